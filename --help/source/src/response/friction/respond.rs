//! What each law makes of the displacement of a pair: the one place that chooses between them.

use super::{
    ContactHistory, ContactLaw, PairDisplacement, PairParameters, PairState, coulomb_3d,
    macro_slip, simplified_3d,
};

impl ContactHistory {
    /// Applies `law` to the displacement.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn respond(
        &mut self,
        law: ContactLaw,
        parameters: &PairParameters,
        displacement: PairDisplacement<'_>,
    ) -> PairState {
        self.respond_drifting(law, parameters, displacement, [0.0; 2])
    }

    /// Applies `law` to a displacement that besides grows steadily by `drift_m` per period along t1
    /// and t2; the forces are periodic all the same.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn respond_drifting(
        &mut self,
        law: ContactLaw,
        parameters: &PairParameters,
        displacement: PairDisplacement<'_>,
        drift_m: [f64; 2],
    ) -> PairState {
        self.drift_m = drift_m;
        assert_eq!(
            displacement.normal.len(),
            self.normal_load.len(),
            "samples of the closing"
        );
        self.law = law;
        match law {
            ContactLaw::MacroSlip1d | ContactLaw::MacroSlip2d => {
                macro_slip::respond(self, parameters, displacement);
            }
            ContactLaw::Simplified3d => simplified_3d::respond(self, parameters, displacement),
            ContactLaw::Coulomb3d => coulomb_3d::respond(self, parameters, displacement),
        }
        self.state
    }
}
