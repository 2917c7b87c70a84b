//! `verification.parquet`: rows of a study solved again, on the same path and on the full-contact model.

use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::writer::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::harmonic_balance::Status;
use crate::verification::reference::ReferencePeak;

use ColumnKind::{Boolean, Float64, Int32, Int64, String as Text};

/// One delivered row with what became of it when solved again.
#[derive(Debug, Clone, PartialEq)]
pub struct VerificationRecord {
    /// Keys.
    pub scenario: Scenario,
    /// The row as delivered.
    pub delivered: ResponseRow,
    /// Whether the same path gives the same bits, tuned reference included.
    pub replay_identical: bool,
    /// Peak of the row on the full-contact model with the same harmonics.
    pub reference: ReferencePeak,
    /// Peak of the tuned wheel on the full-contact model with the same harmonics.
    pub tuned_reference: ReferencePeak,
}

impl VerificationRecord {
    /// Relative error of the peak amplitude, `delivered / reference - 1`; none unless both are there.
    #[must_use]
    pub fn amplitude_error(&self) -> Option<f64> {
        relative(self.delivered.peak_amplitude_m, self.reference.amplitude_m)
    }

    /// Relative error of the peak frequency.
    #[must_use]
    pub fn frequency_error(&self) -> Option<f64> {
        relative(
            self.delivered.peak_frequency_hz,
            self.reference.frequency_hz,
        )
    }

    /// Amplification factor on the full-contact model.
    #[must_use]
    pub fn reference_amplification_factor(&self) -> Option<f64> {
        Some(self.reference.amplitude_m? / self.tuned_reference.amplitude_m?)
    }

    /// Relative error of the amplification factor.
    #[must_use]
    pub fn amplification_factor_error(&self) -> Option<f64> {
        relative(
            self.delivered.amplification_factor,
            self.reference_amplification_factor(),
        )
    }

    /// Whether contact pairs separate at the peak, on either model.
    #[must_use]
    pub fn separates(&self) -> bool {
        let reference = self.reference.shares.map(|shares| shares.separated);
        let shares = [self.delivered.separated_fraction, reference];
        shares.into_iter().flatten().any(|share| share > 0.0)
    }

    /// Whether the fast path delivered a value that the full-contact model could not confirm or deny.
    #[must_use]
    pub fn is_unchecked(&self) -> bool {
        self.delivered.status == Status::Ok
            && (self.reference.status != Status::Ok || self.tuned_reference.status != Status::Ok)
    }
}

fn relative(own: Option<f64>, reference: Option<f64>) -> Option<f64> {
    Some(own? / reference? - 1.0)
}

/// Columns of `verification.parquet`.
pub const VERIFICATION_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    key::PATTERN,
    ColumnSpec::new(
        "harmonics",
        Text,
        "",
        "Temporal harmonics of both solutions, for instance 1-3",
    ),
    ColumnSpec::new("status", Text, "", "How the delivered solution ended"),
    ColumnSpec::new(
        "replay_identical",
        Boolean,
        "",
        "The same path solved again gives the same bits, tuned reference included",
    ),
    ColumnSpec::new(
        "peak_amplitude_m",
        Float64,
        "m",
        "Largest amplitude over blades and frequency, as delivered",
    ),
    ColumnSpec::new(
        "peak_frequency_hz",
        Float64,
        "Hz",
        "Excitation frequency of the peak, as delivered",
    ),
    ColumnSpec::new(
        "peak_blade",
        Int32,
        "",
        "Blade of the peak, from 0, as delivered",
    ),
    ColumnSpec::new(
        "amplification_factor",
        Float64,
        "1",
        "Peak amplitude over the tuned peak, as delivered",
    ),
    ColumnSpec::new(
        "separated_fraction",
        Float64,
        "1",
        "Share of contact pairs without normal load at any instant, at the peak, as delivered",
    ),
    ColumnSpec::new(
        "reference_status",
        Text,
        "",
        "How the solution on the full-contact model ended; every value but ok has nulls",
    ),
    ColumnSpec::new(
        "reference_tuned_status",
        Text,
        "",
        "How the tuned solution on the full-contact model ended",
    ),
    ColumnSpec::new(
        "reference_amplitude_m",
        Float64,
        "m",
        "Peak amplitude on the full-contact model",
    ),
    ColumnSpec::new(
        "reference_frequency_hz",
        Float64,
        "Hz",
        "Peak frequency on the full-contact model",
    ),
    ColumnSpec::new(
        "reference_blade",
        Int32,
        "",
        "Blade of the peak on the full-contact model, from 0",
    ),
    ColumnSpec::new(
        "reference_amplification_factor",
        Float64,
        "1",
        "Amplification factor on the full-contact model, tuned reference included",
    ),
    ColumnSpec::new(
        "reference_separated_fraction",
        Float64,
        "1",
        "Share of contact pairs without normal load at any instant, on the full-contact model",
    ),
    ColumnSpec::new(
        "amplitude_error",
        Float64,
        "1",
        "peak_amplitude_m / reference_amplitude_m - 1",
    ),
    ColumnSpec::new(
        "frequency_error",
        Float64,
        "1",
        "peak_frequency_hz / reference_frequency_hz - 1",
    ),
    ColumnSpec::new(
        "amplification_factor_error",
        Float64,
        "1",
        "amplification_factor / reference_amplification_factor - 1",
    ),
    ColumnSpec::new(
        "reference_residual",
        Float64,
        "1",
        "Residual force relative to the excitation at the peak, full-contact model",
    ),
    ColumnSpec::new(
        "reference_solves",
        Int64,
        "1",
        "Frequencies solved on the full-contact model",
    ),
    ColumnSpec::new(
        "reference_newton_iterations",
        Int64,
        "1",
        "Newton iterations on the full-contact model, all attempts",
    ),
];

/// Writes `verification.parquet`; `seed` is that of the sample, kept in the file's metadata.
///
/// # Errors
/// The file cannot be written.
pub fn write_verification(
    path: &Path,
    records: &[VerificationRecord],
    header: &TableHeader,
    seed: u64,
) -> Result<(), TableError> {
    type Record = VerificationRecord;
    let ids = |value: &dyn Fn(&Record) -> Option<u32>| {
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
    let names = |value: &dyn Fn(&Record) -> &str| {
        Values::String(records.iter().map(|r| Some(value(r).to_owned())).collect())
    };
    let counts = |value: &dyn Fn(&Record) -> u64| {
        Values::Int64(records.iter().map(|r| Some(value(r) as i64)).collect())
    };
    let values = vec![
        ids(&|r| Some(r.scenario.index as u32)),
        names(&|r| r.scenario.contact.name()),
        ids(&|r| Some(r.scenario.engine_order)),
        floats(&|r| r.scenario.contact.normal_load_n()),
        floats(&|r| r.scenario.standard_deviation),
        ids(&|r| Some(r.delivered.pattern)),
        names(&|r| &r.delivered.harmonics),
        names(&|r| r.delivered.status.name()),
        Values::Boolean(records.iter().map(|r| Some(r.replay_identical)).collect()),
        floats(&|r| r.delivered.peak_amplitude_m),
        floats(&|r| r.delivered.peak_frequency_hz),
        ids(&|r| r.delivered.peak_blade),
        floats(&|r| r.delivered.amplification_factor),
        floats(&|r| r.delivered.separated_fraction),
        names(&|r| r.reference.status.name()),
        names(&|r| r.tuned_reference.status.name()),
        floats(&|r| r.reference.amplitude_m),
        floats(&|r| r.reference.frequency_hz),
        ids(&|r| r.reference.blade),
        floats(&Record::reference_amplification_factor),
        floats(&|r| r.reference.shares.map(|shares| shares.separated)),
        floats(&Record::amplitude_error),
        floats(&Record::frequency_error),
        floats(&Record::amplification_factor_error),
        floats(&|r| r.reference.residual),
        counts(&|r| r.reference.work.solves),
        counts(&|r| r.reference.work.newton_iterations),
    ];
    let sample = [
        ("blisk.sample_seed", seed.to_string()),
        ("blisk.sample_rows", records.len().to_string()),
    ];
    let mut writer = TableWriter::create_with(path, VERIFICATION_COLUMNS, header, &sample)?;
    writer.write(values)?;
    writer.finish()
}
