//! `tail_fits.parquet`: percentiles of fitted laws beside those of the sample.

use std::path::Path;

use serde::Serialize;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::percentiles::{QUANTITY, scenario_keys};
use super::writer::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::{Estimate, Quantity, TailFit, TailParameters, TailPercentile};

use ColumnKind::{Boolean, Float64, Int32, String as Text};

/// The two laws fitted to one quantity of one scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct TailFitRecord {
    /// Keys.
    pub scenario: Scenario,
    /// Quantity.
    pub quantity: Quantity,
    /// The fits.
    pub fits: [TailFit; 2],
}

impl Serialize for TailFitRecord {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let scenario = &self.scenario;
        let named = usize::from(scenario.load_case.is_some());
        let mut fields = serializer.serialize_struct("TailFitRecord", 7 + named)?;
        fields.serialize_field("scenario", &scenario.index)?;
        match &scenario.load_case {
            Some(name) => fields.serialize_field("load_case", name)?,
            None => fields.skip_field("load_case")?,
        }
        fields.serialize_field("engine_order", &scenario.engine_order)?;
        fields.serialize_field("standard_deviation", &scenario.standard_deviation)?;
        fields.serialize_field("contact", scenario.contact.name())?;
        fields.serialize_field("normal_load_n", &scenario.contact.normal_load_n())?;
        fields.serialize_field("quantity", &self.quantity)?;
        fields.serialize_field("fits", &self.fits)?;
        fields.end()
    }
}

const fn number(name: &'static str, description: &'static str) -> ColumnSpec {
    ColumnSpec::new(name, Float64, "", description)
}

/// Columns of `tail_fits.parquet`.
pub const TAIL_FIT_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    QUANTITY,
    ColumnSpec::new(
        "law",
        Text,
        "",
        "weibull_bounded_above or generalised_extreme_value",
    ),
    ColumnSpec::new("fit_status", Text, "", "How the fit ended"),
    ColumnSpec::new("percent", Float64, "%", "The percentile"),
    number(
        "value",
        "Order statistic of the sample; null = not estimable",
    ),
    number("lower", "Lower 95 % bound of the sample, distribution-free"),
    number("upper", "Upper 95 % bound of the sample, distribution-free"),
    number("model_value", "Percentile of the fitted law"),
    number("model_lower", "Lower 95 % bound, parametric bootstrap"),
    number("model_upper", "Upper 95 % bound, parametric bootstrap"),
    ColumnSpec::new(
        "outside_interval",
        Boolean,
        "",
        "The fitted percentile lies outside of the bounds of the sample",
    ),
    ColumnSpec::new(
        "extrapolates",
        Boolean,
        "",
        "The percentile lies beyond 1 - 1/n of the sample",
    ),
    number("location", "Location mu of the generalised law"),
    number("location_lower", "Lower 95 % bound of the location"),
    number("location_upper", "Upper 95 % bound of the location"),
    number(
        "scale",
        "Scale sigma of the generalised law, delta of the Weibull law",
    ),
    number("scale_lower", "Lower 95 % bound of the scale"),
    number("scale_upper", "Upper 95 % bound of the scale"),
    number(
        "shape",
        "Shape xi of the generalised law, beta of the Weibull law",
    ),
    number("shape_lower", "Lower 95 % bound of the shape"),
    number("shape_upper", "Upper 95 % bound of the shape"),
    number("upper_end", "Upper end lambda of the law; null = unbounded"),
    number("upper_end_lower", "Lower 95 % bound of the upper end"),
    number("upper_end_upper", "Upper 95 % bound of the upper end"),
    ColumnSpec::new(
        "anderson_darling",
        Float64,
        "1",
        "Anderson-Darling distance",
    ),
    ColumnSpec::new(
        "p_value",
        Float64,
        "1",
        "Probability of a larger distance if the law were right, parametric bootstrap",
    ),
    ColumnSpec::new("resamples", Int32, "1", "Resamples behind it"),
    ColumnSpec::new("failed_resamples", Int32, "1", "Resamples without a fit"),
    ColumnSpec::new("few_values", Boolean, "", "Fewer than 50 values"),
    ColumnSpec::new("rejected", Boolean, "", "p_value below 0.05"),
    ColumnSpec::new(
        "failures_left_out",
        Int32,
        "1",
        "Failed rows that the fit knows nothing of",
    ),
];

/// Writes `tail_fits.parquet`, ordered by scenario, quantity, law, percentile.
///
/// # Errors
/// The file cannot be written.
pub fn write_tail_fits(
    path: &Path,
    records: &[TailFitRecord],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut rows: Vec<(&TailFitRecord, &TailFit, &TailPercentile)> = Vec::new();
    for record in records {
        for fit in &record.fits {
            rows.extend(fit.percentiles.iter().map(|p| (record, fit, p)));
        }
    }
    let floats = |value: &dyn Fn(&TailFit, &TailPercentile) -> Option<f64>| {
        Values::Float64(rows.iter().map(|(_, fit, p)| value(fit, p)).collect())
    };
    let flags = |value: &dyn Fn(&TailFit, &TailPercentile) -> bool| {
        Values::Boolean(rows.iter().map(|(_, fit, p)| Some(value(fit, p))).collect())
    };
    let counts = |value: &dyn Fn(&TailFit) -> u64| {
        let counts = rows.iter().map(|(_, fit, _)| Some(value(fit) as i32));
        Values::Int32(counts.collect())
    };
    let names = |value: &dyn Fn(&TailFitRecord, &TailFit) -> &'static str| {
        let names = rows.iter().map(|(record, fit, _)| value(record, fit));
        Values::String(names.map(|name| Some(name.to_owned())).collect())
    };
    let mut values = scenario_keys(rows.iter().map(|(record, ..)| &record.scenario));
    values.push(names(&|record, _| record.quantity.name()));
    values.push(names(&|_, fit| fit.law.name()));
    values.push(names(&|_, fit| fit.status.name()));
    values.push(floats(&|_, p| Some(p.percent)));
    values.push(floats(&|_, p| p.empirical.value));
    values.push(floats(&|_, p| p.empirical.lower));
    values.push(floats(&|_, p| p.empirical.upper));
    values.push(floats(&|_, p| Some(p.model?.value)));
    values.push(floats(&|_, p| p.model?.lower));
    values.push(floats(&|_, p| p.model?.upper));
    values.push(flags(&|_, p| p.outside_interval));
    values.push(flags(&|_, p| p.extrapolates));
    let parameters: [fn(&TailParameters) -> Option<Estimate>; 4] = [
        |parameters| parameters.location,
        |parameters| Some(parameters.scale),
        |parameters| Some(parameters.shape),
        |parameters| parameters.upper_end,
    ];
    for parameter in parameters {
        let of = |fit: &TailFit| parameter(fit.parameters.as_ref()?);
        values.push(floats(&|fit, _| Some(of(fit)?.value)));
        values.push(floats(&|fit, _| of(fit)?.lower));
        values.push(floats(&|fit, _| of(fit)?.upper));
    }
    values.push(floats(&|fit, _| fit.anderson_darling));
    values.push(floats(&|fit, _| fit.p_value));
    values.push(counts(&|fit| u64::from(fit.resamples)));
    values.push(counts(&|fit| u64::from(fit.failed_resamples)));
    values.push(flags(&|fit, _| fit.few_values));
    values.push(flags(&|fit, _| fit.rejected));
    values.push(counts(&|fit| fit.failures_left_out));
    let mut writer = TableWriter::create(path, TAIL_FIT_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}
