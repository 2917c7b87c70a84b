//! One point by harmonic balance and by time integration, with the same viscous damping.

use std::f64::consts::TAU;

use serde::Serialize;

use super::motion::Motion;
use super::options::TimeOptions;
use super::settle::{Settled, settle};
use super::stability::{PeriodicMotion, periodic_motion};
use super::state::{MarchedWheel, WheelState};
use crate::linalg::Matrix;
use crate::response::forced_response::{
    AmplitudeMeasure, ContactCondition, Excited, LimitsWanted, Point, PointSettings, PointSolver,
    SolverOptions, Wheel, wheel_force,
};
use crate::response::friction::{ContactLaw, PairParameters};
use crate::response::harmonic_balance::{ContactInterface, Damping, Status};
use crate::response::mistuning::{ContactFactors, StructuralModes, WheelBasis};

/// A point of a row: everything that both paths start from.
#[derive(Debug, Clone, Copy)]
pub struct PointCase<'a> {
    /// The wheel's coordinates.
    pub basis: &'a WheelBasis,
    /// Change of its stiffness by a pattern; none for the tuned wheel, whose harmonic balance is
    /// solved on one sector and whose whole wheel is marched.
    pub stiffness_change: Option<&'a Matrix<f64>>,
    /// Damping of the study. A structural loss factor is replaced on both sides by the viscous
    /// `C = eta K / omega` at the frequency of the point.
    pub damping: Damping,
    /// Engine order.
    pub engine_order: u32,
    /// Factor on the model's force vector.
    pub amplitude_n: f64,
    /// Contact law.
    pub law: ContactLaw,
    /// Contact parameters of a sector, its normal load included.
    pub sector: PairParameters,
    /// Contact of the wheel relative to that.
    pub factors: &'a ContactFactors,
    /// Harmonics of the harmonic balance, ascending, with 1.
    pub harmonics: &'a [u32],
    /// Settings of the harmonic balance; its measure of amplitude is that of the comparison.
    pub solver: &'a SolverOptions,
    /// Frequency, Hz.
    pub frequency_hz: f64,
}

/// One step size of the step study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepStudy {
    /// Steps per period.
    pub steps_per_period: usize,
    /// Periods marched with them.
    pub periods: usize,
    /// How that march ended.
    pub status: Status,
    /// Largest amplitude of a blade, m.
    pub largest_m: f64,
}

/// Both answers at one point.
#[derive(Debug, Clone, PartialEq)]
pub struct PointComparison {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude of every blade by harmonic balance, m.
    pub harmonic_balance_m: Vec<f64>,
    /// Amplitude of every blade by time integration, m, at the finest step.
    pub time_m: Vec<f64>,
    /// `ok`, how the march failed, or `step_too_small` where the step study ran out of steps.
    pub status: Status,
    /// The step study, coarsest first.
    pub steps: Vec<StepStudy>,
    /// The last march.
    pub settled: Settled,
    /// Where the march is not periodic within its budget: the periodic motion next to harmonic
    /// balance, and whether it is stable.
    pub motion: Option<PeriodicMotion>,
}

/// What is known of the stability of a periodic motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    /// The march from harmonic balance ends in it, or no Floquet multiplier exceeds 1.
    Stable,
    /// A Floquet multiplier of the periodic motion next to harmonic balance exceeds 1.
    Unstable,
    /// The march did not become periodic, and no periodic motion was found that would say why.
    NotSettled,
}

impl PointComparison {
    /// Relative difference of the largest amplitudes, time integration against harmonic balance.
    #[must_use]
    pub fn largest_difference(&self) -> f64 {
        largest(&self.time_m) / largest(&self.harmonic_balance_m) - 1.0
    }

    /// Largest difference of a blade's amplitude, relative to the largest amplitude.
    #[must_use]
    pub fn blade_difference(&self) -> f64 {
        let blades = self.time_m.iter().zip(&self.harmonic_balance_m);
        let worst = blades.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        worst / largest(&self.harmonic_balance_m)
    }

    /// Whether the wheel stays on the motion that harmonic balance has found.
    #[must_use]
    pub fn stability(&self) -> Stability {
        if self.settled.status == Status::Ok {
            return Stability::Stable;
        }
        match self.motion.as_ref().and_then(PeriodicMotion::is_stable) {
            Some(true) => Stability::Stable,
            Some(false) => Stability::Unstable,
            None => Stability::NotSettled,
        }
    }

    /// Whether the dynamics reach the harmonic-balance solution: a periodic motion whose largest
    /// amplitude differs by at most `tolerance`.
    #[must_use]
    pub fn reached(&self, tolerance: f64) -> bool {
        self.status == Status::Ok && self.largest_difference().abs() <= tolerance
    }
}

/// Solves a point by harmonic balance, and marches the whole wheel from there with ever smaller
/// steps until the largest amplitude does not change any more. Every finer march goes on from the
/// state that the coarser one ended in.
///
/// # Errors
/// The status of the harmonic balance, if it has no solution to start from; `invalid_pattern`.
pub fn compare_point(
    case: &PointCase<'_>,
    options: &TimeOptions,
) -> Result<PointComparison, Status> {
    let solved = case.solved()?;
    let marched = solved.marched();
    let start = solved.motion.start(&marched, options.steps_per_period);
    let (steps, settled, status) = case.march(&marched, start.clone(), options);
    let motion = (settled.status == Status::WorkBudget)
        .then(|| periodic_motion(&marched, &start, options.steps_per_period));
    Ok(PointComparison {
        frequency_hz: case.frequency_hz,
        harmonic_balance_m: solved.harmonic_balance_m,
        time_m: case.measured(&settled).to_vec(),
        status,
        steps,
        settled,
        motion,
    })
}

/// The periodic motion next to the harmonic balance solution of a point, and the amplitude of every
/// blade by harmonic balance, m.
///
/// # Errors
/// The status of the harmonic balance, if it has no solution to start from; `invalid_pattern`.
pub fn periodic_point(
    case: &PointCase<'_>,
    steps_per_period: usize,
) -> Result<(Vec<f64>, PeriodicMotion), Status> {
    let solved = case.solved()?;
    let marched = solved.marched();
    let start = solved.motion.start(&marched, steps_per_period);
    let found = periodic_motion(&marched, &start, steps_per_period);
    Ok((solved.harmonic_balance_m, found))
}

/// The harmonic balance solution of a point, on the whole wheel.
#[derive(Debug)]
pub struct SolvedPoint {
    /// The wheel with viscous damping.
    pub wheel: Excited,
    /// Its contact.
    pub interface: ContactInterface,
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Amplitude of every blade, m.
    pub harmonic_balance_m: Vec<f64>,
    /// The motion.
    pub motion: Motion,
}

impl SolvedPoint {
    /// What is marched.
    #[must_use]
    pub fn marched(&self) -> MarchedWheel<'_> {
        MarchedWheel {
            structure: &self.wheel.linear.structure,
            interface: &self.interface,
            force: &self.wheel.force,
            omega: self.omega,
        }
    }
}

impl PointCase<'_> {
    /// The harmonic balance solution.
    ///
    /// # Errors
    /// Its status; `invalid_pattern`.
    pub fn solved(&self) -> Result<SolvedPoint, Status> {
        let omega = TAU * self.frequency_hz;
        let modes = self.modes()?;
        let wheel = self.wheel(&modes, omega);
        let (harmonic_balance_m, motion) = self.harmonic_balance(&modes, &wheel)?;
        Ok(SolvedPoint {
            interface: self.interface(),
            wheel,
            omega,
            harmonic_balance_m,
            motion,
        })
    }

    fn modes(&self) -> Result<StructuralModes, Status> {
        let size = self.basis.size();
        let none = Matrix::zeros(size, size);
        StructuralModes::of_wheel(self.basis, self.stiffness_change.unwrap_or(&none))
            .ok_or(Status::InvalidPattern)
    }

    /// The whole wheel with viscous damping.
    fn wheel(&self, modes: &StructuralModes, omega: f64) -> Excited {
        let force = wheel_force(self.basis, modes, self.engine_order, self.amplitude_n);
        let wheel = Wheel::mistuned(
            modes.clone(),
            self.basis.model(),
            self.factors,
            self.damping,
            LimitsWanted::default(),
        );
        Excited::wheel(&wheel, force, self.harmonics).with_viscous_damping(omega)
    }

    fn interface(&self) -> ContactInterface {
        let geometry = self.basis.model().contact.clone();
        ContactInterface {
            law: self.law,
            pairs: self
                .sector
                .pairs_under(self.sector.normal_load_n, &geometry, self.factors),
            geometry,
        }
    }

    /// Amplitude of every blade, and the motion of the wheel.
    fn harmonic_balance(
        &self,
        modes: &StructuralModes,
        wheel: &Excited,
    ) -> Result<(Vec<f64>, Motion), Status> {
        if self.stiffness_change.is_some() {
            let point = self.point(wheel)?;
            return Ok((point.amplitudes_m.clone(), Motion::of_wheel(wheel, &point)));
        }
        let model = self.basis.model();
        let waves = Excited::tuned(
            model,
            &ContactFactors::default(),
            self.engine_order,
            self.amplitude_n,
            self.damping,
            self.harmonics,
            LimitsWanted::default(),
        )
        .with_viscous_damping(TAU * self.frequency_hz);
        let point = self.point(&waves)?;
        let motion = Motion::of_waves(self.basis, modes, self.engine_order, &waves, &point);
        Ok((vec![point.amplitudes_m[0]; model.sectors], motion))
    }

    fn point(&self, excited: &Excited) -> Result<Point, Status> {
        let settings = PointSettings::new(
            self.solver,
            self.harmonics,
            Some((self.law, self.sector)),
            self.basis.model().contact.clone(),
        )
        .map_err(|_| Status::IterationLimit)?
        .with_factors(self.factors);
        let condition = ContactCondition::Full {
            normal_load_n: self.sector.normal_load_n,
        };
        let mut solver = PointSolver::new(excited, condition, &settings);
        solver.solve(self.frequency_hz).cloned()
    }

    /// Marches with halved steps until the largest amplitude stays.
    fn march(
        &self,
        wheel: &MarchedWheel<'_>,
        start: WheelState,
        options: &TimeOptions,
    ) -> (Vec<StepStudy>, Settled, Status) {
        let mut studies: Vec<StepStudy> = Vec::new();
        let mut state = start;
        let mut steps_per_period = options.steps_per_period;
        loop {
            let finer = TimeOptions {
                steps_per_period,
                ..*options
            };
            let settled = settle(wheel, &state, &finer);
            let study = StepStudy {
                steps_per_period,
                periods: settled.periods,
                status: settled.status,
                largest_m: largest(self.measured(&settled)),
            };
            let change = studies
                .last()
                .map(|coarser| (study.largest_m / coarser.largest_m - 1.0).abs());
            studies.push(study);
            if settled.status != Status::Ok {
                let status = settled.status;
                return (studies, settled, status);
            }
            if change.is_some_and(|change| change <= options.step_tolerance) {
                return (studies, settled, Status::Ok);
            }
            steps_per_period *= 2;
            if steps_per_period > options.maximum_steps_per_period {
                return (studies, settled, Status::StepTooSmall);
            }
            state = settled.state;
        }
    }

    fn measured<'s>(&self, settled: &'s Settled) -> &'s [f64] {
        match self.solver.amplitude {
            AmplitudeMeasure::Fundamental => &settled.fundamental_m,
            AmplitudeMeasure::TimeMaximum => &settled.time_maximum_m,
        }
    }
}

fn largest(amplitudes_m: &[f64]) -> f64 {
    amplitudes_m.iter().copied().fold(0.0, f64::max)
}
