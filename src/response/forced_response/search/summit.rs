//! The summit of one curve between the neighbours of a sample, from three or four of its points.
//!
//! `y = 1/A^2` of a single mode is a parabola in frequency exactly; several modes and friction skew it,
//! which a cubic through a fourth point shows.

/// A point of a curve: frequency, Hz, and `1/A^2`.
pub type CurvePoint = (f64, f64);

/// What a polynomial says of the highest place between the outer two of three points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summit {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude; infinite where the polynomial reaches zero.
    pub amplitude: f64,
    /// Distance at which the amplitude has fallen to `1/sqrt 2`, Hz; zero where it is infinite.
    pub half_bandwidth_hz: f64,
}

impl Summit {
    /// The higher one of two.
    pub fn higher(self, other: Self) -> Self {
        if other.amplitude > self.amplitude {
            other
        } else {
            self
        }
    }
}

/// `y = y1 + slope t + curvature t^2`, `t` from the middle point: the parabola through three points,
/// ascending in frequency.
#[derive(Debug, Clone, Copy)]
struct Parabola {
    slope: f64,
    curvature: f64,
}

impl Parabola {
    fn through([(x0, y0), (x1, y1), (x2, y2)]: [CurvePoint; 3]) -> Self {
        let (left, right) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
        let curvature = (right - left) / (x2 - x0);
        Self {
            slope: left + curvature * (x1 - x0),
            curvature,
        }
    }
}

/// Summit of the parabola through three points, ascending in frequency; none if it has none.
pub fn of_parabola(points: [CurvePoint; 3]) -> Option<Summit> {
    of_cubic_term(points, 0.0)
}

/// Summit of the cubic that passes through a fourth point as well; none if it has none between the
/// outer two of the three.
pub fn of_cubic(points: [CurvePoint; 3], fourth: CurvePoint) -> Option<Summit> {
    let [(x0, _), (x1, y1), (x2, _)] = points;
    let parabola = Parabola::through(points);
    let t = fourth.0 - x1;
    let missed = fourth.1 - (y1 + t * (parabola.slope + t * parabola.curvature));
    let summit = of_cubic_term(points, missed / ((fourth.0 - x0) * t * (fourth.0 - x2)))?;
    (summit.frequency_hz > x0 && summit.frequency_hz < x2).then_some(summit)
}

/// Height and width where `1/A^2` has this minimum and half this second derivative.
fn summit_at(bottom: f64, bend: f64) -> Summit {
    let open = bottom > 0.0;
    Summit {
        frequency_hz: 0.0,
        amplitude: if open {
            bottom.powf(-0.5)
        } else {
            f64::INFINITY
        },
        half_bandwidth_hz: if open { (bottom / bend).sqrt() } else { 0.0 },
    }
}

/// Minimum of `parabola + c (x - x0)(x - x1)(x - x2)`.
fn of_cubic_term(points: [CurvePoint; 3], c: f64) -> Option<Summit> {
    let [(x0, _), (x1, y1), (x2, _)] = points;
    let parabola = Parabola::through(points);
    let (a, b) = (x0 - x1, x2 - x1);
    let slope = parabola.slope + c * a * b;
    let curvature = parabola.curvature - c * (a + b);
    // Half the second derivative at the minimum.
    let bend = (curvature * curvature - 3.0 * c * slope).sqrt();
    let t = -slope / (curvature + bend);
    if !(bend > 0.0 && t.is_finite()) || (c == 0.0 && curvature <= 0.0) {
        return None;
    }
    let bottom = y1 + t * (slope + t * (curvature + t * c));
    Some(Summit {
        frequency_hz: x1 + t,
        ..summit_at(bottom, bend)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_met_exactly_and_a_cubic_by_its_fourth_point() {
        let resonance = |x: f64| (x, 2.0 + 0.5 * (x - 100.3).powi(2));
        let points = [99.0, 100.0, 102.0].map(resonance);
        let summit = of_parabola(points).expect("convex");
        assert!((summit.frequency_hz - 100.3).abs() < 1e-12);
        assert!((summit.amplitude - 2.0_f64.powf(-0.5)).abs() < 1e-13);
        assert!((summit.half_bandwidth_hz - 2.0).abs() < 1e-12);
        // y = 2 + 0.5 (x - 1)^2 + 0.1 (x - 1)^3: minimum at 1, seen from points that are off it.
        let skewed = |x: f64| (x, 2.0 + 0.5 * (x - 1.0).powi(2) + 0.1 * (x - 1.0).powi(3));
        let points = [0.2, 0.9, 1.9].map(skewed);
        let summit = of_cubic(points, skewed(2.7)).expect("minimum inside");
        assert!((summit.frequency_hz - 1.0).abs() < 1e-12);
        assert!((summit.amplitude - 2.0_f64.powf(-0.5)).abs() < 1e-12);
    }

    #[test]
    fn a_valley_has_no_summit() {
        assert_eq!(of_parabola([(0.0, 1.0), (1.0, 2.0), (2.0, 1.0)]), None);
    }
}
