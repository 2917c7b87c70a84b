//! What is tried where a point on tuned receptances does not converge: the attempts of the contact iteration, in their order.

use super::contact_equation::Preconditioned::{
    self, FirstOfFundamental, HighCoupled, Resonant, Whole,
};

use Attempt::{Accelerated, Damped, Newton};
use Start::{Best, Known, Linear};

/// Damping of the shares of earlier steps, over the tolerance that is asked for.
pub(super) const DAMPING: f64 = 0.5;

/// Newton steps of an attempt at most.
pub(super) const NEWTON_STEPS: usize = 40;
/// Most unknowns of a contact that are few: the whole derivative is factorised in the time of some steps. Where nothing else leads to a
/// solution, it is factorised at every step.
pub(super) const FEW_UNKNOWNS: usize = 150;
/// Most harmonics that are few: with more a step takes so long that attempts are ended early, and that no pair is preconditioned by itself.
const FEW_HARMONICS: usize = 6;

/// How far the solver goes for a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    /// Whether the whole derivative is taken first of a contact with few unknowns, in the place of the mean tangent: where its harmonics are
    /// solved with from the start, and not where others have led to.
    pub(crate) takes_whole: bool,
    /// Attempts at most.
    pub(crate) most_attempts: usize,
    /// Steps after which no other attempt begins.
    pub(crate) most_steps: u64,
}

impl Effort {
    pub(super) const ALL: Self = Self {
        takes_whole: false,
        most_attempts: usize::MAX,
        most_steps: u64::MAX,
    };
}

/// When preconditioners are renewed, what they take in, and how many steps are taken at most.
#[derive(Clone, Copy)]
pub(super) struct Plan {
    pub(super) renewals: &'static [usize],
    pub(super) iterations: usize,
    pub(super) takes_in: Preconditioned,
    /// Earlier steps that are combined.
    pub(super) depth: usize,
    /// Whether an attempt that stalls is over before that: Newton's method goes on from there.
    pub(super) gives_up: bool,
}

const fn plan(renewals: &'static [usize], iterations: usize, takes_in: Preconditioned) -> Plan {
    Plan {
        renewals,
        iterations,
        takes_in,
        depth: 80,
        gives_up: false,
    }
}

/// With many harmonics the steps that follow a new beginning cost more than a long history: all steps are combined.
const fn combining_all(plan: Plan) -> Plan {
    Plan { depth: 160, ..plan }
}

const fn brief(plan: Plan) -> Attempt {
    Accelerated(Plan {
        gives_up: true,
        ..combining_all(plan)
    })
}

/// How Newton steps are preconditioned, how closely they are solved, and how they are shortened.
pub(super) struct NewtonPlan {
    /// Whether every pair is preconditioned by itself besides. What is left is then measured after the preconditioners: without them
    /// the stiffest pairs alone would count.
    pub(super) pairs: bool,
    /// Residual of a step, relative to its right-hand side.
    pub(super) step_error: f64,
    /// Products with the derivative of a step, and of an attempt, at most.
    pub(super) products: usize,
    pub(super) products_in_all: u64,
    /// Residual of a step, relative to its right-hand side, beyond which an attempt is over where the step took all its products and the
    /// residual is not near the tolerance.
    pub(super) most_step_error: f64,
    /// Share of a step below which it is not tried.
    pub(super) least_factor: f64,
    /// Share of what a step promises that it has to take off.
    pub(super) decrease: f64,
}

/// In five studies, of 222 attempts that led to a solution one took such a step far from the tolerance, of 66 that did not 19.
const POOR_STEP: f64 = 0.55;
/// Residual over the tolerance below which it is near.
pub(super) const NEAR: f64 = 10.0;

const BY_HARMONICS: NewtonPlan = NewtonPlan {
    pairs: false,
    step_error: 1e-3,
    products: 120,
    products_in_all: u64::MAX,
    most_step_error: f64::INFINITY,
    least_factor: 1.0 / 128.0,
    decrease: 0.0,
};
/// With many harmonics: where these are not enough, more hardly ever are.
const BY_MANY_HARMONICS: NewtonPlan = NewtonPlan {
    products_in_all: 1_500,
    most_step_error: POOR_STEP,
    ..BY_HARMONICS
};
/// From where the iteration has come to: few steps are left, which need not be solved closely.
const FROM_THERE: NewtonPlan = NewtonPlan {
    step_error: 0.1,
    products_in_all: 700,
    ..BY_HARMONICS
};
/// The same with many, where its steps take off less each.
const FROM_THERE_WITH_MANY: NewtonPlan = NewtonPlan {
    products_in_all: 1_500,
    most_step_error: POOR_STEP,
    ..FROM_THERE
};
const BY_PAIRS: NewtonPlan = NewtonPlan {
    pairs: true,
    step_error: 1e-2,
    products: 250,
    products_in_all: 3_500,
    most_step_error: f64::INFINITY,
    least_factor: 1.0 / 256.0,
    decrease: 0.1,
};

/// Where an attempt begins.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Start {
    /// Motions that are known beside the frequency or with other harmonics.
    Known,
    /// The linear response.
    Linear,
    /// The motions with the smallest residual of all attempts before.
    Best,
}

/// One way to a solution.
pub(super) enum Attempt {
    Accelerated(Plan),
    Newton(NewtonPlan),
    /// Newton's method by the whole derivative, factorised at every step.
    Damped,
}

/// What is tried, in this order, until an attempt ends with a solution. The tangent of a known start is near; that of the linear
/// response says little, and is renewed. Where the iteration creeps, Newton's method ends what it began. Harmonics above 1 near
/// resonances that deviations split take the resonant shapes. Where pairs open, their harmonics depend on each other, and pairs are
/// preconditioned by themselves.
const WITH_FEW_HARMONICS: [(Start, Attempt); 13] = [
    (Known, Accelerated(plan(&[0], 100, FirstOfFundamental))),
    (Linear, Accelerated(plan(&[0, 3], 80, FirstOfFundamental))),
    (Linear, Accelerated(RENEWED)),
    (Known, Accelerated(RENEWED)),
    (Best, Newton(FROM_THERE)),
    (Known, Accelerated(plan(&[0, 3], 80, Resonant))),
    (Known, Accelerated(RENEWED_RESONANT)),
    (Linear, Accelerated(plan(&[0, 3], 80, Resonant))),
    (Linear, Accelerated(RENEWED_RESONANT)),
    (Known, Newton(BY_HARMONICS)),
    (Linear, Newton(BY_HARMONICS)),
    (Known, Newton(BY_PAIRS)),
    (Linear, Newton(BY_PAIRS)),
];
/// The same with many: where an attempt stalls it is over, since Newton's method from there takes less than other starts do. Steps with high
/// harmonics coupled take less again. They begin from there: at a start from few harmonics their derivative says little.
const WITH_MANY_HARMONICS: [(Start, Attempt); 9] = [
    (Known, brief(plan(&[0], 160, FirstOfFundamental))),
    (Best, brief(plan(&[0], 160, HighCoupled))),
    (Best, Newton(FROM_THERE_WITH_MANY)),
    (Known, Newton(BY_MANY_HARMONICS)),
    (Linear, brief(plan(&[0, 3], 120, FirstOfFundamental))),
    (Best, Newton(FROM_THERE_WITH_MANY)),
    (Known, Accelerated(combining_all(RENEWED))),
    (Known, Accelerated(combining_all(RENEWED_RESONANT))),
    (Linear, Accelerated(combining_all(RENEWED_RESONANT))),
];
/// With few unknowns of several harmonics, before those above: steps of Newton's method, whose derivative is kept for some.
const WITH_FEW_UNKNOWNS: [(Start, Attempt); 2] = [
    (Known, Accelerated(BY_WHOLE)),
    (Linear, Accelerated(BY_WHOLE)),
];
/// With so few unknowns that the whole derivative can be factorised at every step, after those above.
const WITH_WHOLE_STEPS: [(Start, Attempt); 3] = [(Known, Damped), (Linear, Damped), (Best, Damped)];
const BY_WHOLE: Plan = plan(&[0, 7, 14, 21, 28], 40, Whole);
const RENEWED: Plan = plan(&[0, 10, 25], 160, FirstOfFundamental);
const RENEWED_RESONANT: Plan = plan(&[0, 10, 25], 160, Resonant);

/// What decides which attempts a point has.
#[derive(Clone, Copy)]
pub(super) struct Circumstances {
    pub(super) harmonics: usize,
    pub(super) unknowns: usize,
    /// Whether the whole derivative may come first, see [`Effort`].
    pub(super) takes_whole: bool,
    /// Whether high harmonics can be coupled.
    pub(super) couples_high: bool,
    /// Whether there is a known start; without one the linear response begins.
    pub(super) has_known: bool,
}

/// The attempts of a point, in their order.
pub(super) fn attempts(of: Circumstances) -> impl Iterator<Item = &'static (Start, Attempt)> {
    let are_few = of.unknowns <= FEW_UNKNOWNS;
    let first: &[_] = if are_few && of.takes_whole && of.harmonics > 1 {
        &WITH_FEW_UNKNOWNS
    } else {
        &[]
    };
    let last: &[_] = if are_few { &WITH_WHOLE_STEPS } else { &[] };
    let attempts: &[_] = if of.harmonics <= FEW_HARMONICS {
        &WITH_FEW_HARMONICS
    } else {
        &WITH_MANY_HARMONICS
    };
    let couples =
        |attempt: &Attempt| matches!(attempt, Accelerated(plan) if plan.takes_in == HighCoupled);
    let known = { first.iter().chain(attempts).chain(last) }
        .filter(move |(_, attempt)| of.couples_high || !couples(attempt))
        .filter(move |(start, _)| of.has_known || *start != Known);
    known.skip_while(move |(start, _)| !of.has_known && *start == Best)
}

/// For the errors of a solution, from that solution: what is left counts, so every step does.
pub(super) const BESIDE: Plan = combining_all(plan(&[0], 120, FirstOfFundamental));

#[cfg(test)]
mod tests {
    use super::{Best, Circumstances, FEW_HARMONICS, Known, Linear, attempts};

    #[test]
    fn without_a_known_start_the_linear_response_begins() {
        let counts = [1, FEW_HARMONICS, FEW_HARMONICS + 1, 16];
        let counts = counts.map(|harmonics| [(harmonics, 100), (harmonics, 10_000)]);
        let counts = counts.into_iter().flatten();
        for ((harmonics, unknowns), takes) in counts.flat_map(|own| [(own, false), (own, true)]) {
            let starts = |has_known: bool| {
                let attempts = attempts(Circumstances {
                    harmonics,
                    unknowns,
                    takes_whole: takes,
                    couples_high: takes,
                    has_known,
                });
                attempts.map(|(start, _)| *start)
            };
            assert!(starts(false).next() == Some(Linear));
            assert!(starts(false).all(|start| start != Known));
            assert!(starts(true).next() == Some(Known));
            assert!(starts(true).any(|start| start == Best));
        }
    }
}
