//! `blisk run`: solves a study or continues it, or one shard of it.

use std::path::{Path, PathBuf};

use super::progress::RunProgress;
use super::run_command::Failure;
use super::scheduler::{ShardArgument, threads};
use super::{ExitStatus, interrupt, output};
use crate::study::{PipelineError, ReducedEngineSource, RunRequest, Study, run, run_shard};

/// Arguments of the command.
#[derive(Debug)]
pub(super) struct RunArguments {
    pub(super) study: PathBuf,
    pub(super) out: Option<PathBuf>,
    pub(super) threads: Option<u16>,
    pub(super) shard: Option<ShardArgument>,
    pub(super) json: bool,
}

pub(super) fn command(arguments: RunArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    let shard = arguments.shard.map(ShardArgument::shard).transpose()?;
    let out = arguments.out;
    let results = out.unwrap_or_else(|| Path::new("results").join(&study.name));
    let signals = interrupt::watch().map_err(|error| Failure {
        status: ExitStatus::InternalError,
        message: format!("cannot watch for signals: {error}"),
    })?;
    let progress = RunProgress::new().stopped_by(signals);
    let request = RunRequest {
        study: &study,
        results: &results,
        threads: threads(arguments.threads),
    };
    let outcome = match shard {
        None => run(request, &ReducedEngineSource, &progress),
        Some(shard) => run_shard(request, shard, &ReducedEngineSource, &progress),
    };
    progress.finish();
    let outcome = match outcome {
        Err(error @ PipelineError::Interrupted { .. }) => {
            return Err(Failure {
                status: signals.came().unwrap_or(ExitStatus::Interrupted),
                message: error.to_string(),
            });
        }
        outcome => outcome?,
    };
    let what = shard.map_or_else(String::new, |shard| format!("shard {shard} of "));
    if outcome.rows_solved == 0 {
        output::message(&format!(
            "{what}{} is complete, nothing to solve",
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
    if shard.is_some() {
        // Statistics are those of the whole, once it is merged.
        return Ok(ExitStatus::Done);
    }
    output::result(arguments.json, &outcome.summary);
    Ok(super::stats::status_of(&outcome.summary))
}
