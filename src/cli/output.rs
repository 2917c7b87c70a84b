//! Printing: results to stdout, messages to stderr; a closed pipe is no error.

use std::fmt::Display;
use std::io::Write;

use serde::Serialize;

/// Prints a result as text, or as JSON if asked for.
pub(super) fn result(json: bool, value: &(impl Display + Serialize)) {
    if json {
        json_only(value);
    } else {
        text(value);
    }
}

/// Prints a result as JSON.
pub(super) fn json_only(value: &impl Serialize) {
    match serde_json::to_string_pretty(value) {
        Ok(line) => text(&line),
        Err(error) => message(&format!("error: cannot write JSON: {error}")),
    }
}

/// Prints text to stdout, one newline at its end.
pub(super) fn text(value: &impl Display) {
    let text = value.to_string();
    // Whoever closed the pipe has read enough.
    let _ = writeln!(std::io::stdout().lock(), "{}", text.trim_end());
}

/// Prints a message to stderr.
pub(super) fn message(value: &impl Display) {
    let _ = writeln!(std::io::stderr().lock(), "{value}");
}
