//! `blisk check`: everything about a study that can be wrong before a solve.

use std::fmt;
use std::path::PathBuf;

use clap::Args;
use serde::{Serialize, Serializer};
use serde_json::json;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::report::StudyEcho;
use crate::study::{
    PipelineError, RotationLoad, Study, StudyDigest, echo, load_sector_model, pattern_source,
};

/// Arguments of `blisk check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The study file.
    study: PathBuf,
    /// Print the resolved study as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn command(arguments: &CheckArguments) -> Result<ExitStatus, Failure> {
    let study = Study::read(&arguments.study)?;
    output::result(arguments.json, &CheckAnswer::of(&study)?)?;
    Ok(ExitStatus::Done)
}

/// A valid study, as the command tells it.
#[derive(Debug)]
pub struct CheckAnswer<'a> {
    study: &'a Study,
    digest: StudyDigest,
    echo: StudyEcho,
}

impl<'a> CheckAnswer<'a> {
    /// Looks at the model and the patterns of the study, and solves nothing.
    ///
    /// # Errors
    /// The model or the patterns are invalid, or a file cannot be read.
    pub fn of(study: &'a Study) -> Result<Self, PipelineError> {
        let model = load_sector_model(study)?;
        pattern_source(study, &model)?;
        Ok(Self {
            study,
            digest: StudyDigest::of(study)?,
            echo: echo(study, &model),
        })
    }
}

impl Serialize for CheckAnswer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        json!({
            "study": self.study.resolved(),
            "study_digest": self.digest.hex(),
            "inputs": self.digest.inputs,
            "scenarios": self.echo.scenarios,
            "echo": self.echo,
            "rotation": self.study.rotation.as_ref().map(RotationLoad::facts),
            "rows": self.echo.rows,
        })
        .serialize(serializer)
    }
}

impl fmt::Display for CheckAnswer<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let echo = self.echo.to_string();
        let path = self.study.path.display();
        write!(f, "{path} is valid\n\n{}", echo.trim_end())?;
        match &self.study.rotation {
            Some(rotation) => write!(f, "\n{}", rotation.facts()),
            None => Ok(()),
        }
    }
}
