//! What the first screen says in large type: load, percentile and numerical error.

use std::cmp::Ordering;

use crate::population::statistics::CONFIDENCE;
use crate::report::numerical_error::Remedy;
use crate::report::study_report::{at_the_end, neighbours, short_load};
use crate::report::words::{LengthUnit, four_digits, percent_words, share_words, signed_share};
use crate::report::{
    GroupReport, LoadChoice, PercentileError, ScenarioSummary, StudyReport, StudySummary, Warning,
    setting,
};

/// A number in large type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct BigNumber {
    /// What it is.
    pub(super) label: String,
    /// The number with its unit.
    pub(super) value: String,
    /// What stands below it in ordinary type.
    pub(super) told: Option<String>,
    /// How sure it is, a line each.
    pub(super) notes: Vec<String>,
    /// Where the page says more: id and words of a link.
    pub(super) more: Option<(String, String)>,
    /// Whether it is no answer yet, or one that a better load may replace.
    pub(super) is_open: bool,
}

/// Load, percentile and numerical error of a group.
pub(super) fn big_numbers(report: &StudyReport, group: &GroupReport) -> [BigNumber; 3] {
    let units = LengthUnit::of_summary(&report.summary);
    let Some((choice, lowest)) = group.known_choice() else {
        return nothing_known(report, group);
    };
    let percent = percent_words(choice.percent);
    let scenario = &report.summary.scenarios[lowest];
    let error = group.error_of(lowest, choice.percent).map(|found| found.1);
    [
        number_of_load(report, group, choice, scenario),
        BigNumber {
            label: format!(
                "P{percent} of the peak amplitude at {}",
                short_load(scenario)
            ),
            value: error
                .and_then(|own| own.percentile.value)
                .map_or_else(|| "not known".to_owned(), |value| units.length(value)),
            told: None,
            notes: notes_of_percentile(report, group, choice, error),
            more: Some(all_percentiles(report, group)),
            is_open: false,
        },
        number_of_error(report, group, lowest, (&percent, error)),
    ]
}

/// The load with the lowest percentile. By a percentile that says too little of the highest blades it is no load to
/// design for, and does not stand where an answer would.
fn number_of_load(
    report: &StudyReport,
    group: &GroupReport,
    choice: &LoadChoice,
    scenario: &ScenarioSummary,
) -> BigNumber {
    let percent = percent_words(choice.percent);
    let load = short_load(scenario);
    let (label, value, told) = if choice.is_of_a_design() {
        let label = format!("Normal load per sector with the lowest P{percent}");
        (label, design_loads(report, group), None)
    } else {
        let told = format!("lowest P{percent}: at {load}");
        let value = "No design load yet".to_owned();
        ("Normal load per sector".to_owned(), value, Some(told))
    };
    BigNumber {
        label,
        value,
        told,
        notes: notes_of_load(report, group, choice, scenario),
        more: other_settings(report),
        is_open: !choice.is_of_a_design()
            || at_the_end(report, group).is_some()
            || !hidden_by_error(report, group).is_empty(),
    }
}

/// The load with the lowest percentile; where numerical error leaves others open, with these and those that the patterns leave
/// open.
pub(super) fn design_loads(report: &StudyReport, group: &GroupReport) -> String {
    let Some((choice, lowest)) = group.known_choice() else {
        return loads_left(report, group, &[]);
    };
    let mut left = group.left_by_error(choice, lowest);
    left.push(lowest);
    loads_left(report, group, &left)
}

/// The loads studied that an answer leaves, ascending. Of one alone it says on which side a better one may lie, if it is the last one
/// studied there.
pub(super) fn loads_left(report: &StudyReport, group: &GroupReport, left: &[usize]) -> String {
    let mut left: Vec<&ScenarioSummary> = { left.iter() }
        .map(|&own| &report.summary.scenarios[own])
        .collect();
    left.sort_by(|a, b| {
        let newtons = a.normal_load_n.partial_cmp(&b.normal_load_n);
        newtons.unwrap_or(Ordering::Equal)
    });
    match left[..] {
        [] => "not known".to_owned(),
        [only] => match neighbours(report, group, only) {
            [None, Some(_)] => format!("{} or lower", short_load(only)),
            [Some(_), None] => format!("{} or higher", short_load(only)),
            _ => short_load(only),
        },
        [ref others @ .., last] => {
            let others = others.iter().map(|own| short_load(own));
            // One unit is enough.
            let others: Vec<String> = others
                .map(|own| own.trim_end_matches(" N").to_owned())
                .collect();
            let last = short_load(last);
            format!("not decided: {} or {last}", others.join(", "))
        }
    }
}

/// The load that a group is answered by and its percentile, in one line.
pub(super) fn in_one_line(report: &StudyReport, group: &GroupReport) -> String {
    let answer = group.known_choice().map_or_else(
        || "not known".to_owned(),
        |(choice, _)| {
            let [load, percentile, _] = big_numbers(report, group);
            let percent = percent_words(choice.percent);
            let told = load.told.unwrap_or_default();
            if choice.is_of_a_design() {
                format!("{}, P{percent} = {}", load.value, percentile.value)
            } else {
                format!("no design load yet, {told}")
            }
        },
    );
    format!("{}: {answer}", setting(group))
}

/// Which loads were calculated next to that of the answer: between them none was, so that the optimum is known no
/// better.
pub(super) fn beside(
    lower: Option<&ScenarioSummary>,
    higher: Option<&ScenarioSummary>,
) -> Option<String> {
    match (lower.map(short_load), higher.map(short_load)) {
        (Some(lower), Some(higher)) => Some(format!("neighbours studied: {lower} and {higher}")),
        (Some(next), None) => Some(format!("neighbour studied: {next}, none higher")),
        (None, Some(next)) => Some(format!("neighbour studied: {next}, none lower")),
        (None, None) => None,
    }
}

/// Where the answers of the other settings are.
fn other_settings(report: &StudyReport) -> Option<(String, String)> {
    let (target, words) = match report.groups.len() {
        0 | 1 => return None,
        2 => ("answer-1", "for the other setting see below".to_owned()),
        all => (
            "contents",
            format!("for {} other settings see below", all - 1),
        ),
    };
    Some((target.to_owned(), words))
}

/// Where the other percentiles are.
fn all_percentiles(report: &StudyReport, group: &GroupReport) -> (String, String) {
    let same = |other: &GroupReport| other.scenarios == group.scenarios;
    let place = report.groups.iter().position(same).unwrap_or(0);
    let words = "all percentiles".to_owned();
    (format!("numbers-{place}"), words)
}

fn nothing_known(report: &StudyReport, group: &GroupReport) -> [BigNumber; 3] {
    let unknown = |label: &str, notes: Vec<String>| BigNumber {
        label: label.to_owned(),
        value: "not known".to_owned(),
        told: None,
        notes,
        more: None,
        is_open: true,
    };
    let lowest = group.choices.iter().min_by_key(|own| own.needed_patterns);
    let why = match lowest {
        Some(choice) if report.summary.patterns < choice.needed_patterns => format!(
            "P{} needs {} patterns, the study has {}",
            percent_words(choice.percent),
            choice.needed_patterns,
            report.summary.patterns
        ),
        _ => "too many solutions failed".to_owned(),
    };
    [
        unknown(
            "Normal load per sector",
            vec!["no load has a percentile to choose it by".to_owned()],
        ),
        unknown("Percentile of the peak amplitude", vec![why]),
        unknown(
            "Numerical error, at most",
            vec!["no percentile that it could be of".to_owned()],
        ),
    ]
}

/// Which loads, that by the patterns alone are higher, numerical error could make the lowest.
pub(super) fn hidden_by_error(report: &StudyReport, group: &GroupReport) -> Vec<String> {
    let scenarios = &report.summary.scenarios;
    let hidden = group.known_choice().into_iter();
    hidden
        .flat_map(|(choice, lowest)| group.hidden_by_error(choice, lowest))
        .map(|own| short_load(&scenarios[own]))
        .collect()
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
            .map(|speed| format!("load at {speed} rpm")),
    );
    let Some(best) = &choice.best else {
        notes.push("the only load of this study".to_owned());
        return notes;
    };
    // What makes the load no optimum comes before how sure it is the lowest.
    let is_at_the_end = at_the_end(report, group);
    let hidden = hidden_by_error(report, group);
    notes.extend({ is_at_the_end.as_ref() }.map(|end| end.not_studied.clone()));
    let others: Vec<String> = { best.loads.iter() }
        .filter(|own| own.could_be_best && own.scenario.scenario != scenario.scenario)
        .map(|own| {
            let other = &report.summary.scenarios[own.scenario.scenario];
            short_load(other)
        })
        .collect();
    let percent = percent_words(choice.percent);
    if !others.is_empty() {
        let others = others.join(", ");
        notes.push(format!("95 % confidence: {others} may be as good"));
    } else if choice.is_of_a_design() {
        notes.push(if hidden.is_empty() {
            format!("95 % sure that no other load studied has a lower P{percent}")
        } else {
            let load = short_load(scenario);
            let studied = best.loads.len();
            format!("statistics: 95 % sure {load} is best of the {studied}")
        });
    }
    if choice.is_of_a_design() {
        notes.push(by_numerical_error(report, group, choice, scenario.scenario));
    }
    let mut higher = { group.choices.iter() }.filter(|own| own.percent > choice.percent);
    let higher = higher.next_back();
    notes.extend(
        higher
            .filter(|_| !choice.is_of_a_design())
            .map(|higher| format!("no P{} is known", percent_words(higher.percent))),
    );
    let [lower, higher] = neighbours(report, group, scenario);
    notes.extend(beside(lower, higher).filter(|_| is_at_the_end.is_none()));
    notes
}

/// What numerical error can do to the choice of a load.
fn by_numerical_error(
    report: &StudyReport,
    group: &GroupReport,
    choice: &LoadChoice,
    lowest: usize,
) -> String {
    let hidden = hidden_by_error(report, group);
    if !hidden.is_empty() {
        let loads = hidden.join(", ");
        return format!("numerical error: {loads} may be as good");
    }
    match group.numerical_rivals(lowest, choice.percent) {
        Some(rivals) if rivals.unknown.is_empty() => "numerical error does not change this",
        Some(_) => "numerical error does not change this where loads have a value",
        None => "numerical error has no bound and may change this",
    }
    .to_owned()
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
    let between = error.and_then(|error| interval_with_error(error, units));
    notes.extend(between.map(|between| format!("with numerical error {between}")));
    let open = choice
        .lowest
        .map_or_else(Vec::new, |lowest| group.hidden_by_error(choice, lowest));
    notes.extend(open.into_iter().filter_map(|scenario| {
        let error = group.error_of(scenario, choice.percent)?.1;
        let value = error.percentile.value?;
        let load = short_load(&summary.scenarios[scenario]);
        Some(match interval_with_error(error, units) {
            Some(between) => format!("{load}: {}, with error {between}", units.number(value)),
            None => format!("{load}: {}", units.length(value)),
        })
    }));
    let value = found.and_then(|percentile| percentile.value);
    notes.extend(
        { choice.lowest.zip(value) }
            .and_then(|(lowest, value)| beside_tuned(summary, lowest, value)),
    );
    let stress = summary.stress_pa_per_m.zip(found.and_then(|own| own.value));
    notes.extend(stress.map(|(pa_per_m, value)| {
        format!("= {} MPa peak stress", four_digits(1e-6 * pa_per_m * value))
    }));
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

/// The interval of a percentile with its numerical error.
fn interval_with_error(error: &PercentileError, units: LengthUnit) -> Option<String> {
    let (low, high) = error.interval_with_error()?;
    Some(format!("{} to {}", units.number(low), units.length(high)))
}

/// An amplitude beside the peak of the tuned wheel under the same load.
pub(super) fn beside_tuned(
    summary: &StudySummary,
    scenario: usize,
    amplitude_m: f64,
) -> Option<String> {
    let tuned = summary.scenarios[scenario].tuned_amplitude_m?;
    let ratio = amplitude_m / tuned;
    let tuned = LengthUnit::of_summary(summary).length(tuned);
    Some(format!(
        "{} times the tuned wheel ({tuned})",
        four_digits(ratio)
    ))
}

/// Numerical error of the percentile: the larger side of its bounds.
fn number_of_error(
    report: &StudyReport,
    group: &GroupReport,
    lowest: usize,
    (percent, error): (&str, Option<&PercentileError>),
) -> BigNumber {
    let label = format!("Numerical error of that P{percent}");
    let bounds = error.and_then(|own| Some((own.lowest?, own.highest?, own.percentile.value?)));
    let Some((low, high, value)) = bounds else {
        let errors = { group.errors.iter() }.find(|own| own.scenario == lowest);
        return BigNumber {
            label,
            value: "no bound".to_owned(),
            told: None,
            notes: errors
                .map(|own| own.rows.why_no_bound())
                .into_iter()
                .collect(),
            more: None,
            is_open: false,
        };
    };
    let largest = (1.0 - low / value).max(high / value - 1.0);
    let remedy = remedy(report, error);
    let mut notes = Vec::new();
    notes.extend({ remedy.zip(error) }.map(|(remedy, error)| {
        let found = error.percentile;
        let side = |end: Option<f64>| end.map_or(f64::NAN, |end| end / value - 1.0);
        let sides = [side(found.lower), side(found.upper)];
        remedy.beside_statistics(&sides.map(signed_share).join(" to "))
    }));
    notes.extend(remedy.map(|remedy| remedy.words().to_owned()));
    BigNumber {
        label,
        value: format!("at most {}", share_words(largest)),
        told: None,
        notes,
        more: None,
        is_open: matches!(remedy, Some(Remedy::Finer)),
    }
}

/// What makes a percentile surer; none where its error or its interval has no bounds.
fn remedy(report: &StudyReport, error: Option<&PercentileError>) -> Option<Remedy> {
    let (numerical, statistical) =
        { error }.and_then(|own| Some((own.numerical_width()?, own.statistical_width()?)))?;
    let findings = { report.summary.warnings.iter() }.filter_map(Warning::numerical_finding);
    Some(Remedy::of(statistical, numerical, findings))
}
