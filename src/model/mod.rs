//! From a sector in physical coordinates to the reduced model that the Monte Carlo loop uses.

pub mod cyclic;
pub mod reduction;
pub mod sector;
