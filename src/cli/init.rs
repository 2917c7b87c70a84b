//! `blisk init`: a commented study file.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::population::table::write_atomically;
use crate::study::{EXAMPLES, ModelSource, Study};

/// Arguments of `blisk init`.
#[derive(Debug, Args)]
pub struct InitArguments {
    /// The file; it must not exist yet.
    #[arg(long, value_name = "FILE", default_value = "study.toml")]
    out: PathBuf,
    /// One of the studies that come with the program.
    #[arg(
        long,
        value_name = "NAME",
        default_value = "template",
        value_parser = PossibleValuesParser::new(EXAMPLES.map(|(name, _)| name))
    )]
    example: String,
}

pub(super) fn command(arguments: &InitArguments) -> Result<ExitStatus, Failure> {
    let out = &arguments.out;
    if out.exists() {
        return Err(Failure {
            status: ExitStatus::InputOutput,
            message: format!(
                "{} exists already and is not overwritten; choose another --out",
                out.display()
            ),
        });
    }
    let text = EXAMPLES
        .iter()
        .find(|(name, _)| *name == arguments.example)
        .map_or("", |(_, text)| text);
    write_atomically(out, text.as_bytes())?;
    output::text(&format!(
        "wrote {}; next: blisk check {0}, blisk run {0}",
        out.display()
    ));
    if let Ok(study) = Study::read(out)
        && let ModelSource::Bundle { path, written } = &study.model
        && !path.exists()
    {
        output::message(&format!(
            "it reads the sector bundle {written}, which is not there: put one there or change model.bundle.path"
        ));
    }
    Ok(ExitStatus::Done)
}
