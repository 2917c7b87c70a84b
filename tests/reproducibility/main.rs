//! Reproducibility: threads, interruption, extension and identity of a study, on a made-up engine.

mod continuation;
mod mock_engine;
mod tables;
