//! The classic chain of blades against exact numbers and the statistics of an independent code.

use blisk::population::monte_carlo::ResponseRow;
use blisk::population::statistics::SampleStatistics;
use blisk::response::forced_response::ContactCondition;
use blisk::response::mistuning::{ContactFactors, Deviations, Pattern};
use blisk::study::Study;
use rayon::prelude::*;

use super::support::{Case, package};

const FREE: ContactCondition = ContactCondition::Free;
const TUNED_PEAK_M: f64 = 1.095_050_174_838e-4;
/// Dashpot of a blade, N s/m.
const DASHPOT: f64 = 1.443;
const BLADES: f64 = 24.0;

pub fn case() -> Case {
    Case::new(Study::read(&package("studies/one-dof.toml")).unwrap())
}

fn relative(found: Option<f64>, expected: f64) -> f64 {
    (found.unwrap() / expected - 1.0).abs()
}

#[test]
fn the_tuned_peak_is_exact() {
    let tuned = case().tuned(FREE);
    assert!(relative(tuned.amplitude_m, TUNED_PEAK_M) < 1e-9);
    // A peak to 1e-12 in height is one to 1e-6 half-bandwidths in place.
    let omega = std::f64::consts::TAU * tuned.frequency_hz.unwrap();
    assert!((omega / 6_328.166_991 - 1.0).abs() < 1e-7, "{omega}");
}

/// The pattern of the deterministic oracle.
pub fn given_pattern() -> Pattern {
    let deviation = |n: f64| 0.03 * (1.7 * n + 0.3 * n * n).cos();
    Pattern {
        id: 0,
        deviations: Deviations::PerBlade((0..24).map(|n| deviation(f64::from(n))).collect()),
        contact: ContactFactors::default(),
    }
}

#[test]
fn a_given_pattern_has_its_known_amplification() {
    let case = case();
    let row = case.row(&given_pattern(), FREE, &case.tuned(FREE));
    let error = (row.amplification_factor.unwrap() - 1.371_081_258).abs();
    assert!(error < 1e-8, "{error:e}");
    assert_eq!(row.peak_blade, Some(13));
    assert!(relative(row.peak_amplitude_m, 1.501_402_771e-4) < 1e-9);
    let omega = std::f64::consts::TAU * row.peak_frequency_hz.unwrap();
    // A height known to 1e-9 tells a place to sqrt(2e-9) half-bandwidths of 63.3 rad/s.
    assert!((omega - 6_296.495).abs() < 2.9e-3, "{omega}");
}

/// An estimate with the half-width of its 95 % interval.
#[derive(Debug, Clone, Copy)]
struct Estimate {
    value: f64,
    half_width: f64,
}

impl Estimate {
    fn between(value: f64, lower: f64, upper: f64) -> Self {
        Self {
            value,
            half_width: 0.5 * (upper - lower),
        }
    }

    /// Distance in standard errors of the difference.
    fn standard_errors_from(self, other: Self) -> f64 {
        let error = self.half_width.hypot(other.half_width) / 1.96;
        (self.value - other.value).abs() / error
    }
}

/// Statistics of the amplification factor at one standard deviation of the blade stiffness.
pub struct Expected {
    pub standard_deviation: f64,
    /// Mean and half-width of its interval.
    mean: [f64; 2],
    spread: f64,
    fifth_percentile: f64,
    /// P50, P95 and P99 with the ends of their intervals.
    percentiles: [[f64; 3]; 3],
}

/// 20,000 patterns each, peaks refined by golden section, of another program and other draws.
pub const EXPECTED: [Expected; 6] = [
    Expected {
        standard_deviation: 0.005,
        mean: [1.0800, 0.0003],
        spread: 0.0228,
        fifth_percentile: 1.0470,
        percentiles: [
            [1.0779, 1.0775, 1.0782],
            [1.1212, 1.1202, 1.1220],
            [1.1425, 1.1414, 1.1440],
        ],
    },
    Expected {
        standard_deviation: 0.01,
        mean: [1.1521, 0.0006],
        spread: 0.0426,
        fifth_percentile: 1.0894,
        percentiles: [
            [1.1479, 1.1472, 1.1486],
            [1.2286, 1.2269, 1.2304],
            [1.2672, 1.2641, 1.2696],
        ],
    },
    Expected {
        standard_deviation: 0.02,
        mean: [1.2653, 0.0010],
        spread: 0.0709,
        fifth_percentile: 1.1592,
        percentiles: [
            [1.2592, 1.2581, 1.2604],
            [1.3915, 1.3893, 1.3945],
            [1.4553, 1.4505, 1.4611],
        ],
    },
    Expected {
        standard_deviation: 0.03,
        mean: [1.3374, 0.0013],
        spread: 0.0906,
        fifth_percentile: 1.2043,
        percentiles: [
            [1.3296, 1.3281, 1.3311],
            [1.4997, 1.4964, 1.5031],
            [1.5850, 1.5810, 1.5918],
        ],
    },
    Expected {
        standard_deviation: 0.05,
        mean: [1.3985, 0.0017],
        spread: 0.1222,
        fifth_percentile: 1.2226,
        percentiles: [
            [1.3846, 1.3825, 1.3865],
            [1.6220, 1.6162, 1.6263],
            [1.7388, 1.7307, 1.7496],
        ],
    },
    Expected {
        standard_deviation: 0.1,
        mean: [1.4116, 0.0020],
        spread: 0.1409,
        fifth_percentile: 1.2056,
        percentiles: [
            [1.3976, 1.3949, 1.3999],
            [1.6689, 1.6636, 1.6750],
            [1.7947, 1.7809, 1.8038],
        ],
    },
];

#[test]
fn twenty_thousand_patterns_have_the_known_statistics() {
    let case = case();
    assert_eq!(case.study.patterns, 20_000);
    let tuned = case.tuned(FREE);
    for expected in &EXPECTED {
        let deviation = expected.standard_deviation;
        let rows: Vec<ResponseRow> = (0..case.study.patterns)
            .into_par_iter()
            .map(|id| case.row(&case.pattern(id, Some(deviation)), FREE, &tuned))
            .collect();
        rows.iter().for_each(stays_within_the_bound);
        let factors = rows.iter().map(|row| row.amplification_factor.unwrap());
        compare(expected, &SampleStatistics::new(factors.collect(), 0));
    }
}

fn compare(expected: &Expected, found: &SampleStatistics) {
    let deviation = expected.standard_deviation;
    let spread = found.standard_deviation.unwrap();
    assert!(
        (spread / expected.spread - 1.0).abs() <= 0.04,
        "{deviation}: {spread}"
    );
    let distances = expected.distances(found, 20_000);
    println!(
        "{deviation}: mean, P50, P95, P99, P5 off by {distances:.2?} standard errors; spread {spread:.4}"
    );
    assert!(
        distances.iter().all(|&d| d <= 4.0),
        "{deviation}: {distances:?}"
    );
}

impl Expected {
    /// Distances of mean, P50, P95, P99 and P5 of so many patterns from the expected ones, in standard
    /// errors of the difference.
    pub fn distances(&self, found: &SampleStatistics, patterns: u32) -> Vec<f64> {
        let [value, half_width] = self.mean;
        let own = Estimate {
            value: found.mean.unwrap(),
            half_width: 1.96 * found.standard_deviation.unwrap() / f64::from(patterns).sqrt(),
        };
        let mut distances = vec![own.standard_errors_from(Estimate { value, half_width })];
        for (percent, [value, lower, upper]) in [50, 95, 99].into_iter().zip(self.percentiles) {
            let own = found.percentile(percent).unwrap();
            let own = Estimate::between(own.value.unwrap(), own.lower.unwrap(), own.upper.unwrap());
            distances.push(own.standard_errors_from(Estimate::between(value, lower, upper)));
        }
        // The reference has no bounds there; from as many patterns they are as wide as ours.
        let fifth = found.percentile(5).unwrap();
        let fifth = Estimate::between(
            fifth.value.unwrap(),
            fifth.lower.unwrap(),
            fifth.upper.unwrap(),
        );
        distances.push(fifth.standard_errors_from(Estimate {
            value: self.fifth_percentile,
            half_width: fifth.half_width,
        }));
        distances
    }
}

/// `omega c |X|` over `F (1 + sqrt N) / 2`, at most 1 for a uniform dashpot and any pattern: `i omega c
/// Z^-1` is half of one plus a unitary matrix (its Cayley transform).
pub fn share_of_the_bound(row: &ResponseRow) -> f64 {
    let omega = std::f64::consts::TAU * row.peak_frequency_hz.unwrap();
    let damping_force = omega * DASHPOT * row.peak_amplitude_m.unwrap();
    damping_force / (0.5 * (1.0 + BLADES.sqrt()))
}

fn stays_within_the_bound(row: &ResponseRow) {
    assert!(share_of_the_bound(row) <= 1.0, "pattern {}", row.pattern);
}
