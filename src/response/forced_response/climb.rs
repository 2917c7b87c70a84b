//! A top of a row that is climbed with one set of harmonics after the other: what every set leaves on few harmonics, between the
//! frequencies that are solved with it.

use crate::response::receptance::{ContactForces, WheelSolver};

/// Least and largest distance, over that wanted, at which a point serves as one beside a top.
const SERVES: (f64, f64) = (0.5, 1.5);
/// Fall of a curve beside a top, relative, without which another top may follow, and the distance, over that wanted, at which no more is
/// looked for.
const FALL: f64 = 0.005;
const FURTHEST: f64 = 3.5;
/// Least distance of points that a force is interpolated between, over that of points beside a top.
const APART: f64 = 0.4;
/// Points that a force is interpolated between at most.
const NODES: usize = 3;

/// Fall beside a top over that of a resonance, and more, from which on the curve falls off a cliff there.
const CLIFF: (f64, f64) = (3.0, 0.01);

/// A frequency that is solved with the harmonics of a set.
pub(super) struct Known {
    pub(super) frequency_hz: f64,
    /// Phases of harmonic 1 of the sectors there, rad, by few harmonics.
    pub(super) phases: Vec<f64>,
    pub(super) height_m: f64,
    /// Whether few harmonics expect this height there, under what the points before it leave.
    pub(super) is_expected: bool,
    /// What the set leaves on few harmonics beyond what the sets before it do.
    pub(super) force: ContactForces,
    /// Amplitude of every blade with the set over that of few harmonics in the same solution, over the same by the sets before it.
    pub(super) growth: Vec<f64>,
}

/// A top that is searched.
pub(super) struct Climb {
    /// What is known of the top with every set so far.
    pub(super) known: Vec<Vec<Known>>,
    /// Frequencies, Hz, that the last set so far began with.
    pub(super) starts_hz: Vec<f64>,
    /// Distance of points beside the top, Hz.
    pub(super) beside_hz: f64,
    /// Distance, Hz, below which no more is looked for between two points.
    pub(super) narrow_hz: f64,
}

impl Climb {
    /// Points of the last set so far.
    pub(super) fn last_set(&self) -> &[Known] {
        self.known.last().map_or(&[], Vec::as_slice)
    }

    /// The highest point of the last set so far.
    pub(super) fn best(&self) -> &Known {
        let highest = |a: &&Known, b: &&Known| a.height_m.total_cmp(&b.height_m);
        let best = self.last_set().iter().max_by(highest);
        best.expect("a climb begins with a point")
    }

    /// Frequencies, Hz, of the points of the last set that are higher than those next to them, without those that are lower than the best
    /// by more than the share `made_up`: the next set may have another one highest. None before the first set.
    pub(super) fn tops_hz(&self, made_up: f64) -> Option<Vec<f64>> {
        let mut points: Vec<&Known> = self.known.last()?.iter().collect();
        points.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let least_m = (1.0 - made_up) * self.best().height_m;
        let height_m = |at: usize| points.get(at).map_or(0.0, |point| point.height_m);
        let is_top = |at: &usize| {
            let next_m = f64::max(height_m(at.wrapping_sub(1)), height_m(at + 1));
            height_m(*at) > least_m.max(next_m)
        };
        let tops = (0..points.len()).filter(is_top);
        Some(tops.map(|at| points[at].frequency_hz).collect())
    }

    /// A frequency, Hz, beside the best point of the last set, one of its tops or where it began, on a side that is not seen. The best moves
    /// from one top to the next, and would leave the far side of the one before unseen. Tops as in [`Self::tops_hz`].
    pub(super) fn unseen(&self, made_up: f64) -> Option<f64> {
        let best_hz = self.best().frequency_hz;
        let tops_hz = self.tops_hz(made_up).unwrap_or_default();
        let mut all_hz = [vec![best_hz], tops_hz, self.starts_hz.clone()]
            .concat()
            .into_iter();
        all_hz.find_map(|top_hz| self.unseen_beside(top_hz))
    }

    /// A frequency, Hz, between the best point of the last set and one next to it, where few harmonics do not expect the height of either:
    /// what the set leaves changes there by more than they know, and the top may lie between. None where the gaps on both sides are narrow.
    pub(super) fn between(&self) -> Option<f64> {
        let best = self.best();
        if best.is_expected {
            return None;
        }
        let gap_hz = |side: f64| {
            let way = |known: &Known| side * (known.frequency_hz - best.frequency_hz);
            let beyond = self.last_set().iter().filter(|known| way(known) > 0.0);
            let next = beyond.min_by(|a, b| way(a).total_cmp(&way(b)))?;
            let gap_hz = way(next);
            (!next.is_expected && 0.5 * gap_hz > self.narrow_hz).then_some(gap_hz)
        };
        let sides = [-1.0, 1.0].into_iter();
        let gaps = sides.filter_map(|side| Some((side, gap_hz(side)?)));
        let widest = gaps.max_by(|a, b| a.1.total_cmp(&b.1));
        widest.map(|(side, gap_hz)| best.frequency_hz + 0.5 * side * gap_hz)
    }

    /// A frequency beside a top, Hz, on a side on which no point serves, or on which the curve has not fallen. Both sides are looked at
    /// with every set: a harmonic of the last one may meet a resonance of its own on the side that the sets before it have not shown.
    fn unseen_beside(&self, top_hz: f64) -> Option<f64> {
        let best_m = self.best().height_m;
        let unseen = |side: f64| {
            let way = |known: &Known| (known.frequency_hz - top_hz) / side;
            let ways = self.last_set().iter().map(way);
            if !ways.clone().any(|way| (SERVES.0..=SERVES.1).contains(&way)) {
                return Some(top_hz + side);
            }
            let furthest = ways.fold(0.0, f64::max);
            let has_fallen =
                |known: &Known| way(known) > 0.0 && known.height_m <= (1.0 - FALL) * best_m;
            let is_flat = furthest < FURTHEST && !self.last_set().iter().any(has_fallen);
            is_flat.then_some(top_hz + (furthest + 1.0) * side)
        };
        [-self.beside_hz, self.beside_hz]
            .into_iter()
            .find_map(unseen)
    }

    /// Whether the curve falls beside the top as no resonance of this half-bandwidth, Hz, does: where a contact that opens folds it, what
    /// the sets leave jumps.
    pub(super) fn falls_off(&self, half_bandwidth_hz: f64) -> bool {
        let best = self.best();
        self.last_set().iter().any(|known| {
            let distance = (known.frequency_hz - best.frequency_hz) / half_bandwidth_hz;
            let of_resonance = 1.0 - 1.0 / (1.0 + distance * distance).sqrt();
            let (times, more) = CLIFF;
            1.0 - known.height_m / best.height_m > times * of_resonance + more
        })
    }

    /// What the first `sets` sets leave on few harmonics, those of `few`, at a frequency, Hz, where the sectors have these phases of
    /// harmonic 1, rad, and the growth of every blade's amplitude by them. These forces turn with the motion of their sector; beside
    /// that they change little.
    pub(super) fn left(
        &self,
        sets: usize,
        frequency_hz: f64,
        phases: &[f64],
        few: &WheelSolver<'_>,
    ) -> Option<(ContactForces, Vec<f64>)> {
        let mut forces: Vec<(f64, ContactForces)> = Vec::new();
        let mut growth: Vec<f64> = Vec::new();
        for known in &self.known[..sets] {
            let nodes = self.nodes(known, frequency_hz);
            let of_set: Vec<f64> = (0..known.first()?.growth.len())
                .map(|blade| {
                    nodes
                        .iter()
                        .map(|(share, node)| share * node.growth[blade])
                        .sum()
                })
                .collect();
            if growth.is_empty() {
                growth = of_set;
            } else {
                growth
                    .iter_mut()
                    .zip(of_set)
                    .for_each(|(all, factor)| *all *= factor);
            }
            for (share, node) in nodes {
                let ahead = phases.iter().zip(&node.phases).map(|(to, from)| to - from);
                let ahead: Vec<f64> = ahead.collect();
                forces.push((share, few.forces_ahead(&node.force, &ahead)));
            }
        }
        let forces: Vec<(f64, &ContactForces)> = forces.iter().map(|(s, f)| (*s, f)).collect();
        Some((ContactForces::combined(&forces)?, growth))
    }

    /// The nearest known points to a frequency, Hz, each with its share in the polynomial through them there.
    fn nodes<'a>(&self, known: &'a [Known], frequency_hz: f64) -> Vec<(f64, &'a Known)> {
        let mut near: Vec<&Known> = known.iter().collect();
        let distance = |known: &Known| (known.frequency_hz - frequency_hz).abs();
        near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut nodes: Vec<&Known> = Vec::new();
        for candidate in near {
            let apart = |node: &&Known| {
                (node.frequency_hz - candidate.frequency_hz).abs() >= APART * self.beside_hz
            };
            if nodes.len() < NODES && nodes.iter().all(apart) {
                nodes.push(candidate);
            }
        }
        let share = |at: usize| -> f64 {
            let others = nodes.iter().enumerate().filter(|(other, _)| *other != at);
            let factors = others.map(|(_, other)| {
                (frequency_hz - other.frequency_hz) / (nodes[at].frequency_hz - other.frequency_hz)
            });
            factors.product()
        };
        (0..nodes.len()).map(|at| (share(at), nodes[at])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A climb with these points of its last set, frequencies in Hz and heights in m, and points 1 Hz beside a top.
    fn climb(points: &[(f64, f64)]) -> Climb {
        let known = points.iter().map(|&(frequency_hz, height_m)| Known {
            frequency_hz,
            phases: Vec::new(),
            height_m,
            is_expected: true,
            force: ContactForces::default(),
            growth: Vec::new(),
        });
        Climb {
            known: vec![known.collect()],
            starts_hz: Vec::new(),
            beside_hz: 1.0,
            narrow_hz: 0.3,
        }
    }

    #[test]
    fn every_top_of_a_set_begins_the_next_one_where_a_dip_parts_them() {
        let two = climb(&[(101.0, 0.9), (100.0, 1.0), (103.0, 0.97), (104.0, 0.9)]);
        assert_eq!(two.tops_hz(0.05), Some(vec![100.0, 103.0]));
        assert_eq!(two.tops_hz(0.02), Some(vec![100.0]));
        let flank = climb(&[(100.0, 1.0), (101.0, 0.99), (99.0, 0.98)]);
        assert_eq!(flank.tops_hz(0.05), Some(vec![100.0]));
    }

    #[test]
    fn where_a_set_began_is_seen_on_both_sides_though_the_best_moved_away() {
        let points = [(100.0, 0.98), (99.0, 0.99), (98.0, 1.0), (97.0, 0.9)];
        let mut moved = climb(&points);
        assert_eq!(moved.unseen(0.05), None);
        moved.starts_hz = vec![100.0];
        assert_eq!(moved.unseen(0.05), Some(101.0));
        // And so is every top that another one parts from the best.
        let parted = climb(&[&points[..], &[(96.0, 0.97)]].concat());
        assert_eq!(parted.unseen(0.05), Some(95.0));
    }

    #[test]
    fn the_wider_gap_beside_a_best_that_is_not_expected_is_halved_until_heights_are() {
        let mut moved = climb(&[(100.0, 0.99), (101.0, 1.0), (101.8, 0.98)]);
        assert_eq!(moved.between(), None);
        for known in &mut moved.known[0] {
            known.is_expected = false;
        }
        assert_eq!(moved.between(), Some(100.5));
        moved.known[0][0].frequency_hz = 100.5;
        assert_eq!(moved.between(), Some(101.4));
        moved.known[0][2].is_expected = true;
        assert_eq!(moved.between(), None);
    }

    #[test]
    fn a_side_that_has_not_fallen_is_looked_at_further_out() {
        let mut points = vec![(100.0, 1.0), (99.0, 0.99)];
        assert_eq!(climb(&points).unseen_beside(100.0), Some(101.0));
        points.push((101.0, 0.999));
        assert_eq!(climb(&points).unseen_beside(100.0), Some(102.0));
        points.push((102.0, 0.994));
        assert_eq!(climb(&points).unseen_beside(100.0), None);
        let plateau = [(100.0, 1.0), (99.0, 0.99), (101.0, 1.0), (102.0, 1.0)];
        let plateau = [&plateau[..], &[(103.0, 1.0), (104.0, 1.0)]].concat();
        assert_eq!(climb(&plateau).unseen_beside(100.0), None);
    }
}
