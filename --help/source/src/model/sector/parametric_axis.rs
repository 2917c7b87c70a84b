//! One direction of the lattice of the built-in bladed disk.

/// Coordinates along one direction in half elements: entry `2 e` begins element `e`.
#[derive(Debug, Clone)]
pub(super) struct Axis(pub(super) Vec<f64>);

impl Axis {
    /// Divides each interval between ascending `levels` into its number of elements; levels that
    /// coincide (within 1e-9 of the span) are one.
    pub(super) fn new(levels: &[f64], elements: impl Fn(f64) -> usize) -> Self {
        let span = levels[levels.len() - 1] - levels[0];
        let mut values = vec![levels[0]];
        let mut start = levels[0];
        for &end in &levels[1..] {
            if end - start <= 1e-9 * span {
                continue;
            }
            let halves = 2 * elements(0.5 * (start + end));
            for half in 1..halves {
                values.push(start + (end - start) * half as f64 / halves as f64);
            }
            values.push(end);
            start = end;
        }
        Self(values)
    }

    pub(super) fn elements(&self) -> usize {
        (self.0.len() - 1) / 2
    }

    /// Middle of element `e`.
    pub(super) fn middle(&self, element: usize) -> f64 {
        self.0[2 * element + 1]
    }

    /// Index of the half-element point nearest to a level.
    pub(super) fn index_of(&self, level: f64) -> usize {
        let mut nearest = 0;
        for (index, value) in self.0.iter().enumerate() {
            if (value - level).abs() < (self.0[nearest] - level).abs() {
                nearest = index;
            }
        }
        nearest
    }
}
