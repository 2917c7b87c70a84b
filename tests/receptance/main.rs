//! The engine on tuned receptances against the full-contact model: two codes, one equation.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and what is measured is shown by `--nocapture`"
)]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::bundle;
use blisk::response::forced_response::{AmplitudeMeasure, ContactCondition, FrequencyBand};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{
    ContactInterface, Damping, HarmonicTransform, WheelContact,
};
use blisk::response::mistuning::{ContactFactors, Deviations, Pattern, Projection};
use blisk::response::receptance::{
    EngineModel, EngineOptions, EngineWheel, Limit, ReceptanceEngine, WaveForce, WheelSolver,
    embedded,
};
use blisk::response::reference::{ReferenceSettings, ReferenceSolver};

const ENGINE_ORDER: u32 = 3;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// A reference wheel: model, contact and pattern of a standard deviation.
struct Case {
    model: ReducedModel,
    contact: PairParameters,
    damping: Damping,
    pattern: Pattern,
}

/// Deviations of mean 0 and the standard deviation 1 without any law.
fn deviations(count: usize, scale: f64) -> Vec<f64> {
    let value = |n: usize| (1.0 + 2.7 * n as f64 + 0.37 * (n * n) as f64).sin() * 1.41;
    (0..count).map(|n| scale * value(n)).collect()
}

impl Case {
    fn new(name: &str, [kn, kt]: [f64; 2], scale: f64, damping: Damping) -> Self {
        let sector = bundle::read(&data(name)).unwrap();
        let springs = ContactStiffness {
            normal_n_per_m: kn,
            tangential_1_n_per_m: kt,
            tangential_2_n_per_m: kt,
        };
        let reduction = Reduction::new(&sector, springs, 25, 0).unwrap();
        let model = reduction.reduce(BasisChoice::CraigBampton, None).unwrap();
        Self {
            pattern: Pattern {
                id: 1,
                deviations: Deviations::PerBlade(deviations(model.sectors, scale)),
                contact: ContactFactors::default(),
            },
            model,
            contact: PairParameters {
                normal_load_n: 0.0,
                normal_stiffness_n_per_m: kn,
                tangential_stiffness_n_per_m: kt,
                friction_coefficient: 0.3,
            },
            damping,
        }
    }

    fn wheel8(scale: f64) -> Self {
        Self::new("wheel8", [8e8, 4e8], scale, Damping::StructuralLossFactor(0.002))
    }

    fn wheel24(scale: f64) -> Self {
        Self::new("wheel24", [2e8, 1e8], scale, Damping::StructuralLossFactor(0.002))
    }

    fn engine(&self, more_shapes: usize) -> (ReceptanceEngine, WaveForce) {
        let force = WaveForce::new(&self.model, ENGINE_ORDER, 1.0);
        let options = EngineOptions {
            damping: self.damping,
            projection: Projection::Exact,
            forces: vec![force.clone()],
            deviation: 0.1,
            band: FrequencyBand::Auto,
            more_shapes,
        };
        let own = EngineModel::new(&self.model, &options).unwrap();
        (ReceptanceEngine::new(&own, &options).unwrap(), force)
    }

    fn transform(harmonics: &[u32]) -> Arc<HarmonicTransform> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        Arc::new(HarmonicTransform::new(&set, 128).unwrap())
    }

    fn wheel_contact(&self, harmonics: &[u32], load_n: f64) -> WheelContact {
        let geometry = self.model.contact.clone();
        let factors = &self.pattern.contact;
        let interface = ContactInterface {
            law: ContactLaw::Simplified3d,
            pairs: self.contact.pairs_under(load_n, &geometry, factors),
            geometry,
        };
        let springs = &self.model.springs.stick;
        WheelContact::new(interface, self.model.sectors, springs, Self::transform(harmonics))
    }

    fn reference(&self, harmonics: &[u32], contact: ContactCondition) -> ReferenceSolver {
        let settings = ReferenceSettings {
            transform: Self::transform(harmonics),
            residual_tolerance: 1e-10,
            peak_tolerance: ReferenceSettings::PEAK_TOLERANCE,
            contact: Some((ContactLaw::Simplified3d, self.contact)),
            damping: self.damping,
            amplitude_n: 1.0,
            amplitude: AmplitudeMeasure::Fundamental,
            time_samples: 256,
            projection: Projection::Exact,
        };
        let pattern = Some(&self.pattern);
        ReferenceSolver::new(&self.model, &settings, ENGINE_ORDER, contact, pattern).unwrap()
    }

    /// Largest difference of a blade relative to the largest blade, and the iterations it took, over frequencies.
    fn difference(
        &self,
        more_shapes: usize,
        contact: ContactCondition,
        harmonics: &[u32],
        frequencies_hz: &[f64],
    ) -> f64 {
        let (engine, force) = self.engine(more_shapes);
        let wheel = EngineWheel::new(Some(&self.pattern), self.model.sectors);
        let own = contact.normal_load_n().map(|n| self.wheel_contact(harmonics, n));
        let limit = Limit::of(contact);
        let mut solver = WheelSolver::new(&engine, &wheel, limit, &force, harmonics, own);
        let mut reference = self.reference(harmonics, contact);
        let mut worst = 0.0_f64;
        for &hz in frequencies_hz {
            let began = Instant::now();
            let (solved, work) = solver.solve(hz, &[], 1e-8);
            let took = began.elapsed();
            solved.as_ref().unwrap();
            let at = solver.harmonics().iter().position(|&k| k == 1).unwrap();
            let observed = solver.observed(at);
            let amplitudes: Vec<f64> = observed
                .chunks(3)
                .map(|u| u.iter().map(|u| u.norm_sqr()).sum::<f64>().sqrt())
                .collect();
            let began = Instant::now();
            let point = reference.solve(hz).unwrap();
            let reference_took = began.elapsed();
            let largest = point.amplitudes_m.iter().copied().fold(0.0, f64::max);
            let error = amplitudes
                .iter()
                .zip(&point.amplitudes_m)
                .map(|(a, b)| (a - b).abs() / largest)
                .fold(0.0, f64::max);
            println!(
                "{harmonics:?} {contact:?} {hz} Hz: {error:.2e}, slip {:.2} open {:.2}, {work:?}, {took:?}, reference {reference_took:?}",
                point.shares.slipping, point.shares.separated
            );
            worst = worst.max(error);
        }
        println!("tables {:.1e}", engine.table_error());
        worst
    }
}

fn load(normal_load_n: f64) -> ContactCondition {
    ContactCondition::Full { normal_load_n }
}

#[test]
fn wheel8_is_that_of_the_full_contact_model() {
    let case = Case::wheel8(0.03);
    for (contact, harmonics) in [
        (ContactCondition::Stuck, &[1][..]),
        (ContactCondition::Slide, &[1]),
        (ContactCondition::Free, &[1]),
        (load(800.0), &[1]),
        (load(800.0), &[1, 3, 5]),
        (load(200.0), &[0, 1, 2, 3]),
    ] {
        let error = case.difference(1, contact, harmonics, &[605.0, 612.0, 618.0]);
        assert!(error < 2e-4, "{contact:?} {harmonics:?}: {error}");
    }
}

#[test]
fn wheel24_is_that_of_the_full_contact_model() {
    let case = Case::wheel24(0.03);
    for (contact, harmonics) in [
        (ContactCondition::Stuck, &[1][..]),
        (load(400.0), &[1]),
        (load(160.0), &[1, 3]),
    ] {
        let error = case.difference(1, contact, harmonics, &[616.0, 625.0]);
        assert!(error < 5e-4, "{contact:?} {harmonics:?}: {error}");
    }
}

#[test]
fn a_solution_with_fewer_harmonics_is_a_start() {
    let motions = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(embedded(&motions, &[1, 3], &[0, 1, 3]), [0.0, 0.0, 1.0, 2.0, 3.0, 4.0]);
}
