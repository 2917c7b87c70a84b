//! Sectors: bundles, and their import from the files of other codes.

use std::path::PathBuf;

use blisk::cli::import_bundle;
use blisk::model::cyclic::contact_free_frequencies_hz;
use blisk::model::sector::bundle;
use blisk::model::sector::import::foreign;
use blisk::study::PipelineError;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use crate::results::{Answer, answer_of};
use crate::watch::{OnSignal, watch};

/// Makes the bundle `out` from an import file, with so many frequencies per nodal diameter unless it is 0.
#[pyfunction]
pub fn import_sector(
    py: Python<'_>,
    file: PathBuf,
    out: PathBuf,
    frequencies: u16,
) -> PyResult<Answer> {
    if let Some(advice) = foreign(&file) {
        return Err(PyValueError::new_err(advice));
    }
    let count = (frequencies > 0).then_some(frequencies);
    let answer = watch(py, None, OnSignal::Leave, move |_| {
        import_bundle(&file, &out, count)
    })?;
    answer_of(&answer)
}

/// Reads a bundle and says as JSON what it holds.
#[pyfunction]
pub fn bundle_facts(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    watch(py, None, OnSignal::Leave, move |_| {
        let model = bundle::read(&folder)?;
        Ok(json!({
            "name": model.name,
            "sectors": model.sectors,
            "dofs": model.dofs.len(),
            "contact_pairs": model.contact_pairs.len(),
            "observed": model.observed.iter().map(|own| &own.name).collect::<Vec<_>>(),
        })
        .to_string())
    })
}

/// Contact-free natural frequencies of a bundle, Hz, lists by nodal diameter.
#[pyfunction]
pub fn bundle_frequencies(py: Python<'_>, folder: PathBuf, count: u16) -> PyResult<Vec<Vec<f64>>> {
    watch(py, None, OnSignal::Leave, move |_| {
        let model = bundle::read(&folder)?;
        contact_free_frequencies_hz(&model, usize::from(count)).map_err(PipelineError::from)
    })
}
