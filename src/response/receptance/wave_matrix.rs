//! A small matrix for every wave, and what it does to fields.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::fields::{Field, LANES, padded};
use crate::linalg::{Complex64, Loops, vectorized};

type Lanes = [f64; LANES];

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
        let chunk_length = self.rows * self.columns * LANES;
        for chunk in self.re.chunks_exact_mut(chunk_length) {
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

    /// The factors of every wave, without pivoting.
    pub(super) fn factorised(mut self) -> WaveFactors {
        vectorized(Factorised(&mut self));
        WaveFactors(self)
    }
}

/// `A = L U` of every wave: L without its diagonal, which is 1, beside U with the inverse of its diagonal.
#[derive(Debug, Default)]
pub(super) struct WaveFactors(WaveMatrix);

impl WaveFactors {
    /// `A^-1 x` in the place of x.
    pub(super) fn solve(&self, field: &mut Field) {
        self.solve_by(false, field);
    }

    /// `A^-T x` in the place of x.
    pub(super) fn solve_transposed(&self, field: &mut Field) {
        self.solve_by(true, field);
    }

    fn solve_by(&self, transposed: bool, field: &mut Field) {
        vectorized(Solved {
            factors: &self.0,
            transposed,
            field,
        });
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

struct Factorised<'a>(&'a mut WaveMatrix);

impl Loops for Factorised<'_> {
    type Output = ();

    /// Doolittle's elimination in place, row by row.
    #[inline(always)]
    fn call(self) {
        let n = self.0.rows;
        let re = self.0.re.as_chunks_mut::<LANES>().0.chunks_exact_mut(n * n);
        let im = self.0.im.as_chunks_mut::<LANES>().0.chunks_exact_mut(n * n);
        for (re, im) in re.zip(im) {
            for row in 0..n {
                for column in 0..n {
                    let place = row * n + column;
                    let (mut x, mut y) = (re[place], im[place]);
                    for k in 0..row.min(column) {
                        let (a, b) = (&re[row * n + k], &im[row * n + k]);
                        let (c, d) = (&re[k * n + column], &im[k * n + column]);
                        for lane in 0..LANES {
                            x[lane] -= a[lane] * c[lane] - b[lane] * d[lane];
                            y[lane] -= a[lane] * d[lane] + b[lane] * c[lane];
                        }
                    }
                    if column < row {
                        let pivot = column * n + column;
                        multiply((&mut x, &mut y), (&re[pivot], &im[pivot]));
                    } else if column == row {
                        for lane in 0..LANES {
                            let square = x[lane] * x[lane] + y[lane] * y[lane];
                            // Padding has no wave.
                            let inverse = if square > 0.0 { 1.0 / square } else { 0.0 };
                            x[lane] *= inverse;
                            y[lane] *= -inverse;
                        }
                    }
                    (re[place], im[place]) = (x, y);
                }
            }
        }
    }
}

struct Solved<'a> {
    factors: &'a WaveMatrix,
    transposed: bool,
    field: &'a mut Field,
}

impl Loops for Solved<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.factors.rows;
        let re = self.factors.re.as_chunks::<LANES>().0.chunks_exact(n * n);
        let im = self.factors.im.as_chunks::<LANES>().0.chunks_exact(n * n);
        let (x, _) = self.field.re.as_chunks_mut::<LANES>();
        let (y, _) = self.field.im.as_chunks_mut::<LANES>();
        let chunks = x.len() / n.max(1);
        let at = |row: usize, column: usize| {
            if self.transposed {
                column * n + row
            } else {
                row * n + column
            }
        };
        for (chunk, (re, im)) in re.zip(im).enumerate() {
            for way in 0..2 * n {
                let is_first = way < n;
                let row = if is_first { way } else { 2 * n - 1 - way };
                let known = if is_first { 0..row } else { row + 1..n };
                let (mut p, mut q) = (x[row * chunks + chunk], y[row * chunks + chunk]);
                for column in known {
                    let (a, b) = (&re[at(row, column)], &im[at(row, column)]);
                    let (c, d) = (&x[column * chunks + chunk], &y[column * chunks + chunk]);
                    for lane in 0..LANES {
                        p[lane] -= a[lane] * c[lane] - b[lane] * d[lane];
                        q[lane] -= a[lane] * d[lane] + b[lane] * c[lane];
                    }
                }
                if is_first == self.transposed {
                    let pivot = row * n + row;
                    multiply((&mut p, &mut q), (&re[pivot], &im[pivot]));
                }
                (x[row * chunks + chunk], y[row * chunks + chunk]) = (p, q);
            }
        }
    }
}

#[inline(always)]
fn multiply((x, y): (&mut Lanes, &mut Lanes), (a, b): (&Lanes, &Lanes)) {
    for lane in 0..LANES {
        let (u, v) = (x[lane], y[lane]);
        x[lane] = u * a[lane] - v * b[lane];
        y[lane] = u * b[lane] + v * a[lane];
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
    fn products_and_solutions_are_those_of_every_wave() {
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
        let factors = matrix.clone().factorised();
        let (mut solved, mut solved_transposed) = (field.clone(), field.clone());
        factors.solve(&mut solved);
        factors.solve_transposed(&mut solved_transposed);
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
            let right: Vec<Complex64> = (0..n).map(|i| field.at(i * stride + h)).collect();
            let mut of_wave = right.clone();
            lu.solve(&mut of_wave);
            for (i, value) in of_wave.iter().enumerate() {
                assert!((value - solved.at(i * stride + h)).norm() < 1e-12);
                let turned = |j: usize| solved_transposed.at(j * stride + h) * entry(h, j, i);
                let back: Complex64 = (0..n).map(turned).sum();
                assert!((back - right[i]).norm() < 1e-12);
            }
        }
    }
}
