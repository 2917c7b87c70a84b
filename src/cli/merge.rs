//! `blisk merge`: shards joined to the results of their study.

use std::path::{Path, PathBuf};

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::merge;

pub(super) fn command(
    shards: &[PathBuf],
    out: &Path,
    study: Option<&Path>,
    json: bool,
) -> Result<ExitStatus, Failure> {
    let outcome = merge(shards, out, study)?;
    output::message(&format!(
        "merged {} rows; results in {}",
        outcome.rows_reused,
        out.display()
    ));
    output::result(json, &outcome.summary);
    Ok(super::stats::status_of(&outcome.summary))
}
