//! When a sample is large enough: a few looks, declared before the first, that share the error.
//!
//! At each of at most [`MOST_LOOKS`] looks the percentile has its order-statistic interval at the
//! confidence `1 - alpha / looks`. By the inequality of Bonferroni all of them hold together with
//! probability `1 - alpha`, so the one at which a study stops does, whatever made it stop.

use serde::{Deserialize, Serialize};

use super::{CONFIDENCE, Percentile, Quantity, percentile_at, smallest_sample};

/// Most looks at a growing sample.
pub const MOST_LOOKS: u32 = 5;

/// Growth of the sample from one look to the next, at least.
const GROWTH: f64 = 2.0;

/// What a study waits for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StoppingRule {
    /// The percentile in percent.
    pub percent: f64,
    /// Width of its interval over its value at which it stops.
    pub relative_width: f64,
    /// Patterns at most.
    pub patterns: u64,
}

/// What a look at the sample came to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Look {
    /// Which look, from 1.
    pub look: u32,
    /// Looks declared.
    pub looks: u32,
    /// Confidence of the interval at this look; that of the rule as a whole is [`CONFIDENCE`].
    pub confidence: f64,
    /// The percentile with its interval at that confidence.
    pub percentile: Percentile,
    /// Width of the interval over the value; null while there is none.
    pub relative_width: Option<f64>,
    /// Whether the interval is as narrow as wanted.
    pub met: bool,
}

impl StoppingRule {
    /// Sizes of the sample at the looks, ascending, the last one `patterns`: at most [`MOST_LOOKS`],
    /// each at least twice the one before, the first with an interval.
    #[must_use]
    pub fn looks(&self) -> Vec<u64> {
        let smallest = smallest_sample(self.percent / 100.0, confidence(MOST_LOOKS));
        let mut looks = vec![self.patterns];
        while looks.len() < MOST_LOOKS as usize {
            let earlier = (looks[looks.len() - 1] as f64 / GROWTH).floor() as u64;
            if earlier < smallest {
                break;
            }
            looks.push(earlier);
        }
        looks.reverse();
        looks
    }

    /// Confidence of the interval at each look.
    #[must_use]
    pub fn confidence(&self) -> f64 {
        confidence(self.looks().len() as u32)
    }

    /// Judges the sample of look `look` (from 1): `sorted` good values (ascending) beside `failed`
    /// rows without value.
    #[must_use]
    pub fn judge(&self, look: u32, sorted: &[f64], failed: u64) -> Look {
        let looks = self.looks().len() as u32;
        let confidence = confidence(looks);
        let percentile = percentile_at(sorted, failed, self.percent, confidence);
        let relative_width = percentile
            .value
            .zip(percentile.lower)
            .zip(percentile.upper)
            .map(|((value, lower), upper)| (upper - lower) / value.abs());
        Look {
            look,
            looks,
            confidence,
            percentile,
            relative_width,
            met: relative_width.is_some_and(|width| width <= self.relative_width),
        }
    }
}

/// When a study may stop before all of its patterns: every scenario must meet the rule at the same look.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StopOptions {
    /// The percentile in percent.
    pub percentile: f64,
    /// Width of its interval over its value, at most, in every scenario.
    pub relative_width: f64,
    /// The quantity.
    pub quantity: Quantity,
}

impl StopOptions {
    /// The rule of each scenario of a study of at most `patterns`.
    #[must_use]
    pub fn rule(&self, patterns: u64) -> StoppingRule {
        StoppingRule {
            percent: self.percentile,
            relative_width: self.relative_width,
            patterns,
        }
    }
}

/// What the stopping rule of a study came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StopOutcome {
    /// What was wanted.
    #[serde(flatten)]
    pub wanted: StopOptions,
    /// Patterns at most.
    pub most_patterns: u64,
    /// Patterns at each of the looks declared.
    pub looks: Vec<u64>,
    /// Confidence of each interval at a look; together they hold with [`CONFIDENCE`], and so does the
    /// one at which the study stops.
    pub confidence: f64,
    /// Whether the last look made is as narrow as wanted in every scenario.
    pub met: bool,
    /// The looks made, in order.
    pub made: Vec<StudyLook>,
}

/// A look at all scenarios of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyLook {
    /// Which look, from 1.
    pub look: u32,
    /// Patterns looked at.
    pub patterns: u64,
    /// Whether every scenario is as narrow as wanted.
    pub met: bool,
    /// The scenarios, in order.
    pub scenarios: Vec<ScenarioLook>,
}

/// One scenario at a look.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScenarioLook {
    /// Index.
    pub scenario: usize,
    /// The percentile; null where it is not estimable.
    pub value: Option<f64>,
    /// Lower bound of the percentile at the confidence of a look.
    pub lower: Option<f64>,
    /// Upper bound of the percentile at the confidence of a look.
    pub upper: Option<f64>,
    /// Width of the interval over the value; null while there is none.
    pub relative_width: Option<f64>,
    /// Whether the interval is as narrow as wanted.
    pub met: bool,
}

impl StopOutcome {
    /// Before the first look.
    #[must_use]
    pub fn new(wanted: StopOptions, most_patterns: u64) -> Self {
        let rule = wanted.rule(most_patterns);
        Self {
            wanted,
            most_patterns,
            looks: rule.looks(),
            confidence: rule.confidence(),
            met: false,
            made: Vec::new(),
        }
    }

    /// Makes the next look, at the sample of every scenario: good values (ascending) and number of
    /// failed rows. All looks made must have been declared.
    pub fn look(&mut self, samples: &[(Vec<f64>, u64)]) {
        let rule = self.wanted.rule(self.most_patterns);
        let look = self.made.len() as u32 + 1;
        let scenarios: Vec<ScenarioLook> = samples
            .iter()
            .enumerate()
            .map(|(scenario, (sorted, failed))| {
                let Look {
                    percentile,
                    relative_width,
                    met,
                    ..
                } = rule.judge(look, sorted, *failed);
                ScenarioLook {
                    scenario,
                    value: percentile.value,
                    lower: percentile.lower,
                    upper: percentile.upper,
                    relative_width,
                    met,
                }
            })
            .collect();
        self.met = scenarios.iter().all(|scenario| scenario.met);
        self.made.push(StudyLook {
            look,
            patterns: self.looks[self.made.len()],
            met: self.met,
            scenarios,
        });
    }
}

/// Confidence of each of `looks` looks.
fn confidence(looks: u32) -> f64 {
    1.0 - (1.0 - CONFIDENCE) / f64::from(looks.max(1))
}
