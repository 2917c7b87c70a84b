//! Long work on a thread of its own, while the thread of Python that asked for it watches for signals and tells a
//! listener how far it is.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use blisk::response::harmonic_balance::Status;
use blisk::settings::{Progress, Stage, TimeLeft};
use blisk::study::PipelineError;
use pyo3::prelude::*;

use crate::errors::{of_panic, of_pipeline};

/// Time between looks for a signal, and between two reports of progress.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of the thread that works, bytes: that of the main thread of a program.
const STACK: usize = 8 << 20;

/// The stages by name, in their order.
const STAGES: [(Stage, &str); 6] = [
    (Stage::LoadModel, "load_model"),
    (Stage::Reduce, "reduce"),
    (Stage::Tuned, "tuned"),
    (Stage::Surrogates, "surrogates"),
    (Stage::Rows, "rows"),
    (Stage::Tables, "tables"),
];

/// How far the work is: written by its threads, read by that of Python.
#[derive(Default)]
pub struct Watched {
    stage: AtomicUsize,
    step: Mutex<String>,
    rows: Mutex<TimeLeft>,
    at_a_time: AtomicU64,
    failed: AtomicU64,
    stop: AtomicBool,
}

/// Stage, step of it in words, rows planned, rows done, rows failed, time left in s.
type Reached = (&'static str, String, u64, u64, u64, Option<f64>);

impl Watched {
    fn reached(&self) -> Reached {
        let (_, stage) = STAGES[self.stage.load(Ordering::Relaxed)];
        let step = locked(&self.step).clone();
        let rows = locked(&self.rows);
        (
            stage,
            step,
            rows.planned(),
            rows.done(),
            self.failed.load(Ordering::Relaxed),
            rows.pace().map(|pace| pace.left_s),
        )
    }
}

/// What nobody panics while holding.
fn locked<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Progress for Watched {
    fn stage(&self, stage: Stage) {
        let place = STAGES.iter().position(|(own, _)| *own == stage);
        self.stage
            .store(place.unwrap_or_default(), Ordering::Relaxed);
        locked(&self.step).clear();
    }

    fn step(&self, words: &str) {
        words.clone_into(&mut locked(&self.step));
    }

    fn rows_at_a_time(&self, rows: u64) {
        self.at_a_time.store(rows, Ordering::Relaxed);
    }

    fn begin_rows(&self, planned: u64, done: u64) {
        let at_a_time = self.at_a_time.load(Ordering::Relaxed);
        *locked(&self.rows) = TimeLeft::new(at_a_time, planned, done);
    }

    fn row(&self, status: Status) {
        let failed = u64::from(status != Status::Ok);
        self.failed.fetch_add(failed, Ordering::Relaxed);
        locked(&self.rows).row(Instant::now());
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// What is done when a signal comes while work goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum OnSignal {
    /// The work is asked to stop and waited for, since it stores what it has; a second signal is not waited for.
    Wait,
    /// The work is left to itself, since nothing of it is stored but its end.
    Leave,
}

/// Carries out `work` and gives what it gives.
///
/// `listener` is called with stage, step, rows planned, rows done, rows failed and time left, whenever they have changed. An exception
/// of `listener` counts as a signal.
pub fn watch<T: Send + 'static>(
    py: Python<'_>,
    listener: Option<&Py<PyAny>>,
    on_signal: OnSignal,
    work: impl FnOnce(&Watched) -> Result<T, PipelineError> + Send + 'static,
) -> PyResult<T> {
    let watched = Arc::new(Watched::default());
    let mut ended = begin(work, Arc::clone(&watched))?;
    let mut told = None;
    let mut broken_off: Option<PyErr> = None;
    let outcome = loop {
        match py.detach(|| wait(&mut ended)) {
            Ok(outcome) => break outcome,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(of_panic(py));
            }
        }
        let looked = py.check_signals().and_then(|()| {
            // Whoever listens is told no more once the work is to stop.
            let listener = listener.filter(|_| broken_off.is_none());
            tell(py, listener, &watched, &mut told)
        });
        if let Err(error) = looked {
            watched.stop.store(true, Ordering::Relaxed);
            if broken_off.is_some() || on_signal == OnSignal::Leave {
                // The thread ends by itself.
                return Err(error);
            }
            broken_off = Some(error);
        }
    };
    if let Some(error) = broken_off {
        return Err(error);
    }
    let outcome = outcome.map_err(|error| of_pipeline(py, &error))?;
    tell(py, listener, &watched, &mut told)?;
    Ok(outcome)
}

/// Begins the work on a thread of its own.
fn begin<T: Send + 'static>(
    work: impl FnOnce(&Watched) -> T + Send + 'static,
    watched: Arc<Watched>,
) -> PyResult<Receiver<T>> {
    let (sender, ended) = channel();
    let carry_out = move || {
        // Without a receiver nobody waits any more.
        let _ = sender.send(work(&watched));
    };
    thread::Builder::new()
        .name("blisk".to_owned())
        .stack_size(STACK)
        .spawn(carry_out)?;
    Ok(ended)
}

/// Waits for the end of the work until the next look.
fn wait<T>(ended: &mut Receiver<T>) -> Result<T, RecvTimeoutError> {
    ended.recv_timeout(LOOK)
}

/// Tells the listener how far the work is, unless it has been told so.
fn tell(
    py: Python<'_>,
    listener: Option<&Py<PyAny>>,
    watched: &Watched,
    told: &mut Option<Reached>,
) -> PyResult<()> {
    let reached = watched.reached();
    if let Some(listener) = listener
        && told.as_ref() != Some(&reached)
    {
        listener.call1(py, reached.clone())?;
        *told = Some(reached);
    }
    Ok(())
}
