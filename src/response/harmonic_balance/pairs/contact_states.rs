//! What every contact pair does over the period of a solution: stick, slip, separate, how long, and its mean friction.

use super::{InterfaceForces, InterfaceWorkspace};

/// One contact pair over a period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairContact {
    /// Slips in any direction at any sample.
    pub slipping: bool,
    /// The normal load is zero at any sample.
    pub separated: bool,
    /// Share of the samples at which it slips; none for a ring that drifts.
    pub slipping_share: Option<f64>,
    /// Share of the samples at which the normal load is zero.
    pub separated_share: f64,
}

impl InterfaceForces {
    /// State of every pair at the motions of the workspace, sector by sector, in each the pairs in the order of the
    /// model.
    pub(in crate::response::harmonic_balance) fn states(
        &self,
        workspace: &mut InterfaceWorkspace,
    ) -> Vec<PairContact> {
        let drifts = self.ring_drift_m.iter().any(|drift| drift.abs() > 0.0);
        (0..workspace.active.len())
            .map(|pair| {
                self.gather_pair(pair, workspace);
                let state = workspace.pairs.evaluate(
                    self.interface.pair(pair),
                    &workspace.pair_input,
                    &mut workspace.pair_output,
                    None,
                );
                let history = workspace.pairs.history();
                let load = history.normal_load_n();
                let share = |count: usize| count as f64 / load.len() as f64;
                let open = load.iter().filter(|&&load| load <= 0.0).count();
                // A slider that sticks keeps its offset to the last bit.
                let moves = |j: usize| {
                    let before = if j == 0 { load.len() - 1 } else { j - 1 };
                    let offsets = history.tangential_correction_n();
                    let moved = |offset: &[f64]| offset[j].total_cmp(&offset[before]).is_ne();
                    load[j] > 0.0 && offsets.iter().any(|offset| moved(offset))
                };
                let slips = (0..load.len()).filter(|&j| moves(j)).count();
                PairContact {
                    slipping: state.slipping,
                    separated: state.separated,
                    slipping_share: (!drifts).then(|| share(slips)),
                    separated_share: share(open),
                }
            })
            .collect()
    }

    /// Mean friction force on the ring at the motions of the workspace, N per sector, averaged over the sectors: along
    /// theta and along z, see [`crate::model::cyclic::ContactGeometry::ring_motion`]. Not a number without pairs.
    pub(in crate::response::harmonic_balance) fn mean_friction_n(
        &self,
        workspace: &mut InterfaceWorkspace,
    ) -> [f64; 2] {
        let per_sector = self.interface.per_sector();
        let count = workspace.active.len();
        let mut sum = [0.0; 2];
        for pair in 0..count {
            self.gather_pair(pair, workspace);
            workspace.pairs.evaluate(
                self.interface.pair(pair),
                &workspace.pair_input,
                &mut workspace.pair_output,
                None,
            );
            let friction = workspace.pairs.history().mean_friction_n();
            let motions = &self.interface.geometry.ring_motion[pair % per_sector];
            for (sum, motion) in sum.iter_mut().zip(motions) {
                *sum += motion[0] * friction[0] + motion[1] * friction[1];
            }
        }
        let sectors = (count / per_sector.max(1)) as f64;
        sum.map(|sum| sum / sectors)
    }
}
