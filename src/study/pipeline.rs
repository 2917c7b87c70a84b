//! A study from file to tables: one call per stage.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use super::results_folder::{Found, ResultsFolder, host_name, verify_tables};
use super::{
    Engine, EngineSource, PipelineError, Study, StudyDigest, digest_file, load_sector_model,
    pattern_source,
};
use crate::population::monte_carlo::{
    ResponseRow, Scenario, TunedReference, block_size, plan_blocks, solve_blocks,
};
use crate::population::statistics::{Accounting, ScenarioAccumulator};
use crate::population::table::{
    Manifest, PartStore, ResponseReader, RunRecord, RunState, SCHEMA_VERSION, ScenarioEntry,
    ScenarioRecord, StatusCounts, TableError, TableHeader, write_atomically, write_patterns,
    write_scenarios,
};
use crate::report::{BasisSummary, StudySummary, SummaryContext};
use crate::response::forced_response::Harmonics;
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{GENERATOR, Pattern, PatternSource};

/// Patterns up to which `patterns.parquet` is written without being asked for.
const PATTERNS_WRITTEN: u32 = 10_000;

/// A stage of a run, for progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Loading and validating the model.
    LoadModel,
    /// Reducing it, or reading the reduced model from the cache.
    Reduce,
    /// Solving the tuned wheel of every scenario.
    Tuned,
    /// Solving the patterns.
    Rows,
    /// Joining parts and writing tables.
    Tables,
}

/// Listener to a run; called from several threads.
pub trait Progress: Sync {
    /// A stage begins.
    fn stage(&self, _stage: Stage) {}
    /// Rows are about to be solved: `planned` in all, of which `done` are stored already.
    fn begin_rows(&self, _planned: u64, _done: u64) {}
    /// A row has been solved.
    fn row(&self, _status: Status) {}
}

/// What to run and where.
#[derive(Debug, Clone, Copy)]
pub struct RunRequest<'a> {
    /// The study.
    pub study: &'a Study,
    /// The results folder.
    pub results: &'a Path,
    /// Number of threads.
    pub threads: usize,
}

/// What a run came to.
#[derive(Debug, Clone)]
pub struct RunOutcome {
    /// The summary.
    pub summary: StudySummary,
    /// Rows solved by this run.
    pub rows_solved: u64,
    /// Rows taken over from earlier runs.
    pub rows_reused: u64,
}

/// Creates or continues the study of `request`.
///
/// A finished study is not solved again. A study whose `patterns` were raised keeps its rows.
///
/// # Errors
/// A stage that failed; what is stored stays stored, and the same call continues.
pub fn run(
    request: RunRequest<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<RunOutcome, PipelineError> {
    let RunRequest {
        study,
        results,
        threads,
    } = request;
    let clock = Clock::start();
    let digest = StudyDigest::of(study)?;
    let folder = ResultsFolder::open(results)?;
    if let Found::Finished(manifest) = folder.find(study, &digest)? {
        let summary = summarise(results)?;
        return Ok(RunOutcome {
            rows_reused: manifest.counts.planned,
            rows_solved: 0,
            summary,
        });
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| PipelineError::Threads {
            threads,
            reason: error.to_string(),
        })?;
    let outcome = pool.install(|| {
        progress.stage(Stage::LoadModel);
        let model = load_sector_model(study)?;
        let patterns = pattern_source(study, model.sectors)?;
        progress.stage(Stage::Reduce);
        let cache = folder.path().join("model");
        let engine = source.build(study, &model, Some(&cache))?;
        let work = Work::new(study, &digest, engine.as_ref(), &patterns, results);
        work.solve(progress)
    })?;
    clock.record(study, threads, &outcome).write(results)?;
    Ok(outcome)
}

/// The summary of the finished study in the folder `results`, from its tables.
///
/// # Errors
/// The folder holds no finished study, or a file of it is damaged.
pub fn summarise(results: &Path) -> Result<StudySummary, PipelineError> {
    let folder = || results.to_owned();
    let manifest =
        Manifest::read(results)?.ok_or_else(|| PipelineError::NoResults { folder: folder() })?;
    if manifest.state != RunState::Finished {
        return Err(PipelineError::Unfinished { folder: folder() });
    }
    verify_tables(results, &manifest)?;
    let keys: Vec<Scenario> = manifest.scenarios.iter().map(ScenarioEntry::keys).collect();
    let tuned: Vec<TunedReference> = manifest
        .scenarios
        .iter()
        .map(ScenarioEntry::tuned)
        .collect();
    let mut accumulators = vec![ScenarioAccumulator::default(); keys.len()];
    let mut reader = ResponseReader::open(&results.join("responses.parquet"))?;
    loop {
        let rows = reader.next_batch()?;
        if rows.is_empty() {
            break;
        }
        for row in &rows {
            if let Some(accumulator) = accumulators.get_mut(row.scenario) {
                accumulator.add(row);
            }
        }
    }
    let records = records_of(&keys, &tuned, accumulators);
    Ok(StudySummary::new(&context_of(&manifest), &records))
}

/// All that the solution of rows needs.
struct Work<'a> {
    study: &'a Study,
    digest: &'a StudyDigest,
    engine: &'a dyn Engine,
    patterns: &'a PatternSource,
    results: &'a Path,
    scenarios: Vec<Scenario>,
    header: TableHeader,
}

impl<'a> Work<'a> {
    fn new(
        study: &'a Study,
        digest: &'a StudyDigest,
        engine: &'a dyn Engine,
        patterns: &'a PatternSource,
        results: &'a Path,
    ) -> Self {
        Self {
            study,
            digest,
            engine,
            patterns,
            results,
            scenarios: study.scenarios(),
            header: TableHeader {
                study_digest: digest.hex(),
                compression: study.output.compression,
            },
        }
    }

    fn solve(&self, progress: &dyn Progress) -> Result<RunOutcome, PipelineError> {
        progress.stage(Stage::Tuned);
        let tuned = self.tuned();
        self.manifest(
            RunState::Running,
            &tuned,
            &vec![Accounting::default(); tuned.len()],
        )
        .write(self.results)?;
        progress.stage(Stage::Rows);
        let store = PartStore::new(self.results, &self.scenarios, self.header.clone());
        let (rows_solved, rows_reused) = self.rows(&store, &tuned, progress)?;
        progress.stage(Stage::Tables);
        let records = self.tables(&store, &tuned)?;
        let counts: Vec<Accounting> = records
            .iter()
            .map(|record| record.statistics.accounting)
            .collect();
        let mut manifest = self.manifest(RunState::Finished, &tuned, &counts);
        manifest.tables = self.table_digests()?;
        let summary = StudySummary::new(&context_of(&manifest), &records);
        write_atomically(
            &self.results.join("summary.txt"),
            summary.to_string().as_bytes(),
        )?;
        manifest.write(self.results)?;
        Ok(RunOutcome {
            summary,
            rows_solved,
            rows_reused,
        })
    }

    /// The tuned wheel knows no standard deviation: solved once per engine order and contact.
    fn tuned(&self) -> Vec<TunedReference> {
        let mut solved: Vec<(Scenario, TunedReference)> = Vec::new();
        for scenario in &self.scenarios {
            let same = solved.iter().find(|(other, _)| {
                other.engine_order == scenario.engine_order && other.contact == scenario.contact
            });
            let reference = match same {
                Some((_, reference)) => TunedReference {
                    scenario: scenario.index,
                    ..reference.clone()
                },
                None => self.engine.tuned(scenario),
            };
            solved.push((*scenario, reference));
        }
        solved.into_iter().map(|(_, reference)| reference).collect()
    }

    /// Solves the patterns that are not stored yet; rows solved and rows reused.
    fn rows(
        &self,
        store: &PartStore,
        tuned: &[TunedReference],
        progress: &dyn Progress,
    ) -> Result<(u64, u64), PipelineError> {
        let ids = self.patterns.ids();
        let done = store.done()?;
        let blocks = plan_blocks(&ids, &done, block_size(ids.len()));
        let per_pattern = self.scenarios.len() as u64;
        let reused = done.len() as u64 * per_pattern;
        progress.begin_rows(ids.len() as u64 * per_pattern, reused);
        let solve = |id: u32| {
            let rows = self.rows_of_pattern(id, tuned);
            for row in &rows {
                progress.row(row.status);
            }
            rows
        };
        solve_blocks(&blocks, solve, store.sink(&blocks))?;
        let solved: usize = blocks.iter().map(|block| block.patterns.len()).sum();
        Ok((solved as u64 * per_pattern, reused))
    }

    /// Rows of one pattern in scenario order; the engine sees the scenarios of each standard
    /// deviation together.
    fn rows_of_pattern(&self, id: u32, tuned: &[TunedReference]) -> Vec<ResponseRow> {
        let mut rows = Vec::with_capacity(self.scenarios.len());
        for &standard_deviation in &self.study.standard_deviations {
            let of_deviation: Vec<(&Scenario, &TunedReference)> = self
                .scenarios
                .iter()
                .zip(tuned)
                .filter(|(scenario, _)| scenario.standard_deviation == standard_deviation)
                .collect();
            if let Some(pattern) = self.patterns.pattern(id, standard_deviation) {
                rows.extend(self.rows_or_panicked(&pattern, &of_deviation));
            }
        }
        rows.sort_by_key(|row| row.scenario);
        rows
    }

    /// A panic while one pattern is solved costs the rows of that pattern, not the run.
    fn rows_or_panicked(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        let solve = AssertUnwindSafe(|| self.engine.rows(pattern, scenarios));
        catch_unwind(solve).unwrap_or_else(|_| {
            scenarios
                .iter()
                .map(|(scenario, _)| ResponseRow {
                    scenario: scenario.index,
                    pattern: pattern.id,
                    status: Status::Panicked,
                    peak_amplitude_m: None,
                    peak_frequency_hz: None,
                    peak_blade: None,
                    amplification_factor: None,
                    peak_bracketed: None,
                    harmonics: String::new(),
                    nonlinear_solves: 0,
                    newton_iterations: 0,
                    retries: 0,
                    residual: None,
                    slipping_fraction: None,
                    separated_fraction: None,
                    mean_friction_circumferential_n: None,
                    mean_friction_axial_n: None,
                    shortcut: "none".to_owned(),
                    sampling_error: None,
                    harmonic_error: None,
                    stated_error: None,
                    error_within_tolerance: None,
                    basis: String::new(),
                })
                .collect()
        })
    }

    fn tables(
        &self,
        store: &PartStore,
        tuned: &[TunedReference],
    ) -> Result<Vec<ScenarioRecord>, PipelineError> {
        let mut accumulators = vec![ScenarioAccumulator::default(); self.scenarios.len()];
        store.assemble(&self.patterns.ids(), |row| {
            accumulators[row.scenario].add(row);
        })?;
        let records = records_of(&self.scenarios, tuned, accumulators);
        write_scenarios(
            &self.results.join("scenarios.parquet"),
            &records,
            &self.header,
        )?;
        if self.writes_patterns() {
            write_patterns(
                &self.results.join("patterns.parquet"),
                self.patterns,
                &self.study.standard_deviations,
                &self.header,
            )?;
        }
        Ok(records)
    }

    /// Whether `patterns.parquet` is part of the results.
    fn writes_patterns(&self) -> bool {
        let few = self.study.patterns <= PATTERNS_WRITTEN;
        self.study.output.patterns.unwrap_or(few)
    }

    fn table_digests(&self) -> Result<BTreeMap<String, String>, PipelineError> {
        let mut names = vec!["responses.parquet", "scenarios.parquet"];
        if self.writes_patterns() {
            names.push("patterns.parquet");
        }
        let digest = |name: &str| {
            let path = self.results.join(name);
            match digest_file(&path) {
                Ok(digest) => Ok((name.to_owned(), digest)),
                Err(source) => Err(TableError::Io {
                    action: "read",
                    path,
                    source,
                }),
            }
        };
        Ok(names.into_iter().map(digest).collect::<Result<_, _>>()?)
    }

    fn manifest(
        &self,
        state: RunState,
        tuned: &[TunedReference],
        counts: &[Accounting],
    ) -> Manifest {
        let mut total = Accounting::default();
        for count in counts {
            total.merge(count);
        }
        let scenarios = self
            .scenarios
            .iter()
            .zip(tuned)
            .zip(counts)
            .map(|((scenario, tuned), count)| ScenarioEntry::new(scenario, tuned, count))
            .collect();
        Manifest {
            schema: SCHEMA_VERSION,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            state,
            name: self.study.name.clone(),
            study_digest: self.header.study_digest.clone(),
            seed: self.study.seed,
            generator: GENERATOR.to_owned(),
            patterns: u64::from(self.study.patterns),
            number_keys: self.digest.number_keys.clone(),
            inputs: self.digest.inputs.clone(),
            study: self.study.resolved(),
            chosen: self.engine.chosen_settings(),
            reduction: self.engine.reduction_facts(),
            counts: StatusCounts::from(&total),
            tables: BTreeMap::new(),
            scenarios,
        }
    }
}

fn records_of(
    scenarios: &[Scenario],
    tuned: &[TunedReference],
    accumulators: Vec<ScenarioAccumulator>,
) -> Vec<ScenarioRecord> {
    scenarios
        .iter()
        .zip(tuned)
        .zip(accumulators)
        .map(|((scenario, tuned), accumulator)| ScenarioRecord {
            scenario: *scenario,
            tuned: tuned.clone(),
            statistics: accumulator.finish(),
        })
        .collect()
}

fn context_of(manifest: &Manifest) -> SummaryContext {
    let harmonics = manifest.study["solver"]["harmonics"].as_array().map(|set| {
        let numbers = set.iter().filter_map(serde_json::Value::as_u64);
        Harmonics::Set(numbers.map(|number| number as u32).collect())
    });
    SummaryContext {
        name: manifest.name.clone(),
        study_digest: manifest.study_digest.clone(),
        seed: manifest.seed,
        patterns: manifest.patterns,
        harmonics: harmonics.unwrap_or(Harmonics::Auto),
        basis: basis_of(manifest),
        version: manifest.version.clone(),
    }
}

/// The basis and its measured error, from the facts that the engine gave.
fn basis_of(manifest: &Manifest) -> BasisSummary {
    let facts = &manifest.reduction;
    let taken = facts["tuned_peak_errors"]
        .as_array()
        .and_then(|tried| tried.last());
    let asked = &manifest.study["reduction"];
    let number = |key: &str| facts[key].as_f64();
    let truncation = number("craig_bampton_error");
    BasisSummary {
        name: facts["basis"].as_str().unwrap_or_default().to_owned(),
        tuned_peak_error: taken.and_then(|taken| taken["error"].as_f64()),
        contact_displacement_error: taken.and_then(|taken| {
            taken["contact_displacement"]["any_nodal_diameter"]["error"].as_f64()
        }),
        craig_bampton_reach: number("craig_bampton_reach"),
        craig_bampton_error: truncation.filter(|_| asked["craig_bampton_modes"].is_u64()),
        wanted_error: asked["error"].as_f64().unwrap_or(f64::INFINITY),
    }
}

/// Wall clock of a run.
struct Clock {
    started_unix_s: u64,
    began: Instant,
}

impl Clock {
    fn start() -> Self {
        Self {
            started_unix_s: SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |since| since.as_secs()),
            began: Instant::now(),
        }
    }

    fn record(&self, study: &Study, threads: usize, outcome: &RunOutcome) -> RunRecord {
        RunRecord {
            started_unix_s: self.started_unix_s,
            wall_time_s: self.began.elapsed().as_secs_f64(),
            host: host_name(),
            threads,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            rows_solved: outcome.rows_solved,
            rows_reused: outcome.rows_reused,
            study_file: std::path::absolute(&study.path).unwrap_or_else(|_| study.path.clone()),
        }
    }
}
