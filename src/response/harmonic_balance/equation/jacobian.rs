//! Derivative of the harmonic balance equation.
//!
//! ```text
//! dR_k / dx_l = delta_kl (Z(k omega) + C^H k_c C) + C^H (dG_k / dd_l) C
//! ```

use super::{HarmonicSystem, SystemWorkspace};
use crate::linalg::{Complex64, Matrix};

impl HarmonicSystem {
    /// Derivative of the residual at the point last given to [`Self::residual`] with `derivative`,
    /// column-major `n x n` into `jacobian`.
    pub fn jacobian(&self, omega: f64, workspace: &mut SystemWorkspace, jacobian: &mut [f64]) {
        let blocks = &self.linear.blocks;
        let height = blocks.unknowns();
        self.linear.jacobian(omega, jacobian);
        let SystemWorkspace {
            contact, active, ..
        } = workspace;
        if !active.begin(contact) {
            return;
        }
        let interface = &self.contact.interface;
        let links = blocks.links();
        let (mut moved, mut loaded): (Option<&Matrix<f64>>, Option<&Matrix<f64>>) = (None, None);
        let n_coefficients = self.contact.transform.n_coefficients();
        for column in &links {
            if !moved.is_some_and(|rows| std::ptr::eq(rows, column.rows)) {
                active.pack_motions(interface, column.rows);
                moved = Some(column.rows);
            }
            let mut changed: Option<usize> = None;
            for c in 0..n_coefficients {
                for row in links.iter().filter(|row| row.coefficient == c) {
                    if !loaded.is_some_and(|rows| std::ptr::eq(rows, row.rows)) {
                        active.pack_forces(interface, row.rows, contact.separated);
                        loaded = Some(row.rows);
                    }
                    if changed != Some(c) {
                        let entry = c * n_coefficients + column.coefficient;
                        active.change(interface, contact, column.size, |slopes| slopes[entry]);
                        changed = Some(c);
                    }
                    let at = column.unknown * height + row.unknown;
                    let end = at + (column.size - 1) * height + row.size;
                    let sign = row.sign * column.sign;
                    let size = (row.size, column.size);
                    active.add_product(&mut jacobian[at..end], height, sign, size);
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
        let block = &self.blocks()[index];
        let (n, rows) = (block.structure.size(), &block.structure.contact().real);
        self.linear.complex_jacobian_of(index, omega, jacobian);
        let SystemWorkspace {
            contact, active, ..
        } = workspace;
        if !active.begin(contact) {
            return;
        }
        let interface = &self.contact.interface;
        active.pack_motions(interface, rows);
        active.pack_forces(interface, rows, contact.separated);
        let count = self.contact.transform.n_coefficients();
        let re = self.linear.blocks.coefficients()[index];
        let mut product = vec![0.0; n * n];
        let mut add = |part: fn(&mut Complex64) -> &mut f64, slope: &dyn Fn(&[f64]) -> f64| {
            active.change(interface, contact, n, slope);
            product.fill(0.0);
            active.add_product(&mut product, n, 1.0, (n, n));
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
}
