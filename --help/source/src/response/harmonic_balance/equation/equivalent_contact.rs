//! The contact of a solution as linear springs: harmonic linearisation of every row.

use super::{HarmonicSystem, SystemWorkspace};
use crate::linalg::Complex64;

impl HarmonicSystem {
    /// Complex spring of every contact row at the solution `x`, N/m: the fundamental of the contact
    /// force over that of the displacement,
    ///
    /// ```text
    /// k = F_1 / d_1 = k_c + G_1 / d_1
    /// ```
    ///
    /// (equivalent linearisation by the describing function, Krylov & Bogoliubov 1947), real part the
    /// stiffness, imaginary part the energy dissipated per radian over `|d_1|^2`; the stuck spring
    /// where the row does not move. Length: rows of the system, sector after sector.
    #[must_use]
    pub fn equivalent_springs(&self, x: &[f64], workspace: &mut SystemWorkspace) -> Vec<Complex64> {
        let stuck = self.interface.stuck_springs(1.0);
        let rows = self.blocks[0].structure.contact().real.rows();
        if rows == 0 {
            return Vec::new();
        }
        self.contact_displacement(x, &mut workspace.displacement);
        self.contact_correction(false, workspace);
        let place = self.coefficient[self.fundamental()];
        let fundamental = |coefficients: &[f64], row: usize| {
            Complex64::new(
                coefficients[place * rows + row],
                coefficients[(place + 1) * rows + row],
            )
        };
        (0..rows)
            .map(|row| {
                let displacement = fundamental(&workspace.displacement, row);
                let correction = fundamental(&workspace.correction, row) / displacement;
                let correction = if correction.is_finite() {
                    correction
                } else {
                    Complex64::default()
                };
                stuck[row % stuck.len()] + correction
            })
            .collect()
    }
}
