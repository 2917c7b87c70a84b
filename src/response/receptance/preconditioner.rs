//! The preconditioner of the contact iteration, one harmonic: the inverse of its derivative under the mean tangent of the contact.
//!
//! ```text
//! P = (I + A G')^-1 about (I + R_cc G)^-1,    and with shapes s of the deviating blades by Woodbury's formula
//! P r = M^-1 r + M^-1 R_cs D (I + (R_ss - X) D)^-1 R_sc G M^-1 r,    M = I + R_cc G,    X = R_sc G M^-1 R_cs
//! ```
//!
//! with the answer A of the wheel to contact forces, its receptances R, and the mean tangent G over the sectors.

use crate::linalg::{Complex64, LuWorkspace};
use crate::response::harmonic_balance::MeanTangent;

use super::elimination::fill_circulant;
use super::fields::{Field, SectorTransform, padded};
use super::wave_matrix::{WaveFactors, WaveMatrix};
use super::wheel_harmonic::WheelHarmonic;

/// Approximate inverse of the derivative `I + A G` of the equation of a harmonic: with the mean tangent G of the contact and
/// some shapes of the blades.
#[derive(Default)]
pub(super) struct Preconditioner {
    /// Of `I + R_cc G`.
    factors: WaveFactors,
    mistuned: Option<MistunedShapes>,
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
        let mut matrix = product.leading_rows(contact);
        matrix.add_identity();
        let factors = matrix.factorised();
        let mistuned = (!shapes.is_empty())
            .then(|| MistunedShapes::new(harmonic, transform, (&product, &factors), shapes))
            .flatten();
        Self { factors, mistuned }
    }

    /// The residual turned into a step, in place.
    pub(super) fn apply(&mut self, transform: &SectorTransform, residual: &mut Field) {
        let forces = self
            .mistuned
            .as_mut()
            .map(|mistuned| mistuned.forces(transform, residual));
        self.factors.solve(residual);
        if let (Some(mistuned), Some(forces)) = (&self.mistuned, forces) {
            mistuned.add(&forces, residual);
        }
    }
}

impl MistunedShapes {
    fn new(
        harmonic: &WheelHarmonic,
        transform: &SectorTransform,
        (product, factors): (&WaveMatrix, &WaveFactors),
        shapes: &[usize],
    ) -> Option<Self> {
        let (sectors, contact) = (harmonic.sectors, harmonic.contact);
        let stride = padded(sectors);
        let receptance = &harmonic.receptance;
        let (mut motions, mut strains, mut answers) = (Vec::new(), Vec::new(), Vec::new());
        for shape in shapes {
            let answer = receptance.column(contact + shape, 0..contact);
            let mut motion = answer.clone();
            factors.solve(&mut motion);
            let mut strain = product.row(contact + shape);
            factors.solve_transposed(&mut strain);
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
            let answer = receptance.at(h, contact + shapes[row], contact + shapes[column]);
            answer - taken[row * shapes.len() + column].at(h)
        };
        let of_shape = |shape: &usize| &harmonic.deviations[shape * sectors..][..sectors];
        let deviations: Vec<Complex64> = shapes.iter().flat_map(of_shape).copied().collect();
        let mut of_shapes = LuWorkspace::new(shapes.len() * sectors);
        let matrix = of_shapes.matrix_mut();
        fill_circulant(transform, shapes.len(), left, &deviations, matrix);
        of_shapes.factor().then_some(Self {
            motions,
            strains,
            factors: of_shapes,
            deviations,
        })
    }

    /// `D (I + (R_ss - X) D)^-1 R_sc G M^-1 r` with `M = I + R_cc G`, `X = R_sc G M^-1 R_cs`, over the waves.
    fn forces(&mut self, transform: &SectorTransform, residual: &Field) -> Field {
        let sectors = transform.sectors();
        let stride = padded(sectors);
        let count = self.strains.len();
        let mut waves = Field::zeros(count, sectors);
        for (shape, strain) in self.strains.iter().enumerate() {
            let mut channel = Field::zeros(1, sectors);
            add_channels(strain, residual, &mut channel, stride);
            waves.re[shape * stride..][..stride].copy_from_slice(&channel.re);
            waves.im[shape * stride..][..stride].copy_from_slice(&channel.im);
        }
        let mut blades = Field::zeros(count, sectors);
        transform.to_sectors(&waves, &mut blades);
        let place = |at: usize| at / sectors * stride + at % sectors;
        let mut unknowns: Vec<Complex64> = (0..count * sectors)
            .map(|at| blades.at(place(at)))
            .collect();
        self.factors.solve(&mut unknowns);
        for (at, (z, deviation)) in unknowns.iter().zip(&self.deviations).enumerate() {
            blades.set(place(at), z * deviation);
        }
        transform.to_waves(&blades, &mut waves);
        waves
    }

    /// Adds `M^-1 R_cs` times the forces over the waves.
    fn add(&self, waves: &Field, step: &mut Field) {
        let stride = waves.re.len() / self.motions.len().max(1);
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
