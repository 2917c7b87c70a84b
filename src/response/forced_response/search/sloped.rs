//! The search where every reading has slopes: cubics between neighbours, of every blade.
//!
//! `y = 1/A^2` and its slope at two samples make a cubic, exact for a single mode however far apart they are. So fewer samples
//! lead to a top, and that of no blade is passed over between two of them. What settles a top are the values of three
//! samples all the same: contact that begins to slip at one more sample of the period makes slopes jump.

use super::envelope::VERTEX_SHARE;
use super::peak_search::Search;
use super::samples::{Sample, Samples};
use super::summit::{self, SlopedPoint, Summit};

/// Share of `1/A^2` that a cubic misses of a top as broad as its points are apart.
const NEGLECTED: f64 = 0.006;
/// Share of the amplitude that slopes put a summit wrong by, for points a half-bandwidth apart: they jump by 3 % of
/// `A/gamma` or so, more where pairs begin to slip.
const ROUGH: f64 = 0.02;
/// What a cubic promises beyond this share of the best, where no peak as high can hide, is the cubic's own.
const BEYOND: f64 = 0.1;

impl Samples {
    /// Whether all samples that are solved have slopes.
    pub fn are_sloped(&self) -> bool {
        let mut solved = self.0.iter().filter(|sample| !sample.amplitudes.is_empty());
        solved.all(|sample| sample.slopes.is_some())
    }

    /// A point of a blade's curve; none where the blade does not move or the slope is not known.
    fn sloped_point(&self, at: usize, blade: usize) -> Option<SlopedPoint> {
        let sample = self.0.get(at)?;
        let amplitude = *sample.amplitudes.get(blade)?;
        let slope = *sample.slopes.as_ref()?.get(blade)?;
        let y = amplitude.powi(-2);
        let moves = amplitude > 0.0 && slope.is_finite();
        moves.then_some((sample.frequency_hz, y, -2.0 * y * slope / amplitude))
    }

    /// Summits of the cubics of all blades between two neighbouring samples.
    fn summits_between(&self, left: usize, right: usize) -> impl Iterator<Item = Summit> + '_ {
        let blades = 0..self.0[left].amplitudes.len();
        blades.filter_map(move |blade| {
            let ends = [left, right].map(|at| self.sloped_point(at, blade));
            summit::of_slopes(ends[0]?, ends[1]?)
        })
    }

    /// Whether a sample is the first or the last, higher than the one beside it, and lower than what lies between.
    pub fn rises_inward(&self, at: usize) -> bool {
        let beside = match at {
            0 => 1,
            last if last + 1 == self.0.len() => last - 1,
            _ => return false,
        };
        let (Some(end), Some(beside)) = (self.0.get(at), self.0.get(beside)) else {
            return false;
        };
        let slope = end.slopes.as_ref().and_then(|slopes| slopes.get(end.blade));
        let inward = beside.frequency_hz - end.frequency_hz;
        slope.is_some_and(|slope| slope * inward > 0.0) && beside.largest < end.largest
    }
}

impl Search {
    /// Where a cubic promises more than the best, or may do so within its own error.
    pub(super) fn promising(&self, best: usize) -> Option<f64> {
        let top = (1.0 + VERTEX_SHARE * self.settings.tolerance) * self.samples.0[best].largest;
        let counts = self.settings.rivals_from * top;
        let mut highest: Option<Summit> = None;
        for right in 1..self.samples.0.len() {
            let left = right - 1;
            let [from, to] = [left, right].map(|at| self.samples.0[at].frequency_hz);
            let width = to - from;
            let hides = self.hiding_place(best, left, right).is_some();
            for summit in self.samples.summits_between(left, right) {
                let widths = width / summit.half_bandwidth_hz;
                let error = 0.5 * NEGLECTED * widths.powi(4) + ROUGH * widths;
                let reach = summit.amplitude * (1.0 + error.min(BEYOND));
                let told = error <= self.settings.tolerance;
                let counts = summit.amplitude > top || (reach > counts && !told);
                let believed = hides || summit.amplitude <= (1.0 + BEYOND) * top;
                let apart = (summit.frequency_hz - from).min(to - summit.frequency_hz);
                let higher = highest.is_none_or(|known| summit.amplitude > known.amplitude);
                if counts && believed && apart > self.fine() && higher {
                    highest = Some(summit);
                }
            }
        }
        highest.map(|summit| summit.frequency_hz)
    }

    /// The samples beside one that tell how the curve bends there: the next ones, where there are slopes none that are too
    /// near.
    pub(super) fn beside(&self, at: usize) -> Option<(usize, usize)> {
        if !self.samples.are_sloped() {
            return self.samples.neighbours(at);
        }
        let frequency_hz = self.samples.0[at].frequency_hz;
        let good = |i: &usize| {
            let other = &self.samples.0[*i];
            !other.amplitudes.is_empty() && (other.frequency_hz - frequency_hz).abs() > self.fine()
        };
        let left = (0..at).rev().find(good)?;
        let right = (at + 1..self.samples.0.len()).find(good)?;
        Some((left, right))
    }

    /// Distance within which slopes and values tell of their jumps rather than of the top: a linear resonance falls by half
    /// the tolerance.
    fn fine(&self) -> f64 {
        self.settings.tolerance.sqrt() * self.envelope.linear_half_bandwidth_hz
    }

    /// `frequency_hz` itself, or, where there are slopes and a sample is as near as that already, the middle of the wider
    /// gap beside the best; none if that is as narrow.
    pub(super) fn not_known(&self, best: usize, frequency_hz: f64) -> Option<f64> {
        let near = |sample: &Sample| (sample.frequency_hz - frequency_hz).abs() <= self.fine();
        if !self.samples.are_sloped() || !self.samples.0.iter().any(near) {
            return Some(frequency_hz);
        }
        let (left, right) = self.beside(best)?;
        let [from, at, to] = [left, best, right].map(|i| self.samples.0[i].frequency_hz);
        let gap = if to - at > at - from {
            to - at
        } else {
            from - at
        };
        (gap.abs() > 4.0 * self.fine()).then_some(at + 0.5 * gap)
    }
}

#[cfg(test)]
mod tests {
    use super::super::envelope::{Envelope, SearchSettings};
    use super::super::peak_search::find_peak;
    use super::super::peak_search::tests::evaluations_of_flat_tops;
    use super::super::samples::Reading;
    use crate::linalg::Complex64;

    /// Sum of complex resonances, one blade per row of residues, with its slopes.
    fn reading(poles: &[(f64, f64)], residues: &[&[f64]], f: f64) -> Reading {
        let (mut amplitudes, mut slopes) = (Vec::new(), Vec::new());
        for row in residues {
            let parts = row.iter().zip(poles).map(|(r, &(f0, gamma))| {
                let pole = Complex64::new(f0 - f, gamma);
                (r / pole, r / (pole * pole))
            });
            let (u, rate) = parts.fold(
                Default::default(),
                |(u, rate): (Complex64, Complex64), term| (u + term.0, rate + term.1),
            );
            amplitudes.push(u.norm());
            slopes.push((u.conj() * rate).re / u.norm());
        }
        Reading {
            amplitudes,
            slopes: Some(slopes),
        }
    }

    #[test]
    fn flat_and_skewed_tops_are_found_by_slopes_in_fewer_evaluations() {
        let evaluations = evaluations_of_flat_tops(reading);
        assert!(evaluations < 400 * 9, "{evaluations}");
    }

    /// A narrow top of another blade between two samples is told by their slopes alone.
    #[test]
    fn a_rival_between_two_samples_is_found() {
        let envelope = Envelope {
            strength: 1.0,
            linear_half_bandwidth_hz: 0.5,
        };
        let settings = SearchSettings {
            tolerance: 1e-3,
            evaluations: 100,
            extensions: 5,
            rivals_from: 1.0,
        };
        let poles = [(100.0, 0.5), (100.6, 0.5)];
        let curve = |f: f64| reading(&poles, &[&[1.0, 0.0], &[0.0, 1.01]], f);
        let result = find_peak((95.0, 105.0), &[100.0], envelope, settings, |f| {
            Some(curve(f))
        });
        let best = &result.samples[result.best.expect("evaluated")];
        assert_eq!(best.blade, 1);
        assert!(best.largest > (1.0 - 1e-3) * 2.02, "{}", best.largest);
    }
}
