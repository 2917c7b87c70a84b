//! What a study with `[accuracy]` tried before it chose its settings.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Settings tried on a sample of rows, and the one taken.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyTrials {
    /// Error accepted.
    pub accepted: f64,
    /// Rows of the whole sample.
    pub rows: u64,
    /// Upper bound of the error of 95 % of the rows at the setting taken; none without a bound.
    pub p95_upper: Option<f64>,
    /// What the worst error at that setting is claimed to be at most; none without a bound.
    pub worst_upper: Option<f64>,
    /// The settings, in the order of the trials.
    pub tried: Vec<AccuracyTrial>,
}

/// A setting that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyTrial {
    /// The setting, in words.
    pub setting: String,
    /// Rows solved before it was taken or given up.
    pub rows: u64,
    /// Largest relative error of their amplitudes; none: a row has no result.
    pub worst: Option<f64>,
    /// Floating-point operations of a row.
    pub operations: f64,
    /// Whether the study was solved with this setting.
    pub taken: bool,
}

/// The choice in the manifest, as far as it is shown.
#[derive(Deserialize)]
struct Choice {
    accepted_error: f64,
    evidence: Evidence,
}

#[derive(Deserialize)]
struct Evidence {
    amplitude: Errors,
    amplitude_worst_upper: Option<f64>,
    operations_per_row: f64,
    tried: Vec<Tried>,
}

#[derive(Deserialize)]
struct Errors {
    rows: u64,
    p95_upper: Option<f64>,
}

#[derive(Deserialize)]
struct Tried {
    setting: String,
    rows: u64,
    worst: Option<f64>,
    operations: f64,
}

impl AccuracyTrials {
    /// From `chosen.accuracy` of a manifest; none without `[accuracy]`, or where nothing had to be tried.
    #[must_use]
    pub fn from_choice(choice: &Value) -> Option<Self> {
        let choice = Choice::deserialize(choice).ok()?;
        let evidence = choice.evidence;
        let taken = |own: &Tried| {
            own.rows == evidence.amplitude.rows
                && own
                    .operations
                    .total_cmp(&evidence.operations_per_row)
                    .is_eq()
        };
        let taken = evidence.tried.iter().position(taken);
        let trial = |(place, own): (usize, Tried)| AccuracyTrial {
            setting: own.setting,
            rows: own.rows,
            worst: own.worst,
            operations: own.operations,
            taken: Some(place) == taken,
        };
        Some(Self {
            accepted: choice.accepted_error,
            rows: evidence.amplitude.rows,
            p95_upper: evidence.amplitude.p95_upper,
            worst_upper: evidence.amplitude_worst_upper,
            tried: evidence.tried.into_iter().enumerate().map(trial).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::AccuracyTrials;

    #[test]
    fn the_setting_taken_is_that_of_the_evidence() {
        let trial = |operations: f64, rows: u32, worst: Value| json!({ "setting": "a, b", "rows": rows, "worst": worst, "operations": operations });
        let choice = json!({
            "accepted_error": 0.01,
            "evidence": {
                "amplitude": { "rows": 18, "p95_upper": 0.005 },
                "amplitude_worst_upper": 0.009,
                "operations_per_row": 2e9,
                "tried": [trial(1e9, 3, Value::Null), trial(2e9, 18, json!(0.004)), trial(3e9, 18, json!(0.001))],
            },
        });
        let trials = AccuracyTrials::from_choice(&choice).expect("trials");
        let taken: Vec<bool> = trials.tried.iter().map(|own| own.taken).collect();
        assert_eq!(taken, [false, true, false]);
        assert_eq!(
            (trials.tried[0].worst, trials.p95_upper, trials.worst_upper),
            (None, Some(0.005), Some(0.009))
        );
        // Linear limits need no trial, and a study without [accuracy] has none.
        let untried = json!({ "accepted_error": 0.01, "evidence": null });
        assert_eq!(AccuracyTrials::from_choice(&untried), None);
        assert_eq!(AccuracyTrials::from_choice(&Value::Null), None);
    }
}
