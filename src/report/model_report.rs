//! What `blisk model` tells about a model and its reduction.

use std::fmt;

use serde::Serialize;

use super::RotationFacts;
use super::text_table::TextTable;
use super::warning::Warning;
use super::words::basis_words;

/// Facts about one nodal diameter of the reduced model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodalDiameterFacts {
    /// Nodal diameter.
    pub nodal_diameter: usize,
    /// Independent dofs of the cyclic sector.
    pub dofs: usize,
    /// Vectors that went into the basis.
    pub candidates: usize,
    /// Rank of the basis: reduced coordinates.
    pub rank: usize,
    /// Condition of the basis before it was made orthonormal.
    pub condition: f64,
    /// Lowest natural frequencies with stuck contact, Hz.
    pub stick_frequencies_hz: Vec<f64>,
    /// Lowest natural frequencies with sliding contact, Hz.
    pub slide_frequencies_hz: Vec<f64>,
}

/// Facts about a model and its reduction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelReport {
    /// Name of the model.
    pub name: String,
    /// Sectors of the wheel.
    pub sectors: usize,
    /// Dofs of a sector, both faces included.
    pub sector_dofs: usize,
    /// Contact pairs of a sector.
    pub contact_pairs: usize,
    /// Nodes whose displacement is reported.
    pub observed: Vec<String>,
    /// Basis and its size, in words.
    pub basis: String,
    /// Reduced coordinates of the wheel.
    pub reduced_coordinates: usize,
    /// Measured relative error of the tuned nonlinear peak, where the basis was chosen by it.
    pub error: Option<f64>,
    /// Fixed-interface modes of the Craig-Bampton model, per nodal diameter.
    pub craig_bampton_modes: usize,
    /// Largest relative change of a tuned peak by more fixed-interface modes; zero where none is left
    /// out, none where no tuned peak was found.
    pub craig_bampton_error: Option<f64>,
    /// Highest fixed-interface frequency over what it should be, 1 is enough; none where no mode
    /// is left out.
    pub craig_bampton_reach: Option<f64>,
    /// Normal loads by rotation, where the study has such.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<RotationFacts>,
    /// What is not accurate enough.
    pub warnings: Vec<Warning>,
    /// Memory of the reduced model, bytes.
    pub memory_bytes: usize,
    /// Digest under which the reduced model is cached.
    pub digest: String,
    /// Nodal diameters 0 to N/2.
    pub nodal_diameters: Vec<NodalDiameterFacts>,
}

impl fmt::Display for ModelReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "model {}: {} sectors of {} dofs, {} contact pairs each, observed {}",
            self.name,
            self.sectors,
            self.sector_dofs,
            self.contact_pairs,
            self.observed.join(", ")
        )?;
        write!(
            f,
            "{}: {} reduced coordinates, {:.1} MiB",
            basis_words(&self.basis),
            self.reduced_coordinates,
            self.memory_bytes as f64 / f64::from(1 << 20)
        )?;
        match self.error {
            Some(error) => writeln!(f, ", tuned peak within {:.2} %", 100.0 * error)?,
            None => writeln!(f)?,
        }
        if let Some(reach) = self.craig_bampton_reach {
            write!(
                f,
                "{} fixed-interface modes reach {reach:.1} times the frequency needed",
                self.craig_bampton_modes
            )?;
            match self.craig_bampton_error {
                Some(error) => {
                    let percent = 100.0 * error;
                    writeln!(f, "; more change the tuned peak by {percent:.2} %")?;
                }
                None => writeln!(f)?,
            }
        }
        if let Some(rotation) = &self.rotation {
            writeln!(f, "{rotation}")?;
        }
        for warning in &self.warnings {
            writeln!(f, "warning: {warning}")?;
        }
        let mut table =
            TextTable::new(&["ND", "dofs", "rank", "condition", "stick Hz", "slide Hz"]);
        for facts in &self.nodal_diameters {
            table.row(vec![
                facts.nodal_diameter.to_string(),
                facts.dofs.to_string(),
                format!("{}/{}", facts.rank, facts.candidates),
                format!("{:.1e}", facts.condition),
                frequencies(&facts.stick_frequencies_hz),
                frequencies(&facts.slide_frequencies_hz),
            ]);
        }
        write!(f, "\n{table}")
    }
}

fn frequencies(hz: &[f64]) -> String {
    hz.iter()
        .take(4)
        .map(|hz| format!("{hz:.2}"))
        .collect::<Vec<_>>()
        .join(" ")
}
