//! The response of one pattern followed by continuation, to CSV or Parquet.

use std::fmt::Write;
use std::path::Path;

use serde::Serialize;

use super::column::{ColumnKind, ColumnSpec, Values};
use super::curve::CurveFormat;
use super::parquet::TableWriter;
use super::{TableError, TableHeader, write_atomically};
use crate::response::harmonic_balance::Status;

use ColumnKind::{Boolean, Float64, Int32, String as Text};

/// Columns of a followed response curve: those of a response curve, and where along the curve.
pub const TRACE_COLUMNS: &[ColumnSpec] = &[
    ColumnSpec::new("frequency_hz", Float64, "Hz", "Excitation frequency"),
    ColumnSpec::new(
        "blade",
        Int32,
        "",
        "Blade, from 0; null where the curve did not pass",
    ),
    ColumnSpec::new(
        "amplitude_m",
        Float64,
        "m",
        "Amplitude; null where the curve did not pass",
    ),
    ColumnSpec::new(
        "status",
        Text,
        "",
        "ok, or why the curve did not pass this frequency",
    ),
    ColumnSpec::new(
        "direction",
        Text,
        "",
        "up: followed from the first frequency to the last; down: the other way",
    ),
    ColumnSpec::new(
        "branch",
        Int32,
        "",
        "Folds passed before; odd: between two folds, no sweep gets there",
    ),
    ColumnSpec::new("fold", Boolean, "", "Whether the frequency turns here"),
];

/// Direction in which a curve is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// From the first frequency to the last.
    Up,
    /// From the last frequency to the first.
    Down,
}

impl Direction {
    /// Both directions, in the order of the table.
    pub const BOTH: [Self; 2] = [Self::Up, Self::Down];

    /// Name in the column `direction`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// Amplitude of one blade at one passage of a frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TracePoint {
    /// Excitation frequency, Hz.
    pub frequency_hz: f64,
    /// Blade, from 0; none where the curve did not pass.
    pub blade: Option<u32>,
    /// Amplitude, m; none where the curve did not pass.
    pub amplitude_m: Option<f64>,
    /// `ok`, or why the curve did not pass.
    pub status: Status,
    /// Direction of the trace.
    pub direction: Direction,
    /// Folds passed before.
    pub branch: Option<u32>,
    /// Whether the frequency turns here.
    pub fold: bool,
}

/// Writes a followed response curve.
///
/// # Errors
/// The file cannot be written.
pub fn write_traced_curve(
    path: &Path,
    format: CurveFormat,
    points: &[TracePoint],
    header: &TableHeader,
) -> Result<(), TableError> {
    if format == CurveFormat::Csv {
        return write_atomically(path, csv(points).as_bytes());
    }
    let mut writer = TableWriter::create(path, TRACE_COLUMNS, header)?;
    writer.write(vec![
        Values::Float64(column(points, |point| Some(point.frequency_hz))),
        Values::Int32(column(points, |point| {
            point.blade.map(|blade| blade as i32)
        })),
        Values::Float64(column(points, |point| point.amplitude_m)),
        Values::String(column(points, |point| Some(point.status.name().to_owned()))),
        Values::String(column(points, |point| {
            Some(point.direction.name().to_owned())
        })),
        Values::Int32(column(points, |point| {
            point.branch.map(|branch| branch as i32)
        })),
        Values::Boolean(column(points, |point| Some(point.fold))),
    ])?;
    writer.finish()
}

/// One value of every point.
fn column<T>(points: &[TracePoint], value: impl Fn(&TracePoint) -> T) -> Vec<T> {
    points.iter().map(value).collect()
}

/// Numbers with as many digits as it takes to read them back exactly.
fn csv(points: &[TracePoint]) -> String {
    let names: Vec<&str> = TRACE_COLUMNS.iter().map(|column| column.name).collect();
    let mut text = names.join(",") + "\n";
    for point in points {
        let whole = |value: Option<u32>| value.map_or_else(String::new, |value| value.to_string());
        let amplitude = point
            .amplitude_m
            .map_or_else(String::new, |amplitude| format!("{amplitude:e}"));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{},{amplitude},{},{},{},{}",
            point.frequency_hz,
            whole(point.blade),
            point.status.name(),
            point.direction.name(),
            whole(point.branch),
            point.fold
        );
    }
    text
}
