//! Receptances of the tuned wheel by frequency: poles and a smooth rest, interpolated.
//!
//! Over a panel of frequencies the receptance of every wave is
//!
//! ```text
//! R(s) = sum_j E x_j (E y_j)^H / (s - s_j) + smooth(s)
//! ```
//!
//! with the damped modes `s_j` near the panel and a rest that a polynomial through Chebyshev points follows (Trefethen 2013,
//! Approximation Theory and Approximation Practice). Panels lie on one fixed grid of frequencies, so that what a panel
//! holds depends on the wheel alone.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

use crate::linalg::{Complex64, Loops, Matrix, vectorized};

use super::blade_shapes::Participation;
use super::fields::LANES;
use super::tuned_diameter::{Pole, TunedDiameter};
use super::wave_matrix::WaveMatrix;

/// Panels of an octave.
const PANELS: f64 = 16.0;
/// Relative distance from the panel up to which poles are taken out.
const NEAR: f64 = 0.1;
/// Points of the interpolation, tried one after the other.
const POINTS: [usize; 3] = [7, 11, 17];
/// Relative error of the interpolation that is accepted.
const ACCEPTED: f64 = 1e-7;
/// Relative error of the interpolation above which receptances are summed and not interpolated.
const REFUSED: f64 = 1e-5;
/// Modes of a nodal diameter up to which receptances are summed and not interpolated.
const LARGEST_SUMMED: usize = 40;

/// Receptances of one harmonic between the motions [contact, strain, observed] and forces at [contact, strain].
#[derive(Debug)]
pub(super) struct Receptances {
    sectors: usize,
    /// Motions of every nodal diameter, `m x n`.
    motions: Vec<Matrix<Complex64>>,
    /// Number of inputs, the first motions.
    inputs: usize,
    panels: RwLock<HashMap<i32, Arc<Panel>>>,
    /// R of harmonic 0.
    static_ones: OnceLock<Option<WaveMatrix>>,
}

/// What stands for R between two frequencies.
#[derive(Debug)]
struct Panel {
    /// Angular frequencies of its ends, rad/s.
    ends: (f64, f64),
    nodes: Vec<f64>,
    weights: Vec<f64>,
    /// The smooth rest at the nodes, those of every group of lanes side by side.
    smooth: Smooth,
    /// The poles, those of all waves side by side; a wave with fewer has zeros.
    poles: Vec<WavePole>,
    /// Relative error of the interpolation, seen between its points.
    error: f64,
}

#[derive(Debug, Default)]
struct Smooth {
    rows: usize,
    columns: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

#[derive(Debug)]
struct WavePole {
    s: WaveMatrix,
    /// `E x`, `m x 1`.
    motion: WaveMatrix,
    /// Conjugate of `E y`, `inputs x 1`.
    force: WaveMatrix,
}

impl Receptances {
    pub(super) fn new(diameters: &[TunedDiameter], strain: &Participation, sectors: usize) -> Self {
        let motions: Vec<Matrix<Complex64>> = diameters
            .iter()
            .zip(strain)
            .map(|(diameter, strain)| diameter.motions(strain))
            .collect();
        Self {
            sectors,
            inputs: motions.first().map_or(0, |matrix| matrix.rows() - 3),
            motions,
            panels: RwLock::new(HashMap::new()),
            static_ones: OnceLock::new(),
        }
    }

    /// Motions of a nodal diameter.
    pub(super) fn motions(&self, index: usize) -> &Matrix<Complex64> {
        &self.motions[index]
    }

    /// R at the angular frequency `s` of every wave, summed.
    pub(super) fn summed(&self, diameters: &[TunedDiameter], s: f64) -> Option<WaveMatrix> {
        let mut all = WaveMatrix::zeros(self.inputs + 3, self.inputs, self.sectors);
        for (index, (diameter, motions)) in diameters.iter().zip(&self.motions).enumerate() {
            let (_, receptance) = diameter.receptance(s, motions, self.inputs + 3)?;
            for column in 0..self.inputs {
                for row in 0..self.inputs + 3 {
                    all.set(index, row, column, receptance[(row, column)]);
                    if diameter.waves == 2 {
                        // The conjugate wave of a reciprocal sector.
                        let other = self.sectors - index;
                        all.set(other, row, column, receptance[(column, row)]);
                    }
                }
            }
        }
        Some(all)
    }

    /// R at `s`, from the panel that it lies in; none where Z is singular.
    pub(super) fn at(
        &self,
        diameters: &[TunedDiameter],
        s: f64,
        into: &mut WaveMatrix,
    ) -> Option<()> {
        let small = diameters
            .iter()
            .all(|diameter| diameter.size() <= LARGEST_SUMMED);
        if s <= 0.0 {
            let known = self.static_ones.get_or_init(|| self.summed(diameters, 0.0));
            into.clone_from(known.as_ref()?);
            return Some(());
        }
        if small {
            *into = self.summed(diameters, s)?;
            return Some(());
        }
        let place = (PANELS * s.log2()).floor() as i32;
        let panel = if let Some(panel) = self.known(place) {
            panel
        } else {
            let panel = Arc::new(self.panel(diameters, place)?);
            let mut panels = self.panels.write().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(panels.entry(place).or_insert(panel))
        };
        if panel.error > REFUSED {
            *into = self.summed(diameters, s)?;
        } else {
            panel.evaluate(s, into);
        }
        Some(())
    }

    fn known(&self, place: i32) -> Option<Arc<Panel>> {
        let panels = self.panels.read().unwrap_or_else(PoisonError::into_inner);
        panels.get(&place).cloned()
    }

    /// Largest relative error of the interpolation in the panels made so far and used.
    pub(super) fn error(&self) -> f64 {
        let panels = self.panels.read().unwrap_or_else(PoisonError::into_inner);
        let errors = panels.values().map(|panel| panel.error);
        errors.filter(|&error| error <= REFUSED).fold(0.0, f64::max)
    }

    fn panel(&self, diameters: &[TunedDiameter], place: i32) -> Option<Panel> {
        let end = |place: i32| (f64::from(place) / PANELS).exp2();
        let ends = (end(place), end(place + 1));
        let poles = self.poles(diameters, ends);
        let mut best: Option<Panel> = None;
        for points in POINTS {
            let mut panel =
                Panel::through(points, ends, poles.iter().map(WavePole::copy).collect());
            let mut smooth = Vec::new();
            for &node in &panel.nodes {
                let mut rest = self.summed(diameters, node)?;
                add_poles(&panel.poles, node, -1.0, &mut rest);
                smooth.push(rest);
            }
            panel.smooth = Smooth::new(&smooth);
            panel.error = self.error_of(diameters, &panel)?;
            let better = best.as_ref().is_none_or(|best| panel.error < best.error);
            if better {
                best = Some(panel);
            }
            if best.as_ref().is_some_and(|best| best.error <= ACCEPTED) {
                break;
            }
        }
        best
    }

    /// Largest error halfway between nodes, relative to the largest direct receptances of the motion and the force.
    fn error_of(&self, diameters: &[TunedDiameter], panel: &Panel) -> Option<f64> {
        let mut error = 0.0_f64;
        let mut found = WaveMatrix::default();
        for pair in [0, panel.nodes.len() / 2] {
            let s = 0.5 * (panel.nodes[pair] + panel.nodes[pair + 1]);
            let exact = self.summed(diameters, s)?;
            panel.evaluate(s, &mut found);
            let of_row = |row: usize| {
                let entries = (0..self.sectors).flat_map(|h| (0..self.inputs).map(move |j| (h, j)));
                entries
                    .map(|(h, j)| exact.at(h, row, j).norm())
                    .fold(0.0, f64::max)
            };
            for row in 0..self.inputs + 3 {
                let largest = of_row(row);
                for h in 0..self.sectors {
                    for j in 0..self.inputs {
                        let deviation = (exact.at(h, row, j) - found.at(h, row, j)).norm();
                        error = error.max(deviation / largest.max(f64::MIN_POSITIVE));
                    }
                }
            }
        }
        Some(error)
    }

    fn poles(&self, diameters: &[TunedDiameter], ends: (f64, f64)) -> Vec<WavePole> {
        let near = |omega: f64| omega > ends.0 * (1.0 - NEAR) && omega < ends.1 * (1.0 + NEAR);
        let of_diameters: Vec<Vec<Pole>> = diameters
            .iter()
            .map(|diameter| {
                let modes = (0..diameter.size()).filter(|&mode| near(diameter.natural.0[mode]));
                let mut poles: Vec<Pole> = Vec::new();
                for pole in modes.filter_map(|mode| diameter.pole(mode)) {
                    let apart = |known: &Pole| (known.s - pole.s).norm() > 1e-9 * pole.s.norm();
                    if poles.iter().all(apart) {
                        poles.push(pole);
                    }
                }
                poles
            })
            .collect();
        let most = of_diameters.iter().map(Vec::len).max().unwrap_or(0);
        (0..most)
            .map(|place| {
                let column = |rows| WaveMatrix::zeros(rows, 1, self.sectors);
                let mut all = WavePole {
                    s: column(1),
                    motion: column(self.inputs + 3),
                    force: column(self.inputs),
                };
                for (index, poles) in of_diameters.iter().enumerate() {
                    let Some(pole) = poles.get(place) else {
                        continue;
                    };
                    let motion = self.motions[index].times_vector(&pole.right);
                    let force = self.motions[index].times_vector(&pole.left);
                    let other = (diameters[index].waves == 2).then_some(self.sectors - index);
                    for wave in [Some(index), other].into_iter().flatten() {
                        all.s.set(wave, 0, 0, pole.s);
                    }
                    for row in 0..self.inputs + 3 {
                        all.motion.set(index, row, 0, motion[row]);
                        if let Some(other) = other {
                            all.motion.set(other, row, 0, force[row].conj());
                        }
                    }
                    for row in 0..self.inputs {
                        all.force.set(index, row, 0, force[row].conj());
                        if let Some(other) = other {
                            all.force.set(other, row, 0, motion[row]);
                        }
                    }
                }
                all
            })
            .collect()
    }
}

impl Smooth {
    fn new(nodes: &[WaveMatrix]) -> Self {
        let first = &nodes[0];
        let interleaved = |part: fn(&WaveMatrix) -> &[f64]| -> Vec<f64> {
            (0..first.re.len() / LANES)
                .flat_map(|at| nodes.iter().map(move |node| (at, node)))
                .flat_map(|(at, node)| part(node)[at * LANES..][..LANES].iter().copied())
                .collect()
        };
        Self {
            rows: first.rows,
            columns: first.columns,
            re: interleaved(|node| &node.re),
            im: interleaved(|node| &node.im),
        }
    }
}

impl WavePole {
    fn copy(&self) -> Self {
        Self {
            s: self.s.clone(),
            motion: self.motion.clone(),
            force: self.force.clone(),
        }
    }
}

impl Panel {
    /// A panel with Chebyshev points and nothing at them.
    fn through(points: usize, ends: (f64, f64), poles: Vec<WavePole>) -> Self {
        let angle = |i: usize| std::f64::consts::PI * (2 * i + 1) as f64 / (2 * points) as f64;
        let (middle, half) = (0.5 * (ends.0 + ends.1), 0.5 * (ends.1 - ends.0));
        Self {
            ends,
            nodes: (0..points)
                .map(|i| middle - half * angle(i).cos())
                .collect(),
            weights: (0..points)
                .map(|i| {
                    if i % 2 == 0 {
                        angle(i).sin()
                    } else {
                        -angle(i).sin()
                    }
                })
                .collect(),
            smooth: Smooth::default(),
            poles,
            error: f64::INFINITY,
        }
    }

    fn evaluate(&self, s: f64, into: &mut WaveMatrix) {
        debug_assert!(s >= self.ends.0 && s <= self.ends.1);
        let entries = self.smooth.re.len() / self.nodes.len();
        (into.rows, into.columns) = (self.smooth.rows, self.smooth.columns);
        into.re.resize(entries, 0.0);
        into.im.resize(entries, 0.0);
        let exact = self
            .nodes
            .iter()
            .position(|node| (node - s).abs() < 1e-14 * s);
        let mut shares: Vec<f64> = if let Some(at) = exact {
            let share = |i| f64::from(u8::from(i == at));
            (0..self.nodes.len()).map(share).collect()
        } else {
            let both = self.weights.iter().zip(&self.nodes);
            both.map(|(weight, node)| weight / (s - node)).collect()
        };
        let sum: f64 = shares.iter().sum();
        for share in &mut shares {
            *share /= sum;
        }
        vectorized(Interpolated {
            smooth: &self.smooth,
            shares: &shares,
            into,
        });
        add_poles(&self.poles, s, 1.0, into);
    }
}

struct Interpolated<'a> {
    smooth: &'a Smooth,
    shares: &'a [f64],
    into: &'a mut WaveMatrix,
}

impl Loops for Interpolated<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "only what is inlined is compiled for vectors"
    )]
    #[inline(always)]
    fn call(self) {
        interpolate(&mut self.into.re, self.shares, &self.smooth.re);
        interpolate(&mut self.into.im, self.shares, &self.smooth.im);
    }
}

#[expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]
#[inline(always)]
fn interpolate(sum: &mut [f64], shares: &[f64], nodes: &[f64]) {
    let nodes = nodes.as_chunks::<LANES>().0.chunks_exact(shares.len());
    for (sum, nodes) in sum.as_chunks_mut::<LANES>().0.iter_mut().zip(nodes) {
        let mut lanes = [0.0; LANES];
        for (node_values, share) in nodes.iter().zip(shares) {
            for lane in 0..LANES {
                lanes[lane] += share * node_values[lane];
            }
        }
        *sum = lanes;
    }
}

/// Adds `factor` times what the poles are at `s`.
fn add_poles(poles: &[WavePole], s: f64, factor: f64, to: &mut WaveMatrix) {
    for pole in poles {
        vectorized(AddPole {
            pole,
            s,
            factor,
            to,
        });
    }
}

struct AddPole<'a> {
    pole: &'a WavePole,
    s: f64,
    factor: f64,
    to: &'a mut WaveMatrix,
}

impl Loops for AddPole<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "only what is inlined is compiled for vectors"
    )]
    #[inline(always)]
    fn call(self) {
        let (rows, columns) = (self.to.rows, self.to.columns);
        let (to_re, _) = self.to.re.as_chunks_mut::<LANES>();
        let (to_im, _) = self.to.im.as_chunks_mut::<LANES>();
        let (s_re, s_im) = (
            self.pole.s.re.as_chunks::<LANES>().0,
            self.pole.s.im.as_chunks::<LANES>().0,
        );
        let motion = &self.pole.motion;
        let (u_re, u_im) = (
            motion.re.as_chunks::<LANES>().0,
            motion.im.as_chunks::<LANES>().0,
        );
        let force = &self.pole.force;
        let (v_re, v_im) = (
            force.re.as_chunks::<LANES>().0,
            force.im.as_chunks::<LANES>().0,
        );
        for chunk in 0..s_re.len() {
            let (mut p, mut q) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                let (a, b) = (self.s - s_re[chunk][lane], -s_im[chunk][lane]);
                let square = self.factor / (a * a + b * b);
                (p[lane], q[lane]) = (a * square, -b * square);
            }
            for row in 0..rows {
                let (u, w) = (&u_re[chunk * rows + row], &u_im[chunk * rows + row]);
                let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
                for lane in 0..LANES {
                    x[lane] = u[lane] * p[lane] - w[lane] * q[lane];
                    y[lane] = u[lane] * q[lane] + w[lane] * p[lane];
                }
                let start = (chunk * rows + row) * columns;
                for column in 0..columns {
                    let (v, z) = (
                        &v_re[chunk * columns + column],
                        &v_im[chunk * columns + column],
                    );
                    let to_re = &mut to_re[start + column];
                    let to_im = &mut to_im[start + column];
                    for lane in 0..LANES {
                        to_re[lane] += x[lane] * v[lane] - y[lane] * z[lane];
                        to_im[lane] += x[lane] * z[lane] + y[lane] * v[lane];
                    }
                }
            }
        }
    }
}
