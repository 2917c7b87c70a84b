//! The samples of a search in order of frequency, and what neighbours say of each and of local maxima beside the best.

use super::envelope::{NEAR, RESOLVED, SearchSettings, VERTEX_SHARE};
use super::summit::{self, CurvePoint, Summit};

/// Distance of two solved points, in half-bandwidths of a linear resonance, within which no top is looked for between them.
const NO_TOP: f64 = 0.5;
/// Distance of a failed point from a solved one, in these, that is near enough.
const BESIDE_LOST: f64 = 0.1;

/// Curves over frequency, one per blade, that a search reads.
pub trait Curve {
    /// Amplitude of every blade, m, at a frequency, Hz; none where the solution failed.
    fn read(&mut self, frequency_hz: f64) -> Option<Vec<f64>>;

    /// A frequency, Hz, that a search has to look at for other reasons than its `samples`, of which `best` is the highest.
    fn unseen(&self, _samples: &[Sample], _best: usize) -> Option<f64> {
        None
    }

    /// Whether it can be steeper than the envelope of a resonance allows for, as where a contact opens.
    fn is_steep(&self) -> bool {
        false
    }
}

impl<F: FnMut(f64) -> Option<Vec<f64>>> Curve for F {
    fn read(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
        self(frequency_hz)
    }
}

/// One evaluated frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude of every blade; empty where the solution failed.
    pub amplitudes: Vec<f64>,
    /// Largest amplitude over the blades.
    pub largest: f64,
    /// Blade of the largest amplitude.
    pub blade: usize,
}

/// What failed points between two solved ones leave to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lost {
    /// Nothing: the solved ones are so near to each other that no top fits between them.
    Narrow,
    /// To look from nearer, at this frequency, Hz.
    Nearer(f64),
    /// Nothing: points fail as near as is looked.
    Hole,
}

/// Samples, ascending in frequency.
#[derive(Debug, Clone, Default)]
pub struct Samples(pub Vec<Sample>);

impl Samples {
    /// Adds what was read at a frequency, Hz; none where the solution failed.
    pub fn insert(&mut self, frequency_hz: f64, amplitudes: Option<Vec<f64>>) {
        let amplitudes = amplitudes.unwrap_or_default();
        let (blade, largest) = amplitudes.iter().copied().enumerate().fold(
            (0, f64::NEG_INFINITY),
            |best, (blade, amplitude)| {
                if amplitude > best.1 {
                    (blade, amplitude)
                } else {
                    best
                }
            },
        );
        let place = self
            .0
            .partition_point(|sample| sample.frequency_hz < frequency_hz);
        self.0.insert(
            place,
            Sample {
                frequency_hz,
                amplitudes,
                largest,
                blade,
            },
        );
    }

    pub fn best(&self) -> Option<usize> {
        (0..self.0.len())
            .filter(|&i| !self.0[i].amplitudes.is_empty())
            .reduce(|best, i| {
                if self.0[i].largest > self.0[best].largest {
                    i
                } else {
                    best
                }
            })
    }

    /// Nearest evaluated neighbours of a sample, failed ones passed over.
    pub fn neighbours(&self, at: usize) -> Option<(usize, usize)> {
        let good = |i: &usize| !self.0[*i].amplitudes.is_empty();
        let left = (0..at).rev().find(good)?;
        let right = (at + 1..self.0.len()).find(good)?;
        Some((left, right))
    }

    /// What to do about the failed points between two solved ones: to look beside the solved ones first, then between failed ones.
    pub(super) fn lost_between(
        &self,
        left: usize,
        right: usize,
        linear_half_bandwidth_hz: f64,
    ) -> Lost {
        let at = |sample: usize| self.0[sample].frequency_hz;
        let width = |from: usize| (at(from + 1) - at(from)) / linear_half_bandwidth_hz;
        if (at(right) - at(left)) / linear_half_bandwidth_hz <= NO_TOP {
            return Lost::Narrow;
        }
        let beside = [left, right - 1].into_iter();
        let beside = beside.filter(|&from| width(from) > BESIDE_LOST);
        let between = (left + 1..right - 1).filter(|&from| width(from) > NO_TOP);
        let wider = |a: &usize, b: &usize| width(*a).total_cmp(&width(*b));
        match beside.max_by(wider).or_else(|| between.max_by(wider)) {
            Some(from) => Lost::Nearer(0.5 * (at(from) + at(from + 1))),
            None => Lost::Hole,
        }
    }

    /// What to do about the failed points on one side of a solved one.
    pub(super) fn lost_beside(
        &self,
        at: usize,
        above: bool,
        linear_half_bandwidth_hz: f64,
    ) -> Lost {
        let Some((left, right)) = self.neighbours(at) else {
            return Lost::Hole;
        };
        let (left, right) = if above { (at, right) } else { (left, at) };
        self.lost_between(left, right, linear_half_bandwidth_hz)
    }

    /// Whether lower amplitudes were seen on both sides.
    pub fn bracketed(&self, best: usize) -> bool {
        let sample = &self.0[best];
        // Where the curve jumps a search can ask for the same frequency twice.
        let elsewhere = |other: &&Sample| {
            let same = other.frequency_hz.total_cmp(&sample.frequency_hz).is_eq();
            !other.amplitudes.is_empty() && !same
        };
        let left = self.0[..best].iter().rev().find(elsewhere);
        let right = self.0[best + 1..].iter().find(elsewhere);
        match (left, right) {
            (Some(left), Some(right)) => {
                left.largest < sample.largest && right.largest < sample.largest
            }
            _ => false,
        }
    }

    /// Whether there is a sample beyond the neighbours of one.
    pub fn has_fourth(&self, at: usize) -> bool {
        self.neighbours(at).is_some_and(|(left, right)| {
            self.neighbours(left).is_some() || self.neighbours(right).is_some()
        })
    }

    /// Summits near a sample by cubics, of every blade that is the largest there or beside it.
    pub fn skewed_summits(&self, at: usize) -> Vec<Summit> {
        let Some((left, right)) = self.neighbours(at) else {
            return Vec::new();
        };
        let beyond = [
            self.neighbours(left).map(|(beyond, _)| beyond),
            self.neighbours(right).map(|(_, beyond)| beyond),
        ];
        let mut blades = [left, at, right].map(|i| self.0[i].blade).to_vec();
        blades.dedup();
        blades
            .iter()
            .flat_map(|&blade| {
                let points = self.points([left, at, right], blade);
                beyond
                    .iter()
                    .flatten()
                    .filter_map(move |&i| summit::of_cubic(points, self.point(i, blade)))
            })
            .collect()
    }

    /// The summit of another local maximum that may be higher than the best.
    pub(super) fn rival(&self, best: usize, settings: SearchSettings) -> Option<f64> {
        let top = (1.0 + VERTEX_SHARE * settings.tolerance) * self.0[best].largest;
        let height = settings.rivals_from * top;
        let mut highest: Option<(f64, f64)> = None;
        for at in (0..self.0.len()).filter(|&at| at != best) {
            let Some((left, right)) = self.neighbours(at).filter(|_| self.bracketed(at)) else {
                continue;
            };
            let points = self.points([left, at, right], self.0[at].blade);
            let summits = || {
                self.skewed_summits(at)
                    .into_iter()
                    .chain(summit::of_parabola(points))
                    .filter(|summit| summit.amplitude.is_finite())
            };
            let Some(summit) = summits().reduce(Summit::higher) else {
                continue;
            };
            // Where parabola and cubics differ, the truth may lie as far on the other side.
            let lowest = summits().fold(f64::INFINITY, |low, other| low.min(other.amplitude));
            let reach = 2.0 * summit.amplitude - lowest;
            // What cannot be the best need not be known better than by a parabola.
            let near = if reach > top { NEAR } else { 1.0 };
            if reach > height
                && is_unseen(points, summit, near, settings)
                && highest.is_none_or(|(_, known)| reach > known)
            {
                highest = Some((summit.frequency_hz, reach));
            }
        }
        self.exceeded_rival(top, settings)
            .into_iter()
            .chain(highest)
            .reduce(|a, b| if b.1 > a.1 { b } else { a })
            .map(|(frequency, _)| frequency)
    }

    /// The highest summit above `top` of a blade that another one exceeds at its highest sample: frequency, Hz, and height.
    fn exceeded_rival(&self, top: f64, settings: SearchSettings) -> Option<(f64, f64)> {
        let summits = (0..self.0.len()).flat_map(|at| {
            let beside = self.neighbours(at);
            beside.into_iter().flat_map(move |(left, right)| {
                let here = &self.0[at].amplitudes;
                let exceeds =
                    move |other: usize, blade: usize| here[blade] > self.0[other].amplitudes[blade];
                (0..here.len())
                    .filter(move |&blade| blade != self.0[at].blade || !self.bracketed(at))
                    .filter(move |&blade| exceeds(left, blade) && exceeds(right, blade))
                    .filter_map(move |blade| {
                        let points = self.points([left, at, right], blade);
                        let summit = summit::of_parabola(points)?;
                        let higher = summit.amplitude.is_finite() && summit.amplitude > top;
                        (higher && is_unseen(points, summit, NEAR, settings))
                            .then_some((summit.frequency_hz, summit.amplitude))
                    })
            })
        });
        summits.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }

    pub fn points(&self, at: [usize; 3], blade: usize) -> [CurvePoint; 3] {
        at.map(|i| self.point(i, blade))
    }

    pub fn point(&self, at: usize, blade: usize) -> CurvePoint {
        let sample = &self.0[at];
        (sample.frequency_hz, sample.amplitudes[blade].powi(-2))
    }
}

/// Whether a summit lies away from the middle of its three samples, and these are farther apart than is trusted.
fn is_unseen(points: [CurvePoint; 3], summit: Summit, near: f64, settings: SearchSettings) -> bool {
    let [left, middle, right] = points.map(|(frequency_hz, _)| frequency_hz);
    let away = (summit.frequency_hz - middle).abs();
    let gap = (right - middle).max(middle - left);
    away > (right - left) * RESOLVED && gap > near * settings.trusted_hz(summit.half_bandwidth_hz)
}
