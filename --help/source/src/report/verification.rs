//! What a verification found: replays, errors against the full-contact model, and the verdict.

use std::fmt;

use serde::Serialize;

use super::text_table::TextTable;
use crate::population::table::VerificationRecord;
use crate::response::harmonic_balance::Status;

/// Distribution of the absolute values of a relative error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorDistribution {
    /// Rows compared.
    pub n: usize,
    /// Median, order statistic `x_(ceil(n / 2))`; none without rows.
    pub median: Option<f64>,
    /// 95th percentile of the sample, `x_(ceil(0.95 n))`.
    pub p95: Option<f64>,
    /// Largest.
    pub max: Option<f64>,
}

impl ErrorDistribution {
    /// The distribution of the magnitudes of the given signed errors.
    #[must_use]
    pub fn of(errors: impl IntoIterator<Item = f64>) -> Self {
        let mut sizes: Vec<f64> = errors.into_iter().map(f64::abs).collect();
        sizes.sort_by(f64::total_cmp);
        let n = sizes.len();
        let ranked = |share: f64| {
            let rank = (share * n as f64).ceil() as usize;
            sizes.get(rank.saturating_sub(1)).copied()
        };
        Self {
            n,
            median: ranked(0.5),
            p95: ranked(0.95),
            max: sizes.last().copied(),
        }
    }
}

/// Errors of the rows of one regime.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RegimeErrors {
    /// Accepted relative error of the peak amplitude.
    pub accepted_amplitude_error: f64,
    /// Rows whose amplitude error is larger.
    pub beyond: usize,
    /// Relative error of the peak amplitude.
    pub amplitude: ErrorDistribution,
    /// Relative error of the peak frequency.
    pub frequency: ErrorDistribution,
    /// Relative error of the amplification factor.
    pub amplification_factor: ErrorDistribution,
}

/// What was verified and how it came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VerificationReport {
    /// Name of the study.
    pub name: String,
    /// Digest of the study.
    pub study_digest: String,
    /// Seed of the sample.
    pub seed: u64,
    /// Rows of the study.
    pub rows: usize,
    /// Rows drawn.
    pub sampled: usize,
    /// Drawn rows, `scenario/pattern`, that the same path does not give again bit for bit.
    pub different_replays: Vec<String>,
    /// Drawn rows without a delivered value.
    pub failed_rows: usize,
    /// Drawn rows with a delivered value that the full-contact model gave no value for.
    pub unchecked_rows: usize,
    /// Coordinates of the full-contact wheel.
    pub reference_coordinates: usize,
    /// Samples per period of the full-contact model.
    pub reference_samples_per_period: usize,
    /// Rows in which every contact pair stays closed.
    pub closed: RegimeErrors,
    /// Rows in which contact pairs separate.
    pub separating: RegimeErrors,
    /// Whether all of it holds.
    pub verified: bool,
}

/// What a verification is about, besides its records.
#[derive(Debug, Clone, PartialEq)]
pub struct VerificationContext {
    /// Name of the study.
    pub name: String,
    /// Digest of the study.
    pub study_digest: String,
    /// Seed of the sample.
    pub seed: u64,
    /// Rows of the study.
    pub rows: usize,
    /// Coordinates of the full-contact wheel.
    pub reference_coordinates: usize,
    /// Samples per period of the full-contact model.
    pub reference_samples_per_period: usize,
    /// Relative error that the settings of the study allow: of its basis and of its peak search.
    pub stated_error: f64,
}

/// Least accepted relative amplitude error where every pair stays closed.
const ACCEPTED_CLOSED: f64 = 3e-3;
/// Least accepted relative amplitude error where pairs separate.
const ACCEPTED_SEPARATING: f64 = 1e-2;

impl VerificationReport {
    /// The report on `records`.
    #[must_use]
    pub fn new(context: VerificationContext, records: &[VerificationRecord]) -> Self {
        let regime = |separates: bool, least: f64| {
            let rows: Vec<&VerificationRecord> = records
                .iter()
                .filter(|record| record.separates() == separates)
                .collect();
            let distribution = |error: fn(&VerificationRecord) -> Option<f64>| {
                ErrorDistribution::of(rows.iter().filter_map(|row| error(row)))
            };
            let accepted = least.max(context.stated_error);
            RegimeErrors {
                accepted_amplitude_error: accepted,
                beyond: rows
                    .iter()
                    .filter_map(|row| row.amplitude_error())
                    .filter(|error| error.is_nan() || error.abs() > accepted)
                    .count(),
                amplitude: distribution(VerificationRecord::amplitude_error),
                frequency: distribution(VerificationRecord::frequency_error),
                amplification_factor: distribution(VerificationRecord::amplification_factor_error),
            }
        };
        let (closed, separating) = (
            regime(false, ACCEPTED_CLOSED),
            regime(true, ACCEPTED_SEPARATING),
        );
        let different_replays: Vec<String> = records
            .iter()
            .filter(|record| !record.replay_identical)
            .map(|record| format!("{}/{}", record.scenario.index, record.delivered.pattern))
            .collect();
        let failed = |record: &&VerificationRecord| record.delivered.status != Status::Ok;
        let unchecked_rows = records
            .iter()
            .filter(|record| record.is_unchecked())
            .count();
        Self {
            verified: different_replays.is_empty()
                && unchecked_rows == 0
                && closed.beyond + separating.beyond == 0,
            name: context.name,
            study_digest: context.study_digest,
            seed: context.seed,
            rows: context.rows,
            sampled: records.len(),
            different_replays,
            failed_rows: records.iter().filter(failed).count(),
            unchecked_rows,
            reference_coordinates: context.reference_coordinates,
            reference_samples_per_period: context.reference_samples_per_period,
            closed,
            separating,
        }
    }
}

impl fmt::Display for VerificationReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "study {}: {} of {} rows drawn with seed {}",
            self.name, self.sampled, self.rows, self.seed
        )?;
        let same = self.sampled - self.different_replays.len();
        write!(f, "same path: {same} of {} bit-identical", self.sampled)?;
        if self.different_replays.is_empty() {
            writeln!(f)?;
        } else {
            let rows = self.different_replays.join(", ");
            writeln!(f, "; different (scenario/pattern): {rows}")?;
        }
        writeln!(
            f,
            "full-contact model ({} coordinates, {} samples, same harmonics): {} rows without delivered value, {} without reference",
            self.reference_coordinates,
            self.reference_samples_per_period,
            self.failed_rows,
            self.unchecked_rows
        )?;
        let mut table = TextTable::new(&[
            "error of", "contact", "n", "median", "P95", "max", "accepted",
        ]);
        for (contact, errors) in [("closed", &self.closed), ("separating", &self.separating)] {
            let accepted = percent(Some(errors.accepted_amplitude_error));
            for (name, distribution, accepted) in [
                ("amplitude", errors.amplitude, accepted.as_str()),
                ("frequency", errors.frequency, ""),
                ("amplification factor", errors.amplification_factor, ""),
            ] {
                if distribution.n > 0 {
                    table.row(vec![
                        name.to_owned(),
                        contact.to_owned(),
                        distribution.n.to_string(),
                        percent(distribution.median),
                        percent(distribution.p95),
                        percent(distribution.max),
                        accepted.to_owned(),
                    ]);
                }
            }
        }
        write!(f, "\n{table}\n")?;
        writeln!(
            f,
            "{}",
            if self.verified {
                "verified"
            } else {
                "NOT verified"
            }
        )
    }
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "-".to_owned(), |share| format!("{:.4} %", 100.0 * share))
}

#[cfg(test)]
mod tests {
    use super::ErrorDistribution;

    #[test]
    fn a_distribution_is_of_sizes_and_by_rank() {
        let of = ErrorDistribution::of([0.1, -0.4, 0.2, -0.3]);
        assert_eq!(
            (of.n, of.median, of.p95, of.max),
            (4, Some(0.2), Some(0.4), Some(0.4))
        );
        let none = ErrorDistribution::of([]);
        assert_eq!((none.n, none.median, none.max), (0, None, None));
    }
}
