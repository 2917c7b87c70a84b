//! The study file: as written, checked, resolved; and the pipeline that turns it into tables.

mod basis_choice;
mod digest;
mod engine;
mod error;
mod harmonic_choice;
mod mistuning;
mod pipeline;
mod pipeline_error;
mod raw;
mod reduced_engine;
mod resolved;
mod response_curve;
mod results_folder;
mod sector_model;
mod source_map;
mod template;
mod validate;
mod validate_mistuning;
mod validate_solver;

pub use digest::{StudyDigest, digest_file};
pub use engine::{Engine, EngineSource};
pub use error::{Finding, Problem, StudyError};
pub use mistuning::{Mistuning, MistuningSource};
pub use pipeline::{Progress, RunOutcome, RunRequest, Stage, run, summarise};
pub use pipeline_error::PipelineError;
pub use reduced_engine::ReducedEngineSource;
pub use resolved::{ModelSource, OutputOptions, Study};
pub use response_curve::{CurveRequest, response_curve};
pub use sector_model::{load_sector_model, pattern_source};
pub use template::STUDY_TEMPLATE;
