//! Studies: text in, checks and resolved values out.

use std::path::PathBuf;
use std::sync::Arc;

use blisk::cli::CheckAnswer;
use blisk::study::{Study, StudyDigest, echo, keys, load_sector_model, pattern_source};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use crate::errors::{of_pipeline, of_study};
use crate::results::{Answer, answer_of};

/// A study that the reader of study files has accepted.
#[pyclass(frozen, module = "blisk._native")]
pub struct CheckedStudy(pub(crate) Arc<Study>);

#[pymethods]
impl CheckedStudy {
    /// Checks the text of the study file `path`, beside which the files lie that it names.
    #[new]
    fn new(py: Python<'_>, path: PathBuf, text: &str) -> PyResult<Self> {
        // It may read files, and a model with normal loads by rotation is assembled.
        py.detach(|| Study::parse(&path, text))
            .map(|study| Self(Arc::new(study)))
            .map_err(|error| of_study(py, &error))
    }

    /// Name of the study.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Number of patterns, at most where the study may stop before.
    #[getter]
    fn patterns(&self) -> u32 {
        self.0.patterns
    }

    /// Number of scenarios.
    #[getter]
    fn scenarios(&self) -> usize {
        self.0.scenarios().len()
    }

    /// Digest of the study and the files it names, hexadecimal.
    fn digest(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| StudyDigest::of(&self.0).map(|digest| digest.hex()))
            .map_err(|error| of_study(py, &error))
    }

    /// The study with every default filled in, as JSON.
    fn resolved(&self) -> String {
        self.0.resolved().to_string()
    }

    /// Looks at model and patterns as well; JSON with `text`, the study in words, and `remarks`.
    fn echo(&self, py: Python<'_>) -> PyResult<String> {
        let looked = || {
            let model = load_sector_model(&self.0)?;
            pattern_source(&self.0, &model)?;
            Ok(echo(&self.0, &model))
        };
        let found = py.detach(looked).map_err(|error| of_pipeline(py, &error))?;
        let remarks: Vec<String> = found.remarks.iter().map(ToString::to_string).collect();
        Ok(json!({ "text": found.to_string(), "remarks": remarks }).to_string())
    }

    /// What the command `check` finds, as JSON and as text.
    fn check(&self, py: Python<'_>) -> PyResult<Answer> {
        let found = py.detach(|| CheckAnswer::of(&self.0));
        answer_of(&found.map_err(|error| of_pipeline(py, &error))?)
    }
}

/// The keys of study files, in the order of their documentation.
#[pyfunction]
pub fn key_names() -> Vec<String> {
    keys().into_iter().map(|key| key.key).collect()
}

/// The tables of a TOML text as JSON.
#[pyfunction]
pub fn tables_of(text: &str) -> PyResult<String> {
    let refused = |error: String| PyValueError::new_err(error);
    let tables: toml::Table = toml::from_str(text).map_err(|error| refused(error.to_string()))?;
    serde_json::to_string(&tables).map_err(|error| refused(error.to_string()))
}
