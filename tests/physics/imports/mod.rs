//! Sectors from finite-element codes: every format, the frequencies of `CalculiX`, and what is refused.

mod calculix;
mod cartesian;
mod formats;
mod other_writers;
mod projection;
mod refused;
pub mod small;
mod templates;
mod triangles;
mod writers;
