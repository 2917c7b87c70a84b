//! Harmonics other than 1 in the tuned wheel: where rows are solved so, and with what.

use std::sync::Arc;

use super::RowSolver;
use super::operations::TunedSize;
use crate::model::ReducedModel;
use crate::response::forced_response::{
    ContactCondition, Excited, HigherHarmonics, LimitsWanted, PointSettings,
};
use crate::response::harmonic_balance::TunedWaves;
use crate::response::mistuning::{ContactFactors, Pattern};

/// The tuned wheel that harmonics other than 1 are taken in.
#[derive(Debug)]
pub(super) struct TunedHarmonics {
    model: Arc<ReducedModel>,
    waves: Arc<TunedWaves>,
}

impl RowSolver {
    /// The same solver with harmonics other than 1 on `model`, the tuned wheel with all its modes, where the settings
    /// ask for it.
    #[must_use]
    pub fn with_tuned_harmonics(mut self, model: Option<Arc<ReducedModel>>) -> Self {
        let asked = self.settings.solver.higher_harmonics == HigherHarmonics::Tuned;
        self.tuned_harmonics = model.filter(|_| asked).and_then(|model| {
            let waves = Arc::new(TunedWaves::new(&model, self.settings.damping)?);
            Some(TunedHarmonics { model, waves })
        });
        self
    }

    /// What the harmonics other than 1 of a row are taken in; none where they are those of the mistuned wheel: with
    /// harmonic 0, for which contact that opens asks and which the others couple with closely.
    pub(super) fn waves(
        &self,
        pattern: &Pattern,
        points: &PointSettings,
    ) -> Option<&Arc<TunedWaves>> {
        let tuned = self.tuned_harmonics.as_ref()?;
        let alike = pattern.contact.is_nominal();
        (alike && !points.harmonics().contains(&0)).then_some(&tuned.waves)
    }

    /// Size of the tuned wheel that the other harmonics of a set are taken in.
    pub(super) fn tuned_size(&self, harmonics: &[u32]) -> Option<TunedSize> {
        let tuned = self.tuned_harmonics.as_ref()?;
        let diameters = tuned.model.nodal_diameters.iter();
        (!harmonics.contains(&0)).then(|| TunedSize {
            sectors: tuned.model.sectors,
            modes: diameters
                .map(|own| own.eigenvalues.len())
                .max()
                .unwrap_or(0),
        })
    }

    /// The tuned wheel with the given harmonics, those other than 1 on the model that rows have them on.
    pub(super) fn tuned_waves(
        &self,
        engine_order: u32,
        contact: ContactCondition,
        harmonics: &[u32],
    ) -> Excited {
        let own =
            self.tuned_waves_with(&ContactFactors::default(), engine_order, contact, harmonics);
        let set = self.points(engine_order, contact).harmonics();
        match &self.tuned_harmonics {
            Some(tuned) if !set.contains(&0) => own.with_harmonics_of(Excited::tuned(
                &tuned.model,
                &ContactFactors::default(),
                engine_order,
                self.settings.amplitude_n,
                self.settings.damping,
                harmonics,
                LimitsWanted::default(),
            )),
            _ => own,
        }
    }
}
