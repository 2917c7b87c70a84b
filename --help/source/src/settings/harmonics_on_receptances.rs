//! Harmonics and fixed-interface modes of a study on tuned receptances, judged by the tuned wheel and by mistuned ones.

use rayon::prelude::*;

use super::row_settings::row_settings;
use crate::model::ReducedModel;
use crate::model::cyclic::ContactGeometry;
use crate::population::monte_carlo::{HarmonicChoice, RowSettings};
use crate::response::forced_response::{
    ContactCondition, EngineRow, ErrorEstimate, Peak, Point, PointSettings, SolverOptions, Window,
    receptance_errors, receptance_peak, receptance_plan, receptance_top_m,
};
use crate::response::harmonic_balance::{Status, TransformError};
use crate::response::mistuning::{ContactFactors, Pattern};
use crate::response::receptance::{EngineWheel, ReceptanceEngine, WaveForce};
use crate::study::Excitation;

/// Relative tolerance of the peaks by which harmonics are judged, at most.
const PEAK_TOLERANCE: f64 = 1e-3;
/// Relative tolerance of the solutions whose tops are compared on two engines.
const COMPARED_TOLERANCE: f64 = 1e-4;
/// Distance of the points by which a top is climbed, in half-bandwidths of a linear resonance.
const NEIGHBOURS: f64 = 0.35;

/// The wheels that judge under one force vector, on one engine.
pub(super) struct Judges<'a> {
    engine: &'a ReceptanceEngine,
    settings: RowSettings,
    forces: Vec<(u32, WaveForce)>,
    geometry: ContactGeometry,
    /// The tuned wheel first.
    wheels: Vec<(EngineWheel, ContactFactors)>,
}

/// A judged row, the settings of its points, and its peak.
type JudgedPeak<'a> = (EngineRow<'a>, PointSettings, Peak);

/// The top of a judged row, to be compared with that of the same wheel on another engine.
pub(super) struct JudgedTop {
    /// Wheel, engine order and condition.
    of: (usize, u32, ContactCondition),
    points: PointSettings,
    point: Point,
    step_hz: f64,
    amplitude_m: f64,
}

impl<'a> Judges<'a> {
    /// The tuned wheel and those of `patterns` under `excitation` on an engine made of `model`.
    pub(super) fn new(
        engine: &'a ReceptanceEngine,
        model: &ReducedModel,
        excitation: &Excitation,
        patterns: &[Pattern],
    ) -> Self {
        let study = &excitation.study;
        let own = excitation.of(model);
        let force = |&order: &u32| (order, WaveForce::new(&own, order, study.amplitude_n));
        let tuned = (
            EngineWheel::new(None, model.sectors),
            ContactFactors::default(),
        );
        let mistuned = patterns.iter().map(|pattern| {
            let wheel = EngineWheel::new(Some(pattern), model.sectors);
            (wheel, pattern.contact.clone())
        });
        Self {
            engine,
            settings: row_settings(study),
            forces: study.engine_orders.iter().map(force).collect(),
            geometry: model.contact.clone(),
            wheels: std::iter::once(tuned).chain(mistuned).collect(),
        }
    }

    /// `set` under every engine order and nonlinear condition, or `reserve` where a wheel has no peak with the set; with what it leaves
    /// out of the peaks of these wheels.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn harmonics(
        &self,
        conditions: &[ContactCondition],
        set: &[u32],
        reserve: Option<&[u32]>,
    ) -> Result<Vec<HarmonicChoice>, TransformError> {
        let nonlinear = |own: &&ContactCondition| own.normal_load_n().is_some();
        let conditions: Vec<ContactCondition> =
            conditions.iter().filter(nonlinear).copied().collect();
        let cases: Vec<(u32, ContactCondition)> = self
            .forces
            .iter()
            .flat_map(|(order, _)| conditions.iter().map(|&condition| (*order, condition)))
            .collect();
        let judged = cases.into_par_iter().map(|case| {
            let (choice, found) = self.judged(choice_of(case, set), reserve.is_some())?;
            match reserve.filter(|_| !found) {
                Some(reserve) => Ok(self.judged(choice_of(case, reserve), false)?.0),
                None => Ok(choice),
            }
        });
        judged.collect()
    }

    /// The peaks of these wheels with their harmonics, under some of `conditions`.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn judged_tops(
        &self,
        conditions: &[ContactCondition],
        sets: &[HarmonicChoice],
    ) -> Result<Vec<JudgedTop>, TransformError> {
        let mut choices = Vec::new();
        for &(order, _) in &self.forces {
            for condition in spread(conditions) {
                let own =
                    |set: &&HarmonicChoice| set.engine_order == order && set.contact == condition;
                let known = sets.iter().find(own).cloned();
                choices.push(known.unwrap_or_else(|| choice_of((order, condition), &[1])));
            }
        }
        let tops = choices.into_par_iter().map(|choice| {
            let peaks = self.peaks(&choice, false)?.into_iter().enumerate();
            let tops = peaks.filter_map(|(wheel, own)| self.top_of(own, wheel, &choice));
            Ok(tops.collect())
        });
        let tops: Vec<Vec<JudgedTop>> = tops.collect::<Result<_, TransformError>>()?;
        Ok(tops.into_iter().flatten().collect())
    }

    /// The top at a peak by the points that it is climbed by on other engines; none where there is none.
    fn top_of(
        &self,
        (row, points, peak): JudgedPeak<'_>,
        wheel: usize,
        choice: &HarmonicChoice,
    ) -> Option<JudgedTop> {
        let point = peak.point.filter(|_| peak.status == Status::Ok)?;
        let envelope = receptance_plan(&row, self.window()).ok()?.envelope;
        let step_hz = NEIGHBOURS * envelope.linear_half_bandwidth_hz;
        Some(JudgedTop {
            of: (wheel, choice.engine_order, choice.contact),
            amplitude_m: receptance_top_m(&row, &points, &point, step_hz, COMPARED_TOLERANCE)?,
            points,
            point,
            step_hz,
        })
    }

    /// Largest relative change of `tops` of other wheels to those of these, the same ones on another engine, each climbed from where it
    /// was found; none where no top is found on both.
    pub(super) fn change(&self, tops: &[JudgedTop]) -> Option<f64> {
        let change = |own: &JudgedTop| {
            let (wheel, engine_order, condition) = own.of;
            let row = self.row(wheel, engine_order, condition)?;
            let top_m = receptance_top_m(
                &row,
                &own.points,
                &own.point,
                own.step_hz,
                COMPARED_TOLERANCE,
            );
            Some((top_m? / own.amplitude_m - 1.0).abs())
        };
        let changes: Vec<Option<f64>> = tops.par_iter().map(change).collect();
        changes.into_iter().flatten().reduce(f64::max)
    }

    fn row(
        &self,
        wheel: usize,
        engine_order: u32,
        condition: ContactCondition,
    ) -> Option<EngineRow<'_>> {
        let force = self
            .forces
            .iter()
            .find(|(order, _)| *order == engine_order)?;
        Some(EngineRow {
            engine: self.engine,
            wheel: &self.wheels[wheel].0,
            force: &force.1,
            condition,
        })
    }

    /// Settings of the points of rows with the harmonics `set`.
    fn points(
        &self,
        options: &SolverOptions,
        set: &[u32],
    ) -> Result<PointSettings, TransformError> {
        PointSettings::new(options, set, self.settings.contact, self.geometry.clone())
    }

    fn window(&self) -> Window {
        Window {
            resonances_hz: None,
            band: self.settings.solver.frequency_band,
        }
    }

    /// The peak of every wheel with the harmonics of `choice`, beside the settings of its points; up to the first that has none where that
    /// is enough to know.
    fn peaks(
        &self,
        choice: &HarmonicChoice,
        ends_where_lost: bool,
    ) -> Result<Vec<JudgedPeak<'_>>, TransformError> {
        let tolerance = self.settings.solver.peak_tolerance.min(PEAK_TOLERANCE);
        let options = SolverOptions {
            peak_tolerance: tolerance,
            ..self.settings.solver.clone()
        };
        let points = self.points(&options, &choice.harmonics)?;
        let mut peaks = Vec::new();
        for (wheel, (_, factors)) in self.wheels.iter().enumerate() {
            let Some(row) = self.row(wheel, choice.engine_order, choice.contact) else {
                continue;
            };
            let points = points.with_factors(factors);
            let found = receptance_peak(&row, &points, points.search(), self.window(), tolerance);
            let is_lost = found.peak.status != Status::Ok;
            peaks.push((row, points, found.peak));
            if is_lost && ends_where_lost {
                break;
            }
        }
        Ok(peaks)
    }

    /// The set with what it leaves out of these wheels, none where that is not known of one of them; and whether all have a peak.
    fn judged(
        &self,
        choice: HarmonicChoice,
        has_reserve: bool,
    ) -> Result<(HarmonicChoice, bool), TransformError> {
        let peaks = self.peaks(&choice, has_reserve)?;
        let found = peaks.iter().all(|(.., peak)| peak.status == Status::Ok);
        let errors = peaks.into_iter().map(|(row, points, peak)| {
            let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok)?;
            receptance_errors(&row, &points, point, PEAK_TOLERANCE)
        });
        let errors: Option<Vec<ErrorEstimate>> = errors.collect();
        let largest = |of: fn(&ErrorEstimate) -> f64| {
            let errors = errors.as_ref()?.iter();
            Some(errors.map(of).fold(0.0, f64::max))
        };
        let judged = HarmonicChoice {
            remainder: largest(|own| own.harmonics.abs() + own.unsettled),
            sampling: largest(|own| own.sampling.abs()),
            ..choice
        };
        Ok((judged, found))
    }
}

/// The linear limits, and of the loads the lowest, one in the middle and the highest.
fn spread(conditions: &[ContactCondition]) -> Vec<ContactCondition> {
    let is_linear = |own: &&ContactCondition| own.normal_load_n().is_none();
    let mut spread: Vec<ContactCondition> = conditions.iter().filter(is_linear).copied().collect();
    let loads = conditions.iter().filter(|own| !is_linear(own));
    let loads: Vec<ContactCondition> = loads.copied().collect();
    let places = [0, loads.len() / 2, loads.len().saturating_sub(1)];
    for place in places {
        if let Some(own) = loads.get(place).filter(|own| !spread.contains(own)) {
            spread.push(*own);
        }
    }
    spread
}

/// A set not yet judged.
pub(super) fn choice_of(
    (engine_order, contact): (u32, ContactCondition),
    harmonics: &[u32],
) -> HarmonicChoice {
    HarmonicChoice {
        engine_order,
        contact,
        harmonics: harmonics.to_vec(),
        remainder: None,
        sampling: None,
    }
}
