//! A study with a rule to stop: where it stops, with which bounds, and what an edit of the rule does.

use std::sync::atomic::Ordering;

use blisk::campaign::{ResultColumns, RunRequest, merge, repair, run_shard, summarise};
use blisk::population::statistics::{
    CONFIDENCE, Quantity, StopOutcome, percentile_at, percentile_ranks_at,
};
use blisk::population::table::{Manifest, Shard};
use blisk::settings::ReducedEngineSource;
use blisk::study::{PipelineError, Study};

use crate::folder::{Silent, bytes, interrupt_in, reference, run_in};
use crate::mock_engine::{MockSource, study};

/// At most `patterns`, until the median factor is known within `width`.
fn stopping(patterns: u32, width: f64) -> Study {
    study(patterns, |text| {
        format!(
            "{text}[stop]\npercentile = 50\nrelative_width = {width}\nquantity = \"amplification_factor\"\n"
        )
    })
}

/// Relative width of the interval of the median of the widest scenario over the first `patterns` of the
/// results in `columns`, its ranks taken from the binomial law.
fn widest(columns: &ResultColumns, patterns: usize, confidence: f64) -> f64 {
    let ranks = percentile_ranks_at(patterns as u64, 0.5, confidence);
    let (l, u) = (ranks.lower.expect("a rank"), ranks.upper.expect("a rank"));
    let width = |values: &[Option<f64>]| {
        let values = &values[..patterns];
        let place = |failed_at: f64, rank: u64| {
            let mut all: Vec<f64> = values.iter().map(|v| v.unwrap_or(failed_at)).collect();
            all.sort_by(f64::total_cmp);
            all[rank as usize - 1]
        };
        let mut good: Vec<f64> = values.iter().flatten().copied().collect();
        good.sort_by(f64::total_cmp);
        let value = good[good.len().div_ceil(2) - 1];
        (place(f64::INFINITY, u) - place(f64::NEG_INFINITY, l)) / value
    };
    columns
        .scenarios
        .iter()
        .map(|scenario| width(scenario.values(Quantity::AmplificationFactor)))
        .fold(0.0, f64::max)
}

fn outcome_in(folder: &std::path::Path) -> (u64, StopOutcome) {
    let manifest = Manifest::read(folder).expect("read").expect("there");
    (manifest.patterns, manifest.stop.expect("a rule"))
}

#[test]
fn it_stops_at_the_first_look_at_which_every_scenario_is_narrow() {
    let whole = tempfile::tempdir().expect("a temporary folder");
    let all = study(1600, |text| text);
    run_in(whole.path(), &all, 2, &MockSource::default()).expect("all patterns");
    let columns = ResultColumns::read(whole.path()).expect("columns");
    let looks = [100_usize, 200, 400, 800, 1600];
    let widths = looks.map(|look| widest(&columns, look, 0.99));
    // Between the widths of two looks that are records, so that it stops at the later one.
    for (place, patterns) in [(1, 200), (2, 400), (3, 800)] {
        let before = widths[..place]
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min);
        assert!(widths[place] < before, "{widths:?}");
        let study = stopping(1600, 0.5 * (before + widths[place]));
        let folder = tempfile::tempdir().expect("a temporary folder");
        let source = MockSource::default();
        let outcome = run_in(folder.path(), &study, 2, &source).expect("the run");
        assert_eq!(outcome.rows_solved, 4 * patterns);
        let (held, stop) = outcome_in(folder.path());
        assert_eq!((held, stop.met), (patterns, true));
        assert_eq!(stop.looks, looks.map(|look| look as u64));
        assert_eq!(stop.made.len(), place + 1);
        assert!((stop.confidence - 0.99).abs() < 1e-12);
        for (look, width) in stop.made.iter().zip(widths) {
            let found = look.scenarios.iter().filter_map(|s| s.relative_width);
            let found = found.fold(0.0, f64::max);
            assert!((found / width - 1.0).abs() < 1e-12, "{found}, {width}");
        }
        // What is published is the interval of the rule, in the tables and in the summary.
        let summary = summarise(folder.path()).expect("a summary");
        assert_eq!(summary, outcome.summary);
        assert_eq!(
            (summary.patterns, summary.stop.as_ref()),
            (patterns, Some(&stop))
        );
        let columns = ResultColumns::read(folder.path()).expect("columns");
        assert_eq!(columns.patterns.len() as u64, patterns);
        for (scenario, of_rule) in columns.scenarios.iter().zip(&stop.made[place].scenarios) {
            let (sorted, failed) = scenario.sorted(Quantity::AmplificationFactor);
            let wide = percentile_at(&sorted, failed, 50.0, 0.99);
            let narrow = percentile_at(&sorted, failed, 50.0, CONFIDENCE);
            assert!(wide.upper > narrow.upper);
            let index = scenario.scenario.index;
            let published = &summary.scenarios[index].amplification_factor;
            assert_eq!(published.percentile(50), Some(&wide));
            assert_eq!((of_rule.lower, of_rule.upper), (wide.lower, wide.upper));
        }
        let again = run_in(folder.path(), &study, 1, &source).expect("nothing to do");
        assert_eq!((again.rows_solved, again.rows_reused), (0, 4 * patterns));
        assert_eq!(source.solved.load(Ordering::SeqCst), 4 * patterns / 2);
    }
}

#[test]
fn threads_and_interruptions_leave_the_bytes_as_they_are() {
    let study = stopping(1600, 0.03);
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(folder.path(), &study, 1, &MockSource::default()).expect("the run");
    let expected = bytes(folder.path());
    let (patterns, stop) = outcome_in(folder.path());
    assert!(stop.met && patterns > 100 && patterns < 1600, "{stop:?}");
    for threads in [2, 4, 16] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        run_in(folder.path(), &study, threads, &MockSource::default()).expect("the run");
        assert!(bytes(folder.path()) == expected, "{threads} threads");
    }
    let rows = 4 * patterns as i64;
    let folder = tempfile::tempdir().expect("a temporary folder");
    for stored in [10, 350, 60, rows / 4] {
        interrupt_in(folder.path(), &study, stored);
    }
    let outcome = run_in(folder.path(), &study, 3, &MockSource::default()).expect("continued");
    assert_eq!(outcome.rows_solved + outcome.rows_reused, rows as u64);
    assert!(outcome.rows_reused > 390, "{}", outcome.rows_reused);
    assert!(bytes(folder.path()) == expected);
    // Rows of a longer study that was broken off change no decision.
    let folder = tempfile::tempdir().expect("a temporary folder");
    interrupt_in(
        folder.path(),
        &crate::mock_engine::study(1600, |text| text),
        rows + 1500,
    );
    run_in(folder.path(), &study, 2, &MockSource::default()).expect("continued");
    assert!(bytes(folder.path()) == expected);
}

#[test]
fn all_patterns_are_spent_where_the_target_is_out_of_reach() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let study = stopping(400, 1e-4);
    let outcome = run_in(folder.path(), &study, 2, &MockSource::default()).expect("the run");
    assert_eq!(outcome.rows_solved, 1600);
    assert!(outcome.summary.misses_its_target());
    let (patterns, stop) = outcome_in(folder.path());
    assert_eq!((patterns, stop.met, stop.made.len()), (400, false, 5));
    assert!(
        outcome
            .summary
            .to_string()
            .contains("NOT reached at look 5 of 5, 400 of at most 400")
    );
}

#[test]
fn an_edited_rule_goes_on_from_what_is_there_and_gives_nothing_up() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = |study: &Study| {
        let source = MockSource::default();
        let outcome = run_in(folder.path(), study, 2, &source).expect("the run");
        let manifest = Manifest::read(folder.path()).expect("read").expect("there");
        (outcome.rows_solved, manifest.patterns, manifest.stop)
    };
    let (solved, first, stop) = run(&stopping(1600, 0.11));
    assert_eq!(solved, 4 * first);
    assert!(stop.expect("a rule").met && first < 800);
    // Stricter: only what is missing is solved, and the result is that of a run at once.
    let strict = stopping(1600, 0.06);
    let (solved, second, stop) = run(&strict);
    assert!(second > first && stop.expect("a rule").met);
    assert_eq!(solved, 4 * (second - first));
    let fresh = tempfile::tempdir().expect("a temporary folder");
    run_in(fresh.path(), &strict, 2, &MockSource::default()).expect("at once");
    assert!(bytes(folder.path()) == bytes(fresh.path()));
    // Looser: what is there is more than enough, and stays.
    let (solved, third, stop) = run(&stopping(1600, 0.2));
    let stop = stop.expect("a rule");
    assert_eq!((solved, third, stop.met), (0, second, true));
    assert!(stop.made[0].met || stop.made[1].met);
    // More patterns at most: the next look of the new plan, from what is held on.
    let (solved, fourth, stop) = run(&stopping(1800, 0.2));
    let looks = stop.expect("a rule").looks;
    assert_eq!(Some(&fourth), looks.iter().find(|&&look| look >= second));
    assert_eq!(solved, 4 * (fourth - second));
    // Without a rule all patterns are solved, with the bounds of a fixed sample.
    let (solved, fifth, stop) = run(&study(1800, |text| text));
    assert_eq!((solved, fifth, stop), (4 * (1800 - fourth), 1800, None));
    assert!(bytes(folder.path()) == reference(1800));
    // A rule on top of it takes all patterns for its last look.
    let (solved, sixth, stop) = run(&stopping(1800, 0.2));
    assert_eq!((solved, sixth), (0, 1800));
    assert_eq!(stop.map(|stop| stop.made.len()), Some(5));
    // Fewer than are held is refused, as ever.
    let refused = run_in(
        folder.path(),
        &stopping(1600, 0.2),
        1,
        &MockSource::default(),
    );
    assert!(matches!(refused, Err(PipelineError::DifferentStudy { .. })));
}

#[test]
fn a_new_scenario_is_looked_at_with_the_others() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rule =
        "[stop]\npercentile = 50\nrelative_width = 0.11\nquantity = \"amplification_factor\"\n";
    let with = |deviations: &str| {
        study(1600, |text| {
            format!("{}{rule}", text.replace("[0.03, 0.01]", deviations))
        })
    };
    run_in(folder.path(), &with("[0.01]"), 2, &MockSource::default()).expect("the run");
    let (few, _) = outcome_in(folder.path());
    // A wider law needs more patterns, and takes the other one along.
    let wide = with("[0.01, 0.05]");
    run_in(folder.path(), &wide, 2, &MockSource::default()).expect("grown");
    let (more, stop) = outcome_in(folder.path());
    assert!(stop.met && more > few, "{few}, {more}");
    let fresh = tempfile::tempdir().expect("a temporary folder");
    run_in(fresh.path(), &wide, 2, &MockSource::default()).expect("at once");
    assert!(bytes(folder.path()) == bytes(fresh.path()));
}

#[test]
fn shards_cannot_stop_and_merged_ones_are_all_patterns() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let cut = |study: &Study, number: u32| {
        let request = RunRequest {
            study,
            results: folder.path(),
            threads: 1,
        };
        let shard = Shard { number, count: 2 };
        run_shard(request, shard, &MockSource::default(), &Silent)
    };
    let error = cut(&stopping(400, 0.1), 1).expect_err("a rule").to_string();
    assert!(error.contains("chain.toml has a [stop]"), "{error}");
    assert!(error.contains("all of its 400 patterns"), "{error}");
    let plain = study(400, |text| text);
    for number in [1, 2] {
        cut(&plain, number).expect("a shard");
    }
    // Shards join a folder that stopped before: they are more of the same rows.
    run_in(
        folder.path(),
        &stopping(400, 0.3),
        1,
        &MockSource::default(),
    )
    .expect("stopped");
    assert!(outcome_in(folder.path()).0 < 400);
    merge(
        &[
            folder.path().join("shards/1-of-2"),
            folder.path().join("shards/2-of-2"),
        ],
        folder.path(),
        None,
        &ReducedEngineSource,
    )
    .expect("merged");
    assert!(bytes(folder.path()) == reference(400));
}

#[test]
fn repair_comes_to_the_same_bytes_where_more_is_held_than_the_rule_needs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let chain = |width: f64| {
        let text = crate::mock_engine::study_text(800);
        let rule = format!(
            "[stop]\npercentile = 50\nrelative_width = {width}\nquantity = \"amplification_factor\"\n"
        );
        let path = folder.path().join("chain.toml");
        std::fs::write(&path, format!("{text}{rule}")).expect("written");
        Study::read(&path).expect("a study")
    };
    let results = folder.path().join("results");
    let request = |study: &Study| {
        let request = RunRequest {
            study,
            results: &results,
            threads: 1,
        };
        blisk::campaign::run(request, &ReducedEngineSource, &Silent).expect("a run");
    };
    request(&chain(0.3));
    let (few, _) = outcome_in(&results);
    request(&chain(0.05));
    request(&chain(0.3));
    let (held, _) = outcome_in(&results);
    assert!(held > few, "{held}, {few}");
    let before = bytes(&results);
    let table = results.join("responses.parquet");
    let mut content = std::fs::read(&table).expect("read");
    let middle = content.len() / 2;
    content[middle] ^= 4;
    std::fs::write(&table, content).expect("written");
    let repaired = repair(&results, None, 1, &ReducedEngineSource, &Silent).expect("repaired");
    assert_eq!(repaired.different, Vec::<String>::new());
    assert!(bytes(&results) == before);
}
