//! `blisk init`: a commented study file.

use std::path::Path;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::population::table::write_atomically;
use crate::study::STUDY_TEMPLATE;

pub(super) fn command(out: &Path) -> Result<ExitStatus, Failure> {
    if out.exists() {
        return Err(Failure {
            status: ExitStatus::InputOutput,
            message: format!(
                "{} exists already and is not overwritten; choose another --out",
                out.display()
            ),
        });
    }
    write_atomically(out, STUDY_TEMPLATE.as_bytes())?;
    output::text(&format!(
        "wrote {}; next: blisk check {0}, blisk run {0}",
        out.display()
    ));
    Ok(ExitStatus::Done)
}
