//! The tuned wheel with linear contact springs, one nodal diameter at a time.
//!
//! In the contact-free modes of nodal diameter h, at the angular frequency s,
//!
//! ```text
//! Z_h(s) = D_h(s) + C_h^H k_c C_h,    D_h(s) = diag(lambda (1 + i eta) + i s c - s^2)
//! ```
//!
//! with the contact rows C and the springs `k_c` of the contact, which are not damped. Harmonic 0 is static and has no
//! damping. D is diagonal under every damping model, so that systems with Z are as small as the contact (`factored_stiffness.rs`).

use crate::linalg::{Complex64, Matrix, hermitian_eigen};
use crate::model::ReducedNodalDiameter;
use crate::response::harmonic_balance::Damping;

use super::factored_stiffness::FactoredStiffness;

/// Steps of the iteration for a pole at most.
const POLE_STEPS: usize = 12;
/// Relative step at which a pole is known, and at which it is near enough to divide by zero there.
const POLE_TOLERANCE: f64 = 1e-13;
const NEARLY: f64 = 1e-6;

/// One nodal diameter, 0..=N/2, in its contact-free modes.
#[derive(Debug)]
pub(super) struct TunedDiameter {
    eigenvalues: Vec<f64>,
    /// Viscous damping of every mode, 1/s.
    viscous: Vec<f64>,
    loss_factor: f64,
    /// Relative motion at the contact rows, `c x n`; no row where there are no springs.
    pub(super) contact: Matrix<Complex64>,
    /// Displacement of the observed node, `3 x n`.
    pub(super) observed: Matrix<Complex64>,
    /// Springs of the contact rows, N/m.
    springs: Vec<f64>,
    /// Waves of the wheel that it stands for: 1 for a standing one, else 2.
    pub(super) waves: usize,
    /// Undamped angular frequencies, rad/s, ascending, and their modes, `n x n`.
    pub(super) natural: (Vec<f64>, Matrix<Complex64>),
}

/// A damped mode: `Z(s_j) x = 0`, `y^H Z(s_j) = 0`; near it `Z^-1(s) = x y^H / ((y^H Z'(s_j) x) (s - s_j))`.
#[derive(Debug, Clone)]
pub(super) struct Pole {
    pub(super) s: Complex64,
    /// `x / (y^H Z' x)`.
    pub(super) right: Vec<Complex64>,
    /// `y`.
    pub(super) left: Vec<Complex64>,
}

impl TunedDiameter {
    /// A nodal diameter of `model` with `springs` at its contact rows; none if its modes are not found.
    pub(super) fn new(
        wave: &ReducedNodalDiameter,
        springs: &[f64],
        damping: Damping,
        waves: usize,
    ) -> Option<Self> {
        let of_mode = |lambda: f64| match damping {
            Damping::StructuralLossFactor(_) => 0.0,
            Damping::ModalRatio(zeta) => 2.0 * zeta * lambda.max(0.0).sqrt(),
            Damping::Rayleigh {
                mass_per_s,
                stiffness_s,
            } => mass_per_s + stiffness_s * lambda,
        };
        let added = &wave.added_damping_per_s;
        let viscous = wave.eigenvalues.iter().zip(added);
        let contact = if springs.is_empty() {
            Matrix::zeros(0, wave.contact.columns())
        } else {
            wave.contact.clone()
        };
        let sprung = Matrix::from_fn(contact.rows(), contact.columns(), |i, j| {
            contact[(i, j)] * springs[i]
        });
        let mut stiffness = contact.adjoint_times(&sprung);
        for (mode, &lambda) in wave.eigenvalues.iter().enumerate() {
            stiffness[(mode, mode)] += lambda;
        }
        let (eigenvalues, modes) = hermitian_eigen(&stiffness).ok()?;
        let natural = eigenvalues.iter().map(|lambda| lambda.max(0.0).sqrt());
        Some(Self {
            viscous: viscous
                .map(|(&lambda, added)| of_mode(lambda) + added)
                .collect(),
            loss_factor: match damping {
                Damping::StructuralLossFactor(eta) => eta,
                Damping::ModalRatio(_) | Damping::Rayleigh { .. } => 0.0,
            },
            eigenvalues: wave.eigenvalues.clone(),
            contact,
            observed: wave.observed.clone(),
            springs: springs.to_vec(),
            waves,
            natural: (natural.collect(), modes),
        })
    }

    /// Number of modes.
    pub(super) fn size(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Contact-free eigenvalues, (rad/s)^2.
    pub(super) fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// Viscous damping of every contact-free mode, 1/s.
    pub(super) fn viscous(&self) -> &[f64] {
        &self.viscous
    }

    /// Number of contact rows with springs: all or none.
    pub(super) fn spring_count(&self) -> usize {
        self.springs.len()
    }

    /// Springs of the contact rows, N/m.
    pub(super) fn springs(&self) -> &[f64] {
        &self.springs
    }

    /// The motions at the contact, where there are springs, then `strain`, then those of the observed node.
    pub(super) fn motions(&self, strain: &Matrix<Complex64>) -> Matrix<Complex64> {
        let contact = self.springs.len();
        let shapes = strain.rows();
        Matrix::from_fn(contact + shapes + 3, self.size(), |i, j| {
            if i < contact {
                self.contact[(i, j)]
            } else if i < contact + shapes {
                strain[(i - contact, j)]
            } else {
                self.observed[(i - contact - shapes, j)]
            }
        })
    }

    /// How far every mode answers a force at the contact, or at the observed node of a wheel without springs, at most in a band
    /// of angular frequencies.
    pub(super) fn free_answers(&self, band: (f64, f64)) -> Vec<f64> {
        let rows = if self.springs.is_empty() {
            &self.observed
        } else {
            &self.contact
        };
        (0..self.size())
            .map(|mode| {
                let force = rows
                    .column(mode)
                    .iter()
                    .map(Complex64::norm_sqr)
                    .sum::<f64>();
                let nearest = self.eigenvalues[mode].max(0.0).sqrt().clamp(band.0, band.1);
                let stiffness = self.free(Complex64::from(nearest))[mode].norm();
                force.sqrt() / stiffness.max(f64::MIN_POSITIVE)
            })
            .collect()
    }

    /// `D(s)`.
    fn free(&self, s: Complex64) -> Vec<Complex64> {
        let stiffness = Complex64::new(1.0, self.loss_factor);
        let modes = self.eigenvalues.iter().zip(&self.viscous);
        modes
            .map(|(&lambda, &rate)| stiffness * lambda + Complex64::i() * s * rate - s * s)
            .collect()
    }

    /// `D'(s)`.
    fn free_slope(&self, s: Complex64) -> Vec<Complex64> {
        let rates = self.viscous.iter();
        rates.map(|&rate| Complex64::i() * rate - s * 2.0).collect()
    }

    /// `v^H D(s) v`, its imaginary part: the damping of an undamped mode.
    pub(super) fn damping_of(&self, mode: usize) -> f64 {
        let omega = self.natural.0[mode];
        let shape = self.natural.1.column(mode).iter();
        let damped = self.eigenvalues.iter().zip(&self.viscous);
        let of_mode = damped.map(|(lambda, rate)| self.loss_factor * lambda + omega * rate);
        shape.zip(of_mode).map(|(v, d)| v.norm_sqr() * d).sum()
    }

    /// `E Z(s)^-1 F^H` with the motions E, a row each, of which the first are the contact rows where there are springs, and the
    /// first `inputs` of them, F; beside the factors of Z. None if Z is singular.
    pub(super) fn receptance(
        &self,
        s: f64,
        motions: &Matrix<Complex64>,
        inputs: usize,
    ) -> Option<(FactoredStiffness<'_>, Matrix<Complex64>)> {
        if s > 0.0 {
            let free = self.free(Complex64::from(s));
            return FactoredStiffness::with_receptance(self.sprung(), &free, motions, inputs);
        }
        // Harmonic 0, in which a body may be free.
        let factored = FactoredStiffness::of_whole(self.sprung(), &self.eigenvalues)?;
        let leading: Vec<usize> = (0..inputs).collect();
        let columns = factored.solve(motions.select_rows(&leading).adjoint());
        Some((factored, motions.times(&columns)))
    }

    /// `Z(s)`, factorised; none where it is singular.
    fn factored(&self, s: Complex64) -> Option<FactoredStiffness<'_>> {
        FactoredStiffness::of_diagonal(self.sprung(), &self.free(s))
    }

    /// Contact rows and their springs.
    fn sprung(&self) -> (&Matrix<Complex64>, &[f64]) {
        (&self.contact, &self.springs)
    }

    /// The damped mode near an undamped one, by Rayleigh quotients of both sides (Schwetlick & Schreiber 2012, Linear
    /// Algebra Appl. 436(10)); none where the iteration does not converge.
    pub(super) fn pole(&self, mode: usize) -> Option<Pole> {
        let omega = self.natural.0[mode];
        let mut right: Vec<Complex64> = self.natural.1.column(mode).to_vec();
        let mut left = right.clone();
        let mut s = Complex64::new(omega, 0.5 * self.damping_of(mode) / omega);
        let mut last = f64::INFINITY;
        for _ in 0..POLE_STEPS {
            let slope = self.free_slope(s);
            let moved: Vec<Complex64> = right.iter().zip(&slope).map(|(x, d)| x * d).collect();
            let left_moved: Vec<Complex64> =
                left.iter().zip(&slope).map(|(y, d)| y * d.conj()).collect();
            let factored = self.factored(s);
            let new_right = factored.as_ref().map(|z| z.solve(column(&moved)));
            let new_left = factored
                .as_ref()
                .map(|z| z.solve_adjoint(column(&left_moved)));
            let finite =
                |vector: &Matrix<Complex64>| vector.as_slice().iter().all(|x| x.is_finite());
            let (Some(new_right), Some(new_left)) =
                (new_right.filter(finite), new_left.filter(finite))
            else {
                // At the pole itself nothing can be solved for.
                return (last <= NEARLY * s.norm()).then(|| self.pole_of(s, right, left));
            };
            (right, left) = (new_right.column(0).to_vec(), new_left.column(0).to_vec());
            // y^H Z(s) x, of which Z(s) x is known.
            let residual = product(&left, &moved);
            let curved: Vec<Complex64> = right.iter().zip(&slope).map(|(x, d)| x * d).collect();
            let step = residual / product(&left, &curved);
            for vector in [&mut right, &mut left] {
                let norm = vector.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
                for entry in vector.iter_mut() {
                    *entry /= norm;
                }
            }
            s -= step;
            if !s.is_finite() {
                return None;
            }
            last = step.norm();
            if last <= POLE_TOLERANCE * s.norm() {
                return Some(self.pole_of(s, right, left));
            }
        }
        None
    }

    fn pole_of(&self, s: Complex64, right: Vec<Complex64>, left: Vec<Complex64>) -> Pole {
        let slope = self.free_slope(s);
        let curved: Vec<Complex64> = right.iter().zip(&slope).map(|(x, d)| x * d).collect();
        let scale = product(&left, &curved);
        let right = right.into_iter().map(|entry| entry / scale).collect();
        Pole { s, right, left }
    }

    /// `E Z(s)^-1 f` of the motions E; of the conjugate wave `N - h`, whose matrices are the conjugate ones of a reciprocal
    /// sector, where `conjugate`.
    pub(super) fn response(
        &self,
        s: f64,
        motions: &Matrix<Complex64>,
        force: &[Complex64],
        conjugate: bool,
    ) -> Option<Vec<Complex64>> {
        let factored = self.factored(Complex64::from(s))?;
        if !conjugate {
            let response = factored.solve(column(force));
            return Some(motions.times_vector(response.column(0)));
        }
        let force: Vec<Complex64> = force.iter().map(Complex64::conj).collect();
        let response = factored.solve_adjoint(column(&force));
        let response = motions.times_vector(response.column(0));
        Some(response.iter().map(Complex64::conj).collect())
    }
}

/// A vector as a matrix of one column.
fn column(vector: &[Complex64]) -> Matrix<Complex64> {
    Matrix::from_fn(vector.len(), 1, |i, _| vector[i])
}

/// `y^H x`.
fn product(left: &[Complex64], right: &[Complex64]) -> Complex64 {
    left.iter().zip(right).map(|(y, x)| y.conj() * x).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::LuWorkspace;

    fn diameter(damping: Damping) -> TunedDiameter {
        with_springs(damping, &[0.7, 0.2, 0.0])
    }

    fn with_springs(damping: Damping, springs: &[f64]) -> TunedDiameter {
        let number = |place: usize| {
            let turn = 0.3 + 1.7 * place as f64 + 0.01 * (place * place) as f64;
            Complex64::new(turn.sin(), (1.3 * turn).cos())
        };
        let modes = 7;
        let wave = ReducedNodalDiameter {
            eigenvalues: (0..modes).map(|i| 1.0 + 3.0 * i as f64).collect(),
            added_damping_per_s: (0..modes).map(|i| 0.003 * i as f64).collect(),
            contact: Matrix::from_fn(3, modes, |i, j| number(10 * i + j)),
            observed: Matrix::from_fn(3, modes, |i, j| number(100 + 10 * i + j)),
            force: Matrix::zeros(modes, 1),
            conjugate_force: Matrix::zeros(modes, 1),
        };
        TunedDiameter::new(&wave, springs, damping, 2).expect("modes")
    }

    fn dampings() -> [Damping; 3] {
        [
            Damping::StructuralLossFactor(0.02),
            Damping::ModalRatio(0.01),
            Damping::Rayleigh {
                mass_per_s: 0.01,
                stiffness_s: 0.002,
            },
        ]
    }

    /// `Z(s)`.
    fn stiffness(diameter: &TunedDiameter, s: Complex64) -> Matrix<Complex64> {
        let sprung = Matrix::from_fn(diameter.springs.len(), diameter.size(), |i, j| {
            diameter.contact[(i, j)] * diameter.springs[i]
        });
        let mut z = diameter.contact.adjoint_times(&sprung);
        for (mode, d) in diameter.free(s).into_iter().enumerate() {
            z[(mode, mode)] += d;
        }
        z
    }

    #[test]
    fn receptances_are_those_of_the_whole_matrix() {
        for damping in dampings() {
            let diameter = diameter(damping);
            let motions = Matrix::from_fn(6, 7, |i, j| {
                if i < 3 {
                    diameter.contact[(i, j)]
                } else {
                    diameter.observed[(i - 3, j)]
                }
            });
            for s in [0.5, 1.9, 3.3] {
                let (_, found) = diameter.receptance(s, &motions, 6).expect("regular");
                let z = stiffness(&diameter, Complex64::from(s));
                let mut lu = LuWorkspace::<Complex64>::new(7);
                lu.matrix_mut().copy_from_slice(z.as_slice());
                assert!(lu.factor());
                let mut columns = motions.adjoint();
                lu.solve_columns(&mut columns);
                let whole = motions.times(&columns);
                for (a, b) in found.as_slice().iter().zip(whole.as_slice()) {
                    assert!((a - b).norm() < 1e-11 * b.norm().max(1.0), "{a} {b}");
                }
                let force: Vec<Complex64> = motions.adjoint().column(4).to_vec();
                let response = diameter
                    .response(s, &motions, &force, false)
                    .expect("regular");
                for (i, value) in response.iter().enumerate() {
                    assert!((value - whole[(i, 4)]).norm() < 1e-11 * value.norm().max(1.0));
                }
            }
        }
    }

    #[test]
    fn poles_are_zeros_of_the_matrix_and_their_residues_those_of_its_inverse() {
        let with = dampings().map(diameter);
        let without = dampings().map(|damping| with_springs(damping, &[]));
        for diameter in with.into_iter().chain(without) {
            for mode in 0..7 {
                let pole = diameter.pole(mode).expect("a pole");
                assert!(pole.s.im > 0.0, "{}", pole.s);
                let z = stiffness(&diameter, pole.s);
                let left = z.times_vector(&pole.right);
                let size = pole.right.iter().map(|x| x.norm()).fold(0.0, f64::max);
                assert!(left.iter().all(|r| r.norm() < 1e-9 * size));
                // The inverse near the pole, less the pole, stays bounded.
                let near = pole.s + Complex64::new(1e-5, 0.0);
                let mut lu = LuWorkspace::<Complex64>::new(7);
                lu.matrix_mut()
                    .copy_from_slice(stiffness(&diameter, near).as_slice());
                assert!(lu.factor());
                for j in 0..7 {
                    let mut column = vec![Complex64::default(); 7];
                    column[j] = Complex64::from(1.0);
                    lu.solve(&mut column);
                    for (i, whole) in column.iter().enumerate() {
                        let part = pole.right[i] * pole.left[j].conj() / (near - pole.s);
                        assert!(
                            (whole - part).norm() < 1e-2 * part.norm() + 30.0,
                            "{whole} {part}"
                        );
                    }
                }
            }
        }
    }
}
