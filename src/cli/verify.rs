//! `blisk verify`: a random sample of delivered rows solved again.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use super::progress::RunProgress;
use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::{ReducedEngineSource, StoredStudy, Study, VerifyRequest, verify};

/// Arguments of the command.
#[derive(Debug)]
pub(super) struct VerifyArguments {
    pub(super) target: PathBuf,
    pub(super) sample: u32,
    pub(super) seed: Option<u64>,
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
    let report = verify(&stored, &ReducedEngineSource, request, &progress);
    progress.finish();
    let report = report?;
    output::message(&format!(
        "wrote {}",
        stored.folder.join("verification.parquet").display()
    ));
    output::result(arguments.json, &report);
    Ok(if report.verified {
        ExitStatus::Done
    } else {
        ExitStatus::VerificationFailed
    })
}

/// The results that `target`, a study file or a results folder, stands for.
fn stored(target: &Path, study: Option<&Path>) -> Result<StoredStudy, Failure> {
    if target.is_dir() {
        return Ok(StoredStudy::open(target, study)?);
    }
    let results = Path::new("results").join(Study::read(target)?.name);
    Ok(StoredStudy::of_study(target, &results)?)
}
