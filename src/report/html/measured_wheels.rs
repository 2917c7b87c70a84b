//! What the first screen says in large type of a few measured wheels, which have no percentile to design by.

use super::headline::{BigNumber, beside, beside_tuned, loads_left};
use crate::report::study_report::{AtTheEnd, end_at, neighbours, short_load, within};
use crate::report::words::{LengthUnit, percent_words, share_words};
use crate::report::{GroupReport, StudyReport};

/// The load under which the worst of the wheels of a file is lowest, its peak, and the error that the wheels state there.
pub(super) fn of_measured_wheels(
    report: &StudyReport,
    group: &GroupReport,
) -> Option<[BigNumber; 3]> {
    let summary = &report.summary;
    let (of_wheel, peak) = group.smallest_worst_peak()?;
    let lowest = of_wheel.scenario;
    let load = short_load(&summary.scenarios[lowest]);
    let scenarios = &summary.scenarios;
    let open = group.loads_left_open();
    let units = LengthUnit::of_summary(summary);
    let mut of_load = vec![if open.is_empty() {
        let [lower, higher] = neighbours(report, group, &scenarios[lowest]);
        beside(lower, higher).unwrap_or("the only load studied".to_owned())
    } else {
        let peaks = std::iter::once((lowest, peak)).chain(open.iter().copied());
        let peaks: Vec<String> = peaks
            .map(|(scenario, peak)| {
                let load = short_load(&scenarios[scenario]);
                format!("{} at {load}", units.length(peak))
            })
            .collect();
        let peaks = peaks.join(", ");
        format!("worst peak {peaks}: closer than the numerical error")
    }];
    let candidates = candidates(group);
    let beyond = ends_among(report, group, &candidates);
    let is_open = !beyond.is_empty() || !open.is_empty();
    of_load.extend(beyond.iter().map(|end| end.1.not_studied.clone()));
    let wheels = summary.patterns;
    let one = summary.is_of_one_wheel();
    let mut of_wheels = vec![if one {
        "the one wheel of mistuning.file: no percentile".to_owned()
    } else {
        format!("for these {wheels} wheels alone, no confidence for others")
    }];
    let mut designs = group.choices.iter().filter(|_| !one);
    of_wheels.extend(designs.rfind(|own| own.is_of_a_design()).map(|own| {
        let percent = percent_words(own.percent);
        format!(
            "no statistics: P{percent} needs {} wheels",
            own.needed_patterns
        )
    }));
    let bound = group
        .largest_stated_error(lowest)
        .map(|error| within(peak, error));
    if let Some((low, Some(high))) = bound {
        let (low, high) = (units.number(low), units.length(high));
        of_wheels.push(format!("with numerical error {low} to {high}"));
    }
    of_wheels.extend(beside_tuned(summary, lowest, peak));
    let error_at = |own: usize| {
        // Beside the peak, as the bounds in micrometres are.
        let stated = group.largest_stated_error(own);
        let above = stated.and_then(|error| within(1.0, error).1);
        above.map_or_else(
            || "no bound".to_owned(),
            |above| format!("at most {}", share_words(above - 1.0)),
        )
    };
    let [of_lowest, of_peak, of_error, told] = if one {
        [
            "Normal load per sector with the lowest peak of the wheel".to_owned(),
            "Peak amplitude of the wheel".to_owned(),
            "Numerical error of the peak".to_owned(),
            "the error bound of its solution".to_owned(),
        ]
    } else {
        [
            "Normal load per sector with the smallest worst peak".to_owned(),
            format!(
                "Worst peak of the {wheels} wheels at {load}, wheel {}",
                of_wheel.pattern
            ),
            format!("Numerical error of the peaks at {load}"),
            format!("the largest bound of the {wheels} solutions"),
        ]
    };
    let mut of_errors = vec![told];
    of_errors.extend(
        open.iter()
            .map(|&(own, _)| format!("at {}: {}", short_load(&scenarios[own]), error_at(own))),
    );
    let number = |label, value, notes, is_open| BigNumber {
        label,
        value,
        told: None,
        notes,
        more: None,
        is_open,
    };
    Some([
        number(
            of_lowest,
            loads_left(report, group, &candidates),
            of_load,
            is_open,
        ),
        number(of_peak, units.length(peak), of_wheels, false),
        number(of_error, error_at(lowest), of_errors, !open.is_empty()),
    ])
}

/// Which of the load of the wheels and those that are left open is the last one studied on a side, and what follows.
pub(super) fn ends_among(
    report: &StudyReport,
    group: &GroupReport,
    candidates: &[usize],
) -> Vec<(usize, AtTheEnd)> {
    let scenarios = &report.summary.scenarios;
    let is_last = |scenario: usize| {
        let beside = neighbours(report, group, &scenarios[scenario]);
        beside.iter().flatten().count() == 1
    };
    let last = candidates.iter().filter(|&&scenario| is_last(scenario));
    last.filter_map(|&scenario| Some((scenario, end_at(report, group, scenario, "worst peak")?)))
        .collect()
}

/// The scenario with the smallest worst peak of the wheels, and those that the errors of the peaks leave open.
pub(super) fn candidates(group: &GroupReport) -> Vec<usize> {
    let lowest = group.smallest_worst_peak().map(|worst| worst.0.scenario);
    let open = group.loads_left_open();
    lowest
        .into_iter()
        .chain(open.iter().map(|load| load.0))
        .collect()
}
