//! What earlier versions had in a study and this one has not: refused with the name of what took its place.

use crate::input::{Finding, Problem, SourceMap};

/// Keys that are refused, with one value or with any, and why.
const REPLACED: [(&str, Option<&str>, &str); 4] = [
    (
        "reduction.basis",
        Some("\"stick_partial_slide\""),
        "\"stick_partial_slide\" is replaced by \"tuned_receptances\", which leaves out no motion of the contact; \
         accepted: this, or \"auto\"",
    ),
    (
        "reduction.partial_modes",
        None,
        "\"stick_partial_slide\" had them, which is replaced by basis = \"tuned_receptances\"; accepted: no such key",
    ),
    (
        "solver.higher_harmonics",
        None,
        "harmonics of the tuned wheel are replaced by basis = \"tuned_receptances\", on which every harmonic is of the \
         mistuned one; accepted: no such key",
    ),
    (
        "accuracy.simpler_contact_law",
        None,
        "rows are solved under contact.law, whatever error is accepted; accepted: no such key, and a simpler law as \
         contact.law",
    ),
];

/// Everything of this kind in a file, in its order.
pub(super) fn replaced(map: &SourceMap) -> Vec<Finding> {
    let is_written = |key: &str, value: Option<&str>| {
        map.holds(key) && value.is_none_or(|value| map.value(key) == value)
    };
    let found = REPLACED.into_iter();
    let found = found.filter(|(key, value, _)| is_written(key, *value));
    let mut found: Vec<Finding> = found
        .map(|(key, _, reason)| {
            let reason = reason.to_owned();
            map.finding(key, Problem::Conflict { reason })
        })
        .collect();
    found.sort_by_key(|finding| finding.line);
    found
}
