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

use super::peak::{Peak, SearchPlan};
use super::peak_search::{Envelope, SearchSettings, VERTEX_SHARE, find_peak};
use super::point::{Point, Work};
use super::point_settings::PointSettings;
use super::point_source::PointSource;
use super::receptance_points::{EngineRow, ReceptancePoints};
use super::refined_peak::{
    EXTENSIONS, HUMP, MADE_UP, NEIGHBOURS, POINTS_OF_TOP, Top, inside_of_band, summit_of,
    tops_of_few,
};
use super::starts::between;
use crate::response::harmonic_balance::Status;
use crate::response::receptance::{ContactForces, embedded, overlay};

/// Precision of the points with all harmonics, over the tolerance of the peak: at a top, and beside it.
const AT_TOP: f64 = 0.2;
const AT_SIDE: f64 = 0.5;
/// Precision of the points with few harmonics, over the tolerance of the peak.
const OF_FEW: f64 = 0.02;
/// Share of the tolerance that a summit found with few harmonics may lie above the points with all of them.
const ABOVE: f64 = 0.15;
/// Points of one top with all harmonics at most.
const POINTS: usize = 20;
/// Points beside a top, in its half-bandwidths: where it has fallen by a hundredth. Nearer than this a hump of that size shows.
const BESIDE: f64 = 0.14;
/// The same in half-bandwidths of a linear resonance, which is as narrow as a hump can be.
const BESIDE_LINEAR: f64 = 0.5;
/// Least and largest distance, over that wanted, at which a point serves as one beside a top.
const SERVES: (f64, f64) = (0.5, 1.5);
/// Least distance of points that a force is interpolated between, over that of points beside a top.
const APART: f64 = 0.4;
/// Points that a force is interpolated between at most.
const NODES: usize = 3;

/// The peak of `row` by `plan` with the settings of few harmonics and of all of them.
///
/// # Errors
/// The work done, where few harmonics find no peak, a contact opens, or a top is lost.
pub(super) fn corrected_peak(
    row: &EngineRow<'_>,
    plan: &SearchPlan,
    [of_few, of_all]: [&PointSettings; 2],
    peak_tolerance: f64,
) -> Result<Peak, Work> {
    let mut few = ReceptancePoints::new(row, of_few);
    let tops = tops_of_few(plan, &mut few, peak_tolerance)?;
    // What samples change jumps over frequency, and is no part of what harmonics leave.
    let Ok(Some(as_fine)) = of_all.search_at_own_samples() else {
        return Err(few.work());
    };
    let mut corrected = ReceptancePoints::new(row, &as_fine);
    corrected.set_precision(OF_FEW * peak_tolerance);
    let mut search = CorrectedSearch {
        few: corrected,
        uncorrected: few,
        all: ReceptancePoints::new(row, of_all),
        envelope: plan.envelope,
        tolerance: peak_tolerance,
    };
    let highest = search.highest(&tops);
    let point = highest.and_then(|frequency_hz| search.finished(frequency_hz));
    let work = search.work();
    let point = point.map_err(|_| work)?;
    let peak = Peak {
        status: Status::Ok,
        blade: point.largest_blade(),
        mean_friction_n: search.all.mean_friction_n(&point),
        point: Some(point),
        bracketed: true,
        work,
    };
    inside_of_band(plan, peak)
}

struct CorrectedSearch<'a> {
    few: ReceptancePoints<'a>,
    /// The points of the first search.
    uncorrected: ReceptancePoints<'a>,
    all: ReceptancePoints<'a>,
    envelope: Envelope,
    tolerance: f64,
}

/// A frequency that is solved with all harmonics.
struct Known {
    frequency_hz: f64,
    height_m: f64,
    /// What all harmonics leave on few of them.
    force: ContactForces,
    /// Amplitude of every blade with all harmonics over that of few of them in the same solution: 1 for that of the fundamental.
    growth: Vec<f64>,
}

/// A top that is searched.
struct Climb {
    known: Vec<Known>,
    /// Distance of points beside the top, Hz.
    beside_hz: f64,
}

impl CorrectedSearch<'_> {
    fn work(&self) -> Work {
        let few = self.few.work().plus(self.uncorrected.work());
        few.plus(self.all.work())
    }

    /// The point with all harmonics to the tolerance of the residual; an error where a contact opens beside it.
    fn finished(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let mut points = self.all.points.iter();
        if points.any(|point| point.shares.separated > 0.0) {
            return Err(Status::SweepIncomplete);
        }
        self.all.finished(frequency_hz)
    }

    /// Frequency of the highest of several tops, Hz.
    fn highest(&mut self, tops: &[Top]) -> Result<f64, Status> {
        // Height and place of the highest so far, and its height over that with few harmonics.
        let mut best: Option<(f64, f64, f64)> = None;
        for top in tops {
            let lower =
                |height: f64| best.is_some_and(|(highest, ..)| height * (1.0 + MADE_UP) < highest);
            if best.is_some_and(|(.., grown)| lower(top.amplitude_m * grown)) {
                continue;
            }
            self.few.points.clone_from(&self.uncorrected.points);
            let mut climb = Climb {
                known: Vec::new(),
                beside_hz: self.distance_beside(top),
            };
            self.solve_all(&mut climb, top.frequency_hz, AT_TOP)?;
            self.few
                .points
                .retain(|point| point.frequency_hz.total_cmp(&top.frequency_hz).is_eq());
            if lower(climb.known[0].height_m) {
                continue;
            }
            let floor_m = best.map_or(0.0, |(highest, ..)| highest);
            let (height, frequency_hz) = self.climb(&mut climb, top, floor_m)?;
            if best.is_none_or(|(highest, ..)| height > highest) {
                best = Some((height, frequency_hz, height / top.amplitude_m));
            }
        }
        best.map(|(_, frequency_hz, _)| frequency_hz)
            .ok_or(Status::NotBracketed)
    }

    fn distance_beside(&self, top: &Top) -> f64 {
        let narrow = BESIDE_LINEAR * self.envelope.linear_half_bandwidth_hz;
        f64::min(
            NEIGHBOURS * top.half_bandwidth_hz,
            narrow.max(BESIDE * top.half_bandwidth_hz),
        )
    }

    /// Height, m, and frequency, Hz, of a top with all harmonics; of the highest point so far where it cannot reach `floor_m`.
    fn climb(&mut self, climb: &mut Climb, top: &Top, floor_m: f64) -> Result<(f64, f64), Status> {
        let reach = NEIGHBOURS * top.half_bandwidth_hz;
        let mut band = (top.frequency_hz - reach, top.frequency_hz + reach);
        let settings = SearchSettings {
            tolerance: self.tolerance * ABOVE / VERTEX_SHARE,
            evaluations: POINTS_OF_TOP,
            extensions: EXTENSIONS,
            rivals_from: 1.0,
        };
        while climb.known.len() < POINTS {
            let starts: Vec<f64> = climb.known.iter().map(|own| own.frequency_hz).collect();
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
            let above = (1.0 + ABOVE * self.tolerance) * best.height_m;
            if is_lower {
                return Ok((best.height_m, best.frequency_hz));
            } else if summit.largest > above {
                self.solve_all(climb, summit.frequency_hz, AT_TOP)?;
            } else if let Some(side_hz) = climb.unseen_beside(best.frequency_hz) {
                self.solve_all(climb, side_hz, AT_SIDE)?;
            } else {
                return Ok((best.height_m, best.frequency_hz));
            }
        }
        Err(Status::SweepIncomplete)
    }

    /// Amplitudes at a frequency, Hz, as few harmonics have them under the force of all.
    fn corrected(&mut self, climb: &Climb, frequency_hz: f64) -> Option<Vec<f64>> {
        let same = |hz: f64| hz.total_cmp(&frequency_hz).is_eq();
        if climb.known.iter().any(|own| same(own.frequency_hz)) {
            return self.all.amplitudes_at(frequency_hz);
        }
        self.few.points.retain(|point| !same(point.frequency_hz));
        let nodes = climb.nodes(frequency_hz);
        let forces: Vec<(f64, &ContactForces)> = nodes
            .iter()
            .map(|(share, own)| (*share, &own.force))
            .collect();
        self.few
            .solver
            .load_contact(ContactForces::combined(&forces)?);
        let mut amplitudes_m = self.few.amplitudes_at(frequency_hz)?;
        for (blade, amplitude_m) in amplitudes_m.iter_mut().enumerate() {
            let growth = nodes.iter().map(|(share, own)| share * own.growth[blade]);
            *amplitude_m *= growth.sum::<f64>();
        }
        Some(amplitudes_m)
    }

    /// Solves all harmonics at a frequency, Hz, beside what few of them have there; to a share of the tolerance of the peak.
    fn solve_all(
        &mut self,
        climb: &mut Climb,
        frequency_hz: f64,
        precision: f64,
    ) -> Result<(), Status> {
        let (few_set, all_set) = (
            self.few.solver.harmonics().to_vec(),
            self.all.solver.harmonics().to_vec(),
        );
        let few = between(&self.few.points, frequency_hz).into_iter().next();
        let few = few.ok_or(Status::NotBracketed)?;
        let known = between(&self.all.points, frequency_hz).into_iter().next();
        let start = match known {
            Some(mut start) => {
                overlay(&mut start, &few, &few_set, &all_set);
                start
            }
            None => embedded(&few, &few_set, &all_set),
        };
        let tolerance = (precision * self.tolerance).max(self.all.least_tolerance());
        let point = self.all.solve_from(frequency_hz, &[start], tolerance)?;
        let force = self.all.solver.contact_forces();
        let growth = self.all.growth_over(&self.few);
        let part = embedded(&point.solution, &all_set, &few_set);
        let few_force = self.few.solver.contact_forces_at(&part);
        let known = Known {
            frequency_hz,
            height_m: point.largest_amplitude_m(),
            force: force.beyond(&few_force.ok_or(Status::NotBracketed)?),
            growth,
        };
        let same = |own: &Point| own.frequency_hz.total_cmp(&frequency_hz).is_eq();
        self.few.points.retain(|own| !same(own));
        self.few.points.push(Point {
            solution: part,
            ..point.clone()
        });
        self.all.points.push(point);
        climb.known.push(known);
        Ok(())
    }
}

impl Climb {
    /// The highest so far.
    fn best(&self) -> &Known {
        let highest = |a: &&Known, b: &&Known| a.height_m.total_cmp(&b.height_m);
        let best = self.known.iter().max_by(highest);
        best.unwrap_or(&self.known[0])
    }

    /// A frequency beside the top, Hz, on a side on which no point serves.
    fn unseen_beside(&self, top_hz: f64) -> Option<f64> {
        let sides = [-self.beside_hz, self.beside_hz];
        let unseen = sides.into_iter().find(|side| {
            let way = |own: &Known| (own.frequency_hz - top_hz) / side;
            let serves = |own: &Known| (SERVES.0..=SERVES.1).contains(&way(own));
            !self.known.iter().any(serves)
        });
        unseen.map(|side| top_hz + side)
    }

    /// The nearest known points to a frequency, Hz, each with its share in the polynomial through them there.
    fn nodes(&self, frequency_hz: f64) -> Vec<(f64, &Known)> {
        let mut near: Vec<&Known> = self.known.iter().collect();
        let distance = |own: &Known| (own.frequency_hz - frequency_hz).abs();
        near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut nodes: Vec<&Known> = Vec::new();
        for own in near {
            let apart = |node: &&Known| {
                (node.frequency_hz - own.frequency_hz).abs() >= APART * self.beside_hz
            };
            if nodes.len() < NODES && nodes.iter().all(apart) {
                nodes.push(own);
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
