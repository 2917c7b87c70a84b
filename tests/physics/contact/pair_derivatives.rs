//! Jacobian of a pair against differences; but for `coulomb_3d` the laws are piecewise linear, so
//! within a piece these are exact.

use std::sync::Arc;

use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{HarmonicTransform, PairHarmonics, PairJacobian};

use super::random::Random;

/// Entry of the full `3 n * 3 n` Jacobian that the blocks stand for.
fn entry(jacobian: &PairJacobian, n: usize, row: usize, column: usize) -> f64 {
    let index = (row % n) * n + column % n;
    match (row / n, column / n) {
        (0, 0) => jacobian.normal_normal[index],
        (0, _) => 0.0,
        (direction, 0) => jacobian.tangential_normal[direction - 1][index],
        (direction, other) if direction == other => {
            jacobian.tangential_tangential[direction - 1][index]
        }
        (direction, _) => jacobian
            .tangential_cross
            .as_ref()
            .map_or(0.0, |cross| cross[direction - 1][index]),
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
        let law = match (case / sets.len()) % 10 {
            4 => ContactLaw::MacroSlip1d,
            9 => ContactLaw::MacroSlip2d,
            _ => ContactLaw::Simplified3d,
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
        if case % 3 == 0 {
            pairs.set_drift([random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]);
        }
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

#[test]
fn jacobian_of_coulomb_3d_is_the_difference_quotient_away_from_kinks() {
    let mut random = Random(23);
    let sets: [&[usize]; 4] = [&[1], &[1, 3], &[0, 1, 2, 3], &[0, 1, 2, 3, 4, 5, 6, 7]];
    let (mut checked, mut skipped) = (0, 0);
    let mut states = [[0; 2]; 2];
    let mut worst = 0.0_f64;
    for case in 0..300 {
        let transform =
            Arc::new(HarmonicTransform::new(sets[case % 4], [64, 90, 128][case % 3]).unwrap());
        let n = transform.n_coefficients();
        let parameters = PairParameters {
            normal_load_n: random.magnitude(0.2, 20.0),
            normal_stiffness_n_per_m: random.magnitude(0.1, 3.0),
            tangential_stiffness_n_per_m: random.magnitude(0.3, 3.0),
            friction_coefficient: random.uniform(0.1, 0.9),
        };
        let mut pairs = PairHarmonics::new(ContactLaw::Coulomb3d, transform);
        if case % 3 == 0 {
            pairs.set_drift([random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)]);
        }
        let coefficients = random.vector(3 * n, 1.0);
        let mut value = vec![0.0; 3 * n];
        let mut jacobian = PairJacobian::new(n);
        let state = pairs.evaluate(&parameters, &coefficients, &mut value, Some(&mut jacobian));
        states[usize::from(state.slipping)][usize::from(state.separated)] += 1;
        let mut slope = |column: usize, step: f64| {
            let mut shifted = coefficients.clone();
            let (mut above, mut below) = (value.clone(), value.clone());
            shifted[column] = coefficients[column] + step;
            pairs.evaluate(&parameters, &shifted, &mut above, None);
            shifted[column] = coefficients[column] - step;
            pairs.evaluate(&parameters, &shifted, &mut below, None);
            let differences = above.iter().zip(&below);
            let slopes: Vec<f64> = differences.map(|(a, b)| (a - b) / (2.0 * step)).collect();
            slopes
        };
        for column in 0..3 * n {
            let (wide, narrow) = (slope(column, 1e-5), slope(column, 5e-6));
            // A kink within the step shows as a difference; the third derivative does not.
            if wide.iter().zip(&narrow).any(|(a, b)| (a - b).abs() > 1e-7) {
                skipped += 1;
                continue;
            }
            checked += 1;
            for (row, (wide, narrow)) in wide.iter().zip(&narrow).enumerate() {
                let difference = (4.0 * narrow - wide) / 3.0;
                let error = (difference - entry(&jacobian, n, row, column)).abs();
                worst = worst.max(error);
                assert!(
                    error < 1e-6,
                    "case {case}, row {row}, column {column}: {error:e}"
                );
            }
        }
    }
    println!("{checked} columns, {skipped} at a kink, worst error {worst:.1e}, states {states:?}");
    assert!(checked > 4 * skipped);
    assert!(states[1][0] > 30 && states[1][1] > 30);
}

#[test]
fn macro_slip_without_normal_load_has_the_derivative_of_no_force() {
    // N0 = 0: the tangential spring carries nothing, whatever the displacement; the normal spring
    // stays bilateral although the pair counts as separated.
    let mut random = Random(24);
    for harmonics in [&[1][..], &[0, 1, 3]] {
        let transform = Arc::new(HarmonicTransform::new(harmonics, 64).unwrap());
        let n = transform.n_coefficients();
        let mut pairs = PairHarmonics::new(ContactLaw::MacroSlip1d, transform);
        let parameters = PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: 2.0,
            tangential_stiffness_n_per_m: 1.5,
            friction_coefficient: 0.4,
        };
        let coefficients = random.vector(3 * n, 1.0);
        let (mut value, mut above) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        let mut jacobian = PairJacobian::new(n);
        let state = pairs.evaluate(&parameters, &coefficients, &mut value, Some(&mut jacobian));
        assert!(state.separated && state.slipping);
        for column in 0..3 * n {
            let mut shifted = coefficients.clone();
            shifted[column] += 0.25;
            pairs.evaluate(&parameters, &shifted, &mut above, None);
            for row in 0..3 * n {
                let exact = entry(&jacobian, n, row, column);
                let difference = (above[row] - value[row]) / 0.25;
                assert!((difference - exact).abs() < 1e-13, "{row} {column}");
                let mean = harmonics[0] == 0 && column == n;
                let lost = row == column && (n..2 * n).contains(&row) && !mean;
                let expected = if lost { -1.5 } else { 0.0 };
                assert!((exact - expected).abs() < 1e-13, "{row} {column}: {exact}");
            }
        }
    }
}
