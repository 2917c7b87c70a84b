//! The sector bundle, a directory that describes one sector: the format shared with FE codes.
//!
//! Specified in `docs/sector-bundle.md`.

mod header;
mod read;
mod table;
mod write;

pub use read::{read, read_force};
pub use write::write;
