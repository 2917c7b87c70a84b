//! Reproducibility: threads, interruption, extension and identity of a study, on a made-up engine.

mod continuation;
mod damage;
mod extension;
mod folder;
mod mock_engine;
mod shards;
mod stopping;
mod tables;
