//! The command `blisk`.

use std::process::ExitCode;

fn main() -> ExitCode {
    blisk::cli::main(std::env::args_os()).into()
}
