//! How a command ends: exit codes, the same for every command, and what a failed one says.

use std::io::{self, ErrorKind};
use std::process::ExitCode;

use crate::model::sector::ModelError;
use crate::population::table::PatternParquetError;
use crate::population::table::TableError;
use crate::response::mistuning::PatternFileError;
use crate::study::{PipelineError, StudyError};

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExitStatus {
    /// Done.
    Done = 0,
    /// A defect of the program.
    InternalError = 1,
    /// Wrong use of the command line.
    Usage = 2,
    /// The study is invalid.
    StudyInvalid = 3,
    /// The model or a matrix is invalid.
    ModelInvalid = 4,
    /// Failures leave a wanted statistic without a value.
    FailureGate = 5,
    /// All patterns are solved, and an interval is wider than the study asks for.
    TargetUnmet = 6,
    /// A file or folder cannot be read or written.
    InputOutput = 7,
    /// Stored results are damaged.
    StoreDamaged = 8,
    /// The folder holds a different study.
    DifferentStudy = 9,
    /// The folder is in use by another process.
    Locked = 10,
    /// A comparison or verification failed.
    VerificationFailed = 11,
    /// Interrupted from the keyboard; what was solved is stored.
    Interrupted = 130,
    /// Asked to end by the system or a scheduler; what was solved is stored.
    Terminated = 143,
}

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> Self {
        Self::from(status as u8)
    }
}

impl From<&PipelineError> for ExitStatus {
    fn from(error: &PipelineError) -> Self {
        match error {
            PipelineError::Study(error) => error.into(),
            PipelineError::Model(ModelError::File { .. }) | PipelineError::NoResults { .. } => {
                Self::InputOutput
            }
            PipelineError::Model(_) => Self::ModelInvalid,
            PipelineError::Cache(_) => Self::InputOutput,
            PipelineError::Harmonics(_) => Self::StudyInvalid,
            PipelineError::Table(error) => error.into(),
            PipelineError::DifferentStudy { .. }
            | PipelineError::DifferentBuild { .. }
            | PipelineError::DifferentShards { .. }
            | PipelineError::InputsChanged { .. } => Self::DifferentStudy,
            PipelineError::Interrupted { .. } | PipelineError::Stopped { .. } => Self::Interrupted,
            PipelineError::Locked { .. } => Self::Locked,
            PipelineError::Unfinished { .. }
            | PipelineError::Shards { .. }
            | PipelineError::NoPattern { .. }
            | PipelineError::NoRow { .. }
            | PipelineError::NoScenario { .. }
            | PipelineError::NoOptimum { .. }
            | PipelineError::NoEstimate { .. }
            | PipelineError::NoCampbell { .. }
            | PipelineError::NoTradeoff { .. }
            | PipelineError::NoTimeDomain { .. }
            | PipelineError::NoContact { .. } => Self::Usage,
            PipelineError::Threads { .. } => Self::InternalError,
        }
    }
}

impl From<&StudyError> for ExitStatus {
    fn from(error: &StudyError) -> Self {
        match error {
            StudyError::Unreadable { .. }
            | StudyError::Input { .. }
            | StudyError::Patterns(PatternFileError::Unreadable { .. })
            | StudyError::PatternTable(PatternParquetError::Table(TableError::Io { .. })) => {
                Self::InputOutput
            }
            StudyError::Model(error) if matches!(**error, ModelError::File { .. }) => {
                Self::InputOutput
            }
            StudyError::Model(_) => Self::ModelInvalid,
            StudyError::Invalid { .. } | StudyError::Patterns(_) | StudyError::PatternTable(_) => {
                Self::StudyInvalid
            }
        }
    }
}

impl From<&TableError> for ExitStatus {
    fn from(error: &TableError) -> Self {
        match error {
            TableError::Io { .. } | TableError::Encoding { .. } | TableError::NoParquet { .. } => {
                Self::InputOutput
            }
            TableError::Damaged { .. } => Self::StoreDamaged,
        }
    }
}

/// A command that failed: what to say and how to exit.
#[derive(Debug)]
pub struct Failure {
    /// How the command ends.
    pub status: ExitStatus,
    /// What it says.
    pub message: String,
}

impl Failure {
    /// The program panicked; its hook has said where.
    #[must_use]
    pub fn of_panic() -> Self {
        Self {
            status: ExitStatus::InternalError,
            message: "the program is at fault, not the study: please report the lines above with the study".to_owned(),
        }
    }

    pub(super) fn usage(message: String) -> Self {
        Self {
            status: ExitStatus::Usage,
            message,
        }
    }
}

impl<E> From<E> for Failure
where
    E: std::error::Error + 'static,
    for<'a> ExitStatus: From<&'a E>,
{
    fn from(error: E) -> Self {
        let status = ExitStatus::from(&error);
        let remedy = match status {
            ExitStatus::InputOutput => remedy(&error),
            _ => "",
        };
        Self {
            status,
            message: format!("{error}{remedy}"),
        }
    }
}

/// What can be done about an error of the file system, as the end of a sentence.
fn remedy(error: &(dyn std::error::Error + 'static)) -> &'static str {
    let mut cause = Some(error);
    let kind = loop {
        match cause {
            None => return "",
            Some(error) => {
                if let Some(error) = error.downcast_ref::<io::Error>() {
                    break error.kind();
                }
                cause = error.source();
            }
        }
    };
    match kind {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "; free some space, or choose another --out, and run again: what is stored stays stored"
        }
        ErrorKind::PermissionDenied => {
            "; grant this user access to it, or choose another --out, and run again"
        }
        ErrorKind::ReadOnlyFilesystem => {
            "; make the file system writable, or choose another --out, and run again"
        }
        ErrorKind::NotFound
        | ErrorKind::NotADirectory
        | ErrorKind::IsADirectory
        | ErrorKind::AlreadyExists => "; check the path",
        _ => "; check the disk and run again: what is stored stays stored",
    }
}
