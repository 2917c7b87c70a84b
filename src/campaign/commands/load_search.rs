//! Which load a search solves next: successive parabolic interpolation, kept safe by golden section
//! (Brent 1973, chapter 5), over the logarithm of the load.
//!
//! The next load follows from the loads that are solved, whatever order they came in: a search that was
//! interrupted continues as if it had not been, and loads that others have solved count like its own.
//!
//! ```text
//! x = ln N0, f the percentile; (a, b, c) the best load b and the solved loads on either side
//! next = vertex of the parabola through the three, at least delta from each of them
//!      = golden section of the longer side, where the sides differ much or there are no three
//! end:   c - a <= ln(1 + resolution);   delta = 0.45 ln(1 + resolution)
//! ```

/// Share of a side at which golden section cuts it: 1 less the golden ratio less 1.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Ratio of the sides of the best load from which on the longer one is cut by golden section.
const LOPSIDED: f64 = 10.0;

/// Least distance of two loads over the logarithm of 1 + resolution.
const CLOSEST: f64 = 0.45;

/// Where and how closely a search looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct LoadRange {
    /// Lowest load, N.
    pub(super) low: f64,
    /// Highest load, N.
    pub(super) high: f64,
    /// Ratio of the loads that enclose the best one, less 1, at which the search ends.
    pub(super) resolution: f64,
}

impl LoadRange {
    /// Whether a load lies in the range, the ends included.
    pub(super) fn contains(&self, load: f64) -> bool {
        (self.low..=self.high).contains(&load)
    }

    /// The load to solve next, with four significant digits; none where those that enclose the lowest
    /// value are as close as wanted. `solved` are the loads of the range with their values, ascending.
    pub(super) fn next(&self, solved: &[(f64, f64)]) -> Option<f64> {
        let Some(best) = (0..solved.len()).min_by(|&a, &b| solved[a].1.total_cmp(&solved[b].1))
        else {
            return Some(self.low);
        };
        let load = |place: usize| solved[place].0;
        // An end that is not solved encloses nothing yet.
        let left = if best > 0 {
            load(best - 1)
        } else if load(best) > self.low {
            return Some(self.low);
        } else {
            load(best)
        };
        let right = if best + 1 < solved.len() {
            load(best + 1)
        } else if load(best) < self.high {
            return Some(self.high);
        } else {
            load(best)
        };
        if right / left - 1.0 <= self.resolution {
            return None;
        }
        let [a, b, c] = [left, load(best), right].map(f64::ln);
        let (left_side, right_side) = (b - a, c - b);
        let golden = if right_side > left_side {
            b + GOLDEN * right_side
        } else {
            b - GOLDEN * left_side
        };
        let three = best > 0 && best + 1 < solved.len();
        let balanced = three && left_side.max(right_side) < LOPSIDED * left_side.min(right_side);
        let vertex = balanced
            .then(|| {
                vertex(
                    [a, b, c],
                    [best - 1, best, best + 1].map(|place| solved[place].1),
                )
            })
            .flatten();
        let delta = CLOSEST * self.resolution.ln_1p();
        let next = vertex.map_or(golden, |vertex| apart(vertex, [a, b, c], delta));
        let next = four_digits(next.exp());
        // Closer than four digits can tell.
        let known = solved
            .iter()
            .any(|known_load| known_load.0.total_cmp(&next).is_eq());
        (!known && left < next && next < right).then_some(next)
    }

    /// Loads that the search is likely to solve beside `solved`: as many as for a parabola with its vertex
    /// where these suggest it.
    pub(super) fn expected(&self, solved: &[(f64, f64)], most: usize) -> usize {
        let mut modelled = solved.to_vec();
        let middle = self.guess(solved);
        let value = |load: f64| (load.ln() - middle).powi(2);
        for load in &mut modelled {
            load.1 = value(load.0);
        }
        let mut count = 0;
        while count < most
            && let Some(next) = self.next(&modelled)
        {
            let place = modelled.partition_point(|modelled_load| modelled_load.0 < next);
            modelled.insert(place, (next, value(next)));
            count += 1;
        }
        count
    }

    /// Logarithm of the load at which the lowest value is likely.
    fn guess(&self, solved: &[(f64, f64)]) -> f64 {
        let middle = 0.5 * (self.low.ln() + self.high.ln());
        let Some(best) = (0..solved.len()).min_by(|&a, &b| solved[a].1.total_cmp(&solved[b].1))
        else {
            return middle;
        };
        if best == 0 || best + 1 == solved.len() {
            return if solved.len() > 1 {
                solved[best].0.ln()
            } else {
                middle
            };
        }
        let places = [best - 1, best, best + 1];
        vertex(
            places.map(|place| solved[place].0.ln()),
            places.map(|place| solved[place].1),
        )
        .unwrap_or(solved[best].0.ln())
    }
}

/// Vertex of the parabola through three points of which the middle one is not above the others; none
/// where they are on a line or a value is missing.
fn vertex([a, b, c]: [f64; 3], [fa, fb, fc]: [f64; 3]) -> Option<f64> {
    let (left, right) = ((b - a) * (fb - fc), (b - c) * (fb - fa));
    let found = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right);
    (found.is_finite() && a < found && found < c).then_some(found)
}

/// The point nearest to `vertex` at least `delta` from each of the three, or the middle of the longer side
/// where that is too short.
fn apart(vertex: f64, [a, b, c]: [f64; 3], delta: f64) -> f64 {
    let (low, high) = if (vertex - b).abs() < delta {
        // Beside the best load: the longer side closes faster.
        if c - b > b - a { (b, c) } else { (a, b) }
    } else if vertex > b {
        (b, c)
    } else {
        (a, b)
    };
    if high - low < 2.0 * delta {
        0.5 * (low + high)
    } else {
        vertex.clamp(low + delta, high - delta)
    }
}

/// A load with four significant digits: what a folder is named by, and close enough.
pub(super) fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn searched(
        range: LoadRange,
        mut solved: Vec<(f64, f64)>,
        f: fn(f64) -> f64,
    ) -> Vec<(f64, f64)> {
        for _ in 0..40 {
            let Some(next) = range.next(&solved) else {
                return solved;
            };
            assert!(range.contains(next));
            let place = solved.partition_point(|solved_load| solved_load.0 < next);
            solved.insert(place, (next, f(next)));
        }
        panic!("no end: {solved:?}");
    }

    /// Steep below 470 N, shallow above.
    fn valley(load: f64) -> f64 {
        let x = (load / 470.0).ln();
        if x < 0.0 {
            290.0 + 150.0 * x * x
        } else {
            290.0 + 60.0 * x * x
        }
    }

    #[test]
    fn a_search_encloses_the_lowest_value_with_few_loads_and_never_ends_above_a_known_one() {
        let known = vec![
            (320.0, valley(320.0)),
            (480.0, valley(480.0)),
            (800.0, valley(800.0)),
        ];
        for (resolution, most) in [(0.5, 2), (0.2, 4), (0.05, 6), (0.01, 10)] {
            let range = LoadRange {
                low: 320.0,
                high: 800.0,
                resolution,
            };
            let solved = searched(range, known.clone(), valley);
            let best = (0..solved.len())
                .min_by(|&a, &b| solved[a].1.total_cmp(&solved[b].1))
                .unwrap_or_default();
            assert!(
                solved.len() - known.len() <= most,
                "{resolution}: {solved:?}"
            );
            assert!(solved[best].1 <= valley(480.0));
            assert!(solved[best + 1].0 / solved[best - 1].0 - 1.0 <= resolution);
            assert!(solved[best - 1].0 <= 470.0 && 470.0 <= solved[best + 1].0);
        }
        // From nothing, over a wide range.
        let range = LoadRange {
            low: 40.0,
            high: 4000.0,
            resolution: 0.1,
        };
        let solved = searched(range, Vec::new(), valley);
        assert!(solved.len() <= 16, "{solved:?}");
    }

    #[test]
    fn a_search_that_was_interrupted_goes_the_same_way() {
        let range = LoadRange {
            low: 40.0,
            high: 4000.0,
            resolution: 0.1,
        };
        let whole = searched(range, Vec::new(), valley);
        let mut solved: Vec<(f64, f64)> = Vec::new();
        while let Some(next) = range.next(&solved) {
            let place = solved.partition_point(|solved_load| solved_load.0 < next);
            solved.insert(place, (next, valley(next)));
            assert_eq!(searched(range, solved.clone(), valley), whole);
        }
    }

    #[test]
    fn ends_flat_and_missing_values_are_searched_to_an_end() {
        let range = LoadRange {
            low: 100.0,
            high: 1000.0,
            resolution: 0.05,
        };
        for f in [
            (|load| load) as fn(f64) -> f64,
            |load| -load,
            |_| 1.0,
            |_| f64::INFINITY,
        ] {
            let solved = searched(range, Vec::new(), f);
            assert!(solved.len() <= 24, "{}", solved.len());
        }
        assert_eq!(
            range.expected(&[], 24),
            searched(range, Vec::new(), |load| {
                (load.ln() - 0.5 * (100.0_f64.ln() + 1000.0_f64.ln())).powi(2)
            })
            .len()
        );
    }
}
