//! Signals: the first one has a command store what it has and end, the second ends it at once.
//!
//! Every command is watched. One that stores rows while it solves them gets time to do so; every other is
//! ended where it stands, which costs nothing: a sector bundle gets its header last, any other file appears whole.

use std::io;
use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM};

use super::{ExitStatus, output};
use crate::platform;
use crate::population::table::abandon_unfinished;

/// Time between looks for a signal.
const LOOK: Duration = Duration::from_millis(50);
/// Time that a command has to store what it has.
const PATIENCE: Duration = Duration::from_secs(4);

/// What a command that is ended by a signal leaves, and what to do then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kept {
    /// The rows solved, and what these words say.
    Rows(&'static str),
    /// What these words say.
    Else(&'static str),
}

impl Kept {
    fn words(self) -> &'static str {
        match self {
            Self::Rows(words) | Self::Else(words) => words,
        }
    }
}

/// The signals that ask a command to end.
#[derive(Debug)]
pub(super) struct Signals {
    /// The signal that came; 0 if none did.
    came: Arc<AtomicUsize>,
    kept: Kept,
    /// Whether rows are in work that the command stores before it ends.
    storing: AtomicBool,
}

/// Set up once in a process.
static SIGNALS: OnceLock<Signals> = OnceLock::new();

/// Watches for signals while a command is carried out that leaves `kept`; those that whoever started the process has it
/// ignore stay ignored.
///
/// A command that does not end in time after a signal is ended: what is stored is complete at any instant.
pub(super) fn watch(kept: Kept) -> io::Result<()> {
    let came = Arc::new(AtomicUsize::new(0));
    let signals = Signals {
        came: Arc::clone(&came),
        kept,
        storing: AtomicBool::new(false),
    };
    if SIGNALS.set(signals).is_err() {
        return Ok(());
    }
    let second = Arc::new(AtomicBool::new(false));
    for signal in asking() {
        if platform::ignores_signal(signal) {
            continue;
        }
        let code = status_of(signal) as i32;
        signal_hook::flag::register_conditional_shutdown(signal, code, Arc::clone(&second))?;
        signal_hook::flag::register(signal, Arc::clone(&second))?;
        signal_hook::flag::register_usize(signal, Arc::clone(&came), signal as usize)?;
    }
    if let Some(signals) = signals_of_process() {
        std::thread::spawn(|| end_in_time(signals));
    }
    Ok(())
}

/// The signals of this process, if they are watched.
pub(super) fn signals_of_process() -> Option<&'static Signals> {
    SIGNALS.get()
}

/// How a command ends that would end with `status`: one that was interrupted, by the signal that came.
pub(super) fn ended(status: ExitStatus) -> ExitStatus {
    match status {
        ExitStatus::Interrupted => signals_of_process()
            .and_then(Signals::came)
            .unwrap_or(status),
        status => status,
    }
}

#[cfg(unix)]
fn asking() -> Vec<i32> {
    use signal_hook::consts::{SIGHUP, SIGUSR1};
    vec![SIGINT, SIGTERM, SIGHUP, SIGUSR1]
}

#[cfg(not(unix))]
fn asking() -> Vec<i32> {
    vec![SIGINT, SIGTERM]
}

fn status_of(signal: i32) -> ExitStatus {
    if signal == SIGINT {
        ExitStatus::Interrupted
    } else {
        ExitStatus::Terminated
    }
}

fn end_in_time(signals: &Signals) {
    let status = loop {
        if let Some(status) = signals.came() {
            break status;
        }
        std::thread::sleep(LOOK);
    };
    if signals.storing.load(Ordering::Relaxed) {
        output::message(&"stopping: what is solved is being stored (once more: stop at once)");
        let since = Instant::now();
        while since.elapsed() < PATIENCE {
            std::thread::sleep(LOOK);
        }
    }
    signals.leave(status);
}

impl Signals {
    /// How the process ends after the signal that came; none if none did.
    pub(super) fn came(&self) -> Option<ExitStatus> {
        match self.came.load(Ordering::Relaxed) {
            0 => None,
            signal => Some(status_of(signal as i32)),
        }
    }

    /// Whether the command stores rows from now on, so that a signal gives it time to do so.
    pub(super) fn set_storing(&self, storing: bool) {
        let storing = storing && matches!(self.kept, Kept::Rows(_));
        self.storing.store(storing, Ordering::Relaxed);
    }

    /// Ends the process if a signal has come.
    pub(super) fn leave_if_asked(&self) {
        if let Some(status) = self.came() {
            self.leave(status);
        }
    }

    /// Ends the process.
    fn leave(&self, status: ExitStatus) -> ! {
        abandon_unfinished();
        output::message(&format!("interrupted: {}", self.kept.words()));
        std::process::exit(status as i32)
    }
}
