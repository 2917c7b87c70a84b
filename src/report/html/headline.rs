//! What the first screen says: three numbers and whether anything is wrong.

use crate::population::statistics::CONFIDENCE;
use crate::report::words::{
    LengthUnit, four_digits, loads_and_limits, percent_words, scenarios_in_words, share_words,
    short_load_words,
};
use crate::report::{
    GroupReport, LoadChoice, PercentileError, ScenarioSummary, StudyReport, Warning, setting,
};

/// Warnings that the first screen names.
const NAMED: usize = 3;

/// Percentile below which a choice of the load says too little of the highest blades.
const LEAST_OF_A_DESIGN: f64 = 90.0;

/// A number in large type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct BigNumber {
    /// What it is.
    pub(super) label: String,
    /// The number with its unit.
    pub(super) value: String,
    /// How sure it is, a line each.
    pub(super) notes: Vec<String>,
    /// Where the page says more: id and words of a link.
    pub(super) more: Option<(&'static str, String)>,
}

/// Whether anything is wrong with a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Health {
    /// `good`, `look` or `bad`: the class of its style.
    pub(super) class: &'static str,
    /// In a few words.
    pub(super) verdict: String,
    /// What there is to see, a line each.
    pub(super) findings: Vec<String>,
}

/// The percentile that a group is judged by: the highest that has a value.
pub(super) fn known_choice(group: &GroupReport) -> Option<(&LoadChoice, usize)> {
    let mut choices = group.choices.iter();
    choices.find_map(|choice| Some((choice, choice.lowest?)))
}

/// Load, percentile and numerical error of a group.
pub(super) fn big_numbers(report: &StudyReport, group: &GroupReport) -> [BigNumber; 3] {
    let units = LengthUnit::of_summary(&report.summary);
    let Some((choice, lowest)) = known_choice(group) else {
        return nothing_known(report, group);
    };
    let percent = percent_words(choice.percent);
    let scenario = &report.summary.scenarios[lowest];
    let error = error_of(group, lowest, choice.percent);
    [
        BigNumber {
            label: if is_of_a_design(choice) {
                format!("Load per sector with the lowest P{percent}")
            } else {
                format!("No design load; the lowest P{percent} is at")
            },
            value: short_load(scenario),
            notes: notes_of_load(report, group, choice, scenario),
            more: other_settings(report),
        },
        BigNumber {
            label: format!("P{percent} of the peak amplitude"),
            value: error
                .and_then(|own| own.percentile.value)
                .map_or_else(|| "not known".to_owned(), |value| units.length(value)),
            notes: notes_of_percentile(report, group, choice, error),
            more: None,
        },
        number_of_error(units, group, lowest, (&percent, error)),
    ]
}

/// Whether the percentile of a choice says enough of the highest blades to design for.
fn is_of_a_design(choice: &LoadChoice) -> bool {
    choice.percent >= LEAST_OF_A_DESIGN
}

/// The load that a group is answered by and its percentile, in one line.
pub(super) fn in_one_line(report: &StudyReport, group: &GroupReport) -> String {
    let answer = known_choice(group).map_or_else(
        || "not known".to_owned(),
        |(choice, _)| {
            let [load, percentile, _] = big_numbers(report, group);
            let percent = percent_words(choice.percent);
            format!("{}, P{percent} = {}", load.value, percentile.value)
        },
    );
    format!("{}: {answer}", setting(group))
}

/// A load with its unit in few letters, or the name of a linear limit.
fn short_load(scenario: &ScenarioSummary) -> String {
    let words = short_load_words(scenario.contact, scenario.normal_load_n);
    if scenario.normal_load_n.is_some() {
        format!("{words} N")
    } else {
        words
    }
}

/// The next lower and the next higher load in newtons of a group; none beside a linear limit.
fn neighbours<'a>(
    report: &'a StudyReport,
    group: &GroupReport,
    scenario: &ScenarioSummary,
) -> [Option<&'a ScenarioSummary>; 2] {
    let Some(own) = scenario.normal_load_n else {
        return [None; 2];
    };
    let newtons = |scenario: &ScenarioSummary| scenario.normal_load_n.unwrap_or(f64::NAN);
    let all = group.scenarios.iter();
    let all = all.map(|&index| &report.summary.scenarios[index]);
    let by_load = |a: &&ScenarioSummary, b: &&ScenarioSummary| newtons(a).total_cmp(&newtons(b));
    [
        all.clone()
            .filter(|load| newtons(load) < own)
            .max_by(by_load),
        all.filter(|load| newtons(load) > own).min_by(by_load),
    ]
}

/// Which loads were calculated next to that of the answer: between them none was, so that the optimum is known no
/// better.
fn beside(lower: Option<&ScenarioSummary>, higher: Option<&ScenarioSummary>) -> String {
    const BEYOND: &str = "the optimum may lie beyond";
    match (lower, higher) {
        (Some(lower), Some(higher)) => {
            let (lower, higher) = (short_load(lower), short_load(higher));
            format!("next loads calculated: {lower} and {higher}")
        }
        (Some(next), None) => {
            let next = short_load(next);
            format!("next load calculated: {next}; none higher: {BEYOND}")
        }
        (None, Some(next)) => {
            let next = short_load(next);
            format!("next load calculated: {next}; none lower: {BEYOND}")
        }
        (None, None) => format!("no load on both sides was calculated: {BEYOND}"),
    }
}

/// Where the answers of the other settings are.
fn other_settings(report: &StudyReport) -> Option<(&'static str, String)> {
    match report.groups.len() {
        0 | 1 => None,
        2 => Some(("answer-1", "for the other setting see below".to_owned())),
        all => Some((
            "contents",
            format!("for {} other settings see below", all - 1),
        )),
    }
}

fn error_of(group: &GroupReport, scenario: usize, percent: f64) -> Option<&PercentileError> {
    let errors = { group.errors.iter() }.find(|errors| errors.scenario == scenario)?;
    let mut percentiles = errors.percentiles.iter();
    percentiles.find(|error| error.percentile.percent.total_cmp(&percent).is_eq())
}

fn nothing_known(report: &StudyReport, group: &GroupReport) -> [BigNumber; 3] {
    let unknown = |label: &str, notes: Vec<String>| BigNumber {
        label: label.to_owned(),
        value: "not known".to_owned(),
        notes,
        more: None,
    };
    let lowest = group.choices.iter().min_by_key(|own| own.needed_patterns);
    let why = match lowest {
        Some(choice) if report.summary.patterns < choice.needed_patterns => format!(
            "P{} needs {} patterns, the study has {}",
            percent_words(choice.percent),
            choice.needed_patterns,
            report.summary.patterns
        ),
        _ => "too many rows failed".to_owned(),
    };
    [
        unknown(
            "Normal load per sector",
            vec!["no load has a percentile to choose it by".to_owned()],
        ),
        unknown("Percentile of the peak amplitude", vec![why]),
        unknown("Numerical error, at most", Vec::new()),
    ]
}

fn notes_of_load(
    report: &StudyReport,
    group: &GroupReport,
    choice: &LoadChoice,
    scenario: &ScenarioSummary,
) -> Vec<String> {
    let mut notes = Vec::new();
    notes.extend(
        scenario
            .speed_rpm
            .map(|speed| format!("that of {speed} rpm")),
    );
    let Some(best) = &choice.best else {
        notes.push("the only load of this study".to_owned());
        return notes;
    };
    let others: Vec<String> = { best.loads.iter() }
        .filter(|own| own.could_be_best && own.scenario.scenario != scenario.scenario)
        .map(|own| {
            let other = &report.summary.scenarios[own.scenario.scenario];
            short_load(other)
        })
        .collect();
    notes.push(if others.is_empty() {
        format!(
            "of the {} calculated, with 95 % confidence",
            loads_and_limits(
                group
                    .scenarios
                    .iter()
                    .map(|&own| &report.summary.scenarios[own])
            )
        )
    } else {
        format!("could be as good: {}", others.join(", "))
    });
    let mut higher = { group.choices.iter() }.filter(|own| own.percent > choice.percent);
    let higher = higher.next_back();
    notes.extend(
        higher
            .filter(|_| !is_of_a_design(choice))
            .map(|higher| format!("no P{} is known", percent_words(higher.percent))),
    );
    let [lower, higher] = neighbours(report, group, scenario);
    notes.push(beside(lower, higher));
    notes
}

fn notes_of_percentile(
    report: &StudyReport,
    group: &GroupReport,
    choice: &LoadChoice,
    error: Option<&PercentileError>,
) -> Vec<String> {
    let summary = &report.summary;
    let units = LengthUnit::of_summary(summary);
    let confidence = { summary.stop.as_ref() }.map_or(CONFIDENCE, |stop| stop.confidence);
    let confidence = percent_words(100.0 * confidence);
    let mut notes = Vec::new();
    let found = error.map(|own| own.percentile);
    notes.push(match found.map(|own| (own.lower, own.upper)) {
        Some((Some(lower), Some(upper))) => format!(
            "{confidence} % interval {} to {}",
            units.number(lower),
            units.length(upper)
        ),
        Some((Some(lower), None)) => {
            format!("above {} at {confidence} % confidence", units.length(lower))
        }
        Some((None, Some(upper))) => {
            format!("below {} at {confidence} % confidence", units.length(upper))
        }
        _ => "no interval".to_owned(),
    });
    let stress = summary.stress_pa_per_m.zip(found.and_then(|own| own.value));
    notes.extend(
        stress.map(|(pa_per_m, value)| format!("{} MPa", four_digits(1e-6 * pa_per_m * value))),
    );
    let mut higher = { group.choices.iter() }
        .filter(|own| own.percent > choice.percent && summary.patterns < own.needed_patterns);
    notes.extend(higher.next_back().map(|own| {
        format!(
            "P{} needs {} patterns",
            percent_words(own.percent),
            own.needed_patterns
        )
    }));
    notes
}

/// Numerical error of the percentile: the larger side of its bounds.
fn number_of_error(
    units: LengthUnit,
    group: &GroupReport,
    lowest: usize,
    (percent, error): (&str, Option<&PercentileError>),
) -> BigNumber {
    let label = format!("Numerical error of P{percent}, at most");
    let bounds = error.and_then(|own| Some((own.lowest?, own.highest?, own.percentile.value?)));
    let Some((low, high, value)) = bounds else {
        let errors = { group.errors.iter() }.find(|own| own.scenario == lowest);
        return BigNumber {
            label,
            value: "no bound".to_owned(),
            notes: errors
                .map(|own| {
                    format!(
                        "{} of {} rows state none",
                        own.rows.without_bound, own.rows.rows
                    )
                })
                .into_iter()
                .collect(),
            more: None,
        };
    };
    let largest = (1.0 - low / value).max(high / value - 1.0);
    let widths = error.and_then(|own| Some((own.numerical_width()?, own.statistical_width()?)));
    let beside = widths.map(|(numerical, statistical)| {
        let interval = units.length(statistical * value);
        let first = if numerical > statistical {
            "refine first"
        } else {
            "add patterns first"
        };
        let own = units.length(largest * value);
        format!("{own}; interval {interval} wide: {first}")
    });
    BigNumber {
        label,
        value: share_words(largest),
        notes: beside.into_iter().collect(),
        more: None,
    }
}

/// Whether a group has percentiles, none of which says enough of the highest blades to design for.
fn is_without_a_design(group: &GroupReport) -> bool {
    known_choice(group).is_some_and(|(choice, _)| !is_of_a_design(choice))
}

/// Whether anything is wrong with the study.
pub(super) fn health(report: &StudyReport) -> Health {
    let summary = &report.summary;
    // What costs a result comes first.
    let (costly, others): (Vec<&Warning>, Vec<&Warning>) =
        { summary.warnings.iter() }.partition(|warning| warning.costs_a_statistic());
    let ordered: Vec<&Warning> = costly.into_iter().chain(others).collect();
    let mut findings = Warning::headlines(&ordered, &|own| scenarios_in_words(summary, own));
    if summary.misses_its_target() {
        findings.insert(
            0,
            "the wanted width of the interval was not reached".to_owned(),
        );
    }
    let (class, verdict) = if summary.failures_cost_a_statistic() {
        let shown = { report.groups.first() }.map_or(&[][..], |group| &group.scenarios);
        let mut costly = { summary.warnings.iter() }.flat_map(Warning::costly_scenarios);
        let verdict = if costly.any(|scenario| shown.contains(scenario)) {
            "Something is wrong: results are missing."
        } else {
            "Something is wrong in another setting, not in this one: results are missing."
        };
        ("bad", verdict.to_owned())
    } else if findings.is_empty() {
        (
            "good",
            format!(
                "No problem found: all {} rows have a result, and there is no warning.",
                summary.rows.ok()
            ),
        )
    } else if report.groups.first().is_some_and(is_without_a_design) {
        let verdict = "Too few patterns for a design load.";
        ("look", verdict.to_owned())
    } else {
        let count = findings.len();
        let warnings = if count == 1 { "warning" } else { "warnings" };
        (
            "look",
            format!(
                "{count} {warnings}; {} of {} rows have a result.",
                summary.rows.ok(),
                summary.rows.planned()
            ),
        )
    };
    let more = findings.len().saturating_sub(NAMED);
    findings.truncate(NAMED);
    if more > 0 {
        findings.push(format!("and {more} more"));
    }
    Health {
        class,
        verdict,
        findings,
    }
}
