//! Rows of the program on tuned receptances against the truth.

use blisk::model::sector::SectorModel;
use blisk::population::monte_carlo::{ResponseRow, Scenario};
use blisk::response::mistuning::{Pattern, PatternSource};
use blisk::settings::{EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};
use rayon::prelude::*;

use super::cases::folder;
use super::rows::{Row, stored};

/// Loads below which pairs of these wheels separate at their peaks, and rows take a second each, N.
const LEAST_LOAD_N: f64 = 150.0;

/// The rows of a wheel that the truth has, each with its true one.
pub fn solved(wheel: &str) -> Vec<(Row, ResponseRow)> {
    solved_within(wheel, None, |row| {
        row.load_n().is_none_or(|load| load >= LEAST_LOAD_N)
    })
}

/// Those of them that are `wanted`, at the settings for an accepted error.
pub fn solved_within(
    wheel: &str,
    accepted: Option<f64>,
    wanted: impl Fn(&Row) -> bool,
) -> Vec<(Row, ResponseRow)> {
    let truth: Vec<Row> = stored(wheel)
        .into_iter()
        .filter(|row| row.amplitude_m.is_some() && wanted(row))
        .collect();
    let study = study_of(wheel, &truth, accepted);
    let model: SectorModel = load_sector_model(&study).expect("a model");
    let patterns: PatternSource = pattern_source(&study, &model).expect("patterns");
    let engine = ReducedEngineSource
        .build(&study, &model, None)
        .expect("an engine");
    if accepted.is_some() {
        println!("{wheel}: {}", engine.chosen_settings()["accuracy"]);
    }
    let scenarios: Vec<Scenario> = study.scenarios();
    let tuned: Vec<_> = scenarios.iter().map(|own| engine.tuned(own)).collect();
    let row = |truth: Row| {
        let of = |own: &Scenario| own.contact.normal_load_n() == truth.load_n();
        let named = |own: &Scenario| {
            own.contact.normal_load_n().is_some() || own.contact.name() == truth.condition
        };
        let place = scenarios.iter().position(|own| of(own) && named(own));
        let place = place.expect("the condition of the row");
        let pattern: Pattern = patterns
            .pattern(truth.pattern as u32, None)
            .expect("the pattern of the row");
        let mut rows = engine.rows(&pattern, &[(&scenarios[place], &tuned[place])]);
        (truth, rows.pop().expect("a row"))
    };
    truth.into_par_iter().map(row).collect()
}

/// The study of a wheel with the conditions of these rows alone, on tuned receptances, in all else as the program
/// chooses by itself, by an accepted error where there is one.
fn study_of(wheel: &str, rows: &[Row], accepted: Option<f64>) -> Study {
    let path = folder(wheel).join("study.toml");
    let text = std::fs::read_to_string(&path).expect("a study");
    let mut conditions: Vec<String> = rows
        .iter()
        .map(|row| match row.load_n() {
            Some(_) => row.condition.clone(),
            None => format!("\"{}\"", row.condition),
        })
        .collect();
    conditions.sort();
    conditions.dedup();
    let physics: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("normal_load_n"))
        .collect();
    let text = format!(
        "{}\nnormal_load_n = [{}]\n\n[reduction]\nbasis = \"tuned_receptances\"\n{}",
        physics.join("\n"),
        conditions.join(", "),
        accepted.map_or(String::new(), |own| format!(
            "[accuracy]\namplitude_error = {own}\n"
        ))
    );
    Study::parse(&path, &text).expect("a good study")
}
