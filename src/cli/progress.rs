//! Progress of a run on stderr: a bar on a terminal, a plain line now and then elsewhere.

use std::fmt::Display;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::interrupt::{Signals, signals_of_process};
use super::output;
use crate::report::ExpectedCost;
use crate::response::harmonic_balance::Status;
use crate::settings::{Progress, Stage};

/// Time between plain lines.
const PLAIN_INTERVAL: Duration = Duration::from_secs(30);

/// Progress of one run.
pub(super) struct RunProgress {
    bar: Option<ProgressBar>,
    failed: AtomicU64,
    plain: Mutex<Plain>,
    signals: Option<&'static Signals>,
}

/// State of the plain lines.
struct Plain {
    began: Instant,
    last: Instant,
    planned: u64,
    reused: u64,
    solved: u64,
}

impl RunProgress {
    pub(super) fn new() -> Self {
        let now = Instant::now();
        Self {
            bar: output::shows_bars().then(ProgressBar::no_length),
            failed: AtomicU64::new(0),
            plain: Mutex::new(Plain {
                began: now,
                last: now,
                planned: 0,
                reused: 0,
                solved: 0,
            }),
            signals: signals_of_process(),
        }
    }

    /// A message, above the bar if there is one.
    fn say(&self, value: &impl Display) {
        match &self.bar {
            Some(bar) => bar.suspend(|| output::message(value)),
            None => output::message(value),
        }
    }

    /// Takes the bar off the terminal.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    fn plain_line(&self, failed: u64) {
        let Ok(mut plain) = self.plain.lock() else {
            return;
        };
        plain.solved += 1;
        if plain.last.elapsed() < PLAIN_INTERVAL {
            return;
        }
        plain.last = Instant::now();
        let seconds = plain.began.elapsed().as_secs_f64();
        let rate = plain.solved as f64 / seconds.max(1e-9);
        let done = plain.reused + plain.solved;
        let left = plain.planned.saturating_sub(done) as f64 / rate.max(1e-9);
        output::message(&format!(
            "{done} of {} rows, {rate:.1} per second, about {left:.0} s left, {failed} failed",
            plain.planned
        ));
    }
}

impl Progress for RunProgress {
    fn stage(&self, stage: Stage) {
        if let Some(signals) = self.signals {
            signals.set_storing(matches!(stage, Stage::Rows | Stage::Tables));
        }
        let words = match stage {
            Stage::LoadModel => "loading the model",
            Stage::Reduce => "reducing the model",
            Stage::Tuned => "solving the tuned wheel",
            Stage::Surrogates => "finding the surrogates",
            Stage::Rows => "solving the patterns",
            Stage::Tables => "writing the tables",
        };
        if let Some(bar) = &self.bar {
            bar.set_style(style("{spinner} {msg} {elapsed}"));
            bar.set_message(words);
            bar.enable_steady_tick(Duration::from_millis(200));
        }
    }

    fn begin_rows(&self, planned: u64, done: u64) {
        if let Some(bar) = &self.bar {
            bar.set_style(style(
                "{bar:30} {pos}/{len} rows  {per_sec}  {eta} left  {msg}",
            ));
            bar.set_length(planned);
            bar.set_position(done);
            bar.reset_eta();
            bar.set_message("0 failed");
        } else if let Ok(mut plain) = self.plain.lock() {
            plain.began = Instant::now();
            plain.planned = planned;
            plain.reused = done;
            plain.solved = 0;
        }
    }

    fn solves_anew(&self, rows: u64, why: &str) {
        self.say(&format!("{rows} stored rows are solved anew: {why}"));
    }

    fn surrogate_times(&self, surrogate_s: f64, row_s: f64) {
        self.say(&format!(
            "measured: a row takes {:.1} ms of processor time, a surrogate {:.1} ms, {:.2} of a row",
            1e3 * row_s,
            1e3 * surrogate_s,
            surrogate_s / row_s
        ));
    }

    fn cost(&self, cost: &ExpectedCost) {
        self.say(cost);
    }

    fn taken_over(&self, holder: &str) {
        self.say(&format!("taken over from {holder}, which was broken off"));
    }

    fn stop_requested(&self) -> bool {
        self.signals.is_some_and(|signals| signals.came().is_some())
    }

    fn saved(&self) {
        if let Some(signals) = self.signals {
            self.finish();
            signals.leave_if_asked();
        }
    }

    fn row(&self, status: Status) {
        let failures = u64::from(status != Status::Ok);
        let failed = self.failed.fetch_add(failures, Ordering::Relaxed) + failures;
        match &self.bar {
            Some(bar) => {
                if failures > 0 {
                    bar.set_message(format!("{failed} failed"));
                }
                bar.inc(1);
            }
            None => self.plain_line(failed),
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
