//! A random sample of delivered rows swept densely: whether the peak search missed a higher peak.

use rayon::prelude::*;

use super::VerifyRequest;
use crate::campaign::store::{ResultsFolder, StoredModel, StoredStudy};
use crate::population::monte_carlo::{CurveSettings, ResponseRow, Scenario};
use crate::population::statistics::draw;
use crate::population::table::{
    CurvePoint, PeakAuditRecord, TableHeader, write_peak_audit, write_side_table,
};
use crate::report::PeakAuditReport;
use crate::response::forced_response::{DensePeak, FrequencyBand, dense_peak};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;
use crate::settings::{Engine, EngineSource, Progress, Stage};
use crate::study::PipelineError;

/// Share of the width of the searched band that the sweep goes beyond either end: a peak outside of
/// the band is what the search cannot see.
const BEYOND: f64 = 0.25;
/// Residual of a point of a sweep: a hundredth of the share by which a row counts as missed, and at most this share of what the row states.
const RESIDUAL: f64 = 1e-5;
const RESIDUAL_OVER_STATED: f64 = 0.1;
/// Steps in a half-bandwidth by which a top with fewer harmonics is looked at.
const BESIDE: i32 = 8;

/// Sweeps a sample of the rows of a finished study and writes `peak_audit.parquet` into its folder.
///
/// # Errors
/// A table cannot be read or written, the folder is in use, or the model cannot be reduced. A row
/// whose peak was missed is no error: the report says so.
pub fn audit_peaks(
    stored: &StoredStudy,
    source: &dyn EngineSource,
    request: VerifyRequest,
    progress: &dyn Progress,
) -> Result<PeakAuditReport, PipelineError> {
    let folder = ResultsFolder::open(&stored.folder)?;
    let stored = &stored.again()?;
    request.pool()?.install(|| {
        let seed = request.seed.unwrap_or(stored.manifest.seed);
        let rows = stored.row_count()?;
        let drawn = stored.rows_at(&draw(rows, request.sample, seed))?;
        progress.stage(Stage::LoadModel);
        let model = stored.model()?;
        progress.stage(Stage::Reduce);
        let engine = stored.engine(&model, source)?;
        progress.begin_rows(drawn.len() as u64, 0);
        let records = drawn
            .into_par_iter()
            .with_max_len(1)
            .map(|row| {
                let record = audit_row(stored, &model, engine.as_ref(), row)?;
                progress.row(record.delivered.status);
                Ok(record)
            })
            .collect::<Result<Vec<_>, PipelineError>>()?;
        progress.stage(Stage::Tables);
        let header = TableHeader {
            study_digest: stored.manifest.study_digest.clone(),
            compression: stored.study.output.compression,
            load_cases: stored.load_cases(),
        };
        write_side_table(folder.path(), "peak_audit.parquet", |path| {
            write_peak_audit(path, &records, &header, seed)
        })?;
        Ok(PeakAuditReport::new(
            &stored.manifest.name,
            seed,
            rows,
            &records,
        ))
    })
}

fn audit_row(
    stored: &StoredStudy,
    model: &StoredModel,
    engine: &dyn Engine,
    delivered: ResponseRow,
) -> Result<PeakAuditRecord, PipelineError> {
    let no_row = || PipelineError::NoRow {
        scenario: delivered.scenario,
        pattern: delivered.pattern,
        scenarios: stored.manifest.scenarios.len(),
    };
    let (scenario, tuned) = stored.scenario(delivered.scenario).ok_or_else(no_row)?;
    let pattern = model
        .pattern(delivered.pattern, &scenario)
        .ok_or_else(no_row)?;
    let swept = if delivered.status == Status::Ok {
        let band = stored.study.solver.frequency_band;
        let of = (&scenario, &pattern);
        sweep(engine, of, &delivered, tuned.frequency_hz, band)
    } else {
        None
    };
    Ok(PeakAuditRecord {
        scenario,
        delivered,
        swept,
    })
}

/// The highest value in and around the band that the peak of the row `delivered` was sought in; none where the linear
/// limits give no band.
///
/// Frequencies without a solution with the harmonics of the load are solved with the fewest. What the others change of an amplitude is
/// taken from the delivered peak: the top that the fewest have beside it counts as high as that peak.
/// Without such a top the frequencies stay without a solution.
fn sweep(
    engine: &dyn Engine,
    (scenario, pattern): (&Scenario, &Pattern),
    delivered: &ResponseRow,
    tuned_hz: Option<f64>,
    band: FrequencyBand,
) -> Option<DensePeak> {
    let (peak_hz, peak_m) = delivered
        .peak_frequency_hz
        .zip(delivered.peak_amplitude_m)?;
    let judged = CurveSettings {
        fewest_harmonics: false,
        least_residual_tolerance: delivered.stated_error.map_or(RESIDUAL, |stated| {
            (RESIDUAL_OVER_STATED * stated).min(RESIDUAL)
        }),
    };
    let plan = engine.search_plan(scenario, pattern, tuned_hz).ok()?;
    let (start, stop) = plan.band_hz;
    let margin = match band {
        FrequencyBand::Auto => BEYOND * (stop - start),
        FrequencyBand::Fixed { .. } => 0.0,
    };
    let half_bandwidth_hz = plan.envelope.linear_half_bandwidth_hz;
    let band_hz = ((start - margin).max(0.5 * start), stop + margin);
    let with_fewest = |frequencies_hz: &[f64]| {
        let settings = CurveSettings {
            fewest_harmonics: true,
            ..judged
        };
        let points = engine.curve(scenario, Some(pattern), frequencies_hz, settings);
        largest_of_blades(&points, frequencies_hz.len())
    };
    let mut with_fewer_harmonics = 0;
    let mut top_m = None;
    let peak = dense_peak(band_hz, half_bandwidth_hz, |frequencies_hz| {
        let points = engine.curve(scenario, Some(pattern), frequencies_hz, judged);
        let mut found = largest_of_blades(&points, frequencies_hz.len());
        let lost = frequencies_hz.iter().zip(&found);
        let lost = lost.filter(|(_, amplitude)| amplitude.is_none());
        let lost_hz: Vec<f64> = lost.map(|(hz, _)| *hz).collect();
        if !lost_hz.is_empty() {
            let top_m =
                *top_m.get_or_insert_with(|| top_beside(peak_hz, half_bandwidth_hz, with_fewest));
            let lost = found.iter_mut().filter(|amplitude| amplitude.is_none());
            for (amplitude, fewest_m) in lost.zip(with_fewest(&lost_hz)) {
                *amplitude = fewest_m
                    .zip(top_m)
                    .map(|(height, top)| height / top * peak_m);
                with_fewer_harmonics += usize::from(amplitude.is_some());
            }
        }
        found
    });
    Some(DensePeak {
        with_fewer_harmonics,
        ..peak
    })
}

/// The largest amplitude, m, within a half-bandwidth of a peak; none where nothing is found there.
fn top_beside(
    peak_hz: f64,
    half_bandwidth_hz: f64,
    heights_m: impl Fn(&[f64]) -> Vec<Option<f64>>,
) -> Option<f64> {
    let beside = (-BESIDE..=BESIDE).map(f64::from);
    let step_hz = half_bandwidth_hz / f64::from(BESIDE);
    let beside_hz: Vec<f64> = beside.map(|step| peak_hz + step * step_hz).collect();
    let heights_m = heights_m(&beside_hz).into_iter().flatten();
    heights_m.reduce(f64::max)
}

/// The largest amplitude over the blades at each of so many frequencies; none where the solution failed.
fn largest_of_blades(points: &[CurvePoint], frequencies: usize) -> Vec<Option<f64>> {
    let blades = points.len() / frequencies.max(1);
    let largest = |blades: &[CurvePoint]| {
        let amplitudes = blades.iter().map(|point| point.amplitude_m);
        amplitudes.fold(None, |largest: Option<f64>, amplitude| {
            amplitude.map(|a| largest.map_or(a, |largest| largest.max(a)))
        })
    };
    points.chunks(blades.max(1)).map(largest).collect()
}
