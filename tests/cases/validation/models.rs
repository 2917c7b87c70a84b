//! Studies of the wheels that more than one section solves.

use blisk::model::reduction::ReductionOptions;
use blisk::response::forced_response::{ContactCondition, Harmonics, SolverOptions};
use blisk::response::harmonic_balance::Status;
use blisk::study::Study;

use super::super::support::package;
use super::report::micrometres;

/// A peak, m, or why there is none.
pub type Amplitude = Result<f64, Status>;

/// A peak in µm, or its status.
pub fn shown(found: Amplitude) -> String {
    found.map_or_else(
        |status| status.name().to_owned(),
        |metres| micrometres(Some(metres)),
    )
}

/// Friction under each of these loads, N per sector.
pub fn under(loads_n: &[f64]) -> Vec<ContactCondition> {
    loads_n
        .iter()
        .map(|&normal_load_n| ContactCondition::Full { normal_load_n })
        .collect()
}

/// A study at default settings under other loads, with other harmonics if there is a set.
pub fn at_defaults(file: &str, loads_n: &[f64], harmonics: Option<&[u32]>) -> Study {
    let mut study = Study::read(&package(file)).unwrap();
    study.reduction = ReductionOptions::default();
    study.contacts = under(loads_n);
    study.solver = SolverOptions {
        harmonics: harmonics.map_or(Harmonics::Auto, |set| Harmonics::Set(set.to_vec())),
        ..SolverOptions::default()
    };
    study
}

/// The built-in wheel with the contact of the quickstart, all else at its defaults.
pub fn default_model(loads_n: &[f64], harmonics: Option<&[u32]>) -> Study {
    at_defaults("studies/quickstart.toml", loads_n, harmonics)
}

/// A reference wheel, all but its loads at the defaults.
pub fn reference_wheel(name: &str, loads_n: &[f64], harmonics: Option<&[u32]>) -> Study {
    let file = format!("studies/validation/{name}.toml");
    at_defaults(&file, loads_n, harmonics)
}
