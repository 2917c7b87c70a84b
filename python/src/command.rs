//! The command `blisk` within the process of Python.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Carries out a command line, whose first word is the program's name; gives its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> i32 {
    py.detach(|| blisk::cli::main(arguments) as i32)
}
