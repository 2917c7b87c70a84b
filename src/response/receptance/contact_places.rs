//! Places of the coefficients of harmonics in a vector over the contact, and the way to fields over the waves and back.

use crate::response::harmonic_balance::WheelContact;

use super::fields::{Field, SectorTransform, padded, returned, turned};

/// Where the coefficients of the harmonics stand in a vector over the contact, see [`WheelContact`].
pub(super) struct Places {
    /// Harmonic and first coefficient of each of the set.
    pub(super) harmonics: Vec<(usize, usize)>,
    rows: usize,
}

impl Places {
    pub(super) fn of(contact: &WheelContact) -> Self {
        let mut first = 0;
        let harmonics = contact.transform().harmonics().iter().map(|&k| {
            let harmonic = (k, first);
            first += if k == 0 { 1 } else { 2 };
            harmonic
        });
        Self {
            harmonics: harmonics.collect(),
            rows: contact.sector_rows(),
        }
    }

    /// The coefficients of fields over the waves, one a harmonic; `sectors` is room for one of them.
    pub(super) fn to_sectors(
        &self,
        transform: &SectorTransform,
        fields: &[Field],
        sectors: &mut Field,
        to: &mut [f64],
    ) {
        let block = transform.sectors() * self.rows;
        for (field, &(k, first)) in fields.iter().zip(&self.harmonics) {
            transform.to_sectors(field, sectors);
            let parts = [&sectors.re, &sectors.im];
            let blocks = to[first * block..].chunks_exact_mut(block);
            for (part, to) in parts.into_iter().take(1 + k.min(1)).zip(blocks) {
                turned(part, padded(transform.sectors()), self.rows, to);
            }
        }
    }

    /// The field of one harmonic over the waves from coefficients; `sectors` is room for one.
    pub(super) fn to_waves(
        &self,
        transform: &SectorTransform,
        place: usize,
        from: &[f64],
        sectors: &mut Field,
        to: &mut Field,
    ) {
        let (k, first) = self.harmonics[place];
        let block = transform.sectors() * self.rows;
        sectors.im.fill(0.0);
        let parts = [&mut sectors.re, &mut sectors.im];
        let blocks = from[first * block..].chunks_exact(block);
        for (part, from) in parts.into_iter().take(1 + k.min(1)).zip(blocks) {
            returned(from, padded(transform.sectors()), self.rows, part);
        }
        transform.to_waves(sectors, to);
    }
}
