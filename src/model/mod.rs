//! From a sector in physical coordinates to the reduced model that the Monte Carlo loop uses.

mod blade_energy;
mod cache;
pub mod cyclic;
mod reduced_model;
pub mod reduction;
pub mod sector;

pub use blade_energy::BladeEnergy;
pub use cache::{
    CacheError, is_whole_entry, read_cached, reduction_digest, sector_digest, write_cached,
    writer_of_leftover,
};
pub use reduced_model::{NodalDiameterReport, ReducedModel, ReducedNodalDiameter};
