//! A run on a thread of its own, while the thread of Python that asked for it watches for signals and reports progress.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use blisk::response::harmonic_balance::Status;
use blisk::study::{
    PipelineError, Progress, ReducedEngineSource, RunOutcome, RunRequest, Stage, Study,
    set_other_builds_aside,
};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::errors::of_pipeline;
use crate::study::CheckedStudy;

/// Time between looks for a signal, and between two reports of progress.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of the thread of a run, bytes: that of the main thread of a program.
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

/// How far a run is: written by its threads, read by that of Python.
#[derive(Default)]
struct Watched {
    stage: AtomicUsize,
    planned: AtomicU64,
    done: AtomicU64,
    failed: AtomicU64,
    stop: AtomicBool,
}

/// Stage, rows planned, rows done, rows failed.
type Reached = (&'static str, u64, u64, u64);

impl Watched {
    fn reached(&self) -> Reached {
        let number = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        let (_, stage) = STAGES[self.stage.load(Ordering::Relaxed)];
        (
            stage,
            number(&self.planned),
            number(&self.done),
            number(&self.failed),
        )
    }
}

impl Progress for Watched {
    fn stage(&self, stage: Stage) {
        let place = STAGES.iter().position(|(own, _)| *own == stage);
        self.stage
            .store(place.unwrap_or_default(), Ordering::Relaxed);
    }

    fn begin_rows(&self, planned: u64, done: u64) {
        self.planned.store(planned, Ordering::Relaxed);
        self.done.store(done, Ordering::Relaxed);
    }

    fn row(&self, status: Status) {
        let failed = u64::from(status != Status::Ok);
        self.failed.fetch_add(failed, Ordering::Relaxed);
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Creates or continues a study in the folder `out`; gives the rows solved and the rows that were there.
///
/// `listener` is called with stage, rows planned, rows done and rows failed, whenever they have changed. A signal, or
/// an exception of `listener`, stops the run between rows; a second one does not wait for that.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    study: &CheckedStudy,
    out: PathBuf,
    threads: Option<u16>,
    solve_anew: bool,
    listener: Option<Py<PyAny>>,
) -> PyResult<(u64, u64)> {
    let watched = Arc::new(Watched::default());
    let mut ended = begin(
        Arc::clone(&study.0),
        out,
        blisk::cli::threads(threads),
        solve_anew,
        Arc::clone(&watched),
    )?;
    let mut told = None;
    let mut broken_off: Option<PyErr> = None;
    let outcome = loop {
        match py.detach(|| wait(&mut ended)) {
            Ok(outcome) => break outcome,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the thread of the run panicked"));
            }
        }
        let looked = py.check_signals().and_then(|()| {
            // Whoever listens is told no more once the run is to stop.
            let listener = listener.as_ref().filter(|_| broken_off.is_none());
            tell(py, listener, &watched, &mut told)
        });
        if let Err(error) = looked {
            watched.stop.store(true, Ordering::Relaxed);
            if broken_off.is_some() {
                // The thread stores what it has and ends by itself.
                return Err(error);
            }
            broken_off = Some(error);
        }
    };
    if let Some(error) = broken_off {
        return Err(error);
    }
    let outcome = outcome.map_err(|error| of_pipeline(py, &error))?;
    tell(py, listener.as_ref(), &watched, &mut told)?;
    Ok((outcome.rows_solved, outcome.rows_reused))
}

/// How a run ended.
type Outcome = Result<RunOutcome, PipelineError>;

/// Begins the run on a thread of its own.
fn begin(
    study: Arc<Study>,
    out: PathBuf,
    threads: usize,
    solve_anew: bool,
    watched: Arc<Watched>,
) -> PyResult<Receiver<Outcome>> {
    let (sender, ended) = channel();
    let carry_out = move || {
        // Without a receiver nobody waits any more.
        let _ = sender.send(solve(&study, &out, threads, solve_anew, &watched));
    };
    thread::Builder::new()
        .name("blisk run".to_owned())
        .stack_size(STACK)
        .spawn(carry_out)?;
    Ok(ended)
}

fn solve(
    study: &Study,
    results: &Path,
    threads: usize,
    solve_anew: bool,
    watched: &Watched,
) -> Outcome {
    if solve_anew {
        set_other_builds_aside(results, study, None)?;
    }
    let request = RunRequest {
        study,
        results,
        threads,
    };
    blisk::study::run(request, &ReducedEngineSource, watched)
}

/// Waits for the end of a run until the next look.
fn wait(ended: &mut Receiver<Outcome>) -> Result<Outcome, RecvTimeoutError> {
    ended.recv_timeout(LOOK)
}

/// Tells the listener how far the run is, unless it has been told so.
fn tell(
    py: Python<'_>,
    listener: Option<&Py<PyAny>>,
    watched: &Watched,
    told: &mut Option<Reached>,
) -> PyResult<()> {
    let reached = watched.reached();
    if let Some(listener) = listener
        && *told != Some(reached)
    {
        listener.call1(py, reached)?;
        *told = Some(reached);
    }
    Ok(())
}
