//! Sources of a sector model: built-in geometry, masses and springs, bundles, and what they refuse.

mod bundle;
pub mod lumped;
mod parametric;
mod refused_files;
mod refused_models;

use std::path::{Path, PathBuf};

/// A file or folder of reference data.
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}
