//! Harmonics and fixed-interface modes of a study on tuned receptances, judged by the tuned wheel and by mistuned ones.

use rayon::prelude::*;

use super::load_cases::Excitation;
use super::reduced_engine::row_settings;
use crate::model::ReducedModel;
use crate::model::cyclic::ContactGeometry;
use crate::population::monte_carlo::{HarmonicChoice, RowSettings};
use crate::response::forced_response::{
    ContactCondition, EngineRow, ErrorEstimate, Peak, Point, PointSettings, SolverOptions, Window,
    receptance_effects, receptance_errors, receptance_peak, receptance_plan, receptance_top_m,
};
use crate::response::harmonic_balance::{Status, TransformError};
use crate::response::mistuning::{ContactFactors, Pattern};
use crate::response::receptance::{EngineWheel, ReceptanceEngine, WaveForce};

/// Relative tolerance of the peaks by which harmonics are judged, at most.
const PEAK_TOLERANCE: f64 = 1e-3;
/// Relative tolerance of the solutions whose tops are compared on two engines.
const COMPARED_TOLERANCE: f64 = 1e-4;
/// Relative tolerance of the solutions that tell the effects of harmonics.
const EFFECT_TOLERANCE: f64 = 1e-4;
/// Share of the wanted tolerance that the judged wheels keep to: those of the population are more, and some of them worse.
const JUDGED_SHARE: f64 = 0.2;
/// Harmonics that are added each time that a set is not enough.
const MORE: usize = 2;
/// Times that this is done at most.
const ROUNDS: usize = 4;
/// What may be left, over the tolerance, where more harmonics leave no less.
const GOOD_ENOUGH: f64 = 2.0;
/// Harmonics that are added at once at most.
const MOST_AT_ONCE: usize = 7;
/// Distance of the points by which a top is climbed, in half-bandwidths of a linear resonance.
const NEIGHBOURS: f64 = 0.35;
/// Harmonics up to this one are taken where no wheel says which are needed.
const FIRST_HARMONICS: u32 = 5;

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

/// What the peaks of a set say of it.
struct Verdict {
    /// Whether every wheel has a peak.
    found: bool,
    /// Whether contacts separate at one of them.
    separates: bool,
    /// Largest change by harmonics outside of the set; none where it is not known of a wheel.
    remainder: Option<f64>,
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

    /// Harmonic set of every engine order and nonlinear condition: `first`, enlarged until harmonics outside of it change no judged
    /// peak by more than a share of `tolerance`; without a tolerance the set stays, and its remainder is measured.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn harmonics(
        &self,
        conditions: &[ContactCondition],
        first: &[u32],
        tolerance: Option<f64>,
    ) -> Result<Vec<HarmonicChoice>, TransformError> {
        let nonlinear = |own: &&ContactCondition| own.normal_load_n().is_some();
        let cases: Vec<(u32, ContactCondition)> = self
            .forces
            .iter()
            .flat_map(|(order, _)| {
                let conditions = conditions.iter().filter(nonlinear);
                conditions.map(|&condition| (*order, condition))
            })
            .collect();
        let choices = cases.into_par_iter().map(|case| {
            let choice = choice_of(case, first);
            match tolerance {
                None => Ok(self.judged(choice)?.0),
                Some(tolerance) => self.chosen(choice, JUDGED_SHARE * tolerance),
            }
        });
        choices.collect()
    }

    /// The choices with the harmonics that separation needs.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn admitting_separation(
        &self,
        choices: Vec<HarmonicChoice>,
    ) -> Result<Vec<HarmonicChoice>, TransformError> {
        let admitted = choices.into_par_iter().map(|mut choice| {
            if choice.admits_separation() {
                return Ok(choice);
            }
            choice.admit_separation();
            Ok(self.judged(choice)?.0)
        });
        admitted.collect()
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
            let peaks = self.peaks(&choice)?.into_iter().enumerate();
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

    /// The peak of every wheel with the harmonics of `choice`, beside the settings of its points.
    fn peaks(&self, choice: &HarmonicChoice) -> Result<Vec<JudgedPeak<'_>>, TransformError> {
        let tolerance = self.settings.solver.peak_tolerance.min(PEAK_TOLERANCE);
        let options = SolverOptions {
            peak_tolerance: tolerance,
            ..self.settings.solver.clone()
        };
        let points = self.points(&options, &choice.harmonics)?;
        let peaks = (0..self.wheels.len()).filter_map(|wheel| {
            let row = self.row(wheel, choice.engine_order, choice.contact)?;
            let points = points.with_factors(&self.wheels[wheel].1);
            let peak = receptance_peak(&row, &points, points.search(), self.window(), tolerance);
            Some((row, points, peak))
        });
        Ok(peaks.collect())
    }

    /// The set with its remainder, what else the peaks say, and these.
    fn judged(
        &self,
        mut choice: HarmonicChoice,
    ) -> Result<(HarmonicChoice, Verdict, Vec<JudgedPeak<'_>>), TransformError> {
        let mut verdict = Verdict {
            found: true,
            separates: false,
            remainder: Some(0.0),
        };
        let peaks = self.peaks(&choice)?;
        for (row, points, peak) in &peaks {
            let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok);
            let errors =
                point.and_then(|point| receptance_errors(row, points, point, PEAK_TOLERANCE));
            verdict.found &= point.is_some();
            verdict.separates |= point.is_some_and(|point| point.shares.separated > 0.0);
            let own = errors.map(|errors: ErrorEstimate| errors.harmonics.abs() + errors.unsettled);
            verdict.remainder = verdict.remainder.zip(own).map(|(a, b)| a.max(b));
        }
        choice.remainder = verdict.remainder;
        Ok((choice, verdict, peaks))
    }

    /// `choice`, enlarged by the harmonics that change one of the wheels by themselves, then by more of them, until what is left
    /// is within `tolerance`.
    fn chosen(
        &self,
        choice: HarmonicChoice,
        tolerance: f64,
    ) -> Result<HarmonicChoice, TransformError> {
        let (mut choice, mut verdict, peaks) = self.judged(choice)?;
        let mut best = (choice.clone(), verdict.left_out(&choice));
        if best.1 <= tolerance {
            return Ok(choice);
        }
        let mut effects = effects(&peaks, &choice);
        let mut wanted = effects
            .iter()
            .filter(|own| own.1 > tolerance)
            .count()
            .clamp(1, MOST_AT_ONCE);
        for _ in 0..ROUNDS {
            if effects.is_empty() {
                break;
            }
            if verdict.separates {
                choice.admit_separation();
            }
            for (harmonic, _) in effects.drain(..wanted.min(effects.len())) {
                add(&mut choice, harmonic);
            }
            wanted = MORE;
            (choice, verdict, _) = self.judged(choice)?;
            let left_out = verdict.left_out(&choice);
            let better = left_out < best.1;
            if better {
                best = (choice.clone(), left_out);
            }
            // Where more harmonics no longer help, they only cost, most of all where contacts separate.
            let good_enough = best.1 <= GOOD_ENOUGH * tolerance && !better;
            if left_out <= tolerance || !verdict.found || good_enough {
                break;
            }
        }
        if best.1.is_infinite() && verdict.separates {
            best.0.admit_separation();
        }
        Ok(best.0)
    }
}

/// The harmonics outside of `choice` with the largest effect that each has on one of the wheels, the largest first.
fn effects(peaks: &[JudgedPeak<'_>], choice: &HarmonicChoice) -> Vec<(u32, f64)> {
    let mut effects: Vec<(u32, f64)> = Vec::new();
    for (row, points, peak) in peaks {
        let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok);
        let own = point.and_then(|point| receptance_effects(row, points, point, EFFECT_TOLERANCE));
        for (k, effect) in own.into_iter().flatten() {
            match effects.iter_mut().find(|known| known.0 == k) {
                Some(known) => known.1 = known.1.max(effect),
                None => effects.push((k, effect)),
            }
        }
    }
    if effects.is_empty() {
        let all = peaks.iter().take(1);
        let all = all.flat_map(|(_, points, _)| points.errors().harmonics().iter().copied());
        let first = all.filter(|k| *k <= FIRST_HARMONICS && !choice.harmonics.contains(k));
        effects = first.map(|k| (k, f64::INFINITY)).collect();
    }
    effects.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    effects
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

impl Verdict {
    /// What a set leaves out; more than anything else where a wheel has no peak, or contacts separate and it lacks what that needs.
    fn left_out(&self, choice: &HarmonicChoice) -> f64 {
        let lacks_separation = self.separates && !choice.admits_separation();
        self.remainder
            .filter(|_| self.found && !lacks_separation)
            .unwrap_or(f64::INFINITY)
    }
}

/// A set not yet judged.
fn choice_of(
    (engine_order, contact): (u32, ContactCondition),
    harmonics: &[u32],
) -> HarmonicChoice {
    HarmonicChoice {
        engine_order,
        contact,
        harmonics: harmonics.to_vec(),
        remainder: None,
    }
}

fn add(choice: &mut HarmonicChoice, harmonic: u32) {
    choice.harmonics.push(harmonic);
    choice.harmonics.sort_unstable();
    choice.harmonics.dedup();
}
