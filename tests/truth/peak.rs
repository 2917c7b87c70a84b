//! The highest amplitude round a frequency: three frequencies beside each other with the highest in the middle, and one
//! where the parabola through `1/A^2` has its vertex, which is exact for a single resonance of any damping.

use faer::Mat;

use super::contact::Period;
use super::iteration::{AtRest, Case, Point, solve_with};
use super::sector::Sector;

/// Distance of the three frequencies, relative: a quarter of the half-bandwidth of the structure alone.
const SPACING_OF_LOSS_FACTOR: f64 = 0.125;
/// Distance of the closer ones over this.
const CLOSER: f64 = 0.125;
/// Most frequencies of one peak.
const MOST_POINTS: usize = 24;

/// A peak and how many frequencies it took.
pub struct Peak {
    pub top: Point,
    pub points: usize,
}

/// The peak round `hint_hz`; none where a frequency on the way to it could not be solved.
pub fn peak(
    sector: &Sector,
    case: &Case,
    period: &Period,
    hint_hz: f64,
    start: Option<&Mat<f64>>,
) -> Option<Peak> {
    peak_spaced(sector, case, period, (hint_hz, start), 1.0)
}

/// The peak by frequencies close beside each other, for a top with a kink, where contacts begin to open: a parabola through three points
/// that stand apart has its vertex beside it.
pub fn close_peak(sector: &Sector, case: &Case, period: &Period, hint_hz: f64) -> Option<Peak> {
    peak_spaced(sector, case, period, (hint_hz, None), CLOSER)
}

fn peak_spaced(
    sector: &Sector,
    case: &Case,
    period: &Period,
    (hint_hz, start): (f64, Option<&Mat<f64>>),
    share: f64,
) -> Option<Peak> {
    let spacing_hz = share * SPACING_OF_LOSS_FACTOR * case.loss_factor * hint_hz;
    let mut points: Vec<Point> = Vec::new();
    let at_rest = AtRest::default();
    let add = |points: &mut Vec<Point>, frequency_hz: f64| -> Option<f64> {
        let distance = |own: &&Point| (own.frequency_hz - frequency_hz).abs();
        let nearest = points
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let start = nearest.map(|own| &own.motion).or(start);
        let point = solve_with(sector, case, period, (frequency_hz, start), &at_rest)?;
        let amplitude_m = point.amplitude_m();
        let at = points.partition_point(|own| own.frequency_hz < frequency_hz);
        points.insert(at, point);
        Some(amplitude_m)
    };
    for place in [0.0, -1.0, 1.0] {
        add(&mut points, hint_hz + place * spacing_hz)?;
    }
    let highest = |points: &[Point]| {
        let height = |at: &usize| points[*at].amplitude_m();
        (0..points.len())
            .max_by(|a, b| height(a).total_cmp(&height(b)))
            .expect("points")
    };
    while points.len() < MOST_POINTS {
        let at = highest(&points);
        if at == 0 || at + 1 == points.len() {
            // Steps grow, so that a hint that is far off is left behind.
            let stride = spacing_hz * f64::max(1.0, points.len() as f64 / 4.0);
            let side = if at == 0 { -stride } else { stride };
            let next = points[at].frequency_hz + side;
            add(&mut points, next)?;
            continue;
        }
        let around = &points[at - 1..=at + 1];
        let vertex_hz = vertex(around)?;
        let to_top = (vertex_hz - points[at].frequency_hz).abs();
        if to_top < 0.02 * spacing_hz {
            return Some(Peak {
                points: points.len(),
                top: points.swap_remove(at),
            });
        }
        add(&mut points, vertex_hz)?;
    }
    None
}

/// Where the parabola through `1/A^2` of three points is lowest.
fn vertex(around: &[Point]) -> Option<f64> {
    let [a, b, c] = [0, 1, 2].map(|at| {
        let own: &Point = &around[at];
        (own.frequency_hz, own.amplitude_m().powi(-2))
    });
    let (left, right) = ((b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0));
    let curvature = (right - left) / (c.0 - a.0);
    let middle = 0.5 * (a.0 + b.0) - 0.5 * left / curvature;
    (curvature > 0.0 && (a.0..=c.0).contains(&middle)).then_some(middle)
}
