//! Rows of mistuned wheels at default settings, whose tops few harmonics lead to, against a search of the whole band with all of them.

use std::path::Path;

use blisk::population::monte_carlo::ResponseRow;
use blisk::response::mistuning::{Pattern, PatternSource};
use blisk::settings::{EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};
use rayon::prelude::*;

/// First patterns of the quickstart.
const PATTERNS: u32 = 12;
/// Loads at which harmonics beyond 3 change the highest amplitude most, and change where it is.
const LOADS: &str = "[320, 1600]";
/// Every point with harmonics 0 to 15.
const WHOLE: &str = "
[solver]
harmonics = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]
search_harmonics = \"all\"
samples_per_period = 256\npeak_tolerance = 1e-4\n";

/// A load at which pairs of about every third wheel open at its top.
const OPENING: &str = "[140]";

/// Rows of the quickstart at `loads`, pattern after pattern, with more settings after its own.
fn rows(loads: &str, settings: &str) -> Vec<ResponseRow> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/quickstart.toml");
    let text = std::fs::read_to_string(&path).expect("a study");
    let lines = text.lines().map(|line| {
        if line.starts_with("normal_load_n") {
            format!("normal_load_n = {loads}")
        } else {
            line.to_owned()
        }
    });
    let lines: Vec<String> = lines.collect();
    let study = Study::parse(&path, &format!("{}\n{settings}", lines.join("\n")));
    let study = study.expect("a good study");
    let model = load_sector_model(&study).expect("a model");
    let patterns: PatternSource = pattern_source(&study, &model).expect("patterns");
    let engine = ReducedEngineSource
        .build(&study, &model, None)
        .expect("an engine");
    let scenarios = study.scenarios();
    let tuned: Vec<_> = scenarios.iter().map(|own| engine.tuned(own)).collect();
    let conditions: Vec<_> = scenarios.iter().zip(&tuned).collect();
    let of_pattern = |id: u32| {
        let pattern: Pattern = patterns
            .pattern(id, scenarios[0].standard_deviation)
            .expect("a pattern");
        engine.rows(&pattern, &conditions)
    };
    let ids: Vec<u32> = (0..PATTERNS).collect();
    ids.into_par_iter().flat_map_iter(of_pattern).collect()
}

/// Largest difference of tops from those of a search of the whole band with all harmonics, each within what the row states.
fn largest_difference(own: &[ResponseRow], whole: &[ResponseRow]) -> f64 {
    let mut largest: f64 = 0.0;
    for (own, whole) in own.iter().zip(whole) {
        assert_eq!((own.pattern, own.scenario), (whole.pattern, whole.scenario));
        assert_eq!(own.harmonics, whole.harmonics);
        let amplitude_m = |row: &ResponseRow| row.peak_amplitude_m.expect("a peak");
        let error = amplitude_m(own) / amplitude_m(whole) - 1.0;
        let stated = own.stated_error.expect("an error");
        println!(
            "pattern {}, scenario {}, {:.0} % open: {error:.2e}, stated {stated:.2e}",
            own.pattern,
            own.scenario,
            100.0 * own.separated_fraction.unwrap_or(0.0)
        );
        assert!(error.abs() <= stated, "{error:.2e}, stated {stated:.2e}");
        largest = largest.max(error.abs());
    }
    println!("largest {largest:.2e}");
    largest
}

/// `cargo test --release --test receptance automatic -- --nocapture`
#[test]
fn automatic_harmonics_miss_no_more_than_rows_state() {
    faer::set_global_parallelism(faer::Par::Seq);
    let (own, whole) = (rows(LOADS, ""), rows(LOADS, WHOLE));
    assert_eq!(own.len(), 2 * PATTERNS as usize);
    let largest = largest_difference(&own, &whole);
    assert!(largest <= 3e-3, "{largest:.2e}");
}

/// Where contacts open, few harmonics with the mean motion lead to the top.
#[test]
fn automatic_harmonics_find_the_tops_of_wheels_whose_contacts_open() {
    faer::set_global_parallelism(faer::Par::Seq);
    let (own, whole) = (rows(OPENING, ""), rows(OPENING, WHOLE));
    assert_eq!(own.len(), PATTERNS as usize);
    let open = |row: &&ResponseRow| row.separated_fraction.is_some_and(|share| share > 0.0);
    assert!(own.iter().filter(open).count() >= 3);
    let largest = largest_difference(&own, &whole);
    assert!(largest <= 3e-3, "{largest:.2e}");
}

/// The fallback has fewer harmonics: it is for rows without a peak, and no better for those that state a large error.
#[test]
fn automatic_harmonics_are_not_exchanged_for_fewer_where_a_row_is_beyond_its_tolerance() {
    faer::set_global_parallelism(faer::Par::Seq);
    let beyond = |what: &str| {
        let settings = "[solver]\nharmonic_tolerance = 1e-5\nrows_beyond_tolerance";
        rows("[800]", &format!("{settings} = \"{what}\"\n"))
    };
    let (flagged, resolved) = (beyond("flag"), beyond("resolve"));
    let inexact = |row: &ResponseRow| row.error_within_tolerance == Some(false);
    assert!(flagged.iter().all(inexact));
    assert_eq!(flagged, resolved);
}
