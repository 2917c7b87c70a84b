//! Direct time integration: exact solutions for the integrator, and harmonic balance held against it.
//!
//! The long forms, in release:
//!
//! ```text
//! cargo test --release --test physics time_integration -- --ignored --nocapture
//! ```

mod lumped;
mod march;
mod one_dof;
mod stability;
mod wheel8;

use std::path::Path;

/// Deviations of a pattern from a table `pattern,blade,deviation`.
pub fn deviations(folder: &str, table: &str, pattern: usize, blades: usize) -> Vec<f64> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(folder)
        .join(table);
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .filter_map(|line| line.split(',').map(|cell| cell.parse().ok()).collect())
        .collect();
    let own: Vec<f64> = rows
        .iter()
        .filter(|row| row[0] as usize == pattern)
        .map(|row| row[2])
        .collect();
    assert_eq!(own.len(), blades);
    own
}
