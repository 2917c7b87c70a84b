//! The judgement of harmonics and models on tuned receptances by the tuned wheel and mistuned ones: which loads have fewer
//! harmonics, and what is left out.
//!
//! The set that is judged is chosen in `reduced_study.rs`.

use rayon::prelude::*;

use super::progress::{Progress, Steps};
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

/// The mistuned wheels that judge, and who is told how far they are.
#[derive(Clone, Copy)]
pub(super) struct JudgingWheels<'a> {
    pub(super) patterns: &'a [Pattern],
    pub(super) progress: &'a dyn Progress,
}

/// The wheels that judge under one force vector, on one engine.
pub(super) struct Judges<'a> {
    engine: &'a ReceptanceEngine,
    settings: RowSettings,
    forces: Vec<(u32, WaveForce)>,
    geometry: ContactGeometry,
    /// The tuned wheel first.
    wheels: Vec<(EngineWheel, ContactFactors)>,
    progress: &'a dyn Progress,
}

/// A judged row, the settings of its points, and its peak.
type JudgedPeak<'a> = (EngineRow<'a>, PointSettings, Peak);

/// A set of harmonics with what it leaves out, and the peaks of the wheels by which that was found.
pub(super) struct JudgedSet<'a> {
    pub(super) choice: HarmonicChoice,
    peaks: Vec<JudgedPeak<'a>>,
}

/// What a top is of beside its wheel: engine order and condition.
pub(super) type TopOf = (u32, ContactCondition);

/// The top of a judged row, to be compared with that of the same wheel on another engine.
pub(super) struct JudgedTop {
    wheel: usize,
    of: TopOf,
    points: PointSettings,
    point: Point,
    step_hz: f64,
    amplitude_m: f64,
}

impl<'a> Judges<'a> {
    /// The tuned wheel and the mistuned `wheels` under `excitation` on an engine made of `model`.
    pub(super) fn new(
        engine: &'a ReceptanceEngine,
        model: &ReducedModel,
        excitation: &Excitation,
        wheels: JudgingWheels<'a>,
    ) -> Self {
        let study = &excitation.study;
        let loaded_model = excitation.of(model);
        let force = |&order: &u32| {
            (
                order,
                WaveForce::new(&loaded_model, order, study.amplitude_n),
            )
        };
        let tuned = (
            EngineWheel::new(None, model.sectors),
            ContactFactors::default(),
        );
        let mistuned = wheels.patterns.iter().map(|pattern| {
            let wheel = EngineWheel::new(Some(pattern), model.sectors);
            (wheel, pattern.contact.clone())
        });
        Self {
            engine,
            settings: row_settings(study),
            forces: study.engine_orders.iter().map(force).collect(),
            geometry: model.contact.clone(),
            wheels: std::iter::once(tuned).chain(mistuned).collect(),
            progress: wheels.progress,
        }
    }

    /// The first of `sets` under every engine order and nonlinear condition, or the next one where a wheel has no peak with it, and so on
    /// to the last one; with what it leaves out of the peaks of these wheels.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn harmonics(
        &self,
        conditions: &[ContactCondition],
        sets: &[Vec<u32>],
    ) -> Result<Vec<JudgedSet<'_>>, TransformError> {
        let nonlinear = |condition: &&ContactCondition| condition.normal_load_n().is_some();
        let conditions: Vec<ContactCondition> =
            conditions.iter().filter(nonlinear).copied().collect();
        let cases: Vec<(u32, ContactCondition)> = self
            .forces
            .iter()
            .flat_map(|(order, _)| conditions.iter().map(|&condition| (*order, condition)))
            .collect();
        let steps = Steps::new(
            self.progress,
            "choosing the harmonics",
            "loads",
            cases.len(),
        );
        let judged = cases.into_par_iter().map(|case| {
            let last = sets.len() - 1;
            let mut judged = self.judged(choice_of(case, &sets[0]), last > 0)?;
            for (place, fewer) in sets.iter().enumerate().skip(1) {
                if judged.lacks_a_peak() {
                    judged = self.judged(choice_of(case, fewer), place < last)?;
                }
            }
            steps.done();
            Ok(judged)
        });
        judged.collect()
    }

    /// The peaks of these wheels with harmonics that were chosen before, on another engine.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn with_sets(
        &self,
        sets: Vec<HarmonicChoice>,
    ) -> Result<Vec<JudgedSet<'_>>, TransformError> {
        let steps = Steps::new(
            self.progress,
            "peaks that judge the model",
            "loads",
            sets.len(),
        );
        let judged = sets.into_par_iter().map(|choice| {
            let peaks = self.peaks(&choice, false)?;
            steps.done();
            Ok(JudgedSet { choice, peaks })
        });
        judged.collect()
    }

    /// The tops of these wheels with their harmonics, and under the linear limits among `conditions`.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn judged_tops(
        &self,
        conditions: &[ContactCondition],
        sets: &[JudgedSet<'_>],
    ) -> Result<Vec<JudgedTop>, TransformError> {
        let is_linear = |condition: &&ContactCondition| condition.normal_load_n().is_none();
        let linear: Vec<ContactCondition> = conditions.iter().filter(is_linear).copied().collect();
        let orders = self.forces.iter().map(|(order, _)| *order);
        let limits = orders.flat_map(|order| linear.iter().map(move |&limit| (order, limit)));
        let limits = self.with_sets(limits.map(|case| choice_of(case, &[1])).collect())?;
        let peaks = limits.iter().chain(sets).flat_map(|set| {
            let peaks = set.peaks.iter().enumerate();
            peaks.map(move |(wheel, peak)| (wheel, peak, &set.choice))
        });
        let peaks: Vec<(usize, &JudgedPeak<'_>, &HarmonicChoice)> = peaks.collect();
        let steps = Steps::new(
            self.progress,
            "tops that judge the model",
            "peaks",
            peaks.len(),
        );
        let tops = peaks.into_par_iter();
        let tops = tops.filter_map(|(wheel, peak, choice)| {
            let top = self.top_of(peak, wheel, choice);
            steps.done();
            top
        });
        Ok(tops.collect())
    }

    /// The top at a peak by the points that it is climbed by on other engines; none where there is none.
    fn top_of(
        &self,
        (row, points, peak): &JudgedPeak<'_>,
        wheel: usize,
        choice: &HarmonicChoice,
    ) -> Option<JudgedTop> {
        let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok)?;
        let envelope = receptance_plan(row, self.window()).ok()?.envelope;
        let step_hz = NEIGHBOURS * envelope.linear_half_bandwidth_hz;
        Some(JudgedTop {
            wheel,
            of: (choice.engine_order, choice.contact),
            amplitude_m: receptance_top_m(row, points, point, step_hz, COMPARED_TOLERANCE)?,
            points: points.clone(),
            point: point.clone(),
            step_hz,
        })
    }

    /// Relative changes of `tops` of other wheels to those of these, the same ones on another engine, each climbed from where it was
    /// found; of those that are found on both.
    pub(super) fn changes(&self, tops: &[JudgedTop]) -> Vec<(TopOf, f64)> {
        let what = "judging modes and shapes of the model";
        let steps = Steps::new(self.progress, what, "peaks", tops.len());
        let change = |top: &JudgedTop| {
            let (engine_order, condition) = top.of;
            let row = self.row(top.wheel, engine_order, condition)?;
            let top_m = receptance_top_m(
                &row,
                &top.points,
                &top.point,
                top.step_hz,
                COMPARED_TOLERANCE,
            );
            steps.done();
            Some((top.of, (top_m? / top.amplitude_m - 1.0).abs()))
        };
        tops.par_iter().filter_map(change).collect()
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

    /// The set with what it leaves out of these wheels, none where that is not known of one of them.
    fn judged(
        &self,
        choice: HarmonicChoice,
        fewer_follow: bool,
    ) -> Result<JudgedSet<'_>, TransformError> {
        let peaks = self.peaks(&choice, fewer_follow)?;
        let errors = peaks.iter().map(|(row, points, peak)| {
            let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok)?;
            receptance_errors(row, points, point, PEAK_TOLERANCE)
        });
        let errors: Option<Vec<ErrorEstimate>> = errors.collect();
        let largest = |of: fn(&ErrorEstimate) -> f64| {
            let errors = errors.as_ref()?.iter();
            Some(errors.map(of).fold(0.0, f64::max))
        };
        let choice = HarmonicChoice {
            remainder: largest(|estimate| estimate.harmonics.abs() + estimate.unsettled),
            sampling: largest(|estimate| estimate.sampling.abs()),
            ..choice
        };
        Ok(JudgedSet { choice, peaks })
    }
}

impl JudgedSet<'_> {
    /// Whether a wheel has no peak with the set.
    fn lacks_a_peak(&self) -> bool {
        { self.peaks.iter() }.any(|(.., peak)| peak.status != Status::Ok)
    }
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
        reduced_model: None,
    }
}
