//! Mean and percentiles of a study from few solves: a surrogate of every pattern where it pays, a sample of rows.
//!
//! Rows are stored as those of a run are, so that an estimate that was interrupted, or that is to have
//! more solves, continues. The sample of each scenario depends on the seed, the ids and the pilot
//! alone.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::ThreadPool;
use rayon::prelude::*;

use super::estimate_sample::Sample;
use crate::campaign::pipeline::{Clock, Facts, RowCounts, Stop, pool_of};
use crate::campaign::store::ResultsFolder;
use crate::identity;
use crate::platform::thread_processor_time_s;
use crate::population::monte_carlo::{
    ResponseRow, Scenario, SurrogatePeak, TunedReference, block_size, counted_time, plan_blocks,
    solve_blocks,
};
use crate::population::statistics::{
    Accounting, EstimateTarget, Population, Quantity, SurrogateWorth, TwoPhaseSample, pilot_places,
};
use crate::population::table::{
    EstimateRow, MANIFEST, PartSink, RowSchema, RowStore, TableHeader, write_atomically,
    write_estimate, write_sample,
};
use crate::report::{EstimateReport, ScenarioEstimate};
use crate::response::mistuning::PatternSource;
use crate::settings::{Engine, EngineSource, Progress, RowWork, Stage, SurrogateOf};
use crate::study::{
    MistuningSource, PipelineError, Study, StudyDigest, load_sector_model, pattern_source,
};

/// Fewest solves that an estimate is made of.
const FEWEST_SOLVES: u32 = 60;
/// Patterns whose surrogates are found between looks at whether to stop.
const CHUNK: usize = 1024;

/// What to estimate.
#[derive(Debug, Clone, Copy)]
pub struct EstimateRequest<'a> {
    /// The study; its patterns are the population.
    pub study: &'a Study,
    /// Folder of the estimate.
    pub results: &'a Path,
    /// Patterns that are solved in each scenario at most.
    pub solves: u32,
    /// What they are to tell best.
    pub target: EstimateTarget,
    /// Number of threads.
    pub threads: usize,
}

/// Estimates as `request` says, and writes `sample.parquet`, `estimate.json` and `summary.txt`.
///
/// # Errors
/// Too few solves or patterns, the folder holds something else, or a stage failed; what is stored stays
/// stored, and the same call continues.
pub fn estimate(
    request: EstimateRequest<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<EstimateReport, PipelineError> {
    refuse(&request)?;
    let EstimateRequest { study, results, .. } = request;
    let clock = Clock::start();
    let digest = StudyDigest::of(study)?;
    let mut folder = ResultsFolder::open(results)?;
    if let Some(holder) = folder.broken_off() {
        progress.taken_over(&holder.to_string());
    }
    folder.check_parts()?;
    progress.stage(Stage::LoadModel);
    let model = load_sector_model(study)?;
    let patterns = pattern_source(study, &model)?;
    let pool = pool_of(request.threads)?;
    progress.stage(Stage::Reduce);
    let engine = pool
        .install(|| source.build_watched(study, &model, Some(&results.join("model")), progress))?;
    progress.stage(Stage::Tuned);
    let facts = pool.install(|| Facts::solve(engine.as_ref(), study, &digest, progress));
    let work = Work {
        request,
        engine: engine.as_ref(),
        patterns: &patterns,
        ids: patterns.ids(),
        pool: &pool,
        header: TableHeader {
            study_digest: digest.hex(),
            compression: study.output.compression,
            load_cases: TableHeader::load_cases_of(&study.scenarios()),
        },
        progress,
        row_times: MeasuredTimes::default(),
        surrogate_times: MeasuredTimes::default(),
    };
    let mut rows = Vec::new();
    let mut scenarios: Vec<ScenarioEstimate> = Vec::new();
    for (scenario, tuned) in study.scenarios().iter().zip(&facts.tuned) {
        let row_digest = &facts.row_digests[scenario.index];
        let (found, solved) = work.scenario(scenario, tuned, row_digest, &mut folder)?;
        scenarios.push(found);
        rows.extend(solved);
    }
    progress.stage(Stage::Tables);
    let sample_digest = write_sample(results, &rows, &work.header)?;
    let counts = RowCounts {
        solved: scenarios.iter().map(|found| found.rows.planned()).sum(),
        reused: 0,
    };
    let report = EstimateReport {
        name: study.name.clone(),
        version: identity::VERSION.to_owned(),
        build: identity::BUILD.to_owned(),
        study_digest: digest.hex(),
        seed: study.seed,
        patterns: work.ids.len() as u64,
        solves: u64::from(request.solves),
        target: request.target,
        study: study.resolved(),
        inputs: digest.inputs.clone(),
        reduction: facts.reduction,
        chosen: facts.chosen,
        sample_digest,
        scenarios,
    };
    write_estimate(results, &report)?;
    write_atomically(&results.join("summary.txt"), report.to_string().as_bytes())?;
    clock
        .record(&study.path, request.threads, counts, BTreeMap::new())
        .write(results)?;
    Ok(report)
}

/// What cannot be estimated.
fn refuse(request: &EstimateRequest<'_>) -> Result<(), PipelineError> {
    let (solves, patterns) = (request.solves, request.study.patterns);
    let reason = if solves < FEWEST_SOLVES {
        format!("{solves} solves are too few; accepted: --solves of at least {FEWEST_SOLVES}")
    } else if solves > patterns {
        format!(
            "{solves} solves are more than the {patterns} patterns; accepted: --patterns of at least {solves}, best ten times as many"
        )
    } else if matches!(request.study.mistuning.source, MistuningSource::File { .. }) {
        "the patterns of a file are no sample of a law; accepted: a study with [mistuning] distribution"
            .to_owned()
    } else if request.results.join(MANIFEST).exists() {
        format!(
            "{} holds the results of a run; accepted: --out with a folder of its own",
            request.results.display()
        )
    } else {
        return Ok(());
    };
    Err(PipelineError::NoEstimate { reason })
}

/// All that the estimate of a scenario needs.
struct Work<'a> {
    request: EstimateRequest<'a>,
    engine: &'a dyn Engine,
    patterns: &'a PatternSource,
    ids: Vec<u32>,
    pool: &'a ThreadPool,
    header: TableHeader,
    progress: &'a dyn Progress,
    /// Processor time that rows took.
    row_times: MeasuredTimes,
    /// Processor time that surrogates took.
    surrogate_times: MeasuredTimes,
}

/// Processor times of tasks of one kind, as they are measured: told, never part of a choice.
#[derive(Default)]
struct MeasuredTimes {
    nanoseconds: AtomicU64,
    tasks: AtomicU64,
}

impl MeasuredTimes {
    /// Runs a task and adds its time, where the system tells it.
    fn of<T>(&self, task: impl FnOnce() -> T) -> T {
        let began = thread_processor_time_s();
        let result = task();
        if let Some((began, ended)) = began.zip(thread_processor_time_s()) {
            let nanoseconds = (1e9 * (ended - began)) as u64;
            self.nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
            self.tasks.fetch_add(1, Ordering::Relaxed);
        }
        result
    }

    /// Mean time of a task, s.
    fn mean_s(&self) -> Option<f64> {
        let tasks = self.tasks.load(Ordering::Relaxed);
        let nanoseconds = self.nanoseconds.load(Ordering::Relaxed);
        (tasks > 0).then(|| 1e-9 * nanoseconds as f64 / tasks as f64)
    }
}

/// Solved rows by pattern.
type Solved = BTreeMap<u32, ResponseRow>;

impl Work<'_> {
    /// The estimate of one scenario, and its rows.
    fn scenario(
        &self,
        scenario: &Scenario,
        tuned: &TunedReference,
        row_digest: &str,
        folder: &mut ResultsFolder,
    ) -> Result<(ScenarioEstimate, Vec<EstimateRow>), PipelineError> {
        // The rows are stored as those of a study with this scenario alone.
        let only = Rows {
            work: self,
            schema: RowSchema {
                scenarios: vec![Scenario {
                    index: 0,
                    ..*scenario
                }],
                row_digests: vec![row_digest.to_owned()],
                header: TableHeader {
                    load_cases: scenario.load_case.into_iter().collect(),
                    ..self.header.clone()
                },
            },
            tuned: TunedReference {
                scenario: 0,
                ..tuned.clone()
            },
        };
        let solves = self.request.solves as usize;
        let pilot = pilot_places(self.request.study.seed, &self.ids, solves);
        let of_pilot = only.solve(&pilot, folder)?;
        let worth = self.worth(scenario, tuned, &pilot, &of_pilot);
        let surrogates = if worth.is_some_and(|worth| worth.pays()) {
            self.surrogates(scenario, tuned)?
        } else {
            vec![None; self.ids.len()]
        };
        let population = Population::new(
            self.request.study.seed,
            &self.ids,
            &surrogates,
            self.request.target,
        );
        let amplitudes: Vec<Option<f64>> = pilot
            .iter()
            .map(|&place| Quantity::PeakAmplitudeM.of(of_pilot.get(&self.ids[place])?))
            .collect();
        let allocation = population.allocate(solves, &amplitudes);
        let places = population.sample(&allocation);
        let solved = only.solve(&places, folder)?;
        let sample = Sample {
            population: &population,
            allocation: &allocation,
            rows: places
                .iter()
                .filter_map(|&place| Some((place, solved.get(&self.ids[place])?)))
                .collect(),
            surrogates: &surrogates,
        };
        let in_pilot: BTreeSet<usize> = pilot.iter().copied().collect();
        let rows = (0..self.ids.len())
            .map(|place| EstimateRow {
                scenario: *scenario,
                pattern: self.ids[place],
                surrogate_amplitude_m: surrogates[place],
                stratum: sample.stratum(place),
                inclusion_probability: sample.inclusion_probability(place),
                pilot: in_pilot.contains(&place),
                row: solved.get(&self.ids[place]).cloned(),
            })
            .collect();
        let strata = sample.strata(Quantity::PeakAmplitudeM);
        let of_amplitude = TwoPhaseSample::new(strata, None);
        let found = ScenarioEstimate {
            scenario: scenario.index,
            contact: scenario.contact.name().to_owned(),
            load_case: scenario.load_case,
            engine_order: scenario.engine_order,
            normal_load_n: scenario.contact.normal_load_n(),
            standard_deviation: scenario.standard_deviation,
            tuned_amplitude_m: tuned.amplitude_m,
            without_surrogate: surrogates.iter().filter(|value| value.is_none()).count() as u64,
            pilot: pilot.len() as u64,
            strata: sample.sizes(),
            rows: sample
                .rows
                .iter()
                .map(|(_, row)| row.status)
                .collect::<Accounting>(),
            failed_share: of_amplitude.failed_share(),
            largest_weight: of_amplitude.largest_weight(),
            quantities: Quantity::ALL
                .into_iter()
                .map(|quantity| sample.estimate(quantity, self.request.target))
                .collect(),
            allocation: allocation.clone(),
            surrogates: worth,
        };
        Ok((found, rows))
    }

    /// What surrogates of all patterns are worth, by those of the pilot and its rows; none where that cannot be told.
    ///
    /// Times are counted from the work of surrogates and rows, not measured: the same sample is drawn on every machine
    /// and with any number of threads.
    fn worth(
        &self,
        scenario: &Scenario,
        tuned: &TunedReference,
        pilot: &[usize],
        solved: &Solved,
    ) -> Option<SurrogateWorth> {
        self.progress.stage(Stage::Surrogates);
        let surrogate = self.engine.surrogate(scenario, tuned)?;
        let found: Vec<Option<SurrogatePeak>> = self.pool.install(|| {
            let ids = pilot.par_iter().map(|&place| self.ids[place]);
            ids.map(|id| self.surrogate_of(&surrogate, scenario, id))
                .collect()
        });
        let times = self.surrogate_times.mean_s().zip(self.row_times.mean_s());
        if let Some((surrogate_s, row_s)) = times {
            self.progress.surrogate_times(surrogate_s, row_s);
        }
        let rows: Vec<&ResponseRow> = pilot
            .iter()
            .filter_map(|&place| solved.get(&self.ids[place]))
            .collect();
        let pairs: Vec<(Option<f64>, Option<f64>)> = pilot
            .iter()
            .zip(&found)
            .map(|(&place, surrogate)| {
                let row = solved.get(&self.ids[place]);
                let value = row.and_then(|row| Quantity::PeakAmplitudeM.of(row));
                (surrogate.map(|peak| peak.amplitude_m), value)
            })
            .collect();
        let cost = self.engine.solvers().map_or(0.0, |solvers| {
            let solver = solvers.under(scenario).rows();
            let of_rows = rows.iter().map(|row| counted_time(solver, scenario, row));
            let of_surrogates = found.iter().flatten().map(|peak| peak.counted_time);
            mean(of_surrogates) / mean(of_rows)
        });
        SurrogateWorth::of_pilot(
            self.ids.len(),
            self.request.solves as usize,
            &pairs,
            self.request.target,
            cost,
        )
    }

    /// Surrogate of a pattern; none where it has none.
    fn surrogate_of(
        &self,
        surrogate: &SurrogateOf<'_>,
        scenario: &Scenario,
        id: u32,
    ) -> Option<SurrogatePeak> {
        let pattern = self.patterns.pattern(id, scenario.standard_deviation)?;
        let found = || catch_unwind(AssertUnwindSafe(|| surrogate(&pattern)));
        self.surrogate_times.of(found).unwrap_or(None)
    }

    /// Surrogate amplitude of every pattern, m.
    fn surrogates(
        &self,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Result<Vec<Option<f64>>, PipelineError> {
        self.progress.stage(Stage::Surrogates);
        let Some(surrogate) = self.engine.surrogate(scenario, tuned) else {
            return Ok(vec![None; self.ids.len()]);
        };
        let of_pattern = |id: u32| {
            let found = self.surrogate_of(&surrogate, scenario, id)?;
            Some(found.amplitude_m)
        };
        let mut values = Vec::with_capacity(self.ids.len());
        for ids in self.ids.chunks(CHUNK) {
            if self.progress.stop_requested() {
                return Err(self.interrupted(0, u64::from(self.request.solves)));
            }
            let found: Vec<_> = self
                .pool
                .install(|| ids.par_iter().map(|&id| of_pattern(id)).collect());
            values.extend(found);
        }
        Ok(values)
    }

    fn interrupted(&self, stored: u64, planned: u64) -> PipelineError {
        PipelineError::Interrupted {
            folder: self.request.results.to_owned(),
            stored,
            planned,
        }
    }
}

fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.fold((0.0, 0_u32), |(sum, count), number| {
        (sum + number, count + 1)
    });
    sum / f64::from(count)
}

/// Rows of one scenario.
struct Rows<'a> {
    work: &'a Work<'a>,
    schema: RowSchema,
    tuned: TunedReference,
}

impl Rows<'_> {
    /// Rows of the patterns at `places`: those stored, and those solved now.
    fn solve(&self, places: &[usize], folder: &mut ResultsFolder) -> Result<Solved, PipelineError> {
        let Work {
            request, progress, ..
        } = *self.work;
        let mut ids: Vec<u32> = places.iter().map(|&place| self.work.ids[place]).collect();
        ids.sort_unstable();
        let stored = self.store()?.stored()?;
        let planned = ids.len() as u64;
        let reused = stored.count(&ids);
        progress.stage(Stage::Rows);
        folder.announce(planned, reused)?;
        progress.rows_at_a_time(self.work.pool.current_num_threads() as u64);
        progress.begin_rows(planned, reused);
        let rows = RowWork {
            engine: self.work.engine,
            patterns: self.work.patterns,
            scenarios: &self.schema.scenarios,
            tuned: std::slice::from_ref(&self.tuned),
            progress,
        };
        let mut sink = PartSink::new(request.results, &self.schema)?;
        let solved = solve_blocks(
            self.work.pool,
            &plan_blocks(&ids, &stored, 1, block_size(ids.len())),
            |block, id| {
                let times = &self.work.row_times;
                times.of(|| rows.of_pattern(id, &block.scenarios))
            },
            &mut sink,
            &Stop(progress),
        )?;
        sink.close()?;
        if reused + solved < planned {
            return Err(self.work.interrupted(reused + solved, planned));
        }
        let mut found = Solved::new();
        self.store()?.visit(|row| {
            if ids.binary_search(&row.pattern).is_ok() {
                found.insert(row.pattern, row);
            }
            Ok(())
        })?;
        Ok(found)
    }

    fn store(&self) -> Result<RowStore, PipelineError> {
        let results = self.work.request.results;
        Ok(RowStore::open(results, self.schema.clone(), Vec::new())?)
    }
}
