//! A cheap stand-in for the peak amplitude of a row: few modes, the fundamental alone.
//!
//! The contact of the tuned wheel at its peak, linearised harmonically, gives every row of contact an
//! equivalent spring. With these springs a mistuned wheel has modes close to the shapes in which it
//! vibrates under friction; those near the tuned peak, with those of sticking and sliding contact, span
//! the space in which harmonic balance with the fundamental alone, few samples and a loose tolerance
//! finds the peak. The friction is that of
//! the wheel at its own amplitude, pair by pair; what is lost are higher harmonics and the modes far
//! away. It ranks patterns; it is no answer.

use std::f64::consts::TAU;

use super::operations::{RowWork, SystemSize, time_of_eigenproblem};
use super::{RowSolver, Scenario, TunedReference};
use crate::linalg::{Matrix, hermitian_eigen, orthonormal_basis};
use crate::response::forced_response::{
    ContactCondition, LimitsWanted, PointSettings, PointSolver, SolverOptions, Wheel, peak,
};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{Pattern, StructuralModes};
use crate::response::receptance::SHIFT_BY_DEVIATION;

/// Modes within this share of the frequency of the tuned peak, besides what mistuning moves them.
const REACH: f64 = 0.3;
/// Singular value below which a direction of the space counts as one that is in it already.
const DEPENDENT: f64 = 1e-4;
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
    /// Linear springs of the contact in the coordinates of the wheel, each `size x size`.
    contact_stiffness: Vec<Matrix<f64>>,
    points: PointSettings,
}

impl<'a> Surrogate<'a> {
    /// For the rows of `scenario` by `solver`; none where the tuned wheel has no peak to linearise at.
    #[must_use]
    pub fn new(solver: &'a RowSolver, scenario: &Scenario, tuned: &TunedReference) -> Option<Self> {
        let tuned_hz = tuned.frequency_hz.filter(|_| tuned.status == Status::Ok)?;
        let rows = solver.basis().contact();
        let stiffness = |springs: Vec<f64>| {
            let scaled = Matrix::from_fn(rows.rows(), rows.columns(), |i, j| {
                springs[i % springs.len()] * rows[(i, j)]
            });
            rows.adjoint_times(&scaled)
        };
        let springs = linear_springs(solver, scenario)?;
        let options = SolverOptions {
            samples_per_period: SAMPLES,
            residual_tolerance: RESIDUAL_TOLERANCE,
            ..solver.settings().solver.clone()
        };
        let points = PointSettings::new(
            &options,
            &[1],
            solver.settings().contact,
            solver.basis().model().contact.clone(),
        );
        Some(Self {
            solver,
            scenario: *scenario,
            tuned_hz,
            contact_stiffness: springs.into_iter().map(stiffness).collect(),
            points: points.ok()?,
        })
    }
}

/// Springs of a sector, N/m, whose modes the wheel vibrates in: those equivalent to the contact
/// of the tuned wheel at its peak, and its two limits; of a linear limit its own.
fn linear_springs(solver: &RowSolver, scenario: &Scenario) -> Option<Vec<Vec<f64>>> {
    let springs = &solver.basis().model().springs;
    let (engine_order, contact) = (scenario.engine_order, scenario.contact);
    match contact {
        ContactCondition::Stuck => return Some(vec![springs.stick.clone()]),
        ContactCondition::Slide => return Some(vec![springs.slide.clone()]),
        ContactCondition::Free => return Some(vec![vec![0.0; springs.slide.len()]]),
        ContactCondition::Full { .. } => {}
    }
    let point = solver.tuned_peak(engine_order, contact).point?;
    let excited = solver.on_basis.tuned_excited(engine_order, contact);
    let mut points = PointSolver::new(&excited, contact, solver.points(scenario));
    let equivalent = points.equivalent_springs(&point)?;
    Some(vec![
        equivalent.iter().map(|spring| spring.re).collect(),
        springs.stick.clone(),
        springs.slide.clone(),
    ])
}

/// The stand-in of one pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurrogatePeak {
    /// Approximate peak amplitude, m.
    pub amplitude_m: f64,
    /// What it took, in the unit of [`super::counted_time`].
    pub counted_time: f64,
}

impl Surrogate<'_> {
    /// Approximate peak of a pattern; none where it has none.
    #[must_use]
    pub fn peak(&self, pattern: &Pattern) -> Option<SurrogatePeak> {
        let solver = self.solver;
        let change = solver.on_basis.stiffness_change(pattern)?;
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
            solver.settings().damping,
            LimitsWanted::of(&[contact]),
        );
        let window = solver
            .on_basis
            .window(pattern, &self.scenario, Some(self.tuned_hz))
            .ok()?;
        let points = self.points.with_factors(&pattern.contact);
        let excited = solver
            .on_basis
            .wheel_excited(&modes, &wheel, engine_order, &[1]);
        let found = peak(&excited, contact, &points, window, PEAK_TOLERANCE);
        let amplitude_m = found.amplitude_m().filter(|metres| metres.is_finite())?;
        let work = RowWork {
            nonlinear_solves: found.work.nonlinear_solves as f64,
            newton_iterations: found.work.newton_iterations as f64,
            factorisations: found.work.factorisations as f64,
        };
        Some(SurrogatePeak {
            amplitude_m,
            counted_time: self.counted_time(shapes.columns(), &work),
        })
    }

    /// The modes with every kind of linear springs, the space they span, and the search in it.
    fn counted_time(&self, vectors: usize, work: &RowWork) -> f64 {
        let full = self.solver.basis().size();
        let springs = self.contact_stiffness.len() as f64;
        let (n, m) = (full as f64, vectors as f64);
        let system = SystemSize {
            coordinates: vectors,
            coefficients: 2,
            samples: SAMPLES,
            ..SystemSize::of_rows(self.solver, &self.scenario)
        };
        let projection = 2.0 * n * m * (n + 2.0 * m);
        springs * time_of_eigenproblem(full)
            + time_of_eigenproblem(vectors)
            + projection
            + system.search(work)
    }

    /// Orthonormal basis of the modes near the tuned peak, of all linear springs together.
    fn shapes(&self, change: &Matrix<f64>, largest_deviation: f64) -> Option<Matrix<f64>> {
        let reach = REACH + SHIFT_BY_DEVIATION * largest_deviation;
        let mut found: Option<Matrix<f64>> = None;
        for springs in &self.contact_stiffness {
            let near = self.near_modes(change, springs, reach)?;
            found = Some(found.map_or_else(|| near.clone(), |found| found.beside(&near)));
        }
        let found = found.filter(|found| found.columns() > 0)?;
        if self.contact_stiffness.len() == 1 {
            return Some(found);
        }
        let identity = Matrix::identity(found.rows());
        let basis = orthonormal_basis(&found, &identity, DEPENDENT).ok()?;
        Some(basis.vectors)
    }

    /// Modes with linear springs whose frequencies are within the share `reach` of the tuned peak.
    fn near_modes(
        &self,
        change: &Matrix<f64>,
        springs: &Matrix<f64>,
        reach: f64,
    ) -> Option<Matrix<f64>> {
        let mut stiffness = change.clone();
        for (sum, &spring) in stiffness.as_mut_slice().iter_mut().zip(springs.as_slice()) {
            *sum += spring;
        }
        for (i, &eigenvalue) in self.solver.basis().eigenvalues().iter().enumerate() {
            stiffness[(i, i)] += eigenvalue;
        }
        let (eigenvalues, shapes) = hermitian_eigen(&stiffness).ok()?;
        let share = |eigenvalue: f64| eigenvalue.max(0.0).sqrt() / TAU / self.tuned_hz - 1.0;
        let first = eigenvalues.partition_point(|&eigenvalue| share(eigenvalue) <= -reach);
        let end = eigenvalues.partition_point(|&eigenvalue| share(eigenvalue) < reach);
        Some(shapes.column_range(first, end.max(first)))
    }
}
