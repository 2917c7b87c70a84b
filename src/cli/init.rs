//! `blisk init`: a commented study file.

use std::path::{Path, PathBuf};

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
    ))?;
    if let Some(missing) = missing_input(out) {
        output::message(&format!(
            "{missing}: this example reads files of the repository; put some there, or change their paths"
        ));
    }
    Ok(ExitStatus::Done)
}

/// What a study reads and is not there.
fn missing_input(file: &Path) -> Option<String> {
    match Study::read(file) {
        Err(error) => Some(error.to_string()),
        Ok(study) => match &study.model {
            ModelSource::Bundle { path, written } if !path.exists() => {
                Some(format!("there is no sector bundle {written}"))
            }
            _ => None,
        },
    }
}
