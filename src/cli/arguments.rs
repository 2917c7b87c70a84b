//! The commands: what clap sees of each, and what carries it out.

use std::path::Path;

use clap::{CommandFactory, Parser, Subcommand};

use super::campbell::CampbellArguments;
use super::check::CheckArguments;
use super::compare::CompareArguments;
use super::estimate::EstimateArguments;
use super::exit::{ExitStatus, Failure};
use super::explain::{CompletionsArguments, ExplainArguments, SchemaArguments};
use super::import::ImportArguments;
use super::init::InitArguments;
use super::interrupt::Kept;
use super::man::ManArguments;
use super::merge::MergeArguments;
use super::model::ModelArguments;
use super::optimum::OptimumArguments;
use super::plan::PlanArguments;
use super::replay::ReplayArguments;
use super::report::{PlotArguments, ReportArguments};
use super::response::ResponseArguments;
use super::run::RunArguments;
use super::slurm::SlurmArguments;
use super::stats::StatsArguments;
use super::status::StatusArguments;
use super::tradeoff::TradeoffArguments;
use super::verify::VerifyArguments;
use super::{
    campbell, check, compare, estimate, explain, import, init, man, merge, model, optimum, plan,
    replay, report, response, run, slurm, stats, status, tradeoff, verify,
};
use crate::identity;

/// Forced response of randomly mistuned bladed disks with friction dampers.
#[derive(Debug, Parser)]
#[command(name = "blisk", version = identity::VERSION, long_version = identity::IN_WORDS)]
#[command(about, disable_help_subcommand = true, max_term_width = 100)]
#[command(help_template = help_template())]
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
    Check(CheckArguments),
    /// Build the reduced model and show sizes, frequencies, rank and condition.
    Model(ModelArguments),
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
    Response(ResponseArguments),
    /// Solve one delivered row again; the older name of that question of `verify`.
    #[command(hide = true)]
    Replay(ReplayArguments),
    /// Solve delivered rows again, a random sample or one, on the same path and on the full-contact model.
    ///
    /// A sample writes verification.parquet into the results folder, one row writes nothing.
    Verify(VerifyArguments),
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

/// What a command leaves that writes a bundle.
const BUNDLE: &str = "the sector bundle is not complete; the same command writes it";

impl Command {
    /// Carries it out, for the executable `program`.
    pub(super) fn carried_out(self, program: &Path) -> Result<ExitStatus, Failure> {
        match self {
            Self::Init(arguments) => init::command(&arguments),
            Self::Check(arguments) => check::command(&arguments),
            Self::Model(arguments) => model::command(&arguments),
            Self::Campbell(arguments) => campbell::command(&arguments),
            Self::Import(arguments) => import::command(&arguments),
            Self::Plan(arguments) => plan::command(&arguments),
            Self::Run(arguments) => run::command(arguments),
            Self::Merge(arguments) => merge::command(&arguments),
            Self::Slurm(arguments) => slurm::command(&arguments, program),
            Self::Status(arguments) => status::command(&arguments),
            Self::Response(arguments) => response::command(&arguments),
            Self::Replay(arguments) => replay::command(&arguments),
            Self::Verify(arguments) => verify::command(&arguments),
            Self::Compare(arguments) => compare::command(&arguments),
            Self::Optimum(arguments) => optimum::command(&arguments),
            Self::Tradeoff(arguments) => tradeoff::command(&arguments),
            Self::Estimate(arguments) => estimate::command(&arguments),
            Self::Stats(arguments) => stats::command(&arguments),
            Self::Report(arguments) => report::command(&arguments),
            Self::Plot(arguments) => report::plot(&arguments),
            Self::Explain(arguments) => explain::explain(&arguments),
            Self::Schema(arguments) => explain::schema(&arguments),
            Self::Completions(arguments) => explain::completions(&arguments, Arguments::command()),
            Self::Man(arguments) => man::command(&arguments, Arguments::command()),
        }
    }

    /// What it leaves when a signal ends it.
    pub(super) fn kept(&self) -> Kept {
        match self {
            Self::Run(_) | Self::Estimate(_) | Self::Optimum(_) => {
                Kept::Rows("what was solved is stored; the same command continues")
            }
            Self::Verify(arguments) if arguments.repair => {
                Kept::Rows("what was solved is stored; `blisk run` continues")
            }
            Self::Merge(_) => {
                Kept::Else("the shards are as they were; the same command merges them")
            }
            Self::Import(_) => Kept::Else(BUNDLE),
            Self::Model(arguments) if arguments.export.is_some() => Kept::Else(BUNDLE),
            Self::Tradeoff(_) => Kept::Else(
                "no table was written, and what was measured so far is not kept; the same command begins again",
            ),
            Self::Init(_)
            | Self::Check(_)
            | Self::Model(_)
            | Self::Campbell(_)
            | Self::Plan(_)
            | Self::Slurm(_)
            | Self::Status(_)
            | Self::Response(_)
            | Self::Replay(_)
            | Self::Verify(_)
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

/// The commands in the order and under the headings of the help and of docs/commands.md.
pub const GROUPS: [(&str, &[&str]); 7] = [
    ("Begin", &["init", "check", "plan", "explain"]),
    ("Model", &["model", "campbell", "import"]),
    ("Solve", &["run", "optimum", "estimate", "response"]),
    ("Read and decide", &["stats", "report", "plot", "compare"]),
    ("Trust", &["tradeoff", "verify"]),
    ("Several machines", &["status", "merge", "slurm"]),
    ("Set-up", &["schema", "completions", "man"]),
];

/// Width of the text of a command in the help, and of its name.
const TEXT_WIDTH: usize = 84;
const NAME_WIDTH: usize = 13;

/// The help of the program, with the commands under their headings.
fn help_template() -> String {
    let commands = Command::augment_subcommands(clap::Command::new("blisk"));
    let about = |name: &str| {
        let command = commands.find_subcommand(name);
        let about = command.and_then(clap::Command::get_about);
        about.map(ToString::to_string).unwrap_or_default()
    };
    let command = |name: &&str| {
        let lines = wrapped(&about(name), TEXT_WIDTH).into_iter().enumerate();
        let named = lines.map(|(at, line)| {
            let name = if at == 0 { name } else { "" };
            format!("  {name:NAME_WIDTH$}{line}\n")
        });
        named.collect::<String>()
    };
    let group = |(heading, names): (&str, &[&str])| {
        let commands: String = names.iter().map(command).collect();
        format!("{heading}:\n{commands}\n")
    };
    let groups: String = GROUPS.into_iter().map(group).collect();
    format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{groups}Options:\n{{options}}{{after-help}}"
    )
}

/// The words of a text in lines of at most so many characters.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().filter(|line| {
            line.is_empty() || line.chars().count() + 1 + word.chars().count() <= width
        });
        match line {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}
