//! Contact forces of every pair of the wheel in harmonic space, beyond those of the stuck springs.

use std::sync::Arc;

use crate::model::cyclic::ContactGeometry;
use crate::response::friction::{ContactLaw, PairParameters};
use crate::response::harmonic_balance::{
    ContactShares, HarmonicTransform, PairHarmonics, PairJacobian,
};
use crate::response::mistuning::ContactFactors;

/// The pairs of every sector under one normal load, sector after sector.
///
/// Vectors over the contact have `n_coefficients * n_rows` entries, coefficient after coefficient:
/// `Re`, `Im` of each harmonic (one for harmonic 0), each over the rows of all sectors.
pub(super) struct ContactForces {
    law: ContactLaw,
    geometry: ContactGeometry,
    pairs: Vec<PairParameters>,
    sectors: usize,
    transform: Arc<HarmonicTransform>,
    /// Drift of the ring along its rigid motions (rotation, axial), m per period.
    ring_drift_m: [f64; 2],
}

/// Derivative of the forces of one pair that slips or separates.
pub(super) struct PairDerivative {
    /// Place of each unknown of the pair in a vector over the contact.
    pub(super) places: Vec<usize>,
    /// `d force(places[i]) / d displacement(places[j])` at `i * places.len() + j`, N/m.
    pub(super) stiffness: Vec<f64>,
}

impl ContactForces {
    pub(super) fn new(
        law: ContactLaw,
        sector: PairParameters,
        factors: &ContactFactors,
        geometry: ContactGeometry,
        sectors: usize,
        transform: Arc<HarmonicTransform>,
    ) -> Self {
        let nominal: Vec<PairParameters> = sector.pairs(&geometry).collect();
        let pair = |index: usize| {
            let parameters = nominal[index % nominal.len()];
            factors
                .pairs()
                .get(index)
                .map_or(parameters, |by| parameters.varied(by))
        };
        Self {
            law,
            pairs: (0..sectors * nominal.len()).map(pair).collect(),
            geometry,
            sectors,
            transform,
            ring_drift_m: [0.0; 2],
        }
    }

    /// Parameters of the pairs of the first sector.
    pub(super) fn first_pairs(&self) -> &[PairParameters] {
        &self.pairs[..self.geometry.rows.len()]
    }

    /// Rigid motions of the ring that nothing but friction holds.
    pub(super) fn free_ring_motions(&self) -> [bool; 2] {
        self.geometry.ring_free
    }

    pub(super) fn ring_drift_m(&self) -> [f64; 2] {
        self.ring_drift_m
    }

    pub(super) fn set_ring_drift(&mut self, drift_m: [f64; 2]) {
        self.ring_drift_m = drift_m;
    }

    /// What a pair of a sector moves on by per period along its tangents, m: the blisk less the ring.
    fn pair_drift_m(&self, pair: usize) -> [f64; 2] {
        let motions = self.geometry.ring_motion[pair];
        let by = self.ring_drift_m;
        [0, 1].map(|tangent| -(motions[0][tangent] * by[0] + motions[1][tangent] * by[1]))
    }

    /// Mean friction force on the ring along its rigid motions at a displacement, N per sector.
    pub(super) fn mean_friction_n(&self, displacement: &[f64]) -> [f64; 2] {
        let coefficients = self.transform.n_coefficients();
        let (per_sector, in_sector) = (self.geometry.row_count(), self.geometry.rows.len());
        let rows = per_sector * self.sectors;
        let mut pair_law = PairHarmonics::new(self.law, Arc::clone(&self.transform));
        let [mut input, mut output] = [0, 1].map(|_| vec![0.0; 3 * coefficients]);
        let mut sum = [0.0; 2];
        for (index, parameters) in self.pairs.iter().enumerate() {
            let (sector, pair) = (index / in_sector, index % in_sector);
            input.fill(0.0);
            for (direction, row) in self.geometry.rows[pair].iter().enumerate() {
                let Some(row) = row else { continue };
                for c in 0..coefficients {
                    let place = c * rows + sector * per_sector + row;
                    input[direction * coefficients + c] = displacement[place];
                }
            }
            pair_law.set_drift(self.pair_drift_m(pair));
            pair_law.evaluate(parameters, &input, &mut output, None);
            let friction = pair_law.history().mean_friction_n();
            for (sum, motion) in sum.iter_mut().zip(&self.geometry.ring_motion[pair]) {
                *sum += motion[0] * friction[0] + motion[1] * friction[1];
            }
        }
        sum.map(|sum| sum / self.sectors as f64)
    }

    /// Copy of this contact with the normal load of every pair multiplied by `factor`.
    pub(super) fn with_load_factor(&self, factor: f64) -> Self {
        let loaded = |pair: &PairParameters| PairParameters {
            normal_load_n: factor * pair.normal_load_n,
            ..*pair
        };
        Self {
            law: self.law,
            geometry: self.geometry.clone(),
            pairs: self.pairs.iter().map(loaded).collect(),
            sectors: self.sectors,
            transform: Arc::clone(&self.transform),
            ring_drift_m: self.ring_drift_m,
        }
    }

    /// `g(d) = F(d) - k_c d` into `force`, and the derivatives of the pairs that slip or separate.
    pub(super) fn evaluate(
        &self,
        displacement: &[f64],
        force: &mut [f64],
        mut derivatives: Option<&mut Vec<PairDerivative>>,
    ) -> ContactShares {
        let coefficients = self.transform.n_coefficients();
        let per_sector = self.geometry.row_count();
        let rows = per_sector * self.sectors;
        let mut pair_law = PairHarmonics::new(self.law, Arc::clone(&self.transform));
        let mut jacobian = PairJacobian::new(coefficients);
        let mut input = vec![0.0; 3 * coefficients];
        let mut output = vec![0.0; 3 * coefficients];
        let (mut slipping, mut separated, mut unclosed) = (0_u32, 0_u32, 0_u32);
        force.fill(0.0);
        if let Some(derivatives) = derivatives.as_deref_mut() {
            derivatives.clear();
        }
        for sector in 0..self.sectors {
            let pairs = &self.pairs[sector * self.geometry.rows.len()..];
            for (place, (pair, directions)) in pairs.iter().zip(&self.geometry.rows).enumerate() {
                pair_law.set_drift(self.pair_drift_m(place));
                // (unknown of the pair, its place) of every direction that the pair moves in.
                let places: Vec<(usize, usize)> = directions
                    .iter()
                    .enumerate()
                    .filter_map(|(direction, row)| Some((direction, (*row)?)))
                    .flat_map(|(direction, row)| {
                        (0..coefficients).map(move |c| {
                            let place = c * rows + sector * per_sector + row;
                            (direction * coefficients + c, place)
                        })
                    })
                    .collect();
                input.fill(0.0);
                for &(unknown, place) in &places {
                    input[unknown] = displacement[place];
                }
                let wanted = derivatives.is_some().then_some(&mut jacobian);
                let state = pair_law.evaluate(pair, &input, &mut output, wanted);
                slipping += u32::from(state.slipping);
                separated += u32::from(state.separated);
                unclosed += u32::from(state.unclosed);
                if !(state.slipping || state.separated) {
                    continue;
                }
                for &(unknown, place) in &places {
                    force[place] = output[unknown];
                }
                if let Some(derivatives) = derivatives.as_deref_mut() {
                    derivatives.push(PairDerivative::new(&jacobian, coefficients, &places));
                }
            }
        }
        let count = f64::from(self.pairs.len().max(1) as u32);
        ContactShares {
            slipping: f64::from(slipping) / count,
            separated: f64::from(separated) / count,
            unclosed: f64::from(unclosed) / count,
        }
    }
}

impl PairDerivative {
    fn new(jacobian: &PairJacobian, coefficients: usize, places: &[(usize, usize)]) -> Self {
        let entry = |row: usize, column: usize| {
            let (direction, c) = (row / coefficients, row % coefficients);
            let (by, other) = (column / coefficients, column % coefficients);
            block(jacobian, direction, by).map_or(0.0, |block| block[c * coefficients + other])
        };
        Self {
            places: places.iter().map(|&(_, place)| place).collect(),
            stiffness: places
                .iter()
                .flat_map(|&(row, _)| places.iter().map(move |&(column, _)| entry(row, column)))
                .collect(),
        }
    }
}

/// Derivative of the force along one direction (normal, first, second tangent) by the displacement
/// along another; none where it is zero.
fn block(jacobian: &PairJacobian, direction: usize, by: usize) -> Option<&[f64]> {
    let cross = jacobian.tangential_cross.as_ref();
    match (direction, by) {
        (0, 0) => Some(&jacobian.normal_normal),
        (0, _) => None,
        (_, 0) => Some(&jacobian.tangential_normal[direction - 1]),
        _ if direction == by => Some(&jacobian.tangential_tangential[direction - 1]),
        _ => cross.map(|cross| &*cross[direction - 1]),
    }
}
