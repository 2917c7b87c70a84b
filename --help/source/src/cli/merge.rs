//! `blisk merge`: shards joined to the results of their study.

use std::path::PathBuf;

use clap::Args;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::campaign::merge;
use crate::settings::ReducedEngineSource;

/// Arguments of the command.
#[derive(Debug, Args)]
pub struct MergeArguments {
    /// Folders of shards, in any order, or the results folder that they lie in.
    #[arg(required = true, value_name = "DIR")]
    pub shards: Vec<PathBuf>,
    /// The results folder.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Where the inputs lie now: beside this study file [default: that of the last run].
    #[arg(long, value_name = "FILE")]
    pub study: Option<PathBuf>,
    /// Print the summary as JSON.
    #[arg(long)]
    pub json: bool,
}

pub(super) fn command(arguments: &MergeArguments) -> Result<ExitStatus, Failure> {
    let MergeArguments {
        shards,
        out,
        study,
        json,
    } = arguments;
    let outcome = merge(shards, out, study.as_deref(), &ReducedEngineSource)?;
    output::message(&format!(
        "merged {} rows; results in {}",
        outcome.rows_reused,
        out.display()
    ));
    output::result(*json, &outcome.summary)?;
    Ok(super::stats::status_of(&outcome.summary))
}
