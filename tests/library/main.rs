//! The library as a program uses it: the examples, problems without a study file, what is refused.

#![allow(clippy::unwrap_used)]

mod examples;
mod face;
mod problems;
