//! Reference cases: solutions of the same problems by other programs, stored in `tests/data`.

#![allow(clippy::unwrap_used)]

mod lumped24;
mod one_dof;
mod support;
mod wheels;
