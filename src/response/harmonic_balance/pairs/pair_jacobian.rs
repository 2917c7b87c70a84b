//! The blocks of the derivative of a pair's force by its displacement, computed in `pair_harmonics.rs` and `clip_slopes.rs`.
//!
//! Under `coulomb_3d` it is computed in `coupled_derivative.rs`. Pairs under a constant normal load side by side have it from
//! `macro_slip_pairs.rs`.

/// Derivative of a pair's correction coefficients, N/m; every block is `n_coefficients *
/// n_coefficients`, row after row, a row per coefficient of the correction and a column per
/// coefficient of the displacement.
///
/// Blocks not listed are zero: normal by tangential.
#[derive(Debug, Clone, PartialEq)]
pub struct PairJacobian {
    /// Normal correction by normal displacement.
    pub normal_normal: Vec<f64>,
    /// Correction along t1 by displacement along t1, then t2 by t2.
    pub tangential_tangential: [Vec<f64>; 2],
    /// Correction along t1, then t2, by the normal displacement.
    pub tangential_normal: [Vec<f64>; 2],
    /// Correction along t1 by displacement along t2, then t2 by t1; none where the law leaves the
    /// tangents uncoupled.
    pub tangential_cross: Option<[Vec<f64>; 2]>,
}

impl PairJacobian {
    /// Zero blocks.
    #[must_use]
    pub fn new(n_coefficients: usize) -> Self {
        let zero = || vec![0.0; n_coefficients * n_coefficients];
        Self {
            normal_normal: zero(),
            tangential_tangential: [zero(), zero()],
            tangential_normal: [zero(), zero()],
            tangential_cross: None,
        }
    }

    /// Correction along one direction by displacement along another, of n, t1, t2; none where it is zero.
    pub(in crate::response::harmonic_balance) fn block(
        &self,
        along: usize,
        by: usize,
    ) -> Option<&[f64]> {
        match (along, by) {
            (0, 0) => Some(&self.normal_normal),
            (0, _) => None,
            (tangent, 0) => Some(&self.tangential_normal[tangent - 1]),
            (tangent, other) if tangent == other => Some(&self.tangential_tangential[tangent - 1]),
            (tangent, _) => self.tangential_cross.as_ref().map(|c| &*c[tangent - 1]),
        }
    }

    /// Sets every block to zero.
    pub fn clear(&mut self) {
        self.normal_normal.fill(0.0);
        self.tangential_tangential
            .iter_mut()
            .for_each(|block| block.fill(0.0));
        self.tangential_normal
            .iter_mut()
            .chain(self.tangential_cross.iter_mut().flatten())
            .for_each(|block| block.fill(0.0));
    }
}
