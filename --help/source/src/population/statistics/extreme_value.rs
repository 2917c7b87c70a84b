//! The generalised extreme value law: distribution function, quantile, likelihood and its gradient.
//!
//! `F(x) = exp(-e^-y)`, `y = ln(1 + xi z) / xi`, `z = (x - mu) / sigma` (Jenkinson 1955; Coles 2001,
//! eq. 3.2), the limit law of largest values: of the largest blade of a wheel it is a model. With
//! `xi < 0` it is bounded above by `lambda = mu - sigma / xi` and is the three-parameter Weibull law
//! of largest values, `F(x) = exp(-((lambda - x) / delta)^beta)`, `delta = -sigma / xi`,
//! `beta = -1 / xi`, of the mistuning literature (Castanier & Pierre 2006).

/// Below this `|xi z|` the series in `xi` takes the place of formulas that cancel.
const SERIES: f64 = 1e-4;

/// A generalised extreme value law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExtremeValueLaw {
    /// Location `mu`, in the unit of the values.
    pub location: f64,
    /// Scale `sigma > 0`, in the unit of the values.
    pub scale: f64,
    /// Shape `xi`; below 0 the law is bounded above.
    pub shape: f64,
}

impl ExtremeValueLaw {
    /// Upper end `mu - sigma / xi` of the law; none if it is unbounded.
    #[must_use]
    pub fn upper_end(&self) -> Option<f64> {
        (self.shape < 0.0).then(|| self.location - self.scale / self.shape)
    }

    /// The `p`-quantile, `0 < p < 1`: `mu + sigma (e^(xi y) - 1) / xi` with `y = -ln(-ln p)`.
    #[must_use]
    pub fn quantile(&self, p: f64) -> f64 {
        let y = -(-p.ln()).ln();
        let z = if self.shape.abs() < 1e-12 {
            y
        } else {
            (self.shape * y).exp_m1() / self.shape
        };
        self.location + self.scale * z
    }

    /// Reduced variate `y(x)`, so that `F(x) = exp(-e^-y)`; infinite beyond the ends of the law.
    #[must_use]
    pub fn reduced(&self, x: f64) -> f64 {
        let z = (x - self.location) / self.scale;
        let xz = self.shape * z;
        if xz <= -1.0 {
            // Beyond the upper end F is 1, below the lower end 0.
            f64::INFINITY.copysign(-self.shape)
        } else if xz.abs() < SERIES {
            z * (1.0 - xz / 2.0 + xz * xz / 3.0 - xz * xz * xz / 4.0)
        } else {
            xz.ln_1p() / self.shape
        }
    }

    /// Negative logarithm of the density at `x`, `ln sigma + (1 + xi) y + e^-y`, and its gradient with
    /// respect to `mu`, `ln sigma`, `xi`; none outside of the support.
    #[must_use]
    pub fn negative_log_density(&self, x: f64) -> Option<(f64, [f64; 3])> {
        let xi = self.shape;
        let z = (x - self.location) / self.scale;
        let t = 1.0 + xi * z;
        if t <= 0.0 || !t.is_finite() {
            return None;
        }
        let y = self.reduced(x);
        let tail = (-y).exp();
        let value = self.scale.ln() + (1.0 + xi) * y + tail;
        let by_y = 1.0 + xi - tail;
        let y_by_xi = if (xi * z).abs() < SERIES {
            z * z * (-0.5 + 2.0 / 3.0 * xi * z - 0.75 * xi * z * xi * z)
        } else {
            (z / t - y) / xi
        };
        let gradient = [
            -by_y / (t * self.scale),
            1.0 - z * by_y / t,
            y + by_y * y_by_xi,
        ];
        Some((value, gradient))
    }
}

/// Anderson-Darling distance of `sorted` values (ascending) from `law`:
/// `A^2 = -n - (1/n) sum (2 i - 1) (ln F(x_(i)) + ln(1 - F(x_(n+1-i))))` (Anderson & Darling 1954).
#[must_use]
pub fn anderson_darling(sorted: &[f64], law: &ExtremeValueLaw) -> f64 {
    let n = sorted.len() as f64;
    // -ln F = e^-y at every value.
    let tails: Vec<f64> = sorted.iter().map(|&x| (-law.reduced(x)).exp()).collect();
    let sum: f64 = tails
        .iter()
        .zip(tails.iter().rev())
        .enumerate()
        .map(|(place, (low, high))| {
            let weight = 2.0 * place as f64 + 1.0;
            weight * ((-(-high).exp_m1()).ln() - low)
        })
        .sum();
    -n - sum / n
}
