//! Studies solved as the program solves them, and reading of the reference tables.

use std::path::{Path, PathBuf};

use blisk::population::monte_carlo::{CurveSettings, ResponseRow, Scenario, TunedReference};
use blisk::report::Warning;
use blisk::response::forced_response::ContactCondition;
use blisk::response::mistuning::{Pattern, PatternSource};
use blisk::settings::{Engine, EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};

/// A file or folder of this package.
pub fn package(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A table of strings by column name; lines of comment before the header are passed over.
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn read(path: &Path) -> Self {
        let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let text = std::fs::read_to_string(path).unwrap();
        // In the lumped tables the header itself is a comment, the last one.
        let (comments, rows): (Vec<&str>, Vec<&str>) =
            text.lines().partition(|line| line.starts_with('#'));
        let (header, rows) = match comments.last() {
            Some(header) => (header.trim_start_matches("# "), &rows[..]),
            None => (rows[0], &rows[1..]),
        };
        Self {
            header: split(header),
            rows: rows.iter().map(|line| split(line)).collect(),
        }
    }

    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row {
            header: &self.header,
            cells,
        })
    }
}

/// One row of a [`Table`].
#[derive(Clone, Copy)]
pub struct Row<'a> {
    header: &'a [String],
    cells: &'a [String],
}

impl<'a> Row<'a> {
    pub fn text(&self, column: &str) -> &'a str {
        let at = self.header.iter().position(|name| name == column);
        &self.cells[at.unwrap_or_else(|| panic!("no column {column}"))]
    }

    pub fn number(&self, column: &str) -> f64 {
        self.text(column).parse().unwrap()
    }

    pub fn numbers(&self) -> Vec<f64> {
        self.cells
            .iter()
            .map(|cell| cell.parse().unwrap())
            .collect()
    }
}

/// Height and place of a peak.
#[derive(Debug, Clone, Copy)]
pub struct Peak {
    pub amplitude_m: f64,
    pub frequency_hz: f64,
    pub blade: usize,
}

/// A study with its reduced model, not yet solved.
pub struct Case {
    pub study: Study,
    engine: Box<dyn Engine>,
    patterns: PatternSource,
}

impl Case {
    pub fn new(study: Study) -> Self {
        let model = load_sector_model(&study).unwrap();
        Self {
            patterns: pattern_source(&study, &model).unwrap(),
            engine: ReducedEngineSource.build(&study, &model, None).unwrap(),
            study,
        }
    }

    /// Facts about the reduction, as in the manifest.
    pub fn reduction(&self) -> serde_json::Value {
        self.engine.reduction_facts()
    }

    /// The basis that was taken.
    pub fn basis(&self) -> String {
        self.engine.model_report().basis
    }

    /// What is said about the basis.
    pub fn warnings(&self) -> Vec<Warning> {
        self.engine.model_report().warnings
    }

    /// Settings chosen where the study says `auto`.
    pub fn chosen(&self) -> serde_json::Value {
        self.engine.chosen_settings()
    }

    pub fn pattern(&self, id: u32, standard_deviation: Option<f64>) -> Pattern {
        self.patterns.pattern(id, standard_deviation).unwrap()
    }

    pub fn scenario(&self, contact: ContactCondition) -> Scenario {
        Scenario {
            index: 0,
            load_case: None,
            engine_order: self.study.engine_orders[0],
            standard_deviation: None,
            contact,
        }
    }

    pub fn tuned(&self, contact: ContactCondition) -> TunedReference {
        self.engine.tuned(&self.scenario(contact))
    }

    pub fn row(
        &self,
        pattern: &Pattern,
        contact: ContactCondition,
        tuned: &TunedReference,
    ) -> ResponseRow {
        let scenario = self.scenario(contact);
        self.engine.rows(pattern, &[(&scenario, tuned)]).remove(0)
    }

    /// Peak of the tuned wheel, or of pattern `id` of a file.
    pub fn peak(&self, id: Option<u32>, contact: ContactCondition) -> Peak {
        let tuned = self.tuned(contact);
        match id {
            None => Peak {
                amplitude_m: tuned.amplitude_m.unwrap(),
                frequency_hz: tuned.frequency_hz.unwrap(),
                blade: 0,
            },
            Some(id) => {
                let row = self.row(&self.pattern(id, None), contact, &tuned);
                assert!(
                    row.peak_amplitude_m.is_some(),
                    "{contact:?}: {}",
                    row.status.name()
                );
                Peak {
                    amplitude_m: row.peak_amplitude_m.unwrap(),
                    frequency_hz: row.peak_frequency_hz.unwrap(),
                    blade: row.peak_blade.unwrap() as usize,
                }
            }
        }
    }

    /// Amplitude of every blade at each frequency; every point must converge.
    pub fn amplitudes(
        &self,
        id: Option<u32>,
        contact: ContactCondition,
        frequencies_hz: &[f64],
    ) -> Vec<Vec<f64>> {
        let pattern = id.map(|id| self.pattern(id, None));
        let scenario = self.scenario(contact);
        let points = self.engine.curve(
            &scenario,
            pattern.as_ref(),
            frequencies_hz,
            CurveSettings::default(),
        );
        let amplitudes: Vec<f64> = points
            .iter()
            .map(|point| {
                let found = point.amplitude_m;
                found.unwrap_or_else(|| panic!("{} Hz: {:?}", point.frequency_hz, point.status))
            })
            .collect();
        let blades = amplitudes.len() / frequencies_hz.len();
        amplitudes.chunks(blades).map(<[f64]>::to_vec).collect()
    }
}
