//! Reference cases: solutions of the same problems by other programs, stored in `tests/data`.

#![allow(clippy::unwrap_used)]

mod support;
mod wheels;
