//! Every number of the report on a finished study.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::words::{
    excitation_and_deviation, percent_words, scenarios_in_words, short_load_with_unit,
};
use super::{
    AccuracyTrials, BestLoads, CommonErrors, PercentileError, ScenarioSummary, ShownModel,
    StatedErrors, StudySummary, WheelReport,
};
use crate::population::monte_carlo::LoadCaseName;
use crate::population::statistics::{Percentile, Quantity, TailFit};
use crate::population::table::AccuracyLadder;

/// The report on a finished study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyReport {
    /// The summary: statistics per scenario, counts by status, warnings.
    pub summary: StudySummary,
    /// Engine orders and standard deviations, each with its loads.
    pub groups: Vec<GroupReport>,
    /// The model of the study.
    pub model: ShownModel,
    /// What accuracy costs, where it was measured.
    pub accuracy_ladder: Option<AccuracyLadder>,
    /// What was tried before the settings were chosen, where `[accuracy]` chose them.
    pub accuracy_trials: Option<AccuracyTrials>,
    /// What the numbers were made from.
    pub provenance: Provenance,
}

/// What the numbers of a report were made from; no clock, host or thread count.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Provenance {
    /// Version of the program that solved the rows.
    pub version: String,
    /// Identity of the build that solved the rows.
    pub build: String,
    /// Random number generator.
    pub generator: String,
    /// Digests of the input files, by path as written in the study.
    pub inputs: BTreeMap<String, String>,
    /// Digests of the tables, by file name.
    pub tables: BTreeMap<String, String>,
    /// The study with every default filled in.
    pub study: Value,
    /// Settings that the program chose where the study says `auto`.
    pub chosen: Value,
}

/// The loads of one engine order and standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupReport {
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation, if the study has one.
    pub standard_deviation: Option<f64>,
    /// Its scenarios.
    pub scenarios: Vec<usize>,
    /// Which load to choose for each percentile of the peak amplitude, the highest percentile first.
    pub choices: Vec<LoadChoice>,
    /// Errors of the numbers of every scenario, in their order.
    pub errors: Vec<ScenarioErrors>,
    /// Scenario that the distributions and wheels are of: the best by the first choice with
    /// a value, or by the tuned peak where there is none.
    pub shown: usize,
    /// Distributions of both quantities there.
    pub distributions: Vec<DistributionReport>,
    /// Wheels solved again there.
    pub wheels: Wheels,
    /// Peak of each wheel of `mistuning.file` under each scenario, where it holds few.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<MeasuredPeak>,
}

impl StudyReport {
    /// All warnings with what to do about them: first the settings whose load is at the end of those studied.
    #[must_use]
    pub fn warnings_in_words(&self) -> Vec<String> {
        let named = |own: &[usize]| scenarios_in_words(&self.summary, own);
        let ends = { self.groups.iter() }.filter_map(|group| at_the_end(self, group));
        let warnings = { self.summary.warnings.iter() }.map(|warning| warning.in_words(&named));
        ends.map(|end| end.in_words).chain(warnings).collect()
    }
}

/// Scenarios beside the one with the lowest percentile, by what numerical error can do to them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NumericalRivals {
    /// Those whose percentile could be lower than that one.
    pub(super) could_be_lower: Vec<usize>,
    /// Those without value: too many rows failed.
    pub(super) unknown: Vec<usize>,
}

impl GroupReport {
    /// The percentile that the group is judged by, with its lowest scenario: the highest that has a value.
    pub(super) fn known_choice(&self) -> Option<(&LoadChoice, usize)> {
        let mut choices = self.choices.iter();
        choices.find_map(|choice| Some((choice, choice.lowest?)))
    }

    /// Errors of a percentile of one scenario, after those of all its rows.
    pub(super) fn error_of(
        &self,
        scenario: usize,
        percent: f64,
    ) -> Option<(&ScenarioErrors, &PercentileError)> {
        let errors = { self.errors.iter() }.find(|errors| errors.scenario == scenario)?;
        let mut percentiles = errors.percentiles.iter();
        let found = percentiles.find(|own| own.percentile.percent.total_cmp(&percent).is_eq());
        Some((errors, found?))
    }

    /// Which scenarios could have a lower percentile than `lowest` if rows are wrong by what they state; none where the
    /// rows of `lowest` state no bound.
    pub(super) fn numerical_rivals(&self, lowest: usize, percent: f64) -> Option<NumericalRivals> {
        let highest = self.error_of(lowest, percent)?.1.highest?;
        let found = |other: usize| Some(self.error_of(other, percent)?.1);
        let others = { self.scenarios.iter() }.filter(|&&own| own != lowest);
        // Where failed rows leave no value, more accurate solutions decide nothing.
        let (known, unknown): (Vec<usize>, Vec<usize>) = others
            .partition(|&&other| found(other).is_some_and(|own| own.percentile.value.is_some()));
        let could = |other: &usize| {
            let bound = found(*other).and_then(|own| own.lowest);
            bound.is_none_or(|bound| bound < highest)
        };
        Some(NumericalRivals {
            could_be_lower: known.into_iter().filter(could).collect(),
            unknown,
        })
    }

    /// Which scenarios, that by the patterns alone have a higher percentile than the lowest, numerical error could make the
    /// lowest.
    pub(super) fn hidden_by_error(&self, choice: &LoadChoice, lowest: usize) -> Vec<usize> {
        let rivals = choice
            .best
            .as_ref()
            .zip(self.numerical_rivals(lowest, choice.percent));
        let Some((best, rivals)) = rivals else {
            return Vec::new();
        };
        let is_higher = |own: &usize| {
            let mut loads = best.loads.iter();
            loads.any(|load| load.scenario.scenario == *own && !load.could_be_best)
        };
        rivals
            .could_be_lower
            .into_iter()
            .filter(is_higher)
            .collect()
    }

    /// The other scenarios that numerical error leaves open, with those that the patterns leave open; none where numerical error
    /// leaves none.
    pub(super) fn left_by_error(&self, choice: &LoadChoice, lowest: usize) -> Vec<usize> {
        let hidden = self.hidden_by_error(choice, lowest);
        if hidden.is_empty() {
            return hidden;
        }
        let by_patterns = |own: &usize| {
            let mut loads = { choice.best.iter() }.flat_map(|best| &best.loads);
            loads.any(|load| load.scenario.scenario == *own && load.could_be_best)
        };
        let all = self.scenarios.iter().copied();
        all.filter(|own| *own != lowest && (hidden.contains(own) || by_patterns(own)))
            .collect()
    }
}

/// What a few measured wheels say.
impl GroupReport {
    /// The worst of the measured wheels under each load, with its peak; not under one where a wheel has no peak, which could be
    /// worse.
    pub(super) fn worst_peaks(&self) -> impl Iterator<Item = (&MeasuredPeak, f64)> {
        let loads = self.measured.chunk_by(|a, b| a.scenario == b.scenario);
        loads.filter_map(|wheels| {
            let peaks = wheels.iter().map(|own| Some((own, own.peak_amplitude_m?)));
            let peaks: Option<Vec<(&MeasuredPeak, f64)>> = peaks.collect();
            peaks?.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))
        })
    }

    /// The smallest of the worst peaks of the measured wheels.
    pub(super) fn smallest_worst_peak(&self) -> Option<(&MeasuredPeak, f64)> {
        self.worst_peaks().min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The other scenarios, with their worst peaks, that could have the smallest one by what the rows state, each wrong by all of it.
    pub(super) fn loads_left_open(&self) -> Vec<(usize, f64)> {
        let Some((of_wheel, peak)) = self.smallest_worst_peak() else {
            return Vec::new();
        };
        let lowest = of_wheel.scenario;
        let highest = { self.largest_stated_error(lowest) }.and_then(|error| within(peak, error).1);
        let others = self.worst_peaks().map(|(own, peak)| (own.scenario, peak));
        others
            .filter(|&(own, peak)| {
                let bound = { self.largest_stated_error(own) }.map(|error| within(peak, error).0);
                let could = bound
                    .zip(highest)
                    .is_none_or(|(bound, highest)| bound < highest);
                own != lowest && could
            })
            .collect()
    }

    /// The largest error that a row of the scenario states.
    pub(super) fn largest_stated_error(&self, scenario: usize) -> Option<f64> {
        let errors = { self.errors.iter() }.find(|errors| errors.scenario == scenario)?;
        Some(errors.rows.stated?.largest)
    }
}

/// Between which values the truth lies that an amplitude is off by a stated error of: that is relative to the truth. None above
/// where it is as large as the truth.
pub(super) fn within(amplitude_m: f64, stated: f64) -> (f64, Option<f64>) {
    let above = (stated < 1.0).then(|| amplitude_m / (1.0 - stated));
    (amplitude_m / (1.0 + stated), above)
}

/// The peak of one wheel of `mistuning.file` under one scenario.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeasuredPeak {
    /// The scenario.
    pub scenario: usize,
    /// Id of the wheel in the file.
    pub pattern: u32,
    /// Its peak amplitude, m; null: the row failed.
    pub peak_amplitude_m: Option<f64>,
    /// Its amplification factor; null: the row or that of the tuned wheel failed.
    pub amplification_factor: Option<f64>,
    /// The blade of its peak; null: the row failed.
    pub peak_blade: Option<u32>,
}

/// Which load to choose for one percentile of the peak amplitude.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoadChoice {
    /// The percentile in percent.
    pub percent: f64,
    /// Loads that could be best; none where the percentile is not estimable, or there is one load.
    pub best: Option<BestLoads>,
    /// Smallest number of patterns with an interval of this percentile.
    pub needed_patterns: u64,
    /// Smallest number of patterns that bounds this percentile at the truly best load.
    pub patterns_of_best: u64,
    /// Scenario with the lowest value, if any has one.
    pub lowest: Option<usize>,
    /// Whether a lower and a higher normal load than that were studied.
    pub enclosed: bool,
}

/// Percentile below which a choice of the load says too little of the highest blades.
const LEAST_OF_A_DESIGN: f64 = 90.0;

impl LoadChoice {
    /// Whether the percentile says enough of the highest blades to design for.
    pub(super) fn is_of_a_design(&self) -> bool {
        self.percent >= LEAST_OF_A_DESIGN
    }
}

/// Numerical and statistical error of the percentiles of one scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioErrors {
    /// The scenario.
    pub scenario: usize,
    /// Errors that its rows state.
    pub rows: StatedErrors,
    /// Errors that every row of the scenario states at least.
    pub common: CommonErrors,
    /// What the errors come to in percentiles of the peak amplitude.
    pub percentiles: Vec<PercentileError>,
}

/// The distribution of a quantity in one scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DistributionReport {
    /// The quantity.
    pub quantity: Quantity,
    /// Half width of the 95 % band, a probability.
    pub half_width: Option<f64>,
    /// Value, share of smaller ones, lower and upper edge of the band.
    pub points: Vec<[f64; 4]>,
    /// Percentiles with their bounds.
    pub percentiles: Vec<Percentile>,
    /// Laws fitted to it.
    pub fits: Vec<TailFit>,
    /// The generalised extreme value law drawn: value and share of smaller ones.
    pub law: Vec<[f64; 2]>,
}

/// The wheels of a group that were solved again.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "wheels", rename_all = "snake_case")]
pub enum Wheels {
    /// The wheels were solved again.
    Solved(Box<WheelReport>),
    /// The wheels were not solved again, and why.
    NotSolved {
        /// Why.
        reason: String,
    },
}

/// Load case, engine order and standard deviation of a group, in words.
#[must_use]
pub fn setting(group: &GroupReport) -> String {
    let words = excitation_and_deviation(
        group.load_case,
        group.engine_order,
        group.standard_deviation,
    );
    // What deviates: a page is read without the study beside it.
    words.replace(
        "standard deviation",
        "standard deviation of blade stiffness",
    )
}
/// A load with its unit in few letters, or the name of a linear limit.
pub(super) fn short_load(scenario: &ScenarioSummary) -> String {
    short_load_with_unit(scenario.contact, scenario.normal_load_n)
}

/// The next lower and the next higher load in newtons of a group; none beside a linear limit.
pub(super) fn neighbours<'a>(
    report: &'a StudyReport,
    group: &GroupReport,
    scenario: &ScenarioSummary,
) -> [Option<&'a ScenarioSummary>; 2] {
    let Some(own) = scenario.normal_load_n else {
        return [None; 2];
    };
    let all = in_newtons(report, group);
    let lower = all.iter().rfind(|(newtons, _)| *newtons < own);
    let higher = all.iter().find(|(newtons, _)| *newtons > own);
    [lower, higher].map(|found| found.map(|&(_, load)| load))
}

/// Loads in newtons of a group, ascending.
fn in_newtons<'a>(report: &'a StudyReport, group: &GroupReport) -> Vec<(f64, &'a ScenarioSummary)> {
    let all = group.scenarios.iter();
    let all = all.map(|&index| &report.summary.scenarios[index]);
    let mut found: Vec<_> = all
        .filter_map(|load| Some((load.normal_load_n?, load)))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// The load of a group is the last one that was studied on a side, so that a better one may lie beyond.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AtTheEnd {
    /// Where a better one may lie, beside the loads studied.
    pub(super) beyond: String,
    /// Beyond which load none was studied.
    pub(super) not_studied: String,
    /// What is wrong, in a few words.
    pub(super) headline: String,
    /// The headline, and where loads are added.
    pub(super) in_words: String,
}

impl AtTheEnd {
    /// What follows from it, without a full stop.
    pub(super) fn consequence(&self) -> String {
        format!("the best load may be {}", self.beyond)
    }
}

/// Whether a better load may lie beyond those of a group, by the percentile that it is judged by.
pub(super) fn at_the_end(report: &StudyReport, group: &GroupReport) -> Option<AtTheEnd> {
    at_the_end_by(report, group, group.known_choice()?)
}

/// Whether a load with a lower percentile may lie beyond those of a group. Linear limits alone ask for no load, and
/// neither does a load alone.
pub(super) fn at_the_end_by(
    report: &StudyReport,
    group: &GroupReport,
    (choice, lowest): (&LoadChoice, usize),
) -> Option<AtTheEnd> {
    if choice.best.is_none() || choice.enclosed {
        return None;
    }
    let of = format!("P{}", percent_words(choice.percent));
    end_at(report, group, lowest, &of)
}

/// What follows from a scenario with the lowest value `of` something being the last one studied on a side.
pub(super) fn end_at(
    report: &StudyReport,
    group: &GroupReport,
    lowest: usize,
    of: &str,
) -> Option<AtTheEnd> {
    let all = in_newtons(report, group);
    let (least, most) = (short_load(all.first()?.1), short_load(all.last()?.1));
    let own = &report.summary.scenarios[lowest];
    let name = short_load(own);
    let (side, beyond) = match (own.contact, neighbours(report, group, own)) {
        ("slide", _) => ("lower", format!("below {least}")),
        ("stuck", _) => ("higher", format!("above {most}")),
        (_, [Some(_), _]) => ("higher", format!("above {name}")),
        (_, [_, Some(_)]) => ("lower", format!("below {name}")),
        _ if own.normal_load_n.is_some() => ("lower and higher", "another one".to_owned()),
        _ => ("more", "another one".to_owned()),
    };
    let what = match (own.normal_load_n, side) {
        (None, _) => format!("{name} has the lowest {of}"),
        (_, "higher") => format!("{name} is the highest load studied"),
        (_, "lower") => format!("{name} is the lowest load studied"),
        _ => format!("{name} is the only load studied"),
    };
    let not_studied = match (own.normal_load_n, side) {
        (Some(_), "higher" | "lower") => format!("no load {beyond} was studied"),
        _ => what.clone(),
    };
    let of_speeds = all.iter().any(|(_, load)| load.speed_rpm.is_some());
    let (loads, key) = if of_speeds {
        ("speeds", "contact.normal_load.speed_rpm")
    } else {
        ("loads", "sweep.normal_load_n")
    };
    let of_setting = match report.groups.len() {
        0 | 1 => String::new(),
        _ => format!("{}: ", setting(group)),
    };
    Some(AtTheEnd {
        beyond,
        headline: format!("{what}: add {side} {loads}"),
        in_words: format!(
            "{of_setting}{what}, so that the optimum may lie beyond: add {side} {loads} to {key} and run again"
        ),
        not_studied,
    })
}
