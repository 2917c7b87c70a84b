//! What the solution of a point needs besides the structure.

use std::sync::Arc;

use super::error_settings::ErrorSettings;
use super::observed_amplitude::ObservedAmplitude;
use super::options::{
    FEWER_HARMONICS, Harmonics, SearchHarmonics, SolverOptions, samples_per_period,
};
use crate::model::cyclic::ContactGeometry;
use crate::response::friction::{ContactLaw, PairParameters, Ring};
use crate::response::harmonic_balance::{
    ContactInterface, EnlargedSet, HarmonicTransform, NewtonBounds, TransformError,
};
use crate::response::mistuning::ContactFactors;

/// Harmonics that lead to the top before all of an automatic set are solved there.
const GUIDE: [u32; 2] = [1, 3];
/// Share of the samples asked for that they are sampled with.
const SAMPLES_OF_GUIDE: (usize, usize) = (1, 2);
/// Harmonics that lead to the top where contacts open: a pair that opens moves apart in the mean, and twice a period.
const OPENING: [u32; 4] = [0, 1, 2, 3];

/// Everything of a study that the solution of a point needs besides the structure.
#[derive(Debug, Clone)]
pub struct PointSettings {
    pub(super) harmonics: Vec<u32>,
    pub(super) transform: Arc<HarmonicTransform>,
    pub(super) amplitude: ObservedAmplitude,
    errors: Arc<ErrorSettings>,
    pub(super) bounds: NewtonBounds,
    /// Whether the tolerance of the residual was asked for.
    pub(super) residual_is_stated: bool,
    pub(super) contact: Option<(ContactLaw, PairParameters)>,
    pub(super) ring: Ring,
    pub(super) geometry: ContactGeometry,
    pub(super) factors: ContactFactors,
    /// Settings with the harmonics of the search for the top, where these are fewer than all.
    search: Option<Box<Self>>,
    /// Settings with the harmonics that lead to the top before all of them are solved there, where there are such.
    guide: Option<Box<Self>>,
    /// Settings with the harmonics of the search for the top where contacts open, where there are such.
    opening: Option<Box<Self>>,
    /// Whether a row that has no peak with these harmonics is solved with fewer: an automatic set on tuned receptances.
    fewer_follow: bool,
}

impl PointSettings {
    /// `harmonics` ascending, with 1; `contact` is the law with its per-sector parameters (the
    /// normal load is set per scenario).
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(
        options: &SolverOptions,
        harmonics: &[u32],
        contact: Option<(ContactLaw, PairParameters)>,
        geometry: ContactGeometry,
    ) -> Result<Self, TransformError> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let samples = samples_per_period(options, harmonics);
        let law = contact.map(|(law, _)| law);
        let sought = sought(&options.search_harmonics, harmonics);
        let search = match &sought {
            Some(sought) if contact.is_some() => {
                let search = Self::new(options, sought, contact, geometry.clone())?;
                Some(Box::new(search))
            }
            _ => None,
        };
        let fewer_follow = options.harmonics == Harmonics::Auto
            && search.is_some()
            && harmonics.last() > FEWER_HARMONICS.last();
        let guided = fewer_follow && is_everything(harmonics);
        let guide = guided.then(|| {
            let settings = Self::new(options, &GUIDE, contact, geometry.clone())?;
            let (share, whole) = SAMPLES_OF_GUIDE;
            settings.at_samples(share * options.samples_per_period / whole)
        });
        let opens = fewer_follow && OPENING.iter().all(|k| harmonics.contains(k));
        let opening = opens.then(|| Self::new(options, &OPENING, contact, geometry.clone()));
        Ok(Self {
            search,
            opening: opening.transpose()?.map(Box::new),
            guide: guide.transpose()?.map(Box::new),
            harmonics: harmonics.to_vec(),
            transform: Arc::new(HarmonicTransform::new(&set, samples)?),
            amplitude: ObservedAmplitude::new(options.amplitude, harmonics, options.time_samples)?,
            errors: Arc::new(ErrorSettings::new(options, harmonics, law)?),
            bounds: NewtonBounds::with_tolerance(options.residual_tolerance),
            residual_is_stated: options.residual_is_stated,
            contact,
            ring: Ring::Locked,
            geometry,
            factors: ContactFactors::default(),
            fewer_follow,
        })
    }

    /// These settings with what a free ring does under mean friction; it is locked at first.
    #[must_use]
    pub fn with_ring(self, ring: Ring) -> Self {
        let same = |settings: Option<Box<Self>>| {
            settings.map(|settings| Box::new(settings.with_ring(ring)))
        };
        Self {
            ring,
            search: same(self.search),
            guide: same(self.guide),
            opening: same(self.opening),
            ..self
        }
    }

    /// Copy of these settings for a wheel whose contact differs from the nominal one by `factors`.
    #[must_use]
    pub fn with_factors(&self, factors: &ContactFactors) -> Self {
        let same = |settings: &Option<Box<Self>>| {
            let settings = settings.as_ref();
            settings.map(|settings| Box::new(settings.with_factors(factors)))
        };
        Self {
            factors: factors.clone(),
            search: same(&self.search),
            guide: same(&self.guide),
            opening: same(&self.opening),
            ..self.clone()
        }
    }

    /// These settings with fewer samples in the search with fewer harmonics: those that its harmonics need, but not fewer than
    /// `least`.
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with them.
    pub fn with_search_samples(self, least: usize) -> Result<Self, TransformError> {
        let Some(mut search) = self.search else {
            return Ok(self);
        };
        let set = search.transform.harmonics().to_vec();
        let highest = set.last().copied().unwrap_or(1);
        let samples = least.max(8 * highest).min(search.transform.n_samples());
        search.transform = Arc::new(HarmonicTransform::new(&set, samples)?);
        Ok(Self {
            search: Some(search),
            ..self
        })
    }

    /// These settings with all harmonics in the search.
    #[must_use]
    pub fn without_search(self) -> Self {
        Self {
            search: None,
            ..self
        }
    }

    /// These settings at the samples of others.
    ///
    /// # Errors
    /// If their harmonics cannot be told apart with them.
    pub(super) fn at_samples_of(&self, other: &Self) -> Result<Self, TransformError> {
        self.clone().at_samples(other.transform.n_samples())
    }

    /// These settings with `samples` samples per period.
    fn at_samples(self, samples: usize) -> Result<Self, TransformError> {
        let transform = HarmonicTransform::new(self.transform.harmonics(), samples)?;
        Ok(Self {
            transform: Arc::new(transform),
            ..self
        })
    }

    /// Settings for the same law, pairs, contact factors and ring in other harmonics.
    ///
    /// # Errors
    /// If these cannot be told apart with the samples asked for.
    pub fn with_harmonics(
        &self,
        harmonics: &[u32],
        options: &SolverOptions,
    ) -> Result<Self, TransformError> {
        let other = Self::new(options, harmonics, self.contact, self.geometry.clone())?;
        Ok(other.with_ring(self.ring).with_factors(&self.factors))
    }

    /// The pairs of the wheel under a law and a normal load.
    #[must_use]
    pub fn interface(
        &self,
        law: ContactLaw,
        sector: PairParameters,
        normal_load_n: f64,
    ) -> ContactInterface {
        ContactInterface {
            law,
            pairs: sector.pairs_under(normal_load_n, &self.geometry, &self.factors),
            geometry: self.geometry.clone(),
        }
    }

    /// Harmonic set of the nonlinear solution.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// Settings of a search with fewer harmonics, if there is one, see [`super::corrected_peak`].
    #[must_use]
    pub fn search(&self) -> Option<&Self> {
        self.search.as_deref()
    }

    /// Settings with the harmonics that lead to the top before all of them are solved there, if there are such: an automatic set on
    /// tuned receptances.
    #[must_use]
    pub fn guide(&self) -> Option<&Self> {
        self.guide.as_deref()
    }

    /// Whether a row that has no peak with these harmonics is solved with fewer of them.
    #[must_use]
    pub fn fewer_follow(&self) -> bool {
        self.fewer_follow
    }

    /// Settings of the search where contacts open, if there is one: an automatic set on tuned receptances that has the mean motion.
    #[must_use]
    pub fn opening(&self) -> Option<&Self> {
        self.opening.as_deref()
    }

    /// How the errors of a solution are estimated.
    #[must_use]
    pub fn errors(&self) -> &ErrorSettings {
        &self.errors
    }
}

/// Harmonics of the search for tops of rows with `harmonics`; none where all of them are sought with.
fn sought(search: &SearchHarmonics, harmonics: &[u32]) -> Option<Vec<u32>> {
    let sought: Vec<u32> = match search {
        SearchHarmonics::All => return None,
        SearchHarmonics::Auto => vec![1],
        SearchHarmonics::Set(set) => {
            let counted = harmonics.iter().filter(|harmonic| set.contains(harmonic));
            counted.copied().collect()
        }
    };
    (sought.len() < harmonics.len()).then_some(sought)
}

/// Whether a set has everything that a law without separation excites, up to the highest that is looked at.
fn is_everything(harmonics: &[u32]) -> bool {
    let everything = EnlargedSet::everything(false);
    everything.iter().all(|k| harmonics.contains(k))
}
