//! A preconditioner of the contact iteration that couples high harmonics along the travelling wave of the excitation.
//!
//! In the frame of the wave w of the excitation all sectors of a tuned wheel have one derivative of the contact forces, `D_kl` by the complex
//! motions of the harmonics k and l, where the harmonic -k stands for the conjugate of k. So the motions
//!
//! ```text
//! u_k of the wave m + k w,    k = ..., -11, -10, 10, 11, ...
//! ```
//!
//! of every m depend on one another alone: N families, of which those of m and -m are conjugate. Of a mistuned wheel D is the mean over the
//! sectors.
//!
//! ```text
//! P = (I + A_k D_kl)^-1 of every family, with the answer A of the tuned wheel
//! ```
//!
//! High harmonics alone are coupled: there a sector with its damper resonates, and the tangent of a harmonic by itself says little.

use crate::linalg::{Complex64, LuWorkspace, Matrix};
use crate::model::cyclic::phase;
use crate::response::harmonic_balance::WheelContact;

use super::contact_places::Places;
use super::fields::{Field, padded};
use super::wheel_harmonic::WheelHarmonic;

/// Harmonics from this one on are coupled.
const FIRST_COUPLED: usize = 10;
/// Unknowns of a family at most: its inverse takes a time that grows with their cube.
const MOST_UNKNOWNS: usize = 400;

/// Inverses of the families from m = 0 to N / 2.
pub(super) struct WavePreconditioner {
    wave: usize,
    sectors: usize,
    /// Contact rows of a sector.
    rows: usize,
    coupled: Vec<Coupled>,
    inverses: Vec<Inverse>,
}

/// A harmonic of a family.
#[derive(Clone, Copy)]
struct Coupled {
    /// The harmonic, below zero for its conjugate.
    k: i64,
    /// Its place in the set.
    place: usize,
}

/// A matrix in single precision, which is enough for a step: column after column.
struct Inverse {
    re: Vec<f32>,
    im: Vec<f32>,
}

impl Coupled {
    /// All of a set, first those above zero.
    fn of(contact: &WheelContact) -> Vec<Self> {
        let set = contact.transform().harmonics().iter().enumerate();
        let high: Vec<(i64, usize)> = set
            .filter(|&(_, &k)| k >= FIRST_COUPLED)
            .map(|(place, &k)| (k as i64, place))
            .collect();
        let signs = [1, -1].into_iter();
        let coupled = signs.flat_map(|sign| {
            let of_sign = move |&(k, place): &(i64, usize)| Self { k: sign * k, place };
            high.iter().map(of_sign).collect::<Vec<_>>()
        });
        coupled.collect()
    }

    /// Wave of the motion that stands for it in the family m.
    fn wave(self, m: usize, wave: usize, sectors: usize) -> usize {
        let of_family = (m as i64 + self.k * wave as i64) * self.k.signum();
        of_family.rem_euclid(sectors as i64) as usize
    }

    /// A value of the harmonic, or its conjugate.
    fn conjugated(self, value: Complex64) -> Complex64 {
        if self.k > 0 { value } else { value.conj() }
    }
}

impl WavePreconditioner {
    /// Whether the set has high harmonics, and families are small enough.
    pub(super) fn fits(contact: &WheelContact) -> bool {
        let unknowns = Coupled::of(contact).len() * contact.sector_rows();
        (1..=MOST_UNKNOWNS).contains(&unknowns)
    }

    /// At the motions last evaluated with derivative, whose harmonics are coupled; none where a family is singular.
    pub(super) fn new(
        contact: &WheelContact,
        harmonics: &[WheelHarmonic],
        wave: usize,
    ) -> Option<Self> {
        let coupled = Coupled::of(contact);
        let (sectors, rows) = (contact.sectors(), contact.sector_rows());
        let derivative = mean_derivative(contact, &coupled, wave);
        let inverse = |m: usize| {
            let mut factors = LuWorkspace::new(coupled.len() * rows);
            let answer = |of: Coupled, row: usize, through: usize| {
                let wave = of.wave(m, wave, sectors);
                of.conjugated(harmonics[of.place].receptance.at(wave, row, through))
            };
            add_family(
                factors.matrix_mut(),
                (contact.pair_rows(), rows),
                &coupled,
                &derivative,
                answer,
            );
            factors.factor().then(|| Inverse::of(&factors))
        };
        Some(Self {
            wave,
            sectors,
            rows,
            inverses: (0..=sectors / 2).map(inverse).collect::<Option<_>>()?,
            coupled,
        })
    }

    /// `P v` of the fields over the waves of all harmonics, into those of the harmonics that are coupled.
    pub(super) fn apply(&self, residual: &[Field], steps: &mut [Field]) {
        let stride = padded(self.sectors);
        let size = self.coupled.len() * self.rows;
        let (mut unknowns, mut step) = (Vec::with_capacity(size), Vec::new());
        for (m, inverse) in self.inverses.iter().enumerate() {
            let places = self.coupled.iter().flat_map(|&of| {
                let wave = of.wave(m, self.wave, self.sectors);
                (0..self.rows).map(move |row| (of, row * stride + wave))
            });
            unknowns.clear();
            let read = |(of, at): (Coupled, usize)| of.conjugated(residual[of.place].at(at));
            unknowns.extend(places.clone().map(read));
            inverse.times(&unknowns, &mut step);
            for ((of, at), value) in places.zip(&step) {
                steps[of.place].set(at, of.conjugated(*value));
            }
        }
    }
}

impl Inverse {
    fn of(factors: &LuWorkspace<Complex64>) -> Self {
        let mut columns = Matrix::<Complex64>::identity(factors.dimension());
        factors.solve_columns(&mut columns);
        let entries = columns.as_slice();
        Self {
            re: entries.iter().map(|z| z.re as f32).collect(),
            im: entries.iter().map(|z| z.im as f32).collect(),
        }
    }

    /// The product with `vector`, into `product`.
    fn times(&self, vector: &[Complex64], product: &mut Vec<Complex64>) {
        let size = vector.len();
        let (mut re, mut im) = (vec![0.0; size], vec![0.0; size]);
        let columns = self.re.chunks_exact(size).zip(self.im.chunks_exact(size));
        for (value, (column_re, column_im)) in vector.iter().zip(columns) {
            let (x, y) = (value.re, value.im);
            let sums = re.iter_mut().zip(&mut im);
            for ((re, im), (a, b)) in sums.zip(column_re.iter().zip(column_im)) {
                let (a, b) = (f64::from(*a), f64::from(*b));
                *re += a * x - b * y;
                *im += a * y + b * x;
            }
        }
        let values = re.into_iter().zip(im);
        product.clear();
        product.extend(values.map(|(re, im)| Complex64::new(re, im)));
    }
}

/// Adds `I + A D` of a family to the zero matrix, column after column, for pairs of a sector with so many rows.
fn add_family(
    matrix: &mut [Complex64],
    (pairs, rows): (&[[Option<usize>; 3]], usize),
    coupled: &[Coupled],
    derivative: &[Vec<Complex64>],
    answer: impl Fn(Coupled, usize, usize) -> Complex64,
) {
    let count = coupled.len();
    let size = count * rows;
    for at in 0..size {
        matrix[at * size + at] = Complex64::from(1.0);
    }
    let blocks = pairs
        .iter()
        .flat_map(|of| (0..9).map(move |block| (of[block / 3], of[block % 3])));
    for ((through, by), derivative) in blocks.zip(derivative) {
        let (Some(through), Some(by)) = (through, by) else {
            continue;
        };
        for (i, &of) in coupled.iter().enumerate() {
            for row in 0..rows {
                let answer = answer(of, row, through);
                for (j, slope) in derivative[i * count..][..count].iter().enumerate() {
                    matrix[(j * rows + by) * size + i * rows + row] += answer * slope;
                }
            }
        }
    }
}

/// `D_kl`, turned with the wave, of every pair of a sector along each of its directions by each: the mean over the sectors.
fn mean_derivative(
    contact: &WheelContact,
    coupled: &[Coupled],
    wave: usize,
) -> Vec<Vec<Complex64>> {
    let (sectors, pairs) = (contact.sectors(), contact.pair_rows().len());
    let coefficients = contact.transform().n_coefficients();
    let places = Places::of(contact);
    let count = coupled.len();
    let mut derivative = vec![vec![Complex64::default(); count * count]; 9 * pairs];
    for pair in (0..sectors * pairs).filter(|&pair| contact.is_active(pair)) {
        for block in 0..9 {
            let Some(slopes) = contact.slopes(pair, block / 3, block % 3) else {
                continue;
            };
            let sum = &mut derivative[pair % pairs * 9 + block];
            for (i, of) in coupled.iter().enumerate() {
                for (j, by) in coupled.iter().enumerate() {
                    let [to, from] = [of, by].map(|one| places.harmonics[one.place].1);
                    let at = |c: usize, d: usize| slopes[(to + c) * coefficients + from + d];
                    // `G_k = T u_l + S conj(u_l)` of the real slopes: T between harmonics of one sign, S between others.
                    let sign = if (of.k > 0) == (by.k > 0) { 1.0 } else { -1.0 };
                    let slope =
                        Complex64::new(at(0, 0) + sign * at(1, 1), at(1, 0) - sign * at(0, 1));
                    let turns = ((of.k - by.k) * wave as i64).rem_euclid(sectors as i64) as usize;
                    let back = phase(turns, pair / pairs, sectors).conj();
                    sum[i * count + j] += of.conjugated(slope) * back * (0.5 / sectors as f64);
                }
            }
        }
    }
    derivative
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::{Field, Places, WavePreconditioner, WheelContact, WheelHarmonic};
    use crate::linalg::Complex64;
    use crate::model::cyclic::ContactGeometry;
    use crate::response::friction::{ContactLaw, PairParameters};
    use crate::response::harmonic_balance::{ContactInterface, HarmonicTransform};
    use crate::response::receptance::fields::SectorTransform;

    const SECTORS: usize = 8;
    const WAVE: usize = 3;
    const SET: [usize; 5] = [0, 1, 2, 10, 11];

    fn number(place: usize) -> Complex64 {
        let turn = 0.3 + 1.7 * place as f64 + 0.01 * (place * place) as f64;
        Complex64::new(turn.sin(), (1.3 * turn).cos())
    }

    /// A pair in three directions that slips under the travelling wave.
    fn contact(set: &[usize]) -> WheelContact {
        let pair = PairParameters {
            normal_load_n: 1.0,
            normal_stiffness_n_per_m: 1.0,
            tangential_stiffness_n_per_m: 2.0,
            friction_coefficient: 0.3,
        };
        let geometry = ContactGeometry {
            weights: vec![1.0],
            load_weights: vec![1.0],
            rows: vec![[Some(0), Some(1), Some(2)]],
            ring_motion: vec![[[0.0; 2]; 2]],
            ring_free: [false; 2],
        };
        let interface = ContactInterface {
            law: ContactLaw::Simplified3d,
            geometry,
            pairs: vec![pair],
        };
        let transform = HarmonicTransform::new(set, 256).expect("a set");
        WheelContact::new(interface, SECTORS, &[1.0, 2.0, 2.0], Arc::new(transform))
    }

    #[test]
    fn of_a_travelling_wave_it_is_the_inverse_for_high_harmonics() {
        let sectors = SectorTransform::new(SECTORS);
        let mut contact = contact(&SET);
        let places = Places::of(&contact);
        let zeros = || vec![Field::zeros(3, SECTORS); SET.len()];
        let mut room = Field::zeros(3, SECTORS);
        let mut motions = zeros();
        for (place, (field, k)) in motions.iter_mut().zip(SET).enumerate() {
            let size = if k == 1 { 3.0 } else { 0.3 };
            for row in 0..3 {
                let value = number(7 * place + row) * size;
                let value = if k == 0 { value.re.into() } else { value };
                field.set(row * SECTORS + k * WAVE % SECTORS, value);
            }
        }
        places.to_sectors(&sectors, &motions, &mut room, contact.motion_mut());
        contact.couple(true);
        let shares = contact.evaluate(true);
        assert!(shares.slipping > 0.9, "{shares:?}");
        let harmonics = SET.map(|k| {
            let mut harmonic = WheelHarmonic::new(SECTORS, 3, 0);
            for (place, entry) in (0..9 * SECTORS).map(|at| (at, number(at + 100 * k))) {
                let (wave, at) = (place / 9, place % 9);
                let answer = entry * 0.3;
                harmonic.receptance.set(wave, at / 3, at % 3, answer);
            }
            harmonic
        });
        // What the derivative makes of motions in the high harmonics, in these.
        let mut expected = zeros();
        for (place, field) in expected.iter_mut().enumerate().skip(3) {
            for at in 0..3 * SECTORS {
                field.set(at, number(at + 50 * place));
            }
        }
        let mut change = vec![0.0; contact.motion().len()];
        let mut force = change.clone();
        places.to_sectors(&sectors, &expected, &mut room, &mut change);
        contact.add_derivative(&change, &mut force);
        let mut residual = expected.clone();
        for place in 3..SET.len() {
            let mut waves = Field::zeros(3, SECTORS);
            places.to_waves(&sectors, place, &force, &mut room, &mut waves);
            let receptance = &harmonics[place].receptance;
            receptance.add_product(0..3, 0..3, 1.0, &waves, &mut residual[place]);
        }
        let by = WavePreconditioner::new(&contact, &harmonics, WAVE).expect("regular");
        let mut steps = zeros();
        by.apply(&residual, &mut steps);
        for place in 3..SET.len() {
            let far = (0..3 * SECTORS)
                .map(|at| (steps[place].at(at) - expected[place].at(at)).norm())
                .fold(0.0, f64::max);
            let moved = (0..3 * SECTORS)
                .map(|at| (residual[place].at(at) - expected[place].at(at)).norm())
                .fold(0.0, f64::max);
            assert!(far < 1e-4 && moved > 0.1, "{far:e}, of {moved:e}");
        }
    }

    #[test]
    fn it_fits_sets_with_high_harmonics_and_small_families() {
        let fits = |set: &[usize]| WavePreconditioner::fits(&contact(set));
        assert!(fits(&SET));
        assert!(!fits(&[0, 1, 2, 9]));
        // Six unknowns for every high harmonic of three rows.
        let up_to = |last: usize| (0..=last).collect::<Vec<_>>();
        assert!(fits(&up_to(75)) && !fits(&up_to(76)));
    }
}
