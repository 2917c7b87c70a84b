//! Multipliers of the linearised motion about a periodic one: closed forms, and what the marched motion does.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails, and what is measured is shown by `--nocapture`"
)]

mod one_dof;
mod points;
