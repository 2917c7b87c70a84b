//! Where a wrong value of a key of a study file is refused: a finding at the key, with what the key accepts.

use crate::input::{Finding, KeySpec, Problem, SourceMap};
use crate::study::keys::{OptionsTable, study_key};

/// Findings so far, and the text they refer to.
pub(super) struct Check<'a> {
    pub(super) map: &'a SourceMap,
    pub(super) findings: Vec<Finding>,
}

impl Check<'_> {
    /// Refuses the value of a key, which accepts what its declaration says.
    pub(super) fn refuse(&mut self, key: &str) {
        self.refuse_for(key, &accepted(key));
    }

    /// Refuses the value of a key for what other keys make of it.
    pub(super) fn refuse_for(&mut self, key: &str, accepted: &str) {
        self.add(
            key,
            Problem::NotAccepted {
                value: self.map.value(key),
                accepted: accepted.to_owned(),
                suggestion: None,
            },
        );
    }

    /// Misses a key, which accepts what its declaration says.
    pub(super) fn missing(&mut self, key: &str) {
        self.missing_for(key, &accepted(key));
    }

    /// Misses a key that other keys need.
    pub(super) fn missing_for(&mut self, key: &str, accepted: &str) {
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

    /// A number as it is, with a finding unless its key accepts it.
    pub(super) fn judged(&mut self, key: &str, number: f64) -> f64 {
        if study_key(key).is_some_and(|spec| !spec.value.holds(number)) {
            self.refuse(key);
        }
        number
    }

    /// A number that must be there and accepted; none, and a finding, otherwise.
    pub(super) fn given(&mut self, key: &str, number: Option<f64>) -> Option<f64> {
        let Some(number) = number else {
            self.missing(key);
            return None;
        };
        let findings = self.findings.len();
        self.judged(key, number);
        (self.findings.len() == findings).then_some(number)
    }

    /// A number as [`Self::given`] has it; 1 stands in for none.
    pub(super) fn required(&mut self, key: &str, number: Option<f64>) -> f64 {
        self.given(key, number).unwrap_or(1.0)
    }

    /// Puts the table `name` into `options`, with a finding for each value that is not accepted, but for the keys that are judged
    /// `elsewhere`.
    pub(super) fn put<T: OptionsTable>(
        &mut self,
        name: &str,
        table: Option<T>,
        options: &mut T::Options,
        elsewhere: &[&str],
    ) {
        let refused = table.map_or_else(Vec::new, |table| table.put_into(options));
        for key in refused.into_iter().filter(|key| !elsewhere.contains(key)) {
            self.refuse(&format!("{name}.{key}"));
        }
    }
}

/// What a key accepts, in words.
fn accepted(key: &str) -> String {
    study_key(key).map_or_else(String::new, KeySpec::accepted)
}
