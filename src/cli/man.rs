//! `blisk man`: the manual pages of the program and of every command.

use std::path::PathBuf;

use clap::Args;
use clap_mangen::Man;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::population::table::write_atomically;

/// Arguments of `blisk man`.
#[derive(Debug, Args)]
pub struct ManArguments {
    /// The folder for the pages, made if it is not there; `man` looks in `man1` below each part of its path.
    #[arg(long, value_name = "DIR", default_value = "man/man1")]
    out: PathBuf,
}

pub(super) fn command(
    arguments: &ManArguments,
    program: clap::Command,
) -> Result<ExitStatus, Failure> {
    let out = &arguments.out;
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let commands = program.get_subcommands().filter(|page| !page.is_hide_set());
    let commands = commands.cloned();
    let pages: Vec<_> = std::iter::once(program.clone()).chain(commands).collect();
    for page in &pages {
        // A page is of a version, not of a build.
        let page = page.clone().long_version(None);
        let page = Man::new(page).source(concat!("blisk ", env!("CARGO_PKG_VERSION")));
        let mut text = Vec::new();
        // Writing to memory cannot fail.
        let _ = page.render(&mut text);
        write_atomically(&out.join(page.get_filename()), &text)?;
    }
    output::text(&format!(
        "wrote {} pages to {}; next: man {}",
        pages.len(),
        out.display(),
        out.join("blisk.1").display()
    ))?;
    Ok(ExitStatus::Done)
}
