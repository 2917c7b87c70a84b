//! What the errors of solutions are estimated with.

use super::observed_amplitude::ObservedAmplitude;
use super::options::{SolverOptions, samples_per_period};
use crate::response::friction::ContactLaw;
use crate::response::harmonic_balance::{EnlargedSet, TransformError};

/// Samples per period of the check, over those of the solution.
const FINER: usize = 4;
/// Samples per period of the check at least.
const FINEST: usize = 256;

/// The enlarged set of a study with the amplitude in it.
#[derive(Debug, Clone)]
pub struct ErrorSettings {
    pub(super) set: EnlargedSet,
    pub(super) amplitude: ObservedAmplitude,
}

impl ErrorSettings {
    /// For solutions with `harmonics` under `options`.
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(
        options: &SolverOptions,
        harmonics: &[u32],
        law: Option<ContactLaw>,
    ) -> Result<Self, TransformError> {
        let variable_load = law.is_some_and(ContactLaw::has_variable_load);
        let samples = FINEST.max(FINER * samples_per_period(options, harmonics));
        let set = EnlargedSet::new(harmonics, variable_load, samples)?;
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
