//! Progress of a run on stderr: a bar on a terminal, a plain line now and then elsewhere.

use std::fmt::Display;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::interrupt::{Signals, signals_of_process};
use super::output;
use crate::report::ExpectedCost;
use crate::response::harmonic_balance::Status;
use crate::settings::{Progress, Stage, TimeLeft};

/// Time between plain lines that say the same or count on.
const PLAIN_INTERVAL: Duration = Duration::from_secs(30);
/// Time between plain lines that say something else, and time that it takes to be said.
const PLAIN_CHANGE: Duration = Duration::from_secs(2);
/// Time between looks at whether a plain line is due.
const LOOK: Duration = Duration::from_millis(250);

/// Progress of one run.
pub(super) struct RunProgress {
    bar: Option<ProgressBar>,
    reached: Arc<Mutex<Reached>>,
    /// Wakes and ends the writer of plain lines.
    _over: Option<Sender<()>>,
    signals: Option<&'static Signals>,
}

/// How far the run is, and when that was said in a plain line.
struct Reached {
    words: String,
    /// Since when it is there.
    since: Instant,
    rows: Option<TimeLeft>,
    at_a_time: u64,
    failed: u64,
    /// When a plain line was last written.
    last: Instant,
    /// What it said.
    told: String,
}

impl Reached {
    fn new(now: Instant) -> Self {
        Self {
            words: String::new(),
            since: now,
            rows: None,
            at_a_time: 1,
            failed: 0,
            last: now,
            told: String::new(),
        }
    }

    fn at(&mut self, words: &str, now: Instant) {
        if self.words != words {
            words.clone_into(&mut self.words);
            self.since = now;
        }
    }

    fn begin_rows(&mut self, planned: u64, done: u64, now: Instant) {
        self.rows = Some(TimeLeft::new(self.at_a_time, planned, done));
        self.since = now;
    }

    fn row(&mut self, status: Status, now: Instant) {
        self.failed += u64::from(status != Status::Ok);
        if let Some(rows) = &mut self.rows {
            rows.row(now);
        }
    }

    /// What stands beside a bar of rows.
    fn beside_bar(&self) -> String {
        let left = self.rows.as_ref().map(TimeLeft::to_string);
        format!("{}, {} failed", left.unwrap_or_default(), self.failed)
    }

    /// The plain line that is due.
    fn line(&mut self, now: Instant) -> Option<String> {
        let quiet = now.duration_since(self.last);
        let here = now.duration_since(self.since);
        let line = match &self.rows {
            Some(rows) => (quiet.min(here) >= PLAIN_INTERVAL).then(|| {
                let (done, planned) = (rows.done(), rows.planned());
                format!("{done} of {planned} rows, {}", self.beside_bar())
            })?,
            None if self.words.is_empty() => return None,
            None if self.words != self.told => {
                (quiet.min(here) >= PLAIN_CHANGE).then(|| self.words.clone())?
            }
            None => (quiet >= PLAIN_INTERVAL)
                .then(|| format!("{}, for {} s so far", self.words, here.as_secs()))?,
        };
        self.told.clone_from(&self.words);
        self.last = now;
        Some(line)
    }
}

/// Writes plain lines while the run goes on, until the sender of `over` is gone.
fn write_lines(reached: &Mutex<Reached>, over: &Receiver<()>) {
    while over.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
        let line = match reached.lock() {
            Ok(mut reached) => reached.line(Instant::now()),
            Err(_) => None,
        };
        if let Some(line) = line {
            output::message(&line);
        }
    }
}

impl RunProgress {
    pub(super) fn new() -> Self {
        let bar = output::shows_bars().then(ProgressBar::no_length);
        let reached = Arc::new(Mutex::new(Reached::new(Instant::now())));
        let over = bar.is_none().then(|| {
            let (over, is_over) = channel();
            let reached = Arc::clone(&reached);
            // It ends by itself once the run has ended.
            thread::spawn(move || write_lines(&reached, &is_over));
            over
        });
        Self {
            bar,
            reached,
            _over: over,
            signals: signals_of_process(),
        }
    }

    fn reached(&self) -> MutexGuard<'_, Reached> {
        // Nobody panics while holding it.
        self.reached.lock().unwrap_or_else(PoisonError::into_inner)
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
        let mut reached = self.reached();
        reached.rows = None;
        reached.words.clear();
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
        let mut reached = self.reached();
        reached.rows = None;
        reached.at(words, Instant::now());
        drop(reached);
        if let Some(bar) = &self.bar {
            bar.set_style(style("{spinner} {msg} {elapsed}"));
            bar.set_message(words);
            bar.enable_steady_tick(Duration::from_millis(200));
        }
    }

    fn step(&self, words: &str) {
        self.reached().at(words, Instant::now());
        if let Some(bar) = &self.bar {
            bar.set_message(words.to_owned());
        }
    }

    fn rows_at_a_time(&self, rows: u64) {
        self.reached().at_a_time = rows;
    }

    fn begin_rows(&self, planned: u64, done: u64) {
        let mut reached = self.reached();
        reached.begin_rows(planned, done, Instant::now());
        let beside = reached.beside_bar();
        drop(reached);
        if let Some(bar) = &self.bar {
            bar.set_style(style("{bar:30} {pos}/{len} rows  {msg}"));
            bar.set_length(planned);
            bar.set_position(done);
            bar.set_message(beside);
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
        let mut reached = self.reached();
        reached.row(status, Instant::now());
        let beside = self.bar.as_ref().map(|bar| (bar, reached.beside_bar()));
        drop(reached);
        if let Some((bar, beside)) = beside {
            bar.set_message(beside);
            bar.inc(1);
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::Reached;
    use crate::response::harmonic_balance::Status;

    /// The lines of a log that looks twice a second, up to `seconds` after the beginning; `happens` is told the half second.
    fn lines(seconds: u32, mut happens: impl FnMut(&mut Reached, u32, Instant)) -> Vec<String> {
        let began = Instant::now();
        let mut reached = Reached::new(began);
        let looks = 0..=2 * seconds;
        let line = looks.filter_map(|look| {
            let now = began + Duration::from_millis(500) * look;
            happens(&mut reached, look, now);
            let line = reached.line(now)?;
            Some(format!("{} s: {line}", f64::from(look) / 2.0))
        });
        line.collect()
    }

    #[test]
    fn a_log_says_what_a_slow_beginning_is_at() {
        let told = lines(100, |reached, look, now| match look {
            0 => reached.at("solving the tuned wheel", now),
            1 => reached.at("tuned wheel: load 1 of 5 (3 N)", now),
            70 => reached.at("tuned wheel: load 2 of 5 (10 N)", now),
            71 => reached.at("tuned wheel: load 3 of 5 (30 N)", now),
            _ => {}
        });
        assert_eq!(
            told,
            [
                "2.5 s: tuned wheel: load 1 of 5 (3 N)",
                "32.5 s: tuned wheel: load 1 of 5 (3 N), for 32 s so far",
                "37.5 s: tuned wheel: load 3 of 5 (30 N)",
                "67.5 s: tuned wheel: load 3 of 5 (30 N), for 32 s so far",
                "97.5 s: tuned wheel: load 3 of 5 (30 N), for 62 s so far",
            ]
        );
    }

    #[test]
    fn a_log_is_silent_where_all_is_quick() {
        let told = lines(20, |reached, look, now| reached.at(&look.to_string(), now));
        assert_eq!(told, [""; 0]);
    }

    #[test]
    fn a_log_counts_rows_and_says_no_time_before_it_is_known() {
        let told = lines(95, |reached, look, now| {
            if look == 20 {
                reached.at_a_time = 4;
                reached.begin_rows(1000, 0, now);
            }
            // The first rows come late.
            if look >= 80 {
                reached.row(Status::Ok, now);
            }
        });
        assert_eq!(
            told,
            [
                "40 s: 1 of 1000 rows, time left not known yet, 0 failed",
                "70 s: 61 of 1000 rows, 2.0 per second, about 7.8 min left, 0 failed",
            ]
        );
    }
}
