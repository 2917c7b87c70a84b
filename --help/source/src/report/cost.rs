//! What a long command will cost, said before its long part.

use std::fmt;

use serde::Serialize;

use super::words::{duration, paragraph};

/// What a command is about to solve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExpectedCost {
    /// What is solved, in words that begin a sentence.
    pub what: String,
    /// Rows, about.
    pub rows: u64,
    /// Time that they take.
    pub time: Option<ExpectedTime>,
}

/// Time of rows that are not solved yet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExpectedTime {
    /// On processors, all threads together, s.
    pub cpu_s: f64,
    /// On the clock, s.
    pub wall_s: f64,
    /// Threads.
    pub threads: usize,
    /// What the time was measured on.
    pub measured_on: String,
}

impl fmt::Display for ExpectedCost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = match &self.time {
            None => "how long they take is said once the first of them are solved".to_owned(),
            Some(time) => format!(
                "about {} of processor time, {} on {} thread{}, by {}",
                duration(time.cpu_s),
                duration(time.wall_s),
                time.threads,
                if time.threads == 1 { "" } else { "s" },
                time.measured_on
            ),
        };
        let text = format!("{}: about {} rows; {time}", self.what, self.rows);
        f.write_str(&paragraph(&text))
    }
}
