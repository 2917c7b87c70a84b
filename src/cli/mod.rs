//! Command line: definitions, one file per command, progress. The only code that prints.

mod arguments;
mod check;
mod exit;
mod init;
mod model;
mod output;
mod progress;
mod response;
mod run;
mod stats;

pub use arguments::{Arguments, Command};
pub use exit::ExitStatus;
pub use run_command::main;

mod run_command;
