//! Tail fits of a finished results folder.

use std::path::Path;

use crate::campaign::store::ResultColumns;
use crate::population::statistics::{Quantity, RESAMPLES, fit_tails};
use crate::population::table::{Compression, TableHeader, TailFitRecord, write_tail_fits};
use crate::study::PipelineError;

/// Fits both laws to both quantities of every scenario in the folder `results`, and writes
/// `tail_fits.parquet` there.
///
/// # Errors
/// The folder holds no finished study, or a file cannot be read or written.
pub fn fit_result_tails(results: &Path) -> Result<Vec<TailFitRecord>, PipelineError> {
    let columns = ResultColumns::read(results)?;
    let seed = columns.manifest.seed;
    let mut records = Vec::new();
    for scenario in &columns.scenarios {
        for (place, quantity) in Quantity::ALL.into_iter().enumerate() {
            let (sorted, failed) = scenario.sorted(quantity);
            // Every sample has streams of its own.
            let topic = (2 * scenario.scenario.index + place) as u32;
            records.push(TailFitRecord {
                scenario: scenario.scenario,
                quantity,
                fits: fit_tails(&sorted, failed, RESAMPLES, seed, topic),
            });
        }
    }
    let scenarios: Vec<_> = columns
        .scenarios
        .iter()
        .map(|scenario| scenario.scenario)
        .collect();
    let compression = columns.manifest.study["output"]["compression"].clone();
    let header = TableHeader {
        study_digest: columns.manifest.study_digest.clone(),
        compression: serde_json::from_value(compression).unwrap_or(Compression::Zstd),
        load_cases: TableHeader::load_cases_of(&scenarios),
    };
    write_tail_fits(&results.join("tail_fits.parquet"), &records, &header)?;
    Ok(records)
}
