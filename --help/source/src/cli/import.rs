//! `blisk import`: a sector bundle from the files of a finite-element code.

use std::fmt::{self, Write as _};
use std::fs;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use serde::Serialize;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::model::cyclic::contact_free_frequencies_hz;
use crate::model::sector::import::{
    IMPORT_TEMPLATES, ImportReport, calculix_equations, foreign, import,
};
use crate::model::sector::{Body, ModelError, bundle};
use crate::study::PipelineError;

/// Arguments of the command.
#[derive(Debug, Args)]
pub struct ImportArguments {
    /// The import file: which meshes, matrices and sets make up the wheel.
    #[arg(required_unless_present = "template")]
    pub file: Option<PathBuf>,
    /// The folder of the bundle to write.
    #[arg(long, value_name = "DIR", required_unless_present_any = ["equations", "template"])]
    pub out: Option<PathBuf>,
    /// Compute so many contact-free natural frequencies per nodal diameter as well, and write them to
    /// DIR/frequencies.csv.
    #[arg(long, value_name = "N", requires = "out", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub frequencies: Option<u16>,
    /// Print equations for `CalculiX` that tie the cyclic faces of a body in a static step, and write
    /// no bundle.
    #[arg(long, value_name = "BODY", conflicts_with = "out")]
    pub equations: Option<BodyArgument>,
    /// Print a commented import file for the files of a code, and write no bundle.
    #[arg(
        long,
        value_name = "CODE",
        conflicts_with_all = ["file", "out", "equations", "json"],
        value_parser = PossibleValuesParser::new(IMPORT_TEMPLATES.map(|(name, _)| name))
    )]
    pub template: Option<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// A body of the wheel.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum BodyArgument {
    /// Disk and blade.
    Blisk,
    /// Ring damper.
    Ring,
}

/// What was imported.
#[derive(Debug, Serialize)]
pub struct ImportAnswer {
    /// What was found.
    #[serde(flatten)]
    pub report: ImportReport,
    /// Contact-free natural frequencies, Hz, by nodal diameter; negative where the eigenvalue is.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frequencies_hz: Vec<Vec<f64>>,
}

impl fmt::Display for ImportAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.report)?;
        if !self.frequencies_hz.is_empty() {
            write!(f, "\n\ncontact-free frequencies, Hz, by nodal diameter")?;
        }
        for (h, frequencies) in self.frequencies_hz.iter().enumerate() {
            let shown: Vec<String> = frequencies.iter().map(|hz| format!("{hz:.2}")).collect();
            write!(f, "\n{h:>4}  {}", shown.join(" "))?;
        }
        Ok(())
    }
}

pub(super) fn command(arguments: &ImportArguments) -> Result<ExitStatus, Failure> {
    if let Some(code) = &arguments.template {
        let chosen = IMPORT_TEMPLATES.iter().find(|(name, _)| name == code);
        output::text(&chosen.map_or("", |(_, text)| text))?;
        return Ok(ExitStatus::Done);
    }
    let Some(file) = &arguments.file else {
        return Err(Failure::usage("FILE is missing".to_owned()));
    };
    if let Some(advice) = foreign(file) {
        return Err(Failure::usage(advice));
    }
    if let Some(body) = arguments.equations {
        let body = match body {
            BodyArgument::Blisk => Body::Blisk,
            BodyArgument::Ring => Body::Ring,
        };
        let equations = calculix_equations(file, body).map_err(PipelineError::from)?;
        output::text(&equations)?;
        return Ok(ExitStatus::Done);
    }
    let Some(out) = &arguments.out else {
        return Err(Failure::usage("--out DIR is missing".to_owned()));
    };
    let answer = import_bundle(file, out, arguments.frequencies)?;
    output::message(&format!("wrote the sector bundle {}", out.display()));
    output::result(arguments.json, &answer)?;
    Ok(ExitStatus::Done)
}

/// Makes the sector bundle `out` from an import file; computes so many frequencies per nodal diameter, where that is
/// asked for, and writes them to `frequencies.csv` there.
///
/// # Errors
/// The import file or what it names is not accepted, or the bundle cannot be written.
pub fn import_bundle(
    file: &Path,
    out: &Path,
    frequencies: Option<u16>,
) -> Result<ImportAnswer, PipelineError> {
    let imported = import(file)?;
    bundle::write(&imported.model, out)?;
    let mut frequencies_hz = Vec::new();
    if let Some(count) = frequencies {
        frequencies_hz = contact_free_frequencies_hz(&imported.model, usize::from(count))?;
        let path = out.join("frequencies.csv");
        fs::write(&path, csv(&frequencies_hz))
            .map_err(|source| ModelError::File { path, source })?;
    }
    Ok(ImportAnswer {
        report: imported.report,
        frequencies_hz,
    })
}

fn csv(frequencies_hz: &[Vec<f64>]) -> String {
    let mut text = "nodal_diameter,mode,frequency_hz\n".to_owned();
    for (h, frequencies) in frequencies_hz.iter().enumerate() {
        for (index, hz) in frequencies.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{h},{},{hz:.9e}", index + 1);
        }
    }
    text
}
