//! A delivered row looked into: blade amplitudes and the state of every contact pair at its peak.

use super::{ResponseRow, RowSolver, Scenario};
use crate::response::forced_response::{LimitsWanted, PointSolver};
use crate::response::harmonic_balance::{PairContact, Status};
use crate::response::mistuning::Pattern;

/// The wheel of a row at the frequency of its peak.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelState {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude of every blade, m.
    pub amplitudes_m: Vec<f64>,
    /// State of every contact pair, sector by sector; none for a linear limit.
    pub contact: Option<Vec<PairContact>>,
}

impl RowSolver {
    /// The wheel of `row`, with the model and harmonics that the row was solved with.
    ///
    /// # Errors
    /// The status of a row without peak, of a pattern that cannot be applied, or of the solution.
    pub fn wheel_state(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
    ) -> Result<WheelState, Status> {
        let solver = self.under(scenario).solver_of(scenario, row);
        let frequency_hz = row.peak_frequency_hz.ok_or(row.status)?;
        if let Some(state) = solver.state_on_engine(pattern, scenario, frequency_hz) {
            return state;
        }
        let (engine_order, contact) = (scenario.engine_order, scenario.contact);
        let (modes, wheel) = solver.mistuned(pattern, LimitsWanted::of(&[contact]))?;
        let points = solver.points_of(pattern, engine_order, contact);
        let excited = solver.wheel_excited(&modes, &wheel, engine_order, points.harmonics());
        let mut solver = PointSolver::new(&excited, contact, &points);
        let point = solver.solve(frequency_hz)?.clone();
        Ok(WheelState {
            frequency_hz,
            contact: solver.contact_states(&point),
            amplitudes_m: point.amplitudes_m,
        })
    }
}
