//! The summary: best loads, warnings, what costs a statistic.

use blisk::population::monte_carlo::{ResponseRow, Scenario, TunedReference};
use blisk::population::statistics::ScenarioAccumulator;
use blisk::population::table::ScenarioRecord;
use blisk::report::{
    BasisSummary, NumericalError, NumericalFinding, RowTolerance, StudySummary, SummaryContext,
    Warning,
};
use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::response::harmonic_balance::Status;

fn context(harmonics: Harmonics) -> SummaryContext {
    SummaryContext {
        tolerance: RowTolerance {
            sampling_tolerance: Some(1e-3),
            harmonic_tolerance: Some(0.02),
        },
        basis: BasisSummary::default(),
        name: "made-up".to_owned(),
        study_digest: "0123".to_owned(),
        seed: 1,
        patterns: 400,
        stop: None,
        harmonics,
        numerical_error: None,
        rotation: None,
        stress_pa_per_m: None,
        version: "0".to_owned(),
    }
}

/// 400 patterns whose amplitude is `scale` (1 + i / 1000), of which the first `failed` fail.
fn record(
    index: usize,
    contact: ContactCondition,
    scale: f64,
    failed: u32,
    separated: f64,
) -> ScenarioRecord {
    let mut rows = ScenarioAccumulator::default();
    for i in 0..400 {
        let good = i >= failed;
        let amplitude = scale * (1.0 + f64::from(i) / 1000.0);
        let status = if good { Status::Ok } else { Status::Stagnated };
        rows.add(&ResponseRow {
            peak_amplitude_m: good.then_some(amplitude),
            peak_frequency_hz: good.then_some(500.0),
            peak_blade: good.then_some(3),
            amplification_factor: good.then_some(amplitude / scale),
            peak_bracketed: good.then_some(true),
            harmonics: "1-3".to_owned(),
            nonlinear_solves: 13,
            newton_iterations: 40,
            factorisations: 4,
            residual: good.then_some(1e-9),
            slipping_fraction: good.then_some(0.5),
            separated_fraction: good.then_some(separated),
            sampling_error: good.then_some(1e-4),
            harmonic_error: good.then_some(-2e-2),
            stated_error: good.then_some(0.021 + 1e-5 * f64::from(i)),
            error_within_tolerance: good.then_some(true),
            basis: "whole space".to_owned(),
            ..ResponseRow::without_result(index, i, status)
        });
    }
    ScenarioRecord {
        scenario: Scenario {
            index,
            load_case: None,
            engine_order: 3,
            standard_deviation: Some(0.03),
            contact,
        },
        tuned: TunedReference {
            scenario: index,
            status: Status::Ok,
            amplitude_m: Some(scale),
            frequency_hz: Some(500.0),
            separated_fraction: Some(0.0),
            slipping_fraction: Some(1.0),
            harmonics: "1-3".to_owned(),
            errors: None,
        },
        statistics: rows.finish(),
        stability: None,
    }
}

fn load(normal_load_n: f64) -> ContactCondition {
    ContactCondition::Full { normal_load_n }
}

#[test]
fn the_best_load_is_the_lowest_and_says_whether_it_is_enclosed() {
    let records = [
        record(0, ContactCondition::Slide, 9e-4, 0, 0.0),
        record(1, load(100.0), 3e-4, 0, 0.0),
        record(2, load(200.0), 2e-4, 0, 0.0),
        record(3, load(400.0), 4e-4, 0, 0.0),
    ];
    let harmonics = Harmonics::Set(vec![1, 3]);
    let summary = StudySummary::new(&context(harmonics.clone()), &records);
    assert_eq!(summary.best.len(), 2);
    for best in &summary.best {
        assert_eq!(
            (best.scenario, best.normal_load_n, best.interior),
            (2, Some(200.0), true)
        );
    }
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    let text = summary.to_string();
    for fragment in [
        "load N",
        "slide",
        "200.0",
        "lowest P95 amplitude",
        "at 200 N per sector\n",
    ] {
        assert!(text.contains(fragment), "{fragment} in\n{text}");
    }
    let open = StudySummary::new(&context(harmonics), &records[..3]);
    assert!(open.best.iter().all(|best| !best.interior));
    assert!(open.to_string().contains("not enclosed"));
}

#[test]
fn separation_is_a_warning_unless_harmonic_zero_and_even_ones_are_in() {
    let records = [record(0, load(100.0), 3e-4, 0, 0.25)];
    let with = |set: &[u32]| StudySummary::new(&context(Harmonics::Set(set.to_vec())), &records);
    let warned = |summary: &StudySummary| {
        summary
            .warnings
            .iter()
            .any(|warning| matches!(warning, Warning::SeparationWithFewHarmonics { .. }))
    };
    assert!(warned(&with(&[1])) && warned(&with(&[1, 3])) && warned(&with(&[0, 1, 3])));
    assert!(!warned(&with(&[0, 1, 2, 3])));
    assert!(warned(&StudySummary::new(
        &context(Harmonics::Auto),
        &records
    )));
}

#[test]
fn rows_beyond_their_tolerance_are_counted_with_the_largest_stated_error() {
    let mut inexact = record(0, load(9.0), 1.0, 0, 0.0);
    assert_eq!(inexact.statistics.beyond_tolerance, 0);
    inexact.statistics.beyond_tolerance = 100;
    inexact.statistics.beyond_by_sampling = 30;
    let auto = StudySummary::new(&context(Harmonics::Auto), &[inexact]);
    assert_eq!(
        auto.warnings,
        [Warning::BeyondTolerance {
            rows: 100,
            by_sampling: 30,
            automatic: true,
            on_basis: true,
            planned: 400,
            scenarios: vec![0],
            tolerance: context(Harmonics::Auto).tolerance,
            largest_stated_error: 0.021 + 1e-5 * 399.0,
        }]
    );
    // On tuned receptances naming harmonics that "auto" left out does not help, and the text does not advise it.
    let mut inexact = record(0, load(9.0), 1.0, 0, 0.0);
    inexact.statistics.beyond_tolerance = 100;
    for (name, automatic, said, unsaid) in [
        (
            "tuned_receptances",
            true,
            "took all that have a peak: raise the normal load, or keep this one, since the stated errors are valid, or accept",
            "name more in",
        ),
        (
            "stick_slide 6 + 6",
            true,
            "raise the normal load, name more in solver.harmonics, or accept",
            "keep this one",
        ),
        (
            "tuned_receptances",
            false,
            "take solver.harmonics = \"auto\" or a larger set",
            "name more in",
        ),
    ] {
        let set = Harmonics::Set(vec![1, 3]);
        let mut own = context(if automatic { Harmonics::Auto } else { set });
        own.basis.name = name.to_owned();
        let text = StudySummary::new(&own, std::slice::from_ref(&inexact)).to_string();
        assert!(text.contains(said) && !text.contains(unsaid), "{text}");
    }
    // The text says under which load, and what the tolerances are.
    let text = auto.to_string();
    assert!(
        text.contains(
            "100 of 400 rows state a sampling or harmonic error beyond its tolerance (0.1 % by samples per period, 2 % by harmonics) \
             at 9 N (stated errors up to 2.5 %); the sampling error is the larger one of 30: raise solver.samples_per_period; \
             the harmonic error is the larger one of 70: \"auto\" took no more of them: raise the normal load"
        ),
        "{text}"
    );
}

#[test]
fn rows_beyond_their_tolerance_are_counted_by_the_larger_of_their_errors() {
    let mut rows = ScenarioAccumulator::default();
    for (pattern, sampling, harmonic, within) in [
        (0, 3e-2, -1e-2, false),
        (1, 1e-3, -5e-2, false),
        (2, -4e-2, 3e-2, false),
        (3, 5e-2, 1e-2, true),
        // Within every tolerance of the sampling error: the harmonics of the wheels that judge are what is beyond.
        (4, 1e-4, 0.0, false),
    ] {
        rows.add(&ResponseRow {
            peak_amplitude_m: Some(1.0),
            sampling_error: Some(sampling),
            harmonic_error: Some(harmonic),
            error_within_tolerance: Some(within),
            ..ResponseRow::without_result(0, pattern, Status::Ok)
        });
    }
    let counted = rows.finish();
    assert_eq!(
        (counted.beyond_tolerance, counted.beyond_by_sampling),
        (4, 2)
    );
}

#[test]
fn failures_are_counted_warned_of_and_cost_a_statistic_beyond_the_gate() {
    let harmonics = || Harmonics::Set(vec![1]);
    let few = StudySummary::new(&context(harmonics()), &[record(0, load(1.0), 1.0, 1, 0.0)]);
    assert_eq!(
        (few.rows.planned(), few.rows.ok(), few.rows.failed()),
        (400, 399, 1)
    );
    assert!(few.warnings.contains(&Warning::Failures {
        failed: 1,
        planned: 400
    }));
    // One of 400 is 0.25 %: within a tenth of the 5 % tail of P95, beyond that of P99.
    assert!(few.warnings.contains(&Warning::TooManyFailures {
        percent: 99,
        scenarios: vec![0]
    }));
    assert!(few.failures_cost_a_statistic());
    let none = StudySummary::new(&context(harmonics()), &[record(0, load(1.0), 1.0, 0, 0.0)]);
    assert!(!none.failures_cost_a_statistic());
}

#[test]
fn all_rows_of_a_scenario_failing_gives_no_number_and_no_panic() {
    let mut lost = record(0, load(1.0), 1.0, 400, 0.0);
    lost.tuned.status = Status::Diverged;
    lost.tuned.amplitude_m = None;
    let summary = StudySummary::new(&context(Harmonics::Set(vec![1])), &[lost]);
    assert_eq!(summary.scenarios[0].peak_amplitude_m.mean, None);
    assert!(summary.failures_cost_a_statistic());
    assert!(summary.to_string().contains("diverged"));
    assert!(serde_json::to_string(&summary).is_ok());
}

#[test]
fn a_basis_less_accurate_than_asked_for_is_a_warning_and_an_accurate_one_is_not() {
    let summary = |error: f64| {
        let basis = BasisSummary {
            name: "stick_slide 2+2".to_owned(),
            tuned_peak_error: Some(error),
            craig_bampton_reach: None,
            craig_bampton_error: None,
            wanted_error: 0.005,
            wanted_peak_error: 0.005,
            is_replaced: false,
        };
        let context = SummaryContext {
            basis,
            ..context(Harmonics::Set(vec![1, 3]))
        };
        StudySummary::new(&context, &[])
    };
    let warned = |summary: &StudySummary| {
        let found = summary.warnings.iter();
        found
            .filter(|warning| matches!(warning, Warning::BasisError { .. }))
            .count()
    };
    assert_eq!(warned(&summary(0.006)), 1);
    assert_eq!(warned(&summary(0.005)), 0);
    assert!(summary(0.006).to_string().contains("within 0.60 %"));
}

#[test]
fn a_short_reach_of_modes_is_a_warning() {
    let warnings = |reach: f64| {
        let basis = BasisSummary {
            name: "stick_slide 6+6".to_owned(),
            tuned_peak_error: Some(0.0),
            craig_bampton_reach: Some(reach),
            craig_bampton_error: None,
            wanted_error: 0.001,
            wanted_peak_error: 0.001,
            is_replaced: false,
        };
        basis.warnings()
    };
    assert!(warnings(10.0).is_empty());
    assert!(matches!(
        warnings(0.9)[..],
        [Warning::CraigBamptonModes { .. }]
    ));
}

/// The interval of P95 of 400 values 1 + i / 1000 is 17 ranks wide, 1.2 % of the value.
#[test]
fn a_numerical_error_is_held_against_the_interval_of_the_wanted_percentile() {
    let full = ContactCondition::Full {
        normal_load_n: 50.0,
    };
    let warned = |p95_upper: f64| {
        let context = SummaryContext {
            numerical_error: Some(NumericalError {
                accepted: 0.01,
                p95_upper: Some(p95_upper),
                worst_upper: None,
                met: true,
            }),
            ..context(Harmonics::Auto)
        };
        let summary = StudySummary::new(&context, &[record(0, full, 1.0, 0, 0.0)]);
        let found = summary.warnings.iter().filter_map(|warning| match warning {
            Warning::NumericalError(finding) => Some(*finding),
            _ => None,
        });
        match found.collect::<Vec<_>>()[..] {
            [] => "fine",
            [NumericalFinding::Large { .. }] => "large",
            [NumericalFinding::Needless { .. }] => "needless",
            _ => "something else",
        }
    };
    assert_eq!(warned(2e-3), "large");
    assert_eq!(warned(5e-4), "fine");
    assert_eq!(warned(5e-5), "needless");
}
