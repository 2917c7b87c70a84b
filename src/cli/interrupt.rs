//! Signals: the first one has a run store what it has and end, the second ends it at once.

use std::io;
use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM};

use super::{ExitStatus, output};
use crate::platform;

/// Time between looks for a signal.
const LOOK: Duration = Duration::from_millis(50);
/// Time that a run has to store what it has.
const PATIENCE: Duration = Duration::from_millis(4500);

/// The signals that ask a run to end.
#[derive(Debug)]
pub(super) struct Signals {
    /// The signal that came; 0 if none did.
    came: Arc<AtomicUsize>,
}

/// Set up once in a process.
static SIGNALS: OnceLock<Signals> = OnceLock::new();

/// Watches for signals from now on; those that whoever started the process has it ignore stay
/// ignored.
///
/// A run that does not end in time after a signal, because it is not yet or no longer at its rows, is
/// ended: what is stored is complete at any instant.
pub(super) fn watch() -> io::Result<&'static Signals> {
    if let Some(signals) = SIGNALS.get() {
        return Ok(signals);
    }
    let came = Arc::new(AtomicUsize::new(0));
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
    let signals = SIGNALS.get_or_init(|| Signals { came });
    std::thread::spawn(|| end_in_time(signals));
    Ok(signals)
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
    output::message(&"stopping: what is solved is being stored (once more: stop at once)");
    let since = Instant::now();
    while since.elapsed() < PATIENCE {
        std::thread::sleep(LOOK);
    }
    leave(status);
}

/// Ends the process.
#[expect(clippy::exit, reason = "rows in work are given up")]
fn leave(status: ExitStatus) -> ! {
    output::message(&"interrupted; the same command continues");
    std::process::exit(status as i32)
}

impl Signals {
    /// How the process ends after the signal that came; none if none did.
    pub(super) fn came(&self) -> Option<ExitStatus> {
        match self.came.load(Ordering::Relaxed) {
            0 => None,
            signal => Some(status_of(signal as i32)),
        }
    }

    /// Ends the process if a signal has come.
    pub(super) fn leave_if_asked(&self) {
        if let Some(status) = self.came() {
            leave(status);
        }
    }
}
