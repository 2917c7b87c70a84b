//! JSON files that hold a checksum of themselves, so that a changed bit is found.
//!
//! The last key of the object is `checksum`: the BLAKE3 digest of all the text before it.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::places::is_file;
use super::{TableError, write_atomically};

/// Between the last key proper and the checksum.
const BEFORE: &str = ",\n  \"checksum\": \"";
/// After the checksum.
const AFTER: &str = "\"\n}\n";

/// Writes `content`, an object with at least one key, atomically.
pub(super) fn write_checked_json(path: &Path, content: &impl Serialize) -> Result<(), TableError> {
    let text = serde_json::to_string_pretty(content)
        .map_err(|error| TableError::encoding(path, error.to_string()))?;
    let body = text.strip_suffix("\n}").unwrap_or(&text);
    let checksum = blake3::hash(body.as_bytes()).to_hex();
    write_atomically(path, format!("{body}{BEFORE}{checksum}{AFTER}").as_bytes())
}

/// Reads such a file; none if there is none.
pub(super) fn read_checked_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, TableError> {
    if !is_file(path)? {
        return Ok(None);
    }
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(TableError::io("read", path)(error)),
    };
    let damaged = |reason: &str| {
        let advice =
            "`blisk verify DIR --repair` sets it aside and solves again what is lost with it";
        TableError::damaged(path, format!("{reason}; {advice}"))
    };
    let text = String::from_utf8(bytes).map_err(|_| damaged("it is no text"))?;
    let (body, rest) = text
        .rsplit_once(BEFORE)
        .ok_or_else(|| damaged("it holds no checksum, or was written by an earlier version"))?;
    let checksum = rest
        .strip_suffix(AFTER)
        .ok_or_else(|| damaged("it does not end as written"))?;
    if blake3::hash(body.as_bytes()).to_hex().as_str() != checksum {
        return Err(damaged("its content does not have its checksum"));
    }
    serde_json::from_str(&format!("{body}\n}}"))
        .map(Some)
        .map_err(|error| TableError::damaged(path, error.to_string()))
}

/// Name of what an estimate came to.
pub const ESTIMATE: &str = "estimate.json";
/// Name of its table.
pub const SAMPLE: &str = "sample.parquet";

/// Writes what an estimate came to into the folder `results`.
///
/// # Errors
/// The file cannot be written.
pub fn write_estimate(results: &Path, estimate: &impl Serialize) -> Result<(), TableError> {
    write_checked_json(&results.join(ESTIMATE), estimate)
}

/// Reads what an estimate came to in the folder `results`; none if there is none.
///
/// # Errors
/// The file cannot be read or is damaged.
pub fn read_estimate<T: DeserializeOwned>(results: &Path) -> Result<Option<T>, TableError> {
    read_checked_json(&results.join(ESTIMATE))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{read_checked_json, write_checked_json};

    #[test]
    fn every_flipped_bit_and_every_truncation_is_found() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("some.json");
        let content: BTreeMap<String, f64> =
            [("a".to_owned(), 1.5), ("b".to_owned(), -0.25)].into();
        write_checked_json(&path, &content).expect("written");
        let read = || read_checked_json::<BTreeMap<String, f64>>(&path);
        assert_eq!(read().expect("whole").expect("there"), content);
        let whole = std::fs::read(&path).expect("read");
        for place in 0..8 * whole.len() {
            let mut flipped = whole.clone();
            flipped[place / 8] ^= 1 << (place % 8);
            std::fs::write(&path, &flipped).expect("written");
            assert!(read().is_err(), "bit {place}");
        }
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).expect("written");
            assert!(read().is_err(), "{length} bytes");
        }
    }
}
