//! `main_effects.parquet`: what each random input explains of the variance of the results.

use std::path::Path;

use super::column::{Cells, Column, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::percentiles::QUANTITY;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::population::statistics::{VarianceShare, main_effects};
use crate::response::mistuning::ContactQuantity;

/// The effect of an input on a quantity of a scenario.
struct EffectRow<'a> {
    scenario: &'a Scenario,
    quantity: &'static str,
    input: &'a str,
    share: Option<VarianceShare>,
    rows: usize,
}

impl InScenario for EffectRow<'_> {
    fn scenario(&self) -> &Scenario {
        self.scenario
    }
}

impl<'a> EffectRow<'a> {
    const COLUMNS: &'a [Column<Self>] = &[
        key::scenario(),
        key::contact(),
        key::engine_order(),
        key::normal_load_n(),
        key::standard_deviation(),
        Column::shared(QUANTITY, Cells::string(|r| Some(r.quantity.to_owned()))),
        Column::new(
            "input",
            "",
            "A contact parameter that varies, or rest: the blades, and inputs acting together",
            Cells::string(|r| Some(r.input.to_owned())),
        ),
        Column::new(
            "variance_share",
            "1",
            "Share of the variance that the input explains by itself; null for fewer than 100 rows",
            Cells::float64(|r| Some(r.share.as_ref()?.share)),
        ),
        Column::new(
            "lower",
            "1",
            "Lower 95 % bound by jackknife",
            Cells::float64(|r| Some(r.share.as_ref()?.lower)),
        ),
        Column::new(
            "upper",
            "1",
            "Upper 95 % bound by jackknife",
            Cells::float64(|r| Some(r.share.as_ref()?.upper)),
        ),
        Column::new(
            "rows",
            "1",
            "Rows with a result",
            Cells::int64(|r| Some(r.rows as u64)),
        ),
    ];
}

/// Columns of `main_effects.parquet`.
pub const MAIN_EFFECT_COLUMNS: &[ColumnSpec] =
    &specs::<_, _, { EffectRow::COLUMNS.len() }>(EffectRow::COLUMNS);

const QUANTITIES: [&str; 2] = ["amplification_factor", "peak_amplitude_m"];

/// Inputs and results of the rows of one scenario.
#[derive(Debug, Clone, Default)]
pub struct EffectRows {
    factors: [Vec<f64>; 4],
    results: [Vec<Option<f64>>; 2],
}

impl EffectRows {
    /// Takes a row in; one with nominal contact has no inputs.
    pub fn add(&mut self, row: &ResponseRow) {
        let Some(factors) = &row.contact_factors else {
            return;
        };
        for (column, quantity) in self.factors.iter_mut().zip(ContactQuantity::ALL) {
            column.push(quantity.of(factors));
        }
        self.results[0].push(row.amplification_factor);
        self.results[1].push(row.peak_amplitude_m);
    }

    /// Effects of the given inputs and of the rest on one result, and the rows behind them.
    fn effects(
        &self,
        inputs: &[ContactQuantity],
        result: usize,
    ) -> (Vec<Option<VarianceShare>>, usize) {
        let good: Vec<(usize, f64)> = self.results[result]
            .iter()
            .enumerate()
            .filter_map(|(row, value)| Some((row, (*value)?)))
            .collect();
        let columns: Vec<Vec<f64>> = inputs
            .iter()
            .map(|&input| {
                good.iter()
                    .map(|&(row, _)| self.factors[input as usize][row])
                    .collect()
            })
            .collect();
        let values: Vec<f64> = good.iter().map(|&(_, value)| value).collect();
        let shares = match main_effects(&columns, &values) {
            Some(found) => found
                .inputs
                .into_iter()
                .chain([found.rest])
                .map(Some)
                .collect(),
            None => vec![None; inputs.len() + 1],
        };
        (shares, good.len())
    }
}

/// Writes `main_effects.parquet`, ordered by scenario, quantity, input; `inputs` are those that vary.
///
/// # Errors
/// The file cannot be written.
pub fn write_main_effects(
    path: &Path,
    scenarios: &[Scenario],
    rows: &[EffectRows],
    inputs: &[ContactQuantity],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut lines = Vec::new();
    let names = || inputs.iter().map(|input| input.name()).chain(["rest"]);
    for (scenario, rows) in scenarios.iter().zip(rows) {
        for (place, quantity) in QUANTITIES.into_iter().enumerate() {
            let (shares, count) = rows.effects(inputs, place);
            let named = names().zip(shares);
            lines.extend(named.map(|(input, share)| EffectRow {
                scenario,
                quantity,
                input,
                share,
                rows: count,
            }));
        }
    }
    let mut writer = TableWriter::create(path, MAIN_EFFECT_COLUMNS, header)?;
    writer.write(values_of(EffectRow::COLUMNS, &lines))?;
    writer.finish()
}
