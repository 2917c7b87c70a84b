//! The engine that the commands use.

use crate::study::EngineSource;

/// The maker of engines behind `model`, `run` and `response`.
pub(super) fn engine_source() -> impl EngineSource {
    unplugged::Unplugged
}

mod unplugged {
    //! Stands in until the engine is there.

    use std::path::Path;

    use crate::model::sector::SectorModel;
    use crate::study::{Engine, EngineSource, PipelineError, Study};

    pub(super) struct Unplugged;

    impl EngineSource for Unplugged {
        fn build(
            &self,
            study: &Study,
            _model: &SectorModel,
            _cache: Option<&Path>,
        ) -> Result<Box<dyn Engine>, PipelineError> {
            Err(PipelineError::NoResults {
                folder: study.path.clone(),
            })
        }
    }
}
