//! All patterns: rows, tables, statistics.

pub mod monte_carlo;
