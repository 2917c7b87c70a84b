//! `blisk model`: the reduced model of a study, and the export of its sector as a bundle.

use std::path::PathBuf;

use clap::Args;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::model::sector::bundle;
use crate::settings::{EngineSource, ReducedEngineSource};
use crate::study::{PipelineError, RotationLoad, Study, load_sector_model};

/// Arguments of `blisk model`.
#[derive(Debug, Args)]
pub struct ModelArguments {
    /// The study file.
    study: PathBuf,
    /// Write the sector model as a bundle into this folder.
    #[arg(long, value_name = "DIR")]
    pub(super) export: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn command(arguments: &ModelArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    let model = load_sector_model(&study)?;
    if let Some(folder) = &arguments.export {
        bundle::write(&model, folder).map_err(PipelineError::from)?;
        output::message(&format!("wrote the sector bundle {}", folder.display()));
        let shares = model
            .contact_pairs
            .iter()
            .any(|pair| pair.load_weight.is_some());
        if shares {
            output::message(
                &"the bundle has no shares of the normal load: a study of it shares the load by weight, unless it has \
                 contact.normal_load.share = \"equilibrium\" itself",
            );
        }
        if !model.load_case_forces.is_empty() {
            output::message(
                &"the bundle has the force vector of the model, not those of load cases",
            );
        }
    }
    let engine = ReducedEngineSource.build(&study, &model, None)?;
    let mut report = engine.model_report();
    report.rotation = study.rotation.as_ref().map(RotationLoad::facts);
    output::result(arguments.json, &report)?;
    Ok(ExitStatus::Done)
}
