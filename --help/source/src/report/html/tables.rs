//! The tables of a report: loads, errors, tail fits, accounting, provenance.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::table::Table;
use crate::identity;
use crate::population::statistics::{
    FitStatus, Percentile, PointStatus, Quantity, SampleStatistics,
};
use crate::report::plot::escaped;
use crate::report::words::{LengthUnit, four_digits, load_words, percent_words, share_words};
use crate::report::{
    ErrorSpread, GroupReport, PercentileError, ScenarioSummary, StudyReport, setting,
};

/// What stands where there is nothing.
const NONE: &str = "<span title=\"no value\">–</span>";

/// Amplitudes of every load.
pub(super) fn amplitudes(report: &StudyReport, group: &GroupReport) -> String {
    let units = LengthUnit::of_summary(&report.summary);
    let column = |name: &str| format!("{name}, {}", units.name());
    let by_speed = has_speeds(report, group);
    let mut header = vec!["load per sector, N".to_owned()];
    header.extend(by_speed.then(|| "load of, rpm".to_owned()));
    header.extend([
        column("tuned"),
        "at, Hz".to_owned(),
        "crossing at, rpm".to_owned(),
        column("P50"),
        column("P95"),
        column("P99"),
    ]);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new(&header);
    for &index in &group.scenarios {
        let scenario = &report.summary.scenarios[index];
        let amplitude = |metres: f64| units.number(metres);
        let mut row = vec![name(scenario)];
        row.extend(by_speed.then(|| speed(scenario)));
        row.extend([
            scenario
                .tuned_amplitude_m
                .map_or_else(|| escaped(scenario.tuned_status), amplitude),
            scenario
                .tuned_frequency_hz
                .map_or(NONE.to_owned(), |hz| format!("{hz:.2}")),
            scenario
                .crossing_rpm()
                .map_or(NONE.to_owned(), |rpm| format!("{rpm:.0}")),
        ]);
        row.extend(percentiles(&scenario.peak_amplitude_m, amplitude));
        table.row_chosen(index == group.shown, row);
    }
    table.html()
}

/// Whether a load of the group is that of a speed.
fn has_speeds(report: &StudyReport, group: &GroupReport) -> bool {
    let scenarios = &report.summary.scenarios;
    let mut speeds = group.scenarios.iter().map(|&own| scenarios[own].speed_rpm);
    speeds.any(|speed| speed.is_some())
}

fn speed(scenario: &ScenarioSummary) -> String {
    let speed = scenario.speed_rpm;
    speed.map_or(NONE.to_owned(), |speed| speed.to_string())
}

/// Amplitudes of every load as stress; empty where the study has no scale.
pub(super) fn stresses(report: &StudyReport, group: &GroupReport) -> String {
    let Some(pa_per_m) = report.summary.stress_pa_per_m else {
        return String::new();
    };
    let by_speed = has_speeds(report, group);
    let mut header = vec!["load per sector, N"];
    header.extend(by_speed.then_some("load of, rpm"));
    header.extend(["tuned, MPa", "P50, MPa", "P95, MPa", "P99, MPa"]);
    let mut table = Table::new(&header);
    for &index in &group.scenarios {
        let scenario = &report.summary.scenarios[index];
        let stress = |metres: f64| four_digits(1e-6 * pa_per_m * metres);
        let mut row = vec![name(scenario)];
        row.extend(by_speed.then(|| speed(scenario)));
        row.push(scenario.tuned_amplitude_m.map_or(NONE.to_owned(), stress));
        row.extend(percentiles(&scenario.peak_amplitude_m, stress));
        table.row_chosen(index == group.shown, row);
    }
    format!(
        "<h3>Stress, {pa_per_m:e} Pa per m of amplitude, 95 % bounds in brackets</h3>\n{}",
        table.html()
    )
}

/// Amplification factors of every load, and what its contacts do.
pub(super) fn factors(report: &StudyReport, group: &GroupReport) -> String {
    let mut table = Table::new(&[
        "load per sector, N",
        "P50",
        "P95",
        "P99",
        "pairs that slip",
        "wheels with separation",
    ]);
    for &index in &group.scenarios {
        let scenario = &report.summary.scenarios[index];
        let mut row = vec![name(scenario)];
        row.extend(percentiles(&scenario.amplification_factor, |factor| {
            format!("{factor:.3}")
        }));
        // Pairs of a linear limit stick or slide by definition: no share of them is a result.
        let friction = scenario.normal_load_n.is_some();
        let shares = [scenario.mean_slipping_fraction, scenario.separated_rows];
        row.extend(shares.map(|share| optional_share(share.filter(|_| friction))));
        table.row_chosen(index == group.shown, row);
    }
    table.html()
}

/// The settings of the accuracy figure: those of a measured ladder that nothing cheaper beats, else what
/// `[accuracy]` tried; empty without both.
pub(super) fn settings(report: &StudyReport) -> String {
    let gflop = |operations: f64| format!("{:.3}", operations / 1e9);
    let share = |error: Option<f64>| error.map_or(NONE.to_owned(), share_words);
    let tolerance =
        |value: Option<f64>| value.map_or(NONE.to_owned(), |value| format!("{value:e}"));
    let (words, table) = if let Some(ladder) = &report.accuracy_ladder {
        let mut front: Vec<_> = ladder.settings.iter().filter(|own| own.on_front).collect();
        front.sort_by(|a, b| {
            a.operations
                .partial_cmp(&b.operations)
                .unwrap_or(Ordering::Equal)
        });
        let mut table = Table::new(&[
            "setting",
            "basis",
            "harmonics",
            "samples",
            "residual",
            "peak",
            "median error",
            "P95 of the error, bound",
            "Gflop per row",
        ]);
        for own in front {
            table.row(vec![
                own.setting.to_string(),
                escaped(&own.basis),
                escaped(&own.harmonics),
                own.samples_per_period.to_string(),
                tolerance(own.residual_tolerance),
                tolerance(own.peak_tolerance),
                share(own.amplitude_error_median),
                share(own.drawn_error()),
                own.operations.map_or(NONE.to_owned(), gflop),
            ]);
        }
        ("Settings that nothing cheaper beats", table)
    } else if let Some(trials) = &report.accuracy_trials {
        let mut table = Table::new(&[
            "setting",
            "basis, harmonics, samples, tolerances, law",
            "rows",
            "largest error",
            "Gflop per row",
        ]);
        for (place, own) in trials.tried.iter().enumerate() {
            table.row_chosen(
                own.taken,
                vec![
                    place.to_string(),
                    escaped(&own.setting),
                    own.rows.to_string(),
                    share(own.worst),
                    gflop(own.operations),
                ],
            );
        }
        (
            "Settings tried for the accepted error, the one taken shaded",
            table,
        )
    } else {
        return String::new();
    };
    format!("<h3>{words}</h3>\n{}", table.html())
}

fn name(scenario: &ScenarioSummary) -> String {
    escaped(&load_words(scenario.contact, scenario.normal_load_n))
}

fn optional_share(share: Option<f64>) -> String {
    share.map_or(NONE.to_owned(), |share| format!("{:.1} %", 100.0 * share))
}

fn percentiles(sample: &SampleStatistics, show: impl Fn(f64) -> String) -> Vec<String> {
    [50, 95, 99]
        .into_iter()
        .map(|percent| bounded(sample.percentile(percent), &show))
        .collect()
}

/// A value with its bounds.
fn bounded(found: Option<&Percentile>, show: impl Fn(f64) -> String) -> String {
    let Some((found, value)) = found.and_then(|found| Some((found, found.value?))) else {
        return match found.map(|found| found.status) {
            Some(PointStatus::TooFewPatterns { needed }) => {
                format!("<span title=\"needs {needed} patterns\">–</span>")
            }
            Some(PointStatus::TooManyFailures) => {
                "<span title=\"too many rows failed\">–</span>".to_owned()
            }
            _ => NONE.to_owned(),
        };
    };
    let bound = |bound: Option<f64>| bound.map_or(NONE.to_owned(), &show);
    format!(
        "{} <span class=\"bounds\">[{}, {}]</span>",
        show(value),
        bound(found.lower),
        bound(found.upper)
    )
}

/// Numerical errors of every load beside its statistical interval.
pub(super) fn errors(report: &StudyReport, group: &GroupReport) -> String {
    let choice = group.choices.iter().find(|choice| choice.lowest.is_some());
    let percent = choice.map_or(95.0, |choice| choice.percent);
    let percentile = percent_words(percent);
    let header = [
        "load per sector, N".to_owned(),
        "sampling".to_owned(),
        "harmonics".to_owned(),
        "stated".to_owned(),
        "stated, largest".to_owned(),
        "rows without bound".to_owned(),
        format!("numerical width of P{percentile}"),
        format!("statistical width of P{percentile}"),
    ];
    let mut table = Table::new(&header.each_ref().map(String::as_str));
    for errors in &group.errors {
        let scenario = &report.summary.scenarios[errors.scenario];
        let rows = &errors.rows;
        let median = |spread: &Option<ErrorSpread>| {
            spread.map_or(NONE.to_owned(), |spread| share_words(spread.median))
        };
        let width = |width: Option<f64>| width.map_or(NONE.to_owned(), share_words);
        let found = errors
            .percentiles
            .iter()
            .find(|error| error.percentile.percent.total_cmp(&percent).is_eq());
        table.row_chosen(
            errors.scenario == group.shown,
            vec![
                name(scenario),
                median(&rows.sampling),
                median(&rows.harmonics),
                median(&rows.stated),
                rows.stated
                    .map_or(NONE.to_owned(), |spread| share_words(spread.largest)),
                rows.without_bound.to_string(),
                width(found.and_then(PercentileError::numerical_width)),
                width(found.and_then(PercentileError::statistical_width)),
            ],
        );
    }
    table.html()
}

/// Percentiles of fitted laws beside those of the sample, at the load shown.
pub(super) fn tails(report: &StudyReport, group: &GroupReport) -> String {
    let units = LengthUnit::of_summary(&report.summary);
    let mut table = Table::new(&[
        "quantity and law",
        "P95",
        "P99",
        "P99.9",
        "P99.99",
        "goodness of fit",
    ]);
    for found in &group.distributions {
        let (quantity, unit) = match found.quantity {
            Quantity::PeakAmplitudeM => ("peak amplitude", units.metres()),
            Quantity::AmplificationFactor => ("amplification factor", 1.0),
        };
        let show = |value: f64| four_digits(value / unit);
        let Some(first) = found.fits.first() else {
            continue;
        };
        let mut row = vec![format!("{quantity}, sample")];
        row.extend(
            first
                .percentiles
                .iter()
                .map(|percentile| bounded(Some(&percentile.empirical), show)),
        );
        row.push("<span title=\"nothing is fitted\">–</span>".to_owned());
        table.row(row);
        for fit in &found.fits {
            let mut row = vec![format!(
                "{quantity}, {}",
                escaped(&fit.law.name().replace('_', " "))
            )];
            row.extend(fit.percentiles.iter().map(|percentile| {
                percentile.model.map_or(NONE.to_owned(), |model| {
                    let marks = match (percentile.outside_interval, percentile.extrapolates) {
                        (true, true) => " *+",
                        (true, false) => " *",
                        (false, true) => " +",
                        (false, false) => "",
                    };
                    let bound = |bound: Option<f64>| bound.map_or(NONE.to_owned(), show);
                    format!(
                        "{}{marks} <span class=\"bounds\">[{}, {}]</span>",
                        show(model.value),
                        bound(model.lower),
                        bound(model.upper)
                    )
                })
            }));
            row.push(match (fit.status, fit.p_value) {
                (FitStatus::Converged, Some(p)) if fit.rejected => format!("p = {p:.3}, rejected"),
                (FitStatus::Converged, Some(p)) => format!("p = {p:.3}"),
                (FitStatus::Converged, None) => "no p".to_owned(),
                (status, _) => escaped(&status.name().replace('_', " ")),
            });
            table.row(row);
        }
    }
    table.html()
}

/// Rows by status, a row per scenario and the sum.
pub(super) fn accounting(report: &StudyReport) -> String {
    let summary = &report.summary;
    let statuses: BTreeSet<&str> = summary
        .rows
        .by_status()
        .into_keys()
        .filter(|status| *status != "ok")
        .collect();
    let mut header = vec!["scenario", "of", "planned", "ok", "failed"];
    header.extend(&statuses);
    header.push("share that fails in the population");
    let mut table = Table::new(&header);
    let several = report.groups.len() > 1;
    let counts = |rows: &crate::population::statistics::Accounting| -> Vec<String> {
        let by_status = rows.by_status();
        let mut cells = vec![
            rows.planned().to_string(),
            rows.ok().to_string(),
            rows.failed().to_string(),
        ];
        cells.extend(
            statuses
                .iter()
                .map(|status| by_status.get(status).copied().unwrap_or(0).to_string()),
        );
        cells.push(
            rows.failed_share_upper_bound()
                .map_or(NONE.to_owned(), |bound| {
                    format!("at most {}", share_words(bound))
                }),
        );
        cells
    };
    for group in &report.groups {
        for &index in &group.scenarios {
            let scenario = &summary.scenarios[index];
            let load = name(scenario);
            let words = if several {
                format!("{}, load {load}", escaped(&setting(group)))
            } else {
                format!("load {load}")
            };
            let mut row = vec![index.to_string(), words];
            row.extend(counts(&scenario.rows));
            table.row(row);
        }
    }
    let mut row = vec!["all".to_owned(), "all loads".to_owned()];
    row.extend(counts(&summary.rows));
    table.row(row);
    table.html()
}

/// What the numbers were made from.
pub(super) fn provenance(report: &StudyReport) -> String {
    let (summary, made) = (&report.summary, &report.provenance);
    let mut table = Table::of_facts();
    table.fact("study", &summary.name);
    table.fact("study digest", &summary.study_digest);
    table.fact("program", &format!("blisk {}", made.version));
    table.fact("build", identity::named(&made.build));
    table.fact("seed", &summary.seed.to_string());
    table.fact("generator", &made.generator);
    table.fact("patterns", &summary.patterns.to_string());
    table.fact("basis", &summary.basis.name);
    for (name, digests) in [("input", &made.inputs), ("table", &made.tables)] {
        for (path, digest) in digests {
            table.fact(&format!("{name} {path}"), digest);
        }
    }
    table.html()
}
