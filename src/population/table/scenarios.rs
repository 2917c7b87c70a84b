//! `scenarios.parquet`: one row of statistics per scenario.

use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::parquet::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{Scenario, TunedReference};
use crate::population::statistics::{
    PERCENTILES, SampleStatistics, ScenarioStability, ScenarioStatistics,
};

use ColumnKind::{Boolean, Float64, Int32, String as Text};

/// A scenario with its tuned reference and its statistics.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenarioRecord {
    /// Keys.
    pub scenario: Scenario,
    /// Tuned peak.
    pub tuned: TunedReference,
    /// Statistics over the patterns.
    pub statistics: ScenarioStatistics,
    /// What is known of the stability of its motions; none where none was looked at.
    pub stability: Option<ScenarioStability>,
}

/// Columns of `scenarios.parquet`.
pub const SCENARIO_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    ColumnSpec::new(
        "tuned_amplitude_m",
        Float64,
        "m",
        "Peak amplitude of the tuned wheel",
    ),
    ColumnSpec::new(
        "tuned_frequency_hz",
        Float64,
        "Hz",
        "Frequency of the tuned peak",
    ),
    ColumnSpec::new("tuned_status", Text, "", "How the tuned solution ended"),
    ColumnSpec::new("planned", Int32, "1", "Patterns of the study"),
    ColumnSpec::new("ok", Int32, "1", "Patterns with a result"),
    ColumnSpec::new(
        "failed",
        Int32,
        "1",
        "Patterns without a result; planned = ok + failed",
    ),
    ColumnSpec::new(
        "amplification_factor_mean",
        Float64,
        "1",
        "Mean over the patterns with a result",
    ),
    ColumnSpec::new(
        "amplification_factor_standard_deviation",
        Float64,
        "1",
        "Standard deviation over the patterns with a result",
    ),
    ColumnSpec::new(
        "amplification_factor_p5",
        Float64,
        "1",
        "5th percentile, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "amplification_factor_p5_lower",
        Float64,
        "1",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p5_upper",
        Float64,
        "1",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p50",
        Float64,
        "1",
        "Median, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "amplification_factor_p50_lower",
        Float64,
        "1",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p50_upper",
        Float64,
        "1",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p95",
        Float64,
        "1",
        "95th percentile, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "amplification_factor_p95_lower",
        Float64,
        "1",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p95_upper",
        Float64,
        "1",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p99",
        Float64,
        "1",
        "99th percentile, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "amplification_factor_p99_lower",
        Float64,
        "1",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "amplification_factor_p99_upper",
        Float64,
        "1",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_mean",
        Float64,
        "m",
        "Mean over the patterns with a result",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_standard_deviation",
        Float64,
        "m",
        "Standard deviation over the patterns with a result",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p5",
        Float64,
        "m",
        "5th percentile, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p5_lower",
        Float64,
        "m",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p5_upper",
        Float64,
        "m",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p50",
        Float64,
        "m",
        "Median, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p50_lower",
        Float64,
        "m",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p50_upper",
        Float64,
        "m",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p95",
        Float64,
        "m",
        "95th percentile, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p95_lower",
        Float64,
        "m",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p95_upper",
        Float64,
        "m",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p99",
        Float64,
        "m",
        "99th percentile, order statistic; null = not estimable",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p99_lower",
        Float64,
        "m",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "peak_amplitude_m_p99_upper",
        Float64,
        "m",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "harmonics",
        Text,
        "",
        "Temporal harmonics of the tuned wheel and the patterns, for instance 1-3",
    ),
    ColumnSpec::new(
        "tuned_sampling_error",
        Float64,
        "1",
        "Relative change of the tuned peak by finer sampling of a period",
    ),
    ColumnSpec::new(
        "tuned_harmonic_error",
        Float64,
        "1",
        "Relative change of the tuned peak by the harmonics outside of the set: up to 15, or 25 where it has all of those",
    ),
    ColumnSpec::new(
        "tuned_stable",
        Boolean,
        "",
        "Small disturbances of the motion at the tuned peak die out; null where that was not looked at, see output.stability, or is not settled",
    ),
    ColumnSpec::new(
        "unstable_rows",
        Int32,
        "1",
        "Rows that were looked at and whose motion is unstable; null where none was looked at",
    ),
    ColumnSpec::new(
        "largest_stated_error",
        Float64,
        "1",
        "Largest stated error of a pattern with a result",
    ),
    ColumnSpec::new(
        "beyond_tolerance",
        Int32,
        "",
        "Patterns whose sampling or harmonic error exceeds its tolerance",
    ),
    ColumnSpec::new(
        "speed_rpm",
        Float64,
        "1/min",
        "Speed that makes the normal load; null for a load in newtons",
    ),
    ColumnSpec::new(
        "tuned_stress_pa",
        Float64,
        "Pa",
        "Peak amplitude of the tuned wheel as stress; null without a stress scale",
    ),
    ColumnSpec::new(
        "peak_stress_pa_p50",
        Float64,
        "Pa",
        "Median of the peak amplitude as stress; null = not estimable, or no stress scale",
    ),
    ColumnSpec::new(
        "peak_stress_pa_p95",
        Float64,
        "Pa",
        "95th percentile of the peak amplitude as stress; null = not estimable, or no stress scale",
    ),
    ColumnSpec::new(
        "peak_stress_pa_p99",
        Float64,
        "Pa",
        "99th percentile of the peak amplitude as stress; null = not estimable, or no stress scale",
    ),
];

/// What the study adds to the scenarios.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ScenarioExtras {
    /// Speed of each scenario whose normal load is by rotation, revolutions per minute; empty: none is.
    pub speeds_rpm: Vec<Option<f64>>,
    /// Stress per amplitude, Pa/m.
    pub stress_pa_per_m: Option<f64>,
}

/// Writes `scenarios.parquet`.
///
/// # Errors
/// The file cannot be written.
pub fn write_scenarios(
    path: &Path,
    records: &[ScenarioRecord],
    extras: &ScenarioExtras,
    header: &TableHeader,
) -> Result<(), TableError> {
    let ids = |value: &dyn Fn(&ScenarioRecord) -> u64| {
        Values::Int32(
            records
                .iter()
                .map(|record| Some(value(record) as i32))
                .collect(),
        )
    };
    let floats = |value: &dyn Fn(&ScenarioRecord) -> Option<f64>| {
        Values::Float64(records.iter().map(value).collect())
    };
    let names = |value: &dyn Fn(&ScenarioRecord) -> &'static str| {
        Values::String(
            records
                .iter()
                .map(|record| Some(value(record).to_owned()))
                .collect(),
        )
    };
    let mut values = vec![
        ids(&|record| record.scenario.index as u64),
        names(&|record| record.scenario.contact.name()),
        ids(&|record| u64::from(record.scenario.engine_order)),
        floats(&|record| record.scenario.contact.normal_load_n()),
        floats(&|record| record.scenario.standard_deviation),
        floats(&|record| record.tuned.amplitude_m),
        floats(&|record| record.tuned.frequency_hz),
        names(&|record| record.tuned.status.name()),
        ids(&|record| record.statistics.accounting.planned()),
        ids(&|record| record.statistics.accounting.ok()),
        ids(&|record| record.statistics.accounting.failed()),
    ];
    let quantities: [fn(&ScenarioRecord) -> &SampleStatistics; 2] = [
        |record| &record.statistics.amplification_factor,
        |record| &record.statistics.peak_amplitude_m,
    ];
    for quantity in quantities {
        values.push(floats(&|record| quantity(record).mean));
        values.push(floats(&|record| quantity(record).standard_deviation));
        for percent in PERCENTILES {
            let of = |record: &ScenarioRecord| quantity(record).percentile(percent).copied();
            values.push(floats(&|record| of(record)?.value));
            values.push(floats(&|record| of(record)?.lower));
            values.push(floats(&|record| of(record)?.upper));
        }
    }
    values.push(Values::String(
        records
            .iter()
            .map(|record| Some(record.tuned.harmonics.clone()))
            .collect(),
    ));
    values.push(floats(&|record| {
        record.tuned.errors.map(|errors| errors.sampling)
    }));
    values.push(floats(&|record| {
        record.tuned.errors.map(|errors| errors.harmonics)
    }));
    let stability = || records.iter().map(|record| record.stability);
    values.push(Values::Boolean(
        stability().map(|found| found?.tuned).collect(),
    ));
    let unstable = stability().map(|found| Some(found?.unstable as i32));
    values.push(Values::Int32(unstable.collect()));
    values.push(floats(&|record| record.statistics.largest_stated_error));
    values.push(ids(&|record| record.statistics.beyond_tolerance));
    let speed = |place: usize| extras.speeds_rpm.get(place).copied().flatten();
    values.push(Values::Float64((0..records.len()).map(speed).collect()));
    let stress = |amplitude_m: Option<f64>| Some(extras.stress_pa_per_m? * amplitude_m?);
    values.push(floats(&|record| stress(record.tuned.amplitude_m)));
    for percent in [50, 95, 99] {
        values.push(floats(&|record| {
            let amplitude = &record.statistics.peak_amplitude_m;
            stress(amplitude.percentile(percent)?.value)
        }));
    }
    let mut writer = TableWriter::create(path, SCENARIO_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::{PERCENTILES, SCENARIO_COLUMNS};

    #[test]
    fn every_statistic_has_its_column() {
        let mut expected = Vec::new();
        for quantity in ["amplification_factor", "peak_amplitude_m"] {
            expected.push(format!("{quantity}_mean"));
            expected.push(format!("{quantity}_standard_deviation"));
            for percent in PERCENTILES {
                for suffix in ["", "_lower", "_upper"] {
                    expected.push(format!("{quantity}_p{percent}{suffix}"));
                }
            }
        }
        let names: Vec<_> = SCENARIO_COLUMNS[11..11 + expected.len()]
            .iter()
            .map(|column| column.name)
            .collect();
        assert_eq!(names, expected);
    }
}
