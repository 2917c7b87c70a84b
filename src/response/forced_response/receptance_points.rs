//! The solver of the points of a row on tuned receptances, and the contact that it solves them with.

use std::sync::Arc;

use super::initial_guess::{between_neighbours, nearest};
use super::observed_amplitude::{ObservedAmplitude, ObservedHarmonic};
use super::options::ContactCondition;
use super::peak::{SearchPlan, Window, search_plan_of};
use super::point::{Point, Work, point_at};
use super::point_settings::PointSettings;
use super::point_source::PointSource;
use super::softer_contact::from_softer_contact;
use crate::linalg::Complex64;
use crate::response::harmonic_balance::{HarmonicTransform, PairContact, Status, WheelContact};
use crate::response::receptance::{
    EngineWheel, Limit, ReceptanceEngine, Resonance, WaveForce, WheelSolution, WheelSolver,
    embedded,
};

/// Points that the search of a row may lose before it is over: each takes as long as many that are found.
const MOST_FAILURES: usize = 8;

/// Steps after which all harmonics are given up at a point, where fewer of them follow. Under loads at which every wheel that judges has a
/// peak with all of them, no point of eight studies took more than 1900 (`docs/trials.md`, "Light loads").
const STEPS_OF_ALL: u64 = 2_500;

/// One wheel on an engine under one excitation and contact condition.
#[derive(Debug, Clone, Copy)]
pub struct EngineRow<'a> {
    /// What the rows of a study share.
    pub engine: &'a ReceptanceEngine,
    /// The wheel.
    pub wheel: &'a EngineWheel,
    /// The excitation.
    pub force: &'a WaveForce,
    /// The contact condition.
    pub condition: ContactCondition,
}

impl ContactCondition {
    /// The linear limit whose springs a solution under the condition is built on.
    #[must_use]
    pub fn limit(self) -> Limit {
        match self {
            Self::Full { .. } | Self::Stuck => Limit::Stuck,
            Self::Slide => Limit::Slide,
            Self::Free => Limit::Free,
        }
    }

    /// The linear limits that bound a solution under the condition, the stuck one first.
    #[must_use]
    pub fn bounding_limits(self) -> Vec<Limit> {
        match self {
            Self::Full { .. } => vec![Limit::Stuck, Limit::Slide],
            other => vec![other.limit()],
        }
    }
}

impl<'a> EngineRow<'a> {
    /// Resonances of the linear limits that bound the condition, the stuck one first; none if they are not found.
    #[must_use]
    pub fn linear_peaks(&self) -> Option<Vec<Vec<Resonance>>> {
        let limits = self.condition.bounding_limits().into_iter();
        limits
            .map(|limit| self.engine.peaks(limit, self.wheel, self.force))
            .collect()
    }

    /// Solver in the harmonics of `transform`.
    pub(super) fn solver(
        &self,
        settings: &PointSettings,
        transform: &Arc<HarmonicTransform>,
    ) -> WheelSolver<'a> {
        let contact = self.contact(settings, transform);
        self.solver_with(contact, settings, transform)
    }

    /// Solver of a row that is no linear limit, under a contact whose tangential stiffness is that of the settings times `factor`.
    pub(super) fn softened_solver(&self, settings: &PointSettings, factor: f64) -> WheelSolver<'a> {
        let contact = settings.contact.map(|(law, sector)| {
            let load_n = self.condition.normal_load_n().unwrap_or(0.0);
            let mut interface = settings.interface(law, sector, load_n);
            let sectors = self.engine.sectors();
            if interface.pairs.len() == interface.per_sector() {
                interface.pairs = interface.pairs.repeat(sectors);
            }
            for pair in &mut interface.pairs {
                pair.tangential_stiffness_n_per_m *= factor;
            }
            let springs = self.engine.springs(self.condition.limit());
            WheelContact::new(interface, sectors, springs, Arc::clone(&settings.transform))
        });
        self.solver_with(contact, settings, &settings.transform)
    }

    fn solver_with(
        &self,
        contact: Option<WheelContact>,
        settings: &PointSettings,
        transform: &HarmonicTransform,
    ) -> WheelSolver<'a> {
        let set: Vec<u32> = transform.harmonics().iter().map(|&k| k as u32).collect();
        let limit = self.condition.limit();
        WheelSolver::new(self.engine, self.wheel, limit, self.force, &set, contact)
            .with_ring(settings.ring)
    }

    /// The contact in the harmonics of `transform`; none for a linear limit of a wheel whose contact is nominal, and without springs.
    pub(super) fn contact(
        &self,
        settings: &PointSettings,
        transform: &Arc<HarmonicTransform>,
    ) -> Option<WheelContact> {
        let limit = self.condition.limit();
        let springs = self.engine.springs(limit);
        let acts = |_: &_| !springs.is_empty();
        let varied = !settings.factors.is_nominal();
        let load_n = self.condition.normal_load_n();
        let contact = settings.contact.filter(acts);
        let contact = contact.filter(|_| load_n.is_some() || varied);
        contact.map(|(law, sector)| {
            let own_springs = settings.factors.springs(springs, &settings.geometry.rows);
            let interface = settings.interface(law, sector, load_n.unwrap_or(0.0));
            let sectors = self.engine.sectors();
            let contact = WheelContact::new(interface, sectors, springs, Arc::clone(transform));
            if load_n.is_some() {
                contact
            } else {
                contact.linear(&own_springs, springs)
            }
        })
    }
}

/// Solver of the points of one row; keeps the converged points as starts for others.
pub(super) struct ReceptancePoints<'a> {
    pub(super) solver: WheelSolver<'a>,
    row: EngineRow<'a>,
    settings: &'a PointSettings,
    pub(super) points: Vec<Point>,
    failures: Vec<(f64, Status)>,
    precision: f64,
    is_nonlinear: bool,
    /// Whether the frequency before was lost, so that this one is tried once.
    beside_lost: bool,
    work: Work,
}

impl<'a> ReceptancePoints<'a> {
    pub(super) fn new(row: &EngineRow<'a>, settings: &'a PointSettings) -> Self {
        let mut solver = row.solver(settings, &settings.transform);
        solver.effort().takes_whole = settings.search().is_none();
        if settings.guide().is_some() {
            solver.effort().most_steps = STEPS_OF_ALL;
        }
        Self {
            solver,
            row: *row,
            settings,
            points: Vec::new(),
            failures: Vec::new(),
            precision: 0.0,
            is_nonlinear: row.condition.normal_load_n().is_some(),
            beside_lost: false,
            work: Work::default(),
        }
    }

    fn solve(&mut self, frequency_hz: f64, tolerance: f64) -> Result<Point, Status> {
        let known = between_neighbours(&self.points, &self.solver, frequency_hz);
        let mut starts: Vec<Vec<f64>> = known.into_iter().collect();
        let opening = self.settings.opening().filter(|_| self.beside_lost);
        let guide = self.settings.guide().or(opening);
        if let Some(guide) = guide.filter(|_| starts.is_empty() && self.is_nonlinear) {
            // From the linear response many harmonics at once are hard to find.
            let mut few = Self::new(&self.row, guide);
            let led = few.solve_from(frequency_hz, &[], tolerance);
            self.work = self.work.plus(few.work);
            let set = self.solver.harmonics();
            starts.extend(led.map(|led| embedded(&led.solution, &guide.harmonics, set)));
        }
        self.solve_from(frequency_hz, &starts, tolerance)
    }

    /// The point at a frequency, Hz, from the best of `starts`.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    pub(super) fn solve_from(
        &mut self,
        frequency_hz: f64,
        starts: &[Vec<f64>],
        tolerance: f64,
    ) -> Result<Point, Status> {
        let near = nearest(&self.points, frequency_hz);
        self.solver
            .set_ring_drift(near.map_or([0.0; 2], |point| point.ring_drift_m));
        let (mut solved, mut work) = self.solver.solve(frequency_hz, starts, tolerance);
        let goes_softer = self.is_nonlinear && !self.beside_lost && self.solver.has_few_unknowns();
        if solved.is_err() && goes_softer {
            let softer = from_softer_contact(|share, starts| {
                let mut solver = self.row.softened_solver(self.settings, share);
                let (solved, own) = solver.solve(frequency_hz, starts, tolerance);
                work = work.plus(own);
                Some(solved.ok()?.motions)
            });
            if let Some(start) = softer {
                let (again, own) = self.solver.solve(frequency_hz, &[start], tolerance);
                (solved, work) = (again, work.plus(own));
            }
        }
        self.work.nonlinear_solves += u64::from(self.is_nonlinear);
        self.work.newton_iterations += work.iterations;
        self.work.factorisations += work.tangents;
        self.work.retries += work.retries;
        let WheelSolution {
            motions,
            residual,
            shares,
        } = solved?;
        let observed = observed(&mut self.solver, &self.settings.amplitude);
        let amplitudes_m = self.settings.amplitude.of_observed(&observed);
        if amplitudes_m.iter().any(|amplitude| !amplitude.is_finite()) {
            return Err(Status::NonFinite);
        }
        Ok(Point {
            frequency_hz,
            solution: motions,
            amplitudes_m,
            residual,
            shares,
            ring_drift_m: self.solver.ring_drift_m(),
        })
    }

    /// Amplitude of every blade at the solution last solved, over what `few` take for it in the harmonics that they count.
    pub(super) fn growth_over(&mut self, few: &Self) -> Vec<f64> {
        growth_of(&mut self.solver, self.settings, &few.solver, few.settings)
    }

    /// Whether the next frequency is tried once, or by every attempt.
    fn try_once_if(&mut self, beside_lost: bool) {
        self.beside_lost = beside_lost;
        let most_attempts = if beside_lost { 1 } else { usize::MAX };
        self.solver.effort().most_attempts = most_attempts;
    }

    pub(super) fn residual_is_stated(&self) -> bool {
        self.settings.residual_is_stated
    }

    /// Tolerance of the residual that is asked for.
    pub(super) fn least_tolerance(&self) -> f64 {
        self.settings.bounds.residual_tolerance
    }

    fn tolerance(&self) -> f64 {
        self.settings.bounds.residual_tolerance.max(self.precision)
    }

    /// Points that a search may lose before it is over. Where fewer harmonics follow, the first lost point ends it.
    fn most_failures(&self) -> usize {
        if self.settings.fewer_follow() {
            0
        } else {
            MOST_FAILURES
        }
    }

    fn added(&mut self, frequency_hz: f64) -> Result<&Point, Status> {
        match self.solve(frequency_hz, self.tolerance()) {
            Ok(point) => {
                self.points.push(point);
                Ok(&self.points[self.points.len() - 1])
            }
            Err(status) => {
                self.failures.push((frequency_hz, status));
                Err(status)
            }
        }
    }
}

impl PointSource for ReceptancePoints<'_> {
    fn amplitudes_at(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
        if let Some(point) = point_at(&self.points, frequency_hz) {
            return Some(point.amplitudes_m.clone());
        }
        if self.failures.len() > self.most_failures() {
            return None;
        }
        let point = self.added(frequency_hz).ok()?;
        Some(point.amplitudes_m.clone())
    }

    fn points(&self) -> &[Point] {
        &self.points
    }

    fn failures(&self) -> &[(f64, Status)] {
        &self.failures
    }

    fn finished(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let same = |point: &Point| point.frequency_hz.total_cmp(&frequency_hz).is_eq();
        let tolerance = self.settings.bounds.residual_tolerance;
        let point = self.solve(frequency_hz, tolerance)?;
        self.points.retain(|known| !same(known));
        self.points.push(point.clone());
        Ok(point)
    }

    fn set_precision(&mut self, share: f64) {
        self.precision = share;
    }

    fn mean_friction_n(&mut self, point: &Point) -> Option<[f64; 2]> {
        self.solver.set_ring_drift(point.ring_drift_m);
        let force = self.solver.mean_friction_n(&point.solution);
        force.filter(|_| self.is_nonlinear)
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// What is observed of the solution last solved, in every harmonic that the amplitude takes notice of.
pub(super) fn observed(
    solver: &mut WheelSolver<'_>,
    amplitude: &ObservedAmplitude,
) -> Vec<ObservedHarmonic> {
    let set = solver.harmonics().to_vec();
    let blades = solver.sectors();
    set.into_iter()
        .enumerate()
        .map(|(place, harmonic)| ObservedHarmonic {
            harmonic,
            displacement: if amplitude.counts(harmonic) && harmonic > 0 {
                solver.observed(place)
            } else {
                vec![Complex64::default(); 3 * blades]
            },
        })
        .collect()
}

/// Amplitude of every blade at the solution last solved by `all`, over what `few` take for it in the harmonics that they count.
pub(super) fn growth_of(
    all: &mut WheelSolver<'_>,
    of_all: &PointSettings,
    few: &WheelSolver<'_>,
    of_few: &PointSettings,
) -> Vec<f64> {
    let observed = observed(all, &of_all.amplitude);
    let counted = observed.iter();
    let counted = counted.filter(|observed| few.harmonics().contains(&observed.harmonic));
    let counted: Vec<ObservedHarmonic> = counted.cloned().collect();
    let by_few = of_few.amplitude.of_observed(&counted).into_iter();
    let amplitudes = of_all.amplitude.of_observed(&observed).into_iter();
    amplitudes
        .zip(by_few)
        .map(|(amplitude, few)| amplitude / few)
        .collect()
}

/// The plan of the search for the peak of a row, see [`super::search_plan`].
///
/// # Errors
/// The resonances are not found or not finite, or nothing answers the excitation.
pub fn receptance_plan(row: &EngineRow<'_>, window: Window) -> Result<SearchPlan, Status> {
    let limits = row.linear_peaks().ok_or(Status::NonFinite)?;
    search_plan_of(&limits, window)
}

/// The point of a row at a frequency, Hz, with the state of every contact pair; none for a linear limit.
///
/// # Errors
/// The status of the last attempt, if none converged.
pub fn receptance_state(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    frequency_hz: f64,
) -> Result<(Point, Option<Vec<PairContact>>), Status> {
    let mut solver = ReceptancePoints::new(row, settings);
    let point = solver.finished(frequency_hz)?;
    let states = solver.solver.contact_states();
    Ok((point, states.filter(|_| solver.is_nonlinear)))
}

/// A harmonic and its complex motion of every contact row, m, sector after sector.
pub type ContactMotion = (u32, Vec<Complex64>);

/// The motion of every contact row of a row at a frequency, Hz, in every harmonic of `settings`, sector after sector, solved beside
/// that in the harmonics of `coarse`; none for a linear limit.
///
/// # Errors
/// The status of the last attempt, if none converged.
pub fn receptance_contact_motion(
    row: &EngineRow<'_>,
    coarse: &PointSettings,
    settings: &PointSettings,
    frequency_hz: f64,
) -> Result<Option<Vec<ContactMotion>>, Status> {
    let beside = ReceptancePoints::new(row, coarse).finished(frequency_hz)?;
    let mut solver = ReceptancePoints::new(row, settings);
    let (few, all) = (&coarse.harmonics, solver.solver.harmonics());
    let start = embedded(&beside.solution, few, all);
    solver.solve_from(frequency_hz, &[start], settings.bounds.residual_tolerance)?;
    let motion = solver.solver.contact_motion();
    Ok(motion.filter(|_| solver.is_nonlinear))
}

/// Points of a row at the given frequencies, Hz, in their order, with a residual tolerance of at least `least_tolerance`.
///
/// With automatic sets of many harmonics there mostly is no solution next to a frequency without one, and all attempts take as long as a
/// hundred that are found. The frequencies after such a one are tried once each, until one is found.
#[must_use]
pub fn receptance_curve(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    frequencies_hz: &[f64],
    least_tolerance: f64,
) -> Vec<(f64, Result<Point, Status>)> {
    let mut solver = ReceptancePoints::new(row, settings);
    solver.set_precision(least_tolerance);
    let solve = |&hz: &f64| {
        let point = solver.added(hz).cloned();
        solver.try_once_if(point.is_err() && settings.fewer_follow());
        (hz, point)
    };
    frequencies_hz.iter().map(solve).collect()
}
