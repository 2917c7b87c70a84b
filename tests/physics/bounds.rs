//! Whitehead's bound on the response of any mistuned wheel with a uniform dashpot.

use std::f64::consts::TAU;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{LumpedOptions, lumped};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;
use blisk::response::mistuning::{StructuralModes, WheelBasis};
use rayon::prelude::*;

use super::contact::random::Random;
use super::wheels::{Wheel, pattern};

/// Random wheels, and patterns of each.
const WHEELS: u64 = 500;
const PATTERNS: usize = 20;

/// `(1 + sqrt N) / 2` for the numbers of blades of the oracle.
#[test]
fn the_bound_has_its_known_values() {
    for (blades, known) in [
        (12, 2.232),
        (24, 2.949),
        (29, 3.193),
        (36, 3.5),
        (92, 5.296),
    ] {
        assert!((bound(blades) - known).abs() < 5e-4, "N = {blades}");
    }
}

fn bound(blades: usize) -> f64 {
    0.5 * (1.0 + (blades as f64).sqrt())
}

/// One mass per sector, or blade and disk: masses, springs and coupling drawn over two decades.
fn random_wheel(random: &mut Random) -> LumpedOptions {
    let disk = random.integer(0, 2) == 0;
    let of_disk = |value: f64| if disk { value } else { 0.0 };
    LumpedOptions {
        sectors: random.integer(2, 24),
        blade_mass_kg: random.magnitude(0.01, 1.0),
        blade_stiffness_n_per_m: random.magnitude(1e4, 1e6),
        blade_coupling_stiffness_n_per_m: random.magnitude(1e2, 1e6),
        disk_mass_kg: of_disk(random.magnitude(0.01, 1.0)),
        disk_ground_stiffness_n_per_m: of_disk(random.magnitude(1e4, 1e6)),
        disk_coupling_stiffness_n_per_m: of_disk(random.magnitude(1e2, 1e6)),
        ..LumpedOptions::default()
    }
}

/// Largest `omega a m_b |X_n| / (F (1 + sqrt N) / 2)` of one wheel under its patterns.
///
/// With `C = a M` the equation in the coordinates `M^1/2 x` has the dashpot a on every one, and the
/// force on each blade is `F / sqrt(m_b)`: `i omega a Z^-1 = (I + U) / 2` with U unitary (Cayley), hence
/// `omega a m_b |X_n| <= F (1 + sqrt N) / 2` for every blade, frequency and pattern (oracle 4.1). Note
/// the factor omega: the ratio of peaks may exceed the bound by the ratio of their frequencies.
fn worst_share(seed: u64) -> f64 {
    let mut random = Random(seed);
    let options = random_wheel(&mut random);
    let sectors = options.sectors;
    let dashpot = random.magnitude(1e-4, 0.3)
        * (options.blade_stiffness_n_per_m / options.blade_mass_kg).sqrt();
    let none = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: 0.0,
        friction_coefficient: 0.0,
    };
    let damping = Damping::Rayleigh {
        mass_per_s: dashpot,
        stiffness_s: 0.0,
    };
    let wheel = Wheel::of(
        &lumped::build(&options).unwrap(),
        ContactLaw::MacroSlip1d,
        none,
        damping,
        BasisChoice::CraigBampton,
    );
    let solver = wheel.solver(&[1], SolverOptions::default());
    let basis = WheelBasis::new(wheel.model.clone());
    let order = random.integer(0, sectors - 1) as u32;
    let mut worst = 0.0_f64;
    for _ in 0..PATTERNS {
        let size = random.magnitude(1e-3, 0.9);
        let deviations = random.vector(sectors, size);
        let change = basis.blade_stiffness_change(&deviations);
        let modes = StructuralModes::of_wheel(&basis, &change).unwrap();
        // At every natural frequency, half a half-bandwidth and two to either side.
        let frequencies: Vec<f64> = modes
            .eigenvalues
            .iter()
            .flat_map(|lambda| {
                let omega = lambda.sqrt();
                [-1.0, -0.25, 0.0, 0.25, 1.0].map(|offset| (omega + offset * dashpot) / TAU)
            })
            .filter(|frequency| *frequency > 0.0)
            .collect();
        let curve = solver.curve(
            order,
            ContactCondition::Free,
            Some(&pattern(&deviations)),
            &frequencies,
        );
        for (frequency, amplitudes) in curve.unwrap() {
            let highest = amplitudes.unwrap().into_iter().fold(0.0, f64::max);
            let share =
                TAU * frequency * dashpot * options.blade_mass_kg * highest / bound(sectors);
            assert!(share.is_finite());
            worst = worst.max(share);
        }
    }
    worst
}

#[test]
fn no_blade_exceeds_whiteheads_bound_on_ten_thousand_random_systems() {
    let shares: Vec<f64> = (0..WHEELS).into_par_iter().map(worst_share).collect();
    let worst = shares.iter().copied().fold(0.0, f64::max);
    println!(
        "{} systems, worst share of the bound {worst:.4}",
        WHEELS as usize * PATTERNS
    );
    assert!(worst <= 1.0 + 1e-9, "{worst}");
    // The check has teeth: some systems come near to what it forbids.
    assert!(worst > 0.6, "{worst}");
}
