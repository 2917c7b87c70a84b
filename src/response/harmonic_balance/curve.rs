//! The harmonic balance equation with one parameter as a further unknown, bordered to a square matrix.
//!
//! The parameter p is the frequency, or the logarithm of the normal load.
//!
//! ```text
//! u = (x / X, p / W),    DR = (X dR/dx, W dR/dp),    A = (DR; c^T)
//! ```
//!
//! relative to the excitation. The kernel of `DR` is that of `A t = (0, 1)`, the shortest step
//! `DR^+ R` any solution of `A v = (R, 0)` less its part along t.

use super::newton::Equation;
use super::{ContactShares, HarmonicSystem, SystemWorkspace};
use crate::linalg::LuWorkspace;
use crate::response::friction::PairParameters;

/// What varies along a curve besides the solution: the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Along {
    /// The angular frequency, rad/s.
    Frequency,
    /// The natural logarithm of the factor on the normal load of every pair, at one frequency.
    NormalLoad {
        /// Angular frequency, rad/s.
        omega: f64,
    },
}

/// `R(u) = 0` with one unknown more than equations; residuals have a zero at the end.
pub(super) struct Curve {
    system: HarmonicSystem,
    along: Along,
    /// Pairs of a sector where the factor on their normal load is 1.
    pairs: Vec<PairParameters>,
    workspace: SystemWorkspace,
    /// Factors of `(DR; c^T)`.
    pub(super) factors: LuWorkspace<f64>,
    pub(super) factored: bool,
    pub(super) state_scale: f64,
    pub(super) parameter_scale: f64,
    /// The solution without its scale.
    pub(super) x: Vec<f64>,
    /// The border c.
    pub(super) border: Vec<f64>,
    /// Kernel of `DR` at the last linearisation, not of unit length.
    pub(super) kernel: Vec<f64>,
    /// Sign of `det (DR; t^T)` along the walk.
    pub(super) orientation: f64,
}

impl Curve {
    /// The curve of a system in the sizes X and W of the unknowns.
    pub(super) fn new(
        system: &HarmonicSystem,
        along: Along,
        state_scale: f64,
        parameter_scale: f64,
    ) -> Self {
        let n = system.unknowns();
        let mut border = vec![0.0; n + 1];
        border[n] = 1.0;
        Self {
            system: system.clone(),
            along,
            pairs: system.pairs().to_vec(),
            workspace: system.workspace(),
            factors: LuWorkspace::new(n + 1),
            factored: false,
            state_scale,
            parameter_scale,
            x: vec![0.0; n],
            border,
            kernel: vec![0.0; n + 1],
            orientation: 0.0,
        }
    }

    /// Whether the parameter has a meaning at `u`.
    pub(super) fn admits(&self, u: &[f64]) -> bool {
        match self.along {
            Along::Frequency => u[u.len() - 1] > 0.0,
            Along::NormalLoad { .. } => true,
        }
    }

    /// Takes the scale off and sets the normal load; returns the frequency.
    fn unscale(&mut self, u: &[f64]) -> f64 {
        for (x, u) in self.x.iter_mut().zip(u) {
            *x = self.state_scale * u;
        }
        let parameter = self.parameter_scale * u[u.len() - 1];
        match self.along {
            Along::Frequency => parameter,
            Along::NormalLoad { omega } => {
                let factor = parameter.exp();
                let own = self.system.interface.pairs.iter_mut();
                for (own, pair) in own.zip(&self.pairs) {
                    own.normal_load_n = factor * pair.normal_load_n;
                }
                omega
            }
        }
    }

    /// Fills `factors` with `(X dR/dx, W dR/dp; c^T)` relative to the excitation; `residual` is that
    /// of the system at the same place.
    fn fill_bordered(&mut self, omega: f64, residual: &[f64]) {
        let n = self.x.len();
        let matrix = self.factors.matrix_mut();
        let (jacobian, last) = matrix.split_at_mut(n * n);
        self.system
            .jacobian(omega, &mut self.workspace, &mut jacobian[..]);
        // The last column has its place behind the n - 1 entries by which the others grow.
        let by_parameter = &mut last[n..2 * n];
        match self.along {
            Along::Frequency => self
                .system
                .frequency_derivative(omega, &self.x, by_parameter),
            Along::NormalLoad { .. } => {
                self.system
                    .normal_load_derivative(&self.x, residual, jacobian, by_parameter)
            }
        }
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
        let parameter = self.parameter_scale / self.system.force_norm();
        for entry in last.iter_mut() {
            *entry *= parameter;
        }
        last[n] = self.border[n];
    }
}

impl Equation for Curve {
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
        self.fill_bordered(omega, &residual[..n]);
        for r in residual.iter_mut() {
            *r /= self.system.force_norm();
        }
        residual[n] = 0.0;
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

/// The curve with its parameter held: the border is the parameter alone.
pub(super) struct AtParameter<'a>(&'a mut Curve);

impl<'a> AtParameter<'a> {
    /// Holds the parameter from now on; factors of the free curve do not serve.
    pub(super) fn new(curve: &'a mut Curve) -> Self {
        let n = curve.x.len();
        curve.border.fill(0.0);
        curve.border[n] = 1.0;
        curve.factored = false;
        Self(curve)
    }
}

impl Equation for AtParameter<'_> {
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
