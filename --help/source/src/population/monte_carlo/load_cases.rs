//! Several force vectors on one wheel: a solver for each, and one mistuned structure for all of them.

use super::{LoadCaseName, RowSolver, Scenario};

impl RowSolver {
    /// This solver with the solvers of the further load cases of its study: the same wheel under
    /// other force vectors. Scenarios with one of these names are solved there, all others here.
    #[must_use]
    pub fn with_load_cases(mut self, others: Vec<(LoadCaseName, Self)>) -> Self {
        self.load_cases = others;
        self
    }

    /// The solvers of all load cases, this one first.
    pub fn of_load_cases(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(self.load_cases.iter().map(|(_, solver)| solver))
    }

    /// The solver of the load case of a scenario.
    #[must_use]
    pub fn under(&self, scenario: &Scenario) -> &Self {
        self.load_cases
            .iter()
            .find(|(name, _)| Some(*name) == scenario.load_case)
            .map_or(self, |(_, solver)| solver)
    }
}
