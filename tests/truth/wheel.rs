//! Dynamic stiffness of a whole mistuned wheel at one frequency, factored sector by sector and round the wheel.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, MatRef, c64};

use super::sector::{DIRECTIONS, Sector};

/// Springs of one pair between its three directions, N/m: row force by column motion.
pub type PairStiffness = [[c64; DIRECTIONS]; DIRECTIONS];

/// `K (1 + i eta) - w^2 M` of every sector with its springs at the contact, factored.
pub struct FactoredWheel<'a> {
    sector: &'a Sector,
    /// Points and modes of each sector.
    inside: Vec<Inside>,
    /// Pivot of each low face but the last, in order, and of the last one.
    pivots: Vec<PartialPivLu<c64>>,
    /// `P_n^-1` times the couplings with the next face and with the last one.
    to_next: Vec<Mat<c64>>,
    to_last: Vec<Mat<c64>>,
    /// Couplings of the next face and of the last one with this one.
    of_next: Vec<Mat<c64>>,
    of_last: Vec<Mat<c64>>,
}

struct Inside {
    factors: PartialPivLu<c64>,
    /// `D_QQ^-1 D_QF`.
    follows: Mat<c64>,
    /// `D_FQ`.
    faces: Mat<c64>,
}

/// Motions of a wheel, sector after sector.
pub struct Motion {
    /// Relative motion at the contact rows, m.
    pub contact: Vec<c64>,
    /// Motion of the observed node, three a sector, m.
    pub observed: Vec<c64>,
}

impl<'a> FactoredWheel<'a> {
    /// At `omega`, rad/s, which is harmonic times excitation; `springs` of each pair, sector after sector; `deviations`
    /// of the blades' stiffness. Harmonic 0 has no loss factor.
    pub fn new(
        sector: &'a Sector,
        omega: f64,
        loss_factor: f64,
        deviations: &[f64],
        springs: &[PairStiffness],
    ) -> Self {
        let (n, f) = (sector.sectors, sector.face);
        assert!(n > 2 && deviations.len() == n);
        let faces = 2 * f;
        let inner = sector.size() - faces;
        let loss = c64::new(1.0, if omega > 0.0 { loss_factor } else { 0.0 });
        let mut inside = Vec::with_capacity(n);
        let mut condensed = Vec::with_capacity(n);
        for (own, delta) in deviations.iter().enumerate() {
            let mut dynamic = Mat::from_fn(sector.size(), sector.size(), |i, j| {
                let stiffness = sector.stiffness[(i, j)] + delta * sector.blade[(i, j)];
                loss * stiffness - c64::new(omega * omega * sector.mass[(i, j)], 0.0)
            });
            let own_springs = &springs[own * sector.pairs.len()..(own + 1) * sector.pairs.len()];
            for (pair, stiffness) in sector.pairs.iter().zip(own_springs) {
                for (row, force) in pair.rows.iter().zip(stiffness) {
                    for (column, &spring) in pair.rows.iter().zip(force) {
                        for &(i, a) in row {
                            for &(j, b) in column {
                                dynamic[(i, j)] += spring * (a * b);
                            }
                        }
                    }
                }
            }
            let factors = dynamic
                .as_ref()
                .submatrix(faces, faces, inner, inner)
                .partial_piv_lu();
            let follows = factors.solve(dynamic.as_ref().submatrix(faces, 0, inner, faces));
            let coupling = dynamic
                .as_ref()
                .submatrix(0, faces, faces, inner)
                .to_owned();
            let own_faces = dynamic.as_ref().submatrix(0, 0, faces, faces);
            condensed.push(own_faces - &coupling * &follows);
            inside.push(Inside {
                factors,
                follows,
                faces: coupling,
            });
        }
        let block = |of: &Mat<c64>, row: usize, column: usize| {
            of.as_ref().submatrix(row * f, column * f, f, f).to_owned()
        };
        // Row and column n: the low face of sector n, which is the high face of sector n - 1.
        let mut diagonal: Vec<Mat<c64>> = (0..n)
            .map(|own| block(&condensed[own], 0, 0) + block(&condensed[(own + n - 1) % n], 1, 1))
            .collect();
        let mut wheel = Self {
            sector,
            inside,
            pivots: Vec::new(),
            to_next: Vec::new(),
            to_last: Vec::new(),
            of_next: Vec::new(),
            of_last: Vec::new(),
        };
        let mut last_column = block(&condensed[n - 1], 1, 0);
        let mut last_row = block(&condensed[n - 1], 0, 1);
        for own in 0..n - 1 {
            let mut next_column = block(&condensed[own], 0, 1);
            let mut next_row = block(&condensed[own], 1, 0);
            if own == n - 2 {
                last_column += &next_column;
                last_row += &next_row;
                next_column = Mat::zeros(f, f);
                next_row = Mat::zeros(f, f);
            }
            let pivot = diagonal[own].partial_piv_lu();
            let to_next = pivot.solve(&next_column);
            let to_last = pivot.solve(&last_column);
            diagonal[n - 1] -= &last_row * &to_last;
            let (mut column_below, mut row_after) = (Mat::zeros(f, f), Mat::zeros(f, f));
            if own < n - 2 {
                diagonal[own + 1] -= &next_row * &to_next;
                column_below -= &next_row * &to_last;
                row_after -= &last_row * &to_next;
            }
            wheel.pivots.push(pivot);
            wheel.to_next.push(to_next);
            wheel.to_last.push(to_last);
            wheel.of_next.push(next_row);
            wheel
                .of_last
                .push(std::mem::replace(&mut last_row, row_after));
            last_column = column_below;
        }
        wheel.pivots.push(diagonal[n - 1].partial_piv_lu());
        wheel
    }

    /// The motion under `contact_forces` on the contact rows, N, which close and slide as the motion does, and under the
    /// excitation of `engine_order`, if any.
    pub fn solve(&self, contact_forces: &[c64], engine_order: Option<u32>) -> Motion {
        let (n, f) = (self.sector.sectors, self.sector.face);
        let (size, rows) = (self.sector.size(), self.sector.contact_rows());
        let mut on_faces = vec![Mat::<c64>::zeros(f, 1); n];
        let mut moved = Vec::with_capacity(n);
        for own in 0..n {
            let mut load = Mat::<c64>::zeros(size, 1);
            let forces = &contact_forces[own * rows..(own + 1) * rows];
            let all_rows = self.sector.pairs.iter().flat_map(|pair| &pair.rows);
            for (row, force) in all_rows.zip(forces) {
                for &(at, factor) in row {
                    load[(at, 0)] += *force * factor;
                }
            }
            if let Some(order) = engine_order {
                let turns = (order as usize * own % n) as f64 / n as f64;
                let turn = c64::cis(std::f64::consts::TAU * turns);
                for &(at, newton) in &self.sector.force {
                    load[(at, 0)] += newton * turn;
                }
            }
            let inside = &self.inside[own];
            let alone = inside
                .factors
                .solve(load.as_ref().subrows(2 * f, size - 2 * f));
            let passed_on = &inside.faces * &alone;
            on_faces[own] += load.as_ref().subrows(0, f) - passed_on.as_ref().subrows(0, f);
            on_faces[(own + 1) % n] +=
                load.as_ref().subrows(f, f) - passed_on.as_ref().subrows(f, f);
            moved.push(alone);
        }
        for own in 0..n - 1 {
            let part = self.pivots[own].solve(&on_faces[own]);
            if own < n - 2 {
                on_faces[own + 1] -= &self.of_next[own] * &part;
            }
            on_faces[n - 1] -= &self.of_last[own] * &part;
            on_faces[own] = part;
        }
        let last = self.pivots[n - 1].solve(&on_faces[n - 1]);
        on_faces[n - 1] = last.clone();
        for own in (0..n - 1).rev() {
            let next = if own < n - 2 {
                &self.to_next[own] * &on_faces[own + 1]
            } else {
                Mat::zeros(f, 1)
            };
            on_faces[own] -= next + &self.to_last[own] * &last;
        }
        let mut motion = Motion {
            contact: Vec::with_capacity(n * rows),
            observed: Vec::with_capacity(n * self.sector.observed.len()),
        };
        for (own, alone) in moved.iter().enumerate() {
            let (low, high) = (&on_faces[own], &on_faces[(own + 1) % n]);
            let follows = &self.inside[own].follows;
            let inside = alone
                - follows.as_ref().subcols(0, f) * low
                - follows.as_ref().subcols(f, f) * high;
            let at = |place: usize| entry(place, f, low.as_ref(), high.as_ref(), inside.as_ref());
            for row in self.sector.pairs.iter().flat_map(|pair| &pair.rows) {
                motion
                    .contact
                    .push(row.iter().map(|&(place, factor)| at(place) * factor).sum());
            }
            motion
                .observed
                .extend(self.sector.observed.iter().map(|&place| at(place)));
        }
        motion
    }
}

fn entry(
    place: usize,
    face: usize,
    low: MatRef<'_, c64>,
    high: MatRef<'_, c64>,
    inside: MatRef<'_, c64>,
) -> c64 {
    match place {
        _ if place < face => low[(place, 0)],
        _ if place < 2 * face => high[(place - face, 0)],
        _ => inside[(place - 2 * face, 0)],
    }
}
