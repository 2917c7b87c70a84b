//! `blisk init`: a commented study file.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::population::table::write_atomically;
use crate::study::{EXAMPLES, example_beside_its_data};

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
    let example = EXAMPLES.iter().find(|(name, _)| *name == arguments.example);
    let (text, data) = example_beside_its_data(example.map_or("", |(_, text)| text));
    let folder = out.parent().unwrap_or_else(|| Path::new(""));
    let mut written: Vec<(PathBuf, &str)> = Vec::new();
    for (path, text) in data {
        let path = folder.join(path);
        // The same data may be there from another `init`.
        if std::fs::read(&path).is_ok_and(|there| there == text.as_bytes()) {
            continue;
        }
        written.push((path, text));
    }
    written.push((out.clone(), &text));
    if let Some((there, _)) = written.iter().find(|(path, _)| path.exists()) {
        return Err(Failure {
            status: ExitStatus::InputOutput,
            message: format!(
                "{} exists already and is not overwritten; choose another --out",
                there.display()
            ),
        });
    }
    for (path, text) in &written {
        write_atomically(path, text.as_bytes())?;
    }
    let read = match written.len() - 1 {
        0 => String::new(),
        1 => ", and beside it a file that it reads".to_owned(),
        files => format!(", and beside it {files} files that it reads"),
    };
    output::text(&format!(
        "wrote {}{read}; next: blisk check {0}, blisk run {0}",
        out.display()
    ))?;
    Ok(ExitStatus::Done)
}
