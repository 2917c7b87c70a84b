//! How the corrections of the contact forces depend on the motions, for all contact rows side by side.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::linear_factors::LinearFactors;
use crate::linalg::{Loops, vectorized};
use crate::response::harmonic_balance::pairs::{InterfaceForces, InterfaceWorkspace};

/// The derivative G' of the corrections. Corrections are ordered coefficient after coefficient, in each row after row of
/// those that have one.
#[derive(Default)]
pub(super) struct ContactCouplings {
    /// Contact rows that have a correction.
    pub(super) rows: Vec<usize>,
    /// The first coupling of every row, the second, and so on.
    couplings: Vec<Couplings>,
    /// Coefficients of a row.
    count: usize,
}

/// Dependence of the correction at every row that has one on the motion at one contact row.
#[derive(Default)]
struct Couplings {
    /// Contact row of the motion.
    from: Vec<usize>,
    /// `dG_c/dd_c'`, for every c' and c one per row; zero where there are fewer couplings.
    slopes: Vec<f64>,
}

impl Couplings {
    /// None, of `rows` rows with `count` coefficients.
    fn clear(&mut self, rows: usize, count: usize) {
        self.from.clear();
        self.from.resize(rows, 0);
        self.slopes.clear();
        self.slopes.resize(count * count * rows, 0.0);
    }
}

impl ContactCouplings {
    /// The rows that have a correction, and the derivatives of the corrections.
    pub(super) fn gather(&mut self, contact: &InterfaceForces, workspace: &InterfaceWorkspace) {
        let geometry = &contact.interface.geometry;
        let count = contact.transform.n_coefficients();
        self.count = count;
        self.rows.clear();
        let first = usize::from(!workspace.separated);
        let variable_load = contact.interface.law.has_variable_load();
        let active = || (0..workspace.active.len()).filter(|&pair| workspace.active[pair]);
        let places = |pair: usize| &geometry.rows[pair % geometry.rows.len()];
        let base = |pair: usize| pair / geometry.rows.len() * geometry.row_count();
        for pair in active() {
            let pair_rows = places(pair)[first..].iter().flatten();
            self.rows.extend(pair_rows.map(|row| base(pair) + row));
        }
        for couplings in &mut self.couplings {
            couplings.clear(self.rows.len(), count);
        }
        let mut to = 0;
        for pair in active() {
            for (direction, place) in places(pair).iter().enumerate().skip(first) {
                if place.is_none() {
                    continue;
                }
                let mut number = 0;
                for (other, place) in places(pair).iter().enumerate() {
                    // Under a constant load friction does not depend on the motion along n.
                    if other == 0 && direction > 0 && !variable_load {
                        continue;
                    }
                    let block = workspace.jacobians[pair].block(direction, other);
                    if let (Some(from), Some(block)) = (*place, block) {
                        self.couple(number, to, base(pair) + from, block);
                        number += 1;
                    }
                }
                to += 1;
            }
        }
    }

    /// Coupling `number` of the correction at place `to` with the motion at the contact row `from`; `block` is `dG_c/dd_c'`, a
    /// row per c.
    fn couple(&mut self, number: usize, to: usize, from: usize, block: &[f64]) {
        let (rows, count) = (self.rows.len(), self.count);
        if self.couplings.len() == number {
            let mut more = Couplings::default();
            more.clear(rows, count);
            self.couplings.push(more);
        }
        let couplings = &mut self.couplings[number];
        couplings.from[to] = from;
        for (c, row) in block.chunks_exact(count).enumerate() {
            for (by, slope) in row.iter().enumerate() {
                couplings.slopes[(by * count + c) * rows + to] = *slope;
            }
        }
    }

    /// `matrix += G' R`, with the receptance of every harmonic.
    pub(super) fn add_times(&self, linear: &[LinearFactors], matrix: &mut [f64]) {
        for couplings in &self.couplings {
            vectorized(Assembly {
                matrix,
                rows: &self.rows,
                couplings,
                linear,
                count: self.count,
            });
        }
    }

    /// `forces += G' motion`, the motion of all `m` contact rows.
    pub(super) fn add_to(&self, forces: &mut [f64], motion: &[f64], m: usize) {
        let rows = self.rows.len();
        for Couplings { from, slopes } in &self.couplings {
            let by_motion = slopes.chunks_exact(self.count * rows);
            for (motion, slopes) in motion.chunks_exact(m).zip(by_motion) {
                let forces = forces.chunks_exact_mut(rows);
                for (forces, slopes) in forces.zip(slopes.chunks_exact(rows)) {
                    for ((force, slope), &from) in forces.iter_mut().zip(slopes).zip(from) {
                        *force += slope * motion[from];
                    }
                }
            }
        }
    }
}

/// `matrix += G' R` of one coupling of every row.
struct Assembly<'a> {
    matrix: &'a mut [f64],
    rows: &'a [usize],
    couplings: &'a Couplings,
    linear: &'a [LinearFactors],
    /// Coefficients of a row.
    count: usize,
}

impl Loops for Assembly<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            matrix,
            rows,
            couplings,
            linear,
            count,
        } = self;
        let Couplings { from, slopes } = couplings;
        let size = count * rows.len();
        let (mut re, mut im) = (vec![0.0; rows.len()], vec![0.0; rows.len()]);
        for part in linear {
            let first = part.coefficient * count * rows.len();
            let slopes = &slopes[first..][..part.parts * size];
            for (j, row) in rows.iter().enumerate() {
                // R is symmetric.
                let m = part.rows();
                let [all_re, all_im] = part.receptance.each_ref().map(|r| &r[row * m..][..m]);
                for ((re, im), &from) in re.iter_mut().zip(&mut im).zip(from) {
                    (*re, *im) = (all_re[from], all_im[from]);
                }
                let column = (part.coefficient * rows.len() + j) * size;
                let target = &mut matrix[column..column + size];
                if part.parts == 1 {
                    add_products(target, slopes, &re);
                    continue;
                }
                let (by_re, by_im) = slopes.split_at(size);
                add_products(target, by_re, &re);
                add_products(target, by_im, &im);
                let target = &mut matrix[column + rows.len() * size..][..size];
                for im in &mut im {
                    *im = -*im;
                }
                add_products(target, by_im, &re);
                add_products(target, by_re, &im);
            }
        }
    }
}

/// Adds `slopes * receptance` entry by entry, the receptance again for every coefficient.
#[inline(always)]
fn add_products(target: &mut [f64], slopes: &[f64], receptance: &[f64]) {
    let rows = receptance.len();
    let targets = target.chunks_exact_mut(rows);
    for (target, slopes) in targets.zip(slopes.chunks_exact(rows)) {
        for ((entry, slope), r) in target.iter_mut().zip(slopes).zip(receptance) {
            *entry += slope * r;
        }
    }
}
