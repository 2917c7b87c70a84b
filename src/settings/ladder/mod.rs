//! The ladder of numerical settings: its levels, the rows that they are measured on, what they cost, and their errors.

mod bench;
mod cost;
mod measure;
mod reference;
mod sample;
mod search;
mod setting;

pub(crate) use bench::{LadderBench, LadderValues};
pub(super) use bench::{LadderEngine, LadderRow};
pub(crate) use cost::LadderPlan;
pub(crate) use measure::{Compared, Measured, error_bound, errors_of_load_cases};
pub(crate) use reference::{LadderEnds, LadderReference};
pub(crate) use sample::{LadderSample, sample_of_patterns};
pub(super) use sample::{Remainders, most_scenarios, sampled_scenarios};
pub(crate) use search::{LadderSearch, Proposal};
pub(crate) use setting::projection_name;
pub use setting::{HarmonicLevel, Knob, LadderSetting};
