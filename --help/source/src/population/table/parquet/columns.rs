//! Columns and their values as Polars has them.

use polars::prelude::{
    ArrowField, ArrowSchema, Column, CompatLevel, DataFrame, DataType, NamedFrom, Schema, Series,
};

use crate::population::table::column::{ColumnKind, ColumnSpec, Values};

fn column_of(values: Values, name: &str) -> Column {
    let series = match values {
        Values::Int32(values) => Series::new(name.into(), values),
        Values::Int64(values) => Series::new(name.into(), values),
        Values::Float64(values) => Series::new(name.into(), values),
        Values::Boolean(values) => Series::new(name.into(), values),
        Values::String(values) => Series::new(name.into(), values),
    };
    series.into()
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
    let columns: Vec<_> = columns
        .iter()
        .zip(values)
        .map(|(column, values)| column_of(values, column.name))
        .collect();
    DataFrame::new(height, columns).map_err(|error| error.to_string())
}
