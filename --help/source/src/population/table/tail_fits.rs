//! `tail_fits.parquet`: percentiles of fitted laws beside those of the sample.

use std::path::Path;

use serde::Serialize;

use super::column::{Cells, Column, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::percentiles::QUANTITY;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::{Estimate, Quantity, TailFit, TailPercentile};

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

/// A column in the unit of the quantity.
const fn number<Row>(
    name: &'static str,
    description: &'static str,
    value: fn(&Row) -> Option<f64>,
) -> Column<Row> {
    Column::new(name, "", description, Cells::float64(value))
}

/// A percentile of a fit.
struct TailFitRow<'a> {
    record: &'a TailFitRecord,
    fit: &'a TailFit,
    at: &'a TailPercentile,
}

impl InScenario for TailFitRow<'_> {
    fn scenario(&self) -> &Scenario {
        &self.record.scenario
    }
}

impl<'a> TailFitRow<'a> {
    fn location(&self) -> Option<Estimate> {
        self.fit.parameters.as_ref()?.location
    }

    fn scale(&self) -> Option<Estimate> {
        Some(self.fit.parameters.as_ref()?.scale)
    }

    fn shape(&self) -> Option<Estimate> {
        Some(self.fit.parameters.as_ref()?.shape)
    }

    fn upper_end(&self) -> Option<Estimate> {
        self.fit.parameters.as_ref()?.upper_end
    }

    const COLUMNS: &'a [Column<Self>] = &[
        key::scenario(),
        key::contact(),
        key::engine_order(),
        key::normal_load_n(),
        key::standard_deviation(),
        Column::shared(
            QUANTITY,
            Cells::string(|r| Some(r.record.quantity.name().to_owned())),
        ),
        Column::new(
            "law",
            "",
            "weibull_bounded_above or generalised_extreme_value",
            Cells::string(|r| Some(r.fit.law.name().to_owned())),
        ),
        Column::new(
            "fit_status",
            "",
            "How the fit ended",
            Cells::string(|r| Some(r.fit.status.name().to_owned())),
        ),
        Column::new(
            "percent",
            "%",
            "The percentile",
            Cells::float64(|r| Some(r.at.percent)),
        ),
        number(
            "value",
            "Order statistic of the sample; null = not estimable",
            |r| r.at.empirical.value,
        ),
        number(
            "lower",
            "Lower 95 % bound of the sample, distribution-free",
            |r| r.at.empirical.lower,
        ),
        number(
            "upper",
            "Upper 95 % bound of the sample, distribution-free",
            |r| r.at.empirical.upper,
        ),
        number("model_value", "Percentile of the fitted law", |r| {
            Some(r.at.model?.value)
        }),
        number(
            "model_lower",
            "Lower 95 % bound, parametric bootstrap",
            |r| r.at.model?.lower,
        ),
        number(
            "model_upper",
            "Upper 95 % bound, parametric bootstrap",
            |r| r.at.model?.upper,
        ),
        Column::new(
            "outside_interval",
            "",
            "The fitted percentile lies outside of the bounds of the sample",
            Cells::boolean(|r| Some(r.at.outside_interval)),
        ),
        Column::new(
            "extrapolates",
            "",
            "The percentile lies beyond 1 - 1/n of the sample",
            Cells::boolean(|r| Some(r.at.extrapolates)),
        ),
        number("location", "Location mu of the generalised law", |r| {
            Some(r.location()?.value)
        }),
        number("location_lower", "Lower 95 % bound of the location", |r| {
            r.location()?.lower
        }),
        number("location_upper", "Upper 95 % bound of the location", |r| {
            r.location()?.upper
        }),
        number(
            "scale",
            "Scale sigma of the generalised law, delta of the Weibull law",
            |r| Some(r.scale()?.value),
        ),
        number("scale_lower", "Lower 95 % bound of the scale", |r| {
            r.scale()?.lower
        }),
        number("scale_upper", "Upper 95 % bound of the scale", |r| {
            r.scale()?.upper
        }),
        number(
            "shape",
            "Shape xi of the generalised law, beta of the Weibull law",
            |r| Some(r.shape()?.value),
        ),
        number("shape_lower", "Lower 95 % bound of the shape", |r| {
            r.shape()?.lower
        }),
        number("shape_upper", "Upper 95 % bound of the shape", |r| {
            r.shape()?.upper
        }),
        number(
            "upper_end",
            "Upper end lambda of the law; null = unbounded",
            |r| Some(r.upper_end()?.value),
        ),
        number(
            "upper_end_lower",
            "Lower 95 % bound of the upper end",
            |r| r.upper_end()?.lower,
        ),
        number(
            "upper_end_upper",
            "Upper 95 % bound of the upper end",
            |r| r.upper_end()?.upper,
        ),
        Column::new(
            "anderson_darling",
            "1",
            "Anderson-Darling distance",
            Cells::float64(|r| r.fit.anderson_darling),
        ),
        Column::new(
            "p_value",
            "1",
            "Probability of a larger distance if the law were right, parametric bootstrap",
            Cells::float64(|r| r.fit.p_value),
        ),
        Column::new(
            "resamples",
            "1",
            "Resamples behind it",
            Cells::int32(|r| Some(r.fit.resamples)),
        ),
        Column::new(
            "failed_resamples",
            "1",
            "Resamples without a fit",
            Cells::int32(|r| Some(r.fit.failed_resamples)),
        ),
        Column::new(
            "few_values",
            "",
            "Fewer than 50 values",
            Cells::boolean(|r| Some(r.fit.few_values)),
        ),
        Column::new(
            "rejected",
            "",
            "p_value below 0.05",
            Cells::boolean(|r| Some(r.fit.rejected)),
        ),
        Column::new(
            "failures_left_out",
            "1",
            "Failed rows that the fit knows nothing of",
            Cells::int32(|r| Some(r.fit.failures_left_out as u32)),
        ),
    ];
}

/// Columns of `tail_fits.parquet`.
pub const TAIL_FIT_COLUMNS: &[ColumnSpec] =
    &specs::<_, _, { TailFitRow::COLUMNS.len() }>(TailFitRow::COLUMNS);

/// Writes `tail_fits.parquet`, ordered by scenario, quantity, law, percentile.
///
/// # Errors
/// The file cannot be written.
pub fn write_tail_fits(
    path: &Path,
    records: &[TailFitRecord],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut rows = Vec::new();
    for record in records {
        for fit in &record.fits {
            let percentiles = fit.percentiles.iter();
            rows.extend(percentiles.map(|at| TailFitRow { record, fit, at }));
        }
    }
    let mut writer = TableWriter::create(path, TAIL_FIT_COLUMNS, header)?;
    writer.write(values_of(TailFitRow::COLUMNS, &rows))?;
    writer.finish()
}
