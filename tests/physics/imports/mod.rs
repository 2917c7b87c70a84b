//! Sectors from finite-element codes: every format, the frequencies of `CalculiX`, and what is refused.

mod built_in;
mod calculix;
mod cartesian;
mod formats;
pub mod lumped;
mod other_writers;
mod projection;
mod refused;
mod refused_sides;
mod sides;
pub mod small;
mod templates;
mod triangles;
mod writers;
