//! The closed set of ways in which a row can end.

use serde::{Deserialize, Serialize};

/// How the solution of one row ended. Everything but [`Status::Ok`] counts as failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Converged, and the peak is bracketed.
    Ok,
    /// The largest amplitude found lies at an end of the searched band.
    NotBracketed,
    /// Newton's method used up its iterations.
    IterationLimit,
    /// No step reduces the residual any further, above the tolerance.
    Stagnated,
    /// The residual grew without bound.
    Diverged,
    /// A value that is not finite appeared.
    NonFinite,
    /// The Jacobian is singular to working precision.
    SingularJacobian,
    /// The step of a continuation became too small.
    StepTooSmall,
    /// A sweep or search ended with points missing.
    SweepIncomplete,
    /// The solution left its branch.
    BranchJump,
    /// The budget of nonlinear solves for the row is used up.
    WorkBudget,
    /// The pattern cannot be applied (a blade stiffness not positive).
    InvalidPattern,
    /// A defect of the program, caught.
    Panicked,
}

impl Status {
    /// Every status, in the order of reports.
    pub const ALL: [Self; 13] = [
        Self::Ok,
        Self::NotBracketed,
        Self::IterationLimit,
        Self::Stagnated,
        Self::Diverged,
        Self::NonFinite,
        Self::SingularJacobian,
        Self::StepTooSmall,
        Self::SweepIncomplete,
        Self::BranchJump,
        Self::WorkBudget,
        Self::InvalidPattern,
        Self::Panicked,
    ];

    /// Name in tables, `snake_case`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::NotBracketed => "not_bracketed",
            Self::IterationLimit => "iteration_limit",
            Self::Stagnated => "stagnated",
            Self::Diverged => "diverged",
            Self::NonFinite => "non_finite",
            Self::SingularJacobian => "singular_jacobian",
            Self::StepTooSmall => "step_too_small",
            Self::SweepIncomplete => "sweep_incomplete",
            Self::BranchJump => "branch_jump",
            Self::WorkBudget => "work_budget",
            Self::InvalidPattern => "invalid_pattern",
            Self::Panicked => "panicked",
        }
    }

    /// What it says of a row.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Ok => "converged, and the peak is bracketed",
            Self::NotBracketed => {
                "the largest amplitude found lies at an end of the searched band with no failed point beside it, or no resonance answers the excitation"
            }
            Self::IterationLimit => "Newton's method used up its iterations",
            Self::Stagnated => "no step makes progress above the tolerance",
            Self::Diverged => "the residual grew without bound",
            Self::NonFinite => "a value that is not finite appeared",
            Self::SingularJacobian => "the Jacobian is singular to working precision",
            Self::StepTooSmall => "the step of a continuation became too small",
            Self::SweepIncomplete => "the search ended with points missing",
            Self::BranchJump => {
                "the solution left its branch, or a curve that may fold could not be followed from the peak to its neighbours"
            }
            Self::WorkBudget => "the evaluations for the row are used up",
            Self::InvalidPattern => {
                "a blade stiffness, or a factor on the contact, would not be positive"
            }
            Self::Panicked => "a defect of the program, caught",
        }
    }
}
