//! Physics: exact solutions, limits and derivatives of the mechanics.
// Measured figures are printed for `--nocapture`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod bounds;
mod calculix_sector;
mod campbell;
mod contact;
mod contact_variation;
mod continuation;
mod dampers;
mod error_columns;
mod extremes;
mod finite_element;
mod fuzz;
mod harmonic_balance;
mod imports;
mod limits;
mod mistuning;
mod newton_points;
mod nodal_diameter_damping;
mod peaks;
mod reduction;
mod reference;
mod rotation;
mod sector_sources;
mod separation;
mod surrogate;
mod time_integration;
mod wheels;
mod work_counts;
