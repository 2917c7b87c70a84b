//! `blisk status`: how far a results folder is.

use std::fmt::{self, Write};
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::campaign::{FolderStatus, Work, status_of_folder};

/// Arguments of the command.
#[derive(Debug, Args)]
pub struct StatusArguments {
    /// The results folder.
    pub results: PathBuf,
    /// Print only the numbers of the shards that are not finished, as for `sbatch --array=`.
    #[arg(long)]
    pub missing: bool,
    /// Print JSON.
    #[arg(long, conflicts_with = "missing")]
    pub json: bool,
}

pub(super) fn command(arguments: &StatusArguments) -> Result<ExitStatus, Failure> {
    let status = status_of_folder(&arguments.results)?;
    if arguments.missing {
        let numbers: Vec<String> = status.missing_shards.iter().map(u32::to_string).collect();
        output::text(&numbers.join(","))?;
    } else {
        output::result(arguments.json, &StatusAnswer(status))?;
    }
    Ok(ExitStatus::Done)
}

/// How far a results folder is, as the command tells it.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub struct StatusAnswer(pub FolderStatus);

impl fmt::Display for StatusAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&lines(&self.0).join("\n"))
    }
}

fn lines(status: &FolderStatus) -> Vec<String> {
    let absent = absent_shards(status).map_or_else(String::new, |(absent, count)| {
        format!("; {absent} of {count} shards not begun, their rows not counted")
    });
    let mut lines = vec![format!("study {}: {}{absent}", status.name, line(status))];
    for shard in &status.shards {
        let name = shard.shard.as_deref().unwrap_or_default();
        lines.push(format!("  shard {name}: {}", line(shard)));
    }
    if !status.missing_shards.is_empty() {
        let numbers: Vec<String> = status.missing_shards.iter().map(u32::to_string).collect();
        lines.push(format!("  shards not finished: {}", numbers.join(",")));
    }
    lines
}

/// How many shards nobody has begun, and how many there are; none where all are begun, or where the rows are not those
/// of the shards.
fn absent_shards(status: &FolderStatus) -> Option<(usize, usize)> {
    let first = status.shards.first()?.shard.as_deref()?;
    let count: usize = first.split_once('/')?.1.parse().ok()?;
    let absent = count.saturating_sub(status.shards.len());
    (absent > 0 && status.work != Work::Finished).then_some((absent, count))
}

fn line(status: &FolderStatus) -> String {
    let counts: Vec<String> = status
        .rows
        .by_status()
        .into_iter()
        .map(|(status, count)| format!("{count} {status}"))
        .collect();
    let mut line = format!(
        "{}, {} of {} rows",
        match status.work {
            Work::Running => "running",
            Work::Finished => "finished",
            Work::Interrupted => "not running",
        },
        status.rows.planned(),
        status.planned
    );
    // Writing to a String cannot fail.
    if !counts.is_empty() {
        let _ = write!(line, " ({})", counts.join(", "));
    }
    if let Some(rate) = status.rows_per_second {
        let _ = write!(line, ", {rate:.3} rows per second");
    }
    if let Some(left) = status.seconds_left {
        let _ = write!(line, ", about {left:.0} s left");
    }
    match (&status.holder, status.work) {
        (Some(holder), Work::Running) => {
            let _ = write!(line, "; {holder}");
        }
        (Some(holder), _) => {
            let _ = write!(line, "; {holder} was broken off");
        }
        (None, _) => {}
    }
    line
}
