//! Command line: definitions, one file per command, progress. The only code that prints.

mod arguments;
mod check;
mod compare;
mod exit;
mod fidelity;
mod init;
mod model;
mod optimum;
mod output;
mod progress;
mod replay;
mod response;
mod run;
mod stats;
mod verify;

pub use arguments::{Arguments, Command};
pub use exit::ExitStatus;
pub use run_command::main;

mod run_command;
