//! The populations of a finished results folder, column by column.

use std::path::{Path, PathBuf};

use super::results_folder::verify_tables;
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::Quantity;
use crate::population::table::{Manifest, ResponseReader, RunState, ScenarioEntry, TableError};
use crate::study::PipelineError;

/// Values of every scenario over the same patterns.
#[derive(Debug, Clone)]
pub struct ResultColumns {
    /// The results folder.
    pub folder: PathBuf,
    /// Its manifest.
    pub manifest: Manifest,
    /// Ids of the patterns, ascending.
    pub patterns: Vec<u32>,
    /// The scenarios, in order.
    pub scenarios: Vec<ScenarioColumns>,
}

/// Values of one scenario, one per pattern; none where a row failed.
#[derive(Debug, Clone)]
pub struct ScenarioColumns {
    /// Keys.
    pub scenario: Scenario,
    /// Peak amplitude, m.
    peak_amplitude_m: Vec<Option<f64>>,
    /// Amplification factor.
    amplification_factor: Vec<Option<f64>>,
}

impl ScenarioColumns {
    /// The values of a quantity.
    #[must_use]
    pub fn values(&self, quantity: Quantity) -> &[Option<f64>] {
        match quantity {
            Quantity::PeakAmplitudeM => &self.peak_amplitude_m,
            Quantity::AmplificationFactor => &self.amplification_factor,
        }
    }

    /// The values that there are, ascending, and the number of failed rows.
    #[must_use]
    pub fn sorted(&self, quantity: Quantity) -> (Vec<f64>, u64) {
        sorted_values(self.values(quantity))
    }
}

/// The values that there are, ascending, and the number of those that are missing.
pub(in crate::campaign) fn sorted_values(values: &[Option<f64>]) -> (Vec<f64>, u64) {
    let mut good: Vec<f64> = values.iter().flatten().copied().collect();
    good.sort_unstable_by(f64::total_cmp);
    let failed = (values.len() - good.len()) as u64;
    (good, failed)
}

impl ResultColumns {
    /// The largest value of each pattern over all scenarios; none where one of its rows failed.
    #[must_use]
    pub(in crate::campaign) fn largest(&self, quantity: Quantity) -> Vec<Option<f64>> {
        let largest = |place: usize| {
            let values = self
                .scenarios
                .iter()
                .map(|scenario| scenario.values(quantity)[place]);
            values
                .reduce(|largest, value| Some(largest?.max(value?)))
                .flatten()
        };
        (0..self.patterns.len()).map(largest).collect()
    }

    /// Reads the folder `results`.
    ///
    /// # Errors
    /// It holds no finished study, or a file of it is damaged.
    pub fn read(results: &Path) -> Result<Self, PipelineError> {
        let folder = results.to_owned();
        let Some(manifest) = Manifest::read(results)? else {
            return Err(PipelineError::NoResults { folder });
        };
        if manifest.state != RunState::Finished {
            return Err(PipelineError::Unfinished { folder });
        }
        verify_tables(results, &manifest)?;
        let mut scenarios: Vec<ScenarioColumns> = manifest
            .scenarios
            .iter()
            .map(|entry| ScenarioColumns {
                scenario: ScenarioEntry::keys(entry),
                peak_amplitude_m: Vec::new(),
                amplification_factor: Vec::new(),
            })
            .collect();
        let path = results.join("responses.parquet");
        let mut patterns = Vec::new();
        let mut reader = ResponseReader::open(&path)?;
        loop {
            let rows = reader.next_batch()?;
            if rows.is_empty() {
                break;
            }
            for row in &rows {
                if row.scenario == 0 {
                    patterns.push(row.pattern);
                }
                let columns = scenarios
                    .get_mut(row.scenario)
                    .filter(|columns| columns.peak_amplitude_m.len() + 1 == patterns.len())
                    .filter(|_| patterns.last() == Some(&row.pattern));
                let Some(columns) = columns else {
                    let reason = format!("the rows of pattern {} are out of order", row.pattern);
                    return Err(TableError::Damaged { path, reason }.into());
                };
                columns
                    .peak_amplitude_m
                    .push(Quantity::PeakAmplitudeM.of(row));
                columns
                    .amplification_factor
                    .push(Quantity::AmplificationFactor.of(row));
            }
        }
        Ok(Self {
            folder,
            manifest,
            patterns,
            scenarios,
        })
    }
}
