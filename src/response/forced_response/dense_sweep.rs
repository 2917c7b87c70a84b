//! The peak of a row by brute force: what the peak search is audited against.
//!
//! Every frequency of a grid of a quarter of a half-bandwidth is solved; round every local maximum
//! that could still win, the grid is refined. Nothing is assumed of the shape of a resonance but
//! that it is not narrower than a linear one: half a step off, such a resonance reads at least
//! 0.992 of its height.

/// Steps in a half-bandwidth.
const STEPS: f64 = 4.0;
/// Steps of the refined grid in one of the coarse grid.
const REFINEMENT: usize = 25;
/// Share of the highest value from which on a local maximum is refined; below 0.992.
const CONTENDER: f64 = 0.98;

/// The highest value that a dense sweep saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DensePeak {
    /// Largest amplitude over blades and frequencies, m.
    pub amplitude_m: f64,
    /// Frequency of the largest amplitude, Hz.
    pub frequency_hz: f64,
    /// Number of frequencies solved, failed ones included.
    pub points: usize,
    /// Number of frequencies that could not be solved; each reads as nothing.
    pub failed: usize,
    /// Number of frequencies that were solved with fewer harmonics than the rest; counted by who solves them.
    pub with_fewer_harmonics: usize,
    /// Whether the largest value lies inside of the band.
    pub inside: bool,
}

/// Sweeps `band_hz` by steps of a quarter of `half_bandwidth_hz` (that of the narrowest linear
/// resonance) and refines the best places 25 times.
///
/// `largest` gives the largest amplitude over the blades at ascending frequencies, none where the
/// solution failed.
pub fn dense_peak(
    band_hz: (f64, f64),
    half_bandwidth_hz: f64,
    mut largest: impl FnMut(&[f64]) -> Vec<Option<f64>>,
) -> DensePeak {
    let (start, stop) = band_hz;
    let steps = ((stop - start) * STEPS / half_bandwidth_hz).ceil().max(2.0) as usize;
    let frequencies = grid(start, stop, steps);
    let coarse = largest(&frequencies);
    let value = |at: usize| coarse[at].unwrap_or(0.0);
    let best = (0..=steps).fold(
        0,
        |best, at| if value(at) > value(best) { at } else { best },
    );
    let mut peak = DensePeak {
        amplitude_m: value(best),
        frequency_hz: frequencies[best],
        points: coarse.len(),
        failed: missing(&coarse),
        with_fewer_harmonics: 0,
        inside: best > 0 && best < steps,
    };
    let contender = CONTENDER * peak.amplitude_m;
    for at in 1..steps {
        let summit = value(at) >= value(at - 1).max(value(at + 1));
        if !(summit && value(at) > contender) {
            continue;
        }
        let around = grid(frequencies[at - 1], frequencies[at + 1], 2 * REFINEMENT);
        let fine = largest(&around);
        peak.points += fine.len();
        peak.failed += missing(&fine);
        for (&frequency_hz, amplitude) in around.iter().zip(&fine) {
            if let Some(amplitude) = amplitude.filter(|amplitude| *amplitude > peak.amplitude_m) {
                (peak.amplitude_m, peak.frequency_hz) = (amplitude, frequency_hz);
            }
        }
    }
    peak
}

fn missing(values: &[Option<f64>]) -> usize {
    values.iter().filter(|value| value.is_none()).count()
}

/// `steps + 1` equidistant frequencies, both ends included.
fn grid(start: f64, stop: f64, steps: usize) -> Vec<f64> {
    (0..=steps)
        .map(|i| start + (stop - start) * i as f64 / steps as f64)
        .collect()
}
