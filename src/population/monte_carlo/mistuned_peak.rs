//! The peak of a mistuned wheel: where it is sought, with which harmonics, and its errors.

use super::{RowSolver, Scenario, TunedReference};
use crate::response::forced_response::{
    ErrorEstimate, FrequencyBand, Peak, PointSettings, Search, SearchHarmonics, Wheel, Window,
    estimate_errors, mistuned_window, peak, refined_peak, tuned_span,
};
use crate::response::harmonic_balance::{LARGEST_WHOLE_JACOBIAN, Status};
use crate::response::mistuning::{ContactFactors, Pattern, StructuralModes};

impl RowSolver {
    /// Where the peak of a mistuned wheel is sought.
    pub(super) fn window(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned_hz: Option<f64>,
    ) -> Result<Window, Status> {
        let band = self.settings.solver.frequency_band;
        Ok(match band {
            FrequencyBand::Auto => {
                let waves = self.tuned_excited(scenario.engine_order, scenario.contact);
                let span = tuned_span(&waves, scenario.contact, tuned_hz);
                let mut span = span.ok_or(Status::NotBracketed)?;
                if let Some(means) = pattern.contact.means() {
                    // Other contact springs move the resonances of all blades alike.
                    let pairs = self.basis().model().contact.weights.len();
                    let varied = self.tuned_waves_with(
                        &ContactFactors::new(vec![means; pairs]),
                        scenario.engine_order,
                        scenario.contact,
                        &[1],
                    );
                    let own = tuned_span(&varied, scenario.contact, None);
                    let own = own.ok_or(Status::NotBracketed)?;
                    span = (span.0.min(own.0), span.1.max(own.1));
                }
                mistuned_window(span, pattern.largest_deviation(), band)
            }
            FrequencyBand::Fixed { .. } => Window {
                resonances_hz: None,
                band,
            },
        })
    }

    /// Settings of a search with fewer harmonics, where rows with `points` have one.
    pub(super) fn search<'a>(&self, points: &'a PointSettings) -> Option<&'a PointSettings> {
        let coordinates: usize = 2 * points.harmonics().len() * self.basis().size();
        let pays = self.settings.solver.search_harmonics != SearchHarmonics::Auto
            || coordinates > LARGEST_WHOLE_JACOBIAN;
        points.search().filter(|_| pays)
    }

    pub(super) fn mistuned_peak(
        &self,
        modes: &StructuralModes,
        wheel: &Wheel,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Result<(Peak, Option<ErrorEstimate>), Status> {
        let window = self.window(pattern, scenario, tuned.frequency_hz)?;
        let engine_order = scenario.engine_order;
        let points = self.points_of(pattern, engine_order, scenario.contact);
        let excited = self.wheel_excited(modes, wheel, engine_order, points.harmonics());
        let tolerance = self.settings.solver.peak_tolerance;
        let found = match self.search(&points) {
            Some(search) => {
                let coarse = self.wheel_excited(modes, wheel, engine_order, search.harmonics());
                let coarse = Search {
                    excited: &coarse,
                    settings: search,
                };
                refined_peak(
                    &excited,
                    coarse,
                    scenario.contact,
                    &points,
                    window,
                    tolerance,
                )
            }
            None => peak(&excited, scenario.contact, &points, window, tolerance),
        };
        let errors = found.point.as_ref().and_then(|point| {
            let enlarged =
                self.wheel_excited(modes, wheel, engine_order, points.errors().harmonics());
            estimate_errors(&excited, scenario.contact, &points, point, &enlarged.blocks)
        });
        Ok((found, errors))
    }
}
