//! The fast path at its default basis against rows of an independent full-contact code.

use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::study::Study;

use super::super::support::{Case, Row, Table, package};
use super::{Section, percent, table};

/// Harmonic sets of the reference, rows without separation.
const SETS: [&[u32]; 4] = [&[1], &[1, 3], &[1, 2, 3], &[1, 3, 5]];

pub(super) fn section() -> Section {
    let mut rows = Vec::new();
    for wheel in ["wheel8", "wheel24"] {
        for set in SETS {
            rows.extend(compare(wheel, set));
        }
    }
    let header = [
        "model",
        "harmonics",
        "pattern",
        "basis",
        "rows",
        "worst amplitude error",
        "worst frequency error",
    ];
    let text = format!(
        "Peaks of `stuck`, `slide`, `free` and of three normal loads without separation, with the basis that `auto` chooses \
         (wanted error 0.1 %), against a Craig-Bampton and harmonic balance code that keeps every contact dof (512 samples, 25 \
         fixed-interface modes, same harmonics; its own tolerance is 0.1 % in amplitude, 0.02 % in frequency).\n\n{}",
        table(&header, &rows)
    );
    Section {
        title: "Fast path against an independent full-contact code",
        text,
    }
}

/// A line for the tuned rows of one harmonic set and one for the mistuned ones.
fn compare(wheel: &str, set: &[u32]) -> Vec<Vec<String>> {
    let mut study = Study::read(&package(&format!("studies/validation/{wheel}.toml"))).unwrap();
    study.solver.harmonics = Harmonics::Set(set.to_vec());
    let case = Case::new(study);
    let name = set.iter().map(u32::to_string).collect::<Vec<_>>().join("-");
    let reference = Table::read(&package(&format!("tests/data/{wheel}/reference/peaks.csv")));
    ["tuned", "mistuned"]
        .into_iter()
        .filter_map(|pattern| {
            let errors: Vec<(f64, f64)> = reference
                .rows()
                .filter(|row| row.text("harmonics") == name)
                .filter(|row| (row.number("pattern") > 0.0) == (pattern == "mistuned"))
                .map(|row| errors(&case, row))
                .collect();
            let worst = |of: fn(&(f64, f64)) -> f64| errors.iter().map(of).fold(0.0, f64::max);
            (!errors.is_empty()).then(|| {
                vec![
                    wheel.to_owned(),
                    name.clone(),
                    pattern.to_owned(),
                    case.basis(),
                    errors.len().to_string(),
                    percent(worst(|error| error.0)),
                    percent(worst(|error| error.1)),
                ]
            })
        })
        .collect()
}

/// Relative errors of amplitude and frequency.
fn errors(case: &Case, row: Row<'_>) -> (f64, f64) {
    let contact = match row.text("contact") {
        "free" => ContactCondition::Free,
        "slide" => ContactCondition::Slide,
        "stuck" => ContactCondition::Stuck,
        _ => ContactCondition::Full {
            normal_load_n: row.number("load"),
        },
    };
    let pattern = row.number("pattern") as u32;
    let found = case.peak((pattern > 0).then_some(pattern), contact);
    let error = |found: f64, column| (found / row.number(column) - 1.0).abs();
    (
        error(found.amplitude_m, "amplitude"),
        error(found.frequency_hz, "frequency_hz"),
    )
}
