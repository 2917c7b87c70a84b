//! Derivative of the harmonic balance equation with respect to frequency.
//!
//! ```text
//! dR_k / domega = (-2 k^2 omega I + i k dD/domega) x_k
//! ```
//!
//! Contact forces are taken over one period, whatever its length, and do not depend on `omega`.

use super::HarmonicSystem;

impl HarmonicSystem {
    /// `dR/domega` at `x` into `derivative`, per rad/s.
    pub fn frequency_derivative(&self, omega: f64, x: &[f64], derivative: &mut [f64]) {
        derivative.fill(0.0);
        let mut product = Vec::new();
        for (index, block) in self.blocks.iter().enumerate() {
            if block.harmonic == 0 {
                continue;
            }
            let range = self.start[index]..self.start[index + 1];
            let (x, derivative) = (&x[range.clone()], &mut derivative[range]);
            let k = f64::from(block.harmonic);
            let inertia = -2.0 * k * k * omega;
            for (derivative, x) in derivative.iter_mut().zip(x) {
                *derivative = inertia * x;
            }
            product.resize(x.len(), 0.0);
            block
                .structure
                .add_damping_rate(k, x, derivative, &mut product);
        }
    }
}
