//! Generalised minimal residuals (Saad & Schultz 1986, SIAM J. Sci. Stat. Comput. 7(3)).

use super::{Columns, Orthogonalised, Subtracted, dot, vectorized};

/// Share of a vector below which what is left of it beside the basis is made orthogonal once more: so much of its digits is lost.
const LITTLE: f64 = 0.1;

/// What [`gmres`] found.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimised {
    /// The solution.
    pub x: Vec<f64>,
    /// Products with the matrix.
    pub products: usize,
    /// Norm of the residual over that of the right-hand side.
    pub residual: f64,
}

/// `x` with `A x` near `right`, until the residual is `enough` of `right` or `most` products are spent.
pub fn gmres(
    right: &[f64],
    enough: f64,
    most: usize,
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
) -> Minimised {
    let size = dot(right, right).sqrt();
    if size == 0.0 || !size.is_finite() {
        return Minimised {
            x: vec![0.0; right.len()],
            products: 0,
            residual: 0.0,
        };
    }
    let length = right.len();
    // Orthonormal columns, one after the other.
    let mut basis: Vec<f64> = right.iter().map(|b| b / size).collect();
    // Columns of the triangle, and the rotations that made them.
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut left = vec![size];
    while triangle.len() < most {
        let mut vector = product(&basis[triangle.len() * length..]);
        let mut column = vec![0.0; triangle.len() + 1];
        let mut norm = dot(&vector, &vector).sqrt();
        for _ in 0..2 {
            vectorized(Orthogonalised {
                columns: Columns::of(&basis, length),
                shares: &mut column,
                vector: &mut vector,
            });
            let whole = std::mem::replace(&mut norm, dot(&vector, &vector).sqrt());
            if norm > LITTLE * whole {
                break;
            }
        }
        for (at, (cosine, sine)) in rotations.iter().enumerate() {
            let (a, b) = (column[at], column[at + 1]);
            column[at] = cosine * a + sine * b;
            column[at + 1] = cosine * b - sine * a;
        }
        let last = column.len() - 1;
        let turned = column[last].hypot(norm);
        if turned == 0.0 || !turned.is_finite() {
            break;
        }
        let (cosine, sine) = (column[last] / turned, norm / turned);
        column[last] = turned;
        rotations.push((cosine, sine));
        triangle.push(column);
        let rest = left[last];
        left[last] = cosine * rest;
        left.push(-sine * rest);
        if (sine * rest).abs() <= enough * size || norm == 0.0 {
            break;
        }
        basis.extend(vector.iter().map(|v| v / norm));
    }
    let count = triangle.len();
    let mut shares = left[..count].to_vec();
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|j| triangle[j][row] * shares[j]).sum();
        shares[row] = (shares[row] - known) / triangle[row][row];
    }
    for share in &mut shares {
        *share = -*share;
    }
    let mut x = vec![0.0; length];
    vectorized(Subtracted {
        columns: Columns::of(&basis, length),
        shares: &shares,
        from: &mut x,
    });
    Minimised {
        x,
        products: count,
        residual: left[count].abs() / size,
    }
}

#[cfg(test)]
mod tests {
    use super::gmres;

    #[test]
    fn a_small_system_is_solved() {
        let a = [[4.0, 1.0, 0.5], [-2.0, 5.0, 0.25], [1.0, 2.0, 6.0]];
        let product = |x: &[f64]| -> Vec<f64> {
            let row = |row: &[f64; 3]| row.iter().zip(x).map(|(a, x)| a * x).sum();
            a.iter().map(row).collect()
        };
        let right: [f64; 3] = [1.0, 2.0, 3.0];
        let (size, most) = (14_f64.sqrt(), 1e-3);
        for products in [1, 2, 3] {
            let found = gmres(&right, most, products, product);
            let back = product(&found.x);
            let squares = right.iter().zip(&back).map(|(b, own)| (b - own).powi(2));
            let left = squares.sum::<f64>().sqrt() / size;
            assert!((left - found.residual).abs() < 1e-12, "{found:?}: {left}");
            assert_eq!(found.products, products);
        }
        assert!(gmres(&right, most, 120, product).residual < most);
    }
}
