//! Dynamic stiffness of a whole mistuned wheel at one frequency, factored sector by sector and round the wheel.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, c64};

use super::sector::{DIRECTIONS, Sector};

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

/// Responses of a wheel to unit forces on its contact rows and to its excitation, sector after sector, m/N.
pub struct Receptance {
    /// Relative motion at the contact rows by forces on them.
    pub contact: Mat<c64>,
    /// Motion of the observed nodes by forces on the contact rows.
    pub observed: Mat<c64>,
    /// Both under the excitation.
    pub contact_excited: Vec<c64>,
    pub observed_excited: Vec<c64>,
}

impl<'a> FactoredWheel<'a> {
    /// At `omega`, rad/s, which is harmonic times excitation; `springs` between the bodies along normal and tangents, N/m
    /// per sector; `deviations` of the blades' stiffness. Harmonic 0 has no loss factor.
    pub fn new(
        sector: &'a Sector,
        omega: f64,
        loss_factor: f64,
        deviations: &[f64],
        springs: [f64; DIRECTIONS],
    ) -> Self {
        let (n, f) = (sector.sectors, sector.face);
        assert!(n > 2 && deviations.len() == n);
        let faces = 2 * f;
        let inner = sector.size() - faces;
        let loss = c64::new(1.0, if omega > 0.0 { loss_factor } else { 0.0 });
        let mut inside = Vec::with_capacity(n);
        let mut condensed = Vec::with_capacity(n);
        for delta in deviations {
            let mut dynamic = Mat::from_fn(sector.size(), sector.size(), |i, j| {
                let stiffness = sector.stiffness[(i, j)] + delta * sector.blade[(i, j)];
                loss * stiffness - c64::new(omega * omega * sector.mass[(i, j)], 0.0)
            });
            for pair in &sector.pairs {
                for (row, spring) in pair.rows.iter().zip(springs) {
                    for &(i, a) in row {
                        for &(j, b) in row {
                            dynamic[(i, j)] += c64::new(pair.weight * spring * a * b, 0.0);
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

    /// Under forces that close and slide as the motion does, and under the excitation of `engine_order`.
    pub fn receptance(&self, engine_order: u32) -> Receptance {
        let (n, f) = (self.sector.sectors, self.sector.face);
        let (size, rows) = (self.sector.size(), self.sector.contact_rows());
        let (inner, watched) = (size - 2 * f, self.sector.observed.len());
        // Rows that are asked for, those of the contact first.
        let mut asked = Mat::<c64>::zeros(rows + watched, size);
        let of_contact = self.sector.pairs.iter().flat_map(|pair| &pair.rows);
        for (at, row) in of_contact.enumerate() {
            for &(place, factor) in row {
                asked[(at, place)] += c64::new(factor, 0.0);
            }
        }
        for (at, &place) in self.sector.observed.iter().enumerate() {
            asked[(rows + at, place)] = c64::new(1.0, 0.0);
        }
        let [on_low, on_high, on_inner] = [(0, f), (f, f), (2 * f, inner)]
            .map(|(from, count)| asked.as_ref().subcols(from, count));
        let excited = n * rows;
        let mut on_faces = vec![Mat::<c64>::zeros(f, excited + 1); n];
        let mut alone = Vec::with_capacity(n);
        for own in 0..n {
            let turns = (engine_order as usize * own % n) as f64 / n as f64;
            let turn = c64::cis(std::f64::consts::TAU * turns);
            let load = Mat::from_fn(size, rows + 1, |place, column| {
                let newton = |&(at, newton): &(usize, c64)| (at == place).then_some(newton * turn);
                if column < rows {
                    asked[(column, place)]
                } else {
                    self.sector.force.iter().filter_map(newton).sum()
                }
            });
            let inside = &self.inside[own];
            let moved = inside.factors.solve(load.as_ref().subrows(2 * f, inner));
            let passed_on = &inside.faces * &moved;
            for (face, from) in [(own, 0), ((own + 1) % n, f)] {
                let part = load.as_ref().subrows(from, f) - passed_on.as_ref().subrows(from, f);
                let mut block = on_faces[face].as_mut().subcols_mut(own * rows, rows);
                block += part.as_ref().subcols(0, rows);
                let mut column = on_faces[face].as_mut().subcols_mut(excited, 1);
                column += part.as_ref().subcols(rows, 1);
            }
            alone.push(moved);
        }
        self.solve_faces(&mut on_faces);
        let mut all = Mat::<c64>::zeros(n * (rows + watched), excited + 1);
        for (own, alone) in alone.iter().enumerate() {
            let (low, high) = (&on_faces[own], &on_faces[(own + 1) % n]);
            let follows = on_inner * &self.inside[own].follows;
            let of_low = on_low - follows.as_ref().subcols(0, f);
            let of_high = on_high - follows.as_ref().subcols(f, f);
            let mut answer = of_low * low + of_high * high;
            let by_itself = on_inner * alone;
            let mut block = answer.as_mut().subcols_mut(own * rows, rows);
            block += by_itself.as_ref().subcols(0, rows);
            let mut column = answer.as_mut().subcols_mut(excited, 1);
            column += by_itself.as_ref().subcols(rows, 1);
            let of_contact = (0..rows).map(|row| (row, own * rows + row));
            let of_tip = (0..watched).map(|row| (rows + row, n * rows + own * watched + row));
            for (from, at) in of_contact.chain(of_tip) {
                for column in 0..=excited {
                    all[(at, column)] = answer[(from, column)];
                }
            }
        }
        let part =
            |row: usize, count: usize| all.as_ref().submatrix(row, 0, count, excited).to_owned();
        let column =
            |row: usize, count: usize| (row..row + count).map(|at| all[(at, excited)]).collect();
        Receptance {
            contact: part(0, n * rows),
            observed: part(n * rows, n * watched),
            contact_excited: column(0, n * rows),
            observed_excited: column(n * rows, n * watched),
        }
    }

    /// Motion of the low faces in the place of the forces on them.
    fn solve_faces(&self, on_faces: &mut [Mat<c64>]) {
        let n = self.sector.sectors;
        for own in 0..n - 1 {
            let part = self.pivots[own].solve(&on_faces[own]);
            if own < n - 2 {
                on_faces[own + 1] -= &self.of_next[own] * &part;
            }
            on_faces[n - 1] -= &self.of_last[own] * &part;
            on_faces[own] = part;
        }
        let last = self.pivots[n - 1].solve(&on_faces[n - 1]);
        for own in (0..n - 1).rev() {
            if own < n - 2 {
                let next = &self.to_next[own] * &on_faces[own + 1];
                on_faces[own] -= next;
            }
            on_faces[own] -= &self.to_last[own] * &last;
        }
        on_faces[n - 1] = last;
    }
}
