//! The choice of settings by an accepted error, with the evidence, kept in the cache of models.

use std::path::Path;

use super::AccuracyChoice;
use super::receptance_accuracy::on_receptances;
use crate::model::sector::SectorModel;
use crate::model::{read_cached, reduction_digest, write_cached};
use crate::settings::ladder::{most_scenarios, sample_of_patterns};
use crate::study::{AccuracyOptions, PipelineError, Study, StudyDigest, pattern_source};

/// Rows that the sample has at least, and fewest patterns of it.
const ROWS: usize = 18;
const FEWEST_PATTERNS: usize = 6;

impl AccuracyChoice {
    /// The choice for `study`, from the folder `cache` if it was made there before.
    ///
    /// # Errors
    /// The model cannot be reduced, or the cache not be written.
    pub fn of(
        study: &Study,
        accuracy: AccuracyOptions,
        sector: &SectorModel,
        cache: Option<&Path>,
    ) -> Result<Self, PipelineError> {
        let keys = StudyDigest::of(study)?.hex();
        // A study with more patterns than the sample has the same sample.
        let sampled = sampled_patterns(study).min(study.patterns as usize);
        let digest = reduction_digest(sector, &format!("accuracy on receptances {keys} {sampled}"));
        let stored: Option<Self> = cache.and_then(|folder| read_cached(folder, &digest));
        let asked = |stored: &Self| stored.accepted.total_cmp(&accuracy.amplitude_error).is_eq();
        if let Some(stored) = stored.filter(asked) {
            return Ok(stored);
        }
        let patterns = pattern_source(study, sector)?;
        let ids = sample_of_patterns(study, &patterns, sampled_patterns(study));
        let sample = (&patterns, ids);
        let choice = on_receptances(study, accuracy.amplitude_error, sector, sample, cache)?;
        if let Some(folder) = cache {
            write_cached(folder, &digest, &choice)?;
        }
        Ok(choice)
    }
}

/// Patterns of the sample.
fn sampled_patterns(study: &Study) -> usize {
    let scenarios = most_scenarios(study).max(1);
    ROWS.div_ceil(scenarios).max(FEWEST_PATTERNS)
}
