//! The peak of a row on tuned receptances.
//!
//! What is tried, one after the other, until a row has a peak:
//!
//! 1. few harmonics over the band, and every larger set at the tops that the one before it finds (`corrected_peak.rs`);
//! 2. where contacts open, the same led by harmonics 0 to 3, of an automatic set;
//! 3. the whole set over the band: up to nine lost points, one where fewer harmonics follow. There it is left out after a top that no
//!    attempt solved;
//! 4. the whole of this with harmonics up to 9, then 7, then 5, of an automatic set (`population/monte_carlo/load_case_solvers.rs`).
//!
//! A point is lost when every attempt of `receptance/attempts_on_receptances.rs` has failed.

use super::corrected_peak::{Lost, corrected_peak};
use super::peak::{Peak, Window, peak_by};
use super::point::Work;
use super::point_settings::PointSettings;
use super::receptance_points::{EngineRow, ReceptancePoints, receptance_plan};
use super::tops::with_work;

/// The peak of a row on tuned receptances.
#[derive(Debug, Clone)]
pub struct ReceptancePeak {
    /// The peak.
    pub peak: Peak,
    /// Relative change of its amplitude from the harmonics that led to it to all of them; none where all were searched with.
    pub by_harmonics: Option<f64>,
}

/// Finds the peak of one row: with few harmonics over the band and with all of them at its tops, where `search` has few, or with
/// all of them alone. Where contacts open, the few of an automatic set are those that follow that. Where fewer
/// harmonics follow, a search ends at the first point that is not found.
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
        let mut found = corrected_peak(row, &plan, search, &sets, peak_tolerance);
        let mut by_harmonics = settings.guide().is_some();
        if let (Err(lost), Some(opening)) = (&found, settings.opening())
            && lost.opens
        {
            wasted = lost.work;
            by_harmonics = false;
            found = corrected_peak(row, &plan, opening, &[settings], peak_tolerance);
        }
        match found {
            Ok((peak, change)) => {
                return ReceptancePeak {
                    peak: with_work(peak, wasted),
                    by_harmonics: by_harmonics.then_some(change),
                };
            }
            // What no attempt solves at a top, the whole band does not bring either.
            Err(Lost {
                work,
                unsolved: Some(status),
                ..
            }) if settings.fewer_follow() => {
                return alone(Peak::without(status, wasted.plus(work)));
            }
            Err(lost) => wasted = wasted.plus(lost.work),
        }
    }
    let mut solver = ReceptancePoints::new(row, settings);
    let (found, _) = peak_by(&plan, row.condition, &mut solver, peak_tolerance);
    alone(with_work(found, wasted))
}
