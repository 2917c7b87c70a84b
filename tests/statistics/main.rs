//! Statistics: random patterns, order statistics with their intervals, accounting.

mod main_effects;
mod order_statistics;
mod patterns;
mod summary;
