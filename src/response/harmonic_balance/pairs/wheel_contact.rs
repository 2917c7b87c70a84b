//! The contact of a whole wheel by itself: motions at the contact rows in, forces out, in harmonics.

use std::sync::Arc;

use super::{ContactInterface, ContactShares, InterfaceForces, InterfaceWorkspace, PairContact};
use crate::linalg::{Complex64, dot};
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::HarmonicTransform;

/// The correction `G(u) = F(u) - k_c u` of the contact forces to those of the tuned wheel's stuck springs.
///
/// Vectors have one real number per coefficient, sector and contact row: coefficient after coefficient of the transform
/// (one for harmonic 0, real and imaginary part for every other), in it sector after sector, in it row after row.
pub struct WheelContact {
    contact: InterfaceForces,
    workspace: InterfaceWorkspace,
    sectors: usize,
    /// Springs of the wheel's own contact rows less those of the tuned wheel, N/m; empty where they are the same.
    springs: Vec<f64>,
    /// Whether the springs are all there is: a linear limit.
    linear: bool,
}

/// Complex-linear part of the derivative of the contact forces of one harmonic, the mean over the sectors, N/m: of every pair
/// of a sector a `3 x 3` matrix over normal and both tangents, row after row.
pub type MeanTangent = Vec<[Complex64; 9]>;

impl WheelContact {
    /// The contact `interface` of a wheel of so many sectors. `springs` are those of a sector's rows in the tuned wheel, N/m.
    #[must_use]
    pub fn new(
        interface: ContactInterface,
        sectors: usize,
        springs: &[f64],
        transform: Arc<HarmonicTransform>,
    ) -> Self {
        let rows = sectors * interface.geometry.row_count();
        let stuck = interface.stuck_springs(1.0);
        let varied = stuck
            .iter()
            .zip(springs.iter().cycle())
            .map(|(spring, tuned)| spring - tuned);
        let varied: Vec<f64> = varied.collect();
        let contact = InterfaceForces::new(interface, transform, rows);
        let mut workspace = contact.workspace();
        workspace.pairs.couple_first(0);
        Self {
            workspace,
            springs: if stuck.len() > springs.len() {
                varied
            } else {
                Vec::new()
            },
            contact,
            sectors,
            linear: false,
        }
    }

    /// The contact of a linear limit whose springs, N/m, `of_wheel` of all rows of the wheel, differ from those of the tuned wheel.
    #[must_use]
    pub fn linear(self, of_wheel: &[f64], tuned: &[f64]) -> Self {
        let varied = of_wheel.iter().zip(tuned.iter().cycle());
        Self {
            springs: varied.map(|(spring, tuned)| spring - tuned).collect(),
            linear: true,
            ..self
        }
    }

    /// Motions to evaluate next, to be filled.
    pub fn motion_mut(&mut self) -> &mut [f64] {
        &mut self.workspace.displacement
    }

    /// The motions last given.
    #[must_use]
    pub fn motion(&self) -> &[f64] {
        &self.workspace.displacement
    }

    /// The correction last evaluated.
    #[must_use]
    pub fn correction(&self) -> &[f64] {
        &self.workspace.correction
    }

    /// Evaluates the correction at the motions given; with its derivative where that is wanted.
    pub fn evaluate(&mut self, derivative: bool) -> ContactShares {
        let shares = if self.linear {
            self.workspace.correction.fill(0.0);
            ContactShares::default()
        } else {
            self.contact.correct(derivative, &mut self.workspace)
        };
        if !self.springs.is_empty() {
            let rows = self.springs.len();
            let motions = self.workspace.displacement.chunks_exact(rows);
            let corrections = self.workspace.correction.chunks_exact_mut(rows);
            for (correction, motion) in corrections.zip(motions) {
                for ((force, spring), u) in correction.iter_mut().zip(&self.springs).zip(motion) {
                    *force += spring * u;
                }
            }
        }
        shares
    }

    /// The mean tangent of the harmonic at place `at` of the set, after an evaluation with derivative.
    #[must_use]
    pub fn mean_tangent(&self, at: usize) -> MeanTangent {
        let interface = &self.contact.interface;
        let pairs = interface.per_sector();
        let coefficients = self.contact.transform.n_coefficients();
        let parts = |harmonic: &usize| if *harmonic == 0 { 1 } else { 2 };
        let (before, from) = self.contact.transform.harmonics().split_at(at);
        let first: usize = before.iter().map(parts).sum();
        let is_mean = from[0] == 0;
        let mut tangent = vec![[Complex64::default(); 9]; pairs];
        let share = 1.0 / self.sectors as f64;
        for (pair, jacobian) in self.workspace.jacobians.iter().enumerate() {
            if !self.workspace.active[pair] {
                continue;
            }
            let sum = &mut tangent[pair % pairs];
            for (place, sum) in sum.iter_mut().enumerate() {
                let Some(block) = jacobian.block(place / 3, place % 3) else {
                    continue;
                };
                let at = |i: usize, j: usize| block[(first + i) * coefficients + first + j];
                *sum += if is_mean {
                    Complex64::from(at(0, 0)) * share
                } else {
                    Complex64::new(at(0, 0) + at(1, 1), at(1, 0) - at(0, 1)) * (0.5 * share)
                };
            }
        }
        self.add_mean_springs(&mut tangent);
        tangent
    }

    /// Adds the mean difference of the springs to those of the tuned wheel.
    fn add_mean_springs(&self, tangent: &mut MeanTangent) {
        let geometry = &self.contact.interface.geometry;
        let per_sector = geometry.row_count();
        for (pair, rows) in geometry.rows.iter().enumerate() {
            for (direction, row) in rows.iter().enumerate() {
                let Some(row) = row.filter(|_| !self.springs.is_empty()) else {
                    continue;
                };
                let of_sectors = self.springs.iter().skip(row).step_by(per_sector);
                tangent[pair][4 * direction] += of_sectors.sum::<f64>() / self.sectors as f64;
            }
        }
    }

    /// What the correction changes by where the motions change by `change`, at the motions last evaluated with derivative, all
    /// harmonics coupled as far as [`Self::couple`] says; added to `correction`, both in the order of the motions.
    pub fn add_derivative(&self, change: &[f64], correction: &mut [f64]) {
        let interface = &self.contact.interface;
        let geometry = &interface.geometry;
        let (pairs, per_sector) = (interface.per_sector(), geometry.row_count());
        let coefficients = self.contact.transform.n_coefficients();
        let rows = self.contact.rows;
        // A pair's changes side by side: they are read once for every coefficient.
        let mut of_pair = vec![0.0; coefficients];
        for (pair, jacobian) in self.workspace.jacobians.iter().enumerate() {
            if !self.workspace.active[pair] {
                continue;
            }
            let base = pair / pairs * per_sector;
            let places = geometry.rows[pair % pairs];
            for (by, from) in places.iter().enumerate() {
                let Some(from) = from else { continue };
                let changes = change[base + from..].iter().step_by(rows);
                for (own, change) in of_pair.iter_mut().zip(changes) {
                    *own = *change;
                }
                for (along, to) in places.iter().enumerate() {
                    let (Some(to), Some(block)) = (to, jacobian.block(along, by)) else {
                        continue;
                    };
                    let corrections = correction[base + to..].iter_mut().step_by(rows);
                    for (correction, slopes) in
                        corrections.zip(block.chunks_exact(coefficients.max(1)))
                    {
                        *correction += dot(slopes, &of_pair);
                    }
                }
            }
        }
        if !self.springs.is_empty() {
            let count = self.springs.len();
            let changes = change.chunks_exact(count);
            for (correction, change) in correction.chunks_exact_mut(count).zip(changes) {
                for ((force, spring), u) in correction.iter_mut().zip(&self.springs).zip(change) {
                    *force += spring * u;
                }
            }
        }
    }

    /// Whether the forces of a pair, counted sector after sector, change with its motions at those last evaluated.
    #[must_use]
    pub fn is_active(&self, pair: usize) -> bool {
        self.workspace.active[pair]
    }

    /// Derivative of a pair's correction along one direction by its displacement along another, of n, t1, t2, at the motions last
    /// evaluated with derivative, N/m: a row per coefficient of the correction; none where it is zero.
    #[must_use]
    pub fn slopes(&self, pair: usize, along: usize, by: usize) -> Option<&[f64]> {
        self.workspace.jacobians[pair].block(along, by)
    }

    /// From now on derivatives are of every harmonic by every other one, or each by itself.
    pub fn couple(&mut self, all: bool) {
        self.workspace
            .pairs
            .couple_first(if all { usize::MAX } else { 0 });
    }

    /// The harmonic transform.
    #[must_use]
    pub fn transform(&self) -> &HarmonicTransform {
        &self.contact.transform
    }

    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.sectors
    }

    /// Contact rows of a sector.
    #[must_use]
    pub fn sector_rows(&self) -> usize {
        self.contact.interface.geometry.row_count()
    }

    /// Rows of every pair of a sector, see [`crate::model::cyclic::ContactGeometry::rows`].
    #[must_use]
    pub fn pair_rows(&self) -> &[[Option<usize>; 3]] {
        &self.contact.interface.geometry.rows
    }

    /// Pair parameters of one sector, or of the whole wheel where sectors differ.
    #[must_use]
    pub fn pairs(&self) -> &[PairParameters] {
        &self.contact.interface.pairs
    }

    /// Rigid motions of the ring (rotation, axial) that nothing but friction holds.
    #[must_use]
    pub fn free_ring_motions(&self) -> [bool; 2] {
        self.contact.interface.geometry.ring_free
    }

    /// Drift of the ring along its rigid motions (rotation, axial), m per period: zero at first.
    #[must_use]
    pub fn ring_drift_m(&self) -> [f64; 2] {
        self.contact.ring_drift_m
    }

    /// Sets the drift of the ring.
    pub fn set_ring_drift(&mut self, drift_m: [f64; 2]) {
        self.contact.ring_drift_m = drift_m;
    }

    /// Mean friction force on the ring at the motions last given, N per sector, see [`crate::response::harmonic_balance::HarmonicSystem::mean_friction_n`].
    pub fn mean_friction_n(&mut self) -> [f64; 2] {
        self.contact.mean_friction_n(&mut self.workspace)
    }

    /// State of every contact pair at the motions last given, see [`PairContact`].
    pub fn contact_states(&mut self) -> Vec<PairContact> {
        self.contact.states(&mut self.workspace)
    }
}
