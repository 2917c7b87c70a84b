//! Newton's step of a wheel with few contact rows, by an equation in the contact forces alone.
//!
//! With `S_k = Z(k omega) + C^T k_c C` the linear part of harmonic k, and G' the derivative of the corrections of the
//! contact forces by the relative motions, the Jacobian is `J = S + C^T G' C`, and exactly
//!
//! ```text
//! J^-1 r = v - A y,    v = S^-1 r,    A_k = S_k^-1 C^T,    R_k = C A_k,
//! (I + G' R) y = G' C v
//! ```
//!
//! (Sherman, Morrison & Woodbury). The unknowns y are as many as coefficients of contact rows that have a correction;
//! S has no coupling of harmonics and is factored once a frequency. Residual and judgement are those of the whole
//! equation.

use std::sync::Arc;

use super::contact_couplings::ContactCouplings;
use super::linear_factors::LinearFactors;
use crate::linalg::{LuWorkspace, add_times};
use crate::response::harmonic_balance::equation::{
    ContactStiffnessMatrix, HarmonicSystem, Structure, SystemWorkspace,
};

/// Factors of J by contact forces.
#[derive(Default)]
pub(in crate::response::harmonic_balance) struct CondensedJacobian {
    /// Matrices of the linear parts at hand.
    of: Option<(Arc<Structure>, Arc<ContactStiffnessMatrix>)>,
    pub(super) linear: Vec<LinearFactors>,
    couplings: ContactCouplings,
    /// Factors of `I + G' R`, coefficient after coefficient, in each row after row of contact.
    factors: Option<LuWorkspace<f64>>,
    pub(super) motion: Vec<f64>,
    forces: Vec<f64>,
    room: Vec<f64>,
    /// Residual that a motion of every row amounts to at most, 1/m.
    pub(super) stiffness: Vec<f64>,
}

impl CondensedJacobian {
    /// Factors J at the point last given to [`HarmonicSystem::residual`] with derivative; false if it is singular.
    pub(in crate::response::harmonic_balance) fn factor(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &SystemWorkspace,
    ) -> bool {
        if !self.factor_linear(system, omega) {
            return false;
        }
        self.couplings.gather(&system.contact, &workspace.contact);
        let count = system.contact.transform.n_coefficients();
        let size = count * self.couplings.rows.len();
        if size == 0 {
            self.factors = None;
            return true;
        }
        if self.factors.as_ref().is_none_or(|f| f.dimension() != size) {
            self.factors = Some(LuWorkspace::new(size));
        }
        let Some(factors) = &mut self.factors else {
            return false;
        };
        let matrix = factors.matrix_mut();
        matrix.fill(0.0);
        (0..size).for_each(|i| matrix[i * size + i] = 1.0);
        self.couplings.add_times(&self.linear, matrix);
        factors.factor()
    }

    /// Factors S and finds R, unless those at hand are the same; false if S is singular.
    pub(in crate::response::harmonic_balance) fn factor_linear(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
    ) -> bool {
        let block = &system.blocks()[0];
        let same = self.of.as_ref().is_some_and(|(structure, stuck)| {
            Arc::ptr_eq(structure, &block.structure) && Arc::ptr_eq(stuck, &block.stuck)
        });
        if !same {
            let stuck = block
                .structure
                .contact_coordinates()
                .stuck(&block.stuck.springs);
            let stuck = Arc::new(stuck);
            let places = system
                .blocks()
                .iter()
                .zip(system.linear.blocks.coefficients());
            self.linear = places
                .map(|(block, &at)| LinearFactors::new(block, Arc::clone(&stuck), at))
                .collect();
            self.of = Some((Arc::clone(&block.structure), Arc::clone(&block.stuck)));
            self.stiffness = residual_of_motion(system);
        }
        let parts = self.linear.iter_mut().zip(system.blocks());
        parts.fold(true, |regular, (part, block)| {
            let at_hand = part.at.is_some_and(|at| at.total_cmp(&omega).is_eq());
            (at_hand || part.factor(block, omega, system.force())) && regular
        })
    }

    /// `J^-1 residual`, in place.
    pub(in crate::response::harmonic_balance) fn solve(&mut self, residual: &mut [f64]) {
        let Some((structure, _)) = &self.of else {
            return;
        };
        let contact = &structure.contact().real;
        let (m, n) = (contact.rows(), contact.columns());
        let mut rest = &mut *residual;
        for part in &mut self.linear {
            let (of_part, beyond) = rest.split_at_mut(part.parts * n);
            part.solve(of_part);
            rest = beyond;
        }
        let columns = residual.len() / n;
        self.motion.clear();
        self.motion.resize(m * columns, 0.0);
        add_times(
            &mut self.motion,
            contact.as_slice(),
            residual,
            (m, columns, n),
        );
        self.answer(columns);
        self.each_harmonic(residual, &self.motion, |part, residual, forces| {
            part.add_attached(residual, -1.0, forces);
        });
    }

    /// y of `motion`, into its place: at all rows, coefficient after coefficient.
    pub(super) fn answer(&mut self, columns: usize) {
        let m = self.motion.len() / columns;
        let Some(factors) = &mut self.factors else {
            self.motion.fill(0.0);
            return;
        };
        self.forces.clear();
        self.forces.resize(factors.dimension(), 0.0);
        self.couplings.add_to(&mut self.forces, &self.motion, m);
        factors.solve_small(&mut self.forces, &mut self.room);
        self.motion.fill(0.0);
        let rows = &self.couplings.rows;
        let coefficients = self.motion.chunks_exact_mut(m);
        for (motion, forces) in coefficients.zip(self.forces.chunks_exact(rows.len())) {
            for (&row, force) in rows.iter().zip(forces) {
                motion[row] = *force;
            }
        }
    }

    /// Parts of `x` and of `forces` that belong to the same harmonic.
    pub(super) fn each_harmonic(
        &self,
        x: &mut [f64],
        forces: &[f64],
        mut visit: impl FnMut(&LinearFactors, &mut [f64], &[f64]),
    ) {
        let coefficients: usize = self.linear.iter().map(|part| part.parts).sum();
        let (width, rows) = (x.len() / coefficients, forces.len() / coefficients);
        let mut rest = x;
        for part in &self.linear {
            let (of_part, beyond) = rest.split_at_mut(part.parts * width);
            let forces = &forces[part.coefficient * rows..][..part.parts * rows];
            visit(part, of_part, forces);
            rest = beyond;
        }
    }

    /// `forces -= y` with the last y.
    pub(in crate::response::harmonic_balance) fn subtract_answer(&self, forces: &mut [f64]) {
        for (force, y) in forces.iter_mut().zip(&self.motion) {
            *force -= y;
        }
    }

    /// `x = S^-1 f - A forces`.
    pub(in crate::response::harmonic_balance) fn response_of(
        &self,
        system: &HarmonicSystem,
        forces: &[f64],
    ) -> Vec<f64> {
        let mut x = vec![0.0; system.unknowns()];
        self.each_harmonic(&mut x, forces, |part, x, forces| part.response(forces, x));
        x
    }

    /// `left = motion - C (S^-1 f - A forces)`.
    pub(in crate::response::harmonic_balance) fn motion_left(
        &self,
        motion: &[f64],
        forces: &[f64],
        left: &mut [f64],
    ) {
        left.copy_from_slice(motion);
        self.each_harmonic(left, forces, |part, left, forces| {
            for (left, alone) in left.iter_mut().zip(&part.motion) {
                *left -= alone;
            }
            part.add_motion(left, 1.0, forces);
        });
    }

    /// The residual that a motion amounts to at most, relative to the excitation.
    pub(in crate::response::harmonic_balance) fn force_of(&self, motion: &[f64]) -> f64 {
        let columns = motion.chunks_exact(self.stiffness.len());
        let forces = columns.flat_map(|column| column.iter().zip(&self.stiffness));
        let square: f64 = forces.map(|(motion, k)| (k * motion).powi(2)).sum();
        square.sqrt()
    }

    /// `(I + R G')^-1 left`, in place.
    pub(in crate::response::harmonic_balance) fn solve_motion(&mut self, left: &mut [f64]) {
        self.motion.clear();
        self.motion.extend_from_slice(left);
        self.answer(self.linear.iter().map(|part| part.parts).sum());
        self.each_harmonic(left, &self.motion, |part, left, forces| {
            part.add_motion(left, -1.0, forces);
        });
    }
}

/// What a motion of every contact row changes the residual by at most, relative to the excitation, 1/m: its correction
/// changes by no more than its spring times the motion.
fn residual_of_motion(system: &HarmonicSystem) -> Vec<f64> {
    let contact = &system.blocks()[0].structure.contact().real;
    let square = contact.times(&contact.adjoint());
    let sum = |i: usize| -> f64 { (0..square.columns()).map(|j| square[(i, j)].abs()).sum() };
    // |C^T|^2, the largest eigenvalue of C C^T, is at most this.
    let largest = (0..square.rows()).map(sum).fold(0.0, f64::max);
    let springs = system.blocks()[0].stuck.springs.iter();
    springs
        .map(|spring| spring * largest.sqrt() / system.force_norm())
        .collect()
}

#[cfg(test)]
pub(in crate::response::harmonic_balance) mod tests {
    use super::*;
    use crate::linalg::{Complex64, Matrix};
    use crate::model::cyclic::ContactGeometry;
    use crate::response::friction::{ContactLaw, PairParameters};
    use crate::response::harmonic_balance::equation::HarmonicBlock;
    use crate::response::harmonic_balance::pairs::{ContactInterface, ContactShares};
    use crate::response::harmonic_balance::{Damping, HarmonicTransform};
    use crate::response::mistuning::{ModalRows, StructuralModes};

    pub(crate) const OMEGA: f64 = 1.1;
    const MODES: usize = 5;

    /// Five modes with damping between them, four pairs of which some have a normal row.
    pub(crate) fn system(law: ContactLaw, harmonics: &[usize], samples: usize) -> HarmonicSystem {
        let rows = |count, factor: f64| ModalRows {
            real: Matrix::from_fn(count, MODES, |i, j| {
                (factor * (1 + i + 3 * j + i * j) as f64).sin()
            }),
            imaginary: None,
        };
        let eigenvalues = vec![1.0, 3.5, 1.7, 9.0, 14.0];
        let structure = Arc::new(Structure::new(
            StructuralModes {
                tuned_eigenvalues: eigenvalues.iter().map(|lambda| 1.1 * lambda).collect(),
                eigenvalues,
                rotation: Some(Matrix::from_fn(MODES, MODES, |i, j| {
                    f64::from(u8::from(i == j)) + 0.2 * ((3 * i + j) as f64).cos()
                })),
                added_damping_per_s: vec![0.0; MODES],
                contact: rows(10, 1.0),
                observed: rows(3, 2.0),
                sectors: 2,
            },
            Damping::Rayleigh {
                mass_per_s: 0.02,
                stiffness_s: 0.01,
            },
        ));
        let stuck = Arc::new(structure.contact_stiffness(&[0.7, 0.9, 0.9, 0.6, 0.8]));
        let blocks = harmonics.iter().map(|&harmonic| HarmonicBlock {
            harmonic: harmonic as u32,
            structure: Arc::clone(&structure),
            stuck: Arc::clone(&stuck),
        });
        let pair = PairParameters {
            normal_load_n: 0.4,
            normal_stiffness_n_per_m: 0.7,
            tangential_stiffness_n_per_m: 0.9,
            friction_coefficient: 0.3,
        };
        let loads = [0.4, 0.0, 50.0, 0.2];
        let interface = ContactInterface {
            law,
            geometry: ContactGeometry {
                weights: vec![0.5; 2],
                load_weights: vec![0.5; 2],
                rows: vec![[Some(0), Some(1), Some(2)], [None, Some(3), Some(4)]],
                ring_motion: vec![[[0.0; 2]; 2]; 2],
                ring_free: [false; 2],
            },
            pairs: loads
                .map(|normal_load_n| PairParameters {
                    normal_load_n,
                    ..pair
                })
                .to_vec(),
        };
        let force: Vec<Complex64> = (0..MODES)
            .map(|i| Complex64::new(1.0, 0.3 * i as f64))
            .collect();
        let transform = HarmonicTransform::new(harmonics, samples).expect("enough samples");
        HarmonicSystem::new(blocks.collect(), force, interface, Arc::new(transform))
    }

    /// A state in which some pairs slip.
    pub(crate) fn state(system: &HarmonicSystem) -> Vec<f64> {
        let entry = |i: usize| 0.4 * (0.7 + 1.3 * i as f64).sin() / (1.0 + (i / 10) as f64);
        (0..system.unknowns()).map(entry).collect()
    }

    fn factored(
        system: &HarmonicSystem,
        x: &[f64],
    ) -> (CondensedJacobian, Vec<f64>, ContactShares) {
        let mut workspace = system.workspace();
        let mut residual = vec![0.0; x.len()];
        let (_, shares) = system.residual(OMEGA, x, &mut residual, true, &mut workspace);
        let mut whole = vec![0.0; x.len() * x.len()];
        system.jacobian(OMEGA, &mut workspace, &mut whole);
        let mut condensed = CondensedJacobian::default();
        assert!(condensed.factor(system, OMEGA, &workspace));
        (condensed, whole, shares)
    }

    #[test]
    fn the_step_by_contact_forces_is_that_of_the_whole_jacobian() {
        for law in ContactLaw::ALL {
            for harmonics in [&[1][..], &[1, 3], &[0, 1, 2]] {
                let system = system(law, harmonics, 64);
                let (mut condensed, whole, shares) = factored(&system, &state(&system));
                assert!((0.3..1.0).contains(&shares.slipping), "{law:?}: {shares:?}");
                let right = state(&system);
                let n = right.len();
                let mut step = right.clone();
                condensed.solve(&mut step);
                for (i, right) in right.iter().enumerate() {
                    let product: f64 = (0..n).map(|j| whole[j * n + i] * step[j]).sum();
                    assert!((product - right).abs() < 1e-11, "{law:?} {harmonics:?} {i}");
                }
            }
        }
    }

    #[test]
    fn the_step_by_contact_forces_undoes_a_small_one() {
        let change = 1e-7;
        for law in ContactLaw::ALL {
            let system = system(law, &[1, 3], 64);
            let x = state(&system);
            let (mut condensed, _, _) = factored(&system, &x);
            let mut workspace = system.workspace();
            for at in 0..x.len() {
                let mut difference = vec![0.0; x.len()];
                for sign in [1.0, -1.0] {
                    let mut moved = x.clone();
                    moved[at] += sign * change;
                    let mut residual = vec![0.0; x.len()];
                    system.residual(OMEGA, &moved, &mut residual, false, &mut workspace);
                    for (sum, r) in difference.iter_mut().zip(&residual) {
                        *sum += sign * r / (2.0 * change);
                    }
                }
                condensed.solve(&mut difference);
                for (i, step) in difference.iter().enumerate() {
                    let expected = f64::from(u8::from(i == at));
                    assert!((step - expected).abs() < 1e-6, "{law:?}: {at} {i} {step}");
                }
            }
        }
    }

    #[test]
    fn factors_of_other_frequencies_and_structures_are_not_taken_for_the_present_ones() {
        let system = system(ContactLaw::MacroSlip1d, &[1, 3], 64);
        let softer = system.with_tangential_stiffness(0.5);
        let x = state(&system);
        let mut kept = CondensedJacobian::default();
        for (system, omega) in [
            (&system, OMEGA),
            (&system, 1.3),
            (&softer, 1.3),
            (&system, 1.3),
        ] {
            let mut workspace = system.workspace();
            let mut residual = vec![0.0; x.len()];
            system.residual(omega, &x, &mut residual, true, &mut workspace);
            let mut fresh = CondensedJacobian::default();
            let steps = [&mut kept, &mut fresh].map(|condensed| {
                assert!(condensed.factor(system, omega, &workspace));
                let mut step = residual.clone();
                condensed.solve(&mut step);
                step
            });
            assert_eq!(steps[0], steps[1]);
        }
    }

    #[test]
    fn few_contact_rows_are_condensed_and_many_are_not() {
        // Ten rows on five modes.
        assert!(!system(ContactLaw::MacroSlip1d, &[1, 3], 64).condenses());
    }
}
