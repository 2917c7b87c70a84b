//! Repeated frequencies and veering: many modes at one frequency, and families that nearly cross.

use std::sync::Arc;

use blisk::model::sector::LumpedOptions;
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::harmonic_balance::Damping;

use super::wheels::{
    CHAIN_LOADS, ORDER, SECTORS, amplitude, chain, one_dimensional, solved, spatial, tight, uneven,
};
use crate::contact::random::Random;
use crate::limits::turned;
use crate::sector_sources::lumped::one_dof;
use crate::wheels::{Wheel, full, relative};

/// Blades that are not coupled: every nodal diameter has one frequency, and blade n, on its own,
/// reaches `F / (eta k (1 + delta_n))`.
#[test]
fn uncoupled_blades_answer_each_on_its_own() {
    for (sectors, coupling) in [(5, 0.0), (24, 0.0), (5, 1e-6), (24, 1e-6)] {
        let options = LumpedOptions {
            blade_coupling_stiffness_n_per_m: coupling,
            ..one_dof(sectors)
        };
        let wheel = Wheel {
            damping: Damping::StructuralLossFactor(0.002),
            amplitude_n: 1.0,
            ..one_dimensional(&options)
        };
        let solver = wheel.solver(&[1], tight());
        for size in [0.0, 1e-3, 0.05, 0.3] {
            let deviations = uneven(sectors, size);
            let softest = deviations.iter().copied().fold(f64::INFINITY, f64::min);
            for order in [0, 1, sectors as u32 / 2] {
                let row = solved(&solver, order, &deviations, ContactCondition::Free).1;
                let factor = row.amplification_factor.unwrap();
                let error = relative(factor, 1.0 / (1.0 + softest));
                assert!(
                    error < 1e-8,
                    "{sectors}, {coupling}, {size}, EO {order}: {error:e}"
                );
            }
        }
    }
}

/// A disk tuned to the blades: the families meet, and each nodal diameter splits them by little.
fn veering() -> LumpedOptions {
    let own = chain();
    // Disk alone at the blade's own frequency at one nodal diameter: k_b/m_b = (k_g + k_b + ...)/m_d.
    let blade = own.blade_stiffness_n_per_m / own.blade_mass_kg;
    LumpedOptions {
        disk_mass_kg: 100.0,
        disk_ground_stiffness_n_per_m: 100.0 * blade,
        disk_coupling_stiffness_n_per_m: 1e4,
        ..own
    }
}

/// The same wheel in modes turned by random angles gives the same factor: to 1e-10 in the linear limits,
/// to 1e-9 under friction.
#[test]
fn the_orientation_of_repeated_modes_does_not_matter() {
    let mut random = Random(73);
    let stiff_disk = LumpedOptions {
        disk_coupling_stiffness_n_per_m: 0.0,
        ring_coupling_stiffness_n_per_m: 0.0,
        ..chain()
    };
    let wheels = [chain(), veering(), stiff_disk].map(|options| one_dimensional(&options));
    for wheel in wheels.into_iter().chain([spatial()]) {
        let settings = SolverOptions {
            peak_tolerance: 1e-10,
            residual_tolerance: 1e-12,
            ..SolverOptions::default()
        };
        let one = wheel.solver(&[1], settings.clone());
        let loads: Vec<f64> = if wheel.model.name == "spatial" {
            vec![200.0, 500.0]
        } else {
            CHAIN_LOADS.to_vec()
        };
        for _ in 0..3 {
            let other = Wheel {
                model: Arc::new(turned(&wheel.model, &mut random)),
                ..wheel.clone()
            };
            let other = other.solver(&[1], settings.clone());
            let deviations = uneven(SECTORS, random.uniform(0.001, 0.1));
            let limits = [
                ContactCondition::Free,
                ContactCondition::Slide,
                ContactCondition::Stuck,
            ];
            let loads = loads.iter().map(|&load| (full(load), 1e-9));
            for (contact, bound) in limits.map(|limit| (limit, 1e-10)).into_iter().chain(loads) {
                let factor = |solver| {
                    let row = solved(solver, ORDER, &deviations, contact).1;
                    (amplitude(&row), row.amplification_factor.unwrap())
                };
                let ((a, b), (c, d)) = (factor(&one), factor(&other));
                let error = relative(c, a).max(relative(d, b));
                assert!(
                    error < bound,
                    "{}, {contact:?}: {error:e}",
                    wheel.model.name
                );
            }
        }
    }
}

/// Veering curves through the tuned crossing: factor and amplitude change continuously as the disk's
/// frequency is moved through that of the blades.
#[test]
fn results_pass_continuously_through_a_veering() {
    for contact in [ContactCondition::Stuck, full(20.0)] {
        let mut last: Option<f64> = None;
        for step in -10..=10 {
            let own = veering();
            let options = LumpedOptions {
                disk_ground_stiffness_n_per_m: own.disk_ground_stiffness_n_per_m
                    * (1.0 + 1e-4 * f64::from(step)),
                ..own
            };
            let solver = one_dimensional(&options).solver(&[1], tight());
            let row = solved(&solver, ORDER, &uneven(SECTORS, 0.02), contact).1;
            let found = amplitude(&row);
            if let Some(last) = last {
                assert!(
                    relative(found, last) < 0.02,
                    "{contact:?}, step {step}: {found} {last}"
                );
            }
            last = Some(found);
        }
    }
}
