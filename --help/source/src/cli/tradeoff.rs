//! `blisk tradeoff`: what accuracy costs in a study.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::exit::Failure;
use super::progress::RunProgress;
use super::scheduler::threads;
use super::{ExitStatus, output};
use crate::campaign::{TradeoffRequest, tradeoff};
use crate::study::Study;

/// Arguments of the command.
#[derive(Debug, Args)]
pub struct TradeoffArguments {
    /// The study file.
    study: PathBuf,
    /// Patterns of the sample; each is solved at up to three loads at every setting.
    #[arg(long, value_name = "N", default_value = "8", value_parser = clap::value_parser!(u32).range(2..))]
    patterns: u32,
    /// Folder of the tables [default: results/NAME].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// `full` checks the reference itself by the full-contact model, one pattern at these loads; slow.
    #[arg(long, value_enum, default_value = "reduced")]
    reference: Reference,
    /// Number of threads [default: those of the scheduler's allocation, else all cores]; errors and
    /// work counts do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What the reference is checked by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Reference {
    /// Nothing: the best settings of the ladder are the reference.
    Reduced,
    /// Every contact dof of the whole wheel.
    Full,
}

pub(super) fn command(arguments: &TradeoffArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    let named = || Path::new("results").join(&study.name);
    let results = arguments.out.clone().unwrap_or_else(named);
    let progress = RunProgress::new();
    let report = tradeoff(
        TradeoffRequest {
            study: &study,
            results: &results,
            patterns: arguments.patterns as usize,
            full: arguments.reference == Reference::Full,
            threads: threads(arguments.threads),
        },
        &progress,
    );
    progress.finish();
    let report = report?;
    output::message(&format!("tables in {}", results.display()));
    output::result(arguments.json, &report)?;
    Ok(ExitStatus::Done)
}
