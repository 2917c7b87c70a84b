//! `blisk optimum`: the normal load with the lowest percentile.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::compare::percent;
use super::exit::Failure;
use super::progress::RunProgress;
use super::scheduler::threads;
use super::{ExitStatus, output};
use crate::campaign::{OptimumRequest, find_optimum};
use crate::population::statistics::Quantity;
use crate::population::table::MANIFEST;
use crate::settings::ReducedEngineSource;
use crate::study::Study;

/// Arguments of `blisk optimum`.
#[derive(Debug, Args)]
pub struct OptimumArguments {
    /// The study file; one standard deviation. Of several load cases and engine orders, each wheel counts by
    /// its largest value over them.
    study: PathBuf,
    /// Lowest and highest normal load per sector in N.
    #[arg(long, value_name = "LOW:HIGH", value_parser = between)]
    between: [f64; 2],
    /// The percentile.
    #[arg(long, value_name = "P", default_value = "95", value_parser = percent)]
    percentile: f64,
    /// The quantity.
    #[arg(long, value_enum, default_value = "peak_amplitude_m")]
    quantity: QuantityArgument,
    /// How close the loads beside the lowest one are at the end, relative.
    #[arg(long, value_name = "R", default_value = "0.05", value_parser = resolution)]
    resolution: f64,
    /// Folder of the search, with a results folder for each load [default: results/NAME-optimum].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Results folder whose loads on the same patterns are not solved again [default: results/NAME].
    #[arg(long, value_name = "DIR")]
    solved: Option<PathBuf>,
    /// Number of threads [default: all cores]; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// The quantities by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
#[value(rename_all = "snake_case")]
enum QuantityArgument {
    /// Peak amplitude.
    PeakAmplitudeM,
    /// Amplification factor.
    AmplificationFactor,
}

pub(super) fn command(arguments: &OptimumArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    let named = || Path::new("results").join(format!("{}-optimum", study.name));
    let results = arguments.out.clone().unwrap_or_else(named);
    if results.join(MANIFEST).exists() {
        return Err(Failure::usage(format!(
            "--out {}: it holds the results of a study; accepted: a folder of its own for the search, like {}; the \
             loads of these results are taken by --solved {}",
            results.display(),
            named().display(),
            results.display()
        )));
    }
    let of_study = || Path::new("results").join(&study.name);
    let solved = arguments.solved.clone().unwrap_or_else(of_study);
    let progress = RunProgress::new();
    let report = find_optimum(
        OptimumRequest {
            study: &study,
            results: &results,
            solved: &solved,
            between_n: arguments.between,
            percent: arguments.percentile,
            quantity: match arguments.quantity {
                QuantityArgument::PeakAmplitudeM => Quantity::PeakAmplitudeM,
                QuantityArgument::AmplificationFactor => Quantity::AmplificationFactor,
            },
            resolution: arguments.resolution,
            threads: threads(arguments.threads),
        },
        &ReducedEngineSource,
        &progress,
    );
    progress.finish();
    let report = report?;
    output::message(&format!("results in {}", results.display()));
    output::result(arguments.json, &report)?;
    Ok(if report.failures_cost_a_load() {
        ExitStatus::FailureGate
    } else {
        ExitStatus::Done
    })
}

/// `LOW:HIGH`, positive and ascending.
fn between(text: &str) -> Result<[f64; 2], String> {
    let numbers = text.split_once(':').and_then(|(low, high)| {
        let (low, high): (f64, f64) = (low.parse().ok()?, high.parse().ok()?);
        (low > 0.0 && low < high && high.is_finite()).then_some([low, high])
    });
    numbers.ok_or_else(|| "accepted: two positive loads, the lower first, like 50:800".to_owned())
}

/// A relative distance of loads.
fn resolution(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|resolution| (1e-3..=1.0).contains(resolution))
        .ok_or_else(|| "accepted: a number from 0.001 to 1".to_owned())
}
