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

/// Approximate inverse of the derivative `I + A G` of the equation of a harmonic: with the mean tangent G of the contact and
/// the leading shape of the blades.
#[derive(Default)]
pub(super) struct Preconditioner {
    /// `(I + R_cc G)^-1`.
    inverse: WaveMatrix,
    leading: Option<Leading>,
    turned: Field,
}

/// The part of the leading shape, by Woodbury's formula.
struct Leading {
    /// `(I + R_cc G)^-1 R_c1`, a channel per row.
    motion: Field,
    /// `R_1c G (I + R_cc G)^-1`, a channel per row.
    strain: Field,
    factors: LuWorkspace<Complex64>,
    deviations: Vec<Complex64>,
}

impl Preconditioner {
    /// For a harmonic under the mean tangent of the contact; with its leading shape where that is wanted.
    pub(super) fn new(
        harmonic: &WheelHarmonic,
        transform: &SectorTransform,
        tangent: &MeanTangent,
        pairs: &[[Option<usize>; 3]],
        with_leading: bool,
    ) -> Self {
        let (sectors, contact) = (harmonic.sectors, harmonic.contact);
        let receptance = &harmonic.receptance;
        // R G of the motions of the contact, and of the leading shape.
        let rows = contact + usize::from(with_leading && harmonic.shapes > 0);
        let mut product = WaveMatrix::zeros(rows, contact, sectors);
        product.add_times_pairs(receptance, pairs, tangent);
        let mut inverse = product.leading_rows(contact);
        inverse.add_identity();
        inverse.invert();
        let leading = (with_leading && harmonic.is_mistuned)
            .then(|| Leading::new(harmonic, transform, &product, &inverse))
            .flatten();
        Self {
            inverse,
            leading,
            turned: Field::zeros(contact, sectors),
        }
    }

    /// The residual turned into a step, in place.
    pub(super) fn apply(&mut self, transform: &SectorTransform, residual: &mut Field) {
        let contact = self.inverse.rows;
        self.turned.fill(0.0);
        self.inverse
            .add_product(0..contact, 0..contact, 1.0, residual, &mut self.turned);
        if let Some(leading) = &mut self.leading {
            leading.add(transform, residual, &mut self.turned);
        }
        std::mem::swap(&mut self.turned, residual);
    }
}

impl Leading {
    fn new(
        harmonic: &WheelHarmonic,
        transform: &SectorTransform,
        product: &WaveMatrix,
        inverse: &WaveMatrix,
    ) -> Option<Self> {
        let (sectors, contact) = (harmonic.sectors, harmonic.contact);
        let stride = padded(sectors);
        let receptance = &harmonic.receptance;
        let mut motion = Field::zeros(contact, sectors);
        let own = receptance.column(contact, 0..contact);
        inverse.add_product(0..contact, 0..contact, 1.0, &own, &mut motion);
        let mut strain = Field::zeros(contact, sectors);
        inverse.add_transposed_product(&product.row(contact), &mut strain);
        let mut taken = Field::zeros(1, sectors);
        add_channels(&strain, &own, &mut taken, stride);
        let left = |h: usize| receptance.at(h, contact, contact) - taken.at(h);
        let deviations = harmonic.deviations[..sectors].to_vec();
        let mut factors = LuWorkspace::new(sectors);
        let matrix = factors.matrix_mut();
        fill_circulant(transform, 1, |_, _, h| left(h), &deviations, matrix);
        factors.factor().then_some(Self {
            motion,
            strain,
            factors,
            deviations,
        })
    }

    /// Adds `M^-1 R_c1 D (I + (R_11 - X) D)^-1 R_1c G M^-1 r` with `X = R_1c G M^-1 R_c1`.
    fn add(&mut self, transform: &SectorTransform, residual: &Field, step: &mut Field) {
        let sectors = transform.sectors();
        let stride = padded(sectors);
        let mut waves = Field::zeros(1, sectors);
        add_channels(&self.strain, residual, &mut waves, stride);
        let mut own = Field::zeros(1, sectors);
        transform.to_sectors(&waves, &mut own);
        let mut unknowns: Vec<Complex64> = (0..sectors).map(|n| own.at(n)).collect();
        self.factors.solve(&mut unknowns);
        for (n, (z, deviation)) in unknowns.iter().zip(&self.deviations).enumerate() {
            own.set(n, z * deviation);
        }
        transform.to_waves(&own, &mut waves);
        for (place, (x, y)) in self.motion.re.iter().zip(&self.motion.im).enumerate() {
            let (a, b) = (waves.re[place % stride], waves.im[place % stride]);
            step.re[place] += x * a - y * b;
            step.im[place] += x * b + y * a;
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
