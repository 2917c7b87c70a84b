//! `[nodal_diameter_damping]`: damping ratios by nodal diameter, for instance aerodynamic ones.

use serde_json::{Value, json};

use super::{Problem, Study, StudyError};
use crate::model::reduction::{DampedModes, NodalDiameterDamping};
use crate::model::sector::SectorModel;

/// Damping ratios by nodal diameter as a study has them.
#[derive(Debug, Clone, PartialEq)]
pub struct NodalDiameterTable {
    /// Nodal diameters with their ratios, as written; the others have none.
    pub ratios: Vec<(u32, f64)>,
    /// Which modes they damp.
    pub modes: DampedModes,
}

impl NodalDiameterTable {
    /// As the study file has it.
    pub(super) fn resolved(&self) -> Value {
        json!({ "damping_ratios": self.ratios, "modes": self.modes })
    }
}

impl Study {
    /// What damps the modes of the tuned wheel besides `[damping]`.
    #[must_use]
    pub fn added_damping(&self) -> NodalDiameterDamping {
        let Some(table) = &self.nodal_diameter_damping else {
            return NodalDiameterDamping::default();
        };
        let last = table.ratios.iter().map(|&(h, _)| h as usize).max();
        let mut ratios = vec![0.0; last.map_or(0, |last| last + 1)];
        for &(h, ratio) in &table.ratios {
            ratios[h as usize] = ratio;
        }
        NodalDiameterDamping {
            ratios,
            modes: table.modes,
        }
    }

    /// Refuses nodal diameters that the wheel does not have.
    pub(super) fn check_nodal_diameters(&self, model: &SectorModel) -> Result<(), StudyError> {
        let last = model.sectors / 2;
        let findings: Vec<_> = self
            .nodal_diameter_damping
            .iter()
            .flat_map(|table| table.ratios.iter().enumerate())
            .filter(|(_, (h, _))| *h as usize > last)
            .map(|(place, _)| {
                let key = format!("nodal_diameter_damping.damping_ratios[{place}]");
                let problem = Problem::NotAccepted {
                    value: self.map.value(&key),
                    accepted: format!(
                        "nodal diameters from 0 to {last}, those of {} sectors",
                        model.sectors
                    ),
                    suggestion: None,
                };
                self.map.finding(&key, problem)
            })
            .collect();
        if findings.is_empty() {
            return Ok(());
        }
        Err(StudyError::Invalid {
            path: self.path.clone(),
            findings,
        })
    }
}
