//! The numbers of the report on a finished results folder.

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::compare::{HALF_ERROR, best_loads};
use super::report_model::shown_model;
use super::report_wheels::solve_wheels;
use crate::campaign::store::{ResultColumns, ScenarioColumns, StoredModel, StoredStudy, summarise};
use crate::identity;
use crate::population::monte_carlo::{LoadCaseName, ResponseRow};
use crate::population::statistics::{
    CONFIDENCE, DistributionBand, FitStatus, Quantity, RESAMPLES, TailLaw, fit_extreme_value,
    fit_tails, percentile_at, smallest_sample,
};
use crate::population::table::{AccuracyLadder, Manifest, ResponseReader, TableError};
use crate::report::{
    AccuracyTrials, CommonErrors, ComparedScenario, DistributionReport, ErrorRows, GroupReport,
    LoadChoice, MOST_WHEELS_NAMED, MeasuredPeak, Provenance, ScenarioErrors, ShownModel,
    StudyReport, Wheels,
};
use crate::response::harmonic_balance::Status;
use crate::settings::EngineSource;
use crate::study::PipelineError;

/// Percentiles that a load is chosen by, in percent, the first with a value before the others.
const CHOSEN_BY: [f64; 3] = [99.0, 95.0, 50.0];
/// Percentiles of a distribution that its figure marks, in percent.
const MARKED: [f64; 4] = [5.0, 50.0, 95.0, 99.0];
/// Points at which a fitted law is drawn.
const LAW_POINTS: u32 = 200;

/// What a report is wanted of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportRequest {
    /// The results folder.
    pub results: PathBuf,
    /// The study file beside which the inputs lie now; none = that of the last run.
    pub study_file: Option<PathBuf>,
    /// Whether wheels are solved again for their response curves.
    pub curves: bool,
    /// Whether the model is shown: its masses, frequencies and places.
    pub model: bool,
}

/// Collects the report of a finished study.
///
/// A study whose inputs are gone or have changed has neither model nor curves, and the report says why.
///
/// # Errors
/// The folder holds no finished study, or a file of it is damaged.
pub fn report(
    request: &ReportRequest,
    source: &dyn EngineSource,
) -> Result<StudyReport, PipelineError> {
    let summary = summarise(&request.results)?;
    let columns = ResultColumns::read(&request.results)?;
    let rows = stated_errors(&request.results, columns.scenarios.len())?;
    let mut groups: Vec<GroupReport> = groups_of(&columns)
        .into_iter()
        .map(|group| group_report(&columns, &rows, group))
        .collect();
    let measured = measured_peaks(&columns)?;
    for group in &mut groups {
        let here = measured
            .iter()
            .filter(|own| group.scenarios.contains(&own.scenario));
        group.measured = here.copied().collect();
    }
    let asked = request.curves || request.model;
    let inputs = asked.then(|| inputs_of(request)).transpose()?;
    if let (true, Some(inputs)) = (request.curves, &inputs) {
        add_wheels(inputs, source, &columns, &mut groups)?;
    }
    let model = match &inputs {
        Some(Ok((stored, model))) if request.model => shown_model(&stored.study, &model.sector),
        Some(Err(reason)) if request.model => ShownModel::NotShown {
            reason: reason.clone(),
        },
        _ => ShownModel::NotShown {
            reason: "not asked for".to_owned(),
        },
    };
    let manifest = columns.manifest;
    let accuracy_ladder = ladder_of(&request.results, &manifest)?;
    Ok(StudyReport {
        summary,
        groups,
        model,
        accuracy_ladder,
        accuracy_trials: AccuracyTrials::from_choice(&manifest.chosen["accuracy"]),
        provenance: Provenance {
            version: manifest.version,
            build: manifest.build,
            generator: manifest.generator,
            inputs: manifest.inputs,
            tables: manifest.tables,
            study: manifest.study,
            chosen: manifest.chosen,
        },
    })
}

/// The measured trade-off, which has to be of the build that solved the rows.
fn ladder_of(results: &Path, manifest: &Manifest) -> Result<Option<AccuracyLadder>, TableError> {
    let ladder = AccuracyLadder::read(results)?;
    match ladder {
        Some(ladder) if ladder.build != manifest.build => Err(TableError::Damaged {
            path: results.join("tradeoff.parquet"),
            reason: format!(
                "build {} measured it, and build {} solved the rows; `blisk tradeoff` measures it anew, or remove it",
                identity::named(&ladder.build),
                identity::named(&manifest.build)
            ),
        }),
        ladder => Ok(ladder),
    }
}

/// Errors of the rows of every scenario.
fn stated_errors(results: &Path, scenarios: usize) -> Result<Vec<ErrorRows>, PipelineError> {
    let mut errors = vec![ErrorRows::default(); scenarios];
    let mut reader = ResponseReader::open(&results.join("responses.parquet"))?;
    loop {
        let batch: Vec<ResponseRow> = reader.next_batch()?;
        if batch.is_empty() {
            return Ok(errors);
        }
        for row in &batch {
            errors[row.scenario].add(row);
        }
    }
}

/// Scenarios of one engine order and standard deviation stand beside each other.
fn groups_of(columns: &ResultColumns) -> Vec<Range<usize>> {
    let mut start = 0;
    columns
        .scenarios
        .chunk_by(|a, b| a.scenario.same_group(&b.scenario))
        .map(|group| {
            let range = start..start + group.len();
            start = range.end;
            range
        })
        .collect()
}

fn group_report(columns: &ResultColumns, rows: &[ErrorRows], group: Range<usize>) -> GroupReport {
    let manifest = &columns.manifest;
    let confidence = manifest
        .stop
        .as_ref()
        .map_or(CONFIDENCE, |stop| stop.confidence);
    let scenarios = &columns.scenarios[group.clone()];
    let choices: Vec<LoadChoice> = CHOSEN_BY
        .iter()
        .map(|&percent| choice(scenarios, percent, manifest.seed))
        .collect();
    let shown = choices
        .iter()
        .find_map(|choice| choice.lowest)
        .unwrap_or_else(|| lowest_tuned(columns, group.clone()));
    let errors = group
        .clone()
        .map(|scenario| ScenarioErrors {
            scenario,
            rows: rows[scenario].spread(),
            common: common_errors(columns, scenario),
            percentiles: CHOSEN_BY
                .iter()
                .map(|&percent| rows[scenario].percentile(percent, confidence))
                .collect(),
        })
        .collect();
    GroupReport {
        load_case: scenarios[0].scenario.load_case,
        engine_order: scenarios[0].scenario.engine_order,
        standard_deviation: scenarios[0].scenario.standard_deviation,
        scenarios: group.collect(),
        choices,
        errors,
        shown,
        distributions: Quantity::ALL
            .iter()
            .enumerate()
            .map(|(place, &quantity)| {
                let topic = (2 * shown + place) as u32;
                distribution(
                    &columns.scenarios[shown],
                    quantity,
                    (manifest.seed, topic),
                    confidence,
                )
            })
            .collect(),
        wheels: Wheels::NotSolved {
            reason: "not asked for".to_owned(),
        },
        measured: Vec::new(),
    }
}

/// The peaks of the wheels of a file, scenario by scenario; none of drawn ones, nor of many.
fn measured_peaks(columns: &ResultColumns) -> Result<Vec<MeasuredPeak>, PipelineError> {
    let mut peaks = Vec::new();
    if columns.patterns.len() as u64 > MOST_WHEELS_NAMED {
        return Ok(peaks);
    }
    let mut reader = ResponseReader::open(&columns.folder.join("responses.parquet"))?;
    loop {
        let batch: Vec<ResponseRow> = reader.next_batch()?;
        if batch.is_empty() {
            break;
        }
        // Only wheels of a file have no standard deviation.
        let of_file = batch.iter().filter(|row| {
            let load = columns.scenarios.get(row.scenario);
            load.is_some_and(|load| load.scenario.standard_deviation.is_none())
        });
        peaks.extend(of_file.map(|row| MeasuredPeak {
            scenario: row.scenario,
            pattern: row.pattern,
            peak_amplitude_m: Quantity::PeakAmplitudeM.of(row),
            amplification_factor: Quantity::AmplificationFactor.of(row),
            peak_blade: row.peak_blade.filter(|_| row.status == Status::Ok),
        }));
    }
    peaks.sort_by_key(|peak| peak.scenario);
    Ok(peaks)
}

/// What every row of a scenario states of errors that are not measured on the row itself, besides the basis.
fn common_errors(columns: &ResultColumns, scenario: usize) -> CommonErrors {
    let manifest = &columns.manifest;
    let of_scenario = &columns.scenarios[scenario].scenario;
    let of_load = |choice: &&Value| {
        choice["load_case"].as_str() == of_scenario.load_case.as_ref().map(LoadCaseName::as_str)
            && choice["engine_order"] == of_scenario.engine_order
            && choice["contact"]["full"]["normal_load_n"].as_f64()
                == of_scenario.contact.normal_load_n()
            && of_scenario.contact.normal_load_n().is_some()
    };
    let harmonics = manifest.chosen["harmonics"].as_array();
    let choice = harmonics.and_then(|all| all.iter().find(of_load));
    let of_limits = || {
        let is_limit = of_scenario.contact.normal_load_n().is_none();
        manifest.reduction["linear_limit_error"]
            .as_f64()
            .filter(|_| is_limit)
    };
    // Where [accuracy] chose it, the tolerance is a level of the ladder, which is text.
    let chosen = manifest.chosen["accuracy"]["setting"]["peak_tolerance"].as_str();
    let chosen = chosen.and_then(|level| level.parse().ok());
    CommonErrors {
        harmonics: choice.and_then(|choice| choice["remainder"].as_f64()),
        reduced_model: { choice.and_then(|choice| choice["reduced_model"].as_f64()) }
            .or_else(of_limits),
        peak: chosen.or(manifest.study["solver"]["peak_tolerance"].as_f64()),
    }
}

/// The scenario with the lowest tuned peak, where too few patterns or too many failures give no percentile.
fn lowest_tuned(columns: &ResultColumns, group: Range<usize>) -> usize {
    let tuned = |scenario: usize| columns.manifest.scenarios[scenario].tuned_amplitude_m;
    let first = group.start;
    group
        .filter_map(|scenario| Some((scenario, tuned(scenario)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(first, |(scenario, _)| scenario)
}

/// The load with the lowest percentile of the peak amplitude, and which others could be.
fn choice(group: &[ScenarioColumns], percent: f64, seed: u64) -> LoadChoice {
    let named: Vec<_> = group
        .iter()
        .map(|load| {
            let name = ComparedScenario::new(0, &load.scenario);
            (name, load.values(Quantity::PeakAmplitudeM))
        })
        .collect();
    let best = (group.len() > 1)
        .then(|| best_loads(&named, percent, seed))
        .flatten();
    let alone = |load: &ScenarioColumns| {
        let (sorted, failed) = load.sorted(Quantity::PeakAmplitudeM);
        let found = percentile_at(&sorted, failed, percent, CONFIDENCE);
        found.value.map(|_| load.scenario.index)
    };
    let lowest = match (&best, group) {
        (Some(best), _) => best.lowest,
        (None, [only]) => alone(only),
        _ => None,
    };
    let load_of = |load: &ScenarioColumns| load.scenario.contact.normal_load_n();
    let chosen = group
        .iter()
        .find(|load| Some(load.scenario.index) == lowest)
        .and_then(load_of);
    let loads = || group.iter().filter_map(load_of);
    LoadChoice {
        percent,
        best,
        needed_patterns: smallest_sample(percent / 100.0, CONFIDENCE),
        patterns_of_best: smallest_sample(percent / 100.0, HALF_ERROR),
        lowest,
        enclosed: chosen.is_some_and(|chosen| {
            loads().any(|load| load < chosen) && loads().any(|load| load > chosen)
        }),
    }
}

/// The distribution of a quantity with its band, percentiles and fitted laws; resamples come from the
/// streams of `topic` under `seed`.
fn distribution(
    load: &ScenarioColumns,
    quantity: Quantity,
    (seed, topic): (u64, u32),
    confidence: f64,
) -> DistributionReport {
    let (sorted, failed) = load.sorted(quantity);
    let band = DistributionBand::at(&sorted, failed, confidence);
    let fits = fit_tails(&sorted, failed, RESAMPLES, seed, topic);
    let converged = fits.iter().any(|fit| {
        fit.law == TailLaw::GeneralisedExtremeValue && fit.status == FitStatus::Converged
    });
    let law = fit_extreme_value(&sorted).ok().filter(|_| converged);
    DistributionReport {
        quantity,
        half_width: band.half_width,
        points: band
            .points
            .iter()
            .map(|point| [point.value, point.cumulative, point.lower, point.upper])
            .collect(),
        percentiles: MARKED
            .iter()
            .map(|&percent| percentile_at(&sorted, failed, percent, confidence))
            .collect(),
        fits: fits.into(),
        law: law.map_or_else(Vec::new, |law| {
            law_probabilities().map(|p| [law.quantile(p), p]).collect()
        }),
    }
}

/// Probabilities spaced evenly in the reduced variate `-ln(-ln p)` of Gumbel's law.
fn law_probabilities() -> impl Iterator<Item = f64> {
    let [low, high] = [1e-3_f64, 0.9999].map(|p| -(-p.ln()).ln());
    (0..=LAW_POINTS).map(move |step| {
        let reduced = low + (high - low) * f64::from(step) / f64::from(LAW_POINTS);
        (-(-reduced).exp()).exp()
    })
}

/// What a study is solved from; the reason where that is gone or has changed.
type Inputs = Result<(StoredStudy, StoredModel), String>;

fn inputs_of(request: &ReportRequest) -> Result<Inputs, PipelineError> {
    let stored = StoredStudy::open(&request.results, request.study_file.as_deref());
    let opened = stored.and_then(|stored| {
        let model = stored.model()?;
        Ok((stored, model))
    });
    match opened {
        Ok(inputs) => Ok(Ok(inputs)),
        Err(PipelineError::Table(error)) => Err(error.into()),
        Err(error) => Ok(Err(error.to_string())),
    }
}

/// Solves the wheels of every group, unless what they are made from is no longer there or another build
/// solved the rows.
fn add_wheels(
    inputs: &Inputs,
    source: &dyn EngineSource,
    columns: &ResultColumns,
    groups: &mut [GroupReport],
) -> Result<(), PipelineError> {
    let (stored, model) = match inputs {
        Ok(inputs) => inputs,
        Err(reason) => {
            leave_out_wheels(groups, reason);
            return Ok(());
        }
    };
    if let Some(reason) = stored.other_build() {
        let reason = format!("{reason}: its curves need not be those of the rows");
        leave_out_wheels(groups, &reason);
        return Ok(());
    }
    let solved = stored.engine(model, source).and_then(|engine| {
        let shown = groups.iter().map(|group| group.shown);
        shown
            .map(|scenario| {
                let columns = &columns.scenarios[scenario];
                solve_wheels(stored, model, engine.as_ref(), columns)
            })
            .collect::<Result<Vec<Wheels>, PipelineError>>()
    });
    match solved {
        Ok(solved) => {
            for (group, wheels) in groups.iter_mut().zip(solved) {
                group.wheels = wheels;
            }
        }
        Err(PipelineError::Table(error)) => return Err(error.into()),
        Err(error) => leave_out_wheels(groups, &error.to_string()),
    }
    Ok(())
}

fn leave_out_wheels(groups: &mut [GroupReport], reason: &str) {
    for group in groups {
        group.wheels = Wheels::NotSolved {
            reason: reason.to_owned(),
        };
    }
}
