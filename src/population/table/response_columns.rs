//! The columns of `responses.parquet`, each with its value in a row and its way back.

use super::column::{Access, Cells, Column, ColumnSpec, InScenario, key, specs};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::PairFactors;

/// A row on its way into the table.
pub(super) struct WrittenRow {
    pub(super) row: ResponseRow,
    pub(super) scenario: Scenario,
    /// What is known of the stability of its motion.
    pub(super) stable: Option<bool>,
}

impl InScenario for WrittenRow {
    fn scenario(&self) -> &Scenario {
        &self.scenario
    }
}

/// A field of a row that is stored as a cell of type `T`.
trait Stored<T>: Sized {
    fn cell(&self) -> Option<T>;
    /// The field of a cell; none where it can be no such cell.
    fn of(cell: Option<T>) -> Option<Self>;
}

impl<T: Copy> Stored<T> for Option<T> {
    fn cell(&self) -> Self {
        *self
    }

    fn of(cell: Self) -> Option<Self> {
        Some(cell)
    }
}

impl Stored<Self> for u32 {
    fn cell(&self) -> Option<Self> {
        Some(*self)
    }

    fn of(cell: Option<Self>) -> Option<Self> {
        cell
    }
}

impl Stored<u32> for usize {
    fn cell(&self) -> Option<u32> {
        Some(*self as u32)
    }

    fn of(cell: Option<u32>) -> Option<Self> {
        cell.map(|value| value as Self)
    }
}

impl Stored<Self> for u64 {
    fn cell(&self) -> Option<Self> {
        Some(*self)
    }

    fn of(cell: Option<Self>) -> Option<Self> {
        cell
    }
}

impl Stored<Self> for String {
    fn cell(&self) -> Option<Self> {
        Some(self.clone())
    }

    fn of(cell: Option<Self>) -> Option<Self> {
        cell
    }
}

impl Stored<String> for Status {
    fn cell(&self) -> Option<String> {
        Some(self.name().to_owned())
    }

    fn of(cell: Option<String>) -> Option<Self> {
        let name = cell?;
        Self::ALL.into_iter().find(|status| status.name() == name)
    }
}

/// The column of a field of [`ResponseRow`], which has the name of the field.
macro_rules! field {
    ($kind:ident, $field:ident, $unit:literal, $description:literal) => {
        Column::new(
            stringify!($field),
            $unit,
            $description,
            field!(cells $kind, $field),
        )
    };
    ($kind:ident, $field:ident: $spec:expr) => {
        Column::shared($spec, field!(cells $kind, $field))
    };
    (cells $kind:ident, $field:ident) => {
        Cells::$kind(Access {
            value: |written: &WrittenRow| written.row.$field.cell(),
            read: Some(|row: &mut ResponseRow, cell| {
                row.$field = Stored::of(cell)?;
                Some(())
            }),
        })
    };
}

/// The column of a factor on the contact of a wheel. A row that lacks one of them when it is read back has none.
macro_rules! factor {
    ($factor:ident, $name:literal, $description:literal) => {
        Column::new(
            $name,
            "1",
            $description,
            Cells::Float64(Access {
                value: |written: &WrittenRow| Some(written.row.contact_factors?.$factor),
                read: Some(|row: &mut ResponseRow, cell| {
                    let others = row.contact_factors;
                    row.contact_factors = others
                        .zip(cell)
                        .map(|(others, $factor)| PairFactors { $factor, ..others });
                    Some(())
                }),
            }),
        )
    };
}

/// Columns of `responses.parquet` with their values. The last one is no part of a row, and is not read back.
pub(super) const COLUMNS: &[Column<WrittenRow, ResponseRow>] = &[
    field!(Int32, scenario: key::SCENARIO),
    key::contact(),
    key::engine_order(),
    key::normal_load_n(),
    key::standard_deviation(),
    field!(Int32, pattern: key::PATTERN),
    field!(
        String,
        status,
        "",
        "How the solution ended; every value but ok is a failure and has nulls"
    ),
    field!(
        Float64,
        peak_amplitude_m,
        "m",
        "Largest amplitude over blades and frequency"
    ),
    field!(
        Float64,
        peak_frequency_hz,
        "Hz",
        "Excitation frequency of the peak"
    ),
    field!(Int32, peak_blade, "", "Blade of the peak, from 0"),
    field!(
        Float64,
        amplification_factor,
        "1",
        "Peak amplitude over the tuned peak of the same normal load, engine order and solver settings"
    ),
    field!(
        Boolean,
        peak_bracketed,
        "",
        "Lower amplitudes were seen on both sides of the peak"
    ),
    field!(
        String,
        harmonics,
        "",
        "Temporal harmonics of the solution, for instance 1-3"
    ),
    field!(Int64, nonlinear_solves, "1", "Nonlinear solves used"),
    field!(
        Int64,
        newton_iterations,
        "1",
        "Steps of the iteration, all attempts; in Newton's method on tuned receptances products with the derivative"
    ),
    field!(
        Float64,
        residual,
        "1",
        "Residual at the peak, relative: on tuned receptances to the contact motions, on a basis to the excitation"
    ),
    field!(
        Float64,
        slipping_fraction,
        "1",
        "Share of contact pairs that slip in any direction at any instant, at the peak"
    ),
    field!(
        Float64,
        separated_fraction,
        "1",
        "Share of contact pairs without normal load at any instant, at the peak"
    ),
    field!(
        String,
        shortcut,
        "",
        "What was left out: linear, stuck, or none; after the simplification of the contact law, if there is one"
    ),
    field!(
        Int64,
        retries,
        "1",
        "Nonlinear solves that needed more than their first attempt; on tuned receptances every further attempt"
    ),
    field!(
        Int64,
        factorisations,
        "1",
        "Jacobians assembled and factored, all attempts"
    ),
    field!(
        Float64,
        mean_friction_circumferential_n,
        "N",
        "Mean friction force on the ring along theta per sector (torque over the mean contact radius) at the peak, mean over the sectors; null for the linear limits"
    ),
    field!(
        Float64,
        mean_friction_axial_n,
        "N",
        "Mean friction force on the ring along z per sector at the peak, mean over the sectors; null for the linear limits"
    ),
    field!(
        Float64,
        sampling_error,
        "1",
        "Relative change of the peak amplitude by finer sampling of a period and under the law of the study"
    ),
    field!(
        Float64,
        harmonic_error,
        "1",
        "Relative change of the peak amplitude by the harmonics outside of the set: up to 15, or 25 where it has all of those"
    ),
    field!(
        Float64,
        stated_error,
        "1",
        "Bound on the relative error of the peak amplitude: sampling, harmonics, basis and peak tolerance together"
    ),
    field!(
        Boolean,
        error_within_tolerance,
        "",
        "Sampling and harmonic error are within their tolerances"
    ),
    field!(
        String,
        basis,
        "",
        "Basis of the reduced model that the row was solved on"
    ),
    factor!(
        friction_coefficient,
        "friction_coefficient_factor",
        "Factor on the coefficient of friction of this wheel, mean over its pairs; null where the contact does not vary"
    ),
    factor!(
        tangential_stiffness,
        "tangential_stiffness_factor",
        "Factor on the tangential contact stiffness of this wheel, mean over its pairs; null where the contact does not vary"
    ),
    factor!(
        normal_stiffness,
        "normal_stiffness_factor",
        "Factor on the normal contact stiffness of this wheel, mean over its pairs; null where the contact does not vary"
    ),
    factor!(
        normal_load,
        "normal_load_factor",
        "Factor on the normal load of this wheel, mean over its pairs; null where the contact does not vary"
    ),
    Column::new(
        "stable",
        "",
        "Small disturbances of the motion at the peak die out; null where that was not looked at, see output.stability, or is not settled",
        Cells::boolean(|written| written.stable),
    ),
];

/// Columns of `responses.parquet`.
pub const RESPONSE_COLUMNS: &[ColumnSpec] = &specs::<_, _, { COLUMNS.len() }>(COLUMNS);
