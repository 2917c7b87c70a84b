//! `blisk import`: a sector bundle from the files of a finite-element code.

use std::fmt::{self, Write as _};
use std::fs;
use std::path::PathBuf;

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
struct Outcome {
    #[serde(flatten)]
    report: ImportReport,
    /// Contact-free natural frequencies, Hz, by nodal diameter; negative where the eigenvalue is.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    frequencies_hz: Vec<Vec<f64>>,
}

impl fmt::Display for Outcome {
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
    let imported = import(file).map_err(PipelineError::from)?;
    bundle::write(&imported.model, out).map_err(PipelineError::from)?;
    let mut frequencies_hz = Vec::new();
    if let Some(count) = arguments.frequencies {
        frequencies_hz = contact_free_frequencies_hz(&imported.model, usize::from(count))
            .map_err(PipelineError::from)?;
        let path = out.join("frequencies.csv");
        fs::write(&path, csv(&frequencies_hz))
            .map_err(|source| PipelineError::from(ModelError::File { path, source }))?;
    }
    output::message(&format!("wrote the sector bundle {}", out.display()));
    let outcome = Outcome {
        report: imported.report,
        frequencies_hz,
    };
    output::result(arguments.json, &outcome)?;
    Ok(ExitStatus::Done)
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
