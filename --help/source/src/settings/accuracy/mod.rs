//! The choice of settings by an accepted error, with its evidence.

mod accuracy_choice;
mod chosen_settings;
mod ladder_trials;
mod receptance_accuracy;
mod receptance_setting;

pub use chosen_settings::{AccuracyChoice, AccuracyEvidence, ChosenSetting, TriedSetting};
pub use receptance_setting::ReceptanceSetting;
