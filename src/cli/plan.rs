//! `blisk plan`: what a study will cost, from its first few patterns.

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Failure;
use super::progress::RunProgress;
use super::scheduler::threads;
use super::{ExitStatus, output};
use crate::campaign::{PlanRequest, plan};
use crate::settings::ReducedEngineSource;
use crate::study::Study;

/// Arguments of `blisk plan`.
#[derive(Debug, Args)]
pub struct PlanArguments {
    /// The study file. Rows that its results folder, results/NAME, has are counted.
    study: PathBuf,
    /// Patterns of the pilot, the first ones of the study; they are solved, timed and not kept.
    #[arg(long, value_name = "N", default_value = "20", value_parser = clap::value_parser!(u32).range(2..))]
    pilot: u32,
    /// Number of threads [default: those of the scheduler's allocation, else all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn command(arguments: &PlanArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    let progress = RunProgress::new();
    let request = PlanRequest {
        study: &study,
        results: &Path::new("results").join(&study.name),
        pilot: arguments.pilot as usize,
        threads: threads(arguments.threads),
    };
    let plan = plan(request, &ReducedEngineSource, &progress);
    progress.finish();
    output::result(arguments.json, &plan?)?;
    Ok(ExitStatus::Done)
}
