//! What the excitation puts into a mistuned wheel in a period is what its structure and its contacts take out, for every built-in damper.

use std::f64::consts::{PI, TAU};

use blisk::linalg::Complex64;
use blisk::model::sector::{Component, SectorModel};
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::ContactLaw;

use super::built_in::{KINDS, LOSS_FACTOR, SECTORS};
use crate::extremes::wheels::uneven;
use crate::harmonic_balance::{SAMPLES, Solved, amplitudes, converge, march};
use crate::wheels::{ENGINE_ORDER, Wheel, full, pattern, solve_row};

const HARMONICS: [u32; 4] = [0, 1, 2, 3];

/// Loads of each of [`KINDS`], N for 1 N of excitation: under the first many pairs open, under the second the contact slips
/// and takes most or much of the work.
const LOADS_N: [[f64; 2]; 5] = [
    [10.0, 20.0],
    [10.0, 160.0],
    [10.0, 160.0],
    [20.0, 40.0],
    [10.0, 160.0],
];

/// Work of the excitation in a period: of its forces on the motions of the tips.
fn work_put_in(wheel: &Wheel, sector: &SectorModel, solved: &Solved) -> f64 {
    let system = &solved.system;
    let at = system.fundamental();
    let rows = system.blocks()[at].structure.observed();
    let x = amplitudes(system, at, &solved.x);
    let moved = |row: usize| -> Complex64 {
        let of = |(mode, x): (usize, &Complex64)| {
            let imaginary = rows
                .imaginary
                .as_ref()
                .map_or(0.0, |part| part[(row, mode)]);
            Complex64::new(rows.real[(row, mode)], imaginary) * x
        };
        x.iter().enumerate().map(of).sum()
    };
    let mut work = 0.0;
    for blade in 0..SECTORS {
        let turn = TAU * f64::from(ENGINE_ORDER) * blade as f64 / SECTORS as f64;
        for &(dof, newton) in &sector.force {
            assert_eq!(sector.dofs[dof].node, sector.observed[0].node);
            let component = Component::DISPLACEMENTS
                .iter()
                .position(|&own| own == sector.dofs[dof].component)
                .unwrap();
            let force = wheel.amplitude_n * newton * Complex64::cis(turn);
            work += PI * (force * moved(3 * blade + component).conj()).im;
        }
    }
    work
}

/// Work that the loss factor takes in a period: `2 pi eta` of the largest strain energy of each harmonic, k times for harmonic k.
fn taken_by_structure(solved: &Solved) -> f64 {
    let of = |(index, k): (usize, u32)| {
        let x = amplitudes(&solved.system, index, &solved.x);
        let eigenvalues = solved.system.blocks()[index].structure.eigenvalues();
        let modes = eigenvalues.iter().zip(&x);
        let strain: f64 = modes.map(|(own, x)| 0.5 * own * x.norm_sqr()).sum();
        f64::from(k) * TAU * LOSS_FACTOR * strain
    };
    let blocks = solved.system.blocks().iter().enumerate();
    let moving = blocks.filter(|(_, block)| block.harmonic > 0);
    moving
        .map(|(index, block)| of((index, block.harmonic)))
        .sum()
}

/// Work that the contact takes in a period by forces marched in time, and how many pairs of the wheel open.
fn taken_by_contact(wheel: &Wheel, solved: &Solved, load_n: f64) -> (f64, usize) {
    let rows = march(wheel, solved);
    let forces = rows
        .iter()
        .flat_map(|row| row.force.iter().zip(&row.velocity));
    let work = forces.map(|(force, velocity)| force * velocity * TAU / SAMPLES as f64);
    let geometry = &wheel.model.contact;
    let mut opening = 0;
    for sector in rows.chunks(geometry.row_count()) {
        for (places, weight) in geometry.rows.iter().zip(&geometry.weights) {
            // The force on a normal row is the change of the load, which is all of it where the pair opens.
            let change = &sector[places[0].unwrap()].force;
            opening += usize::from(change.iter().any(|force| *force <= -weight * load_n));
        }
    }
    (work.sum(), opening)
}

#[test]
fn the_work_of_the_excitation_is_dissipated_by_structure_and_contact() {
    let deviations = uneven(SECTORS, 0.03);
    for (kind, loads_n) in KINDS.iter().zip(LOADS_N) {
        let (wheel, sector) = (kind.wheel(ContactLaw::Simplified3d), kind.sector());
        let excited = wheel.mistuned(&deviations, &HARMONICS);
        let solver = wheel.solver(&[1], SolverOptions::default());
        for (place, load_n) in loads_n.into_iter().enumerate() {
            // Near a resonance: at the peak of harmonic 1.
            let (_, row) = solve_row(&solver, &pattern(&deviations), full(load_n));
            let solved = converge(&wheel, &excited, load_n, row.peak_frequency_hz.unwrap());
            let input = work_put_in(&wheel, &sector, &solved);
            let structure = taken_by_structure(&solved);
            let (contact, opening) = taken_by_contact(&wheel, &solved, load_n);
            let (share, error) = (contact / input, ((structure + contact) / input - 1.0).abs());
            let name = format!("{} {load_n} N", kind.name);
            println!(
                "{name}: contact takes {share:.3}, {opening} pairs open, imbalance {error:.1e}"
            );
            assert!(error < 1e-10, "{name}: {error:e}");
            assert!(share > 0.05, "{name}: friction takes {share}");
            assert!(
                place > 0 || opening >= 2 * SECTORS,
                "{name}: {opening} pairs open"
            );
        }
    }
}
