//! Forces at the contact of a wheel beyond those of its springs, in some harmonics.

use super::fields::{Field, SectorTransform};
use super::motions::turned_field;

/// Contact forces of a wheel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactForces {
    pub(super) harmonics: Vec<u32>,
    /// Over the waves, a field per harmonic.
    pub(super) fields: Vec<Field>,
}

impl ContactForces {
    /// What these forces are more than `others`, in the harmonics of these others.
    #[must_use]
    pub fn beyond(&self, others: &Self) -> Self {
        let fields = others.harmonics.iter().zip(&others.fields);
        let beyond = fields.map(|(harmonic, other)| {
            let place = self
                .harmonics
                .iter()
                .position(|of_field| of_field == harmonic);
            let mut field = Field::zeros_like(other);
            field.add(-1.0, other);
            if let Some(place) = place {
                field.add(1.0, &self.fields[place]);
            }
            field
        });
        Self {
            harmonics: others.harmonics.clone(),
            fields: beyond.collect(),
        }
    }

    /// These forces, whose sectors are ahead by phases of harmonic 1, rad.
    pub(super) fn turned_ahead(&self, transform: &SectorTransform, phases: &[f64]) -> Self {
        let fields = self.harmonics.iter().zip(&self.fields);
        let turned = fields.map(|(&k, field)| turned_field(transform, field, k, phases));
        Self {
            harmonics: self.harmonics.clone(),
            fields: turned.collect(),
        }
    }

    /// The sum of forces in the same harmonics, each with its share; none of no forces.
    #[must_use]
    pub fn combined(shares: &[(f64, &Self)]) -> Option<Self> {
        let (_, first) = shares.first()?;
        let fields = (0..first.fields.len()).map(|place| {
            let mut sum = Field::zeros_like(&first.fields[place]);
            for (share, forces) in shares {
                sum.add(*share, &forces.fields[place]);
            }
            sum
        });
        Some(Self {
            harmonics: first.harmonics.clone(),
            fields: fields.collect(),
        })
    }
}
