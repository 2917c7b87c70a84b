//! Direct time integration to the periodic state: a path to a point that shares neither contact
//! code nor harmonics with harmonic balance.

mod compare;
mod contact_rows;
mod motion;
mod options;
mod periods;
mod propagator;
mod settle;
mod stability;
mod state;
mod stepper;

pub use compare::{
    PointCase, PointComparison, SolvedPoint, Stability, StepStudy, compare_point, periodic_point,
};
pub use motion::Motion;
pub use options::TimeOptions;
pub use settle::{Settled, settle};
pub use stability::{PeriodicMotion, periodic_motion};
pub use state::{MarchedWheel, WheelState};
pub use stepper::TimeStepper;
