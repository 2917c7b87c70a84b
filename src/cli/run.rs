//! `blisk run`: solves a study or continues it.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use super::progress::RunProgress;
use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::{ReducedEngineSource, RunRequest, Study, run};

pub(super) fn command(
    study: &Path,
    out: Option<PathBuf>,
    threads: Option<u16>,
    json: bool,
) -> Result<ExitStatus, Failure> {
    let study = Study::read(study)?;
    let results = out.unwrap_or_else(|| Path::new("results").join(&study.name));
    let threads = threads.map_or_else(
        || std::thread::available_parallelism().map_or(1, NonZero::get),
        usize::from,
    );
    let progress = RunProgress::new();
    let outcome = run(
        RunRequest {
            study: &study,
            results: &results,
            threads,
        },
        &ReducedEngineSource,
        &progress,
    );
    progress.finish();
    let outcome = outcome?;
    if outcome.rows_solved == 0 {
        output::message(&format!(
            "{} is complete, nothing to solve",
            results.display()
        ));
    } else {
        output::message(&format!(
            "solved {} rows, reused {}; results in {}",
            outcome.rows_solved,
            outcome.rows_reused,
            results.display()
        ));
    }
    output::result(json, &outcome.summary);
    Ok(super::stats::status_of(&outcome.summary))
}
