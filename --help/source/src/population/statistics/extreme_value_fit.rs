//! Maximum-likelihood fit of the generalised extreme value law.
//!
//! Newton's step, `delta = H^-1 sum g_i` with the scores `g_i` of the single values and the information
//! `H` by differences of their sum; where `H` is not positive definite, the step of Berndt, Hall, Hall
//! & Hausman (1974), `H = sum g_i g_i^T`. It is halved until the likelihood grows. The decrement
//! `delta^T sum g_i` is the squared step in standard errors, which gives the criterion its meaning.

use statrs::function::gamma::gamma;

use super::extreme_value::ExtremeValueLaw;

/// Smallest number of values that a law is fitted to.
pub const FEWEST_VALUES: usize = 20;

/// Shapes that are accepted; below -1 the likelihood is unbounded (Smith 1985), and no bounded response
/// is as heavy-tailed as 1.
pub const SHAPE_RANGE: [f64; 2] = [-0.95, 0.95];

/// Squared step, in standard errors, below which a fit has converged.
const CONVERGED: f64 = 1e-10;

/// Steps of one start.
const MOST_STEPS: usize = 300;

/// Values above which a law is sought from that of [`THINNED`] of them, evenly spaced in rank.
const MANY_VALUES: usize = 10_000;

/// Values of a thinned sample.
const THINNED: usize = 1000;

/// Halvings of one step.
const MOST_HALVINGS: i32 = 40;

/// How a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FitStatus {
    /// The likelihood has a maximum there.
    Converged,
    /// The likelihood grows up to the end of the range of the shape, or of the family.
    ShapeAtBound,
    /// No start led to a maximum.
    NotConverged,
    /// Fewer than [`FEWEST_VALUES`] values.
    TooFewValues,
    /// All values are the same.
    NoSpread,
}

impl FitStatus {
    /// Name in tables, `snake_case`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::ShapeAtBound => "shape_at_bound",
            Self::NotConverged => "not_converged",
            Self::TooFewValues => "too_few_values",
            Self::NoSpread => "no_spread",
        }
    }
}

/// Fits the law to `sorted` values (ascending).
///
/// # Errors
/// Why there is no fit.
pub fn fit_extreme_value(sorted: &[f64]) -> Result<ExtremeValueLaw, FitStatus> {
    let scaled = Scaled::new(sorted)?;
    if let Some(law) = scaled.near_thinned() {
        return Ok(law);
    }
    let moments = l_moment_start(&scaled.values);
    // Close to the answer, then from afar on both sides of the shapes that a bounded response has.
    let starts = [moments, start_of_shape(-0.1), start_of_shape(-0.4)];
    scaled.best_of(&starts, None)
}

/// Fits the law to `sorted` values (ascending) from a law that is known to be near, which is where a
/// resample begins.
///
/// # Errors
/// Why there is no fit.
pub fn fit_extreme_value_near(
    sorted: &[f64],
    near: &ExtremeValueLaw,
) -> Result<ExtremeValueLaw, FitStatus> {
    let scaled = Scaled::new(sorted)?;
    let near = scaled.to_scaled(near);
    match climb(&scaled.values, near, None) {
        Some(end) if end.status == FitStatus::Converged => Ok(scaled.to_given(&end.law)),
        _ => fit_extreme_value(sorted),
    }
}

/// Fits the law with shape 0, Gumbel's: the end of the family of laws bounded above.
///
/// # Errors
/// Why there is no fit.
pub fn fit_gumbel(sorted: &[f64]) -> Result<ExtremeValueLaw, FitStatus> {
    let scaled = Scaled::new(sorted)?;
    scaled.best_of(&[start_of_shape(0.0)], Some(0.0))
}

/// Values with mean 0 and standard deviation 1: the likelihood does not care, the arithmetic does.
struct Scaled {
    mean: f64,
    deviation: f64,
    values: Vec<f64>,
}

impl Scaled {
    fn new(sorted: &[f64]) -> Result<Self, FitStatus> {
        if sorted.len() < FEWEST_VALUES {
            return Err(FitStatus::TooFewValues);
        }
        let n = sorted.len() as f64;
        let mean = sorted.iter().sum::<f64>() / n;
        let squares: f64 = sorted.iter().map(|x| (x - mean).powi(2)).sum();
        let deviation = (squares / n).sqrt();
        // Rounding alone leaves a spread of this size.
        if deviation.is_nan() || deviation <= 1e-12 * mean.abs() {
            return Err(FitStatus::NoSpread);
        }
        let values = sorted.iter().map(|x| (x - mean) / deviation).collect();
        Ok(Self {
            mean,
            deviation,
            values,
        })
    }

    fn to_scaled(&self, law: &ExtremeValueLaw) -> ExtremeValueLaw {
        ExtremeValueLaw {
            location: (law.location - self.mean) / self.deviation,
            scale: law.scale / self.deviation,
            shape: law.shape,
        }
    }

    fn to_given(&self, law: &ExtremeValueLaw) -> ExtremeValueLaw {
        ExtremeValueLaw {
            location: self.mean + self.deviation * law.location,
            scale: self.deviation * law.scale,
            shape: law.shape,
        }
    }

    /// The maximum near that of a part of many values; none where there are few, or where it leads to none.
    fn near_thinned(&self) -> Option<ExtremeValueLaw> {
        let n = self.values.len();
        if n <= MANY_VALUES {
            return None;
        }
        // The middle of each of as many equal steps of rank.
        let thinned = (0..THINNED).map(|step| self.values[(2 * step + 1) * n / (2 * THINNED)]);
        let near = fit_extreme_value(&thinned.collect::<Vec<f64>>()).ok()?;
        let end = climb(&self.values, widened(&self.values, near), None)?;
        (end.status == FitStatus::Converged).then(|| self.to_given(&end.law))
    }

    /// The most likely of the maxima that the starts lead to.
    fn best_of(
        &self,
        starts: &[ExtremeValueLaw],
        shape: Option<f64>,
    ) -> Result<ExtremeValueLaw, FitStatus> {
        let ends = starts
            .iter()
            .filter_map(|&start| climb(&self.values, widened(&self.values, start), shape));
        let best = ends.min_by(|a, b| a.value.total_cmp(&b.value));
        match best {
            None => Err(FitStatus::NotConverged),
            Some(end) if end.status == FitStatus::Converged => Ok(self.to_given(&end.law)),
            Some(end) => Err(end.status),
        }
    }
}

/// Law with the mean 0 and the standard deviation 1 of Gumbel's, and the shape given.
fn start_of_shape(shape: f64) -> ExtremeValueLaw {
    let scale = 6.0_f64.sqrt() / std::f64::consts::PI;
    ExtremeValueLaw {
        location: -0.577_215_664_901_532_9 * scale,
        scale,
        shape,
    }
}

/// L-moment estimate (Hosking, Wallis & Wood 1985, eqs. 9-15, with `k = -xi`).
fn l_moment_start(sorted: &[f64]) -> ExtremeValueLaw {
    let n = sorted.len() as f64;
    let (mut b0, mut b1, mut b2) = (0.0, 0.0, 0.0);
    for (place, x) in sorted.iter().enumerate() {
        let j = place as f64;
        b0 += x / n;
        b1 += x * j / (n * (n - 1.0));
        b2 += x * j * (j - 1.0) / (n * (n - 1.0) * (n - 2.0));
    }
    let (l2, l3) = (2.0 * b1 - b0, 6.0 * b2 - 6.0 * b1 + b0);
    let c = 2.0 / (3.0 + l3 / l2) - 2.0_f64.ln() / 3.0_f64.ln();
    let k = (7.859 * c + 2.9554 * c * c).clamp(-0.9, 0.9);
    // At k = 0 the formulas have a removable singularity.
    let k = if k.abs() < 1e-6 { 1e-6 } else { k };
    let scale = l2 * k / ((1.0 - 2.0_f64.powf(-k)) * gamma(1.0 + k));
    ExtremeValueLaw {
        location: b0 - scale * (1.0 - gamma(1.0 + k)) / k,
        scale,
        shape: -k,
    }
}

/// The start with its scale doubled until every value lies inside of its support.
fn widened(values: &[f64], start: ExtremeValueLaw) -> ExtremeValueLaw {
    let mut law = start;
    for _ in 0..60 {
        let inside = |x: &f64| 1.0 + law.shape * (x - law.location) / law.scale > 1e-3;
        if values.iter().all(inside) {
            break;
        }
        law.scale *= 2.0;
    }
    law
}

/// Sum of the negative log-likelihood, of the scores and of their outer products.
struct Sums {
    value: f64,
    score: [f64; 3],
    products: [[f64; 3]; 3],
}

/// None if a value lies outside of the support.
fn sums(values: &[f64], law: &ExtremeValueLaw) -> Option<Sums> {
    let mut sums = Sums {
        value: 0.0,
        score: [0.0; 3],
        products: [[0.0; 3]; 3],
    };
    for &x in values {
        let (value, gradient) = law.negative_log_density(x)?;
        sums.value += value;
        for i in 0..3 {
            sums.score[i] -= gradient[i];
            for j in 0..=i {
                sums.products[i][j] += gradient[i] * gradient[j];
            }
        }
    }
    sums.value.is_finite().then_some(sums)
}

/// Where a climb ended.
struct End {
    law: ExtremeValueLaw,
    /// Negative log-likelihood there.
    value: f64,
    status: FitStatus,
}

/// Climbs from `start` to a maximum of the likelihood; none from outside of the support. A given
/// `shape` is kept.
fn climb(values: &[f64], start: ExtremeValueLaw, shape: Option<f64>) -> Option<End> {
    let free = if shape.is_some() { 2 } else { 3 };
    let mut law = start;
    let mut here = sums(values, &law)?;
    let mut status = None;
    for _ in 0..MOST_STEPS {
        let step = information(values, &law, &here, free)
            .and_then(|information| solve(&information, &here.score, free))
            .or_else(|| solve(&here.products, &here.score, free));
        let Some(step) = step else { break };
        let decrement: f64 = (0..free).map(|i| step[i] * here.score[i]).sum();
        if decrement <= CONVERGED {
            status = Some(FitStatus::Converged);
            break;
        }
        // Rounding hides a gain below this.
        let noise = 1e-13 * here.value.abs().max(values.len() as f64);
        let gain = |length: f64| 1e-4 * length * decrement - noise;
        let lengths = (0..MOST_HALVINGS).map(|halvings| 0.5_f64.powi(halvings));
        let next = lengths.into_iter().find_map(|length| {
            let trial = moved(&law, step.map(|part| length * part));
            let inside = (SHAPE_RANGE[0]..=SHAPE_RANGE[1]).contains(&trial.shape);
            let found = if inside {
                sums(values, &trial)?
            } else {
                return None;
            };
            (found.value <= here.value - gain(length)).then_some((trial, found))
        });
        let Some((trial, found)) = next else { break };
        (law, here) = (trial, found);
    }
    Some(End {
        status: status.unwrap_or_else(|| ended(&law)),
        value: here.value,
        law,
    })
}

/// Why a climb without a maximum ended.
fn ended(law: &ExtremeValueLaw) -> FitStatus {
    let margin = 0.01;
    if law.shape < SHAPE_RANGE[0] + margin || law.shape > SHAPE_RANGE[1] - margin {
        FitStatus::ShapeAtBound
    } else {
        FitStatus::NotConverged
    }
}

/// Parameters moved by `step`; the scale by its logarithm.
fn moved(law: &ExtremeValueLaw, step: [f64; 3]) -> ExtremeValueLaw {
    ExtremeValueLaw {
        location: law.location + step[0],
        scale: law.scale * step[1].exp(),
        shape: law.shape + step[2],
    }
}

/// Observed information: forward differences of the scores, lower triangle. None where a difference
/// leaves the support.
fn information(
    values: &[f64],
    law: &ExtremeValueLaw,
    here: &Sums,
    free: usize,
) -> Option<[[f64; 3]; 3]> {
    let h = 1e-6;
    let mut columns = [[0.0; 3]; 3];
    for (j, column) in columns.iter_mut().enumerate().take(free) {
        let mut step = [0.0; 3];
        step[j] = h;
        let there = sums(values, &moved(law, step))?;
        *column = [0, 1, 2].map(|i| (here.score[i] - there.score[i]) / h);
    }
    let mut information = [[0.0; 3]; 3];
    for i in 0..free {
        for j in 0..=i {
            information[i][j] = 0.5 * (columns[i][j] + columns[j][i]);
        }
    }
    Some(information)
}

/// Solves `matrix step = score` (lower triangle, symmetric) for the first `free` unknowns by
/// Cholesky's method, the others 0; none if the matrix is not positive definite.
fn solve(matrix: &[[f64; 3]; 3], score: &[f64; 3], free: usize) -> Option<[f64; 3]> {
    let mut factor = [[0.0; 3]; 3];
    for i in 0..free {
        for j in 0..=i {
            let inner: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
            let rest = matrix[i][j] - inner;
            if i == j {
                // A direction in which the likelihood does not curve.
                if rest.is_nan() || rest <= 1e-14 * matrix[i][i].abs() {
                    return None;
                }
                factor[i][i] = rest.sqrt();
            } else {
                factor[i][j] = rest / factor[j][j];
            }
        }
    }
    let mut step = [0.0; 3];
    for i in 0..free {
        let inner: f64 = (0..i).map(|k| factor[i][k] * step[k]).sum();
        step[i] = (score[i] - inner) / factor[i][i];
    }
    for i in (0..free).rev() {
        let inner: f64 = (i + 1..free).map(|k| factor[k][i] * step[k]).sum();
        step[i] = (step[i] - inner) / factor[i][i];
    }
    Some(step)
}
