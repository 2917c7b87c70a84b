//! `responses.parquet`: one row per (scenario, pattern), ordered by pattern, then scenario.

use std::path::{Path, PathBuf};

use super::column::Values;
use super::reader::TableReader;
use super::response_columns::RESPONSE_COLUMNS;
use super::writer::{ROW_DIGESTS_KEY, TableWriter};
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{ContactQuantity, PairFactors};

/// Rows per row group and per batch in memory.
const ROW_GROUP: usize = 65_536;

/// Writer of `responses.parquet` and of its parts; holds one row group in memory.
///
/// Row groups have a fixed number of rows, so the file does not show how the rows arrived.
pub struct ResponseWriter {
    scenarios: Vec<Scenario>,
    writer: TableWriter,
    waiting: Vec<ResponseRow>,
    stable: Vec<Option<bool>>,
}

impl ResponseWriter {
    /// Begins the file `path`; `scenarios` are those of the study, in order. `row_digests` says what
    /// the rows are made from, a digest for each scenario that has rows in the file.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(
        path: &Path,
        scenarios: &[Scenario],
        header: &TableHeader,
        row_digests: &[String],
    ) -> Result<Self, TableError> {
        let digests = [(ROW_DIGESTS_KEY, row_digests.join(","))];
        Ok(Self {
            scenarios: scenarios.to_vec(),
            writer: TableWriter::create_with(path, RESPONSE_COLUMNS, header, &digests)?,
            waiting: Vec::new(),
            stable: Vec::new(),
        })
    }

    /// Appends rows in their order.
    ///
    /// # Errors
    /// The file cannot be written, or a row belongs to no scenario.
    pub fn write(&mut self, rows: impl IntoIterator<Item = ResponseRow>) -> Result<(), TableError> {
        for row in rows {
            self.write_judged(row, None)?;
        }
        Ok(())
    }

    /// Appends a row with what is known of the stability of its motion.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn write_judged(
        &mut self,
        row: ResponseRow,
        stable: Option<bool>,
    ) -> Result<(), TableError> {
        self.waiting.push(row);
        self.stable.push(stable);
        if self.waiting.len() == ROW_GROUP {
            self.flush()?;
        }
        Ok(())
    }

    /// Completes the file and puts it in its place.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), TableError> {
        self.flush()?;
        self.writer.finish()
    }

    /// The same under a name made from the digest of the file.
    pub(super) fn finish_as(
        mut self,
        name: impl FnOnce(&str) -> Result<String, TableError>,
    ) -> Result<(), TableError> {
        self.flush()?;
        self.writer.finish_as(name)
    }

    fn flush(&mut self) -> Result<(), TableError> {
        let rows = std::mem::take(&mut self.waiting);
        if rows.is_empty() {
            return Ok(());
        }
        let mut values = columns_of(&rows, &self.scenarios)?;
        values.push(Values::Boolean(std::mem::take(&mut self.stable)));
        self.writer.write(values)
    }
}

/// Values of the columns but the last one.
fn columns_of(rows: &[ResponseRow], scenarios: &[Scenario]) -> Result<Vec<Values>, TableError> {
    let keys: Vec<&Scenario> = rows
        .iter()
        .map(|row| {
            scenarios.get(row.scenario).ok_or_else(|| {
                let reason = format!(
                    "a row names scenario {}, which does not exist",
                    row.scenario
                );
                TableError::encoding(Path::new("responses.parquet"), reason)
            })
        })
        .collect::<Result<_, _>>()?;
    let ids = |id: &dyn Fn(&ResponseRow) -> Option<u32>| {
        Values::Int32(rows.iter().map(|row| id(row).map(|id| id as i32)).collect())
    };
    let floats = |value: &dyn Fn(&ResponseRow) -> Option<f64>| {
        Values::Float64(rows.iter().map(value).collect())
    };
    let counts = |value: &dyn Fn(&ResponseRow) -> u64| {
        Values::Int64(rows.iter().map(|row| Some(value(row) as i64)).collect())
    };
    let names = |value: &dyn Fn(&ResponseRow) -> String| {
        Values::String(rows.iter().map(|row| Some(value(row))).collect())
    };
    Ok(vec![
        ids(&|row| Some(row.scenario as u32)),
        Values::String(
            keys.iter()
                .map(|key| Some(key.contact.name().to_owned()))
                .collect(),
        ),
        Values::Int32(
            keys.iter()
                .map(|key| Some(key.engine_order as i32))
                .collect(),
        ),
        Values::Float64(keys.iter().map(|key| key.contact.normal_load_n()).collect()),
        Values::Float64(keys.iter().map(|key| key.standard_deviation).collect()),
        ids(&|row| Some(row.pattern)),
        names(&|row| row.status.name().to_owned()),
        floats(&|row| row.peak_amplitude_m),
        floats(&|row| row.peak_frequency_hz),
        ids(&|row| row.peak_blade),
        floats(&|row| row.amplification_factor),
        Values::Boolean(rows.iter().map(|row| row.peak_bracketed).collect()),
        names(&|row| row.harmonics.clone()),
        counts(&|row| row.nonlinear_solves),
        counts(&|row| row.newton_iterations),
        floats(&|row| row.residual),
        floats(&|row| row.slipping_fraction),
        floats(&|row| row.separated_fraction),
        names(&|row| row.shortcut.clone()),
        counts(&|row| row.retries),
        counts(&|row| row.factorisations),
        floats(&|row| row.mean_friction_circumferential_n),
        floats(&|row| row.mean_friction_axial_n),
        floats(&|row| row.sampling_error),
        floats(&|row| row.harmonic_error),
        floats(&|row| row.stated_error),
        Values::Boolean(rows.iter().map(|row| row.error_within_tolerance).collect()),
        names(&|row| row.basis.clone()),
        floats(&|row| {
            row.contact_factors
                .map(|factors| factors.friction_coefficient)
        }),
        floats(&|row| {
            row.contact_factors
                .map(|factors| factors.tangential_stiffness)
        }),
        floats(&|row| row.contact_factors.map(|factors| factors.normal_stiffness)),
        floats(&|row| row.contact_factors.map(|factors| factors.normal_load)),
    ])
}

/// Reader of `responses.parquet` and of its parts, batch by batch.
#[derive(Debug)]
pub struct ResponseReader {
    path: PathBuf,
    table: TableReader,
    next: usize,
}

impl ResponseReader {
    /// Opens the file `path` and checks its columns.
    ///
    /// # Errors
    /// The file cannot be read or is no such table.
    pub fn open(path: &Path) -> Result<Self, TableError> {
        Ok(Self {
            path: path.to_owned(),
            // Stability is no part of a row, and tables of before have none.
            table: TableReader::open(path, &RESPONSE_COLUMNS[..RESPONSE_COLUMNS.len() - 1])?,
            next: 0,
        })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.table.rows()
    }

    /// Digest of the study that the file belongs to.
    #[must_use]
    pub fn study_digest(&self) -> Option<&str> {
        self.table.study_digest()
    }

    /// Digests of what the rows of each scenario of the file are made from.
    #[must_use]
    pub fn row_digests(&self) -> &[String] {
        self.table.row_digests()
    }

    /// The next rows, at most one row group; empty at the end.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn next_batch(&mut self) -> Result<Vec<ResponseRow>, TableError> {
        let count = ROW_GROUP.min(self.rows() - self.next);
        if count == 0 {
            return Ok(Vec::new());
        }
        let rows = self.read(self.next, count)?;
        if rows.len() != count {
            return Err(TableError::damaged(
                &self.path,
                format!(
                    "{} rows instead of {count} from row {} on",
                    rows.len(),
                    self.next
                ),
            ));
        }
        self.next += count;
        Ok(rows)
    }

    /// The row group of row `place`: where it begins, and its rows; without rows beyond the end.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn group_of(&self, place: usize) -> Result<(usize, Vec<ResponseRow>), TableError> {
        let first = place - place % ROW_GROUP;
        let count = ROW_GROUP.min(self.rows().saturating_sub(first));
        Ok((first, self.read(first, count)?))
    }

    fn read(&self, first: usize, count: usize) -> Result<Vec<ResponseRow>, TableError> {
        let slice = self.table.read(first, count)?;
        let gap = |row: usize, column: &str| {
            TableError::damaged(
                &self.path,
                format!("row {}: no valid value in column {column}", first + row),
            )
        };
        let ids = |name: &'static str| -> Result<Vec<u32>, TableError> {
            let values = slice.int32(name)?;
            let whole = |(row, value): (usize, Option<i32>)| {
                value
                    .and_then(|value| u32::try_from(value).ok())
                    .ok_or_else(|| gap(row, name))
            };
            values.into_iter().enumerate().map(whole).collect()
        };
        let counts = |name: &'static str| -> Result<Vec<u64>, TableError> {
            let values = slice.int64(name)?;
            let whole = |(row, value): (usize, Option<i64>)| {
                value
                    .and_then(|value| u64::try_from(value).ok())
                    .ok_or_else(|| gap(row, name))
            };
            values.into_iter().enumerate().map(whole).collect()
        };
        let (scenarios, patterns) = (ids("scenario")?, ids("pattern")?);
        let mut statuses = slice.string("status")?;
        let amplitudes = slice.float64("peak_amplitude_m")?;
        let frequencies = slice.float64("peak_frequency_hz")?;
        let blades = slice.int32("peak_blade")?;
        let factors = slice.float64("amplification_factor")?;
        let bracketed = slice.boolean("peak_bracketed")?;
        let mut harmonics = slice.string("harmonics")?;
        let (solves, iterations) = (counts("nonlinear_solves")?, counts("newton_iterations")?);
        let (retries, factorisations) = (counts("retries")?, counts("factorisations")?);
        let residuals = slice.float64("residual")?;
        let slipping = slice.float64("slipping_fraction")?;
        let separated = slice.float64("separated_fraction")?;
        let circumferential = slice.float64("mean_friction_circumferential_n")?;
        let axial = slice.float64("mean_friction_axial_n")?;
        let mut shortcuts = slice.string("shortcut")?;
        let sampling_errors = slice.float64("sampling_error")?;
        let harmonic_errors = slice.float64("harmonic_error")?;
        let stated_errors = slice.float64("stated_error")?;
        let within = slice.boolean("error_within_tolerance")?;
        let mut bases = slice.string("basis")?;
        let factors_of = ContactQuantity::ALL.map(|quantity| format!("{}_factor", quantity.name()));
        let mut contact_factors = Vec::new();
        for column in &factors_of {
            contact_factors.push(slice.float64(column)?);
        }
        (0..scenarios.len())
            .map(|i| {
                let status = statuses[i]
                    .take()
                    .and_then(|name| Status::ALL.into_iter().find(|status| status.name() == name));
                Ok(ResponseRow {
                    scenario: scenarios[i] as usize,
                    pattern: patterns[i],
                    status: status.ok_or_else(|| gap(i, "status"))?,
                    peak_amplitude_m: amplitudes[i],
                    peak_frequency_hz: frequencies[i],
                    peak_blade: blades[i].and_then(|blade| u32::try_from(blade).ok()),
                    amplification_factor: factors[i],
                    peak_bracketed: bracketed[i],
                    harmonics: harmonics[i].take().ok_or_else(|| gap(i, "harmonics"))?,
                    nonlinear_solves: solves[i],
                    newton_iterations: iterations[i],
                    factorisations: factorisations[i],
                    retries: retries[i],
                    residual: residuals[i],
                    slipping_fraction: slipping[i],
                    separated_fraction: separated[i],
                    mean_friction_circumferential_n: circumferential[i],
                    mean_friction_axial_n: axial[i],
                    shortcut: shortcuts[i].take().ok_or_else(|| gap(i, "shortcut"))?,
                    sampling_error: sampling_errors[i],
                    harmonic_error: harmonic_errors[i],
                    stated_error: stated_errors[i],
                    error_within_tolerance: within[i],
                    contact_factors: match [0, 1, 2, 3]
                        .map(|column: usize| contact_factors[column][i])
                    {
                        [
                            Some(friction_coefficient),
                            Some(tangential_stiffness),
                            Some(normal_stiffness),
                            Some(normal_load),
                        ] => Some(PairFactors {
                            friction_coefficient,
                            tangential_stiffness,
                            normal_stiffness,
                            normal_load,
                        }),
                        _ => None,
                    },
                    basis: bases[i].take().ok_or_else(|| gap(i, "basis"))?,
                })
            })
            .collect()
    }
}
