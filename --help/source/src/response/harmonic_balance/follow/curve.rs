//! The harmonic balance equation with frequency as a further unknown, bordered to a square matrix.
//!
//! ```text
//! u = (x / X, omega / W),    DR = (X dR/dx, W dR/domega),    A = (DR; c^T)
//! ```
//!
//! relative to the excitation. The kernel of `DR` is that of `A t = (0, 1)`, the shortest step
//! `DR^+ R` any solution of `A v = (R, 0)` less its part along t.

use crate::linalg::LuWorkspace;
use crate::response::harmonic_balance::equation::{HarmonicSystem, SystemWorkspace};
use crate::response::harmonic_balance::pairs::ContactShares;
use crate::response::harmonic_balance::solver::Equation;

/// `R(u) = 0` with one unknown more than equations; residuals have a zero at the end.
pub(super) struct Curve<'a> {
    system: &'a HarmonicSystem,
    workspace: SystemWorkspace,
    /// Factors of `(DR; c^T)`.
    pub(super) factors: LuWorkspace<f64>,
    pub(super) factored: bool,
    pub(super) state_scale: f64,
    pub(super) frequency_scale: f64,
    /// The solution without its scale.
    pub(super) x: Vec<f64>,
    /// The border c.
    pub(super) border: Vec<f64>,
    /// Kernel of `DR` at the last linearisation, not of unit length.
    pub(super) kernel: Vec<f64>,
    /// Sign of `det (DR; t^T)` along the walk.
    pub(super) orientation: f64,
}

impl<'a> Curve<'a> {
    /// The curve of a system in the sizes X and W of the unknowns.
    pub(super) fn new(system: &'a HarmonicSystem, state_scale: f64, frequency_scale: f64) -> Self {
        let n = system.unknowns();
        let mut border = vec![0.0; n + 1];
        border[n] = 1.0;
        Self {
            system,
            workspace: system.workspace(),
            factors: LuWorkspace::new(n + 1),
            factored: false,
            state_scale,
            frequency_scale,
            x: vec![0.0; n],
            border,
            kernel: vec![0.0; n + 1],
            orientation: 0.0,
        }
    }

    /// Takes the scale off; returns the frequency.
    fn unscale(&mut self, u: &[f64]) -> f64 {
        for (x, u) in self.x.iter_mut().zip(u) {
            *x = self.state_scale * u;
        }
        self.frequency_scale * u[u.len() - 1]
    }

    /// Fills `factors` with `(X dR/dx, W dR/domega; c^T)` relative to the excitation.
    fn fill_bordered(&mut self, omega: f64) {
        let n = self.x.len();
        let matrix = self.factors.matrix_mut();
        self.system
            .jacobian(omega, &mut self.workspace, &mut matrix[..n * n]);
        let state = self.state_scale / self.system.force_norm();
        for column in (0..n).rev() {
            matrix.copy_within(column * n..(column + 1) * n, column * (n + 1));
            let column_entries = &mut matrix[column * (n + 1)..][..=n];
            for entry in column_entries.iter_mut() {
                *entry *= state;
            }
            column_entries[n] = self.border[column];
        }
        let last = &mut matrix[n * (n + 1)..];
        self.system
            .frequency_derivative(omega, &self.x, &mut last[..n]);
        let frequency = self.frequency_scale / self.system.force_norm();
        for entry in last.iter_mut() {
            *entry *= frequency;
        }
        last[n] = self.border[n];
    }
}

impl Equation for Curve<'_> {
    fn residual(&mut self, u: &[f64], residual: &mut [f64]) -> (f64, ContactShares) {
        let n = self.x.len();
        let omega = self.unscale(u);
        let (norm, shares) = self.system.residual(
            omega,
            &self.x,
            &mut residual[..n],
            false,
            &mut self.workspace,
        );
        for r in residual.iter_mut() {
            *r /= self.system.force_norm();
        }
        residual[n] = 0.0;
        (norm, shares)
    }

    fn linearise(&mut self, u: &[f64], residual: &mut [f64]) -> bool {
        let n = self.x.len();
        let omega = self.unscale(u);
        self.system.residual(
            omega,
            &self.x,
            &mut residual[..n],
            true,
            &mut self.workspace,
        );
        for r in residual.iter_mut() {
            *r /= self.system.force_norm();
        }
        residual[n] = 0.0;
        self.fill_bordered(omega);
        self.factored = self.factors.factor();
        if self.factored {
            self.kernel.fill(0.0);
            self.kernel[n] = 1.0;
            self.factors.solve(&mut self.kernel);
            self.factored = self.kernel.iter().all(|t| t.is_finite());
        }
        self.factored
    }

    fn is_linearised(&self) -> bool {
        self.factored
    }

    /// The shortest solution of `DR v = R`: any solution less its part along the kernel.
    fn step(&mut self, residual: &mut [f64]) {
        self.factors.solve(residual);
        let along = dot(residual, &self.kernel) / dot(&self.kernel, &self.kernel);
        for (v, t) in residual.iter_mut().zip(&self.kernel) {
            *v -= along * t;
        }
    }
}

/// The curve with its frequency held: the border is `omega` alone.
pub(super) struct AtFrequency<'a, 'b>(&'a mut Curve<'b>);

impl<'a, 'b> AtFrequency<'a, 'b> {
    /// Holds the frequency from now on; factors of the free curve do not serve.
    pub(super) fn new(curve: &'a mut Curve<'b>) -> Self {
        let n = curve.x.len();
        curve.border.fill(0.0);
        curve.border[n] = 1.0;
        curve.factored = false;
        Self(curve)
    }
}

impl Equation for AtFrequency<'_, '_> {
    fn residual(&mut self, u: &[f64], residual: &mut [f64]) -> (f64, ContactShares) {
        self.0.residual(u, residual)
    }

    fn linearise(&mut self, u: &[f64], residual: &mut [f64]) -> bool {
        self.0.linearise(u, residual)
    }

    fn is_linearised(&self) -> bool {
        self.0.factored
    }

    fn step(&mut self, residual: &mut [f64]) {
        self.0.factors.solve(residual);
    }
}

/// Inner product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Euclidean distance.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}
