//! The joint law of a surrogate and the value that it stands for, as a pilot shows it.

/// Rows of a pilot, and of the whole sample, at least.
pub(super) const FEWEST_PILOT: usize = 30;
/// Factor on the spread about the surrogate that the pilot shows: it may be larger in the tail.
const SPREAD_SAFETY: f64 = 1.25;

/// Value y as a line over the surrogate x, with a normal rest, by regression.
pub(super) struct JointLaw {
    /// Mean of the surrogates.
    pub(super) x: f64,
    /// Mean of the values.
    pub(super) y: f64,
    pub(super) slope: f64,
    variance_x: f64,
    variance_y: f64,
    /// Standard deviation of the rest, larger than seen.
    pub(super) rest: f64,
}

impl JointLaw {
    /// None where pairs are too few, or the surrogate does not vary with the value.
    pub(super) fn of(pairs: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let pairs: Vec<(f64, f64)> = pairs.collect();
        if pairs.len() < FEWEST_PILOT / 2 {
            return None;
        }
        let count = pairs.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|pair| pair.0), mean(|pair| pair.1));
        let xx: f64 = pairs.iter().map(|pair| (pair.0 - x).powi(2)).sum();
        let xy: f64 = pairs.iter().map(|pair| (pair.0 - x) * (pair.1 - y)).sum();
        let yy: f64 = pairs.iter().map(|pair| (pair.1 - y).powi(2)).sum();
        let slope = xy / xx;
        let rest: f64 = pairs
            .iter()
            .map(|pair| (pair.1 - y - slope * (pair.0 - x)).powi(2))
            .sum();
        let rest = SPREAD_SAFETY * (rest / (count - 2.0)).sqrt();
        (slope > 0.0 && slope.is_finite() && rest > 0.0).then_some(Self {
            x,
            y,
            slope,
            variance_x: xx / count,
            variance_y: yy / count,
            rest,
        })
    }

    pub(super) fn spread_x(&self) -> f64 {
        self.variance_x.sqrt()
    }

    pub(super) fn correlation(&self) -> f64 {
        self.slope * (self.variance_x / self.variance_y).sqrt()
    }
}
