//! What can be wrong with a line of a bundle's file.

use thiserror::Error;

/// A refused line: the value found and what is accepted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LineProblem {
    /// `model.toml` is not what the format says.
    #[error("{message}")]
    Toml {
        /// What the TOML reader reports: the key or value found and what it expected.
        message: String,
    },
    /// A fixed value of `model.toml` is another one.
    #[error("`{key}` is {found}; accepted: {accepted}")]
    Header {
        /// The key.
        key: &'static str,
        /// Value found.
        found: String,
        /// Value accepted.
        accepted: String,
    },
    /// The banner of a Matrix Market file.
    #[error(
        "the banner is {found:?}; accepted: \"%%MatrixMarket matrix coordinate\" and then real or integer, symmetric or general"
    )]
    Banner {
        /// Line found.
        found: String,
    },
    /// The file ends too early.
    #[error("the file ends after {found} of {expected} entries")]
    Truncated {
        /// Entries read.
        found: usize,
        /// Entries announced by the size line.
        expected: usize,
    },
    /// There is no header or size line.
    #[error("the file ends before {0}")]
    Missing(LinePart),
    /// There is more than the size line says.
    #[error("there are more than the {expected} entries of the size line")]
    Surplus {
        /// Entries announced by the size line.
        expected: usize,
    },
    /// The matrix is not square.
    #[error("the size is {rows} x {columns}; accepted: a square matrix")]
    NotSquare {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// The matrix is larger than any sector that could be solved.
    #[error("the dimension is {dimension}; accepted: at most {most}")]
    TooLarge {
        /// Dimension found.
        dimension: usize,
        /// Largest dimension accepted.
        most: usize,
    },
    /// A wrong number of values on the line.
    #[error("the line has {found} values; accepted: {expected} ({what})")]
    FieldCount {
        /// Values found.
        found: usize,
        /// Values accepted.
        expected: usize,
        /// What the line holds.
        what: LinePart,
    },
    /// A word that is no whole number.
    #[error("{field} is {found:?}; accepted: a whole number of 0 or more")]
    NotAnInteger {
        /// Name of the field.
        field: &'static str,
        /// Word found.
        found: String,
    },
    /// A word that is no finite number.
    #[error("{field} is {found:?}; accepted: a finite number")]
    NotANumber {
        /// Name of the field.
        field: &'static str,
        /// Word found.
        found: String,
    },
    /// A word outside a closed list.
    #[error("{field} is {found:?}; accepted: {accepted}")]
    NotAWord {
        /// Name of the field.
        field: &'static str,
        /// Word found.
        found: String,
        /// Words accepted.
        accepted: &'static str,
    },
    /// An index that must count up does not.
    #[error("{field} is {found}; accepted: {expected} (rows count up from 0)")]
    OutOfOrder {
        /// Name of the field.
        field: &'static str,
        /// Index found.
        found: usize,
        /// Index accepted.
        expected: usize,
    },
    /// A Matrix Market index outside the matrix.
    #[error("the entry is at ({row}, {column}); accepted: 1 to {dimension}")]
    EntryOutside {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// Dimension of the matrix.
        dimension: usize,
    },
    /// An entry above the diagonal of a `symmetric` file.
    #[error(
        "the entry ({row}, {column}) lies above the diagonal; accepted in a symmetric file: the lower triangle only"
    )]
    AboveDiagonal {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// An entry stands twice.
    #[error(
        "the entry ({row}, {column}) stands on line {first} already; accepted: each entry once"
    )]
    Repeated {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// Line of the first one.
        first: usize,
    },
    /// A `general` matrix is not symmetric.
    #[error(
        "the matrix is not symmetric: entry ({row}, {column}) is {value:e} but ({column}, {row}) is {mirror:e}; accepted: exactly equal values"
    )]
    NotSymmetric {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// Entry (row, column).
        value: f64,
        /// Entry (column, row), 0 if absent.
        mirror: f64,
    },
    /// A `general` matrix of which one triangle is written.
    #[error(
        "{entries} entries stand {side} the diagonal and none on the other side; accepted in a general file: both triangles, else a banner that says symmetric, and the lower triangle (is only one triangle written?)"
    )]
    OneTriangle {
        /// Entries off the diagonal.
        entries: usize,
        /// `above` or `below`.
        side: &'static str,
    },
}

/// A part of a file that a line should hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinePart {
    /// The banner of a Matrix Market file.
    Banner,
    /// The size line of a Matrix Market file.
    Size,
    /// An entry of a Matrix Market file.
    Entry,
    /// The header line of a CSV file with these columns.
    Columns(&'static str),
}

impl std::fmt::Display for LinePart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Banner => f.write_str("its banner"),
            Self::Size => f.write_str("rows columns entries"),
            Self::Entry => f.write_str("row column value"),
            Self::Columns(columns) => write!(f, "columns {columns}"),
        }
    }
}
