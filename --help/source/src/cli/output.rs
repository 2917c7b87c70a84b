//! Printing: results to stdout, messages to stderr, and nothing else in the program prints.
//!
//! A result that cannot be written is a failure of its command; a closed pipe is none. What is printed may
//! hold names out of files, so that characters that a terminal takes for orders are printed as escapes.

use std::fmt::{Display, Write as _};
use std::io::{ErrorKind, IsTerminal, Write};

use serde::Serialize;

use super::ExitStatus;
use super::exit::Failure;
use crate::report::{visible, with_orders_escaped};

/// Prints a result as text, or as JSON if asked for.
pub(super) fn result(json: bool, value: &(impl Display + Serialize)) -> Result<(), Failure> {
    if json { json_only(value) } else { text(value) }
}

/// Prints a result as JSON.
pub(super) fn json_only(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Failure {
        status: ExitStatus::InternalError,
        message: format!("cannot write the result as JSON: {error}"),
    })?;
    // What the encoder leaves of such characters stands inside of strings.
    write_result(&with_orders_escaped(&text, |character, escaped| {
        let _ = write!(escaped, "\\u{:04x}", u32::from(character));
    }))
}

/// Prints text to stdout, one newline at its end.
pub(super) fn text(value: &impl Display) -> Result<(), Failure> {
    write_result(&visible(&value.to_string()))
}

/// Prints a message to stderr; if that cannot be written, there is nowhere left to say so.
pub(super) fn message(value: &impl Display) {
    let text = visible(&value.to_string()).into_owned();
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Whether messages go to a terminal, which can show a bar.
pub(super) fn shows_bars() -> bool {
    std::io::stderr().is_terminal()
}

/// Prints what clap has to say instead of a command line: help and version are results, anything else is wrong use.
pub(super) fn of_clap(error: &clap::Error) -> Result<ExitStatus, Failure> {
    let rendered = error.render();
    let plain = rendered.to_string();
    if !error.use_stderr() {
        let text = if takes_styles(&std::io::stdout()) {
            rendered.ansi().to_string()
        } else {
            plain
        };
        // The text is the program's own, so that there is nothing to escape.
        write_result(&text)?;
        return Ok(ExitStatus::Done);
    }
    // It repeats the arguments; those with something to escape get no style.
    if takes_styles(&std::io::stderr()) && visible(&plain) == plain {
        let _ = write!(std::io::stderr().lock(), "{}", rendered.ansi());
    } else {
        message(&plain.trim_end());
    }
    Ok(ExitStatus::Usage)
}

/// Whether bold and colour are shown there, and wanted (no-color.org).
fn takes_styles(stream: &impl IsTerminal) -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    cfg!(unix) && stream.is_terminal() && !set("NO_COLOR") && !dumb
}

fn write_result(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    let written = writeln!(stdout, "{}", text.trim_end()).and_then(|()| stdout.flush());
    match written {
        // Whoever closed the pipe has read enough.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure {
            status: ExitStatus::InputOutput,
            message: format!(
                "cannot write the result to standard output: {error}; what was printed is not complete, what was stored \
                 stays stored: give the command again with an output that can be written"
            ),
        }),
        _ => Ok(()),
    }
}
