//! A preconditioner of the contact iteration that leaves nothing out: the whole derivative of a contact with few unknowns, factorised.
//!
//! ```text
//! P = (I + A G')^-1
//! ```
//!
//! with the answer A of the mistuned wheel, harmonic by harmonic, and the whole derivative `G'` of the contact forces, pair by pair. A step
//! is one of Newton's method at the motions where it was made.

use crate::linalg::{Complex64, LuWorkspace};
use crate::response::harmonic_balance::WheelContact;

use super::contact_places::Places;
use super::fields::SectorTransform;
use super::wheel_harmonic::WheelHarmonic;

/// The factors of `I + A G'` over the motions of every sector, in the order of the contact.
pub(super) struct WholePreconditioner {
    factors: LuWorkspace<f64>,
    pub(super) unknowns: Vec<f64>,
}

impl WholePreconditioner {
    /// At the motions last evaluated with derivative, whose harmonics are coupled; none where the derivative is singular.
    pub(super) fn new(
        transform: &SectorTransform,
        contact: &WheelContact,
        harmonics: &mut [WheelHarmonic],
    ) -> Option<Self> {
        let (rows, sector_rows) = (contact.pair_rows(), contact.sector_rows());
        let coefficients = contact.transform().n_coefficients();
        let block = contact.sectors() * sector_rows;
        let size = coefficients * block;
        let places = Places::of(contact);
        let answers: Vec<&[Complex64]> = { harmonics.iter_mut() }
            .map(|harmonic| harmonic.sector_answers(transform))
            .collect();
        let mut factors = LuWorkspace::new(size);
        let matrix = factors.matrix_mut();
        for at in 0..size {
            matrix[at * size + at] = 1.0;
        }
        let (mut motion, mut force) = (vec![0.0; size], vec![0.0; size]);
        for (direction, coefficient) in (0..3).flat_map(|d| (0..coefficients).map(move |c| (d, c)))
        {
            // All pairs at once: none feels what another one does.
            motion.fill(0.0);
            force.fill(0.0);
            let pairs = || (0..contact.sectors()).flat_map(|n| rows.iter().map(move |of| (n, of)));
            let row = |n: usize, row: usize| n * sector_rows + row;
            let moved = pairs().filter_map(|(n, of)| Some((of, n, row(n, of[direction]?))));
            for (_, _, row) in moved.clone() {
                motion[coefficient * block + row] = 1.0;
            }
            contact.add_derivative(&motion, &mut force);
            for (of, n, by) in moved {
                let column = &mut matrix[(coefficient * block + by) * size..][..size];
                for through in of.iter().flatten().map(|&through| row(n, through)) {
                    for (answers, &(k, first)) in answers.iter().zip(&places.harmonics) {
                        let at = |c: usize| force[(first + c) * block + through];
                        let force = Complex64::new(at(0), if k == 0 { 0.0 } else { at(1) });
                        let (re, im) = column[first * block..].split_at_mut(block);
                        for (place, answer) in
                            answers[through * block..][..block].iter().enumerate()
                        {
                            let moved = answer * force;
                            re[place] += moved.re;
                            if k > 0 {
                                im[place] += moved.im;
                            }
                        }
                    }
                }
            }
        }
        factors.factor().then(|| Self {
            factors,
            unknowns: vec![0.0; size],
        })
    }

    /// `P v` of the unknowns, in place.
    pub(super) fn apply(&mut self) {
        self.factors.solve(&mut self.unknowns);
    }
}
