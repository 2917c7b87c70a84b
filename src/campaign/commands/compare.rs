//! Comparison of the scenarios of one or several results folders.

use std::path::PathBuf;

use super::pairing::{PatternMatcher, follow_from_the_same, same_contact_factors};
use super::{PairedPlaces, Pairing};
use crate::campaign::store::{ResultColumns, ScenarioColumns, sorted_values};
use crate::population::statistics::{
    CONFIDENCE, Expansion, PairFacts, PercentileEstimator, Quantity, RESAMPLES, best_set_at,
    compare_independent, compare_paired, holm_with_origins, percentile, percentile_at,
    resample_percentile, smallest_sample,
};
use crate::report::{
    BaselineChoice, BestLoads, ComparedFolder, ComparedScenario, ComparisonReport, LoadOfSet,
    QuantityComparison, ScenarioComparison,
};
use crate::study::PipelineError;

/// Streams of the resamples of comparisons, apart from those of tail fits; the same for all of them,
/// so that all loads see the same resamples.
const TOPIC: u32 = 1 << 30;

/// Confidence of both the set and the intervals in it that together bound the lowest percentile with
/// 95 % (Bonferroni).
pub(super) const HALF_ERROR: f64 = 0.975;

/// What to compare.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareRequest {
    /// Results folders; the baseline is in the first.
    pub folders: Vec<PathBuf>,
    /// Scenario of the first folder that all others are compared with. Absent: in one folder the scenario
    /// with the lowest percentile of the peak amplitude of each load case, engine order and standard
    /// deviation, or with the lowest of the largest where patterns are too few for the percentile; of several, the scenario of the first folder with the same keys.
    pub baseline: Option<usize>,
    /// The percentile in percent.
    pub percent: f64,
}

/// A scenario by folder and index.
type Place = (usize, usize);

/// Baselines and candidates.
type Pairs = Vec<(Place, Place)>;

/// Compares as `request` says.
///
/// # Errors
/// A folder holds no finished study or is damaged, or there is no such baseline.
pub fn compare(request: &CompareRequest) -> Result<ComparisonReport, PipelineError> {
    let folders: Vec<ResultColumns> = request
        .folders
        .iter()
        .map(|folder| ResultColumns::read(folder))
        .collect::<Result<_, _>>()?;
    let work = Comparison {
        folders: &folders,
        matcher: PatternMatcher::new(&folders)?,
        percent: request.percent,
        seed: folders.first().map_or(0, |first| first.manifest.seed),
    };
    let (pairs, unmatched) = work.pairs(request.baseline)?;
    let quantities = Quantity::ALL
        .iter()
        .map(|&quantity| work.of_quantity(quantity, &pairs))
        .collect();
    Ok(ComparisonReport {
        percent: request.percent,
        resamples: RESAMPLES,
        seed: work.seed,
        baseline_choice: match request.baseline {
            Some(_) => BaselineChoice::Named,
            None if folders.len() == 1 && work.has_few_patterns() => {
                BaselineChoice::LowestOfLargest
            }
            None if folders.len() == 1 => BaselineChoice::Lowest,
            None => BaselineChoice::SameKeys,
        },
        folders: folders.iter().map(facts).collect(),
        unmatched: unmatched
            .into_iter()
            .map(|place| work.name(place))
            .collect(),
        quantities,
    })
}

fn facts(columns: &ResultColumns) -> ComparedFolder {
    ComparedFolder {
        folder: columns.folder.clone(),
        name: columns.manifest.name.clone(),
        study_digest: columns.manifest.study_digest.clone(),
        build: columns.manifest.build.clone(),
        patterns: columns.patterns.len() as u64,
    }
}

struct Comparison<'a> {
    folders: &'a [ResultColumns],
    matcher: PatternMatcher<'a>,
    percent: f64,
    seed: u64,
}

impl Comparison<'_> {
    /// Pairs of baseline and candidate, and candidates without baseline.
    fn pairs(&self, baseline: Option<usize>) -> Result<(Pairs, Vec<Place>), PipelineError> {
        let first = &self.folders[0];
        if let Some(index) = baseline.filter(|&index| index >= first.scenarios.len()) {
            return Err(PipelineError::NoScenario {
                scenario: index,
                scenarios: first.scenarios.len(),
            });
        }
        let (mut pairs, mut unmatched) = (Pairs::new(), Vec::new());
        for (folder, columns) in self.folders.iter().enumerate() {
            for (index, candidate) in columns.scenarios.iter().enumerate() {
                let of_candidate = match baseline {
                    Some(index) => Some(index),
                    None if self.folders.len() == 1 => self.lowest_beside(candidate),
                    None if folder == 0 => Some(index),
                    None => first
                        .scenarios
                        .iter()
                        .position(|other| same_keys(other, candidate)),
                };
                match of_candidate {
                    Some(place) if folder == 0 && place == index => {}
                    Some(place) => pairs.push(((0, place), (folder, index))),
                    None => unmatched.push((folder, index)),
                }
            }
        }
        Ok((pairs, unmatched))
    }

    /// Whether the first folder has too few patterns for the percentile.
    fn has_few_patterns(&self) -> bool {
        let needed = smallest_sample(self.percent / 100.0, CONFIDENCE);
        (self.folders[0].patterns.len() as u64) < needed
    }

    /// The scenario of the first folder with the lowest percentile of the peak amplitude among those of
    /// the group of `scenario`, or with the lowest of the largest where patterns are too few; the first of them where none
    /// has a value.
    fn lowest_beside(&self, scenario: &ScenarioColumns) -> Option<usize> {
        let of_group = self.folders[0].scenarios.iter().enumerate();
        let of_group = of_group.filter(|(_, other)| same_group(other, scenario));
        let few = self.has_few_patterns();
        let value = |scenario: &ScenarioColumns| {
            let values = scenario.values(Quantity::PeakAmplitudeM);
            let found = if few {
                largest(values)
            } else {
                let (sorted, failed) = sorted_values(values);
                percentile(&sorted, failed, self.percent).value
            };
            found.unwrap_or(f64::INFINITY)
        };
        of_group
            .map(|(index, scenario)| (index, value(scenario)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }

    fn columns(&self, (folder, index): Place) -> &ScenarioColumns {
        &self.folders[folder].scenarios[index]
    }

    fn name(&self, place: Place) -> ComparedScenario {
        ComparedScenario::new(place.0, &self.columns(place).scenario)
    }

    fn of_quantity(&self, quantity: Quantity, pairs: &[(Place, Place)]) -> QuantityComparison {
        let mut comparisons: Vec<ScenarioComparison> = pairs
            .iter()
            .map(|&(baseline, candidate)| self.compare(quantity, baseline, candidate))
            .collect();
        let p_values: Vec<Option<f64>> = comparisons
            .iter()
            .map(|comparison| comparison.percentile.p_value)
            .collect();
        let at_floor: Vec<bool> = comparisons
            .iter()
            .map(|comparison| comparison.percentile.is_at_floor())
            .collect();
        for (comparison, adjusted) in comparisons.iter_mut().zip(holm_with_origins(&p_values)) {
            comparison.adjusted_p_value = adjusted.map(|(value, _)| value);
            comparison.adjusted_p_value_is_bound =
                adjusted.is_some_and(|(_, origin)| at_floor[origin]);
        }
        QuantityComparison {
            quantity,
            comparisons,
            best: self.best(quantity),
        }
    }

    fn compare(&self, quantity: Quantity, baseline: Place, candidate: Place) -> ScenarioComparison {
        let (left, right) = (self.columns(baseline), self.columns(candidate));
        let places: PairedPlaces = self
            .matcher
            .pair((baseline.0, &left.scenario), (candidate.0, &right.scenario));
        let take = |columns: &ScenarioColumns, places: &[usize]| -> Vec<Option<f64>> {
            let values = columns.values(quantity);
            places.iter().map(|&place| values[place]).collect()
        };
        let x = take(left, &places.baseline);
        let y = take(right, &places.candidate);
        let streams = (self.seed, TOPIC);
        let independent = places.pairing == Pairing::Independent;
        let percentile = if independent {
            compare_independent(&x, &y, self.percent, RESAMPLES, streams)
        } else {
            compare_paired(&x, &y, self.percent, RESAMPLES, streams)
        };
        let ids: Vec<u32> = places
            .baseline
            .iter()
            .map(|&place| self.folders[baseline.0].patterns[place])
            .collect();
        let left_out = [(baseline.0, x.len()), (candidate.0, y.len())]
            .map(|(folder, used)| (self.folders[folder].patterns.len() - used) as u64);
        ScenarioComparison {
            baseline: self.name(baseline),
            candidate: self.name(candidate),
            pairing: match places.pairing {
                Pairing::SamePatterns => "same_patterns",
                Pairing::SameBlades => "same_blades",
                Pairing::SameUnitDraws => "same_unit_draws",
                Pairing::Independent => "independent",
            },
            patterns: [x.len() as u64, y.len() as u64],
            patterns_left_out: left_out,
            percentile,
            largest: [largest(&x), largest(&y)],
            adjusted_p_value: None,
            adjusted_p_value_is_bound: false,
            pairs: (!independent).then(|| PairFacts::new(&ids, &x, &y, self.percent)),
        }
    }

    /// Of each folder, engine order and standard deviation with several loads, which could be best.
    fn best(&self, quantity: Quantity) -> Vec<BestLoads> {
        let mut best = Vec::new();
        for (folder, columns) in self.folders.iter().enumerate() {
            let groups = columns.scenarios.chunk_by(same_group);
            for group in groups.filter(|group| group.len() > 1) {
                let loads: Vec<_> = group
                    .iter()
                    .map(|load| {
                        let name = ComparedScenario::new(folder, &load.scenario);
                        (name, load.values(quantity))
                    })
                    .collect();
                best.extend(best_loads(&loads, self.percent, self.seed));
            }
        }
        best
    }
}

/// The largest of `values`; none where one of them is missing, which could be larger.
fn largest(values: &[Option<f64>]) -> Option<f64> {
    let known: Option<Vec<f64>> = values.iter().copied().collect();
    known?.into_iter().reduce(f64::max)
}

/// Which of `loads`, values over the same patterns, could be the best; none where the percentile is not
/// estimable for lack of patterns.
pub(super) fn best_loads(
    loads: &[(ComparedScenario, &[Option<f64>])],
    percent: f64,
    seed: u64,
) -> Option<BestLoads> {
    let values: Vec<&[Option<f64>]> = loads.iter().map(|(_, values)| *values).collect();
    let samples: Vec<(Vec<f64>, u64)> = values
        .iter()
        .map(|load_values| sorted_values(load_values))
        .collect();
    let (first, failed) = samples.first()?;
    percentile(first, *failed, percent).achieved_coverage?;
    let estimator = PercentileEstimator::of(&values);
    let resamples = resample_percentile(&values, percent, estimator, RESAMPLES, (seed, TOPIC));
    let expansion = match estimator {
        PercentileEstimator::SmoothedOrderStatistics => Expansion::of(first.len() as u64, percent),
        PercentileEstimator::OrderStatistic => Expansion::default(),
    };
    let set_at = |confidence: f64| {
        let confidence = 1.0 - expansion.tail(1.0 - confidence);
        best_set_at(&resamples, confidence)
    };
    let wide = set_at(HALF_ERROR);
    let bounds: Vec<_> = samples
        .iter()
        .zip(&wide)
        .filter(|(_, possible)| **possible)
        .map(|((sorted, failed), _)| percentile_at(sorted, *failed, percent, HALF_ERROR))
        .collect();
    // A bound that one of the loads does not have is infinite.
    let lower: Option<Vec<f64>> = bounds.iter().map(|found| found.lower).collect();
    let upper: Option<Vec<f64>> = bounds.iter().map(|found| found.upper).collect();
    let loads: Vec<LoadOfSet> = loads
        .iter()
        .zip(&samples)
        .zip(set_at(CONFIDENCE))
        .map(|(((scenario, _), (sorted, failed)), possible)| LoadOfSet {
            scenario: scenario.clone(),
            percentile: percentile(sorted, *failed, percent),
            could_be_best: possible,
        })
        .collect();
    Some(BestLoads {
        lowest: loads
            .iter()
            .filter_map(|load| Some((load.scenario.scenario, load.percentile.value?)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(scenario, _)| scenario),
        lower: lower.map(|all| all.into_iter().fold(f64::INFINITY, f64::min)),
        upper: upper.map(|all| all.into_iter().fold(f64::NEG_INFINITY, f64::max)),
        loads,
    })
}

/// Whether both folders have the same patterns, by what these follow from.
pub(super) fn same_patterns(a: &ResultColumns, b: &ResultColumns) -> bool {
    a.patterns == b.patterns && follow_from_the_same(a, b) && same_contact_factors(a, b)
}

fn same_group(a: &ScenarioColumns, b: &ScenarioColumns) -> bool {
    a.scenario.same_group(&b.scenario)
}

fn same_keys(a: &ScenarioColumns, b: &ScenarioColumns) -> bool {
    same_group(a, b) && a.scenario.contact == b.scenario.contact
}
