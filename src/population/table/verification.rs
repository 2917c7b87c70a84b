//! `verification.parquet`: rows of a study solved again, on the same path and on the full-contact model.

use std::path::Path;

use super::column::{Cells, Column, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::harmonic_balance::Status;
use crate::verification::reference::ReferencePeak;

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

fn relative(value: Option<f64>, reference: Option<f64>) -> Option<f64> {
    Some(value? / reference? - 1.0)
}

impl InScenario for VerificationRecord {
    fn scenario(&self) -> &Scenario {
        &self.scenario
    }
}

const COLUMNS: &[Column<VerificationRecord>] = &[
    key::scenario(),
    key::contact(),
    key::engine_order(),
    key::normal_load_n(),
    key::standard_deviation(),
    Column::shared(key::PATTERN, Cells::int32(|r| Some(r.delivered.pattern))),
    Column::new(
        "harmonics",
        "",
        "Temporal harmonics of both solutions, for instance 1-3",
        Cells::string(|r| Some(r.delivered.harmonics.clone())),
    ),
    Column::new(
        "status",
        "",
        "How the delivered solution ended",
        Cells::string(|r| Some(r.delivered.status.name().to_owned())),
    ),
    Column::new(
        "replay_identical",
        "",
        "The same path solved again gives the same bits, tuned reference included",
        Cells::boolean(|r| Some(r.replay_identical)),
    ),
    Column::new(
        "peak_amplitude_m",
        "m",
        "Largest amplitude over blades and frequency, as delivered",
        Cells::float64(|r| r.delivered.peak_amplitude_m),
    ),
    Column::new(
        "peak_frequency_hz",
        "Hz",
        "Excitation frequency of the peak, as delivered",
        Cells::float64(|r| r.delivered.peak_frequency_hz),
    ),
    Column::new(
        "peak_blade",
        "",
        "Blade of the peak, from 0, as delivered",
        Cells::int32(|r| r.delivered.peak_blade),
    ),
    Column::new(
        "amplification_factor",
        "1",
        "Peak amplitude over the tuned peak, as delivered",
        Cells::float64(|r| r.delivered.amplification_factor),
    ),
    Column::new(
        "separated_fraction",
        "1",
        "Share of contact pairs without normal load at any instant, at the peak, as delivered",
        Cells::float64(|r| r.delivered.separated_fraction),
    ),
    Column::new(
        "reference_status",
        "",
        "How the solution on the full-contact model ended; every value but ok has nulls",
        Cells::string(|r| Some(r.reference.status.name().to_owned())),
    ),
    Column::new(
        "reference_tuned_status",
        "",
        "How the tuned solution on the full-contact model ended",
        Cells::string(|r| Some(r.tuned_reference.status.name().to_owned())),
    ),
    Column::new(
        "reference_amplitude_m",
        "m",
        "Peak amplitude on the full-contact model",
        Cells::float64(|r| r.reference.amplitude_m),
    ),
    Column::new(
        "reference_frequency_hz",
        "Hz",
        "Peak frequency on the full-contact model",
        Cells::float64(|r| r.reference.frequency_hz),
    ),
    Column::new(
        "reference_blade",
        "",
        "Blade of the peak on the full-contact model, from 0",
        Cells::int32(|r| r.reference.blade),
    ),
    Column::new(
        "reference_amplification_factor",
        "1",
        "Amplification factor on the full-contact model, tuned reference included",
        Cells::float64(VerificationRecord::reference_amplification_factor),
    ),
    Column::new(
        "reference_separated_fraction",
        "1",
        "Share of contact pairs without normal load at any instant, on the full-contact model",
        Cells::float64(|r| Some(r.reference.shares?.separated)),
    ),
    Column::new(
        "amplitude_error",
        "1",
        "peak_amplitude_m / reference_amplitude_m - 1",
        Cells::float64(VerificationRecord::amplitude_error),
    ),
    Column::new(
        "frequency_error",
        "1",
        "peak_frequency_hz / reference_frequency_hz - 1",
        Cells::float64(VerificationRecord::frequency_error),
    ),
    Column::new(
        "amplification_factor_error",
        "1",
        "amplification_factor / reference_amplification_factor - 1",
        Cells::float64(VerificationRecord::amplification_factor_error),
    ),
    Column::new(
        "reference_residual",
        "1",
        "Residual force relative to the excitation at the peak, full-contact model",
        Cells::float64(|r| r.reference.residual),
    ),
    Column::new(
        "reference_solves",
        "1",
        "Frequencies solved on the full-contact model",
        Cells::int64(|r| Some(r.reference.work.solves)),
    ),
    Column::new(
        "reference_newton_iterations",
        "1",
        "Newton iterations on the full-contact model, all attempts",
        Cells::int64(|r| Some(r.reference.work.newton_iterations)),
    ),
];

/// Columns of `verification.parquet`.
pub const VERIFICATION_COLUMNS: &[ColumnSpec] = &specs::<_, _, { COLUMNS.len() }>(COLUMNS);

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
    let sample = [
        ("blisk.sample_seed", seed.to_string()),
        ("blisk.sample_rows", records.len().to_string()),
    ];
    let mut writer = TableWriter::create_with(path, VERIFICATION_COLUMNS, header, &sample)?;
    writer.write(values_of(COLUMNS, records))?;
    writer.finish()
}
