//! `blisk estimate`: mean and percentiles from few solves, with a surrogate of every pattern.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;

use super::exit::Failure;
use super::progress::RunProgress;
use super::scheduler::threads;
use super::{ExitStatus, output};
use crate::campaign::{EstimateRequest, estimate};
use crate::population::statistics::EstimateTarget;
use crate::settings::ReducedEngineSource;
use crate::study::Study;

/// Arguments of `blisk estimate`.
#[derive(Debug, Args)]
pub struct EstimateArguments {
    /// The study file.
    study: PathBuf,
    /// What the solves are to tell best: `mean`, or a percentile from 50 to 99.9.
    #[arg(long, value_name = "mean|P", default_value = "99")]
    target: TargetArgument,
    /// Patterns of the population, each with a surrogate [default: those of the study].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    patterns: Option<u32>,
    /// Patterns that are solved in each scenario at most [default: a tenth of the patterns].
    #[arg(long, value_name = "M", value_parser = clap::value_parser!(u32).range(1..))]
    solves: Option<u32>,
    /// Folder of the estimate [default: results/NAME-estimate].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of threads [default: all cores]; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// `mean` or a percentile.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TargetArgument(EstimateTarget);

impl FromStr for TargetArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "mean" {
            return Ok(Self(EstimateTarget::Mean));
        }
        text.parse()
            .ok()
            .filter(|percent| (50.0..=99.9).contains(percent))
            .map(|percent| Self(EstimateTarget::Percentile(percent)))
            .ok_or_else(|| "accepted: mean, or a percentile from 50 to 99.9".to_owned())
    }
}

pub(super) fn command(arguments: &EstimateArguments) -> Result<ExitStatus, Failure> {
    let mut study = Study::read(&arguments.study)?;
    if let Some(patterns) = arguments.patterns {
        study.patterns = patterns;
    }
    let named = || Path::new("results").join(format!("{}-estimate", study.name));
    let results = arguments.out.clone().unwrap_or_else(named);
    let progress = RunProgress::new();
    let report = estimate(
        EstimateRequest {
            study: &study,
            results: &results,
            solves: arguments.solves.unwrap_or(study.patterns / 10),
            target: arguments.target.0,
            threads: threads(arguments.threads),
        },
        &ReducedEngineSource,
        &progress,
    );
    progress.finish();
    let report = report?;
    output::message(&format!("results in {}", results.display()));
    output::result(arguments.json, &report)?;
    Ok(if report.failures_cost_a_value() {
        ExitStatus::FailureGate
    } else {
        ExitStatus::Done
    })
}
