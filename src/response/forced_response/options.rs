//! What a user chooses about the solution of one row, and the contact condition it is solved under.

use serde::{Deserialize, Serialize};

/// Samples per period of the highest harmonic of an automatic set at least.
const SAMPLES_OF_HIGHEST: usize = 12;
/// A number of samples is a multiple of this one: quarters of a period are whole vectors of the machine.
const SAMPLES_STEP: usize = 16;

/// Highest harmonics of the sets that are tried one after the other, on tuned receptances, where a peak is not found with all of an
/// automatic set.
pub const FEWER_HARMONICS: [u32; 3] = [9, 7, 5];

/// Temporal harmonics of the solution.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Harmonics {
    /// On tuned receptances 0 to 15, odd ones under a constant normal load, or up to 9, 7 or 5 where a peak is not found with more
    /// ([`FEWER_HARMONICS`]). On a basis a set per engine order and normal load, chosen by the tuned full contact model.
    Auto,
    /// This set, ascending; contains 1.
    Set(Vec<u32>),
}

/// Harmonics with which the tops of a row are sought, before the whole set is solved there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum SearchHarmonics {
    /// Harmonic 1 on tuned receptances, and 0 to 3 where contacts open and an automatic set goes beyond 5 and has these; the whole
    /// set where it is stated and the contact has few unknowns, and with a creeping ring.
    Auto,
    /// The whole set, without a search before.
    All,
    /// The harmonics of this set, ascending and with 1, that are in the set of the row.
    Set(Vec<u32>),
}

/// What becomes of a row whose error exceeds its tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RowsBeyondTolerance {
    /// The row is marked.
    Flag,
    /// With an automatic harmonic set on a basis, the row is solved again with more harmonics. On tuned receptances, where such a
    /// set has all of them, the row is marked.
    Resolve,
}

/// The displacement measure called amplitude, at the first observed node of a blade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AmplitudeMeasure {
    /// Euclidean norm over r, theta, z of the complex amplitude of the fundamental harmonic.
    Fundamental,
    /// Largest norm of the displacement over one period, harmonic 0 left out.
    TimeMaximum,
}

/// Band in which the peak is sought.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum FrequencyBand {
    /// Per row, from the stuck and slide linear models of the pattern.
    Auto,
    /// Fixed, Hz.
    Fixed {
        /// Lower end, Hz.
        start_hz: f64,
        /// Upper end, Hz.
        stop_hz: f64,
    },
}

/// Settings of the nonlinear solution and of the peak search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolverOptions {
    /// Harmonic set. Default auto.
    pub harmonics: Harmonics,
    /// Harmonics of the search. Default auto.
    pub search_harmonics: SearchHarmonics,
    /// Wanted relative error of the amplitude by the harmonics left out. Default 0.02.
    pub harmonic_tolerance: f64,
    /// What becomes of a row beyond it. Default flag.
    pub rows_beyond_tolerance: RowsBeyondTolerance,
    /// Time samples per period of the alternating frequency/time method; an automatic set takes at least
    /// 12 per period of its highest harmonic. Default 128.
    pub samples_per_period: usize,
    /// Bound on the residual. On a basis it is of the forces, relative to the excitation. On tuned receptances it is of the
    /// contact motions, relative to them, and harmonic k counts by `1/k`. Default 1e-8.
    pub residual_tolerance: f64,
    /// Whether it was asked for. Where it was not, the peak of a row with an automatic set of all harmonics on tuned receptances is
    /// solved to a tenth of the tolerance of the peak, and to a fifth where contacts open.
    pub residual_is_stated: bool,
    /// Relative tolerance of the peak amplitude in the peak search. Default 1e-3.
    pub peak_tolerance: f64,
    /// Measure called amplitude. Default fundamental.
    pub amplitude: AmplitudeMeasure,
    /// Instants of a period for [`AmplitudeMeasure::TimeMaximum`]. Default 1024.
    pub time_samples: usize,
    /// Searched band. Default auto.
    pub frequency_band: FrequencyBand,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            harmonics: Harmonics::Auto,
            search_harmonics: SearchHarmonics::Auto,
            harmonic_tolerance: 0.02,
            rows_beyond_tolerance: RowsBeyondTolerance::Flag,
            samples_per_period: 128,
            residual_tolerance: 1e-8,
            residual_is_stated: false,
            peak_tolerance: 1e-3,
            amplitude: AmplitudeMeasure::Fundamental,
            time_samples: 1024,
            frequency_band: FrequencyBand::Auto,
        }
    }
}

/// Samples per period of a solution in `harmonics`: those asked for; where the set is automatic, at least 12 per period of
/// the highest.
#[must_use]
pub fn samples_per_period(options: &SolverOptions, harmonics: &[u32]) -> usize {
    let highest = harmonics.last().map_or(1, |&k| k as usize);
    match options.harmonics {
        Harmonics::Auto => {
            let wanted = (SAMPLES_OF_HIGHEST * highest).next_multiple_of(SAMPLES_STEP);
            options.samples_per_period.max(wanted)
        }
        Harmonics::Set(_) => options.samples_per_period,
    }
}

/// Condition of the contact between blisk and ring in one scenario.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactCondition {
    /// The nonlinear contact law under this normal load per sector, N.
    Full {
        /// Normal load per sector, N.
        normal_load_n: f64,
    },
    /// Linear limit: normal and tangential contact springs bilateral.
    Stuck,
    /// Linear limit: normal contact springs only.
    Slide,
    /// Linear limit: no contact springs.
    Free,
}

impl ContactCondition {
    /// Name in the column `contact`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Full { .. } => "full",
            Self::Stuck => "stuck",
            Self::Slide => "slide",
            Self::Free => "free",
        }
    }

    /// Normal load per sector, N; none for the linear limits.
    #[must_use]
    pub fn normal_load_n(self) -> Option<f64> {
        match self {
            Self::Full { normal_load_n } => Some(normal_load_n),
            _ => None,
        }
    }
}
