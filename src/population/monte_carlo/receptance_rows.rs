//! Rows under one force vector on the receptances of the tuned wheel: without a basis for the contact.

use std::sync::Arc;

use super::basis_rows::BasisRows;
use super::row::MistunedPeak;
use super::{CurveResult, Scenario, TunedReference, WheelState, harmonics_name};
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, EngineRow, ErrorEstimate, FrequencyBand, PointSettings, ReceptancePeak,
    SearchPlan, TopBeside, Window, mistuned_window, receptance_curve, receptance_errors,
    receptance_peak, receptance_plan, receptance_state, receptance_top_beside, tuned_span_of,
};
use crate::response::harmonic_balance::{ContactShares, Status};
use crate::response::mistuning::Pattern;
use crate::response::receptance::{EngineWheel, ReceptanceEngine, Resonance, WaveForce};

/// Samples per period of a search with few harmonics: what it finds is only where to look.
pub(super) const SEARCH_SAMPLES: usize = 32;

/// Share of what all harmonics up to 15 change of a row beside those that led to its top that may be left beyond them: a contact force
/// that slips has a part k^-2 in harmonic k.
const LEFT_OF_CHANGE: f64 = 0.05;

/// Steps by which a top is climbed beside another solution, in half-bandwidths of a linear resonance.
const CLIMBED: f64 = 0.1;
/// Tolerance of solutions beside another one over that of the peak, and its bounds.
const BESIDE_SHARE: f64 = 0.1;
const BESIDE_TOLERANCES: (f64, f64) = (1e-6, 3e-4);

/// The receptances of a study with the excitations of one of its force vectors.
///
/// What a study says about its rows, and how contact that varies moves the resonances, is asked of the rows on the basis.
#[derive(Debug)]
pub(super) struct ReceptanceRows {
    engine: Arc<ReceptanceEngine>,
    /// The tuned wheel on it.
    tuned: EngineWheel,
    /// By engine order.
    forces: Vec<(u32, WaveForce)>,
}

impl ReceptanceRows {
    /// On `engine`, under the force vector of `model`.
    pub(super) fn new(
        engine: Arc<ReceptanceEngine>,
        model: &ReducedModel,
        engine_orders: &[u32],
        amplitude_n: f64,
    ) -> Self {
        let force = |&order: &u32| (order, WaveForce::new(model, order, amplitude_n));
        Self {
            tuned: EngineWheel::new(None, model.sectors),
            forces: engine_orders.iter().map(force).collect(),
            engine,
        }
    }

    pub(super) fn receptances(&self) -> &ReceptanceEngine {
        &self.engine
    }

    pub(super) fn force(&self, engine_order: u32) -> Option<&WaveForce> {
        let found = self.forces.iter().find(|(order, _)| *order == engine_order);
        found.map(|(_, force)| force)
    }

    /// The wheel of a pattern.
    pub(super) fn wheel(&self, pattern: &Pattern) -> EngineWheel {
        EngineWheel::new(Some(pattern), self.engine.sectors())
    }

    /// The row of `wheel`, the tuned one for none; none under an engine order without excitation.
    fn row<'a>(
        &'a self,
        wheel: Option<&'a EngineWheel>,
        engine_order: u32,
        condition: ContactCondition,
    ) -> Option<EngineRow<'a>> {
        Some(EngineRow {
            engine: &self.engine,
            wheel: wheel.unwrap_or(&self.tuned),
            force: self.force(engine_order)?,
            condition,
        })
    }

    fn tuned_limits(&self, engine_order: u32, condition: ContactCondition) -> Vec<Vec<Resonance>> {
        let Some(row) = self.row(None, engine_order, condition) else {
            return Vec::new();
        };
        let limits = condition.bounding_limits().into_iter();
        limits
            .map(|limit| row.engine.tuned_peaks(limit, row.force))
            .collect()
    }

    /// Where the peak of a wheel is sought: of the tuned one for no pattern.
    fn window(
        &self,
        basis: &BasisRows,
        pattern: Option<&Pattern>,
        (engine_order, condition): (u32, ContactCondition),
        tuned_hz: Option<f64>,
    ) -> Result<Window, Status> {
        let whole = basis.whole_window();
        let (Some(pattern), FrequencyBand::Auto) = (pattern, whole.band) else {
            return Ok(whole);
        };
        let limits = self.tuned_limits(engine_order, condition);
        let span = tuned_span_of(&limits, tuned_hz).ok_or(Status::NotBracketed)?;
        let span = basis.span_of_varied_contact(pattern, span, engine_order, condition)?;
        Ok(mistuned_window(
            span,
            pattern.largest_deviation(),
            whole.band,
        ))
    }

    /// Tuned reference of a scenario; none under an engine order without excitation.
    pub(super) fn tuned(&self, basis: &BasisRows, scenario: &Scenario) -> Option<TunedReference> {
        let (engine_order, condition) = (scenario.engine_order, scenario.contact);
        let row = self.row(None, engine_order, condition)?;
        let points = basis.points.nominal(engine_order, condition);
        let tolerance = basis.points.settings.solver.peak_tolerance;
        let window = basis.whole_window();
        let found = receptance_peak(&row, points, points.search(), window, tolerance);
        let errors = errors(&row, basis, points, &found, scenario);
        let harmonics = harmonics_name(points.harmonics());
        Some(TunedReference::of_peak(
            scenario,
            &found.peak,
            harmonics,
            errors,
        ))
    }

    /// The highest peak of the wheel of a pattern with its errors.
    pub(super) fn mistuned_peak(
        &self,
        basis: &BasisRows,
        wheel: &EngineWheel,
        (pattern, scenario): (&Pattern, &Scenario),
        tuned: &TunedReference,
    ) -> Result<MistunedPeak, Status> {
        let case = (scenario.engine_order, scenario.contact);
        let row = self.row(Some(wheel), case.0, case.1);
        let row = row.ok_or(Status::NotBracketed)?;
        let window = self.window(basis, Some(pattern), case, tuned.frequency_hz)?;
        let points = basis.points.of(pattern, case.0, case.1);
        let tolerance = basis.points.settings.solver.peak_tolerance;
        let found = receptance_peak(&row, &points, points.search(), window, tolerance);
        Ok(MistunedPeak {
            errors: errors(&row, basis, &points, &found, scenario),
            peak: found.peak,
        })
    }

    /// The top on `finer`, which has the harmonics of these rows among its own, beside the peak that these rows have at
    /// `frequency_hz`; of the tuned wheel for no pattern. None where the solutions do not settle.
    pub(super) fn top_beside(
        &self,
        basis: &BasisRows,
        finer: (&Self, &BasisRows),
        pattern: Option<&Pattern>,
        scenario: &Scenario,
        frequency_hz: f64,
    ) -> Option<TopBeside> {
        let case = (scenario.engine_order, scenario.contact);
        let wheel = pattern.map(|pattern| finer.0.wheel(pattern));
        let there = self.row(wheel.as_ref(), case.0, case.1)?;
        let here = finer.0.row(wheel.as_ref(), case.0, case.1)?;
        let window = self.window(basis, pattern, case, Some(frequency_hz));
        let envelope = receptance_plan(&there, window.ok()?).ok()?.envelope;
        let [before, points] = [basis, finer.1].map(|rows| rows.points.of(pattern, case.0, case.1));
        let (point, _) = receptance_state(&there, &before, frequency_hz).ok()?;
        let tolerance = BESIDE_SHARE * basis.points.settings.solver.peak_tolerance;
        receptance_top_beside(
            &here,
            &points,
            (&point, before.harmonics()),
            CLIMBED * envelope.linear_half_bandwidth_hz,
            tolerance.clamp(BESIDE_TOLERANCES.0, BESIDE_TOLERANCES.1),
        )
    }

    /// Amplitude of every blade at each frequency, Hz, with a residual tolerance of at least so much, of the tuned wheel for no pattern;
    /// none under an engine order without excitation.
    pub(super) fn curve(
        &self,
        basis: &BasisRows,
        (engine_order, condition): (u32, ContactCondition),
        pattern: Option<&Pattern>,
        (frequencies_hz, least_tolerance): (&[f64], f64),
    ) -> Option<Vec<CurveResult>> {
        let wheel = pattern.map(|pattern| self.wheel(pattern));
        let row = self.row(wheel.as_ref(), engine_order, condition)?;
        let points = basis.points.of(pattern, engine_order, condition);
        let curve = receptance_curve(&row, &points, frequencies_hz, least_tolerance).into_iter();
        let amplitudes = curve.map(|(hz, point)| (hz, point.map(|point| point.amplitudes_m)));
        Some(amplitudes.collect())
    }

    /// The wheel of a pattern at a frequency, Hz; none under an engine order without excitation.
    pub(super) fn wheel_state(
        &self,
        basis: &BasisRows,
        pattern: &Pattern,
        scenario: &Scenario,
        frequency_hz: f64,
    ) -> Option<Result<WheelState, Status>> {
        let wheel = self.wheel(pattern);
        let (engine_order, condition) = (scenario.engine_order, scenario.contact);
        let row = self.row(Some(&wheel), engine_order, condition)?;
        let points = basis.points.of(pattern, engine_order, condition);
        let state = receptance_state(&row, &points, frequency_hz);
        Some(state.map(|(point, contact)| WheelState {
            frequency_hz,
            contact,
            amplitudes_m: point.amplitudes_m,
        }))
    }

    /// Where the linear limits of a row say that its peak can lie, of the tuned wheel for no pattern; none under an engine order
    /// without excitation.
    pub(super) fn search_plan(
        &self,
        basis: &BasisRows,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        tuned_hz: Option<f64>,
    ) -> Option<Result<SearchPlan, Status>> {
        let wheel = pattern.map(|pattern| self.wheel(pattern));
        let case = (scenario.engine_order, scenario.contact);
        let row = self.row(wheel.as_ref(), case.0, case.1)?;
        let window = self.window(basis, pattern, case, tuned_hz);
        Some(window.and_then(|window| receptance_plan(&row, window)))
    }
}

/// What a row leaves out, of which `settings` has the points: where all harmonics were solved beside those that led to the top, what
/// is left of the wheels that judge under the same load, and not less than a share of what these harmonics brought; else by further
/// solutions.
fn errors(
    row: &EngineRow<'_>,
    basis: &BasisRows,
    settings: &PointSettings,
    found: &ReceptancePeak,
    scenario: &Scenario,
) -> Option<ErrorEstimate> {
    let peak = &found.peak;
    let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok)?;
    let points = &basis.points;
    let judged = points.choice(scenario.engine_order, scenario.contact);
    let judged = judged.and_then(|choice| choice.remainder.zip(choice.sampling));
    match (found.by_harmonics, judged) {
        (Some(_), _) if point.shares == ContactShares::default() => Some(ErrorEstimate::default()),
        // The change by harmonics beyond has no sign that a row could be corrected by.
        (Some(change), Some((remainder, sampling))) => Some(ErrorEstimate {
            sampling,
            harmonics: 0.0,
            unsettled: remainder.max(LEFT_OF_CHANGE * change.abs()) + point.residual,
        }),
        _ => receptance_errors(row, settings, point, points.settings.solver.peak_tolerance),
    }
}
