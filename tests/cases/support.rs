//! Reading of reference tables and solution of a bundle at the reference's settings.

use std::path::{Path, PathBuf};

use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::{SectorModel, bundle};
use blisk::response::forced_response::{
    ContactCondition, Excited, FrequencyBand, LimitsWanted, Peak, PointSettings, SolverOptions,
    Wheel, Window, dominant_resonance, mistuned_window, peak, wheel_force,
};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;
use blisk::response::mistuning::{StructuralModes, WheelBasis};

/// A table of strings by column name.
pub struct Table {
    header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        Self {
            header: split(lines.next().unwrap()),
            rows: lines.map(split).collect(),
        }
    }

    pub fn text<'a>(&self, row: &'a [String], column: &str) -> &'a str {
        let at = self.header.iter().position(|name| name == column).unwrap();
        &row[at]
    }

    pub fn number(&self, row: &[String], column: &str) -> f64 {
        self.text(row, column).parse().unwrap()
    }
}

pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// A bundle with the parameters of its reference.
pub struct Case {
    pub model: SectorModel,
    pub stiffness: ContactStiffness,
    pub sector: PairParameters,
    pub deviations: Vec<f64>,
    pub peaks: Table,
}

pub const ENGINE_ORDER: u32 = 3;
pub const DAMPING: Damping = Damping::StructuralLossFactor(0.002);

impl Case {
    pub fn wheel8() -> Self {
        Self::read("wheel8", 8e8, 4e8)
    }

    pub fn wheel24() -> Self {
        Self::read("wheel24", 2e8, 1e8)
    }

    fn read(name: &str, kn: f64, kt: f64) -> Self {
        let folder = data(name);
        let patterns = Table::read(&folder.join("reference/patterns.csv"));
        Self {
            model: bundle::read(&folder).unwrap(),
            stiffness: ContactStiffness {
                normal_n_per_m: kn,
                tangential_1_n_per_m: kt,
                tangential_2_n_per_m: kt,
            },
            sector: PairParameters {
                normal_load_n: 0.0,
                normal_stiffness_n_per_m: kn,
                tangential_stiffness_n_per_m: kt,
                friction_coefficient: 0.3,
            },
            deviations: patterns
                .rows
                .iter()
                .map(|row| patterns.number(row, "deviation"))
                .collect(),
            peaks: Table::read(&folder.join("reference/peaks.csv")),
        }
    }

    pub fn reduce(&self, choice: BasisChoice) -> ReducedModel {
        Reduction::new(&self.model, self.stiffness, 25, 0)
            .unwrap()
            .reduce(choice, None)
            .unwrap()
    }
}

pub fn settings(
    case: &Case,
    model: &ReducedModel,
    harmonics: &[u32],
    samples: usize,
) -> PointSettings {
    let options = SolverOptions {
        samples_per_period: samples,
        ..SolverOptions::default()
    };
    let contact = Some((ContactLaw::Simplified3d, case.sector));
    PointSettings::new(&options, harmonics, contact, model.contact.clone()).unwrap()
}

pub const ALL_LIMITS: LimitsWanted = LimitsWanted {
    stuck: true,
    slide: true,
    free: true,
};

/// Tuned wheel as one sector.
pub fn tuned(model: &ReducedModel, harmonics: &[u32]) -> Excited {
    Excited::tuned(model, ENGINE_ORDER, 1.0, DAMPING, harmonics, ALL_LIMITS)
}

/// Mistuned wheel.
pub fn mistuned(model: &ReducedModel, deviations: &[f64], harmonics: &[u32]) -> Excited {
    let basis = WheelBasis::new(std::sync::Arc::new(model.clone()));
    let modes =
        StructuralModes::of_wheel(&basis, &basis.blade_stiffness_change(deviations)).unwrap();
    let force = wheel_force(&basis, &modes, ENGINE_ORDER, 1.0);
    let wheel = Wheel::mistuned(modes, model, DAMPING, ALL_LIMITS);
    Excited::wheel(&wheel, force, harmonics)
}

/// Peak of the tuned wheel (`deviations` none) or of the mistuned one.
pub fn solve(
    case: &Case,
    model: &ReducedModel,
    deviations: Option<&[f64]>,
    condition: ContactCondition,
    harmonics: &[u32],
) -> Peak {
    let settings = settings(case, model, harmonics, 512);
    let one_sector = tuned(model, harmonics);
    let anywhere = Window {
        resonances_hz: None,
        band: FrequencyBand::Auto,
    };
    match deviations {
        None => peak(&one_sector, condition, &settings, anywhere, 1e-4),
        Some(deviations) => {
            let wheel = mistuned(model, deviations, harmonics);
            let largest = deviations.iter().map(|d| d.abs()).fold(0.0, f64::max);
            let tuned = dominant_resonance(&one_sector, condition).unwrap();
            let window = mistuned_window(tuned, largest, FrequencyBand::Auto);
            peak(&wheel, condition, &settings, window, 1e-4)
        }
    }
}
