//! The surrogate of a row and the equivalent springs it starts from, against dense linear solves.

use std::f64::consts::TAU;

use blisk::linalg::{Complex64, Matrix};
use blisk::population::monte_carlo::Surrogate;
use blisk::response::forced_response::{
    ContactCondition, Excited, PointSettings, PointSolver, SolverOptions,
};
use blisk::response::harmonic_balance::Structure;

use super::contact::random::Random;
use super::wheels::{Wheel, full, pattern, relative, scenario, solve_row};

/// Solution of `a x = b` by Gaussian elimination with row exchange.
fn solve_dense(mut a: Vec<Vec<Complex64>>, mut b: Vec<Complex64>) -> Vec<Complex64> {
    let n = b.len();
    for column in 0..n {
        let pivot = (column..n)
            .max_by(|&i, &j| a[i][column].norm().total_cmp(&a[j][column].norm()))
            .unwrap();
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..n {
            let factor = a[row][column] / a[column][column];
            let pivot_row = a[column].clone();
            for (own, above) in a[row].iter_mut().zip(pivot_row).skip(column) {
                *own -= factor * above;
            }
            let above = b[column];
            b[row] -= factor * above;
        }
    }
    for row in (0..n).rev() {
        let known: Complex64 = (row + 1..n).map(|k| a[row][k] * b[k]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    b
}

fn complex_rows(rows: &blisk::response::mistuning::ModalRows) -> Matrix<Complex64> {
    Matrix::from_fn(rows.real.rows(), rows.real.columns(), |i, j| {
        let imaginary = rows.imaginary.as_ref().map_or(0.0, |part| part[(i, j)]);
        Complex64::new(rows.real[(i, j)], imaginary)
    })
}

/// Largest amplitude of a blade with linear springs at the contact rows, by a dense solve.
fn dense_amplitude(excited: &Excited, springs: &[Complex64], frequency_hz: f64) -> f64 {
    let structure: &Structure = &excited.linear.structure;
    let omega = TAU * frequency_hz;
    let (contact, observed) = (
        complex_rows(structure.contact()),
        complex_rows(structure.observed()),
    );
    let n = structure.size();
    let mut z = vec![vec![Complex64::default(); n]; n];
    for i in 0..n {
        z[i][i] += structure.eigenvalues()[i] - omega * omega;
        for j in 0..n {
            for row in 0..contact.rows() {
                let spring = springs[row % springs.len()];
                z[i][j] += contact[(row, i)].conj() * spring * contact[(row, j)];
            }
        }
    }
    structure.for_each_damping(omega, |i, j, d| z[i][j] += Complex64::new(0.0, d));
    let x = solve_dense(z, excited.force.clone());
    (0..structure.sectors())
        .map(|blade| {
            let norms = (0..3).map(|k| {
                let u: Complex64 = (0..n).map(|j| observed[(3 * blade + k, j)] * x[j]).sum();
                u.norm_sqr()
            });
            norms.sum::<f64>().sqrt()
        })
        .fold(0.0, f64::max)
}

#[test]
fn equivalent_springs_give_the_tuned_peak_back() {
    for (wheel, load_n) in [(Wheel::lumped24(), 7.5), (Wheel::wheel8(), 1600.0)] {
        let options = SolverOptions::default();
        let found = wheel
            .solver(&[1, 3], options.clone())
            .tuned_peak(super::wheels::ENGINE_ORDER, full(load_n));
        let point = found.point.unwrap();
        assert!(point.shares.slipping > 0.0, "nothing slips");
        let excited = wheel.tuned(&[1, 3]);
        let contact = Some((wheel.law, wheel.sector));
        let points =
            PointSettings::new(&options, &[1, 3], contact, wheel.model.contact.clone()).unwrap();
        let springs = PointSolver::new(&excited, full(load_n), &points)
            .equivalent_springs(&point)
            .unwrap();
        // Friction takes energy out in the sum over the rows.
        assert!(springs.iter().map(|spring| spring.im).sum::<f64>() > 0.0);
        let linear = dense_amplitude(&excited, &springs, point.frequency_hz);
        let difference = relative(linear, point.amplitudes_m[0]);
        assert!(difference < 1e-6, "{load_n} N: {difference:e}");
    }
}

#[test]
fn under_sticking_contact_the_surrogate_is_the_linear_peak() {
    let wheel = Wheel::lumped24();
    let solver = wheel.solver(&[1], SolverOptions::default());
    let stuck = scenario(ContactCondition::Stuck);
    let surrogate = Surrogate::new(&solver, &stuck, &solver.tuned(&stuck)).unwrap();
    let mut random = Random(5);
    for _ in 0..3 {
        let deviations = wheel.deviations(&mut random, 0.03);
        let found = surrogate.peak(&pattern(&deviations)).unwrap().amplitude_m;
        let excited = wheel.mistuned(&deviations, &[1]);
        let springs: Vec<Complex64> = wheel
            .model
            .springs
            .stick
            .iter()
            .map(|&k| k.into())
            .collect();
        let (_, row) = solve_row(&solver, &pattern(&deviations), ContactCondition::Stuck);
        // A dense solve at and beside the peak of the row.
        let at = row.peak_frequency_hz.unwrap();
        let highest = (-5..=5)
            .map(|step| dense_amplitude(&excited, &springs, at * (1.0 + 2e-5 * f64::from(step))))
            .fold(0.0, f64::max);
        let difference = relative(found, highest);
        assert!(difference < 0.01, "{difference:e}");
    }
}

#[test]
fn under_friction_the_surrogate_ranks_as_the_rows_do() {
    let wheel = Wheel::lumped24();
    let solver = wheel.solver(&[1, 3], SolverOptions::default());
    let friction = scenario(full(7.5));
    let surrogate = Surrogate::new(&solver, &friction, &solver.tuned(&friction)).unwrap();
    let mut random = Random(7);
    let pairs: Vec<(f64, f64)> = (0..24)
        .map(|_| {
            let deviations = pattern(&wheel.deviations(&mut random, 0.03));
            let (_, row) = solve_row(&solver, &deviations, full(7.5));
            let stand_in = surrogate.peak(&deviations).unwrap().amplitude_m;
            (stand_in, row.peak_amplitude_m.unwrap())
        })
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / 24.0;
    let (x, y) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let product = |f: fn(f64, f64) -> f64| -> f64 {
        pairs.iter().map(|pair| f(pair.0 - x, pair.1 - y)).sum()
    };
    let correlation =
        product(|a, b| a * b) / (product(|a, _| a * a) * product(|_, b| b * b)).sqrt();
    println!("correlation {correlation}");
    assert!(correlation > 0.8, "{correlation}");
}
