//! A table of a results folder in memory, which other libraries read by the Arrow `PyCapsule` interface.

use std::collections::BTreeMap;
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use blisk::population::table::TableError;
use polars::prelude::{CompatLevel, ParquetReader, PolarsError, SerReader};
use polars_arrow::array::{
    Array, BooleanArray, Float64Array, Int32Array, Int64Array, StructArray, Utf8Array,
};
use polars_arrow::datatypes::{ArrowDataType, Field, Metadata};
use polars_arrow::ffi::{ArrowArrayStream, ArrowSchema, export_field_to_c, export_iterator};
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};

/// A table: named columns of the same length, with units.
///
/// Libraries take it as it is: `polars.DataFrame(responses)`, `pyarrow.table(responses)`,
/// `pandas.DataFrame.from_arrow(responses)`,
/// `duckdb.sql("from responses")`. No value is copied that they can share.
#[pyclass(frozen, module = "blisk")]
pub struct Table {
    name: String,
    /// The columns as one structure of Arrow.
    columns: StructArray,
    /// That structure as a field, with the metadata of the file.
    field: Field,
}

impl Table {
    /// Reads the whole file `path`.
    pub fn read(path: &Path) -> Result<Self, TableError> {
        // The decoder panics on some damaged files.
        let read = catch_unwind(AssertUnwindSafe(|| Self::read_unguarded(path)));
        read.unwrap_or_else(|_| Err(damaged(path, "the decoder gave up")))
    }

    fn read_unguarded(path: &Path) -> Result<Self, TableError> {
        let refused = |error: PolarsError| damaged(path, &error.to_string());
        let file = File::open(path).map_err(|source| TableError::Io {
            action: "read",
            path: path.to_owned(),
            source,
        })?;
        let mut reader = ParquetReader::new(file);
        let schema = reader.schema().map_err(refused)?;
        let pairs = reader
            .get_metadata()
            .map_err(refused)?
            .key_value_metadata()
            .clone();
        let frame = reader.set_rechunk(true).finish().map_err(refused)?;
        let (height, mut fields, mut arrays) = (frame.height(), Vec::new(), Vec::new());
        for column in frame.columns() {
            // Types that every reader of Arrow knows: no views of strings.
            let array = column
                .as_materialized_series()
                .to_arrow(0, CompatLevel::oldest());
            let mut field = Field::new(column.name().clone(), array.dtype().clone(), true);
            field.metadata = schema
                .get(column.name())
                .and_then(|own| own.metadata.clone());
            fields.push(field);
            arrays.push(array);
        }
        let kind = ArrowDataType::Struct(fields);
        let columns = StructArray::try_new(kind.clone(), height, arrays, None).map_err(refused)?;
        let own: Metadata = { pairs.into_iter().flatten() }
            .filter(|pair| pair.key.starts_with("blisk."))
            .map(|pair| (pair.key.into(), pair.value.unwrap_or_default().into()))
            .collect();
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let field = Field::new("".into(), kind, false).with_metadata(own);
        Ok(Self {
            name,
            columns,
            field,
        })
    }

    fn fields(&self) -> &[Field] {
        self.columns.fields()
    }

    /// An entry of the metadata of each column that has it.
    fn metadata(&self, key: &str) -> BTreeMap<String, String> {
        let of_field = |field: &Field| {
            let value = field.metadata.as_ref()?.get(key)?;
            Some((field.name.to_string(), value.to_string()))
        };
        self.fields().iter().filter_map(of_field).collect()
    }

    fn stream(&self) -> ArrowArrayStream {
        let batch: Box<dyn Array> = Box::new(self.columns.clone());
        export_iterator(Box::new(std::iter::once(Ok(batch))), self.field.clone())
    }
}

#[pymethods]
impl Table {
    /// Name of the table, like ``responses``.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// Names of the columns, in order.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.fields()
            .iter()
            .map(|field| field.name.to_string())
            .collect()
    }

    /// Unit of each column by its name; ``1`` for pure numbers, nothing for names and flags.
    #[getter]
    fn units(&self) -> BTreeMap<String, String> {
        self.metadata("unit")
    }

    /// What each column holds, by its name.
    #[getter]
    fn descriptions(&self) -> BTreeMap<String, String> {
        self.metadata("description")
    }

    /// Number of rows.
    fn __len__(&self) -> usize {
        self.columns.len()
    }

    fn __repr__(&self) -> String {
        let (rows, columns) = (self.columns.len(), self.fields().len());
        format!(
            "<blisk.Table {}: {rows} rows, {columns} columns>",
            self.name
        )
    }

    /// The values of a column as a list with one entry per row; ``None`` where there is no value.
    fn __getitem__<'py>(&self, py: Python<'py>, column: &str) -> PyResult<Bound<'py, PyList>> {
        let place = { self.fields().iter() }.position(|field| field.name == column);
        match place {
            Some(place) => values(py, self.columns.values()[place].as_ref()),
            None => Err(PyKeyError::new_err(format!(
                "{} has no column {column}; it has: {}",
                self.name,
                self.columns().join(", ")
            ))),
        }
    }

    /// The rows as a list of dictionaries by the names of the columns.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let rows = PyList::empty(py);
        for _ in 0..self.columns.len() {
            rows.append(PyDict::new(py))?;
        }
        for (field, array) in self.fields().iter().zip(self.columns.values()) {
            for (row, value) in rows.iter().zip(values(py, array.as_ref())?) {
                row.set_item(field.name.as_str(), value)?;
            }
        }
        Ok(rows)
    }

    /// The schema by the Arrow `PyCapsule` interface.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema: ArrowSchema = export_field_to_c(&self.field);
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    /// The rows by the Arrow `PyCapsule` interface; no other schema than the own one can be asked for.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The interface lets a producer that cannot cast give what it has.
        let _ = requested_schema;
        PyCapsule::new_with_value(py, self.stream(), c"arrow_array_stream")
    }
}

/// The values of a column of one of the types that tables have.
fn values<'py>(py: Python<'py>, array: &dyn Array) -> PyResult<Bound<'py, PyList>> {
    let array = array.as_any();
    if let Some(numbers) = array.downcast_ref::<Float64Array>() {
        PyList::new(
            py,
            numbers
                .iter()
                .map(Option::<&f64>::cloned)
                .collect::<Vec<_>>(),
        )
    } else if let Some(numbers) = array.downcast_ref::<Int32Array>() {
        PyList::new(
            py,
            numbers
                .iter()
                .map(Option::<&i32>::cloned)
                .collect::<Vec<_>>(),
        )
    } else if let Some(numbers) = array.downcast_ref::<Int64Array>() {
        PyList::new(
            py,
            numbers
                .iter()
                .map(Option::<&i64>::cloned)
                .collect::<Vec<_>>(),
        )
    } else if let Some(flags) = array.downcast_ref::<BooleanArray>() {
        PyList::new(py, flags.iter().collect::<Vec<_>>())
    } else if let Some(texts) = array.downcast_ref::<Utf8Array<i64>>() {
        PyList::new(py, texts.iter().collect::<Vec<_>>())
    } else {
        Err(PyTypeError::new_err(
            "a column of a type that no table of blisk has",
        ))
    }
}

fn damaged(path: &Path, reason: &str) -> TableError {
    TableError::Damaged {
        path: path.to_owned(),
        reason: reason.to_owned(),
    }
}
