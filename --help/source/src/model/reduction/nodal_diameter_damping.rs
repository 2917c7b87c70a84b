//! Damping of the tuned contact-free modes by nodal diameter, besides that of the structure.
//!
//! With `phi_r` the M-orthonormal modes of nodal diameter h and `omega_r^2` their eigenvalues,
//!
//! ```text
//! C_h = M (sum_r c_r phi_r phi_r^H) M,    c_r = 2 zeta_h s_r omega_r
//! ```
//!
//! `s_r` is 1, or the share of the mode's strain energy that its blade holds, `phi_r^H K_blade phi_r /
//! omega_r^2`: a force on the blades that does the work `4 pi zeta_h U_blade` per cycle damps mode r by
//! `zeta_h U_blade / U`. Over the wheel this is block circulant, and mistuning leaves it as it is.

use serde::{Deserialize, Serialize};

use crate::linalg::{Complex64, HermitianSparse, Matrix};

/// Which modes of a nodal diameter are damped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampedModes {
    /// Each mode by the share `s_r` of its strain energy in the blade.
    #[default]
    Blade,
    /// All alike: `s_r = 1`.
    All,
}

/// Damping ratios by nodal diameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NodalDiameterDamping {
    /// Ratio `zeta_h` of nodal diameters 0, 1, ...; those beyond the last one have none.
    pub ratios: Vec<f64>,
    /// Which modes they damp.
    pub modes: DampedModes,
}

impl NodalDiameterDamping {
    /// `c_r` of the modes of nodal diameter h with these eigenvalues, 1/s. `shapes` are the modes over the
    /// dofs of `blade_stiffness`, `n_dofs x n_modes`.
    #[must_use]
    pub(super) fn of_modes(
        &self,
        h: usize,
        eigenvalues: &[f64],
        shapes: &Matrix<Complex64>,
        blade_stiffness: impl Fn() -> HermitianSparse,
    ) -> Vec<f64> {
        let zeta = self.ratios.get(h).copied().unwrap_or(0.0);
        if zeta == 0.0 {
            return vec![0.0; eigenvalues.len()];
        }
        let loaded = match self.modes {
            DampedModes::Blade => Some(blade_stiffness().times(shapes)),
            DampedModes::All => None,
        };
        let share = |mode: usize, lambda: f64| match &loaded {
            None => 1.0,
            Some(loaded) => {
                let pairs = shapes.column(mode).iter().zip(loaded.column(mode));
                let energy: f64 = pairs.map(|(u, f)| (u.conj() * f).re).sum();
                energy / lambda
            }
        };
        let rate = |(mode, &lambda): (usize, &f64)| {
            // A motion without stiffness has no ratio of damping.
            if lambda > 0.0 {
                2.0 * zeta * share(mode, lambda) * lambda.sqrt()
            } else {
                0.0
            }
        };
        eigenvalues.iter().enumerate().map(rate).collect()
    }
}
