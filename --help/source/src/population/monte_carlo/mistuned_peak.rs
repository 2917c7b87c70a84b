//! The peak of a mistuned wheel: where it is sought, with which harmonics, and its errors.

use super::row_solver::MistunedPeak;
use super::{RowSolver, Scenario, TunedReference};
use crate::response::forced_response::{
    ContactCondition, ErrorEstimate, Excited, FrequencyBand, Peak, PointSettings, Search,
    SearchHarmonics, Wheel, Window, Work, estimate_errors, mistuned_window, peak, refined,
    slopes_lead, tuned_span,
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
                    let pairs = self.basis().model().contact.weights.len();
                    let factors = ContactFactors::new(vec![means; pairs]);
                    let (order, contact) = (scenario.engine_order, scenario.contact);
                    span = self.widened_by(&factors, span, order, contact)?;
                }
                mistuned_window(span, pattern.largest_deviation(), band)
            }
            FrequencyBand::Fixed { .. } => Window {
                resonances_hz: None,
                band,
            },
        })
    }

    /// The span with the resonances that count under other contact springs, which move those of all blades alike.
    pub(super) fn widened_by(
        &self,
        factors: &ContactFactors,
        span: (f64, f64),
        engine_order: u32,
        contact: ContactCondition,
    ) -> Result<(f64, f64), Status> {
        let varied = self.tuned_waves(factors, engine_order, contact, &[1]);
        let own = tuned_span(&varied, contact, None).ok_or(Status::NotBracketed)?;
        Ok((span.0.min(own.0), span.1.max(own.1)))
    }

    /// Settings of a search with fewer harmonics, where rows with `points` have one.
    #[must_use]
    pub fn search<'a>(&self, points: &'a PointSettings) -> Option<&'a PointSettings> {
        let basis = self.basis();
        let pays = match self.settings.solver.search_harmonics {
            SearchHarmonics::Auto => {
                let unknowns: usize = 2 * points.harmonics().len() * basis.size();
                // A search that slopes lead takes fewer points by itself, and finds tops that harmonic 1 hardly shows.
                unknowns > LARGEST_WHOLE_JACOBIAN
                    && !slopes_lead(points, basis.size(), basis.contact().rows())
            }
            SearchHarmonics::All | SearchHarmonics::Set(_) => true,
        };
        points.search().filter(|_| pays)
    }

    /// The highest peak of a mistuned wheel with its errors.
    pub(super) fn mistuned_peak(
        &self,
        modes: &StructuralModes,
        wheel: &Wheel,
        pattern: &Pattern,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Result<MistunedPeak, Status> {
        let window = self.window(pattern, scenario, tuned.frequency_hz)?;
        let contact = scenario.contact;
        let points = self.points_of(pattern, scenario.engine_order, contact);
        let in_harmonics =
            |harmonics: &[u32]| self.wheel_excited(modes, wheel, scenario.engine_order, harmonics);
        let tolerance = self.settings.solver.peak_tolerance;
        let in_stages = |excited: &Excited, search: &PointSettings| {
            let coarse = in_harmonics(search.harmonics());
            let search = Search {
                excited: &coarse,
                settings: search,
            };
            refined(excited, search, contact, &points, window, tolerance)
        };
        let excited = in_harmonics(points.harmonics());
        let mut wasted = Work::default();
        let staged = self.search(&points);
        let staged = staged.map(|search| in_stages(&excited, search));
        let found = match staged {
            Some(Ok(found)) => found,
            Some(Err(work)) => {
                wasted = work;
                peak(&excited, contact, &points, window, tolerance)
            }
            None => peak(&excited, contact, &points, window, tolerance),
        };
        let found = Peak {
            work: found.work.plus(wasted),
            ..found
        };
        let enlarged = in_harmonics(points.errors().harmonics());
        Ok(MistunedPeak {
            errors: errors(&excited, contact, &points, &found, &enlarged),
            peak: found,
        })
    }
}

fn errors(
    excited: &Excited,
    contact: ContactCondition,
    points: &PointSettings,
    peak: &Peak,
    enlarged: &Excited,
) -> Option<ErrorEstimate> {
    let point = peak.point.as_ref()?;
    estimate_errors(excited, contact, points, point, &enlarged.blocks)
}
