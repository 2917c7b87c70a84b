//! One frequency of one row: the solution, found by a fixed ladder of attempts, and its amplitudes.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::a_posteriori::ErrorSettings;
use super::excited::Excited;
use super::observed_amplitude::ObservedAmplitude;
use super::options::{ContactCondition, SolverOptions};
use crate::linalg::{Complex64, LuWorkspace};
use crate::model::cyclic::ContactGeometry;
use crate::response::friction::{ContactLaw, PairParameters};
use crate::response::harmonic_balance::{
    ContactInterface, ContactShares, HarmonicSystem, HarmonicTransform, NewtonBounds,
    NewtonWorkspace, Status, Structure, TransformError, linear_response, solve,
};

/// Samples per period of the highest harmonic at least.
const SAMPLES_OF_HIGHEST: usize = 16;

/// Everything of a study that the solution of a point needs besides the structure.
#[derive(Debug, Clone)]
pub struct PointSettings {
    harmonics: Vec<u32>,
    transform: Arc<HarmonicTransform>,
    amplitude: ObservedAmplitude,
    errors: Arc<ErrorSettings>,
    bounds: NewtonBounds,
    contact: Option<(ContactLaw, PairParameters)>,
    geometry: ContactGeometry,
}

impl PointSettings {
    /// `harmonics` ascending, with 1; `contact` is the law with its per-sector parameters (the
    /// normal load is set per scenario).
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(
        options: &SolverOptions,
        harmonics: &[u32],
        contact: Option<(ContactLaw, PairParameters)>,
        geometry: ContactGeometry,
    ) -> Result<Self, TransformError> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let samples = samples_per_period(options, harmonics);
        let transform = HarmonicTransform::new(&set, samples)?;
        let amplitude = ObservedAmplitude::new(options.amplitude, harmonics, options.time_samples)?;
        Ok(Self {
            harmonics: harmonics.to_vec(),
            transform: Arc::new(transform),
            amplitude,
            errors: Arc::new(ErrorSettings::new(
                options,
                harmonics,
                contact.map(|(law, _)| law),
            )?),
            bounds: NewtonBounds::with_tolerance(options.residual_tolerance),
            contact,
            geometry,
        })
    }

    /// Harmonic set of the nonlinear solution.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// How the errors of a solution are estimated.
    #[must_use]
    pub fn errors(&self) -> &ErrorSettings {
        &self.errors
    }
}

/// Work done for a row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Points solved nonlinearly.
    pub nonlinear_solves: u64,
    /// Newton iterations, all attempts.
    pub newton_iterations: u64,
    /// Jacobians assembled and factored.
    pub factorisations: u64,
    /// Points that needed more than the first attempt.
    pub retries: u64,
}

/// A converged point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Real unknowns of the harmonic balance, see [`HarmonicSystem`]; for a linear limit those of
    /// harmonic 1 alone.
    pub solution: Vec<f64>,
    /// Amplitude of every blade, m.
    pub amplitudes_m: Vec<f64>,
    /// Residual relative to the excitation; 0 for a linear limit.
    pub residual: f64,
    /// Shares of slipping and separated pairs.
    pub shares: ContactShares,
}

/// Solver of the points of one row; keeps the converged points as starts for others.
pub struct PointSolver<'a> {
    excited: &'a Excited,
    condition: ContactCondition,
    settings: &'a PointSettings,
    linear: LuWorkspace<Complex64>,
    nonlinear: Option<(HarmonicSystem, NewtonWorkspace)>,
    points: Vec<Point>,
    failures: Vec<(f64, Status)>,
    work: Work,
}

impl<'a> PointSolver<'a> {
    /// A solver for `condition`, with no point solved yet.
    #[must_use]
    pub fn new(
        excited: &'a Excited,
        condition: ContactCondition,
        settings: &'a PointSettings,
    ) -> Self {
        let nonlinear = match (condition, settings.contact) {
            (ContactCondition::Full { normal_load_n }, Some((law, sector))) => {
                let interface = ContactInterface {
                    law,
                    geometry: settings.geometry.clone(),
                    pairs: pairs_under(sector, normal_load_n, &settings.geometry),
                };
                let system = HarmonicSystem::new(
                    excited.blocks.clone(),
                    excited.force.clone(),
                    interface,
                    Arc::clone(&settings.transform),
                );
                let workspace = NewtonWorkspace::new(&system);
                Some((system, workspace))
            }
            _ => None,
        };
        Self {
            excited,
            condition,
            settings,
            linear: LuWorkspace::new(excited.linear.structure.size()),
            nonlinear,
            points: Vec::new(),
            failures: Vec::new(),
            work: Work::default(),
        }
    }

    /// Converged points, in the order in which they were solved.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Frequencies that could not be solved, Hz, with the status of the last attempt.
    #[must_use]
    pub fn failures(&self) -> &[(f64, Status)] {
        &self.failures
    }

    /// Work done so far.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work
    }

    /// The nonlinear equation with its buffers; none for a linear limit.
    pub(super) fn nonlinear(&mut self) -> Option<(&HarmonicSystem, &mut NewtonWorkspace)> {
        let (system, workspace) = self.nonlinear.as_mut()?;
        Some((&*system, workspace))
    }

    /// Solves at one frequency, Hz.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    pub fn solve(&mut self, frequency_hz: f64) -> Result<&Point, Status> {
        let solved = if self.nonlinear.is_some() {
            self.solve_nonlinear(frequency_hz)
        } else {
            self.solve_linear(frequency_hz)
        };
        match solved {
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

    fn solve_linear(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let response = self.linear_at(frequency_hz)?;
        let solution = real_parts(&response);
        let blocks = [(1, &*self.excited.linear.structure)];
        Ok(Point {
            frequency_hz,
            amplitudes_m: self.settings.amplitude.of(&blocks, &solution),
            solution,
            residual: 0.0,
            shares: ContactShares::default(),
        })
    }

    /// Linear response with the springs of the condition, stuck ones for the full law.
    fn linear_at(&mut self, frequency_hz: f64) -> Result<Vec<Complex64>, Status> {
        linear_response(
            &self.excited.linear.structure,
            self.excited.linear.contact(self.condition),
            TAU * frequency_hz,
            &self.excited.force,
            &mut self.linear,
        )
        .ok_or(Status::SingularJacobian)
    }

    fn stuck_start(&mut self, frequency_hz: f64) -> Result<Vec<f64>, Status> {
        let stuck = self.linear_at(frequency_hz)?;
        let Some((system, _)) = &self.nonlinear else {
            return Err(Status::SingularJacobian);
        };
        let mut start = vec![0.0; system.unknowns()];
        let at = system.block_start(system.fundamental());
        start[at..at + 2 * stuck.len()].copy_from_slice(&real_parts(&stuck));
        Ok(start)
    }

    fn solve_nonlinear(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        self.work.nonlinear_solves += 1;
        let mut last = Status::IterationLimit;
        for (rung, attempt) in Attempt::LADDER.into_iter().enumerate() {
            match self.attempt(attempt, frequency_hz) {
                Ok(point) => {
                    self.work.retries += u64::from(rung > 0);
                    return Ok(point);
                }
                Err(status) => last = status,
            }
        }
        self.work.retries += 1;
        Err(last)
    }

    fn attempt(&mut self, attempt: Attempt, frequency_hz: f64) -> Result<Point, Status> {
        match attempt {
            Attempt::Neighbours => {
                let start = match self.between(frequency_hz) {
                    Some(start) => start,
                    None => self.stuck_start(frequency_hz)?,
                };
                self.newton(frequency_hz, start, 1.0)
            }
            Attempt::Stuck => {
                let start = self.stuck_start(frequency_hz)?;
                self.newton(frequency_hz, start, 1.0)
            }
            Attempt::FrequencySteps => self.step_in_frequency(frequency_hz),
            Attempt::LoadHomotopy => self.lower_normal_load(frequency_hz),
        }
    }

    /// Linear interpolation between the nearest converged points on either side, or the nearest
    /// one where there is none on the other side.
    fn between(&self, frequency_hz: f64) -> Option<Vec<f64>> {
        let below = self
            .points
            .iter()
            .filter(|point| point.frequency_hz <= frequency_hz)
            .max_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let above = self
            .points
            .iter()
            .filter(|point| point.frequency_hz > frequency_hz)
            .min_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let (Some(below), Some(above)) = (below, above) else {
            return below.or(above).map(|point| point.solution.clone());
        };
        let share = (frequency_hz - below.frequency_hz) / (above.frequency_hz - below.frequency_hz);
        let pairs = below.solution.iter().zip(&above.solution);
        Some(pairs.map(|(a, b)| a + share * (b - a)).collect())
    }

    fn nearest(&self, frequency_hz: f64) -> Option<&Point> {
        self.points.iter().min_by(|a, b| {
            let distance = |point: &Point| (point.frequency_hz - frequency_hz).abs();
            distance(a).total_cmp(&distance(b))
        })
    }

    /// Newton's method from `start`, the normal load multiplied by `load_factor`.
    fn newton(
        &mut self,
        frequency_hz: f64,
        start: Vec<f64>,
        load_factor: f64,
    ) -> Result<Point, Status> {
        let Some((system, workspace)) = &mut self.nonlinear else {
            return Err(Status::SingularJacobian);
        };
        let mut x = start;
        let omega = TAU * frequency_hz;
        let bounds = self.settings.bounds;
        let outcome = if load_factor.total_cmp(&1.0).is_eq() {
            solve(system, omega, &mut x, bounds, workspace)
        } else {
            let scaled = system
                .pairs()
                .iter()
                .map(|pair| PairParameters {
                    normal_load_n: load_factor * pair.normal_load_n,
                    ..*pair
                })
                .collect();
            solve(&system.with_pairs(scaled), omega, &mut x, bounds, workspace)
        };
        self.work.newton_iterations += outcome.iterations;
        self.work.factorisations += outcome.factorisations;
        if outcome.status != Status::Ok {
            return Err(outcome.status);
        }
        let blocks: Vec<(u32, &Structure)> = self
            .excited
            .blocks
            .iter()
            .map(|block| (block.harmonic, &*block.structure))
            .collect();
        Ok(Point {
            frequency_hz,
            amplitudes_m: self.settings.amplitude.of(&blocks, &x),
            solution: x,
            residual: outcome.residual,
            shares: outcome.shares,
        })
    }

    /// Continuation in frequency from the nearest converged point, the step halved on failure.
    fn step_in_frequency(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        const SMALLEST_SHARE: f64 = 1.0 / 64.0;
        let Some(from) = self.nearest(frequency_hz).cloned() else {
            return Err(Status::StepTooSmall);
        };
        let span = frequency_hz - from.frequency_hz;
        let (mut done, mut share, mut current) = (0.0, 0.25, from.solution);
        loop {
            let next: f64 = f64::min(done + share, 1.0);
            let at = if next >= 1.0 {
                frequency_hz
            } else {
                from.frequency_hz + next * span
            };
            match self.newton(at, current.clone(), 1.0) {
                Ok(point) if next >= 1.0 => return Ok(point),
                Ok(point) => {
                    current = point.solution;
                    done = next;
                }
                Err(_) if share > SMALLEST_SHARE => share *= 0.5,
                Err(_) => return Err(Status::StepTooSmall),
            }
        }
    }

    /// Homotopy in normal load: from a load at which every pair sticks down to that of the
    /// scenario, the step (in the logarithm of the load) halved on failure.
    fn lower_normal_load(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        const FIRST_FACTOR: f64 = 64.0;
        const SMALLEST_STEP: f64 = 1.0 / 64.0;
        let mut current = self.stuck_start(frequency_hz)?;
        let (mut exponent, mut step) = (1.0, 0.25);
        loop {
            let next = f64::max(exponent - step, 0.0);
            match self.newton(frequency_hz, current.clone(), FIRST_FACTOR.powf(next)) {
                Ok(point) if next <= 0.0 => return Ok(point),
                Ok(point) => {
                    current = point.solution;
                    exponent = next;
                }
                Err(_) if step > SMALLEST_STEP => step *= 0.5,
                Err(_) => return Err(Status::StepTooSmall),
            }
        }
    }
}

/// Those asked for, and at least [`SAMPLES_OF_HIGHEST`] per period of the highest harmonic.
pub(super) fn samples_per_period(options: &SolverOptions, harmonics: &[u32]) -> usize {
    let highest = harmonics.last().map_or(1, |&k| k as usize);
    options.samples_per_period.max(SAMPLES_OF_HIGHEST * highest)
}

/// Attempts at one point, in order.
#[derive(Debug, Clone, Copy)]
enum Attempt {
    /// From the converged points beside it, or from the stuck solution if there is none.
    Neighbours,
    /// From the stuck solution.
    Stuck,
    /// Continuation in frequency.
    FrequencySteps,
    /// Homotopy in normal load.
    LoadHomotopy,
}

impl Attempt {
    const LADDER: [Self; 4] = [
        Self::Neighbours,
        Self::Stuck,
        Self::FrequencySteps,
        Self::LoadHomotopy,
    ];
}

fn real_parts(x: &[Complex64]) -> Vec<f64> {
    x.iter()
        .map(|x| x.re)
        .chain(x.iter().map(|x| x.im))
        .collect()
}

fn pairs_under(
    sector: PairParameters,
    normal_load_n: f64,
    geometry: &ContactGeometry,
) -> Vec<PairParameters> {
    let sector = PairParameters {
        normal_load_n,
        ..sector
    };
    geometry
        .weights
        .iter()
        .map(|&weight| sector.share(weight))
        .collect()
}
