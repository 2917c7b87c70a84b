//! The harmonic balance equation of a wheel, or of one travelling wave, and its derivative.
//!
//! On the stuck base, for every harmonic k of the set,
//!
//! ```text
//! R_k(x) = (Z(k omega) + C^H k_c C) x_k + C^H G_k(C x) - f_k,     G = F - k_c C x
//! ```
//!
//! with G the correction of the contact force to that of the stuck springs, evaluated in time and
//! projected back (alternating frequency/time, Cameron & Griffin 1989). Unknowns are real: for
//! harmonic 0 the modal coordinates, for every other harmonic first the real, then the imaginary
//! parts. The residual is measured relative to the excitation in M-orthonormal coordinates.

use std::sync::Arc;

use super::HarmonicBlock;
use crate::linalg::{
    Complex64, Matrix, add_times, add_times_vector, add_transpose_times, add_transpose_times_vector,
};
use crate::response::friction::{ContactLaw, PairParameters};
use crate::response::harmonic_balance::HarmonicTransform;
use crate::response::harmonic_balance::pairs::{
    ContactInterface, ContactShares, MacroSlipPairs, PairHarmonics, PairJacobian,
    Simplified3dPairs, WheelPairs,
};

/// The nonlinear equation at any frequency.
#[derive(Debug, Clone)]
pub struct HarmonicSystem {
    pub(in crate::response::harmonic_balance) blocks: Vec<HarmonicBlock>,
    /// First unknown of each block, and the number of unknowns at the end.
    pub(in crate::response::harmonic_balance) start: Vec<usize>,
    /// First real coefficient of each block.
    pub(in crate::response::harmonic_balance) coefficient: Vec<usize>,
    pub(super) force: Vec<Complex64>,
    force_norm: f64,
    pub(in crate::response::harmonic_balance) interface: ContactInterface,
    pub(in crate::response::harmonic_balance) transform: Arc<HarmonicTransform>,
    /// Number of contact rows over all sectors.
    pub(in crate::response::harmonic_balance) rows: usize,
    /// Whether all harmonics have the same real matrices, those of a wheel: the unknowns are then one matrix
    /// with a column per real coefficient.
    pub(super) shared: bool,
    /// Drift of the ring along its rigid motions, m per period.
    ring_drift_m: [f64; 2],
}

/// Buffers of one thread for one [`HarmonicSystem`].
#[derive(Debug)]
pub struct SystemWorkspace {
    pub(in crate::response::harmonic_balance) pairs: PairHarmonics,
    /// Displacement and correction at the contact rows, coefficient after coefficient (`n_coefficients x rows`).
    pub(in crate::response::harmonic_balance) displacement: Vec<f64>,
    pub(in crate::response::harmonic_balance) correction: Vec<f64>,
    /// `k_c d + G`, of both.
    contact_force: Vec<f64>,
    pub(in crate::response::harmonic_balance) pair_input: Vec<f64>,
    pub(super) pair_output: Vec<f64>,
    /// Of every pair, once a derivative was asked for: they are large.
    pub(in crate::response::harmonic_balance) jacobians: Vec<PairJacobian>,
    pub(in crate::response::harmonic_balance) active: Vec<bool>,
    /// Pairs that are evaluated side by side.
    pub(super) together: Option<MacroSlipPairs>,
    pub(super) together_3d: Option<Simplified3dPairs>,
    /// Whether a pair separates.
    pub(in crate::response::harmonic_balance) separated: bool,
    /// Contact rows of the active pairs; those of them that have a correction; then `dG/dd C`.
    pub(super) active_rows: Vec<f64>,
    pub(super) left_rows: Vec<f64>,
    pub(super) loaded_rows: Vec<f64>,
    /// The full viscous damping times the unknowns of one harmonic.
    pub(super) damped: Vec<f64>,
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
        let mut start = vec![0];
        let mut coefficient = Vec::new();
        let (mut unknowns, mut coefficients) = (0, 0);
        for block in &blocks {
            let parts = if block.harmonic == 0 { 1 } else { 2 };
            coefficient.push(coefficients);
            coefficients += parts;
            unknowns += parts * block.size();
            start.push(unknowns);
        }
        let force_norm = force.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        let rows = blocks[0].structure.contact().real.rows();
        let shared = blocks.iter().all(|block| {
            Arc::ptr_eq(&block.structure, &blocks[0].structure)
                && Arc::ptr_eq(&block.stuck, &blocks[0].stuck)
                && block.structure.contact().imaginary.is_none()
                && block.stuck.imaginary.is_none()
        });
        Self {
            blocks,
            start,
            coefficient,
            force,
            force_norm,
            interface,
            transform,
            rows,
            shared,
            ring_drift_m: [0.0; 2],
        }
    }

    /// Number of real unknowns.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.start[self.blocks.len()]
    }

    /// The harmonics with their structures.
    #[must_use]
    pub fn blocks(&self) -> &[HarmonicBlock] {
        &self.blocks
    }

    /// First unknown of the block at `index`.
    #[must_use]
    pub fn block_start(&self, index: usize) -> usize {
        self.start[index]
    }

    /// Place of harmonic 1 among the blocks.
    #[must_use]
    pub fn fundamental(&self) -> usize {
        self.blocks
            .iter()
            .position(|block| block.harmonic == 1)
            .unwrap_or(0)
    }

    /// Modal force of harmonic 1.
    #[must_use]
    pub fn force(&self) -> &[Complex64] {
        &self.force
    }

    /// Norm of the modal force: the size that residuals are relative to.
    #[must_use]
    pub fn force_norm(&self) -> f64 {
        self.force_norm
    }

    /// Pair parameters of one sector, or of the whole wheel where sectors differ.
    #[must_use]
    pub fn pairs(&self) -> &[PairParameters] {
        &self.interface.pairs
    }

    /// Drift of the ring along its rigid motions (rotation, axial), m per period: zero at first.
    #[must_use]
    pub fn ring_drift_m(&self) -> [f64; 2] {
        self.ring_drift_m
    }

    /// Sets the drift of the ring.
    pub fn set_ring_drift(&mut self, drift_m: [f64; 2]) {
        self.ring_drift_m = drift_m;
    }

    /// Rigid motions of the ring that nothing but friction holds.
    #[must_use]
    pub fn free_ring_motions(&self) -> [bool; 2] {
        self.interface.geometry.ring_free
    }

    /// Buffers for this system.
    #[must_use]
    pub fn workspace(&self) -> SystemWorkspace {
        let coefficients = self.transform.n_coefficients();
        let sector_rows = self.interface.geometry.row_count().max(1);
        let pairs = self.interface.per_sector() * (self.rows / sector_rows);
        let largest = self
            .blocks
            .iter()
            .map(|block| block.structure.size())
            .max()
            .unwrap_or(0);
        SystemWorkspace {
            pairs: PairHarmonics::new(self.interface.law, Arc::clone(&self.transform)),
            displacement: vec![0.0; coefficients * self.rows],
            correction: vec![0.0; coefficients * self.rows],
            contact_force: vec![0.0; coefficients * self.rows],
            pair_input: vec![0.0; 3 * coefficients],
            pair_output: vec![0.0; 3 * coefficients],
            jacobians: Vec::new(),
            active: vec![false; pairs],
            together: None,
            together_3d: None,
            separated: false,
            active_rows: vec![0.0; self.rows * largest],
            left_rows: vec![0.0; self.rows * largest],
            loaded_rows: vec![0.0; self.rows * largest],
            damped: vec![0.0; 2 * largest],
        }
    }

    /// [`Self::workspace`] for derivatives of every harmonic by itself, see [`PairHarmonics::couple_first`].
    pub(in crate::response::harmonic_balance) fn decoupled_workspace(&self) -> SystemWorkspace {
        let mut workspace = self.workspace();
        workspace.pairs.couple_first(0);
        workspace
    }

    /// Number of contact rows over all sectors.
    pub(in crate::response::harmonic_balance) fn contact_row_count(&self) -> usize {
        self.rows
    }

    /// Whether all harmonics have the same real matrices.
    pub(in crate::response::harmonic_balance) fn is_shared(&self) -> bool {
        self.shared
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
        self.linear_part(omega, x, residual, &mut workspace.damped);
        let shares = if self.rows > 0 {
            self.contact_displacement(x, &mut workspace.displacement);
            let shares = self.contact_correction(derivative, workspace);
            if self.shared {
                self.add_shared_force(workspace, residual);
            } else if shares != ContactShares::default() {
                self.add_contact_force(&workspace.correction, residual);
            }
            shares
        } else {
            ContactShares::default()
        };
        let norm = residual.iter().map(|r| r * r).sum::<f64>().sqrt();
        (norm / self.force_norm, shares)
    }

    /// Coefficients of `C x`.
    pub(in crate::response::harmonic_balance) fn contact_displacement(
        &self,
        x: &[f64],
        displacement: &mut [f64],
    ) {
        displacement.fill(0.0);
        if self.shared {
            let rows = &self.blocks[0].structure.contact().real;
            let size = (rows.rows(), x.len() / rows.columns().max(1), rows.columns());
            add_times(displacement, rows.as_slice(), x, size);
            return;
        }
        for link in self.links() {
            let x = &x[link.unknown..link.unknown + link.size];
            let d = &mut displacement[link.coefficient * self.rows..][..self.rows];
            add_times_vector(d, link.sign, link.rows.as_slice(), x);
        }
    }

    /// `residual += C^H G`, where harmonics have matrices of their own.
    fn add_contact_force(&self, correction: &[f64], residual: &mut [f64]) {
        for link in self.links() {
            let r = &mut residual[link.unknown..link.unknown + link.size];
            let g = &correction[link.coefficient * self.rows..][..self.rows];
            add_transpose_times_vector(r, link.sign, link.rows.as_slice(), g);
        }
    }

    /// `residual += C^T (k_c d + G)`, where all harmonics have the same matrices.
    fn add_shared_force(&self, workspace: &mut SystemWorkspace, residual: &mut [f64]) {
        let block = &self.blocks[0];
        let columns = workspace.displacement.chunks_exact(self.rows);
        let corrections = workspace.correction.chunks_exact(self.rows);
        let forces = workspace.contact_force.chunks_exact_mut(self.rows);
        for ((force, displacement), correction) in forces.zip(columns).zip(corrections) {
            let springs = block.stuck.springs.iter();
            let both = displacement.iter().zip(correction);
            for ((force, spring), (d, g)) in force.iter_mut().zip(springs).zip(both) {
                *force = spring * d + g;
            }
        }
        let rows = &block.structure.contact().real;
        let (n, count) = (rows.columns(), residual.len() / rows.columns().max(1));
        let forces = &workspace.contact_force;
        let size = (n, count, self.rows);
        add_transpose_times(residual, n, 1.0, rows.as_slice(), forces, size);
    }

    /// Coefficients of the displacement of one pair into `pair_input`, and its drift.
    pub(in crate::response::harmonic_balance) fn gather_pair(
        &self,
        pair: usize,
        workspace: &mut SystemWorkspace,
    ) {
        let coefficients = self.transform.n_coefficients();
        let per_sector = self.interface.per_sector();
        let base = pair / per_sector * self.interface.geometry.row_count();
        // The relative displacement is that of the blisk less that of the ring.
        let [rotation, axial] = self.interface.geometry.ring_motion[pair % per_sector];
        let [by_rotation, by_axial] = self.ring_drift_m;
        let drift = [0, 1].map(|k| -(rotation[k] * by_rotation + axial[k] * by_axial));
        workspace.pairs.set_drift(drift);
        workspace.pair_input.fill(0.0);
        let places = &self.interface.geometry.rows[pair % per_sector];
        for (direction, place) in places.iter().enumerate() {
            if let Some(row) = *place {
                for c in 0..coefficients {
                    workspace.pair_input[direction * coefficients + c] =
                        workspace.displacement[c * self.rows + base + row];
                }
            }
        }
    }

    /// The laws, pair by pair: displacement coefficients to correction coefficients.
    pub(in crate::response::harmonic_balance) fn contact_correction(
        &self,
        derivative: bool,
        workspace: &mut SystemWorkspace,
    ) -> ContactShares {
        workspace.correction.fill(0.0);
        if derivative && workspace.jacobians.is_empty() {
            let zero = PairJacobian::new(self.transform.n_coefficients());
            workspace.jacobians = vec![zero; workspace.active.len()];
        }
        if let Some(shares) = self.correction_side_by_side(derivative, workspace) {
            workspace.separated = shares.separated > 0.0;
            return shares;
        }
        let coefficients = self.transform.n_coefficients();
        let per_sector = self.interface.per_sector();
        let sector_rows = self.interface.geometry.row_count();
        let (mut slipping, mut separated, mut unclosed) = (0_usize, 0_usize, 0_usize);
        let count = workspace.active.len();
        for pair in 0..count {
            let base = pair / per_sector * sector_rows;
            let places = self.interface.geometry.rows[pair % per_sector];
            self.gather_pair(pair, workspace);
            let state = workspace.pairs.evaluate(
                self.interface.pair(pair),
                &workspace.pair_input,
                &mut workspace.pair_output,
                workspace.jacobians.get_mut(pair).filter(|_| derivative),
            );
            slipping += usize::from(state.slipping);
            separated += usize::from(state.separated);
            unclosed += usize::from(state.unclosed);
            workspace.active[pair] = state.slipping || state.separated;
            if workspace.active[pair] {
                for (direction, place) in places.iter().enumerate() {
                    if let Some(row) = *place {
                        for c in 0..coefficients {
                            workspace.correction[c * self.rows + base + row] =
                                workspace.pair_output[direction * coefficients + c];
                        }
                    }
                }
            }
        }
        workspace.separated = separated > 0;
        ContactShares {
            slipping: slipping as f64 / count as f64,
            separated: separated as f64 / count as f64,
            unclosed: unclosed as f64 / count as f64,
        }
    }

    /// The corrections of all pairs at once; none where the law has no such form, or the ring drifts.
    fn correction_side_by_side(
        &self,
        derivative: bool,
        workspace: &mut SystemWorkspace,
    ) -> Option<ContactShares> {
        let law = self.interface.law;
        if self.ring_drift_m.iter().any(|drift| drift.abs() > 0.0) {
            return None;
        }
        let count = workspace.active.len();
        let wheel = &mut WheelPairs {
            interface: &self.interface,
            rows: self.rows,
            displacement: &workspace.displacement,
            correction: &mut workspace.correction,
            one: &mut workspace.pairs,
            active: &mut workspace.active,
            jacobians: &mut workspace.jacobians,
        };
        match law {
            ContactLaw::MacroSlip1d | ContactLaw::MacroSlip2d => {
                let together = workspace.together.get_or_insert_with(|| {
                    MacroSlipPairs::new(law.tangents() * count, &self.transform)
                });
                Some(together.correct(derivative, wheel))
            }
            ContactLaw::Simplified3d => {
                let together = workspace
                    .together_3d
                    .get_or_insert_with(|| Simplified3dPairs::new(count, &self.transform));
                Some(together.correct(derivative, wheel))
            }
            ContactLaw::Coulomb3d => None,
        }
    }

    /// How the real unknowns enter the real coefficients of the contact displacement:
    /// `Re d = Re C Re x - Im C Im x`, `Im d = Re C Im x + Im C Re x`.
    pub(super) fn links(&self) -> Vec<Link<'_>> {
        let mut links = Vec::new();
        for (index, block) in self.blocks.iter().enumerate() {
            let size = block.structure.size();
            let (unknown, coefficient) = (self.start[index], self.coefficient[index]);
            let contact = block.structure.contact();
            let mut link = |from: usize, to: usize, sign: f64, rows| {
                links.push(Link {
                    unknown: unknown + from * size,
                    size,
                    coefficient: coefficient + to,
                    sign,
                    rows,
                });
            };
            link(0, 0, 1.0, &contact.real);
            if block.harmonic > 0 {
                link(1, 1, 1.0, &contact.real);
                if let Some(imaginary) = &contact.imaginary {
                    link(1, 0, -1.0, imaginary);
                    link(0, 1, 1.0, imaginary);
                }
            }
        }
        links
    }
}

/// One real block of the map from unknowns to contact coefficients.
pub(super) struct Link<'a> {
    pub(super) unknown: usize,
    pub(super) size: usize,
    pub(super) coefficient: usize,
    pub(super) sign: f64,
    pub(super) rows: &'a Matrix<f64>,
}
