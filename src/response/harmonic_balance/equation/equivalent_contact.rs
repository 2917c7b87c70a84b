//! The contact of a solution as linear springs: harmonic linearisation of every row.

use crate::linalg::Complex64;

/// Complex spring of every contact row, N/m: the fundamental of the contact force over that of the displacement,
///
/// ```text
/// k = F_1 / d_1 = k_c + G_1 / d_1
/// ```
///
/// (equivalent linearisation by the describing function, Krylov & Bogoliubov 1947), real part the
/// stiffness, imaginary part the energy dissipated per radian over `|d_1|^2`; the stuck spring
/// where the row does not move.
///
/// `stuck` are the springs `k_c` of a sector or of the wheel, N/m, `displacement` and `correction` are `d_1` and `G_1`: the
/// real parts of all rows, then their imaginary parts.
pub(super) fn equivalent_springs(
    stuck: &[f64],
    displacement: &[f64],
    correction: &[f64],
) -> Vec<Complex64> {
    let rows = displacement.len() / 2;
    let fundamental = |parts: &[f64], row: usize| Complex64::new(parts[row], parts[rows + row]);
    (0..rows)
        .map(|row| {
            let displacement = fundamental(displacement, row);
            let correction = fundamental(correction, row) / displacement;
            let correction = if correction.is_finite() {
                correction
            } else {
                Complex64::default()
            };
            stuck[row % stuck.len()] + correction
        })
        .collect()
}
