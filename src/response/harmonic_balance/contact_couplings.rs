//! How the corrections of the contact forces depend on the motions, for all contact rows side by side.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::linear_factors::LinearFactors;
use super::{HarmonicSystem, SystemWorkspace};
use crate::linalg::{Loops, vectorized};

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
struct Couplings {
    /// Contact row of the motion.
    from: Vec<usize>,
    /// `dG_c/dd_c'`, for every c' and c one per row; zero where there are fewer couplings.
    slopes: Vec<f64>,
}

impl ContactCouplings {
    /// The rows that have a correction, and the derivatives of the corrections.
    pub(super) fn gather(&mut self, system: &HarmonicSystem, workspace: &SystemWorkspace) {
        let geometry = &system.interface.geometry;
        let count = system.transform.n_coefficients();
        self.count = count;
        self.rows.clear();
        // Place of the correction, contact row of the motion, and derivatives, those of one correction together.
        let mut found: Vec<(usize, usize, &[f64])> = Vec::new();
        for (pair, jacobian) in workspace.jacobians.iter().enumerate() {
            if !workspace.active[pair] {
                continue;
            }
            let base = pair / geometry.rows.len() * geometry.row_count();
            let places = &geometry.rows[pair % geometry.rows.len()];
            let first = usize::from(!workspace.separated);
            for (direction, place) in places.iter().enumerate().skip(first) {
                let Some(row) = *place else { continue };
                for (other, place) in places.iter().enumerate() {
                    if let (Some(from), Some(block)) = (*place, jacobian.block(direction, other)) {
                        found.push((self.rows.len(), base + from, block));
                    }
                }
                self.rows.push(base + row);
            }
        }
        let rows = self.rows.len();
        self.couplings.clear();
        let mut number = 0;
        for (place, &(to, from, block)) in found.iter().enumerate() {
            let again = place > 0 && found[place - 1].0 == to;
            number = if again { number + 1 } else { 0 };
            if self.couplings.len() == number {
                self.couplings.push(Couplings {
                    from: vec![0; rows],
                    slopes: vec![0.0; count * count * rows],
                });
            }
            let Couplings {
                from: motions,
                slopes,
            } = &mut self.couplings[number];
            motions[to] = from;
            for (c, row) in block.chunks_exact(count).enumerate() {
                for (by, slope) in row.iter().enumerate() {
                    slopes[(by * count + c) * rows + to] = *slope;
                }
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
