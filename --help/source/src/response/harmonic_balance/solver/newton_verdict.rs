//! The judgement on a Newton iteration: whether to accept, go on or give up, and why.

use crate::response::harmonic_balance::Status;

/// Residuals above this multiple of the first one mean divergence.
const DIVERGED: f64 = 1e6;

/// Bounds of a Newton iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonBounds {
    /// Accepted residual force relative to the excitation.
    pub residual_tolerance: f64,
    /// Largest number of iterations.
    pub iterations: usize,
    /// Largest number of halvings of a step.
    pub halvings: usize,
}

impl NewtonBounds {
    /// Default bounds with the given tolerance.
    #[must_use]
    pub fn with_tolerance(residual_tolerance: f64) -> Self {
        Self {
            residual_tolerance,
            iterations: 60,
            halvings: 8,
        }
    }

    /// Verdict on residual norms: of the start, and of the iterate after `iterations` steps.
    /// None means: go on. The residual alone decides, never the size of the step.
    #[must_use]
    pub fn judge(&self, first: f64, now: f64, iterations: usize) -> Option<Status> {
        if !now.is_finite() {
            Some(Status::NonFinite)
        } else if now <= self.residual_tolerance {
            Some(Status::Ok)
        } else if now > DIVERGED * first.max(1.0) {
            Some(Status::Diverged)
        } else if iterations >= self.iterations {
            Some(Status::IterationLimit)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_residual_alone_decides() {
        let bounds = NewtonBounds::with_tolerance(1e-8);
        assert_eq!(bounds.judge(1.0, 0.9e-8, 3), Some(Status::Ok));
        assert_eq!(bounds.judge(1.0, 1.1e-8, 3), None);
        assert_eq!(bounds.judge(1.0, f64::NAN, 3), Some(Status::NonFinite));
        assert_eq!(bounds.judge(1.0, 1e7, 3), Some(Status::Diverged));
        assert_eq!(bounds.judge(1.0, 0.5, 60), Some(Status::IterationLimit));
    }
}
