//! Problems that a program states in its own words, solved without a study file.

mod engine;
mod numerics;
mod population;
mod problem;
#[cfg(feature = "parquet")]
mod run;

pub use engine::Engine;
pub use numerics::Numerics;
pub use population::Population;
pub use problem::{Mistuning, Problem};
#[cfg(feature = "parquet")]
pub use run::run;
