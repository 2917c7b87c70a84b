//! `[output]`: what a study writes beside its statistics.

use crate::population::table::Compression;

/// What is written beside the statistics, and how.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OutputOptions {
    /// Whether `patterns.parquet` is written; absent: up to 10,000 patterns.
    pub patterns: Option<bool>,
    /// Compression of the tables.
    pub compression: Compression,
    /// Stress per amplitude of the observed node, Pa/m.
    pub stress_pa_per_m: Option<f64>,
    /// Rows round every percentile whose motions are looked at for their stability; 0: none, and no tuned wheel.
    pub stability: u32,
}
