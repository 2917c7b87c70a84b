//! A mistuned wheel in one harmonic at one frequency: the answer of its contact to forces there.
//!
//! With the receptances R of the tuned wheel, strain coordinates z of the blades and their deviations D,
//!
//! ```text
//! u = u_0 - R_cc g - R_cz D z,    (I + R_zz D) z = z_0 - R_zc g
//! ```
//!
//! Receptances act on every wave by itself, deviations on every sector by itself; z is eliminated exactly.

use crate::linalg::Complex64;

use super::elimination::Elimination;
use super::fields::{Field, SectorTransform, padded};
use super::wave_matrix::WaveMatrix;

/// Unknowns of all sectors up to which a preconditioner takes in more than one shape of the blades.
const UNKNOWNS: usize = 192;

/// One harmonic of a mistuned wheel; fields are over the waves unless said otherwise.
pub(super) struct WheelHarmonic {
    pub(super) sectors: usize,
    pub(super) contact: usize,
    shapes: usize,
    /// Receptance of the motions [contact, strain, observed] by forces at [contact, strain].
    pub(super) receptance: WaveMatrix,
    /// Deviation of every shape and sector, the loss factor included, shape after shape.
    pub(super) deviations: Vec<Complex64>,
    elimination: Elimination,
    /// Whether a blade deviates.
    is_mistuned: bool,
    /// Blade forces `D z` without contact forces beyond those of the springs.
    excited: Field,
    strain: Field,
    /// [`Self::sector_answers`], once they are known; empty before.
    answers: Vec<Complex64>,
}

impl WheelHarmonic {
    /// A harmonic with `contact` rows a sector and strain coordinates for as many shapes.
    pub(super) fn new(sectors: usize, contact: usize, shapes: usize) -> Self {
        let field = || Field::zeros(shapes, sectors);
        Self {
            sectors,
            contact,
            shapes,
            receptance: WaveMatrix::zeros(contact + shapes + 3, contact + shapes, sectors),
            deviations: Vec::new(),
            elimination: Elimination::new(sectors, contact, shapes),
            is_mistuned: false,
            excited: field(),
            strain: field(),
            answers: Vec::new(),
        }
    }

    /// Takes the deviations in, of every shape and sector, shape after shape, at the receptances filled in before; false if
    /// `I + R_zz D` is singular.
    pub(super) fn mistune(
        &mut self,
        transform: &SectorTransform,
        deviations: impl Iterator<Item = Complex64>,
    ) -> bool {
        self.deviations.clear();
        self.answers.clear();
        self.deviations.extend(deviations);
        self.excited.fill(0.0);
        let deviates = |deviation: &Complex64| deviation.norm_sqr() != 0.0;
        self.is_mistuned = self.deviations.iter().any(deviates);
        !self.is_mistuned
            || self
                .elimination
                .prepare(transform, &self.receptance, &self.deviations)
    }

    /// The first shapes, so many; none where no blade deviates.
    pub(super) fn first_shapes(&self, count: usize) -> Vec<usize> {
        if self.is_mistuned {
            (0..count.min(self.shapes)).collect()
        } else {
            Vec::new()
        }
    }

    /// Shapes that are not nearly static, as many as a preconditioner takes in; none where no blade deviates.
    pub(super) fn resonant_shapes(&self) -> Vec<usize> {
        let resonant = self.elimination.resonant().iter();
        let most = (UNKNOWNS / self.sectors).max(1);
        let shapes = resonant.take(most).copied();
        shapes.filter(|_| self.is_mistuned).collect()
    }

    /// What each of `pairs` answers to its own forces in the tuned wheel, m/N: a `3 x 3` matrix over its rows, row after row.
    pub(super) fn pair_answers(&self, pairs: &[[Option<usize>; 3]]) -> Vec<[Complex64; 9]> {
        let share = 1.0 / self.sectors as f64;
        let answer = |row: usize, column: usize| {
            let waves = (0..self.sectors).map(|wave| self.receptance.at(wave, row, column));
            waves.sum::<Complex64>() * share
        };
        let of = |rows: &[Option<usize>; 3]| {
            std::array::from_fn(|place| match (rows[place / 3], rows[place % 3]) {
                (Some(row), Some(column)) => answer(row, column),
                _ => Complex64::default(),
            })
        };
        pairs.iter().map(of).collect()
    }

    /// Strain coordinates to blade forces `D (I + R_zz D)^-1 z`, in place.
    fn blade_forces(&mut self, transform: &SectorTransform) {
        if self.is_mistuned {
            self.elimination
                .blade_forces(transform, &self.receptance, &mut self.strain);
        } else {
            self.strain.fill(0.0);
        }
    }

    /// Motion of the contact under an excitation whose tuned response of the motions [contact, strain, observed] is `response` in
    /// the wave `wave`; into `motion`.
    pub(super) fn excite(
        &mut self,
        transform: &SectorTransform,
        wave: usize,
        response: &[Complex64],
        motion: &mut Field,
    ) {
        let stride = padded(self.sectors);
        motion.fill(0.0);
        let (contact_rows, rest) = response.split_at(self.contact);
        for (row, u) in contact_rows.iter().enumerate() {
            motion.set(row * stride + wave, *u);
        }
        self.strain.fill(0.0);
        for (shape, z) in rest.iter().take(self.shapes).enumerate() {
            self.strain.set(shape * stride + wave, *z);
        }
        self.blade_forces(transform);
        let (contact, shapes) = (self.contact, self.shapes);
        let columns = contact..contact + shapes;
        self.receptance
            .add_product(0..contact, columns, -1.0, &self.strain, motion);
        std::mem::swap(&mut self.excited, &mut self.strain);
    }

    /// Adds the motion that contact forces `g` take off: `R_cc g - R_cz D (I + R_zz D)^-1 R_zc g`.
    pub(super) fn add_answer(
        &mut self,
        transform: &SectorTransform,
        g: &Field,
        answer: &mut Field,
    ) {
        if !self.answers.is_empty() {
            return self.add_known_answer(transform, g, answer);
        }
        let (contact, shapes) = (self.contact, self.shapes);
        self.receptance
            .add_product(0..contact, 0..contact, 1.0, g, answer);
        if !self.is_mistuned {
            return;
        }
        let strained = contact..contact + shapes;
        self.strain.fill(0.0);
        self.receptance
            .add_product(strained.clone(), 0..contact, 1.0, g, &mut self.strain);
        self.blade_forces(transform);
        self.receptance
            .add_product(0..contact, strained, -1.0, &self.strain, answer);
    }

    /// [`Self::add_answer`] by the answers to unit forces.
    fn add_known_answer(&self, transform: &SectorTransform, g: &Field, answer: &mut Field) {
        let (sectors, rows) = (self.sectors, self.contact);
        let stride = padded(sectors);
        let places = || (0..sectors * rows).map(|at| at % rows * stride + at / rows);
        let mut forces = Field::zeros(rows, sectors);
        transform.to_sectors(g, &mut forces);
        let mut motions = vec![Complex64::default(); sectors * rows];
        for (column, by) in self.answers.chunks_exact(sectors * rows).zip(places()) {
            let force = forces.at(by);
            for (motion, answer) in motions.iter_mut().zip(column) {
                *motion += answer * force;
            }
        }
        for (motion, at) in motions.iter().zip(places()) {
            forces.set(at, *motion);
        }
        let mut waves = Field::zeros(rows, sectors);
        transform.to_waves(&forces, &mut waves);
        answer.add(1.0, &waves);
    }

    /// What the contact rows of every sector answer to a unit force at each of them, m/N: a column a force, both sector after sector.
    pub(super) fn sector_answers(&mut self, transform: &SectorTransform) -> &[Complex64] {
        let (sectors, rows) = (self.sectors, self.contact);
        let stride = padded(sectors);
        if self.answers.is_empty() {
            let field = || Field::zeros(rows, sectors);
            let (mut over_sectors, mut force, mut answer) = (field(), field(), field());
            let mut answers = Vec::with_capacity((sectors * rows).pow(2));
            let places = |all: usize| (0..all).map(move |at| at % rows * stride + at / rows);
            for by in places(sectors * rows) {
                over_sectors.fill(0.0);
                over_sectors.set(by, Complex64::from(1.0));
                transform.to_waves(&over_sectors, &mut force);
                answer.fill(0.0);
                self.add_answer(transform, &force, &mut answer);
                transform.to_sectors(&answer, &mut over_sectors);
                let column = places(sectors * rows).map(|at| over_sectors.at(at));
                answers.extend(column);
            }
            self.answers = answers;
        }
        &self.answers
    }

    /// Displacement r, theta, z of the observed node of every sector under contact forces `g`; `response` as in
    /// [`Self::excite`], for the harmonic that is excited.
    pub(super) fn observed(
        &mut self,
        transform: &SectorTransform,
        g: &Field,
        response: Option<(usize, &[Complex64])>,
    ) -> Field {
        let (contact, shapes) = (self.contact, self.shapes);
        let stride = padded(self.sectors);
        let strained = contact..contact + shapes;
        let rows = contact + shapes..contact + shapes + 3;
        let mut waves = Field::zeros(3, self.sectors);
        if let Some((wave, response)) = response {
            for row in 0..3 {
                waves.set(row * stride + wave, response[contact + shapes + row]);
            }
            self.receptance.add_product(
                rows.clone(),
                strained.clone(),
                -1.0,
                &self.excited,
                &mut waves,
            );
        }
        self.receptance
            .add_product(rows.clone(), 0..contact, -1.0, g, &mut waves);
        if self.is_mistuned {
            self.strain.fill(0.0);
            self.receptance
                .add_product(strained.clone(), 0..contact, 1.0, g, &mut self.strain);
            self.blade_forces(transform);
            self.receptance
                .add_product(rows, strained, 1.0, &self.strain, &mut waves);
        }
        let mut sectors = Field::zeros(3, self.sectors);
        transform.to_sectors(&waves, &mut sectors);
        sectors
    }
}
