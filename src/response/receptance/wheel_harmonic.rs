//! A mistuned wheel in one harmonic at one frequency: the answer of its contact to forces there.
//!
//! With the receptances R of the tuned wheel, strain coordinates z of the blades and their deviations D,
//!
//! ```text
//! u = u_0 - R_cc g - R_cz D z,    (I + R_zz D) z = z_0 - R_zc g
//! ```
//!
//! Receptances act on every wave by itself, deviations on every sector by itself; z is eliminated exactly.

use crate::linalg::{Complex64, LuWorkspace};
use crate::response::harmonic_balance::MeanTangent;

use super::elimination::{Elimination, fill_circulant};
use super::fields::{Field, SectorTransform, padded};
use super::wave_matrix::WaveMatrix;

/// One harmonic of a mistuned wheel; fields are over the waves unless said otherwise.
pub(super) struct WheelHarmonic {
    sectors: usize,
    contact: usize,
    shapes: usize,
    /// Of the motions [contact, strain, observed] by forces at [contact, strain].
    pub(super) receptance: WaveMatrix,
    /// Deviation of every shape and sector, the loss factor included, shape after shape.
    deviations: Vec<Complex64>,
    elimination: Elimination,
    /// Whether a blade deviates.
    is_mistuned: bool,
    /// Blade forces `D z` without contact forces beyond those of the springs.
    excited: Field,
    strain: Field,
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
        self.deviations.extend(deviations);
        self.excited.fill(0.0);
        let deviates = |own: &Complex64| own.norm_sqr() != 0.0;
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
        let (own, rest) = response.split_at(self.contact);
        for (row, u) in own.iter().enumerate() {
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

/// Unknowns of all sectors up to which a preconditioner takes in more than one shape of the blades.
const UNKNOWNS: usize = 192;

/// Approximate inverse of the derivative `I + A G` of the equation of a harmonic: with the mean tangent G of the contact and
/// some shapes of the blades.
#[derive(Default)]
pub(super) struct Preconditioner {
    /// `(I + R_cc G)^-1`.
    inverse: WaveMatrix,
    mistuned: Option<MistunedShapes>,
    turned: Field,
}

/// The part of some shapes (index s) of the deviating blades, by Woodbury's formula.
struct MistunedShapes {
    /// `(I + R_cc G)^-1 R_cs` of every shape, a channel per row.
    motions: Vec<Field>,
    /// `R_sc G (I + R_cc G)^-1` of every shape, a channel per row.
    strains: Vec<Field>,
    factors: LuWorkspace<Complex64>,
    /// Of every shape and sector, shape after shape.
    deviations: Vec<Complex64>,
}

impl Preconditioner {
    /// For a harmonic under the mean tangent of the contact, with these shapes of the blades, ascending.
    pub(super) fn new(
        harmonic: &WheelHarmonic,
        transform: &SectorTransform,
        tangent: &MeanTangent,
        pairs: &[[Option<usize>; 3]],
        shapes: &[usize],
    ) -> Self {
        let (sectors, contact) = (harmonic.sectors, harmonic.contact);
        let receptance = &harmonic.receptance;
        // R G of the motions of the contact, and of the shapes.
        let rows = contact + shapes.last().map_or(0, |last| last + 1);
        let mut product = WaveMatrix::zeros(rows, contact, sectors);
        product.add_times_pairs(receptance, pairs, tangent);
        let mut inverse = product.leading_rows(contact);
        inverse.add_identity();
        inverse.invert();
        let mistuned = (!shapes.is_empty())
            .then(|| MistunedShapes::new(harmonic, transform, (&product, &inverse), shapes))
            .flatten();
        Self {
            inverse,
            mistuned,
            turned: Field::zeros(contact, sectors),
        }
    }

    /// The residual turned into a step, in place.
    pub(super) fn apply(&mut self, transform: &SectorTransform, residual: &mut Field) {
        let contact = self.inverse.rows;
        self.turned.fill(0.0);
        self.inverse
            .add_product(0..contact, 0..contact, 1.0, residual, &mut self.turned);
        if let Some(mistuned) = &mut self.mistuned {
            mistuned.add(transform, residual, &mut self.turned);
        }
        std::mem::swap(&mut self.turned, residual);
    }
}

impl MistunedShapes {
    fn new(
        harmonic: &WheelHarmonic,
        transform: &SectorTransform,
        (product, inverse): (&WaveMatrix, &WaveMatrix),
        shapes: &[usize],
    ) -> Option<Self> {
        let (sectors, contact) = (harmonic.sectors, harmonic.contact);
        let stride = padded(sectors);
        let receptance = &harmonic.receptance;
        let (mut motions, mut strains, mut answers) = (Vec::new(), Vec::new(), Vec::new());
        for shape in shapes {
            let answer = receptance.column(contact + shape, 0..contact);
            let mut motion = Field::zeros(contact, sectors);
            inverse.add_product(0..contact, 0..contact, 1.0, &answer, &mut motion);
            let mut strain = Field::zeros(contact, sectors);
            inverse.add_transposed_product(&product.row(contact + shape), &mut strain);
            motions.push(motion);
            strains.push(strain);
            answers.push(answer);
        }
        // R_sc G (I + R_cc G)^-1 R_cs of every shape by every one.
        let taken: Vec<Field> = strains
            .iter()
            .flat_map(|strain| answers.iter().map(move |answer| (strain, answer)))
            .map(|(strain, answer)| {
                let mut taken = Field::zeros(1, sectors);
                add_channels(strain, answer, &mut taken, stride);
                taken
            })
            .collect();
        let left = |row: usize, column: usize, h: usize| {
            let own = receptance.at(h, contact + shapes[row], contact + shapes[column]);
            own - taken[row * shapes.len() + column].at(h)
        };
        let of_shape = |shape: &usize| &harmonic.deviations[shape * sectors..][..sectors];
        let deviations: Vec<Complex64> = shapes.iter().flat_map(of_shape).copied().collect();
        let mut factors = LuWorkspace::new(shapes.len() * sectors);
        let matrix = factors.matrix_mut();
        fill_circulant(transform, shapes.len(), left, &deviations, matrix);
        factors.factor().then_some(Self {
            motions,
            strains,
            factors,
            deviations,
        })
    }

    /// Adds `M^-1 R_cs D (I + (R_ss - X) D)^-1 R_sc G M^-1 r` with `M = I + R_cc G`, `X = R_sc G M^-1 R_cs`.
    fn add(&mut self, transform: &SectorTransform, residual: &Field, step: &mut Field) {
        let sectors = transform.sectors();
        let stride = padded(sectors);
        let count = self.strains.len();
        let mut waves = Field::zeros(count, sectors);
        for (shape, strain) in self.strains.iter().enumerate() {
            let mut own = Field::zeros(1, sectors);
            add_channels(strain, residual, &mut own, stride);
            waves.re[shape * stride..][..stride].copy_from_slice(&own.re);
            waves.im[shape * stride..][..stride].copy_from_slice(&own.im);
        }
        let mut own = Field::zeros(count, sectors);
        transform.to_sectors(&waves, &mut own);
        let place = |at: usize| at / sectors * stride + at % sectors;
        let mut unknowns: Vec<Complex64> =
            (0..count * sectors).map(|at| own.at(place(at))).collect();
        self.factors.solve(&mut unknowns);
        for (at, (z, deviation)) in unknowns.iter().zip(&self.deviations).enumerate() {
            own.set(place(at), z * deviation);
        }
        transform.to_waves(&own, &mut waves);
        for (shape, motion) in self.motions.iter().enumerate() {
            let forces = (
                &waves.re[shape * stride..][..stride],
                &waves.im[shape * stride..][..stride],
            );
            for (place, (x, y)) in motion.re.iter().zip(&motion.im).enumerate() {
                let (a, b) = (forces.0[place % stride], forces.1[place % stride]);
                step.re[place] += x * a - y * b;
                step.im[place] += x * b + y * a;
            }
        }
    }
}

/// Adds the sum over the channels of `left right`, wave by wave.
fn add_channels(left: &Field, right: &Field, sum: &mut Field, stride: usize) {
    let left = left
        .re
        .chunks_exact(stride)
        .zip(left.im.chunks_exact(stride));
    let right = right
        .re
        .chunks_exact(stride)
        .zip(right.im.chunks_exact(stride));
    for ((x, y), (a, b)) in left.zip(right) {
        for h in 0..stride {
            sum.re[h] += x[h] * a[h] - y[h] * b[h];
            sum.im[h] += x[h] * b[h] + y[h] * a[h];
        }
    }
}
