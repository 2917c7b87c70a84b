//! Statistics: random patterns, order statistics with their intervals, accounting.

mod order_statistics;
mod patterns;
mod summary;
