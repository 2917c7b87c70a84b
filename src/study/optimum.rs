//! Search for the normal load with the lowest percentile: the same patterns at every load.
//!
//! Golden-section search (Kiefer 1953) over the logarithm of the load. Each load is a run of the study in
//! a folder of its own, so that a search that was interrupted continues and nothing is solved twice.
//! All loads see the same patterns (common random numbers), which takes most of the sampling error out
//! of their differences. A ring serves every load case and engine order of its wheel, so that where there are
//! several, the percentile is that of the largest value of each wheel over them.

use std::path::{Path, PathBuf};

use super::compare::{best_loads, same_patterns};
use super::result_columns::sorted_values;
use super::{
    AccuracyChoice, AccuracyOptions, EngineSource, PipelineError, Progress, ResultColumns,
    RunRequest, Study, load_sector_model, run,
};
use crate::population::statistics::CONFIDENCE;
use crate::population::statistics::{Quantity, percentile, smallest_sample};
use crate::population::table::is_folder;
use crate::report::{ComparedScenario, OptimumExcitation, OptimumReport};
use crate::response::forced_response::ContactCondition;

/// Golden ratio less 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Loads solved at most.
const MOST_LOADS: usize = 24;

/// What to search.
#[derive(Debug, Clone, Copy)]
pub struct OptimumRequest<'a> {
    /// The study; its loads are not used.
    pub study: &'a Study,
    /// Folder of the search: one results folder per load.
    pub results: &'a Path,
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
    refuse(&request)?;
    let settled = settled(&request)?;
    let mut search = Search {
        request: OptimumRequest {
            study: &settled,
            ..request
        },
        source,
        progress,
        loads: Vec::new(),
    };
    let [low, high] = request.between_n;
    let ended = search.golden_section(low, high)?;
    search.report(ended)
}

/// What a search cannot be made of.
fn refuse(request: &OptimumRequest<'_>) -> Result<(), PipelineError> {
    let study = request.study;
    let needed = smallest_sample(request.percent / 100.0, CONFIDENCE);
    let reason = if study.standard_deviations.len() != 1 {
        "a search takes a study with one standard deviation".to_owned()
    } else if study.contact.is_none() {
        "the study has no [contact], so there is no normal load to search".to_owned()
    } else if study.rotation.is_some() {
        "a search is over newtons; accepted: a study without contact.normal_load".to_owned()
    } else if u64::from(study.patterns) < needed {
        format!(
            "P{} of {} patterns has no interval; accepted: study.patterns from {needed} on",
            request.percent, study.patterns
        )
    } else {
        return Ok(());
    };
    Err(PipelineError::NoOptimum { reason })
}

/// The study of a search: settings by `[accuracy]` are chosen once, at both ends and between them, so
/// that every load has the same.
fn settled(request: &OptimumRequest<'_>) -> Result<Study, PipelineError> {
    let mut study = request.study.clone();
    let Some(accuracy) = study.accuracy else {
        return Ok(study);
    };
    // The folders of single loads hold the study at the settings chosen, in which a law in the place of another cannot be told.
    let accuracy = AccuracyOptions::within(accuracy.amplitude_error);
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

/// A load that was solved.
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
    source: &'a dyn EngineSource,
    progress: &'a dyn Progress,
    loads: Vec<Load>,
}

impl Search<'_> {
    /// Whether the loads that enclose the best one are as close as wanted.
    fn golden_section(&mut self, low: f64, high: f64) -> Result<bool, PipelineError> {
        let (mut a, mut b) = (low.ln(), high.ln());
        self.value(low)?;
        self.value(high)?;
        while self.loads.len() < MOST_LOADS {
            if (b - a).exp() - 1.0 <= self.request.resolution {
                return Ok(true);
            }
            let (left, right) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
            if self.value(left.exp())? <= self.value(right.exp())? {
                b = right;
            } else {
                a = left;
            }
        }
        Ok(false)
    }

    /// The percentile at a load, solved if it has not been.
    fn value(&mut self, normal_load_n: f64) -> Result<f64, PipelineError> {
        let normal_load_n = four_digits(normal_load_n);
        let known = |load: &&Load| load.normal_load_n.total_cmp(&normal_load_n).is_eq();
        if let Some(load) = self.loads.iter().find(known) {
            return Ok(load.value);
        }
        let folder = self.folder(normal_load_n);
        is_folder(&folder)?;
        let mut study = self.request.study.clone();
        study.contacts = vec![ContactCondition::Full { normal_load_n }];
        // Loads are compared over the same patterns, so that none may stop before the others.
        study.stop = None;
        let run_request = RunRequest {
            study: &study,
            results: &folder,
            threads: self.request.threads,
        };
        run(run_request, self.source, self.progress)?;
        let columns = ResultColumns::read(&folder)?;
        let largest = columns.largest(self.request.quantity);
        let (sorted, failed) = sorted_values(&largest);
        let found = percentile(&sorted, failed, self.request.percent);
        let value = found.value.unwrap_or(f64::INFINITY);
        self.loads.push(Load {
            normal_load_n,
            columns,
            largest,
            value,
        });
        Ok(value)
    }

    fn folder(&self, normal_load_n: f64) -> PathBuf {
        self.request.results.join(format!("load-{normal_load_n}"))
    }

    fn report(mut self, resolved: bool) -> Result<OptimumReport, PipelineError> {
        self.loads
            .sort_by(|a, b| a.normal_load_n.total_cmp(&b.normal_load_n));
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
        let own = &self.loads[0].columns.scenarios[scenario].scenario;
        Ok(OptimumExcitation {
            load_case: own.load_case,
            engine_order: own.engine_order,
            normal_load_n: best.lowest.map(|place| self.loads[place].normal_load_n),
            best,
        })
    }

    /// A scenario of the load at `place`, named by that place.
    fn name(&self, place: usize, scenario: usize) -> ComparedScenario {
        let own = &self.loads[place].columns.scenarios[scenario].scenario;
        ComparedScenario {
            scenario: place,
            ..ComparedScenario::new(place, own)
        }
    }
}

/// The first of the excitations with the highest percentile at the load at `place`; failures leave it infinite.
fn highest_at(place: usize, excitations: &[OptimumExcitation]) -> usize {
    let value = |own: &OptimumExcitation| {
        let percentile = &own.best.loads[place].percentile;
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

/// A load with four significant digits: what a folder is named by, and close enough.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
