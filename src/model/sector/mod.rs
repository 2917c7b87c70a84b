//! The sector model, its validation, and everything that makes one.

mod sector_model;

pub use sector_model::{Body, Component, ContactPair, Dof, ObservedNode, SectorModel};
