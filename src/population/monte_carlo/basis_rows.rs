//! Rows under one force vector on a reduced basis: the tuned wheel on one sector, a mistuned wheel in its structural modes.

use std::sync::Arc;

use super::row::MistunedPeak;
use super::row_points::{RowPoints, RowSettings};
use super::{CurveResult, Scenario, TunedReference, WheelState, harmonics_name};
use crate::linalg::Matrix;
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, Excited, FrequencyBand, LimitsWanted, Peak, PointSolver, ResponseTrace,
    Screening, SearchPlan, Wheel, Window, estimate_errors, mistuned_window, peak, screen,
    search_plan, tuned_span, wheel_force,
};
use crate::response::harmonic_balance::{Status, TransformError};
use crate::response::mistuning::{
    ContactFactors, Deviations, Pattern, Projection, StructuralModes, WheelBasis,
};

/// A basis of the wheel, and how the points of rows are solved on it.
#[derive(Debug)]
pub(super) struct BasisRows {
    pub(super) basis: WheelBasis,
    pub(super) points: RowPoints,
}

impl BasisRows {
    /// On the basis of `model`.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn new(
        model: Arc<ReducedModel>,
        settings: RowSettings,
    ) -> Result<Self, TransformError> {
        Ok(Self {
            points: RowPoints::new(settings, &model)?,
            basis: WheelBasis::new(model),
        })
    }

    fn settings(&self) -> &RowSettings {
        &self.points.settings
    }

    /// Where a study says that peaks are sought.
    pub(super) fn whole_window(&self) -> Window {
        Window {
            resonances_hz: None,
            band: self.settings().solver.frequency_band,
        }
    }

    /// Peak of the tuned wheel, on one sector.
    pub(super) fn tuned_peak(&self, engine_order: u32, contact: ContactCondition) -> Peak {
        peak(
            &self.tuned_excited(engine_order, contact),
            contact,
            self.points.nominal(engine_order, contact),
            self.whole_window(),
            self.settings().solver.peak_tolerance,
        )
    }

    /// Peak of the tuned wheel with its errors and the effects of the harmonics left out; none
    /// where there is no peak, or it cannot be corrected.
    pub(super) fn tuned_screening(
        &self,
        engine_order: u32,
        contact: ContactCondition,
    ) -> (Peak, Option<Screening>) {
        let found = self.tuned_peak(engine_order, contact);
        let point = found.point.as_ref().filter(|_| found.status == Status::Ok);
        let screening = point.and_then(|point| {
            let points = self.points.nominal(engine_order, contact);
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
    pub(super) fn tuned(&self, scenario: &Scenario) -> TunedReference {
        let (engine_order, contact) = (scenario.engine_order, scenario.contact);
        let (found, screening) = self.tuned_screening(engine_order, contact);
        let points = self.points.nominal(engine_order, contact);
        let errors = screening.map(|screening| screening.errors);
        TunedReference::of_peak(scenario, &found, harmonics_name(points.harmonics()), errors)
    }

    pub(super) fn tuned_excited(&self, engine_order: u32, contact: ContactCondition) -> Excited {
        let harmonics = self.points.nominal(engine_order, contact).harmonics();
        self.tuned_waves(&ContactFactors::default(), engine_order, contact, harmonics)
    }

    /// The tuned wheel with the contact of every sector multiplied by `factors`.
    fn tuned_waves(
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
            self.settings().amplitude_n,
            self.settings().damping,
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
        let amplitude_n = self.settings().amplitude_n;
        let force = wheel_force(&self.basis, modes, engine_order, amplitude_n);
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
            self.settings().damping,
            wanted,
        );
        Ok((modes, wheel))
    }

    /// What the pattern adds to the stiffness of the wheel, in its coordinates; none if it cannot
    /// be applied.
    pub(super) fn stiffness_change(&self, pattern: &Pattern) -> Option<Matrix<f64>> {
        if !pattern.is_possible() {
            return None;
        }
        match (&pattern.deviations, self.settings().projection) {
            (Deviations::PerBlade(values), Projection::Exact) => {
                Some(self.basis.blade_stiffness_change(values))
            }
            (Deviations::PerBlade(values), Projection::CantileverModes) => self
                .basis
                .cantilever_stiffness_change(|blade, _| values[blade]),
            (Deviations::PerMode { modes, values }, _) => {
                self.basis.cantilever_stiffness_change(|blade, mode| {
                    let place = modes.iter().position(|&number| number as usize == mode);
                    place.map_or(0.0, |place| values[blade * modes.len() + place])
                })
            }
        }
    }

    /// Where the peak of a mistuned wheel is sought.
    pub(super) fn window(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned_hz: Option<f64>,
    ) -> Result<Window, Status> {
        let whole = self.whole_window();
        let FrequencyBand::Auto = whole.band else {
            return Ok(whole);
        };
        let (engine_order, contact) = (scenario.engine_order, scenario.contact);
        let waves = self.tuned_excited(engine_order, contact);
        let span = tuned_span(&waves, contact, tuned_hz).ok_or(Status::NotBracketed)?;
        let span = self.span_of_varied_contact(pattern, span, engine_order, contact)?;
        Ok(mistuned_window(
            span,
            pattern.largest_deviation(),
            whole.band,
        ))
    }

    /// The span with the resonances that count under the mean contact of a pattern, which moves those of all blades alike.
    pub(super) fn span_of_varied_contact(
        &self,
        pattern: &Pattern,
        span: (f64, f64),
        engine_order: u32,
        contact: ContactCondition,
    ) -> Result<(f64, f64), Status> {
        let Some(means) = pattern.contact.means() else {
            return Ok(span);
        };
        let pairs = self.basis.model().contact.weights.len();
        let factors = ContactFactors::new(vec![means; pairs]);
        let varied = self.tuned_waves(&factors, engine_order, contact, &[1]);
        let varied_span = tuned_span(&varied, contact, None).ok_or(Status::NotBracketed)?;
        Ok((span.0.min(varied_span.0), span.1.max(varied_span.1)))
    }

    /// The highest peak of a mistuned wheel with its errors.
    pub(super) fn mistuned_peak(
        &self,
        (modes, wheel): &(StructuralModes, Wheel),
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Result<MistunedPeak, Status> {
        let window = self.window(pattern, scenario, tuned.frequency_hz)?;
        let contact = scenario.contact;
        let points = self.points.of(pattern, scenario.engine_order, contact);
        let in_harmonics =
            |harmonics: &[u32]| self.wheel_excited(modes, wheel, scenario.engine_order, harmonics);
        let tolerance = self.settings().solver.peak_tolerance;
        let excited = in_harmonics(points.harmonics());
        let found = peak(&excited, contact, &points, window, tolerance);
        let enlarged = in_harmonics(points.errors().harmonics());
        let errors = found
            .point
            .as_ref()
            .and_then(|point| estimate_errors(&excited, contact, &points, point, &enlarged.blocks));
        Ok(MistunedPeak {
            errors,
            peak: found,
        })
    }

    /// The wheel of a pattern, or one sector of the tuned one for none, under the excitation of a scenario.
    fn excited(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        wanted: LimitsWanted,
    ) -> Result<Excited, Status> {
        let Some(pattern) = pattern else {
            return Ok(self.tuned_excited(engine_order, contact));
        };
        let (modes, wheel) = self.mistuned(pattern, wanted)?;
        let harmonics = self.points.nominal(engine_order, contact).harmonics();
        Ok(self.wheel_excited(&modes, &wheel, engine_order, harmonics))
    }

    /// Amplitude of every blade at each frequency, Hz; no pattern means the tuned wheel, of which one sector stands for all.
    pub(super) fn curve(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<Vec<CurveResult>, Status> {
        let excited = self.excited(engine_order, contact, pattern, LimitsWanted::default())?;
        let points = self.points.of(pattern, engine_order, contact);
        let mut solver = PointSolver::new(&excited, contact, &points);
        let sectors = self.basis.model().sectors;
        let amplitudes = |&frequency: &f64| {
            let point = solver.solve(frequency);
            let amplitudes = point.map(|point| of_all_blades(&point.amplitudes_m, sectors));
            (frequency, amplitudes)
        };
        Ok(frequencies_hz.iter().map(amplitudes).collect())
    }

    /// The curve between the first and the last frequency, followed upwards and downwards with the frequencies, Hz, ascending,
    /// solved for exactly; no pattern means the tuned wheel.
    pub(super) fn traces(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<[ResponseTrace; 2], Status> {
        let limits = LimitsWanted::of(&[contact]);
        let excited = self.excited(engine_order, contact, pattern, limits)?;
        let (Some(&first), Some(&last)) = (frequencies_hz.first(), frequencies_hz.last()) else {
            return Err(Status::SweepIncomplete);
        };
        let points = self.points.of(pattern, engine_order, contact);
        let sectors = self.basis.model().sectors;
        Ok([(first, last), (last, first)].map(|(start, stop)| {
            let mut solver = PointSolver::new(&excited, contact, &points);
            let mut trace = solver.trace(start, stop, frequencies_hz);
            for point in &mut trace.points {
                let amplitudes_m = &mut point.point.amplitudes_m;
                *amplitudes_m = of_all_blades(amplitudes_m, sectors);
            }
            trace
        }))
    }

    /// Where the linear limits of a row say that its peak can lie; no pattern means the tuned wheel.
    pub(super) fn search_plan(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        tuned_hz: Option<f64>,
    ) -> Result<SearchPlan, Status> {
        let (engine_order, contact) = (scenario.engine_order, scenario.contact);
        let limits = LimitsWanted::of(&[contact]);
        let excited = self.excited(engine_order, contact, pattern, limits)?;
        let window = match pattern {
            None => self.whole_window(),
            Some(pattern) => self.window(pattern, scenario, tuned_hz)?,
        };
        search_plan(&excited, contact, window)
    }

    /// The wheel of a pattern at a frequency, Hz.
    pub(super) fn wheel_state(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        frequency_hz: f64,
    ) -> Result<WheelState, Status> {
        let (engine_order, contact) = (scenario.engine_order, scenario.contact);
        let limits = LimitsWanted::of(&[contact]);
        let excited = self.excited(engine_order, contact, Some(pattern), limits)?;
        let points = self.points.of(pattern, engine_order, contact);
        let mut solver = PointSolver::new(&excited, contact, &points);
        let point = solver.solve(frequency_hz)?.clone();
        Ok(WheelState {
            frequency_hz,
            contact: solver.contact_states(&point),
            amplitudes_m: point.amplitudes_m,
        })
    }
}

/// Amplitudes of all blades, of which one stands for all on the tuned wheel.
fn of_all_blades(amplitudes_m: &[f64], sectors: usize) -> Vec<f64> {
    match amplitudes_m {
        [one] => vec![*one; sectors],
        all => all.to_vec(),
    }
}
