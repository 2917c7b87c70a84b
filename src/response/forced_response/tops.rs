//! The tops that few harmonics find over a band, and what is shared by the ways to solve them with more.

use super::peak::{EVALUATIONS, Peak, SEARCH_PRECISION, SearchPlan};
use super::point::Work;
use super::point_source::{PointSource, Watched};
use super::search::summit;
use super::search::{Envelope, SearchSettings};
use super::search::{Sample, Samples};
use super::search::{SearchEnd, SearchResult, find_peak};

/// Least tolerance of the first search: what it finds is only where to look.
const COARSE_TOLERANCE: f64 = 0.02;
/// Share that harmonics may change the height of one top more than that of another.
pub(super) const MADE_UP: f64 = 0.05;
/// First neighbours of a top, in half-bandwidths: the distance at which a parabola is trusted at 0.5 %.
pub(super) const NEIGHBOURS: f64 = 0.35;
/// Points of one top at most.
pub(super) const POINTS_OF_TOP: usize = 40;
/// Times that a top may be followed beyond its neighbours.
pub(super) const EXTENSIONS: usize = 12;
/// Share of the height that a hump may add to a top: what is lower by more is not looked into.
pub(super) const HUMP: f64 = 0.01;

/// A local maximum of the first search.
pub(super) struct Top {
    pub(super) frequency_hz: f64,
    pub(super) amplitude_m: f64,
    pub(super) half_bandwidth_hz: f64,
}

/// The tops that `few` harmonics find by `plan`, the highest first, among them all that are lower than the highest by no more than
/// `made_up`; the work done where they find no peak.
pub(super) fn tops_of_few(
    plan: &SearchPlan,
    few: &mut impl PointSource,
    peak_tolerance: f64,
    made_up: f64,
) -> Result<Vec<Top>, Work> {
    let coarse_tolerance = peak_tolerance.max(COARSE_TOLERANCE);
    few.set_precision(SEARCH_PRECISION * coarse_tolerance);
    let found = find_peak(
        plan.band_hz,
        &plan.starts_hz,
        plan.envelope,
        SearchSettings {
            tolerance: coarse_tolerance,
            evaluations: EVALUATIONS,
            extensions: plan.extensions,
            rivals_from: 1.0 - made_up,
        },
        Watched {
            solver: few,
            stuck: &plan.stuck,
        },
    );
    if found.end != SearchEnd::Found || !found.bracketed {
        return Err(few.work());
    }
    Ok(tops(&found, plan.envelope, plan.extensions > 0))
}

/// The peak, unless a band that is asked for ends there: it has no peak beyond its ends.
pub(super) fn inside_of_band(plan: &SearchPlan, refined: Peak) -> Result<Peak, Work> {
    let hz = refined.point.as_ref().map(|point| point.frequency_hz);
    let inside = hz.is_some_and(|hz| plan.band_hz.0 < hz && hz < plan.band_hz.1);
    if plan.extensions > 0 || inside {
        Ok(refined)
    } else {
        Err(refined.work)
    }
}

/// A peak that took other work besides.
pub(super) fn with_work(peak: Peak, work: Work) -> Peak {
    Peak {
        work: peak.work.plus(work),
        ..peak
    }
}

/// The local maxima of a search, the highest first; with the samples at its ends, where it may go beyond them: a resonance outside of the
/// band has a sample on one side alone.
fn tops(found: &SearchResult, envelope: Envelope, with_ends: bool) -> Vec<Top> {
    let samples = Samples(found.samples.clone());
    let at_end = |at: usize| -> Option<Top> {
        let sample = &samples.0[at];
        let beside = samples.0.get(if at == 0 { 1 } else { at - 1 })?;
        (with_ends && sample.largest > beside.largest).then_some(Top {
            frequency_hz: sample.frequency_hz,
            amplitude_m: sample.largest,
            half_bandwidth_hz: envelope.linear_half_bandwidth_hz,
        })
    };
    let ends = [0, samples.0.len().saturating_sub(1)];
    let ends = ends.into_iter().filter(|_| samples.0.len() > 1);
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
        .chain(ends.filter_map(at_end))
        .collect();
    tops.sort_by(|a, b| b.amplitude_m.total_cmp(&a.amplitude_m));
    tops
}

/// The highest sample of a search that found a peak.
pub(super) fn summit_of(found: &SearchResult) -> Option<&Sample> {
    let sample = found.best.map(|best| &found.samples[best]);
    sample.filter(|_| found.end == SearchEnd::Found && found.bracketed)
}
