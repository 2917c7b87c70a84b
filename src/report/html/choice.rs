//! The percentile and the load that a group is judged by, and whether loads on both sides of it were studied.

use crate::report::words::{percent_words, short_load_with_unit};
use crate::report::{GroupReport, LoadChoice, ScenarioSummary, StudyReport, setting};

/// The percentile that a group is judged by: the highest that has a value.
pub(super) fn known_choice(group: &GroupReport) -> Option<(&LoadChoice, usize)> {
    let mut choices = group.choices.iter();
    choices.find_map(|choice| Some((choice, choice.lowest?)))
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
    /// What follows from it.
    pub(super) consequence: String,
    /// What is wrong, in a few words.
    pub(super) headline: String,
    /// The same, and where loads are added.
    pub(super) in_words: String,
}

impl AtTheEnd {
    /// What follows from it, in the words of a note.
    pub(super) fn on_card(&self) -> String {
        self.consequence
            .trim_end_matches('.')
            .replacen("Best", "best", 1)
    }
}

/// Whether a better load may lie beyond those of a group. Linear limits alone ask for no load, and neither does a load
/// alone.
pub(super) fn at_the_end(report: &StudyReport, group: &GroupReport) -> Option<AtTheEnd> {
    let (choice, lowest) = known_choice(group)?;
    if choice.best.is_none() || choice.enclosed {
        return None;
    }
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
        (None, _) => format!("{name} has the lowest P{}", percent_words(choice.percent)),
        (_, "higher") => format!("{name} is the highest load studied"),
        (_, "lower") => format!("{name} is the lowest load studied"),
        _ => format!("{name} is the only load studied"),
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
        consequence: format!("Best load may be {beyond}."),
        headline: format!("{what}: add {side} {loads}"),
        in_words: format!(
            "{of_setting}{what}, so that the optimum may lie beyond: add {side} {loads} to {key} and run again"
        ),
    })
}
