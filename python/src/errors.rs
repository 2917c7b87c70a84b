//! Errors of the program as exceptions of the package, with their findings and exit codes.

use std::path::Path;

use blisk::cli::{ExitStatus, Failure};
use blisk::model::sector::ModelError;
use blisk::study::{Finding, PipelineError, Problem, StudyError};
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The exception that `error` is.
pub fn of_pipeline(py: Python<'_>, error: &PipelineError) -> PyErr {
    if let PipelineError::Study(error) = error {
        return of_study(py, error);
    }
    let status = ExitStatus::from(error);
    let findings = match (error, status) {
        (PipelineError::Model(ModelError::ImportFile { path, findings }), _) => {
            let found = findings.iter().map(|finding| described(path, finding));
            Some(found.collect())
        }
        (_, ExitStatus::StudyInvalid | ExitStatus::ModelInvalid) => Some(only(&error.to_string())),
        _ => None,
    };
    raised(py, status, &error.to_string(), findings)
}

/// The exception that `error` is.
pub fn of_study(py: Python<'_>, error: &StudyError) -> PyErr {
    let status = ExitStatus::from(error);
    let findings = match (error, status) {
        (StudyError::Invalid { path, findings }, _) => {
            let found = findings.iter().map(|finding| described(path, finding));
            Some(found.collect())
        }
        (_, ExitStatus::StudyInvalid | ExitStatus::ModelInvalid) => Some(only(&error.to_string())),
        _ => None,
    };
    raised(py, status, &error.to_string(), findings)
}

/// The exception that the failure of a command is.
pub fn of_failure(py: Python<'_>, failure: &Failure) -> PyErr {
    raised(py, failure.status, &failure.message, None)
}

/// What is wrong elsewhere than under a key of the study file.
fn only(message: &str) -> Vec<Value> {
    vec![json!({ "problem": "input", "message": message })]
}

/// A finding by the names that it has in Python.
fn described(path: &Path, finding: &Finding) -> Value {
    let mut described = json!({
        "file": path.display().to_string(),
        "line": finding.line,
        "key": finding.key,
        "message": finding.to_string(),
    });
    let (problem, value, accepted, suggestion) = match &finding.problem {
        Problem::Syntax { .. } => ("syntax", None, None, None),
        Problem::UnknownKey {
            suggestion,
            accepted,
        } => (
            "unknown_key",
            None,
            Some(accepted.join(", ")),
            suggestion.clone(),
        ),
        Problem::Missing { accepted } => ("missing", None, Some(accepted.clone()), None),
        Problem::NotAccepted {
            value,
            accepted,
            suggestion,
        } => (
            "not_accepted",
            Some(value.clone()),
            Some(accepted.clone()),
            suggestion.clone(),
        ),
        Problem::Conflict { .. } => ("conflict", None, None, None),
    };
    described["problem"] = json!(problem);
    described["value"] = json!(value);
    described["accepted"] = json!(accepted);
    described["suggestion"] = json!(suggestion);
    described
}

/// What is raised where the program is at fault; the place has been written to the error output.
pub fn of_panic(py: Python<'_>) -> PyErr {
    let failure = Failure::of_panic();
    raised(py, failure.status, &failure.message, None)
}

/// `InputError` where there are findings, else `BliskError`; both stand in Python.
fn raised(
    py: Python<'_>,
    status: ExitStatus,
    message: &str,
    findings: Option<Vec<Value>>,
) -> PyErr {
    let made = || {
        let errors = py.import("blisk._errors")?;
        let code = status as i32;
        match findings {
            Some(findings) => {
                let findings = Value::Array(findings).to_string();
                errors.call_method1("input_error", (message, code, findings))
            }
            None => errors.call_method1("blisk_error", (message, code)),
        }
    };
    match made() {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}
