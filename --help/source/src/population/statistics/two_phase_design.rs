//! Which patterns of a population are solved, from a cheap surrogate of every one of them.
//!
//! Two-phase sampling (Neyman 1938; Cochran 1977, chapter 12): the surrogate of all N patterns cuts the
//! population into strata, finer towards the percentile that is asked for; a pilot, a simple random
//! sample, says how well the surrogate tells who exceeds the percentile; then every stratum is
//! sampled in proportion to its size and to the uncertainty left in it (Neyman 1934).
//!
//! Every pattern has a permanent random number that depends on the seed and its id alone (Ohlsson
//! 1995): a sample of n of a stratum, and the pilot, are the patterns with the smallest ones.

use rand::RngExt;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

use super::joint_law::{FEWEST_PILOT, JointLaw};
use super::resampling_stream;

/// Topic of the stream of the permanent random numbers.
const SELECTION: u32 = 0x2b1d;
/// Upper ends of the strata, in shares of the population that exceed the percentile.
const EDGES: [f64; 15] = [
    0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 25.0, 50.0,
];
/// Largest share of the population that the strata besides the last one may take.
const TOP_SHARE: f64 = 0.75;
/// Share of the solves that the pilot has.
const PILOT_SHARE: f64 = 0.3;
/// Rows of a stratum at least, as far as it has as many patterns.
pub(super) const FEWEST_OF_STRATUM: usize = 2;
/// Predicted gain over crude sampling from which on two-phase sampling is taken.
pub(super) const LEAST_GAIN: f64 = 1.2;

/// What the solves are to tell best.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EstimateTarget {
    /// The mean.
    Mean,
    /// A percentile, in percent, at least 50.
    Percentile(f64),
}

/// How the patterns that are solved were drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SamplingMethod {
    /// A simple random sample.
    Crude,
    /// Stratified by the surrogate.
    TwoPhase,
}

impl SamplingMethod {
    /// Name in tables, `snake_case`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Crude => "crude",
            Self::TwoPhase => "two_phase",
        }
    }
}

/// Places of patterns by their permanent random numbers, those to be solved first in front.
fn order_of(seed: u64, ids: &[u32]) -> Vec<usize> {
    let numbers: Vec<u64> = ids
        .iter()
        .map(|&id| resampling_stream(seed, SELECTION, id).random())
        .collect();
    let mut order: Vec<usize> = (0..ids.len()).collect();
    order.sort_by_key(|&place| (numbers[place], place));
    order
}

/// Places of the pilot of `solves` patterns among those with the ids `ids` (ascending), in the order in which they are
/// drawn: a simple random sample that surrogates do not change.
#[must_use]
pub fn pilot_places(seed: u64, ids: &[u32], solves: usize) -> Vec<usize> {
    let mut order = order_of(seed, ids);
    order.truncate(pilot_size(solves, ids.len()));
    order
}

fn pilot_size(solves: usize, patterns: usize) -> usize {
    let share = (PILOT_SHARE * solves as f64).round() as usize;
    share.max(FEWEST_PILOT).min(solves).min(patterns)
}

/// A population with a surrogate value for each pattern, none where there is none.
#[derive(Debug, Clone)]
pub struct Population<'a> {
    surrogates: &'a [Option<f64>],
    /// Stratum of each pattern: the highest surrogate values first, those without at the end.
    strata: Vec<usize>,
    /// Patterns of each stratum, those to be solved first in front.
    pub(super) members: Vec<Vec<usize>>,
    /// All patterns in the same order.
    order: Vec<usize>,
    percent: Option<f64>,
}

/// How many patterns of each stratum are solved, and why.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Allocation {
    /// The method.
    pub method: SamplingMethod,
    /// Crude patterns that one solve was predicted to be worth by the pilot; none for the mean, which
    /// takes a simple random sample.
    pub predicted_gain: Option<f64>,
    /// Rows of each stratum, those of the pilot included; one entry under crude sampling.
    pub rows: Vec<usize>,
}

impl<'a> Population<'a> {
    /// The population with the pattern ids `ids` (ascending) and their surrogate values.
    #[must_use]
    pub fn new(
        seed: u64,
        ids: &[u32],
        surrogates: &'a [Option<f64>],
        target: EstimateTarget,
    ) -> Self {
        let order = order_of(seed, ids);
        let percent = match target {
            EstimateTarget::Mean => None,
            EstimateTarget::Percentile(percent) => Some(percent),
        };
        let strata = strata_of(surrogates, percent);
        let count = strata.iter().max().map_or(0, |last| last + 1);
        let mut members = vec![Vec::new(); count];
        for &place in &order {
            members[strata[place]].push(place);
        }
        Self {
            surrogates,
            strata,
            members,
            order,
            percent,
        }
    }

    /// Number of patterns.
    #[must_use]
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is no pattern.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Number of strata.
    #[must_use]
    pub fn strata(&self) -> usize {
        self.members.len()
    }

    /// Stratum of the pattern at a place.
    #[must_use]
    pub fn stratum(&self, place: usize) -> usize {
        self.strata[place]
    }

    /// Patterns of a stratum.
    #[must_use]
    pub fn size(&self, stratum: usize) -> usize {
        self.members[stratum].len()
    }

    /// Mean of the surrogate values.
    #[must_use]
    pub fn surrogate_mean(&self) -> Option<f64> {
        let known = self.surrogates.iter().flatten();
        let count = known.clone().count();
        (count > 0).then(|| known.sum::<f64>() / count as f64)
    }

    /// Places of the pilot of a sample of `solves` patterns, in the order in which they are drawn.
    #[must_use]
    pub fn pilot(&self, solves: usize) -> &[usize] {
        &self.order[..pilot_size(solves, self.len())]
    }

    /// Allocates `solves` patterns in all by the values of the pilot, in its order; none where a row
    /// failed.
    #[must_use]
    pub fn allocate(&self, solves: usize, pilot: &[Option<f64>]) -> Allocation {
        let solves = solves.min(self.len());
        let crude = |predicted_gain| Allocation {
            method: SamplingMethod::Crude,
            predicted_gain,
            rows: vec![solves],
        };
        let Some(percent) = self.percent else {
            return crude(None);
        };
        let exceeding = 1.0 - percent / 100.0;
        let Some(spread) = self.spread_by_stratum(pilot, exceeding) else {
            return crude(None);
        };
        let mut least = vec![0; self.strata()];
        for &place in &self.order[..pilot.len().min(self.len())] {
            least[self.strata[place]] += 1;
        }
        for (rows, members) in least.iter_mut().zip(&self.members) {
            *rows = FEWEST_OF_STRATUM.max(*rows).min(members.len());
        }
        let rows = self.neyman(solves, &least, &spread);
        let gain = self.gain(solves, &rows, &spread, exceeding);
        if gain < LEAST_GAIN || rows.iter().sum::<usize>() > solves {
            return crude(Some(gain));
        }
        Allocation {
            method: SamplingMethod::TwoPhase,
            predicted_gain: Some(gain),
            rows,
        }
    }

    /// Crude patterns that one of `solves` is worth, allocated to the strata by `rows`.
    pub(super) fn gain(
        &self,
        solves: usize,
        rows: &[usize],
        spread: &[f64],
        exceeding: f64,
    ) -> f64 {
        let n = self.len() as f64;
        let within: f64 = rows
            .iter()
            .zip(&self.members)
            .zip(spread)
            .map(|((&rows, members), spread)| {
                let (rows, size) = (rows as f64, members.len() as f64);
                (size / n * spread).powi(2) * (1.0 / rows - 1.0 / size)
            })
            .sum();
        let variance = exceeding * (1.0 - exceeding);
        variance / solves as f64 / (variance / n + within)
    }

    /// Places of the patterns that an allocation solves, ascending.
    #[must_use]
    pub fn sample(&self, allocation: &Allocation) -> Vec<usize> {
        let mut places: Vec<usize> = match allocation.method {
            SamplingMethod::Crude => self.order[..allocation.rows[0]].to_vec(),
            SamplingMethod::TwoPhase => self
                .members
                .iter()
                .zip(&allocation.rows)
                .flat_map(|(members, &rows)| members[..rows].iter().copied())
                .collect(),
        };
        places.sort_unstable();
        places
    }

    /// Standard deviation of the exceedance of the percentile in every stratum, `sqrt(p (1 - p))`
    /// with p the mean of `P(a + b s + e > t)` over its surrogate values s; a, b and the spread of
    /// the normal e by regression on the pilot, t such that the share of the population is right.
    /// None where the pilot has too few values, or the surrogate does not vary.
    fn spread_by_stratum(&self, pilot: &[Option<f64>], exceeding: f64) -> Option<Vec<f64>> {
        let pairs = self
            .order
            .iter()
            .zip(pilot)
            .filter_map(|(&place, value)| Some((self.surrogates[place]?, (*value)?)));
        Some(self.spreads(&JointLaw::of(pairs)?, exceeding))
    }

    /// Standard deviation of the exceedance of the percentile in every stratum under `law`, the joint law of surrogate
    /// and value.
    pub(super) fn spreads(&self, law: &JointLaw, exceeding: f64) -> Vec<f64> {
        let normal = Normal::standard();
        let beyond = |t: f64, s: f64| normal.sf((t - law.y - law.slope * (s - law.x)) / law.rest);
        let known: Vec<f64> = self.surrogates.iter().flatten().copied().collect();
        let share = |t: f64| known.iter().map(|&s| beyond(t, s)).sum::<f64>() / known.len() as f64;
        let reach = |s: f64, sign: f64| law.y + law.slope * (s - law.x) + sign * 8.0 * law.rest;
        let mut low = known
            .iter()
            .map(|&s| reach(s, -1.0))
            .fold(f64::INFINITY, f64::min);
        let mut high = known
            .iter()
            .map(|&s| reach(s, 1.0))
            .fold(f64::NEG_INFINITY, f64::max);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if share(middle) > exceeding {
                low = middle;
            } else {
                high = middle;
            }
        }
        let spreads = self.members.iter().map(|members| {
            let of_known: Vec<f64> = members
                .iter()
                .filter_map(|&place| self.surrogates[place])
                .map(|s| beyond(low, s))
                .collect();
            // Nothing is known of patterns without surrogate.
            let p = if of_known.is_empty() {
                0.5
            } else {
                of_known.iter().sum::<f64>() / of_known.len() as f64
            };
            (p * (1.0 - p)).sqrt()
        });
        spreads.collect()
    }

    /// Rows proportional to size times spread, at least `least` and at most all, `solves` in all.
    pub(super) fn neyman(&self, solves: usize, least: &[usize], spread: &[f64]) -> Vec<usize> {
        let mut rows = least.to_vec();
        let ratio = |stratum: usize, rows: usize| {
            self.members[stratum].len() as f64 * spread[stratum] / (rows as f64 + 0.5)
        };
        // One after the other to the stratum that has the least of its share.
        for _ in rows.iter().sum::<usize>()..solves {
            let wanting = (0..rows.len())
                .filter(|&stratum| rows[stratum] < self.members[stratum].len())
                .max_by(|&a, &b| ratio(a, rows[a]).total_cmp(&ratio(b, rows[b])));
            if let Some(stratum) = wanting {
                rows[stratum] += 1;
            }
        }
        rows
    }
}

/// Stratum of each pattern: by rank from the highest surrogate down; one stratum without percentile.
fn strata_of(surrogates: &[Option<f64>], percent: Option<f64>) -> Vec<usize> {
    let Some(percent) = percent else {
        return vec![0; surrogates.len()];
    };
    let mut ranked: Vec<usize> = (0..surrogates.len())
        .filter(|&place| surrogates[place].is_some())
        .collect();
    ranked.sort_by(|&a, &b| {
        let value = |place: usize| surrogates[place].unwrap_or(f64::NEG_INFINITY);
        value(b).total_cmp(&value(a)).then(a.cmp(&b))
    });
    let exceeding = 1.0 - percent / 100.0;
    let count = ranked.len();
    let mut ends: Vec<usize> = EDGES
        .iter()
        .map(|edge| edge * exceeding)
        .filter(|share| *share < TOP_SHARE)
        .map(|share| (share * count as f64).round() as usize)
        .filter(|&end| end > 0 && end < count)
        .collect();
    ends.push(count);
    ends.dedup();
    let mut strata = vec![ends.len(); surrogates.len()];
    for (rank, place) in ranked.into_iter().enumerate() {
        strata[place] = ends.partition_point(|&end| end <= rank);
    }
    if count == 0 {
        return vec![0; surrogates.len()];
    }
    strata
}
