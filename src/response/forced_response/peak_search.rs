//! Search for the highest peak of a set of curves over frequency, with evidence that it is the highest.
//!
//! Every blade has a curve; the peak is the largest value over blades and frequency. Near a
//! resonance `1/A^2` is a parabola in frequency, exactly so for a single mode, so a vertex is found
//! by a parabola through three points of one blade's `1/A^2`. Whether a higher peak can hide
//! between two points is judged by an envelope: a resonance of height P and half-bandwidth
//! gamma reads at least `P / sqrt(1 + (d/gamma)^2)` at distance d. Friction only adds damping, and
//! `P gamma` of a mode is fixed by its modal force, so a hidden peak as high as the best one
//! seen is at least as wide as [`Envelope::half_bandwidth`] says. The search ends when no interval can
//! hide a higher peak and the vertex of the best is found.

/// Amplitude of every blade at one frequency; none where the solution failed.
pub type Evaluation = Option<Vec<f64>>;

/// What is known beforehand of the width of peaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// Height times half-bandwidth of the strongest linear resonance, m Hz.
    pub strength: f64,
    /// Smallest half-bandwidth of a linear resonance in the band, Hz.
    pub linear_half_bandwidth_hz: f64,
}

impl Envelope {
    /// Share of the strongest resonance that a competing mode is assumed to have at least.
    const COMPETITOR: f64 = 0.7;

    /// Half-bandwidth assumed of a hidden peak at most, over that of a linear resonance: where
    /// friction holds the best peak far below the linear ones, a competitor need not be as broad.
    const BROADEST: f64 = 5.0;

    /// Half-bandwidth, Hz, assumed of a hidden peak of height `amplitude`.
    fn half_bandwidth(&self, amplitude: f64) -> f64 {
        let linear = self.linear_half_bandwidth_hz;
        Self::COMPETITOR * (self.strength / amplitude).clamp(linear, Self::BROADEST * linear)
    }
}

/// Settings of one search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Relative tolerance of the peak amplitude.
    pub tolerance: f64,
    /// Largest number of evaluations.
    pub evaluations: usize,
    /// Largest number of times that the band is widened while the largest value lies at its end.
    pub extensions: usize,
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
    mut evaluate: impl FnMut(f64) -> Evaluation,
) -> SearchResult {
    let mut search = Search {
        samples: Vec::new(),
        envelope,
        settings,
        evaluations: 0,
    };
    let mut first: Vec<f64> = starts
        .iter()
        .copied()
        .filter(|f| *f > band_hz.0 && *f < band_hz.1)
        .chain([band_hz.0, band_hz.1])
        .collect();
    first.sort_by(f64::total_cmp);
    let resolution = 0.05 * envelope.linear_half_bandwidth_hz;
    first.dedup_by(|later, earlier| *later - *earlier < resolution);
    for frequency in first {
        search.add(frequency, &mut evaluate);
    }
    let mut extensions = 0;
    let end = loop {
        if search.evaluations >= settings.evaluations {
            break SearchEnd::Exhausted;
        }
        let Some(best) = search.best() else {
            break SearchEnd::Incomplete;
        };
        if best == 0 || best + 1 == search.samples.len() {
            if extensions == settings.extensions {
                // The band ends here, but the peak may still lie just inside of its end.
                match search.inside_of_end(best) {
                    Some(frequency) => search.add(frequency, &mut evaluate),
                    None => break SearchEnd::Open,
                }
                continue;
            }
            extensions += 1;
            let width = (band_hz.1 - band_hz.0).max(resolution);
            let at = search.samples[best].frequency_hz;
            let next = if best == 0 {
                at - 0.25 * width
            } else {
                at + 0.25 * width
            };
            if next <= 0.0 {
                break SearchEnd::Open;
            }
            search.add(next, &mut evaluate);
            continue;
        }
        match search.next_frequency(best) {
            Next::Evaluate(frequency) => search.add(frequency, &mut evaluate),
            Next::Hole => break SearchEnd::Incomplete,
            Next::Done => break SearchEnd::Found,
        }
    };
    let best = search.best();
    let bracketed = best.is_some_and(|best| search.bracketed(best));
    SearchResult {
        bracketed,
        best,
        samples: search.samples,
        end,
    }
}

struct Search {
    samples: Vec<Sample>,
    envelope: Envelope,
    settings: SearchSettings,
    evaluations: usize,
}

enum Next {
    Evaluate(f64),
    /// Nothing left to try, but a failed point may hide a higher peak.
    Hole,
    Done,
}

impl Search {
    fn add(&mut self, frequency_hz: f64, evaluate: &mut impl FnMut(f64) -> Evaluation) {
        self.evaluations += 1;
        let amplitudes = evaluate(frequency_hz).unwrap_or_default();
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
            .samples
            .partition_point(|sample| sample.frequency_hz < frequency_hz);
        self.samples.insert(
            place,
            Sample {
                frequency_hz,
                amplitudes,
                largest,
                blade,
            },
        );
    }

    fn best(&self) -> Option<usize> {
        (0..self.samples.len())
            .filter(|&i| !self.samples[i].amplitudes.is_empty())
            .reduce(|best, i| {
                if self.samples[i].largest > self.samples[best].largest {
                    i
                } else {
                    best
                }
            })
    }

    /// Nearest evaluated neighbours of a sample, failed ones passed over.
    fn neighbours(&self, at: usize) -> Option<(usize, usize)> {
        let good = |i: &usize| !self.samples[*i].amplitudes.is_empty();
        let left = (0..at).rev().find(good)?;
        let right = (at + 1..self.samples.len()).find(good)?;
        Some((left, right))
    }

    fn bracketed(&self, best: usize) -> bool {
        self.neighbours(best).is_some_and(|(left, right)| {
            self.samples[left].largest < self.samples[best].largest
                && self.samples[right].largest < self.samples[best].largest
        })
    }

    /// A point inside of the end of the band that is the best so far, until the next one inside is
    /// nearer than a resonance as high could turn within.
    fn inside_of_end(&self, best: usize) -> Option<f64> {
        let at = self.samples[best].frequency_hz;
        let inside = self
            .samples
            .get(if best == 0 { 1 } else { best - 1 })?
            .frequency_hz;
        let near = 0.1 * self.envelope.half_bandwidth(self.samples[best].largest);
        let gap = inside - at;
        (gap.abs() > near).then(|| at + gap.signum() * f64::max(0.25 * gap.abs(), 0.9 * near))
    }

    /// The vertex of the best peak first; then the widest interval that could hide a higher one.
    fn next_frequency(&self, best: usize) -> Next {
        if let Some(vertex) = self.unsettled_vertex(best) {
            return self.short_of_failures(best, vertex);
        }
        self.hidden(best)
    }

    /// The middle of the widest interval that could hide a peak higher than the best.
    fn hidden(&self, best: usize) -> Next {
        let height = self.samples[best].largest * (1.0 + self.settings.tolerance);
        let gamma = self.envelope.half_bandwidth(height);
        let good: Vec<usize> = (0..self.samples.len())
            .filter(|&i| !self.samples[i].amplitudes.is_empty())
            .collect();
        // Distance at which a peak of this height and width would read what was seen.
        let reach = |a: f64| gamma * ((height / a).powi(2) - 1.0).max(0.0).sqrt();
        let mut widest: Option<(f64, f64)> = None;
        let mut hole = false;
        if let (Some(&first), Some(&last)) = (good.first(), good.last()) {
            // Out to the ends of the band, where all points failed.
            let (first, last) = (&self.samples[first], &self.samples[last]);
            let (start, stop) = (&self.samples[0], &self.samples[self.samples.len() - 1]);
            hole |= first.frequency_hz - reach(first.largest) > start.frequency_hz;
            hole |= last.frequency_hz + reach(last.largest) < stop.frequency_hz;
        }
        for pair in good.windows(2) {
            let (left, right) = (&self.samples[pair[0]], &self.samples[pair[1]]);
            if pair[0] == best || pair[1] == best {
                // Beside the best the parabola through it has judged already, unless it is far away.
                let distance = right.frequency_hz - left.frequency_hz;
                if distance <= 2.0 * gamma {
                    continue;
                }
            }
            let from = left.frequency_hz + reach(left.largest);
            let to = right.frequency_hz - reach(right.largest);
            if to <= from {
                continue;
            }
            if pair[1] > pair[0] + 1 {
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

    /// `frequency` itself, or, where a failed point lies between it and the best, a point halfway to
    /// the failed one; a hole once that is too near.
    fn short_of_failures(&self, best: usize, frequency: f64) -> Next {
        let at = self.samples[best].frequency_hz;
        let beside = if frequency > at { best + 1 } else { best - 1 };
        let failed = &self.samples[beside];
        let between = (failed.frequency_hz - at).abs() <= (frequency - at).abs();
        if !failed.amplitudes.is_empty() || !between {
            Next::Evaluate(frequency)
        } else if (failed.frequency_hz - at).abs() > 0.05 * self.envelope.linear_half_bandwidth_hz {
            Next::Evaluate(0.5 * (failed.frequency_hz + at))
        } else {
            Next::Hole
        }
    }

    /// The vertex of the parabola in `1/A^2` through the best sample and its neighbours, unless
    /// the best is known to lie within tolerance of it.
    fn unsettled_vertex(&self, best: usize) -> Option<f64> {
        let (left, right) = self.neighbours(best)?;
        let blade = self.samples[best].blade;
        let point = |i: usize| {
            let sample = &self.samples[i];
            (sample.frequency_hz, sample.amplitudes[blade].powi(-2))
        };
        let (x0, y0) = point(left);
        let (x1, y1) = point(best);
        let (x2, y2) = point(right);
        let amplitude = self.samples[best].largest;
        let (slope_left, slope_right) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
        let curvature = (slope_right - slope_left) / (x2 - x0);
        if curvature.is_nan() || curvature <= 0.0 {
            return None;
        }
        // Vertex of the parabola through the three points, between its outer two.
        let slope = slope_left + curvature * (x1 - x0);
        let vertex = x1 - slope / (2.0 * curvature);
        let bottom = y1 - slope * slope / (4.0 * curvature);
        let predicted = if bottom > 0.0 {
            bottom.powf(-0.5)
        } else {
            f64::INFINITY
        };
        let gain = predicted / amplitude - 1.0;
        let gamma = if bottom > 0.0 {
            (bottom / curvature).sqrt()
        } else {
            0.0
        };
        // The vertex is trusted where the cubic term it neglects, about 0.1 (d/gamma)^3 at a
        // distance d of the neighbours, is below the tolerance.
        let trusted = gamma * (10.0 * self.settings.tolerance).cbrt();
        let (left_gap, right_gap) = (x1 - x0, x2 - x1);
        if gain <= 0.5 * self.settings.tolerance && left_gap.max(right_gap) <= trusted {
            return None;
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
        if gain > 0.5 * self.settings.tolerance && (vertex - x1).abs() > distinct {
            return Some(vertex.clamp(x0 + 0.1 * left_gap, x2 - 0.1 * right_gap));
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
mod tests {
    use super::*;

    const SETTINGS: SearchSettings = SearchSettings {
        tolerance: 1e-4,
        evaluations: 100,
        extensions: 5,
    };

    /// Sum of complex resonances, one blade per row of residues.
    fn curves(poles: &[(f64, f64)], residues: &[&[f64]], f: f64) -> Vec<f64> {
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
        let envelope = Envelope {
            strength: 1.0,
            linear_half_bandwidth_hz: 0.5,
        };
        let result = find_peak((90.0, 110.0), &[100.3], envelope, SETTINGS, |f| {
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
        let envelope = Envelope {
            strength: 1.0,
            linear_half_bandwidth_hz: 0.5,
        };
        let poles = [(100.0, 0.5), (106.3, 0.5)];
        let result = find_peak((90.0, 115.0), &[100.0], envelope, SETTINGS, |f| {
            Some(curves(&poles, &[&[0.9, 0.0], &[0.0, 1.0]], f))
        });
        let best = &result.samples[result.best.expect("evaluated")];
        assert_eq!(best.blade, 1);
        assert!((best.frequency_hz - 106.3).abs() < 0.02);
    }

    #[test]
    fn a_peak_outside_the_band_is_followed_and_a_rising_curve_is_open() {
        let envelope = Envelope {
            strength: 1.0,
            linear_half_bandwidth_hz: 0.5,
        };
        let inside = |f: f64| Some(curves(&[(112.0, 0.5)], &[&[1.0]], f));
        let result = find_peak((90.0, 110.0), &[], envelope, SETTINGS, inside);
        assert!(result.bracketed);
        let rising = |f: f64| Some(vec![f]);
        let result = find_peak((90.0, 110.0), &[], envelope, SETTINGS, rising);
        assert_eq!(result.end, SearchEnd::Open);
        assert!(!result.bracketed);
    }

    #[test]
    fn a_failed_point_that_could_hide_the_peak_leaves_the_search_incomplete() {
        let envelope = Envelope {
            strength: 1.0,
            linear_half_bandwidth_hz: 0.5,
        };
        let result = find_peak(
            (90.0, 110.0),
            &[95.0, 100.0, 105.0],
            envelope,
            SETTINGS,
            |f| ((f - 100.0).abs() > 1.0).then(|| curves(&[(100.0, 0.5)], &[&[1.0]], f)),
        );
        assert_eq!(result.end, SearchEnd::Incomplete);
    }

    #[test]
    fn failed_points_out_to_an_end_of_the_band_leave_the_search_incomplete() {
        let envelope = Envelope {
            strength: 1.0,
            linear_half_bandwidth_hz: 0.5,
        };
        let poles = [(95.0, 0.5), (105.0, 0.5)];
        let residues: &[&[f64]] = &[&[1.0, 0.4]];
        let starts = [95.0, 100.0, 105.0];
        // Of the two peaks the lower one alone is seen, from all sides.
        for (failed, end) in [(98.0, SearchEnd::Incomplete), (0.0, SearchEnd::Found)] {
            let result = find_peak((90.0, 110.0), &starts, envelope, SETTINGS, |f| {
                (f > failed).then(|| curves(&poles, residues, f))
            });
            assert_eq!(result.end, end, "{failed}");
            assert!(result.bracketed);
        }
    }
}
