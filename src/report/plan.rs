//! What a study will cost, and what its percentiles will be worth.

use std::fmt;
use std::path::PathBuf;

use serde::Serialize;

use super::text_table::TextTable;
use super::words::{duration, four_digits, trimmed};
use crate::population::statistics::{Accounting, ExpectedSum, StopOptions};

/// Plan of a study, from a pilot. Times are those of this machine while the pilot was solved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyPlan {
    /// Name of the study.
    pub name: String,
    /// Patterns, at most where it may stop before.
    pub patterns: u64,
    /// Scenarios.
    pub scenarios: u64,
    /// Rows, at most.
    pub rows: u64,
    /// Threads.
    pub threads: usize,
    /// Patterns of the pilot.
    pub pilot_patterns: u64,
    /// Rows of the pilot by status.
    pub pilot_rows: Accounting,
    /// Time to load, reduce and solve the tuned wheel, s; a later run takes the reduced model from its
    /// folder.
    pub set_up_s: f64,
    /// Mean time of a pattern, all scenarios, on a processor, s.
    pub cpu_s_per_pattern: f64,
    /// Share of a processor that a thread had; less than 1 on a machine that is busy with other things.
    pub processor_share: f64,
    /// Time of all patterns.
    pub time: PlannedTime,
    /// Time of the patterns after which the rule is expected to stop; null without one, or where the
    /// pilot does not say.
    pub expected_time: Option<PlannedTime>,
    /// Rows that are stored already, which a run takes over; null where none is.
    pub stored: Option<PlannedRest>,
    /// Largest memory, bytes: that of the pilot and what a run grows by with all rows; null where the system
    /// does not say.
    pub memory_bytes: Option<u64>,
    /// Space on disk.
    pub disk: PlannedDisk,
    /// What the percentiles will be worth.
    pub percentiles: Vec<PlannedPercentile>,
    /// What the rule to stop will see; null without one.
    pub stop: Option<PlannedStop>,
}

/// Time of a number of patterns, with 95 % bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlannedTime {
    /// Patterns.
    pub patterns: u64,
    /// Time on processors, all threads together, set-up left out, s.
    pub cpu_s: ExpectedSum,
    /// Time on the clock, set-up included, on a machine as busy as in the pilot, s.
    pub wall_s: f64,
    /// Lower bound of the time on the clock, s.
    pub wall_lower_s: f64,
    /// Upper bound of the time on the clock, s; null where one pattern cannot say.
    pub wall_upper_s: Option<f64>,
}

/// Rows that are stored, and the time of the others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedRest {
    /// The results folder.
    pub folder: PathBuf,
    /// Rows of the study that are stored there.
    pub rows: u64,
    /// Time of the others, as that of so many patterns; null where all are stored.
    pub time: Option<PlannedTime>,
}

/// Space on disk, without the cache of the reduced model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlannedDisk {
    /// Bytes of a row of `responses.parquet`.
    pub bytes_per_row: f64,
    /// Bytes of `responses.parquet` and `patterns.parquet`.
    pub results_bytes: u64,
    /// Bytes of `responses.parquet`, `patterns.parquet` and their parts, which are there until the
    /// tables are.
    pub peak_bytes: u64,
}

/// A percentile of the study to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlannedPercentile {
    /// The percentile in percent.
    pub percent: u32,
    /// Smallest number of patterns with an interval.
    pub needed_patterns: u64,
    /// Whether the study has as many.
    pub estimable: bool,
    /// Expected width of the 95 % interval over the value, widest scenario; null where the pilot has
    /// too few patterns to say.
    pub peak_amplitude_m_relative_width: Option<f64>,
    /// Expected width of the 95 % interval of the amplification factor over the value, widest scenario;
    /// null where the pilot has too few patterns to say.
    pub amplification_factor_relative_width: Option<f64>,
}

/// What a rule to stop will see.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedStop {
    /// What is wanted.
    pub wanted: StopOptions,
    /// Confidence at each look.
    pub confidence: f64,
    /// The looks.
    pub looks: Vec<PlannedLook>,
    /// Patterns at the first look that is expected to be narrow enough, all of them if none is; null
    /// where the pilot does not say.
    pub expected_patterns: Option<u64>,
    /// Whether the target is expected to be reached; null where the pilot does not say.
    pub reached: Option<bool>,
}

/// A look to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlannedLook {
    /// Patterns.
    pub patterns: u64,
    /// Expected width of the interval over the value, widest scenario.
    pub relative_width: Option<f64>,
}

impl fmt::Display for StudyPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "study {}: {} patterns x {} scenarios = {} rows; pilot of {} patterns, {} rows ok, {} failed",
            self.name,
            self.patterns,
            self.scenarios,
            self.rows,
            self.pilot_patterns,
            self.pilot_rows.ok(),
            self.pilot_rows.failed()
        )?;
        writeln!(
            f,
            "set-up {}; {} of CPU a pattern; a thread had {:.0} % of a processor",
            duration(self.set_up_s),
            duration(self.cpu_s_per_pattern),
            100.0 * self.processor_share
        )?;
        self.line_of(f, "all patterns", &self.time)?;
        if let Some(expected) = &self.expected_time {
            self.line_of(f, "expected to stop", expected)?;
        }
        if let Some(stored) = &self.stored {
            let what = format!(
                "{} of {} rows are stored in {}",
                stored.rows,
                self.rows,
                stored.folder.display()
            );
            match &stored.time {
                Some(rest) => self.line_of(f, &format!("{what}; the rest, like"), rest)?,
                None => writeln!(f, "{what}: none is left to solve")?,
            }
        }
        let memory = self.memory_bytes.map_or("unknown".to_owned(), size);
        writeln!(
            f,
            "memory about {memory}; disk about {}, {} while running ({:.0} bytes a row)\n",
            size(self.disk.results_bytes),
            size(self.disk.peak_bytes),
            self.disk.bytes_per_row
        )?;
        let mut table = TextTable::new(&[
            "percentile",
            "needs patterns",
            "amplitude within",
            "amplification within",
        ]);
        for planned in &self.percentiles {
            let shown = |width: Option<f64>| match width {
                _ if !planned.estimable => "not estimable".to_owned(),
                None => "-".to_owned(),
                Some(width) => percent(width),
            };
            table.row(vec![
                format!("P{}", planned.percent),
                planned.needed_patterns.to_string(),
                shown(planned.peak_amplitude_m_relative_width),
                shown(planned.amplification_factor_relative_width),
            ]);
        }
        write!(f, "{table}")?;
        if let Some(stop) = &self.stop {
            write!(f, "\n{stop}")?;
        }
        writeln!(
            f,
            "\nwithin: expected width of the 95 % interval over the value, widest scenario; - = more \
             patterns in the pilot are needed to say (--pilot). Times are those of this machine, now."
        )
    }
}

impl StudyPlan {
    fn line_of(
        &self,
        f: &mut fmt::Formatter<'_>,
        what: &str,
        planned: &PlannedTime,
    ) -> fmt::Result {
        let upper = planned.wall_upper_s.map_or("?".to_owned(), duration);
        writeln!(
            f,
            "{what}: {} patterns, {} of CPU, {} on {} threads [{} {upper}]",
            planned.patterns,
            duration(planned.cpu_s.value),
            duration(planned.wall_s),
            self.threads,
            duration(planned.wall_lower_s)
        )
    }
}

impl fmt::Display for PlannedStop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "stop at P{} of {} within {}, looks at {:.1} %:",
            trimmed(self.wanted.percentile),
            self.wanted.quantity.name(),
            percent(self.wanted.relative_width),
            100.0 * self.confidence
        )?;
        for look in &self.looks {
            let width = look.relative_width.map_or("-".to_owned(), percent);
            writeln!(f, "  {} patterns: {width}", look.patterns)?;
        }
        match (self.reached, self.expected_patterns) {
            (Some(true), Some(patterns)) => writeln!(f, "expected to stop at {patterns} patterns"),
            (Some(false), _) => writeln!(f, "not expected to be reached: exit code 6"),
            _ => writeln!(f, "the pilot is too small to say where it stops"),
        }
    }
}

fn percent(share: f64) -> String {
    format!("{} %", four_digits(100.0 * share))
}

fn size(bytes: u64) -> String {
    let mebibytes = bytes as f64 / 1_048_576.0;
    if mebibytes < 1000.0 {
        format!("{mebibytes:.1} MiB")
    } else {
        format!("{:.1} GiB", mebibytes / 1024.0)
    }
}
