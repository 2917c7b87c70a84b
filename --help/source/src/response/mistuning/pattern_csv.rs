//! Reader of patterns in CSV: `pattern,blade,deviation`, optionally with a column `mode`.

use std::path::Path;
use std::str::FromStr;

use super::{PatternFileError, PatternRecord, PatternRecords};

const ACCEPTED_HEADER: &str =
    "a header with the columns pattern, blade, deviation and optionally mode, comma separated";

/// Places of the columns in a line.
struct Columns {
    count: usize,
    pattern: usize,
    blade: usize,
    mode: Option<usize>,
    deviation: usize,
}

/// Reads the patterns of a CSV file. Empty lines and lines that begin with `#` are skipped; an
/// empty `mode` means all modes.
///
/// # Errors
/// An unreadable file, a header or entry that is not accepted; see [`PatternRecords::new`].
pub fn read_pattern_csv(path: &Path) -> Result<PatternRecords, PatternFileError> {
    let text = std::fs::read_to_string(path).map_err(|source| PatternFileError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    let mut lines = (1..)
        .zip(text.trim_start_matches('\u{feff}').lines())
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let Some((_, header)) = lines.next() else {
        return Err(PatternFileError::Form {
            path: path.to_owned(),
            found: "the file is empty".to_owned(),
            accepted: ACCEPTED_HEADER,
        });
    };
    let columns = read_header(path, header)?;
    let records = lines
        .map(|(line, content)| read_record(path, &columns, line, content))
        .collect::<Result<_, _>>()?;
    PatternRecords::new(path, records)
}

fn read_header(path: &Path, header: &str) -> Result<Columns, PatternFileError> {
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let refused = |found: String| PatternFileError::Form {
        path: path.to_owned(),
        found,
        accepted: ACCEPTED_HEADER,
    };
    if let Some(unknown) = names
        .iter()
        .find(|name| !["pattern", "blade", "mode", "deviation"].contains(name))
    {
        return Err(refused(format!(
            "unknown column \"{unknown}\" in the header"
        )));
    }
    let place = |wanted: &str| -> Result<Option<usize>, PatternFileError> {
        let mut places = (0..names.len()).filter(|&i| names[i] == wanted);
        let first = places.next();
        match places.next() {
            Some(_) => Err(refused(format!(
                "column \"{wanted}\" stands twice in the header"
            ))),
            None => Ok(first),
        }
    };
    let required = |wanted: &str| {
        place(wanted)?.ok_or_else(|| refused(format!("no column \"{wanted}\" in the header")))
    };
    Ok(Columns {
        count: names.len(),
        pattern: required("pattern")?,
        blade: required("blade")?,
        mode: place("mode")?,
        deviation: required("deviation")?,
    })
}

fn read_record(
    path: &Path,
    columns: &Columns,
    line: usize,
    content: &str,
) -> Result<PatternRecord, PatternFileError> {
    let fields: Vec<&str> = content.split(',').map(str::trim).collect();
    if fields.len() != columns.count {
        return Err(PatternFileError::Entry {
            path: path.to_owned(),
            line,
            column: "line",
            value: format!("{content:?}"),
            accepted: format!("{} fields, as in the header", columns.count),
        });
    }
    let id = |column: &'static str, place: usize| {
        parse(
            path,
            line,
            column,
            fields[place],
            "a whole number from 0 to 2147483647",
        )
        .and_then(|value: u32| {
            if i32::try_from(value).is_ok() {
                Ok(value)
            } else {
                Err(entry(
                    path,
                    line,
                    column,
                    fields[place],
                    "a whole number from 0 to 2147483647",
                ))
            }
        })
    };
    Ok(PatternRecord {
        line,
        pattern: id("pattern", columns.pattern)?,
        blade: id("blade", columns.blade)?,
        mode: match columns.mode {
            Some(place) if !fields[place].is_empty() => Some(id("mode", place)?),
            _ => None,
        },
        deviation: parse(
            path,
            line,
            "deviation",
            fields[columns.deviation],
            "a finite number above -1",
        )?,
    })
}

fn parse<T: FromStr>(
    path: &Path,
    line: usize,
    column: &'static str,
    field: &str,
    accepted: &str,
) -> Result<T, PatternFileError> {
    field
        .parse()
        .map_err(|_| entry(path, line, column, field, accepted))
}

fn entry(
    path: &Path,
    line: usize,
    column: &'static str,
    field: &str,
    accepted: &str,
) -> PatternFileError {
    PatternFileError::Entry {
        path: path.to_owned(),
        line,
        column,
        value: format!("\"{field}\""),
        accepted: accepted.to_owned(),
    }
}
