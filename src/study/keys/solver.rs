//! The keys of a study file that say how rows are solved, when a study ends and what it writes.

use super::options_table::options_table;
use super::ranges::ABOVE_ZERO;
use crate::input::Value::{self, Ascending, Either, Flag, Name, Number, Whole};
use crate::input::{REQUIRED, Range, key, toml_table};
use crate::population::statistics::Quantity;
use crate::population::table::Compression;
use crate::response::forced_response::{
    AmplitudeMeasure, FrequencyBand, Harmonics, RowsBeyondTolerance, SearchHarmonics, SolverOptions,
};
use crate::response::receptance::HIGHEST_HARMONIC;
use crate::study::{AccuracyOptions, OutputOptions};

/// A harmonic of a solution.
const HARMONIC: Value = Whole(0, HIGHEST_HARMONIC as i64);

options_table! {
    /// `[solver]`.
    pub(in crate::study) struct SolverTable of SolverOptions {
        harmonics: Harmonics = key(Either(&[Name(&["auto"]), Ascending(&HARMONIC, None)]), "`\"auto\"`",
            "`auto`: 0 to 15, on a basis per engine order and load by the tuned full contact model ([formulation.md](formulation.md)); a list has 1 among them")
            .of_accuracy().told("\"auto\" or an ascending list of harmonics from 0 to 100 that contains 1, like [1, 3]"),
        search_harmonics: SearchHarmonics = key(Either(&[Name(&["auto", "all"]), Ascending(&HARMONIC, None)]), "`\"auto\"`",
            "local maxima of the response are located with these, then solved with `harmonics` ([formulation.md](formulation.md)); `auto`: 1, or `harmonics` where a set is stated and the contact of a wheel of few masses has few unknowns; `all`: located with `harmonics`, as always with a creeping ring")
            .of_accuracy().told("\"auto\", \"all\" or an ascending list of harmonics from 0 to 100 that contains 1, like [1, 3]"),
        harmonic_tolerance: f64 = key(Number(Range::from_to(1e-6, 1.0)), "0.02",
            "wanted relative error of the amplitude by the harmonics left out; on a basis `auto` chooses by it; rows beyond it are marked")
            .of_accuracy(),
        rows_beyond_tolerance: RowsBeyondTolerance = key(Name(&["flag", "resolve"]), "`\"flag\"`",
            "`resolve`: with automatic harmonics on a basis, such rows are solved again with the set of a quarter of the tolerance")
            .of_accuracy(),
        samples_per_period: usize = key(Whole(16, 65_536), "128",
            "at least 4 times the highest harmonic; an automatic set takes at least 12 per period of its highest harmonic")
            .of_accuracy(),
        residual_tolerance: f64 = key(Number(Range::from_to(1e-13, 1e-2)), "1e-8",
            "when the iteration for a solution ends: the part of the force that is still out of balance, relative to the excitation. A smaller number takes longer and gives more digits; change it to compare with another program. Where nothing is said, peaks with automatic harmonics on tuned receptances are solved to a tenth of `peak_tolerance`")
            .of_accuracy().told("a number from 1e-13 to 1e-2"),
        peak_tolerance: f64 = key(Number(Range::from_to(1e-10, 0.1)), "1e-3",
            "relative, of the peak amplitude").of_accuracy(),
        amplitude: AmplitudeMeasure = key(Name(&["fundamental", "time_maximum"]), "`\"fundamental\"`",
            "`fundamental`: norm over r, theta, z of the complex amplitude of harmonic 1; `time_maximum`: largest norm over a period, harmonic 0 left out"),
        time_samples: usize = key(Whole(16, 65_536), "1024", "instants for `time_maximum`"),
        frequency_band_hz as frequency_band: FrequencyBand = key(Either(&[Name(&["auto"]), Ascending(&ABOVE_ZERO, Some(2))]), "`\"auto\"`",
            "where peaks are sought, Hz")
            .told("\"auto\" or two ascending frequencies above 0 in Hz, like [540.0, 580.0]"),
    }
}

options_table! {
    /// `[accuracy]`.
    pub(in crate::study) struct AccuracyTable of AccuracyOptions {
        amplitude_error: f64 = key(Number(AccuracyOptions::ACCEPTED), "0.01",
            "relative error of the peak amplitude that 95 % of the rows are to keep")
            .and(", relative error of the peak amplitude"),
    }
}

toml_table! {
    /// `[stop]`.
    pub(in crate::study) struct StopTable {
        percentile: f64 = key(Number(Range::above(0.0).below(100.0)), REQUIRED,
            "in percent; `study.patterns` must allow it an interval (72 for 95, 368 for 99)")
            .and(", in percent"),
        relative_width: f64 = key(Number(Range::above(0.0).up_to(1.0)), REQUIRED,
            "width of the interval over the percentile").and(": width of the interval over the percentile"),
        quantity: Quantity = key(Name(&["peak_amplitude_m", "amplification_factor"]), "`\"peak_amplitude_m\"`", ""),
    }
}

options_table! {
    /// `[output]`.
    pub(in crate::study) struct OutputTable of OutputOptions {
        patterns: Option<bool> = key(Flag, "true up to 10,000 patterns",
            "whether `patterns.parquet` is written").or_null(),
        compression: Compression = key(Name(&["zstd", "snappy"]), "`\"zstd\"`", ""),
        stress_pa_per_m: Option<f64> = key(ABOVE_ZERO, "none",
            "stress per amplitude of the observed node, Pa/m: amplitudes are told as stress too")
            .and(", in Pa/m"),
        stability: u32 = key(Whole(0, 1000), "0",
            "rows nearest to P5, P50, P95 and P99 of the amplitude of every scenario whose motions, and those of the tuned wheel, are looked at for their stability; seconds each ([formulation.md](formulation.md))"),
    }
}
