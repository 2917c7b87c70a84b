//! Fields over the sectors of a wheel and over its waves, and what acts on every wave by itself.
//!
//! A field has several channels, each with one complex number per sector or per wave:
//!
//! ```text
//! x_n = (1/sqrt N) sum_h X_h e^{i h n alpha},    n, h = 0 .. N-1,    alpha = 2 pi / N
//! ```
//!
//! Real and imaginary parts stand apart and sectors side by side, padded by zeros to whole [`LANES`], so that a
//! vector of the machine holds several sectors. No sum is taken in another order for it.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use crate::linalg::{Complex64, Loops, vectorized};
use crate::model::cyclic::phase;

/// Sectors that are handled side by side.
pub(super) const LANES: usize = 8;

type Lanes = [f64; LANES];

/// Sectors with their padding.
pub(super) fn padded(sectors: usize) -> usize {
    sectors.next_multiple_of(LANES)
}

/// Complex numbers, channel after channel, each over the padded sectors.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Field {
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
}

impl Field {
    pub(super) fn zeros(channels: usize, sectors: usize) -> Self {
        let entries = channels * padded(sectors);
        Self {
            re: vec![0.0; entries],
            im: vec![0.0; entries],
        }
    }

    pub(super) fn fill(&mut self, value: f64) {
        self.re.fill(value);
        self.im.fill(value);
    }

    pub(super) fn at(&self, place: usize) -> Complex64 {
        Complex64::new(self.re[place], self.im[place])
    }

    pub(super) fn set(&mut self, place: usize, value: Complex64) {
        (self.re[place], self.im[place]) = (value.re, value.im);
    }

    /// Adds `factor` times another field.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        for (sum, own) in self.re.iter_mut().zip(&other.re) {
            *sum += factor * own;
        }
        for (sum, own) in self.im.iter_mut().zip(&other.im) {
            *sum += factor * own;
        }
    }
}

/// Transform between sectors and waves.
#[derive(Debug)]
pub(super) struct SectorTransform {
    sectors: usize,
    /// `cos(h n alpha) / sqrt N` over h, padded, for n = 0..=N/2.
    cosine: Vec<f64>,
    sine: Vec<f64>,
}

impl SectorTransform {
    pub(super) fn new(sectors: usize) -> Self {
        let stride = padded(sectors);
        let half = sectors / 2 + 1;
        let (mut cosine, mut sine) = (vec![0.0; half * stride], vec![0.0; half * stride]);
        let scale = 1.0 / (sectors as f64).sqrt();
        for n in 0..half {
            for h in 0..sectors {
                let turn = phase(h, n, sectors) * scale;
                (cosine[n * stride + h], sine[n * stride + h]) = (turn.re, turn.im);
            }
        }
        Self {
            sectors,
            cosine,
            sine,
        }
    }

    pub(super) fn sectors(&self) -> usize {
        self.sectors
    }

    /// Waves of a field over the sectors.
    pub(super) fn to_waves(&self, sectors: &Field, waves: &mut Field) {
        vectorized(Turned {
            transform: self,
            sign: -1.0,
            from: sectors,
            to: waves,
        });
    }

    /// Sectors of a field over the waves.
    pub(super) fn to_sectors(&self, waves: &Field, sectors: &mut Field) {
        vectorized(Turned {
            transform: self,
            sign: 1.0,
            from: waves,
            to: sectors,
        });
    }
}

/// `to_h = (1/sqrt N) sum_n from_n e^{sign i h n alpha}`; n and N - n have one cosine, and sines of opposite sign.
struct Turned<'a> {
    transform: &'a SectorTransform,
    sign: f64,
    from: &'a Field,
    to: &'a mut Field,
}

impl Loops for Turned<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let sectors = self.transform.sectors;
        let stride = padded(sectors);
        let chunks = stride / LANES;
        let (cosine, _) = self.transform.cosine.as_chunks::<LANES>();
        let (sine, _) = self.transform.sine.as_chunks::<LANES>();
        let from = self.from.re.chunks_exact(stride);
        let from = from.zip(self.from.im.chunks_exact(stride));
        let to = self.to.re.chunks_exact_mut(stride);
        let to = to.zip(self.to.im.chunks_exact_mut(stride));
        for ((re, im), (to_re, to_im)) in from.zip(to) {
            let (to_re, _) = to_re.as_chunks_mut::<LANES>();
            let (to_im, _) = to_im.as_chunks_mut::<LANES>();
            for chunk in 0..chunks {
                let (mut sum_re, mut sum_im) = ([0.0; LANES], [0.0; LANES]);
                for n in 0..=sectors / 2 {
                    let alone = n == 0 || 2 * n == sectors;
                    let (other_re, other_im) = if alone {
                        (0.0, 0.0)
                    } else {
                        (re[sectors - n], im[sectors - n])
                    };
                    let (even_re, even_im) = (re[n] + other_re, im[n] + other_im);
                    let odd_re = self.sign * (re[n] - other_re);
                    let odd_im = -self.sign * (im[n] - other_im);
                    let (c, s) = (&cosine[n * chunks + chunk], &sine[n * chunks + chunk]);
                    for lane in 0..LANES {
                        sum_re[lane] += c[lane] * even_re + s[lane] * odd_im;
                        sum_im[lane] += c[lane] * even_im + s[lane] * odd_re;
                    }
                }
                (to_re[chunk], to_im[chunk]) = (sum_re, sum_im);
            }
        }
    }
}

/// A small matrix for every wave, `rows x columns`: waves side by side, [`LANES`] at a time, then columns, then rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct WaveMatrix {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
}

impl WaveMatrix {
    pub(super) fn zeros(rows: usize, columns: usize, sectors: usize) -> Self {
        let entries = rows * columns * padded(sectors);
        Self {
            rows,
            columns,
            re: vec![0.0; entries],
            im: vec![0.0; entries],
        }
    }

    fn place(&self, wave: usize, row: usize, column: usize) -> usize {
        let chunk = wave / LANES;
        ((chunk * self.rows + row) * self.columns + column) * LANES + wave % LANES
    }

    pub(super) fn at(&self, wave: usize, row: usize, column: usize) -> Complex64 {
        let place = self.place(wave, row, column);
        Complex64::new(self.re[place], self.im[place])
    }

    pub(super) fn set(&mut self, wave: usize, row: usize, column: usize, value: Complex64) {
        let place = self.place(wave, row, column);
        (self.re[place], self.im[place]) = (value.re, value.im);
    }

    /// `to += factor A from` of every wave, for the block of A with these rows and columns; `from` and `to` have a channel
    /// per column and row of the block.
    pub(super) fn add_product(
        &self,
        rows: std::ops::Range<usize>,
        columns: std::ops::Range<usize>,
        factor: f64,
        from: &Field,
        to: &mut Field,
    ) {
        vectorized(AddProduct {
            matrix: self,
            rows,
            columns,
            factor,
            from,
            to,
        });
    }

    /// Adds R G, for the rows of R that this matrix has and a block diagonal G: of every pair a `3 x 3` matrix over its `rows`,
    /// row after row.
    pub(super) fn add_times_pairs(
        &mut self,
        receptance: &Self,
        rows: &[[Option<usize>; 3]],
        pairs: &[[Complex64; 9]],
    ) {
        vectorized(AddTimesPairs {
            sum: self,
            receptance,
            rows,
            pairs,
        });
    }

    /// The first rows.
    pub(super) fn leading_rows(&self, rows: usize) -> Self {
        let of = |part: &[f64]| -> Vec<f64> {
            let chunks = part.chunks_exact(self.rows * self.columns * LANES);
            let leading = chunks.flat_map(|chunk| &chunk[..rows * self.columns * LANES]);
            leading.copied().collect()
        };
        Self {
            rows,
            columns: self.columns,
            re: of(&self.re),
            im: of(&self.im),
        }
    }

    /// Adds 1 to the diagonal of every wave.
    pub(super) fn add_identity(&mut self) {
        let own = self.rows * self.columns * LANES;
        for chunk in self.re.chunks_exact_mut(own) {
            for row in 0..self.rows {
                let place = (row * self.columns + row) * LANES;
                chunk[place..place + LANES]
                    .iter_mut()
                    .for_each(|entry| *entry += 1.0);
            }
        }
    }

    /// Some entries of a column as a field, a channel per row.
    pub(super) fn column(&self, column: usize, rows: std::ops::Range<usize>) -> Field {
        self.entries(rows.map(|row| (row, column)))
    }

    /// A row as a field, a channel per column.
    pub(super) fn row(&self, row: usize) -> Field {
        self.entries((0..self.columns).map(|column| (row, column)))
    }

    fn entries(&self, places: impl Iterator<Item = (usize, usize)>) -> Field {
        let mut field = Field::default();
        let chunks = self.re.len() / (self.rows * self.columns * LANES).max(1);
        for (row, column) in places {
            for chunk in 0..chunks {
                let from = self.place(chunk * LANES, row, column);
                field.re.extend_from_slice(&self.re[from..from + LANES]);
                field.im.extend_from_slice(&self.im[from..from + LANES]);
            }
        }
        field
    }

    /// `to += A^T from` of every wave.
    pub(super) fn add_transposed_product(&self, from: &Field, to: &mut Field) {
        vectorized(AddTransposed {
            matrix: self,
            from,
            to,
        });
    }

    /// The inverse of every wave in the place of the matrix, without pivoting.
    pub(super) fn invert(&mut self) {
        vectorized(Inverted(self));
    }
}

struct AddProduct<'a> {
    matrix: &'a WaveMatrix,
    rows: std::ops::Range<usize>,
    columns: std::ops::Range<usize>,
    factor: f64,
    from: &'a Field,
    to: &'a mut Field,
}

impl Loops for AddProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (rows, columns) = (self.matrix.rows, self.matrix.columns);
        let (re, _) = self.matrix.re.as_chunks::<LANES>();
        let (im, _) = self.matrix.im.as_chunks::<LANES>();
        let chunks = re.len() / (rows * columns).max(1);
        let (from_re, _) = self.from.re.as_chunks::<LANES>();
        let (from_im, _) = self.from.im.as_chunks::<LANES>();
        let (to_re, _) = self.to.re.as_chunks_mut::<LANES>();
        let (to_im, _) = self.to.im.as_chunks_mut::<LANES>();
        for chunk in 0..chunks {
            for (channel, row) in self.rows.clone().enumerate() {
                let (mut sum_re, mut sum_im): (Lanes, Lanes) = ([0.0; LANES], [0.0; LANES]);
                let start = (chunk * rows + row) * columns;
                for (other, column) in self.columns.clone().enumerate() {
                    let (a, b) = (&re[start + column], &im[start + column]);
                    let x = &from_re[other * chunks + chunk];
                    let y = &from_im[other * chunks + chunk];
                    for lane in 0..LANES {
                        sum_re[lane] += a[lane] * x[lane] - b[lane] * y[lane];
                        sum_im[lane] += a[lane] * y[lane] + b[lane] * x[lane];
                    }
                }
                let to_re = &mut to_re[channel * chunks + chunk];
                let to_im = &mut to_im[channel * chunks + chunk];
                for lane in 0..LANES {
                    to_re[lane] += self.factor * sum_re[lane];
                    to_im[lane] += self.factor * sum_im[lane];
                }
            }
        }
    }
}

struct AddTimesPairs<'a> {
    sum: &'a mut WaveMatrix,
    receptance: &'a WaveMatrix,
    rows: &'a [[Option<usize>; 3]],
    pairs: &'a [[Complex64; 9]],
}

impl Loops for AddTimesPairs<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (rows, columns) = (self.sum.rows, self.sum.columns);
        let width = self.receptance.columns;
        let (from_re, _) = self.receptance.re.as_chunks::<LANES>();
        let (from_im, _) = self.receptance.im.as_chunks::<LANES>();
        let (to_re, _) = self.sum.re.as_chunks_mut::<LANES>();
        let (to_im, _) = self.sum.im.as_chunks_mut::<LANES>();
        let chunks = to_re.len() / (rows * columns).max(1);
        for (places, pair) in self.rows.iter().zip(self.pairs) {
            for (place, g) in pair.iter().enumerate() {
                let (Some(from), Some(to)) = (places[place / 3], places[place % 3]) else {
                    continue;
                };
                if g.norm_sqr() == 0.0 {
                    continue;
                }
                for chunk in 0..chunks {
                    for row in 0..rows {
                        let source = (chunk * self.receptance.rows + row) * width + from;
                        let (x, y) = (&from_re[source], &from_im[source]);
                        let place = (chunk * rows + row) * columns + to;
                        let (to_re, to_im) = (&mut to_re[place], &mut to_im[place]);
                        for lane in 0..LANES {
                            to_re[lane] += x[lane] * g.re - y[lane] * g.im;
                            to_im[lane] += x[lane] * g.im + y[lane] * g.re;
                        }
                    }
                }
            }
        }
    }
}

struct AddTransposed<'a> {
    matrix: &'a WaveMatrix,
    from: &'a Field,
    to: &'a mut Field,
}

impl Loops for AddTransposed<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (rows, columns) = (self.matrix.rows, self.matrix.columns);
        let (re, _) = self.matrix.re.as_chunks::<LANES>();
        let (im, _) = self.matrix.im.as_chunks::<LANES>();
        let chunks = re.len() / (rows * columns).max(1);
        let (from_re, _) = self.from.re.as_chunks::<LANES>();
        let (from_im, _) = self.from.im.as_chunks::<LANES>();
        let (to_re, _) = self.to.re.as_chunks_mut::<LANES>();
        let (to_im, _) = self.to.im.as_chunks_mut::<LANES>();
        for chunk in 0..chunks {
            for row in 0..rows {
                let (x, y) = (
                    &from_re[row * chunks + chunk],
                    &from_im[row * chunks + chunk],
                );
                for column in 0..columns {
                    let place = (chunk * rows + row) * columns + column;
                    let (a, b) = (&re[place], &im[place]);
                    let to_re = &mut to_re[column * chunks + chunk];
                    let to_im = &mut to_im[column * chunks + chunk];
                    for lane in 0..LANES {
                        to_re[lane] += a[lane] * x[lane] - b[lane] * y[lane];
                        to_im[lane] += a[lane] * y[lane] + b[lane] * x[lane];
                    }
                }
            }
        }
    }
}

struct Inverted<'a>(&'a mut WaveMatrix);

impl Loops for Inverted<'_> {
    type Output = ();

    /// Gauss-Jordan elimination in place.
    #[inline(always)]
    fn call(self) {
        let n = self.0.rows;
        let re = self.0.re.as_chunks_mut::<LANES>().0.chunks_exact_mut(n * n);
        let im = self.0.im.as_chunks_mut::<LANES>().0.chunks_exact_mut(n * n);
        for (re, im) in re.zip(im) {
            for pivot in 0..n {
                let own = pivot * n;
                let (a, b) = (re[own + pivot], im[own + pivot]);
                let (mut p, mut q) = ([0.0; LANES], [0.0; LANES]);
                for lane in 0..LANES {
                    let square = a[lane] * a[lane] + b[lane] * b[lane];
                    // Padding has no wave.
                    let inverse = if square > 0.0 { 1.0 / square } else { 0.0 };
                    p[lane] = a[lane] * inverse;
                    q[lane] = -b[lane] * inverse;
                }
                (re[own + pivot], im[own + pivot]) = ([1.0; LANES], [0.0; LANES]);
                for column in 0..n {
                    let (x, y) = (&mut re[own + column], &mut im[own + column]);
                    for lane in 0..LANES {
                        let (u, v) = (x[lane], y[lane]);
                        x[lane] = u * p[lane] - v * q[lane];
                        y[lane] = u * q[lane] + v * p[lane];
                    }
                }
                for row in (0..n).filter(|&row| row != pivot) {
                    let (f, g) = (re[row * n + pivot], im[row * n + pivot]);
                    (re[row * n + pivot], im[row * n + pivot]) = ([0.0; LANES], [0.0; LANES]);
                    for column in 0..n {
                        let (x, y) = (re[own + column], im[own + column]);
                        let to_re = &mut re[row * n + column];
                        let to_im = &mut im[row * n + column];
                        for lane in 0..LANES {
                            to_re[lane] -= f[lane] * x[lane] - g[lane] * y[lane];
                            to_im[lane] -= f[lane] * y[lane] + g[lane] * x[lane];
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::LuWorkspace;

    fn number(place: usize) -> Complex64 {
        let turn = 0.3 + 1.7 * place as f64 + 0.01 * (place * place) as f64;
        Complex64::new(turn.sin(), (1.3 * turn).cos())
    }

    #[test]
    fn waves_are_those_of_the_sums_and_return_to_the_sectors() {
        for sectors in [1, 2, 7, 8, 13, 24] {
            let stride = padded(sectors);
            let transform = SectorTransform::new(sectors);
            let mut field = Field::zeros(3, sectors);
            for place in 0..3 * stride {
                if place % stride < sectors {
                    field.set(place, number(place));
                }
            }
            let mut waves = Field::zeros(3, sectors);
            transform.to_waves(&field, &mut waves);
            for channel in 0..3 {
                for h in 0..stride {
                    let turned = |n| field.at(channel * stride + n) * phase(h, n, sectors).conj();
                    let sum: Complex64 = if h < sectors {
                        (0..sectors).map(turned).sum::<Complex64>() / (sectors as f64).sqrt()
                    } else {
                        Complex64::default()
                    };
                    assert!((sum - waves.at(channel * stride + h)).norm() < 1e-13);
                }
            }
            let mut back = Field::zeros(3, sectors);
            transform.to_sectors(&waves, &mut back);
            for place in 0..3 * stride {
                assert!(
                    (back.at(place) - field.at(place)).norm() < 1e-13,
                    "{sectors}"
                );
            }
        }
    }

    #[test]
    fn products_and_inverses_are_those_of_every_wave() {
        let (sectors, n) = (11, 4);
        let stride = padded(sectors);
        let mut matrix = WaveMatrix::zeros(n, n, sectors);
        let entry = |h: usize, i: usize, j: usize| {
            number(100 * h + 10 * i + j) + if i == j { 3.0 } else { 0.0 }
        };
        let mut field = Field::zeros(n, sectors);
        for h in 0..sectors {
            for i in 0..n {
                field.set(i * stride + h, number(1000 + 10 * h + i));
                for j in 0..n {
                    matrix.set(h, i, j, entry(h, i, j));
                }
            }
        }
        let mut part = Field::zeros(2, sectors);
        let mut of_part = Field::zeros(3, sectors);
        part.re.copy_from_slice(&field.re[stride..3 * stride]);
        part.im.copy_from_slice(&field.im[stride..3 * stride]);
        matrix.add_product(1..4, 1..3, -2.0, &part, &mut of_part);
        let mut inverse = matrix.clone();
        inverse.invert();
        for h in 0..sectors {
            for i in 1..4 {
                let sum: Complex64 = (1..3)
                    .map(|j| -2.0 * entry(h, i, j) * field.at(j * stride + h))
                    .sum();
                assert!((sum - of_part.at((i - 1) * stride + h)).norm() < 1e-12);
            }
            let mut lu = LuWorkspace::<Complex64>::new(n);
            for j in 0..n {
                for i in 0..n {
                    lu.matrix_mut()[j * n + i] = entry(h, i, j);
                }
            }
            assert!(lu.factor());
            for j in 0..n {
                let mut column = vec![Complex64::default(); n];
                column[j] = Complex64::from(1.0);
                lu.solve(&mut column);
                for (i, own) in column.iter().enumerate() {
                    assert!((own - inverse.at(h, i, j)).norm() < 1e-12);
                }
            }
        }
    }
}
