//! Settings of rows on tuned receptances by an accepted error, of which every tolerance is a fixed share, and the enlarged ones.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::population::monte_carlo::{TUNED_RECEPTANCES, harmonics_name};
use crate::response::forced_response::{Harmonics, RowsBeyondTolerance, TopBeside};
use crate::study::Study;

/// Tolerance of the harmonics over the accepted error, beyond which rows are marked.
const HARMONICS: f64 = 2.0;
/// Tolerance of fixed-interface modes and blade shapes over the accepted error.
const REDUCTION: f64 = 0.1;
/// Tolerance of the peak over the accepted error.
const PEAK: f64 = 0.1;
/// Samples per period, and an error below which twice as many are taken.
const SAMPLES: usize = 128;
const FINER_SAMPLES_BELOW: f64 = 0.004;
/// Harmonics that rows are compared with go to this one; those that the study says are among them.
const ENLARGED_HARMONIC: u32 = 15;
/// Least samples per period of the rows that rows are compared with.
const ENLARGED_SAMPLES: usize = 256;
/// What a top of the rows compared with may be off by because a solution had not settled, over the peak tolerance of the
/// settings.
const UNSETTLED: f64 = 1.0;

/// Settings of rows on tuned receptances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReceptanceSetting {
    /// `reduction.error`, by which fixed-interface modes and blade shapes are chosen.
    pub reduction_error: f64,
    /// `solver.harmonic_tolerance`.
    pub harmonic_tolerance: f64,
    /// `solver.harmonics`, where the study says them.
    pub harmonics: Option<Vec<u32>>,
    /// `solver.samples_per_period`, at least.
    pub samples_per_period: usize,
    /// `solver.peak_tolerance`.
    pub peak_tolerance: f64,
}

impl ReceptanceSetting {
    /// The settings for an error of the amplitude.
    #[must_use]
    pub fn within(amplitude_error: f64) -> Self {
        let is_fine = amplitude_error < FINER_SAMPLES_BELOW;
        Self {
            reduction_error: REDUCTION * amplitude_error,
            harmonic_tolerance: HARMONICS * amplitude_error,
            harmonics: None,
            samples_per_period: if is_fine { 2 * SAMPLES } else { SAMPLES },
            peak_tolerance: PEAK * amplitude_error,
        }
    }

    /// These settings but for those that `study` says itself.
    pub(super) fn but_for_those_of(mut self, study: &Study) -> Self {
        let solver = &study.solver;
        if study.states("reduction.error") {
            self.reduction_error = study.reduction.error;
        }
        if study.states("solver.harmonic_tolerance") {
            self.harmonic_tolerance = solver.harmonic_tolerance;
        }
        if study.states("solver.harmonics") {
            self.harmonics = match &solver.harmonics {
                Harmonics::Auto => None,
                Harmonics::Set(set) => Some(set.clone()),
            };
        }
        if study.states("solver.samples_per_period") {
            self.samples_per_period = solver.samples_per_period;
        }
        if study.states("solver.peak_tolerance") {
            self.peak_tolerance = solver.peak_tolerance;
        }
        self
    }

    /// The settings tried for `amplitude_error`, in order: those for it, then half the tolerance of the peak, then a quarter and twice
    /// the samples. Where `study` says what a step would change, there is no such step.
    pub(super) fn tried_for(amplitude_error: f64, study: &Study) -> Vec<Self> {
        let first = Self::within(amplitude_error);
        let second = Self {
            peak_tolerance: 0.5 * first.peak_tolerance,
            ..first.clone()
        };
        let third = Self {
            peak_tolerance: 0.5 * second.peak_tolerance,
            samples_per_period: 2 * second.samples_per_period,
            ..second.clone()
        };
        let mut tried: Vec<Self> = Vec::new();
        for setting in [first, second, third] {
            let setting = setting.but_for_those_of(study);
            if tried.last() != Some(&setting) {
                tried.push(setting);
            }
        }
        tried
    }

    /// `study` solved at these settings. What they do not say stays.
    #[must_use]
    pub fn applied_to(&self, study: &Study) -> Study {
        let mut applied = study.clone();
        applied.accuracy = None;
        applied.reduction.error = self.reduction_error;
        let solver = &mut applied.solver;
        solver.harmonics = match &self.harmonics {
            None => Harmonics::Auto,
            Some(set) => Harmonics::Set(set.clone()),
        };
        solver.harmonic_tolerance = self.harmonic_tolerance;
        if !study.states("solver.rows_beyond_tolerance") {
            solver.rows_beyond_tolerance = RowsBeyondTolerance::Flag;
        }
        solver.samples_per_period = self.samples_per_period;
        solver.peak_tolerance = self.peak_tolerance;
        applied
    }

    /// `study` as rows at these settings are held against.
    pub(super) fn enlarged(&self, study: &Study, harmonics: &[u32]) -> Study {
        let mut enlarged = self.applied_to(study);
        enlarged.solver.harmonics = Harmonics::Set(harmonics.to_vec());
        enlarged.solver.samples_per_period = ENLARGED_SAMPLES.max(2 * self.samples_per_period);
        enlarged
    }

    /// `top` where it is known well enough to tell an error by.
    pub(super) fn settled(&self, top: TopBeside) -> Option<TopBeside> {
        (top.unsettled <= UNSETTLED * self.peak_tolerance).then_some(top)
    }

    /// The settings for the manifest, under the names of the ladder's where it has them.
    #[must_use]
    pub fn facts(&self) -> Value {
        json!({
            "basis": TUNED_RECEPTANCES,
            "reduction_error": format!("{:e}", self.reduction_error),
            "harmonics": self.harmonics_in_words(),
            "samples_per_period": self.samples_per_period.to_string(),
            "peak_tolerance": format!("{:e}", self.peak_tolerance),
        })
    }

    fn harmonics_in_words(&self) -> String {
        match &self.harmonics {
            None => format!("auto {}", self.harmonic_tolerance),
            Some(set) => harmonics_name(set),
        }
    }

    pub(super) fn words(&self) -> String {
        format!(
            "{TUNED_RECEPTANCES} to {:e}, harmonics {}, {} samples, peak to {:e}",
            self.reduction_error,
            self.harmonics_in_words(),
            self.samples_per_period,
            self.peak_tolerance
        )
    }
}

/// Every harmonic that the law of `study` can excite, to the highest of the comparison, and those that the study says.
pub(super) fn enlarged_harmonics(study: &Study) -> Vec<u32> {
    let contact = study.contact.as_ref();
    let varies = contact.is_some_and(|contact| contact.law.has_variable_load());
    let all = (0..=ENLARGED_HARMONIC).filter(|harmonic| varies || harmonic % 2 == 1);
    let mut harmonics: Vec<u32> = all.collect();
    if let Harmonics::Set(set) = &study.solver.harmonics {
        harmonics.extend(set);
    }
    harmonics.sort_unstable();
    harmonics.dedup();
    harmonics
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study::AccuracyOptions;

    /// The built-in wheel with these lines at the end of its study.
    fn study(lines: &str) -> Study {
        let text = format!(
            "schema = 1\n[study]\nname = \"a\"\nseed = 1\npatterns = 3\n[model]\nsource = \"parametric\"\n\
             [contact]\nlaw = \"simplified_3d\"\nfriction_coefficient = 0.3\ntangential_stiffness_n_per_m = 1e8\n\
             normal_stiffness_n_per_m = 1e8\n[damping]\nstructural_loss_factor = 0.01\n\
             [excitation]\nengine_orders = [2]\n[mistuning]\ndistribution = {{ kind = \"normal\" }}\n\
             [sweep]\nnormal_load_n = [10]\nstandard_deviation = [0.01]\n{lines}"
        );
        Study::parse(Path::new("study.toml"), &text).expect("a study")
    }

    fn tried(study: &Study) -> Vec<ReceptanceSetting> {
        ReceptanceSetting::tried_for(0.01, study)
    }

    #[test]
    fn a_study_without_an_accepted_error_has_the_settings_of_the_default_one() {
        let study = study("");
        let default = ReceptanceSetting {
            reduction_error: study.reduction.error,
            harmonic_tolerance: study.solver.harmonic_tolerance,
            harmonics: None,
            samples_per_period: study.solver.samples_per_period,
            peak_tolerance: study.solver.peak_tolerance,
        };
        assert_eq!(ReceptanceSetting::within(AccuracyOptions::DEFAULT), default);
        let applied = default.applied_to(&study);
        assert_eq!(applied.resolved(), study.resolved());
    }

    #[test]
    fn what_the_study_says_stays_at_every_step() {
        let free = tried(&study(""));
        assert_eq!(free.len(), 3);
        assert_eq!(free[2].samples_per_period, 256);
        assert_eq!(free[2].peak_tolerance.to_bits(), 2.5e-4_f64.to_bits());
        let coarse = tried(&study("[solver]\nsamples_per_period = 40"));
        assert!(
            coarse
                .iter()
                .all(|tried_setting| tried_setting.samples_per_period == 40)
        );
        let stated = study(
            "[reduction]\nerror = 3e-3\n[solver]\nharmonics = [1, 3, 5]\nharmonic_tolerance = 0.1\npeak_tolerance = 2e-4\nsamples_per_period = 64",
        );
        let [only] = tried(&stated).try_into().expect("one setting");
        assert_eq!(only.harmonics, Some(vec![1, 3, 5]));
        let numbers = [
            only.reduction_error,
            only.harmonic_tolerance,
            only.peak_tolerance,
        ];
        assert_eq!(
            numbers.map(f64::to_bits),
            [3e-3, 0.1, 2e-4].map(f64::to_bits)
        );
        let resolves = study("[solver]\nrows_beyond_tolerance = \"resolve\"");
        let stated = free[0].applied_to(&resolves).solver.rows_beyond_tolerance;
        assert_eq!(stated, RowsBeyondTolerance::Resolve);
    }

    #[test]
    fn rows_are_held_against_more_harmonics_and_samples_than_they_have() {
        let study = study("[solver]\nharmonics = [1, 3, 21]");
        let setting = tried(&study).remove(0);
        let enlarged = setting.enlarged(&study, &enlarged_harmonics(&study));
        let all = Harmonics::Set((0..=15).chain([21]).collect());
        assert_eq!(enlarged.solver.harmonics, all);
        assert_eq!(enlarged.solver.samples_per_period, 256);
    }
}
