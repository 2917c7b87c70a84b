//! `blisk verify`: a random sample of delivered rows solved again.

use std::fmt::Display;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::progress::RunProgress;
use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::{
    ReducedEngineSource, StoredStudy, Study, TimeDomainRequest, VerifyRequest, audit_peaks, verify,
    verify_in_time,
};

/// Arguments of the command.
#[derive(Debug)]
pub(super) struct VerifyArguments {
    pub(super) target: PathBuf,
    pub(super) sample: u32,
    pub(super) seed: Option<u64>,
    pub(super) question: Question,
    pub(super) study: Option<PathBuf>,
    pub(super) threads: Option<u16>,
    pub(super) json: bool,
}

/// What is asked of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Question {
    /// The same on the full-contact model?
    FullModel,
    /// A higher peak elsewhere?
    DenseSweep,
    /// The same in time? Of one row, by scenario and pattern, or the first of the sample.
    TimeDomain(Option<(usize, u32)>),
}

impl Question {
    /// By the flags, of which at most one is set, and the row.
    pub(super) fn of(dense_sweep: bool, time_domain: bool, row: Option<(usize, u32)>) -> Self {
        match (dense_sweep, time_domain) {
            (true, _) => Self::DenseSweep,
            (_, true) => Self::TimeDomain(row),
            _ => Self::FullModel,
        }
    }
}

pub(super) fn command(arguments: &VerifyArguments) -> Result<ExitStatus, Failure> {
    let stored = stored(&arguments.target, arguments.study.as_deref())?;
    let request = VerifyRequest {
        sample: arguments.sample as usize,
        seed: arguments.seed,
        threads: arguments.threads.map_or_else(
            || std::thread::available_parallelism().map_or(1, NonZero::get),
            usize::from,
        ),
    };
    let progress = RunProgress::new();
    match arguments.question {
        Question::FullModel => {
            let report = verify(&stored, &ReducedEngineSource, request, &progress);
            progress.finish();
            let report = report?;
            name_table(&stored, "verification.parquet");
            Ok(finish(arguments, &report, report.verified))
        }
        Question::DenseSweep => {
            let report = audit_peaks(&stored, &ReducedEngineSource, request, &progress);
            progress.finish();
            let report = report?;
            name_table(&stored, "peak_audit.parquet");
            Ok(finish(arguments, &report, report.verified))
        }
        Question::TimeDomain(row) => {
            let request = TimeDomainRequest {
                row,
                sample: request,
            };
            let report = verify_in_time(&stored, &ReducedEngineSource, request, &progress);
            progress.finish();
            let report = report?;
            Ok(finish(arguments, &report, report.verified))
        }
    }
}

/// Names the table that was written.
fn name_table(stored: &StoredStudy, table: &str) {
    output::message(&format!("wrote {}", stored.folder.join(table).display()));
}

/// Prints the report and says how the command ends.
fn finish(
    arguments: &VerifyArguments,
    report: &(impl Serialize + Display),
    verified: bool,
) -> ExitStatus {
    output::result(arguments.json, report);
    if verified {
        ExitStatus::Done
    } else {
        ExitStatus::VerificationFailed
    }
}

/// The results that `target`, a study file or a results folder, stands for.
fn stored(target: &Path, study: Option<&Path>) -> Result<StoredStudy, Failure> {
    if target.is_dir() {
        return Ok(StoredStudy::open(target, study)?);
    }
    let results = Path::new("results").join(Study::read(target)?.name);
    Ok(StoredStudy::of_study(target, &results)?)
}
