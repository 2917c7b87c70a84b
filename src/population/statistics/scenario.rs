//! Statistics of one scenario, gathered row by row.

use serde::Serialize;

use super::{Accounting, CONFIDENCE, DistributionBand, Quantity, SampleStatistics};
use crate::population::monte_carlo::{ResponseRow, sampling_tolerance};
use crate::response::harmonic_balance::Status;

/// Statistics of one scenario: a row of `scenarios.parquet` without its keys.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioStatistics {
    /// Rows by status.
    pub accounting: Accounting,
    /// Amplification factor; rows without one count as failed.
    pub amplification_factor: SampleStatistics,
    /// Peak amplitude, m.
    pub peak_amplitude_m: SampleStatistics,
    /// Distribution of the amplification factor.
    #[serde(skip)]
    pub amplification_factor_band: DistributionBand,
    /// Distribution of the peak amplitude, m.
    #[serde(skip)]
    pub peak_amplitude_m_band: DistributionBand,
    /// Largest share of separated pairs of an `ok` row.
    pub largest_separated_fraction: Option<f64>,
    /// Share of `ok` rows in which a pair separates.
    pub separated_rows: Option<f64>,
    /// Mean share of slipping pairs over the `ok` rows.
    pub mean_slipping_fraction: Option<f64>,
    /// Largest stated error of an `ok` row.
    pub largest_stated_error: Option<f64>,
    /// `ok` rows whose sampling or harmonic error exceeds its tolerance.
    pub beyond_tolerance: u64,
    /// Those of them whose sampling error is the larger one.
    #[serde(skip)]
    pub beyond_by_sampling: u64,
}

/// Gathers the rows of one scenario; holds 16 bytes per row.
#[derive(Debug, Clone, Default)]
pub struct ScenarioAccumulator {
    accounting: Accounting,
    amplification_factor: Vec<f64>,
    peak_amplitude_m: Vec<f64>,
    largest_separated_fraction: Option<f64>,
    separated_rows: u64,
    contact_rows: u64,
    slipping_sum: f64,
    largest_stated_error: Option<f64>,
    beyond_tolerance: u64,
    beyond_by_sampling: u64,
}

impl ScenarioAccumulator {
    /// Takes one row of the scenario.
    pub fn add(&mut self, row: &ResponseRow) {
        self.accounting.add(row.status);
        if row.status != Status::Ok {
            return;
        }
        self.amplification_factor
            .extend(Quantity::AmplificationFactor.of(row));
        self.peak_amplitude_m
            .extend(Quantity::PeakAmplitudeM.of(row));
        if let Some(stated) = row.stated_error {
            let largest = self.largest_stated_error.unwrap_or(0.0);
            self.largest_stated_error = Some(largest.max(stated));
        }
        if row.error_within_tolerance == Some(false) {
            let size = |error: Option<f64>| error.unwrap_or(0.0).abs();
            let sampling = size(row.sampling_error);
            // No tolerance of the sampling error is below this one. What the wheels that judge leave out of a row's harmonics is not
            // in its own harmonic error.
            let by_sampling = sampling > sampling_tolerance(0.0);
            self.beyond_tolerance += 1;
            self.beyond_by_sampling +=
                u64::from(by_sampling && sampling > size(row.harmonic_error));
        }
        if let Some(separated) = row.separated_fraction {
            let largest = self.largest_separated_fraction.unwrap_or(0.0);
            self.largest_separated_fraction = Some(largest.max(separated));
            self.separated_rows += u64::from(separated > 0.0);
        }
        if let Some(slipping) = row.slipping_fraction {
            self.contact_rows += 1;
            self.slipping_sum += slipping;
        }
    }

    /// The statistics of the rows taken, bounds at [`CONFIDENCE`].
    #[must_use]
    pub fn finish(self) -> ScenarioStatistics {
        self.finish_at(CONFIDENCE)
    }

    /// The statistics of the rows taken, bounds at the two-sided `confidence`.
    #[must_use]
    pub fn finish_at(self, confidence: f64) -> ScenarioStatistics {
        let planned = self.accounting.planned();
        let ok = self.accounting.ok();
        let statistics = |mut values: Vec<f64>| {
            values.sort_unstable_by(f64::total_cmp);
            let failed = planned - values.len() as u64;
            (
                SampleStatistics::of_sorted(&values, failed, confidence),
                DistributionBand::at(&values, failed, confidence),
            )
        };
        let (amplification_factor, amplification_factor_band) =
            statistics(self.amplification_factor);
        let (peak_amplitude_m, peak_amplitude_m_band) = statistics(self.peak_amplitude_m);
        ScenarioStatistics {
            accounting: self.accounting,
            amplification_factor,
            peak_amplitude_m,
            amplification_factor_band,
            peak_amplitude_m_band,
            largest_separated_fraction: self.largest_separated_fraction,
            separated_rows: self
                .largest_separated_fraction
                .map(|_| self.separated_rows as f64 / ok as f64),
            largest_stated_error: self.largest_stated_error,
            beyond_tolerance: self.beyond_tolerance,
            beyond_by_sampling: self.beyond_by_sampling,
            mean_slipping_fraction: (self.contact_rows > 0)
                .then(|| self.slipping_sum / self.contact_rows as f64),
        }
    }
}
