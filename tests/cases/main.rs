//! Reference cases: solutions of the same problems by other programs, stored in `tests/data`.

// Measured figures are printed for `--nocapture`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod accuracy;
mod default_dampers;
mod full_model;
mod lumped24;
mod one_dof;
mod reduction_error;
mod rows_found;
mod stated_errors;
mod support;
mod surrogate_times;
mod validation;
mod wheels;
