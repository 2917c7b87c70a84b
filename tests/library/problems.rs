//! Problems that a program states: the same rows as from a study file, and refused values with what is accepted.

use blisk::options::{ContactLaw, Deviations, Ring};
use blisk::{
    ContactCondition, ContactOptions, Damping, Distribution, Engine, LumpedOptions, Mistuning,
    Numerics, Pattern, PipelineError, Problem, Progress, Quantity, SectorModel, Status, Study,
    lumped_sector,
};

fn options() -> LumpedOptions {
    LumpedOptions {
        sectors: 6,
        blade_mass_kg: 0.25,
        disk_mass_kg: 1.0,
        ring_mass_kg: 0.03,
        blade_stiffness_n_per_m: 2.5e6,
        disk_ground_stiffness_n_per_m: 7.0e6,
        disk_coupling_stiffness_n_per_m: 2.5e5,
        ring_coupling_stiffness_n_per_m: 8.0e5,
        ring_disk_stiffness_n_per_m: 1.0e4,
        ..LumpedOptions::default()
    }
}

fn sector() -> SectorModel {
    lumped_sector(&options()).unwrap()
}

fn problem() -> Problem {
    let wheels = Mistuning::Random {
        law: Distribution::TruncatedNormal { truncation: 2.5 },
        standard_deviations: vec![0.01, 0.04],
        seed: 7,
    };
    Problem {
        contact: Some(ContactOptions {
            law: ContactLaw::MacroSlip1d,
            friction_coefficient: 0.3,
            tangential_stiffness_n_per_m: 8.0e5,
            normal_stiffness_n_per_m: None,
            ring: Ring::Locked,
        }),
        amplitude_n: 10.0,
        conditions: vec![
            ContactCondition::Slide,
            ContactCondition::Full {
                normal_load_n: 50.0,
            },
        ],
        ..Problem::new(Damping::StructuralLossFactor(0.002), &[1, 2], wheels)
    }
}

fn numerics() -> Numerics {
    Numerics {
        harmonics: Some(vec![1, 3]),
        samples_per_period: Some(64),
        peak_tolerance: Some(5e-4),
        ..Numerics::default()
    }
}

/// The study file that says the same as [`problem`], [`numerics`] and [`sector`].
const STUDY: &str = r#"
schema = 1
study = { name = "same", seed = 7, patterns = 6 }
mistuning = { distribution = { kind = "truncated_normal", truncation = 2.5 } }
sweep = { standard_deviation = [0.01, 0.04], normal_load_n = ["slide", 50] }
excitation = { engine_orders = [1, 2], amplitude_n = 10.0 }
damping = { structural_loss_factor = 0.002 }
solver = { harmonics = [1, 3], samples_per_period = 64, peak_tolerance = 5e-4 }
contact = { law = "macro_slip_1d", friction_coefficient = 0.3, tangential_stiffness_n_per_m = 8.0e5 }

[model]
source = "lumped"

[model.lumped]
sectors = 6
blade_mass_kg = 0.25
disk_mass_kg = 1.0
ring_mass_kg = 0.03
blade_stiffness_n_per_m = 2.5e6
disk_ground_stiffness_n_per_m = 7.0e6
disk_coupling_stiffness_n_per_m = 2.5e5
ring_coupling_stiffness_n_per_m = 8.0e5
ring_disk_stiffness_n_per_m = 1.0e4
"#;

#[test]
fn a_problem_has_the_rows_that_a_run_of_the_same_study_stores() {
    let engine = Engine::build(&sector(), &problem(), &numerics()).unwrap();
    let population = engine.population(6, &()).unwrap();
    assert_eq!(population.rows().len(), 6 * 8);
    let place = tempfile::tempdir().unwrap();
    let study = Study::parse(&place.path().join("study.toml"), STUDY).unwrap();
    let results = place.path().join("results");
    let request = blisk::RunRequest {
        study: &study,
        results: &results,
        threads: 2,
    };
    let outcome = blisk::run(request, &()).unwrap();
    let stored = blisk::campaign::StoredStudy::open(&results, None).unwrap();
    for row in population.rows() {
        assert_eq!(row.status, Status::Ok);
        let delivered = stored.row(row.scenario, row.pattern).unwrap();
        assert_eq!(delivered.as_ref(), Some(row));
    }
    // One wheel by itself, drawn or of its deviations, is the row of the population.
    let scenario = engine.scenarios()[7];
    let wheel = engine.wheel(5, &scenario).unwrap();
    let row = population.of(&scenario).nth(5).unwrap();
    assert_eq!(&engine.peak(&wheel, &scenario), row);
    let Deviations::PerBlade(deviations) = wheel.deviations else {
        panic!("deviations per mode");
    };
    assert_eq!(
        &engine.peak(&Pattern::of_blades(5, deviations), &scenario),
        row
    );
    // The statistics are those of the summary.
    for (scenario, summary) in engine.scenarios().iter().zip(&outcome.summary.scenarios) {
        let found = population.statistics(scenario);
        assert_eq!(found.accounting, summary.rows);
        let median = population.percentile(scenario, Quantity::PeakAmplitudeM, 50.0);
        assert_eq!(found.peak_amplitude_m.percentile(50), Some(&median));
        assert!(median.lower < median.upper);
    }
}

#[test]
fn an_engine_of_a_study_file_has_its_rows_and_no_number_of_threads_changes_one() {
    let study = Study::parse("study.toml".as_ref(), STUDY).unwrap();
    let of_study = Engine::of_study(&study).unwrap();
    let of_problem = Engine::build(&sector(), &problem(), &numerics()).unwrap();
    let on = |engine: &Engine, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| engine.population(4, &())).unwrap()
    };
    assert_eq!(on(&of_study, 1), on(&of_problem, 3));
}

#[test]
fn settings_by_an_accepted_error_are_those_of_a_study_with_accuracy() {
    let mut problem = problem();
    problem.engine_orders = vec![2];
    let chosen = Engine::build(&sector(), &problem, &Numerics::within(0.02)).unwrap();
    let text = STUDY
        .replace("patterns = 6", "patterns = 1000")
        .replace("engine_orders = [1, 2]", "engine_orders = [2]")
        .replace(
            "solver = { harmonics = [1, 3], samples_per_period = 64, peak_tolerance = 5e-4 }",
            "accuracy = { amplitude_error = 0.02 }",
        );
    let study = Study::parse("study.toml".as_ref(), &text).unwrap();
    let expected = Engine::of_study(&study).unwrap();
    assert_eq!(
        chosen.population(3, &()).unwrap(),
        expected.population(3, &()).unwrap()
    );
}

/// What is said of a problem that is not accepted.
fn refusal(problem: &Problem, numerics: &Numerics) -> String {
    match Engine::build(&sector(), problem, numerics) {
        Ok(_) => panic!("accepted: {problem:?} {numerics:?}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_refused_value_is_named_with_what_is_accepted() {
    let random = |standard_deviations: Vec<f64>, seed: u64| Mistuning::Random {
        law: Distribution::Normal,
        standard_deviations,
        seed,
    };
    let with = |change: &dyn Fn(&mut Problem)| {
        let mut changed = problem();
        change(&mut changed);
        refusal(&changed, &numerics())
    };
    let contact = |change: fn(&mut ContactOptions)| {
        with(&|problem: &mut Problem| change(problem.contact.as_mut().unwrap()))
    };
    let load = ContactCondition::Full {
        normal_load_n: -5.0,
    };
    let cases = [
        (
            contact(|own| own.friction_coefficient = -0.5),
            ["contact.friction_coefficient", "-0.5", "from 0 to 10"],
        ),
        (
            contact(|own| own.tangential_stiffness_n_per_m = f64::NAN),
            ["tangential_stiffness_n_per_m", "nan", "above 0"],
        ),
        (
            with(&|own| own.amplitude_n = f64::INFINITY),
            ["excitation.amplitude_n", "inf", "1e-30 to 1e30"],
        ),
        (
            with(&|own| own.damping = Damping::ModalRatio(-0.1)),
            ["damping.modal_ratio", "-0.1", "accepted"],
        ),
        (
            with(&|own| own.engine_orders.clear()),
            ["excitation.engine_orders", "[]", "at least one"],
        ),
        (
            with(&|own| own.conditions = vec![load]),
            ["sweep.normal_load_n", "-5", "accepted"],
        ),
        (
            with(&|own| own.mistuning = random(vec![0.9], 1)),
            ["standard_deviation", "0.9", "0.5"],
        ),
        (
            with(&|own| own.mistuning = random(vec![0.1], u64::MAX)),
            ["study.seed", "18446744073709551615", "whole number"],
        ),
        (
            with(&|own| own.mistuning = Mistuning::Measured(vec![vec![0.0, -1.5]])),
            ["deviation", "-1.5", "above -1"],
        ),
        (
            with(&|own| own.mistuning = Mistuning::Measured(vec![vec![0.0; 5]])),
            ["pattern 0", "blade 5", "0 to 5"],
        ),
        (
            with(&|own| own.contact = None),
            [
                "contact",
                "friction_coefficient",
                "because the model has contact",
            ],
        ),
    ];
    let shown = cases[0].0.lines().next().unwrap();
    assert!(
        include_str!("../../docs/library.md").contains(shown),
        "docs/library.md lacks {shown}"
    );
    for (said, words) in cases {
        for word in words {
            assert!(said.contains(word), "no {word:?} in {said}");
        }
    }
    let harmonics = Numerics {
        harmonics: Some(vec![3]),
        ..Numerics::default()
    };
    let said = refusal(&problem(), &harmonics);
    assert!(
        said.contains("solver.harmonics") && said.contains("[3]"),
        "{said}"
    );
    let said = refusal(&problem(), &Numerics::within(0.5));
    assert!(
        said.contains("accuracy.amplitude_error") && said.contains("0.001 to 0.2"),
        "{said}"
    );
}

#[test]
fn a_sector_of_ones_own_is_checked() {
    let mut sector = sector();
    sector.observed.clear();
    let Err(PipelineError::Model(error)) = Engine::build(&sector, &problem(), &numerics()) else {
        panic!("accepted");
    };
    assert!(error.to_string().contains("observe"), "{error}");
}

#[test]
fn a_wheel_that_does_not_fit_is_a_row_with_a_status_and_an_unknown_one_an_error() {
    let engine = Engine::build(&sector(), &problem(), &numerics()).unwrap();
    let scenario = engine.scenarios()[1];
    let status = |deviations: Vec<f64>| {
        engine
            .peak(&Pattern::of_blades(0, deviations), &scenario)
            .status
    };
    assert_eq!(status(vec![0.0; 6]), Status::Ok);
    assert_eq!(status(vec![0.0; 5]), Status::InvalidPattern);
    assert_eq!(status(vec![-2.0; 6]), Status::InvalidPattern);
    let measured = Problem {
        mistuning: Mistuning::Measured(vec![vec![0.01; 6], vec![0.0; 6]]),
        ..problem()
    };
    let engine = Engine::build(&sector(), &measured, &numerics()).unwrap();
    assert_eq!(
        engine.population(9, &()).unwrap().rows().len(),
        2 * engine.scenarios().len()
    );
    let error = engine.wheel(2, &engine.scenarios()[0]).unwrap_err();
    assert!(error.to_string().contains("an id from 0 to 1"), "{error}");
}

/// Asks to stop at once.
struct Impatient;

impl Progress for Impatient {
    fn stop_requested(&self) -> bool {
        true
    }
}

#[test]
fn a_population_that_is_stopped_gives_no_statistics() {
    let engine = Engine::build(&sector(), &problem(), &numerics()).unwrap();
    let stopped = engine.population(50, &Impatient);
    let Err(PipelineError::Stopped { solved, planned }) = stopped else {
        panic!("not stopped: {stopped:?}");
    };
    assert!(solved < planned && planned == 50 * 8);
}
