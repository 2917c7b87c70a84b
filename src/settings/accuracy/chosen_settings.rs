//! The settings chosen for an accepted error, and the evidence that they were chosen by.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::ReceptanceSetting;
use crate::population::monte_carlo::LoadCaseName;
use crate::population::statistics::{ErrorBound, LoadCaseErrors};
use crate::study::Study;

/// The settings chosen for an accepted error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccuracyChoice {
    /// Error accepted.
    pub accepted: f64,
    /// The settings.
    pub setting: ReceptanceSetting,
    /// Fixed-interface modes.
    pub craig_bampton_modes: usize,
    /// Whether the upper bound of the 95th percentile of the amplitude error is accepted, and half of the rows of the sample are known
    /// at the enlarged settings.
    pub met: bool,
    /// Errors on the sample; none where nothing was to be measured.
    pub evidence: Option<AccuracyEvidence>,
}

/// What a choice was made by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccuracyEvidence {
    /// Ids of the patterns of the sample.
    pub patterns: Vec<u32>,
    /// Normal loads of its scenarios, N.
    pub normal_loads_n: Vec<f64>,
    /// What rows are compared with: `enlarged`.
    pub reference: String,
    /// Errors of the peak amplitude.
    pub amplitude: ErrorBound,
    /// What the worst error of the peak amplitude over all rows is claimed to be at most, see [`ErrorBound::worst_upper`].
    pub amplitude_worst_upper: f64,
    /// Errors of the frequency of the peak.
    pub frequency: Option<ErrorBound>,
    /// Errors of the amplification factor.
    pub amplification_factor: Option<ErrorBound>,
    /// Estimated floating-point operations of a row at the settings chosen.
    pub operations_per_row: f64,
    /// Estimated floating-point operations of the whole choice.
    pub operations_of_choice: f64,
    /// Settings measured, in order.
    pub tried: Vec<TriedSetting>,
    /// Load case of each scenario of the sample; empty in a study without load cases.
    pub load_cases: Vec<LoadCaseName>,
    /// Errors of the peak amplitude under each load case.
    pub errors_of_load_cases: Vec<LoadCaseErrors>,
}

/// Settings that were measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriedSetting {
    /// The settings, in words.
    pub setting: String,
    /// Rows measured before it was taken or given up.
    pub rows: u64,
    /// Largest amplitude error of the rows measured.
    pub worst: f64,
    /// Estimated floating-point operations of a row.
    pub operations: f64,
}

impl AccuracyChoice {
    /// The study at the settings chosen.
    #[must_use]
    pub fn applied_to(&self, study: &Study) -> Study {
        self.setting.applied_to(study)
    }

    /// The choice for the manifest.
    #[must_use]
    pub fn facts(&self) -> Value {
        let mut evidence = json!(self.evidence);
        if let Some(evidence) = evidence.as_object_mut() {
            // A study without load cases has none in its manifest.
            evidence.retain(|key, value| !key.contains("load_cases") || *value != json!([]));
        }
        json!({
            "accepted_error": self.accepted,
            "met": self.met,
            "craig_bampton_modes": self.craig_bampton_modes,
            "setting": self.setting.facts(),
            "evidence": evidence,
        })
    }
}
