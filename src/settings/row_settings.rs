//! The physics of a row as a study states it, for the reduced and for the full-contact model.

use std::sync::Arc;

use crate::model::reduction::ContactStiffness;
use crate::population::monte_carlo::RowSettings;
use crate::response::forced_response::Harmonics;
use crate::response::friction::{ContactOptions, Ring};
use crate::response::harmonic_balance::HarmonicTransform;
use crate::study::Study;
use crate::verification::reference::ReferenceSettings;

/// Harmonics that an automatic set begins with.
const FIRST_HARMONICS: [u32; 1] = [1];

/// The settings of the rows of `study`.
pub(super) fn row_settings(study: &Study) -> RowSettings {
    let harmonics = match &study.solver.harmonics {
        Harmonics::Set(set) => set.clone(),
        Harmonics::Auto => FIRST_HARMONICS.to_vec(),
    };
    RowSettings {
        harmonics,
        contact: study
            .contact
            .as_ref()
            .map(|contact| (contact.law, contact.sector_parameters(0.0))),
        ring: study
            .contact
            .as_ref()
            .map_or(Ring::Locked, |contact| contact.ring),
        damping: study.damping,
        amplitude_n: study.amplitude_n,
        projection: study.mistuning.projection,
        solver: study.solver.clone(),
    }
}

/// Linear contact springs of the law.
pub(crate) fn contact_stiffness(contact: Option<&ContactOptions>) -> ContactStiffness {
    let Some(contact) = contact else {
        return ContactStiffness {
            normal_n_per_m: 0.0,
            tangential_1_n_per_m: 0.0,
            tangential_2_n_per_m: 0.0,
        };
    };
    let normal = contact.normal_stiffness_n_per_m.unwrap_or(0.0);
    let tangential = contact.tangential_stiffness_n_per_m;
    let [normal, first, second] = contact.law.springs(normal, tangential);
    ContactStiffness {
        normal_n_per_m: normal,
        tangential_1_n_per_m: first,
        tangential_2_n_per_m: second,
    }
}

/// The settings of a study's rows as the full-contact model takes them.
pub(super) fn reference_settings(
    row: &RowSettings,
    transform: HarmonicTransform,
) -> ReferenceSettings {
    ReferenceSettings {
        transform: Arc::new(transform),
        residual_tolerance: ReferenceSettings::RESIDUAL_TOLERANCE,
        peak_tolerance: ReferenceSettings::PEAK_TOLERANCE,
        contact: row.contact,
        ring: row.ring,
        damping: row.damping,
        amplitude_n: row.amplitude_n,
        amplitude: row.solver.amplitude,
        time_samples: row.solver.time_samples,
        projection: row.projection,
    }
}
