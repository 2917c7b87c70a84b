//! A study file carried out in a results folder, with a listener to its progress.
//!
//!     cargo run --release --example progress -- STUDY FOLDER

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use blisk::{Progress, RunRequest, Stage, Status, Study, run};

/// Tells stages and tenths of the rows; called from every thread that solves rows.
pub(crate) struct Listener<W> {
    out: Mutex<W>,
    planned: AtomicU64,
    done: AtomicU64,
}

impl<W: Write> Listener<W> {
    /// Nothing is planned yet.
    pub(crate) fn new(out: W) -> Self {
        Self {
            out: Mutex::new(out),
            planned: AtomicU64::new(0),
            done: AtomicU64::new(0),
        }
    }

    fn tell(&self, text: &str) {
        if let Ok(mut out) = self.out.lock() {
            // Nobody is left to hear that nobody listens.
            let _ = writeln!(out, "{text}");
        }
    }
}

impl<W: Write + Send> Progress for Listener<W> {
    fn stage(&self, stage: Stage) {
        self.tell(match stage {
            Stage::LoadModel => "loading the sector",
            Stage::Reduce => "reducing it",
            Stage::Tuned => "solving the tuned wheels",
            Stage::Surrogates => "finding surrogates",
            Stage::Rows => "solving rows",
            Stage::Tables => "writing tables",
        });
    }

    fn begin_rows(&self, planned: u64, done: u64) {
        self.planned.store(planned, Ordering::Relaxed);
        self.done.store(done, Ordering::Relaxed);
    }

    fn row(&self, status: Status) {
        if status != Status::Ok {
            self.tell(&format!("a row failed: {}", status.name()));
        }
        let planned = self.planned.load(Ordering::Relaxed);
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let tenths = |rows: u64| 10 * rows / planned.max(1);
        if tenths(done) > tenths(done - 1) {
            self.tell(&format!("{done} of {planned} rows"));
        }
    }

    // `stop_requested` has the run store what it has and end; the same call continues it.
}

/// Carries out the study file `study` in the folder `results`, and writes what it came to.
pub(crate) fn told(
    study: &Path,
    results: &Path,
    out: &mut (impl Write + Send),
) -> Result<(), Box<dyn Error>> {
    let study = Study::read(study)?;
    let listener = Listener::new(&mut *out);
    let request = RunRequest {
        study: &study,
        results,
        threads: std::thread::available_parallelism()?.get(),
    };
    let outcome = run(request, &listener)?;
    writeln!(
        out,
        "{} rows solved\n{}",
        outcome.rows_solved, outcome.summary
    )?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let both = arguments.next().zip(arguments.next());
    let (study, results) =
        both.ok_or("two arguments are needed: a study file and a results folder")?;
    told(study.as_ref(), results.as_ref(), &mut std::io::stdout())
}
