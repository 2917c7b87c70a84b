//! What a study says about the physics of a row, and the settings of its points: the harmonics of each scenario.

use std::borrow::Cow;

use serde::Serialize;

use super::{ErrorTolerance, HarmonicChoice, sampling_tolerance};
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, Harmonics, PointSettings, SearchHarmonics, SolverOptions,
};
use crate::response::friction::{ContactLaw, PairParameters, Ring};
use crate::response::harmonic_balance::{Damping, TransformError};
use crate::response::mistuning::{Pattern, Projection};

/// Unknowns of the contact up to which a search with fewer harmonics costs as much as one with all of them.
const UNKNOWNS_WITHOUT_SEARCH: usize = 300;

/// What a study says about the physics of a row.
#[derive(Debug, Clone, Serialize)]
pub struct RowSettings {
    /// Harmonic set under the contact law, ascending, with 1.
    pub harmonics: Vec<u32>,
    /// Contact law and its parameters per sector; none for a model without contact.
    pub contact: Option<(ContactLaw, PairParameters)>,
    /// What a free ring does under mean friction.
    pub ring: Ring,
    /// Damping of the structure.
    pub damping: Damping,
    /// Factor on the model's force vector.
    pub amplitude_n: f64,
    /// How a deviation enters the reduced stiffness.
    pub projection: Projection,
    /// Settings of the solution.
    pub solver: SolverOptions,
}

impl RowSettings {
    /// What points with `harmonics` need.
    fn points(
        &self,
        harmonics: &[u32],
        model: &ReducedModel,
    ) -> Result<PointSettings, TransformError> {
        let geometry = model.contact.clone();
        let points = PointSettings::new(&self.solver, harmonics, self.contact, geometry)?;
        Ok(points.with_ring(self.ring))
    }

    pub(super) fn tolerance(&self) -> ErrorTolerance {
        ErrorTolerance {
            sampling: sampling_tolerance(self.solver.peak_tolerance),
            harmonics: self.solver.harmonic_tolerance,
        }
    }
}

/// The settings of the points of all scenarios of a force vector.
#[derive(Debug)]
pub(super) struct RowPoints {
    pub(super) settings: RowSettings,
    full: PointSettings,
    linear: PointSettings,
    /// Sets that differ from scenario to scenario; the others have that of the settings.
    chosen: Vec<(HarmonicChoice, PointSettings)>,
}

impl RowPoints {
    /// With the harmonics of the settings.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub(super) fn new(settings: RowSettings, model: &ReducedModel) -> Result<Self, TransformError> {
        Ok(Self {
            full: settings.points(&settings.harmonics, model)?,
            linear: settings.points(&[1], model)?,
            settings,
            chosen: Vec::new(),
        })
    }

    /// From now on with the harmonic sets chosen for single scenarios.
    pub(super) fn choose(
        &mut self,
        choices: Vec<HarmonicChoice>,
        model: &ReducedModel,
    ) -> Result<(), TransformError> {
        let settings = &self.settings;
        let chosen = choices.into_iter().map(|choice| {
            let points = settings.points(&choice.harmonics, model)?;
            Ok((choice, points))
        });
        self.chosen = chosen.collect::<Result<_, TransformError>>()?;
        Ok(())
    }

    /// From now on for rows on tuned receptances, those of a basis or all: a search with fewer harmonics has so many samples per period, and
    /// there is none with a creeping ring, nor where harmonics that are stated, or those of a basis, give the contact of all `sectors` few
    /// unknowns, unless the study asks for it.
    pub(super) fn search_on_receptances(
        &mut self,
        (samples, of_basis): (usize, bool),
        (sectors, rows): (usize, usize),
    ) -> Result<(), TransformError> {
        let solver = &self.settings.solver;
        let goes_without = (of_basis || solver.harmonics != Harmonics::Auto)
            && solver.search_harmonics == SearchHarmonics::Auto;
        let creeps = self.settings.ring == Ring::Creeping;
        let unknowns = |points: &PointSettings| 2 * points.harmonics().len() * sectors * rows;
        let chosen = self.chosen.iter_mut().map(|(_, points)| points);
        for points in std::iter::once(&mut self.full).chain(chosen) {
            let own = points.clone();
            *points = if creeps || goes_without && unknowns(points) <= UNKNOWNS_WITHOUT_SEARCH {
                own.without_search()
            } else {
                own.with_search_samples(samples)?
            };
        }
        Ok(())
    }

    /// Harmonic sets chosen for single scenarios.
    pub(super) fn choices(&self) -> impl Iterator<Item = &HarmonicChoice> {
        self.chosen.iter().map(|(choice, _)| choice)
    }

    pub(super) fn choice(
        &self,
        engine_order: u32,
        contact: ContactCondition,
    ) -> Option<&HarmonicChoice> {
        let chosen = self.chosen(engine_order, contact);
        chosen.map(|(choice, _)| choice)
    }

    fn chosen(
        &self,
        engine_order: u32,
        contact: ContactCondition,
    ) -> Option<&(HarmonicChoice, PointSettings)> {
        self.chosen
            .iter()
            .find(|(choice, _)| choice.engine_order == engine_order && choice.contact == contact)
    }

    /// The settings of a point of a wheel with the nominal contact.
    pub(super) fn nominal(&self, engine_order: u32, contact: ContactCondition) -> &PointSettings {
        match (contact, self.chosen(engine_order, contact)) {
            (ContactCondition::Full { .. }, Some((_, points))) => points,
            (ContactCondition::Full { .. }, None) => &self.full,
            _ => &self.linear,
        }
    }

    /// The settings of a point of the wheel with `pattern`; none means the tuned wheel.
    pub(super) fn of<'a>(
        &'a self,
        pattern: impl Into<Option<&'a Pattern>>,
        engine_order: u32,
        contact: ContactCondition,
    ) -> Cow<'a, PointSettings> {
        let points = self.nominal(engine_order, contact);
        match pattern.into().map(|pattern| &pattern.contact) {
            Some(factors) if !factors.is_nominal() => Cow::Owned(points.with_factors(factors)),
            _ => Cow::Borrowed(points),
        }
    }
}
