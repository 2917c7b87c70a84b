//! Linear response with contact springs that do not slip: the start of Newton's method, and the
//! exact answer where every pair sticks.

use super::{ContactStiffnessMatrix, Structure};
use crate::linalg::{Complex64, LuWorkspace};

/// Solves `(Z(omega) + C^H k_c C) x = f` for modal amplitudes; none if the matrix is singular.
/// Without contact springs a diagonal `Z` is divided by, with no factorisation.
pub fn linear_response(
    structure: &Structure,
    contact: Option<&ContactStiffnessMatrix>,
    omega: f64,
    force: &[Complex64],
    workspace: &mut LuWorkspace<Complex64>,
) -> Option<Vec<Complex64>> {
    if contact.is_none() && structure.is_diagonal() {
        let response = force.iter().enumerate().map(|(mode, f)| {
            let z = Complex64::new(
                structure.eigenvalues()[mode] - omega * omega,
                structure.damping_diagonal(mode, omega),
            );
            f / z
        });
        let response: Vec<Complex64> = response.collect();
        return response.iter().all(|x| x.is_finite()).then_some(response);
    }
    structure.dynamic_stiffness(omega, contact, workspace.matrix_mut());
    if !workspace.factor() {
        return None;
    }
    let mut response = force.to_vec();
    workspace.solve(&mut response);
    response.iter().all(|x| x.is_finite()).then_some(response)
}
