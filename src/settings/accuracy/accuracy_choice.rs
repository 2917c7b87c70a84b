//! The choice of settings by an accepted error, with the evidence: on tuned receptances those of
//! [`ReceptanceSetting`](super::ReceptanceSetting), on a basis the cheapest of the ladder.
//!
//! Of the ladder:
//! A few patterns of the study are solved at reference settings. Single knobs are moved on fewer of them,
//! which proposes combinations, the cheapest first by estimated operations. These are measured pattern by
//! pattern and given up at the first row beyond the accepted error, which no bound can be below, so that
//! bad settings cost little. Taken is the cheapest whose upper bound of the 95th percentile of the
//! amplitude error is accepted.

use std::path::Path;

use super::ladder_trials::{Trials, levels};
use super::receptance_accuracy::on_receptances;
use super::{AccuracyChoice, AccuracyEvidence, ChosenSetting};
use crate::model::sector::SectorModel;
use crate::model::{read_cached, reduction_digest, write_cached};
use crate::response::friction::Ring;
use crate::response::mistuning::PatternSource;
use crate::settings::ladder::{
    Compared, LadderBench, LadderEnds, LadderReference, LadderSearch, Measured, error_bound,
    errors_of_load_cases, most_scenarios, sample_of_patterns,
};
use crate::settings::reduced_study::is_on_receptances;
use crate::study::{AccuracyOptions, PipelineError, Study, StudyDigest, pattern_source};

/// Rows that the sample has at least, and fewest patterns of it.
const ROWS: usize = 18;
const FEWEST_PATTERNS: usize = 6;
/// Patterns of the sample on which single knobs are moved.
const PROBED: usize = 2;
/// Accepted error over what the harmonics of the reference may leave out.
const FINER_REFERENCE: f64 = 5.0;
/// Least tolerance of the harmonics of the reference.
const FINEST_REFERENCE: f64 = 1e-3;

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
        let digest = reduction_digest(sector, &format!("accuracy with its worst {keys} {sampled}"));
        let stored: Option<Self> = cache.and_then(|folder| read_cached(folder, &digest));
        let asked = |stored: &Self| stored.accepted.total_cmp(&accuracy.amplitude_error).is_eq();
        if let Some(stored) = stored.filter(asked) {
            return Ok(stored);
        }
        let patterns = pattern_source(study, sector)?;
        let mut judged = study.clone();
        judged.accuracy = Some(accuracy);
        let choice = if is_on_receptances(&judged, sector) {
            let ids = sample_of_patterns(study, &patterns, sampled_patterns(study));
            on_receptances(
                study,
                accuracy.amplitude_error,
                sector,
                (&patterns, ids),
                cache,
            )?
        } else {
            on_the_ladder(study, accuracy, sector, &patterns)?
        };
        if let Some(folder) = cache {
            write_cached(folder, &digest, &choice)?;
        }
        Ok(choice)
    }
}

/// The cheapest settings of the ladder for `accuracy`.
fn on_the_ladder(
    study: &Study,
    accuracy: AccuracyOptions,
    sector: &SectorModel,
    patterns: &PatternSource,
) -> Result<AccuracyChoice, PipelineError> {
    let accepted = accuracy.amplitude_error;
    let ids = sample_of_patterns(study, patterns, sampled_patterns(study));
    let mut bench = LadderBench::new(study, sector, ids, &())?;
    let tolerance = (accepted / FINER_REFERENCE).max(FINEST_REFERENCE);
    let mut ends = LadderEnds::choose(&mut bench, tolerance, accepted)?;
    ends.base = ends.base.but_for_those_of(study);
    let craig_bampton_modes = bench.fixed_interface().modes;
    if bench.sample().scenarios.is_empty() {
        // Linear limits know none of these settings but the basis.
        return Ok(AccuracyChoice {
            accepted,
            setting: ChosenSetting::Ladder(ends.base),
            craig_bampton_modes,
            met: true,
            evidence: None,
        });
    }
    let reference = LadderReference::solve(&mut bench, &ends, patterns)?;
    let space = bench.space(ends.best.basis);
    let sample = bench.sample().clone();
    let mut search = LadderSearch::new(&mut bench, patterns, &reference, PROBED);
    // The drift of a creeping ring under one law is not that under another.
    let locked = study
        .contact
        .as_ref()
        .is_some_and(|contact| contact.ring == Ring::Locked);
    let accuracy = AccuracyOptions {
        simpler_contact_law: accuracy.simpler_contact_law && locked,
        ..accuracy
    };
    search.measure_levels(levels(study, &space, &ends.base, accuracy, tolerance))?;
    let mut trials = Trials::new(accepted);
    trials.among(&mut search, study, reference.most_operations())?;
    let Some((measured, amplitude)) = trials.taken else {
        // No row of the sample has a reference: the best that is affordable.
        return Ok(AccuracyChoice {
            accepted,
            setting: ChosenSetting::Ladder(ends.base),
            craig_bampton_modes,
            met: false,
            evidence: None,
        });
    };
    let of_measured =
        |measured: &Measured| measured.rows.iter().map(|row| row.operations).sum::<f64>();
    let of_reference = reference.parts.iter().chain([&reference.base]);
    let values = measured.values();
    let bound = |quantity| error_bound(&values, &reference.values, quantity);
    Ok(AccuracyChoice {
        accepted,
        craig_bampton_modes,
        met: amplitude.p95_upper <= accepted,
        evidence: Some(AccuracyEvidence {
            patterns: sample.patterns.clone(),
            normal_loads_n: sample
                .scenarios
                .iter()
                .filter_map(|scenario| scenario.contact.normal_load_n())
                .collect(),
            reference_tolerance: Some(tolerance),
            reference: reference.kind.name().to_owned(),
            amplitude,
            amplitude_worst_upper: amplitude.worst_upper(measured.setting.peak_tolerance),
            frequency: bound(Compared::Frequency),
            amplification_factor: bound(Compared::AmplificationFactor),
            operations_per_row: measured.operations(),
            operations_of_choice: trials.operations
                + of_reference.map(of_measured).sum::<f64>()
                + search.levels().iter().map(of_measured).sum::<f64>(),
            tried: trials.tried,
            load_cases: sample
                .scenarios
                .iter()
                .filter_map(|scenario| scenario.load_case)
                .collect(),
            errors_of_load_cases: errors_of_load_cases(&measured.rows, &reference.values, &sample),
        }),
        setting: ChosenSetting::Ladder(measured.setting),
    })
}

/// Patterns of the sample.
fn sampled_patterns(study: &Study) -> usize {
    let scenarios = most_scenarios(study).max(1);
    ROWS.div_ceil(scenarios).max(FEWEST_PATTERNS)
}
