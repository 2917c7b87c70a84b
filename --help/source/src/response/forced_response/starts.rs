//! Initial guesses at a frequency of a row: polynomials through the solutions known beside it.

use super::point::Point;

/// Share of the frequency within which a point at which most pairs slip tells more than the stuck solution.
pub(super) const NEAR: f64 = 0.002;

/// The point nearest to a frequency, Hz.
pub(super) fn nearest(points: &[Point], frequency_hz: f64) -> Option<&Point> {
    points.iter().min_by(|a, b| {
        let distance = |point: &Point| (point.frequency_hz - frequency_hz).abs();
        distance(a).total_cmp(&distance(b))
    })
}

/// The solution of the nearest point, and the polynomials through the two and three nearest with points on
/// either side.
pub(super) fn between(points: &[Point], frequency_hz: f64) -> Vec<Vec<f64>> {
    let distance = |point: &Point| (point.frequency_hz - frequency_hz).abs();
    let mut near: Vec<&Point> = points.iter().collect();
    near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(&first) = near.first() else {
        return Vec::new();
    };
    let below = first.frequency_hz <= frequency_hz;
    let other = near[1..]
        .iter()
        .find(|point| (point.frequency_hz <= frequency_hz) != below);
    let Some(&second) = other else {
        let ahead = first.slope.as_ref().map(|slope| {
            let step = frequency_hz - first.frequency_hz;
            let tangent = first.solution.iter().zip(&slope.solution);
            tangent.map(|(x, slope)| x + step * slope).collect()
        });
        return ahead.into_iter().chain([first.solution.clone()]).collect();
    };
    if let Some(start) = hermite(first, second, frequency_hz) {
        return vec![start];
    }
    let mut starts = vec![interpolated(&[first, second], frequency_hz)];
    let third = near[1..].iter().find(|point| {
        let differs = |other: &Point| point.frequency_hz.total_cmp(&other.frequency_hz).is_ne();
        differs(first) && differs(second)
    });
    if let Some(&third) = third {
        starts.push(interpolated(&[first, second, third], frequency_hz));
    }
    starts
}

/// The cubic through two solutions with their slopes at `frequency_hz`; none where a slope is not known.
fn hermite(first: &Point, second: &Point, frequency_hz: f64) -> Option<Vec<f64>> {
    let (first_slope, second_slope) = (first.slope.as_ref()?, second.slope.as_ref()?);
    let width = second.frequency_hz - first.frequency_hz;
    let t = (frequency_hz - first.frequency_hz) / width;
    let values = [(1.0 + 2.0 * t) * (1.0 - t).powi(2), t * t * (3.0 - 2.0 * t)];
    let slopes = [width * t * (1.0 - t).powi(2), width * t * t * (t - 1.0)];
    let ends = first.solution.iter().zip(&second.solution);
    let rates = first_slope.solution.iter().zip(&second_slope.solution);
    let sum = ends.zip(rates).map(|((x0, x1), (s0, s1))| {
        values[0] * x0 + values[1] * x1 + slopes[0] * s0 + slopes[1] * s1
    });
    Some(sum.collect())
}

/// The polynomial through the solutions of `points`, of different frequencies, at `frequency_hz`.
fn interpolated(points: &[&Point], frequency_hz: f64) -> Vec<f64> {
    let mut sum = vec![0.0; points[0].solution.len()];
    for (at, point) in points.iter().enumerate() {
        let others = points.iter().enumerate().filter(|(other, _)| *other != at);
        let share: f64 = others
            .map(|(_, other)| {
                (frequency_hz - other.frequency_hz) / (point.frequency_hz - other.frequency_hz)
            })
            .product();
        for (sum, x) in sum.iter_mut().zip(&point.solution) {
            *sum += share * x;
        }
    }
    sum
}
