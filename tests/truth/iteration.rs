//! Harmonic balance of a whole wheel on the motions u at the contact, at one frequency:
//!
//! ```text
//! r(u) = u - u_excited + R (F(u) - k_c u) = 0
//! ```
//!
//! with R the receptance of the wheel whose contact sticks, `k_c` the springs of sticking and F the contact forces. Newton's
//! method; its linear equations by GMRES (Saad and Schultz 1986) with the contact of each harmonic alone as
//! preconditioner. Where that fails, the normal load comes down in steps from one that nothing slips under.

use std::cell::OnceCell;
use std::f64::consts::TAU;
use std::rc::Rc;

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, c64};

use super::contact::{Law, Period, State};
use super::sector::{DIRECTIONS, Sector};
use super::wheel::{FactoredWheel, Receptance};

/// What a wheel is excited and held by.
#[derive(Clone)]
pub struct Case {
    pub loss_factor: f64,
    pub engine_order: u32,
    /// Relative deviation of each blade's stiffness.
    pub deviations: Vec<f64>,
    /// Contact per sector.
    pub contact: Contact,
}

/// What holds the ring, with the parameters of a sector.
#[derive(Clone, Copy)]
pub enum Contact {
    Friction(Law),
    /// Springs that never open or slip: normal and tangential, N/m.
    Springs(f64, f64),
}

/// Length of a Newton step relative to the motion at which a frequency is solved.
const TOLERANCE: f64 = 1e-7;
const MOST_NEWTON_STEPS: usize = 40;
const MOST_HALVINGS: usize = 7;
/// Vectors of GMRES, which begins anew after them once. Where pairs open, the harmonics depend on each other and hundreds
/// are needed.
const KRYLOV: usize = 400;
/// Factor of the load that the homotopy begins with, and its shortest step of the logarithm.
const HIGHEST_LOAD: f64 = 256.0;
const SHORTEST_STEP: f64 = 1.0 / 256.0;

/// A solved frequency.
#[derive(Clone)]
pub struct Point {
    pub frequency_hz: f64,
    /// Amplitude of the first harmonic of each blade, m.
    pub amplitudes_m: Vec<f64>,
    /// Motion at the contact: a column of coefficients a contact row.
    pub motion: Mat<f64>,
    /// Products with the Jacobian.
    pub products: usize,
    pub opening_pairs: usize,
    pub slipping_pairs: usize,
}

impl Point {
    pub fn amplitude_m(&self) -> f64 {
        self.amplitudes_m.iter().copied().fold(0.0, f64::max)
    }
}

/// Receptance of a wheel at rest, for harmonic 0 of a case at any frequency.
#[derive(Default)]
pub struct AtRest(OnceCell<Rc<Receptance>>);

/// Solves a frequency from `start`, or from sticking; none where no solution was reached.
pub fn solve(
    sector: &Sector,
    case: &Case,
    period: &Period,
    frequency_hz: f64,
    start: Option<&Mat<f64>>,
) -> Option<Point> {
    solve_with(
        sector,
        case,
        period,
        (frequency_hz, start),
        &AtRest::default(),
    )
}

/// Solves a frequency of a case that `at_rest` is of.
pub fn solve_with(
    sector: &Sector,
    case: &Case,
    period: &Period,
    (frequency_hz, start): (f64, Option<&Mat<f64>>),
    at_rest: &AtRest,
) -> Option<Point> {
    let (springs, law) = match case.contact {
        Contact::Friction(law) => (
            (
                law.normal_stiffness_n_per_m,
                law.tangential_stiffness_n_per_m,
            ),
            Some(law),
        ),
        Contact::Springs(normal, tangential) => ((normal, tangential), None),
    };
    let springs = [springs.0, springs.1, springs.1];
    let harmonics = if law.is_some() {
        &period.harmonics[..]
    } else {
        &[1]
    };
    let receptance = |k: u32| {
        let omega = TAU * frequency_hz * f64::from(k);
        let wheel = FactoredWheel::new(sector, omega, case.loss_factor, &case.deviations, springs);
        Rc::new(wheel.receptance(case.engine_order))
    };
    let receptances: Vec<Rc<Receptance>> = harmonics
        .iter()
        .map(|&k| match k {
            0 => Rc::clone(at_rest.0.get_or_init(|| receptance(0))),
            _ => receptance(k),
        })
        .collect();
    let fundamental = harmonics.iter().position(|&k| k == 1).expect("harmonic 1");
    let of_sector = |place: usize| sector.pairs[place % sector.pairs.len()].weight;
    let weights: Vec<f64> = (0..sector.sectors * sector.pairs.len())
        .map(of_sector)
        .collect();
    let equation = Equation {
        period,
        receptances: &receptances,
        fundamental,
        springs,
        weights: &weights,
    };
    let watched = sector.observed.len();
    let amplitudes = |observed: &[c64]| -> Vec<f64> {
        let of = |blade: &[c64]| blade.iter().map(c64::norm_sqr).sum::<f64>().sqrt();
        observed.chunks(watched).map(of).collect()
    };
    let at_tips = &receptances[fundamental];
    let Some(law) = law else {
        return Some(Point {
            frequency_hz,
            amplitudes_m: amplitudes(&at_tips.observed_excited),
            motion: Mat::zeros(0, 0),
            products: 0,
            opening_pairs: 0,
            slipping_pairs: 0,
        });
    };
    let stuck = equation.excited();
    let mut products = 0;
    let laws = equation.laws(&law, 1.0);
    let from_start = start.and_then(|start| equation.newton(&laws, start, &mut products));
    let solved = from_start
        .or_else(|| equation.newton(&laws, &stuck, &mut products))
        .or_else(|| equation.lower_load(&law, &stuck, &mut products));
    let (motion, state) = solved?;
    let (forces, _) = period.forces(&laws, &motion);
    let loads = equation.beyond_sticking(&forces, &motion);
    let load = equation.harmonic(&loads, fundamental);
    let by_contact = &at_tips.observed * load;
    let observed: Vec<c64> = (0..at_tips.observed_excited.len())
        .map(|row| at_tips.observed_excited[row] - by_contact[(row, 0)])
        .collect();
    Some(Point {
        frequency_hz,
        amplitudes_m: amplitudes(&observed),
        motion,
        products,
        opening_pairs: state.opening_pairs(),
        slipping_pairs: state.slipping_pairs(),
    })
}

/// The equation at one frequency.
struct Equation<'a> {
    period: &'a Period,
    receptances: &'a [Rc<Receptance>],
    /// Place of harmonic 1.
    fundamental: usize,
    springs: [f64; DIRECTIONS],
    weights: &'a [f64],
}

/// The contact of each harmonic alone, factored: `I + R_k (G_k - k_c)`.
struct Preconditioner(Vec<PartialPivLu<c64>>);

impl Equation<'_> {
    fn laws(&self, law: &Law, load: f64) -> Vec<Law> {
        let of = |&weight: &f64| Law {
            normal_load_n: load * weight * law.normal_load_n,
            normal_stiffness_n_per_m: weight * law.normal_stiffness_n_per_m,
            tangential_stiffness_n_per_m: weight * law.tangential_stiffness_n_per_m,
            ..*law
        };
        self.weights.iter().map(of).collect()
    }

    fn rows(&self) -> usize {
        DIRECTIONS * self.weights.len()
    }

    /// The motion where everything sticks.
    fn excited(&self) -> Mat<f64> {
        let mut motion = Mat::zeros(self.period.coefficients(), self.rows());
        let excited = &self.receptances[self.fundamental].contact_excited;
        let column = Mat::from_fn(self.rows(), 1, |row, _| excited[row]);
        self.set_harmonic(&mut motion, self.fundamental, &column);
        motion
    }

    /// A harmonic of all contact rows.
    fn harmonic(&self, of: &Mat<f64>, place: usize) -> Mat<c64> {
        let first = self.period.first(place);
        let is_mean = self.period.harmonics[place] == 0;
        Mat::from_fn(self.rows(), 1, |row, _| {
            let imaginary = if is_mean { 0.0 } else { of[(first + 1, row)] };
            c64::new(of[(first, row)], imaginary)
        })
    }

    fn set_harmonic(&self, of: &mut Mat<f64>, place: usize, column: &Mat<c64>) {
        let first = self.period.first(place);
        for row in 0..self.rows() {
            of[(first, row)] = column[(row, 0)].re;
            if self.period.harmonics[place] > 0 {
                of[(first + 1, row)] = column[(row, 0)].im;
            }
        }
    }

    /// `F - k_c u`.
    fn beyond_sticking(&self, forces: &Mat<f64>, motion: &Mat<f64>) -> Mat<f64> {
        Mat::from_fn(motion.nrows(), motion.ncols(), |at, row| {
            let spring = self.weights[row / DIRECTIONS] * self.springs[row % DIRECTIONS];
            forces[(at, row)] - spring * motion[(at, row)]
        })
    }

    /// `R f` of every harmonic.
    fn moved_by(&self, forces: &Mat<f64>) -> Mat<f64> {
        let mut moved = Mat::zeros(forces.nrows(), forces.ncols());
        for (place, receptance) in self.receptances.iter().enumerate() {
            let column = &receptance.contact * self.harmonic(forces, place);
            self.set_harmonic(&mut moved, place, &column);
        }
        moved
    }

    /// `r(u)` and what the pairs do.
    fn residual(&self, laws: &[Law], motion: &Mat<f64>) -> (Mat<f64>, State) {
        let (forces, state) = self.period.forces(laws, motion);
        let moved = self.moved_by(&self.beyond_sticking(&forces, motion));
        (motion - self.excited() + moved, state)
    }

    /// `dr = v + R (dF - k_c v)`.
    fn jacobian_times(&self, laws: &[Law], state: &State, change: &Mat<f64>) -> Mat<f64> {
        let forces = self.period.change(laws, state, change);
        change + self.moved_by(&self.beyond_sticking(&forces, change))
    }

    fn preconditioner(&self, laws: &[Law], state: &State) -> Preconditioner {
        let of = |(place, receptance): (usize, &Rc<Receptance>)| {
            let k = self.period.harmonics[place];
            let mut matrix = Mat::<c64>::identity(self.rows(), self.rows());
            for (pair, law) in laws.iter().enumerate() {
                let mut stiffness = state.stiffness(law, pair, k);
                for (direction, row) in stiffness.iter_mut().enumerate() {
                    let stuck = self.weights[pair] * self.springs[direction];
                    row[direction] -= c64::new(stuck, 0.0);
                }
                let at = DIRECTIONS * pair;
                let own = Mat::from_fn(DIRECTIONS, DIRECTIONS, |i, j| stiffness[i][j]);
                let moved = receptance.contact.as_ref().subcols(at, DIRECTIONS) * own;
                let mut block = matrix.as_mut().subcols_mut(at, DIRECTIONS);
                block += moved;
            }
            matrix.partial_piv_lu()
        };
        Preconditioner(self.receptances.iter().enumerate().map(of).collect())
    }

    fn preconditioned(&self, by: &Preconditioner, vector: &Mat<f64>) -> Mat<f64> {
        let mut found = Mat::zeros(vector.nrows(), vector.ncols());
        for (place, factors) in by.0.iter().enumerate() {
            let column = factors.solve(self.harmonic(vector, place));
            self.set_harmonic(&mut found, place, &column);
        }
        found
    }

    /// Newton's method from `start`; steps are shortened until what is left becomes less, measured by the
    /// preconditioner of the step.
    fn newton(
        &self,
        laws: &[Law],
        start: &Mat<f64>,
        products: &mut usize,
    ) -> Option<(Mat<f64>, State)> {
        let mut motion = start.clone();
        let (mut residual, mut state) = self.residual(laws, &motion);
        for _ in 0..MOST_NEWTON_STEPS {
            let by = self.preconditioner(laws, &state);
            let right = self.preconditioned(&by, &residual);
            let length = right.norm_l2();
            if length <= TOLERANCE * motion.norm_l2() {
                return Some((motion, state));
            }
            let times = |change: &Mat<f64>| {
                self.preconditioned(&by, &self.jacobian_times(laws, &state, change))
            };
            let step = gmres(times, &right, products);
            let shorter = (0..=MOST_HALVINGS).find_map(|halvings| {
                let factor = 0.5_f64.powi(halvings as i32);
                let trial = &motion - factor * &step;
                let (left, state) = self.residual(laws, &trial);
                let measured = self.preconditioned(&by, &left).norm_l2();
                (measured < (1.0 - 0.1 * factor) * length).then_some((trial, left, state))
            });
            (motion, residual, state) = shorter?;
        }
        None
    }

    /// From a load under which nothing slips down to that of the law.
    fn lower_load(
        &self,
        law: &Law,
        stuck: &Mat<f64>,
        products: &mut usize,
    ) -> Option<(Mat<f64>, State)> {
        let (mut exponent, mut step, mut motion) = (1.0, 0.125, stuck.clone());
        loop {
            let next = f64::max(exponent - step, 0.0);
            let laws = self.laws(law, HIGHEST_LOAD.powf(next));
            match self.newton(&laws, &motion, products) {
                Some(solved) if next <= 0.0 => return Some(solved),
                Some((solved, _)) => {
                    motion = solved;
                    exponent = next;
                    step *= 1.5;
                }
                None if step > SHORTEST_STEP => step *= 0.5,
                None => return None,
            }
        }
    }
}

/// Solves `A x = b` to a thousandth, or as far as it gets in twice [`KRYLOV`] products.
fn gmres(
    times: impl Fn(&Mat<f64>) -> Mat<f64>,
    right: &Mat<f64>,
    products: &mut usize,
) -> Mat<f64> {
    let wanted = 1e-3 * right.norm_l2();
    let mut solution = Mat::zeros(right.nrows(), right.ncols());
    for begun in 0..2 {
        let rest = if begun == 0 {
            right.clone()
        } else {
            *products += 1;
            right - times(&solution)
        };
        let length = rest.norm_l2();
        if length <= wanted {
            break;
        }
        let mut basis = vec![(1.0 / length) * &rest];
        // Upper triangle of the Hessenberg matrix turned by rotations, and the turned right-hand side.
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut turned = vec![length];
        while columns.len() < KRYLOV && turned[turned.len() - 1].abs() > wanted {
            *products += 1;
            let mut next = times(&basis[basis.len() - 1]);
            let mut column = Vec::with_capacity(basis.len() + 1);
            for own in &basis {
                let along = dot(own, &next);
                next -= along * own;
                column.push(along);
            }
            let height = next.norm_l2();
            column.push(height);
            for (at, &(c, s)) in rotations.iter().enumerate() {
                let (upper, lower) = (column[at], column[at + 1]);
                column[at] = c * upper + s * lower;
                column[at + 1] = c * lower - s * upper;
            }
            let last = rotations.len();
            let size = column[last].hypot(column[last + 1]);
            let (c, s) = (column[last] / size, column[last + 1] / size);
            rotations.push((c, s));
            column[last] = size;
            column.pop();
            let before = turned[last];
            turned[last] = c * before;
            turned.push(-s * before);
            columns.push(column);
            if height == 0.0 {
                break;
            }
            basis.push((1.0 / height) * next);
        }
        let mut weights = vec![0.0; columns.len()];
        for at in (0..columns.len()).rev() {
            let known: f64 = (at + 1..columns.len())
                .map(|j| columns[j][at] * weights[j])
                .sum();
            weights[at] = (turned[at] - known) / columns[at][at];
        }
        for (weight, own) in weights.iter().zip(&basis) {
            solution += *weight * own;
        }
    }
    solution
}

fn dot(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    let column = |at: usize| -> f64 { (0..a.nrows()).map(|i| a[(i, at)] * b[(i, at)]).sum() };
    (0..a.ncols()).map(column).sum()
}
