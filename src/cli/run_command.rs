//! From the command line to an exit code.

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use clap::Parser;

use super::exit::Failure;
use super::{Arguments, ExitStatus, interrupt, output};

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
    let work = || arguments.command.carried_out(program);
    let ended = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(Failure::of_panic()));
    ended.unwrap_or_else(|failure| failed(&failure))
}

fn failed(failure: &Failure) -> ExitStatus {
    output::message(&format!("error: {}", failure.message));
    interrupt::ended(failure.status)
}
