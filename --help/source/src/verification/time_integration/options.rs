//! How long a time integration marches, and what it calls periodic.

/// Bounds of a time integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeOptions {
    /// Steps per period of the excitation. Default 1024.
    pub steps_per_period: usize,
    /// Periods marched at least. Default 100.
    pub minimum_periods: usize,
    /// Periods marched at most; a motion not periodic by then ends as `work_budget`. Default 3000.
    pub maximum_periods: usize,
    /// Largest change over one period of blade displacements and of contact forces, each relative
    /// to its largest value, that counts as periodic. Default 1e-5.
    pub periodicity_tolerance: f64,
    /// Periods over which the blades' fundamental amplitudes must stay as well. Default 50.
    ///
    /// A change over one period does not bound the distance from the periodic state: at a quality
    /// factor Q an error shrinks by the share `pi / Q` per period only.
    pub drift_periods: usize,
    /// Largest change of the fundamental amplitudes over [`Self::drift_periods`], relative to the
    /// largest. Default 1e-4.
    pub drift_tolerance: f64,
    /// A point is integrated with halved steps until its largest amplitude changes by less than
    /// this share. Default 1e-3.
    pub step_tolerance: f64,
    /// Most steps per period of that study. Default 8192.
    pub maximum_steps_per_period: usize,
}

impl Default for TimeOptions {
    fn default() -> Self {
        Self {
            steps_per_period: 1024,
            minimum_periods: 100,
            maximum_periods: 3000,
            periodicity_tolerance: 1e-5,
            drift_periods: 50,
            drift_tolerance: 1e-4,
            step_tolerance: 1e-3,
            maximum_steps_per_period: 8192,
        }
    }
}
