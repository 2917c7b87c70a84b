//! What a peak would change by with finer sampling and with the harmonics outside of its set.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::excited::Excited;
use super::observed_amplitude::ObservedAmplitude;
use super::options::{ContactCondition, SolverOptions};
use super::point_solver::{Point, PointSettings, PointSolver};
use crate::response::harmonic_balance::{
    EnlargedSet, HarmonicBlock, Structure, TransformError, enlarge,
};

/// Samples per period of the check, over those of the solution.
const FINER: usize = 4;
/// Samples per period of the check at least: 16 per period of its highest harmonic.
const FINEST: usize = 256;

/// The enlarged set of a study with the amplitude in it.
#[derive(Debug, Clone)]
pub struct ErrorSettings {
    set: EnlargedSet,
    amplitude: ObservedAmplitude,
}

/// Relative changes of the largest amplitude; positive where it would grow.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// By one Newton correction of the same equations with 4 times the samples per period.
    pub sampling: f64,
    /// By the harmonics up to 15 that are not in the set, with that sampling; none if their
    /// estimate did not settle.
    pub harmonics: Option<f64>,
}

impl ErrorSettings {
    /// For solutions with `harmonics` under `options`.
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(options: &SolverOptions, harmonics: &[u32]) -> Result<Self, TransformError> {
        let samples = FINEST.max(FINER * options.samples_per_period);
        let set = EnlargedSet::new(harmonics, samples)?;
        let instants = options.time_samples.max(samples);
        Ok(Self {
            amplitude: ObservedAmplitude::new(options.amplitude, set.harmonics(), instants)?,
            set,
        })
    }

    /// Harmonics of the enlarged set, ascending.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        self.set.harmonics()
    }
}

/// Errors of `point`, a solution of `excited` under `settings`; `blocks` are those of the enlarged
/// set. None if the solution has no neighbourhood to correct it in (a singular Jacobian).
#[must_use]
pub fn estimate_errors(
    excited: &Excited,
    condition: ContactCondition,
    settings: &PointSettings,
    point: &Point,
    blocks: &[HarmonicBlock],
) -> Option<ErrorEstimate> {
    let mut solver = PointSolver::new(excited, condition, settings);
    let Some((system, workspace)) = solver.nonlinear() else {
        return Some(ErrorEstimate {
            sampling: 0.0,
            harmonics: Some(0.0),
        });
    };
    let ErrorSettings { set, amplitude } = settings.errors();
    let omega = TAU * point.frequency_hz;
    let enlarged = enlarge(system, workspace, set, blocks, omega, &point.solution)?;
    let structures: Vec<(u32, &Structure)> = blocks
        .iter()
        .map(|block| (block.harmonic, &*block.structure))
        .collect();
    let largest = |amplitudes: Vec<f64>| amplitudes.into_iter().fold(0.0, f64::max);
    let before = largest(amplitude.of(&structures, &enlarged.before));
    let after = |solution: &[f64]| {
        largest(amplitude.changed(&structures, &enlarged.before, solution)) / before - 1.0
    };
    let sampling = after(&enlarged.resampled);
    let harmonics = after(&enlarged.after) - sampling;
    Some(ErrorEstimate {
        sampling,
        harmonics: enlarged.settled.then_some(harmonics),
    })
}
