//! Derivative of the harmonic balance equation.
//!
//! ```text
//! dR_k / dx_l = delta_kl (Z(k omega) + C^H k_c C) + C^H (dG_k / dd_l) C
//! ```
//!
//! Pairs that neither slip nor separate have no derivative of G and cost nothing; without separation the
//! correction along the normal has none.

use std::ops::Range;

use super::system::{HarmonicSystem, Link, SystemWorkspace};
use crate::linalg::{Matrix, add_transpose_times};

impl HarmonicSystem {
    /// Derivative of the residual at the point last given to [`Self::residual`] with `derivative`,
    /// column-major `n x n` into `jacobian`.
    pub fn jacobian(&self, omega: f64, workspace: &mut SystemWorkspace, jacobian: &mut [f64]) {
        self.jacobian_of(0..self.blocks.len(), omega, workspace, jacobian);
    }

    /// [`Self::jacobian`] of the harmonics at the places `wanted` of the set by themselves.
    pub(super) fn jacobian_of(
        &self,
        wanted: Range<usize>,
        omega: f64,
        workspace: &mut SystemWorkspace,
        jacobian: &mut [f64],
    ) {
        let (first, end) = (self.start[wanted.start], self.start[wanted.end]);
        let unknowns = end - first;
        self.linear_jacobian(wanted, omega, jacobian);
        let active: Vec<usize> = (0..workspace.active.len())
            .filter(|&pair| workspace.active[pair])
            .collect();
        if active.is_empty() {
            return;
        }
        let inside = |link: &Link<'_>| link.unknown >= first && link.unknown < end;
        let links: Vec<Link<'_>> = self.links().into_iter().filter(inside).collect();
        let separated = workspace.separated;
        let (mut gathered, mut left_gathered): (Option<&Matrix<f64>>, Option<&Matrix<f64>>) =
            (None, None);
        let mut n_rows = 0;
        for column in &links {
            if !gathered.is_some_and(|rows| std::ptr::eq(rows, column.rows)) {
                self.gather_active(&active, column.rows, true, &mut workspace.active_rows);
                gathered = Some(column.rows);
            }
            let mut loaded: Option<usize> = None;
            for c in 0..self.transform.n_coefficients() {
                for row in links.iter().filter(|row| row.coefficient == c) {
                    if !left_gathered.is_some_and(|rows| std::ptr::eq(rows, row.rows)) {
                        let packed = &mut workspace.left_rows;
                        n_rows = self.gather_active(&active, row.rows, separated, packed);
                        left_gathered = Some(row.rows);
                    }
                    if loaded != Some(c) {
                        self.load_active(&active, c, column, workspace);
                        loaded = Some(c);
                    }
                    let at = (column.unknown - first) * unknowns + (row.unknown - first);
                    add_transpose_times(
                        &mut jacobian[at..at + (column.size - 1) * unknowns + row.size],
                        unknowns,
                        row.sign * column.sign,
                        &workspace.left_rows[..n_rows * row.size],
                        &workspace.loaded_rows[..n_rows * column.size],
                        (row.size, column.size, n_rows),
                    );
                }
            }
        }
    }

    /// Contact rows of the active pairs, packed, with or without those along the normal; returns their
    /// number.
    fn gather_active(
        &self,
        active: &[usize],
        rows: &Matrix<f64>,
        normals: bool,
        packed: &mut [f64],
    ) -> usize {
        let per_sector = self.interface.per_sector();
        let sector_rows = self.interface.geometry.row_count();
        let skipped = usize::from(!normals);
        let mut at = 0;
        for column in 0..rows.columns() {
            let source = rows.column(column);
            for &pair in active {
                let base = pair / per_sector * sector_rows;
                let places = &self.interface.geometry.rows[pair % per_sector];
                for row in places[skipped..].iter().flatten() {
                    packed[at] = source[base + row];
                    at += 1;
                }
            }
        }
        at / rows.columns().max(1)
    }

    /// `dG_c / dx_{c'}` of the active pairs times their packed rows, into `loaded_rows`; c' is the coefficient
    /// of `column`, and the rows along the normal are there where pairs separate.
    fn load_active(
        &self,
        active: &[usize],
        c: usize,
        column: &Link<'_>,
        workspace: &mut SystemWorkspace,
    ) {
        let entry = c * self.transform.n_coefficients() + column.coefficient;
        let per_sector = self.interface.per_sector();
        let (mut from, mut to) = (0, 0);
        for _ in 0..column.size {
            for &pair in active {
                let jacobian = &workspace.jacobians[pair];
                let places = &self.interface.geometry.rows[pair % per_sector];
                let source = &workspace.active_rows[from..];
                let target = &mut workspace.loaded_rows[to..];
                let normal = places[0].map(|_| source[0]);
                let mut at = usize::from(normal.is_some());
                let mut first = 0;
                if let (Some(normal), true) = (normal, workspace.separated) {
                    target[0] = jacobian.normal_normal[entry] * normal;
                    first = 1;
                }
                let first_tangent = at;
                let mut written = first;
                for (tangent, place) in places[1..].iter().enumerate() {
                    if place.is_some() {
                        target[written] = jacobian.tangential_tangential[tangent][entry]
                            * source[at]
                            + normal.map_or(0.0, |normal| {
                                jacobian.tangential_normal[tangent][entry] * normal
                            });
                        written += 1;
                        at += 1;
                    }
                }
                if let (Some(cross), [_, Some(_), Some(_)]) = (&jacobian.tangential_cross, places) {
                    target[first] += cross[0][entry] * source[first_tangent + 1];
                    target[first + 1] += cross[1][entry] * source[first_tangent];
                }
                from += at;
                to += written;
            }
        }
    }

    /// Derivative of the linear part of the wanted harmonics, column-major.
    fn linear_jacobian(&self, wanted: Range<usize>, omega: f64, jacobian: &mut [f64]) {
        let first = self.start[wanted.start];
        let unknowns = self.start[wanted.end] - first;
        jacobian.fill(0.0);
        for index in wanted {
            let block = &self.blocks[index];
            let n = block.structure.size();
            let start = self.start[index] - first;
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
