//! A preconditioner of the contact iteration that takes every pair by itself, with all harmonics of it together.
//!
//! ```text
//! P = (I + A_p G_p')^-1
//! ```
//!
//! with what a pair answers to its own forces in the tuned wheel, `A_p`, which is the mean of the receptances over the waves, and the
//! whole derivative `G_p'` of its forces. Where pairs open, their harmonics depend on each other, which the preconditioner of one harmonic
//! after the other leaves out.

use crate::linalg::{Complex64, LuWorkspace};
use crate::response::harmonic_balance::WheelContact;

use super::contact_places::Places;
use super::wheel_harmonic::WheelHarmonic;

/// The factors of every pair whose forces change with its motions.
pub(super) struct PairPreconditioner {
    pairs: Vec<PairFactors>,
    unknowns: Vec<f64>,
}

struct PairFactors {
    /// Places of the unknowns in a vector over the contact: directions, in them coefficients.
    places: Vec<usize>,
    factors: LuWorkspace<f64>,
}

impl PairPreconditioner {
    /// At the motions last evaluated with derivative, whose harmonics are coupled.
    pub(super) fn new(contact: &WheelContact, harmonics: &[WheelHarmonic]) -> Self {
        let rows = contact.pair_rows();
        let places = Places::of(contact);
        // By harmonic, then by pair of a sector.
        let answers: Vec<Vec<[Complex64; 9]>> = harmonics
            .iter()
            .map(|harmonic| harmonic.pair_answers(rows))
            .collect();
        let pairs = (0..contact.sectors() * rows.len()).filter(|&pair| contact.is_active(pair));
        let factors = pairs.filter_map(|pair| {
            let pair_answers: Vec<[Complex64; 9]> =
                answers.iter().map(|of| of[pair % rows.len()]).collect();
            PairFactors::new(contact, &places, pair, &pair_answers)
        });
        Self {
            pairs: factors.collect(),
            unknowns: Vec::new(),
        }
    }

    /// `P v` in place, for motions of every sector in the order of the contact.
    pub(super) fn apply(&mut self, motions: &mut [f64]) {
        for PairFactors { places, factors } in &mut self.pairs {
            self.unknowns.clear();
            self.unknowns
                .extend(places.iter().map(|&place| motions[place]));
            factors.solve(&mut self.unknowns);
            for (&place, motion) in places.iter().zip(&self.unknowns) {
                motions[place] = *motion;
            }
        }
    }
}

impl PairFactors {
    /// Of a pair, counted sector after sector, with its answers by harmonic; none where the derivative is singular.
    fn new(
        contact: &WheelContact,
        places: &Places,
        pair: usize,
        answers: &[[Complex64; 9]],
    ) -> Option<Self> {
        let coefficients = contact.transform().n_coefficients();
        let (rows, sector_rows) = (contact.pair_rows(), contact.sector_rows());
        let (sector, pair_rows) = (pair / rows.len(), rows[pair % rows.len()]);
        let directions: Vec<(usize, usize)> =
            (0..3).filter_map(|d| Some((d, pair_rows[d]?))).collect();
        let size = directions.len() * coefficients;
        let mut factors = LuWorkspace::new(size);
        let matrix = factors.matrix_mut();
        for at in 0..size {
            matrix[at * size + at] = 1.0;
        }
        for (j, &(by, _)) in directions.iter().enumerate() {
            for &(through, _) in &directions {
                let Some(slopes) = contact.slopes(pair, through, by) else {
                    continue;
                };
                for (answer, &(k, first)) in answers.iter().zip(&places.harmonics) {
                    for (i, &(along, _)) in directions.iter().enumerate() {
                        let answer = answer[3 * along + through];
                        for d in 0..coefficients {
                            let slope = |c: usize| slopes[(first + c) * coefficients + d];
                            let imaginary = if k == 0 { 0.0 } else { slope(1) };
                            let moved = answer * Complex64::new(slope(0), imaginary);
                            let to = (j * coefficients + d) * size + i * coefficients + first;
                            matrix[to] += moved.re;
                            if k > 0 {
                                matrix[to + 1] += moved.im;
                            }
                        }
                    }
                }
            }
        }
        let all = contact.sectors() * sector_rows;
        let row = |&(_, row): &(usize, usize)| sector * sector_rows + row;
        let places = directions.iter().map(row);
        let places = places.flat_map(|row| (0..coefficients).map(move |c| c * all + row));
        factors.factor().then(|| Self {
            places: places.collect(),
            factors,
        })
    }
}
