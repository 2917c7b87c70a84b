//! From a sector in physical coordinates to the reduced model that the Monte Carlo loop uses.

pub mod cyclic;
mod reduced_model;
pub mod reduction;
pub mod sector;

pub use reduced_model::{NodalDiameterReport, ReducedModel, ReducedNodalDiameter};
