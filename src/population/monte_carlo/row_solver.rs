//! Rows under one force vector on one reduced model: on its basis, or on the receptances of the tuned wheel.

use std::sync::Arc;

use super::basis_rows::BasisRows;
use super::receptance_rows::{ReceptanceRows, SEARCH_SAMPLES};
use super::row::MistunedPeak;
use super::{
    CurveResult, HARMONIC_SAFETY, HARMONIC_SAFETY_ON_RECEPTANCES, HarmonicChoice, ResponseRow,
    RowSettings, Scenario, ScenarioError, TunedReference, WheelState, amplification_factor,
    harmonics_name, stated_error,
};
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, LimitsWanted, Peak, Point, PointSettings, ResponseTrace, Screening,
    SearchPlan, TopBeside, Wheel,
};
use crate::response::harmonic_balance::{Status, TransformError};
use crate::response::mistuning::{Pattern, StructuralModes, WheelBasis};
use crate::response::receptance::{EngineWheel, ReceptanceEngine};

/// In the column `basis`.
pub const TUNED_RECEPTANCES: &str = "tuned_receptances";

/// Solves rows under one force vector on one reduced model; shared between threads.
#[derive(Debug)]
pub struct RowSolver {
    pub(super) on_basis: BasisRows,
    /// What rows are solved on in the place of the basis.
    pub(super) on_receptances: Option<ReceptanceRows>,
    /// Whether these receptances are those of the basis, and not of all contact degrees of freedom.
    is_on_basis: bool,
    basis_error: f64,
}

/// A mistuned wheel as its rows are solved on it.
pub(super) enum MistunedWheel {
    InModes(Box<(StructuralModes, Wheel)>),
    OnReceptances(Box<EngineWheel>),
}

impl RowSolver {
    /// A solver for `model`.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub fn new(model: Arc<ReducedModel>, settings: RowSettings) -> Result<Self, TransformError> {
        Ok(Self {
            on_basis: BasisRows::new(model, settings)?,
            on_receptances: None,
            is_on_basis: false,
            basis_error: 0.0,
        })
    }

    /// This solver with the harmonic sets chosen for its scenarios, and the measured error of its basis.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub fn with_choices(
        mut self,
        choices: Vec<HarmonicChoice>,
        basis_error: f64,
    ) -> Result<Self, TransformError> {
        let BasisRows { basis, points } = &mut self.on_basis;
        points.choose(choices, basis.model())?;
        self.basis_error = basis_error;
        Ok(self)
    }

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
        let points = &mut self.on_basis.points;
        let rows = model.contact.row_count();
        points.search_on_receptances((SEARCH_SAMPLES, self.is_on_basis), (model.sectors, rows))?;
        let amplitude_n = points.settings.amplitude_n;
        let rows = ReceptanceRows::new(engine, model, engine_orders, amplitude_n);
        self.on_receptances = Some(rows);
        Ok(self)
    }

    /// [`Self::with_engine`] of the basis itself: rows have the coordinates of the basis, and what it leaves out.
    ///
    /// # Errors
    /// If the harmonics of a search cannot be told apart.
    pub fn with_engine_of_basis(
        mut self,
        engine: Arc<ReceptanceEngine>,
        model: &ReducedModel,
        engine_orders: &[u32],
    ) -> Result<Self, TransformError> {
        self.is_on_basis = true;
        self.with_engine(engine, model, engine_orders)
    }

    /// The wheel's coordinates.
    #[must_use]
    pub fn basis(&self) -> &WheelBasis {
        &self.on_basis.basis
    }

    pub(super) fn settings(&self) -> &RowSettings {
        &self.on_basis.points.settings
    }

    /// The settings of a point of the tuned wheel.
    pub(super) fn points(&self, scenario: &Scenario) -> &PointSettings {
        let points = &self.on_basis.points;
        points.nominal(scenario.engine_order, scenario.contact)
    }

    /// Harmonic sets chosen for single scenarios.
    pub fn choices(&self) -> impl Iterator<Item = &HarmonicChoice> {
        self.on_basis.points.choices()
    }

    /// Whether rows have the receptances of the tuned wheel with all its contact degrees of freedom, and leave out no basis.
    pub(super) fn has_all_receptances(&self) -> bool {
        self.on_receptances.is_some() && !self.is_on_basis
    }

    /// Whether rows are solved on the very receptances of `other`, or both on none.
    pub(super) fn has_receptances_of(&self, other: &Self) -> bool {
        match (&self.on_receptances, &other.on_receptances) {
            (Some(own), Some(other)) => std::ptr::eq(own.receptances(), other.receptances()),
            (own, other) => own.is_none() && other.is_none(),
        }
    }

    /// What rows are solved on: a basis, or the receptances of the tuned wheel.
    #[must_use]
    pub fn basis_name(&self) -> String {
        if self.has_all_receptances() {
            TUNED_RECEPTANCES.to_owned()
        } else {
            self.basis().model().basis_name()
        }
    }

    /// [`Self::basis_name`], where the whole space counts as the basis that it was made by.
    #[must_use]
    pub fn rows_on(&self) -> String {
        if self.has_all_receptances() {
            TUNED_RECEPTANCES.to_owned()
        } else {
            self.basis().model().basis.to_string()
        }
    }

    /// Peak of the tuned wheel on the basis, by one sector.
    #[must_use]
    pub fn tuned_peak(&self, engine_order: u32, contact: ContactCondition) -> Peak {
        self.on_basis.tuned_peak(engine_order, contact)
    }

    /// [`Self::tuned_peak`] with its errors and the effects of the harmonics left out; none where there is no peak, or it cannot
    /// be corrected.
    #[must_use]
    pub fn tuned_screening(
        &self,
        engine_order: u32,
        contact: ContactCondition,
    ) -> (Peak, Option<Screening>) {
        self.on_basis.tuned_screening(engine_order, contact)
    }

    /// Tuned reference of a scenario.
    #[must_use]
    pub fn tuned(&self, scenario: &Scenario) -> TunedReference {
        let on_receptances = self.on_receptances.as_ref();
        let tuned = on_receptances.and_then(|rows| rows.tuned(&self.on_basis, scenario));
        tuned.unwrap_or_else(|| self.on_basis.tuned(scenario))
    }

    /// The wheel with a pattern applied, for the rows of these scenarios.
    ///
    /// # Errors
    /// The status of a pattern that cannot be applied.
    pub(super) fn mistuned(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Result<MistunedWheel, Status> {
        if !pattern.is_possible() {
            return Err(Status::InvalidPattern);
        }
        if let Some(rows) = &self.on_receptances {
            let wheel = Box::new(rows.wheel(pattern));
            return Ok(MistunedWheel::OnReceptances(wheel));
        }
        let conditions: Vec<ContactCondition> = scenarios
            .iter()
            .map(|(scenario, _)| scenario.contact)
            .collect();
        let limits = LimitsWanted::of(&conditions);
        let wheel = self.on_basis.mistuned(pattern, limits)?;
        Ok(MistunedWheel::InModes(Box::new(wheel)))
    }

    /// Rows of one pattern under several scenarios of one standard deviation, in their order. The
    /// projected stiffness, its modes and the modes of the linear limits are found once.
    #[must_use]
    pub fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        let wheel = self.mistuned(pattern, scenarios);
        scenarios
            .iter()
            .map(|(scenario, tuned)| self.row(&wheel, pattern, scenario, tuned))
            .collect()
    }

    /// The row of a wheel with a pattern applied, which is the same under every force vector.
    pub(super) fn row(
        &self,
        wheel: &Result<MistunedWheel, Status>,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> ResponseRow {
        let found = match wheel {
            Ok(wheel) => self.mistuned_peak(wheel, pattern, scenario, tuned),
            Err(status) => Err(*status),
        };
        self.row_of(pattern, scenario, tuned, found)
    }

    fn mistuned_peak(
        &self,
        wheel: &MistunedWheel,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Result<MistunedPeak, Status> {
        match (wheel, &self.on_receptances) {
            (MistunedWheel::OnReceptances(wheel), Some(rows)) => {
                rows.mistuned_peak(&self.on_basis, wheel, (pattern, scenario), tuned)
            }
            (MistunedWheel::InModes(wheel), _) => {
                self.on_basis.mistuned_peak(wheel, pattern, scenario, tuned)
            }
            // The solvers of a study are all on receptances, or none of them is.
            (MistunedWheel::OnReceptances(_), None) => Err(Status::NotBracketed),
        }
    }

    /// Amplitude of every blade at each frequency, Hz; no pattern means the tuned wheel, of which
    /// one sector stands for all.
    ///
    /// # Errors
    /// The status of a pattern that cannot be applied.
    pub fn curve(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<Vec<CurveResult>, Status> {
        self.curve_within(engine_order, contact, pattern, frequencies_hz, 0.0)
    }

    /// [`Self::curve`] with a residual tolerance of at least `least_tolerance`.
    ///
    /// # Errors
    /// The status of a pattern that cannot be applied.
    pub fn curve_within(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
        least_tolerance: f64,
    ) -> Result<Vec<CurveResult>, Status> {
        if pattern.is_some_and(|pattern| !pattern.is_possible()) {
            return Err(Status::InvalidPattern);
        }
        let case = (engine_order, contact);
        let on_receptances = self.on_receptances.as_ref();
        let points = (frequencies_hz, least_tolerance);
        match on_receptances.and_then(|rows| rows.curve(&self.on_basis, case, pattern, points)) {
            Some(curve) => Ok(curve),
            None => self
                .on_basis
                .curve(engine_order, contact, pattern, frequencies_hz),
        }
    }

    /// The curve between the first and the last frequency, followed on the basis upwards and downwards with the
    /// frequencies, Hz, ascending, solved for exactly; no pattern means the tuned wheel.
    ///
    /// # Errors
    /// The status of a pattern that cannot be applied.
    pub fn traces(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<[ResponseTrace; 2], Status> {
        self.on_basis
            .traces(engine_order, contact, pattern, frequencies_hz)
    }

    /// Where the linear limits of a row say that its peak can lie; no pattern means the tuned wheel.
    /// `tuned_hz` is the frequency of the tuned peak.
    ///
    /// # Errors
    /// The pattern cannot be applied, or nothing answers the excitation.
    pub fn search_plan(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        tuned_hz: Option<f64>,
    ) -> Result<SearchPlan, Status> {
        let on_receptances = self.on_receptances.as_ref();
        on_receptances
            .and_then(|rows| rows.search_plan(&self.on_basis, scenario, pattern, tuned_hz))
            .unwrap_or_else(|| self.on_basis.search_plan(scenario, pattern, tuned_hz))
    }

    /// The wheel of a pattern at a frequency, Hz.
    ///
    /// # Errors
    /// The status of a pattern that cannot be applied, or of the solution.
    pub(super) fn wheel_state(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        frequency_hz: f64,
    ) -> Result<WheelState, Status> {
        let on_receptances = self.on_receptances.as_ref();
        on_receptances
            .and_then(|rows| rows.wheel_state(&self.on_basis, pattern, scenario, frequency_hz))
            .unwrap_or_else(|| self.on_basis.wheel_state(pattern, scenario, frequency_hz))
    }

    /// The top on this solver, which has the harmonics of `coarse` among its own, beside the peak that `coarse` has at
    /// `frequency_hz`; of the tuned wheel for no pattern. None where rows are not on receptances, or where the solutions do not
    /// settle.
    pub(super) fn top_beside(
        &self,
        coarse: &Self,
        pattern: Option<&Pattern>,
        scenario: &Scenario,
        frequency_hz: f64,
    ) -> Option<TopBeside> {
        let finer = (self.on_receptances.as_ref()?, &self.on_basis);
        let rows = coarse.on_receptances.as_ref()?;
        rows.top_beside(&coarse.on_basis, finer, pattern, scenario, frequency_hz)
    }

    /// What the basis or the reduced model leaves out of the rows of a scenario.
    #[must_use]
    pub fn model_error(&self, scenario: &Scenario) -> f64 {
        let points = &self.on_basis.points;
        let choice = points.choice(scenario.engine_order, scenario.contact);
        let error = choice.and_then(|choice| choice.reduced_model);
        error.unwrap_or(self.basis_error)
    }

    /// Errors that the rows of a scenario take over from it; a linear limit has no harmonics.
    fn scenario_error(&self, scenario: &Scenario) -> ScenarioError {
        let points = &self.on_basis.points;
        let choice = points.choice(scenario.engine_order, scenario.contact);
        ScenarioError {
            basis: self.model_error(scenario),
            // A remainder that could not be measured bounds nothing, but rows on tuned receptances are asked themselves.
            harmonics: match choice.map(|choice| choice.remainder) {
                Some(None) if !self.has_all_receptances() => f64::INFINITY,
                Some(remainder) => remainder.unwrap_or(0.0),
                None => 0.0,
            },
        }
    }

    /// The row of what was found of a peak.
    fn row_of(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
        found: Result<MistunedPeak, Status>,
    ) -> ResponseRow {
        let (status, found, errors) = match found {
            Ok(found) => (found.peak.status, Some(found.peak), found.errors),
            Err(status) => (status, None, None),
        };
        let good: Option<(&Peak, &Point)> = found
            .as_ref()
            .filter(|found| found.status == Status::Ok)
            .and_then(|found| Some((found, found.point.as_ref()?)));
        let errors = good.and(errors);
        let work = found.as_ref().map(|found| found.work).unwrap_or_default();
        let amplitude = good.map(|(found, point)| point.amplitudes_m[found.blade]);
        let mean_friction = good.and_then(|(found, _)| found.mean_friction_n);
        ResponseRow {
            scenario: scenario.index,
            pattern: pattern.id,
            status,
            contact_factors: pattern.contact.means(),
            peak_amplitude_m: amplitude,
            peak_frequency_hz: good.map(|(_, point)| point.frequency_hz),
            peak_blade: good.map(|(found, _)| found.blade as u32),
            amplification_factor: amplification_factor(amplitude, tuned.amplitude_m),
            peak_bracketed: good.map(|(found, _)| found.bracketed),
            harmonics: harmonics_name(self.points(scenario).harmonics()),
            nonlinear_solves: work.nonlinear_solves,
            newton_iterations: work.newton_iterations,
            factorisations: work.factorisations,
            retries: work.retries,
            residual: good.map(|(_, point)| point.residual),
            slipping_fraction: good.map(|(_, point)| point.shares.slipping),
            separated_fraction: good.map(|(_, point)| point.shares.separated),
            mean_friction_circumferential_n: mean_friction.map(|force| force[0]),
            mean_friction_axial_n: mean_friction.map(|force| force[1]),
            sampling_error: errors.map(|errors| errors.sampling),
            harmonic_error: errors.map(|errors| errors.harmonics),
            stated_error: errors
                .map(|errors| {
                    let of_scenario = self.scenario_error(scenario);
                    let safety = if self.has_all_receptances() {
                        HARMONIC_SAFETY_ON_RECEPTANCES
                    } else {
                        HARMONIC_SAFETY
                    };
                    let tolerance = self.settings().solver.peak_tolerance;
                    stated_error(&errors, &of_scenario, safety, tolerance)
                })
                .filter(|error| error.is_finite()),
            // An error that cannot be estimated is within no tolerance.
            error_within_tolerance: good
                .map(|_| errors.is_some_and(|errors| self.settings().tolerance().holds(&errors))),
            basis: self.basis_name(),
            shortcut: shortcut(scenario.contact, good.map(|(_, point)| point)).to_owned(),
        }
    }
}

/// `linear` for a linear limit; `stuck` where every pair sticks at the peak, so that the linear
/// solution is the exact one; else `none`.
fn shortcut(contact: ContactCondition, point: Option<&Point>) -> &'static str {
    match (contact, point) {
        (ContactCondition::Full { .. }, Some(point))
            if point.shares.slipping == 0.0 && point.shares.separated == 0.0 =>
        {
            "stuck"
        }
        (ContactCondition::Full { .. }, _) => "none",
        _ => "linear",
    }
}
