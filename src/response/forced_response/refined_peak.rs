//! The peak of a row on a basis in two stages: the whole band with few harmonics, the tops found there with all of them.
//!
//! Higher harmonics change the height of a peak by some percent and hardly its place, but each of them costs as
//! much as the first. So the search that proves that nothing higher hides is made with few harmonics, and the set of
//! the row is solved where the few lead to: at the highest top, and at every other one that is not lower
//! by more than harmonics can make up for. Beside the solution with few harmonics the rest comes by the derivatives
//! of harmonics by themselves (see [`crate::response::harmonic_balance::Steps::ByHarmonic`]). Where
//! the few find no peak, a contact opens, or a top is lost on the way, the search is made with the whole set.
//!
//! Rows on tuned receptances have their second stage in `corrected_peak.rs`.

use super::excited::Excited;
use super::options::ContactCondition;
use super::peak::{Peak, Window, search_plan};
use super::point::{Point, Work};
use super::point_settings::PointSettings;
use super::point_solver::PointSolver;
use super::point_source::{PointSource, opens};
use super::search::{Envelope, SearchSettings};
use super::search::{Reading, Samples};
use super::search::{SearchResult, find_peak};
use super::tops::{
    EXTENSIONS, HUMP, MADE_UP, NEIGHBOURS, POINTS_OF_TOP, Top, inside_of_band, summit_of,
    tops_of_few, with_work,
};
use crate::response::friction::Ring;
use crate::response::harmonic_balance::Status;

/// Precision of the amplitudes of all harmonics that are compared, over the tolerance: the best is solved again beyond it.
const REFINED_PRECISION: f64 = 0.2;
/// Gaps beside a top that are looked into, in half-bandwidths of a linear resonance.
const WIDE: f64 = 0.5;
/// Times that they are looked into at most; each halves them.
const LOOKS: usize = 4;

/// What a search with few harmonics is made with.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    /// The structure in these harmonics, under the same excitation.
    pub excited: &'a Excited,
    /// The settings of its points.
    pub settings: &'a PointSettings,
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
    let mut coarse = PointSolver::new(search.excited, condition, search.settings);
    let tops = tops_of_few(&plan, &mut coarse, peak_tolerance, MADE_UP)?;
    if opens(coarse.points()) {
        return Err(coarse.work());
    }
    let mut solver = PointSolver::new(excited, condition, settings).refining(&coarse);
    solver.set_precision(REFINED_PRECISION * peak_tolerance);
    let refined = highest(solver, &tops, plan.envelope, peak_tolerance)
        .map_err(|wasted| coarse.work().plus(wasted))?;
    inside_of_band(&plan, with_work(refined, coarse.work()))
}

/// The point at a frequency, solved to its end; the work done where that fails or a contact opens.
fn finished(solver: &mut impl PointSource, frequency_hz: f64) -> Result<Point, Work> {
    if opens(solver.points()) {
        return Err(solver.work());
    }
    let finished = solver.finished(frequency_hz);
    finished.map_err(|_| solver.work())
}

/// What a search of one top found, or finds with the middles of the gaps beside its best, where these promise more than
/// the tolerance above it.
///
/// A broad top is believed by three or four points far apart, which do not see where another harmonic meets a resonance
/// of its own: a hump of half a percent, narrower than they are apart.
fn looked_into(
    found: SearchResult,
    envelope: Envelope,
    settings: SearchSettings,
    mut evaluate: impl FnMut(f64) -> Option<Vec<f64>>,
) -> SearchResult {
    let wide = WIDE * envelope.linear_half_bandwidth_hz;
    let mut found = found;
    for _ in 0..LOOKS {
        let mut samples = Samples(found.samples.clone());
        let beside = found.best.and_then(|best| samples.neighbours(best));
        let (Some(best), Some((left, right))) = (found.best, beside) else {
            return found;
        };
        let hz = |at: usize| samples.0[at].frequency_hz;
        let gaps = [(hz(left), hz(best)), (hz(best), hz(right))];
        let height = samples.0[best].largest;
        for (from, to) in gaps.into_iter().filter(|(from, to)| to - from > wide) {
            let middle = 0.5 * (from + to);
            samples.insert(middle, evaluate(middle).map(Reading::from));
        }
        let kept = samples.0.len() == found.samples.len()
            || samples.promised() <= (1.0 + settings.tolerance) * height;
        let (Some(first), Some(last), false) = (samples.0.first(), samples.0.last(), kept) else {
            return found;
        };
        let band = (first.frequency_hz, last.frequency_hz);
        let all: Vec<f64> = samples.0.iter().map(|sample| sample.frequency_hz).collect();
        found = find_peak(band, &all, envelope, settings, &mut evaluate);
    }
    found
}

/// The highest of the `tops` with the harmonics of `solver`; the work done where one of them that may be it is lost.
fn highest(
    mut solver: impl PointSource,
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
    let mut searched = Vec::new();
    for top in tops {
        let lower =
            |height: f64| best.is_some_and(|(highest, ..)| height * (1.0 + MADE_UP) < highest);
        if best.is_some_and(|(.., grown)| lower(top.amplitude_m * grown)) {
            continue;
        }
        let there = solver
            .amplitudes_at(top.frequency_hz)
            .ok_or(solver.work())?;
        if lower(there.into_iter().fold(0.0, f64::max)) {
            continue;
        }
        let reach = NEIGHBOURS * top.half_bandwidth_hz;
        let band = (top.frequency_hz - reach, top.frequency_hz + reach);
        let found = find_peak(band, &[top.frequency_hz], envelope, settings, |hz| {
            solver.amplitudes_at(hz)
        });
        let Some(sample) = summit_of(&found) else {
            return Err(solver.work());
        };
        if best.is_none_or(|(height, ..)| sample.largest > height) {
            let grown = sample.largest / top.amplitude_m;
            best = Some((sample.largest, sample.frequency_hz, grown));
        }
        searched.push(found);
    }
    let (height, frequency_hz, _) = best.ok_or(solver.work())?;
    let mut point = finished(&mut solver, frequency_hz)?;
    // What was found stays as it is unless something higher is seen beside it.
    solver.set_precision(REFINED_PRECISION * tolerance);
    let mut highest = (height, None);
    for found in searched {
        if summit_of(&found).is_none_or(|summit| summit.largest < (1.0 - HUMP) * height) {
            continue;
        }
        let looked = looked_into(found, envelope, settings, |hz| solver.amplitudes_at(hz));
        let sample = summit_of(&looked).ok_or(solver.work())?;
        if sample.largest > highest.0 {
            highest = (sample.largest, Some(sample.frequency_hz));
        }
    }
    if let Some(frequency_hz) = highest.1 {
        point = finished(&mut solver, frequency_hz)?;
    }
    Ok(Peak {
        status: Status::Ok,
        blade: point.largest_blade(),
        mean_friction_n: solver.mean_friction_n(&point),
        point: Some(point),
        bracketed: true,
        work: solver.work(),
    })
}
