//! A study from file to tables: one call per stage.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use rayon::ThreadPool;

use super::goal::Goal;
use super::tables::{Facts, TableWork};
use super::{can_be_cut, is_shard_of};
use crate::campaign::store::{
    Found, ResultsFolder, finished_rows, folder_of_shard, is_complete, summary_of_rows,
    unix_seconds,
};
use crate::population::monte_carlo::{
    Interruption, Scenario, block_size, plan_blocks, solve_blocks,
};
use crate::population::table::{
    Manifest, PartSink, RowStore, RunRecord, Shard, is_folder, remove_leftovers,
};
use crate::report::StudySummary;
use crate::response::mistuning::PatternSource;
use crate::settings::{Engine, EngineSource, Progress, RowWork, Stage};
use crate::study::{PipelineError, Study, StudyDigest, load_sector_model, pattern_source};
use crate::{identity, platform};

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
/// A finished study is not solved again. A study whose patterns or scenarios became more keeps its
/// rows, as far as they are made from the same.
///
/// # Errors
/// A stage that failed; what is stored stays stored, and the same call continues.
pub fn run(
    request: RunRequest<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<RunOutcome, PipelineError> {
    let scope = RunScope {
        shard: None,
        model_cache: &request.results.join("model"),
        held: 0,
    };
    run_in(request, scope, source, progress)
}

/// Creates or continues the shard `shard` of the study of `request`, in a folder of its own below
/// the results folder: `shards/<number>-of-<count>`.
///
/// # Errors
/// A stage failed; what is stored stays stored, and the same call continues. Or the shard is refused:
/// the study has a stopping rule, which one shard cannot follow, or its patterns have no such share,
/// or something else stands where the folder of the shard is to be.
pub fn run_shard(
    request: RunRequest<'_>,
    shard: Shard,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<RunOutcome, PipelineError> {
    can_be_cut(request.study)?;
    is_shard_of(request.study, shard)?;
    let folder = folder_of_shard(request.results, shard)?;
    let model = request.results.join("model");
    let of_shard = RunRequest {
        results: &folder,
        ..request
    };
    let scope = RunScope {
        shard: Some(shard),
        model_cache: &model,
        held: 0,
    };
    run_in(of_shard, scope, source, progress)
}

/// What a run is about beside its study and folder.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct RunScope<'a> {
    /// The share of the patterns; none: all of them.
    pub(in crate::campaign) shard: Option<Shard>,
    /// Where reduced models are kept.
    pub(in crate::campaign) model_cache: &'a Path,
    /// Patterns that its results held before and are not to lose.
    pub(in crate::campaign) held: u64,
}

pub(in crate::campaign) fn run_in(
    request: RunRequest<'_>,
    scope: RunScope<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<RunOutcome, PipelineError> {
    let RunRequest { study, results, .. } = request;
    let shard = scope.shard;
    let clock = Clock::start();
    let digest = StudyDigest::of(study)?;
    let mut folder = ResultsFolder::open(results)?;
    // Of a shard it lies beside the others.
    if is_folder(scope.model_cache)? {
        remove_leftovers(scope.model_cache)?;
    }
    if let Some(holder) = folder.broken_off() {
        progress.taken_over(&holder.to_string());
    }
    let found = folder.find(study, &digest, shard)?;
    if let Found::Finished(manifest) = &found
        && is_complete(manifest, study)
    {
        return Ok(RunOutcome {
            rows_reused: manifest.counts.planned,
            rows_solved: 0,
            // Its files have just been checked.
            summary: summary_of_rows(results, manifest)?,
        });
    }
    progress.stage(Stage::LoadModel);
    let model = load_sector_model(study)?;
    let patterns = pattern_source(study, &model)?;
    let held = match &found {
        Found::Finished(manifest) => manifest.patterns,
        _ => scope.held,
    };
    let job = Job {
        request,
        goal: Goal::new(study, held),
        found: &found,
        patterns: &patterns,
        progress,
    };
    let tables = |size, facts: Facts| {
        let all = patterns.ids();
        let first = &all[..all.len().min(size as usize)];
        let ids = shard.map_or(first, |shard| shard.of(first)).to_vec();
        TableWork::new(study, &digest, &patterns, (shard, ids), facts)
    };
    let pool = pool_of(request.threads)?;
    let mut ended = None;
    if let Some((size, facts)) = job.facts_of_stored_rows() {
        // Motions are looked at by an engine.
        if !TableWork::wants_engine(study, shard) {
            ended = pool.install(|| job.end(&tables(size, facts), 0, None))?;
        }
    }
    if ended.is_none() {
        progress.stage(Stage::Reduce);
        let engine = pool
            .install(|| source.build_watched(study, &model, Some(scope.model_cache), progress))?;
        progress.stage(Stage::Tuned);
        let facts = pool.install(|| Facts::solve(engine.as_ref(), study, &digest, progress));
        let mut solved = 0;
        for &size in job.goal.ends() {
            let tables = tables(size, facts.clone());
            let rows = job.solve(&pool, engine.as_ref(), &tables, &mut folder)?;
            solved += rows.solved;
            let stored = rows.stored();
            if stored < tables.planned() {
                let rows = RowCounts {
                    solved,
                    reused: stored - solved,
                };
                clock
                    .record(&study.path, request.threads, rows, BTreeMap::new())
                    .write(results)?;
                return Err(PipelineError::Interrupted {
                    folder: results.to_owned(),
                    stored,
                    planned: tables.planned(),
                });
            }
            ended = pool.install(|| job.end(&tables, solved, Some(engine.as_ref())))?;
            if ended.is_some() {
                break;
            }
        }
    }
    let Some((outcome, manifest)) = ended else {
        return Err(PipelineError::Unfinished {
            folder: results.to_owned(),
        });
    };
    let rows = RowCounts {
        solved: outcome.rows_solved,
        reused: outcome.rows_reused,
    };
    clock
        .record(&study.path, request.threads, rows, manifest.tables)
        .write(results)?;
    Ok(outcome)
}

/// Threads of a run.
pub(in crate::campaign) fn pool_of(threads: usize) -> Result<ThreadPool, PipelineError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| PipelineError::Threads {
            threads,
            reason: error.to_string(),
        })
}

/// Rows solved by a run and rows that were stored before.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct RowCounts {
    pub(in crate::campaign) solved: u64,
    pub(in crate::campaign) reused: u64,
}

impl RowCounts {
    fn stored(self) -> u64 {
        self.solved + self.reused
    }
}

/// A run that has something to do.
struct Job<'a> {
    request: RunRequest<'a>,
    goal: Goal,
    found: &'a Found,
    patterns: &'a PatternSource,
    progress: &'a dyn Progress,
}

impl Job<'_> {
    /// The manifest of what is stored.
    fn stored(&self) -> Option<&Manifest> {
        match self.found {
            Found::Nothing => None,
            Found::Unfinished(manifest) | Found::Finished(manifest) => Some(manifest),
        }
    }

    /// What the tables of the first patterns, up to the first possible end, are made from, if all of
    /// their rows are stored: in another order, with other tables asked for, or another rule to stop.
    fn facts_of_stored_rows(&self) -> Option<(u64, Facts)> {
        let &size = self.goal.ends().first()?;
        match self.found {
            Found::Finished(manifest) if manifest.patterns == size => {
                Some((size, Facts::stored(manifest, self.request.study)?))
            }
            _ => None,
        }
    }

    /// Rows of the finished study for those of `scenarios` that it has, at most `patterns` of each.
    fn held_rows(&self, scenarios: &[Scenario], patterns: u64) -> u64 {
        let Found::Finished(manifest) = self.found else {
            return 0;
        };
        let has = |scenario: &&Scenario| {
            let mut held = manifest.scenarios.iter();
            held.any(|held| {
                held.load_case == scenario.load_case
                    && held.engine_order == scenario.engine_order
                    && held.standard_deviation == scenario.standard_deviation
                    && held.contact == scenario.contact
            })
        };
        let rows_of_each = manifest.counts.planned / (manifest.scenarios.len().max(1) as u64);
        scenarios.iter().filter(has).count() as u64 * rows_of_each.min(patterns)
    }

    /// The rows stored.
    fn store(&self, tables: &TableWork) -> Result<RowStore, PipelineError> {
        let results = self.request.results;
        let finished = self
            .stored()
            .map_or_else(Vec::new, |manifest| finished_rows(results, manifest));
        Ok(RowStore::open(results, tables.schema().clone(), finished)?)
    }

    /// Solves the rows that are not stored yet.
    fn solve(
        &self,
        pool: &ThreadPool,
        engine: &dyn Engine,
        tables: &TableWork,
        folder: &mut ResultsFolder,
    ) -> Result<RowCounts, PipelineError> {
        let results = self.request.results;
        if !matches!(self.found, Found::Finished(_)) {
            tables.unfinished().write(results)?;
        }
        self.progress.stage(Stage::Rows);
        let ids = tables.ids();
        let scenarios = &tables.schema().scenarios;
        let stored = self.store(tables)?.stored()?;
        let blocks = plan_blocks(ids, &stored, scenarios.len(), block_size(ids.len()));
        let reused = stored.count(ids);
        folder.announce(tables.planned(), reused)?;
        let held = self.held_rows(scenarios, ids.len() as u64);
        let anew = held.saturating_sub(reused);
        if anew > 0 {
            let why = { self.stored() }
                .map_or_else(String::new, |stored| why_anew(stored, &tables.unfinished()));
            self.progress.solves_anew(anew, &why);
        }
        let at_a_time = pool.current_num_threads() * scenarios.len();
        self.progress.rows_at_a_time(at_a_time as u64);
        self.progress.begin_rows(tables.planned(), reused);
        let rows = RowWork {
            engine,
            patterns: self.patterns,
            scenarios,
            tuned: tables.tuned(),
            progress: self.progress,
        };
        let mut sink = PartSink::new(results, tables.schema())?;
        let solved = solve_blocks(
            pool,
            &blocks,
            |block, id| rows.of_pattern(id, &block.scenarios),
            &mut sink,
            &Stop(self.progress),
        )?;
        sink.close()?;
        Ok(RowCounts { solved, reused })
    }

    /// Writes the tables of the rows stored, if the study ends with them; `solved` are those of this
    /// run.
    fn end(
        &self,
        tables: &TableWork,
        solved: u64,
        engine: Option<&dyn Engine>,
    ) -> Result<Option<(RunOutcome, Manifest)>, PipelineError> {
        let store = self.store(tables)?;
        let scenarios = tables.schema().scenarios.len();
        let verdict = self.goal.look(&store, tables.ids(), scenarios)?;
        if !verdict.ends {
            return Ok(None);
        }
        self.progress.stage(Stage::Tables);
        let results = self.request.results;
        let (manifest, summary) = tables.publish(&store, results, verdict.outcome, engine)?;
        let outcome = RunOutcome {
            summary,
            rows_solved: solved,
            rows_reused: tables.planned() - solved,
        };
        Ok(Some((outcome, manifest)))
    }
}

/// Why rows that were stored with one manifest are not those of another.
fn why_anew(before: &Manifest, now: &Manifest) -> String {
    let modes = |manifest: &Manifest| manifest.reduction["craig_bampton_modes"].as_u64();
    let vectors = |manifest: &Manifest| {
        let tried = manifest.reduction["tuned_peak_errors"].as_array()?;
        tried.last()?["vectors"].as_u64()
    };
    let changed =
        |of: &dyn Fn(&Manifest) -> Option<u64>| of(before).zip(of(now)).filter(|(a, b)| a != b);
    if let Some((before, now)) = changed(&modes) {
        format!("the model of the study now has {now} fixed-interface modes, {before} before")
    } else if let Some((before, now)) = changed(&vectors) {
        format!(
            "the model of the study now has {now} blade shapes or modes of its basis, {before} before"
        )
    } else {
        "their loads now have other harmonics, another basis or another stated error".to_owned()
    }
}

/// The listener as the one that stops the solution of rows.
pub(in crate::campaign) struct Stop<'a>(pub(in crate::campaign) &'a dyn Progress);

impl Interruption for Stop<'_> {
    fn requested(&self) -> bool {
        self.0.stop_requested()
    }

    fn saved(&self) {
        self.0.saved();
    }
}

/// Wall clock of a run.
pub(in crate::campaign) struct Clock {
    started_unix_s: u64,
    began: Instant,
}

impl Clock {
    pub(in crate::campaign) fn start() -> Self {
        Self {
            started_unix_s: unix_seconds(),
            began: Instant::now(),
        }
    }

    pub(in crate::campaign) fn record(
        &self,
        study_file: &Path,
        threads: usize,
        rows: RowCounts,
        tables: BTreeMap<String, String>,
    ) -> RunRecord {
        RunRecord {
            started_unix_s: self.started_unix_s,
            wall_time_s: self.began.elapsed().as_secs_f64(),
            host: platform::host_name(),
            threads,
            version: identity::VERSION.to_owned(),
            build: identity::BUILD.to_owned(),
            rows_solved: rows.solved,
            rows_reused: rows.reused,
            study_file: std::path::absolute(study_file).unwrap_or_else(|_| study_file.to_owned()),
            tables,
        }
    }
}
