//! Damping by nodal diameter: closed forms, a dense wheel assembled here, and the dynamics in time.

use std::f64::consts::TAU;
use std::sync::Arc;

use blisk::linalg::Complex64;
use blisk::model::reduction::{BasisChoice, DampedModes, NodalDiameterDamping, Reduction};
use blisk::model::sector::{LumpedOptions, lumped};
use blisk::population::monte_carlo::{RowSettings, RowSolver, Scenario};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters, Ring};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::{ContactFactors, Projection, WheelBasis};
use blisk::verification::time_integration::{PointCase, TimeOptions, compare_point};

use crate::sector_sources::lumped::{lumped24, one_dof};
use crate::wheels::{LUMPED_KT, pattern, springs};

/// Sectors of the wheels of this file: both kinds of standing wave, and waves that travel.
const SECTORS: usize = 6;
/// Ratios of nodal diameters 0 to 3, no two alike.
const RATIOS: [f64; 4] = [0.0, 0.0021, 0.0008, 0.0037];
const ETA: f64 = 0.001;

fn contact() -> PairParameters {
    PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: LUMPED_KT,
        friction_coefficient: 0.3,
    }
}

fn table(modes: DampedModes) -> NodalDiameterDamping {
    NodalDiameterDamping {
        ratios: RATIOS.to_vec(),
        modes,
    }
}

fn chain() -> LumpedOptions {
    LumpedOptions {
        sectors: SECTORS,
        blade_coupling_stiffness_n_per_m: 6.0e4,
        ..lumped24()
    }
}

fn solver(options: &LumpedOptions, damping: Damping, modes: DampedModes) -> RowSolver {
    let sector = lumped::build(options).unwrap();
    let law = ContactLaw::MacroSlip1d;
    let reduction = Reduction::new(&sector, springs(law, contact()), 25, 0)
        .unwrap()
        .with_damping(table(modes));
    let model = reduction.reduce(BasisChoice::CraigBampton, None).unwrap();
    let settings = RowSettings {
        harmonics: vec![1],
        contact: (options.ring_mass_kg > 0.0).then_some((law, contact())),
        ring: Ring::Locked,
        damping,
        amplitude_n: 1.0,
        projection: Projection::Exact,
        solver: SolverOptions {
            peak_tolerance: 1e-9,
            ..SolverOptions::default()
        },
    };
    RowSolver::new(Arc::new(model), settings).unwrap()
}

/// Largest value of `1 / |lambda - omega^2 + i (eta lambda + omega c)|`.
fn highest(lambda: f64, eta: f64, c: f64) -> f64 {
    let of = |omega: f64| {
        (lambda - omega * omega)
            .hypot(eta * lambda + omega * c)
            .recip()
    };
    let (mut low, mut high) = (0.98 * lambda.sqrt(), 1.02 * lambda.sqrt());
    for _ in 0..200 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if of(a) < of(b) {
            low = a;
        } else {
            high = b;
        }
    }
    of(0.5 * (low + high))
}

#[test]
fn the_tuned_peak_of_every_engine_order_is_that_of_one_mode_with_its_ratio() {
    let options = one_dof(SECTORS);
    let (m, k) = (options.blade_mass_kg, options.blade_stiffness_n_per_m);
    for modes in [DampedModes::Blade, DampedModes::All] {
        let solver = solver(&options, Damping::StructuralLossFactor(ETA), modes);
        for engine_order in 0..=8_u32 {
            let h = engine_order as usize % SECTORS;
            let h = h.min(SECTORS - h);
            let turn = TAU * h as f64 / SECTORS as f64;
            let stiffness = k + 2.0 * options.blade_coupling_stiffness_n_per_m * (1.0 - turn.cos());
            let share = match modes {
                DampedModes::Blade => k / stiffness,
                DampedModes::All => 1.0,
            };
            let lambda = stiffness / m;
            let c = 2.0 * RATIOS[h] * share * lambda.sqrt();
            let found = solver.tuned(&Scenario {
                index: 0,
                load_case: None,
                engine_order,
                standard_deviation: None,
                contact: ContactCondition::Free,
            });
            assert_eq!(found.status, Status::Ok);
            let expected = highest(lambda, ETA, c) / m;
            let ratio = found.amplitude_m.unwrap() / expected;
            assert!(
                (ratio - 1.0).abs() < 1e-7,
                "{modes:?} {engine_order}: {ratio}"
            );
        }
    }
}

type Three = [[f64; 3]; 3];

/// Eigenvalues and orthonormal eigenvectors (columns) of a symmetric matrix by Jacobi's rotations.
fn jacobi(mut a: Three) -> ([f64; 3], Three) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..60 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let angle = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
            let (s, c) = angle.sin_cos();
            let turn = |row: &mut [f64; 3]| {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            };
            a.iter_mut().for_each(turn);
            let (above, below) = (a[p], a[q]);
            for i in 0..3 {
                a[p][i] = c * above[i] - s * below[i];
                a[q][i] = s * above[i] + c * below[i];
            }
            v.iter_mut().for_each(turn);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}

/// Stiffness of nodal diameter h without contact: blade, disk, ring.
fn stiffness(options: &LumpedOptions, h: usize) -> Three {
    let wave = 2.0 - 2.0 * (TAU * h as f64 / SECTORS as f64).cos();
    let (blade, located) = (
        options.blade_stiffness_n_per_m,
        options.ring_disk_stiffness_n_per_m,
    );
    let disk =
        options.disk_ground_stiffness_n_per_m + wave * options.disk_coupling_stiffness_n_per_m;
    let ring = wave * options.ring_coupling_stiffness_n_per_m;
    [
        [
            blade + wave * options.blade_coupling_stiffness_n_per_m,
            -blade,
            0.0,
        ],
        [-blade, blade + disk + located, -located],
        [0.0, -located, ring + located],
    ]
}

/// `M (sum_r c_r phi_r phi_r^T) M` of nodal diameter h.
fn damping(options: &LumpedOptions, h: usize, modes: DampedModes) -> Three {
    let mass = [
        options.blade_mass_kg,
        options.disk_mass_kg,
        options.ring_mass_kg,
    ];
    let k = stiffness(options, h);
    let mut scaled = k;
    for i in 0..3 {
        for j in 0..3 {
            scaled[i][j] /= (mass[i] * mass[j]).sqrt();
        }
    }
    let (values, vectors) = jacobi(scaled);
    let mut c = [[0.0; 3]; 3];
    for r in 0..3 {
        // Columns of M phi, and of phi.
        let loaded: Vec<f64> = (0..3).map(|i| mass[i].sqrt() * vectors[i][r]).collect();
        let shape: Vec<f64> = (0..3).map(|i| vectors[i][r] / mass[i].sqrt()).collect();
        let stretch = shape[0] - shape[1];
        let share = match modes {
            DampedModes::Blade => options.blade_stiffness_n_per_m * stretch * stretch / values[r],
            DampedModes::All => 1.0,
        };
        let rate = 2.0 * RATIOS[h] * share * values[r].sqrt();
        for i in 0..3 {
            for j in 0..3 {
                c[i][j] += rate * loaded[i] * loaded[j];
            }
        }
    }
    c
}

/// Solves a dense complex system by Gaussian elimination with row exchange.
fn gauss(mut a: Vec<Vec<Complex64>>, mut b: Vec<Complex64>) -> Vec<Complex64> {
    let n = b.len();
    for column in 0..n {
        let pivot = (column..n)
            .max_by(|&i, &j| a[i][column].norm().total_cmp(&a[j][column].norm()))
            .unwrap();
        a.swap(column, pivot);
        b.swap(column, pivot);
        let (above, below) = a.split_at_mut(column + 1);
        let own = &above[column];
        for (place, row) in below.iter_mut().enumerate() {
            let factor = row[column] / own[column];
            for (entry, own) in row.iter_mut().zip(own).skip(column) {
                *entry -= factor * own;
            }
            let known = b[column];
            b[column + 1 + place] -= factor * known;
        }
    }
    for row in (0..n).rev() {
        let known: Complex64 = (row + 1..n).map(|k| a[row][k] * b[k]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    b
}

/// Amplitude of every blade of the whole wheel in its masses, `[K (1 + i eta) + K_contact + i omega C -
/// omega^2 M] x = f`.
fn dense(
    modes: DampedModes,
    deviations: &[f64],
    stuck: bool,
    engine_order: usize,
    omega: f64,
) -> Vec<f64> {
    let options = chain();
    let i = Complex64::new(0.0, 1.0);
    let n = 3 * SECTORS;
    let mut z = vec![vec![Complex64::default(); n]; n];
    for h in 0..SECTORS {
        let own = h.min(SECTORS - h);
        let (k, c) = (stiffness(&options, own), damping(&options, own, modes));
        for a in 0..SECTORS {
            for b in 0..SECTORS {
                let turn = TAU * (h * (a + SECTORS - b)) as f64 / SECTORS as f64;
                for p in 0..3 {
                    for q in 0..3 {
                        let value = k[p][q] * (1.0 + i * ETA) + i * omega * c[p][q];
                        z[3 * a + p][3 * b + q] += value * turn.cos() / SECTORS as f64;
                    }
                }
            }
        }
    }
    let mass = [
        options.blade_mass_kg,
        options.disk_mass_kg,
        options.ring_mass_kg,
    ];
    let mut spring = |p: usize, q: usize, k: Complex64| {
        z[p][p] += k;
        z[q][q] += k;
        z[p][q] -= k;
        z[q][p] -= k;
    };
    for (a, delta) in deviations.iter().enumerate() {
        let blade = delta * options.blade_stiffness_n_per_m * (1.0 + i * ETA);
        spring(3 * a, 3 * a + 1, blade);
        if stuck {
            spring(3 * a + 1, 3 * a + 2, LUMPED_KT.into());
        }
    }
    let mut force = vec![Complex64::default(); n];
    for a in 0..SECTORS {
        let turn = TAU * (engine_order * a) as f64 / SECTORS as f64;
        force[3 * a] = Complex64::from_polar(1.0, turn);
        for (p, m) in mass.iter().enumerate() {
            z[3 * a + p][3 * a + p] -= m * omega * omega;
        }
    }
    let x = gauss(z, force);
    (0..SECTORS).map(|a| x[3 * a].norm()).collect()
}

#[test]
fn a_mistuned_wheel_is_that_of_a_dense_assembly() {
    let options = chain();
    let deviations = [0.05, -0.03, 0.02, 0.06, -0.05, 0.01];
    let none = [0.0; SECTORS];
    for modes in [DampedModes::Blade, DampedModes::All] {
        let solver = solver(&options, Damping::StructuralLossFactor(ETA), modes);
        for (contact, stuck) in [
            (ContactCondition::Free, false),
            (ContactCondition::Stuck, true),
        ] {
            for engine_order in [1, 2, 3, 5] {
                let frequencies: Vec<f64> = (0..12).map(|k| 320.0 + 17.0 * f64::from(k)).collect();
                let order = engine_order as usize;
                for deviations in [&deviations, &none] {
                    let pattern = pattern(deviations);
                    let found = solver
                        .curve(engine_order, contact, Some(&pattern), &frequencies)
                        .unwrap();
                    for (hz, found) in found {
                        let own = dense(modes, deviations, stuck, order, TAU * hz);
                        let largest = own.iter().copied().fold(0.0, f64::max);
                        for (own, found) in own.iter().zip(found.unwrap()) {
                            let off = (own - found).abs() / largest;
                            assert!(off < 1e-9, "{contact:?} EO {order}, {hz} Hz: {off:e}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn the_ratio_of_a_nodal_diameter_damps_its_own_engine_order_alone() {
    let options = one_dof(SECTORS);
    let with = solver(
        &options,
        Damping::StructuralLossFactor(ETA),
        DampedModes::All,
    );
    let height = |engine_order| {
        let scenario = Scenario {
            index: 0,
            load_case: None,
            engine_order,
            standard_deviation: None,
            contact: ContactCondition::Free,
        };
        with.tuned(&scenario).amplitude_m.unwrap() * options.blade_mass_kg
    };
    // Nodal diameter 0 has no ratio of its own: F / (m eta lambda).
    let lambda = options.blade_stiffness_n_per_m / options.blade_mass_kg;
    assert!((height(0) * ETA * lambda - 1.0).abs() < 1e-6);
    assert!(height(3) < 0.2 * height(0));
}

#[test]
fn the_wheel_does_the_same_in_time() {
    let sector = lumped::build(&chain()).unwrap();
    let law = ContactLaw::MacroSlip1d;
    let reduction = Reduction::new(&sector, springs(law, contact()), 25, 0)
        .unwrap()
        .with_damping(table(DampedModes::Blade));
    let model = reduction.reduce(BasisChoice::CraigBampton, None).unwrap();
    let basis = WheelBasis::new(Arc::new(model));
    let deviations = [0.05, -0.03, 0.02, 0.06, -0.05, 0.01];
    let change = basis.blade_stiffness_change(&deviations);
    let damping = Damping::StructuralLossFactor(ETA);
    // Where the sticking wheel resonates, so that damping decides.
    let grid: Vec<f64> = (0..400).map(|k| 300.0 + 0.25 * f64::from(k)).collect();
    let sticking = solver(&chain(), damping, DampedModes::Blade);
    let pattern = pattern(&deviations);
    let curve = sticking
        .curve(1, ContactCondition::Stuck, Some(&pattern), &grid)
        .unwrap();
    let largest = |amplitudes: &[f64]| amplitudes.iter().copied().fold(0.0, f64::max);
    let heights = curve
        .iter()
        .map(|(hz, point)| (*hz, largest(point.as_ref().unwrap())));
    let (frequency_hz, _) = heights.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let settings = SolverOptions {
        samples_per_period: 1024,
        ..SolverOptions::default()
    };
    let factors = ContactFactors::default();
    let bare = Reduction::new(&sector, springs(law, contact()), 25, 0).unwrap();
    let bare = WheelBasis::new(Arc::new(
        bare.reduce(BasisChoice::CraigBampton, None).unwrap(),
    ));
    let case = |basis, normal_load_n| PointCase {
        basis,
        stiffness_change: Some(&change),
        damping,
        engine_order: 1,
        amplitude_n: 10.0,
        law,
        sector: PairParameters {
            normal_load_n,
            ..contact()
        },
        factors: &factors,
        harmonics: &[1, 3, 5, 7, 9, 11, 13, 15],
        solver: &settings,
        frequency_hz,
    };
    let options = TimeOptions {
        steps_per_period: 512,
        minimum_periods: 60,
        ..TimeOptions::default()
    };
    // Slipping and hardly slipping; friction hides damping under the first load, not under the second.
    for (normal_load_n, hidden) in [(1000.0, true), (2000.0, false)] {
        let found = compare_point(&case(&basis, normal_load_n), &options).unwrap();
        assert_eq!(found.status, Status::Ok, "{:?}", found.steps);
        assert!(found.reached(2e-4), "{}", found.largest_difference());
        let without = compare_point(&case(&bare, normal_load_n), &options).unwrap();
        let ratio = largest(&found.time_m) / largest(&without.time_m);
        assert!(hidden || ratio < 0.8, "{ratio}");
    }
}
