//! `blisk verify`: delivered rows solved again, a random sample or one of them.

use std::fmt::{self, Display};
use std::path::{Path, PathBuf};

use clap::Args;
use serde::{Serialize, Serializer};
use serde_json::json;

use super::exit::Failure;
use super::fidelity::FidelityArguments;
use super::progress::RunProgress;
use super::replay::{solved_again, warn_of_other_build};
use super::scheduler::threads;
use super::{ExitStatus, output};
use crate::campaign::{
    FileState, Integrity, Repair, StoredStudy, TimeDomainRequest, VerifyRequest, audit_peaks,
    integrity, repair, verify, verify_in_time,
};
use crate::identity;
use crate::settings::ReducedEngineSource;
use crate::study::{PipelineError, Study};

/// Arguments of `blisk verify`.
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub struct VerifyArguments {
    /// The study file of results/NAME, or a results folder.
    #[arg(value_name = "STUDY|DIR")]
    target: PathBuf,
    /// Number of rows to draw.
    #[arg(long, value_name = "N", default_value = "10", value_parser = clap::value_parser!(u32).range(1..))]
    sample: u32,
    /// Seed of the sample [default: that of the study].
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Sweep the drawn rows densely instead, and count the peaks that the search missed.
    ///
    /// Writes `peak_audit.parquet` into the results folder.
    #[arg(long)]
    dense_sweep: bool,
    /// Integrate one row in time instead, and compare it with harmonic balance.
    ///
    /// The row of --scenario and --pattern at its peak frequency, or the first one of the
    /// sample under friction. Writes no table.
    #[arg(long, conflicts_with = "dense_sweep")]
    time_domain: bool,
    /// Scenario of one row, counted from 0: it is solved again and compared bit for bit, in the place of a sample.
    #[arg(
        long,
        value_name = "I",
        requires = "pattern",
        conflicts_with = "dense_sweep"
    )]
    scenario: Option<usize>,
    /// Id of the pattern of that row.
    #[arg(long, value_name = "ID", requires = "scenario")]
    pattern: Option<u32>,
    /// What that row is compared with besides.
    #[command(flatten)]
    fidelity: FidelityArguments,
    /// Set damaged files aside, into `damaged/`, and solve again what they held; draws no rows.
    #[arg(long, conflicts_with_all = ["dense_sweep", "time_domain", "scenario"])]
    pub(super) repair: bool,
    /// Read all files and compare them with their checksums; draws no rows and changes nothing.
    #[arg(long, conflicts_with_all = ["dense_sweep", "time_domain", "scenario", "repair"])]
    integrity: bool,
    /// Where the inputs lie now: beside this study file [default: that of the last run].
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
    /// Number of threads [default: those of the scheduler's allocation, else all cores]; results
    /// do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What is asked of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    /// Is the peak the same on the full-contact model?
    FullModel,
    /// Is this row, by scenario and pattern, the same bit for bit?
    OneRow(usize, u32),
    /// A higher peak elsewhere?
    DenseSweep,
    /// Is the motion the same in time? Of one row, by scenario and pattern, or the first of the
    /// sample.
    TimeDomain(Option<(usize, u32)>),
    /// None: are the files as they were written? Damaged ones are set aside and solved again.
    Files,
    /// None: are the files as they were written? Nothing is changed.
    Integrity,
}

impl VerifyArguments {
    fn question(&self) -> Question {
        if self.repair {
            Question::Files
        } else if self.integrity {
            Question::Integrity
        } else if self.dense_sweep {
            Question::DenseSweep
        } else if self.time_domain {
            Question::TimeDomain(self.scenario.zip(self.pattern))
        } else if let Some((scenario, pattern)) = self.scenario.zip(self.pattern) {
            Question::OneRow(scenario, pattern)
        } else {
            Question::FullModel
        }
    }
}

pub(super) fn command(arguments: &VerifyArguments) -> Result<ExitStatus, Failure> {
    let question = arguments.question();
    if !matches!(question, Question::OneRow(..)) && arguments.fidelity.is_stated() {
        return Err(Failure::usage(
            "--fidelity, --harmonics and --samples are of one row; accepted: with --scenario and --pattern, without --time-domain"
                .to_owned(),
        ));
    }
    let stored = || stored(&arguments.target, arguments.study.as_deref());
    let request = VerifyRequest {
        sample: arguments.sample as usize,
        seed: arguments.seed,
        threads: threads(arguments.threads),
    };
    let progress = RunProgress::new();
    match question {
        Question::OneRow(scenario, pattern) => {
            arguments.fidelity.check_for_one_row()?;
            let row = (scenario, pattern);
            solved_again(&stored()?, row, &arguments.fidelity, arguments.json)
        }
        Question::FullModel => {
            let stored = stored()?;
            let report = verify(&stored, &ReducedEngineSource, request, &progress);
            progress.finish();
            let report = report?;
            name_table(&stored, "verification.parquet");
            finish(arguments, &report, report.verified)
        }
        Question::DenseSweep => {
            let stored = stored()?;
            let report = audit_peaks(&stored, &ReducedEngineSource, request, &progress);
            progress.finish();
            let report = report?;
            name_table(&stored, "peak_audit.parquet");
            finish(arguments, &report, report.verified)
        }
        Question::TimeDomain(row) => {
            let request = TimeDomainRequest {
                row,
                sample: request,
            };
            let report = verify_in_time(&stored()?, &ReducedEngineSource, request, &progress);
            progress.finish();
            let report = report?;
            finish(arguments, &report, report.verified)
        }
        Question::Files => repaired(arguments),
        Question::Integrity => looked_at(arguments),
    }
}

/// Reads all files and changes none.
fn looked_at(arguments: &VerifyArguments) -> Result<ExitStatus, Failure> {
    let results = if arguments.target.is_dir() {
        arguments.target.clone()
    } else {
        Path::new("results").join(Study::read(&arguments.target)?.name)
    };
    let answer = IntegrityAnswer(integrity(&results)?);
    if arguments.json {
        output::json_only(&answer)?;
    } else {
        output::text(&answer)?;
    }
    Ok(if answer.0.is_whole() {
        ExitStatus::Done
    } else {
        ExitStatus::StoreDamaged
    })
}

/// What the files of a folder are found to be, as the command tells it.
#[derive(Debug)]
pub struct IntegrityAnswer(pub Integrity);

impl Serialize for IntegrityAnswer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        json!({ "whole": self.0.is_whole(), "integrity": self.0 }).serialize(serializer)
    }
}

impl Display for IntegrityAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&of_files(&self.0).join("\n"))
    }
}

/// What the files of a folder are found to be: a line for each that is not whole, and the numbers.
fn of_files(found: &Integrity) -> Vec<String> {
    let name = |state: FileState| match state {
        FileState::Whole => "whole",
        FileState::Damaged => "damaged",
        FileState::Missing => "missing",
        FileState::Unverified => "unverified",
        FileState::Foreign => "foreign",
    };
    let others = found
        .files
        .iter()
        .filter(|file| file.state != FileState::Whole);
    let mut lines: Vec<String> = others
        .map(|file| {
            format!(
                "{:<10}  {}: {}",
                name(file.state),
                file.file.display(),
                file.reason
            )
        })
        .collect();
    let build = found.build.as_deref().map_or("not known", identity::named);
    lines.push(format!("{}: build {build}", found.folder.display()));
    let states = [
        FileState::Whole,
        FileState::Damaged,
        FileState::Missing,
        FileState::Unverified,
        FileState::Foreign,
    ];
    let counts = states.map(|state| {
        let count = found
            .files
            .iter()
            .filter(|file| file.state == state)
            .count();
        format!("{count} {}", name(state))
    });
    lines.push(format!("files: {}", counts.join(", ")));
    lines
}

/// Sets damaged files aside and solves again what they held.
fn repaired(arguments: &VerifyArguments) -> Result<ExitStatus, Failure> {
    let (results, study) = if arguments.target.is_dir() {
        (arguments.target.clone(), arguments.study.clone())
    } else {
        let name = Study::read(&arguments.target)?.name;
        let file = Some(arguments.target.clone());
        (Path::new("results").join(name), file)
    };
    let progress = RunProgress::new();
    let repaired = repair(
        &results,
        study.as_deref(),
        threads(arguments.threads),
        &ReducedEngineSource,
        &progress,
    );
    progress.finish();
    let repaired = match repaired {
        Err(PipelineError::Interrupted {
            folder,
            stored,
            planned,
        }) => {
            // What was set aside is forgotten by a second repair, and known to a run.
            return Err(Failure {
                status: ExitStatus::Interrupted,
                message: format!(
                    "interrupted: {stored} of {planned} rows are stored in {}; `blisk run` continues",
                    folder.display()
                ),
            });
        }
        other => other?,
    };
    let answer = RepairAnswer { results, repaired };
    output::result(arguments.json, &answer)?;
    Ok(if answer.repaired.different.is_empty() {
        ExitStatus::Done
    } else {
        ExitStatus::VerificationFailed
    })
}

/// What a repair came to, as the command tells it.
#[derive(Debug)]
pub struct RepairAnswer {
    /// The results folder.
    pub results: PathBuf,
    /// What was done.
    pub repaired: Repair,
}

impl Serialize for RepairAnswer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let repaired = &self.repaired;
        let set_aside = { repaired.set_aside.iter() }
            .map(|(from, to)| json!({ "file": from, "now": to }))
            .collect::<Vec<_>>();
        json!({
            "set_aside": set_aside,
            "missing": repaired.missing,
            "rows_solved": repaired.outcome.as_ref().map(|outcome| outcome.rows_solved),
            "rows_reused": repaired.outcome.as_ref().map(|outcome| outcome.rows_reused),
            "different": repaired.different,
        })
        .serialize(serializer)
    }
}

impl Display for RepairAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&in_words(&self.repaired, &self.results).join("\n"))
    }
}

/// What a repair came to, a line each.
fn in_words(repaired: &Repair, results: &Path) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for (from, to) in &repaired.set_aside {
        lines.push(format!(
            "{} was damaged; it is now {}",
            from.display(),
            to.display()
        ));
    }
    for path in &repaired.missing {
        lines.push(format!("{} was missing", path.display()));
    }
    lines.push(match &repaired.outcome {
        None if lines.is_empty() => format!("{}: no file is damaged", results.display()),
        None => "`blisk run` solves the rows that are missing; a table of another command is written by that again".to_owned(),
        Some(outcome) if repaired.different.is_empty() => format!(
            "solved {} rows again, reused {}; every table is the same bytes as before",
            outcome.rows_solved, outcome.rows_reused
        ),
        Some(outcome) => format!(
            "solved {} rows again, reused {}; NOT the same as before: {}",
            outcome.rows_solved,
            outcome.rows_reused,
            repaired.different.join(", ")
        ),
    });
    lines
}

/// Names the table that was written.
fn name_table(stored: &StoredStudy, table: &str) {
    output::message(&format!("wrote {}", stored.folder.join(table).display()));
}

/// Prints the report and says how the command ends.
fn finish(
    arguments: &VerifyArguments,
    report: &(impl Serialize + Display),
    verified: bool,
) -> Result<ExitStatus, Failure> {
    output::result(arguments.json, report)?;
    Ok(if verified {
        ExitStatus::Done
    } else {
        ExitStatus::VerificationFailed
    })
}

/// The results that `target`, a study file or a results folder, stands for.
fn stored(target: &Path, study: Option<&Path>) -> Result<StoredStudy, Failure> {
    let stored = if target.is_dir() {
        StoredStudy::open(target, study)?
    } else {
        let results = Path::new("results").join(Study::read(target)?.name);
        StoredStudy::of_study(target, &results)?
    };
    warn_of_other_build(&stored);
    Ok(stored)
}
