//! Command line: definitions, one file per command, progress. The only code that prints.

mod arguments;
mod campbell;
mod check;
mod compare;
mod estimate;
mod exit;
mod explain;
mod fidelity;
mod import;
mod init;
mod interrupt;
mod man;
mod merge;
mod model;
mod optimum;
mod output;
mod plan;
mod progress;
mod replay;
mod report;
mod response;
mod run;
mod scheduler;
mod slurm;
mod stats;
mod status;
mod tradeoff;
mod verify;

pub use arguments::{Arguments, Command, GROUPS};
pub use check::CheckAnswer;
pub use exit::{ExitStatus, Failure};
pub use explain::Explanations;
pub use import::{ImportAnswer, import_bundle};
pub use init::{WrittenStudy, write_example};
pub use replay::ReplayAnswer;
pub use run_command::{main, main_of};
pub use scheduler::threads;
pub use slurm::{SlurmArguments, WrittenScript, time_limit, write_slurm_script};
pub use status::StatusAnswer;
pub use verify::{IntegrityAnswer, RepairAnswer};

mod run_command;
