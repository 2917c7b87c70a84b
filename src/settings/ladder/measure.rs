//! What a setting costs and how far its rows are from a reference.

use super::bench::{LadderEngine, LadderRow, LadderValues};
use super::sample::LadderSample;
use super::{Knob, LadderSetting};
use crate::population::monte_carlo::{RowWork, SystemSize};
use crate::population::statistics::{ErrorBound, LoadCaseErrors};

/// A setting with its rows, ordered by pattern, then scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The setting.
    pub setting: LadderSetting,
    /// The knob that alone differs from the base; none for the base and for combinations.
    pub knob: Option<Knob>,
    /// Rows.
    pub rows: Vec<LadderRow>,
    /// Size of the equation in each scenario of the sample.
    pub sizes: Vec<SystemSize>,
    /// Tuned peak amplitude of each scenario of the sample, m.
    pub tuned_amplitudes_m: Vec<Option<f64>>,
}

/// One of the three results of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compared {
    /// Peak amplitude.
    Amplitude,
    /// Frequency of the peak.
    Frequency,
    /// Amplification factor.
    AmplificationFactor,
}

impl Compared {
    /// Its value.
    #[must_use]
    pub fn of(self, values: &LadderValues) -> Option<f64> {
        match self {
            Self::Amplitude => values.amplitude_m,
            Self::Frequency => values.frequency_hz,
            Self::AmplificationFactor => values.amplification_factor,
        }
    }
}

impl LadderValues {
    /// Each value of `self` times the ratio of that of `level` to that of `base`: what one knob changes.
    #[must_use]
    pub fn changed(&self, level: &Self, base: &Self) -> Self {
        let product = |quantity: Compared| {
            Some(quantity.of(self)? * quantity.of(level)? / quantity.of(base)?)
        };
        Self {
            amplitude_m: product(Compared::Amplitude),
            frequency_hz: product(Compared::Frequency),
            amplification_factor: product(Compared::AmplificationFactor),
        }
    }
}

impl Measured {
    /// A setting with the rows of its engine.
    #[must_use]
    pub fn new(
        setting: LadderSetting,
        knob: Option<Knob>,
        engine: &LadderEngine,
        rows: Vec<LadderRow>,
    ) -> Self {
        Self {
            setting,
            knob,
            rows,
            sizes: engine.sizes(),
            tuned_amplitudes_m: engine
                .tuned()
                .iter()
                .map(|tuned| tuned.amplitude_m)
                .collect(),
        }
    }

    /// Results of its rows.
    #[must_use]
    pub fn values(&self) -> Vec<LadderValues> {
        self.rows.iter().map(|row| row.values).collect()
    }

    /// Mean work counts of a row.
    #[must_use]
    pub fn work(&self) -> RowWork {
        let mean = |count: fn(&RowWork) -> f64| {
            let sum: f64 = self.rows.iter().map(|row| count(&row.work)).sum();
            sum / self.rows.len().max(1) as f64
        };
        RowWork {
            nonlinear_solves: mean(|work| work.nonlinear_solves),
            newton_iterations: mean(|work| work.newton_iterations),
            factorisations: mean(|work| work.factorisations),
        }
    }

    /// Mean estimated floating-point operations of a row.
    #[must_use]
    pub fn operations(&self) -> f64 {
        let sum: f64 = self.rows.iter().map(|row| row.operations).sum();
        sum / self.rows.len().max(1) as f64
    }

    /// Mean processor time of a row, s.
    #[must_use]
    pub fn cpu_s(&self) -> f64 {
        let sum: f64 = self.rows.iter().map(|row| row.cpu_s).sum();
        sum / self.rows.len().max(1) as f64
    }

    /// Most real unknowns of a scenario.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.sizes
            .iter()
            .map(SystemSize::unknowns)
            .max()
            .unwrap_or(0)
    }
}

/// Signed relative errors of `values` against `reference`, row by row, where the reference has a value; a
/// row that has none itself has the error `None`.
#[must_use]
pub fn relative_errors(
    values: &[LadderValues],
    reference: &[LadderValues],
    quantity: Compared,
) -> Vec<Option<f64>> {
    values
        .iter()
        .zip(reference)
        .filter_map(|(values, reference)| {
            let reference = quantity.of(reference)?;
            Some(quantity.of(values).map(|value| value / reference - 1.0))
        })
        .collect()
}

/// The errors as a bound; none where the reference has no value at all.
#[must_use]
pub fn error_bound(
    values: &[LadderValues],
    reference: &[LadderValues],
    quantity: Compared,
) -> Option<ErrorBound> {
    ErrorBound::of(&relative_errors(values, reference, quantity))
}

/// Errors of the amplitude of the rows of each load case by themselves; none in a study without load cases.
#[must_use]
pub fn errors_of_load_cases(
    rows: &[LadderRow],
    reference: &[LadderValues],
    sample: &LadderSample,
) -> Vec<LoadCaseErrors> {
    let of_case = |load_case| {
        let rows = rows.iter().zip(reference);
        let rows =
            rows.filter(|(row, _)| sample.scenarios[row.scenario].load_case == Some(load_case));
        let (values, reference): (Vec<LadderValues>, Vec<LadderValues>) = rows
            .map(|(row, &reference)| (row.values, reference))
            .unzip();
        LoadCaseErrors {
            load_case,
            amplitude: error_bound(&values, &reference, Compared::Amplitude),
        }
    };
    sample.load_cases().into_iter().map(of_case).collect()
}
