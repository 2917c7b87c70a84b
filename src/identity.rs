//! What this program was built from. Two builds may calculate differently, so their rows are never mixed.
//!
//! `build.rs` makes the identity. It stands as `build` in manifests, in the headers of parts, in the records of runs and
//! in the keys of cached models; never in a Parquet file or in the digest of a study, which are of the study alone.

use serde::Serialize;

/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Digest, hexadecimal, of the sources, the locked dependencies, the features, the compiler and its settings.
pub const BUILD: &str = env!("BLISK_BUILD");

/// A commit that holds these sources, `, changed` after it where some differ from it; `none` without a repository.
pub const COMMIT: &str = env!("BLISK_COMMIT");

/// Version, build and commit, a line each.
pub const IN_WORDS: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\nbuild ",
    env!("BLISK_BUILD"),
    "\ncommit ",
    env!("BLISK_COMMIT")
);

/// How a stored `build` is named in a message; results of 0.1.0 have none.
#[must_use]
pub fn named(build: &str) -> &str {
    if build.is_empty() { "(none)" } else { build }
}

/// What two values that are the same to the last bit have in common, and no other value of their type: numbers in the order of the
/// fields, whatever these are called.
#[must_use]
pub fn bytes_of(value: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(value).expect("numbers in memory can be written to memory")
}
