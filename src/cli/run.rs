//! `blisk run`: solves a study or continues it, or one shard of it.

use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Failure;
use super::progress::RunProgress;
use super::scheduler::{ShardArgument, threads};
use super::{ExitStatus, output};
use crate::campaign::{RunRequest, run, run_shard, set_other_builds_aside};
use crate::population::table::Shard;
use crate::settings::ReducedEngineSource;
use crate::study::{AccuracyOptions, Study};

/// Arguments of the command.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The study file.
    pub study: PathBuf,
    /// The results folder [default: results/NAME].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of threads [default: those of the scheduler's allocation, else all cores]; results
    /// do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Only share k of n of the patterns, into a folder of its own below the results folder;
    /// without a value the share is that of a task of a Slurm, PBS, LSF, Grid Engine or
    /// Kubernetes array.
    #[arg(long, value_name = "k/n|auto", num_args = 0..=1, default_missing_value = "auto")]
    pub shard: Option<ShardArgument>,
    /// Accepted relative error of the peak amplitude, like 1% or 0.01: the program chooses what the
    /// study does not say of harmonics and tolerances, as with `[accuracy]` in the study.
    #[arg(long, value_name = "E", value_parser = accuracy)]
    pub accuracy: Option<AccuracyOptions>,
    /// Where another build of the program solved the rows of the folder: move them to `superseded/`
    /// and solve everything anew, rather than end with exit code 9.
    #[arg(long)]
    pub solve_anew: bool,
    /// Print the summary as JSON.
    #[arg(long)]
    pub json: bool,
}

pub(super) fn command(arguments: RunArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read_with(&arguments.study, arguments.accuracy)?;
    let shard = arguments.shard.map(ShardArgument::shard).transpose()?;
    let out = arguments.out;
    let results = out.unwrap_or_else(|| Path::new("results").join(&study.name));
    if arguments.solve_anew
        && let Some(place) = set_other_builds_aside(&results, &study, shard)?
    {
        output::message(&format!(
            "the results of another build are now in {}; everything is solved anew",
            place.display()
        ));
    }
    let progress = RunProgress::new();
    let request = RunRequest {
        study: &study,
        results: &results,
        threads: threads(arguments.threads),
    };
    let ran = match shard {
        None => run(request, &ReducedEngineSource, &progress),
        Some(shard) => run_shard(request, shard, &ReducedEngineSource, &progress),
    };
    progress.finish();
    let outcome = ran?;
    let rows = (outcome.rows_solved, outcome.rows_reused);
    output::message(&said(rows, shard, &results));
    if shard.is_some() {
        // Statistics are those of the whole, once it is merged.
        return Ok(ExitStatus::Done);
    }
    output::result(arguments.json, &outcome.summary)?;
    Ok(super::stats::status_of(&outcome.summary))
}

/// What is said of a run that solved and reused as many rows, into the folder `results` or into that of
/// a shard in it.
fn said((solved, reused): (u64, u64), shard: Option<Shard>, results: &Path) -> String {
    let folder = results.display();
    match shard {
        None if solved == 0 => format!("{folder} is complete, nothing to solve"),
        None => format!("solved {solved} rows, reused {reused}; results in {folder}"),
        Some(shard) if solved == 0 => {
            format!("shard {shard} of {folder} is complete, nothing to solve")
        }
        Some(Shard { number, count }) => format!(
            "solved {solved} rows, reused {reused}; shard in {folder}/shards/{number}-of-{count}; when all are \
             solved: blisk merge {folder} --out {folder}"
        ),
    }
}

/// `1%` or `0.01`.
fn accuracy(text: &str) -> Result<AccuracyOptions, String> {
    let number: Option<f64> = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse().ok().map(|share: f64| share / 100.0),
        None => text.trim().parse().ok(),
    };
    number
        .filter(|&error| AccuracyOptions::accepts(error))
        .map(AccuracyOptions::within)
        .ok_or_else(|| "accepted: a relative error from 0.1% to 20%, like 1% or 0.01".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{Path, Shard, said};

    const SECOND: Option<Shard> = Some(Shard {
        number: 2,
        count: 8,
    });

    fn of(rows: (u64, u64), shard: Option<Shard>) -> String {
        said(rows, shard, Path::new("results/fan"))
    }

    #[test]
    fn a_run_without_rows_to_solve_says_that_the_folder_is_complete() {
        assert_eq!(
            of((0, 40), None),
            "results/fan is complete, nothing to solve"
        );
    }

    #[test]
    fn a_run_that_solved_rows_says_how_many_and_where_they_are() {
        let expected = "solved 30 rows, reused 10; results in results/fan";
        assert_eq!(of((30, 10), None), expected);
    }

    #[test]
    fn a_shard_that_solved_rows_says_how_all_are_merged() {
        let expected = "solved 5 rows, reused 0; shard in results/fan/shards/2-of-8; when all are solved: \
                        blisk merge results/fan --out results/fan";
        assert_eq!(of((5, 0), SECOND), expected);
    }

    #[test]
    fn a_shard_without_rows_to_solve_says_which_one_is_complete() {
        let expected = "shard 2/8 of results/fan is complete, nothing to solve";
        assert_eq!(of((0, 5), SECOND), expected);
    }
}
