//! All patterns: rows, tables, statistics.

pub mod monte_carlo;
pub mod statistics;
pub mod table;
