//! The rows that an estimate solved as a sample of its population.

use crate::population::monte_carlo::ResponseRow;
use crate::population::statistics::{
    Allocation, EstimateTarget, Population, Quantity, SamplingMethod, StratumSample,
    TwoPhasePercentile, TwoPhaseSample, percentile,
};
use crate::report::QuantityEstimate;

/// Percentiles that are reported besides the target.
const PERCENTS: [f64; 2] = [95.0, 99.0];

/// The solved rows of a scenario as a sample of its population.
pub(super) struct Sample<'a> {
    pub(super) population: &'a Population<'a>,
    pub(super) allocation: &'a Allocation,
    pub(super) rows: Vec<(usize, &'a ResponseRow)>,
    pub(super) surrogates: &'a [Option<f64>],
}

impl Sample<'_> {
    /// Patterns of each stratum; all in one under crude sampling.
    pub(super) fn sizes(&self) -> Vec<u64> {
        match self.allocation.method {
            SamplingMethod::Crude => vec![self.population.len() as u64],
            SamplingMethod::TwoPhase => (0..self.population.strata())
                .map(|stratum| self.population.size(stratum) as u64)
                .collect(),
        }
    }

    pub(super) fn stratum(&self, place: usize) -> usize {
        match self.allocation.method {
            SamplingMethod::Crude => 0,
            SamplingMethod::TwoPhase => self.population.stratum(place),
        }
    }

    pub(super) fn inclusion_probability(&self, place: usize) -> f64 {
        let stratum = self.stratum(place);
        self.allocation.rows[stratum] as f64 / self.sizes()[stratum] as f64
    }

    /// The strata with the values of a quantity.
    pub(super) fn strata(&self, quantity: Quantity) -> Vec<StratumSample> {
        let mut strata: Vec<StratumSample> = self
            .sizes()
            .into_iter()
            .map(|size| StratumSample {
                size,
                rows: Vec::new(),
            })
            .collect();
        for &(place, row) in &self.rows {
            let pair = (self.surrogates[place], quantity.of(row));
            strata[self.stratum(place)].rows.push(pair);
        }
        strata
    }

    pub(super) fn estimate(&self, quantity: Quantity, target: EstimateTarget) -> QuantityEstimate {
        let strata = self.strata(quantity);
        let mut good: Vec<f64> = self
            .rows
            .iter()
            .filter_map(|(_, row)| quantity.of(row))
            .collect();
        good.sort_unstable_by(f64::total_cmp);
        let failed = (self.rows.len() - good.len()) as u64;
        let two_phase = TwoPhaseSample::new(strata, self.population.surrogate_mean());
        let mut percents = PERCENTS.to_vec();
        if let EstimateTarget::Percentile(percent) = target {
            percents.push(percent);
        }
        percents.sort_by(f64::total_cmp);
        percents.dedup_by(|a, b| a.total_cmp(b).is_eq());
        let percentiles = percents
            .into_iter()
            .map(|percent| match self.allocation.method {
                SamplingMethod::TwoPhase => two_phase.percentile(percent),
                SamplingMethod::Crude => {
                    let found = percentile(&good, failed, percent);
                    TwoPhasePercentile {
                        percent,
                        value: found.value,
                        lower: found.lower,
                        upper: found.upper,
                        status: found.status,
                        equivalent_patterns: found.value.map(|_| self.rows.len() as f64),
                    }
                }
            });
        QuantityEstimate {
            quantity,
            percentiles: percentiles.collect(),
            mean: two_phase.mean(),
        }
    }
}
