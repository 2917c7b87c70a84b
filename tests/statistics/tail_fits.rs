//! Tail fits: formulas against independent ones, recovery of known parameters, honest statuses.

use blisk::population::statistics::{
    ExtremeValueLaw, FitStatus, TailFit, TailLaw, anderson_darling, fit_extreme_value, fit_gumbel,
    fit_tails, resampling_stream,
};
use rand::RngExt;

fn law(location: f64, scale: f64, shape: f64) -> ExtremeValueLaw {
    ExtremeValueLaw {
        location,
        scale,
        shape,
    }
}

/// Sorted sample by inversion, from a stream of its own.
fn sample(law: &ExtremeValueLaw, n: usize, seed: u64) -> Vec<f64> {
    let mut stream = resampling_stream(seed, 77, 0);
    let mut values: Vec<f64> = (0..n)
        .map(|_| law.quantile(stream.random_range(1e-16..1.0)))
        .collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The distribution function as in the books: `exp(-(1 + xi z)^(-1/xi))`, or Gumbel's.
fn textbook(law: &ExtremeValueLaw, x: f64) -> f64 {
    let z = (x - law.location) / law.scale;
    if law.shape == 0.0 {
        return (-(-z).exp()).exp();
    }
    (-(1.0 + law.shape * z).max(0.0).powf(-1.0 / law.shape)).exp()
}

#[test]
fn quantile_distribution_and_density_agree_with_the_textbook() {
    for shape in [-0.9, -0.3, -1e-3, -1e-6, 0.0, 1e-6, 0.2, 0.8] {
        let law = law(2.0, 0.7, shape);
        for p in [1e-6, 0.01, 0.3, 0.5, 0.9, 0.999, 1.0 - 1e-9] {
            let x = law.quantile(p);
            let back = (-(-law.reduced(x)).exp()).exp();
            assert!((back - p).abs() < 1e-9 * p.max(1e-3), "xi {shape}, p {p}");
            assert!((textbook(&law, x) - p).abs() < 1e-6, "xi {shape}, p {p}");
        }
        // The density is the slope of the distribution.
        for p in [0.05, 0.4, 0.8, 0.97] {
            let (x, h) = (law.quantile(p), 1e-5);
            let slope = (textbook(&law, x + h) - textbook(&law, x - h)) / (2.0 * h);
            let (value, _) = law.negative_log_density(x).expect("inside");
            if shape == 0.0 || shape.abs() > 1e-4 {
                assert!(
                    ((-value).exp() / slope - 1.0).abs() < 1e-5,
                    "xi {shape}, p {p}"
                );
            }
        }
    }
    // The Weibull form of the same law, with upper end, scale and exponent.
    let bounded = law(2.0, 0.7, -0.25);
    let (lambda, delta, beta) = (2.0 + 0.7 / 0.25, 0.7 / 0.25, 4.0);
    assert_eq!(bounded.upper_end(), Some(lambda));
    for x in [0.0, 1.5, 2.5, 4.7] {
        let weibull = (-f64::powf((lambda - x) / delta, beta)).exp();
        assert!((textbook(&bounded, x) - weibull).abs() < 1e-14);
    }
    assert!(bounded.negative_log_density(lambda + 1e-9).is_none());
}

#[test]
fn gradient_of_the_likelihood_agrees_with_finite_differences() {
    for shape in [-0.6, -0.2, -3e-5, 0.0, 2e-5, 0.3] {
        let given = law(1.0, 0.4, shape);
        for p in [0.02, 0.3, 0.7, 0.99] {
            let x = given.quantile(p);
            let (_, gradient) = given.negative_log_density(x).expect("inside");
            let value = |d: [f64; 3]| {
                let moved = law(1.0 + d[0], 0.4 * d[1].exp(), shape + d[2]);
                moved.negative_log_density(x).expect("inside").0
            };
            for i in 0..3 {
                let h = 1e-5;
                let at = |factor: f64| {
                    let mut d = [0.0; 3];
                    d[i] = factor * h;
                    value(d)
                };
                let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
                assert!(
                    (slope - gradient[i]).abs() < 1e-6 * (1.0 + gradient[i].abs()),
                    "xi {shape}, p {p}, parameter {i}: {slope} {}",
                    gradient[i]
                );
            }
        }
    }
}

#[test]
fn the_distance_is_that_of_anderson_and_darling() {
    // Against the defining integral n int (Fn - F)^2 / (F (1 - F)) dF, by the midpoint rule in F.
    let law = law(0.0, 1.0, -0.2);
    let values = sample(&law, 25, 5);
    let steps = 2_000_000;
    let below: Vec<f64> = values.iter().map(|&x| textbook(&law, x)).collect();
    let mut integral = 0.0;
    for step in 0..steps {
        let f = (f64::from(step) + 0.5) / f64::from(steps);
        let empirical = below.partition_point(|&u| u <= f) as f64 / 25.0;
        integral += (empirical - f).powi(2) / (f * (1.0 - f)) / f64::from(steps);
    }
    let found = anderson_darling(&values, &law);
    assert!(
        (found - 25.0 * integral).abs() < 1e-4,
        "{found} {}",
        25.0 * integral
    );
}

#[test]
fn parameters_of_known_laws_are_recovered_within_their_standard_errors() {
    // Mean over 60 samples of 1000: the bias of maximum likelihood is of order 1/n.
    for shape in [-0.35, -0.15, 0.1] {
        let truth = law(1.7, 0.2, shape);
        let fits: Vec<ExtremeValueLaw> = (0..60)
            .map(|seed| fit_extreme_value(&sample(&truth, 1000, seed)).expect("a fit"))
            .collect();
        let mean = |value: fn(&ExtremeValueLaw) -> f64| fits.iter().map(value).sum::<f64>() / 60.0;
        // Standard errors of a mean of 60: sigma/sqrt(60000) times about 1 to 1.1 for each.
        let error = 1.1 / 60_000.0_f64.sqrt();
        assert!(
            (mean(|f| f.location) - 1.7).abs() < 5.0 * 0.2 * error,
            "xi {shape}"
        );
        assert!(
            (mean(|f| f.scale) - 0.2).abs() < 5.0 * 0.2 * error,
            "xi {shape}"
        );
        assert!(
            (mean(|f| f.shape) - shape).abs() < 5.0 * error,
            "xi {shape}"
        );
    }
    let gumbel = law(1.7, 0.2, 0.0);
    let found = fit_gumbel(&sample(&gumbel, 20_000, 3)).expect("a fit");
    assert!((found.location - 1.7).abs() < 0.01 && (found.scale - 0.2).abs() < 0.01);
    assert!(found.shape == 0.0);
}

#[test]
fn a_fit_is_a_maximum_of_the_likelihood_and_follows_units() {
    let values = sample(&law(1.7, 0.2, -0.2), 300, 11);
    let fitted = fit_extreme_value(&values).expect("a fit");
    let total = |law: ExtremeValueLaw| -> f64 {
        let terms = values.iter().map(|&x| law.negative_log_density(x));
        terms
            .map(|term| term.map_or(f64::INFINITY, |term| term.0))
            .sum()
    };
    let best = total(fitted);
    for step in [-1e-3, 1e-3] {
        assert!(
            total(law(
                fitted.location * (1.0 + step),
                fitted.scale,
                fitted.shape
            )) > best
        );
        assert!(
            total(law(
                fitted.location,
                fitted.scale * (1.0 + step),
                fitted.shape
            )) > best
        );
        assert!(
            total(law(
                fitted.location,
                fitted.scale,
                fitted.shape * (1.0 + step)
            )) > best
        );
    }
    let scaled: Vec<f64> = values.iter().map(|x| 1e-5 * x).collect();
    let other = fit_extreme_value(&scaled).expect("a fit");
    assert!((other.shape - fitted.shape).abs() < 1e-4);
    assert!((other.location / (1e-5 * fitted.location) - 1.0).abs() < 1e-4);
}

#[test]
fn samples_that_no_law_fits_say_so() {
    let fit = |values: &[f64]| fit_extreme_value(values);
    assert_eq!(fit(&[1.0; 500]), Err(FitStatus::NoSpread));
    assert_eq!(fit(&[]), Err(FitStatus::TooFewValues));
    assert_eq!(
        fit(&sample(&law(1.0, 0.1, -0.1), 19, 1)),
        Err(FitStatus::TooFewValues)
    );
    // Uniform values have shape -1: the likelihood grows up to the end of the range.
    let uniform = sample(&law(1.0, 1.0, -1.0), 400, 1);
    assert_eq!(fit(&uniform), Err(FitStatus::ShapeAtBound));
    // Two atoms: no law with a density.
    let atoms: Vec<f64> = (0..400).map(|i| if i < 200 { 1.0 } else { 2.0 }).collect();
    assert!(fit(&atoms).is_err());
    let [weibull, general] = fit_tails(&atoms, 3, 50, 1, 0);
    for fit in [weibull, general] {
        assert_ne!(fit.status, FitStatus::Converged);
        assert!(fit.parameters.is_none() && fit.p_value.is_none());
        assert!(
            fit.percentiles
                .iter()
                .all(|p| p.model.is_none() && !p.outside_interval)
        );
        // The empirical percentile is there whatever becomes of the model.
        assert!(fit.percentiles[0].empirical.upper.is_some());
        assert_eq!(fit.failures_left_out, 3);
    }
}

#[test]
fn an_unbounded_law_leaves_the_bounded_one_at_the_end_of_its_family() {
    let heavy = sample(&law(1.0, 0.1, 0.3), 500, 2);
    let [weibull, general] = fit_tails(&heavy, 0, 50, 1, 0);
    assert_eq!(
        (weibull.law, weibull.status),
        (TailLaw::WeibullBoundedAbove, FitStatus::ShapeAtBound)
    );
    assert!(weibull.percentiles.iter().all(|p| p.model.is_none()));
    assert_eq!(general.status, FitStatus::Converged);
    let parameters = general.parameters.expect("parameters");
    assert!(parameters.upper_end.is_none());
    assert!(parameters.shape.lower < Some(0.3) && parameters.shape.upper > Some(0.3));
}

#[test]
fn a_bounded_law_is_given_in_both_forms_with_the_same_numbers() {
    let truth = law(1.7, 0.2, -0.25);
    let values = sample(&truth, 600, 8);
    let [weibull, general] = fit_tails(&values, 0, 200, 9, 4);
    assert_eq!(
        fit_tails(&values, 0, 200, 9, 4)[0],
        weibull,
        "the same seed gives the same fit"
    );
    let (w, g) = (
        weibull.parameters.expect("parameters"),
        general.parameters.expect("parameters"),
    );
    assert!((w.shape.value + 1.0 / g.shape.value).abs() < 1e-12);
    assert!((w.scale.value + g.scale.value / g.shape.value).abs() < 1e-12);
    let end = w.upper_end.expect("bounded");
    assert!((end.value - truth.upper_end().expect("bounded")).abs() < 0.15);
    assert!(end.lower < Some(2.5) && end.upper > Some(2.5), "{end:?}");
    for (a, b) in weibull.percentiles.iter().zip(&general.percentiles) {
        assert_eq!(a, b);
    }
    let flags: Vec<bool> = general.percentiles.iter().map(|p| p.extrapolates).collect();
    assert_eq!(flags, [false, false, true, true]);
    assert!(!general.few_values && !general.rejected && general.p_value > Some(0.05));
    // A percentile that the sample cannot support stays null beside the model.
    assert!(general.percentiles[2].empirical.value.is_none());
}

#[test]
fn a_wrong_law_is_rejected_and_its_percentile_outside_of_the_interval_marked() {
    // Two populations far apart.
    let mut values = sample(&law(1.0, 0.05, -0.1), 450, 1);
    values.extend(sample(&law(3.0, 0.05, -0.1), 50, 2));
    let fits = fit_tails(&values, 0, 100, 1, 0);
    let converged: Vec<&TailFit> = fits
        .iter()
        .filter(|fit| fit.status == FitStatus::Converged)
        .collect();
    assert!(!converged.is_empty());
    for fit in converged {
        assert!(fit.rejected, "p = {:?}", fit.p_value);
        assert!(fit.percentiles.iter().any(|p| p.outside_interval));
    }
}

/// What the `p_value` of samples drawn from a law is like, where the same law is fitted.
#[derive(Debug)]
struct Uniformity {
    /// Over ten classes, of the samples that have one.
    chi_square: f64,
    /// Samples without: no maximum of the likelihood, or more than 1 % of the resamples have none.
    without: u64,
}

impl Uniformity {
    fn holds(&self) -> bool {
        self.chi_square < CHI_SQUARE_9 && self.without == 0
    }
}

fn uniformity(truth: &ExtremeValueLaw, n: usize, samples: u64, resamples: u32) -> Uniformity {
    let mut classes = [0.0; 10];
    let mut without = 0;
    for seed in 0..samples {
        let fits = fit_tails(&sample(truth, n, seed), 0, resamples, seed, 1);
        match fits[1].p_value {
            Some(p) => classes[((p * 10.0) as usize).min(9)] += 1.0,
            None => without += 1,
        }
    }
    let expected = (samples - without) as f64 / 10.0;
    let squares = classes.map(|count: f64| (count - expected).powi(2) / expected);
    Uniformity {
        chi_square: squares.iter().sum(),
        without,
    }
}

/// 0.999 quantile of chi-square with 9 degrees of freedom.
const CHI_SQUARE_9: f64 = 27.877;

#[test]
fn goodness_of_fit_is_uniform_where_the_law_is_right() {
    let found = uniformity(&law(1.7, 0.2, -0.2), 60, 300, 99);
    assert!(found.holds(), "{found:?}");
}

/// Work that grows with the sample is done on it once, not in every resample.
#[test]
fn resamples_of_a_large_sample_are_no_larger_than_those_of_a_small_one() {
    let truth = law(1.7, 0.2, -0.2);
    for (n, values) in [(60, 60), (1000, 1000), (1001, 1000), (50_000, 1000)] {
        for fit in fit_tails(&sample(&truth, n, 3), 0, 20, 5, 0) {
            assert_eq!(fit.status, FitStatus::Converged, "{n}");
            assert_eq!(fit.values_of_resample, values, "{n}");
        }
    }
}

/// The statistics of resamples of 1000 values, brought to the size of the sample, are those of resamples as large
/// as the sample.
#[test]
fn smaller_resamples_give_the_spread_and_the_goodness_of_fit_of_whole_ones() {
    let n = 4000;
    let values = sample(&law(1.7, 0.2, -0.2), n, 8);
    let fitted = fit_extreme_value(&values).expect("a fit");
    let found = &fit_tails(&values, 0, 2000, 3, 0)[1];
    let whole: Vec<(f64, f64)> = (0..200)
        .map(|resample| {
            let drawn = sample(&fitted, n, 1000 + resample);
            let own = fit_extreme_value(&drawn).expect("a fit");
            (own.quantile(0.99), anderson_darling(&drawn, &own))
        })
        .collect();
    let size = whole.len() as f64;
    let mean = whole.iter().map(|own| own.0).sum::<f64>() / size;
    let variance = whole.iter().map(|own| (own.0 - mean).powi(2)).sum::<f64>() / (size - 1.0);
    let p99 = found.percentiles[1].model.expect("a model");
    let (lower, upper) = p99.lower.zip(p99.upper).expect("bounds");
    // The standard deviation of 200 values is known to 5 %.
    let ratio = (upper - lower) / (2.0 * 1.96 * variance.sqrt());
    assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
    let distance = found.anderson_darling.expect("a fit");
    let larger = whole.iter().filter(|own| own.1 >= distance).count() as f64 / size;
    let p = found.p_value.expect("a fit");
    assert!((p - larger).abs() < 0.12, "{p}, {larger}");
    // And the probability is uniform where the law is right.
    let found = uniformity(&law(1.7, 0.2, -0.2), 1500, 60, 99);
    assert!(found.holds(), "{found:?}");
}

#[test]
fn the_fit_of_many_values_is_the_maximum_that_the_fit_of_few_is() {
    let truth = law(1.7, 0.2, -0.2);
    let values = sample(&truth, 40_000, 5);
    let found = fit_extreme_value(&values).expect("a fit");
    let likelihood = |law: &ExtremeValueLaw| -> f64 {
        let densities = values.iter().map(|&x| law.negative_log_density(x));
        densities
            .map(|own| own.map_or(f64::INFINITY, |own| own.0))
            .sum()
    };
    let best = likelihood(&found);
    for (location, scale, shape) in [(1e-4, 1.0, 0.0), (0.0, 1.0005, 0.0), (0.0, 1.0, 1e-3)] {
        for sign in [-1.0, 1.0] {
            let beside = law(
                found.location + sign * location,
                found.scale * f64::powf(scale, sign),
                found.shape + sign * shape,
            );
            assert!(likelihood(&beside) > best, "{beside:?}");
        }
    }
}

/// `cargo test --release --test statistics -- --ignored goodness_of_fit`
#[test]
#[allow(clippy::print_stdout)]
#[ignore = "10,000 samples of several sizes and shapes: some minutes"]
fn goodness_of_fit_is_uniform_over_many_samples() {
    let mut outside = Vec::new();
    for (shape, n) in [(-0.3, 50), (-0.15, 200), (0.05, 100)] {
        let found = uniformity(&law(1.7, 0.2, shape), n, 10_000, 199);
        println!("xi {shape}, n {n}: {found:?}");
        if !found.holds() {
            outside.push((shape, n, found));
        }
    }
    assert!(outside.is_empty(), "{outside:?}");
}
