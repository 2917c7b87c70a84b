//! One implicit step: exact structure, contact force linear over the step, contact condensed on its
//! rows.
//!
//! With u the motion of the contact rows, k the springs of the law, F its force and W the
//! compliance of the rows to the force at the end of the step,
//!
//! ```text
//! u = u* - W F(u),    F = k u + y(u)
//! u = (I + W k)^-1 (u* - W y)
//! ```
//!
//! solved by iterating on y, which changes where a pair slips or opens only: a pair that sticks is
//! solved exactly, and the iteration contracts as `W k / (1 + W k)`, a few per cent at usual steps.
//! Second order: all is exact but the contact force between two instants.

use std::f64::consts::TAU;

use super::contact_rows::ContactRows;
use super::propagator::Propagator;
use super::state::{MarchedWheel, WheelState};
use crate::linalg::{Complex64, LuWorkspace, Matrix, add_times_vector, add_transpose_times_vector};
use crate::response::friction::PairMemory;
use crate::response::harmonic_balance::Status;

/// Change of the corrections, relative to the largest spring force, at which they count as found.
const CORRECTION_TOLERANCE: f64 = 1e-12;
/// Most iterations of one step.
const MOST_ITERATIONS: u64 = 400;

/// Marches a wheel with a fixed number of steps per period.
pub struct TimeStepper<'a> {
    rows: &'a Matrix<f64>,
    contact: ContactRows,
    propagator: Propagator,
    steps_per_period: usize,
    /// `W`, `(I + W k)^-1` and `(I + W k)^-1 W`.
    compliance: Matrix<f64>,
    stuck: Matrix<f64>,
    stuck_compliance: Matrix<f64>,
    /// Step of the period that comes next.
    step: usize,
    state: Vec<f64>,
    next: Vec<f64>,
    position: Vec<f64>,
    pairs: Vec<PairMemory>,
    pairs_after: Vec<PairMemory>,
    balance: Vec<f64>,
    displacement: Vec<f64>,
    /// Contact force at every row, and its correction y to the springs.
    force: Vec<f64>,
    correction: Vec<f64>,
    modal_force: Vec<f64>,
    predicted: Vec<f64>,
    without_correction: Vec<f64>,
    iterations: u64,
}

impl<'a> TimeStepper<'a> {
    /// Starts at `state`, at phase zero of the excitation; none if the damping of the structure has
    /// no time-domain form or `I + W k` is singular.
    #[must_use]
    pub fn new(
        wheel: &MarchedWheel<'a>,
        state: &WheelState,
        steps_per_period: usize,
    ) -> Option<Self> {
        let step_s = TAU / wheel.omega / steps_per_period as f64;
        let propagator = Propagator::new(wheel.structure, wheel.force, wheel.omega, step_s)?;
        let rows = &wheel.structure.contact().real;
        let n_rows = rows.rows();
        let contact = ContactRows::new(wheel.interface, n_rows);
        let compliance = propagator.compliance(rows);
        let stuck = stuck_inverse(&compliance, contact.springs())?;
        let mut stepper = Self {
            rows,
            steps_per_period,
            stuck_compliance: stuck.times(&compliance),
            compliance,
            stuck,
            step: 0,
            state: propagator.pack(&state.position, &state.velocity),
            next: vec![0.0; propagator.state_length()],
            position: state.position.clone(),
            pairs: state.pairs.clone(),
            pairs_after: state.pairs.clone(),
            balance: state.balance_n.clone(),
            displacement: rows.times_vector(&state.position),
            force: vec![0.0; n_rows],
            correction: vec![0.0; n_rows],
            modal_force: vec![0.0; wheel.structure.size()],
            predicted: vec![0.0; n_rows],
            without_correction: vec![0.0; n_rows],
            iterations: 0,
            contact,
            propagator,
        };
        stepper.meet_the_law();
        Some(stepper)
    }

    /// Goes on from `state`, at phase zero of the excitation.
    pub fn restart(&mut self, state: &WheelState) {
        self.step = 0;
        self.state = self.propagator.pack(&state.position, &state.velocity);
        self.position.clone_from(&state.position);
        self.pairs.clone_from(&state.pairs);
        self.balance.clone_from(&state.balance_n);
        self.displacement = self.rows.times_vector(&state.position);
        self.meet_the_law();
    }

    /// Steps per period.
    #[must_use]
    pub fn steps_per_period(&self) -> usize {
        self.steps_per_period
    }

    /// Modal positions now, `n_modes`.
    #[must_use]
    pub fn position(&self) -> &[f64] {
        &self.position
    }

    /// Contact force on the blisk's side of the equation at every contact row now, N, without the
    /// static load and without the balance.
    #[must_use]
    pub fn contact_force_n(&self) -> &[f64] {
        &self.force
    }

    /// Relative motion of every contact row now, m.
    #[must_use]
    pub fn contact_displacement_m(&self) -> &[f64] {
        &self.displacement
    }

    /// Memory of every pair now.
    #[must_use]
    pub fn pairs(&self) -> &[PairMemory] {
        &self.pairs
    }

    /// Iterations on the contact forces, all steps so far.
    #[must_use]
    pub fn iterations(&self) -> u64 {
        self.iterations
    }

    /// The state now; it can start another stepper at the end of a whole number of periods.
    #[must_use]
    pub fn state(&self) -> WheelState {
        WheelState {
            position: self.position.clone(),
            velocity: self.propagator.velocity(&self.state),
            pairs: self.pairs.clone(),
            balance_n: self.balance.clone(),
        }
    }

    /// Takes one step.
    ///
    /// # Errors
    /// [`Status::IterationLimit`] if the contact forces are not found, [`Status::NonFinite`].
    pub fn advance(&mut self) -> Result<(), Status> {
        let turn = self.step as f64 / self.steps_per_period as f64;
        let phase = Complex64::from_polar(1.0, TAU * turn);
        self.step = (self.step + 1) % self.steps_per_period;
        self.set_modal_force();
        self.propagator
            .advance(&self.state, &self.modal_force, phase, &mut self.next);
        self.propagator.position(&self.next, &mut self.position);
        self.find_contact_force()?;
        self.set_modal_force();
        self.propagator
            .add_force_after(&self.modal_force, &mut self.next);
        std::mem::swap(&mut self.state, &mut self.next);
        self.propagator.position(&self.state, &mut self.position);
        if self.position.iter().all(|q| q.is_finite()) {
            Ok(())
        } else {
            Err(Status::NonFinite)
        }
    }

    /// `p = -R^T (F + balance)`.
    fn set_modal_force(&mut self) {
        self.modal_force.fill(0.0);
        for part in [&self.force, &self.balance] {
            add_transpose_times_vector(&mut self.modal_force, -1.0, self.rows.as_slice(), part);
        }
    }

    /// The contact force at the end of the step, from the position without it.
    fn find_contact_force(&mut self) -> Result<(), Status> {
        let (rows, compliance) = (self.rows.as_slice(), self.compliance.as_slice());
        self.predicted.fill(0.0);
        add_times_vector(&mut self.predicted, 1.0, rows, &self.position);
        add_times_vector(&mut self.predicted, -1.0, compliance, &self.balance);
        self.without_correction.fill(0.0);
        add_times_vector(
            &mut self.without_correction,
            1.0,
            self.stuck.as_slice(),
            &self.predicted,
        );
        for _ in 0..MOST_ITERATIONS {
            self.iterations += 1;
            self.displacement.copy_from_slice(&self.without_correction);
            add_times_vector(
                &mut self.displacement,
                -1.0,
                self.stuck_compliance.as_slice(),
                &self.correction,
            );
            let (change, largest) = self.meet_the_law();
            if change <= CORRECTION_TOLERANCE * largest {
                std::mem::swap(&mut self.pairs, &mut self.pairs_after);
                return Ok(());
            }
        }
        Err(Status::IterationLimit)
    }

    /// Force and correction of the law at the present displacement; returns the largest change of a
    /// correction and the largest spring force.
    fn meet_the_law(&mut self) -> (f64, f64) {
        self.contact.march(
            &self.pairs,
            &self.displacement,
            &mut self.pairs_after,
            &mut self.force,
        );
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for (row, correction) in self.correction.iter_mut().enumerate() {
            let spring = self.contact.springs()[row] * self.displacement[row];
            let found = self.force[row] - spring;
            change = change.max((found - *correction).abs());
            largest = largest.max(spring.abs());
            *correction = found;
        }
        (change, largest)
    }
}

/// `(I + W k)^-1`; none if singular.
fn stuck_inverse(compliance: &Matrix<f64>, springs: &[f64]) -> Option<Matrix<f64>> {
    let n = springs.len();
    let mut factors = LuWorkspace::<f64>::new(n);
    for (j, spring) in springs.iter().enumerate() {
        for i in 0..n {
            let unit = f64::from(u8::from(i == j));
            factors.matrix_mut()[j * n + i] = unit + compliance[(i, j)] * spring;
        }
    }
    if !factors.factor() {
        return None;
    }
    let mut inverse = Matrix::<f64>::identity(n);
    for j in 0..n {
        factors.solve(inverse.column_mut(j));
    }
    Some(inverse)
}
