//! `blisk slurm`: a script that submits a study to Slurm as an array of shards and a merge after it.

use std::fmt;
use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::campaign::{can_be_cut, is_shard_of};
use crate::population::table::{Shard, write_atomically};
use crate::study::Study;

/// Arguments of the command.
#[derive(Debug, Args)]
pub struct SlurmArguments {
    /// The study file.
    pub study: PathBuf,
    /// Number of shards.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub tasks: u32,
    /// The results folder, on a file system that all nodes see [default: results/NAME].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads of each shard.
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Time limit of each shard, as `sbatch --time` takes it; a shard that reaches it queues again.
    #[arg(long, value_name = "TIME", value_parser = time_limit)]
    pub time: Option<String>,
    /// The script; it must not exist yet [default: NAME-slurm.sh].
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
}

pub(super) fn command(arguments: &SlurmArguments, program: &Path) -> Result<ExitStatus, Failure> {
    output::text(&write_slurm_script(arguments, program)?)?;
    Ok(ExitStatus::Done)
}

/// A script that was written.
#[derive(Debug)]
pub struct WrittenScript {
    /// The script.
    pub path: PathBuf,
    /// Number of shards that it submits.
    pub tasks: u32,
}

impl fmt::Display for WrittenScript {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, tasks } = self;
        let path = path.display();
        write!(
            f,
            "wrote {path}; `bash {path}` submits {tasks} shards and their merge"
        )
    }
}

/// Writes the script that submits a study; `program` is the command `blisk` that its tasks carry out.
///
/// # Errors
/// The study is invalid or cannot be cut into so many shards, a path has control characters, or the script exists
/// already or cannot be written.
pub fn write_slurm_script(
    arguments: &SlurmArguments,
    program: &Path,
) -> Result<WrittenScript, Failure> {
    for (name, path) in [
        ("STUDY", Some(&arguments.study)),
        ("--out", arguments.out.as_ref()),
        ("--script", arguments.script.as_ref()),
    ] {
        refuse_control_characters(name, path)?;
    }
    let study = Study::read(&arguments.study)?;
    can_be_cut(&study)?;
    let last = Shard {
        number: arguments.tasks,
        count: arguments.tasks,
    };
    is_shard_of(&study, last)?;
    let default = || PathBuf::from(format!("{}-slurm.sh", study.name));
    let script = arguments.script.clone().unwrap_or_else(default);
    if script.exists() {
        return Err(Failure {
            status: ExitStatus::InputOutput,
            message: format!(
                "{} exists already; choose another --script, or remove it",
                script.display()
            ),
        });
    }
    let out = arguments.out.clone();
    let results = out.unwrap_or_else(|| Path::new("results").join(&study.name));
    let text = script_of(&Submission {
        name: &study.name,
        tasks: arguments.tasks,
        threads: arguments.threads,
        time: arguments.time.as_deref(),
        program: quoted(program),
        study: quoted(&arguments.study),
        results: quoted(&results),
    });
    write_atomically(&script, text.as_bytes())?;
    Ok(WrittenScript {
        path: script,
        tasks: arguments.tasks,
    })
}

/// A path in the script is one word of one line.
fn refuse_control_characters(name: &str, path: Option<&PathBuf>) -> Result<(), Failure> {
    let absolute = path.map(|path| std::path::absolute(path).unwrap_or_else(|_| path.clone()));
    match absolute {
        Some(path) if path.to_string_lossy().contains(char::is_control) => {
            Err(Failure::usage(format!(
                "{name} {}: accepted: a path without control characters, which a script of the shell takes for ends of lines \
                 or orders",
                path.display()
            )))
        }
        _ => Ok(()),
    }
}

/// A time limit in one of the forms of `sbatch --time`.
///
/// # Errors
/// It has none of them; the message says which ones there are.
pub fn time_limit(text: &str) -> Result<String, String> {
    let number = |part: &str| {
        (1..=9).contains(&part.len()) && part.bytes().all(|byte| byte.is_ascii_digit())
    };
    let (days, clock) = match text.split_once('-') {
        Some((days, clock)) => (Some(days), clock),
        None => (None, text),
    };
    let parts: Vec<&str> = clock.split(':').collect();
    let known =
        days.is_none_or(number) && parts.len() <= 3 && parts.iter().all(|part| number(part));
    let endless = ["UNLIMITED", "INFINITE"].contains(&text.to_ascii_uppercase().as_str());
    if known || endless {
        Ok(text.to_owned())
    } else {
        Err("accepted: MINUTES, MINUTES:SECONDS, HOURS:MINUTES:SECONDS, DAYS-HOURS, DAYS-HOURS:MINUTES, \
             DAYS-HOURS:MINUTES:SECONDS or UNLIMITED, like 12:00:00"
            .to_owned())
    }
}

/// What the script is made from; paths absolute and quoted for the shell.
struct Submission<'a> {
    name: &'a str,
    tasks: u32,
    threads: u16,
    time: Option<&'a str>,
    program: String,
    study: String,
    results: String,
}

/// A path, made absolute, as one word of the shell.
fn quoted(path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    format!("'{}'", absolute.to_string_lossy().replace('\'', r"'\''"))
}

fn script_of(submission: &Submission) -> String {
    let Submission {
        name,
        tasks,
        threads,
        time,
        program,
        study,
        results,
    } = submission;
    let time = time.map_or_else(String::new, |time| format!("#SBATCH --time={time}\n"));
    format!(
        r#"#!/usr/bin/env bash
# Submits the study {name} as {tasks} shards and, when all are finished, their merge.
# Arguments: the shards to solve [1-{tasks}]; those that are not finished are listed by
#   blisk status RESULTS --missing
set -euo pipefail
blisk={program}
study={study}
results={results}
export blisk study results
mkdir -p "$results/slurm"

array=$(sbatch --parsable --array="${{1:-1-{tasks}}}" --output="$results/slurm/shard-%a.log" <<'SHARD'
#!/usr/bin/env bash
#SBATCH --job-name={name}
#SBATCH --cpus-per-task={threads}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@120
{time}
# USR1 comes before the time limit: blisk stores what is solved, and the task queues again.
# TERM may come with scancel or a preemption; after the latter Slurm itself queues the task again.
again=
trap 'again=yes; kill -TERM "$solver" 2>/dev/null' USR1
trap 'kill -TERM "$solver" 2>/dev/null' TERM
"$blisk" run "$study" --out "$results" --shard "$SLURM_ARRAY_TASK_ID/{tasks}" &
solver=$!
# A signal ends a wait before its time.
while kill -0 "$solver" 2>/dev/null; do wait "$solver"; done
wait "$solver"
code=$?
if [ -n "$again" ] && [ "$code" -eq 143 ]; then
    scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
    sleep 60
fi
exit "$code"
SHARD
)

merge=$(sbatch --parsable --dependency="afterok:${{array%%;*}}" --kill-on-invalid-dep=yes \
    --output="$results/slurm/merge.log" <<'MERGE'
#!/usr/bin/env bash
#SBATCH --job-name={name}-merge
#SBATCH --cpus-per-task=1
"$blisk" merge "$results"/shards/*-of-{tasks} --out "$results"
MERGE
)
echo "shards: job ${{array%%;*}}, merge: job ${{merge%%;*}}"
"#
    )
}

#[cfg(test)]
mod tests {
    use super::quoted;
    use std::path::Path;

    #[test]
    fn a_path_is_one_word_of_the_shell_whatever_is_in_it() {
        let path = Path::new("/a b/it's $HOME");
        assert_eq!(quoted(path), r"'/a b/it'\''s $HOME'");
    }
}
