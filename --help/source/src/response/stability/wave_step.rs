//! One step of one wave without its contact: every mode by itself, exact under a force that is constant over the step.
//!
//! ```text
//! q'' + c q' + lambda q = p,    (q, q')_1 = A (q, q')_0 + g (p_0 + p_1) / 2
//! y = E q,    p = E^H f
//! ```
//!
//! The mean of the forces at both ends makes the step stable with contact springs of any stiffness. Modes above a cutoff
//! follow the force as springs do: `q = p / lambda`.

use crate::linalg::{Complex64, Matrix, exponential};
use crate::response::receptance::FreeWave;

/// One wave with the steps of its modes below the cutoff.
#[derive(Debug)]
pub(super) struct WaveStep {
    /// Whether its motions are real: h = 0 and N/2.
    pub(super) real: bool,
    /// Eigenvalue of every mode kept, (rad/s)^2.
    pub(super) eigenvalues: Vec<f64>,
    /// A, row after row.
    advance: Vec<[f64; 4]>,
    /// g.
    gain: Vec<[f64; 2]>,
    /// Rows `[Re E; Im E]` of contact and strain, `2 m x n`, column-major.
    motion: Vec<f64>,
    /// The rows of `motion` of the strain alone.
    strain: Vec<f64>,
    inputs: usize,
    strains: usize,
}

/// What the forces at an instant do at once to the motions and, of the strain, to their rates.
pub(super) struct Compliance {
    /// At the end of a step, `(m + r) x m`.
    pub(super) of_step: Matrix<Complex64>,
    /// By the modes above the cutoff alone.
    pub(super) at_rest: Matrix<Complex64>,
}

impl WaveStep {
    /// Steps of `step_s` at the angular frequency `omega`, at which a loss factor is replaced by viscous damping.
    pub(super) fn new(
        wave: &FreeWave,
        real: bool,
        loss_factor: f64,
        omega: f64,
        (step_s, cutoff): (f64, f64),
    ) -> (Self, Compliance) {
        let (contacts, strains) = (wave.contact.rows(), wave.strain.rows());
        let inputs = contacts + strains;
        let mut step = Self {
            real,
            eigenvalues: Vec::new(),
            advance: Vec::new(),
            gain: Vec::new(),
            motion: Vec::new(),
            strain: Vec::new(),
            inputs,
            strains,
        };
        let mut of_step = Matrix::zeros(inputs + strains, inputs);
        let mut at_rest = Matrix::zeros(inputs + strains, inputs);
        for (mode, (&lambda, &viscous)) in wave.eigenvalues.iter().zip(&wave.viscous).enumerate() {
            let contact = wave.contact.column(mode).iter();
            let row: Vec<Complex64> = contact.chain(wave.strain.column(mode)).copied().collect();
            let add = |matrix: &mut Matrix<Complex64>, position: f64, rate: f64| {
                for j in 0..inputs {
                    for i in 0..inputs + strains {
                        let (row_i, factor) = if i < inputs {
                            (row[i], position)
                        } else {
                            (row[i - strains], rate)
                        };
                        matrix[(i, j)] += row_i * row[j].conj() * factor;
                    }
                }
            };
            if lambda > cutoff * cutoff {
                add(&mut of_step, 1.0 / lambda, 0.0);
                add(&mut at_rest, 1.0 / lambda, 0.0);
                continue;
            }
            let damping = viscous + loss_factor * lambda.max(0.0) / omega;
            let (advance, gain) = exact(lambda, damping, step_s);
            add(&mut of_step, 0.5 * gain[0], 0.5 * gain[1]);
            step.eigenvalues.push(lambda);
            step.advance.push(advance);
            step.gain.push(gain);
            step.motion.extend(row.iter().map(|e| e.re));
            step.motion.extend(row.iter().map(|e| e.im));
            step.strain.extend(row[contacts..].iter().map(|e| e.re));
            step.strain.extend(row[contacts..].iter().map(|e| e.im));
        }
        (step, Compliance { of_step, at_rest })
    }

    /// Number of modes.
    pub(super) fn size(&self) -> usize {
        self.eigenvalues.len()
    }

    /// `(q, q') <- A (q, q')`.
    pub(super) fn advance(&self, position: &mut [f64], velocity: &mut [f64]) {
        let modes = position.iter_mut().zip(velocity).zip(&self.advance);
        for ((q, v), [a, b, c, d]) in modes {
            (*q, *v) = (a * *q + b * *v, c * *q + d * *v);
        }
    }

    /// `(q, q') <- (q, q') + g p / 2`.
    pub(super) fn push(&self, position: &mut [f64], velocity: &mut [f64], force: &[f64]) {
        let modes = position.iter_mut().zip(velocity).zip(&self.gain);
        for (((q, v), [of_q, of_v]), p) in modes.zip(force) {
            *q += 0.5 * of_q * p;
            *v += 0.5 * of_v * p;
        }
    }

    /// Motions of contact and strain, and the rates of the strain, as real and imaginary part of a wave: `m + r` each.
    pub(super) fn observe(&self, q: [&[f64]; 2], v: [&[f64]; 2], re: &mut [f64], im: &mut [f64]) {
        let (m, r) = (self.inputs, self.strains);
        observe(&self.motion, q, &mut re[..m], &mut im[..m]);
        observe(&self.strain, v, &mut re[m..m + r], &mut im[m..m + r]);
    }

    /// `p = E^H f`.
    pub(super) fn force(&self, f: [&[f64]; 2], re: &mut [f64], im: &mut [f64]) {
        let m = self.inputs;
        let modes = self.motion.chunks_exact(2 * m);
        for ((p_re, p_im), row) in re.iter_mut().zip(im).zip(modes) {
            let (e_re, e_im) = row.split_at(m);
            let (mut real, mut imaginary) = (0.0, 0.0);
            for ((er, ei), (fr, fi)) in e_re.iter().zip(e_im).zip(f[0].iter().zip(f[1])) {
                real += er * fr + ei * fi;
                imaginary += er * fi - ei * fr;
            }
            (*p_re, *p_im) = (real, imaginary);
        }
    }
}

/// `re + i im = E (x_0 + i x_1)`.
fn observe(rows: &[f64], x: [&[f64]; 2], re: &mut [f64], im: &mut [f64]) {
    re.fill(0.0);
    im.fill(0.0);
    let m = re.len();
    if m == 0 {
        return;
    }
    for ((row, &a), &b) in rows.chunks_exact(2 * m).zip(x[0]).zip(x[1]) {
        let (e_re, e_im) = row.split_at(m);
        for ((re, im), (er, ei)) in re.iter_mut().zip(&mut *im).zip(e_re.iter().zip(e_im)) {
            *re += er * a - ei * b;
            *im += er * b + ei * a;
        }
    }
}

/// A and g of a mode.
fn exact(lambda: f64, damping: f64, step_s: f64) -> ([f64; 4], [f64; 2]) {
    // (q, h q', p) over the step, p constant.
    let mut generator = Matrix::<f64>::zeros(3, 3);
    generator[(0, 1)] = 1.0;
    generator[(1, 0)] = -step_s * step_s * lambda;
    generator[(1, 1)] = -step_s * damping;
    generator[(1, 2)] = step_s * step_s;
    let e = exponential(&generator);
    (
        [e[(0, 0)], e[(0, 1)] * step_s, e[(1, 0)] / step_s, e[(1, 1)]],
        [e[(0, 2)], e[(1, 2)] / step_s],
    )
}
