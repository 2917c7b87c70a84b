//! Reproducibility: threads, interruption, extension and identity of a study, on a made-up engine and a real one.

mod builds;
mod continuation;
mod damage;
mod extension;
mod folder;
mod forged;
#[path = "../shared/forgery.rs"]
mod forgery;
mod integrity;
mod mock_engine;
mod scale;
mod shards;
mod solid_wheel;
mod stopping;
mod tables;
