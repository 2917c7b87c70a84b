//! The peak of a row on the full-contact model, sought on its own from a coarse scan and from where
//! the fast path found it.

use super::{ReferenceSolver, ReferenceWork};
use crate::response::forced_response::{SearchEnd, SearchPlan, SearchSettings, find_peak};
use crate::response::harmonic_balance::{ContactShares, Status};

/// Equally spaced frequencies of the coarse scan, the ends of the band besides.
const SCAN: usize = 11;
/// Distance of the first frequencies from the expected peak, in half-bandwidths of the narrowest
/// linear resonance.
const ASIDE: f64 = 0.4;
/// Tolerance of the search over that of the peak: where pairs begin to slip the curve is no parabola,
/// and a search to 1e-4 was seen to stop 1.7e-4 below the peak.
const MARGIN: f64 = 0.25;
/// Largest number of frequencies of one row.
const EVALUATIONS: usize = 400;

/// Peak of a row on the full-contact model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReferencePeak {
    /// How the search ended; values are none unless it is [`Status::Ok`].
    pub status: Status,
    /// Largest amplitude over blades and frequency, m.
    pub amplitude_m: Option<f64>,
    /// Frequency of the largest amplitude, Hz.
    pub frequency_hz: Option<f64>,
    /// Blade of the largest amplitude.
    pub blade: Option<u32>,
    /// Residual force relative to the excitation there.
    pub residual: Option<f64>,
    /// Shares of slipping and separated pairs there.
    pub shares: Option<ContactShares>,
    /// Work done.
    pub work: ReferenceWork,
}

impl ReferencePeak {
    /// A row without a peak.
    #[must_use]
    pub fn failed(status: Status) -> Self {
        Self {
            status,
            amplitude_m: None,
            frequency_hz: None,
            blade: None,
            residual: None,
            shares: None,
            work: ReferenceWork::default(),
        }
    }
}

/// Finds the highest peak in the band of `plan`, with the evidence of [`find_peak`]: lower values on
/// both sides, and no interval left in which a resonance as wide as `plan.envelope` says could be
/// higher.
///
/// The first frequencies are a coarse scan of the band and, where given, either side of
/// `expected_hz`, never that itself: the peak is to be found, not confirmed. Those at which the
/// linear limits resonate only fix the band.
pub fn reference_peak(
    solver: &mut ReferenceSolver,
    plan: &SearchPlan,
    expected_hz: Option<f64>,
) -> ReferencePeak {
    let (low, high) = plan.band_hz;
    let scan = (1..=SCAN).map(|i| low + (high - low) * i as f64 / (SCAN + 1) as f64);
    let aside = ASIDE * plan.envelope.linear_half_bandwidth_hz;
    let beside = expected_hz.into_iter().flat_map(|f| [f - aside, f + aside]);
    let starts: Vec<f64> = beside.chain(scan).collect();
    let settings = SearchSettings {
        tolerance: MARGIN * solver.settings().peak_tolerance,
        evaluations: EVALUATIONS,
        extensions: plan.extensions,
        rivals_from: 1.0,
    };
    let result = find_peak(
        plan.band_hz,
        &starts,
        plan.envelope,
        settings,
        |frequency| {
            let point = solver.solve(frequency).ok();
            point.map(|point| point.amplitudes_m.clone())
        },
    );
    let status = match result.end {
        SearchEnd::Found if result.bracketed => Status::Ok,
        SearchEnd::Found | SearchEnd::Open => Status::NotBracketed,
        SearchEnd::Exhausted => Status::WorkBudget,
        SearchEnd::Incomplete => {
            let last = solver.failures().last();
            last.map_or(Status::SweepIncomplete, |&(_, status)| status)
        }
    };
    let found = result
        .best
        .filter(|_| status == Status::Ok)
        .and_then(|best| {
            let sample = &result.samples[best];
            let same = |f: f64| f.total_cmp(&sample.frequency_hz).is_eq();
            let mut points = solver.points().iter();
            Some((sample, points.find(|point| same(point.frequency_hz))?))
        });
    ReferencePeak {
        status,
        amplitude_m: found.map(|(sample, _)| sample.largest),
        frequency_hz: found.map(|(sample, _)| sample.frequency_hz),
        blade: found.map(|(sample, _)| sample.blade as u32),
        residual: found.map(|(_, point)| point.residual),
        shares: found.map(|(_, point)| point.shares),
        work: solver.work(),
    }
}
