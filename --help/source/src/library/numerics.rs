//! How a problem is solved: the numbers that change the error and the time of a row, and nothing else.

use toml::{Table, Value};

use super::problem::{list, put};
use crate::model::reduction::Basis;

/// How rows are solved. What is `None` is chosen by the program, as in a study file without the key; [`Numerics::default`] chooses all.
///
/// The ranges are those of the keys of the same meaning in `docs/study-file.md`, tables `[reduction]`, `[solver]` and `[accuracy]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Numerics {
    /// Accepted relative error of the peak amplitude of 95 % of the rows, from 0.001 to 0.2. The settings below are then found by
    /// measured errors of the first wheels, which takes a while; those that are `Some` are kept.
    pub accuracy: Option<f64>,
    /// What rows are solved on.
    pub basis: Option<Basis>,
    /// Wanted relative error by which numbers of modes are chosen, above 0 and at most 0.5. Default 0.001.
    pub basis_error: Option<f64>,
    /// Fixed-interface modes per nodal diameter, from 1 to 1000.
    pub fixed_interface_modes: Option<usize>,
    /// Temporal harmonics, ascending and with 1.
    pub harmonics: Option<Vec<u32>>,
    /// Wanted relative error of the amplitude by the harmonics left out. Default 0.02.
    pub harmonic_tolerance: Option<f64>,
    /// Samples per period in which contact forces are evaluated. Default 128.
    pub samples_per_period: Option<usize>,
    /// Bound on the residual force relative to the excitation. Default 1e-8.
    pub residual_tolerance: Option<f64>,
    /// Relative tolerance of the peak amplitude in the peak search. Default 1e-3.
    pub peak_tolerance: Option<f64>,
}

impl Numerics {
    /// Settings chosen so that the peak amplitude of 95 % of the rows is within this relative error, from 0.001 to 0.2.
    #[must_use]
    pub fn within(amplitude_error: f64) -> Self {
        Self {
            accuracy: Some(amplitude_error),
            ..Self::default()
        }
    }

    /// These tables of a study file are written into `study`.
    pub(super) fn write(&self, study: &mut Table) {
        let count = |number: usize| Value::Integer(i64::try_from(number).unwrap_or(i64::MAX));
        let mut reduction = Table::new();
        put(
            &mut reduction,
            "basis",
            self.basis.and_then(|basis| Value::try_from(basis).ok()),
        );
        put(&mut reduction, "error", self.basis_error);
        put(
            &mut reduction,
            "craig_bampton_modes",
            self.fixed_interface_modes.map(count),
        );
        let mut solver = Table::new();
        put(
            &mut solver,
            "harmonics",
            self.harmonics.as_deref().map(list),
        );
        put(&mut solver, "harmonic_tolerance", self.harmonic_tolerance);
        put(
            &mut solver,
            "samples_per_period",
            self.samples_per_period.map(count),
        );
        put(&mut solver, "residual_tolerance", self.residual_tolerance);
        put(&mut solver, "peak_tolerance", self.peak_tolerance);
        study.insert("reduction".to_owned(), Value::Table(reduction));
        // What is searched and called amplitude is part of the problem, and stands in the same table.
        let of_problem = study
            .entry("solver")
            .or_insert_with(|| Value::Table(Table::new()));
        if let Some(table) = of_problem.as_table_mut() {
            table.extend(solver);
        }
        if let Some(error) = self.accuracy {
            let accuracy = Table::from_iter([("amplitude_error".to_owned(), Value::Float(error))]);
            study.insert("accuracy".to_owned(), Value::Table(accuracy));
        }
    }
}
