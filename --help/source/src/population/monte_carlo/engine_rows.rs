//! Rows on the receptances of the tuned wheel: without a basis for the contact.

use std::sync::Arc;

use super::row_engine::RowEngine;
use super::row_solver::MistunedPeak;
use super::{ResponseRow, RowSolver, Scenario, TunedReference, harmonics_name};
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, EngineRow, ErrorEstimate, FrequencyBand, LinearPeak, PointSettings,
    ReceptancePeak, SearchPlan, TopBeside, Window, linear_peaks_of, mistuned_window,
    receptance_curve, receptance_errors, receptance_peak, receptance_plan, receptance_state,
    receptance_top_beside, tuned_span_of,
};
use crate::response::harmonic_balance::{ContactShares, PairContact, Status, TransformError};
use crate::response::mistuning::{ContactFactors, Pattern};
use crate::response::receptance::{EngineWheel, ReceptanceEngine, WaveForce, embedded};

use super::curves::CurveResult;
use super::wheel_state::WheelState;

/// In the column `basis`.
pub const TUNED_RECEPTANCES: &str = "tuned_receptances";

/// Samples per period of a search with few harmonics: what it finds is only where to look.
const SEARCH_SAMPLES: usize = 32;

/// Share of what all harmonics up to 15 change of a row beside those that led to its top that may be left beyond them: a contact force
/// that slips has a part k^-2 in harmonic k.
const LEFT_OF_CHANGE: f64 = 0.05;

/// Steps by which a top is climbed beside another solution, in half-bandwidths of a linear resonance.
const CLIMBED: f64 = 0.1;
/// Tolerance of solutions beside another one over that of the peak, and its bounds.
const BESIDE_SHARE: f64 = 0.1;
const BESIDE_TOLERANCES: (f64, f64) = (1e-6, 3e-4);

impl RowSolver {
    /// This solver with rows that are solved on `engine`, under the force vector of `model`.
    ///
    /// # Errors
    /// If the harmonics of a search cannot be told apart.
    pub fn with_engine(
        mut self,
        engine: Arc<ReceptanceEngine>,
        model: &ReducedModel,
        engine_orders: &[u32],
    ) -> Result<Self, TransformError> {
        self.full = self.full.with_search_samples(SEARCH_SAMPLES)?;
        for (_, points) in &mut self.chosen {
            *points = points.clone().with_search_samples(SEARCH_SAMPLES)?;
        }
        let amplitude_n = self.settings.amplitude_n;
        let force = |&order: &u32| (order, WaveForce::new(model, order, amplitude_n));
        self.engine = Some(RowEngine {
            tuned: EngineWheel::new(None, model.sectors),
            forces: engine_orders.iter().map(force).collect(),
            engine,
        });
        Ok(self)
    }

    /// What rows are solved on: a basis, or the receptances of the tuned wheel.
    #[must_use]
    pub fn basis_name(&self) -> String {
        match &self.engine {
            Some(_) => TUNED_RECEPTANCES.to_owned(),
            None => self.basis().model().basis_name(),
        }
    }

    /// [`Self::basis_name`], where the whole space counts as the basis that it was made by.
    #[must_use]
    pub fn rows_on(&self) -> String {
        match &self.engine {
            Some(_) => TUNED_RECEPTANCES.to_owned(),
            None => self.basis().model().basis.to_string(),
        }
    }

    /// The row of `wheel`, the tuned one for none; none without engine.
    fn on_engine<'a>(
        &'a self,
        wheel: Option<&'a EngineWheel>,
        engine_order: u32,
        condition: ContactCondition,
    ) -> Option<EngineRow<'a>> {
        let own = self.engine.as_ref()?;
        Some(EngineRow {
            engine: &own.engine,
            wheel: wheel.unwrap_or(&own.tuned),
            force: own.force(engine_order)?,
            condition,
        })
    }

    fn tuned_limits(&self, engine_order: u32, condition: ContactCondition) -> Vec<Vec<LinearPeak>> {
        let Some(row) = self.on_engine(None, engine_order, condition) else {
            return Vec::new();
        };
        let limits = condition.bounding_limits().into_iter();
        limits
            .map(|limit| linear_peaks_of(row.engine.tuned_peaks(limit, row.force)))
            .collect()
    }

    /// Where the peak of a wheel is sought: of the tuned one for no pattern.
    fn engine_window(
        &self,
        pattern: Option<&Pattern>,
        engine_order: u32,
        condition: ContactCondition,
        tuned_hz: Option<f64>,
    ) -> Result<Window, Status> {
        let band = self.settings.solver.frequency_band;
        let (Some(pattern), FrequencyBand::Auto) = (pattern, band) else {
            return Ok(Window {
                resonances_hz: None,
                band,
            });
        };
        let limits = self.tuned_limits(engine_order, condition);
        let span = tuned_span_of(&limits, tuned_hz).ok_or(Status::NotBracketed)?;
        let span = self.span_of_varied_contact(pattern, span, engine_order, condition)?;
        Ok(mistuned_window(span, pattern.largest_deviation(), band))
    }

    /// Peak of the tuned wheel with its errors.
    pub(super) fn tuned_on_engine(&self, scenario: &Scenario) -> Option<TunedReference> {
        let solver = self.under(scenario);
        let (engine_order, condition) = (scenario.engine_order, scenario.contact);
        let row = solver.on_engine(None, engine_order, condition)?;
        let points = solver.points(engine_order, condition);
        let window = solver.engine_window(None, engine_order, condition, None);
        let found = window.map(|window| {
            let tolerance = solver.settings.solver.peak_tolerance;
            receptance_peak(&row, points, points.search(), window, tolerance)
        });
        let found = found.ok()?;
        let errors = solver.errors_on_engine(&row, points, &found, scenario);
        let found = found.peak;
        let point = found.point.as_ref().filter(|_| found.status == Status::Ok);
        Some(TunedReference {
            scenario: scenario.index,
            status: found.status,
            amplitude_m: found.amplitude_m(),
            frequency_hz: point.map(|point| point.frequency_hz),
            separated_fraction: point.map(|point| point.shares.separated),
            slipping_fraction: point.map(|point| point.shares.slipping),
            harmonics: harmonics_name(points.harmonics()),
            errors,
        })
    }

    /// What a row leaves out, of which `settings` has the points: where all harmonics were solved beside those that led to the top, what
    /// is left of the wheels that judge under the same load, and not less than a share of what these harmonics brought; else by further
    /// solutions.
    fn errors_on_engine(
        &self,
        row: &EngineRow<'_>,
        settings: &PointSettings,
        found: &ReceptancePeak,
        scenario: &Scenario,
    ) -> Option<ErrorEstimate> {
        let peak = &found.peak;
        let point = peak.point.as_ref().filter(|_| peak.status == Status::Ok)?;
        let judged = self.chosen(scenario.engine_order, scenario.contact);
        let judged = judged.and_then(|(choice, _)| choice.remainder.zip(choice.sampling));
        match (found.by_harmonics, judged) {
            (Some(_), _) if point.shares == ContactShares::default() => {
                Some(ErrorEstimate::default())
            }
            // The change by harmonics beyond has no sign that a row could be corrected by.
            (Some(change), Some((remainder, sampling))) => Some(ErrorEstimate {
                sampling,
                harmonics: 0.0,
                unsettled: remainder.max(LEFT_OF_CHANGE * change.abs()) + point.residual,
            }),
            _ => receptance_errors(row, settings, point, self.settings.solver.peak_tolerance),
        }
    }

    /// [`RowSolver::rows`] on the engine; none without one.
    pub(super) fn rows_on_engine(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Option<Vec<ResponseRow>> {
        let own = self.engine.as_ref()?;
        let wheel = Self::is_possible(pattern)
            .then(|| EngineWheel::new(Some(pattern), own.engine.sectors()));
        let rows = scenarios.iter().map(|(scenario, tuned)| {
            let solver = self.under(scenario);
            let found = match &wheel {
                Some(wheel) => solver.peak_on_engine(wheel, pattern, scenario, tuned),
                None => Err(Status::InvalidPattern),
            };
            let row = solver.row(pattern, scenario, tuned, found);
            let again = solver.solved_again(pattern, scenario, &row);
            again.unwrap_or(row)
        });
        Some(rows.collect())
    }

    fn peak_on_engine(
        &self,
        wheel: &EngineWheel,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Result<MistunedPeak, Status> {
        let (engine_order, condition) = (scenario.engine_order, scenario.contact);
        let row = self
            .on_engine(Some(wheel), engine_order, condition)
            .ok_or(Status::NotBracketed)?;
        let window =
            self.engine_window(Some(pattern), engine_order, condition, tuned.frequency_hz)?;
        let points = self.points_of(pattern, engine_order, condition);
        let tolerance = self.settings.solver.peak_tolerance;
        let found = receptance_peak(&row, &points, points.search(), window, tolerance);
        Ok(MistunedPeak {
            errors: self.errors_on_engine(&row, &points, &found, scenario),
            peak: found.peak,
        })
    }

    /// The top of this solver, which has the harmonics of `coarse` among its own, beside the peak that `coarse` found at
    /// `frequency_hz` with the set named `harmonics`; of the tuned wheel for no pattern. None without engines, or where the
    /// solutions do not settle.
    #[must_use]
    pub fn top_beside(
        &self,
        coarse: &Self,
        pattern: Option<&Pattern>,
        scenario: &Scenario,
        (frequency_hz, harmonics): (f64, &str),
    ) -> Option<TopBeside> {
        let (order, condition) = (scenario.engine_order, scenario.contact);
        let coarse = coarse.under(scenario);
        let solvers = [Some(coarse), coarse.beyond()].into_iter().flatten();
        let is_of_the_row =
            |own: &&Self| harmonics_name(own.points(order, condition).harmonics()) == harmonics;
        let coarse = { solvers }.find(is_of_the_row)?;
        let own = self.under(scenario);
        let wheel = pattern.map(|pattern| {
            let sectors = own.basis().model().sectors;
            EngineWheel::new(Some(pattern), sectors)
        });
        let there = coarse.on_engine(wheel.as_ref(), order, condition)?;
        let here = own.on_engine(wheel.as_ref(), order, condition)?;
        let window = coarse.engine_window(pattern, order, condition, Some(frequency_hz));
        let envelope = receptance_plan(&there, window.ok()?).ok()?.envelope;
        let [before, points] = [coarse, own].map(|own| own.points_of(pattern, order, condition));
        let (point, _) = receptance_state(&there, &before, frequency_hz).ok()?;
        let start = embedded(&point.solution, before.harmonics(), points.harmonics());
        let tolerance = BESIDE_SHARE * coarse.settings.solver.peak_tolerance;
        receptance_top_beside(
            &here,
            &points,
            (frequency_hz, start),
            CLIMBED * envelope.linear_half_bandwidth_hz,
            tolerance.clamp(BESIDE_TOLERANCES.0, BESIDE_TOLERANCES.1),
        )
    }

    /// [`RowSolver::curve`] on the engine; none without one.
    pub(super) fn curve_on_engine(
        &self,
        engine_order: u32,
        condition: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Option<Vec<CurveResult>> {
        let sectors = self.engine.as_ref()?.engine.sectors();
        let wheel = pattern.map(|pattern| EngineWheel::new(Some(pattern), sectors));
        let row = self.on_engine(wheel.as_ref(), engine_order, condition)?;
        let points = self.points_of(pattern, engine_order, condition);
        let curve = receptance_curve(&row, &points, frequencies_hz).into_iter();
        let amplitudes = curve.map(|(hz, point)| (hz, point.map(|point| point.amplitudes_m)));
        Some(amplitudes.collect())
    }

    /// [`RowSolver::wheel_state`] on the engine; none without one.
    pub(super) fn state_on_engine(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        frequency_hz: f64,
    ) -> Option<Result<WheelState, Status>> {
        let sectors = self.engine.as_ref()?.engine.sectors();
        let wheel = EngineWheel::new(Some(pattern), sectors);
        let row = self.on_engine(Some(&wheel), scenario.engine_order, scenario.contact)?;
        let points = self.points_of(pattern, scenario.engine_order, scenario.contact);
        let state = receptance_state(&row, &points, frequency_hz);
        Some(state.map(
            |(point, contact): (_, Option<Vec<PairContact>>)| WheelState {
                frequency_hz,
                contact,
                amplitudes_m: point.amplitudes_m,
            },
        ))
    }

    /// [`RowSolver::search_plan`] on the engine; none without one.
    pub(super) fn plan_on_engine(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        tuned_hz: Option<f64>,
    ) -> Option<Result<SearchPlan, Status>> {
        let sectors = self.engine.as_ref()?.engine.sectors();
        let wheel = pattern.map(|pattern| EngineWheel::new(Some(pattern), sectors));
        let (engine_order, condition) = (scenario.engine_order, scenario.contact);
        let row = self.on_engine(wheel.as_ref(), engine_order, condition)?;
        let window = self.engine_window(pattern, engine_order, condition, tuned_hz);
        Some(window.and_then(|window| receptance_plan(&row, window)))
    }

    /// The span of the resonances that count, with those under the mean contact of a pattern.
    fn span_of_varied_contact(
        &self,
        pattern: &Pattern,
        span: (f64, f64),
        engine_order: u32,
        condition: ContactCondition,
    ) -> Result<(f64, f64), Status> {
        let Some(means) = pattern.contact.means() else {
            return Ok(span);
        };
        let pairs = self.basis().model().contact.weights.len();
        let factors = ContactFactors::new(vec![means; pairs]);
        self.widened_by(&factors, span, engine_order, condition)
    }
}
