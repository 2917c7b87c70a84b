//! Axes: from values to places, and the ticks that name them.

/// How values are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm.
    Logarithmic,
    /// Probabilities by the reduced variate `-ln(-ln p)` of Gumbel's law, which spreads the upper tail.
    Gumbel,
}

impl Scale {
    fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.ln(),
            Self::Gumbel => -(-value.ln()).ln(),
        }
    }
}

/// An axis from `low` to `high` between two places of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Axis {
    pub(in crate::report) scale: Scale,
    pub(in crate::report) low: f64,
    pub(in crate::report) high: f64,
    /// Places of both ends, in user units.
    pub(in crate::report) ends: (f64, f64),
}

/// Probabilities that an axis of Gumbel's law names, and their names in percent.
const PROBABILITIES: [(f64, &str); 10] = [
    (0.001, "0.1"),
    (0.01, "1"),
    (0.05, "5"),
    (0.25, "25"),
    (0.5, "50"),
    (0.75, "75"),
    (0.95, "95"),
    (0.99, "99"),
    (0.999, "99.9"),
    (0.9999, "99.99"),
];

/// Ticks of a linear axis at most; a range that is no range of numbers has none.
const MOST_TICKS: f64 = 1000.0;

impl Axis {
    /// Place of `value`, not beyond the ends.
    pub(in crate::report) fn at(&self, value: f64) -> f64 {
        let of = |value: f64| self.scale.of(value);
        let (low, high) = (of(self.low), of(self.high));
        let share = if high > low {
            (of(value) - low) / (high - low)
        } else {
            0.5
        };
        // What is not finite on this scale stands at the end it is nearer to.
        let share = if share.is_nan() {
            0.0
        } else {
            share.clamp(0.0, 1.0)
        };
        self.ends.0 + share * (self.ends.1 - self.ends.0)
    }

    /// Values with names, about `count` of them on a linear axis.
    pub(in crate::report) fn ticks(&self, count: u32) -> Vec<(f64, String)> {
        match self.scale {
            Scale::Linear => {
                // Halves do not leave the range of numbers where the difference does.
                let half = 0.5 * self.high - 0.5 * self.low;
                let step = nice_step(half / (0.5 * f64::from(count.max(1))));
                let first = (self.low / step - 1e-9).ceil();
                let last = (self.high / step + 1e-9).floor();
                let is_range = last - first <= MOST_TICKS;
                if !is_range {
                    return Vec::new();
                }
                let (first, last) = (first as i64, last as i64);
                let decimals = (-step.log10().floor()).max(0.0) as usize;
                (first..=last)
                    .map(|place| {
                        let value = place as f64 * step;
                        (value, format!("{value:.decimals$}"))
                    })
                    .collect()
            }
            Scale::Logarithmic => self.decades(count),
            Scale::Gumbel => PROBABILITIES
                .iter()
                .filter(|(p, _)| (self.low..=self.high).contains(p))
                .map(|&(p, name)| (p, name.to_owned()))
                .collect(),
        }
    }

    /// Powers of ten, and 2 and 5 times them where there is room; where those are few, numbers between them too.
    fn decades(&self, count: u32) -> Vec<(f64, String)> {
        if !(self.low > 0.0 && self.high.is_finite()) {
            return Vec::new();
        }
        let named = |factors: &[f64]| -> Vec<(f64, String)> {
            let (first, last) = (self.low.log10().floor(), self.high.log10().ceil());
            (first as i32..=last as i32)
                .flat_map(|decade| {
                    factors
                        .iter()
                        .map(move |factor| factor * 10_f64.powi(decade))
                })
                .filter(|value| (self.low * 0.999..=self.high * 1.001).contains(value))
                .map(|value| (value, named_number(value)))
                .collect()
        };
        let all = named(&[1.0, 2.0, 5.0]);
        let between = named(&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]);
        if all.len() <= 3 && between.len() as u32 <= count + 3 {
            return between;
        }
        let powers = named(&[1.0]);
        if all.len() as u32 <= count + 3 || powers.len() < 2 {
            all
        } else {
            powers
        }
    }
}

/// A number as short as it can be said exactly; powers of ten where it is very large or small.
fn named_number(value: f64) -> String {
    if (1e-3..1e6).contains(&value) {
        // The shortest text that reads back as about the same.
        format!("{}", (value * 1e9).round() / 1e9)
    } else {
        format!("{value:e}")
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
fn nice_step(step: f64) -> f64 {
    if !(step.is_finite() && step > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|nice| *nice >= 0.999_999 * step)
        .unwrap_or(10.0 * power)
}

/// The end of a linear axis from 0 that holds `largest` with a tick at its end.
pub(in crate::report) fn nice_top(largest: f64, count: u32) -> f64 {
    let step = nice_step(1.02 * largest / f64::from(count.max(1)));
    step * (1.02 * largest / step).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(scale: Scale, low: f64, high: f64) -> Axis {
        Axis {
            scale,
            low,
            high,
            ends: (100.0, 300.0),
        }
    }

    fn names(axis: &Axis, count: u32) -> Vec<String> {
        axis.ticks(count)
            .into_iter()
            .map(|(_, name)| name)
            .collect()
    }

    #[test]
    fn values_stand_where_their_scale_puts_them_and_never_outside() {
        let linear = axis(Scale::Linear, 10.0, 20.0);
        assert!((linear.at(12.5) - 150.0).abs() < 1e-12);
        assert!((linear.at(99.0) - 300.0).abs() < 1e-12);
        let logarithmic = axis(Scale::Logarithmic, 1.0, 100.0);
        assert!((logarithmic.at(10.0) - 200.0).abs() < 1e-12);
        assert!((logarithmic.at(0.0) - 100.0).abs() < 1e-12);
        let gumbel = axis(Scale::Gumbel, 0.1, 0.9);
        // The median of Gumbel's law is 0.3665, its 10th and 90th percentiles -0.8340 and 2.2504.
        let expected =
            100.0 + 200.0 * (0.366_512_92 + 0.834_032_45) / (2.250_367_33 + 0.834_032_45);
        assert!((gumbel.at(0.5) - expected).abs() < 1e-5);
        assert!((gumbel.at(1.0) - 300.0).abs() < 1e-12);
        assert!((gumbel.at(0.0) - 100.0).abs() < 1e-12);
    }

    #[test]
    fn ticks_are_round_numbers_inside_of_the_axis() {
        assert_eq!(
            names(&axis(Scale::Linear, 0.0, 0.5), 5),
            ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]
        );
        assert_eq!(
            names(&axis(Scale::Linear, 557.0, 563.0), 4),
            ["558", "560", "562"]
        );
        assert_eq!(
            names(&axis(Scale::Logarithmic, 3.0, 60.0), 6),
            ["5", "10", "20", "50"]
        );
        assert_eq!(
            names(&axis(Scale::Logarithmic, 190.0, 1100.0), 6),
            ["200", "300", "400", "500", "700", "1000"]
        );
        assert_eq!(
            names(&axis(Scale::Logarithmic, 0.01, 1e7), 5),
            [
                "0.01", "0.1", "1", "10", "100", "1000", "10000", "100000", "1e6", "1e7"
            ]
        );
        assert_eq!(
            names(&axis(Scale::Gumbel, 0.04, 0.995), 5),
            ["5", "25", "50", "75", "95", "99"]
        );
    }

    #[test]
    fn the_end_of_an_axis_holds_the_largest_value() {
        for largest in [1.0, 1.99, 3.7, 980.0, 0.012] {
            let top = nice_top(largest, 5);
            assert!(top >= largest && top <= 1.6 * largest, "{largest}: {top}");
        }
    }
}
