//! One (scenario, pattern) -> one row, and the tuned reference of a scenario.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use super::row_engine::RowEngine;
use super::{
    ErrorTolerance, HARMONIC_SAFETY, HARMONIC_SAFETY_ON_RECEPTANCES, HarmonicChoice, LoadCaseName,
    ResponseRow, Scenario, ScenarioError, TunedReference, amplification_factor, harmonics_name,
    stated_error,
};
use crate::linalg::Matrix;
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, ErrorEstimate, Excited, LimitsWanted, Peak, Point, PointSettings, Screening,
    SolverOptions, Wheel, Window, peak, screen, wheel_force,
};
use crate::response::friction::{ContactLaw, PairParameters, Ring};
use crate::response::harmonic_balance::{Damping, Status, TransformError};
use crate::response::mistuning::{
    ContactFactors, Deviations, Pattern, Projection, StructuralModes, WheelBasis,
};

/// Tolerance of the sampling error, unless that of the peak is larger.
const SAMPLING_TOLERANCE: f64 = 1e-3;

/// What a study says about the physics of a row.
#[derive(Debug, Clone)]
pub struct RowSettings {
    /// Harmonic set under the contact law, ascending, with 1.
    pub harmonics: Vec<u32>,
    /// Contact law and its parameters per sector; none for a model without contact.
    pub contact: Option<(ContactLaw, PairParameters)>,
    /// What a free ring does under mean friction.
    pub ring: Ring,
    /// Law in whose place the simpler one of `contact` is taken, with the same springs; what that changes is in the errors.
    pub in_place_of: Option<ContactLaw>,
    /// Damping of the structure.
    pub damping: Damping,
    /// Factor on the model's force vector.
    pub amplitude_n: f64,
    /// How a deviation enters the reduced stiffness.
    pub projection: Projection,
    /// Settings of the solution.
    pub solver: SolverOptions,
}

impl RowSettings {
    /// What points with `harmonics` need.
    fn points(
        &self,
        harmonics: &[u32],
        model: &ReducedModel,
    ) -> Result<PointSettings, TransformError> {
        let geometry = model.contact.clone();
        PointSettings::new(&self.solver, harmonics, self.contact, geometry)?
            .with_ring(self.ring)
            .in_place_of(self.in_place_of, &self.solver)
    }

    /// In the column `shortcut`: what the law leaves out of the one in whose place it is taken.
    fn simpler_law(&self) -> Option<&'static str> {
        let (own, _) = self.contact?;
        let varies = self.in_place_of?.has_variable_load();
        if varies && !own.has_variable_load() {
            Some("constant_normal_load")
        } else {
            Some("uncoupled_tangents")
        }
    }
}

/// Solves rows on one reduced model; shared between threads.
#[derive(Debug)]
pub struct RowSolver {
    basis: WheelBasis,
    pub(super) settings: RowSettings,
    pub(super) full: PointSettings,
    linear: PointSettings,
    /// Sets that differ from scenario to scenario; the others have that of the settings.
    pub(super) chosen: Vec<(HarmonicChoice, PointSettings)>,
    basis_error: f64,
    pub(super) beyond: Option<Beyond>,
    /// What rows are solved on in the place of the basis.
    pub(super) engine: Option<RowEngine>,
    /// Solvers of the further load cases of the study.
    pub(super) load_cases: Vec<(LoadCaseName, RowSolver)>,
}

/// A peak as a row states it.
pub(super) struct MistunedPeak {
    pub(super) peak: Peak,
    pub(super) errors: Option<ErrorEstimate>,
}

/// What solves the rows that this solver is not good enough for.
#[derive(Debug)]
pub(super) struct Beyond {
    pub(super) solver: Box<RowSolver>,
    /// Whether rows with an error beyond its tolerance go there too, besides those that separate or, on tuned receptances,
    /// have no peak.
    pub(super) inexact_rows: bool,
    /// Tuned peaks on that solver, for each of its chosen sets, found when first asked for.
    pub(super) tuned: Vec<OnceLock<TunedReference>>,
}

impl RowSolver {
    /// A solver for `model`.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub fn new(model: Arc<ReducedModel>, settings: RowSettings) -> Result<Self, TransformError> {
        Ok(Self {
            full: settings.points(&settings.harmonics, &model)?,
            linear: settings.points(&[1], &model)?,
            basis: WheelBasis::new(model),
            settings,
            chosen: Vec::new(),
            basis_error: 0.0,
            beyond: None,
            engine: None,
            load_cases: Vec::new(),
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
        let settings = &self.settings;
        self.chosen = choices
            .into_iter()
            .map(|choice| {
                let points = settings.points(&choice.harmonics, self.basis.model())?;
                Ok((choice, points))
            })
            .collect::<Result<_, TransformError>>()?;
        self.basis_error = basis_error;
        Ok(self)
    }

    /// The wheel's coordinates.
    #[must_use]
    pub fn basis(&self) -> &WheelBasis {
        &self.basis
    }

    /// Harmonic sets chosen for single scenarios.
    pub fn choices(&self) -> impl Iterator<Item = &HarmonicChoice> {
        self.chosen.iter().map(|(choice, _)| choice)
    }

    /// Peak of the tuned wheel, on one sector.
    #[must_use]
    pub fn tuned_peak(&self, engine_order: u32, contact: ContactCondition) -> Peak {
        let excited = self.tuned_excited(engine_order, contact);
        let window = Window {
            resonances_hz: None,
            band: self.settings.solver.frequency_band,
        };
        peak(
            &excited,
            contact,
            self.points(engine_order, contact),
            window,
            self.settings.solver.peak_tolerance,
        )
    }

    /// Peak of the tuned wheel with its errors and the effects of the harmonics left out; none
    /// where there is no peak, or it cannot be corrected.
    #[must_use]
    pub fn tuned_screening(
        &self,
        engine_order: u32,
        contact: ContactCondition,
    ) -> (Peak, Option<Screening>) {
        let found = self.tuned_peak(engine_order, contact);
        let point = found.point.as_ref().filter(|_| found.status == Status::Ok);
        let screening = point.and_then(|point| {
            let points = self.points(engine_order, contact);
            let nominal = ContactFactors::default();
            let of = |set: &[u32]| self.tuned_waves(&nominal, engine_order, contact, set);
            let enlarged = of(points.errors().harmonics());
            screen(
                &of(points.harmonics()),
                contact,
                points,
                point,
                &enlarged.blocks,
            )
        });
        (found, screening)
    }

    /// Tuned reference of a scenario.
    #[must_use]
    pub fn tuned(&self, scenario: &Scenario) -> TunedReference {
        if let Some(tuned) = self.tuned_on_engine(scenario) {
            return tuned;
        }
        let solver = self.under(scenario);
        let (found, screening) = solver.tuned_screening(scenario.engine_order, scenario.contact);
        let points = solver.points(scenario.engine_order, scenario.contact);
        let point = found.point.as_ref().filter(|_| found.status == Status::Ok);
        TunedReference {
            scenario: scenario.index,
            status: found.status,
            amplitude_m: found.amplitude_m(),
            frequency_hz: point.map(|point| point.frequency_hz),
            separated_fraction: point.map(|point| point.shares.separated),
            slipping_fraction: point.map(|point| point.shares.slipping),
            harmonics: harmonics_name(points.harmonics()),
            errors: screening.map(|screening| screening.errors),
        }
    }

    /// Rows of one pattern under several scenarios of one standard deviation, in their order. The
    /// projected stiffness, its modes and the modes of the linear limits are found once.
    #[must_use]
    pub fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        if let Some(rows) = self.rows_on_engine(pattern, scenarios) {
            return rows;
        }
        let conditions: Vec<ContactCondition> = scenarios
            .iter()
            .map(|(scenario, _)| scenario.contact)
            .collect();
        let wheel = self.mistuned(pattern, LimitsWanted::of(&conditions));
        scenarios
            .iter()
            .map(|(scenario, tuned)| {
                // The wheel is the same under every load case.
                let solver = self.under(scenario);
                let found = match &wheel {
                    Ok((modes, wheel)) => {
                        solver.mistuned_peak(modes, wheel, pattern, scenario, tuned)
                    }
                    Err(status) => Err(*status),
                };
                let row = solver.row(pattern, scenario, tuned, found);
                let again = solver.solved_again(pattern, scenario, &row);
                again.unwrap_or(row)
            })
            .collect()
    }

    pub(super) fn chosen(
        &self,
        engine_order: u32,
        contact: ContactCondition,
    ) -> Option<&(HarmonicChoice, PointSettings)> {
        self.chosen
            .iter()
            .find(|(choice, _)| choice.engine_order == engine_order && choice.contact == contact)
    }

    pub(super) fn points(&self, engine_order: u32, contact: ContactCondition) -> &PointSettings {
        match (contact, self.chosen(engine_order, contact)) {
            (ContactCondition::Full { .. }, Some((_, points))) => points,
            (ContactCondition::Full { .. }, None) => &self.full,
            _ => &self.linear,
        }
    }

    /// The settings of a point of the wheel with `pattern`; none means the tuned wheel.
    pub(super) fn points_of<'a>(
        &'a self,
        pattern: impl Into<Option<&'a Pattern>>,
        engine_order: u32,
        contact: ContactCondition,
    ) -> Cow<'a, PointSettings> {
        let points = self.points(engine_order, contact);
        match pattern.into().map(|pattern| &pattern.contact) {
            Some(factors) if !factors.is_nominal() => Cow::Owned(points.with_factors(factors)),
            _ => Cow::Borrowed(points),
        }
    }

    /// Errors that the rows of a scenario take over from it; a linear limit has no harmonics.
    fn scenario_error(&self, scenario: &Scenario) -> ScenarioError {
        let choice = self.chosen(scenario.engine_order, scenario.contact);
        ScenarioError {
            basis: self.basis_error,
            // A remainder that could not be measured bounds nothing, but rows on tuned receptances are asked themselves.
            harmonics: match choice.map(|(choice, _)| choice.remainder) {
                Some(None) if self.engine.is_none() => f64::INFINITY,
                Some(remainder) => remainder.unwrap_or(0.0),
                None => 0.0,
            },
        }
    }

    fn tolerance(&self) -> ErrorTolerance {
        ErrorTolerance {
            sampling: self.settings.solver.peak_tolerance.max(SAMPLING_TOLERANCE),
            harmonics: self.settings.solver.harmonic_tolerance,
        }
    }

    pub(super) fn tuned_excited(&self, engine_order: u32, contact: ContactCondition) -> Excited {
        let harmonics = self.points(engine_order, contact).harmonics();
        self.tuned_waves(&ContactFactors::default(), engine_order, contact, harmonics)
    }

    /// The tuned wheel with the contact of every sector multiplied by `factors`.
    pub(super) fn tuned_waves(
        &self,
        factors: &ContactFactors,
        engine_order: u32,
        contact: ContactCondition,
        harmonics: &[u32],
    ) -> Excited {
        Excited::tuned(
            self.basis.model(),
            factors,
            engine_order,
            self.settings.amplitude_n,
            self.settings.damping,
            harmonics,
            LimitsWanted::of(&[contact]),
        )
    }

    pub(super) fn wheel_excited(
        &self,
        modes: &StructuralModes,
        wheel: &Wheel,
        engine_order: u32,
        harmonics: &[u32],
    ) -> Excited {
        let force = wheel_force(&self.basis, modes, engine_order, self.settings.amplitude_n);
        Excited::wheel(wheel, force, harmonics)
    }

    /// The wheel with the pattern applied.
    pub(super) fn mistuned(
        &self,
        pattern: &Pattern,
        wanted: LimitsWanted,
    ) -> Result<(StructuralModes, Wheel), Status> {
        let modes = self
            .stiffness_change(pattern)
            .and_then(|change| StructuralModes::of_wheel(&self.basis, &change))
            .ok_or(Status::InvalidPattern)?;
        let wheel = Wheel::mistuned(
            modes.clone(),
            self.basis.model(),
            &pattern.contact,
            self.settings.damping,
            wanted,
        );
        Ok((modes, wheel))
    }

    /// Whether stiffnesses and contact parameters of a pattern are above zero.
    pub(super) fn is_possible(pattern: &Pattern) -> bool {
        let entries = pattern.entries();
        let mut deviations = entries.iter().map(|&(_, _, deviation)| deviation);
        let physical = deviations.all(|deviation| deviation > -1.0 && deviation.is_finite());
        physical && pattern.contact.are_possible()
    }

    /// What the pattern adds to the stiffness of the wheel, in its coordinates; none if it cannot
    /// be applied.
    pub(super) fn stiffness_change(&self, pattern: &Pattern) -> Option<Matrix<f64>> {
        if !Self::is_possible(pattern) {
            return None;
        }
        match (&pattern.deviations, self.settings.projection) {
            (Deviations::PerBlade(values), Projection::Exact) => {
                Some(self.basis.blade_stiffness_change(values))
            }
            (Deviations::PerBlade(values), Projection::CantileverModes) => self
                .basis
                .cantilever_stiffness_change(|blade, _| values[blade]),
            (Deviations::PerMode { modes, values }, _) => {
                self.basis.cantilever_stiffness_change(|blade, mode| {
                    let place = modes.iter().position(|&own| own as usize == mode);
                    place.map_or(0.0, |place| values[blade * modes.len() + place])
                })
            }
        }
    }

    pub(super) fn row(
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
            harmonics: harmonics_name(
                self.points(scenario.engine_order, scenario.contact)
                    .harmonics(),
            ),
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
                    let safety = match &self.engine {
                        Some(_) => HARMONIC_SAFETY_ON_RECEPTANCES,
                        None => HARMONIC_SAFETY,
                    };
                    let tolerance = self.settings.solver.peak_tolerance;
                    stated_error(&errors, &of_scenario, safety, tolerance)
                })
                .filter(|error| error.is_finite()),
            // An error that cannot be estimated is within no tolerance.
            error_within_tolerance: good
                .map(|_| errors.is_some_and(|errors| self.tolerance().holds(&errors))),
            basis: self.basis_name(),
            shortcut: shortcut(
                scenario.contact,
                good.map(|(_, point)| point),
                self.settings.simpler_law(),
            ),
        }
    }
}

/// `linear` for a linear limit; `stuck` where every pair sticks at the peak, so that the linear
/// solution is the exact one; else `none`; where a simpler law is taken this first.
fn shortcut(contact: ContactCondition, point: Option<&Point>, simpler_law: Option<&str>) -> String {
    let own = match (contact, point) {
        (ContactCondition::Full { .. }, Some(point))
            if point.shares.slipping == 0.0 && point.shares.separated == 0.0 =>
        {
            "stuck"
        }
        (ContactCondition::Full { .. }, _) => "none",
        _ => return "linear".to_owned(),
    };
    match simpler_law {
        Some(law) if own == "none" => law.to_owned(),
        Some(law) => format!("{law}, {own}"),
        None => own.to_owned(),
    }
}
