//! The linear part of the harmonic balance equation, on the stuck base.
//!
//! A wheel leaves the stuck springs to the contact forces: where contact is stiff and slips, these are far smaller than
//! spring and correction by themselves, whose rounding would be left.

use super::{HarmonicSystem, linear_response};
use crate::linalg::{LuWorkspace, add_times_vector};

impl HarmonicSystem {
    /// The linear response with every pair stuck, harmonic 1 and nothing else; none if it has none.
    pub(in crate::response::harmonic_balance) fn stuck_response(
        &self,
        omega: f64,
    ) -> Option<Vec<f64>> {
        let (at, block) = (self.fundamental(), &self.blocks()[self.fundamental()]);
        let mut factors = LuWorkspace::new(block.structure.size());
        let (structure, stuck) = (&block.structure, Some(&*block.stuck));
        let response = linear_response(structure, stuck, omega, self.force(), &mut factors)?;
        let mut x = vec![0.0; self.unknowns()];
        let (real, imaginary) = x[self.start[at]..self.start[at + 1]].split_at_mut(response.len());
        for ((real, imaginary), z) in real.iter_mut().zip(imaginary).zip(&response) {
            (*real, *imaginary) = (z.re, z.im);
        }
        Some(x)
    }

    /// `(Z + C^H k_c C) x - f` of every harmonic, `Z x - f` where all share the matrices of a wheel.
    pub(super) fn linear_part(
        &self,
        omega: f64,
        x: &[f64],
        residual: &mut [f64],
        damped: &mut [f64],
    ) {
        residual.fill(0.0);
        let fundamental = self.fundamental();
        for (index, block) in self.blocks.iter().enumerate() {
            let range = self.start[index]..self.start[index + 1];
            let (x, r) = (&x[range.clone()], &mut residual[range]);
            let n = block.structure.size();
            let k_omega = f64::from(block.harmonic) * omega;
            let stuck = &block.stuck;
            if block.harmonic == 0 {
                if !self.shared {
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
            if !self.shared {
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
}
