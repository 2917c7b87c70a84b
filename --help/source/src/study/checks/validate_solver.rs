//! The checks of `[solver]`: harmonics, samples, tolerances and band.

use super::check::Check;
use crate::response::forced_response::{FrequencyBand, Harmonics, SearchHarmonics, SolverOptions};
use crate::study::raw::{RawBand, RawHarmonics, RawSolver};

/// Highest harmonic accepted.
const MAX_HARMONIC: u32 = 100;

/// The settings of the solution, defaults filled in.
pub(super) fn solver(check: &mut Check, raw: RawSolver) -> SolverOptions {
    let default = SolverOptions::default();
    let harmonics = harmonics(check, raw.harmonics);
    let highest = match &harmonics {
        Harmonics::Set(set) => set.last().copied().unwrap_or(1) as usize,
        Harmonics::Auto => 3,
    };
    let samples = raw.samples_per_period.unwrap_or(default.samples_per_period);
    let residual = raw.residual_tolerance.unwrap_or(default.residual_tolerance);
    let peak = raw.peak_tolerance.unwrap_or(default.peak_tolerance);
    let instants = raw.time_samples.unwrap_or(default.time_samples);
    let left_out = raw.harmonic_tolerance.unwrap_or(default.harmonic_tolerance);
    SolverOptions {
        residual_is_stated: raw.residual_tolerance.is_some(),
        search_harmonics: search_harmonics(check, raw.search_harmonics),
        harmonic_tolerance: check.within(
            "solver.harmonic_tolerance",
            left_out,
            (1e-6..=1.0).contains(&left_out),
            "a number from 1e-6 to 1",
        ),
        rows_beyond_tolerance: raw
            .rows_beyond_tolerance
            .unwrap_or(default.rows_beyond_tolerance),
        samples_per_period: check.within(
            "solver.samples_per_period",
            samples,
            samples >= 16.max(4 * highest) && samples <= 65_536,
            &format!(
                "a whole number from {} (16, and 4 per period of the highest harmonic) to 65536",
                16.max(4 * highest)
            ),
        ),
        residual_tolerance: check.within(
            "solver.residual_tolerance",
            residual,
            (1e-13..=1e-2).contains(&residual),
            "a number from 1e-13 to 1e-2",
        ),
        peak_tolerance: check.within(
            "solver.peak_tolerance",
            peak,
            (1e-10..=0.1).contains(&peak),
            "a number from 1e-10 to 0.1",
        ),
        amplitude: raw.amplitude.unwrap_or(default.amplitude),
        time_samples: check.within(
            "solver.time_samples",
            instants,
            (16..=65_536).contains(&instants),
            "a whole number from 16 to 65536",
        ),
        frequency_band: band(check, raw.frequency_band_hz),
        harmonics,
    }
}

fn harmonics(check: &mut Check, raw: Option<RawHarmonics>) -> Harmonics {
    match raw {
        None => Harmonics::Auto,
        Some(RawHarmonics::Name(name)) if name == "auto" => Harmonics::Auto,
        Some(RawHarmonics::List(set)) if is_set(&set) => Harmonics::Set(set),
        Some(_) => {
            check.refuse(
                "solver.harmonics",
                "\"auto\" or an ascending list of harmonics from 0 to 100 that contains 1, like [1, 3]",
            );
            Harmonics::Auto
        }
    }
}

fn search_harmonics(check: &mut Check, raw: Option<RawHarmonics>) -> SearchHarmonics {
    match raw {
        None => SearchHarmonics::Auto,
        Some(RawHarmonics::Name(name)) if name == "auto" => SearchHarmonics::Auto,
        Some(RawHarmonics::Name(name)) if name == "all" => SearchHarmonics::All,
        Some(RawHarmonics::List(set)) if is_set(&set) => SearchHarmonics::Set(set),
        Some(_) => {
            check.refuse(
                "solver.search_harmonics",
                "\"auto\", \"all\" or an ascending list of harmonics from 0 to 100 that contains 1, like [1, 3]",
            );
            SearchHarmonics::Auto
        }
    }
}

/// Whether harmonics are a set that has the fundamental.
fn is_set(harmonics: &[u32]) -> bool {
    harmonics.contains(&1)
        && harmonics.is_sorted_by(|a, b| a < b)
        && harmonics.last() <= Some(&MAX_HARMONIC)
}

fn band(check: &mut Check, raw: Option<RawBand>) -> FrequencyBand {
    match raw {
        None => FrequencyBand::Auto,
        Some(RawBand::Name(name)) if name == "auto" => FrequencyBand::Auto,
        Some(RawBand::List(ends))
            if ends.len() == 2 && ends[0] > 0.0 && ends[0] < ends[1] && ends[1].is_finite() =>
        {
            FrequencyBand::Fixed {
                start_hz: ends[0],
                stop_hz: ends[1],
            }
        }
        Some(_) => {
            check.refuse(
                "solver.frequency_band_hz",
                "\"auto\" or two ascending frequencies above 0 in Hz, like [540.0, 580.0]",
            );
            FrequencyBand::Auto
        }
    }
}
