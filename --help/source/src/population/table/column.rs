//! Columns of a table, each declared once: name, type, unit, meaning, value in a row, way back into a row.

use crate::population::monte_carlo::Scenario;

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

/// A column of a table of `Row`s; `Back` is what its rows are read back into, nothing for a table that is only written.
pub(super) struct Column<Row, Back = ()> {
    pub(super) spec: ColumnSpec,
    pub(super) cells: Cells<Row, Back>,
}

/// The cells of a column by their type, which is one of [`ColumnKind`].
pub(super) enum Cells<Row, Back> {
    Int32(Access<Row, Back, u32>),
    Int64(Access<Row, Back, u64>),
    Float64(Access<Row, Back, f64>),
    Boolean(Access<Row, Back, bool>),
    String(Access<Row, Back, String>),
}

/// Sets the value of a cell in a row that is read back; none where the row can have no such value.
pub(super) type ReadBack<Back, T> = fn(&mut Back, Option<T>) -> Option<()>;

/// The way of a cell into the table and back.
pub(super) struct Access<Row, Back, T> {
    /// Value of a row; none is null.
    pub(super) value: fn(&Row) -> Option<T>,
    /// The way back; none where the column is only written.
    pub(super) read: Option<ReadBack<Back, T>>,
}

impl<Row, Back> Column<Row, Back> {
    /// A column called `name` that is only written.
    pub(super) const fn new(
        name: &'static str,
        unit: &'static str,
        description: &'static str,
        cells: Cells<Row, Back>,
    ) -> Self {
        let kind = cells.kind();
        let spec = ColumnSpec::new(name, kind, unit, description);
        Self { spec, cells }
    }

    /// The column `spec`, which other tables have too.
    pub(super) const fn shared(spec: ColumnSpec, cells: Cells<Row, Back>) -> Self {
        Self::new(spec.name, spec.unit, spec.description, cells)
    }
}

impl<Row, Back> Cells<Row, Back> {
    const fn kind(&self) -> ColumnKind {
        match self {
            Self::Int32(_) => ColumnKind::Int32,
            Self::Int64(_) => ColumnKind::Int64,
            Self::Float64(_) => ColumnKind::Float64,
            Self::Boolean(_) => ColumnKind::Boolean,
            Self::String(_) => ColumnKind::String,
        }
    }

    pub(super) const fn int32(value: fn(&Row) -> Option<u32>) -> Self {
        Self::Int32(Access { value, read: None })
    }

    pub(super) const fn int64(value: fn(&Row) -> Option<u64>) -> Self {
        Self::Int64(Access { value, read: None })
    }

    pub(super) const fn float64(value: fn(&Row) -> Option<f64>) -> Self {
        Self::Float64(Access { value, read: None })
    }

    pub(super) const fn boolean(value: fn(&Row) -> Option<bool>) -> Self {
        Self::Boolean(Access { value, read: None })
    }

    pub(super) const fn string(value: fn(&Row) -> Option<String>) -> Self {
        Self::String(Access { value, read: None })
    }

    fn values(&self, rows: &[Row]) -> Values {
        match self {
            Self::Int32(access) => {
                Values::Int32(access.of(rows).map(|cell| cell.map(|n| n as i32)).collect())
            }
            Self::Int64(access) => {
                Values::Int64(access.of(rows).map(|cell| cell.map(|n| n as i64)).collect())
            }
            Self::Float64(access) => Values::Float64(access.of(rows).collect()),
            Self::Boolean(access) => Values::Boolean(access.of(rows).collect()),
            Self::String(access) => Values::String(access.of(rows).collect()),
        }
    }
}

impl<Row, Back, T> Access<Row, Back, T> {
    fn of(&self, rows: &[Row]) -> impl Iterator<Item = Option<T>> {
        rows.iter().map(self.value)
    }

    /// The first row that cannot have its cell, if there is one.
    pub(super) fn set(
        &self,
        cells: impl IntoIterator<Item = Option<T>>,
        rows: &mut [Back],
    ) -> Option<usize> {
        let read = self.read?;
        let mut pairs = rows.iter_mut().zip(cells);
        pairs.position(|(row, cell)| read(row, cell).is_none())
    }
}

/// Name, type, unit and meaning of each of `columns`, whose number is `N`.
pub(super) const fn specs<Row, Back, const N: usize>(
    columns: &[Column<Row, Back>],
) -> [ColumnSpec; N] {
    let mut specs = [ColumnSpec::new("", ColumnKind::Int32, "", ""); N];
    let mut place = 0;
    while place < N {
        specs[place] = columns[place].spec;
        place += 1;
    }
    specs
}

/// Values of `columns` in `rows`.
pub(super) fn values_of<Row, Back>(columns: &[Column<Row, Back>], rows: &[Row]) -> Vec<Values> {
    columns
        .iter()
        .map(|column| column.cells.values(rows))
        .collect()
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
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Int32(values) => values.len(),
            Self::Int64(values) => values.len(),
            Self::Float64(values) => values.len(),
            Self::Boolean(values) => values.len(),
            Self::String(values) => values.len(),
        }
    }
}

/// Columns that name a row in every table that has it.
pub(super) mod key {
    use super::{Cells, Column, ColumnKind, ColumnSpec, InScenario};
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

    pub(in super::super) const fn scenario<Row: InScenario, Back>() -> Column<Row, Back> {
        let cells = Cells::int32(|row: &Row| Some(row.scenario().index as u32));
        Column::shared(SCENARIO, cells)
    }

    pub(in super::super) const fn contact<Row: InScenario, Back>() -> Column<Row, Back> {
        let cells = Cells::string(|row: &Row| Some(row.scenario().contact.name().to_owned()));
        Column::shared(CONTACT, cells)
    }

    pub(in super::super) const fn engine_order<Row: InScenario, Back>() -> Column<Row, Back> {
        let cells = Cells::int32(|row: &Row| Some(row.scenario().engine_order));
        Column::shared(ENGINE_ORDER, cells)
    }

    pub(in super::super) const fn normal_load_n<Row: InScenario, Back>() -> Column<Row, Back> {
        let cells = Cells::float64(|row: &Row| row.scenario().contact.normal_load_n());
        Column::shared(NORMAL_LOAD, cells)
    }

    pub(in super::super) const fn standard_deviation<Row: InScenario, Back>() -> Column<Row, Back> {
        let cells = Cells::float64(|row: &Row| row.scenario().standard_deviation);
        Column::shared(STANDARD_DEVIATION, cells)
    }
}

/// A row of a table by scenarios; it has the columns of [`key`].
pub(super) trait InScenario {
    /// The scenario that it belongs to.
    fn scenario(&self) -> &Scenario;
}
