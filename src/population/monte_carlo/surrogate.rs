//! A cheap stand-in for the peak amplitude of a row: few modes, the fundamental alone.
//!
//! The contact of the tuned wheel at its peak, linearised harmonically, gives every row of contact an
//! equivalent spring. With these springs a mistuned wheel has modes close to the shapes in which it
//! vibrates under friction; those near the tuned peak span the space in which harmonic balance with
//! the fundamental alone, few samples and a loose tolerance finds the peak. The friction is that of
//! the wheel at its own amplitude, pair by pair; what is lost are higher harmonics and the modes far
//! away. It ranks patterns; it is no answer.

use std::f64::consts::TAU;

use super::{RowSolver, Scenario, TunedReference};
use crate::linalg::{Matrix, hermitian_eigen};
use crate::response::forced_response::{
    ContactCondition, LimitsWanted, PointSettings, PointSolver, SolverOptions, Wheel, peak,
};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{Pattern, StructuralModes};

/// Modes within this share of the frequency of the tuned peak, besides what mistuning moves them.
const REACH: f64 = 0.3;
/// Samples per period.
const SAMPLES: usize = 32;
/// Tolerance of the residual of harmonic balance.
const RESIDUAL_TOLERANCE: f64 = 1e-5;
/// Tolerance of the peak.
const PEAK_TOLERANCE: f64 = 3e-3;

/// The stand-in for one scenario.
#[derive(Debug)]
pub struct Surrogate<'a> {
    solver: &'a RowSolver,
    scenario: Scenario,
    tuned_hz: f64,
    /// Equivalent springs of the contact in the coordinates of the wheel, `size x size`.
    contact_stiffness: Matrix<f64>,
    points: PointSettings,
}

impl RowSolver {
    /// The stand-in for the rows of `scenario`; none where the tuned wheel has no peak to linearise at.
    #[must_use]
    pub fn surrogate(&self, scenario: &Scenario, tuned: &TunedReference) -> Option<Surrogate<'_>> {
        let tuned_hz = tuned.frequency_hz.filter(|_| tuned.status == Status::Ok)?;
        let springs = self.equivalent_springs(scenario)?;
        let rows = self.basis().contact();
        let scaled = Matrix::from_fn(rows.rows(), rows.columns(), |i, j| {
            springs[i % springs.len()] * rows[(i, j)]
        });
        let options = SolverOptions {
            samples_per_period: SAMPLES,
            residual_tolerance: RESIDUAL_TOLERANCE,
            ..self.settings.solver.clone()
        };
        let points = PointSettings::new(
            &options,
            &[1],
            self.settings.contact,
            self.basis().model().contact.clone(),
        );
        Some(Surrogate {
            solver: self,
            scenario: *scenario,
            tuned_hz,
            contact_stiffness: rows.adjoint_times(&scaled),
            points: points.ok()?,
        })
    }

    /// Stiffness of the equivalent springs of a sector at the tuned peak, N/m.
    fn equivalent_springs(&self, scenario: &Scenario) -> Option<Vec<f64>> {
        let model = self.basis().model();
        match scenario.contact {
            ContactCondition::Stuck => return Some(model.springs.stick.clone()),
            ContactCondition::Slide => return Some(model.springs.slide.clone()),
            ContactCondition::Free => return Some(vec![0.0; model.springs.slide.len()]),
            ContactCondition::Full { .. } => {}
        }
        let point = self
            .tuned_peak(scenario.engine_order, scenario.contact)
            .point?;
        let excited = self.tuned_excited(scenario.engine_order, scenario.contact);
        let points = self.points(scenario.engine_order, scenario.contact);
        let springs =
            PointSolver::new(&excited, scenario.contact, points).equivalent_springs(&point)?;
        Some(springs.iter().map(|spring| spring.re).collect())
    }
}

impl Surrogate<'_> {
    /// Approximate peak amplitude of a pattern, m; none where it has none.
    #[must_use]
    pub fn peak_amplitude_m(&self, pattern: &Pattern) -> Option<f64> {
        let solver = self.solver;
        let change = solver.stiffness_change(pattern)?;
        let shapes = self.shapes(&change, pattern.largest_deviation())?;
        let modes = StructuralModes::of_subspace(solver.basis(), &change, &shapes)?;
        let Scenario {
            engine_order,
            contact,
            ..
        } = self.scenario;
        let wheel = Wheel::mistuned(
            modes.clone(),
            solver.basis().model(),
            &pattern.contact,
            solver.settings.damping,
            LimitsWanted::of(&[contact]),
        );
        let window = solver
            .window(pattern, &self.scenario, Some(self.tuned_hz))
            .ok()?;
        let points = self.points.with_factors(&pattern.contact);
        let excited = solver.wheel_excited(&modes, &wheel, engine_order, &[1]);
        peak(&excited, contact, &points, window, PEAK_TOLERANCE)
            .amplitude_m()
            .filter(|amplitude| amplitude.is_finite())
    }

    /// Modes of the wheel with the equivalent springs near the tuned peak.
    fn shapes(&self, change: &Matrix<f64>, largest_deviation: f64) -> Option<Matrix<f64>> {
        let mut stiffness = change.clone();
        let springs = self.contact_stiffness.as_slice();
        for (sum, &spring) in stiffness.as_mut_slice().iter_mut().zip(springs) {
            *sum += spring;
        }
        for (i, &eigenvalue) in self.solver.basis().eigenvalues().iter().enumerate() {
            stiffness[(i, i)] += eigenvalue;
        }
        let (eigenvalues, shapes) = hermitian_eigen(&stiffness).ok()?;
        let reach = REACH + 0.6 * largest_deviation;
        let near = |&eigenvalue: &f64| {
            let share = eigenvalue.max(0.0).sqrt() / TAU / self.tuned_hz;
            (share - 1.0).abs() < reach
        };
        let first = eigenvalues.iter().position(|own| near(own))?;
        let count = eigenvalues[first..]
            .iter()
            .take_while(|own| near(own))
            .count();
        Some(shapes.column_range(first, first + count))
    }
}
