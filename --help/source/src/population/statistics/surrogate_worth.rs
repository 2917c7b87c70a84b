//! What the surrogates of all patterns are worth, in time, before they are found.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

use super::joint_law::JointLaw;
use super::two_phase_design::{FEWEST_OF_STRATUM, LEAST_GAIN};
use super::{EstimateTarget, Population};

/// Patterns, at most, of the population that stands for one whose surrogates are not known yet.
const STAND_IN: usize = 4000;

/// What the surrogates of all patterns are worth before they are found, by a pilot that has both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SurrogateWorth {
    /// Crude patterns that one solve is predicted to be worth with them.
    pub gain: f64,
    /// Time of a surrogate over that of a row, counted from the work of both.
    pub cost: f64,
    /// The gain over what solves and surrogates take together, in the time of the solves alone.
    pub gain_in_time: f64,
}

impl SurrogateWorth {
    /// Of `solves` rows among `patterns`, by the surrogate and the value of each row of the pilot and the time of a
    /// surrogate over that of a row; none where the pilot cannot tell.
    ///
    /// The gain is that of a stand-in for the population, with normal surrogates of the mean and spread of the pilot's.
    #[must_use]
    pub fn of_pilot(
        patterns: usize,
        solves: usize,
        pilot: &[(Option<f64>, Option<f64>)],
        target: EstimateTarget,
        cost: f64,
    ) -> Option<Self> {
        let law = JointLaw::of(pilot.iter().filter_map(|&(s, y)| Some((s?, y?))))?;
        let share = solves as f64 / patterns as f64;
        let gain = match target {
            EstimateTarget::Mean => {
                let unexplained = 1.0 - law.correlation().powi(2);
                1.0 / (share + (1.0 - share) * unexplained)
            }
            EstimateTarget::Percentile(percent) => {
                let size = patterns.min(STAND_IN);
                let rows = ((share * size as f64).round() as usize).max(1);
                let normal = Normal::standard();
                let values: Vec<Option<f64>> = (0..size)
                    .map(|place| (place as f64 + 0.5) / size as f64)
                    .map(|below| Some(law.x + law.spread_x() * normal.inverse_cdf(below)))
                    .collect();
                let ids: Vec<u32> = (0..size as u32).collect();
                let stand_in = Population::new(0, &ids, &values, target);
                let exceeding = 1.0 - percent / 100.0;
                let spread = stand_in.spreads(&law, exceeding);
                let least: Vec<usize> = stand_in
                    .members
                    .iter()
                    .map(|members| FEWEST_OF_STRATUM.min(members.len()))
                    .collect();
                let rows_of = stand_in.neyman(rows, &least, &spread);
                stand_in.gain(rows, &rows_of, &spread, exceeding)
            }
        };
        Some(Self {
            gain,
            cost,
            gain_in_time: gain / (1.0 + cost / share),
        })
    }

    /// Whether surrogates of all patterns are worth their time.
    #[must_use]
    pub fn pays(&self) -> bool {
        self.gain_in_time >= LEAST_GAIN
    }
}
