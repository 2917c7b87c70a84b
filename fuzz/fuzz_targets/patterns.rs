//! Any bytes as a CSV file of patterns: patterns or an error, never a panic.
#![no_main]

use std::fs;

use blisk::response::mistuning::read_pattern_csv;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("patterns.csv");
    fs::write(&path, bytes).expect("a writable folder");
    match read_pattern_csv(&path).and_then(|records| records.for_wheel(5, 3)) {
        Ok(table) => assert!(table.ids().iter().all(|&id| table.pattern(id).is_some())),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
