//! A row over frequency: its curve, its curve followed through folds, and where its peak can lie.

use super::{RowSolver, Scenario};
use crate::response::forced_response::{
    ContactCondition, LimitsWanted, PointSolver, ResponseTrace, SearchPlan, Window, search_plan,
};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;

/// Amplitudes of every blade at one frequency.
pub type CurveResult = (f64, Result<Vec<f64>, Status>);

impl RowSolver {
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
        if pattern.is_some_and(|pattern| !Self::is_possible(pattern)) {
            return Err(Status::InvalidPattern);
        }
        if let Some(curve) = self.curve_on_engine(engine_order, contact, pattern, frequencies_hz) {
            return Ok(curve);
        }
        let excited = match pattern {
            None => self.tuned_excited(engine_order, contact),
            Some(pattern) => {
                let (modes, wheel) = self.mistuned(pattern, LimitsWanted::default())?;
                let points = self.points(engine_order, contact);
                self.wheel_excited(&modes, &wheel, engine_order, points.harmonics())
            }
        };
        let points = self.points_of(pattern, engine_order, contact);
        let mut solver = PointSolver::new(&excited, contact, &points);
        let sectors = self.basis().model().sectors;
        Ok(frequencies_hz
            .iter()
            .map(|&frequency| {
                let amplitudes =
                    solver
                        .solve(frequency)
                        .map(|point| match point.amplitudes_m.as_slice() {
                            [one] => vec![*one; sectors],
                            all => all.to_vec(),
                        });
                (frequency, amplitudes)
            })
            .collect())
    }

    /// The curve between the first and the last frequency, followed upwards and downwards with the
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
        let excited = match pattern {
            None => self.tuned_excited(engine_order, contact),
            Some(pattern) => {
                let (modes, wheel) = self.mistuned(pattern, LimitsWanted::of(&[contact]))?;
                let harmonics = self.points(engine_order, contact).harmonics();
                self.wheel_excited(&modes, &wheel, engine_order, harmonics)
            }
        };
        let (Some(&first), Some(&last)) = (frequencies_hz.first(), frequencies_hz.last()) else {
            return Err(Status::SweepIncomplete);
        };
        let points = self.points_of(pattern, engine_order, contact);
        let sectors = self.basis().model().sectors;
        Ok([(first, last), (last, first)].map(|(start, stop)| {
            let mut solver = PointSolver::new(&excited, contact, &points);
            let mut trace = solver.trace(start, stop, frequencies_hz);
            for point in &mut trace.points {
                if let [one] = point.point.amplitudes_m[..] {
                    point.point.amplitudes_m = vec![one; sectors];
                }
            }
            trace
        }))
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
        let solver = self.under(scenario);
        if let Some(plan) = solver.plan_on_engine(scenario, pattern, tuned_hz) {
            return plan;
        }
        let (excited, window) = match pattern {
            None => {
                let window = Window {
                    resonances_hz: None,
                    band: solver.settings.solver.frequency_band,
                };
                let excited = solver.tuned_excited(scenario.engine_order, scenario.contact);
                (excited, window)
            }
            Some(pattern) => {
                let (modes, wheel) =
                    solver.mistuned(pattern, LimitsWanted::of(&[scenario.contact]))?;
                let window = solver.window(pattern, scenario, tuned_hz)?;
                let engine_order = scenario.engine_order;
                let harmonics = solver.points(engine_order, scenario.contact).harmonics();
                let excited = solver.wheel_excited(&modes, &wheel, engine_order, harmonics);
                (excited, window)
            }
        };
        search_plan(&excited, scenario.contact, window)
    }
}
