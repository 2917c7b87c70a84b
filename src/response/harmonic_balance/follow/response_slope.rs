//! How a solution changes with frequency.
//!
//! ```text
//! R(x(omega), omega) = 0,    dx/domega = -J^-1 dR/domega
//! ```

use crate::response::harmonic_balance::equation::HarmonicSystem;
use crate::response::harmonic_balance::solver::NewtonWorkspace;

/// `dx/domega` of `system` at its solution `x`, per rad/s, by the Jacobian there, which is kept in `workspace`; none
/// where it is singular.
pub fn response_slope(
    system: &HarmonicSystem,
    omega: f64,
    x: &[f64],
    workspace: &mut NewtonWorkspace,
) -> Option<Vec<f64>> {
    workspace.system_mut().couple_all();
    if !workspace.factor_at(system, omega, x) {
        return None;
    }
    let mut slope = vec![0.0; system.unknowns()];
    system.frequency_derivative(omega, x, &mut slope);
    workspace.solve_linear(&mut slope);
    for entry in &mut slope {
        *entry = -*entry;
    }
    Some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::friction::ContactLaw;
    use crate::response::harmonic_balance::Status;
    use crate::response::harmonic_balance::condensed::newton_step::tests::{OMEGA, system};
    use crate::response::harmonic_balance::solver::{NewtonBounds, solve};

    #[test]
    fn the_slope_is_that_of_solutions_at_neighbouring_frequencies() {
        let change = 1e-6;
        for harmonics in [&[1][..], &[1, 3], &[0, 1, 2]] {
            let system = system(ContactLaw::MacroSlip1d, harmonics, 64);
            let solution = |omega: f64| {
                let mut x = vec![0.0; system.unknowns()];
                let mut workspace = NewtonWorkspace::new(&system);
                let bounds = NewtonBounds::with_tolerance(1e-13);
                let found = solve(&system, omega, &mut x, bounds, None, &mut workspace);
                assert_eq!(found.status, Status::Ok);
                assert!((0.2..1.0).contains(&found.shares.slipping), "{found:?}");
                x
            };
            let x = solution(OMEGA);
            let mut workspace = NewtonWorkspace::new(&system);
            let slope = response_slope(&system, OMEGA, &x, &mut workspace);
            let slope = slope.expect("a regular Jacobian");
            let (above, below) = (solution(OMEGA + change), solution(OMEGA - change));
            let largest = slope.iter().fold(0.0, |a: f64, s| a.max(s.abs()));
            for ((slope, above), below) in slope.iter().zip(&above).zip(&below) {
                let expected = (above - below) / (2.0 * change);
                let error = (slope - expected).abs() / largest;
                assert!(error < 1e-5, "{harmonics:?}: {slope} {expected}");
            }
        }
    }
}
