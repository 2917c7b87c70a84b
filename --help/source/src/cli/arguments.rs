//! The command line as clap sees it.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use super::campbell::CampbellArguments;
use super::compare::CompareArguments;
use super::estimate::EstimateArguments;
use super::explain::{CompletionsArguments, ExplainArguments, SchemaArguments};
use super::fidelity::FidelityArguments;
use super::import::ImportArguments;
use super::init::InitArguments;
use super::interrupt::Kept;
use super::man::ManArguments;
use super::merge::MergeArguments;
use super::optimum::OptimumArguments;
use super::plan::PlanArguments;
use super::replay::ReplayArguments;
use super::report::{PlotArguments, ReportArguments};
use super::response::{FrequencyGrid, LoadArgument, PatternArgument};
use super::run::RunArguments;
use super::slurm::SlurmArguments;
use super::stats::StatsArguments;
use super::status::StatusArguments;
use super::tradeoff::TradeoffArguments;
use crate::identity;

/// Forced response of randomly mistuned bladed disks with friction dampers.
#[derive(Debug, Parser)]
#[command(name = "blisk", version = identity::VERSION, long_version = identity::IN_WORDS)]
#[command(about, disable_help_subcommand = true, max_term_width = 100)]
#[command(
    after_help = "Exit codes: 0 done, 1 internal error, 2 usage, 3 study invalid, 4 model invalid,\n5 failures leave a statistic without a value,\n6 all patterns are solved and the target of [stop] is not reached, 7 input/output, 8 store damaged,\n9 different study, 10 locked by another process,\n11 a verification failed, 130/143 interrupted, what is solved is stored."
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented study file to start from.
    Init(InitArguments),
    /// Check a study, its model and its patterns without solving anything.
    Check {
        /// The study file.
        study: PathBuf,
        /// Print the resolved study as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Build the reduced model and show sizes, frequencies, rank and condition.
    Model {
        /// The study file.
        study: PathBuf,
        /// Write the sector model as a bundle into this folder.
        #[arg(long, value_name = "DIR")]
        export: Option<PathBuf>,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Natural frequencies per nodal diameter, and the speeds at which engine orders cross them.
    #[command(
        after_help = "Examples:\n  blisk campbell study.toml --engine-orders 1:12 --speed-rpm 0:12000\n  blisk campbell study.toml --at 0=bundle_rest --at 6000=bundle_speed"
    )]
    Campbell(CampbellArguments),
    /// Make a sector bundle from the files of a finite-element code.
    ///
    /// The import file names meshes, matrices and sets; docs/import.md has the commands that write
    /// them with `CalculiX`, Ansys and Nastran.
    Import(ImportArguments),
    /// Solve a few patterns, and say what the study will take and what its percentiles will be worth.
    ///
    /// Nothing is written. Times are those of this machine at the time.
    Plan(PlanArguments),
    /// Solve a study, or continue it; a finished study is shown, not solved again.
    Run(RunArguments),
    /// Join the shards of a study to its results.
    Merge(MergeArguments),
    /// Write a script that submits a study to Slurm as an array of shards and a merge after it.
    Slurm(SlurmArguments),
    /// Show how far a results folder is, without touching it.
    Status(StatusArguments),
    /// Amplitude of every blade over frequency, for one pattern and one contact condition.
    Response {
        /// The study file.
        study: PathBuf,
        /// `tuned`, or the id of a pattern of the study.
        #[arg(long, value_name = "tuned|ID")]
        pattern: PatternArgument,
        /// Normal load per sector in N, or a linear limit.
        #[arg(long, value_name = "N|stuck|slide|free")]
        load: LoadArgument,
        /// First and last frequency in Hz, both included, and the number of frequencies.
        #[arg(long, value_name = "START:STOP:COUNT")]
        frequencies: FrequencyGrid,
        /// The file to write: .csv or .parquet.
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
        /// Load case, where the study has several.
        #[arg(long, value_name = "NAME")]
        load_case: Option<String>,
        /// Engine order, where the study lists several.
        #[arg(long, value_name = "EO")]
        engine_order: Option<u32>,
        /// Standard deviation, where the study lists several.
        #[arg(long, value_name = "S")]
        standard_deviation: Option<f64>,
        /// Which model is solved, and how finely.
        #[command(flatten)]
        fidelity: FidelityArguments,
        /// Follow the curve through its folds, upwards and downwards.
        #[arg(long)]
        continuation: bool,
        /// Print what was written as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Solve one delivered row again and say whether it is the same bit for bit.
    Replay(ReplayArguments),
    /// Solve a random sample of delivered rows again, on the same path and on the full-contact model.
    ///
    /// Writes verification.parquet into the results folder.
    Verify {
        /// The study file of results/NAME, or a results folder.
        #[arg(value_name = "STUDY|DIR")]
        target: PathBuf,
        /// Number of rows to draw.
        #[arg(long, value_name = "N", default_value = "10", value_parser = clap::value_parser!(u32).range(1..))]
        sample: u32,
        /// Seed of the sample [default: that of the study].
        #[arg(long, value_name = "S")]
        seed: Option<u64>,
        /// Sweep the drawn rows densely instead, and count the peaks that the search missed.
        ///
        /// Writes `peak_audit.parquet` into the results folder.
        #[arg(long)]
        dense_sweep: bool,
        /// Integrate one row in time instead, and compare it with harmonic balance.
        ///
        /// The row of --scenario and --pattern at its peak frequency, or the first one of the
        /// sample under friction. Writes no table.
        #[arg(long, conflicts_with = "dense_sweep")]
        time_domain: bool,
        /// Scenario of that row, counted from 0.
        #[arg(long, value_name = "I", requires_all = ["time_domain", "pattern"])]
        scenario: Option<usize>,
        /// Pattern of that row.
        #[arg(long, value_name = "ID", requires_all = ["time_domain", "scenario"])]
        pattern: Option<u32>,
        /// Set damaged files aside, into `damaged/`, and solve again what they held; draws no rows.
        #[arg(long, conflicts_with_all = ["dense_sweep", "time_domain"])]
        repair: bool,
        /// Read all files and compare them with their checksums; draws no rows and changes nothing.
        #[arg(long, conflicts_with_all = ["dense_sweep", "time_domain", "repair"])]
        integrity: bool,
        /// Where the inputs lie now: beside this study file [default: that of the last run].
        #[arg(long, value_name = "FILE")]
        study: Option<PathBuf>,
        /// Number of threads [default: those of the scheduler's allocation, else all cores]; results
        /// do not depend on it.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Compare a percentile between scenarios, on common patterns where there are any.
    ///
    /// Within one results folder each scenario is compared with the best of its load case, engine order
    /// and standard deviation, the one with the lowest percentile of the peak amplitude; between folders, with the scenario of the first folder that has the same
    /// load case, engine order, standard deviation and load.
    Compare(CompareArguments),
    /// Search for the normal load with the lowest percentile, on the same patterns at every load.
    Optimum(OptimumArguments),
    /// Measure what accuracy costs: a sample of the study's rows over a ladder of settings.
    ///
    /// Errors are against the best settings of the ladder. Writes `tradeoff.parquet`,
    /// `tradeoff_rows.parquet` and `tradeoff_times.parquet`.
    Tradeoff(TradeoffArguments),
    /// Mean and percentiles from few solves: a cheap surrogate of every pattern says which to solve.
    Estimate(EstimateArguments),
    /// Show the statistics of a results folder again, from its tables.
    Stats(StatsArguments),
    /// Write a finished study as one HTML page: which load to choose, how sure that is, figures, tables.
    ///
    /// The page needs no network and shows in any browser. A few wheels are solved again for their
    /// response curves.
    #[command(
        after_help = "Examples:\n  blisk report results/quickstart\n  blisk report results/quickstart --out quickstart.html --no-curves\n  blisk report results/quickstart --json > numbers.json"
    )]
    Report(ReportArguments),
    /// Write one figure of the report as SVG.
    #[command(
        after_help = "Example:\n  blisk plot results/quickstart amplitude --out amplitude.svg"
    )]
    Plot(PlotArguments),
    /// Say what a key of a study file, or of an import file, accepts, what it means and its default; or find keys by
    /// words.
    #[command(
        after_help = "Examples:\n  blisk explain solver.peak_tolerance\n  blisk explain contact\n  blisk explain friction\n  blisk explain import.contact"
    )]
    Explain(ExplainArguments),
    /// Print the JSON Schema of study files, or of import files, for editors.
    Schema(SchemaArguments),
    /// Print a script that completes commands and options in a shell.
    #[command(
        after_help = "Example:\n  blisk completions bash > ~/.local/share/bash-completion/completions/blisk"
    )]
    Completions(CompletionsArguments),
    /// Write the manual pages: one of the program, and one of every command.
    #[command(after_help = "Example:\n  blisk man --out ~/.local/share/man/man1")]
    Man(ManArguments),
}

impl Command {
    /// What it leaves when a signal ends it.
    pub(super) fn kept(&self) -> Kept {
        match self {
            Self::Run(_) | Self::Estimate(_) | Self::Optimum(_) => {
                Kept::Rows("what was solved is stored; the same command continues")
            }
            Self::Verify { repair: true, .. } => {
                Kept::Rows("what was solved is stored; `blisk run` continues")
            }
            Self::Merge(_) => {
                Kept::Else("the shards are as they were; the same command merges them")
            }
            Self::Import(_)
            | Self::Model {
                export: Some(_), ..
            } => Kept::Else("the sector bundle is not complete; the same command writes it"),
            Self::Tradeoff(_) => Kept::Else(
                "no table was written, and what was measured so far is not kept; the same command begins again",
            ),
            Self::Init(_)
            | Self::Check { .. }
            | Self::Model { .. }
            | Self::Campbell(_)
            | Self::Plan(_)
            | Self::Slurm(_)
            | Self::Status(_)
            | Self::Response { .. }
            | Self::Replay(_)
            | Self::Verify { .. }
            | Self::Compare(_)
            | Self::Stats(_)
            | Self::Report(_)
            | Self::Plot(_)
            | Self::Explain(_)
            | Self::Schema(_)
            | Self::Completions(_)
            | Self::Man(_) => {
                Kept::Else("nothing of this command is kept; the same command begins again")
            }
        }
    }
}
