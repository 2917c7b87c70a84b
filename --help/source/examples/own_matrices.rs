//! Mass and stiffness of your own: from the matrices of one sector to the peak of a wheel and a percentile of many.
//!
//!     cargo run --release --example own_matrices

use std::error::Error;
use std::io::Write;

use blisk::sector::{Body, Complex64, Component, Dof, ObservedNode, SymmetricSparse};
use blisk::{
    Damping, Distribution, Engine, Mistuning, Numerics, Pattern, Problem, Quantity, SectorModel,
};

/// Sectors of the wheel.
const SECTORS: usize = 12;
/// Blade mass, kg; spring to ground and spring to the next blade, N/m.
const MASS_KG: f64 = 0.05;
const BLADE_N_PER_M: f64 = 5.0e5;
const COUPLING_N_PER_M: f64 = 4.0e4;

/// One sector with both of its cut faces: dof 0 is the blade, dof 1 the blade of the next sector, on the high face.
///
/// Each matrix is its lower triangle as `(row, column, value)`. The high face has no mass, which would be counted twice.
fn sector() -> SectorModel {
    let matrix = |entries: &[(usize, usize, f64)]| SymmetricSparse::from_lower_triplets(2, entries);
    let dof = |node: usize| {
        let angle = node as f64 * std::f64::consts::TAU / SECTORS as f64;
        Dof {
            node,
            component: Component::Tangential,
            position_m: [angle.cos(), angle.sin(), 0.0],
            body: Body::Blisk,
        }
    };
    SectorModel {
        name: "chain".to_owned(),
        sectors: SECTORS,
        stiffness: matrix(&[
            (0, 0, BLADE_N_PER_M + COUPLING_N_PER_M),
            (1, 0, -COUPLING_N_PER_M),
            (1, 1, COUPLING_N_PER_M),
        ]),
        mass: matrix(&[(0, 0, MASS_KG)]),
        // The share that a blade's deviation changes.
        blade_stiffness: matrix(&[(0, 0, BLADE_N_PER_M)]),
        dofs: vec![dof(0), dof(1)],
        cyclic_pairs: vec![(0, 1)],
        rigid_points: Vec::new(),
        contact_pairs: Vec::new(),
        // 1 N on the blade.
        force: vec![(0, Complex64::new(1.0, 0.0))],
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "blade".to_owned(),
            node: 0,
        }],
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    told(&mut std::io::stdout())
}

/// Writes what is found to `out`.
pub(crate) fn told(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let wheels = Mistuning::Random {
        law: Distribution::Normal,
        standard_deviations: vec![0.03],
        seed: 1,
    };
    let problem = Problem::new(Damping::StructuralLossFactor(0.002), &[2], wheels);
    let engine = Engine::build(&sector(), &problem, &Numerics::default())?;
    let scenario = engine.scenarios()[0];

    let tuned = engine.tuned(&scenario).and_then(|own| own.amplitude_m);
    writeln!(out, "tuned wheel: {:.5e} m", tuned.ok_or("no tuned peak")?)?;

    // A wheel of your own: every third blade 4 % stiffer.
    let stiffer = |blade: usize| if blade.is_multiple_of(3) { 0.04 } else { 0.0 };
    let wheel = Pattern::of_blades(0, (0..SECTORS).map(stiffer).collect());
    let row = engine.peak(&wheel, &scenario);
    let peak = row.peak_amplitude_m.zip(row.peak_frequency_hz);
    let (peak_m, frequency_hz) = peak.ok_or_else(|| row.status.name())?;
    writeln!(out, "own wheel: {peak_m:.5e} m at {frequency_hz:.2} Hz")?;

    let population = engine.population(500, &())?;
    let p95 = population.percentile(&scenario, Quantity::AmplificationFactor, 95.0);
    let bounds = p95.value.zip(p95.lower.zip(p95.upper));
    let (value, (lower, upper)) = bounds.ok_or_else(|| p95.status.name())?;
    writeln!(
        out,
        "95th percentile of the amplification factor: {value:.3}, 95 % interval {lower:.3} to {upper:.3}"
    )?;
    Ok(())
}
