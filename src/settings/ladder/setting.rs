//! The ladder of numerical settings: knobs, their levels, and a study at given levels.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::model::reduction::{Basis, BasisChoice};
use crate::population::monte_carlo::harmonics_name;
use crate::response::forced_response::{Harmonics, RowsBeyondTolerance};
use crate::response::friction::ContactLaw;
use crate::response::mistuning::Projection;
use crate::study::Study;

/// Cantilever modes of the projection through them, where the study does not say.
const CANTILEVER_MODES: usize = 10;

/// Harmonics of every scenario of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum HarmonicLevel {
    /// This set.
    Set(Vec<u32>),
    /// Per scenario, by this tolerance.
    Automatic(f64),
}

impl fmt::Display for HarmonicLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(set) => f.write_str(&harmonics_name(set)),
            Self::Automatic(tolerance) => write!(f, "auto {tolerance}"),
        }
    }
}

/// One setting of every knob.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LadderSetting {
    /// Reduction basis; the whole Craig-Bampton space where a model is not reduced.
    pub basis: BasisChoice,
    /// Harmonics.
    pub harmonics: HarmonicLevel,
    /// Samples per period.
    pub samples_per_period: usize,
    /// Bound on the residual relative to the excitation.
    pub residual_tolerance: f64,
    /// Relative tolerance of the peak amplitude.
    pub peak_tolerance: f64,
    /// Contact law.
    pub law: ContactLaw,
    /// How a deviation enters the reduced stiffness.
    pub projection: Projection,
}

/// What can be set by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Knob {
    /// `reduction.basis` and its modes.
    Basis,
    /// `solver.harmonics`.
    Harmonics,
    /// `solver.samples_per_period`.
    SamplesPerPeriod,
    /// `solver.residual_tolerance`.
    ResidualTolerance,
    /// `solver.peak_tolerance`.
    PeakTolerance,
    /// `contact.law`.
    ContactLaw,
    /// `mistuning.projection`.
    Projection,
}

impl Knob {
    /// Every knob.
    pub const ALL: [Self; 7] = [
        Self::Basis,
        Self::Harmonics,
        Self::SamplesPerPeriod,
        Self::ResidualTolerance,
        Self::PeakTolerance,
        Self::ContactLaw,
        Self::Projection,
    ];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Basis => "basis",
            Self::Harmonics => "harmonics",
            Self::SamplesPerPeriod => "samples_per_period",
            Self::ResidualTolerance => "residual_tolerance",
            Self::PeakTolerance => "peak_tolerance",
            Self::ContactLaw => "contact_law",
            Self::Projection => "projection",
        }
    }
}

impl LadderSetting {
    /// This setting with one knob at the level of `other`.
    #[must_use]
    pub fn with(&self, knob: Knob, other: &Self) -> Self {
        let mut changed = self.clone();
        match knob {
            Knob::Basis => changed.basis = other.basis,
            Knob::Harmonics => changed.harmonics.clone_from(&other.harmonics),
            Knob::SamplesPerPeriod => changed.samples_per_period = other.samples_per_period,
            Knob::ResidualTolerance => changed.residual_tolerance = other.residual_tolerance,
            Knob::PeakTolerance => changed.peak_tolerance = other.peak_tolerance,
            Knob::ContactLaw => changed.law = other.law,
            Knob::Projection => changed.projection = other.projection,
        }
        changed
    }

    /// The level of one knob, in words.
    #[must_use]
    pub fn level(&self, knob: Knob) -> String {
        match knob {
            Knob::Basis => self.basis.to_string(),
            Knob::Harmonics => self.harmonics.to_string(),
            Knob::SamplesPerPeriod => self.samples_per_period.to_string(),
            Knob::ResidualTolerance => format!("{:e}", self.residual_tolerance),
            Knob::PeakTolerance => format!("{:e}", self.peak_tolerance),
            Knob::ContactLaw => self.law.name().to_owned(),
            Knob::Projection => projection_name(self.projection).to_owned(),
        }
    }

    /// Whether it has harmonics that its law does not excite: the same without them is the same, and cheaper.
    #[must_use]
    pub fn is_redundant(&self) -> bool {
        let even = |set: &[u32]| set.iter().any(|k| k % 2 == 0);
        match &self.harmonics {
            HarmonicLevel::Set(set) => !self.law.has_variable_load() && even(set),
            HarmonicLevel::Automatic(_) => false,
        }
    }

    /// `study` solved at this setting. What the setting does not say stays.
    #[must_use]
    pub fn applied_to(&self, study: &Study) -> Study {
        let mut applied = study.clone();
        applied.accuracy = None;
        let reduction = &mut applied.reduction;
        (reduction.stick_modes, reduction.slide_modes) = (None, None);
        match self.basis {
            BasisChoice::StickSlide { stick, slide } => {
                reduction.basis = Basis::StickSlide;
                (reduction.stick_modes, reduction.slide_modes) = (Some(stick), Some(slide));
            }
            BasisChoice::StickAttachment { stick } => {
                reduction.basis = Basis::StickAttachment;
                reduction.stick_modes = Some(stick);
            }
            // Sectors in their whole space, as they were measured; `Auto` could take tuned receptances.
            BasisChoice::CraigBampton => reduction.basis = Basis::StickSlide,
        }
        let solver = &mut applied.solver;
        match &self.harmonics {
            HarmonicLevel::Set(set) => solver.harmonics = Harmonics::Set(set.clone()),
            HarmonicLevel::Automatic(tolerance) => {
                solver.harmonics = Harmonics::Auto;
                solver.harmonic_tolerance = *tolerance;
            }
        }
        solver.rows_beyond_tolerance = RowsBeyondTolerance::Flag;
        solver.samples_per_period = self.samples_per_period;
        solver.residual_tolerance = self.residual_tolerance;
        solver.residual_is_stated = true;
        solver.peak_tolerance = self.peak_tolerance;
        if let Some(contact) = &mut applied.contact {
            contact.law = self.law;
        }
        applied.mistuning.projection = self.projection;
        if self.projection == Projection::CantileverModes {
            let modes = &mut applied.mistuning.cantilever_mode_count;
            *modes = modes.or(Some(CANTILEVER_MODES));
        }
        applied
    }
}

/// Name of a projection in a study.
#[must_use]
pub fn projection_name(projection: Projection) -> &'static str {
    match projection {
        Projection::Exact => "exact",
        Projection::CantileverModes => "cantilever_modes",
    }
}

/// What the levels of a ladder depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LadderSpace {
    /// Whether no mode is left out, so that there is one basis alone.
    pub whole_space: bool,
    /// Contact rows of a sector.
    pub contact_rows: usize,
    /// Vectors per nodal diameter of the best basis.
    pub most_vectors: usize,
    /// Law of the study.
    pub law: ContactLaw,
    /// Projection of the study.
    pub projection: Projection,
}

/// Stick and slide modes of `stick_slide` that are tried.
const STICK_SLIDE: [(usize, usize); 11] = [
    (2, 2),
    (2, 3),
    (3, 3),
    (3, 4),
    (4, 4),
    (4, 6),
    (6, 6),
    (8, 8),
    (10, 10),
    (14, 14),
    (20, 20),
];
/// Sets under a constant normal load.
const ODD_SETS: [&[u32]; 5] = [&[1], &[1, 3], &[1, 3, 5], &[1, 3, 5, 7], &[1, 3, 5, 7, 9]];
/// Sets under a variable one.
const SETS: [&[u32]; 8] = [
    &[1],
    &[1, 3],
    &[1, 3, 5],
    &[1, 2, 3],
    &[0, 1, 2, 3],
    &[0, 1, 2, 3, 4, 5],
    &[1, 3, 5, 7, 9],
    &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10],
];
/// Tolerances of automatic sets.
const AUTOMATIC: [f64; 3] = [0.02, 0.01, 0.005];
const SAMPLES: [usize; 4] = [32, 64, 128, 256];
const RESIDUALS: [f64; 3] = [1e-4, 1e-6, 1e-8];
const PEAKS: [f64; 4] = [1e-2, 3e-3, 1e-3, 3e-4];

impl LadderSpace {
    /// Vectors per nodal diameter of a basis.
    #[must_use]
    pub fn vectors(&self, basis: BasisChoice) -> usize {
        match basis {
            BasisChoice::StickSlide { stick, slide } => stick + slide,
            BasisChoice::StickAttachment { stick } => stick + self.contact_rows,
            BasisChoice::CraigBampton => usize::MAX,
        }
    }

    /// The bases below the best one, the smallest first.
    #[must_use]
    pub fn bases(&self) -> Vec<BasisChoice> {
        if self.whole_space {
            return vec![BasisChoice::CraigBampton];
        }
        let modes = STICK_SLIDE.map(|(stick, slide)| BasisChoice::StickSlide { stick, slide });
        let smaller = modes.into_iter();
        smaller
            .filter(|&basis| self.vectors(basis) < self.most_vectors)
            .collect()
    }

    /// The harmonics, coarser than an automatic set of tolerance `finest`.
    #[must_use]
    pub fn harmonics(&self, finest: f64) -> Vec<HarmonicLevel> {
        let sets: &[&[u32]] = if self.law.has_variable_load() {
            &SETS
        } else {
            &ODD_SETS
        };
        let sets = sets.iter().map(|set| HarmonicLevel::Set(set.to_vec()));
        let automatic = AUTOMATIC
            .into_iter()
            .filter(|&tolerance| tolerance > finest);
        sets.chain(automatic.map(HarmonicLevel::Automatic))
            .collect()
    }

    /// Laws that are simpler than that of the study, and this.
    #[must_use]
    pub fn laws(&self) -> Vec<ContactLaw> {
        let all = ContactLaw::ALL;
        let last = all.iter().position(|&law| law == self.law).unwrap_or(0);
        all[..=last].to_vec()
    }

    /// Every setting that differs from `base` in one knob alone, knob by knob, the base included with
    /// each.
    #[must_use]
    pub fn one_at_a_time(&self, base: &LadderSetting, finest: f64) -> Vec<(Knob, LadderSetting)> {
        let mut settings = Vec::new();
        let mut add = |knob, change: &dyn Fn(&mut LadderSetting)| {
            let mut changed = base.clone();
            change(&mut changed);
            settings.push((knob, changed));
        };
        for basis in self.bases() {
            add(Knob::Basis, &|setting| setting.basis = basis);
        }
        for harmonics in self.harmonics(finest) {
            add(Knob::Harmonics, &|setting| {
                setting.harmonics.clone_from(&harmonics);
            });
        }
        for samples in SAMPLES {
            add(Knob::SamplesPerPeriod, &|setting| {
                setting.samples_per_period = samples;
            });
        }
        for residual in RESIDUALS {
            add(Knob::ResidualTolerance, &|setting| {
                setting.residual_tolerance = residual;
            });
        }
        for peak in PEAKS {
            add(Knob::PeakTolerance, &|setting| {
                setting.peak_tolerance = peak;
            });
        }
        for law in self.laws() {
            add(Knob::ContactLaw, &|setting| setting.law = law);
        }
        if self.projection == Projection::Exact {
            add(Knob::Projection, &|setting| {
                setting.projection = Projection::CantileverModes;
            });
        }
        settings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(law: ContactLaw, harmonics: HarmonicLevel) -> LadderSetting {
        LadderSetting {
            basis: BasisChoice::StickAttachment { stick: 4 },
            harmonics,
            samples_per_period: 64,
            residual_tolerance: 1e-8,
            peak_tolerance: 1e-3,
            law,
            projection: Projection::Exact,
        }
    }

    fn space(law: ContactLaw) -> LadderSpace {
        LadderSpace {
            whole_space: false,
            contact_rows: 12,
            most_vectors: 8,
            law,
            projection: Projection::Exact,
        }
    }

    #[test]
    fn the_laws_of_a_ladder_are_those_that_are_simpler() {
        let of = |law| {
            space(law)
                .laws()
                .into_iter()
                .map(ContactLaw::name)
                .collect::<Vec<_>>()
        };
        assert_eq!(of(ContactLaw::MacroSlip1d), ["macro_slip_1d"]);
        assert_eq!(
            of(ContactLaw::MacroSlip2d),
            ["macro_slip_1d", "macro_slip_2d"]
        );
        let to_simplified = of(ContactLaw::Simplified3d);
        assert_eq!(to_simplified.last(), Some(&"simplified_3d"));
        assert!(!to_simplified.contains(&"coulomb_3d"));
        assert_eq!(of(ContactLaw::Coulomb3d), ContactLaw::NAMES);
    }

    #[test]
    fn even_harmonics_under_a_constant_load_are_redundant() {
        use ContactLaw::{MacroSlip2d, Simplified3d};
        let redundant = |law, set: &[u32]| {
            let set = HarmonicLevel::Set(set.to_vec());
            setting(law, set).is_redundant()
        };
        assert!(redundant(MacroSlip2d, &[0, 1, 3]) && redundant(MacroSlip2d, &[1, 2, 3]));
        assert!(!redundant(MacroSlip2d, &[1, 3]) && !redundant(Simplified3d, &[1, 2, 3]));
        assert!(!setting(MacroSlip2d, HarmonicLevel::Automatic(0.01)).is_redundant());
    }
}
