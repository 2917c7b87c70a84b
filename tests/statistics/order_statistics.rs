//! Ranks, coverage, failures at both infinities.

use blisk::population::statistics::{
    Accounting, PointStatus, SampleStatistics, failure_gate, percentile, percentile_ranks,
};
use blisk::response::harmonic_balance::Status;

/// Binomial probabilities by Pascal's rule, independent of the library's logarithms.
fn binomial(n: usize, p: f64) -> Vec<f64> {
    let mut law = vec![1.0];
    for _ in 0..n {
        let mut next = vec![0.0; law.len() + 1];
        for (k, mass) in law.iter().enumerate() {
            next[k] += mass * (1.0 - p);
            next[k + 1] += mass * p;
        }
        law = next;
    }
    law
}

#[test]
fn ranks_are_those_of_the_published_table() {
    // n, p, lower, upper, achieved coverage: 95 % equal-tailed ranks computed elsewhere.
    for (n, p, lower, upper, coverage) in [
        (1_000, 0.99, 983, 997, 0.976),
        (10_000, 0.99, 9_880, 9_920, 0.956),
        (10_000, 0.999, 9_983, 9_997, 0.976),
        (100_000, 0.999, 99_880, 99_920, 0.955),
    ] {
        let ranks = percentile_ranks(n, p);
        assert_eq!(
            (ranks.lower, ranks.upper),
            (Some(lower), Some(upper)),
            "n = {n}, p = {p}"
        );
        let achieved = ranks.coverage.expect("both ranks exist");
        assert!(
            (achieved - coverage).abs() < 6e-4,
            "n = {n}, p = {p}: {achieved}"
        );
    }
}

#[test]
fn an_interval_exists_from_the_known_sample_sizes_on() {
    for (p, needed) in [(0.95, 72), (0.99, 368), (0.999, 3688), (0.9999, 36_887)] {
        assert!(percentile_ranks(needed, p).upper.is_some(), "p = {p}");
        assert!(percentile_ranks(needed - 1, p).upper.is_none(), "p = {p}");
        assert!(
            percentile_ranks(needed, 1.0 - p).lower.is_some(),
            "p = {}",
            1.0 - p
        );
        assert!(
            percentile_ranks(needed - 1, 1.0 - p).lower.is_none(),
            "p = {}",
            1.0 - p
        );
    }
}

#[test]
fn coverage_is_at_least_nominal_and_each_tail_at_most_half_of_the_rest() {
    for n in [50, 72, 200, 368, 1000] {
        for percent in [5, 50, 90, 95, 99] {
            let p = f64::from(percent) / 100.0;
            let law = binomial(n, p);
            let ranks = percentile_ranks(n as u64, p);
            if let Some(lower) = ranks.lower {
                let below: f64 = law[..lower as usize].iter().sum();
                assert!(below <= 0.025 + 1e-12, "n = {n}, P{percent}: {below}");
                let next: f64 = law[..=lower as usize].iter().sum();
                assert!(
                    next > 0.025,
                    "n = {n}, P{percent}: a higher lower end would do"
                );
            }
            if let Some(upper) = ranks.upper {
                let above: f64 = law[upper as usize..].iter().sum();
                assert!(above <= 0.025 + 1e-12, "n = {n}, P{percent}: {above}");
                let next: f64 = law[upper as usize - 1..].iter().sum();
                assert!(
                    next > 0.025,
                    "n = {n}, P{percent}: a lower upper end would do"
                );
            }
            if let (Some(lower), Some(upper)) = (ranks.lower, ranks.upper) {
                let inside: f64 = law[lower as usize..upper as usize].iter().sum();
                let coverage = ranks.coverage.expect("both ranks exist");
                assert!((inside - coverage).abs() < 1e-10);
                assert!(inside >= 0.95);
            }
        }
    }
}

#[test]
fn the_value_is_the_order_statistic_at_the_rounded_up_rank() {
    let sorted: Vec<f64> = (1..=1000).map(f64::from).collect();
    for (percent, value) in [(5, 50.0), (50, 500.0), (95, 950.0), (99, 990.0)] {
        assert_eq!(percentile(&sorted, 0, percent).value, Some(value));
    }
    let odd: Vec<f64> = (1..=101).map(f64::from).collect();
    assert_eq!(percentile(&odd, 0, 50).value, Some(51.0));
    assert_eq!(percentile(&odd, 0, 95).value, Some(96.0));
}

#[test]
fn bounds_with_failures_hold_whatever_the_failed_values_were() {
    let all: Vec<f64> = (1..=1000).map(f64::from).collect();
    let truth = percentile(&all, 0, 95);
    // Failures among the lowest, the highest and spread rows, as many as they may be.
    for failed in [1_usize, 5, 20] {
        let lost = [
            all[failed..].to_vec(),
            all[..1000 - failed].to_vec(),
            all.iter()
                .copied()
                .enumerate()
                .filter(|(i, _)| i % (1000 / failed) != 3)
                .map(|(_, x)| x)
                .collect(),
        ];
        for rest in lost {
            let bounded = percentile(&rest, (1000 - rest.len()) as u64, 95);
            assert!(bounded.lower <= truth.lower, "{failed} failed");
            assert!(
                bounded.upper.is_none() || bounded.upper >= truth.upper,
                "{failed} failed"
            );
        }
    }
}

#[test]
fn a_failed_share_above_a_tenth_of_the_tail_withholds_the_value_but_not_the_bounds() {
    assert!((failure_gate(0.95) - 0.005).abs() < 1e-15);
    assert!((failure_gate(0.5) - 0.05).abs() < 1e-15);
    let good: Vec<f64> = (1..=995).map(f64::from).collect();
    let at_gate = percentile(&good, 5, 95);
    assert_eq!(at_gate.status, PointStatus::Estimated);
    let beyond = percentile(&good[..994], 6, 95);
    assert_eq!(beyond.status, PointStatus::TooManyFailures);
    assert_eq!(beyond.value, None);
    assert!(beyond.lower.is_some() && beyond.upper.is_some());
}

#[test]
fn too_few_patterns_give_no_value_and_say_how_many_it_takes() {
    let good: Vec<f64> = (1..=200).map(f64::from).collect();
    let p99 = percentile(&good, 0, 99);
    assert_eq!((p99.value, p99.upper), (None, None));
    assert_eq!(p99.status, PointStatus::TooFewPatterns { needed: 368 });
    assert_eq!(percentile(&good, 0, 95).status, PointStatus::Estimated);
    let none = percentile(&[], 0, 50);
    assert_eq!((none.value, none.lower, none.upper), (None, None, None));
}

#[test]
fn moments_do_not_depend_on_the_order_of_the_rows() {
    let values: Vec<f64> = (0..500).map(|i| (f64::from(i) * 0.7).sin() + 2.0).collect();
    let mut reversed = values.clone();
    reversed.reverse();
    assert_eq!(
        SampleStatistics::new(values, 0),
        SampleStatistics::new(reversed, 0)
    );
    let known = SampleStatistics::new(vec![2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0], 0);
    assert_eq!(known.mean, Some(5.0));
    let deviation = known.standard_deviation.expect("more than one value");
    assert!((deviation - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
    assert_eq!(SampleStatistics::new(vec![1.0], 0).standard_deviation, None);
    assert_eq!(SampleStatistics::new(vec![], 3).mean, None);
}

#[test]
fn planned_is_ok_plus_failed_for_every_status() {
    let statuses = Status::ALL
        .into_iter()
        .chain([Status::Ok, Status::Ok, Status::Diverged]);
    let accounting: Accounting = statuses.collect();
    assert_eq!(
        (accounting.planned(), accounting.ok(), accounting.failed()),
        (16, 3, 13)
    );
    assert_eq!(accounting.by_status().values().sum::<u64>(), 16);
    assert_eq!(accounting.count(Status::Diverged), 2);
    let mut twice = accounting;
    twice.merge(&accounting);
    assert_eq!(twice.planned(), 32);
}
