//! What else the command answers: models, Campbell tables, shards, rows solved again, estimates, figures.

use std::path::PathBuf;
use std::sync::Arc;

use blisk::campaign::{
    CampbellRequest, EstimateRequest, ReplayRequest, ReportRequest, StoredStudy, TimeDomainRequest,
    TradeoffRequest, VerifyRequest,
};
use blisk::cli::{IntegrityAnswer, RepairAnswer, ReplayAnswer, threads as threads_of};
use blisk::model::sector::bundle;
use blisk::population::monte_carlo::LoadCaseName;
use blisk::population::statistics::EstimateTarget;
use blisk::population::table::write_atomically;
use blisk::report::{
    FIGURES, FigureName, GroupReport, StudyReport, figure as drawn_figure, missing,
};
use blisk::settings::{EngineSource, FullSettings, ReducedEngineSource};
use blisk::study::{PipelineError, RotationLoad, load_sector_model};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::results::{Answer, answer_of};
use crate::run::full_samples;
use crate::study::CheckedStudy;
use crate::watch::{OnSignal, watch};

/// Builds the reduced model; writes the sector as a bundle into `export`, where that is given.
#[pyfunction]
pub fn model(py: Python<'_>, study: &CheckedStudy, export: Option<PathBuf>) -> PyResult<Answer> {
    let study = Arc::clone(&study.0);
    let report = watch(py, None, OnSignal::Leave, move |_| {
        let model = load_sector_model(&study)?;
        if let Some(folder) = export {
            bundle::write(&model, &folder)?;
        }
        let engine = ReducedEngineSource.build(&study, &model, None)?;
        let mut report = engine.model_report();
        report.rotation = study.rotation.as_ref().map(RotationLoad::facts);
        Ok(report)
    })?;
    answer_of(&report)
}

/// SVG files for the Campbell and the SAFE diagram, and the highest frequency of both, Hz.
type Plots = (Option<PathBuf>, Option<PathBuf>, Option<f64>);

/// Natural frequencies per nodal diameter, and the speeds at which engine orders cross them.
#[pyfunction]
pub fn campbell(
    py: Python<'_>,
    study: &CheckedStudy,
    engine_orders: Vec<u32>,
    modes: usize,
    range_rpm: Option<[f64; 2]>,
    bundles: Vec<(f64, PathBuf)>,
    plots: Plots,
) -> PyResult<Answer> {
    let study = Arc::clone(&study.0);
    let report = watch(py, None, OnSignal::Leave, move |_| {
        let at_speeds = if bundles.is_empty() {
            vec![(None, load_sector_model(&study)?)]
        } else {
            { bundles.into_iter() }
                .map(|(speed_rpm, folder)| Ok((Some(speed_rpm), bundle::read(&folder)?)))
                .collect::<Result<Vec<_>, PipelineError>>()?
        };
        let request = CampbellRequest {
            study: &study,
            models: &at_speeds,
            engine_orders: &engine_orders,
            modes,
            range_rpm,
        };
        let report = blisk::campaign::campbell(&request)?;
        let (over_speed, safe, top_hz) = plots;
        for (file, name) in [(over_speed, FigureName::Campbell), (safe, FigureName::Safe)] {
            if let Some(file) = file {
                let drawn = request.diagram(&report, name, top_hz)?;
                write_atomically(&file, drawn.standalone().as_bytes())?;
            }
        }
        Ok(report)
    })?;
    answer_of(&report)
}

/// Joins shards to the results folder `out`.
#[pyfunction]
pub fn merge(
    py: Python<'_>,
    shards: Vec<PathBuf>,
    out: PathBuf,
    study_file: Option<PathBuf>,
) -> PyResult<()> {
    watch(py, None, OnSignal::Leave, move |_| {
        blisk::campaign::merge(&shards, &out, study_file.as_deref(), &ReducedEngineSource)
    })?;
    Ok(())
}

/// Solves one delivered row again; `full`: on the full-contact model as well.
#[pyfunction]
pub fn replay(
    py: Python<'_>,
    results: PathBuf,
    scenario: usize,
    pattern: u32,
    full: bool,
    study_file: Option<PathBuf>,
) -> PyResult<Answer> {
    let answer = watch(py, None, OnSignal::Leave, move |_| {
        let stored = StoredStudy::open(&results, study_file.as_deref())?;
        let request = ReplayRequest {
            scenario,
            pattern,
            full: full.then(|| FullSettings {
                harmonics: None,
                samples_per_period: full_samples(&stored.study),
            }),
        };
        let replay = blisk::campaign::replay(&stored, &ReducedEngineSource, &request)?;
        Ok(ReplayAnswer(replay))
    })?;
    answer_of(&answer)
}

/// Solves a sample of delivered rows again; `question`: `full_model`, `dense_sweep`, `time_domain` or `integrity`.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // As many as the command has.
pub fn verify(
    py: Python<'_>,
    results: PathBuf,
    question: &str,
    sample: usize,
    seed: Option<u64>,
    row: Option<(usize, u32)>,
    threads: Option<u16>,
    study_file: Option<PathBuf>,
    listener: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let request = VerifyRequest {
        sample,
        seed,
        threads: threads_of(threads),
    };
    let listener = listener.as_ref();
    if question == "integrity" {
        let found = watch(py, listener, OnSignal::Leave, move |_| {
            blisk::campaign::integrity(&results)
        })?;
        return answer_of(&IntegrityAnswer(found));
    }
    let stored = move || StoredStudy::open(&results, study_file.as_deref());
    match question {
        "full_model" => answer_of(&watch(py, listener, OnSignal::Leave, move |progress| {
            blisk::campaign::verify(&stored()?, &ReducedEngineSource, request, progress)
        })?),
        "dense_sweep" => answer_of(&watch(py, listener, OnSignal::Leave, move |progress| {
            blisk::campaign::audit_peaks(&stored()?, &ReducedEngineSource, request, progress)
        })?),
        "time_domain" => answer_of(&watch(py, listener, OnSignal::Leave, move |progress| {
            let request = TimeDomainRequest {
                row,
                sample: request,
            };
            blisk::campaign::verify_in_time(&stored()?, &ReducedEngineSource, request, progress)
        })?),
        other => Err(PyValueError::new_err(format!(
            "question = {other} is not accepted; accepted: full_model, dense_sweep, time_domain, integrity"
        ))),
    }
}

/// Sets damaged files of the folder aside and solves again what they held.
#[pyfunction]
pub fn repair(
    py: Python<'_>,
    results: PathBuf,
    threads: Option<u16>,
    study_file: Option<PathBuf>,
    listener: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let answer = watch(py, listener.as_ref(), OnSignal::Wait, move |progress| {
        let repaired = blisk::campaign::repair(
            &results,
            study_file.as_deref(),
            threads_of(threads),
            &ReducedEngineSource,
            progress,
        )?;
        Ok(RepairAnswer { results, repaired })
    })?;
    answer_of(&answer)
}

/// Measures what accuracy costs on a sample of the study's rows, and writes the tables into `out`.
#[pyfunction]
pub fn tradeoff(
    py: Python<'_>,
    study: &CheckedStudy,
    patterns: usize,
    full: bool,
    out: PathBuf,
    threads: Option<u16>,
    listener: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let study = Arc::clone(&study.0);
    let report = watch(py, listener.as_ref(), OnSignal::Leave, move |progress| {
        let request = TradeoffRequest {
            study: &study,
            results: &out,
            patterns,
            full,
            threads: threads_of(threads),
        };
        blisk::campaign::tradeoff(request, progress)
    })?;
    answer_of(&report)
}

/// Estimates the mean, or a percentile, from few solves.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // As many as the command has.
pub fn estimate(
    py: Python<'_>,
    study: &CheckedStudy,
    percent: Option<f64>,
    patterns: Option<u32>,
    solves: Option<u32>,
    out: PathBuf,
    threads: Option<u16>,
    listener: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let mut study = (*study.0).clone();
    if let Some(patterns) = patterns {
        study.patterns = patterns;
    }
    let report = watch(py, listener.as_ref(), OnSignal::Wait, move |progress| {
        let request = EstimateRequest {
            study: &study,
            results: &out,
            solves: solves.unwrap_or(study.patterns / 10),
            target: percent.map_or(EstimateTarget::Mean, EstimateTarget::Percentile),
            threads: threads_of(threads),
        };
        blisk::campaign::estimate(request, &ReducedEngineSource, progress)
    })?;
    answer_of(&report)
}

/// Names of the figures, and what each shows.
#[pyfunction]
pub fn figure_names() -> Vec<(String, String)> {
    { FIGURES.iter() }
        .map(|(_, name, about)| ((*name).to_owned(), (*about).to_owned()))
        .collect()
}

/// A figure of the report: SVG, title and setting.
#[pyfunction]
pub fn figure(
    py: Python<'_>,
    results: PathBuf,
    name: &str,
    load_case: Option<String>,
    engine_order: Option<u32>,
    standard_deviation: Option<f64>,
    study_file: Option<PathBuf>,
) -> PyResult<(String, String, String)> {
    let own = { FIGURES.iter() }
        .find(|(_, own, _)| *own == name)
        .map(|(own, ..)| *own)
        .ok_or_else(|| {
            let names: Vec<&str> = FIGURES.iter().map(|(_, own, _)| *own).collect();
            PyValueError::new_err(format!(
                "figure = {name} is not accepted; accepted: {}",
                names.join(", ")
            ))
        })?;
    let request = ReportRequest {
        results,
        study_file,
        curves: own.is_of_wheels(),
        model: own.is_of_model(),
    };
    let found = watch(py, None, OnSignal::Leave, move |_| {
        blisk::campaign::report(&request, &ReducedEngineSource)
    })?;
    let group = chosen(
        &found,
        load_case.as_deref(),
        engine_order,
        standard_deviation,
    )?;
    let Some(drawn) = drawn_figure(&found, group, own) else {
        let reason = missing(&found, group, own);
        let reason = reason.map_or_else(String::new, |reason| format!(": {reason}"));
        return Err(PyValueError::new_err(format!(
            "these results have nothing to draw in {name}{reason}"
        )));
    };
    Ok((
        drawn.standalone(),
        drawn.title.clone(),
        drawn.setting.clone(),
    ))
}

/// The load case, engine order and standard deviation that are named, or the only ones.
fn chosen<'a>(
    found: &'a StudyReport,
    load_case: Option<&str>,
    engine_order: Option<u32>,
    standard_deviation: Option<f64>,
) -> PyResult<&'a GroupReport> {
    let fits = |group: &&GroupReport| {
        let case = group.load_case.as_ref().map(LoadCaseName::as_str);
        (load_case.is_none() || load_case == case)
            && engine_order.is_none_or(|order| order == group.engine_order)
            && standard_deviation.is_none_or(|own| Some(own) == group.standard_deviation)
    };
    let fitting: Vec<&GroupReport> = found.groups.iter().filter(fits).collect();
    if let [only] = fitting[..] {
        return Ok(only);
    }
    let choices: Vec<String> = { found.groups.iter() }
        .map(|group| {
            let case = group.load_case.as_ref().map(LoadCaseName::as_str);
            let case = case.map_or_else(String::new, |name| format!("load_case {name}, "));
            let deviation = group.standard_deviation;
            let deviation =
                deviation.map_or_else(String::new, |s| format!(", standard_deviation {s}"));
            format!("{case}engine_order {}{deviation}", group.engine_order)
        })
        .collect();
    Err(PyValueError::new_err(format!(
        "name load_case, engine_order and standard_deviation of the study: {}",
        choices.join("; ")
    )))
}
