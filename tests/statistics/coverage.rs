//! Intervals hold what they promise: counted over many samples of known laws.

use blisk::population::statistics::{
    CONFIDENCE, DistributionBand, PointStatus, StoppingRule, percentile, percentile_ranks,
    wilks_sample,
};

use crate::laws::{LAWS, Law, sample, uniform};

const REPLICAS: u64 = 10_000;

/// Smallest share of intervals that may hold the truth: nominal minus 0.5 %.
const LEAST: f64 = CONFIDENCE - 0.005;

#[test]
fn order_statistic_intervals_hold_the_percentile_of_every_law() {
    for law in LAWS {
        for (n, percent) in [(72, 95.0), (150, 50.0), (400, 99.0)] {
            let truth = law.quantile(percent / 100.0);
            let held = (0..REPLICAS).filter(|&replica| {
                let found = percentile(&sample(law, replica, n), 0, percent);
                assert_eq!(found.status, PointStatus::Estimated);
                found.lower <= Some(truth) && found.upper >= Some(truth)
            });
            let share = held.count() as f64 / REPLICAS as f64;
            assert!(share >= LEAST, "{law:?}, n {n}, P{percent}: {share}");
            // Without atoms it is the stated coverage, within four standard errors.
            let stated = percentile_ranks(n as u64, percent / 100.0)
                .coverage
                .expect("ranks");
            if !matches!(law, Law::Rounded | Law::Atoms) {
                assert!(
                    (share - stated).abs() < 0.009,
                    "{law:?}, n {n}: {share}, {stated}"
                );
            }
        }
    }
}

#[test]
fn failure_aware_intervals_hold_the_percentile_whichever_rows_fail() {
    // Rows fail by what they would have been: the highest, the lowest, or any.
    let fails: [fn(f64, f64) -> bool; 3] = [
        |u, v| u > 0.95 && v < 0.3,
        |u, v| u < 0.1 && v < 0.3,
        |_, v| v < 0.02,
    ];
    for (n, percent) in [(200, 95.0), (100, 50.0)] {
        for (which, fail) in fails.iter().enumerate() {
            for law in [Law::Bounded, Law::Rounded] {
                let truth = law.quantile(percent / 100.0);
                let held = (0..REPLICAS).filter(|&replica| {
                    let ranks = uniform(replica, 2 * n);
                    let mut good: Vec<f64> = (0..n)
                        .filter(|&i| !fail(ranks[i], ranks[n + i]))
                        .map(|i| law.quantile(ranks[i]))
                        .collect();
                    good.sort_unstable_by(f64::total_cmp);
                    let found = percentile(&good, (n - good.len()) as u64, percent);
                    // A bound that does not exist is infinite.
                    found.lower.is_none_or(|lower| lower <= truth)
                        && found.upper.is_none_or(|upper| upper >= truth)
                });
                let share = held.count() as f64 / REPLICAS as f64;
                assert!(
                    share >= LEAST,
                    "{law:?}, failures {which}, P{percent}: {share}"
                );
            }
        }
    }
}

#[test]
fn the_band_holds_the_whole_distribution_at_once() {
    for (law, n) in [
        (Law::Uniform, 10),
        (Law::Uniform, 100),
        (Law::Uniform, 1000),
        (Law::Atoms, 100),
    ] {
        let held = (0..REPLICAS).filter(|&replica| {
            let band = DistributionBand::new(&sample(law, replica, n), 0);
            let half_width = band.half_width.expect("rows");
            let distribution = |x: f64| match law {
                Law::Atoms => [0.6, 0.96, 1.0][x as usize],
                _ => x,
            };
            // Between two values the edges stand still: the upper edge must hold up to the next one.
            let mut upper = half_width;
            band.points.iter().all(|point| {
                let truth = distribution(point.value);
                let before = match law {
                    Law::Atoms => 0.0,
                    _ => truth,
                };
                let holds = point.lower <= truth + 1e-12
                    && truth <= point.upper + 1e-12
                    && before <= upper + 1e-12;
                upper = point.upper;
                holds
            })
        });
        let share = held.count() as f64 / REPLICAS as f64;
        assert!(share >= LEAST, "{law:?}, n {n}: {share}");
    }
}

/// Share of samples whose interval at the look where they stop holds the percentile, and mean number
/// of patterns.
fn stopped(rule: &StoppingRule, law: Law) -> (f64, f64) {
    let truth = law.quantile(rule.percent / 100.0);
    let looks = rule.looks();
    let (mut held, mut patterns) = (0, 0);
    for replica in 0..REPLICAS {
        let values: Vec<f64> = uniform(replica, looks[looks.len() - 1] as usize)
            .into_iter()
            .map(|u| law.quantile(u))
            .collect();
        for (place, &n) in looks.iter().enumerate() {
            let mut sorted = values[..n as usize].to_vec();
            sorted.sort_unstable_by(f64::total_cmp);
            let look = rule.judge(place as u32 + 1, &sorted, 0);
            if look.met || place + 1 == looks.len() {
                held += u64::from(
                    look.percentile.lower <= Some(truth) && look.percentile.upper >= Some(truth),
                );
                patterns += n;
                break;
            }
        }
    }
    (
        held as f64 / REPLICAS as f64,
        patterns as f64 / REPLICAS as f64,
    )
}

#[test]
fn a_study_that_stops_early_keeps_its_coverage() {
    for relative_width in [0.5, 0.25] {
        let rule = StoppingRule {
            percent: 95.0,
            relative_width,
            patterns: 1000,
        };
        let (share, patterns) = stopped(&rule, Law::Bounded);
        assert!(share >= LEAST, "width {relative_width}: {share}");
        assert!(patterns < 990.0, "it never stops early");
    }
}

/// `cargo test --release --test statistics -- --ignored stop`
#[test]
#[ignore = "12 rules, 10,000 samples of up to 6400 values each: about a minute"]
fn every_target_and_law_keeps_its_coverage_at_the_stop() {
    for law in [Law::Bounded, Law::Exponential, Law::Rounded] {
        for relative_width in [0.4, 0.2, 0.1, 0.05] {
            let rule = StoppingRule {
                percent: 95.0,
                relative_width,
                patterns: 6400,
            };
            let (share, _) = stopped(&rule, law);
            assert!(share >= LEAST, "{law:?}, width {relative_width}: {share}");
        }
    }
}

/// Share of samples whose last interval holds the percentile where `patterns` is doubled, up to `times`
/// times, whenever all of them are spent without reaching the target: looks that nobody declared.
fn extended(rule: &StoppingRule, times: u32, law: Law) -> f64 {
    let truth = law.quantile(rule.percent / 100.0);
    let most = rule.patterns << times;
    let held = |replica: u64| {
        let values: Vec<f64> = uniform(replica, most as usize)
            .into_iter()
            .map(|u| law.quantile(u))
            .collect();
        let mut patterns_held = 0;
        for time in 0..=times {
            let rule = StoppingRule {
                patterns: rule.patterns << time,
                ..*rule
            };
            let looks = rule.looks();
            for (place, &n) in looks.iter().enumerate() {
                if n < patterns_held {
                    continue;
                }
                patterns_held = n;
                let mut sorted = values[..n as usize].to_vec();
                sorted.sort_unstable_by(f64::total_cmp);
                let look = rule.judge(place as u32 + 1, &sorted, 0);
                if look.met || n == most {
                    return look.percentile.lower <= Some(truth)
                        && look.percentile.upper >= Some(truth);
                }
            }
        }
        unreachable!("the last look ends it")
    };
    (0..REPLICAS).filter(|&replica| held(replica)).count() as f64 / REPLICAS as f64
}

/// `cargo test --release --test statistics -- --ignored --nocapture doubled`
#[test]
#[allow(clippy::print_stdout)]
#[ignore = "6 rules, 10,000 samples of up to 6400 values each: about a minute"]
fn patterns_doubled_three_times_after_missed_targets_leave_the_coverage() {
    for law in [Law::Bounded, Law::Exponential] {
        for relative_width in [0.2, 0.1, 0.05] {
            let rule = StoppingRule {
                percent: 95.0,
                relative_width,
                patterns: 800,
            };
            let share = extended(&rule, 3, law);
            println!("{law:?}, width {relative_width}: {share}");
            assert!(share >= LEAST, "{law:?}, width {relative_width}: {share}");
        }
    }
}

#[test]
fn looks_double_end_with_all_patterns_and_each_has_an_interval() {
    let rule = |patterns: u64| StoppingRule {
        percent: 95.0,
        relative_width: 0.1,
        patterns,
    };
    assert_eq!(rule(6400).looks(), [400, 800, 1600, 3200, 6400]);
    // 0.95^n <= 0.005 from 104 patterns on.
    assert_eq!(rule(450).looks(), [112, 225, 450]);
    assert_eq!(rule(207).looks(), [207]);
    assert_eq!(rule(60).looks(), [60]);
    for patterns in [104, 208, 1000, 12_345] {
        let values: Vec<f64> = (0..patterns).map(|i| 1.0 + i as f64).collect();
        for (place, n) in rule(patterns).looks().into_iter().enumerate() {
            let look = rule(patterns).judge(place as u32 + 1, &values[..n as usize], 0);
            assert!(look.relative_width.is_some(), "{patterns}, look {place}");
            assert!((look.confidence - 1.0 + 0.05 / f64::from(look.looks)).abs() < 1e-12);
        }
    }
    // A sample without result, or one in which all failed, never stops a study.
    let nothing = rule(6400).judge(1, &[], 400);
    assert!(!nothing.met && nothing.relative_width.is_none());
    assert!(!rule(6400).judge(1, &[1.0; 10], 390).met);
}

#[test]
fn one_sided_samples_are_those_of_wilks() {
    for (p, expected) in [
        (0.95, [59, 93, 124]),
        (0.99, [299, 473, 628]),
        (0.999, [2995, 4742, 6294]),
    ] {
        let found = [1, 2, 3].map(|order| wilks_sample(p, 0.95, order));
        assert_eq!(found, expected, "p = {p}");
    }
    assert_eq!(wilks_sample(0.9999, 0.95, 1), 29_956);
}
