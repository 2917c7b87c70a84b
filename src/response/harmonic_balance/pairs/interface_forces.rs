//! The contact forces of a wheel: motions at its contact rows in, corrections of the forces out, in harmonics.
//!
//! ```text
//! G(d) = F(d) - k_c d
//! ```
//!
//! is the correction of the contact force F to that of the stuck springs, evaluated in time and projected back
//! (alternating frequency/time, Cameron & Griffin 1989).

use std::sync::Arc;

use super::{
    ContactInterface, ContactShares, MacroSlipPairs, PairHarmonics, PairJacobian,
    Simplified3dPairs, WheelPairs,
};
use crate::response::friction::SideBySide;
use crate::response::harmonic_balance::HarmonicTransform;

/// The contact pairs of a wheel under their law.
#[derive(Debug, Clone)]
pub(in crate::response::harmonic_balance) struct InterfaceForces {
    pub(in crate::response::harmonic_balance) interface: ContactInterface,
    pub(in crate::response::harmonic_balance) transform: Arc<HarmonicTransform>,
    /// Number of contact rows over all sectors.
    pub(in crate::response::harmonic_balance) rows: usize,
    /// Drift of the ring along its rigid motions (rotation, axial), m per period: zero at first.
    pub(in crate::response::harmonic_balance) ring_drift_m: [f64; 2],
}

/// Buffers of one thread for one [`InterfaceForces`].
#[derive(Debug)]
pub(in crate::response::harmonic_balance) struct InterfaceWorkspace {
    pub(in crate::response::harmonic_balance) pairs: PairHarmonics,
    /// Displacement and correction at the contact rows, coefficient after coefficient (`n_coefficients x rows`).
    pub(in crate::response::harmonic_balance) displacement: Vec<f64>,
    pub(in crate::response::harmonic_balance) correction: Vec<f64>,
    pub(in crate::response::harmonic_balance) pair_input: Vec<f64>,
    pub(super) pair_output: Vec<f64>,
    /// Of every pair, once a derivative was asked for: they are large.
    pub(in crate::response::harmonic_balance) jacobians: Vec<PairJacobian>,
    /// Whether a pair slips or separates.
    pub(in crate::response::harmonic_balance) active: Vec<bool>,
    /// Pairs that are evaluated side by side.
    together: Option<MacroSlipPairs>,
    together_3d: Option<Simplified3dPairs>,
    /// Whether a pair separates.
    pub(in crate::response::harmonic_balance) separated: bool,
}

impl InterfaceForces {
    /// The contact `interface` of a wheel with so many contact `rows`, with the ring at rest.
    pub(in crate::response::harmonic_balance) fn new(
        interface: ContactInterface,
        transform: Arc<HarmonicTransform>,
        rows: usize,
    ) -> Self {
        Self {
            interface,
            transform,
            rows,
            ring_drift_m: [0.0; 2],
        }
    }

    /// Buffers for these forces.
    pub(in crate::response::harmonic_balance) fn workspace(&self) -> InterfaceWorkspace {
        let coefficients = self.transform.n_coefficients();
        let sector_rows = self.interface.geometry.row_count().max(1);
        let pairs = self.interface.per_sector() * (self.rows / sector_rows);
        InterfaceWorkspace {
            pairs: PairHarmonics::new(self.interface.law, Arc::clone(&self.transform)),
            displacement: vec![0.0; coefficients * self.rows],
            correction: vec![0.0; coefficients * self.rows],
            pair_input: vec![0.0; 3 * coefficients],
            pair_output: vec![0.0; 3 * coefficients],
            jacobians: Vec::new(),
            active: vec![false; pairs],
            together: None,
            together_3d: None,
            separated: false,
        }
    }

    /// Coefficients of the displacement of one pair into `pair_input`, and its drift.
    pub(in crate::response::harmonic_balance) fn gather_pair(
        &self,
        pair: usize,
        workspace: &mut InterfaceWorkspace,
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
    pub(in crate::response::harmonic_balance) fn correct(
        &self,
        derivative: bool,
        workspace: &mut InterfaceWorkspace,
    ) -> ContactShares {
        workspace.correction.fill(0.0);
        if derivative && workspace.jacobians.is_empty() {
            let zero = PairJacobian::new(self.transform.n_coefficients());
            workspace.jacobians = vec![zero; workspace.active.len()];
        }
        if let Some(shares) = self.correct_side_by_side(derivative, workspace) {
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
    fn correct_side_by_side(
        &self,
        derivative: bool,
        workspace: &mut InterfaceWorkspace,
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
        match law.side_by_side() {
            SideBySide::VariableLimit => {
                let together = workspace
                    .together_3d
                    .get_or_insert_with(|| Simplified3dPairs::new(count, &self.transform));
                Some(together.correct(derivative, wheel))
            }
            SideBySide::ConstantLimit => {
                let together = workspace.together.get_or_insert_with(|| {
                    MacroSlipPairs::new(law.tangents() * count, &self.transform)
                });
                Some(together.correct(derivative, wheel))
            }
            SideBySide::No => None,
        }
    }
}
