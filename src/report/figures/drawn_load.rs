//! A load as it is drawn: its percentiles, tuned peak, measured wheels and numerical error.

use crate::population::statistics::Percentile;
use crate::report::ScenarioSummary;
use crate::report::plot::Mark;

/// Percentiles drawn: in percent, class, mark. Through hollow marks a bound is seen that is narrower than its mark.
pub(super) const DRAWN: [(u32, &str, Mark); 3] = [
    (99, "hollow extreme", Mark::Diamond),
    (95, "hollow high", Mark::Square),
    (50, "hollow median", Mark::Circle),
];

/// A load with its numbers in the unit of the figure.
pub(super) struct Load<'a> {
    pub(super) scenario: &'a ScenarioSummary,
    pub(super) tuned: Option<f64>,
    pub(super) percentiles: Vec<Percentile>,
    /// Measured wheels with their peaks.
    pub(super) wheels: Vec<(u32, f64)>,
    /// What the load is chosen by, as an interval with numerical error; none where that leaves no load open.
    pub(super) with_error: Option<(f64, f64)>,
}

impl<'a> Load<'a> {
    /// A load of which nothing is known yet.
    pub(super) fn new(scenario: &'a ScenarioSummary) -> Self {
        Self {
            scenario,
            tuned: None,
            percentiles: Vec::new(),
            wheels: Vec::new(),
            with_error: None,
        }
    }

    pub(super) fn percentile(&self, percent: u32) -> Option<&Percentile> {
        self.percentiles
            .iter()
            .find(|found| found.percent.total_cmp(&f64::from(percent)).is_eq())
    }

    pub(super) fn value(&self, percent: u32) -> Option<f64> {
        self.percentile(percent)?.value
    }

    /// The place of the measured wheel with the largest peak.
    pub(super) fn worst_wheel(&self) -> Option<usize> {
        let wheels = self.wheels.iter().enumerate();
        let worst = wheels.max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        worst.map(|(place, _)| place)
    }

    /// All values that are drawn of the load.
    pub(super) fn values(&self) -> Vec<f64> {
        let of = |percent: u32| {
            self.percentile(percent)
                .filter(|found| found.value.is_some())
                .map_or([None; 3], |found| [found.value, found.lower, found.upper])
        };
        [5, 50, 95, 99]
            .into_iter()
            .flat_map(of)
            .chain([self.tuned])
            .flatten()
            .chain(self.wheels.iter().map(|wheel| wheel.1))
            .chain(self.with_error.iter().flat_map(|&(low, high)| [low, high]))
            .collect()
    }
}

pub(super) fn scaled(found: &Percentile, scale: f64) -> Percentile {
    let of = |value: Option<f64>| value.map(|value| value / scale);
    Percentile {
        value: of(found.value),
        lower: of(found.lower),
        upper: of(found.upper),
        ..*found
    }
}
