//! What the numbers of a study are solved with, chosen by measured error, and the engines that solve its rows with it.

mod accuracy;
mod basis_choice;
mod engines;
mod fixed_interface;
mod full_model;
mod harmonics_on_basis;
mod harmonics_on_receptances;
pub(crate) mod ladder;
mod progress;
mod receptances_of_basis;
mod reduced_study;
mod row_settings;
mod time_left;
mod tuned_receptances;

pub use accuracy::{AccuracyChoice, AccuracyEvidence, ReceptanceSetting, TriedSetting};
pub use engines::{Engine, EngineSource, ReducedEngineSource, SurrogateOf};
pub(crate) use engines::{RowWork, rows_of, tuned_references};
pub(crate) use fixed_interface::FixedInterface;
pub use full_model::{FullModel, FullRow, FullSettings};
pub use ladder::{HarmonicLevel, Knob, LadderSetting};
pub use progress::{Progress, Stage};
pub(crate) use row_settings::contact_stiffness;
pub use time_left::{Pace, TimeLeft};
pub(crate) use tuned_receptances::SHAPES_BETWEEN;
