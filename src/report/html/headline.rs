//! What the first screen says in large type: load, percentile and numerical error.

use super::choice::{at_the_end, known_choice, neighbours, short_load};
use crate::population::statistics::CONFIDENCE;
use crate::report::numerical_error::Remedy;
use crate::report::words::{LengthUnit, four_digits, percent_words, share_words};
use crate::report::{
    GroupReport, LoadChoice, PercentileError, ScenarioSummary, StudyReport, Warning, setting,
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
    let Some((choice, lowest)) = known_choice(group) else {
        return nothing_known(report, group);
    };
    let percent = percent_words(choice.percent);
    let scenario = &report.summary.scenarios[lowest];
    let error = error_of(group, lowest, choice.percent);
    [
        number_of_load(report, group, choice, scenario),
        BigNumber {
            label: format!("P{percent} of the peak amplitude"),
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
        let label = format!("Load per sector with the lowest P{percent}");
        (label, load, None)
    } else {
        let told = format!("lowest P{percent}: at {load}");
        let value = "No design load yet".to_owned();
        ("Load per sector".to_owned(), value, Some(told))
    };
    BigNumber {
        label,
        value,
        told,
        notes: notes_of_load(report, group, choice, scenario),
        more: other_settings(report),
        is_open: !choice.is_of_a_design() || at_the_end(report, group).is_some(),
    }
}

/// The load that a group is answered by and its percentile, in one line.
pub(super) fn in_one_line(report: &StudyReport, group: &GroupReport) -> String {
    let answer = known_choice(group).map_or_else(
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
fn beside(lower: Option<&ScenarioSummary>, higher: Option<&ScenarioSummary>) -> Option<String> {
    match (lower.map(short_load), higher.map(short_load)) {
        (Some(lower), Some(higher)) => Some(format!("neighbouring loads: {lower} and {higher}")),
        (Some(next), None) => Some(format!("neighbouring load: {next}, none higher")),
        (None, Some(next)) => Some(format!("neighbouring load: {next}, none lower")),
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
    let words = "all in “Numbers”".to_owned();
    (format!("numbers-{place}"), words)
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
        told: None,
        notes,
        more: None,
        is_open: true,
    };
    if let Some(found) = of_one_wheel(report, group) {
        return found;
    }
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
        unknown(
            "Numerical error, at most",
            vec!["no percentile that it could be of".to_owned()],
        ),
    ]
}

/// Load with the lowest peak of the one wheel of a file, the peak, and the error that its row states.
fn of_one_wheel(report: &StudyReport, group: &GroupReport) -> Option<[BigNumber; 3]> {
    let summary = &report.summary;
    let peaks = { group.measured.iter() }.filter(|_| summary.is_of_one_wheel());
    let peaks = peaks.filter_map(|own| Some((own.scenario, own.peak_amplitude_m?)));
    let (lowest, peak) = peaks.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let errors = { group.errors.iter() }.find(|own| own.scenario == lowest)?;
    let number = |label: &str, value: String, note: String| BigNumber {
        label: label.to_owned(),
        value,
        told: None,
        notes: vec![note],
        more: None,
        is_open: false,
    };
    let [lower, higher] = neighbours(report, group, &summary.scenarios[lowest]);
    let units = LengthUnit::of_summary(summary);
    Some([
        number(
            "Load per sector with the lowest peak of the wheel",
            short_load(&summary.scenarios[lowest]),
            beside(lower, higher).unwrap_or_else(|| "no neighbouring load".to_owned()),
        ),
        number(
            "Peak amplitude of the wheel",
            units.length(peak),
            "the one wheel of mistuning.file: no percentile".to_owned(),
        ),
        number(
            "Numerical error of the peak, at most",
            { errors.rows.stated }
                .map_or_else(|| "no bound".to_owned(), |own| share_words(own.largest)),
            "by what its row states".to_owned(),
        ),
    ])
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
    let [lower, higher] = neighbours(report, group, scenario);
    let beside = beside(lower, higher);
    // What makes the load no optimum comes before how sure it is the lowest.
    let is_at_the_end = at_the_end(report, group);
    if let Some(end) = &is_at_the_end {
        let beyond = end.on_card();
        let beside = beside.as_ref();
        notes.push(beside.map_or(beyond.clone(), |beside| format!("{beside}: {beyond}")));
    }
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
        notes.push(format!("could be as good: {others} (same patterns)"));
    } else if choice.is_of_a_design() {
        notes.push(format!(
            "95 % confident: no other calculated load has a lower P{percent} (same patterns)"
        ));
    }
    let mut higher = { group.choices.iter() }.filter(|own| own.percent > choice.percent);
    let higher = higher.next_back();
    notes.extend(
        higher
            .filter(|_| !choice.is_of_a_design())
            .map(|higher| format!("no P{} is known", percent_words(higher.percent))),
    );
    notes.extend(beside.filter(|_| is_at_the_end.is_none()));
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

/// Numerical error of the percentile: the larger side of its bounds.
fn number_of_error(
    report: &StudyReport,
    group: &GroupReport,
    lowest: usize,
    (percent, error): (&str, Option<&PercentileError>),
) -> BigNumber {
    let units = LengthUnit::of_summary(&report.summary);
    // Errors of single rows, which stand further below, may be larger than the bound.
    let label = format!("Numerical error of P{percent}, not of a row");
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
    let widths = error.and_then(|own| Some((own.numerical_width()?, own.statistical_width()?)));
    let notes = widths.map_or_else(Vec::new, |(numerical, statistical)| {
        let findings = { report.summary.warnings.iter() }.filter_map(Warning::numerical_finding);
        let remedy = Remedy::of(statistical, numerical, findings);
        let (own, interval) = (largest * value, statistical * value);
        vec![
            format!(
                "±{}; statistical interval {} wide",
                units.rough(own),
                units.rough(interval)
            ),
            remedy.words().to_owned(),
        ]
    });
    BigNumber {
        label,
        value: format!("at most {}", share_words(largest)),
        told: None,
        notes,
        more: None,
        is_open: false,
    }
}
