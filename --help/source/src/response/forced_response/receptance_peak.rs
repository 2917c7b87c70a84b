//! The peak of a row on tuned receptances.

use super::corrected_peak::corrected_peak;
use super::peak::{Peak, Window, peak_by};
use super::point::Work;
use super::point_settings::PointSettings;
use super::receptance_points::{EngineRow, ReceptancePoints, receptance_plan};

/// The peak of a row on tuned receptances.
#[derive(Debug, Clone)]
pub struct ReceptancePeak {
    /// The peak.
    pub peak: Peak,
    /// Relative change of its amplitude from the harmonics that led to it to all of them; none where all were searched with.
    pub by_harmonics: Option<f64>,
}

/// Finds the peak of one row: with few harmonics over the band and with all of them at its tops, where `search` has few, or with
/// all of them alone. With an automatic set of all harmonics a search with these ends at the first point that is not found: fewer of
/// them have to do there.
#[must_use]
pub fn receptance_peak(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    search: Option<&PointSettings>,
    window: Window,
    peak_tolerance: f64,
) -> ReceptancePeak {
    let alone = |peak| ReceptancePeak {
        peak,
        by_harmonics: None,
    };
    let plan = match receptance_plan(row, window) {
        Ok(plan) => plan,
        Err(status) => {
            return alone(Peak::without(status, Work::default()));
        }
    };
    let nonlinear = row.condition.normal_load_n().is_some();
    let mut wasted = Work::default();
    if let Some(search) = search.filter(|_| nonlinear) {
        let sets: Vec<&PointSettings> = settings.guide().into_iter().chain([settings]).collect();
        match corrected_peak(row, &plan, search, &sets, peak_tolerance) {
            Ok((peak, change)) => {
                return ReceptancePeak {
                    peak,
                    by_harmonics: settings.guide().map(|_| change),
                };
            }
            Err(work) => wasted = work,
        }
    }
    let solver = ReceptancePoints::new(row, settings);
    let found = peak_by(&plan, row.condition, solver, peak_tolerance);
    alone(Peak {
        work: found.work.plus(wasted),
        ..found
    })
}
