//! The peak of a row on tuned receptances by a search with few harmonics that takes along what all of them leave there.
//!
//! All harmonics and few of them differ in the equation of the few by a force at the contact alone,
//!
//! ```text
//! u = u_lin - A (G(u) + tau),    tau = G(all harmonics) - G(few of them)
//! ```
//!
//! which is known at every frequency that is solved with all harmonics, and between these frequencies varies little. With it the
//! few harmonics have the curve of all, exactly at these frequencies (full approximation scheme, Brandt 1977). So the top is
//! sought with few harmonics; all of them are solved where it is found, until it is found no higher than they say, and on either
//! side of it, where another harmonic that meets a resonance of its own would show.
//!
//! Where contacts open, the few are harmonics 0 to 3: a pair that opens moves apart in the mean, and twice a period.
//!
//! Between few and all may stand a set that is cheap and close: then the same is done with that set first, and what all harmonics
//! leave beyond it is one more force, that takes three or four solutions with all of them to know.

use super::climb::{Climb, Known};
use super::initial_guess::between_neighbours;
use super::peak::{Peak, SearchPlan};
use super::point::{Point, Work, point_at};
use super::point_settings::PointSettings;
use super::point_source::{PointSource, opens};
use super::receptance_points::{EngineRow, ReceptancePoints};
use super::search::find_peak;
use super::search::{Envelope, SearchSettings, VERTEX_SHARE};
use super::tops::{
    EXTENSIONS, HUMP, MADE_UP, NEIGHBOURS, POINTS_OF_TOP, Top, inside_of_band, summit_of,
    tops_of_few,
};
use crate::response::harmonic_balance::Status;
use crate::response::receptance::{ContactForces, embedded, overlay};

/// How closely tops are followed; precisions are over the tolerance of the peak.
struct Care {
    /// Precision of the points of a set at a top, and beside it.
    at_top: f64,
    at_side: f64,
    /// Precision of the points with few harmonics.
    of_few: f64,
    /// Share of the tolerance that a summit found with few harmonics may lie above the points of a set.
    above: f64,
}

/// Where the study says the harmonics, or no set leads to them.
const ONE_SET: Care = Care {
    at_top: 0.2,
    at_side: 0.5,
    of_few: 0.02,
    above: 0.15,
};
/// Where one set leads to the next: a summit takes half of what was asked for off the peak, a residual a tenth.
const LED: Care = Care {
    at_top: 0.1,
    at_side: 1.0,
    of_few: 0.1,
    above: 0.5,
};
/// Why a set is solved at a frequency.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// Few harmonics have the top there.
    Top,
    /// To see what is beside a top.
    Beside,
    /// Between two points whose heights few harmonics do not expect.
    Between,
}

/// Points of one top with all harmonics at most.
const POINTS: usize = 20;
/// Points beside a top, in its half-bandwidths: where it has fallen by a hundredth. Nearer than this a hump of that size shows.
const BESIDE: f64 = 0.14;
/// Distance of points beside a narrow top, in half-bandwidths of a linear resonance, which is as narrow as a hump can be.
const BESIDE_LINEAR: f64 = 0.5;
/// Least distance between points of a top, in half-bandwidths of a linear resonance: a hump where harmonic 5 meets one is this narrow.
const NARROW: f64 = 0.1;
/// Share that harmonics may change one top more than another at most.
const MOST_MADE_UP: f64 = 0.5;

/// A search that found no peak.
pub(super) struct Lost {
    pub(super) work: Work,
    /// Whether a contact opens, which few harmonics without the mean motion do not follow.
    pub(super) opens: bool,
    /// How a point beside a top ended that no attempt solved, if that ended the search.
    pub(super) unsolved: Option<Status>,
}

/// The peak of `row` by `plan` with the settings of few harmonics, and of sets each within the next, the last with all of them.
///
/// The amplitude with all of them over that with the set before, less 1, stands beside it.
///
/// # Errors
/// Where few harmonics find no peak, a contact opens that they do not follow, or a top is lost.
pub(super) fn corrected_peak(
    row: &EngineRow<'_>,
    plan: &SearchPlan,
    of_few: &PointSettings,
    sets: &[&PointSettings],
    peak_tolerance: f64,
) -> Result<(Peak, f64), Lost> {
    let lost = |work: Work, opens: bool| Lost {
        work,
        opens,
        unsolved: None,
    };
    let mut few = ReceptancePoints::new(row, of_few);
    let follows = of_few.harmonics().contains(&0);
    let tops = tops_of_few(plan, &mut few, peak_tolerance, MADE_UP);
    let is_open = opens(&few.points);
    let tops = tops.map_err(|work| lost(work, is_open))?;
    // What samples change jumps over frequency, and is no part of what harmonics leave.
    let as_fine = sets.first().map(|set| of_few.at_samples_of(set));
    let Some(Ok(as_fine)) = as_fine.filter(|_| follows || !is_open) else {
        return Err(lost(few.work(), is_open));
    };
    let mut corrected = ReceptancePoints::new(row, &as_fine);
    let care = if sets.len() > 1 { LED } else { ONE_SET };
    corrected.set_precision(care.of_few * peak_tolerance);
    let mut search = CorrectedSearch {
        few: corrected,
        uncorrected: few,
        sets: sets
            .iter()
            .map(|set| ReceptancePoints::new(row, set))
            .collect(),
        envelope: plan.envelope,
        tolerance: peak_tolerance,
        care,
        follows,
    };
    let found = search.highest(plan, &tops);
    let found = found.and_then(|highest| Ok((search.finished(highest.frequency_hz)?, highest)));
    let work = search.work();
    let is_open = search.opens();
    let of_search =
        |status: Status| matches!(status, Status::NotBracketed | Status::SweepIncomplete);
    let (point, highest) = found.map_err(|status| Lost {
        unsolved: (!of_search(status)).then_some(status),
        ..lost(work, is_open)
    })?;
    let all = search.sets.last_mut().ok_or(lost(work, is_open))?;
    let peak = Peak {
        status: Status::Ok,
        blade: point.largest_blade(),
        mean_friction_n: all.mean_friction_n(&point),
        point: Some(point),
        bracketed: true,
        work,
    };
    let peak = inside_of_band(plan, peak).map_err(|work| lost(work, is_open))?;
    Ok((peak, highest.last_change()))
}

struct CorrectedSearch<'a> {
    few: ReceptancePoints<'a>,
    /// The points of the first search.
    uncorrected: ReceptancePoints<'a>,
    /// The sets of harmonics, each within the next.
    sets: Vec<ReceptancePoints<'a>>,
    envelope: Envelope,
    tolerance: f64,
    care: Care,
    /// Whether few harmonics have the mean motion, and so follow a contact that opens.
    follows: bool,
}

/// The highest top so far: its frequency, Hz, and its height, m, with few harmonics and with each of the sets.
struct Highest {
    frequency_hz: f64,
    heights_m: Vec<f64>,
}

impl Highest {
    fn height_m(&self) -> f64 {
        self.heights_m.last().copied().unwrap_or(0.0)
    }

    /// What the last set changes of what the one before it has, relative.
    fn last_change(&self) -> f64 {
        let before = self.heights_m.iter().rev().nth(1);
        before.map_or(0.0, |before| self.height_m() / before - 1.0)
    }

    /// Share that all harmonics may change the height of another top more than that of this one, both with so many sets: what they take
    /// off this one they need not take off another.
    fn made_up(&self, sets: usize) -> f64 {
        let taken = self.heights_m[sets] / self.height_m() - 1.0;
        taken.clamp(MADE_UP, MOST_MADE_UP)
    }

    /// Height, m, that all harmonics give a top that has this one with so many sets, if they do what they do here.
    fn grown_m(&self, height_m: f64, sets: usize) -> f64 {
        height_m * self.height_m() / self.heights_m[sets]
    }
}

impl CorrectedSearch<'_> {
    fn work(&self) -> Work {
        let few = self.few.work().plus(self.uncorrected.work());
        self.sets.iter().fold(few, |sum, set| sum.plus(set.work()))
    }

    /// Whether a contact opens at a point without correction, or with one of the sets.
    fn opens(&self) -> bool {
        opens(&self.uncorrected.points) || self.sets.iter().any(|set| opens(&set.points))
    }

    /// The point with all harmonics, to the tolerance of the residual but where several sets led to it and none was asked for.
    fn finished(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let is_guided = self.sets.len() > 1 || self.follows;
        let all = self.sets.last_mut().ok_or(Status::NotBracketed)?;
        if is_guided && !all.residual_is_stated() {
            let point = point_at(&all.points, frequency_hz).cloned();
            return point.ok_or(Status::NotBracketed);
        }
        all.finished(frequency_hz)
    }

    /// The highest of the tops of few harmonics, and of the lower ones that they find where all harmonics take much off the highest.
    fn highest(&mut self, plan: &SearchPlan, tops: &[Top]) -> Result<Highest, Status> {
        let highest = self.highest_beside(None, tops)?;
        let reach = highest.made_up(0);
        if reach <= MADE_UP {
            return Ok(highest);
        }
        let lower = 1.0 - 1.0 / (1.0 + reach);
        let found = tops_of_few(plan, &mut self.uncorrected, self.tolerance, lower);
        let mut further = found.map_err(|_| Status::SweepIncomplete)?;
        if self.opens() && !self.follows {
            return Err(Status::SweepIncomplete);
        }
        let apart = self.envelope.linear_half_bandwidth_hz;
        further.retain(|candidate| {
            let is_new = |top: &Top| (top.frequency_hz - candidate.frequency_hz).abs() > apart;
            tops.iter().all(is_new)
        });
        self.highest_beside(Some(highest), &further)
    }

    /// The highest of several tops and of `best`.
    fn highest_beside(
        &mut self,
        mut best: Option<Highest>,
        tops: &[Top],
    ) -> Result<Highest, Status> {
        for top in tops {
            if let Some(found) = self.heights(top, best.as_ref())?
                && best
                    .as_ref()
                    .is_none_or(|best| found.height_m() > best.height_m())
            {
                best = Some(found);
            }
        }
        best.ok_or(Status::NotBracketed)
    }

    /// A top with one set after the other; none where it cannot be higher than `best`.
    fn heights(&mut self, top: &Top, best: Option<&Highest>) -> Result<Option<Highest>, Status> {
        let is_lower = |height_m: f64, sets: usize| {
            best.is_some_and(|best| {
                best.grown_m(height_m, sets) * (1.0 + best.made_up(sets)) < best.height_m()
            })
        };
        if is_lower(top.amplitude_m, 0) {
            return Ok(None);
        }
        self.few.points.clone_from(&self.uncorrected.points);
        let mut climb = Climb {
            known: Vec::new(),
            starts_hz: Vec::new(),
            beside_hz: self.distance_beside(top),
            narrow_hz: NARROW * self.envelope.linear_half_bandwidth_hz,
        };
        let mut highest = Highest {
            frequency_hz: top.frequency_hz,
            heights_m: vec![top.amplitude_m],
        };
        let reach_hz = NEIGHBOURS * top.half_bandwidth_hz;
        for set in 0..self.sets.len() {
            climb.starts_hz = climb.tops_hz(MADE_UP).unwrap_or(vec![top.frequency_hz]);
            climb.known.push(Vec::new());
            for start_hz in climb.starts_hz.clone() {
                self.solve(&mut climb, start_hz, Place::Top)?;
            }
            if set == 0 {
                let is_top =
                    |point: &Point| point.frequency_hz.total_cmp(&top.frequency_hz).is_eq();
                self.few.points.retain(is_top);
            }
            let floor_m = best.map_or(0.0, |best| best.heights_m[set + 1]);
            let (height_m, frequency_hz) = self.climb(&mut climb, reach_hz, floor_m)?;
            if self.follows && climb.falls_off(top.half_bandwidth_hz) {
                return Err(Status::SweepIncomplete);
            }
            highest.frequency_hz = frequency_hz;
            highest.heights_m.push(height_m);
        }
        Ok(Some(highest))
    }

    fn distance_beside(&self, top: &Top) -> f64 {
        let narrow = BESIDE_LINEAR * self.envelope.linear_half_bandwidth_hz;
        f64::min(
            NEIGHBOURS * top.half_bandwidth_hz,
            narrow.max(BESIDE * top.half_bandwidth_hz),
        )
    }

    /// Height, m, and frequency, Hz, of a top with the last set of the climb; of the highest point so far where it cannot reach
    /// `floor_m`. It is first sought within `reach_hz`.
    fn climb(
        &mut self,
        climb: &mut Climb,
        reach_hz: f64,
        floor_m: f64,
    ) -> Result<(f64, f64), Status> {
        let first = climb.best().frequency_hz;
        let mut band = (first - reach_hz, first + reach_hz);
        let settings = SearchSettings {
            tolerance: self.tolerance * self.care.above / VERTEX_SHARE,
            evaluations: POINTS_OF_TOP,
            extensions: EXTENSIONS,
            rivals_from: 1.0,
        };
        while climb.last_set().len() < POINTS {
            let starts: Vec<f64> = climb
                .last_set()
                .iter()
                .map(|known| known.frequency_hz)
                .collect();
            let found = find_peak(band, &starts, self.envelope, settings, |hz| {
                self.corrected(climb, hz)
            });
            let summit = summit_of(&found).ok_or(Status::NotBracketed)?;
            let best = climb.best();
            band = (
                best.frequency_hz - climb.beside_hz,
                best.frequency_hz + climb.beside_hz,
            );
            let is_lower = summit.largest.max(best.height_m) * (1.0 + HUMP) < floor_m;
            let above = (1.0 + self.care.above * self.tolerance) * best.height_m;
            if is_lower {
                return Ok((best.height_m, best.frequency_hz));
            } else if summit.largest > above {
                self.solve(climb, summit.frequency_hz, Place::Top)?;
            } else if let Some(side_hz) = climb.unseen(MADE_UP) {
                self.solve(climb, side_hz, Place::Beside)?;
            } else if let Some(between_hz) =
                { climb.between() }.filter(|_| climb.last_set().len() + 1 < POINTS)
            {
                self.solve(climb, between_hz, Place::Between)?;
            } else {
                return Ok((best.height_m, best.frequency_hz));
            }
        }
        Err(Status::SweepIncomplete)
    }

    /// Amplitudes at a frequency, Hz, as few harmonics have them under the forces of the sets of the climb.
    fn corrected(&mut self, climb: &Climb, frequency_hz: f64) -> Option<Vec<f64>> {
        let same = |hz: f64| hz.total_cmp(&frequency_hz).is_eq();
        if climb
            .last_set()
            .iter()
            .any(|known| same(known.frequency_hz))
        {
            return self.sets[climb.known.len() - 1].amplitudes_at(frequency_hz);
        }
        self.few.points.retain(|point| !same(point.frequency_hz));
        let phases = self.phases(frequency_hz)?;
        let sets = climb.known.len();
        let (force, growth) = climb.left(sets, frequency_hz, &phases, &self.few.solver)?;
        self.few.solver.add_forces(force);
        let mut amplitudes_m = self.few.amplitudes_at(frequency_hz)?;
        for (amplitude_m, growth) in amplitudes_m.iter_mut().zip(growth) {
            *amplitude_m *= growth;
        }
        Some(amplitudes_m)
    }

    /// Phases of harmonic 1, rad, by which the sectors at a frequency, Hz, are ahead of those of the first point with few harmonics alone.
    fn phases(&self, frequency_hz: f64) -> Option<Vec<f64>> {
        let points = &self.uncorrected.points;
        let solver = &self.uncorrected.solver;
        let there = between_neighbours(points, solver, frequency_hz)?;
        Some(solver.phases_ahead(&points[0].solution, &there))
    }

    /// Motions to solve the last of the first `sets` sets from, at a frequency, Hz: those of few harmonics, and of every set on the way
    /// what its own points have beside them.
    fn start(&self, sets: usize, frequency_hz: f64) -> Option<Vec<f64>> {
        let few_set = self.few.solver.harmonics();
        let few = between_neighbours(&self.few.points, &self.few.solver, frequency_hz)?;
        let (mut start, mut set) = (few.clone(), few_set);
        for points in &self.sets[..sets] {
            let larger = points.solver.harmonics();
            let known = between_neighbours(&points.points, &points.solver, frequency_hz);
            start = if let Some(known) = known {
                let part = embedded(&known, larger, few_set);
                let phases = self.few.solver.phases_ahead(&part, &few);
                let mut known = points.solver.turned_ahead(&known, &phases);
                overlay(&mut known, &few, few_set, larger);
                known
            } else {
                embedded(&start, set, larger)
            };
            set = larger;
        }
        Some(start)
    }

    /// Solves the last set of the climb at a frequency, Hz.
    fn solve(&mut self, climb: &mut Climb, frequency_hz: f64, place: Place) -> Result<(), Status> {
        let precision = match place {
            Place::Top | Place::Between => self.care.at_top,
            Place::Beside => self.care.at_side,
        };
        let expected_m = match place {
            Place::Between => self.corrected(climb, frequency_hz),
            Place::Top | Place::Beside => None,
        };
        let expected_m = expected_m.map(|heights_m| heights_m.into_iter().fold(0.0, f64::max));
        let sets = climb.known.len();
        let start = self.start(sets, frequency_hz).ok_or(Status::NotBracketed)?;
        let last_set = &mut self.sets[sets - 1];
        let tolerance = (precision * self.tolerance).max(last_set.least_tolerance());
        let point = last_set.solve_from(frequency_hz, &[start], tolerance)?;
        let force = last_set.solver.contact_forces();
        let mut growth = last_set.growth_over(&self.few);
        let part = embedded(
            &point.solution,
            last_set.solver.harmonics(),
            self.few.solver.harmonics(),
        );
        let few_force = self.few.solver.contact_forces_at(&part);
        let mut force = force.beyond(&few_force.ok_or(Status::NotBracketed)?);
        let phases = self.phases(frequency_hz).ok_or(Status::NotBracketed)?;
        let before = climb.left(sets - 1, frequency_hz, &phases, &self.few.solver);
        if let Some((before, grown)) = before {
            force = ContactForces::combined(&[(1.0, &force), (-1.0, &before)])
                .ok_or(Status::NotBracketed)?;
            growth
                .iter_mut()
                .zip(grown)
                .for_each(|(factor, before)| *factor /= before);
        }
        let last_set = &mut self.sets[sets - 1];
        let height_m = point.largest_amplitude_m();
        let known = Known {
            frequency_hz,
            phases,
            height_m,
            is_expected: match expected_m {
                Some(expected_m) => {
                    (height_m / expected_m - 1.0).abs() <= self.care.above * self.tolerance
                }
                None => place == Place::Top,
            },
            force,
            growth,
        };
        let same = |known_point: &Point| known_point.frequency_hz.total_cmp(&frequency_hz).is_eq();
        self.few.points.retain(|known_point| !same(known_point));
        self.few.points.push(Point {
            solution: part,
            ..point.clone()
        });
        last_set.points.push(point);
        climb.known[sets - 1].push(known);
        if self.opens() && !self.follows {
            return Err(Status::SweepIncomplete);
        }
        Ok(())
    }
}
