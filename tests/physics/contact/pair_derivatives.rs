//! Jacobian of a pair against differences; the law is piecewise linear, so within a piece these are
//! exact.

use std::sync::Arc;

use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{HarmonicTransform, PairHarmonics, PairJacobian};

use super::random::Random;

/// Entry of the full `3 n * 3 n` Jacobian that the blocks stand for.
fn entry(jacobian: &PairJacobian, n: usize, row: usize, column: usize) -> f64 {
    let index = (row % n) * n + column % n;
    match (row / n, column / n) {
        (0, 0) => jacobian.normal_normal[index],
        (direction, 0) => jacobian.tangential_normal[direction - 1][index],
        (direction, other) if direction == other => {
            jacobian.tangential_tangential[direction - 1][index]
        }
        _ => 0.0,
    }
}

#[test]
fn jacobian_is_the_difference_quotient_away_from_kinks() {
    let mut random = Random(21);
    let sets: [&[usize]; 4] = [&[1], &[1, 3], &[0, 1, 2, 3], &[0, 1, 2, 3, 4, 5, 6, 7]];
    let (mut checked, mut skipped) = (0, 0);
    let mut states = [[0; 2]; 2];
    for case in 0..400 {
        let harmonics = sets[case % sets.len()];
        let law = if case % 5 == 4 {
            ContactLaw::MacroSlip1d
        } else {
            ContactLaw::Simplified3d
        };
        let transform =
            Arc::new(HarmonicTransform::new(harmonics, [64, 90, 128][case % 3]).unwrap());
        let n = transform.n_coefficients();
        let parameters = PairParameters {
            normal_load_n: random.magnitude(0.2, 20.0),
            normal_stiffness_n_per_m: random.magnitude(0.1, 3.0),
            tangential_stiffness_n_per_m: random.magnitude(0.3, 3.0),
            friction_coefficient: random.uniform(0.1, 0.9),
        };
        let mut pairs = PairHarmonics::new(law, transform);
        let coefficients = random.vector(3 * n, 1.0);
        let mut value = vec![0.0; 3 * n];
        let mut jacobian = PairJacobian::new(n);
        let state = pairs.evaluate(&parameters, &coefficients, &mut value, Some(&mut jacobian));
        states[usize::from(state.slipping)][usize::from(state.separated)] += 1;
        let step = 1e-7;
        let mut shifted = coefficients.clone();
        let (mut above, mut below) = (value.clone(), value.clone());
        for column in 0..3 * n {
            shifted[column] = coefficients[column] + step;
            pairs.evaluate(&parameters, &shifted, &mut above, None);
            shifted[column] = coefficients[column] - step;
            pairs.evaluate(&parameters, &shifted, &mut below, None);
            shifted[column] = coefficients[column];
            let smooth =
                (0..3 * n).all(|row| (above[row] + below[row] - 2.0 * value[row]).abs() < 1e-14);
            if !smooth {
                skipped += 1;
                continue;
            }
            checked += 1;
            for row in 0..3 * n {
                let difference = (above[row] - below[row]) / (2.0 * step);
                let exact = entry(&jacobian, n, row, column);
                assert!(
                    (difference - exact).abs() < 2e-7,
                    "case {case}, row {row}, column {column}: {difference} {exact}"
                );
            }
        }
    }
    assert!(
        checked > 20 * skipped,
        "{checked} columns checked, {skipped} at a kink"
    );
    assert!(
        states[1][0] > 30 && states[1][1] > 30 && states[0][0] > 10,
        "{states:?}"
    );
}

#[test]
fn jacobian_times_state_is_the_correction_when_nothing_is_preloaded() {
    // Euler: without N0 the corrections are homogeneous of degree one in the displacement alone.
    let mut random = Random(22);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n = transform.n_coefficients();
    let mut pairs = PairHarmonics::new(ContactLaw::Simplified3d, transform);
    let mut jacobian = PairJacobian::new(n);
    for _ in 0..50 {
        let coefficients = random.vector(3 * n, 1.0);
        let parameters = PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: 2.0,
            tangential_stiffness_n_per_m: 1.0,
            friction_coefficient: 0.4,
        };
        let mut value = vec![0.0; 3 * n];
        pairs.evaluate(&parameters, &coefficients, &mut value, Some(&mut jacobian));
        for (row, value) in value.iter().enumerate() {
            let product: f64 = (0..3 * n)
                .map(|column| entry(&jacobian, n, row, column) * coefficients[column])
                .sum();
            assert!((product - value).abs() < 1e-13, "{product} {value}");
        }
    }
}
