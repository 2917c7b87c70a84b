//! Times of rows and surrogates as `estimate` counts them, beside measured ones.

use std::time::Instant;

use blisk::population::monte_carlo::counted_time;
use blisk::response::forced_response::ContactCondition;
use blisk::settings::{EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};

use super::support::package;

/// Time of a surrogate over that of a row: counted, and measured on this thread.
fn ratios(file: &str, contact: ContactCondition, patterns: u32) -> (f64, f64) {
    let mut study = Study::read(&package(file)).unwrap();
    study.contacts = vec![contact];
    study.standard_deviations.truncate(1);
    let model = load_sector_model(&study).unwrap();
    let source = pattern_source(&study, &model).unwrap();
    let engine = ReducedEngineSource.build(&study, &model, None).unwrap();
    let scenario = study.scenarios().remove(0);
    let tuned = engine.tuned(&scenario);
    let surrogate = engine.surrogate(&scenario, &tuned).unwrap();
    let solver = engine.solvers().unwrap().under(&scenario).rows();
    let (mut counted, mut measured) = ([0.0; 2], [0.0; 2]);
    for id in 0..patterns {
        let pattern = source.pattern(id, scenario.standard_deviation).unwrap();
        let began = Instant::now();
        let row = engine.rows(&pattern, &[(&scenario, &tuned)]).remove(0);
        measured[0] += began.elapsed().as_secs_f64();
        counted[0] += counted_time(solver, &scenario, &row);
        let began = Instant::now();
        let peak = surrogate(&pattern).unwrap();
        measured[1] += began.elapsed().as_secs_f64();
        counted[1] += peak.counted_time;
    }
    println!(
        "{file}, {contact:?}: a row {:.1} ms, a surrogate {:.1} ms",
        1e3 * measured[0] / f64::from(patterns),
        1e3 * measured[1] / f64::from(patterns)
    );
    (counted[1] / counted[0], measured[1] / measured[0])
}

/// `cargo test --release --test cases surrogate_times -- --ignored --nocapture`
#[test]
#[ignore = "a timing of about 1 minute"]
fn counted_times_of_surrogates_beside_rows_are_those_measured_within_a_factor_of_two() {
    let full = |normal_load_n| ContactCondition::Full { normal_load_n };
    for (file, contact) in [
        ("studies/quickstart.toml", full(480.0)),
        ("studies/quickstart.toml", full(1600.0)),
        ("studies/quickstart.toml", ContactCondition::Stuck),
        ("studies/validation/lumped24-population.toml", full(75.0)),
        ("studies/validation/default-population.toml", full(480.0)),
    ] {
        let (counted, measured) = ratios(file, contact, 20);
        println!("    of a row: counted {counted:.3}, measured {measured:.3}");
        let off = counted / measured;
        assert!(
            (0.5..2.0).contains(&off),
            "{file}, {contact:?}: {counted} for {measured}"
        );
    }
}
