//! Exact propagation of the structure over one step.
//!
//! With the scaled state `z = (q, h q')` and time `s = t/h` from 0 to 1,
//!
//! ```text
//! dz/ds = [0, I; -h^2 diag(lambda), -h C] z + [0; h^2] (p0 + s (p1 - p0) + Re(f e^{i omega t}))
//! ```
//!
//! p is the modal contact force, taken as linear over the step; structure and excitation are not
//! approximated. The solution is one matrix exponential: the inputs ride along as further states
//! (Van Loan 1978). Modes that damping does not couple have one exponential each.

use crate::linalg::{Complex64, Matrix, add_times_vector, exponential};
use crate::response::harmonic_balance::Structure;

/// Propagation of the modes `start..start + count`, coupled by damping.
struct Block {
    start: usize,
    count: usize,
    /// `2 count x 2 count`.
    state: Matrix<f64>,
    /// Columns for the cosine and the sine of the phase at the start of the step, `2 count x 2`.
    excitation: Matrix<f64>,
    /// Weights of the force at the start and at the end of the step, `2 count x count`.
    force_before: Matrix<f64>,
    force_after: Matrix<f64>,
}

/// Propagator of all modes for one step size. States are block after block `(q, h q')`.
pub(super) struct Propagator {
    step_s: f64,
    blocks: Vec<Block>,
}

impl Propagator {
    /// For steps of `step_s` under the modal force `Re(force e^{i omega t})`; none if the damping has
    /// no time-domain form.
    pub(super) fn new(
        structure: &Structure,
        force: &[Complex64],
        omega: f64,
        step_s: f64,
    ) -> Option<Self> {
        if !structure.is_viscous() {
            return None;
        }
        let n = structure.size();
        let mut damping = Matrix::<f64>::zeros(n, n);
        structure.for_each_damping(1.0, |i, j, c| damping[(i, j)] += c);
        let ranges = if structure.is_diagonal() {
            (0..n).map(|mode| (mode, 1)).collect()
        } else {
            vec![(0, n)]
        };
        let blocks = ranges
            .into_iter()
            .map(|(start, count)| {
                let modes = Modes {
                    eigenvalues: &structure.eigenvalues()[start..start + count],
                    damping: Matrix::from_fn(count, count, |i, j| damping[(start + i, start + j)]),
                    force: &force[start..start + count],
                };
                modes.propagate(start, omega, step_s)
            })
            .collect();
        Some(Self { step_s, blocks })
    }

    /// Length of a state.
    pub(super) fn state_length(&self) -> usize {
        self.blocks.iter().map(|block| 2 * block.count).sum()
    }

    /// State from modal positions and velocities.
    pub(super) fn pack(&self, position: &[f64], velocity: &[f64]) -> Vec<f64> {
        let mut state = Vec::with_capacity(self.state_length());
        for block in &self.blocks {
            let modes = block.start..block.start + block.count;
            state.extend_from_slice(&position[modes.clone()]);
            state.extend(velocity[modes].iter().map(|v| self.step_s * v));
        }
        state
    }

    /// Modal positions of a state.
    pub(super) fn position(&self, state: &[f64], position: &mut [f64]) {
        for block in &self.blocks {
            let at = 2 * block.start;
            position[block.start..block.start + block.count]
                .copy_from_slice(&state[at..at + block.count]);
        }
    }

    /// Modal velocities of a state, per second.
    pub(super) fn velocity(&self, state: &[f64]) -> Vec<f64> {
        let mut velocity = Vec::with_capacity(state.len() / 2);
        for block in &self.blocks {
            let at = 2 * block.start + block.count;
            velocity.extend(state[at..at + block.count].iter().map(|w| w / self.step_s));
        }
        velocity
    }

    /// `next = Phi state + excitation + weight p0`: all of the step but the force at its end.
    pub(super) fn advance(
        &self,
        state: &[f64],
        force_before: &[f64],
        phase: Complex64,
        next: &mut [f64],
    ) {
        next.fill(0.0);
        for block in &self.blocks {
            let range = 2 * block.start..2 * (block.start + block.count);
            let next = &mut next[range.clone()];
            let force = &force_before[block.start..block.start + block.count];
            add_times_vector(next, 1.0, block.state.as_slice(), &state[range]);
            add_times_vector(next, 1.0, block.force_before.as_slice(), force);
            let phases = [phase.re, phase.im];
            add_times_vector(next, 1.0, block.excitation.as_slice(), &phases);
        }
    }

    /// Adds the part of the force at the end of the step.
    pub(super) fn add_force_after(&self, force_after: &[f64], next: &mut [f64]) {
        for block in &self.blocks {
            let next = &mut next[2 * block.start..2 * (block.start + block.count)];
            let force = &force_after[block.start..block.start + block.count];
            add_times_vector(next, 1.0, block.force_after.as_slice(), force);
        }
    }

    /// `rows G rows^T`, with G the positions at the end caused by the force at the end.
    pub(super) fn compliance(&self, rows: &Matrix<f64>) -> Matrix<f64> {
        let mut sum = Matrix::zeros(rows.rows(), rows.rows());
        for block in &self.blocks {
            let block_rows = rows.column_range(block.start, block.start + block.count);
            let weight =
                Matrix::from_fn(block.count, block.count, |i, j| block.force_after[(i, j)]);
            let part = block_rows.times(&weight).times(&block_rows.adjoint());
            for (sum, part) in sum.as_mut_slice().iter_mut().zip(part.as_slice()) {
                *sum += part;
            }
        }
        sum
    }
}

/// Coupled modes before discretisation.
struct Modes<'a> {
    eigenvalues: &'a [f64],
    damping: Matrix<f64>,
    force: &'a [Complex64],
}

impl Modes<'_> {
    fn propagate(&self, start: usize, omega: f64, step_s: f64) -> Block {
        let n = self.eigenvalues.len();
        let square = step_s * step_s;
        // States: q, h q', the force at this instant, its growth over the step, cosine, sine.
        let (held, grown, phase) = (2 * n, 3 * n, 4 * n);
        let mut generator = Matrix::<f64>::zeros(4 * n + 2, 4 * n + 2);
        for i in 0..n {
            generator[(i, n + i)] = 1.0;
            generator[(n + i, i)] = -square * self.eigenvalues[i];
            for j in 0..n {
                generator[(n + i, n + j)] -= step_s * self.damping[(i, j)];
            }
            generator[(n + i, held + i)] = square;
            // The input `held` grows by `grown` over the step.
            generator[(held + i, grown + i)] = 1.0;
            generator[(n + i, phase)] = square * self.force[i].re;
            generator[(n + i, phase + 1)] = -square * self.force[i].im;
        }
        generator[(phase, phase + 1)] = -step_s * omega;
        generator[(phase + 1, phase)] = step_s * omega;
        let exact = exponential(&generator);
        let part = |column: usize, columns: usize| {
            Matrix::from_fn(2 * n, columns, |i, j| exact[(i, column + j)])
        };
        let force_after = part(grown, n);
        let both = part(held, n);
        Block {
            start,
            count: n,
            state: part(0, 2 * n),
            excitation: part(phase, 2),
            force_before: Matrix::from_fn(2 * n, n, |i, j| both[(i, j)] - force_after[(i, j)]),
            force_after,
        }
    }
}
