//! The harmonic balance equation of a wheel, or of one travelling wave, and its derivative.
//!
//! On the stuck base, for every harmonic k of the set,
//!
//! ```text
//! R_k(x) = (Z(k omega) + C^H k_c C) x_k + C^H G_k(C x) - f_k,     G = F - k_c C x
//! ```
//!
//! with G the correction of the contact force to that of the stuck springs, evaluated in time and
//! projected back (alternating frequency/time, Cameron & Griffin 1989). The unknowns are real, in the order of
//! [`super::harmonic_blocks`]. The residual is measured relative to the excitation in M-orthonormal coordinates.

use std::sync::Arc;

use super::HarmonicBlock;
use super::active_rows::ActiveRows;
use super::equivalent_contact::equivalent_springs;
use super::harmonic_blocks::HarmonicBlocks;
use super::linear_part::LinearPart;
use crate::linalg::Complex64;
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::HarmonicTransform;
use crate::response::harmonic_balance::pairs::{
    ContactInterface, ContactShares, InterfaceForces, InterfaceWorkspace, PairContact,
};

/// The nonlinear equation at any frequency.
#[derive(Debug, Clone)]
pub struct HarmonicSystem {
    pub(in crate::response::harmonic_balance) linear: LinearPart,
    pub(in crate::response::harmonic_balance) contact: InterfaceForces,
}

/// Buffers of one thread for one [`HarmonicSystem`].
#[derive(Debug)]
pub struct SystemWorkspace {
    pub(in crate::response::harmonic_balance) contact: InterfaceWorkspace,
    /// `k_c d + G`, of displacement and correction at the contact rows.
    contact_force: Vec<f64>,
    /// Contact rows of the pairs that slip or separate.
    pub(super) active: ActiveRows,
    /// The full viscous damping times the unknowns of one harmonic.
    damped: Vec<f64>,
}

impl SystemWorkspace {
    /// From now on derivatives of pairs are those of so many leading coefficients, and of every other harmonic by
    /// itself, see [`crate::response::harmonic_balance::PairHarmonics::couple_first`].
    pub(in crate::response::harmonic_balance) fn couple_first(&mut self, coefficients: usize) {
        self.contact.pairs.couple_first(coefficients);
    }
}

impl HarmonicSystem {
    /// Assembles a system. `force` is the modal force of harmonic 1 (`n_modes` of its structure).
    ///
    /// # Panics
    /// If the set lacks harmonic 1 or disagrees with `transform`, a defect of the caller.
    #[must_use]
    pub fn new(
        blocks: Vec<HarmonicBlock>,
        force: Vec<Complex64>,
        interface: ContactInterface,
        transform: Arc<HarmonicTransform>,
    ) -> Self {
        assert_eq!(
            blocks.len(),
            transform.harmonics().len(),
            "one block per harmonic"
        );
        let linear = LinearPart::new(HarmonicBlocks::new(blocks), force);
        let rows = linear.blocks.contact_rows();
        Self {
            linear,
            contact: InterfaceForces::new(interface, transform, rows),
        }
    }

    /// Copy of this system with `pairs`, which have another normal load.
    #[must_use]
    pub fn with_pairs(&self, pairs: Vec<PairParameters>) -> Self {
        let mut system = self.clone();
        system.contact.interface.pairs = pairs;
        system
    }

    /// Copy of this system with all tangential contact springs multiplied by `factor`, in the law and in the stuck
    /// base.
    #[must_use]
    pub fn with_tangential_stiffness(&self, factor: f64) -> Self {
        let mut system = self.clone();
        for pair in &mut system.contact.interface.pairs {
            pair.tangential_stiffness_n_per_m *= factor;
        }
        let springs = self.contact.interface.stuck_springs(factor);
        system.linear.blocks.set_springs(&springs);
        system
    }

    /// Number of real unknowns.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.linear.blocks.unknowns()
    }

    /// The harmonics with their structures.
    #[must_use]
    pub fn blocks(&self) -> &[HarmonicBlock] {
        self.linear.blocks.as_slice()
    }

    /// First unknown of the block at `index`.
    #[must_use]
    pub fn block_start(&self, index: usize) -> usize {
        self.linear.blocks.unknowns_of(index..index).start
    }

    /// Place of harmonic 1 among the blocks.
    #[must_use]
    pub fn fundamental(&self) -> usize {
        self.linear.blocks.fundamental()
    }

    /// Modal force of harmonic 1.
    #[must_use]
    pub fn force(&self) -> &[Complex64] {
        &self.linear.force
    }

    /// Norm of the modal force: the size that residuals are relative to.
    #[must_use]
    pub fn force_norm(&self) -> f64 {
        self.linear.force_norm
    }

    /// Pair parameters of one sector, or of the whole wheel where sectors differ.
    #[must_use]
    pub fn pairs(&self) -> &[PairParameters] {
        &self.contact.interface.pairs
    }

    /// Drift of the ring along its rigid motions (rotation, axial), m per period: zero at first.
    #[must_use]
    pub fn ring_drift_m(&self) -> [f64; 2] {
        self.contact.ring_drift_m
    }

    /// Sets the drift of the ring.
    pub fn set_ring_drift(&mut self, drift_m: [f64; 2]) {
        self.contact.ring_drift_m = drift_m;
    }

    /// Rigid motions of the ring that nothing but friction holds.
    #[must_use]
    pub fn free_ring_motions(&self) -> [bool; 2] {
        self.contact.interface.geometry.ring_free
    }

    /// Buffers for this system.
    #[must_use]
    pub fn workspace(&self) -> SystemWorkspace {
        let coefficients = self.contact.transform.n_coefficients();
        let largest = self.linear.blocks.largest();
        SystemWorkspace {
            contact: self.contact.workspace(),
            contact_force: vec![0.0; coefficients * self.contact.rows],
            active: ActiveRows::new(self.contact.rows * largest),
            damped: vec![0.0; 2 * largest],
        }
    }

    /// Residual at `x` into `residual`; returns its norm relative to the excitation and the
    /// shares of slipping and separated pairs. With `derivative`, the pair Jacobians are kept in
    /// the workspace for [`Self::jacobian`].
    pub fn residual(
        &self,
        omega: f64,
        x: &[f64],
        residual: &mut [f64],
        derivative: bool,
        workspace: &mut SystemWorkspace,
    ) -> (f64, ContactShares) {
        self.linear
            .residual(omega, x, residual, &mut workspace.damped);
        let shares = if self.contact.rows > 0 {
            let shares = self.contact_at(x, derivative, workspace);
            let blocks = &self.linear.blocks;
            let InterfaceWorkspace {
                displacement,
                correction,
                ..
            } = &workspace.contact;
            if blocks.are_shared() {
                let force = &mut workspace.contact_force;
                blocks.add_shared_force(displacement, correction, force, residual);
            } else if shares != ContactShares::default() {
                blocks.add_contact_force(correction, residual);
            }
            shares
        } else {
            ContactShares::default()
        };
        let norm = residual.iter().map(|r| r * r).sum::<f64>().sqrt();
        (norm / self.force_norm(), shares)
    }

    /// The contact at `x`, without the residual: motions and corrections are left in the workspace; with `derivative`
    /// the pair Jacobians too.
    pub(in crate::response::harmonic_balance) fn contact_at(
        &self,
        x: &[f64],
        derivative: bool,
        workspace: &mut SystemWorkspace,
    ) -> ContactShares {
        self.contact_displacement(x, &mut workspace.contact.displacement);
        self.contact.correct(derivative, &mut workspace.contact)
    }

    /// Coefficients of the motions at the contact rows, `C x`.
    pub(in crate::response::harmonic_balance) fn contact_displacement(
        &self,
        x: &[f64],
        displacement: &mut [f64],
    ) {
        self.linear.blocks.contact_displacement(x, displacement);
    }

    /// The linear response with every pair stuck, harmonic 1 and nothing else; none if it has none.
    #[must_use]
    pub fn stuck_response(&self, omega: f64) -> Option<Vec<f64>> {
        self.linear.stuck_response(omega)
    }

    /// `dR/domega` at `x` into `derivative`, per rad/s.
    pub fn frequency_derivative(&self, omega: f64, x: &[f64], derivative: &mut [f64]) {
        self.linear.frequency_derivative(omega, x, derivative);
    }

    /// Complex spring of every contact row at the solution `x`, N/m: real part the stiffness, imaginary part the energy
    /// dissipated per radian over the square of the displacement. Length: rows of the system, sector after sector.
    #[must_use]
    pub fn equivalent_springs(&self, x: &[f64], workspace: &mut SystemWorkspace) -> Vec<Complex64> {
        let rows = self.contact.rows;
        if rows == 0 {
            return Vec::new();
        }
        self.contact_at(x, false, workspace);
        let place = self.linear.blocks.coefficients()[self.fundamental()];
        let fundamental = place * rows..(place + 2) * rows;
        equivalent_springs(
            &self.contact.interface.stuck_springs(1.0),
            &workspace.contact.displacement[fundamental.clone()],
            &workspace.contact.correction[fundamental],
        )
    }

    /// State of every pair at the unknowns `x`, sector by sector, in each the pairs in the order of the
    /// model.
    #[must_use]
    pub fn contact_states(&self, x: &[f64], workspace: &mut SystemWorkspace) -> Vec<PairContact> {
        self.contact_displacement(x, &mut workspace.contact.displacement);
        self.contact.states(&mut workspace.contact)
    }

    /// Mean friction force on the ring at `x` per sector, N, averaged over the sectors: along theta
    /// (the torque over the mean contact radius) and along z, see
    /// [`crate::model::cyclic::ContactGeometry::ring_motion`].
    ///
    /// It is caused by the displacements without their tangential means; a ring that is locked
    /// against rotation and axial motion hands it on to what locks it.
    #[must_use]
    pub fn mean_friction_n(&self, x: &[f64], workspace: &mut SystemWorkspace) -> [f64; 2] {
        if workspace.contact.active.is_empty() {
            return [0.0; 2];
        }
        self.contact_displacement(x, &mut workspace.contact.displacement);
        self.contact.mean_friction_n(&mut workspace.contact)
    }
}

#[cfg(test)]
pub(in crate::response::harmonic_balance) mod tests {
    use super::*;
    use crate::linalg::Matrix;
    use crate::model::cyclic::ContactGeometry;
    use crate::response::friction::ContactLaw;
    use crate::response::harmonic_balance::Damping;
    use crate::response::harmonic_balance::equation::Structure;
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

    #[test]
    fn the_jacobian_is_the_difference_of_residuals() {
        let change = 1e-7;
        for law in ContactLaw::ALL {
            for harmonics in [&[1][..], &[1, 3], &[0, 1, 2]] {
                let system = system(law, harmonics, 64);
                let x = state(&system);
                let n = x.len();
                let mut workspace = system.workspace();
                let mut residual = vec![0.0; n];
                let (_, shares) = system.residual(OMEGA, &x, &mut residual, true, &mut workspace);
                assert!((0.3..1.0).contains(&shares.slipping), "{law:?}: {shares:?}");
                let mut jacobian = vec![0.0; n * n];
                system.jacobian(OMEGA, &mut workspace, &mut jacobian);
                for (at, column) in jacobian.chunks_exact(n).enumerate() {
                    let mut difference = vec![0.0; n];
                    for sign in [1.0, -1.0] {
                        let mut moved = x.clone();
                        moved[at] += sign * change;
                        system.residual(OMEGA, &moved, &mut residual, false, &mut workspace);
                        for (sum, r) in difference.iter_mut().zip(&residual) {
                            *sum += sign * r / (2.0 * change);
                        }
                    }
                    for (i, (exact, found)) in difference.iter().zip(column).enumerate() {
                        assert!(
                            (exact - found).abs() < 1e-6,
                            "{law:?} {harmonics:?}: {at} {i}"
                        );
                    }
                }
            }
        }
    }
}
