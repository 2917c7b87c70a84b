//! The peak of a row: band, starting points, search, and what was found.

use super::excited::Excited;
use super::folded_peak::falls_off;
use super::options::{ContactCondition, FrequencyBand};
use super::point::{Point, Work};
use super::point_settings::PointSettings;
use super::point_solver::PointSolver;
use super::point_source::{PointSource, Watched};
use super::search::Sample;
use super::search::{Envelope, SearchSettings};
use super::search::{SearchEnd, SearchResult, find_peak};
use crate::response::harmonic_balance::Status;
use crate::response::receptance::{Resonance, reach_of_mistuning, resonances_that_count};

/// Tolerance of peaks of linear limits, which cost almost nothing.
const LINEAR_PEAK_TOLERANCE: f64 = 4e-11;
/// Largest number of points of one row.
pub(super) const EVALUATIONS: usize = 1500;
/// Precision of the amplitudes that the search compares, over its tolerance: far below the share of it that a
/// summit may be missed by.
pub(super) const SEARCH_PRECISION: f64 = 0.01;
/// Starting points between the dominant stuck and slide peaks.
const STARTS_BETWEEN: usize = 5;
/// Times the automatic band is widened while the largest value lies at its end.
const BAND_EXTENSIONS: usize = 5;

/// What was found of one row.
#[derive(Debug, Clone, PartialEq)]
pub struct Peak {
    /// How the search ended.
    pub status: Status,
    /// The point of the largest amplitude; none if no point converged.
    pub point: Option<Point>,
    /// Blade of the largest amplitude.
    pub blade: usize,
    /// Whether lower amplitudes were seen on both sides.
    pub bracketed: bool,
    /// Mean friction force on the ring along theta and z at the point, N per sector; none for a
    /// linear limit.
    pub mean_friction_n: Option<[f64; 2]>,
    /// Work done.
    pub work: Work,
}

impl Peak {
    /// No peak, and why.
    pub(super) fn without(status: Status, work: Work) -> Self {
        Self {
            status,
            point: None,
            blade: 0,
            bracketed: false,
            mean_friction_n: None,
            work,
        }
    }

    /// Largest amplitude, m; none unless the search succeeded.
    #[must_use]
    pub fn amplitude_m(&self) -> Option<f64> {
        (self.status == Status::Ok).then_some(())?;
        Some(self.point.as_ref()?.amplitudes_m[self.blade])
    }
}

/// Where the peak of a row is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Frequencies to look for linear resonances in, Hz; none = anywhere.
    pub resonances_hz: Option<(f64, f64)>,
    /// Band asked for.
    pub band: FrequencyBand,
}

/// Frequencies, Hz, between which the tuned wheel answers an excitation: from the lowest to the
/// highest resonance that counts under any linear limit bounding the condition, and the tuned
/// peak itself where it is known. None if nothing answers.
#[must_use]
pub fn tuned_span(
    excited: &Excited,
    condition: ContactCondition,
    tuned_peak_hz: Option<f64>,
) -> Option<(f64, f64)> {
    tuned_span_of(&excited.linear_peaks(condition), tuned_peak_hz)
}

/// [`tuned_span`] from the resonances of the linear limits.
#[must_use]
pub fn tuned_span_of(limits: &[Vec<Resonance>], tuned_peak_hz: Option<f64>) -> Option<(f64, f64)> {
    limits
        .iter()
        .flat_map(|limit| resonances_that_count(limit))
        .map(|peak| peak.frequency_hz)
        .chain(tuned_peak_hz)
        .fold(None, |span: Option<(f64, f64)>, f| {
            let (low, high) = span.unwrap_or((f, f));
            Some((low.min(f), high.max(f)))
        })
}

/// Window of a mistuned wheel: resonances within [`reach_of_mistuning`] of where the tuned wheel answers.
#[must_use]
pub fn mistuned_window(span_hz: (f64, f64), largest_deviation: f64, band: FrequencyBand) -> Window {
    let reach = reach_of_mistuning(largest_deviation);
    Window {
        resonances_hz: Some((span_hz.0 * (1.0 - reach), span_hz.1 * (1.0 + reach))),
        band,
    }
}

/// Where the linear limits of a row say that its peak can lie, and how wide a peak is there.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchPlan {
    /// Band, Hz.
    pub band_hz: (f64, f64),
    /// First frequencies to try, Hz.
    pub starts_hz: Vec<f64>,
    /// Resonances of the stuck limit, or of the limit itself, in the band and within its width of it.
    pub stuck: Vec<Resonance>,
    /// Least width of a peak.
    pub envelope: Envelope,
    /// Times the band may be widened while the largest value lies at its end.
    pub extensions: usize,
}

/// The plan of the search for one row, from the resonances of its linear limits.
///
/// # Errors
/// A resonance is not finite, or nothing answers the excitation.
pub fn search_plan(
    excited: &Excited,
    condition: ContactCondition,
    window: Window,
) -> Result<SearchPlan, Status> {
    search_plan_of(&excited.linear_peaks(condition), window)
}

/// [`search_plan`] from the resonances of the linear limits that bound the condition, the stuck one first.
///
/// # Errors
/// A resonance is not finite, or nothing answers the excitation.
pub(super) fn search_plan_of(
    limits: &[Vec<Resonance>],
    window: Window,
) -> Result<SearchPlan, Status> {
    let limits = within(limits, window);
    let candidates: Vec<Resonance> = limits
        .iter()
        .flat_map(|limit| resonances_that_count(limit))
        .collect();
    if candidates.iter().any(|peak| !peak.amplitude_m.is_finite()) {
        return Err(Status::NonFinite);
    }
    if candidates.is_empty() {
        return Err(Status::NotBracketed);
    }
    let (band_hz, extensions) = match window.band {
        FrequencyBand::Fixed { start_hz, stop_hz } => ((start_hz, stop_hz), 0),
        FrequencyBand::Auto => (band_of(&candidates), BAND_EXTENSIONS),
    };
    let envelope = Envelope {
        strength: candidates
            .iter()
            .map(|peak| peak.amplitude_m * peak.half_bandwidth_hz)
            .fold(0.0, f64::max),
        linear_half_bandwidth_hz: candidates
            .iter()
            .map(|peak| peak.half_bandwidth_hz)
            .fold(f64::INFINITY, f64::min),
    };
    Ok(SearchPlan {
        stuck: near_band(limits.first().map_or(&[], Vec::as_slice), band_hz),
        band_hz,
        starts_hz: starting_points(&limits, &candidates),
        envelope,
        extensions,
    })
}

/// Finds the peak of one row.
#[must_use]
pub fn peak(
    excited: &Excited,
    condition: ContactCondition,
    settings: &PointSettings,
    window: Window,
    peak_tolerance: f64,
) -> Peak {
    let plan = match search_plan(excited, condition, window) {
        Ok(plan) => plan,
        Err(status) => {
            return Peak::without(status, Work::default());
        }
    };
    let mut solver = PointSolver::new(excited, condition, settings);
    let (found, search) = peak_by(&plan, condition, &mut solver, peak_tolerance);
    // Contacts that open can fold the curve; where they do, the samples fall off a cliff.
    let cliff = search
        .best
        .is_some_and(|best| falls_off(&search.samples, best, plan.envelope));
    let top = { found.point.as_ref() }.filter(|_| cliff && found.status == Status::Ok);
    let Some(point) = top.cloned() else {
        return found;
    };
    let tolerance = search_tolerance(condition, peak_tolerance);
    let (status, point) = match solver.over_folds(&point, tolerance, plan.extensions > 0) {
        Ok(higher) => (Status::Ok, higher.unwrap_or(point)),
        Err(status) => (status, point),
    };
    peak_at(Some(point), status, found.bracketed, &mut solver)
}

/// Relative tolerance of the search for a peak.
fn search_tolerance(condition: ContactCondition, peak_tolerance: f64) -> f64 {
    match condition {
        ContactCondition::Full { .. } => peak_tolerance,
        _ => LINEAR_PEAK_TOLERANCE,
    }
}

/// The peak at a point of `solver`.
fn peak_at(
    point: Option<Point>,
    status: Status,
    bracketed: bool,
    solver: &mut impl PointSource,
) -> Peak {
    let mean_friction_n = point
        .as_ref()
        .and_then(|point| solver.mean_friction_n(point));
    Peak {
        status,
        blade: point.as_ref().map_or(0, Point::largest_blade),
        point,
        bracketed,
        mean_friction_n,
        work: solver.work(),
    }
}

/// How a search ended, and the point of its highest sample, solved to its end.
fn settled(result: &SearchResult, solver: &mut impl PointSource) -> (Status, Option<Point>) {
    let best = result.best.map(|best| &result.samples[best]);
    let (point, unfinished) = match best.map(|best| solver.finished(best.frequency_hz)) {
        Some(Ok(point)) => (Some(point), None),
        Some(Err(status)) => (None, Some(status)),
        None => (None, None),
    };
    let status = match result.end {
        SearchEnd::Found if result.bracketed => unfinished.unwrap_or(Status::Ok),
        SearchEnd::Found | SearchEnd::Open => {
            failure_beyond(solver, best).unwrap_or(Status::NotBracketed)
        }
        SearchEnd::Exhausted => Status::WorkBudget,
        SearchEnd::Incomplete => solver
            .failures()
            .last()
            .map_or(Status::SweepIncomplete, |&(_, status)| status),
    };
    (status, point)
}

/// The peak by `plan` with the points of `solver`, and the search that found it.
pub(super) fn peak_by(
    plan: &SearchPlan,
    condition: ContactCondition,
    solver: &mut impl PointSource,
    peak_tolerance: f64,
) -> (Peak, SearchResult) {
    let search = SearchSettings {
        tolerance: search_tolerance(condition, peak_tolerance),
        evaluations: EVALUATIONS,
        extensions: plan.extensions,
        rivals_from: 1.0,
    };
    solver.set_precision(SEARCH_PRECISION * search.tolerance);
    let watched = Watched {
        solver,
        stuck: &plan.stuck,
    };
    let result = find_peak(
        plan.band_hz,
        &plan.starts_hz,
        plan.envelope,
        search,
        watched,
    );
    let (status, point) = settled(&result, solver);
    let peak = peak_at(point, status, result.bracketed, solver);
    (peak, result)
}

/// Status of the failed frequency nearest to the best point, among those with no lower amplitude
/// known between: the curve may well have turned there. None if the search only ran out of band.
fn failure_beyond(solver: &impl PointSource, best: Option<&Sample>) -> Option<Status> {
    let at = best?.frequency_hz;
    let lower = |side: f64| {
        solver
            .points()
            .iter()
            .map(|point| side * (point.frequency_hz - at))
            .filter(|distance| *distance > 0.0)
            .fold(f64::INFINITY, f64::min)
    };
    let nearest = [lower(-1.0), lower(1.0)];
    solver
        .failures()
        .iter()
        .filter(|(hz, _)| (hz - at).abs() < nearest[usize::from(*hz > at)])
        .min_by(|a, b| (a.0 - at).abs().total_cmp(&(b.0 - at).abs()))
        .map(|&(_, status)| status)
}

/// Resonances of each limit inside the window, or all of them where none of a limit is: a
/// nonlinear peak lies between those of its limits, which may both be outside of a fixed band.
fn within(limits: &[Vec<Resonance>], window: Window) -> Vec<Vec<Resonance>> {
    let (low, high) = match (window.band, window.resonances_hz) {
        (FrequencyBand::Fixed { start_hz, stop_hz }, _) => (start_hz, stop_hz),
        (FrequencyBand::Auto, Some(range)) => range,
        (FrequencyBand::Auto, None) => (0.0, f64::INFINITY),
    };
    limits
        .iter()
        .map(|limit| {
            let inside: Vec<Resonance> = limit
                .iter()
                .copied()
                .filter(|peak| peak.frequency_hz >= low && peak.frequency_hz <= high)
                .collect();
            if resonances_that_count(&inside).is_empty() {
                limit.clone()
            } else {
                inside
            }
        })
        .collect()
}

/// The resonances in a band and within its width of it: another family further away is a peak of its own.
fn near_band(resonances: &[Resonance], (low, high): (f64, f64)) -> Vec<Resonance> {
    let width = high - low;
    let is_near =
        |peak: &&Resonance| peak.frequency_hz > low - width && peak.frequency_hz < high + width;
    resonances.iter().filter(is_near).copied().collect()
}

/// From the lowest to the highest candidate, widened by 1 % and 10 half-bandwidths.
fn band_of(candidates: &[Resonance]) -> (f64, f64) {
    candidates
        .iter()
        .fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), peak| {
            let margin = 0.01 * peak.frequency_hz + 10.0 * peak.half_bandwidth_hz;
            (
                low.min((peak.frequency_hz - margin).max(0.1 * peak.frequency_hz)),
                high.max(peak.frequency_hz + margin),
            )
        })
}

/// Every candidate resonance, and points between the dominant ones of the limits.
fn starting_points(limits: &[Vec<Resonance>], candidates: &[Resonance]) -> Vec<f64> {
    let mut starts: Vec<f64> = candidates.iter().map(|peak| peak.frequency_hz).collect();
    let dominant: Vec<f64> = limits
        .iter()
        .filter_map(|peaks| {
            peaks
                .iter()
                .max_by(|a, b| a.amplitude_m.total_cmp(&b.amplitude_m))
        })
        .map(|peak| peak.frequency_hz)
        .collect();
    if let [first, second] = dominant[..] {
        for i in 1..=STARTS_BETWEEN {
            let share = i as f64 / (STARTS_BETWEEN + 1) as f64;
            starts.push(first + share * (second - first));
        }
    }
    starts
}
