//! `main_effects.parquet`: what each random input explains of the variance of the results.

use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::percentiles::{QUANTITY, scenario_keys};
use super::writer::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::population::statistics::{VarianceShare, main_effects};
use crate::response::mistuning::ContactQuantity;

use ColumnKind::{Float64, Int64, String as Text};

/// Columns of `main_effects.parquet`.
pub const MAIN_EFFECT_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    QUANTITY,
    ColumnSpec::new(
        "input",
        Text,
        "",
        "A contact parameter that varies, or rest: the blades, and inputs acting together",
    ),
    ColumnSpec::new(
        "variance_share",
        Float64,
        "1",
        "Share of the variance that the input explains by itself; null for fewer than 100 rows",
    ),
    ColumnSpec::new("lower", Float64, "1", "Lower 95 % bound by jackknife"),
    ColumnSpec::new("upper", Float64, "1", "Upper 95 % bound by jackknife"),
    ColumnSpec::new("rows", Int64, "1", "Rows with a result"),
];

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
    let mut lines: Vec<(&Scenario, &str, &str, Option<VarianceShare>, usize)> = Vec::new();
    let names = || inputs.iter().map(|input| input.name()).chain(["rest"]);
    for (scenario, rows) in scenarios.iter().zip(rows) {
        for (place, quantity) in QUANTITIES.into_iter().enumerate() {
            let (shares, count) = rows.effects(inputs, place);
            let named = names().zip(shares);
            lines.extend(named.map(|(name, share)| (scenario, quantity, name, share, count)));
        }
    }
    let floats = |value: fn(&VarianceShare) -> f64| {
        Values::Float64(
            lines
                .iter()
                .map(|line| line.3.as_ref().map(value))
                .collect(),
        )
    };
    let mut values = scenario_keys(lines.iter().map(|line| line.0));
    values.push(Values::String(
        lines.iter().map(|line| Some(line.1.to_owned())).collect(),
    ));
    values.push(Values::String(
        lines.iter().map(|line| Some(line.2.to_owned())).collect(),
    ));
    values.push(floats(|share| share.share));
    values.push(floats(|share| share.lower));
    values.push(floats(|share| share.upper));
    values.push(Values::Int64(
        lines.iter().map(|line| Some(line.4 as i64)).collect(),
    ));
    let mut writer = TableWriter::create(path, MAIN_EFFECT_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}
