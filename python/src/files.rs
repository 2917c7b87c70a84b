//! Files to begin with: example studies and scripts for Slurm, and what a study file accepts.

use std::path::PathBuf;

use blisk::cli::{
    Explanations, Failure, SlurmArguments, time_limit, write_example, write_slurm_script,
};
use blisk::model::sector::import::import_schema;
use blisk::study::{EXAMPLES, example_beside_its_data, study_schema};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::of_failure;
use crate::results::{Answer, answer_of};

/// The studies that come with the program: name and text of the file.
#[pyfunction]
pub fn examples() -> Vec<(String, String)> {
    { EXAMPLES.iter() }
        .map(|(name, text)| ((*name).to_owned(), example_beside_its_data(text).0))
        .collect()
}

/// Writes an example study to the file `out`, and what it reads beside that.
#[pyfunction]
pub fn init(py: Python<'_>, example: &str, out: PathBuf) -> PyResult<()> {
    py.detach(|| write_example(example, &out))
        .map(|_| ())
        .map_err(|failure| of_failure(py, &failure))
}

/// The script that submits the study file `study` to Slurm, and its path; it is written.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // As many as the command has.
pub fn slurm(
    py: Python<'_>,
    study: PathBuf,
    tasks: u32,
    out: Option<PathBuf>,
    threads: u16,
    time: Option<String>,
    script: Option<PathBuf>,
    program: PathBuf,
) -> PyResult<PathBuf> {
    let time = time
        .map(|time| time_limit(&time).map_err(|accepted| format!("time = {time}: {accepted}")))
        .transpose()
        .map_err(PyValueError::new_err)?;
    let arguments = SlurmArguments {
        study,
        tasks,
        out,
        threads,
        time,
        script,
    };
    py.detach(|| write_slurm_script(&arguments, &program))
        .map(|written| written.path)
        .map_err(|failure| of_failure(py, &failure))
}

/// Keys that `name` is, or that have its words, as a JSON list, and the words of the command.
#[pyfunction]
pub fn explain(name: &str) -> PyResult<Answer> {
    let found = Explanations::about(name);
    answer_of(&found.map_err(|Failure { message, .. }| PyValueError::new_err(message))?)
}

/// The JSON schema of study files, or of import files, as JSON.
#[pyfunction]
pub fn schema(of_import: bool) -> String {
    if of_import {
        import_schema().to_string()
    } else {
        study_schema().to_string()
    }
}
