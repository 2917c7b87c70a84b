//! A top of a row that is climbed with one set of harmonics after the other: what every set leaves on few harmonics, between the
//! frequencies that are solved with it.

use crate::response::receptance::ContactForces;

/// Least and largest distance, over that wanted, at which a point serves as one beside a top.
const SERVES: (f64, f64) = (0.5, 1.5);
/// Least distance of points that a force is interpolated between, over that of points beside a top.
const APART: f64 = 0.4;
/// Points that a force is interpolated between at most.
const NODES: usize = 3;

/// Fall beside a top over that of a resonance, and more, from which on the curve falls off a cliff there.
const CLIFF: (f64, f64) = (3.0, 0.01);

/// A frequency that is solved with the harmonics of a set.
pub(super) struct Known {
    pub(super) frequency_hz: f64,
    /// Phase of harmonic 1 there, rad, by few harmonics.
    pub(super) phase: f64,
    pub(super) height_m: f64,
    /// What the set leaves on few harmonics beyond what the sets before it do.
    pub(super) force: ContactForces,
    /// Amplitude of every blade with the set over that of few harmonics in the same solution, over the same by the sets before it.
    pub(super) growth: Vec<f64>,
}

/// A top that is searched.
pub(super) struct Climb {
    /// What is known of the top with every set so far.
    pub(super) known: Vec<Vec<Known>>,
    /// Distance of points beside the top, Hz.
    pub(super) beside_hz: f64,
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

    /// A frequency beside the top, Hz, on a side on which no point serves. Both sides are looked at with every set: a harmonic of the
    /// last one may meet a resonance of its own on the side that the sets before it have not shown.
    pub(super) fn unseen_beside(&self, top_hz: f64) -> Option<f64> {
        let is_unseen = |side: &f64| {
            let way = |known: &Known| (known.frequency_hz - top_hz) / side;
            let serves = |known: &Known| (SERVES.0..=SERVES.1).contains(&way(known));
            !self.last_set().iter().any(serves)
        };
        let unseen = [-self.beside_hz, self.beside_hz]
            .into_iter()
            .find(is_unseen);
        unseen.map(|side| top_hz + side)
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

    /// What the first `sets` sets leave on few harmonics at a frequency, Hz, with a phase of harmonic 1 there, rad, and the growth of
    /// every blade's amplitude by them. These forces turn with the phase; beside that they change little.
    pub(super) fn left(
        &self,
        sets: usize,
        (frequency_hz, phase): (f64, f64),
    ) -> Option<(ContactForces, Vec<f64>)> {
        let mut forces = Vec::new();
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
            let turned =
                |(share, node): (f64, &Known)| (share, node.force.turned_ahead(phase - node.phase));
            forces.extend(nodes.into_iter().map(turned));
        }
        let forces = forces.iter().map(|(share, force)| (*share, force));
        let forces: Vec<(f64, &ContactForces)> = forces.collect();
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
