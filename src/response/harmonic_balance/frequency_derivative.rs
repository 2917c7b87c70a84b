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
        for (index, block) in self.blocks.iter().enumerate() {
            if block.harmonic == 0 {
                continue;
            }
            let n = block.structure.size();
            let range = self.start[index]..self.start[index + 1];
            let (x_real, x_imaginary) = x[range.clone()].split_at(n);
            let (d_real, d_imaginary) = derivative[range].split_at_mut(n);
            let k = f64::from(block.harmonic);
            let inertia = -2.0 * k * k * omega;
            for mode in 0..n {
                d_real[mode] = inertia * x_real[mode];
                d_imaginary[mode] = inertia * x_imaginary[mode];
            }
            block.structure.for_each_damping_rate(|i, j, rate| {
                d_real[i] -= k * rate * x_imaginary[j];
                d_imaginary[i] += k * rate * x_real[j];
            });
        }
    }
}
