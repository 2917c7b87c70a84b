//! The reference that settings are judged by: every knob at its best.
//!
//! All knobs at their best at once is what is wanted, and what is solved where the equation is small. On
//! larger models that costs minutes a row. There the base setting is taken with one knob at its best at
//! a time (basis, harmonics, numerical tolerances), and the ratios to the base are multiplied:
//!
//! ```text
//! A_ref = A_base  (A_basis / A_base)  (A_harmonics / A_base)  (A_tolerances / A_base)
//! ```
//!
//! Left out is what two knobs do together beyond the product of what they do alone.

use super::bench::{LadderBench, LadderValues};
use super::measure::Measured;
use super::{HarmonicLevel, Knob, LadderSetting};
use crate::model::reduction::{Basis, BasisChoice, ReductionOptions};
use crate::response::forced_response::Harmonics;
use crate::response::mistuning::PatternSource;
use crate::settings::basis_choice::{
    Judged, choose_basis_under, judged_conditions, judged_variations,
};
use crate::settings::row_settings::row_settings;
use crate::study::{Excitation, PipelineError, excitations};

/// Relative error of the tuned peak by which the basis of the base is chosen.
const BASE_ERROR: f64 = 5e-3;
/// Relative error of the tuned peak by which the best `stick_slide` is chosen.
const BEST_ERROR: f64 = 1e-4;
/// Stick modes of the best basis, beside its attachment vectors.
const BEST_STICK: usize = 8;
/// Vectors per nodal diameter up to which attachment vectors are the best basis.
const MOST_ATTACHMENT: usize = 24;
/// Unknowns up to which all knobs are at their best at once.
const JOINT_UNKNOWNS: usize = 1600;
/// Harmonics of the base, without and with contacts that separate.
const BASE_HARMONICS: [&[u32]; 2] = [&[1, 3], &[0, 1, 2, 3]];
/// Samples, residual and tolerance of the peak of the base and of the reference.
const BASE_TOLERANCES: (usize, f64, f64) = (128, 1e-8, 1e-3);
const BEST_TOLERANCES: (usize, f64, f64) = (512, 1e-10, 1e-4);

/// How the reference was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceKind {
    /// All knobs at their best at once.
    Joint,
    /// One knob at its best at a time, ratios multiplied.
    ByKnobs,
}

impl ReferenceKind {
    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::ByKnobs => "by_knobs",
        }
    }
}

/// Reference results of a sample.
#[derive(Debug, Clone, PartialEq)]
pub struct LadderReference {
    /// How it was found.
    pub kind: ReferenceKind,
    /// Values, ordered as the rows of the sample.
    pub values: Vec<LadderValues>,
    /// Values of the reference by ratios, ordered as the rows of the sample, whatever the kind.
    pub by_ratios: Vec<LadderValues>,
    /// The base setting.
    pub base: Measured,
    /// The base with one knob at its best each; the last is the joint reference, if it was solved.
    pub parts: Vec<Measured>,
    /// Where the joint reference was solved: largest relative difference of the amplitude by ratios.
    pub product_error: Option<f64>,
}

/// The best level of every knob, and the base from which single knobs are moved.
#[derive(Debug, Clone, PartialEq)]
pub struct LadderEnds {
    /// The base.
    pub base: LadderSetting,
    /// The best.
    pub best: LadderSetting,
}

impl LadderEnds {
    /// Chooses them for the model of `bench`; `tolerance` is that of the best harmonics.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub fn choose(bench: &mut LadderBench<'_>, tolerance: f64) -> Result<Self, PipelineError> {
        let with_attachments = bench.reduction().contact_rows() + BEST_STICK;
        let best_basis = if bench.reduction().is_whole_space() {
            BasisChoice::CraigBampton
        } else if with_attachments <= MOST_ATTACHMENT {
            BasisChoice::StickAttachment { stick: BEST_STICK }
        } else {
            basis_within(bench, Basis::StickSlide, BEST_ERROR)?
        };
        let base_basis = basis_within(bench, Basis::StickSlide, BASE_ERROR)?;
        let setting = |basis, harmonics, (samples, residual, peak)| LadderSetting {
            basis,
            harmonics,
            samples_per_period: samples,
            residual_tolerance: residual,
            peak_tolerance: peak,
            law: bench.law(),
            projection: bench.study().mistuning.projection,
        };
        let base = |set: &[u32]| {
            let harmonics = HarmonicLevel::Set(set.to_vec());
            setting(base_basis, harmonics, BASE_TOLERANCES)
        };
        let [closed, separating] = BASE_HARMONICS.map(base);
        let automatic = HarmonicLevel::Automatic(tolerance);
        let best = setting(best_basis, automatic, BEST_TOLERANCES);
        let separates = bench.law().has_variable_load() && bench.engine(&closed)?.separates();
        Ok(Self {
            base: if separates { separating } else { closed },
            best,
        })
    }

    /// The base with all tolerances at their best.
    fn fine(&self) -> LadderSetting {
        self.base
            .with(Knob::SamplesPerPeriod, &self.best)
            .with(Knob::ResidualTolerance, &self.best)
            .with(Knob::PeakTolerance, &self.best)
    }
}

/// The smallest basis of a family whose tuned peaks are within `error`.
fn basis_within(
    bench: &LadderBench<'_>,
    family: Basis,
    error: f64,
) -> Result<BasisChoice, PipelineError> {
    let mut study = bench.study().clone();
    study.solver.harmonics = Harmonics::Set(BASE_HARMONICS[0].to_vec());
    let conditions = judged_conditions(&study.contacts);
    let varied = judged_variations(&study.contact_variations);
    let excitations = excitations(&study);
    let settings: Vec<_> = excitations
        .iter()
        .map(|case| row_settings(&case.study))
        .collect();
    let judged = |(case, settings)| {
        let case: &Excitation = case;
        let judged = Judged {
            settings,
            engine_orders: &case.study.engine_orders,
            conditions: &conditions,
            sets: &[],
            varied: &varied,
        };
        (case, judged)
    };
    let cases: Vec<_> = excitations.iter().zip(&settings).map(judged).collect();
    let options = ReductionOptions {
        basis: family,
        error,
        ..ReductionOptions::default()
    };
    Ok(choose_basis_under(bench.reduction(), &options, &cases)?.0)
}

impl LadderReference {
    /// Solves the reference on the patterns `ids` of the sample of `bench`.
    ///
    /// # Errors
    /// The model cannot be reduced, or the samples cannot tell the harmonics apart.
    pub fn solve(
        bench: &mut LadderBench<'_>,
        ends: &LadderEnds,
        patterns: &PatternSource,
    ) -> Result<Self, PipelineError> {
        let ids = bench.sample().patterns.clone();
        let mut measure = |setting: LadderSetting, knob| -> Result<Measured, PipelineError> {
            let engine = bench.engine(&setting)?;
            let rows = engine.rows(patterns, &ids);
            Ok(Measured::new(setting, knob, &engine, rows))
        };
        let base = measure(ends.base.clone(), None)?;
        let mut parts = Vec::new();
        for (knob, setting) in [
            (Knob::Basis, ends.base.with(Knob::Basis, &ends.best)),
            (Knob::Harmonics, ends.base.with(Knob::Harmonics, &ends.best)),
            (Knob::SamplesPerPeriod, ends.fine()),
        ] {
            if setting != ends.base {
                parts.push(measure(setting, Some(knob))?);
            }
        }
        let of_parts = |row: usize| {
            let of_base = base.rows[row].values;
            parts.iter().fold(of_base, |product, part| {
                product.changed(&part.rows[row].values, &of_base)
            })
        };
        let by_ratios: Vec<LadderValues> = (0..base.rows.len()).map(of_parts).collect();
        let coordinates = |part: &Measured| part.sizes.iter().map(|size| size.coordinates).max();
        let coefficients = |part: &Measured| part.sizes.iter().map(|size| size.coefficients).max();
        let largest = |of: &dyn Fn(&Measured) -> Option<usize>| {
            let all = parts.iter().chain([&base]);
            all.filter_map(of).max().unwrap_or(0)
        };
        let unknowns = largest(&coordinates) * largest(&coefficients);
        if unknowns > JOINT_UNKNOWNS {
            return Ok(Self {
                kind: ReferenceKind::ByKnobs,
                values: by_ratios.clone(),
                by_ratios,
                base,
                parts,
                product_error: None,
            });
        }
        let joint = measure(ends.best.clone(), None)?;
        let values = joint.values();
        let differences = by_ratios
            .iter()
            .zip(&values)
            .filter_map(|(product, joint)| {
                Some((product.amplitude_m? / joint.amplitude_m? - 1.0).abs())
            });
        let product_error = differences.reduce(f64::max);
        parts.push(joint);
        Ok(Self {
            kind: ReferenceKind::Joint,
            values,
            by_ratios,
            base,
            parts,
            product_error,
        })
    }

    /// Most operations of a row that the reference was made of: nothing dearer is worth a try.
    #[must_use]
    pub fn most_operations(&self) -> f64 {
        let parts = self.parts.iter().chain([&self.base]);
        parts.map(Measured::operations).fold(0.0, f64::max)
    }
}
