//! What the first screen says in large type of a few measured wheels, which have no percentile to design by.

use super::headline::{BigNumber, beside};
use crate::report::study_report::{neighbours, short_load};
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
    let hidden = loads_left_open(report, group);
    let between = neighbours(report, group, &summary.scenarios[lowest]);
    let beyond = match between {
        [None, Some(_)] => Some("below"),
        [Some(_), None] => Some("above"),
        _ => None,
    };
    let [lower, higher] = between;
    let mut of_load = vec![beside(lower, higher).unwrap_or("the only load studied".to_owned())];
    of_load.extend(beyond.map(|side| format!("the best load may be {side} {load}")));
    let units = LengthUnit::of_summary(summary);
    if !hidden.is_empty() {
        let peaks = hidden
            .iter()
            .map(|(load, peak)| format!("{} at {load}", units.length(*peak)));
        let peaks: Vec<String> = peaks.collect();
        of_load.push(format!(
            "numerical error leaves it open: {} at {load}, {}",
            units.length(peak),
            peaks.join(", ")
        ));
    }
    let or_hidden = hidden.iter().map(|(load, _)| load.as_str());
    let loads: Vec<&str> = std::iter::once(load.as_str()).chain(or_hidden).collect();
    let wheels = summary.patterns;
    let one = summary.is_of_one_wheel();
    let mut of_wheels = vec![if one {
        "the one wheel of mistuning.file: no percentile".to_owned()
    } else {
        format!(
            "wheel {}; another wheel may be higher than these {wheels}",
            of_wheel.pattern
        )
    }];
    let mut designs = group.choices.iter().filter(|_| !one);
    of_wheels.extend(designs.rfind(|own| own.is_of_a_design()).map(|own| {
        let percent = percent_words(own.percent);
        format!(
            "no percentile to design by: P{percent} needs {} wheels",
            own.needed_patterns
        )
    }));
    let error = { group.largest_stated_error(lowest) }.map_or_else(
        || "no bound".to_owned(),
        |own| format!("at most {}", share_words(own)),
    );
    let [of_lowest, of_peak, of_error, told] = if one {
        [
            "Normal load per sector with the lowest peak of the wheel".to_owned(),
            "Peak amplitude of the wheel".to_owned(),
            "Numerical error of the peak".to_owned(),
            "by what its solution states".to_owned(),
        ]
    } else {
        [
            "Normal load per sector with the smallest worst peak".to_owned(),
            format!("Worst peak of the {wheels} wheels at {load}"),
            format!("Numerical error of the peaks at {load}"),
            "the largest that a solution there states".to_owned(),
        ]
    };
    let is_open = beyond.is_some() || !hidden.is_empty();
    let number = |label, value, notes, is_open| BigNumber {
        label,
        value,
        told: None,
        notes,
        more: None,
        is_open,
    };
    Some([
        number(of_lowest, loads.join(" or "), of_load, is_open),
        number(of_peak, units.length(peak), of_wheels, false),
        number(of_error, error, vec![told], !hidden.is_empty()),
    ])
}

/// The other loads, with their worst peaks, that could have the smallest one by what the solutions state, each wrong by all of it.
pub(super) fn loads_left_open(report: &StudyReport, group: &GroupReport) -> Vec<(String, f64)> {
    let Some((of_wheel, peak)) = group.smallest_worst_peak() else {
        return Vec::new();
    };
    let highest = group
        .largest_stated_error(of_wheel.scenario)
        .map(|own| peak * (1.0 + own));
    let others = group
        .worst_peaks()
        .filter(|(own, _)| own.scenario != of_wheel.scenario);
    others
        .filter(|(own, peak)| {
            let bound = group
                .largest_stated_error(own.scenario)
                .map(|error| peak * (1.0 - error));
            bound
                .zip(highest)
                .is_none_or(|(bound, highest)| bound < highest)
        })
        .map(|(own, peak)| (short_load(&report.summary.scenarios[own.scenario]), peak))
        .collect()
}
