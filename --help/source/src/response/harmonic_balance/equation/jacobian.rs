//! Derivative of the harmonic balance equation.
//!
//! ```text
//! dR_k / dx_l = delta_kl (Z(k omega) + C^H k_c C) + C^H (dG_k / dd_l) C
//! ```
//!
//! Pairs that neither slip nor separate have no derivative of G and cost nothing; without separation the
//! correction along the normal has none.

use std::ops::Range;

use super::system::Link;
use super::{HarmonicSystem, SystemWorkspace};
use crate::linalg::{Complex64, Matrix, add_transpose_times};

/// Unknowns up to which accelerated steps take the whole Jacobian: it costs next to nothing there.
pub const LARGEST_WHOLE_JACOBIAN: usize = 400;

impl HarmonicSystem {
    /// Derivative of the residual at the point last given to [`Self::residual`] with `derivative`,
    /// column-major `n x n` into `jacobian`.
    pub fn jacobian(&self, omega: f64, workspace: &mut SystemWorkspace, jacobian: &mut [f64]) {
        let all = 0..self.blocks.len();
        self.jacobian_of(all.clone(), all, omega, workspace, jacobian);
    }

    /// Derivative of the harmonics at the places `rows` of the set by those at `columns`, which are among them.
    pub(in crate::response::harmonic_balance) fn jacobian_of(
        &self,
        rows: Range<usize>,
        columns: Range<usize>,
        omega: f64,
        workspace: &mut SystemWorkspace,
        jacobian: &mut [f64],
    ) {
        let of = |blocks: &Range<usize>| self.start[blocks.start]..self.start[blocks.end];
        let (wanted_rows, wanted_columns) = (of(&rows), of(&columns));
        let height = wanted_rows.len();
        self.linear_jacobian(rows, columns, omega, jacobian);
        let active = active_pairs(workspace);
        if active.is_empty() {
            return;
        }
        let links = self.links();
        let rows: Vec<&Link<'_>> = within(&links, &wanted_rows);
        let separated = workspace.separated;
        let (mut gathered, mut left_gathered): (Option<&Matrix<f64>>, Option<&Matrix<f64>>) =
            (None, None);
        let mut n_rows = 0;
        let n_coefficients = self.transform.n_coefficients();
        for column in within(&links, &wanted_columns) {
            if !gathered.is_some_and(|rows| std::ptr::eq(rows, column.rows)) {
                self.gather_active(&active, column.rows, true, &mut workspace.active_rows);
                gathered = Some(column.rows);
            }
            let mut loaded: Option<usize> = None;
            for c in 0..n_coefficients {
                for row in rows.iter().filter(|row| row.coefficient == c) {
                    if !left_gathered.is_some_and(|rows| std::ptr::eq(rows, row.rows)) {
                        let packed = &mut workspace.left_rows;
                        n_rows = self.gather_active(&active, row.rows, separated, packed);
                        left_gathered = Some(row.rows);
                    }
                    if loaded != Some(c) {
                        let entry = c * n_coefficients + column.coefficient;
                        let slope = |slopes: &[f64]| slopes[entry];
                        self.load_active(&active, column.size, slope, workspace);
                        loaded = Some(c);
                    }
                    let at = (column.unknown - wanted_columns.start) * height
                        + (row.unknown - wanted_rows.start);
                    add_transpose_times(
                        &mut jacobian[at..at + (column.size - 1) * height + row.size],
                        height,
                        row.sign * column.sign,
                        &workspace.left_rows[..n_rows * row.size],
                        &workspace.loaded_rows[..n_rows * column.size],
                        (row.size, column.size, n_rows),
                    );
                }
            }
        }
    }

    /// The part of the derivative of one harmonic by itself that is linear in the complex unknowns, column-major
    /// `n x n` into `jacobian`: of `dG = g dd + h conj(dd)` the part g. For harmonics of a wheel, whose
    /// contact rows are real.
    pub(in crate::response::harmonic_balance) fn complex_jacobian_of(
        &self,
        index: usize,
        omega: f64,
        workspace: &mut SystemWorkspace,
        jacobian: &mut [Complex64],
    ) {
        let block = &self.blocks[index];
        let (n, rows) = (block.structure.size(), &block.structure.contact().real);
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
        let active = active_pairs(workspace);
        if active.is_empty() {
            return;
        }
        self.gather_active(&active, rows, true, &mut workspace.active_rows);
        let separated = workspace.separated;
        let n_rows = self.gather_active(&active, rows, separated, &mut workspace.left_rows);
        let (count, re) = (self.transform.n_coefficients(), self.coefficient[index]);
        let mut product = vec![0.0; n * n];
        let mut add = |part: fn(&mut Complex64) -> &mut f64, slope: &dyn Fn(&[f64]) -> f64| {
            self.load_active(&active, n, slope, workspace);
            product.fill(0.0);
            add_transpose_times(
                &mut product,
                n,
                1.0,
                &workspace.left_rows[..n_rows * n],
                &workspace.loaded_rows[..n_rows * n],
                (n, n, n_rows),
            );
            for (entry, product) in jacobian.iter_mut().zip(&product) {
                *part(entry) += product;
            }
        };
        if block.harmonic == 0 {
            add(|entry| &mut entry.re, &|slopes| slopes[re * count + re]);
            return;
        }
        let im = re + 1;
        add(|entry| &mut entry.re, &|slopes| {
            0.5 * (slopes[re * count + re] + slopes[im * count + im])
        });
        add(|entry| &mut entry.im, &|slopes| {
            0.5 * (slopes[im * count + re] - slopes[re * count + im])
        });
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

    /// Derivatives of G of the active pairs times their packed rows of `size` columns, into `loaded_rows`; `slope`
    /// picks the wanted one from a block of a pair's. The rows along the normal are there where pairs separate.
    fn load_active(
        &self,
        active: &[usize],
        size: usize,
        slope: impl Fn(&[f64]) -> f64,
        workspace: &mut SystemWorkspace,
    ) {
        let per_sector = self.interface.per_sector();
        let (mut from, mut to) = (0, 0);
        for _ in 0..size {
            for &pair in active {
                let jacobian = &workspace.jacobians[pair];
                let places = &self.interface.geometry.rows[pair % per_sector];
                let source = &workspace.active_rows[from..];
                let target = &mut workspace.loaded_rows[to..];
                let normal = places[0].map(|_| source[0]);
                let mut at = usize::from(normal.is_some());
                let mut first = 0;
                if let (Some(normal), true) = (normal, workspace.separated) {
                    target[0] = slope(&jacobian.normal_normal) * normal;
                    first = 1;
                }
                let first_tangent = at;
                let mut written = first;
                for (tangent, place) in places[1..].iter().enumerate() {
                    if place.is_some() {
                        target[written] = slope(&jacobian.tangential_tangential[tangent])
                            * source[at]
                            + normal.map_or(0.0, |normal| {
                                slope(&jacobian.tangential_normal[tangent]) * normal
                            });
                        written += 1;
                        at += 1;
                    }
                }
                if let (Some([by_second, by_first]), [_, Some(_), Some(_)]) =
                    (&jacobian.tangential_cross, places)
                {
                    target[first] += slope(by_second) * source[first_tangent + 1];
                    target[first + 1] += slope(by_first) * source[first_tangent];
                }
                from += at;
                to += written;
            }
        }
    }

    /// Derivative of the linear part of the harmonics at `rows` by those at `columns`, column-major.
    fn linear_jacobian(
        &self,
        rows: Range<usize>,
        columns: Range<usize>,
        omega: f64,
        jacobian: &mut [f64],
    ) {
        let first_row = self.start[rows.start];
        let height = self.start[rows.end] - first_row;
        let first_column = self.start[columns.start];
        jacobian.fill(0.0);
        for index in columns {
            let block = &self.blocks[index];
            let n = block.structure.size();
            let (top, left) = (
                self.start[index] - first_row,
                self.start[index] - first_column,
            );
            let k_omega = f64::from(block.harmonic) * omega;
            let parts = if block.harmonic == 0 { 1 } else { 2 };
            for part in 0..parts {
                let row = top + part * n;
                for j in 0..n {
                    let column = &mut jacobian[(left + part * n + j) * height..][..height];
                    column[row..row + n].copy_from_slice(block.stuck.real.column(j));
                    column[row + j] += block.structure.eigenvalues()[j] - k_omega * k_omega;
                    if let (2, Some(imaginary)) = (parts, &block.stuck.imaginary) {
                        let (other, sign) = if part == 0 {
                            (top + n, 1.0)
                        } else {
                            (top, -1.0)
                        };
                        for (i, &value) in imaginary.column(j).iter().enumerate() {
                            column[other + i] += sign * value;
                        }
                    }
                }
            }
            if parts == 2 {
                block.structure.for_each_damping(k_omega, |i, j, d| {
                    jacobian[(left + j) * height + top + n + i] += d;
                    jacobian[(left + n + j) * height + top + i] -= d;
                });
            }
        }
    }
}

fn active_pairs(workspace: &SystemWorkspace) -> Vec<usize> {
    (0..workspace.active.len())
        .filter(|&pair| workspace.active[pair])
        .collect()
}

/// The links whose unknowns are among `unknowns`.
fn within<'a, 'b>(links: &'a [Link<'b>], unknowns: &Range<usize>) -> Vec<&'a Link<'b>> {
    links
        .iter()
        .filter(|link| unknowns.contains(&link.unknown))
        .collect()
}
