//! What a peak would change by with finer sampling and with the harmonics outside of its set.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::error_settings::ErrorSettings;
use super::excited::Excited;
use super::observed_amplitude::ObservedBlock;
use super::options::ContactCondition;
use super::point::Point;
use super::point_settings::PointSettings;
use super::point_solver::PointSolver;
use crate::response::harmonic_balance::{ContactShares, Effects, HarmonicBlock, enlarge};

/// Relative changes of the largest amplitude; positive where it would grow.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// By finer sampling. On a basis it is one Newton correction with 4
    /// times the samples per period, at least 256. On tuned receptances the point is solved on from its solution, with the
    /// samples of the enlarged set.
    pub sampling: f64,
    /// By the harmonics up to 15 that are not in the set, or by those up to 25 where the set has all up to 15.
    pub harmonics: f64,
    /// What the estimate of the harmonics may still be off by.
    pub unsettled: f64,
}

/// Errors of a solution, and what each harmonic outside of its set has to do with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Screening {
    /// The errors.
    pub errors: ErrorEstimate,
    /// Relative change of the amplitude that the harmonic alone makes.
    pub effects: Vec<(u32, f64)>,
}

/// Errors of `point`, a solution of `excited` under `settings`; `blocks` are those of the enlarged
/// set. None if the solution cannot be corrected (a singular Jacobian).
#[must_use]
pub fn estimate_errors(
    excited: &Excited,
    condition: ContactCondition,
    settings: &PointSettings,
    point: &Point,
    blocks: &[HarmonicBlock],
) -> Option<ErrorEstimate> {
    let assessed = assess(
        excited,
        condition,
        settings,
        point,
        blocks,
        Effects::Together,
    )?;
    Some(assessed.errors)
}

/// [`estimate_errors`] with the effect of each harmonic outside.
#[must_use]
pub fn screen(
    excited: &Excited,
    condition: ContactCondition,
    settings: &PointSettings,
    point: &Point,
    blocks: &[HarmonicBlock],
) -> Option<Screening> {
    assess(excited, condition, settings, point, blocks, Effects::Each)
}

fn assess(
    excited: &Excited,
    condition: ContactCondition,
    settings: &PointSettings,
    point: &Point,
    blocks: &[HarmonicBlock],
    wanted: Effects,
) -> Option<Screening> {
    let mut solver = PointSolver::new(excited, condition, settings);
    let ErrorSettings { set, amplitude } = settings.errors();
    let linear = point.shares == ContactShares::default();
    let nonlinear = solver.nonlinear_at(point).filter(|_| !linear);
    let Some((system, workspace)) = nonlinear else {
        return Some(Screening {
            errors: ErrorEstimate::default(),
            effects: Vec::new(),
        });
    };
    let omega = TAU * point.frequency_hz;
    let enlarged = enlarge(
        system,
        workspace,
        set,
        blocks,
        omega,
        &point.solution,
        wanted,
    )?;
    let structures = ObservedBlock::all(blocks);
    let largest = |amplitudes: Vec<f64>| amplitudes.into_iter().fold(0.0, f64::max);
    let before = largest(amplitude.of(&structures, &enlarged.before));
    let change = |solution: &[f64]| {
        largest(amplitude.changed(&structures, &enlarged.before, solution)) / before - 1.0
    };
    let sampling = change(&enlarged.resampled);
    let alone = change(&enlarged.alone);
    let total = change(&enlarged.after);
    let effects = enlarged.without.iter();
    Some(Screening {
        errors: ErrorEstimate {
            sampling,
            harmonics: total - alone,
            unsettled: enlarged.unsettled,
        },
        effects: effects
            .map(|(harmonic, without)| (*harmonic, total - change(without)))
            .collect(),
    })
}
