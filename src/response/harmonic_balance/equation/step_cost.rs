//! Which Jacobian makes the cheaper Newton step: the whole one, or that of an equation in the contact forces alone.

use crate::response::friction::ContactLaw;

/// Unknowns up to which accelerated steps take the whole Jacobian: it costs next to nothing there.
pub const LARGEST_WHOLE_JACOBIAN: usize = 400;

/// Whether the step by contact forces is the cheaper one, by the operations that either takes, for a wheel of `modes`
/// coordinates and `contact_rows` with so many real `coefficients` each. Under a constant normal load only, and only where the
/// matrix of all contact rows is so small that it costs next to nothing.
#[must_use]
pub fn condensing_pays(
    law: ContactLaw,
    coefficients: usize,
    modes: usize,
    contact_rows: usize,
) -> bool {
    let condensed = coefficients * contact_rows;
    if contact_rows == 0 || condensed > LARGEST_WHOLE_JACOBIAN {
        return false;
    }
    // Where contact may open a renewed step can lead to another branch than damped ones.
    if law.has_variable_load() {
        return false;
    }
    let factored = |n: f64| 2.0 / 3.0 * n.powi(3);
    let (m, n) = (contact_rows as f64, modes as f64);
    let unknowns = coefficients as f64 * n;
    let whole = factored(unknowns) + 2.0 * unknowns.powi(2) * m;
    let of_harmonic = 4.0 * factored(n) + 8.0 * n * n * m + 4.0 * n * m * m;
    let harmonics = coefficients.div_ceil(2) as f64;
    harmonics * of_harmonic + factored(condensed as f64) < whole
}
