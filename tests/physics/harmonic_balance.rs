//! The harmonic balance equation: its derivative, its energy, and its solution by another route.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix};
use blisk::response::forced_response::{Excited, PointSettings, PointSolver, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{
    ContactInterface, Damping, HarmonicSystem, HarmonicTransform, Structure,
};
use rustfft::FftPlanner;

use super::contact::random::Random;
use super::wheels::{Wheel, full, springs};

const DAMPINGS: [Damping; 3] = [
    Damping::StructuralLossFactor(0.002),
    Damping::ModalRatio(0.001),
    Damping::Rayleigh {
        mass_per_s: 5.0,
        stiffness_s: 4e-7,
    },
];
const SETS: [&[u32]; 3] = [&[1], &[1, 3], &[0, 1, 2, 3]];

/// The finite-element wheel under a law and a damping, tuned as one sector or mistuned.
fn excited(wheel: &Wheel, tuned: bool, harmonics: &[u32], random: &mut Random) -> Excited {
    if tuned {
        wheel.tuned(harmonics)
    } else {
        wheel.mistuned(&wheel.deviations(random, 0.03), harmonics)
    }
}

fn pairs(wheel: &Wheel, normal_load_n: f64) -> Vec<PairParameters> {
    let sector = PairParameters {
        normal_load_n,
        ..wheel.sector
    };
    let weights = &wheel.model.contact.weights;
    weights.iter().map(|&weight| sector.share(weight)).collect()
}

fn system(wheel: &Wheel, excited: &Excited, samples: usize, load: f64) -> HarmonicSystem {
    let harmonics: Vec<usize> = excited
        .blocks
        .iter()
        .map(|block| block.harmonic as usize)
        .collect();
    HarmonicSystem::new(
        excited.blocks.clone(),
        excited.force.clone(),
        ContactInterface {
            law: wheel.law,
            geometry: wheel.model.contact.clone(),
            pairs: pairs(wheel, load),
        },
        Arc::new(HarmonicTransform::new(&harmonics, samples).unwrap()),
    )
}

/// Contact rows of a structure, complex.
fn contact_rows(structure: &Structure) -> Matrix<Complex64> {
    let rows = structure.contact();
    Matrix::from_fn(rows.real.rows(), rows.real.columns(), |i, j| {
        let imaginary = rows.imaginary.as_ref().map_or(0.0, |part| part[(i, j)]);
        Complex64::new(rows.real[(i, j)], imaginary)
    })
}

/// Complex modal amplitudes of the harmonic at `index`.
pub fn amplitudes(system: &HarmonicSystem, index: usize, x: &[f64]) -> Vec<Complex64> {
    let block = &system.blocks()[index];
    let x = &x[system.block_start(index)..system.block_start(index + 1)];
    let (re, im) = x.split_at(block.structure.size());
    (0..re.len())
        .map(|mode| Complex64::new(re[mode], im.get(mode).copied().unwrap_or(0.0)))
        .collect()
}

/// Complex amplitudes of the relative motion, harmonic by harmonic.
fn contact_motion(system: &HarmonicSystem, x: &[f64]) -> Vec<Vec<Complex64>> {
    (0..system.blocks().len())
        .map(|index| {
            let rows = contact_rows(&system.blocks()[index].structure);
            rows.times_vector(&amplitudes(system, index, x))
        })
        .collect()
}

mod derivative {
    use super::*;

    /// Residual and Jacobian at `x`, with the shares of slipping and separated pairs.
    struct Linearised {
        residual: Vec<f64>,
        jacobian: Vec<f64>,
        slipping: f64,
        separated: f64,
    }

    fn linearise(system: &HarmonicSystem, omega: f64, x: &[f64]) -> Linearised {
        let n = system.unknowns();
        let mut workspace = system.workspace();
        let (mut residual, mut jacobian) = (vec![0.0; n], vec![0.0; n * n]);
        let (_, shares) = system.residual(omega, x, &mut residual, true, &mut workspace);
        system.jacobian(omega, &mut workspace, &mut jacobian);
        Linearised {
            residual,
            jacobian,
            slipping: shares.slipping,
            separated: shares.separated,
        }
    }

    /// A state in which every mode carries about the same stiffness force.
    fn random_state(system: &HarmonicSystem, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
        let scale: Vec<f64> = system
            .blocks()
            .iter()
            .flat_map(|block| {
                let parts = if block.harmonic == 0 { 1 } else { 2 };
                let own = block.structure.eigenvalues();
                let of_mode = own.iter().map(|lambda| 1.0 / lambda.max(1e6));
                of_mode.collect::<Vec<_>>().repeat(parts)
            })
            .collect();
        let x = scale
            .iter()
            .map(|s| s * random.uniform(-1.0, 1.0))
            .collect();
        (x, scale)
    }

    /// The system under the highest of a row of normal loads at which `x` makes a pair slip, or
    /// separate where the law knows separation.
    fn at_work(wheel: &Wheel, stuck: &HarmonicSystem, omega: f64, x: &[f64]) -> HarmonicSystem {
        let motion = contact_motion(stuck, x);
        let squares: f64 = motion.iter().flatten().map(Complex64::norm_sqr).sum();
        let first_load = wheel.sector.normal_stiffness_n_per_m * squares.sqrt();
        (0..60)
            .map(|i| stuck.with_pairs(pairs(wheel, first_load * 0.7_f64.powi(i))))
            .find(|system| share_at_work(wheel.law, &linearise(system, omega, x)) > 0.3)
            .unwrap()
    }

    /// One column against differences; all in the size of the residual.
    struct Column {
        error: f64,
        /// Change of the slope over the step: not zero at a kink.
        bend: f64,
        /// The contact part of the column.
        size: f64,
    }

    /// Compares the contact part of every column, scaled by the size of its unknown, with central
    /// differences; returns the worst error relative to the largest column, and how many columns
    /// were passed over at a kink.
    fn worst_column_error(
        system: &HarmonicSystem,
        stuck: &Linearised,
        omega: f64,
        x: &[f64],
        scale: &[f64],
    ) -> (f64, usize) {
        const STEP: f64 = 1e-6;
        let n = system.unknowns();
        let here = linearise(system, omega, x);
        let mut workspace = system.workspace();
        let mut columns = Vec::new();
        for column in 0..n {
            let step = STEP * scale[column];
            let mut shifted = x.to_vec();
            let mut sides = [vec![0.0; n], vec![0.0; n]];
            for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                shifted[column] = x[column] + sign * step;
                system.residual(omega, &shifted, side, false, &mut workspace);
            }
            let column = column * n..(column + 1) * n;
            let (linear, exact) = (&stuck.jacobian[column.clone()], &here.jacobian[column]);
            let largest = |entry: &dyn Fn(usize) -> f64| {
                (0..n).map(|row| entry(row).abs()).fold(0.0, f64::max) / STEP
            };
            columns.push(Column {
                error: largest(&|row| (sides[0][row] - sides[1][row]) / 2.0 - exact[row] * step),
                bend: largest(&|row| sides[0][row] + sides[1][row] - 2.0 * here.residual[row]),
                size: largest(&|row| (exact[row] - linear[row]) * step),
            });
        }
        let size = columns.iter().map(|column| column.size).fold(0.0, f64::max);
        let smooth = columns.iter().filter(|column| column.bend <= 1e-7 * size);
        let worst = smooth
            .clone()
            .map(|column| column.error)
            .fold(0.0, f64::max);
        (worst / size, n - smooth.count())
    }

    #[test]
    fn the_derivative_by_frequency_is_the_difference_quotient() {
        let mut random = Random(11);
        let wheel8 = Wheel::wheel8();
        for (damping, harmonics, tuned) in settings() {
            let wheel = Wheel {
                damping,
                ..wheel8.clone()
            };
            let excited = excited(&wheel, tuned, harmonics, &mut random);
            let stuck = system(&wheel, &excited, 64, 1e30);
            let (x, _) = random_state(&stuck, &mut random);
            let omega = TAU * 613.0;
            let system = at_work(&wheel, &stuck, omega, &x);
            let n = system.unknowns();
            let mut workspace = system.workspace();
            let mut exact = vec![0.0; n];
            system.frequency_derivative(omega, &x, &mut exact);
            // The residual is of second degree in frequency: central differences are exact.
            let step = 1e-2 * omega;
            let [above, below] = [omega + step, omega - step].map(|omega| {
                let mut residual = vec![0.0; n];
                system.residual(omega, &x, &mut residual, false, &mut workspace);
                residual
            });
            let size = exact.iter().fold(0.0_f64, |size, d| size.max(d.abs()));
            assert!(size > 0.0);
            for ((above, below), exact) in above.iter().zip(&below).zip(&exact) {
                let quotient = (above - below) / (2.0 * step);
                assert!(
                    (quotient - exact).abs() < 1e-8 * size,
                    "{damping:?} {harmonics:?} {tuned}: {quotient:e} for {exact:e}"
                );
            }
        }
    }

    #[test]
    fn the_jacobian_is_the_difference_quotient_away_from_kinks() {
        let mut random = Random(5);
        let wheel8 = Wheel::wheel8();
        let (mut columns, mut kinks, mut worst) = (0, 0, 0.0_f64);
        for law in ContactLaw::ALL {
            let mut mixed = 0.0_f64;
            for (damping, harmonics, tuned) in settings() {
                let wheel = Wheel {
                    law,
                    damping,
                    ..wheel8.clone()
                };
                let excited = excited(&wheel, tuned, harmonics, &mut random);
                let stuck = system(&wheel, &excited, 64, 1e30);
                let (x, scale) = random_state(&stuck, &mut random);
                let omega = TAU * 613.0;
                let system = at_work(&wheel, &stuck, omega, &x);
                let state = linearise(&system, omega, &x);
                let share = share_at_work(law, &state);
                mixed = mixed.max(share.min(1.0 - share));
                let linear = linearise(&stuck, omega, &x);
                let (error, at_kink) = worst_column_error(&system, &linear, omega, &x, &scale);
                assert!(
                    error < 1e-6,
                    "{law:?} {damping:?} {harmonics:?} {tuned}: {error:e}"
                );
                worst = worst.max(error);
                kinks += at_kink;
                columns += system.unknowns();
            }
            assert!(mixed > 0.1, "{law:?}: pairs are not all in one state");
        }
        println!("{columns} columns, {kinks} at a kink, worst error {worst:.1e}");
        assert!(
            20 * kinks < columns,
            "{kinks} of {columns} columns at a kink"
        );
    }

    /// Every damping, harmonic set and kind of wheel (tuned or not).
    fn settings() -> impl Iterator<Item = (Damping, &'static [u32], bool)> {
        DAMPINGS.into_iter().flat_map(|damping| {
            SETS.into_iter()
                .flat_map(move |set| [true, false].map(|tuned| (damping, set, tuned)))
        })
    }

    /// Share of the pairs in the state that is the hardest the law knows.
    fn share_at_work(law: ContactLaw, state: &Linearised) -> f64 {
        if law.has_variable_load() {
            state.separated
        } else {
            state.slipping
        }
    }

    #[test]
    fn without_slip_the_equation_is_linear() {
        let mut random = Random(6);
        for damping in DAMPINGS {
            let wheel = Wheel {
                damping,
                ..Wheel::wheel8()
            };
            for tuned in [true, false] {
                let excited = excited(&wheel, tuned, &[0, 1, 2, 3], &mut random);
                let system = system(&wheel, &excited, 64, 1e30);
                let (x, _) = random_state(&system, &mut random);
                let n = system.unknowns();
                let at_x = linearise(&system, 3800.0, &x);
                let at_zero = linearise(&system, 3800.0, &vec![0.0; n]);
                for row in 0..n {
                    let terms = || (0..n).map(|j| at_x.jacobian[j * n + row] * x[j]);
                    let size = terms().map(f64::abs).sum::<f64>() + at_zero.residual[row].abs();
                    let error = terms().sum::<f64>() + at_zero.residual[row] - at_x.residual[row];
                    assert!(
                        error.abs() <= 1e-13 * size,
                        "{damping:?}: {error:e} of {size:e}"
                    );
                }
            }
        }
    }
}

/// A converged solution of one point.
pub struct Solved {
    pub system: HarmonicSystem,
    pub omega: f64,
    pub x: Vec<f64>,
}

pub const SAMPLES: usize = 128;

pub fn converge(wheel: &Wheel, excited: &Excited, load: f64, frequency_hz: f64) -> Solved {
    let options = SolverOptions {
        samples_per_period: SAMPLES,
        residual_tolerance: 1e-12,
        ..SolverOptions::default()
    };
    let harmonics: Vec<u32> = excited.blocks.iter().map(|block| block.harmonic).collect();
    let settings = PointSettings::new(
        &options,
        &harmonics,
        Some((wheel.law, wheel.sector)),
        wheel.model.contact.clone(),
    )
    .unwrap();
    let mut solver = PointSolver::new(excited, full(load), &settings);
    let point = solver.solve(frequency_hz).unwrap();
    assert!(point.shares.slipping > 0.0, "something slips");
    Solved {
        x: point.solution.clone(),
        system: system(wheel, excited, SAMPLES, load),
        omega: TAU * frequency_hz,
    }
}

/// Histories of one contact row: displacement without and with its mean, velocity per radian,
/// and the force on it.
#[derive(Clone)]
pub struct RowHistory {
    oscillation: Vec<f64>,
    mean: f64,
    pub velocity: Vec<f64>,
    pub force: Vec<f64>,
}

/// Marches every pair from rest for three periods and keeps the third: `T += kt dx`, confined to
/// the friction limit.
pub fn march(wheel: &Wheel, solved: &Solved) -> Vec<RowHistory> {
    let motion = contact_motion(&solved.system, &solved.x);
    let mut rows: Vec<RowHistory> = (0..motion[0].len())
        .map(|row| synthesize(&solved.system, &motion, row))
        .collect();
    let geometry = &wheel.model.contact;
    for sector in rows.chunks_mut(geometry.row_count()) {
        for (places, pair) in geometry.rows.iter().zip(solved.system.pairs()) {
            push_pair(wheel.law, pair, *places, sector);
        }
    }
    rows
}

fn synthesize(system: &HarmonicSystem, motion: &[Vec<Complex64>], row: usize) -> RowHistory {
    let mut history = RowHistory {
        oscillation: vec![0.0; SAMPLES],
        mean: 0.0,
        velocity: vec![0.0; SAMPLES],
        force: vec![0.0; SAMPLES],
    };
    for (block, motion) in system.blocks().iter().zip(motion) {
        let k = f64::from(block.harmonic);
        if block.harmonic == 0 {
            history.mean = motion[row].re;
            continue;
        }
        for j in 0..SAMPLES {
            let turned = motion[row] * Complex64::cis(k * TAU * j as f64 / SAMPLES as f64);
            history.oscillation[j] += turned.re;
            history.velocity[j] -= k * turned.im;
        }
    }
    history
}

/// Fills the forces of one pair: on its normal row the change of the normal load.
fn push_pair(
    law: ContactLaw,
    pair: &PairParameters,
    places: [Option<usize>; 3],
    sector: &mut [RowHistory],
) {
    let n0 = pair.normal_load_n;
    let mut limit = vec![pair.friction_coefficient * n0; SAMPLES];
    if let Some(normal) = places[0] {
        let row = &mut sector[normal];
        for (j, limit) in limit.iter_mut().enumerate() {
            let closing = pair.normal_stiffness_n_per_m * (row.oscillation[j] + row.mean);
            row.force[j] = closing;
            if law == ContactLaw::Simplified3d {
                row.force[j] = closing.max(-n0);
                *limit = pair.friction_coefficient * (n0 + row.force[j]);
            }
        }
    }
    let with_friction = if law == ContactLaw::MacroSlip1d { 1 } else { 2 };
    for place in places[1..=with_friction].iter().flatten() {
        let row = &mut sector[*place];
        let kt = pair.tangential_stiffness_n_per_m;
        let (mut before, mut force) = (0.0, 0.0);
        for step in 0..3 * SAMPLES {
            let j = step % SAMPLES;
            force = (force + kt * (row.oscillation[j] - before)).clamp(-limit[j], limit[j]);
            before = row.oscillation[j];
            row.force[j] = force;
        }
    }
}

/// Norm of the residual relative to the excitation, from marched forces projected by an FFT.
fn marched_residual(wheel: &Wheel, solved: &Solved) -> f64 {
    let rows = march(wheel, solved);
    let stuck = {
        let springs = springs(wheel.law, wheel.sector);
        wheel.model.contact.springs([
            springs.normal_n_per_m,
            springs.tangential_1_n_per_m,
            springs.tangential_2_n_per_m,
        ])
    };
    let normal: Vec<usize> = wheel
        .model
        .contact
        .rows
        .iter()
        .filter_map(|row| row[0])
        .collect();
    let fft = FftPlanner::new().plan_fft_forward(SAMPLES);
    let spectra: Vec<Vec<Complex64>> = rows
        .iter()
        .map(|row| {
            let mut spectrum: Vec<Complex64> = row.force.iter().map(|&f| f.into()).collect();
            fft.process(&mut spectrum);
            spectrum
        })
        .collect();
    let mut square = 0.0;
    for (index, block) in solved.system.blocks().iter().enumerate() {
        let k = block.harmonic as usize;
        let k_omega = k as f64 * solved.omega;
        let forces: Vec<Complex64> = (0..rows.len())
            .map(|row| {
                let in_sector = row % stuck.len();
                match k {
                    // A tangential mean is no matter of the law: its force is that of the spring.
                    0 if !normal.contains(&in_sector) => (stuck[in_sector] * rows[row].mean).into(),
                    0 => spectra[row][0] / SAMPLES as f64,
                    _ => spectra[row][k] * (2.0 / SAMPLES as f64),
                }
            })
            .collect();
        let contact = contact_rows(&block.structure).adjoint_times_vector(&forces);
        let x = amplitudes(&solved.system, index, &solved.x);
        for (mode, &lambda) in block.structure.eigenvalues().iter().enumerate() {
            let damping = match (k, wheel.damping) {
                (0, _) => 0.0,
                (_, Damping::StructuralLossFactor(eta)) => eta * lambda,
                (_, Damping::ModalRatio(zeta)) => 2.0 * zeta * lambda.sqrt() * k_omega,
                (
                    _,
                    Damping::Rayleigh {
                        mass_per_s,
                        stiffness_s,
                    },
                ) => (mass_per_s + stiffness_s * lambda) * k_omega,
            };
            let z = Complex64::new(lambda - k_omega * k_omega, damping);
            let force = if k == 1 {
                solved.system.force()[mode]
            } else {
                Complex64::default()
            };
            square += (z * x[mode] + contact[mode] - force).norm_sqr();
        }
    }
    let excitation: f64 = solved.system.force().iter().map(Complex64::norm_sqr).sum();
    (square / excitation).sqrt()
}

/// Work of the excitation per period, and what structure and contact dissipate.
fn energies(wheel: &Wheel, solved: &Solved) -> [f64; 3] {
    let system = &solved.system;
    let response = amplitudes(system, system.fundamental(), &solved.x);
    let input: f64 = system
        .force()
        .iter()
        .zip(response)
        .map(|(f, x)| PI * (f * x.conj()).im)
        .sum();
    let mut structure = 0.0;
    for (index, block) in system.blocks().iter().enumerate() {
        let k = f64::from(block.harmonic);
        if block.harmonic == 0 {
            continue;
        }
        let x = amplitudes(system, index, &solved.x);
        block
            .structure
            .for_each_damping(k * solved.omega, |i, j, d| {
                structure += PI * k * d * (x[i].conj() * x[j]).re;
            });
    }
    let contact = march(wheel, solved)
        .iter()
        .flat_map(|row| row.force.iter().zip(&row.velocity))
        .map(|(force, velocity)| force * velocity * TAU / SAMPLES as f64)
        .sum();
    [input, structure, contact]
}

/// Points of friction at work: wheel, tuned or not, harmonics, load and frequency.
fn points() -> Vec<(Wheel, bool, &'static [u32], f64, f64)> {
    let lumped = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    let wheel8 = Wheel::wheel8();
    let mut points = Vec::new();
    for harmonics in SETS {
        for tuned in [true, false] {
            points.push((wheel8.clone(), tuned, harmonics, 300.0, 614.0));
        }
    }
    for tuned in [true, false] {
        points.push((lumped.clone(), tuned, SETS[1], 50.0, 350.0));
    }
    // Clapping contact.
    points.push((wheel8.clone(), true, SETS[2], 100.0, 612.8));
    for damping in DAMPINGS {
        let wheel = Wheel {
            damping,
            ..wheel8.clone()
        };
        points.push((wheel, true, SETS[1], 400.0, 615.0));
    }
    points
}

#[test]
fn what_the_excitation_puts_in_is_dissipated() {
    let mut random = Random(8);
    for (wheel, tuned, harmonics, load, frequency) in points() {
        let excited = excited(&wheel, tuned, harmonics, &mut random);
        let solved = converge(&wheel, &excited, load, frequency);
        let [input, structure, contact] = energies(&wheel, &solved);
        let error = ((structure + contact) / input - 1.0).abs();
        let share = contact / input;
        println!("{harmonics:?} {load} N: contact takes {share:.3}, imbalance {error:.1e}");
        assert!(share > 0.01, "friction dissipates: {share}");
        assert!(
            error < 1e-10,
            "{harmonics:?} {load} N {frequency} Hz: {error:e}"
        );
    }
}

#[test]
fn marching_the_contact_in_time_gives_no_residual_either() {
    let mut random = Random(9);
    for (wheel, tuned, harmonics, load, frequency) in points() {
        if !tuned && !matches!(wheel.damping, Damping::StructuralLossFactor(_)) {
            // The modes of a mistuned wheel do not diagonalise viscous damping.
            continue;
        }
        let excited = excited(&wheel, tuned, harmonics, &mut random);
        let solved = converge(&wheel, &excited, load, frequency);
        let residual = marched_residual(&wheel, &solved);
        println!("{harmonics:?} {load} N: {residual:.1e}");
        assert!(
            residual < 1e-10,
            "{harmonics:?} {load} N {frequency} Hz: {residual:e}"
        );
    }
}
