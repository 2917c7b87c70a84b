//! A second opinion on the tail: laws of largest values fitted to the good values, with a goodness of
//! fit, beside the order statistics and never in their place.
//!
//! The parameters come from the same values that the fit is judged by, so that published tables of the
//! Anderson-Darling distance do not apply: its law under the fit is simulated (parametric bootstrap,
//! Stute, Gonzalez Manteiga & Presedo Quindimil 1993), every resample fitted anew. The same resamples
//! give the intervals of the parameters and percentiles.
//!
//! Of a large sample the resamples are smaller than it is ([`MOST_RESAMPLED`]), so that the work does not grow with
//! it: the law of the distance no longer changes with the number of values, and the deviations of the
//! parameters shrink with its root, by which they are brought to the size of the sample.

use rand::RngExt;
use rayon::prelude::*;
use serde::Serialize;

use super::extreme_value::{ExtremeValueLaw, anderson_darling};
use super::extreme_value_fit::{FitStatus, fit_extreme_value, fit_extreme_value_near, fit_gumbel};
use super::resampling::resampling_stream;
use super::{CONFIDENCE, Percentile, percentile};

/// Percentiles that a fit gives, in percent.
pub const TAIL_PERCENTILES: [f64; 4] = [95.0, 99.0, 99.9, 99.99];

/// Fewer values than this are marked.
const FEW_VALUES: usize = 50;

/// A goodness of fit below this is marked.
const REJECTED_BELOW: f64 = 0.05;

/// Values of a resample at most.
pub const MOST_RESAMPLED: usize = 1000;

/// Shapes above this are Gumbel's to all purposes, the end of the family of laws bounded above.
const BOUNDED_ABOVE: f64 = -1e-3;

/// Largest share of resamples without a fit under which their statistics are given.
const FAILED_RESAMPLES: f64 = 0.01;

/// A fitted law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TailLaw {
    /// Three-parameter Weibull law of largest values: upper end `lambda`, scale `delta`, shape `beta`.
    WeibullBoundedAbove,
    /// Generalised extreme value law: location `mu`, scale `sigma`, shape `xi`.
    GeneralisedExtremeValue,
}

impl TailLaw {
    /// Name in tables, `snake_case`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::WeibullBoundedAbove => "weibull_bounded_above",
            Self::GeneralisedExtremeValue => "generalised_extreme_value",
        }
    }
}

/// A fitted number with its 95 % interval; null bounds are infinite, or the resamples gave none.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
}

/// Parameters of a fitted law; those that a law does not have are null.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TailParameters {
    /// Location `mu`, in the unit of the quantity.
    pub location: Option<Estimate>,
    /// Scale `sigma` or `delta`, in the unit of the quantity.
    pub scale: Estimate,
    /// Shape `xi` or `beta`.
    pub shape: Estimate,
    /// Upper end `lambda`, in the unit of the quantity.
    pub upper_end: Option<Estimate>,
}

/// A percentile of a fitted law beside that of the sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TailPercentile {
    /// The percentile in percent.
    pub percent: f64,
    /// Percentile of the fitted law.
    pub model: Option<Estimate>,
    /// Order statistic of the sample with its distribution-free interval.
    pub empirical: Percentile,
    /// The model lies outside of the interval of the sample.
    pub outside_interval: bool,
    /// Beyond `1 - 1/n`: no value of the sample reaches there.
    pub extrapolates: bool,
}

/// One law fitted to one sample.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TailFit {
    /// The law.
    pub law: TailLaw,
    /// How the fit ended; without `converged` there are no numbers of the model.
    pub status: FitStatus,
    /// Parameters.
    pub parameters: Option<TailParameters>,
    /// Anderson-Darling distance.
    pub anderson_darling: Option<f64>,
    /// Probability of a larger distance if the law were right.
    pub p_value: Option<f64>,
    /// Resamples behind the `p_value` and the intervals.
    pub resamples: u32,
    /// Values of each resample: those of the sample, or [`MOST_RESAMPLED`] where it has more.
    pub values_of_resample: u32,
    /// Resamples that could not be fitted; above 1 % there are no intervals and no `p_value`.
    pub failed_resamples: u32,
    /// Percentiles in the order of [`TAIL_PERCENTILES`].
    pub percentiles: Vec<TailPercentile>,
    /// Fewer than 50 values.
    pub few_values: bool,
    /// `p_value` is below 0.05.
    pub rejected: bool,
    /// Failed rows that the fit knows nothing of.
    pub failures_left_out: u64,
}

/// A law and the distance of its sample.
type Fitted = (ExtremeValueLaw, f64);

/// Both laws fitted to `sorted` good values (ascending) beside `failed` rows without value; resamples
/// come from the streams of `topic` under `seed`.
#[must_use]
pub fn fit_tails(
    sorted: &[f64],
    failed: u64,
    resamples: u32,
    seed: u64,
    topic: u32,
) -> [TailFit; 2] {
    let law = fit_extreme_value(sorted);
    let bounded = match law {
        Ok(law) if law.shape >= BOUNDED_ABOVE => Err(FitStatus::ShapeAtBound),
        other => other,
    };
    let simulated: Vec<Option<[Fitted; 2]>> = match law {
        Err(_) => Vec::new(),
        Ok(law) => simulate(
            &law,
            bounded.is_ok(),
            sorted.len(),
            |resample| resampling_stream(seed, topic, resample),
            resamples,
        ),
    };
    let sample = Sample { sorted, failed };
    [
        sample.report(TailLaw::WeibullBoundedAbove, bounded, &of(&simulated, 0)),
        sample.report(TailLaw::GeneralisedExtremeValue, law, &of(&simulated, 1)),
    ]
}

/// Fits of resamples of `law` as samples of `n` values have them.
fn simulate<R: rand::Rng>(
    law: &ExtremeValueLaw,
    bounded: bool,
    n: usize,
    stream: impl Fn(u32) -> R + Sync,
    resamples: u32,
) -> Vec<Option<[Fitted; 2]>> {
    let size = n.min(MOST_RESAMPLED);
    let shrunk = (size < n).then(|| (size as f64 / n as f64).sqrt());
    (0..resamples)
        .into_par_iter()
        .map(|resample| {
            let mut stream = stream(resample);
            let mut drawn: Vec<f64> = (0..size)
                .map(|_| law.quantile(open_unit(&mut stream)))
                .collect();
            drawn.sort_unstable_by(f64::total_cmp);
            let fitted = refit(&drawn, law, bounded)?;
            Some(match shrunk {
                None => fitted,
                Some(share) => fitted
                    .map(|(parameters, distance)| (between(law, &parameters, share), distance)),
            })
        })
        .collect()
}

/// The law whose parameters deviate from those of `law` by `share` of what those of `other` do; the scale by its
/// logarithm.
fn between(law: &ExtremeValueLaw, other: &ExtremeValueLaw, share: f64) -> ExtremeValueLaw {
    ExtremeValueLaw {
        location: law.location + share * (other.location - law.location),
        scale: law.scale * (other.scale / law.scale).powf(share),
        shape: law.shape + share * (other.shape - law.shape),
    }
}

/// The simulated fits of one of the two laws.
fn of(simulated: &[Option<[Fitted; 2]>], place: usize) -> Vec<Option<Fitted>> {
    simulated
        .iter()
        .map(|both| Some(both.as_ref()?[place]))
        .collect()
}

/// Uniform on the open interval from 0 to 1.
fn open_unit(stream: &mut impl rand::Rng) -> f64 {
    loop {
        let u: f64 = stream.random();
        if u > 0.0 {
            return u;
        }
    }
}

/// The bounded and the general law fitted to a resample; none if either cannot be. Without a `bounded`
/// law of the sample there is nothing to compare that of a resample with.
fn refit(sorted: &[f64], near: &ExtremeValueLaw, bounded: bool) -> Option<[Fitted; 2]> {
    let with_distance = |law: ExtremeValueLaw| (law, anderson_darling(sorted, &law));
    let general = fit_extreme_value_near(sorted, near).ok()?;
    let bounded = if general.shape < BOUNDED_ABOVE || !bounded {
        general
    } else {
        fit_gumbel(sorted).ok()?
    };
    Some([with_distance(bounded), with_distance(general)])
}

struct Sample<'a> {
    sorted: &'a [f64],
    failed: u64,
}

impl Sample<'_> {
    fn report(
        &self,
        name: TailLaw,
        fitted: Result<ExtremeValueLaw, FitStatus>,
        simulated: &[Option<Fitted>],
    ) -> TailFit {
        let good: Vec<Fitted> = simulated.iter().filter_map(|fit| *fit).collect();
        let lost = simulated.len() - good.len();
        let enough = !good.is_empty() && lost as f64 <= FAILED_RESAMPLES * simulated.len() as f64;
        let estimate = |value: Of| {
            let law = fitted.ok()?;
            let mut values: Vec<f64> = good.iter().map(|(law, _)| value(law)).collect();
            values.sort_unstable_by(f64::total_cmp);
            let [lower, upper] = if enough {
                central(&values)
            } else {
                [None, None]
            };
            Some(Estimate {
                value: value(&law),
                lower,
                upper,
            })
        };
        let distance = fitted.ok().map(|law| anderson_darling(self.sorted, &law));
        let p_value = distance.filter(|_| enough).map(|distance| {
            let beyond = good.iter().filter(|(_, other)| *other >= distance).count();
            (1.0 + beyond as f64) / (1.0 + good.len() as f64)
        });
        let percentiles = TAIL_PERCENTILES
            .iter()
            .map(|&percent| {
                let p = percent / 100.0;
                self.beside(percent, estimate(&|law| law.quantile(p)))
            })
            .collect();
        TailFit {
            law: name,
            status: fitted.err().unwrap_or(FitStatus::Converged),
            parameters: parameters(name, estimate),
            anderson_darling: distance,
            p_value,
            resamples: simulated.len() as u32,
            values_of_resample: self.sorted.len().min(MOST_RESAMPLED) as u32,
            failed_resamples: lost as u32,
            percentiles,
            few_values: self.sorted.len() < FEW_VALUES,
            rejected: p_value.is_some_and(|p| p < REJECTED_BELOW),
            failures_left_out: self.failed,
        }
    }

    /// A percentile of the model beside that of the sample.
    fn beside(&self, percent: f64, model: Option<Estimate>) -> TailPercentile {
        let empirical = percentile(self.sorted, self.failed, percent);
        let outside_interval = model.is_some_and(|model| {
            empirical.lower.is_some_and(|lower| model.value < lower)
                || empirical.upper.is_some_and(|upper| model.value > upper)
        });
        TailPercentile {
            percent,
            model,
            empirical,
            outside_interval,
            extrapolates: percent / 100.0 > 1.0 - 1.0 / self.sorted.len() as f64,
        }
    }
}

/// A number of a law.
type Of<'a> = &'a dyn Fn(&ExtremeValueLaw) -> f64;

/// The parameters that `name` has; none without a fit.
fn parameters(name: TailLaw, estimate: impl Fn(Of) -> Option<Estimate>) -> Option<TailParameters> {
    let upper_end = estimate(&|law| law.upper_end().unwrap_or(f64::INFINITY))?;
    Some(match name {
        TailLaw::WeibullBoundedAbove => TailParameters {
            location: None,
            scale: estimate(&|law| {
                let end = law.upper_end().unwrap_or(f64::INFINITY);
                end - law.location
            })?,
            shape: estimate(&|law| {
                if law.shape < 0.0 {
                    -1.0 / law.shape
                } else {
                    f64::INFINITY
                }
            })?,
            upper_end: Some(upper_end),
        },
        TailLaw::GeneralisedExtremeValue => TailParameters {
            location: Some(estimate(&|law| law.location)?),
            scale: estimate(&|law| law.scale)?,
            shape: estimate(&|law| law.shape)?,
            upper_end: upper_end.value.is_finite().then_some(upper_end),
        },
    })
}

/// Bounds of the central share [`CONFIDENCE`] of `sorted` values; none where they are infinite.
fn central(sorted: &[f64]) -> [Option<f64>; 2] {
    let tail = 0.5 * (1.0 - CONFIDENCE) * (sorted.len() as f64 + 1.0);
    let place = (tail.floor() as usize).max(1);
    let finite = |value: f64| value.is_finite().then_some(value);
    [
        finite(sorted[place - 1]),
        finite(sorted[sorted.len() - place]),
    ]
}
