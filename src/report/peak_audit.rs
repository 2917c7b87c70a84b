//! What an audit of the peak search found, and its verdict.

use std::fmt;

use serde::Serialize;

use super::text_table::TextTable;
use super::verification::ErrorDistribution;
use crate::population::statistics::{CONFIDENCE, proportion_upper_bound};
use crate::population::table::PeakAuditRecord;

/// Share by which a sweep must beat a delivered peak for the peak to count as missed.
const MISSED: f64 = 1e-3;

/// Delivered peaks against dense sweeps of the same rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PeakAuditReport {
    /// Name of the study.
    pub name: String,
    /// Seed of the sample.
    pub seed: u64,
    /// Rows of the study.
    pub rows: usize,
    /// Rows drawn.
    pub sampled: usize,
    /// Drawn rows that were swept.
    pub swept: usize,
    /// Drawn rows without a delivered value.
    pub failed_rows: usize,
    /// Frequencies solved, those without a solution included.
    pub points: usize,
    /// Frequencies without a solution.
    pub failed_points: usize,
    /// Frequencies that were solved with fewer harmonics than their load has.
    pub points_with_fewer_harmonics: usize,
    /// Sweeps whose highest value lies at an end of the band.
    pub open_sweeps: usize,
    /// Share from which on a peak counts as missed.
    pub missed_share: f64,
    /// Rows, `scenario/pattern`, whose peak the sweep beats by more.
    pub missed: Vec<String>,
    /// Rows, `scenario/pattern`, that are lower than the sweep by more than their stated error; none of a row that states nothing.
    pub beyond_stated: Vec<String>,
    /// Upper bound on the share of missed rows in the study, one-sided, of Clopper & Pearson (1934); none without rows.
    pub missed_upper_bound: Option<f64>,
    /// Confidence of that bound.
    pub confidence: f64,
    /// How far delivered peaks lie below the sweeps, where they do.
    pub under_read: ErrorDistribution,
    /// Whether no peak was missed.
    pub verified: bool,
}

impl PeakAuditReport {
    /// The report on `records`.
    #[must_use]
    pub fn new(name: &str, seed: u64, rows: usize, records: &[PeakAuditRecord]) -> Self {
        let sweeps: Vec<_> = records.iter().filter_map(|record| record.swept).collect();
        let lower_by = |most: fn(&PeakAuditRecord) -> Option<f64>| {
            let is_lower = |record: &&PeakAuditRecord| {
                let both = record.under_read().zip(most(record));
                both.is_some_and(|(share, most)| share.is_nan() || share > most)
            };
            let rows = records.iter().filter(is_lower);
            rows.map(|record| format!("{}/{}", record.scenario.index, record.delivered.pattern))
                .collect::<Vec<String>>()
        };
        let missed = lower_by(|_| Some(MISSED));
        let under_read = records.iter().filter_map(PeakAuditRecord::under_read);
        Self {
            name: name.to_owned(),
            seed,
            rows,
            sampled: records.len(),
            swept: sweeps.len(),
            failed_rows: records.len() - sweeps.len(),
            points: sweeps.iter().map(|sweep| sweep.points).sum(),
            failed_points: sweeps.iter().map(|sweep| sweep.failed).sum(),
            points_with_fewer_harmonics: sweeps
                .iter()
                .map(|sweep| sweep.with_fewer_harmonics)
                .sum(),
            open_sweeps: sweeps.iter().filter(|sweep| !sweep.inside).count(),
            missed_share: MISSED,
            missed_upper_bound: (!sweeps.is_empty())
                .then(|| proportion_upper_bound(missed.len() as u64, sweeps.len() as u64)),
            confidence: CONFIDENCE,
            under_read: ErrorDistribution::of(under_read.map(|share| share.max(0.0))),
            beyond_stated: lower_by(|record| record.delivered.stated_error),
            verified: missed.is_empty(),
            missed,
        }
    }
}

impl fmt::Display for PeakAuditReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "study {}: {} of {} rows drawn with seed {}, {} without delivered value",
            self.name, self.sampled, self.rows, self.seed, self.failed_rows
        )?;
        writeln!(
            f,
            "dense sweeps: {} frequencies, {} with fewer harmonics than their load has, {} without solution; {} sweeps highest at an end of their band",
            self.points, self.points_with_fewer_harmonics, self.failed_points, self.open_sweeps
        )?;
        let percent = |share: Option<f64>| {
            share.map_or_else(|| "-".to_owned(), |share| format!("{:.4} %", 100.0 * share))
        };
        let mut table = TextTable::new(&["delivered below swept", "n", "median", "P95", "max"]);
        table.row(vec![
            "peak amplitude".to_owned(),
            self.under_read.n.to_string(),
            percent(self.under_read.median),
            percent(self.under_read.p95),
            percent(self.under_read.max),
        ]);
        write!(f, "\n{table}\n")?;
        writeln!(
            f,
            "{} rows beaten by more than {}; at most {} of all rows, with {} % confidence",
            self.missed.len(),
            percent(Some(self.missed_share)),
            percent(self.missed_upper_bound),
            100.0 * self.confidence
        )?;
        let lists = [
            ("missed", &self.missed),
            ("lower by more than stated", &self.beyond_stated),
        ];
        for (what, rows) in lists.into_iter().filter(|(_, rows)| !rows.is_empty()) {
            writeln!(f, "{what} (scenario/pattern): {}", rows.join(", "))?;
        }
        writeln!(
            f,
            "{}",
            if self.verified {
                "no peak missed"
            } else {
                "PEAKS MISSED"
            }
        )
    }
}
