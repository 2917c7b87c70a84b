//! Statistics: random patterns, order statistics with their intervals, accounting, comparisons, tails.

mod comparison;
mod comparison_cases;
mod coverage;
mod laws;
mod main_effects;
mod multi_fidelity;
mod order_statistics;
mod patterns;
mod percentile_windows;
mod summary;
mod tail_fits;
