//! From the command line to an exit code.

use std::ffi::OsString;
use std::io::{self, ErrorKind};

use clap::Parser;

use super::{
    Arguments, Command, ExitStatus, campbell, check, compare, estimate, explain, import, init,
    interrupt, man, merge, model, optimum, output, plan, replay, report, response, run, slurm,
    stats, status, tradeoff, verify,
};

/// Carries out the command line `arguments` (the first is the program's name).
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitStatus {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => return output::of_clap(&error).unwrap_or_else(|failure| failed(&failure)),
    };
    if let Err(error) = interrupt::watch(&arguments.command) {
        return failed(&Failure {
            status: ExitStatus::InternalError,
            message: format!("cannot watch for signals: {error}"),
        });
    }
    carry_out(arguments.command).unwrap_or_else(|failure| failed(&failure))
}

fn failed(failure: &Failure) -> ExitStatus {
    output::message(&format!("error: {}", failure.message));
    interrupt::ended(failure.status)
}

fn carry_out(command: Command) -> Result<ExitStatus, Failure> {
    match command {
        Command::Init(arguments) => init::command(&arguments),
        Command::Check { study, json } => check::command(&study, json),
        Command::Model {
            study,
            export,
            json,
        } => model::command(&study, export.as_deref(), json),
        Command::Campbell(arguments) => campbell::command(&arguments),
        Command::Import(arguments) => import::command(&arguments),
        Command::Plan(arguments) => plan::command(&arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Merge(arguments) => merge::command(&arguments),
        Command::Slurm(arguments) => slurm::command(&arguments),
        Command::Status(arguments) => status::command(&arguments),
        Command::Response {
            study,
            pattern,
            load,
            frequencies,
            out,
            load_case,
            engine_order,
            standard_deviation,
            fidelity,
            continuation,
            json,
        } => response::command(&response::ResponseArguments {
            study,
            pattern,
            load,
            frequencies,
            out,
            load_case,
            engine_order,
            standard_deviation,
            fidelity,
            continuation,
            json,
        }),
        Command::Replay(arguments) => replay::command(&arguments),
        Command::Verify {
            target,
            sample,
            seed,
            dense_sweep,
            time_domain,
            scenario,
            pattern,
            repair,
            integrity,
            study,
            threads,
            json,
        } => verify::command(&verify::VerifyArguments {
            target,
            sample,
            seed,
            question: match (repair, integrity) {
                (true, _) => verify::Question::Files,
                (_, true) => verify::Question::Integrity,
                _ => verify::Question::of(dense_sweep, time_domain, scenario.zip(pattern)),
            },
            study,
            threads,
            json,
        }),
        Command::Compare(arguments) => compare::command(&arguments),
        Command::Optimum(arguments) => optimum::command(&arguments),
        Command::Tradeoff(arguments) => tradeoff::command(&arguments),
        Command::Estimate(arguments) => estimate::command(&arguments),
        Command::Stats(arguments) => stats::command(&arguments),
        Command::Report(arguments) => report::command(&arguments),
        Command::Plot(arguments) => report::plot(&arguments),
        Command::Explain(arguments) => explain::explain(&arguments),
        Command::Schema(arguments) => explain::schema(&arguments),
        Command::Completions(arguments) => explain::completions(&arguments),
        Command::Man(arguments) => man::command(&arguments),
    }
}

/// A command that failed: what to say and how to exit.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) status: ExitStatus,
    pub(super) message: String,
}

impl Failure {
    pub(super) fn usage(message: String) -> Self {
        Self {
            status: ExitStatus::Usage,
            message,
        }
    }
}

impl<E> From<E> for Failure
where
    E: std::error::Error + 'static,
    for<'a> ExitStatus: From<&'a E>,
{
    fn from(error: E) -> Self {
        let status = ExitStatus::from(&error);
        let remedy = match status {
            ExitStatus::InputOutput => remedy(&error),
            _ => "",
        };
        Self {
            status,
            message: format!("{error}{remedy}"),
        }
    }
}

/// What can be done about an error of the file system, as the end of a sentence.
fn remedy(error: &(dyn std::error::Error + 'static)) -> &'static str {
    let mut cause = Some(error);
    let kind = loop {
        match cause {
            None => return "",
            Some(error) => {
                if let Some(error) = error.downcast_ref::<io::Error>() {
                    break error.kind();
                }
                cause = error.source();
            }
        }
    };
    match kind {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "; free some space, or choose another --out, and run again: what is stored stays stored"
        }
        ErrorKind::PermissionDenied => {
            "; grant this user access to it, or choose another --out, and run again"
        }
        ErrorKind::ReadOnlyFilesystem => {
            "; make the file system writable, or choose another --out, and run again"
        }
        ErrorKind::NotFound
        | ErrorKind::NotADirectory
        | ErrorKind::IsADirectory
        | ErrorKind::AlreadyExists => "; check the path",
        _ => "; check the disk and run again: what is stored stays stored",
    }
}
