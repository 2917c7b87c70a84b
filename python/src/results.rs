//! Results folders: summary, manifest, report, comparison, and which table is read.

use std::fmt::Display;
use std::path::PathBuf;

use blisk::campaign::{
    CompareRequest, ReportRequest, checked_table, fit_result_tails, status_of_folder, summarise,
    summarise_partly,
};
use blisk::cli::StatusAnswer;
use blisk::population::table::{Manifest, write_atomically};
use blisk::report::{StatisticsReport, html_report};
use blisk::settings::ReducedEngineSource;
use blisk::study::PipelineError;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use serde::Serialize;

use crate::errors::of_pipeline;
use crate::table::Table;
use crate::watch::{OnSignal, watch};

/// An answer as JSON and as text.
pub type Answer = (String, String);

/// Summary of the folder as JSON and as text, and rows stored and planned where the study is not finished.
#[pyfunction]
pub fn summary(py: Python<'_>, results: PathBuf) -> PyResult<(Answer, Option<(u64, u64)>)> {
    let summarised = || -> Result<_, PipelineError> {
        Ok(match summarise_partly(&results)? {
            Some(partial) => (partial.summary, Some((partial.stored, partial.planned))),
            None => (summarise(&results)?, None),
        })
    };
    let (summary, unfinished) = py
        .detach(summarised)
        .map_err(|error| of_pipeline(py, &error))?;
    Ok((answer_of(&summary)?, unfinished))
}

/// How far the folder is.
#[pyfunction]
pub fn status(py: Python<'_>, results: PathBuf) -> PyResult<Answer> {
    let found = py.detach(|| status_of_folder(&results));
    answer_of(&StatusAnswer(
        found.map_err(|error| of_pipeline(py, &error))?,
    ))
}

/// The summary of the finished folder with fits of its tails, which are written into it.
#[pyfunction]
pub fn tails(py: Python<'_>, results: PathBuf) -> PyResult<Answer> {
    let report = watch(py, None, OnSignal::Leave, move |_| {
        Ok(StatisticsReport {
            summary: summarise(&results)?,
            tails: Some(fit_result_tails(&results)?),
        })
    })?;
    answer_of(&report)
}

/// `manifest.json` of the folder as JSON.
#[pyfunction]
pub fn manifest(py: Python<'_>, results: PathBuf) -> PyResult<String> {
    let read = || {
        Manifest::read(&results)?.ok_or_else(|| PipelineError::NoResults {
            folder: results.clone(),
        })
    };
    let manifest = py.detach(read).map_err(|error| of_pipeline(py, &error))?;
    json_of(&manifest)
}

/// Writes the report of the folder to the HTML file `path`.
#[pyfunction]
pub fn report(
    py: Python<'_>,
    results: PathBuf,
    path: PathBuf,
    curves: bool,
    study_file: Option<PathBuf>,
) -> PyResult<()> {
    let request = ReportRequest {
        results,
        study_file,
        curves,
        model: true,
    };
    watch(py, None, OnSignal::Leave, move |_| {
        let found = blisk::campaign::report(&request, &ReducedEngineSource)?;
        Ok(write_atomically(&path, html_report(&found).as_bytes())?)
    })
}

/// Compares the scenarios of folders on the patterns that they share.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    folders: Vec<PathBuf>,
    percent: f64,
    baseline: Option<usize>,
) -> PyResult<Answer> {
    let request = CompareRequest {
        folders,
        baseline,
        percent,
    };
    let report = watch(py, None, OnSignal::Leave, move |_| {
        blisk::campaign::compare(&request)
    })?;
    answer_of(&report)
}

/// Reads the table `name` of the folder, after a look at its digest.
#[pyfunction]
pub fn table(py: Python<'_>, results: PathBuf, name: &str) -> PyResult<Table> {
    let file = format!("{name}.parquet");
    let read = || {
        let path = checked_table(&results, &file)?;
        Ok(Table::read(&path)?)
    };
    py.detach(read).map_err(|error| of_pipeline(py, &error))
}

/// `value` as JSON and as text.
pub fn answer_of(value: &(impl Serialize + Display)) -> PyResult<Answer> {
    Ok((json_of(value)?, value.to_string()))
}

fn json_of(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}
