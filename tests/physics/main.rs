//! Physics: exact solutions, limits and derivatives of the mechanics.
// Measured figures are printed for `--nocapture`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod contact;
mod error_columns;
mod finite_element;
mod harmonic_balance;
mod limits;
mod mistuning;
mod peaks;
mod reduction;
mod sector_sources;
mod wheels;
