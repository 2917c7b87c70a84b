//! Monte Carlo forced response of randomly mistuned bladed disks with friction dampers.
//!
//! A program states a sector, a [`Problem`] and [`Numerics`]; an [`Engine`] solves single wheels or a [`Population`]:
//!
//! ```
//! use blisk::{Damping, Distribution, Engine, LumpedOptions, Mistuning, Numerics, Problem, Quantity, lumped_sector};
//!
//! // One mass per sector, coupled to its neighbours (Rivas-Guerra and Mignolet).
//! let sector = lumped_sector(&LumpedOptions {
//!     sectors: 24,
//!     blade_mass_kg: 0.0114,
//!     blade_stiffness_n_per_m: 430_000.0,
//!     blade_coupling_stiffness_n_per_m: 45_430.0,
//!     ..LumpedOptions::default()
//! })?;
//! let damping = Damping::Rayleigh { mass_per_s: 1.443 / 0.0114, stiffness_s: 0.0 };
//! let wheels = Mistuning::Random { law: Distribution::Normal, standard_deviations: vec![0.02], seed: 20_240_917 };
//! let engine = Engine::build(&sector, &Problem::new(damping, &[3], wheels), &Numerics::default())?;
//! let population = engine.population(1000, &())?;
//! let p95 = population.percentile(&engine.scenarios()[0], Quantity::AmplificationFactor, 95.0);
//! let bounds = p95.value.zip(p95.lower.zip(p95.upper));
//! let (value, (lower, upper)) = bounds.expect("1000 wheels are enough for both bounds");
//! assert!((value - 1.396).abs() < 5e-4, "{value}");
//! // 20,000 other wheels have 1.3915 by another program (tests/cases/one_dof.rs).
//! assert!(lower < 1.3915 && 1.3915 < upper);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | to | there is |
//! | --- | --- |
//! | make a sector | [`lumped_sector`], [`parametric_sector`], [`read_sector`]; [`sector`] for matrices of your own |
//! | say what is solved, and how | [`Problem`], [`options`]; [`Numerics`] |
//! | solve | [`Engine::peak`], [`Engine::population`] |
//! | read what was found | [`ResponseRow`], [`Population::percentile`], [`Population::statistics`] |
//! | carry out a study file | [`Study`], `run` |
//!
//! The feature `parquet` has results folders and `run`, the feature `cli` the command line. Both are on by default; the rest needs
//! neither. Three programs stand in `examples/`. What is hidden from this page may change at any time.

// Without the command line some of what serves results folders alone is not used, and it is not worth a condition each.
#![cfg_attr(not(feature = "cli"), allow(dead_code, unused_imports))]

// The way of the data, and the order in which modules may name each other (each only those before
// it; a test holds it):
//
// | wing | rooms, in order | holds |
// | --- | --- | --- |
// | `identity` | | what the program was built from |
// | `platform` | | what the operating system says of machine and processes |
// | `linalg` | | a thin layer over faer |
// | `input` | | the keys of TOML files, and what is wrong with them |
// | `model` | `sector`, `cyclic`, `reduced_model`, `reduction`, `cache` | from a sector to the reduced model |
// | `response` | `mistuning`, `friction`, `harmonic_balance`, `receptance`, `forced_response`, `stability` | one wheel to its peak |
// | `verification` | `reference`, `time_integration` | what rows are verified by |
// | `population` | `monte_carlo`, `statistics`, `table` | all wheels to tables |
// | `report` | | the summary and its warnings |
// | `study` | | the study file |
// | `settings` | | what the numbers are solved with, chosen by measured error, and the engines |
// | `campaign` | `store`, `pipeline`, `commands` | a study carried out |
// | `library` | | problems that a program states in its own words |
// | `cli` | | the commands; the only code that prints |

#[cfg(feature = "parquet")]
#[doc(hidden)]
pub mod campaign;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod identity;
#[doc(hidden)]
pub mod input;
mod library;
#[doc(hidden)]
pub mod linalg;
#[doc(hidden)]
pub mod model;
#[doc(hidden)]
pub mod platform;
#[doc(hidden)]
pub mod population;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod response;
#[doc(hidden)]
pub mod settings;
#[doc(hidden)]
pub mod study;
#[doc(hidden)]
pub mod verification;

// The face, in the order of a program that uses it.
pub use model::sector::bundle::read as read_sector;
pub use model::sector::lumped::build as lumped_sector;
pub use model::sector::parametric::build as parametric_sector;
pub use model::sector::{LumpedOptions, ParametricOptions, SectorModel};

pub use library::{Mistuning, Problem};
pub use response::forced_response::ContactCondition;
pub use response::friction::ContactOptions;
pub use response::harmonic_balance::Damping;
pub use response::mistuning::Distribution;

pub use library::{Engine, Numerics};
pub use population::monte_carlo::{ResponseRow, Scenario};
pub use response::harmonic_balance::Status;
pub use response::mistuning::Pattern;

pub use library::Population;
pub use population::statistics::{Percentile, Quantity};

#[cfg(feature = "parquet")]
pub use campaign::{RunOutcome, RunRequest};
#[cfg(feature = "parquet")]
pub use library::run;
pub use settings::{Progress, Stage};
pub use study::{PipelineError, Study};

/// Parts of a [`SectorModel`], for matrices of your own.
pub mod sector {
    pub use crate::linalg::{Complex64, SymmetricSparse};
    pub use crate::model::sector::{
        Body, Component, ContactPair, ContactSide, Dof, ModelError, NamedContact, NamedMass,
        NamedSpring, ObservedNode, RigidPoint,
    };
}

/// What the fields of a [`Problem`], [`Numerics`] and their results can be.
pub mod options {
    pub use crate::model::reduction::Basis;
    pub use crate::population::monte_carlo::{LoadCaseName, TunedReference};
    pub use crate::population::statistics::{
        Accounting, PointStatus, SampleStatistics, ScenarioStatistics,
    };
    pub use crate::response::forced_response::{AmplitudeMeasure, FrequencyBand};
    pub use crate::response::friction::{ContactLaw, Ring};
    pub use crate::response::mistuning::{ContactFactors, Deviations, PairFactors};
}
