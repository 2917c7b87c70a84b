//! The solvers of a study: one for the force vector of every load case, each with others for the rows that it is not good enough for.

use std::sync::OnceLock;

use super::{
    CurveResult, CurveSettings, LoadCaseName, ResponseRow, RowSolver, Scenario, TunedReference,
    WheelState, harmonics_name,
};
use crate::response::forced_response::TopBeside;
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;

/// The solver of the rows under one force vector.
#[derive(Debug)]
pub struct LoadCaseSolver {
    rows: RowSolver,
    /// What is tried one after the other.
    fallbacks: Vec<Fallback>,
}

/// What solves the rows that another solver is not good enough for.
#[derive(Debug)]
struct Fallback {
    rows: RowSolver,
    /// Whether rows of a basis with an error beyond its tolerance go there too, besides those that separate.
    inexact_rows: bool,
    /// Tuned peaks on that solver, for each of its chosen sets, found when first asked for.
    tuned: Vec<OnceLock<TunedReference>>,
}

/// The solvers of all load cases of a study; shared between threads.
#[derive(Debug)]
pub struct LoadCaseSolvers {
    /// Of the scenarios whose load case no other solver has.
    first: LoadCaseSolver,
    others: Vec<(LoadCaseName, LoadCaseSolver)>,
}

impl From<RowSolver> for LoadCaseSolver {
    fn from(rows: RowSolver) -> Self {
        Self {
            rows,
            fallbacks: Vec::new(),
        }
    }
}

impl LoadCaseSolver {
    /// This solver with `other` for the rows that it and the others before are not good enough for, each with the tuned reference of
    /// `other`. On a basis, where `other` is finer, these are the rows whose contacts separate, and with `inexact_rows` those whose
    /// sampling or harmonic error exceeds its tolerance. On tuned receptances, where `other` has fewer harmonics, they are the rows
    /// without a peak. Only scenarios for which `other` has a chosen set are solved again.
    #[must_use]
    pub fn with_fallback(mut self, other: RowSolver, inexact_rows: bool) -> Self {
        self.fallbacks.push(Fallback {
            tuned: other.choices().map(|_| OnceLock::new()).collect(),
            rows: other,
            inexact_rows,
        });
        self
    }

    /// The solver that rows are solved by first.
    #[must_use]
    pub fn rows(&self) -> &RowSolver {
        &self.rows
    }

    /// The solvers of the rows that those before are not good enough for, in their order.
    pub fn fallbacks(&self) -> impl Iterator<Item = &RowSolver> {
        self.fallbacks.iter().map(|fallback| &fallback.rows)
    }

    /// The solver that a row came from.
    #[must_use]
    pub fn solver_of(&self, scenario: &Scenario, row: &ResponseRow) -> &RowSolver {
        let gave_it = |solver: &&RowSolver| {
            let harmonics = harmonics_name(solver.points(scenario).harmonics());
            row.harmonics == harmonics && row.basis == solver.basis_name()
        };
        let mut solvers = std::iter::once(&self.rows).chain(self.fallbacks());
        solvers.find(gave_it).unwrap_or(&self.rows)
    }

    /// Amplitude of every blade at each frequency; no pattern means the tuned wheel.
    #[must_use]
    pub fn curve(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
        settings: CurveSettings,
    ) -> Vec<CurveResult> {
        let lost = |status| {
            let frequencies = frequencies_hz.iter();
            frequencies.map(|&hz| (hz, Err(status))).collect()
        };
        let solver = if settings.fewest_harmonics {
            let own = self.rows.points(scenario).harmonics().len();
            let has_fewer = |solver: &&RowSolver| solver.points(scenario).harmonics().len() < own;
            self.fallbacks().last().filter(has_fewer)
        } else {
            Some(&self.rows)
        };
        let Some(solver) = solver else {
            return lost(Status::IterationLimit);
        };
        let (order, contact) = (scenario.engine_order, scenario.contact);
        let tolerance = settings.least_residual_tolerance;
        let solved = solver.curve_within(order, contact, pattern, frequencies_hz, tolerance);
        // A pattern that cannot be applied has no solution at any frequency.
        solved.unwrap_or_else(lost)
    }

    /// The row, or that of the first fallback that has to solve it again and can.
    fn solved_again(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: ResponseRow,
    ) -> ResponseRow {
        self.fallbacks.iter().fold(row, |row, fallback| {
            let again = self.solved_by(fallback, pattern, scenario, &row);
            again.unwrap_or(row)
        })
    }

    /// The row by a fallback, if it has to be and can be.
    fn solved_by(
        &self,
        fallback: &Fallback,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
    ) -> Option<ResponseRow> {
        let own = self.rows.points(scenario).harmonics();
        let failed = row.status != Status::Ok;
        // Of a fallback whose tuned wheel has no peak with its harmonics.
        let stands_alone =
            row.amplification_factor.is_none() && row.harmonics != harmonics_name(own);
        let wanted = if self.rows.has_all_receptances() {
            failed || stands_alone
        } else {
            let separates = row.separated_fraction.is_some_and(|share| share > 0.0);
            separates || fallback.inexact_rows && row.error_within_tolerance == Some(false)
        };
        if !wanted {
            return None;
        }
        let mut choices = fallback.rows.choices().enumerate();
        let (place, choice) = choices.find(|(_, choice)| {
            choice.engine_order == scenario.engine_order && choice.contact == scenario.contact
        })?;
        let same_set = harmonics_name(&choice.harmonics) == row.harmonics;
        let has_fewer = choice.harmonics.len() < own.len();
        if same_set && fallback.rows.basis_name() == self.rows.basis_name()
            || self.rows.has_all_receptances() && !has_fewer
        {
            return None;
        }
        let tuned = fallback.tuned[place].get_or_init(|| fallback.rows.tuned(scenario));
        let tuned = TunedReference {
            scenario: scenario.index,
            ..tuned.clone()
        };
        let again = fallback.rows.rows(pattern, &[(scenario, &tuned)]).pop()?;
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

impl LoadCaseSolvers {
    /// `first`, and the solvers of the load cases with these names: the same wheel under other force vectors.
    #[must_use]
    pub fn new(first: LoadCaseSolver, others: Vec<(LoadCaseName, LoadCaseSolver)>) -> Self {
        Self { first, others }
    }

    /// The solvers of all load cases, the first one first.
    pub fn all(&self) -> impl Iterator<Item = &LoadCaseSolver> {
        std::iter::once(&self.first).chain(self.others.iter().map(|(_, solver)| solver))
    }

    /// The solver of the first load case.
    #[must_use]
    pub fn first(&self) -> &LoadCaseSolver {
        &self.first
    }

    /// The solver of the load case of a scenario.
    #[must_use]
    pub fn under(&self, scenario: &Scenario) -> &LoadCaseSolver {
        self.others
            .iter()
            .find(|(name, _)| Some(*name) == scenario.load_case)
            .map_or(&self.first, |(_, solver)| solver)
    }

    /// Tuned reference of a scenario.
    #[must_use]
    pub fn tuned(&self, scenario: &Scenario) -> TunedReference {
        self.under(scenario).rows.tuned(scenario)
    }

    /// Rows of one pattern under several scenarios of one standard deviation, in their order.
    #[must_use]
    pub fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        // The wheel is the same under every load case, unless each has receptances of its own.
        let wheel = self.first.rows.mistuned(pattern, scenarios);
        let row = |&(scenario, tuned): &(&Scenario, &TunedReference)| {
            let solver = self.under(scenario);
            let row = if solver.rows.has_receptances_of(&self.first.rows) {
                solver.rows.row(&wheel, pattern, scenario, tuned)
            } else {
                let wheel = solver.rows.mistuned(pattern, &[(scenario, tuned)]);
                solver.rows.row(&wheel, pattern, scenario, tuned)
            };
            solver.solved_again(pattern, scenario, row)
        };
        scenarios.iter().map(row).collect()
    }

    /// The wheel of `row`, which these solvers gave, at its peak, with the model and harmonics that the row was solved with.
    ///
    /// # Errors
    /// The status of a row without peak, of a pattern that cannot be applied, or of the solution.
    pub fn wheel_state(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
    ) -> Result<WheelState, Status> {
        let solver = self.under(scenario).solver_of(scenario, row);
        let frequency_hz = row.peak_frequency_hz.ok_or(row.status)?;
        solver.wheel_state(pattern, scenario, frequency_hz)
    }

    /// The top on these solvers, which have the harmonics of `coarse` among their own, beside the peak that `coarse` found at
    /// `frequency_hz` with the set named `harmonics`; of the tuned wheel for no pattern. None where rows are not on receptances,
    /// or where the solutions do not settle.
    #[must_use]
    pub fn top_beside(
        &self,
        coarse: &Self,
        pattern: Option<&Pattern>,
        scenario: &Scenario,
        (frequency_hz, harmonics): (f64, &str),
    ) -> Option<TopBeside> {
        let coarse = coarse.under(scenario);
        let mut solvers = std::iter::once(&coarse.rows).chain(coarse.fallbacks());
        let is_of_the_row =
            |solver: &&RowSolver| harmonics_name(solver.points(scenario).harmonics()) == harmonics;
        let coarse = solvers.find(is_of_the_row)?;
        let rows = &self.under(scenario).rows;
        rows.top_beside(coarse, pattern, scenario, frequency_hz)
    }
}
