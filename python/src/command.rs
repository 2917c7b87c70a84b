//! The command `blisk` within the process of Python.

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::prelude::*;

/// Carries out a command line, whose first word is the program's name; gives its exit code. `program` is the
/// command itself, since the executable of this process is that of Python.
#[pyfunction]
pub fn main(py: Python<'_>, program: PathBuf, arguments: Vec<OsString>) -> i32 {
    py.detach(|| blisk::cli::main_of(&program, arguments) as i32)
}
