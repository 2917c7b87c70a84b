//! The settings of `tradeoff.parquet` as a report shows them: what each costs and how far its rows are off.

use std::path::Path;

use serde::Serialize;

use super::TableError;
use super::column::{ColumnKind, ColumnSpec};
use super::parquet::TableReader;
use super::side_tables::{SideTable, check_side_table};

use ColumnKind::{Boolean, Float64, Int32, String as Text};

const fn column(name: &'static str, kind: ColumnKind) -> ColumnSpec {
    ColumnSpec::new(name, kind, "", "")
}

/// Name of the table.
const TRADEOFF: &str = "tradeoff.parquet";

/// Columns read; the file has more.
const COLUMNS: &[ColumnSpec] = &[
    column("setting", Int32),
    column("role", Text),
    column("basis", Text),
    column("harmonics", Text),
    column("samples_per_period", Int32),
    column("residual_tolerance", Float64),
    column("peak_tolerance", Float64),
    column("amplitude_error_median", Float64),
    column("amplitude_error_p95", Float64),
    column("amplitude_error_p95_upper", Float64),
    column("operations_per_row", Float64),
    column("on_front", Boolean),
];

/// One setting of a measured trade-off between accuracy and cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredSetting {
    /// Its number.
    pub setting: u32,
    /// `reference`, `base`, `knob` or `combination`.
    pub role: String,
    /// Reduction basis.
    pub basis: String,
    /// Harmonics.
    pub harmonics: String,
    /// Samples per period.
    pub samples_per_period: u32,
    /// Residual accepted, relative to the excitation.
    pub residual_tolerance: Option<f64>,
    /// Relative tolerance of the peak.
    pub peak_tolerance: Option<f64>,
    /// Median relative error of the peak amplitude.
    pub amplitude_error_median: Option<f64>,
    /// 95th percentile of the errors of the sample.
    pub amplitude_error_p95: Option<f64>,
    /// Upper 95 % bound on the 95th percentile of the errors of all rows.
    pub amplitude_error_p95_upper: Option<f64>,
    /// Mean floating-point operations of a row.
    pub operations: Option<f64>,
    /// Whether no other setting is both cheaper and more accurate.
    pub on_front: bool,
}

impl MeasuredSetting {
    /// The bound on the error that 95 % of the rows keep; where the sample has none, that of the sample.
    #[must_use]
    pub fn drawn_error(&self) -> Option<f64> {
        let bound = self.amplitude_error_p95_upper;
        bound
            .filter(|bound| bound.is_finite())
            .or(self.amplitude_error_p95)
    }
}

/// A measured trade-off.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyLadder {
    /// Digest of the study that it was measured on.
    pub study_digest: String,
    /// Identity of the build that measured it.
    pub build: String,
    /// The settings, in the order of the table.
    pub settings: Vec<MeasuredSetting>,
}

impl AccuracyLadder {
    /// Reads `tradeoff.parquet` of the folder `results`; none if there is none.
    ///
    /// # Errors
    /// The file cannot be read, or is not as it was written.
    pub fn read(results: &Path) -> Result<Option<Self>, TableError> {
        let Some(SideTable { build, .. }) = check_side_table(results, TRADEOFF)? else {
            return Ok(None);
        };
        let path = results.join(TRADEOFF);
        let table = TableReader::open(&path, COLUMNS)?;
        let rows = table.read(0, table.rows())?;
        let (setting, samples) = (rows.int32("setting")?, rows.int32("samples_per_period")?);
        let (role, basis) = (rows.string("role")?, rows.string("basis")?);
        let harmonics = rows.string("harmonics")?;
        let residual = rows.float64("residual_tolerance")?;
        let peak = rows.float64("peak_tolerance")?;
        let median = rows.float64("amplitude_error_median")?;
        let p95 = rows.float64("amplitude_error_p95")?;
        let p95_upper = rows.float64("amplitude_error_p95_upper")?;
        let operations = rows.float64("operations_per_row")?;
        let on_front = rows.boolean("on_front")?;
        let settings = (0..table.rows())
            .map(|row| MeasuredSetting {
                setting: setting[row].unwrap_or_default() as u32,
                role: role[row].clone().unwrap_or_default(),
                basis: basis[row].clone().unwrap_or_default(),
                harmonics: harmonics[row].clone().unwrap_or_default(),
                samples_per_period: samples[row].unwrap_or_default() as u32,
                residual_tolerance: residual[row],
                peak_tolerance: peak[row],
                amplitude_error_median: median[row],
                amplitude_error_p95: p95[row],
                amplitude_error_p95_upper: p95_upper[row],
                operations: operations[row],
                on_front: on_front[row].unwrap_or_default(),
            })
            .collect();
        Ok(Some(Self {
            study_digest: table.study_digest().unwrap_or_default().to_owned(),
            build,
            settings,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::table::column::Values;
    use crate::population::table::parquet::TableWriter;
    use crate::population::table::{CHECKSUMS, Compression, TableHeader, write_side_table};

    #[test]
    fn settings_are_read_from_a_table_with_these_columns() {
        let folder = tempfile::tempdir().expect("a folder");
        assert_eq!(AccuracyLadder::read(folder.path()).expect("no table"), None);
        let header = TableHeader {
            study_digest: "d".to_owned(),
            compression: Compression::Zstd,
            load_cases: Vec::new(),
        };
        let path = folder.path().join("tradeoff.parquet");
        let mut writer = TableWriter::create(&path, COLUMNS, &header).expect("a table");
        let text = |words: &str| Values::String(vec![Some(words.to_owned()), None]);
        let number = |value: f64| Values::Float64(vec![Some(value), None]);
        let values = vec![
            Values::Int32(vec![Some(0), Some(1)]),
            text("base"),
            text("stick_slide 3+4"),
            text("1-3"),
            Values::Int32(vec![Some(128), Some(256)]),
            number(1e-8),
            number(1e-3),
            number(0.001),
            number(0.01),
            number(0.02),
            number(3e9),
            Values::Boolean(vec![Some(true), Some(false)]),
        ];
        writer.write(values).expect("rows");
        writer.finish().expect("an end");
        let unknown = AccuracyLadder::read(folder.path()).expect_err("nothing vouches for it");
        assert!(unknown.to_string().contains(CHECKSUMS), "{unknown}");
        let copied = |to: &Path| {
            std::fs::create_dir_all(to.parent().expect("a folder")).expect("made");
            std::fs::copy(&path, to).expect("copied");
            Ok(())
        };
        write_side_table(folder.path(), TRADEOFF, copied).expect("written");
        let ladder = AccuracyLadder::read(folder.path()).expect("a table");
        let ladder = ladder.expect("a ladder");
        assert_eq!(ladder.study_digest, "d");
        assert_eq!(ladder.build, crate::identity::BUILD);
        let first = &ladder.settings[0];
        assert_eq!(
            (first.role.as_str(), first.samples_per_period),
            ("base", 128)
        );
        assert_eq!(first.amplitude_error_p95_upper, Some(0.02));
        assert!(first.on_front && ladder.settings[1].operations.is_none());
    }
}
