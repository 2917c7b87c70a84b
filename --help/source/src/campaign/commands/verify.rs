//! A random sample of delivered rows solved again, on the same path and on the full-contact model.

use std::path::Path;

use rayon::prelude::*;

use super::replay::{harmonics_of, same_bits};
use crate::campaign::store::{ResultsFolder, StoredModel, StoredStudy};
use crate::population::monte_carlo::{ResponseRow, Scenario, TunedReference};
use crate::population::statistics::draw;
use crate::population::table::{
    TableHeader, VerificationRecord, write_side_table, write_verification,
};
use crate::report::{VerificationContext, VerificationReport};
use crate::settings::{Engine, EngineSource, FullModel, FullRow, FullSettings, Progress, Stage};
use crate::study::PipelineError;
use crate::verification::reference::{ReferencePeak, ReferenceSettings};

/// What to verify.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VerifyRequest {
    /// Rows to draw; all of them where the study has fewer.
    pub sample: usize,
    /// Seed of the sample; none = that of the study.
    pub seed: Option<u64>,
    /// Number of threads.
    pub threads: usize,
}

/// Verifies a finished study and writes `verification.parquet` into its folder.
///
/// # Errors
/// A table cannot be read or written, the folder is in use, or the model cannot be reduced. A row
/// that differs is no error: the report says so.
pub fn verify(
    stored: &StoredStudy,
    source: &dyn EngineSource,
    request: VerifyRequest,
    progress: &dyn Progress,
) -> Result<VerificationReport, PipelineError> {
    let folder = ResultsFolder::open(&stored.folder)?;
    let stored = stored.again()?;
    let pool = request.pool()?;
    pool.install(|| verify_in(&folder, &stored, source, request, progress))
}

impl VerifyRequest {
    /// The threads asked for.
    pub(super) fn pool(&self) -> Result<rayon::ThreadPool, PipelineError> {
        let threads = self.threads;
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| PipelineError::Threads {
                threads,
                reason: error.to_string(),
            })
    }
}

fn verify_in(
    folder: &ResultsFolder,
    stored: &StoredStudy,
    source: &dyn EngineSource,
    request: VerifyRequest,
    progress: &dyn Progress,
) -> Result<VerificationReport, PipelineError> {
    let seed = request.seed.unwrap_or(stored.manifest.seed);
    let rows = stored.row_count()?;
    let drawn = stored.rows_at(&draw(rows, request.sample, seed))?;
    progress.stage(Stage::LoadModel);
    let model = stored.model()?;
    progress.stage(Stage::Reduce);
    let engine = stored.engine(&model, source)?;
    let full = FullModel::build(&stored.study, &model.sector, &FullSettings::default())?;
    progress.stage(Stage::Tuned);
    let tuned = TunedAgain::solve(stored, engine.as_ref(), &full, &drawn)?;
    progress.begin_rows(drawn.len() as u64, 0);
    let records = drawn
        .into_par_iter()
        .with_max_len(1)
        .map(|row| {
            let record = verify_row(stored, &model, engine.as_ref(), &full, &tuned, row)?;
            progress.row(record.reference.status);
            Ok(record)
        })
        .collect::<Result<Vec<_>, PipelineError>>()?;
    progress.stage(Stage::Tables);
    write_records(folder.path(), stored, &records, seed)?;
    let stated_error = stored.study.reduction.error + stored.study.solver.peak_tolerance;
    let context = VerificationContext {
        name: stored.manifest.name.clone(),
        study_digest: stored.manifest.study_digest.clone(),
        seed,
        rows,
        reference_coordinates: full.size(),
        reference_samples_per_period: full.samples_per_period(),
        stated_error,
    };
    Ok(VerificationReport::new(context, &records))
}

/// The tuned wheel under one contact condition and excitation.
struct TunedPeak {
    scenario: Scenario,
    harmonics: String,
    settings: ReferenceSettings,
    /// On the fast path; its scenario index is that of the first row that asked.
    again: TunedReference,
    full: ReferencePeak,
}

/// The tuned wheel of every condition among the drawn rows, solved again on both models.
struct TunedAgain(Vec<TunedPeak>);

impl TunedAgain {
    fn solve(
        stored: &StoredStudy,
        engine: &dyn Engine,
        full: &FullModel,
        drawn: &[ResponseRow],
    ) -> Result<Self, PipelineError> {
        let mut wanted: Vec<(Scenario, &str)> = Vec::new();
        for row in drawn {
            let (scenario, _) = scenario_of(stored, row)?;
            let same = |(other, harmonics): &(Scenario, &str)| {
                is_same(other, &scenario) && *harmonics == row.harmonics
            };
            if !wanted.iter().any(same) {
                wanted.push((scenario, &row.harmonics));
            }
        }
        let solved = wanted.into_par_iter().map(|(scenario, name)| {
            let harmonics = match harmonics_of(name) {
                Some(harmonics) => harmonics,
                None => full.harmonics(&scenario)?,
            };
            let settings = full.settings(&harmonics)?;
            let again = engine.tuned(&scenario);
            let peak = full.peak(FullRow {
                scenario: &scenario,
                pattern: None,
                settings: &settings,
                tuned_hz: None,
                expected_hz: again.frequency_hz,
            });
            Ok(TunedPeak {
                scenario,
                harmonics: name.to_owned(),
                settings,
                again,
                full: peak,
            })
        });
        solved.collect::<Result<_, PipelineError>>().map(Self)
    }

    fn of(&self, scenario: &Scenario, harmonics: &str) -> Option<&TunedPeak> {
        self.0
            .iter()
            .find(|tuned| is_same(&tuned.scenario, scenario) && tuned.harmonics == harmonics)
    }
}

/// Whether two scenarios have the same tuned wheel.
fn is_same(a: &Scenario, b: &Scenario) -> bool {
    a.same_excitation(b) && a.contact == b.contact
}

fn scenario_of(
    stored: &StoredStudy,
    row: &ResponseRow,
) -> Result<(Scenario, TunedReference), PipelineError> {
    stored.scenario(row.scenario).ok_or(PipelineError::NoRow {
        scenario: row.scenario,
        pattern: row.pattern,
        scenarios: stored.manifest.scenarios.len(),
    })
}

fn verify_row(
    stored: &StoredStudy,
    model: &StoredModel,
    engine: &dyn Engine,
    full: &FullModel,
    tuned: &TunedAgain,
    delivered: ResponseRow,
) -> Result<VerificationRecord, PipelineError> {
    let no_row = || PipelineError::NoRow {
        scenario: delivered.scenario,
        pattern: delivered.pattern,
        scenarios: stored.manifest.scenarios.len(),
    };
    let (scenario, tuned_delivered) = scenario_of(stored, &delivered)?;
    let tuned = tuned
        .of(&scenario, &delivered.harmonics)
        .ok_or_else(no_row)?;
    let pattern = model
        .pattern(delivered.pattern, &scenario)
        .ok_or_else(no_row)?;
    let tuned_again = TunedReference {
        scenario: scenario.index,
        ..tuned.again.clone()
    };
    let again = engine
        .rows(&pattern, &[(&scenario, &tuned_again)])
        .remove(0);
    let reference = full.peak(FullRow {
        scenario: &scenario,
        pattern: Some(&pattern),
        settings: &tuned.settings,
        tuned_hz: tuned.full.frequency_hz,
        expected_hz: delivered.peak_frequency_hz,
    });
    Ok(VerificationRecord {
        replay_identical: same_bits(&again, &delivered)
            && same_bits(&tuned_again, &tuned_delivered),
        scenario,
        delivered,
        reference,
        tuned_reference: tuned.full,
    })
}

fn write_records(
    folder: &Path,
    stored: &StoredStudy,
    records: &[VerificationRecord],
    seed: u64,
) -> Result<(), PipelineError> {
    let header = TableHeader {
        study_digest: stored.manifest.study_digest.clone(),
        compression: stored.study.output.compression,
        load_cases: stored.load_cases(),
    };
    Ok(write_side_table(folder, "verification.parquet", |path| {
        write_verification(path, records, &header, seed)
    })?)
}
