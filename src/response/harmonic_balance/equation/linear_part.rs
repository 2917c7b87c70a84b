//! The linear part of the harmonic balance equation, on the stuck base, its excitation, and its derivatives.
//!
//! ```text
//! L_k(x) = (Z(k omega) + C^H k_c C) x_k - f_k,    dL_k / domega = (-2 k^2 omega I + i k dD/domega) x_k
//! ```
//!
//! Contact forces are taken over one period, whatever its length, and do not depend on `omega`.
//!
//! A wheel leaves the stuck springs to the contact forces: where contact is stiff and slips, these are far smaller than
//! spring and correction by themselves, whose rounding would be left.

use super::harmonic_blocks::HarmonicBlocks;
use super::linear_response;
use crate::linalg::{Complex64, LuWorkspace, add_times_vector};

/// The linear part: harmonics on the stuck base, and the force on harmonic 1.
#[derive(Debug, Clone)]
pub(in crate::response::harmonic_balance) struct LinearPart {
    pub(in crate::response::harmonic_balance) blocks: HarmonicBlocks,
    /// Modal force of harmonic 1 (`n_modes` of its structure), and its norm.
    pub(super) force: Vec<Complex64>,
    pub(super) force_norm: f64,
}

impl LinearPart {
    /// Of `blocks` under the modal `force`.
    pub(super) fn new(blocks: HarmonicBlocks, force: Vec<Complex64>) -> Self {
        let force_norm = force.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        Self {
            blocks,
            force,
            force_norm,
        }
    }

    /// The linear response with every pair stuck, harmonic 1 and nothing else; none if it has none.
    pub(super) fn stuck_response(&self, omega: f64) -> Option<Vec<f64>> {
        let at = self.blocks.fundamental();
        let block = &self.blocks.as_slice()[at];
        let mut factors = LuWorkspace::new(block.structure.size());
        let (structure, stuck) = (&block.structure, Some(&*block.stuck));
        let response = linear_response(structure, stuck, omega, &self.force, &mut factors)?;
        let mut x = vec![0.0; self.blocks.unknowns()];
        let (real, imaginary) = x[self.blocks.unknowns_of(at..at + 1)].split_at_mut(response.len());
        for ((real, imaginary), z) in real.iter_mut().zip(imaginary).zip(&response) {
            (*real, *imaginary) = (z.re, z.im);
        }
        Some(x)
    }

    /// `(Z + C^H k_c C) x - f` of every harmonic, `Z x - f` where all share the matrices of a wheel.
    pub(super) fn residual(&self, omega: f64, x: &[f64], residual: &mut [f64], damped: &mut [f64]) {
        residual.fill(0.0);
        let fundamental = self.blocks.fundamental();
        for (index, block) in self.blocks.as_slice().iter().enumerate() {
            let range = self.blocks.unknowns_of(index..index + 1);
            let (x, r) = (&x[range.clone()], &mut residual[range]);
            let n = block.structure.size();
            let k_omega = f64::from(block.harmonic) * omega;
            let stuck = &block.stuck;
            if block.harmonic == 0 {
                if !self.blocks.are_shared() {
                    add_times_vector(r, 1.0, stuck.real.as_slice(), x);
                }
                for (mode, lambda) in block.structure.eigenvalues().iter().enumerate() {
                    r[mode] += lambda * x[mode];
                }
                continue;
            }
            let damping = &block.structure;
            damping.add_damping_force(k_omega, x, r, &mut damped[..2 * n]);
            let (x_real, x_imaginary) = x.split_at(n);
            let (r_real, r_imaginary) = r.split_at_mut(n);
            if !self.blocks.are_shared() {
                add_times_vector(r_real, 1.0, stuck.real.as_slice(), x_real);
                add_times_vector(r_imaginary, 1.0, stuck.real.as_slice(), x_imaginary);
            }
            if let Some(imaginary) = &stuck.imaginary {
                add_times_vector(r_real, -1.0, imaginary.as_slice(), x_imaginary);
                add_times_vector(r_imaginary, 1.0, imaginary.as_slice(), x_real);
            }
            for (mode, lambda) in block.structure.eigenvalues().iter().enumerate() {
                let stiffness = lambda - k_omega * k_omega;
                r_real[mode] += stiffness * x_real[mode];
                r_imaginary[mode] += stiffness * x_imaginary[mode];
            }
            if index == fundamental {
                for (mode, f) in self.force.iter().enumerate() {
                    r_real[mode] -= f.re;
                    r_imaginary[mode] -= f.im;
                }
            }
        }
    }

    /// Derivative of the linear part, column-major.
    pub(super) fn jacobian(&self, omega: f64, jacobian: &mut [f64]) {
        let height = self.blocks.unknowns();
        jacobian.fill(0.0);
        for (index, block) in self.blocks.as_slice().iter().enumerate() {
            let n = block.structure.size();
            let start = self.blocks.unknowns_of(index..index).start;
            let k_omega = f64::from(block.harmonic) * omega;
            let parts = if block.harmonic == 0 { 1 } else { 2 };
            for part in 0..parts {
                let row = start + part * n;
                for j in 0..n {
                    let column = &mut jacobian[(start + part * n + j) * height..][..height];
                    column[row..row + n].copy_from_slice(block.stuck.real.column(j));
                    column[row + j] += block.structure.eigenvalues()[j] - k_omega * k_omega;
                    if let (2, Some(imaginary)) = (parts, &block.stuck.imaginary) {
                        let (other, sign) = if part == 0 {
                            (start + n, 1.0)
                        } else {
                            (start, -1.0)
                        };
                        for (i, &value) in imaginary.column(j).iter().enumerate() {
                            column[other + i] += sign * value;
                        }
                    }
                }
            }
            if parts == 2 {
                block.structure.for_each_damping(k_omega, |i, j, d| {
                    jacobian[(start + j) * height + start + n + i] += d;
                    jacobian[(start + n + j) * height + start + i] -= d;
                });
            }
        }
    }

    /// Derivative of the harmonic at place `index` by its complex unknowns, column-major `n x n`. For harmonics of a
    /// wheel, whose contact rows are real.
    pub(super) fn complex_jacobian_of(&self, index: usize, omega: f64, jacobian: &mut [Complex64]) {
        let block = &self.blocks.as_slice()[index];
        let n = block.structure.size();
        let k_omega = f64::from(block.harmonic) * omega;
        for (entry, &stuck) in jacobian.iter_mut().zip(block.stuck.real.as_slice()) {
            *entry = Complex64::new(stuck, 0.0);
        }
        for (mode, lambda) in block.structure.eigenvalues().iter().enumerate() {
            jacobian[mode * n + mode].re += lambda - k_omega * k_omega;
        }
        if block.harmonic > 0 {
            block
                .structure
                .for_each_damping(k_omega, |i, j, d| jacobian[j * n + i].im += d);
        }
    }

    /// `dR/domega` at `x` into `derivative`, per rad/s.
    pub(super) fn frequency_derivative(&self, omega: f64, x: &[f64], derivative: &mut [f64]) {
        derivative.fill(0.0);
        let mut product = Vec::new();
        for (index, block) in self.blocks.as_slice().iter().enumerate() {
            if block.harmonic == 0 {
                continue;
            }
            let range = self.blocks.unknowns_of(index..index + 1);
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
