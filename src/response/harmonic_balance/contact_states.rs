//! What every contact pair does over the period of a solution: stick, slip, separate, and how long.

use super::{HarmonicSystem, SystemWorkspace};

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

impl HarmonicSystem {
    /// State of every pair at the unknowns `x`, sector by sector, in each the pairs in the order of the
    /// model.
    #[must_use]
    pub fn contact_states(&self, x: &[f64], workspace: &mut SystemWorkspace) -> Vec<PairContact> {
        self.contact_displacement(x, &mut workspace.displacement);
        self.contact_states_at(workspace)
    }

    /// [`Self::contact_states`] at the motions of the workspace.
    pub(super) fn contact_states_at(&self, workspace: &mut SystemWorkspace) -> Vec<PairContact> {
        let drifts = self.ring_drift_m().iter().any(|drift| drift.abs() > 0.0);
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
}
