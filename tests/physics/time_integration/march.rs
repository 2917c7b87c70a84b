//! The contact laws marched: hysteresis loops known in closed form.

use std::f64::consts::TAU;

use blisk::response::friction::{ContactLaw, PairMemory, PairParameters, march};

fn pair(normal_load_n: f64, kn: f64, kt: f64, mu: f64) -> PairParameters {
    PairParameters {
        normal_load_n,
        normal_stiffness_n_per_m: kn,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: mu,
    }
}

#[test]
fn a_jenkins_loop_point_by_point() {
    let parameters = pair(3.0, 0.0, 2.0, 1.0);
    let path = [5.0, 3.5, 2.0, -5.0, -3.5, -2.0, 0.0];
    let expected = [3.0, 0.0, -3.0, -3.0, 0.0, 3.0, 3.0];
    for law in ContactLaw::ALL {
        let mut memory = PairMemory::at_rest(&parameters);
        for (u, force) in path.into_iter().zip(expected) {
            memory = march(law, &parameters, &memory, [0.0, u, 0.0]);
            assert!(
                (memory.force_n(law, &parameters)[1] - force).abs() < 1e-15,
                "{law:?} {u}"
            );
        }
    }
}

/// The normal motion is large and has no effect on it, nor does a force pull the pair open.
#[test]
fn both_tangents_of_a_constant_load_are_jenkins_elements_by_themselves() {
    let parameters = pair(3.0, 1.5, 2.0, 1.0);
    let law = ContactLaw::MacroSlip2d;
    let path = [5.0, 3.5, 2.0, -5.0, -3.5, -2.0, 0.0];
    let expected = [3.0, 0.0, -3.0, -3.0, 0.0, 3.0, 3.0];
    let mut memory = PairMemory::at_rest(&parameters);
    for ((step, u), force) in path.into_iter().enumerate().zip(expected) {
        let normal = 4.0 - step as f64;
        // Along t2 a step later, from rest.
        let before = step.checked_sub(1);
        let second = before.map_or(0.0, |before| path[before]);
        memory = march(law, &parameters, &memory, [normal, u, second]);
        let found = memory.force_n(law, &parameters);
        let second = before.map_or(0.0, |before| expected[before]);
        for (found, expected) in found.into_iter().zip([1.5 * normal, force, second]) {
            assert!(
                (found - expected).abs() < 1e-15,
                "{step}: {found} {expected}"
            );
        }
        assert!(!memory.separated());
    }
}

/// Mean, cosine and sine coefficient of friction, and energy per cycle, on the loop
/// `x = A cos`, normal closing `g/kn x`; marched for two cycles.
fn loop_of(law: ContactLaw, amplitude: f64, load_slope: f64, steps: u32) -> [f64; 4] {
    let kn = 7.0;
    let parameters = pair(6.0, kn, 2.0, 0.5);
    let mut memory = PairMemory::at_rest(&parameters);
    let mut sums = [0.0; 4];
    for step in 0..=2 * steps {
        let angle = TAU * f64::from(step) / f64::from(steps);
        let x = amplitude * angle.cos();
        let after = march(law, &parameters, &memory, [load_slope / kn * x, x, 0.0]);
        if step > steps {
            let share = 1.0 / f64::from(steps);
            sums[0] += share * after.friction_n[0];
            sums[1] += 2.0 * share * after.friction_n[0] * angle.cos();
            sums[2] += 2.0 * share * after.friction_n[0] * angle.sin();
            sums[3] += 0.5
                * (after.friction_n[0] + memory.friction_n[0])
                * (after.displacement_m[1] - memory.displacement_m[1]);
        }
        memory = after;
    }
    sums
}

#[test]
fn loops_with_variable_load_and_separation_meet_their_closed_forms() {
    // kt = 2, mu = 0.5, N0 = 6, A = 5: mean, cosine, sine coefficient and energy by load slope g.
    let table = [
        (0.0, [0.0, 2.523_158, -2.673_803_044, 42.0]),
        (0.4, [0.656_484, 2.551_649, -2.610_784_117, 41.010_101_01]),
        (1.0, [1.573_613, 2.756_048, -2.257_878_126, 35.466_666_667]),
        (1.2, [1.825_139, 2.932_004, -2.056_771_572, 32.307_692_308]),
        (2.0, [2.642_631, 4.068_074, -1.358_122_181, 21.333_333_333]),
        (3.0, [3.716_104, 5.481_612, -0.668_450_761, 10.5]),
    ];
    for (g, expected) in table {
        // Along one line the friction circle is a Jenkins element.
        for law in [ContactLaw::Simplified3d, ContactLaw::Coulomb3d] {
            let found = loop_of(law, 5.0, g, 20_000);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 3e-6 * 42.0,
                    "{law:?} {g}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn an_open_pair_carries_nothing_and_forgets_where_it_was() {
    let parameters = pair(1.0, 1.0, 2.0, 0.5);
    let law = ContactLaw::Simplified3d;
    let rest = PairMemory::at_rest(&parameters);
    let open = march(law, &parameters, &rest, [-3.0, 0.4, -0.2]);
    assert!(open.separated());
    assert_eq!(
        open.force_n(law, &parameters).map(f64::to_bits),
        [-1.0_f64, 0.0, 0.0].map(f64::to_bits)
    );
    // Moves on while open, then closes halfway through a step: only the second half of the path
    // counts, and it sticks where kt u' < mu kn v'.
    let moved = march(law, &parameters, &open, [-3.0, 9.0, 5.0]);
    let closed = march(law, &parameters, &moved, [1.0, 9.2, 5.0]);
    assert!((closed.friction_n[0] - 2.0 * 0.1).abs() < 1e-14 && !closed.slipping);
    let slipping = march(law, &parameters, &moved, [1.0, 10.5, 3.5]);
    let bits = slipping.friction_n.map(f64::to_bits);
    assert!(slipping.slipping && bits == [1.0_f64, -1.0].map(f64::to_bits));
}
