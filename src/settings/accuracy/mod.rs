//! The choice of settings by an accepted error, with its evidence.

mod accuracy_choice;
mod chosen_settings;
mod receptance_accuracy;
mod receptance_setting;

pub use chosen_settings::{AccuracyChoice, AccuracyEvidence, TriedSetting};
pub use receptance_setting::ReceptanceSetting;
