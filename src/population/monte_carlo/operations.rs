//! Floating-point operations of a row, estimated from its work counts: the same on every machine.

use serde::{Deserialize, Serialize};

use super::{ResponseRow, RowSolver, Scenario};
use crate::response::forced_response::{ContactCondition, samples_per_period};
use crate::response::friction::ContactLaw;

/// Operations per unknown cubed of the eigenvalues and vectors of a symmetric matrix.
const EIGEN: f64 = 9.0;
/// Time of one operation of eigenvalues and vectors over that of one of a product or of LU factors
/// (`cargo bench --bench response`).
const SLOWER_EIGEN: f64 = 5.0;
/// Eigenproblems of a pattern: the structure and its two linear limits.
const EIGENPROBLEMS: f64 = 3.0;
/// Operations of the contact law for one pair at one sample.
const LAW: f64 = 40.0;
/// Evaluations that the check of the harmonics takes.
const CHECK_ITERATIONS: f64 = 14.0;
/// Harmonics that the check has besides 1, each with a complex block: those up to 15.
const CHECK_BLOCKS: f64 = 14.0;
/// Real coefficients of the check.
const CHECK_COEFFICIENTS: f64 = 31.0;
/// Real coefficients of the check under a constant normal load, which excites odd harmonics alone.
const CHECK_COEFFICIENTS_ODD: usize = 16;
/// Harmonics that the check has besides 1 under a constant normal load.
const CHECK_BLOCKS_ODD: f64 = 7.0;
/// Samples of the check over those of the solution.
const CHECK_SAMPLES: f64 = 4.0;

/// Work counts of a row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RowWork {
    /// Points solved nonlinearly.
    pub nonlinear_solves: f64,
    /// Newton iterations, all attempts.
    pub newton_iterations: f64,
    /// Jacobians assembled and factored.
    pub factorisations: f64,
}

impl RowWork {
    /// Of a row.
    #[must_use]
    pub fn of(row: &ResponseRow) -> Self {
        Self {
            nonlinear_solves: row.nonlinear_solves as f64,
            newton_iterations: row.newton_iterations as f64,
            factorisations: row.factorisations as f64,
        }
    }
}

/// Size of the harmonic balance equation of a wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SystemSize {
    /// Coordinates of the wheel.
    pub coordinates: usize,
    /// Contact rows of the wheel.
    pub contact_rows: usize,
    /// Contact pairs of the wheel.
    pub pairs: usize,
    /// Real coefficients of a coordinate: 2 for a harmonic, 1 for harmonic 0.
    pub coefficients: usize,
    /// Samples per period.
    pub samples: usize,
    /// Contact law, where friction is solved for.
    pub law: Option<ContactLaw>,
}

impl SystemSize {
    /// Size of the equation of the rows of a scenario.
    #[must_use]
    pub fn of_rows(solver: &RowSolver, scenario: &Scenario) -> Self {
        let points = solver.points(scenario);
        let harmonics = points.harmonics();
        let model = solver.basis().model();
        let linear = !matches!(scenario.contact, ContactCondition::Full { .. });
        let settings = solver.settings();
        let law = settings.contact.map(|(law, _)| law);
        let law = law.filter(|_| !linear);
        Self {
            coordinates: solver.basis().size(),
            contact_rows: solver.basis().contact().rows(),
            pairs: model.contact.weights.len() * model.sectors,
            coefficients: Self::coefficients_of(harmonics),
            law,
            samples: if linear {
                1
            } else {
                samples_per_period(&settings.solver, harmonics)
            },
        }
    }

    /// Real coefficients of a harmonic set.
    #[must_use]
    pub fn coefficients_of(harmonics: &[u32]) -> usize {
        harmonics.iter().map(|&k| if k == 0 { 1 } else { 2 }).sum()
    }

    /// Real unknowns.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.coordinates * self.coefficients
    }

    /// Assembly and LU factors of the Jacobian: `2 c n^2 + 2/3 n^3` for c contact rows.
    #[must_use]
    pub fn per_factorisation(&self) -> f64 {
        self.whole_jacobian(self.unknowns())
    }

    fn whole_jacobian(&self, unknowns: usize) -> f64 {
        let n = unknowns as f64;
        2.0 * self.contact_rows as f64 * n * n + 2.0 / 3.0 * n.powi(3)
    }

    /// The whole Jacobian of harmonic 1 and a complex block of every harmonic `beyond`.
    fn by_harmonic(&self, beyond: f64) -> f64 {
        let coordinates = self.coordinates as f64;
        let block =
            4.0 * self.contact_rows as f64 * coordinates.powi(2) + 8.0 / 3.0 * coordinates.powi(3);
        self.whole_jacobian(2 * self.coordinates) + beyond * block
    }

    /// Triangular solves, contact displacement and force in modal coordinates, and the alternating
    /// frequency/time method.
    #[must_use]
    pub fn per_iteration(&self) -> f64 {
        let n = self.unknowns() as f64;
        2.0 * n * n + self.evaluation(self.coefficients as f64, self.samples as f64)
    }

    /// One residual with `coefficients` and `samples`.
    fn evaluation(&self, coefficients: f64, samples: f64) -> f64 {
        let rows = self.contact_rows as f64;
        let modal = 4.0 * rows * self.coordinates as f64 * coefficients;
        modal + self.contact(coefficients, samples)
    }

    /// The alternating frequency/time method at all contact rows; under a constant normal load at those along the tangents,
    /// over half a period, since all harmonics are odd.
    fn contact(&self, coefficients: f64, samples: f64) -> f64 {
        let constant = self.law.filter(|law| !law.has_variable_load());
        let (rows, samples) = match constant {
            Some(law) => (law.tangents() * self.pairs, 0.5 * samples),
            None => (self.contact_rows, samples),
        };
        let transforms = 4.0 * rows.min(self.contact_rows) as f64 * coefficients * samples;
        transforms + LAW * self.pairs as f64 * samples
    }

    /// The check of samples and harmonics that every row has: the whole Jacobian, that of harmonic 1, and a complex block of each
    /// harmonic besides, then evaluations with all harmonics up to 15.
    #[must_use]
    pub fn check(&self) -> f64 {
        let samples = CHECK_SAMPLES * self.samples as f64;
        let constant = self.law.is_some_and(|law| !law.has_variable_load());
        let (coefficients, blocks) = if constant {
            (CHECK_COEFFICIENTS_ODD as f64, CHECK_BLOCKS_ODD)
        } else {
            (CHECK_COEFFICIENTS, CHECK_BLOCKS)
        };
        let evaluation = self.evaluation(coefficients, samples);
        let factors = self.by_harmonic(blocks) + self.whole_jacobian(self.unknowns());
        factors + CHECK_ITERATIONS * evaluation
    }

    /// Operations of a row.
    #[must_use]
    pub fn operations(&self, work: &RowWork) -> f64 {
        self.search(work) + self.check() + EIGENPROBLEMS * eigenproblem(self.coordinates)
    }

    /// Operations of the search for the peak alone.
    #[must_use]
    pub fn search(&self, work: &RowWork) -> f64 {
        work.factorisations * self.per_factorisation()
            + work.newton_iterations * self.per_iteration()
    }
}

/// Operations of the eigenvalues and vectors of a symmetric matrix.
fn eigenproblem(size: usize) -> f64 {
    EIGEN * (size as f64).powi(3)
}

/// What it takes in time, counted in operations of a matrix product.
#[must_use]
pub fn time_of_eigenproblem(size: usize) -> f64 {
    SLOWER_EIGEN * eigenproblem(size)
}

/// Time that a row takes, counted from its work in operations of a matrix product: the same on every machine.
#[must_use]
pub fn counted_time(solver: &RowSolver, scenario: &Scenario, row: &ResponseRow) -> f64 {
    let size = SystemSize::of_rows(solver, scenario);
    let linear = size.law.is_none();
    let solved = if linear {
        0.0
    } else {
        size.search(&RowWork::of(row)) + size.check()
    };
    solved + EIGENPROBLEMS * time_of_eigenproblem(size.coordinates)
}

#[cfg(test)]
mod tests {
    use super::{ContactLaw, RowWork, SystemSize};

    #[test]
    fn the_cube_of_the_unknowns_leads() {
        let size = |coordinates| SystemSize {
            coordinates,
            contact_rows: 288,
            pairs: 96,
            coefficients: SystemSize::coefficients_of(&[0, 1, 3]),
            samples: 128,
            law: Some(ContactLaw::Simplified3d),
        };
        assert_eq!(size(168).unknowns(), 840);
        let work = RowWork {
            nonlinear_solves: 20.0,
            newton_iterations: 200.0,
            factorisations: 15.0,
        };
        let ratio = size(16_000).operations(&work) / size(8_000).operations(&work);
        assert!((7.0..8.0).contains(&ratio), "{ratio}");
    }
}
