//! `blisk check`: everything about a study that can be wrong before a solve.

use std::path::Path;

use serde_json::json;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::{RotationLoad, Study, StudyDigest, load_sector_model, pattern_source};

pub(super) fn command(study: &Path, json: bool) -> Result<ExitStatus, Failure> {
    let study = Study::read(study)?;
    let model = load_sector_model(&study)?;
    pattern_source(&study, &model)?;
    let digest = StudyDigest::of(&study)?;
    let scenarios = study.scenarios().len();
    if json {
        output::json_only(&json!({
            "study": study.resolved(),
            "study_digest": digest.hex(),
            "inputs": digest.inputs,
            "scenarios": scenarios,
            "rotation": study.rotation.as_ref().map(RotationLoad::facts),
            "rows": scenarios as u64 * u64::from(study.patterns),
        }))?;
    } else {
        output::text(&format!(
            "{} is valid: model {} ({} sectors of {} dofs, {} contact pairs each), \
             {} patterns x {scenarios} scenarios = {} rows",
            study.path.display(),
            model.name,
            model.sectors,
            model.dofs.len(),
            model.contact_pairs.len(),
            study.patterns,
            scenarios as u64 * u64::from(study.patterns),
        ))?;
        if let Some(rotation) = &study.rotation {
            output::text(&rotation.facts())?;
        }
    }
    Ok(ExitStatus::Done)
}
