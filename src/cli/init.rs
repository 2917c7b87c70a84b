//! `blisk init`: a commented study file.

use std::fmt;
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
    output::text(&write_example(&arguments.example, &arguments.out)?)?;
    Ok(ExitStatus::Done)
}

/// A study file that was written.
#[derive(Debug)]
pub struct WrittenStudy {
    /// The file.
    pub path: PathBuf,
    /// How many files that it reads were written beside it.
    pub files_beside: usize,
}

impl fmt::Display for WrittenStudy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let beside = match self.files_beside {
            0 => String::new(),
            1 => ", and beside it a file that it reads".to_owned(),
            files => format!(", and beside it {files} files that it reads"),
        };
        let path = self.path.display();
        write!(
            f,
            "wrote {path}{beside}; next: blisk check {path}, blisk run {path}"
        )
    }
}

/// Writes the study `name` of those that come with the program to the file `out`, and what it reads beside that.
///
/// # Errors
/// There is no such study, a file exists already, or one cannot be written.
pub fn write_example(name: &str, out: &Path) -> Result<WrittenStudy, Failure> {
    let Some((_, example)) = EXAMPLES.iter().find(|(known, _)| *known == name) else {
        let names = EXAMPLES.map(|(known, _)| known).join(", ");
        return Err(Failure::usage(format!(
            "example = {name} is not accepted; accepted: {names}"
        )));
    };
    let (text, data) = example_beside_its_data(example);
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
    written.push((out.to_owned(), &text));
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
    Ok(WrittenStudy {
        files_beside: written.len() - 1,
        path: out.to_owned(),
    })
}
