//! Masses and springs with friction against an independent code: every blade at every frequency.

use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::study::Study;

use super::support::{Case, Table, package};

const LOAD: ContactCondition = ContactCondition::Full {
    normal_load_n: 50.0,
};

/// Largest difference from a reference table, relative to what `scale` makes of its amplitude and
/// of its largest one.
fn worst_difference(
    case: &Case,
    pattern: Option<u32>,
    table: &str,
    scale: impl Fn(f64, f64) -> f64,
) -> f64 {
    let table = Table::read(&package("tests/data/lumped24").join(table));
    let rows: Vec<Vec<f64>> = table.rows().map(|row| row.numbers()).collect();
    assert_eq!((rows.len(), rows[0].len()), (121, 25));
    let frequencies: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let amplitudes = case.amplitudes(pattern, LOAD, &frequencies);
    let highest = rows
        .iter()
        .flat_map(|row| &row[1..])
        .copied()
        .fold(0.0, f64::max);
    rows.iter()
        .zip(&amplitudes)
        .flat_map(|(row, found)| row[1..].iter().zip(found))
        .map(|(&expected, found)| (found - expected).abs() / scale(expected, highest))
        .fold(0.0, f64::max)
}

fn study() -> Study {
    Study::read(&package("studies/lumped24.toml")).unwrap()
}

#[test]
fn two_harmonics_and_128_samples_meet_the_reference_to_a_millionth() {
    let case = Case::new(study());
    for (pattern, table) in [(None, "ref_tuned_h3.csv"), (Some(0), "ref_p0_h3.csv")] {
        let worst = worst_difference(&case, pattern, table, |own, _| own);
        println!("{table}: {worst:.1e}");
        assert!(worst <= 1e-6, "{table}: {worst:e}");
    }
}

#[test]
fn eight_odd_harmonics_meet_the_physical_answer() {
    let mut study = study();
    study.solver.harmonics = Harmonics::Set((1..=15).step_by(2).collect());
    study.solver.samples_per_period = 1024;
    let case = Case::new(study);
    for (pattern, table) in [(None, "ref_tuned_h15.csv"), (Some(0), "ref_p0_h15.csv")] {
        let worst = worst_difference(&case, pattern, table, |_, highest| highest);
        println!("{table}: {worst:.1e}");
        assert!(worst <= 1e-4, "{table}: {worst:e}");
    }
}
