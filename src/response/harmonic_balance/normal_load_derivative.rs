//! Derivative of the harmonic balance equation with respect to the normal load.
//!
//! Displacement and load times a make force times a: `G(a d, a N0) = a G(d, N0)`. By Euler's theorem on
//! such functions
//!
//! ```text
//! dG / d ln N0 = G - (dG/dd) d,    so    dR / d ln N0 = R + f - J x
//! ```
//!
//! since everything else in R is linear in x or the excitation f. The ring is at rest.

use super::HarmonicSystem;
use crate::linalg::add_times_vector;

impl HarmonicSystem {
    /// `dR/d ln N0` at `x` into `derivative`, from the residual and the Jacobian there (column after
    /// column).
    pub fn normal_load_derivative(
        &self,
        x: &[f64],
        residual: &[f64],
        jacobian: &[f64],
        derivative: &mut [f64],
    ) {
        derivative.copy_from_slice(residual);
        add_times_vector(derivative, -1.0, jacobian, x);
        let at = self.block_start(self.fundamental());
        let (real, imaginary) = derivative[at..].split_at_mut(self.force().len());
        for ((real, imaginary), f) in real.iter_mut().zip(imaginary).zip(self.force()) {
            *real += f.re;
            *imaginary += f.im;
        }
    }
}
