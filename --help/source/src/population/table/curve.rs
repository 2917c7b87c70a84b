//! The response of one pattern over frequency, to CSV or Parquet.

use std::fmt::Write;
use std::path::Path;

use serde::Serialize;

use super::column::{ColumnKind, ColumnSpec, Values};
use super::parquet::TableWriter;
use super::{TableError, TableHeader, write_atomically};
use crate::response::harmonic_balance::Status;

use ColumnKind::{Float64, Int32, String as Text};

/// Columns of a response curve.
pub const CURVE_COLUMNS: &[ColumnSpec] = &[
    ColumnSpec::new("frequency_hz", Float64, "Hz", "Excitation frequency"),
    ColumnSpec::new("blade", Int32, "", "Blade, from 0"),
    ColumnSpec::new(
        "amplitude_m",
        Float64,
        "m",
        "Amplitude; null where the solution failed",
    ),
    ColumnSpec::new(
        "status",
        Text,
        "",
        "How the solution at this frequency ended",
    ),
];

/// Amplitude of one blade at one frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CurvePoint {
    /// Excitation frequency, Hz.
    pub frequency_hz: f64,
    /// Blade, from 0.
    pub blade: u32,
    /// Amplitude, m; none where the solution failed.
    pub amplitude_m: Option<f64>,
    /// How the solution at this frequency ended.
    pub status: Status,
}

/// Format of a response curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveFormat {
    /// Comma-separated values with a header; an empty field where there is no value.
    Csv,
    /// Parquet.
    Parquet,
}

impl CurveFormat {
    /// The format that the extension of `path` asks for.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "csv" => Some(Self::Csv),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }
}

/// Writes a response curve.
///
/// # Errors
/// The file cannot be written.
pub fn write_curve(
    path: &Path,
    format: CurveFormat,
    points: &[CurvePoint],
    header: &TableHeader,
) -> Result<(), TableError> {
    match format {
        CurveFormat::Csv => write_atomically(path, csv(points).as_bytes()),
        CurveFormat::Parquet => {
            let mut writer = TableWriter::create(path, CURVE_COLUMNS, header)?;
            writer.write(vec![
                Values::Float64(
                    points
                        .iter()
                        .map(|point| Some(point.frequency_hz))
                        .collect(),
                ),
                Values::Int32(
                    points
                        .iter()
                        .map(|point| Some(point.blade as i32))
                        .collect(),
                ),
                Values::Float64(points.iter().map(|point| point.amplitude_m).collect()),
                Values::String(
                    points
                        .iter()
                        .map(|point| Some(point.status.name().to_owned()))
                        .collect(),
                ),
            ])?;
            writer.finish()
        }
    }
}

/// Numbers with as many digits as it takes to read them back exactly.
fn csv(points: &[CurvePoint]) -> String {
    let mut text = String::from("frequency_hz,blade,amplitude_m,status\n");
    for point in points {
        let amplitude = point
            .amplitude_m
            .map_or_else(String::new, |amplitude| format!("{amplitude:e}"));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{},{amplitude},{}",
            point.frequency_hz,
            point.blade,
            point.status.name()
        );
    }
    text
}
