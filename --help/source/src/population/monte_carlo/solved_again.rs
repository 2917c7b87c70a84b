//! Rows that a solver is not good enough for: solved again, with the tuned reference, by a finer one.

use std::sync::OnceLock;

use super::row_solver::Beyond;
use super::{ResponseRow, RowSolver, Scenario, TunedReference, harmonics_name};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;

impl RowSolver {
    /// This solver with `solver` for the rows that it is not good enough for, each with the tuned reference of `solver`. On a
    /// basis these are the rows whose contacts separate, on tuned receptances the rows without a peak; with `inexact_rows`, also
    /// those whose sampling or harmonic error exceeds its tolerance. Only scenarios for which `solver` has a chosen set are
    /// solved again.
    #[must_use]
    pub fn with_beyond(mut self, solver: Self, inexact_rows: bool) -> Self {
        self.beyond = Some(Beyond {
            tuned: solver.chosen.iter().map(|_| OnceLock::new()).collect(),
            solver: Box::new(solver),
            inexact_rows,
        });
        self
    }

    /// The solver of the rows that this one is not good enough for.
    #[must_use]
    pub fn beyond(&self) -> Option<&Self> {
        self.beyond.as_ref().map(|beyond| &*beyond.solver)
    }

    /// The row by the solver for what is beyond this one, if it has to be and can be.
    pub(super) fn solved_again(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
    ) -> Option<ResponseRow> {
        let beyond = self.beyond.as_ref()?;
        let failed = row.status != Status::Ok;
        let wanted = match &self.engine {
            Some(_) => failed,
            None => row.separated_fraction.is_some_and(|share| share > 0.0),
        };
        let inexact = row.error_within_tolerance == Some(false);
        if !(wanted || inexact && beyond.inexact_rows) {
            return None;
        }
        let place = beyond.solver.chosen.iter().position(|(choice, _)| {
            choice.engine_order == scenario.engine_order && choice.contact == scenario.contact
        })?;
        let same_set = harmonics_name(&beyond.solver.chosen[place].0.harmonics) == row.harmonics;
        if same_set && beyond.solver.basis_name() == self.basis_name() {
            return None;
        }
        let tuned = beyond.tuned[place].get_or_init(|| beyond.solver.tuned(scenario));
        let tuned = TunedReference {
            scenario: scenario.index,
            ..tuned.clone()
        };
        let again = beyond.solver.rows(pattern, &[(scenario, &tuned)]).pop()?;
        let solved = again.status == Status::Ok && again.amplification_factor.is_some();
        (solved || failed).then(|| ResponseRow {
            nonlinear_solves: row.nonlinear_solves + again.nonlinear_solves,
            newton_iterations: row.newton_iterations + again.newton_iterations,
            factorisations: row.factorisations + again.factorisations,
            retries: row.retries + again.retries,
            ..again
        })
    }
}
