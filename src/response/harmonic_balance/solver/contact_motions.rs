//! Newton's method for the motions at the contact rows of a wheel with few of them: nothing else is unknown.
//!
//! With `S`, `A` and `R` of [`crate::response::harmonic_balance::condensed::newton_step`] and the correction G of the contact forces,
//!
//! ```text
//! x = S^-1 f - A G(d),    F(d) = d - C x = d - C S^-1 f + R G(d) = 0,
//! (dF/dd)^-1 F = (I + R G')^-1 F = F - R y,    (I + G' R) y = G' F
//! ```
//!
//! The residual of this x is `C^T (G(d - F) - G(d))`, which is not known before the contact is asked again. On the way
//! it is taken for `|C^T| k_c |F|`; what is delivered has one step more and is judged by the residual of the whole
//! equation.

use super::kept_jacobian::KeptJacobian;
use super::newton_iteration::{DEPTH, Equation, NewtonBuffers, iterate, norm_of};
use super::{NewtonBounds, NewtonOutcome, Settled, Steps};
use crate::response::harmonic_balance::Status;
use crate::response::harmonic_balance::equation::{HarmonicSystem, SystemWorkspace};
use crate::response::harmonic_balance::pairs::ContactShares;

/// A step of the motions that is longer than this share of them leaves no amplitude as it is.
const FAR_FROM_SETTLED: f64 = 0.02;

/// F at one frequency, whose linear part is at hand.
pub(super) struct ContactMotions<'a> {
    system: &'a HarmonicSystem,
    omega: f64,
    workspace: &'a mut SystemWorkspace,
    jacobian: &'a mut KeptJacobian,
    pub(super) settled: Option<Settled<'a>>,
    start: Option<MotionStart>,
    /// Contact forces `G - y` that the last step leads to, and those of the step before.
    forces: [Vec<f64>; 2],
    /// x under either, where it was asked for.
    responses: [Option<Vec<f64>>; 2],
}

impl<'a> ContactMotions<'a> {
    /// The equation at `omega`; none if the linear part is singular.
    pub(super) fn new(
        system: &'a HarmonicSystem,
        omega: f64,
        workspace: &'a mut SystemWorkspace,
        jacobian: &'a mut KeptJacobian,
    ) -> Option<Self> {
        if !jacobian.condensed().factor_linear(system, omega) {
            return None;
        }
        Some(Self {
            system,
            omega,
            workspace,
            jacobian,
            settled: None,
            start: None,
            forces: [Vec::new(), Vec::new()],
            responses: [None, None],
        })
    }

    /// What starting at `x`, in the unknowns of the whole equation, would leave.
    fn start_at(&mut self, x: Vec<f64>) -> MotionStart {
        let mut motion = vec![0.0; self.workspace.contact.displacement.len()];
        self.system.contact_displacement(&x, &mut motion);
        let mut left = vec![0.0; motion.len()];
        let (norm, shares) = self.left(&motion, &mut left, false);
        MotionStart {
            omega: self.omega,
            x,
            motion,
            correction: self.workspace.contact.correction.clone(),
            left,
            norm,
            shares,
        }
    }

    /// F into `left`.
    fn left(&mut self, motion: &[f64], left: &mut [f64], derivative: bool) -> (f64, ContactShares) {
        self.workspace.contact.displacement.copy_from_slice(motion);
        let shares = self
            .system
            .contact
            .correct(derivative, &mut self.workspace.contact);
        let condensed = self.jacobian.condensed();
        condensed.motion_left(motion, &self.workspace.contact.correction, left);
        (condensed.force_of(left), shares)
    }

    /// x that the last step leads to. With every pair stuck it is the linear response to the last bit, however the
    /// factors at hand came about.
    fn delivered(&mut self) -> Vec<f64> {
        let [last, _] = &self.forces;
        let forces = if last.is_empty() {
            &self.workspace.contact.correction
        } else {
            last
        };
        if forces.iter().all(|&force| force == 0.0)
            && let Some(x) = self.system.stuck_response(self.omega)
        {
            return x;
        }
        let known = self.responses[0].take();
        known.unwrap_or_else(|| {
            self.jacobian
                .condensed_at_hand()
                .response_of(self.system, forces)
        })
    }
}

impl Equation for ContactMotions<'_> {
    fn residual(&mut self, motion: &[f64], left: &mut [f64]) -> (f64, ContactShares) {
        if let Some(start) = self.start.take() {
            left.copy_from_slice(&start.left);
            self.workspace
                .contact
                .correction
                .clone_from(&start.correction);
            return (start.norm, start.shares);
        }
        self.left(motion, left, false)
    }

    fn linearise(&mut self, motion: &[f64], left: &mut [f64]) -> bool {
        self.workspace.couple_all();
        self.left(motion, left, true);
        let (system, omega) = (self.system, self.omega);
        self.jacobian
            .factor_condensed(system, omega, self.workspace)
    }

    fn is_linearised(&self) -> bool {
        self.jacobian.is_condensed()
    }

    fn step(&mut self, left: &mut [f64]) {
        let condensed = self.jacobian.condensed();
        condensed.solve_motion(left);
        self.forces.swap(0, 1);
        self.responses = [None, self.responses[0].take()];
        let forces = &mut self.forces[0];
        forces.clear();
        forces.extend_from_slice(&self.workspace.contact.correction);
        condensed.subtract_answer(forces);
    }

    /// Asked with x before the last step, and with the change that this step makes of it.
    fn is_settled(&mut self, motion: &[f64], step: &[f64]) -> bool {
        let Some(settled) = self.settled else {
            return false;
        };
        // x itself takes a substitution.
        if norm_of(step) > FAR_FROM_SETTLED * norm_of(motion) {
            return false;
        }
        let system = self.system;
        let condensed = self.jacobian.condensed_at_hand();
        let [after, before] = &mut self.responses;
        let [after, before] = [(after, 0), (before, 1)].map(|(response, at)| {
            &*response.get_or_insert_with(|| condensed.response_of(system, &self.forces[at]))
        });
        let step: Vec<f64> = after.iter().zip(before).map(|(a, b)| a - b).collect();
        settled(before, &step)
    }
}

/// A start in motions at the contact rows, with what its choice has found.
struct MotionStart {
    omega: f64,
    /// In the unknowns of the whole equation.
    x: Vec<f64>,
    motion: Vec<f64>,
    correction: Vec<f64>,
    left: Vec<f64>,
    norm: f64,
    shares: ContactShares,
}

/// Solver for the motions at the contact rows, with its buffers.
#[derive(Default)]
pub(super) struct MotionSolver {
    /// The start of the solve that follows, where starts were compared.
    start: Option<MotionStart>,
    buffers: Option<NewtonBuffers>,
    /// Residual of the whole equation.
    residual: Vec<f64>,
}

impl MotionSolver {
    /// Lets go of the start that was chosen.
    pub(super) fn forget_start(&mut self) {
        self.start = None;
    }

    /// The one of `starts` that leaves the least; none if none is finite.
    pub(super) fn of_least_motion(
        &mut self,
        equation: &mut ContactMotions<'_>,
        starts: Vec<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        let mut best: Option<MotionStart> = None;
        for x in starts {
            let start = equation.start_at(x);
            if best.as_ref().is_none_or(|best| start.norm < best.norm) {
                best = Some(start);
            }
        }
        let x = best.as_ref().map(|best| best.x.clone());
        self.start = best;
        x
    }

    /// [`super::solve`] for the motions; x stays as it is unless they are found. The second is whether x is what was asked
    /// for then: the residual of the whole equation may be above what it was taken for.
    pub(super) fn solve(
        &mut self,
        mut equation: ContactMotions<'_>,
        x: &mut Vec<f64>,
        bounds: NewtonBounds,
    ) -> (NewtonOutcome, bool) {
        let omega = equation.omega;
        let same = |start: &MotionStart| start.omega.total_cmp(&omega).is_eq() && start.x == *x;
        let start = match self.start.take().filter(same) {
            Some(start) => start,
            None => equation.start_at(x.clone()),
        };
        let mut motion = start.motion.clone();
        let buffers = self.buffers.get_or_insert_with(|| {
            let mut buffers = NewtonBuffers::accelerated(motion.len(), DEPTH);
            buffers.steps = Steps::Renewed;
            buffers
        });
        equation.start = Some(start);
        let mut outcome = iterate(&mut equation, &mut motion, bounds, buffers);
        if outcome.status != Status::Ok {
            return (outcome, false);
        }
        *x = equation.delivered();
        let ended_early = outcome.residual > bounds.residual_tolerance;
        let residual = &mut self.residual;
        residual.resize(x.len(), 0.0);
        let system = equation.system;
        let (norm, shares) = system.residual(omega, x, residual, false, equation.workspace);
        (outcome.residual, outcome.shares) = (norm, shares);
        let proven = ended_early || norm <= bounds.residual_tolerance;
        (outcome, proven && shares.unclosed == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{NewtonWorkspace, solve};
    use super::*;
    use crate::response::friction::ContactLaw;
    use crate::response::harmonic_balance::condensed::newton_step::tests::{OMEGA, state, system};

    const TOLERANCE: f64 = 1e-10;

    /// Solves for the motions from `x` at [`OMEGA`].
    fn solved(
        system: &HarmonicSystem,
        x: &mut Vec<f64>,
        bounds: NewtonBounds,
        settled: Option<Settled<'_>>,
    ) -> (NewtonOutcome, bool) {
        let (mut workspace, mut jacobian) = (system.workspace(), KeptJacobian::new());
        let equation = ContactMotions::new(system, OMEGA, &mut workspace, &mut jacobian);
        let mut equation = equation.expect("a regular linear part");
        equation.settled = settled;
        MotionSolver::default().solve(equation, x, bounds)
    }

    #[test]
    fn motions_and_whole_unknowns_have_the_same_solution() {
        for harmonics in [&[1][..], &[1, 3], &[0, 1, 2]] {
            let system = system(ContactLaw::MacroSlip1d, harmonics, 64);
            let bounds = NewtonBounds::with_tolerance(TOLERANCE);
            let start = vec![0.0; system.unknowns()];
            let mut whole = start.clone();
            let mut plain = NewtonWorkspace::new(&system);
            plain.set_steps(Steps::Plain);
            let expected = solve(&system, OMEGA, &mut whole, bounds, None, &mut plain);
            assert_eq!(expected.status, Status::Ok);
            assert!(
                (0.2..1.0).contains(&expected.shares.slipping),
                "{expected:?}"
            );
            let mut x = start;
            let (found, done) = solved(&system, &mut x, bounds, None);
            assert!(done && found.status == Status::Ok, "{found:?}");
            assert!(found.iterations > 0 && found.residual <= TOLERANCE);
            assert_eq!(found.shares, expected.shares);
            for (x, whole) in x.iter().zip(&whole) {
                assert!((x - whole).abs() < 1e-8, "{harmonics:?}: {x} {whole}");
            }
        }
    }

    /// By central differences of F, and the size of F by the residual of the whole equation.
    #[test]
    fn a_step_of_the_motions_undoes_a_small_one_and_the_residual_is_no_larger_than_it_is_taken_for()
    {
        let system = system(ContactLaw::MacroSlip1d, &[1, 3], 64);
        let (mut workspace, mut jacobian) = (system.workspace(), KeptJacobian::new());
        let equation = ContactMotions::new(&system, OMEGA, &mut workspace, &mut jacobian);
        let mut equation = equation.expect("a regular linear part");
        let start = equation.start_at(state(&system));
        let mut motion = start.motion;
        let mut left = vec![0.0; motion.len()];
        assert!(equation.linearise(&motion, &mut left));
        let mut x = equation.delivered();
        let taken_for = equation.jacobian.condensed().force_of(&left);
        let change = 1e-7;
        for at in 0..motion.len() {
            let mut difference = vec![0.0; motion.len()];
            for sign in [1.0, -1.0] {
                motion[at] += sign * change;
                equation.left(&motion, &mut left, false);
                motion[at] -= sign * change;
                for (sum, f) in difference.iter_mut().zip(&left) {
                    *sum += sign * f / (2.0 * change);
                }
            }
            equation.step(&mut difference);
            for (i, step) in difference.iter().enumerate() {
                let expected = f64::from(u8::from(i == at));
                assert!((step - expected).abs() < 1e-6, "{at} {i}: {step}");
            }
        }
        let mut residual = vec![0.0; x.len()];
        let (norm, _) = system.residual(OMEGA, &x, &mut residual, false, equation.workspace);
        assert!(
            norm > 0.01 * taken_for && norm <= taken_for,
            "{norm} {taken_for}"
        );
        // Where every pair sticks the response needs no step.
        x = system.stuck_response(OMEGA).expect("damped");
        assert!(x.iter().any(|x| x.abs() > 0.1));
    }

    /// Steps that are settled before the residual is met are told by what they change in x.
    #[test]
    fn what_is_settled_is_asked_with_the_step_of_the_whole_unknowns() {
        let system = system(ContactLaw::MacroSlip1d, &[1, 3], 64);
        let bounds = NewtonBounds::with_tolerance(1e-12);
        let mut exact = vec![0.0; system.unknowns()];
        let (outcome, _) = solved(&system, &mut exact, bounds, None);
        assert_eq!(outcome.status, Status::Ok);
        let length = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        for share in [1e-1, 1e-3, 1e-5] {
            let settled = |x: &[f64], step: &[f64]| length(step) <= share * length(x);
            let mut x = vec![0.0; system.unknowns()];
            let (outcome, done) = solved(&system, &mut x, bounds, Some(&settled));
            assert!(done && outcome.status == Status::Ok);
            let missed: Vec<f64> = x.iter().zip(&exact).map(|(x, e)| x - e).collect();
            assert!(
                length(&missed) <= share * length(&exact),
                "{share}: {:e}",
                length(&missed)
            );
        }
    }
}
