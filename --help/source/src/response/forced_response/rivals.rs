//! Local maxima of a search beside the best one.

use super::peak_search::{NEAR, RESOLVED, Search, VERTEX_SHARE, higher};
use super::summit;

impl Search {
    /// The summit of another local maximum that may be higher than the best.
    pub(super) fn rival(&self, best: usize) -> Option<f64> {
        let top = (1.0 + VERTEX_SHARE * self.settings.tolerance) * self.samples.0[best].largest;
        let height = self.settings.rivals_from * top;
        let mut highest: Option<(f64, f64)> = None;
        for at in (0..self.samples.0.len()).filter(|&at| at != best) {
            let Some((left, right)) = self
                .samples
                .neighbours(at)
                .filter(|_| self.samples.bracketed(at))
            else {
                continue;
            };
            let points = self
                .samples
                .points([left, at, right], self.samples.0[at].blade);
            let summits = || {
                self.samples
                    .skewed_summits(at)
                    .into_iter()
                    .chain(summit::of_parabola(points))
                    .filter(|summit| summit.amplitude.is_finite())
            };
            let Some(summit) = summits().reduce(higher) else {
                continue;
            };
            let trusted = self.trusted(summit.half_bandwidth_hz);
            let gap = (points[2].0 - points[1].0).max(points[1].0 - points[0].0);
            // Where parabola and cubics differ, the truth may lie as far on the other side.
            let lowest = summits().fold(f64::INFINITY, |low, other| low.min(other.amplitude));
            let reach = 2.0 * summit.amplitude - lowest;
            let resolved = (points[2].0 - points[0].0) * RESOLVED;
            let away = (summit.frequency_hz - points[1].0).abs();
            // What cannot be the best need not be known better than by a parabola.
            let near = if reach > top { NEAR } else { 1.0 };
            if reach > height
                && away > resolved
                && gap > near * trusted
                && highest.is_none_or(|(_, known)| reach > known)
            {
                highest = Some((summit.frequency_hz, reach));
            }
        }
        highest.map(|(frequency, _)| frequency)
    }
}
