//! `--fidelity`, `--harmonics`, `--samples`: which model is solved, and how finely.

use std::str::FromStr;

use clap::{Args, ValueEnum};

use super::exit::Failure;
use crate::response::forced_response::Harmonics;
use crate::settings::FullSettings;
use crate::study::Study;
use crate::verification::reference::ReferenceSettings;

/// Highest harmonic accepted, as in a study.
const MAX_HARMONIC: u32 = 100;

/// `--fidelity`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Fidelity {
    /// The reduced model of the study.
    Reduced,
    /// Every contact dof of the whole wheel, finely sampled; slow, and independent of the reduced path.
    Full,
}

/// `--harmonics`, like `1,3,5`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HarmonicsArgument(Vec<u32>);

impl FromStr for HarmonicsArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let set: Option<Vec<u32>> = text.split(',').map(|k| k.trim().parse().ok()).collect();
        set.filter(|set| {
            set.contains(&1)
                && set.is_sorted_by(|a, b| a < b)
                && set.last() <= Some(&MAX_HARMONIC)
        })
        .map(Self)
        .ok_or_else(|| {
            format!("accepted: ascending harmonics from 0 to {MAX_HARMONIC} with 1 among them, like 1,3,5")
        })
    }
}

/// Which model is solved, and how finely.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct FidelityArguments {
    /// The reduced model of the study, or every contact dof of the whole wheel; says nothing about friction, unlike
    /// `full` in the column `contact` (`blisk explain full`).
    #[arg(long, value_enum, default_value = "reduced")]
    pub fidelity: Fidelity,
    /// Harmonics instead of those of the study, like 1,3,5.
    #[arg(long, value_name = "LIST")]
    pub harmonics: Option<HarmonicsArgument>,
    /// Samples per period instead of those of the study [full: 512].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=65_536))]
    pub samples: Option<u32>,
}

impl FidelityArguments {
    /// Whether any of them is on the command line, but for what is the default.
    pub(super) fn is_stated(&self) -> bool {
        self.fidelity != Fidelity::Reduced || self.harmonics.is_some() || self.samples.is_some()
    }

    /// Refuses other harmonics and samples for a row that is solved again on the model of the study.
    pub(super) fn check_for_one_row(&self) -> Result<(), Failure> {
        if self.fidelity == Fidelity::Reduced && self.is_stated() {
            return Err(Failure::usage(
                "a row is solved again with its own harmonics and samples; accepted: --harmonics and --samples with --fidelity full"
                    .to_owned(),
            ));
        }
        Ok(())
    }

    /// The study with these harmonics and samples.
    pub(super) fn applied_to(&self, mut study: Study) -> Result<Study, Failure> {
        if study.accuracy.is_some() && (self.harmonics.is_some() || self.samples.is_some()) {
            return Err(Failure::usage(
                "--harmonics and --samples are chosen by [accuracy] of the study; accepted: one of both"
                    .to_owned(),
            ));
        }
        let mut solver = study.solver.clone();
        if let Some(HarmonicsArgument(set)) = &self.harmonics {
            solver.harmonics = Harmonics::Set(set.clone());
        }
        if let Some(samples) = self.samples {
            solver.samples_per_period = samples as usize;
        }
        if let Harmonics::Set(set) = &solver.harmonics
            && let Some(&highest) = set.last()
        {
            fits(highest, solver.samples_per_period)?;
        }
        study.solver = solver;
        Ok(study)
    }

    /// Settings on the full-contact model; none for the reduced one.
    pub(super) fn full(&self, study: &Study) -> Result<Option<FullSettings>, Failure> {
        if self.fidelity == Fidelity::Reduced {
            return Ok(None);
        }
        let least = study.solver.samples_per_period;
        let samples_per_period = match self.samples {
            Some(samples) => samples as usize,
            None => ReferenceSettings::SAMPLES_PER_PERIOD.max(least),
        };
        let harmonics = self
            .harmonics
            .as_ref()
            .map(|HarmonicsArgument(set)| set.clone());
        if let Some(&highest) = harmonics.as_ref().and_then(|set| set.last()) {
            fits(highest, samples_per_period)?;
        }
        Ok(Some(FullSettings {
            harmonics,
            samples_per_period,
        }))
    }
}

fn fits(highest: u32, samples: usize) -> Result<(), Failure> {
    let least = 4 * highest as usize;
    if samples < least {
        return Err(Failure::usage(format!(
            "{samples} samples per period are too few for harmonic {highest}; accepted: --samples of at least {least}"
        )));
    }
    Ok(())
}
