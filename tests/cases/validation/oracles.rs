//! Exact solutions and reference numbers, recomputed: contact laws, oscillators, chains of blades, symmetries.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix};
use blisk::model::cyclic::ContactGeometry;
use blisk::model::reduction::Basis;
use blisk::population::monte_carlo::ResponseRow;
use blisk::population::statistics::SampleStatistics;
use blisk::response::forced_response::ContactCondition;
use blisk::response::friction::{
    ContactHistory, ContactLaw, PairDisplacement, PairParameters, PeriodicSlider,
};
use blisk::response::harmonic_balance::{
    ContactInterface, Damping, HarmonicBlock, HarmonicSystem, HarmonicTransform, NewtonBounds,
    NewtonWorkspace, Status, Structure, solve,
};
use blisk::response::mistuning::{ContactFactors, Deviations, ModalRows, Pattern, StructuralModes};
use rayon::prelude::*;

use super::super::one_dof::{EXPECTED, case, given_pattern, share_of_the_bound};
use super::super::support::Case;
use super::models::reference_wheel;
use super::named_tests::assert_is_a_test;
use super::report::{Section, Verdict, table};

/// A number of this program beside the exact one.
struct Oracle {
    /// Name of its verdict.
    id: String,
    what: String,
    ours: f64,
    reference: f64,
    /// Largest relative difference accepted.
    bar: f64,
    /// The test that holds it in every run of the tests.
    test: &'static str,
}

impl Oracle {
    fn new(
        id: impl Into<String>,
        what: impl Into<String>,
        ours: f64,
        reference: f64,
        bar: f64,
        test: &'static str,
    ) -> Self {
        Self {
            id: id.into(),
            what: what.into(),
            ours,
            reference,
            bar,
            test,
        }
    }

    fn difference(&self) -> f64 {
        (self.ours / self.reference - 1.0).abs()
    }

    fn verdict(&self) -> Verdict {
        Verdict::at_most(&self.id, &self.what, [self.difference()], self.bar)
    }

    fn cells(&self) -> Vec<String> {
        assert_is_a_test(self.test);
        vec![
            self.what.clone(),
            format!("{:.9e}", self.ours),
            format!("{:.9e}", self.reference),
            format!("{:.1e}", self.difference()),
            format!("{:.0e}", self.bar),
            format!("`{}`", self.test),
        ]
    }
}

pub fn section() -> Section {
    let mut oracles = sliders();
    oracles.extend(oscillators());
    oracles.extend(chain_of_blades());
    oracles.extend(symmetries());
    let statistics = statistics();
    let cells: Vec<Vec<String>> = oracles.iter().map(Oracle::cells).collect();
    let header = [
        "oracle",
        "ours",
        "reference",
        "relative difference",
        "bar",
        "test",
    ];
    let statistics_header = [
        "standard deviation",
        "mean, standard errors",
        "P50",
        "P95",
        "P99",
        "P5",
        "largest share of Whitehead's bound",
    ];
    let statistics_cells: Vec<Vec<String>> = statistics
        .iter()
        .map(|(deviation, distances, share)| {
            let mut cells = vec![format!("{} %", 100.0 * deviation)];
            cells.extend(distances.iter().map(|distance| format!("{distance:.2}")));
            cells.push(format!("{share:.3}"));
            cells
        })
        .collect();
    Section {
        compared: format!(
            "Closed forms, limits and symmetries, each with the test that holds it. Below, amplification factors of the chain of 24 blades of \
             studies/one-dof.toml, {PATTERNS} patterns for each standard deviation, against 20,000 other patterns by another program (distance in standard \
             errors of the difference), and the largest share of Whitehead's bound that a blade reaches."
        ),
        body: table(&header, &cells) + "\n" + &table(&statistics_header, &statistics_cells),
        verdicts: oracles
            .iter()
            .map(Oracle::verdict)
            .chain([
                Verdict::share(
                    "statistics",
                    "statistics within four standard errors",
                    statistics.iter().flat_map(|(_, distances, _)| {
                        distances.iter().map(|distance| *distance <= 4.0)
                    }),
                    1.0,
                ),
                Verdict::share(
                    "whiteheads-bound",
                    "populations within Whitehead's bound",
                    statistics.iter().map(|(_, _, share)| *share <= 1.0),
                    1.0,
                ),
            ])
            .collect(),
    }
}

const SAMPLES: usize = 1 << 18;
const LOOP_TEST: &str = "constant_load_matches_the_table_and_its_closed_forms";
const VARIABLE_TEST: &str = "variable_load_matches_the_table_with_separation";

fn cosine(amplitude: f64, n_samples: usize) -> Vec<f64> {
    let angle = |j: usize| TAU * j as f64 / n_samples as f64;
    (0..n_samples).map(|j| amplitude * angle(j).cos()).collect()
}

/// Coefficients of `cos` and `sin` of the fundamental.
fn fundamental(force: &[f64]) -> (f64, f64) {
    let n = force.len() as f64;
    let (mut a, mut b) = (0.0, 0.0);
    for (j, f) in force.iter().enumerate() {
        let (sin, cos) = (TAU * j as f64 / n).sin_cos();
        a += f * cos;
        b += f * sin;
    }
    (2.0 * a / n, 2.0 * b / n)
}

/// Fundamental of `kt x + y` for x = A cos, constant limit.
fn constant_load(kt: f64, limit: f64, amplitude: f64) -> (f64, f64) {
    let x = cosine(amplitude, SAMPLES);
    let mut slider = PeriodicSlider::new(x.len());
    slider.solve(kt, 1.0, &x, &vec![limit; x.len()]);
    let force: Vec<f64> = x
        .iter()
        .zip(slider.offset_n())
        .map(|(x, y)| kt * x + y)
        .collect();
    fundamental(&force)
}

/// The same under `N = max(0, 6 + g x)`, mu = 0.5, kt = 2.
fn variable_load(g: f64, amplitude: f64) -> (f64, f64) {
    let x = cosine(amplitude, SAMPLES);
    let parameters = PairParameters {
        normal_load_n: 6.0,
        normal_stiffness_n_per_m: g,
        tangential_stiffness_n_per_m: 2.0,
        friction_coefficient: 0.5,
    };
    let rest = vec![0.0; x.len()];
    let displacement = PairDisplacement {
        normal: &x,
        tangential: [&x, &rest],
    };
    let mut history = ContactHistory::new(x.len());
    history.respond(ContactLaw::Simplified3d, &parameters, displacement);
    let offsets = history.sliders()[0].offset_n();
    let force: Vec<f64> = x.iter().zip(offsets).map(|(x, y)| 2.0 * x + y).collect();
    fundamental(&force)
}

/// One Jenkins element in steady motion `x = A cos`.
fn sliders() -> Vec<Oracle> {
    let (kt, limit, amplitude) = (2.0, 3.0, 5.0);
    let (a, b) = constant_load(kt, limit, amplitude);
    let theta = (1.0_f64 - 2.0 * limit / (kt * amplitude)).acos();
    let stiffness = kt / PI * (theta - 0.5 * (2.0 * theta).sin());
    let energy = 4.0 * limit * (amplitude - limit / kt);
    let (_, most) = constant_load(kt, limit, 2.0 * limit / kt);
    let (rigid_a, rigid_b) = constant_load(1e6, limit, amplitude);
    let mut oracles = vec![
        Oracle::new(
            "jenkins-stiffness",
            "Jenkins element, A = 5, kt = 2, limit 3: equivalent stiffness",
            a / amplitude,
            stiffness,
            1e-8,
            LOOP_TEST,
        ),
        Oracle::new(
            "jenkins-energy",
            "the same Jenkins element: energy per cycle",
            -PI * amplitude * b,
            energy,
            1e-8,
            LOOP_TEST,
        ),
        Oracle::new(
            "jenkins-largest-loss",
            "largest loss, at twice the slip amplitude: kt / pi",
            -most / (2.0 * limit / kt),
            kt / PI,
            1e-8,
            "largest_loss_is_at_twice_the_slip_amplitude",
        ),
        Oracle::new(
            "rigid-slider",
            "rigid slider: fundamental 4 limit / pi",
            rigid_a.hypot(rigid_b),
            4.0 * limit / PI,
            1e-4,
            "rigid_slider_has_the_square_wave_harmonic",
        ),
    ];
    for g in [0.4, 1.0, 2.0, 3.0] {
        let (limit, k) = (3.0, 0.5 * g);
        let closing = 2.0 * (limit + k * amplitude).powi(2) / (kt + k);
        let separates = g * amplitude > 6.0;
        let exact = if separates {
            k * (amplitude + 6.0 / g).powi(2) - closing
        } else {
            4.0 * limit * amplitude - closing - 2.0 * (limit - k * amplitude).powi(2) / (kt - k)
        };
        let (_, b) = variable_load(g, amplitude);
        oracles.push(Oracle::new(
            format!("variable-load-{g}"),
            format!(
                "normal load 6 + {g} x{}: energy per cycle",
                if separates { ", separating" } else { "" }
            ),
            -PI * amplitude * b,
            exact,
            1e-7,
            VARIABLE_TEST,
        ));
    }
    oracles
}

/// A mass of 1 kg on a spring of 1 N/m with a Jenkins element to the ground.
fn oscillator(
    harmonics: &[usize],
    samples: usize,
    force: f64,
    kt: f64,
    limit: f64,
) -> HarmonicSystem {
    let rows = |count| ModalRows {
        real: Matrix::from_fn(count, 1, |_, _| 1.0),
        imaginary: None,
    };
    let modes = StructuralModes {
        eigenvalues: vec![1.0],
        tuned_eigenvalues: vec![1.0],
        added_damping_per_s: vec![0.0],
        rotation: None,
        contact: rows(1),
        observed: rows(3),
        sectors: 1,
    };
    let structure = Arc::new(Structure::new(modes, Damping::ModalRatio(0.0)));
    let stuck = Arc::new(structure.contact_stiffness(&[kt]));
    let blocks = harmonics
        .iter()
        .map(|&harmonic| HarmonicBlock {
            harmonic: harmonic as u32,
            structure: Arc::clone(&structure),
            stuck: Arc::clone(&stuck),
        })
        .collect();
    let interface = ContactInterface {
        law: ContactLaw::MacroSlip1d,
        geometry: ContactGeometry {
            weights: vec![1.0],
            load_weights: vec![1.0],
            rows: vec![[None, Some(0), None]],
            ring_motion: vec![[[1.0, 0.0], [0.0, 1.0]]],
            ring_free: [false; 2],
        },
        pairs: vec![PairParameters {
            normal_load_n: limit,
            normal_stiffness_n_per_m: 0.0,
            tangential_stiffness_n_per_m: kt,
            friction_coefficient: 1.0,
        }],
    };
    let transform = Arc::new(HarmonicTransform::new(harmonics, samples).unwrap());
    HarmonicSystem::new(
        blocks,
        vec![Complex64::new(force, 0.0)],
        interface,
        transform,
    )
}

fn converge(system: &HarmonicSystem, omega: f64, x: &mut Vec<f64>) {
    let mut workspace = NewtonWorkspace::new(system);
    let bounds = NewtonBounds::with_tolerance(1e-9);
    let outcome = solve(system, omega, x, bounds, None, &mut workspace);
    assert_eq!(outcome.status, Status::Ok, "omega {omega}: {outcome:?}");
}

/// Den Hartog's oscillator and the resonance that friction alone bounds.
fn oscillators() -> Vec<Oracle> {
    let harmonics: Vec<usize> = (0..16).map(|i| 2 * i + 1).collect();
    let mut oracles = Vec::new();
    for (b, friction) in [(0.7, 0.3), (1.3, 0.3), (1.6, 0.2)] {
        let v = 1.0 / (1.0 - b * b);
        let g = (PI / b).sin() / (b * (1.0 + (PI / b).cos()));
        let exact = f64::sqrt(v * v - (friction * g).powi(2));
        let transform = HarmonicTransform::new(&harmonics, 2048).unwrap();
        let mut x = vec![0.0; 2 * harmonics.len()];
        let mut largest = Vec::new();
        for power in 0..=6 {
            let kt = 2.0_f64.powi(power);
            converge(&oscillator(&harmonics, 2048, 1.0, kt, friction), b, &mut x);
            let mut samples = vec![0.0; 2048];
            transform.synthesize_by_sums(&x, &mut samples);
            largest.push(samples.into_iter().fold(0.0, f64::max));
        }
        // The spring delays every reversal by a time of order kt^(-1/2): extrapolated in that.
        let [coarse, middle, fine] = [largest[2], largest[4], largest[6]];
        let limit = (4.0 * (2.0 * fine - middle) - (2.0 * middle - coarse)) / 3.0;
        oracles.push(Oracle::new(
            format!("den-hartog-{b}"),
            format!("Den Hartog, frequency ratio {b}, friction {friction}: largest displacement"),
            limit,
            exact,
            2e-3,
            "stiff_spring_and_many_harmonics_tend_to_den_hartog",
        ));
    }
    let (kt, limit) = (0.8, 1.0);
    for share in [0.3, 0.85] {
        let force = share * 4.0 * limit / PI;
        let highest = limit / kt / (1.0 - share);
        let theta = (1.0 - 2.0 * limit / (kt * highest)).acos();
        let omega = f64::sqrt(1.0 + kt / PI * (theta - 0.5 * (2.0 * theta).sin()));
        let mut x = vec![0.0, -highest];
        converge(&oscillator(&[1], 1 << 14, force, kt, limit), omega, &mut x);
        oracles.push(Oracle::new(
            format!("undamped-resonance-{share}"),
            format!("undamped resonance with F = {share} of 4 mu N / pi: amplitude"),
            x[0].hypot(x[1]),
            highest,
            1e-3,
            "friction_alone_bounds_the_resonance_if_the_force_is_below_4_mu_n_over_pi",
        ));
    }
    oracles
}

const FREE: ContactCondition = ContactCondition::Free;

/// The chain of 24 blades: tuned peak and one pattern.
fn chain_of_blades() -> Vec<Oracle> {
    let case = case();
    let tuned = case.tuned(FREE);
    let row = case.row(&given_pattern(), FREE, &tuned);
    let omega = |hz: Option<f64>| TAU * hz.unwrap();
    let (of_tuned, of_pattern) = (
        "the_tuned_peak_is_exact",
        "a_given_pattern_has_its_known_amplification",
    );
    vec![
        Oracle::new(
            "chain-tuned-peak",
            "chain of 24 blades: tuned peak, m/N",
            tuned.amplitude_m.unwrap(),
            1.095_050_174_838e-4,
            1e-9,
            of_tuned,
        ),
        Oracle::new(
            "chain-tuned-frequency",
            "chain of 24 blades: frequency of the tuned peak, rad/s",
            omega(tuned.frequency_hz),
            6_328.166_991,
            1e-7,
            of_tuned,
        ),
        Oracle::new(
            "chain-amplification-factor",
            "chain of 24 blades, a given pattern: amplification factor",
            row.amplification_factor.unwrap(),
            1.371_081_258,
            1e-8,
            of_pattern,
        ),
        Oracle::new(
            "chain-largest-amplitude",
            "chain of 24 blades, a given pattern: largest amplitude, m/N",
            row.peak_amplitude_m.unwrap(),
            1.501_402_771e-4,
            1e-8,
            of_pattern,
        ),
        Oracle::new(
            "chain-frequency",
            "chain of 24 blades, a given pattern: its frequency, rad/s",
            omega(row.peak_frequency_hz),
            6_296.495,
            5e-7,
            of_pattern,
        ),
    ]
}

fn peak(case: &Case, pattern: &Pattern, contact: ContactCondition) -> f64 {
    let tuned = case.tuned(contact);
    case.row(pattern, contact, &tuned).peak_amplitude_m.unwrap()
}

fn full(normal_load_n: f64) -> ContactCondition {
    ContactCondition::Full { normal_load_n }
}

/// Scaling, limits and symmetries of wheel8 under friction.
fn symmetries() -> Vec<Oracle> {
    let study = |amplitude_n: f64, friction: f64| {
        let mut study = reference_wheel("wheel8", &[400.0], Some(&[1, 3]));
        study.reduction.basis = Basis::StickSlide;
        study.reduction.stick_modes = Some(4);
        study.reduction.slide_modes = Some(4);
        study.solver.peak_tolerance = 1e-7;
        study.solver.residual_tolerance = 1e-11;
        study.amplitude_n = amplitude_n;
        study.contact.as_mut().unwrap().friction_coefficient = friction;
        Case::new(study)
    };
    let case = study(1.0, 0.3);
    let pattern = case.pattern(1, None);
    let Deviations::PerBlade(blades) = &pattern.deviations else {
        panic!("deviations per blade are compared");
    };
    let of_blades = |blades: Vec<f64>| Pattern {
        id: 1,
        deviations: Deviations::PerBlade(blades),
        contact: ContactFactors::default(),
    };
    let mut turned = blades.clone();
    turned.rotate_right(3);
    let none = of_blades(vec![0.0; blades.len()]);
    let own = peak(&case, &pattern, full(400.0));
    vec![
        Oracle::new(
            "wheel8-scaled",
            "wheel8, 400 N: force and load 1.7 times, amplitude over 1.7",
            peak(&study(1.7, 0.3), &pattern, full(680.0)) / 1.7,
            own,
            1e-6,
            "force_and_normal_load_scale_the_response_together",
        ),
        Oracle::new(
            "wheel8-turned",
            "wheel8, 400 N: pattern turned by three blades",
            peak(&case, &of_blades(turned), full(400.0)),
            own,
            1e-6,
            "turning_the_pattern_turns_the_response",
        ),
        Oracle::new(
            "wheel8-no-deviations",
            "wheel8, 400 N: whole wheel without deviations, one sector",
            peak(&case, &none, full(400.0)),
            case.tuned(full(400.0)).amplitude_m.unwrap(),
            1e-6,
            "a_wheel_without_deviations_is_the_tuned_sector",
        ),
        Oracle::new(
            "wheel8-stuck-limit",
            "wheel8: load of 1e9 N, linear stuck limit",
            peak(&case, &pattern, full(1e9)),
            peak(&case, &pattern, ContactCondition::Stuck),
            1e-6,
            "under_high_normal_load_the_contact_is_stuck",
        ),
        Oracle::new(
            "wheel8-slide-limit",
            "wheel8: friction coefficient 1e-10 at 1e6 N, linear slide limit",
            peak(&study(1.0, 1e-10), &pattern, full(1e6)),
            peak(&case, &pattern, ContactCondition::Slide),
            1e-3,
            "as_friction_vanishes_the_contact_slides",
        ),
    ]
}

const PATTERNS: u32 = 5000;

/// Standard deviation, distances in standard errors, largest share of Whitehead's bound.
fn statistics() -> Vec<(f64, Vec<f64>, f64)> {
    let case = case();
    let tuned = case.tuned(FREE);
    let wanted = [0.01, 0.03, 0.1];
    EXPECTED
        .iter()
        .filter(|expected| wanted.contains(&expected.standard_deviation))
        .map(|expected| {
            let deviation = expected.standard_deviation;
            let rows: Vec<ResponseRow> = (0..PATTERNS)
                .into_par_iter()
                .map(|id| case.row(&case.pattern(id, Some(deviation)), FREE, &tuned))
                .collect();
            let factors = rows.iter().map(|row| row.amplification_factor.unwrap());
            let found = SampleStatistics::new(factors.collect(), 0);
            let share = rows.iter().map(share_of_the_bound).fold(0.0, f64::max);
            (deviation, expected.distances(&found, PATTERNS), share)
        })
        .collect()
}
