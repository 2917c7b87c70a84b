//! Findings of the checks of a study file, each at its key.

use crate::input::{Finding, Problem, SourceMap};

/// Findings so far, and the text they refer to.
pub(super) struct Check<'a> {
    pub(super) map: &'a SourceMap,
    pub(super) findings: Vec<Finding>,
}

impl Check<'_> {
    pub(super) fn refuse(&mut self, key: &str, accepted: &str) {
        self.add(
            key,
            Problem::NotAccepted {
                value: self.map.value(key),
                accepted: accepted.to_owned(),
                suggestion: None,
            },
        );
    }

    pub(super) fn missing(&mut self, key: &str, accepted: &str) {
        self.add(
            key,
            Problem::Missing {
                accepted: accepted.to_owned(),
            },
        );
    }

    pub(super) fn conflict(&mut self, key: &str, reason: &str) {
        self.add(
            key,
            Problem::Conflict {
                reason: reason.to_owned(),
            },
        );
    }

    fn add(&mut self, key: &str, problem: Problem) {
        self.findings.push(self.map.finding(key, problem));
    }

    pub(super) fn is_written(&self, key: &str) -> bool {
        self.map.holds(key)
    }

    /// `value`, with a finding unless it `holds`.
    pub(super) fn within<T: Copy>(
        &mut self,
        key: &str,
        value: T,
        holds: bool,
        accepted: &str,
    ) -> T {
        if !holds {
            self.refuse(key, accepted);
        }
        value
    }

    /// A number that must be there and accepted; none, and a finding, otherwise.
    pub(super) fn given(
        &mut self,
        key: &str,
        value: Option<f64>,
        holds: impl Fn(f64) -> bool,
        accepted: &str,
    ) -> Option<f64> {
        match value {
            Some(value) if holds(value) => return Some(value),
            Some(_) => self.refuse(key, accepted),
            None => self.missing(key, accepted),
        }
        None
    }

    /// A number as [`Self::given`] has it; 1 stands in for none.
    pub(super) fn required(
        &mut self,
        key: &str,
        value: Option<f64>,
        holds: impl Fn(f64) -> bool,
        accepted: &str,
    ) -> f64 {
        self.given(key, value, holds, accepted).unwrap_or(1.0)
    }
}
