//! Columns of a table: name, type, unit and meaning, and their values in memory.

use polars::prelude::{
    ArrowField, ArrowSchema, Column, CompatLevel, DataFrame, DataType, NamedFrom, Schema, Series,
};

/// Type of a column; the set that pandas, R, `DuckDB` and MATLAB all read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Counts and ids.
    Int32,
    /// Work counts.
    Int64,
    /// Numbers.
    Float64,
    /// Flags.
    Boolean,
    /// Names.
    String,
}

/// One column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ColumnSpec {
    /// Name, with unit.
    pub name: &'static str,
    /// Type.
    pub kind: ColumnKind,
    /// Unit; `1` for a ratio, empty for an id, a name or a flag.
    pub unit: &'static str,
    /// What it holds.
    pub description: &'static str,
}

impl ColumnSpec {
    /// A column; for tables of columns.
    #[must_use]
    pub const fn new(
        name: &'static str,
        kind: ColumnKind,
        unit: &'static str,
        description: &'static str,
    ) -> Self {
        Self {
            name,
            kind,
            unit,
            description,
        }
    }
}

/// Values of a column, in row order; `None` is null.
#[derive(Debug, Clone)]
pub(super) enum Values {
    Int32(Vec<Option<i32>>),
    Int64(Vec<Option<i64>>),
    Float64(Vec<Option<f64>>),
    Boolean(Vec<Option<bool>>),
    String(Vec<Option<String>>),
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Int32(values) => values.len(),
            Self::Int64(values) => values.len(),
            Self::Float64(values) => values.len(),
            Self::Boolean(values) => values.len(),
            Self::String(values) => values.len(),
        }
    }

    fn into_column(self, name: &str) -> Column {
        let series = match self {
            Self::Int32(values) => Series::new(name.into(), values),
            Self::Int64(values) => Series::new(name.into(), values),
            Self::Float64(values) => Series::new(name.into(), values),
            Self::Boolean(values) => Series::new(name.into(), values),
            Self::String(values) => Series::new(name.into(), values),
        };
        series.into()
    }
}

pub(super) fn polars_type(kind: ColumnKind) -> DataType {
    match kind {
        ColumnKind::Int32 => DataType::Int32,
        ColumnKind::Int64 => DataType::Int64,
        ColumnKind::Float64 => DataType::Float64,
        ColumnKind::Boolean => DataType::Boolean,
        ColumnKind::String => DataType::String,
    }
}

pub(super) fn polars_schema(columns: &[ColumnSpec]) -> Schema {
    columns
        .iter()
        .map(|column| (column.name.into(), polars_type(column.kind)))
        .collect()
}

/// The Arrow schema of `columns`, each field with its unit and description.
pub(super) fn described_schema(columns: &[ColumnSpec]) -> ArrowSchema {
    let field = |column: &ColumnSpec| -> ArrowField {
        let metadata = [("unit", column.unit), ("description", column.description)];
        let metadata = metadata.map(|(key, value)| (key.into(), value.into()));
        polars_type(column.kind)
            .to_arrow_field(column.name.into(), CompatLevel::newest())
            .with_metadata(metadata.into_iter().collect())
    };
    columns.iter().map(field).collect()
}

/// The frame of `values`, one per column; the reason if they do not fit together.
pub(super) fn frame(columns: &[ColumnSpec], values: Vec<Values>) -> Result<DataFrame, String> {
    let height = values.first().map_or(0, Values::len);
    let columns: Vec<Column> = columns
        .iter()
        .zip(values)
        .map(|(column, values)| values.into_column(column.name))
        .collect();
    DataFrame::new(height, columns).map_err(|error| error.to_string())
}

/// Columns that name a row in every table that has it.
pub(super) mod key {
    use super::{ColumnKind, ColumnSpec};
    use ColumnKind::{Float64, Int32, String as Text};

    pub(in super::super) const SCENARIO: ColumnSpec = ColumnSpec::new(
        "scenario",
        Int32,
        "",
        "Index in the order engine order, standard deviation, normal load of this study",
    );
    /// Only in the tables of studies with load cases.
    pub(in super::super) const LOAD_CASE: ColumnSpec = ColumnSpec::new(
        "load_case",
        Text,
        "",
        "Load case: force vector of the excitation",
    );
    pub(in super::super) const CONTACT: ColumnSpec = ColumnSpec::new(
        "contact",
        Text,
        "",
        "full: friction under the normal load; or the linear limit stuck, slide or free",
    );
    pub(in super::super) const ENGINE_ORDER: ColumnSpec =
        ColumnSpec::new("engine_order", Int32, "1", "Engine order of the excitation");
    pub(in super::super) const NORMAL_LOAD: ColumnSpec = ColumnSpec::new(
        "normal_load_n",
        Float64,
        "N",
        "Damper normal load per sector; null for the linear limits",
    );
    pub(in super::super) const STANDARD_DEVIATION: ColumnSpec = ColumnSpec::new(
        "standard_deviation",
        Float64,
        "1",
        "Standard deviation of the blades' relative stiffness deviation, after truncation; null for patterns from a file",
    );
    pub(in super::super) const PATTERN: ColumnSpec =
        ColumnSpec::new("pattern", Int32, "", "Pattern id");
}
