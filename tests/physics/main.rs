//! Physics: exact solutions, limits and derivatives of the mechanics.
#![allow(clippy::unwrap_used)]

mod contact;
mod finite_element;
mod sector_sources;
