//! The strain coordinates of mistuned blades, eliminated from the equation of one harmonic at one frequency.
//!
//! ```text
//! (I + R D) z = r
//! ```
//!
//! with the receptances R of the tuned wheel in the strain coordinates z of all blades, and the deviations D of every shape
//! and sector. Few unknowns are solved by one factorisation. Of many, only those of the leading shapes are (index 1), which
//! hold the resonances; the motion of the others (index 2) is nearly static, so that their deviations change it little:
//!
//! ```text
//! z_1 = (I + R_11 D_1)^-1 (r_1 - R_12 f_2),    f_2 <- D_2 (r_2 - R_21 D_1 z_1 - R_22 f_2)
//! ```
//!
//! The blade forces `f = D z` of this block Gauss-Seidel iteration settle by a digit a sweep. Where they do not, all unknowns
//! are factorised.

use crate::linalg::{Complex64, LuWorkspace};

use super::fields::{Field, SectorTransform, norm_squared, padded};
use super::wave_matrix::WaveMatrix;

/// Largest deviation of a blade times the receptance of a shape up to which the shape is not a leading one.
const NEARLY_STATIC: f64 = 0.15;
/// Change of the blade forces in a sweep, relative to them, at which they have settled.
const SETTLED: f64 = 1e-12;
/// Sweeps at most.
const SWEEPS: usize = 40;
/// Sweeps and solutions of one frequency, for the choice between the two ways.
const EXPECTED_SWEEPS: f64 = 13.0;
const EXPECTED_SOLUTIONS: f64 = 40.0;

/// `I + R D` of one harmonic at one frequency, ready to be solved with.
pub(super) struct Elimination {
    sectors: usize,
    shapes: usize,
    /// Contact rows before the strain coordinates in the receptances.
    contact: usize,
    /// Shapes that are factorised.
    leading: usize,
    /// Shapes that are not nearly static, ascending.
    resonant: Vec<usize>,
    factors: LuWorkspace<Complex64>,
    /// Deviation of every shape and sector, the loss factor included, shape after shape.
    deviations: Vec<Complex64>,
    unknowns: Vec<Complex64>,
    sides: [Side; 2],
}

/// Fields of the leading shapes, or of the remaining ones.
#[derive(Default)]
struct Side {
    right: Field,
    waves: Field,
    sectors: Field,
    forces: Field,
}

impl Elimination {
    /// For so many shapes a blade, after `contact` rows of the receptances.
    pub(super) fn new(sectors: usize, contact: usize, shapes: usize) -> Self {
        Self {
            sectors,
            shapes,
            contact,
            leading: 0,
            resonant: Vec::new(),
            factors: LuWorkspace::new(0),
            deviations: Vec::new(),
            unknowns: Vec::new(),
            sides: Default::default(),
        }
    }

    /// Takes the deviations in; false if `I + R D` is singular.
    pub(super) fn prepare(
        &mut self,
        transform: &SectorTransform,
        receptance: &WaveMatrix,
        deviations: &[Complex64],
    ) -> bool {
        self.deviations.clear();
        self.deviations.extend_from_slice(deviations);
        self.find_resonant(receptance);
        let up_to_last = self.resonant.last().map_or(1, |last| last + 1);
        let leading = self.cheapest(up_to_last);
        self.factorise(transform, receptance, leading)
    }

    /// Shapes that are not nearly static, ascending.
    pub(super) fn resonant(&self) -> &[usize] {
        &self.resonant
    }

    fn find_resonant(&mut self, receptance: &WaveMatrix) {
        let largest = self.deviations.iter().map(|deviation| deviation.norm());
        let largest = largest.fold(0.0, f64::max);
        let answer = |shape: usize| {
            let place = self.contact + shape;
            let of_wave = (0..self.sectors).map(|h| receptance.at(h, place, place).norm());
            of_wave.fold(0.0, f64::max)
        };
        let is_resonant = |shape: &usize| largest * answer(*shape) > NEARLY_STATIC;
        self.resonant = (0..self.shapes).filter(is_resonant).collect();
    }

    /// As many shapes as are factorised for the fewest operations: these or all.
    fn cheapest(&self, resonant: usize) -> usize {
        let (sectors, shapes) = (self.sectors as f64, self.shapes as f64);
        let direct = |shapes: usize| {
            let unknowns = shapes as f64 * sectors;
            unknowns.powi(2) * (unknowns / 3.0 + EXPECTED_SOLUTIONS)
        };
        let sweep = shapes.powi(2) * sectors + shapes * sectors.powi(2);
        let iterated = direct(resonant) + EXPECTED_SOLUTIONS * EXPECTED_SWEEPS * sweep;
        if iterated < direct(self.shapes) {
            resonant
        } else {
            self.shapes
        }
    }

    fn factorise(
        &mut self,
        transform: &SectorTransform,
        receptance: &WaveMatrix,
        leading: usize,
    ) -> bool {
        let size = leading * self.sectors;
        if self.factors.dimension() != size {
            self.factors = LuWorkspace::new(size);
        }
        if self.leading != leading {
            let fields = |channels: usize| {
                let field = || Field::zeros(channels, self.sectors);
                Side {
                    right: field(),
                    waves: field(),
                    sectors: field(),
                    forces: field(),
                }
            };
            self.sides = [fields(leading), fields(self.shapes - leading)];
            self.leading = leading;
        }
        let contact = self.contact;
        let block =
            |row: usize, column: usize, h| receptance.at(h, contact + row, contact + column);
        let matrix = self.factors.matrix_mut();
        fill_circulant(transform, leading, block, &self.deviations, matrix);
        self.factors.factor()
    }

    /// Blade forces `D (I + R D)^-1 r` in the place of r, over the waves.
    pub(super) fn blade_forces(
        &mut self,
        transform: &SectorTransform,
        receptance: &WaveMatrix,
        strain: &mut Field,
    ) {
        if !self.sweep(transform, receptance, strain) {
            // Forces by a singular matrix are not finite, and the iteration on the contact ends by that.
            self.factorise(transform, receptance, self.shapes);
            self.sweep(transform, receptance, strain);
        }
        let split = self.leading * padded(self.sectors);
        let [first, second] = &self.sides;
        for (to, first, second) in [
            (&mut strain.re, &first.forces.re, &second.forces.re),
            (&mut strain.im, &first.forces.im, &second.forces.im),
        ] {
            to[..split].copy_from_slice(first);
            to[split..].copy_from_slice(second);
        }
    }

    /// Blade forces of both sides; false if they do not settle.
    fn sweep(
        &mut self,
        transform: &SectorTransform,
        receptance: &WaveMatrix,
        strain: &Field,
    ) -> bool {
        let stride = padded(self.sectors);
        let (split, all) = (self.leading * stride, self.shapes * stride);
        for (side, part) in self.sides.iter_mut().zip([0..split, split..all]) {
            side.right.re.copy_from_slice(&strain.re[part.clone()]);
            side.right.im.copy_from_slice(&strain.im[part]);
            side.forces.fill(0.0);
        }
        let (first, middle) = (self.contact, self.contact + self.leading);
        let (leading, others) = (first..middle, middle..first + self.shapes);
        for _ in 0..SWEEPS {
            let [one, two] = &mut self.sides;
            one.waves.clone_from(&one.right);
            receptance.add_product(
                leading.clone(),
                others.clone(),
                -1.0,
                &two.forces,
                &mut one.waves,
            );
            self.solve_leading(transform);
            if self.leading == self.shapes {
                return true;
            }
            let [one, two] = &mut self.sides;
            two.waves.clone_from(&two.right);
            for (columns, forces) in [
                (leading.clone(), &one.forces),
                (others.clone(), &two.forces),
            ] {
                receptance.add_product(others.clone(), columns, -1.0, forces, &mut two.waves);
            }
            transform.to_sectors(&two.waves, &mut two.sectors);
            let deviations = &self.deviations[self.leading * self.sectors..];
            times(&mut two.sectors, deviations, self.sectors);
            transform.to_waves(&two.sectors, &mut two.waves);
            std::mem::swap(&mut two.waves, &mut two.forces);
            // The forces before.
            two.waves.add(-1.0, &two.forces);
            let whole = norm_squared(&one.forces) + norm_squared(&two.forces);
            let change = norm_squared(&two.waves);
            if change <= SETTLED.powi(2) * whole {
                return true;
            }
            if !change.is_finite() {
                return false;
            }
        }
        false
    }

    /// Blade forces of the leading shapes by their right-hand side in the waves.
    fn solve_leading(&mut self, transform: &SectorTransform) {
        let sectors = self.sectors;
        let stride = padded(sectors);
        let one = &mut self.sides[0];
        transform.to_sectors(&one.waves, &mut one.sectors);
        self.unknowns.clear();
        for shape in 0..self.leading {
            let blades = (0..sectors).map(|n| one.sectors.at(shape * stride + n));
            self.unknowns.extend(blades);
        }
        self.factors.solve(&mut self.unknowns);
        for (at, z) in self.unknowns.iter().enumerate() {
            one.sectors.set(at / sectors * stride + at % sectors, *z);
        }
        times(&mut one.sectors, &self.deviations, sectors);
        transform.to_waves(&one.sectors, &mut one.forces);
    }
}

/// Times the deviation of every shape and sector.
fn times(field: &mut Field, deviations: &[Complex64], sectors: usize) {
    let stride = padded(sectors);
    let channels = field.re.len() / stride;
    for (at, deviation) in deviations[..channels * sectors].iter().enumerate() {
        let place = at / sectors * stride + at % sectors;
        field.set(place, field.at(place) * deviation);
    }
}

/// `I + circ(R) D`, column-major, unknowns shape after shape and sector after sector.
pub(super) fn fill_circulant(
    transform: &SectorTransform,
    shapes: usize,
    block: impl Fn(usize, usize, usize) -> Complex64,
    deviations: &[Complex64],
    matrix: &mut [Complex64],
) {
    let sectors = transform.sectors();
    let stride = padded(sectors);
    let size = shapes * sectors;
    let scale = 1.0 / (sectors as f64).sqrt();
    let mut waves = Field::zeros(shapes, sectors);
    let mut circulant = Field::zeros(shapes, sectors);
    for column in 0..shapes {
        for row in 0..shapes {
            for h in 0..sectors {
                waves.set(row * stride + h, block(row, column, h) * scale);
            }
        }
        transform.to_sectors(&waves, &mut circulant);
        for m in 0..sectors {
            let deviation = deviations[column * sectors + m];
            let column_of_sector = &mut matrix[(column * sectors + m) * size..][..size];
            for row in 0..shapes {
                for n in 0..sectors {
                    let apart = if n >= m { n - m } else { n + sectors - m };
                    column_of_sector[row * sectors + n] =
                        circulant.at(row * stride + apart) * deviation;
                }
            }
            column_of_sector[column * sectors + m] += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::cyclic::phase;

    fn number(place: usize) -> Complex64 {
        let turn = 0.3 + 1.7 * place as f64 + 0.01 * (place * place) as f64;
        Complex64::new(turn.sin(), (1.3 * turn).cos())
    }

    /// Receptances over one contact row, `shapes` strain coordinates and three observed rows, of which the first shape resonates.
    fn receptances(sectors: usize, shapes: usize) -> WaveMatrix {
        let mut receptance = WaveMatrix::zeros(shapes + 4, shapes + 1, sectors);
        for h in 0..sectors {
            for row in 0..shapes + 4 {
                for column in 0..=shapes {
                    let scale = if row == 1 && column == 1 { 40.0 } else { 0.4 };
                    let size = scale / (1.0 + row.abs_diff(column) as f64);
                    receptance.set(h, row, column, size * number(31 * h + 7 * row + column));
                }
            }
        }
        receptance
    }

    /// Largest entry of `(I + R D) z - r` for the forces `D z`, by the sums over sectors and waves.
    fn largest_residual(
        receptance: &WaveMatrix,
        deviations: &[Complex64],
        (right, forces): (&Field, &Field),
        (sectors, shapes): (usize, usize),
    ) -> f64 {
        let stride = padded(sectors);
        let over = |field: &Field, shape: usize, n: usize, sign: bool| -> Complex64 {
            let turned = |h: usize| {
                let turn = phase(h, n, sectors);
                field.at(shape * stride + h) * if sign { turn } else { turn.conj() }
            };
            (0..sectors).map(turned).sum::<Complex64>() / (sectors as f64).sqrt()
        };
        let mut waves = right.clone();
        for h in 0..sectors {
            for row in 0..shapes {
                let taken: Complex64 = (0..shapes)
                    .map(|j| receptance.at(h, row + 1, j + 1) * forces.at(j * stride + h))
                    .sum();
                let place = row * stride + h;
                waves.set(place, waves.at(place) - taken);
            }
        }
        let places = (0..shapes).flat_map(|shape| (0..sectors).map(move |n| (shape, n)));
        let left = places.map(|(shape, n)| {
            let z = over(&waves, shape, n, true);
            (over(forces, shape, n, true) - deviations[shape * sectors + n] * z).norm()
        });
        left.fold(0.0, f64::max)
    }

    #[test]
    fn blade_forces_solve_the_equation_by_either_way() {
        // All factorised; the leading shape only; deviations with which the sweeps do not settle.
        for (sectors, shapes, deviation, leading) in
            [(5, 2, 0.1, 2), (9, 20, 0.05, 1), (9, 20, 4.0, 1)]
        {
            let receptance = receptances(sectors, shapes);
            let deviations: Vec<Complex64> = (0..shapes * sectors)
                .map(|at| number(at % sectors).re * deviation * Complex64::new(1.0, 0.002))
                .collect();
            let transform = SectorTransform::new(sectors);
            let mut elimination = Elimination::new(sectors, 1, shapes);
            assert!(elimination.prepare(&transform, &receptance, &deviations));
            if leading < shapes {
                assert!(elimination.factorise(&transform, &receptance, leading));
            }
            let mut right = Field::zeros(shapes, sectors);
            let stride = padded(sectors);
            for shape in 0..shapes {
                for h in 0..sectors {
                    right.set(shape * stride + h, number(1000 + 17 * shape + h));
                }
            }
            let mut forces = right.clone();
            elimination.blade_forces(&transform, &receptance, &mut forces);
            let expected = if deviation > 0.2 { shapes } else { leading };
            assert_eq!(elimination.leading, expected);
            let both = (&right, &forces);
            let left = largest_residual(&receptance, &deviations, both, (sectors, shapes));
            assert!(left < 1e-10, "{sectors} {shapes} {deviation}: {left}");
        }
    }
}
