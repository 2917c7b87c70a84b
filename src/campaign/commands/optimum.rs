//! Search for the normal load with the lowest percentile: the same patterns at every load.
//!
//! Loads that are solved already on the same patterns, in the results of the study or by an earlier search,
//! count like those that the search solves itself. Each of its own is a run of the study in a folder of its
//! own, so that a search that was interrupted continues and nothing is solved twice.
//! All loads see the same patterns (common random numbers), which takes most of the sampling error out
//! of their differences. A ring serves every load case and engine order of its wheel, so that where there are
//! several, the percentile is that of the largest value of each wheel over them.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

use super::compare::{best_loads, same_patterns};
use super::load_search::{LoadRange, four_digits};
use super::searchable::refuse;
use super::solved_loads::{Holding, SolvedLoad, cpu_s_per_row, solved_loads, study_at};
use crate::campaign::pipeline::{RunRequest, run};
use crate::campaign::store::{ResultColumns, ResultsFolder, folders_of_loads, sorted_values};
use crate::population::statistics::{Quantity, percentile};
use crate::population::table::is_folder;
use crate::report::{
    ComparedScenario, ExpectedCost, ExpectedTime, OptimumExcitation, OptimumReport,
};
use crate::response::forced_response::ContactCondition;
use crate::response::harmonic_balance::Status;
use crate::settings::{AccuracyChoice, EngineSource, Progress, Stage};
use crate::study::{PipelineError, Study, load_sector_model};

/// Loads solved at most.
const MOST_LOADS: usize = 24;

/// Rows solved on each thread, and seconds, after which the time of the remaining rows is estimated where nothing else says it.
const TIMED_ROWS: u64 = 4;
const TIMED_S: f64 = 1.0;

/// What to search.
#[derive(Debug, Clone, Copy)]
pub struct OptimumRequest<'a> {
    /// The study; its loads are not used.
    pub study: &'a Study,
    /// Folder of the search: one results folder per load.
    pub results: &'a Path,
    /// Results folder of the study, whose loads are not solved again; it need not be there.
    pub solved: &'a Path,
    /// Lowest and highest normal load per sector, N.
    pub between_n: [f64; 2],
    /// The percentile in percent.
    pub percent: f64,
    /// The quantity.
    pub quantity: Quantity,
    /// Ratio of the loads that enclose the best one, less 1, at which the search ends.
    pub resolution: f64,
    /// Number of threads.
    pub threads: usize,
}

/// Searches as `request` says.
///
/// # Errors
/// The study has several standard deviations, no contact, or too few patterns for the percentile; or a run
/// failed.
pub fn find_optimum(
    request: OptimumRequest<'_>,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<OptimumReport, PipelineError> {
    refuse(request.study, request.percent)?;
    let settled = settled(&request)?;
    let [low, high] = request.between_n;
    let mut search = Search {
        request: OptimumRequest {
            study: &settled,
            ..request
        },
        range: LoadRange {
            low: four_digits(low),
            high: four_digits(high),
            resolution: request.resolution,
        },
        source,
        progress,
        loads: Vec::new(),
        solved: 0,
    };
    search.take_over()?;
    let ended = search.solve()?;
    search.report(ended)
}

/// The study of a search: settings by `[accuracy]` are chosen once, at both ends and between them, so
/// that every load has the same.
fn settled(request: &OptimumRequest<'_>) -> Result<Study, PipelineError> {
    let mut study = request.study.clone();
    let Some(accuracy) = study.accuracy else {
        return Ok(study);
    };
    let [low, high] = request.between_n;
    study.contacts = [low, (low * high).sqrt(), high]
        .map(|normal_load_n| ContactCondition::Full { normal_load_n })
        .to_vec();
    let sector = load_sector_model(&study)?;
    let cache = request.results.join("model");
    is_folder(&cache)?;
    let choice = AccuracyChoice::of(&study, accuracy, &sector, Some(&cache))?;
    Ok(choice.applied_to(request.study))
}

/// A load with its values.
struct Load {
    normal_load_n: f64,
    columns: ResultColumns,
    /// Value of each pattern: the largest over load cases and engine orders.
    largest: Vec<Option<f64>>,
    /// Their percentile; infinite where failures leave it without a value.
    value: f64,
}

struct Search<'a> {
    request: OptimumRequest<'a>,
    range: LoadRange,
    source: &'a dyn EngineSource,
    progress: &'a dyn Progress,
    /// Ascending.
    loads: Vec<Load>,
    /// Loads that this search has solved, now or before.
    solved: usize,
}

impl Search<'_> {
    /// Takes over the loads that are solved already, and says what the others will cost.
    fn take_over(&mut self) -> Result<(), PipelineError> {
        let (study, folder) = (self.request.study, self.request.solved);
        let mut taken = Vec::new();
        let mut cpu_s = None;
        let mut unused = String::new();
        match solved_loads(study, folder)? {
            Holding::Nothing => {}
            Holding::Other(reason) => {
                unused = format!(" (no load of {} is taken: {reason})", folder.display());
            }
            Holding::Loads(loads) => {
                for load in loads {
                    if self.range.contains(load.normal_load_n) {
                        cpu_s = cpu_s.or_else(|| cpu_s_per_row(folder, &load.columns));
                        taken.push(format!("{} N", load.normal_load_n));
                        self.add(load);
                    }
                }
            }
        }
        for (normal_load_n, folder) in folders_of_loads(self.request.results) {
            if !self.range.contains(normal_load_n) || self.knows(normal_load_n) {
                continue;
            }
            // Takes away what a search that was killed left there.
            drop(ResultsFolder::open(&folder)?);
            if let Holding::Loads(loads) = solved_loads(study, &folder)? {
                // The name of the folder promises one load; whatever else its results hold was not asked for here.
                let named =
                    |load: &SolvedLoad| load.normal_load_n.total_cmp(&normal_load_n).is_eq();
                for load in loads.into_iter().filter(named) {
                    taken.push(format!("{} N", load.normal_load_n));
                    cpu_s = cpu_s.or_else(|| cpu_s_per_row(&folder, &load.columns));
                    self.solved += 1;
                    self.add(load);
                }
            }
        }
        self.announce(&taken, &unused, cpu_s);
        Ok(())
    }

    fn announce(&self, taken: &[String], unused: &str, cpu_s_per_row: Option<f64>) {
        let loads = self.range.expected(&self.values(), self.left());
        let rows = loads as u64 * self.rows_of_a_load();
        let from = if taken.is_empty() {
            "no load is solved yet".to_owned()
        } else {
            format!("solved already: {}", taken.join(", "))
        };
        let of = |cpu_s: f64| cpu_s * rows as f64;
        self.progress.cost(&ExpectedCost {
            what: format!("{from}{unused}; about {loads} loads to solve"),
            rows,
            time: cpu_s_per_row
                .map(of)
                .or((loads == 0).then_some(0.0))
                .map(|cpu_s| ExpectedTime {
                    cpu_s,
                    wall_s: cpu_s / self.request.threads as f64,
                    threads: self.request.threads,
                    measured_on: "the rows that are solved".to_owned(),
                }),
        });
    }

    fn rows_of_a_load(&self) -> u64 {
        let scenarios = study_at(self.request.study, self.range.low).scenarios();
        u64::from(self.request.study.patterns) * scenarios.len() as u64
    }

    /// Loads that may still be solved.
    fn left(&self) -> usize {
        MOST_LOADS.saturating_sub(self.solved)
    }

    /// The loads and their percentiles, ascending.
    fn values(&self) -> Vec<(f64, f64)> {
        let loads = self.loads.iter();
        loads.map(|load| (load.normal_load_n, load.value)).collect()
    }

    fn knows(&self, normal_load_n: f64) -> bool {
        let same = |load: &Load| load.normal_load_n.total_cmp(&normal_load_n).is_eq();
        self.loads.iter().any(same)
    }

    /// Solves loads until those that enclose the best one are as close as wanted, and says whether they are.
    fn solve(&mut self) -> Result<bool, PipelineError> {
        while let Some(normal_load_n) = self.range.next(&self.values()) {
            if self.left() == 0 {
                return Ok(false);
            }
            self.solve_load(normal_load_n)?;
        }
        Ok(true)
    }

    fn solve_load(&mut self, normal_load_n: f64) -> Result<(), PipelineError> {
        let folder = self.folder(normal_load_n);
        is_folder(&folder)?;
        let study = study_at(self.request.study, normal_load_n);
        let run_request = RunRequest {
            study: &study,
            results: &folder,
            threads: self.request.threads,
        };
        // Where no finished run says what a row takes, the first rows do.
        let loads = 1 + self.range.expected(&self.values(), self.left() - 1);
        let timed = Timed::new(
            self.progress,
            loads as u64 * self.rows_of_a_load(),
            &run_request,
        );
        let progress = if self.loads.is_empty() {
            &timed as &dyn Progress
        } else {
            self.progress
        };
        run(run_request, self.source, progress)?;
        self.solved += 1;
        self.add(SolvedLoad {
            normal_load_n,
            columns: ResultColumns::read(&folder)?,
        });
        Ok(())
    }

    fn add(&mut self, load: SolvedLoad) {
        let SolvedLoad {
            normal_load_n,
            columns,
        } = load;
        let largest = columns.largest(self.request.quantity);
        let (sorted, failed) = sorted_values(&largest);
        let found = percentile(&sorted, failed, self.request.percent);
        let place = self
            .loads
            .partition_point(|load| load.normal_load_n < normal_load_n);
        self.loads.insert(
            place,
            Load {
                normal_load_n,
                columns,
                largest,
                value: found.value.unwrap_or(f64::INFINITY),
            },
        );
    }

    fn folder(&self, normal_load_n: f64) -> PathBuf {
        self.request.results.join(format!("load-{normal_load_n}"))
    }

    fn report(self, resolved: bool) -> Result<OptimumReport, PipelineError> {
        let request = &self.request;
        let alike = self
            .loads
            .windows(2)
            .all(|pair| same_patterns(&pair[0].columns, &pair[1].columns));
        if !alike {
            return Err(no_patterns_in_common());
        }
        let scenarios = 0..self.loads[0].columns.scenarios.len();
        let alone = scenarios.map(|scenario| self.under(scenario));
        let mut excitations = alone.collect::<Result<Vec<OptimumExcitation>, _>>()?;
        let columns: Vec<_> = self
            .loads
            .iter()
            .enumerate()
            .map(|(place, load)| {
                let highest = highest_at(place, &excitations);
                (self.name(place, highest), load.largest.as_slice())
            })
            .collect();
        let best = best_loads(&columns, request.percent, request.study.seed)
            .ok_or_else(no_patterns_in_common)?;
        if excitations.len() == 1 {
            excitations.clear();
        }
        let possible: Vec<usize> = (0..best.loads.len())
            .filter(|&place| best.loads[place].could_be_best)
            .collect();
        let load = |place: usize| self.loads[place].normal_load_n;
        let below = possible.first().and_then(|first| first.checked_sub(1));
        let above = possible.last().map(|last| last + 1);
        Ok(OptimumReport {
            name: request.study.name.clone(),
            seed: request.study.seed,
            patterns: u64::from(request.study.patterns),
            percent: request.percent,
            quantity: request.quantity,
            normal_load_n: best.lowest.map(load),
            normal_load_lower_n: below.map(load),
            normal_load_upper_n: above.filter(|&place| place < self.loads.len()).map(load),
            resolved,
            best,
            excitations,
        })
    }

    /// The loads solved under one scenario alone.
    fn under(&self, scenario: usize) -> Result<OptimumExcitation, PipelineError> {
        let request = &self.request;
        let loads = self.loads.iter().enumerate();
        let columns: Vec<_> = loads
            .map(|(place, load)| {
                let values = load.columns.scenarios[scenario].values(request.quantity);
                (self.name(place, scenario), values)
            })
            .collect();
        let best = best_loads(&columns, request.percent, request.study.seed)
            .ok_or_else(no_patterns_in_common)?;
        let excitation = &self.loads[0].columns.scenarios[scenario].scenario;
        Ok(OptimumExcitation {
            load_case: excitation.load_case,
            engine_order: excitation.engine_order,
            normal_load_n: best.lowest.map(|place| self.loads[place].normal_load_n),
            best,
        })
    }

    /// A scenario of the load at `place`, named by that place.
    fn name(&self, place: usize, scenario: usize) -> ComparedScenario {
        let compared = &self.loads[place].columns.scenarios[scenario].scenario;
        ComparedScenario {
            scenario: place,
            ..ComparedScenario::new(place, compared)
        }
    }
}

/// The first of the excitations with the highest percentile at the load at `place`; failures leave it infinite.
fn highest_at(place: usize, excitations: &[OptimumExcitation]) -> usize {
    let value = |excitation: &OptimumExcitation| {
        let percentile = &excitation.best.loads[place].percentile;
        percentile.value.unwrap_or(f64::INFINITY)
    };
    (0..excitations.len())
        .rev()
        .max_by(|&a, &b| value(&excitations[a]).total_cmp(&value(&excitations[b])))
        .unwrap_or(0)
}

fn no_patterns_in_common() -> PipelineError {
    PipelineError::NoOptimum {
        reason: "the loads have no patterns in common".to_owned(),
    }
}

/// Passes everything on, and says what all rows will take once the first of them are solved.
struct Timed<'a> {
    progress: &'a dyn Progress,
    rows: u64,
    threads: usize,
    /// When rows began, and how many are solved since.
    began: Mutex<Option<(Instant, u64)>>,
}

impl<'a> Timed<'a> {
    fn new(progress: &'a dyn Progress, rows: u64, request: &RunRequest<'_>) -> Self {
        Self {
            progress,
            rows,
            threads: request.threads,
            began: Mutex::new(None),
        }
    }

    /// Time of a row so far, once; none before there are enough.
    fn timed(&self) -> Option<f64> {
        let mut began = self.began.lock().ok()?;
        let (start, solved) = began.as_mut()?;
        *solved += 1;
        let seconds = start.elapsed().as_secs_f64();
        let enough = *solved >= TIMED_ROWS * self.threads as u64 && seconds >= TIMED_S;
        let wall_s = enough.then(|| seconds / *solved as f64);
        if enough {
            *began = None;
        }
        wall_s
    }
}

impl Progress for Timed<'_> {
    fn stage(&self, stage: Stage) {
        self.progress.stage(stage);
    }

    fn step(&self, words: &str) {
        self.progress.step(words);
    }

    fn rows_at_a_time(&self, rows: u64) {
        self.progress.rows_at_a_time(rows);
    }

    fn begin_rows(&self, planned: u64, done: u64) {
        if let Ok(mut began) = self.began.lock() {
            *began = Some((Instant::now(), 0));
        }
        self.progress.begin_rows(planned, done);
    }

    fn row(&self, status: Status) {
        if let Some(wall_s) = self.timed() {
            let wall_s = wall_s * self.rows as f64;
            self.progress.cost(&ExpectedCost {
                what: "the loads to solve".to_owned(),
                rows: self.rows,
                time: Some(ExpectedTime {
                    cpu_s: wall_s * self.threads as f64,
                    wall_s,
                    threads: self.threads,
                    measured_on: "the first rows".to_owned(),
                }),
            });
        }
        self.progress.row(status);
    }

    fn cost(&self, cost: &ExpectedCost) {
        self.progress.cost(cost);
    }

    fn taken_over(&self, holder: &str) {
        self.progress.taken_over(holder);
    }

    fn stop_requested(&self) -> bool {
        self.progress.stop_requested()
    }

    fn saved(&self) {
        self.progress.saved();
    }
}
