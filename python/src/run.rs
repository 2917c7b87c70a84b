//! What solves rows: runs, searches for a load, plans, response curves.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use blisk::campaign::{
    CurveRequest, OptimumRequest, PlanRequest, RunRequest, set_other_builds_aside,
};
use blisk::cli::threads as threads_of;
use blisk::population::monte_carlo::{LoadCaseName, Scenario};
use blisk::population::statistics::Quantity;
use blisk::population::table::{CurveFormat, TableHeader, write_curve, write_traced_curve};
use blisk::response::forced_response::ContactCondition;
use blisk::response::friction::Ring;
use blisk::settings::{FullSettings, ReducedEngineSource};
use blisk::study::{Study, StudyDigest};
use blisk::verification::reference::ReferenceSettings;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::results::{Answer, answer_of};
use crate::study::CheckedStudy;
use crate::table::Table;
use crate::watch::{OnSignal, watch};

/// Creates or continues a study in the folder `out`; gives the rows solved and the rows that were there.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    study: &CheckedStudy,
    out: PathBuf,
    threads: Option<u16>,
    solve_anew: bool,
    listener: Option<Py<PyAny>>,
) -> PyResult<(u64, u64)> {
    let study = Arc::clone(&study.0);
    let outcome = watch(py, listener.as_ref(), OnSignal::Wait, move |progress| {
        if solve_anew {
            set_other_builds_aside(&out, &study, None)?;
        }
        let request = RunRequest {
            study: &study,
            results: &out,
            threads: threads_of(threads),
        };
        blisk::campaign::run(request, &ReducedEngineSource, progress)
    })?;
    Ok((outcome.rows_solved, outcome.rows_reused))
}

/// Searches the normal load with the lowest percentile.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // As many as the search has.
pub fn optimum(
    py: Python<'_>,
    study: &CheckedStudy,
    between_n: [f64; 2],
    percent: f64,
    quantity: &str,
    resolution: f64,
    out: PathBuf,
    solved: PathBuf,
    threads: Option<u16>,
    listener: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let quantity = { Quantity::ALL.into_iter() }
        .find(|own| own.name() == quantity)
        .ok_or_else(|| PyValueError::new_err(format!("there is no quantity {quantity}")))?;
    let study = Arc::clone(&study.0);
    let report = watch(py, listener.as_ref(), OnSignal::Wait, move |progress| {
        let request = OptimumRequest {
            study: &study,
            results: &out,
            solved: &solved,
            between_n,
            percent,
            quantity,
            resolution,
            threads: threads_of(threads),
        };
        blisk::campaign::find_optimum(request, &ReducedEngineSource, progress)
    })?;
    answer_of(&report)
}

/// Solves the first `pilot` patterns and says what the study costs.
#[pyfunction]
pub fn plan(
    py: Python<'_>,
    study: &CheckedStudy,
    pilot: u32,
    threads: Option<u16>,
) -> PyResult<Answer> {
    let study = Arc::clone(&study.0);
    let plan = watch(py, None, OnSignal::Leave, move |progress| {
        let request = PlanRequest {
            study: &study,
            results: &Path::new("results").join(&study.name),
            pilot: pilot as usize,
            threads: threads_of(threads),
        };
        blisk::campaign::plan(request, &ReducedEngineSource, progress)
    })?;
    answer_of(&plan)
}

/// Amplitude of every blade of one wheel over frequency, written to the Parquet file `path` and read from there.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // As many as name a curve.
pub fn response(
    py: Python<'_>,
    study: &CheckedStudy,
    pattern: Option<u32>,
    load: Load,
    frequencies_hz: Vec<f64>,
    load_case: Option<String>,
    engine_order: Option<u32>,
    standard_deviation: Option<f64>,
    way: &str,
    path: PathBuf,
) -> PyResult<Table> {
    let study = Arc::clone(&study.0);
    let contact = load.contact()?;
    let way = Way::of(way, &study, contact, frequencies_hz.len())?;
    let excited = excitation_of(&study, load_case.as_deref(), engine_order)?;
    let standard_deviation = match pattern {
        None => None,
        Some(_) => deviation_of(&study, standard_deviation)?,
    };
    watch(py, None, OnSignal::Leave, move |_| {
        let request = CurveRequest {
            pattern,
            contact,
            load_case: excited.load_case,
            engine_order: excited.engine_order,
            standard_deviation,
            frequencies_hz: &frequencies_hz,
        };
        let header = TableHeader {
            study_digest: StudyDigest::of(&study)?.hex(),
            compression: study.output.compression,
            load_cases: Vec::new(),
        };
        if way == Way::Followed {
            let curve = blisk::campaign::traced_response(&study, &ReducedEngineSource, request)?;
            write_traced_curve(&path, CurveFormat::Parquet, &curve.points, &header)?;
            return Ok(Table::read(&path)?);
        }
        let points = match way {
            Way::Full => {
                let settings = FullSettings {
                    harmonics: None,
                    samples_per_period: full_samples(&study),
                };
                blisk::campaign::full_response_curve(&study, &settings, request)?
            }
            _ => blisk::campaign::response_curve(&study, &ReducedEngineSource, request)?,
        };
        write_curve(&path, CurveFormat::Parquet, &points, &header)?;
        Ok(Table::read(&path)?)
    })
}

/// How a curve is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Each frequency on the reduced model.
    Reduced,
    /// Each frequency on the full-contact model.
    Full,
    /// Followed through its folds.
    Followed,
}

impl Way {
    fn of(
        name: &str,
        study: &Study,
        contact: ContactCondition,
        frequencies: usize,
    ) -> PyResult<Self> {
        let way = match name {
            "full" => Self::Full,
            "followed" => Self::Followed,
            _ => Self::Reduced,
        };
        let ring = study.contact.as_ref().map(|contact| contact.ring);
        let refused = match way {
            Self::Followed if contact.normal_load_n().is_none() => {
                "a linear response has one branch; accepted: a normal load in N"
            }
            Self::Followed if ring == Some(Ring::Creeping) => {
                "the curve of a creeping ring is not followed; accepted: contact.ring = \"locked\""
            }
            Self::Followed if frequencies < 2 => "continuation needs at least two frequencies",
            _ => return Ok(way),
        };
        Err(PyValueError::new_err(refused))
    }
}

/// Samples per period on the full-contact model: finely, and not more coarsely than the study.
pub fn full_samples(study: &Study) -> usize {
    ReferenceSettings::SAMPLES_PER_PERIOD.max(study.solver.samples_per_period)
}

/// A number of newtons, or a linear limit by name.
#[derive(FromPyObject)]
pub enum Load {
    /// Normal load per sector, N.
    Newtons(f64),
    /// `stuck`, `slide` or `free`.
    Limit(String),
}

impl Load {
    fn contact(&self) -> PyResult<ContactCondition> {
        let (accepted, written) = match self {
            Self::Newtons(load) if *load >= 0.0 && load.is_finite() => {
                return Ok(ContactCondition::Full {
                    normal_load_n: *load,
                });
            }
            Self::Newtons(load) => (None, load.to_string()),
            Self::Limit(name) => {
                let limits = [
                    ContactCondition::Stuck,
                    ContactCondition::Slide,
                    ContactCondition::Free,
                ];
                let limit = limits.into_iter().find(|limit| limit.name() == name);
                (limit, name.clone())
            }
        };
        accepted.ok_or_else(|| {
            PyValueError::new_err(format!(
                "load = {written} is not accepted; accepted: a number of at least 0 in N, stuck, slide or free"
            ))
        })
    }
}

/// The excitation of the study that is named, or its only one.
fn excitation_of(
    study: &Study,
    load_case: Option<&str>,
    engine_order: Option<u32>,
) -> PyResult<Scenario> {
    let name = |scenario: &Scenario| {
        scenario
            .load_case
            .as_ref()
            .map(LoadCaseName::as_str)
            .map(str::to_owned)
    };
    let fits = |scenario: &Scenario| {
        load_case.is_none_or(|wanted| name(scenario).as_deref() == Some(wanted))
            && engine_order.is_none_or(|wanted| scenario.engine_order == wanted)
    };
    let all = study.scenarios();
    let mut fitting: Vec<Scenario> = all.iter().copied().filter(fits).collect();
    fitting.dedup_by(|a, b| a.same_excitation(b));
    if let [only] = fitting[..] {
        return Ok(only);
    }
    let mut choices: Vec<String> = { all.iter() }
        .map(|own| match name(own) {
            Some(case) => format!("load_case {case}, engine_order {}", own.engine_order),
            None => format!("engine_order {}", own.engine_order),
        })
        .collect();
    choices.dedup();
    Err(PyValueError::new_err(format!(
        "name one excitation of the study: {}",
        choices.join("; ")
    )))
}

/// The standard deviation of the study that is named, or its only one; none for patterns from a file.
fn deviation_of(study: &Study, wanted: Option<f64>) -> PyResult<Option<f64>> {
    let known = &study.standard_deviations;
    match (wanted, &known[..]) {
        (None, [only]) => Ok(*only),
        (Some(_), _) if known.contains(&wanted) => Ok(wanted),
        _ => {
            let choices: Vec<String> = { known.iter().flatten() }.map(f64::to_string).collect();
            Err(PyValueError::new_err(format!(
                "name one standard_deviation of the study: {}",
                choices.join(", ")
            )))
        }
    }
}
