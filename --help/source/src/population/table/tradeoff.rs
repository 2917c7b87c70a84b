//! `tradeoff.parquet`, `tradeoff_rows.parquet` and `tradeoff_times.parquet`: what settings cost and how far
//! their rows are from a reference.

use std::path::Path;

use serde::Serialize;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::parquet::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{RowWork, Scenario};
use crate::population::statistics::ErrorBound;

use ColumnKind::{Boolean, Float64, Int32, Int64, String as Text};

/// Accepted amplitude errors for which the cheapest setting is marked.
pub const TRADEOFF_TARGETS: [f64; 3] = [0.01, 0.003, 0.001];

/// One setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TradeoffRecord {
    /// Number of the setting, from 0.
    pub setting: u32,
    /// `reference`, `base`, `knob` or `combination`.
    pub role: &'static str,
    /// The knob that alone differs from the base.
    pub knob: Option<&'static str>,
    /// Reduction basis.
    pub basis: String,
    /// Harmonics: a set, or `auto` with its tolerance.
    pub harmonics: String,
    /// Wheel of the harmonics other than 1: always the mistuned one.
    pub higher_harmonics: &'static str,
    /// Samples per period.
    pub samples_per_period: u32,
    /// Bound on the residual.
    pub residual_tolerance: f64,
    /// Tolerance of the peak.
    pub peak_tolerance: f64,
    /// Contact law.
    pub contact_law: &'static str,
    /// Projection of the mistuning.
    pub projection: &'static str,
    /// Errors of the peak amplitude.
    pub amplitude: Option<ErrorBound>,
    /// What the worst error of the amplitude over all rows is claimed to be at most.
    pub amplitude_worst_upper: Option<f64>,
    /// Errors of the frequency of the peak.
    pub frequency: Option<ErrorBound>,
    /// Errors of the amplification factor.
    pub amplification_factor: Option<ErrorBound>,
    /// Errors of the amplitude by this knob alone, against its best level on the base.
    pub knob_amplitude: Option<ErrorBound>,
    /// Largest relative error of the P95 of the amplitude over the scenarios; none where the sample is
    /// too small for it.
    pub amplitude_p95_error: Option<f64>,
    /// Largest relative error of the P99 of the amplitude over the scenarios; none where the sample is too
    /// small for it.
    pub amplitude_p99_error: Option<f64>,
    /// Mean work counts of a row.
    pub work: RowWork,
    /// Most real unknowns.
    pub unknowns: u32,
    /// Mean estimated floating-point operations of a row.
    pub operations: f64,
    /// Whether no other setting is both cheaper and more accurate.
    pub on_front: bool,
    /// Whether it is the cheapest for each of [`TRADEOFF_TARGETS`].
    pub chosen: [bool; 3],
    /// Mean processor time of a row, s; not the same twice.
    pub cpu_s: f64,
}

/// One row at one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeoffRow {
    /// Number of the setting.
    pub setting: u32,
    /// Scenario of the study.
    pub scenario: Scenario,
    /// Pattern.
    pub pattern: u32,
    /// How the solution ended.
    pub status: &'static str,
    /// Harmonic set.
    pub harmonics: String,
    /// Amplitude, m, frequency, Hz, and amplification factor.
    pub values: [Option<f64>; 3],
    /// Amplitude, m, frequency, Hz, and amplification factor of the reference.
    pub reference: [Option<f64>; 3],
    /// Work counts.
    pub work: RowWork,
    /// Estimated floating-point operations.
    pub operations: f64,
}

const SETTING: ColumnSpec = ColumnSpec::new(
    "setting",
    Int32,
    "",
    "Number of the setting, from 0, the same in all tables of the trade-off",
);

/// Columns of `tradeoff.parquet`.
pub const TRADEOFF_COLUMNS: &[ColumnSpec] = &[
    SETTING,
    ColumnSpec::new(
        "role",
        Text,
        "",
        "reference: the reference or a part of it; base; knob: one knob differs from the base; combination",
    ),
    ColumnSpec::new(
        "knob",
        Text,
        "",
        "The knob that alone differs from the base; null for the base and combinations",
    ),
    ColumnSpec::new("basis", Text, "", "Reduction basis with its modes"),
    ColumnSpec::new(
        "harmonics",
        Text,
        "",
        "Harmonic set, or auto with solver.harmonic_tolerance",
    ),
    ColumnSpec::new(
        "higher_harmonics",
        Text,
        "",
        "Wheel of the harmonics other than 1: always mistuned",
    ),
    ColumnSpec::new(
        "samples_per_period",
        Int32,
        "1",
        "solver.samples_per_period",
    ),
    ColumnSpec::new(
        "residual_tolerance",
        Float64,
        "1",
        "solver.residual_tolerance",
    ),
    ColumnSpec::new("peak_tolerance", Float64, "1", "solver.peak_tolerance"),
    ColumnSpec::new("contact_law", Text, "", "contact.law"),
    ColumnSpec::new("projection", Text, "", "mistuning.projection"),
    ColumnSpec::new(
        "rows_compared",
        Int32,
        "1",
        "Rows compared with the reference",
    ),
    ColumnSpec::new(
        "rows_failed",
        Int32,
        "1",
        "Rows of these without result; their errors count as infinite",
    ),
    ColumnSpec::new(
        "amplitude_error_median",
        Float64,
        "1",
        "Median of the relative error of the peak amplitude",
    ),
    ColumnSpec::new(
        "amplitude_error_p95",
        Float64,
        "1",
        "95th percentile of these errors in the sample",
    ),
    ColumnSpec::new(
        "amplitude_error_p95_upper",
        Float64,
        "1",
        "Upper bound of their 95th percentile over all rows, 95 % confidence",
    ),
    ColumnSpec::new(
        "amplitude_error_worst",
        Float64,
        "1",
        "Largest of these errors",
    ),
    ColumnSpec::new(
        "amplitude_error_worst_upper",
        Float64,
        "1",
        "Upper bound of their 99.9th percentile over all rows, 95 % confidence, with peak_tolerance added",
    ),
    ColumnSpec::new(
        "frequency_error_median",
        Float64,
        "1",
        "Median of the relative error of the peak frequency",
    ),
    ColumnSpec::new(
        "frequency_error_p95",
        Float64,
        "1",
        "95th percentile of these errors in the sample",
    ),
    ColumnSpec::new(
        "frequency_error_worst",
        Float64,
        "1",
        "Largest of these errors",
    ),
    ColumnSpec::new(
        "amplification_factor_error_median",
        Float64,
        "1",
        "Median of the relative error of the amplification factor",
    ),
    ColumnSpec::new(
        "amplification_factor_error_p95",
        Float64,
        "1",
        "95th percentile of these errors in the sample",
    ),
    ColumnSpec::new(
        "amplification_factor_error_worst",
        Float64,
        "1",
        "Largest of these errors",
    ),
    ColumnSpec::new(
        "knob_error_p95",
        Float64,
        "1",
        "95th percentile of the change of the amplitude by this knob alone, against its best level on the base",
    ),
    ColumnSpec::new(
        "amplitude_p95_error",
        Float64,
        "1",
        "Largest relative error of the 95th percentile of the amplitude over the scenarios; null if not estimable",
    ),
    ColumnSpec::new(
        "amplitude_p99_error",
        Float64,
        "1",
        "Largest relative error of the 99th percentile of the amplitude over the scenarios; null if not estimable",
    ),
    ColumnSpec::new(
        "nonlinear_solves_per_row",
        Float64,
        "1",
        "Mean nonlinear solves of a row",
    ),
    ColumnSpec::new(
        "newton_iterations_per_row",
        Float64,
        "1",
        "Mean Newton iterations of a row",
    ),
    ColumnSpec::new(
        "factorisations_per_row",
        Float64,
        "1",
        "Mean factorisations of a row",
    ),
    ColumnSpec::new("unknowns", Int32, "1", "Most real unknowns of a scenario"),
    ColumnSpec::new(
        "operations_per_row",
        Float64,
        "1",
        "Mean floating-point operations of a row, estimated from its work counts",
    ),
    ColumnSpec::new(
        "on_front",
        Boolean,
        "",
        "No other setting takes fewer operations for a smaller amplitude_error_p95_upper",
    ),
    ColumnSpec::new(
        "chosen_1_percent",
        Boolean,
        "",
        "The setting of fewest operations with amplitude_error_p95_upper within 1 %",
    ),
    ColumnSpec::new("chosen_0_3_percent", Boolean, "", "The same within 0.3 %"),
    ColumnSpec::new("chosen_0_1_percent", Boolean, "", "The same within 0.1 %"),
];

/// Columns of `tradeoff_times.parquet`.
pub const TRADEOFF_TIME_COLUMNS: &[ColumnSpec] = &[
    SETTING,
    ColumnSpec::new(
        "cpu_s_per_row",
        Float64,
        "s",
        "Mean processor time of a row on this machine, not the same twice",
    ),
];

/// Columns of `tradeoff_rows.parquet`.
pub const TRADEOFF_ROW_COLUMNS: &[ColumnSpec] = &[
    SETTING,
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    key::PATTERN,
    ColumnSpec::new("status", Text, "", "How the solution ended"),
    ColumnSpec::new("harmonics", Text, "", "Temporal harmonics of the solution"),
    ColumnSpec::new("peak_amplitude_m", Float64, "m", "Peak amplitude"),
    ColumnSpec::new("peak_frequency_hz", Float64, "Hz", "Its frequency"),
    ColumnSpec::new(
        "amplification_factor",
        Float64,
        "1",
        "Peak over the tuned peak",
    ),
    ColumnSpec::new(
        "reference_amplitude_m",
        Float64,
        "m",
        "Peak amplitude of the reference",
    ),
    ColumnSpec::new("reference_frequency_hz", Float64, "Hz", "Its frequency"),
    ColumnSpec::new(
        "reference_amplification_factor",
        Float64,
        "1",
        "Amplification factor of the reference",
    ),
    ColumnSpec::new("nonlinear_solves", Int64, "1", "Nonlinear solves"),
    ColumnSpec::new("newton_iterations", Int64, "1", "Newton iterations"),
    ColumnSpec::new("factorisations", Int64, "1", "Factorisations"),
    ColumnSpec::new(
        "operations",
        Float64,
        "1",
        "Estimated floating-point operations",
    ),
];

/// Writes `tradeoff.parquet`.
///
/// # Errors
/// The file cannot be written.
pub fn write_tradeoff(
    path: &Path,
    records: &[TradeoffRecord],
    header: &TableHeader,
    more: &[(&str, String)],
) -> Result<(), TableError> {
    type Record = TradeoffRecord;
    let ids = |value: &dyn Fn(&Record) -> Option<u64>| {
        Values::Int32(
            records
                .iter()
                .map(|r| value(r).map(|id| id as i32))
                .collect(),
        )
    };
    let floats = |value: &dyn Fn(&Record) -> Option<f64>| {
        Values::Float64(records.iter().map(value).collect())
    };
    let names = |value: &dyn Fn(&Record) -> Option<&str>| {
        let name = |r| value(r).map(str::to_owned);
        Values::String(records.iter().map(name).collect())
    };
    let flags = |value: &dyn Fn(&Record) -> bool| {
        Values::Boolean(records.iter().map(|r| Some(value(r))).collect())
    };
    let bound = |of: fn(&Record) -> Option<ErrorBound>, value: fn(&ErrorBound) -> f64| {
        floats(&|r| of(r).as_ref().map(value))
    };
    let values = vec![
        ids(&|r| Some(u64::from(r.setting))),
        names(&|r| Some(r.role)),
        names(&|r| r.knob),
        names(&|r| Some(&r.basis)),
        names(&|r| Some(&r.harmonics)),
        names(&|r| Some(r.higher_harmonics)),
        ids(&|r| Some(u64::from(r.samples_per_period))),
        floats(&|r| Some(r.residual_tolerance)),
        floats(&|r| Some(r.peak_tolerance)),
        names(&|r| Some(r.contact_law)),
        names(&|r| Some(r.projection)),
        ids(&|r| r.amplitude.map(|errors| errors.rows)),
        ids(&|r| r.amplitude.map(|errors| errors.failed)),
        bound(|r| r.amplitude, |errors| errors.median),
        bound(|r| r.amplitude, |errors| errors.p95),
        bound(|r| r.amplitude, |errors| errors.p95_upper),
        bound(|r| r.amplitude, |errors| errors.worst),
        floats(&|r| r.amplitude_worst_upper),
        bound(|r| r.frequency, |errors| errors.median),
        bound(|r| r.frequency, |errors| errors.p95),
        bound(|r| r.frequency, |errors| errors.worst),
        bound(|r| r.amplification_factor, |errors| errors.median),
        bound(|r| r.amplification_factor, |errors| errors.p95),
        bound(|r| r.amplification_factor, |errors| errors.worst),
        bound(|r| r.knob_amplitude, |errors| errors.p95),
        floats(&|r| r.amplitude_p95_error),
        floats(&|r| r.amplitude_p99_error),
        floats(&|r| Some(r.work.nonlinear_solves)),
        floats(&|r| Some(r.work.newton_iterations)),
        floats(&|r| Some(r.work.factorisations)),
        ids(&|r| Some(u64::from(r.unknowns))),
        floats(&|r| Some(r.operations)),
        flags(&|r| r.on_front),
        flags(&|r| r.chosen[0]),
        flags(&|r| r.chosen[1]),
        flags(&|r| r.chosen[2]),
    ];
    let mut writer = TableWriter::create_with(path, TRADEOFF_COLUMNS, header, more)?;
    writer.write(values)?;
    writer.finish()
}

/// Writes `tradeoff_times.parquet`.
///
/// # Errors
/// The file cannot be written.
pub fn write_tradeoff_times(
    path: &Path,
    records: &[TradeoffRecord],
    header: &TableHeader,
) -> Result<(), TableError> {
    let values = vec![
        Values::Int32(records.iter().map(|r| Some(r.setting as i32)).collect()),
        Values::Float64(records.iter().map(|r| Some(r.cpu_s)).collect()),
    ];
    let mut writer = TableWriter::create(path, TRADEOFF_TIME_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}

/// Writes `tradeoff_rows.parquet`.
///
/// # Errors
/// The file cannot be written.
pub fn write_tradeoff_rows(
    path: &Path,
    rows: &[TradeoffRow],
    header: &TableHeader,
) -> Result<(), TableError> {
    let ids = |value: &dyn Fn(&TradeoffRow) -> u32| {
        Values::Int32(rows.iter().map(|r| Some(value(r) as i32)).collect())
    };
    let floats = |value: &dyn Fn(&TradeoffRow) -> Option<f64>| {
        Values::Float64(rows.iter().map(value).collect())
    };
    // Counts of a row are whole.
    let counts = |value: &dyn Fn(&TradeoffRow) -> f64| {
        Values::Int64(rows.iter().map(|r| Some(value(r) as i64)).collect())
    };
    let names = |value: &dyn Fn(&TradeoffRow) -> &str| {
        Values::String(rows.iter().map(|r| Some(value(r).to_owned())).collect())
    };
    let values = vec![
        ids(&|r| r.setting),
        ids(&|r| r.scenario.index as u32),
        names(&|r| r.scenario.contact.name()),
        ids(&|r| r.scenario.engine_order),
        floats(&|r| r.scenario.contact.normal_load_n()),
        floats(&|r| r.scenario.standard_deviation),
        ids(&|r| r.pattern),
        names(&|r| r.status),
        names(&|r| &r.harmonics),
        floats(&|r| r.values[0]),
        floats(&|r| r.values[1]),
        floats(&|r| r.values[2]),
        floats(&|r| r.reference[0]),
        floats(&|r| r.reference[1]),
        floats(&|r| r.reference[2]),
        counts(&|r| r.work.nonlinear_solves),
        counts(&|r| r.work.newton_iterations),
        counts(&|r| r.work.factorisations),
        floats(&|r| Some(r.operations)),
    ];
    let mut writer = TableWriter::create(path, TRADEOFF_ROW_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}
