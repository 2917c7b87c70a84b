//! The engine on tuned receptances against the full-contact model: two codes, one equation.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and what is measured is shown by `--nocapture`"
)]

mod automatic_harmonics;
mod tops;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use blisk::linalg::Complex64;
use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::bundle;
use blisk::response::forced_response::{AmplitudeMeasure, ContactCondition};
use blisk::response::friction::{ContactLaw, PairParameters, Ring};
use blisk::response::harmonic_balance::{
    ContactInterface, Damping, HarmonicTransform, WheelContact,
};
use blisk::response::mistuning::{ContactFactors, Deviations, PairFactors, Pattern, Projection};
use blisk::response::receptance::{
    EngineOptions, EngineWheel, Limit, ReceptanceEngine, WaveForce, WheelSolver, embedded,
};
use blisk::verification::reference::{ReferenceSettings, ReferenceSolver};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// A reference wheel with all that its response depends on.
struct Case {
    model: ReducedModel,
    law: ContactLaw,
    contact: PairParameters,
    damping: Damping,
    projection: Projection,
    engine_order: u32,
    pattern: Pattern,
}

/// Numbers of mean 0 and standard deviation 1 without any law.
fn numbers(count: usize) -> Vec<f64> {
    let value = |n: usize| (1.0 + 2.7 * n as f64 + 0.37 * (n * n) as f64).sin() * 1.41;
    (0..count).map(value).collect()
}

fn deviations(count: usize, standard_deviation: f64) -> Vec<f64> {
    let numbers = numbers(count).into_iter();
    numbers.map(|number| standard_deviation * number).collect()
}

impl Case {
    fn new(name: &str, [kn, kt]: [f64; 2], law: ContactLaw, modes: usize) -> Self {
        let sector = bundle::read(&data(name)).unwrap();
        let springs = ContactStiffness {
            normal_n_per_m: if law.has_variable_load() { kn } else { 0.0 },
            tangential_1_n_per_m: kt,
            tangential_2_n_per_m: kt,
        };
        let reduction = Reduction::new(&sector, springs, modes, 0).unwrap();
        let model = reduction
            .reduce(BasisChoice::CraigBampton, Some(3))
            .unwrap();
        Self {
            pattern: Pattern {
                id: 1,
                deviations: Deviations::PerBlade(deviations(model.sectors, 0.03)),
                contact: ContactFactors::default(),
            },
            model,
            law,
            contact: PairParameters {
                normal_load_n: 0.0,
                normal_stiffness_n_per_m: kn,
                tangential_stiffness_n_per_m: kt,
                friction_coefficient: 0.3,
            },
            damping: Damping::StructuralLossFactor(0.002),
            projection: Projection::Exact,
            engine_order: 3,
        }
    }

    fn wheel8() -> Self {
        Self::wheel8_under(ContactLaw::Simplified3d)
    }

    fn wheel8_under(law: ContactLaw) -> Self {
        Self::new("wheel8", [8e8, 4e8], law, 25)
    }

    fn wheel24() -> Self {
        Self::new("wheel24", [2e8, 1e8], ContactLaw::Simplified3d, 25)
    }

    /// Contact that varies from pair to pair.
    fn with_varied_contact(mut self) -> Self {
        let pairs = self.model.sectors * self.model.contact.rows.len();
        let factor = |number: &f64| PairFactors {
            friction_coefficient: 1.0 + 0.2 * number,
            tangential_stiffness: 1.0 - 0.15 * number,
            normal_stiffness: 1.0 + 0.1 * number,
            normal_load: 1.0 + 0.1 * number,
        };
        let factors = numbers(pairs).iter().map(factor).collect();
        self.pattern.contact = ContactFactors::new(factors);
        self
    }

    fn engine(&self) -> (ReceptanceEngine, WaveForce) {
        let force = WaveForce::new(&self.model, self.engine_order, 1.0);
        let options = EngineOptions {
            damping: self.damping,
            projection: self.projection,
            forces: vec![force.clone()],
            deviation: 0.1,
            band_hz: None,
        };
        let (_, engine) = ReceptanceEngine::of_model(self.model.clone(), &options, 1).unwrap();
        (engine, force)
    }

    fn transform(harmonics: &[u32]) -> Arc<HarmonicTransform> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        Arc::new(HarmonicTransform::new(&set, 128).unwrap())
    }

    /// The contact of the wheel; none for a linear limit of nominal contact.
    fn wheel_contact(
        &self,
        harmonics: &[u32],
        condition: ContactCondition,
    ) -> Option<WheelContact> {
        let geometry = self.model.contact.clone();
        let springs = match condition.limit() {
            Limit::Stuck => &self.model.springs.stick,
            Limit::Slide => &self.model.springs.slide,
            Limit::Free => return None,
        };
        let factors = &self.pattern.contact;
        let own = factors.springs(springs, &geometry.rows);
        let load_n = condition.normal_load_n();
        let interface = ContactInterface {
            law: self.law,
            pairs: self
                .contact
                .pairs_under(load_n.unwrap_or(0.0), &geometry, factors),
            geometry,
        };
        let transform = Self::transform(harmonics);
        let contact = WheelContact::new(interface, self.model.sectors, springs, transform);
        match load_n {
            Some(_) => Some(contact),
            None if factors.is_nominal() => None,
            None => Some(contact.linear(&own, springs)),
        }
    }

    fn reference(&self, harmonics: &[u32], contact: ContactCondition) -> ReferenceSolver {
        let settings = ReferenceSettings {
            transform: Self::transform(harmonics),
            residual_tolerance: 1e-10,
            peak_tolerance: ReferenceSettings::PEAK_TOLERANCE,
            contact: Some((self.law, self.contact)),
            ring: Ring::Locked,
            damping: self.damping,
            amplitude_n: 1.0,
            amplitude: AmplitudeMeasure::Fundamental,
            time_samples: 256,
            projection: self.projection,
        };
        let pattern = Some(&self.pattern);
        ReferenceSolver::new(&self.model, &settings, self.engine_order, contact, pattern).unwrap()
    }

    /// Largest difference of a blade relative to the largest blade over frequencies.
    fn difference(
        &self,
        contact: ContactCondition,
        harmonics: &[u32],
        frequencies_hz: &[f64],
    ) -> f64 {
        let (engine, force) = self.engine();
        let wheel = EngineWheel::new(Some(&self.pattern), self.model.sectors);
        let own = self.wheel_contact(harmonics, contact);
        let limit = contact.limit();
        let mut solver = WheelSolver::new(&engine, &wheel, limit, &force, harmonics, own);
        let mut reference = self.reference(harmonics, contact);
        let mut worst = 0.0_f64;
        for &hz in frequencies_hz {
            let (solved, work) = solver.solve(hz, &[], 1e-8);
            solved.as_ref().unwrap();
            let at = solver.harmonics().iter().position(|&k| k == 1).unwrap();
            let observed = solver.observed(at);
            let norm = |u: &[Complex64]| u.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
            let point = reference.solve(hz).unwrap();
            let largest = point.amplitudes_m.iter().copied().fold(0.0, f64::max);
            let blades = observed.chunks(3).zip(&point.amplitudes_m);
            let error = blades
                .map(|(u, own)| (norm(u) - own).abs() / largest)
                .fold(0.0, f64::max);
            println!(
                "{:?} {harmonics:?} {contact:?} {hz} Hz: {error:.2e}, slip {:.2} open {:.2}, {} iterations",
                self.law, point.shares.slipping, point.shares.separated, work.iterations
            );
            worst = worst.max(error);
        }
        let tables = engine.table_error();
        assert!(tables < 1e-6, "tables {tables}");
        worst
    }

    fn assert_same(&self, contact: ContactCondition, harmonics: &[u32], bound: f64) {
        let error = self.difference(contact, harmonics, &[605.0, 612.0, 618.0]);
        assert!(error < bound, "{contact:?} {harmonics:?}: {error}");
    }
}

fn load(normal_load_n: f64) -> ContactCondition {
    ContactCondition::Full { normal_load_n }
}

/// What three blade shapes leave out of a wheel with a standard deviation of 3 %.
const BY_SHAPES: f64 = 2e-4;
/// Where no shape is left out: the solutions' own tolerance.
const EXACT: f64 = 2e-6;

#[test]
fn linear_limits_are_those_of_the_full_contact_model() {
    for case in [Case::wheel8(), Case::wheel8().with_varied_contact()] {
        for limit in [
            ContactCondition::Stuck,
            ContactCondition::Slide,
            ContactCondition::Free,
        ] {
            case.assert_same(limit, &[1], BY_SHAPES);
        }
    }
}

/// With 80 modes a pole of the wheel without springs is met exactly, and divided by.
#[test]
fn the_wheel_without_springs_is_met_with_many_modes() {
    let case = Case::new("wheel8", [8e8, 4e8], ContactLaw::Simplified3d, 80);
    case.assert_same(ContactCondition::Free, &[1], BY_SHAPES);
}

#[test]
fn friction_and_separation_are_those_of_the_full_contact_model() {
    let case = Case::wheel8();
    case.assert_same(load(800.0), &[1], BY_SHAPES);
    case.assert_same(load(800.0), &[1, 3, 5], BY_SHAPES);
    case.assert_same(load(200.0), &[0, 1, 2, 3], BY_SHAPES);
    case.assert_same(load(60.0), &[0, 1, 2, 3], BY_SHAPES);
    case.with_varied_contact()
        .assert_same(load(300.0), &[0, 1, 2, 3], BY_SHAPES);
}

#[test]
fn every_law_is_that_of_the_full_contact_model() {
    for law in [ContactLaw::MacroSlip2d, ContactLaw::Coulomb3d] {
        Case::wheel8_under(law).assert_same(load(400.0), &[1, 3], BY_SHAPES);
    }
}

#[test]
fn every_damping_is_that_of_the_full_contact_model() {
    for damping in [
        Damping::ModalRatio(0.001),
        Damping::Rayleigh {
            mass_per_s: 2.0,
            stiffness_s: 1e-7,
        },
    ] {
        let case = Case {
            damping,
            ..Case::wheel8()
        };
        case.assert_same(load(400.0), &[1, 3], BY_SHAPES);
    }
}

/// Engine orders N/2, of a conjugate wave, and 0.
#[test]
fn every_wave_is_that_of_the_full_contact_model() {
    for engine_order in [4, 6, 8] {
        let case = Case {
            engine_order,
            ..Case::wheel8()
        };
        let (engine, force) = case.engine();
        let peaks = engine.tuned_peaks(Limit::Stuck, &force).into_iter();
        let peak = peaks.max_by(|a, b| a.amplitude_m.total_cmp(&b.amplitude_m));
        let peak_hz = peak.unwrap().frequency_hz;
        let near = [0.99, 0.995, 1.0, 1.01].map(|factor| factor * peak_hz);
        let error = case.difference(load(400.0), &[1, 2, 3], &near);
        assert!(error < BY_SHAPES, "engine order {engine_order}: {error}");
    }
}

/// Deviations of cantilever modes act on these alone, so that nothing is left out.
#[test]
fn cantilever_modes_are_taken_exactly() {
    let mut case = Case {
        projection: Projection::CantileverModes,
        ..Case::wheel8()
    };
    case.assert_same(ContactCondition::Stuck, &[1], EXACT);
    case.pattern.deviations = Deviations::PerMode {
        modes: vec![0, 2],
        values: deviations(2 * case.model.sectors, 0.03),
    };
    case.assert_same(load(400.0), &[1, 3], EXACT);
}

#[test]
fn wheel24_is_that_of_the_full_contact_model() {
    let case = Case::wheel24();
    for (contact, harmonics) in [
        (ContactCondition::Stuck, &[1][..]),
        (load(400.0), &[1]),
        (load(160.0), &[1, 3]),
    ] {
        let error = case.difference(contact, harmonics, &[558.0, 566.0]);
        assert!(error < 5e-4, "{contact:?} {harmonics:?}: {error}");
    }
}

#[test]
fn a_solution_with_fewer_harmonics_is_a_start() {
    let motions = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(
        embedded(&motions, &[1, 3], &[0, 1, 3]),
        [0.0, 0.0, 1.0, 2.0, 3.0, 4.0]
    );
}
