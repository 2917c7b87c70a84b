//! `blisk check`: everything about a study that can be wrong before a solve.

use std::path::Path;

use serde_json::json;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::study::{RotationLoad, Study, StudyDigest, echo, load_sector_model, pattern_source};

pub(super) fn command(study: &Path, json: bool) -> Result<ExitStatus, Failure> {
    let study = Study::read(study)?;
    let model = load_sector_model(&study)?;
    pattern_source(&study, &model)?;
    let digest = StudyDigest::of(&study)?;
    let echo = echo(&study, &model);
    if json {
        output::json_only(&json!({
            "study": study.resolved(),
            "study_digest": digest.hex(),
            "inputs": digest.inputs,
            "scenarios": echo.scenarios,
            "echo": echo,
            "rotation": study.rotation.as_ref().map(RotationLoad::facts),
            "rows": echo.rows,
        }))?;
    } else {
        output::text(&format!("{} is valid\n\n{echo}", study.path.display()))?;
        if let Some(rotation) = &study.rotation {
            output::text(&rotation.facts())?;
        }
    }
    Ok(ExitStatus::Done)
}
