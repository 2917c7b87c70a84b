//! The time that the rows of a run still take, by rows alone, once enough of them are solved.

use std::fmt;
use std::time::Instant;

use crate::report::duration;

/// Rows at a time at least, for the estimate: a few rows say little.
const FEWEST: u64 = 4;
/// Rounds of rows solved at a time before which nothing is said: the first one has the slow rows of a beginning, and is left out.
const ROUNDS: u64 = 3;

/// Counts rows, and estimates how long those that are left take.
///
/// The time before the first row counts for nothing, and so does the first round of rows. Of the others those of the later two thirds
/// and more count.
#[derive(Debug, Clone)]
pub struct TimeLeft {
    at_a_time: u64,
    planned: u64,
    reused: u64,
    solved: u64,
    /// Rows solved and the time at which they were, each with twice the rows of the one before.
    marks: Vec<(u64, Instant)>,
    last: Option<Instant>,
}

/// How fast rows are solved, and how long those that are left take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Rows per second.
    pub rows_per_s: f64,
    /// Time of the rows that are left, s.
    pub left_s: f64,
}

impl Default for TimeLeft {
    fn default() -> Self {
        Self::new(FEWEST, 0, 0)
    }
}

impl TimeLeft {
    /// Of `planned` rows, `reused` of which are there, where `at_a_time` are solved at the same time.
    #[must_use]
    pub fn new(at_a_time: u64, planned: u64, reused: u64) -> Self {
        Self {
            at_a_time: at_a_time.max(FEWEST),
            planned,
            reused,
            solved: 0,
            marks: Vec::new(),
            last: None,
        }
    }

    /// A row was solved at the time `now`.
    pub fn row(&mut self, now: Instant) {
        self.solved += 1;
        self.last = Some(now);
        let next = { self.marks.last() }.map_or(self.at_a_time, |(solved, _)| 2 * solved);
        if self.solved == next {
            self.marks.push((next, now));
        }
    }

    /// Rows planned.
    #[must_use]
    pub fn planned(&self) -> u64 {
        self.planned
    }

    /// Rows that are there: solved now or before.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.reused + self.solved
    }

    /// The pace of the rows; none before enough of them are solved.
    #[must_use]
    pub fn pace(&self) -> Option<Pace> {
        let is_early = |mark: &&(u64, Instant)| ROUNDS * mark.0 <= self.solved;
        let &(before, since) = self.marks.iter().rev().find(is_early)?;
        let seconds = self.last?.duration_since(since).as_secs_f64();
        let rows_per_s = (self.solved - before) as f64 / seconds.max(1e-9);
        let left = self.planned.saturating_sub(self.done());
        Some(Pace {
            rows_per_s,
            left_s: left as f64 / rows_per_s,
        })
    }
}

impl fmt::Display for TimeLeft {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.pace() {
            None => write!(f, "time left not known yet"),
            Some(pace) if pace.rows_per_s < 1.0 => write!(
                f,
                "{} a row, about {} left",
                duration(1.0 / pace.rows_per_s),
                duration(pace.left_s)
            ),
            Some(pace) => write!(
                f,
                "{:.1} per second, about {} left",
                pace.rows_per_s,
                duration(pace.left_s)
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::TimeLeft;

    /// Rows at these times in seconds.
    fn solved(
        mut left: TimeLeft,
        began: Instant,
        times: impl IntoIterator<Item = f64>,
    ) -> TimeLeft {
        for seconds in times {
            left.row(began + Duration::from_secs_f64(seconds));
        }
        left
    }

    #[test]
    fn nothing_is_said_before_enough_rows_and_slow_first_rows_do_not_count() {
        let began = Instant::now();
        // Ten at a time: the first ones take 100 s, all others 2 s.
        let of_round = |round: u32| (0..10).map(move |_| 100.0 + 2.0 * f64::from(round));
        let two = solved(TimeLeft::new(10, 1000, 0), began, (0..2).flat_map(of_round));
        assert_eq!(two.pace(), None);
        assert_eq!(two.to_string(), "time left not known yet");
        let three = solved(two, began, of_round(2));
        let pace = three.pace().expect("enough rows");
        assert!((pace.rows_per_s - 5.0).abs() < 1e-6, "{pace:?}");
        assert!((pace.left_s - 970.0 / 5.0).abs() < 1e-6, "{pace:?}");
        assert_eq!(three.to_string(), "5.0 per second, about 3.2 min left");
    }

    #[test]
    fn rows_that_were_there_take_no_time() {
        let began = Instant::now();
        let times = (1..=12).map(|row| 10.0 * f64::from(row));
        let left = solved(TimeLeft::new(1, 200, 100), began, times);
        let pace = left.pace().expect("enough rows");
        assert_eq!(left.done(), 112);
        assert!((pace.left_s - 880.0).abs() < 1e-6, "{pace:?}");
        assert_eq!(left.to_string(), "10.0 s a row, about 14.7 min left");
    }

    #[test]
    fn a_pace_that_changes_is_followed() {
        let began = Instant::now();
        let slow = (1..=100).map(f64::from);
        let fast = (1..=900).map(|row| 100.0 + 0.1 * f64::from(row));
        let left = solved(TimeLeft::new(4, 2000, 0), began, slow.chain(fast));
        let pace = left.pace().expect("enough rows");
        assert!((pace.rows_per_s - 10.0).abs() < 1e-6, "{pace:?}");
    }
}
