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
use crate::population::statistics::StopOutcome;
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

/// Creates or continues what `scope` says of the study of `request`.
pub(in crate::campaign) fn run_in(
    request: RunRequest<'_>,
    scope: RunScope<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<RunOutcome, PipelineError> {
    let RunRequest { study, results, .. } = request;
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
    let found = folder.find(study, &digest, scope.shard)?;
    if let Some(manifest) = found.finished().filter(|own| is_complete(own, study)) {
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
    let held = { found.finished() }.map_or(scope.held, |manifest| manifest.patterns);
    let job = Job {
        request,
        shard: scope.shard,
        clock,
        digest,
        goal: Goal::new(study, held),
        found,
        patterns,
        pool: pool_of(request.threads)?,
        progress,
    };
    if let Some(ended) = job.end_of_stored_rows()? {
        return job.publish(ended, None);
    }
    progress.stage(Stage::Reduce);
    let build = || source.build_watched(study, &model, Some(scope.model_cache), progress);
    let engine = job.pool.install(build)?;
    progress.stage(Stage::Tuned);
    let solve = || Facts::solve(engine.as_ref(), study, &job.digest, progress);
    let facts = job.pool.install(solve);
    let ended = job.solve_to_an_end(engine.as_ref(), &facts, &mut folder)?;
    job.publish(ended, Some(engine.as_ref()))
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
    /// Of `stored` rows, `solved` are those of this run.
    fn of(stored: u64, solved: u64) -> Self {
        Self {
            solved,
            reused: stored - solved,
        }
    }

    fn stored(self) -> u64 {
        self.solved + self.reused
    }
}

/// A run that has something to do, with what its steps need.
struct Job<'a> {
    request: RunRequest<'a>,
    shard: Option<Shard>,
    clock: Clock,
    digest: StudyDigest,
    goal: Goal,
    found: Found,
    patterns: PatternSource,
    pool: ThreadPool,
    progress: &'a dyn Progress,
}

/// The rows that a study ends with.
struct Ended<'a> {
    /// The tables to be made of them.
    tables: TableWork<'a>,
    /// Where they are stored.
    store: RowStore,
    /// What the stopping rule of the study saw, if it has one.
    stop: Option<StopOutcome>,
    /// How many of them this run solved.
    solved: u64,
}

impl Job<'_> {
    /// The tables of the first `size` patterns, or of the share that a shard has of these.
    fn tables(&self, size: u64, facts: Facts) -> TableWork<'_> {
        let all = self.patterns.ids();
        let first = &all[..all.len().min(size as usize)];
        let ids = self.shard.map_or(first, |shard| shard.of(first)).to_vec();
        let (study, share) = (self.request.study, (self.shard, ids));
        TableWork::new(study, &self.digest, &self.patterns, share, facts)
    }

    /// The end of the study if no row of it is to be solved, and nothing else needs an engine.
    fn end_of_stored_rows(&self) -> Result<Option<Ended<'_>>, PipelineError> {
        match self.facts_of_stored_rows() {
            // Motions are looked at by an engine.
            Some((size, facts)) if !TableWork::wants_engine(self.request.study, self.shard) => {
                self.look(self.tables(size, facts), 0)
            }
            _ => Ok(None),
        }
    }

    /// What the tables of the first patterns, up to the first possible end, are made from, if all of
    /// their rows are stored: in another order, with other tables asked for, or another rule to stop.
    fn facts_of_stored_rows(&self) -> Option<(u64, Facts)> {
        let &size = self.goal.ends().first()?;
        let manifest = { self.found.finished() }.filter(|own| own.patterns == size)?;
        Some((size, Facts::stored(manifest, self.request.study)?))
    }

    /// Solves the rows up to one possible end after the other, until the study ends.
    fn solve_to_an_end(
        &self,
        engine: &dyn Engine,
        facts: &Facts,
        folder: &mut ResultsFolder,
    ) -> Result<Ended<'_>, PipelineError> {
        let results = self.request.results;
        let mut solved = 0;
        for &size in self.goal.ends() {
            let tables = self.tables(size, facts.clone());
            let rows = self.solve(engine, &tables, folder)?;
            solved += rows.solved;
            let (stored, planned) = (rows.stored(), tables.planned());
            if stored < planned {
                // Tables are made at an end only.
                self.record(RowCounts::of(stored, solved), BTreeMap::new())?;
                return Err(PipelineError::Interrupted {
                    folder: results.to_owned(),
                    stored,
                    planned,
                });
            }
            if let Some(ended) = self.look(tables, solved)? {
                return Ok(ended);
            }
        }
        Err(PipelineError::Unfinished {
            folder: results.to_owned(),
        })
    }

    /// Rows of the finished study for those of `scenarios` that it has, at most `patterns` of each.
    fn held_rows(&self, scenarios: &[Scenario], patterns: u64) -> u64 {
        let Some(manifest) = self.found.finished() else {
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
        let finished = { self.found.manifest() }
            .map_or_else(Vec::new, |manifest| finished_rows(results, manifest));
        Ok(RowStore::open(results, tables.schema().clone(), finished)?)
    }

    /// Solves the rows that are not stored yet.
    fn solve(
        &self,
        engine: &dyn Engine,
        tables: &TableWork,
        folder: &mut ResultsFolder,
    ) -> Result<RowCounts, PipelineError> {
        let results = self.request.results;
        if self.found.finished().is_none() {
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
            let why = { self.found.manifest() }
                .map_or_else(String::new, |stored| why_anew(stored, &tables.unfinished()));
            self.progress.solves_anew(anew, &why);
        }
        let at_a_time = self.pool.current_num_threads() * scenarios.len();
        self.progress.rows_at_a_time(at_a_time as u64);
        self.progress.begin_rows(tables.planned(), reused);
        let rows = RowWork {
            engine,
            patterns: &self.patterns,
            scenarios,
            tuned: tables.tuned(),
            progress: self.progress,
        };
        let mut sink = PartSink::new(results, tables.schema())?;
        let solved = solve_blocks(
            &self.pool,
            &blocks,
            |block, id| rows.of_pattern(id, &block.scenarios),
            &mut sink,
            &Stop(self.progress),
        )?;
        sink.close()?;
        Ok(RowCounts { solved, reused })
    }

    /// The end of the study, if it ends with the rows of `tables`, which are stored; `solved` are those
    /// of this run.
    fn look<'a>(
        &self,
        tables: TableWork<'a>,
        solved: u64,
    ) -> Result<Option<Ended<'a>>, PipelineError> {
        let store = self.store(&tables)?;
        let scenarios = tables.schema().scenarios.len();
        let look = || self.goal.look(&store, tables.ids(), scenarios);
        let verdict = self.pool.install(look)?;
        Ok(verdict.ends.then_some(Ended {
            tables,
            store,
            stop: verdict.outcome,
            solved,
        }))
    }

    /// Writes the tables of the rows that the study ends with, and the record of this run.
    fn publish(
        &self,
        ended: Ended<'_>,
        engine: Option<&dyn Engine>,
    ) -> Result<RunOutcome, PipelineError> {
        self.progress.stage(Stage::Tables);
        let Ended {
            tables,
            store,
            stop,
            solved,
        } = ended;
        let rows = RowCounts::of(tables.planned(), solved);
        let publish = || tables.publish(&store, self.request.results, stop, engine);
        let (manifest, summary) = self.pool.install(publish)?;
        self.record(rows, manifest.tables)?;
        Ok(RunOutcome {
            summary,
            rows_solved: rows.solved,
            rows_reused: rows.reused,
        })
    }

    /// Writes down this run, with the digests of the tables that it made.
    fn record(
        &self,
        rows: RowCounts,
        tables: BTreeMap<String, String>,
    ) -> Result<(), PipelineError> {
        let RunRequest { study, threads, .. } = self.request;
        let record = self.clock.record(&study.path, threads, rows, tables);
        Ok(record.write(self.request.results)?)
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
