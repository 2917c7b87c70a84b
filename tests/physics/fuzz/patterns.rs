//! CSV files of patterns.

use std::fmt::Write as _;
use std::fs;

use blisk::response::mistuning::{Deviations, read_pattern_csv};

use super::mutator::Mutator;
use super::{assert_clear, folder, run};
use crate::contact::random::Random;

const PER_BLADE: &str =
    "pattern,blade,deviation\n0,0,0.01\n0,1,-0.02\n0,2,0.03\n7,0,0\n7,1,1e-3\n7,2,-0.5\n";
const PER_MODE: &str = "# a comment\npattern,blade,mode,deviation\n0,0,0,0.01\n0,1,0,-0.02\n0,2,0,0.03\n0,0,1,0\n0,1,1,1e-3\n0,2,1,-0.5\n";

#[test]
fn a_spoiled_file_of_patterns_is_read_or_refused() {
    let folder = folder();
    let spoil = |case| {
        let mut mutator = Mutator::new(case);
        let file = *mutator.one_of(&[PER_BLADE, PER_MODE]);
        mutator.spoil(file.as_bytes())
    };
    let accepted = run(spoil, |case, bytes| {
        let path = folder.path().join(format!("{case}.csv"));
        fs::write(&path, bytes).unwrap();
        let read = read_pattern_csv(&path).and_then(|records| {
            assert!(!records.ids().is_empty());
            assert!(!records.root_mean_square().is_nan());
            records.for_wheel(3, 2)
        });
        fs::remove_file(&path).unwrap();
        match read {
            Ok(table) => {
                for id in table.ids() {
                    let pattern = table.pattern(id).unwrap();
                    let entries = pattern.entries();
                    assert!(entries.iter().all(|&(blade, mode, deviation)| {
                        blade < 3
                            && mode.is_none_or(|mode| mode < 2)
                            && deviation.is_finite()
                            && deviation > -1.0
                    }));
                    assert_eq!(entries.len() % 3, 0);
                }
                true
            }
            Err(error) => {
                let message = error.to_string();
                assert_clear(&message);
                assert!(message.contains(&format!("{case}.csv")), "{message}");
                false
            }
        }
    });
    assert!(accepted > 0, "none of the changes is harmless");
}

#[test]
fn random_patterns_read_back_to_the_last_bit() {
    let folder = folder();
    let path = folder.path().join("patterns.csv");
    for case in 0..200 {
        let mut random = Random(case);
        let blades = random.integer(1, 40);
        let values: Vec<f64> = (0..blades)
            .map(|_| random.uniform(-0.999, 1.0) * random.magnitude(1e-300, 1.0))
            .collect();
        let id = random.integer(0, i32::MAX as usize);
        let mut text = String::from("deviation,blade,pattern\r\n");
        for (blade, value) in values.iter().enumerate() {
            writeln!(text, "{value:e} , {blade},{id}\r").unwrap();
        }
        fs::write(&path, &text).unwrap();
        let table = read_pattern_csv(&path)
            .unwrap()
            .for_wheel(blades, 0)
            .unwrap();
        let pattern = table.pattern(id as u32).unwrap();
        assert_eq!(pattern.deviations, Deviations::PerBlade(values), "{case}");
    }
}
