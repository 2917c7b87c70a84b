//! The checks of `[solver]` that its keys do not make each by itself.

use super::check::Check;
use crate::response::forced_response::{Harmonics, SolverOptions};
use crate::study::keys::solver::SolverTable;

/// The settings of the solution, defaults filled in.
pub(super) fn solver(check: &mut Check, table: Option<SolverTable>) -> SolverOptions {
    let residual_is_stated = table
        .as_ref()
        .is_some_and(|table| table.residual_tolerance.is_some());
    let mut options = SolverOptions {
        residual_is_stated,
        ..SolverOptions::default()
    };
    check.put("solver", table, &mut options, &["samples_per_period"]);
    let highest = match &options.harmonics {
        Harmonics::Set(set) => set.last().copied().unwrap_or(1) as usize,
        Harmonics::Auto => 3,
    };
    let least = 16.max(4 * highest);
    if !(least..=65_536).contains(&options.samples_per_period) {
        let accepted = format!(
            "a whole number from {least} (16, and 4 per period of the highest harmonic) to 65536"
        );
        check.refuse_for("solver.samples_per_period", &accepted);
    }
    options
}
