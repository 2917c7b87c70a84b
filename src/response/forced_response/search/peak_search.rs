//! Search for the highest peak of a set of curves over frequency, with evidence that it is the highest.
//!
//! Every blade has a curve; the peak is the largest value over blades and frequency. Near a
//! resonance `1/A^2` is a parabola in frequency, exactly so for a single mode, so a vertex is found
//! by a parabola through three points of one blade's `1/A^2`, and believed once the cubics through
//! a fourth point promise nothing higher, there or at any other local maximum. Whether a higher peak can hide
//! between two points is judged by an envelope: a resonance of height P and half-bandwidth
//! gamma reads at least `P / sqrt(1 + (d/gamma)^2)` at distance d. Friction only adds damping, and
//! `P gamma` of a mode is fixed by its modal force, so a hidden peak as high as the best one
//! seen is at least as wide as [`Envelope::half_bandwidth`] says. The search ends when no interval can
//! hide a higher peak and the vertex of the best is found.

use super::envelope::{Envelope, NEAR, SearchSettings, VERTEX_SHARE};
use super::samples::{Curve, Lost, Sample, Samples};
use super::summit::{self, Summit};

/// Share of the best from which a higher top of a steep curve can stand beside a sample.
const HIGH_FLANK: f64 = 0.7;

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchEnd {
    /// The peak is bracketed and nothing higher can hide.
    Found,
    /// The largest value lies at an end of the band.
    Open,
    /// A failed evaluation lies where a higher peak could be.
    Incomplete,
    /// The evaluations are used up.
    Exhausted,
}

/// Result of a search: all samples in order of frequency and the place of the best.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchResult {
    /// Samples, ascending in frequency.
    pub samples: Vec<Sample>,
    /// Index of the sample with the largest amplitude; none if every evaluation failed.
    pub best: Option<usize>,
    /// Whether lower amplitudes were seen on both sides.
    pub bracketed: bool,
    /// Why the search ended.
    pub end: SearchEnd,
}

/// Finds the highest peak in `[start_hz, stop_hz]`, widened where the largest value lies at an end.
///
/// `starts` are the first frequencies tried besides the ends of the band.
pub fn find_peak(
    band_hz: (f64, f64),
    starts: &[f64],
    envelope: Envelope,
    settings: SearchSettings,
    mut curve: impl Curve,
) -> SearchResult {
    let mut search = Search {
        samples: Samples::default(),
        envelope,
        settings,
        evaluations: 0,
        steep: false,
    };
    let mut first: Vec<f64> = starts
        .iter()
        .copied()
        .filter(|f| *f > band_hz.0 && *f < band_hz.1)
        .chain([band_hz.0, band_hz.1])
        .collect();
    first.sort_by(f64::total_cmp);
    let resolution = envelope.resolution_hz();
    first.dedup_by(|later, earlier| *later - *earlier < resolution);
    for frequency in first {
        search.evaluate(frequency, &mut curve);
    }
    let mut extensions = 0;
    let end = loop {
        if search.evaluations >= settings.evaluations {
            break SearchEnd::Exhausted;
        }
        let Some(best) = search.samples.best() else {
            break SearchEnd::Incomplete;
        };
        if best == 0 || best + 1 == search.samples.0.len() {
            if extensions == settings.extensions {
                // The band ends here, but the peak may still lie just inside of its end.
                match search.inside_of_end(best) {
                    Some(frequency) => search.evaluate(frequency, &mut curve),
                    None => break SearchEnd::Open,
                }
                continue;
            }
            extensions += 1;
            let width = (band_hz.1 - band_hz.0).max(resolution);
            let at = search.samples.0[best].frequency_hz;
            let next = if best == 0 {
                at - 0.25 * width
            } else {
                at + 0.25 * width
            };
            if next <= 0.0 {
                break SearchEnd::Open;
            }
            search.evaluate(next, &mut curve);
            continue;
        }
        search.steep = curve.is_steep();
        match search.next_frequency(best) {
            Next::Evaluate(frequency) => search.evaluate(frequency, &mut curve),
            Next::Hole => break SearchEnd::Incomplete,
            Next::Done => match curve.unseen(&search.samples.0, best) {
                Some(frequency) => search.evaluate(frequency, &mut curve),
                None => break SearchEnd::Found,
            },
        }
    };
    let best = search.samples.best();
    let bracketed = best.is_some_and(|best| search.samples.bracketed(best));
    SearchResult {
        bracketed,
        best,
        samples: search.samples.0,
        end,
    }
}

pub(super) struct Search {
    pub(super) samples: Samples,
    pub(super) envelope: Envelope,
    pub(super) settings: SearchSettings,
    evaluations: usize,
    /// Whether the curve can be steeper than the envelope allows for.
    steep: bool,
}

enum Next {
    Evaluate(f64),
    /// Nothing left to try, but a failed point may hide a higher peak.
    Hole,
    Done,
}

impl Search {
    fn evaluate(&mut self, frequency_hz: f64, curve: &mut impl Curve) {
        self.evaluations += 1;
        self.samples.insert(frequency_hz, curve.read(frequency_hz));
    }

    /// A point inside of the end of the band that is the best so far, until the next one inside is
    /// nearer than a resonance as high could turn within.
    fn inside_of_end(&self, best: usize) -> Option<f64> {
        let at = self.samples.0[best].frequency_hz;
        let inside = self
            .samples
            .0
            .get(if best == 0 { 1 } else { best - 1 })?
            .frequency_hz;
        let near = 0.1 * self.envelope.half_bandwidth(self.samples.0[best].largest);
        let gap = inside - at;
        (gap.abs() > near).then(|| at + gap.signum() * f64::max(0.25 * gap.abs(), 0.9 * near))
    }

    /// The summit of the best peak first; then those of others; then the widest interval that could
    /// hide a higher one.
    fn next_frequency(&self, best: usize) -> Next {
        if let Some(vertex) = self.unsettled_vertex(best) {
            return self.short_of_failures(best, vertex);
        }
        match self.samples.rival(best, self.settings) {
            Some(frequency) => Next::Evaluate(frequency),
            None => self.hidden(best),
        }
    }

    /// Half-bandwidth, Hz, assumed of a hidden peak that is higher than the best.
    fn hidden_half_bandwidth(&self, best: usize) -> f64 {
        let top = self.samples.0[best].largest;
        self.envelope
            .half_bandwidth((1.0 + self.settings.tolerance) * top)
    }

    /// Distance at which a peak of the height that counts between samples of heights `sampled` and `other`, at least as high as
    /// they, and of this width would read `sampled`.
    fn reach(&self, best: usize, sampled: f64, other: f64) -> f64 {
        let counts = self.settings.rivals_from * self.samples.0[best].largest;
        let height = (1.0 + self.settings.tolerance) * f64::max(counts, sampled.max(other));
        self.hidden_half_bandwidth(best) * ((height / sampled).powi(2) - 1.0).max(0.0).sqrt()
    }

    /// Where between two samples a peak higher than the best could hide.
    pub(super) fn hiding_place(
        &self,
        best: usize,
        left: usize,
        right: usize,
    ) -> Option<(f64, f64)> {
        let (left, right) = (&self.samples.0[left], &self.samples.0[right]);
        let from = left.frequency_hz + self.reach(best, left.largest, right.largest);
        let to = right.frequency_hz - self.reach(best, right.largest, left.largest);
        (from < to).then_some((from, to))
    }

    /// The middle of the widest interval that could hide a peak higher than the best.
    fn hidden(&self, best: usize) -> Next {
        let gamma = self.hidden_half_bandwidth(best);
        let top = self.samples.0[best].largest;
        let linear = self.envelope.linear_half_bandwidth_hz;
        let good: Vec<usize> = (0..self.samples.0.len())
            .filter(|&i| !self.samples.0[i].amplitudes.is_empty())
            .collect();
        let mut widest: Option<(f64, f64)> = None;
        let mut hole = false;
        if let (Some(&first), Some(&last)) = (good.first(), good.last()) {
            // Out to the ends of the band all points failed.
            let all = &self.samples.0;
            let (start, stop) = (&all[0], &all[all.len() - 1]);
            let alone = |at: usize| self.reach(best, all[at].largest, 0.0);
            hole |= all[first].frequency_hz - alone(first) > start.frequency_hz;
            hole |= all[last].frequency_hz + alone(last) < stop.frequency_hz;
        }
        for pair in good.windows(2) {
            let (left, right) = (&self.samples.0[pair[0]], &self.samples.0[pair[1]]);
            // Beside the best the parabola through it has judged already, unless it is far away.
            let beside_best = pair[0] == best || pair[1] == best;
            let lost = pair[1] > pair[0] + 1;
            if self.steep && lost && left.largest.max(right.largest) > HIGH_FLANK * top {
                match self.samples.lost_between(pair[0], pair[1], linear) {
                    Lost::Nearer(frequency) => return Next::Evaluate(frequency),
                    Lost::Hole => hole = true,
                    Lost::Narrow => {}
                }
                continue;
            }
            if beside_best && right.frequency_hz - left.frequency_hz <= 2.0 * gamma {
                continue;
            }
            let Some((from, to)) = self.hiding_place(best, pair[0], pair[1]) else {
                continue;
            };
            if lost {
                hole = true;
                continue;
            }
            if widest.is_none_or(|(_, width)| to - from > width) {
                widest = Some((0.5 * (from + to), to - from));
            }
        }
        match widest {
            Some((frequency, _)) => Next::Evaluate(frequency),
            None if hole => Next::Hole,
            None => Next::Done,
        }
    }

    /// `frequency`, or, where a failed point lies before it, one halfway to that, then one from its other side, or a hole.
    fn short_of_failures(&self, best: usize, frequency: f64) -> Next {
        let at = self.samples.0[best].frequency_hz;
        let linear = self.envelope.linear_half_bandwidth_hz;
        let beside = if frequency > at { best + 1 } else { best - 1 };
        let failed = &self.samples.0[beside];
        let between = (failed.frequency_hz - at).abs() <= (frequency - at).abs();
        if !failed.amplitudes.is_empty() || !between {
            Next::Evaluate(frequency)
        } else if (failed.frequency_hz - at).abs() > 0.05 * linear {
            Next::Evaluate(0.5 * (failed.frequency_hz + at))
        } else {
            match self.samples.lost_beside(best, frequency > at, linear) {
                Lost::Nearer(frequency) if self.steep => Next::Evaluate(frequency),
                _ => Next::Hole,
            }
        }
    }

    /// Where the summit of the best sample and its neighbours is, unless the best is known to lie
    /// within tolerance of it.
    fn unsettled_vertex(&self, best: usize) -> Option<f64> {
        let (left, right) = self.samples.neighbours(best)?;
        let points = self
            .samples
            .points([left, best, right], self.samples.0[best].blade);
        let [x0, x1, x2] = points.map(|(frequency, _)| frequency);
        let summit = summit::of_parabola(points)?;
        let (vertex, gamma) = (summit.frequency_hz, summit.half_bandwidth_hz);
        let gain = summit.amplitude / self.samples.0[best].largest - 1.0;
        let tolerance = VERTEX_SHARE * self.settings.tolerance;
        let trusted = self.settings.trusted_hz(gamma);
        let (left_gap, right_gap) = (x1 - x0, x2 - x1);
        let between = |frequency: f64| frequency.clamp(x0 + 0.1 * left_gap, x2 - 0.1 * right_gap);
        if gain <= tolerance && left_gap.max(right_gap) <= trusted {
            let told = left_gap.max(right_gap) > NEAR * trusted;
            let skewed = self.samples.skewed_summits(best);
            if told && self.settings.extensions > 0 && !self.samples.has_fourth(best) {
                // Three points say nothing of how skewed the top is; a band that is asked for is not left for a fourth.
                return Some(if points[2].1 < points[0].1 {
                    x2 + right_gap
                } else {
                    x0 - left_gap
                });
            }
            let skewed = skewed.into_iter().reduce(Summit::higher)?;
            return (told && skewed.amplitude > (1.0 + tolerance) * self.samples.0[best].largest)
                .then(|| between(skewed.frequency_hz));
        }
        // A neighbour far away spoils the parabola, and the vertex would only creep: fetch a nearer one.
        let (wide, narrow) = (left_gap.max(right_gap), left_gap.min(right_gap));
        if wide > 8.0 * narrow {
            let step = f64::min(
                0.5 * wide,
                f64::max(3.0 * narrow, 2.0 * (vertex - x1).abs()),
            );
            return Some(if right_gap > left_gap {
                x1 + step
            } else {
                x1 - step
            });
        }
        // Closer to the best than this, the rounding of the amplitudes hides any gain.
        let distinct = 1e-7 * (x2 - x0);
        if gain > tolerance && (vertex - x1).abs() > distinct {
            return Some(between(vertex));
        }
        // The best lies at the vertex: confirm it by closer neighbours.
        Some(if right_gap > left_gap {
            x1 + f64::min(0.5 * right_gap, 0.9 * trusted)
        } else {
            x1 - f64::min(0.5 * left_gap, 0.9 * trusted)
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in super::super) const SETTINGS: SearchSettings = SearchSettings {
        tolerance: 1e-4,
        evaluations: 100,
        extensions: 5,
        rivals_from: 1.0,
    };

    pub(in super::super) const ENVELOPE: Envelope = Envelope {
        strength: 1.0,
        linear_half_bandwidth_hz: 0.5,
    };

    /// Sum of complex resonances, one blade per row of residues.
    pub(in super::super) fn curves(poles: &[(f64, f64)], residues: &[&[f64]], f: f64) -> Vec<f64> {
        residues
            .iter()
            .map(|row| {
                row.iter()
                    .zip(poles)
                    .map(|(r, &(f0, gamma))| r / crate::linalg::Complex64::new(f0 - f, gamma))
                    .sum::<crate::linalg::Complex64>()
                    .norm()
            })
            .collect()
    }

    #[test]
    fn a_single_resonance_takes_few_evaluations() {
        let mut count = 0;
        let result = find_peak((90.0, 110.0), &[100.3], ENVELOPE, SETTINGS, |f| {
            count += 1;
            Some(curves(&[(100.0, 0.5)], &[&[1.0]], f))
        });
        let best = &result.samples[result.best.expect("evaluated")];
        assert_eq!(result.end, SearchEnd::Found);
        assert!(result.bracketed && (best.largest - 2.0).abs() < 1e-4 * 2.0);
        assert!(count <= 14, "{count}");
    }

    #[test]
    fn a_higher_narrow_peak_away_from_every_start_is_found() {
        let poles = [(100.0, 0.5), (106.3, 0.5)];
        let result = find_peak((90.0, 115.0), &[100.0], ENVELOPE, SETTINGS, |f| {
            Some(curves(&poles, &[&[0.9, 0.0], &[0.0, 1.0]], f))
        });
        let best = &result.samples[result.best.expect("evaluated")];
        assert_eq!(best.blade, 1);
        assert!((best.frequency_hz - 106.3).abs() < 0.02);
    }

    /// Damped modes within a half-bandwidth make a top so flat that a parabola through three
    /// samples can settle on the wrong place (case 103).
    #[test]
    fn flat_and_skewed_tops_are_found_to_the_tolerance() {
        let settings = SearchSettings {
            tolerance: 1e-3,
            ..SETTINGS
        };
        let mut evaluations = 0;
        for case in 0..400 {
            let draw = |k: usize| ((case * 17 + k) as f64 * 0.618_033_988_75).fract();
            let poles = [
                (100.0, 0.6 + 2.0 * draw(1)),
                (100.2 + 1.5 * draw(2), 0.5 + 2.0 * draw(3)),
                (101.0 + 3.0 * draw(4), 0.5 + 2.0 * draw(5)),
            ];
            let first = [draw(6), -draw(7), draw(8)];
            let second = [draw(9), draw(10), -draw(11)];
            let envelope = Envelope {
                strength: 6.0,
                linear_half_bandwidth_hz: 0.5,
            };
            let result = find_peak((95.0, 108.0), &[98.0, 104.0], envelope, settings, |f| {
                evaluations += 1;
                Some(curves(&poles, &[&first, &second], f))
            });
            let found = result.samples[result.best.expect("evaluated")].largest;
            let highest = (0..13_000)
                .flat_map(|i| curves(&poles, &[&first, &second], 95.0 + 0.001 * f64::from(i)))
                .fold(0.0, f64::max);
            assert!(
                found > (1.0 - 1e-3) * highest,
                "case {case}: {found} {highest}"
            );
        }
        assert!(evaluations < 400 * 12, "{evaluations}");
    }

    #[test]
    fn a_peak_outside_the_band_is_followed_and_a_rising_curve_is_open() {
        let inside = |f: f64| Some(curves(&[(112.0, 0.5)], &[&[1.0]], f));
        let result = find_peak((90.0, 110.0), &[], ENVELOPE, SETTINGS, inside);
        assert!(result.bracketed);
        let rising = |f: f64| Some(vec![f]);
        let result = find_peak((90.0, 110.0), &[], ENVELOPE, SETTINGS, rising);
        assert_eq!(result.end, SearchEnd::Open);
        assert!(!result.bracketed);
    }

    #[test]
    fn a_failed_point_that_could_hide_the_peak_leaves_the_search_incomplete() {
        let result = find_peak(
            (90.0, 110.0),
            &[95.0, 100.0, 105.0],
            ENVELOPE,
            SETTINGS,
            |f: f64| ((f - 100.0).abs() > 1.0).then(|| curves(&[(100.0, 0.5)], &[&[1.0]], f)),
        );
        assert_eq!(result.end, SearchEnd::Incomplete);
    }
}
