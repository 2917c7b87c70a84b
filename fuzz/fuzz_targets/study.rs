//! Any text as a study file: a study or an error, never a panic.
#![no_main]

use std::path::Path;

use blisk::study::{Study, load_sector_model};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match Study::parse(Path::new("studies/fuzzed.toml"), text) {
        Ok(study) => drop(load_sector_model(&study)),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
