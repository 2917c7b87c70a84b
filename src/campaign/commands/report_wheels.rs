//! Wheels of one scenario solved again for a report: response curves, blades and contact at the peak.

use crate::campaign::store::{ScenarioColumns, StoredModel, StoredStudy};
use crate::population::monte_carlo::{CurveSettings, ResponseRow, Scenario};
use crate::population::statistics::Quantity;
use crate::report::{
    PairReport, ResponseCurve, WheelCurves, WheelReport, WheelStateReport, Wheels,
};
use crate::response::forced_response::ContactCondition;
use crate::response::mistuning::Pattern;
use crate::settings::Engine;
use crate::study::PipelineError;

/// Points of a curve spread evenly over its band.
const EVEN_POINTS: u32 = 80;
/// Points on either side of a delivered peak, ever closer to it.
const CLOSE_POINTS: u32 = 16;
/// Ratio of the distances of neighbouring points from a peak.
const CLOSER: f64 = 0.7;
/// Steps of a linear curve over one step of the curve with friction.
const LINEAR_POINTS: u32 = 4;

/// The tuned wheel, and those of the median and the largest peak amplitude.
pub(super) fn solve_wheels(
    stored: &StoredStudy,
    model: &StoredModel,
    engine: &dyn Engine,
    columns: &ScenarioColumns,
) -> Result<Wheels, PipelineError> {
    let scenario = columns.scenario;
    let not_solved = |reason: &str| {
        Ok(Wheels::NotSolved {
            reason: reason.to_owned(),
        })
    };
    let Some([median, worst]) = rows_of(stored, columns)? else {
        return not_solved("no wheel of this load has a result");
    };
    let patterns = [&median, &worst].map(|row| model.pattern(row.pattern, &scenario));
    let [Some(of_median), Some(of_worst)] = patterns else {
        return not_solved("the study no longer has these patterns");
    };
    let solver = Curves {
        engine,
        scenario,
        tuned_hz: stored
            .scenario(scenario.index)
            .and_then(|(_, tuned)| tuned.frequency_hz),
    };
    let Some(worst_curves) = solver.wheel(&of_worst, &worst) else {
        return not_solved("the linear limits of the worst wheel have no peak");
    };
    let Some(median_curves) = solver.wheel(&of_median, &median) else {
        return not_solved("the linear limits of the median wheel have no peak");
    };
    let tuned = solver.curve(scenario.contact, None, &worst_curves.full.frequency_hz);
    Ok(Wheels::Solved(Box::new(WheelReport {
        scenario: scenario.index,
        tuned,
        state: state(engine, &scenario, &of_worst, &worst),
        median: median_curves,
        worst: worst_curves,
    })))
}

/// Delivered rows of the median and of the largest peak amplitude; none if every row failed.
fn rows_of(
    stored: &StoredStudy,
    columns: &ScenarioColumns,
) -> Result<Option<[ResponseRow; 2]>, PipelineError> {
    let index = columns.scenario.index;
    let scenarios = stored.manifest.scenarios.len();
    // Rows are ordered by pattern, then scenario.
    let mut good: Vec<(f64, usize)> = columns
        .values(Quantity::PeakAmplitudeM)
        .iter()
        .enumerate()
        .filter_map(|(place, value)| Some(((*value)?, place * scenarios + index)))
        .collect();
    good.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let Some(&(_, worst)) = good.last() else {
        return Ok(None);
    };
    let (_, median) = good[good.len().div_ceil(2) - 1];
    let row = |place: usize| -> Result<Option<ResponseRow>, PipelineError> {
        Ok(stored.rows_at(&[place])?.pop())
    };
    Ok(row(median)?.zip(row(worst)?).map(|(a, b)| [a, b]))
}

/// Curves of the wheels of one scenario.
struct Curves<'a> {
    engine: &'a dyn Engine,
    scenario: Scenario,
    tuned_hz: Option<f64>,
}

impl Curves<'_> {
    fn wheel(&self, pattern: &Pattern, row: &ResponseRow) -> Option<WheelCurves> {
        let peak_frequency_hz = row.peak_frequency_hz?;
        let friction = matches!(self.scenario.contact, ContactCondition::Full { .. });
        // The band in which the peak was sought holds those of the linear limits.
        let plan = self
            .engine
            .search_plan(&self.scenario, pattern, self.tuned_hz);
        let (low, high) = plan.ok()?.band_hz;
        let (low, high) = (low.min(peak_frequency_hz), high.max(peak_frequency_hz));
        let frequencies = frequencies(low, high, peak_frequency_hz);
        let dense = between(&frequencies);
        let linear = |contact| friction.then(|| self.curve(contact, Some(pattern), &dense));
        let full = if friction { &frequencies } else { &dense };
        Some(WheelCurves {
            pattern: row.pattern,
            peak_amplitude_m: row.peak_amplitude_m?,
            peak_frequency_hz,
            peak_blade: row.peak_blade?,
            amplification_factor: row.amplification_factor,
            stated_error: row.stated_error,
            harmonics: row.harmonics.clone(),
            full: self.curve(self.scenario.contact, Some(pattern), full),
            stuck: linear(ContactCondition::Stuck),
            slide: linear(ContactCondition::Slide),
        })
    }

    fn curve(
        &self,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> ResponseCurve {
        let scenario = Scenario {
            contact,
            ..self.scenario
        };
        let points =
            self.engine
                .curve(&scenario, pattern, frequencies_hz, CurveSettings::default());
        let of_frequency =
            points.chunk_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz).is_eq());
        let (frequency_hz, amplitude_m) = of_frequency
            .map(|blades| {
                let largest = blades.iter().filter_map(|point| point.amplitude_m);
                (blades[0].frequency_hz, largest.reduce(f64::max))
            })
            .unzip();
        ResponseCurve {
            frequency_hz,
            amplitude_m,
        }
    }
}

/// Frequencies from `low` to `high`, closer together around `peak`, ascending.
fn frequencies(low: f64, high: f64, peak: f64) -> Vec<f64> {
    let even =
        (0..=EVEN_POINTS).map(|step| low + (high - low) * f64::from(step) / f64::from(EVEN_POINTS));
    let mut distance = (high - low) / f64::from(EVEN_POINTS);
    let mut all: Vec<f64> = even.collect();
    all.push(peak);
    for _ in 0..CLOSE_POINTS {
        all.extend([peak - distance, peak + distance]);
        distance *= CLOSER;
    }
    all.retain(|f| (low..=high).contains(f));
    all.sort_unstable_by(f64::total_cmp);
    all.dedup_by(|a, b| a.total_cmp(b).is_eq());
    all
}

/// `frequencies` with further ones between them.
fn between(frequencies: &[f64]) -> Vec<f64> {
    let mut dense: Vec<f64> = frequencies
        .windows(2)
        .flat_map(|pair| {
            (0..LINEAR_POINTS).map(move |step| {
                pair[0] + (pair[1] - pair[0]) * f64::from(step) / f64::from(LINEAR_POINTS)
            })
        })
        .collect();
    dense.extend(frequencies.last());
    dense
}

/// The wheel of a row at its peak; none where it is not found again.
fn state(
    engine: &dyn Engine,
    scenario: &Scenario,
    pattern: &Pattern,
    row: &ResponseRow,
) -> Option<WheelStateReport> {
    let solver = engine.solvers()?;
    let state = solver.wheel_state(pattern, scenario, row).ok()?;
    let sectors = state.amplitudes_m.len();
    let contact: Vec<PairReport> = state
        .contact
        .iter()
        .flatten()
        .map(|pair| PairReport {
            state: match (pair.separated, pair.slipping) {
                (true, _) => "separation",
                (false, true) => "slip",
                (false, false) => "stick",
            },
            slipping_share: pair.slipping_share,
            separated_share: pair.separated_share,
        })
        .collect();
    let entries = pattern.entries();
    let deviation_mode = entries.first().and_then(|(_, mode, _)| *mode);
    Some(WheelStateReport {
        amplitude_m: state.amplitudes_m,
        deviation: entries
            .iter()
            .filter(|(_, mode, _)| *mode == deviation_mode)
            .map(|(_, _, deviation)| *deviation)
            .collect(),
        deviation_mode,
        pairs_per_sector: contact.len() / sectors.max(1),
        contact,
    })
}
