//! The peak of a row in two stages: the whole band with few harmonics, the tops found there with all of them.
//!
//! Higher harmonics change the height of a peak by some percent and hardly its place, but each of them costs as
//! much as the first. So the search that proves that nothing higher hides is made with few harmonics, and the set of
//! the row is solved where the few lead to: at the highest top, and at every other one that is not lower
//! by more than harmonics can make up for. Beside the solution with few harmonics the rest comes by the derivatives
//! of harmonics by themselves (see [`crate::response::harmonic_balance::Steps::ByHarmonic`]). Where
//! the few find no peak, a contact opens, or a top is lost on the way, the search is made with the whole set.

use super::excited::Excited;
use super::options::ContactCondition;
use super::peak::{EVALUATIONS, Peak, SEARCH_PRECISION, Window, peak, search_plan};
use super::peak_search::{Envelope, SearchEnd, SearchResult, SearchSettings, find_peak};
use super::point_settings::PointSettings;
use super::point_solver::{Point, PointSolver, Work};
use super::samples::{Sample, Samples};
use super::summit;
use crate::response::friction::Ring;
use crate::response::harmonic_balance::Status;

/// Least tolerance of the first search: what it finds is only where to look.
const COARSE_TOLERANCE: f64 = 0.02;
/// Precision of the amplitudes of all harmonics that are compared, over the tolerance.
const REFINED_PRECISION: f64 = 0.05;
/// Share that harmonics may change the height of one top more than that of another.
const MADE_UP: f64 = 0.05;
/// First neighbours of a top, in half-bandwidths: the distance at which a parabola is trusted at 0.5 %.
const NEIGHBOURS: f64 = 0.35;
/// Points of one top at most.
const POINTS_OF_TOP: usize = 40;
/// Times that a top may be followed beyond its neighbours.
const EXTENSIONS: usize = 12;

/// What a search with few harmonics is made with.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    /// The structure in these harmonics, under the same excitation.
    pub excited: &'a Excited,
    /// The settings of its points.
    pub settings: &'a PointSettings,
}

/// A local maximum of the first search.
struct Top {
    frequency_hz: f64,
    amplitude_m: f64,
    half_bandwidth_hz: f64,
}

/// [`peak`] with `search` before it.
#[must_use]
pub fn refined_peak(
    excited: &Excited,
    search: Search<'_>,
    condition: ContactCondition,
    settings: &PointSettings,
    window: Window,
    peak_tolerance: f64,
) -> Peak {
    let refined = refined(excited, search, condition, settings, window, peak_tolerance);
    refined.unwrap_or_else(|wasted| {
        let found = peak(excited, condition, settings, window, peak_tolerance);
        with_work(found, wasted)
    })
}

/// The peak by both stages alone.
///
/// # Errors
/// The work done, where one of them finds none: few harmonics find no peak, a contact opens, or a top is lost.
pub fn refined(
    excited: &Excited,
    search: Search<'_>,
    condition: ContactCondition,
    settings: &PointSettings,
    window: Window,
    peak_tolerance: f64,
) -> Result<Peak, Work> {
    let plan = search_plan(excited, condition, window).map_err(|_| Work::default())?;
    if settings.ring == Ring::Creeping {
        return Err(Work::default());
    }
    let coarse_tolerance = peak_tolerance.max(COARSE_TOLERANCE);
    let mut coarse = PointSolver::new(search.excited, condition, search.settings)
        .with_precision(SEARCH_PRECISION * coarse_tolerance);
    let found = find_peak(
        plan.band_hz,
        &plan.starts_hz,
        plan.envelope,
        SearchSettings {
            tolerance: coarse_tolerance,
            evaluations: EVALUATIONS,
            extensions: plan.extensions,
            rivals_from: 1.0 - MADE_UP,
        },
        |hz| amplitudes(&mut coarse, hz),
    );
    let opens = coarse
        .points()
        .iter()
        .any(|point| point.shares.separated > 0.0);
    if found.end != SearchEnd::Found || !found.bracketed || opens {
        return Err(coarse.work());
    }
    let solver = PointSolver::new(excited, condition, settings)
        .with_precision(REFINED_PRECISION * peak_tolerance)
        .refining(&coarse);
    let tops = tops(&found, plan.envelope);
    let refined = highest(solver, &tops, plan.envelope, peak_tolerance)
        .map_err(|wasted| coarse.work().plus(wasted))?;
    let refined = with_work(refined, coarse.work());
    // A band that is asked for has no peak beyond its ends.
    let hz = refined.point.as_ref().map(|point| point.frequency_hz);
    let inside = hz.is_some_and(|hz| plan.band_hz.0 < hz && hz < plan.band_hz.1);
    if plan.extensions > 0 || inside {
        Ok(refined)
    } else {
        Err(refined.work)
    }
}

fn with_work(peak: Peak, work: Work) -> Peak {
    Peak {
        work: peak.work.plus(work),
        ..peak
    }
}

fn amplitudes(solver: &mut PointSolver<'_>, frequency_hz: f64) -> Option<Vec<f64>> {
    let known = |point: &&Point| point.frequency_hz.total_cmp(&frequency_hz).is_eq();
    if let Some(point) = solver.points().iter().find(known) {
        return Some(point.amplitudes_m.clone());
    }
    let point = solver.solve(frequency_hz).ok()?;
    Some(point.amplitudes_m.clone())
}

/// The local maxima of a search, the highest first.
fn tops(found: &SearchResult, envelope: Envelope) -> Vec<Top> {
    let samples = Samples(found.samples.clone());
    let mut tops: Vec<Top> = (0..samples.0.len())
        .filter(|&at| samples.bracketed(at))
        .filter_map(|at| {
            let (left, right) = samples.neighbours(at)?;
            let sample: &Sample = &samples.0[at];
            let between =
                |hz: f64| hz > samples.0[left].frequency_hz && hz < samples.0[right].frequency_hz;
            let summit = summit::of_parabola(samples.points([left, at, right], sample.blade))
                .filter(|summit| summit.amplitude.is_finite() && between(summit.frequency_hz));
            Some(Top {
                frequency_hz: summit.map_or(sample.frequency_hz, |summit| summit.frequency_hz),
                amplitude_m: summit.map_or(sample.largest, |summit| summit.amplitude),
                half_bandwidth_hz: summit.map_or(envelope.linear_half_bandwidth_hz, |summit| {
                    summit
                        .half_bandwidth_hz
                        .max(envelope.linear_half_bandwidth_hz)
                }),
            })
        })
        .collect();
    tops.sort_by(|a, b| b.amplitude_m.total_cmp(&a.amplitude_m));
    tops
}

/// The highest of the `tops` with the harmonics of `solver`; the work done where one of them that may be it is lost.
fn highest(
    mut solver: PointSolver<'_>,
    tops: &[Top],
    envelope: Envelope,
    tolerance: f64,
) -> Result<Peak, Work> {
    let settings = SearchSettings {
        tolerance,
        evaluations: POINTS_OF_TOP,
        extensions: EXTENSIONS,
        rivals_from: 1.0,
    };
    // Height and place of the highest so far, and its height over that with few harmonics.
    let mut best: Option<(f64, f64, f64)> = None;
    for top in tops {
        let lower =
            |height: f64| best.is_some_and(|(highest, ..)| height * (1.0 + MADE_UP) < highest);
        if best.is_some_and(|(.., grown)| lower(top.amplitude_m * grown)) {
            continue;
        }
        let there = amplitudes(&mut solver, top.frequency_hz).ok_or(solver.work())?;
        if lower(there.into_iter().fold(0.0, f64::max)) {
            continue;
        }
        let reach = NEIGHBOURS * top.half_bandwidth_hz;
        let band = (top.frequency_hz - reach, top.frequency_hz + reach);
        let found = find_peak(band, &[top.frequency_hz], envelope, settings, |hz| {
            amplitudes(&mut solver, hz)
        });
        let sample = found.best.map(|best| &found.samples[best]);
        let Some(sample) = sample.filter(|_| found.end == SearchEnd::Found && found.bracketed)
        else {
            return Err(solver.work());
        };
        if best.is_none_or(|(height, ..)| sample.largest > height) {
            let grown = sample.largest / top.amplitude_m;
            best = Some((sample.largest, sample.frequency_hz, grown));
        }
    }
    let opens = solver
        .points()
        .iter()
        .any(|point| point.shares.separated > 0.0);
    let Some((_, frequency_hz, _)) = best.filter(|_| !opens) else {
        return Err(solver.work());
    };
    let point = solver.finish(frequency_hz).cloned();
    let Ok(point) = point else {
        return Err(solver.work());
    };
    Ok(Peak {
        status: Status::Ok,
        blade: point.largest_blade(),
        mean_friction_n: solver.mean_friction_n(&point),
        point: Some(point),
        bracketed: true,
        work: solver.work(),
    })
}
