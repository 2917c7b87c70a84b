//! Derivative of the harmonic balance equation.
//!
//! ```text
//! dR_k / dx_l = delta_kl (Z(k omega) + C^H k_c C) + C^H (dG_k / dd_l) C
//! ```
//!
//! Pairs that neither slip nor separate have no derivative of G and cost nothing.

use super::system::{HarmonicSystem, SystemWorkspace};
use crate::linalg::{Matrix, add_transpose_times};

impl HarmonicSystem {
    /// Derivative of the residual at the point last given to [`Self::residual`] with `derivative`,
    /// column-major `n x n` into `jacobian`.
    pub fn jacobian(&self, omega: f64, workspace: &mut SystemWorkspace, jacobian: &mut [f64]) {
        let unknowns = self.unknowns();
        self.linear_jacobian(omega, jacobian);
        let active: Vec<usize> = (0..workspace.active.len())
            .filter(|&pair| workspace.active[pair])
            .collect();
        if active.is_empty() {
            return;
        }
        let links = self.links();
        for column in &links {
            let n_rows = self.gather_active(&active, column.rows, &mut workspace.active_rows);
            for c in 0..self.transform.n_coefficients() {
                let size = column.size;
                self.load_active(&active, c, column.coefficient, n_rows, size, workspace);
                for row in links.iter().filter(|row| row.coefficient == c) {
                    // The wheel's rows are the same for every coefficient: gathered already.
                    let shared = std::ptr::eq(row.rows, column.rows);
                    let gathered;
                    let left = if shared {
                        &workspace.active_rows[..n_rows * row.size]
                    } else {
                        gathered = self.gathered(&active, row.rows);
                        &gathered[..]
                    };
                    let at = column.unknown * unknowns + row.unknown;
                    add_transpose_times(
                        &mut jacobian[at..at + (size - 1) * unknowns + row.size],
                        unknowns,
                        row.sign * column.sign,
                        left,
                        &workspace.loaded_rows[..n_rows * size],
                        (row.size, size, n_rows),
                    );
                }
            }
        }
    }

    /// Contact rows of the active pairs, packed; returns their number.
    fn gather_active(&self, active: &[usize], rows: &Matrix<f64>, packed: &mut [f64]) -> usize {
        let per_sector = self.interface.per_sector();
        let sector_rows = self.interface.geometry.row_count();
        let mut at = 0;
        for column in 0..rows.columns() {
            let source = rows.column(column);
            for &pair in active {
                let base = pair / per_sector * sector_rows;
                for row in self.interface.geometry.rows[pair % per_sector]
                    .iter()
                    .flatten()
                {
                    packed[at] = source[base + row];
                    at += 1;
                }
            }
        }
        at / rows.columns().max(1)
    }

    fn gathered(&self, active: &[usize], rows: &Matrix<f64>) -> Vec<f64> {
        let mut packed = vec![0.0; rows.as_slice().len()];
        let count = self.gather_active(active, rows, &mut packed);
        packed.truncate(count * rows.columns());
        packed
    }

    /// `dG_c / dx_{c'}` of the active pairs times their packed rows, into `loaded_rows`.
    fn load_active(
        &self,
        active: &[usize],
        c: usize,
        other: usize,
        n_rows: usize,
        columns: usize,
        workspace: &mut SystemWorkspace,
    ) {
        let coefficients = self.transform.n_coefficients();
        let entry = c * coefficients + other;
        let per_sector = self.interface.per_sector();
        let packed = workspace.active_rows[..n_rows * columns].chunks_exact(n_rows);
        let loaded = workspace.loaded_rows[..n_rows * columns].chunks_exact_mut(n_rows);
        for (source, target) in packed.zip(loaded) {
            let mut at = 0;
            for &pair in active {
                let jacobian = &workspace.jacobians[pair];
                let places = &self.interface.geometry.rows[pair % per_sector];
                let normal = places[0].map(|_| source[at]);
                if let Some(normal) = normal {
                    target[at] = jacobian.normal_normal[entry] * normal;
                    at += 1;
                }
                let first = at;
                for (tangent, place) in places[1..].iter().enumerate() {
                    if place.is_some() {
                        target[at] = jacobian.tangential_tangential[tangent][entry] * source[at]
                            + normal.map_or(0.0, |normal| {
                                jacobian.tangential_normal[tangent][entry] * normal
                            });
                        at += 1;
                    }
                }
                if let (Some(cross), [_, Some(_), Some(_)]) = (&jacobian.tangential_cross, places) {
                    target[first] += cross[0][entry] * source[first + 1];
                    target[first + 1] += cross[1][entry] * source[first];
                }
            }
        }
    }

    /// Derivative of the linear part, column-major.
    fn linear_jacobian(&self, omega: f64, jacobian: &mut [f64]) {
        let unknowns = self.unknowns();
        jacobian.fill(0.0);
        for (index, block) in self.blocks.iter().enumerate() {
            let n = block.structure.size();
            let start = self.start[index];
            let k_omega = f64::from(block.harmonic) * omega;
            let parts = if block.harmonic == 0 { 1 } else { 2 };
            for part in 0..parts {
                let offset = start + part * n;
                for j in 0..n {
                    let column = &mut jacobian[(offset + j) * unknowns..][..unknowns];
                    column[offset..offset + n].copy_from_slice(block.stuck.real.column(j));
                    column[offset + j] += block.structure.eigenvalues()[j] - k_omega * k_omega;
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
                    jacobian[(start + j) * unknowns + start + n + i] += d;
                    jacobian[(start + n + j) * unknowns + start + i] -= d;
                });
            }
        }
    }
}
