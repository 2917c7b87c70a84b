//! Files spoiled at random: whatever stands in them, they are read or refused with words, never a panic.
//!
//! Each case follows from its number alone. The quick form is 5000 cases for each kind of file; more of
//! them, for as long as one likes:
//!
//! ```text
//! BLISK_FUZZ_CASES=1000000 cargo test --release --test physics fuzz
//! ```
//!
//! The same kinds of file guided by coverage, with a nightly toolchain and `cargo-fuzz`, are in `fuzz/`.

mod bundles;
mod imports;
mod matrices;
mod mutator;
mod patterns;
mod studies;

use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;

/// Number of cases of each kind.
fn cases() -> u64 {
    std::env::var("BLISK_FUZZ_CASES").map_or(5000, |cases| cases.parse().unwrap())
}

/// Runs `check` on `spoil(case)` of every case; a panic is reported with the input that caused it.
/// Returns how many inputs were accepted.
fn run(spoil: impl Fn(u64) -> Vec<u8> + Sync, check: impl Fn(u64, &[u8]) -> bool + Sync) -> usize {
    let accepted = (0..cases())
        .into_par_iter()
        .filter(|&case| {
            let input = spoil(case);
            let outcome = catch_unwind(AssertUnwindSafe(|| check(case, &input)));
            outcome.unwrap_or_else(|_| {
                let text = String::from_utf8_lossy(&input);
                let shown: String = text.chars().take(4000).collect();
                panic!("case {case} panicked on:\n{shown}");
            })
        })
        .count();
    println!("{accepted} of {} accepted", cases());
    accepted
}

/// A folder of its own, whose name, part of messages, does not end like one of the sources.
fn folder() -> tempfile::TempDir {
    tempfile::Builder::new().suffix("-case").tempdir().unwrap()
}

/// A message for the user: not empty, no debris of the program.
fn assert_clear(message: &str) {
    assert!(!message.trim().is_empty());
    for debris in ["panicked", "unwrap", "RUST_BACKTRACE", "src/"] {
        assert!(!message.contains(debris), "{message}");
    }
}
