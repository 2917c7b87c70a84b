//! From the command line to an exit code.

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use clap::{CommandFactory, Parser};

use super::exit::Failure;
use super::{
    Arguments, Command, ExitStatus, campbell, check, compare, estimate, explain, import, init,
    interrupt, man, merge, model, optimum, output, plan, replay, report, response, run, slurm,
    stats, status, tradeoff, verify,
};

/// Carries out the command line `arguments` (the first is the program's name) of this executable.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitStatus {
    let program = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("blisk"));
    main_of(&program, arguments)
}

/// Carries out the command line `arguments` of the command `program`, which need not be this executable.
pub fn main_of(program: &Path, arguments: impl IntoIterator<Item = OsString>) -> ExitStatus {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => return output::of_clap(&error).unwrap_or_else(|failure| failed(&failure)),
    };
    if let Err(error) = interrupt::watch(arguments.command.kept()) {
        return failed(&Failure {
            status: ExitStatus::InternalError,
            message: format!("cannot watch for signals: {error}"),
        });
    }
    let work = || carry_out(program, arguments.command);
    let ended = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(Failure::of_panic()));
    ended.unwrap_or_else(|failure| failed(&failure))
}

fn failed(failure: &Failure) -> ExitStatus {
    output::message(&format!("error: {}", failure.message));
    interrupt::ended(failure.status)
}

fn carry_out(program: &Path, command: Command) -> Result<ExitStatus, Failure> {
    match command {
        Command::Init(arguments) => init::command(&arguments),
        Command::Check(arguments) => check::command(&arguments),
        Command::Model(arguments) => model::command(&arguments),
        Command::Campbell(arguments) => campbell::command(&arguments),
        Command::Import(arguments) => import::command(&arguments),
        Command::Plan(arguments) => plan::command(&arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Merge(arguments) => merge::command(&arguments),
        Command::Slurm(arguments) => slurm::command(&arguments, program),
        Command::Status(arguments) => status::command(&arguments),
        Command::Response(arguments) => response::command(&arguments),
        Command::Replay(arguments) => replay::command(&arguments),
        Command::Verify(arguments) => verify::command(&arguments),
        Command::Compare(arguments) => compare::command(&arguments),
        Command::Optimum(arguments) => optimum::command(&arguments),
        Command::Tradeoff(arguments) => tradeoff::command(&arguments),
        Command::Estimate(arguments) => estimate::command(&arguments),
        Command::Stats(arguments) => stats::command(&arguments),
        Command::Report(arguments) => report::command(&arguments),
        Command::Plot(arguments) => report::plot(&arguments),
        Command::Explain(arguments) => explain::explain(&arguments),
        Command::Schema(arguments) => explain::schema(&arguments),
        Command::Completions(arguments) => explain::completions(&arguments, Arguments::command()),
        Command::Man(arguments) => man::command(&arguments, Arguments::command()),
    }
}
