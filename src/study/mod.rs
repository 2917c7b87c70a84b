//! The study file: as written, checked, resolved, and what it says of its sector model.

mod accuracy;
pub(crate) mod checks;
mod echo;
mod error;
mod examples;
mod excitation;
mod given;
mod keys;
mod load_cases;
mod mistuning;
mod nodal_diameter_damping;
mod output;
mod pipeline_error;
mod resolved;
mod rotation;
mod rotation_load;
mod sector_model;
mod template;

pub use accuracy::AccuracyOptions;
pub use echo::echo;
pub use error::StudyError;
pub use examples::{EXAMPLES, example_beside_its_data};
pub(crate) use excitation::{Excitation, excitations, solver_under};
pub(crate) use given::Given;
pub use keys::{
    KeySpec, Range, StudyDigest, Value, keys, keys_about, keys_below, nearest_keys, study_schema,
};
pub use load_cases::{ForceSource, LoadCase};
pub use mistuning::{Mistuning, MistuningSource};
pub use nodal_diameter_damping::NodalDiameterTable;
pub use output::OutputOptions;
pub use pipeline_error::PipelineError;
pub use resolved::{ModelSource, Study};
pub use rotation_load::{LoadShare, RotationLoad, RotationOptions};
pub(crate) use sector_model::judging_patterns;
pub use sector_model::{load_sector_model, pattern_source};
pub use template::STUDY_TEMPLATE;

pub use crate::input::{Excerpt, Finding, Problem};
