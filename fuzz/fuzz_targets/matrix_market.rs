//! Any bytes as a Matrix Market file: a symmetric matrix or an error, never a panic.
#![no_main]

use std::fs;

use blisk::model::sector::matrix_market;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("matrix.mtx");
    fs::write(&path, bytes).expect("a writable folder");
    match matrix_market::read(&path) {
        Ok(matrix) => {
            matrix_market::write(&matrix, "fuzzed", &path).expect("a writable folder");
            assert_eq!(
                matrix_market::read(&path).expect("what was written"),
                matrix
            );
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
