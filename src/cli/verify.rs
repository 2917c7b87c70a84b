//! `blisk verify`: a random sample of delivered rows solved again.

use std::fmt::Display;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::progress::RunProgress;
use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::{ReducedEngineSource, StoredStudy, Study, VerifyRequest, audit_peaks, verify};

/// Arguments of the command.
#[derive(Debug)]
pub(super) struct VerifyArguments {
    pub(super) target: PathBuf,
    pub(super) sample: u32,
    pub(super) seed: Option<u64>,
    pub(super) dense_sweep: bool,
    pub(super) study: Option<PathBuf>,
    pub(super) threads: Option<u16>,
    pub(super) json: bool,
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
    if arguments.dense_sweep {
        let report = audit_peaks(&stored, &ReducedEngineSource, request, &progress);
        progress.finish();
        let report = report?;
        return Ok(finish(
            arguments,
            &stored,
            "peak_audit.parquet",
            &report,
            report.verified,
        ));
    }
    let report = verify(&stored, &ReducedEngineSource, request, &progress);
    progress.finish();
    let report = report?;
    Ok(finish(
        arguments,
        &stored,
        "verification.parquet",
        &report,
        report.verified,
    ))
}

/// Names the table that was written, prints the report and says how the command ends.
fn finish(
    arguments: &VerifyArguments,
    stored: &StoredStudy,
    table: &str,
    report: &(impl Serialize + Display),
    verified: bool,
) -> ExitStatus {
    output::message(&format!("wrote {}", stored.folder.join(table).display()));
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
