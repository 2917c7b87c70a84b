//! Whether anything is wrong with a study: the worst consequence, and the warnings in a few words.

use super::headline::{design_loads, hidden_by_error, loads_left};
use super::measured_wheels::{candidates, ends_among};
use crate::report::study_report::{at_the_end, short_load};
use crate::report::words::{scenarios_in_words, told_apart};
use crate::report::{GroupReport, StudyReport, Warning};

/// Whether anything is wrong, with a study or with the setting that the page opens with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Health {
    /// `good`, `look` or `bad`: the class of its style.
    pub(super) class: &'static str,
    /// The worst consequence.
    pub(super) verdict: String,
    /// What there is to see, what weighs most first.
    pub(super) findings: Vec<String>,
}

/// Whether anything is wrong with the study. Results that another setting lacks are apart from what concerns the
/// numbers of this one.
pub(super) fn health(report: &StudyReport) -> Vec<Health> {
    let summary = &report.summary;
    let all = summary.warnings.iter();
    let (costly, others): (Vec<&Warning>, Vec<&Warning>) =
        all.partition(|warning| warning.costs_a_statistic());
    if costly.is_empty() {
        return vec![of_setting(report, others)];
    }
    let shown = { report.groups.first() }.map_or(&[][..], |group| &group.scenarios);
    let scenarios: Vec<usize> = { costly.iter() }
        .flat_map(|warning| warning.costly_scenarios())
        .copied()
        .collect();
    if scenarios.iter().any(|own| shown.contains(own)) {
        let ordered: Vec<&Warning> = costly.into_iter().chain(others).collect();
        return vec![Health {
            class: "bad",
            verdict: missing_here(report, shown),
            findings: lines(report, &ordered),
        }];
    }
    // Failed rows are those of the setting that lacks results, or hardly matter beside it.
    let failures = |own: &&Warning| matches!(own, Warning::Failures { .. });
    let (failed, rest): (Vec<&Warning>, Vec<&Warning>) = others.into_iter().partition(failures);
    let elsewhere: Vec<&Warning> = costly.into_iter().chain(failed).collect();
    let mut found = vec![Health {
        class: "bad",
        verdict: missing_elsewhere(report, &scenarios),
        findings: lines(report, &elsewhere),
    }];
    // The percentile says by itself how many patterns the next one needs.
    let few = |own: &&Warning| matches!(own, Warning::TooFewPatterns { .. });
    let is_said = rest.iter().all(few);
    let mut own = of_setting(report, rest);
    if own.class != "good" {
        if is_said && own.findings.len() == 1 {
            own.findings.clear();
        }
        found.push(own);
    }
    found
}

fn lines(report: &StudyReport, warnings: &[&Warning]) -> Vec<String> {
    let of_file = { report.groups.iter() }.any(|group| !group.measured.is_empty());
    let patterns = if of_file { "wheels" } else { "patterns" };
    let named = |own: &[usize]| scenarios_in_words(&report.summary, own);
    Warning::headlines(warnings, &named, patterns)
}

/// What numerical error leaves open, and what settles it.
fn may_be_as_good(loads: &str) -> String {
    format!("numerical error: {loads} may be as good; solve more accurately")
}

/// With a capital letter and a full stop.
fn sentence(words: &str) -> String {
    format!("{}.", capital(words))
}

/// With a capital letter.
fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let head = letters.next().map(char::to_uppercase);
    head.into_iter().flatten().chain(letters).collect()
}

/// What there is to say of the setting that the page opens with, where it lacks no result.
fn of_setting(report: &StudyReport, mut warnings: Vec<&Warning>) -> Health {
    let summary = &report.summary;
    let first = report.groups.first();
    let choice = first.and_then(GroupReport::known_choice);
    let chosen = choice.map(|(choice, _)| choice.percent);
    // What weighs most comes first.
    warnings.sort_by_key(|warning| warning.consequence(chosen).0);
    let mut findings = lines(report, &warnings);
    let mut verdict = warnings.first().map(|worst| worst.consequence(chosen).1);
    if summary.misses_its_target() {
        findings.insert(
            0,
            "the wanted width of the interval was not reached".to_owned(),
        );
        verdict = Some("The interval is wider than wanted.".to_owned());
    }
    let hidden = first.map_or_else(Vec::new, |group| hidden_by_error(report, group));
    if !hidden.is_empty() {
        let loads = hidden.join(", ");
        findings.insert(0, may_be_as_good(&loads));
    }
    if let Some(end) = first.and_then(|group| at_the_end(report, group)) {
        findings.insert(0, end.headline.clone());
        verdict = Some(sentence(&end.consequence()));
    }
    if let (Some(group), false) = (first, hidden.is_empty()) {
        verdict = Some(sentence(&design_loads(report, group)));
    }
    let others = report.groups.iter().skip(1);
    let others = others.filter(|group| at_the_end(report, group).is_some());
    match others.count() {
        0 => {}
        count => {
            findings.push(format!(
                "loads of other settings at the end of those studied: {count}"
            ));
            verdict = verdict.or(Some(
                "Best load of another setting may lie beyond.".to_owned(),
            ));
        }
    }
    let few = { warnings.iter() }.any(|own| matches!(own, Warning::TooFewPatterns { .. }));
    match choice {
        Some((choice, _)) if !choice.is_of_a_design() && verdict.is_some() => {
            verdict = Some("Too few patterns for a design load.".to_owned());
        }
        None if few => verdict = Some("Too few patterns for any percentile.".to_owned()),
        _ => {}
    }
    if let Some(group) = first {
        let candidates = candidates(group);
        let ends = ends_among(report, group, &candidates);
        for (_, end) in ends.into_iter().rev() {
            findings.insert(0, end.headline.clone());
            verdict = Some(sentence(&end.consequence()));
        }
        if candidates.len() > 1 {
            let others = { candidates[1..].iter() }.map(|&own| short_load(&summary.scenarios[own]));
            let others = others.collect::<Vec<_>>().join(", ");
            findings.insert(0, may_be_as_good(&others));
            verdict = Some(sentence(&loads_left(report, group, &candidates)));
        }
    }
    let class = if verdict.is_some() { "look" } else { "good" };
    Health {
        class,
        verdict: verdict.unwrap_or_else(|| {
            format!(
                "No problem found: {} a result under every load, and there is no warning.",
                if summary.patterns == 1 {
                    "the wheel has".to_owned()
                } else {
                    format!("all {} wheels have", summary.patterns)
                }
            )
        }),
        findings,
    }
}

/// What failed rows cost in the setting that the page opens with.
fn missing_here(report: &StudyReport, shown: &[usize]) -> String {
    let mut lacking = { report.summary.warnings.iter() }.filter(|own| {
        let scenarios = own.costly_scenarios();
        matches!(own, Warning::TooManyFailures { .. })
            && scenarios.iter().any(|own| shown.contains(own))
    });
    let first = report.groups.first();
    let choice = first.and_then(GroupReport::known_choice);
    let verdict = if lacking.next().is_none() {
        "Tuned peaks are missing, and with them amplification factors."
    } else if choice.is_none() {
        "No percentile at any load: too many rows failed."
    } else {
        "Percentiles are missing at some loads: too many rows failed."
    };
    verdict.to_owned()
}

/// Which other setting lacks what, and that the load of this one does not depend on it.
fn missing_elsewhere(report: &StudyReport, scenarios: &[usize]) -> String {
    let lacks = |group: &&GroupReport| group.scenarios.iter().any(|own| scenarios.contains(own));
    let groups: Vec<&GroupReport> = report.groups.iter().filter(lacks).collect();
    let which = match groups[..] {
        [only] => {
            let own = &report.summary.scenarios[only.scenarios[0]];
            capital(&told_apart(&report.summary, own).in_short)
        }
        _ => format!("{} other settings", groups.len()),
    };
    let what = if groups.iter().all(|group| group.known_choice().is_none()) {
        "no percentile at any load"
    } else {
        "results are missing"
    };
    let first = report.groups.first();
    let choice = first.and_then(GroupReport::known_choice);
    let load = choice.map_or_else(
        || "This setting".to_owned(),
        |(_, lowest)| {
            format!(
                "The {} above",
                short_load(&report.summary.scenarios[lowest])
            )
        },
    );
    format!("{which}: {what}. {load} is not affected.")
}
