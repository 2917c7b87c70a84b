//! The full-contact model of the program against the reference rows, and the fast path against it.

use std::fmt::Write;

use blisk::population::monte_carlo::Scenario;
use blisk::response::forced_response::ContactCondition;
use blisk::response::mistuning::PatternSource;
use blisk::response::reference::ReferencePeak;
use blisk::study::{FullModel, FullRow, FullSettings, Study, load_sector_model, pattern_source};

use super::support::{Row, package};
use super::wheels::{WHEEL8, WHEEL24, Wheel, solved_for, stands_out};

/// A wheel on the full-contact model, without any reduction but Craig-Bampton's.
struct Full {
    wheel: Wheel,
    study: Study,
    model: FullModel,
    patterns: PatternSource,
}

impl Full {
    fn new(wheel: Wheel) -> Self {
        let study = wheel.study(&format!("\"free\", \"slide\", {}, \"stuck\"", wheel.loads), "", &[1]);
        let sector = load_sector_model(&study).unwrap();
        Self {
            wheel,
            model: FullModel::build(&study, &sector, &FullSettings::default()).unwrap(),
            patterns: pattern_source(&study, sector.sectors).unwrap(),
            study,
        }
    }

    fn scenario(&self, contact: ContactCondition) -> Scenario {
        Scenario {
            index: 0,
            engine_order: self.study.engine_orders[0],
            standard_deviation: None,
            contact,
        }
    }

    fn peak(&self, id: Option<u32>, contact: ContactCondition, harmonics: &[u32]) -> ReferencePeak {
        let scenario = self.scenario(contact);
        let settings = self.model.settings(harmonics).unwrap();
        let row = FullRow {
            scenario: &scenario,
            pattern: None,
            settings: &settings,
            tuned_hz: None,
            expected_hz: None,
        };
        let tuned = self.model.peak(row);
        let Some(id) = id else { return tuned };
        self.model.peak(FullRow {
            pattern: Some(&self.patterns.pattern(id, None).unwrap()),
            tuned_hz: tuned.frequency_hz,
            ..row
        })
    }

    fn amplitude_at(&self, id: Option<u32>, contact: ContactCondition, harmonics: &[u32], hz: f64) -> f64 {
        let pattern = id.map(|id| self.patterns.pattern(id, None).unwrap());
        let settings = self.model.settings(harmonics).unwrap();
        self.model
            .curve(&self.scenario(contact), pattern.as_ref(), &settings, &[hz])
            .iter()
            .map(|point| point.amplitude_m.unwrap())
            .fold(0.0, f64::max)
    }

    /// What is wrong with one row of the reference, if anything, within the tolerances that its
    /// makers trust it to.
    fn miss(&self, row: Row<'_>) -> Option<String> {
        let (id, contact) = solved_for(row);
        let harmonics: Vec<u32> = row.text("harmonics").split('-').map(|k| k.parse().unwrap()).collect();
        let found = self.peak(id, contact, &harmonics);
        let (amplitude, frequency) = (row.number("amplitude"), row.number("frequency_hz"));
        let (within, within_hz) = match contact {
            ContactCondition::Full { .. } if harmonics[0] == 0 => (1e-2, 5e-4),
            ContactCondition::Full { .. } => (1e-3, 2e-4),
            _ => (5e-4, 5e-5),
        };
        let amplitude_error = found.amplitude_m.map_or(f64::NAN, |own| own / amplitude - 1.0);
        let frequency_error = found.frequency_hz.map_or(f64::NAN, |own| own / frequency - 1.0);
        let there = self.amplitude_at(id, contact, &harmonics, frequency) / amplitude - 1.0;
        // On a flat peak the frequency says nothing: the amplitude at the stored one does instead.
        let in_place = frequency_error.abs() <= within_hz || there.abs() <= within;
        let blade = found.blade.map_or(usize::MAX, |blade| blade as usize);
        let right_blade = blade == row.number("blade") as usize || !stands_out(self.wheel, row);
        let mut line = String::new();
        write!(
            line,
            "{} {id:?} {contact:?} {}: {} amplitude {:+.4} %, frequency {:+.5} %, there {:+.4} %, blade {blade}, separated {:.3}, {} solves, {} iterations, residual {:.1e}",
            self.wheel.name,
            row.text("harmonics"),
            found.status.name(),
            100.0 * amplitude_error,
            100.0 * frequency_error,
            100.0 * there,
            found.shares.map_or(0.0, |shares| shares.separated),
            found.work.solves,
            found.work.newton_iterations,
            found.residual.unwrap_or(f64::NAN),
        )
        .unwrap();
        println!("{line}");
        let near = amplitude_error.abs() <= within && in_place;
        (!near || !right_blade).then_some(line)
    }

    /// Compares the rows of the reference that `wanted` picks; all must be there.
    fn check(&self, count: usize, wanted: impl Fn(Row<'_>) -> bool) {
        let table = self.wheel.table("peaks.csv");
        let rows: Vec<Row<'_>> = table.rows().filter(|row| wanted(*row)).collect();
        assert_eq!(rows.len(), count);
        let misses: Vec<String> = rows.into_iter().filter_map(|row| self.miss(row)).collect();
        assert!(misses.is_empty(), "{}", misses.join("\n"));
    }
}

fn is_tuned(row: Row<'_>) -> bool {
    row.text("pattern") == "0"
}

#[test]
fn the_full_model_meets_the_tuned_reference_peaks() {
    Full::new(WHEEL8).check(20, is_tuned);
    Full::new(WHEEL24).check(20, is_tuned);
}

#[test]
#[ignore = "minutes: cargo test --release --test cases full_model -- --ignored --nocapture"]
fn the_full_model_meets_the_mistuned_reference_peaks_of_wheel8() {
    Full::new(WHEEL8).check(11, |row| !is_tuned(row));
}

#[test]
#[ignore = "an hour: cargo test --release --test cases full_model -- --ignored --nocapture"]
fn the_full_model_meets_the_mistuned_reference_peaks_of_wheel24() {
    Full::new(WHEEL24).check(8, |row| !is_tuned(row));
}
