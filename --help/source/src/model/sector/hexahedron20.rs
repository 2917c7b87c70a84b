//! The 20-node serendipity brick: stiffness and consistent mass of an isotropic linear elastic solid.

use super::error::ModelError;

/// Isotropic linear elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio, below 0.5.
    pub poisson_ratio: f64,
    /// Density, kg/m^3.
    pub density_kg_per_m3: f64,
}

/// Stiffness and mass of one element in Cartesian components.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementMatrices {
    /// Stiffness blocks, N/m: `stiffness[a][b][i][j]` couples direction `i` of node `a` to `j` of `b`.
    pub stiffness: Vec<[Block; NODES]>,
    /// Mass factors, kg: the mass block of nodes `a` and `b` is `mass[a][b]` times the identity.
    pub mass: [[f64; NODES]; NODES],
}

/// Nodes of the element.
pub const NODES: usize = 20;

/// The 3 x 3 block of a pair of nodes.
pub type Block = [[f64; 3]; 3];

/// Natural coordinates (xi, eta, zeta) of the nodes in the order of `CalculiX` and Abaqus `C3D20`:
/// eight corners, the edges of the lower face, those of the upper face, the upright edges.
pub const NATURAL_COORDINATES: [[f64; 3]; NODES] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Abscissae and weights of the three-point Gauss rule on [-1, 1]: 0 and +-sqrt(3/5), 8/9 and 5/9.
const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

/// Shape functions at a natural point and their derivatives by (xi, eta, zeta).
///
/// Corner: `N = (1 + xi xi_a)(1 + eta eta_a)(1 + zeta zeta_a)(xi xi_a + eta eta_a + zeta zeta_a - 2) / 8`;
/// edge along xi: `N = (1 - xi^2)(1 + eta eta_a)(1 + zeta zeta_a) / 4`, and likewise along eta, zeta.
fn shape_functions(point: [f64; 3]) -> ([f64; NODES], [[f64; 3]; NODES]) {
    let mut value = [0.0; NODES];
    let mut derivative = [[0.0; 3]; NODES];
    for (a, node) in NATURAL_COORDINATES.iter().enumerate() {
        let along = (0..3).find(|&i| node[i] == 0.0);
        // One factor per direction, and its derivative.
        let mut factor = [0.0; 3];
        let mut slope = [0.0; 3];
        for i in 0..3 {
            if along == Some(i) {
                factor[i] = 1.0 - point[i] * point[i];
                slope[i] = -2.0 * point[i];
            } else {
                factor[i] = 1.0 + point[i] * node[i];
                slope[i] = node[i];
            }
        }
        let product = factor[0] * factor[1] * factor[2];
        let (scale, sum) = match along {
            Some(_) => (0.25, 1.0),
            None => (0.125, (0..3).map(|i| point[i] * node[i]).sum::<f64>() - 2.0),
        };
        value[a] = scale * product * sum;
        for i in 0..3 {
            let product_slope = slope[i] * factor[(i + 1) % 3] * factor[(i + 2) % 3];
            let sum_slope = if along.is_some() { 0.0 } else { node[i] };
            derivative[a][i] = scale * (product_slope * sum + product * sum_slope);
        }
    }
    (value, derivative)
}

/// Determinant and inverse of a 3 x 3 matrix; the inverse is meaningless where the determinant is 0.
fn determinant_and_inverse(a: Block) -> (f64, Block) {
    let mut cofactor = [[0.0; 3]; 3];
    for (i, row) in cofactor.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            *entry = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
    }
    let determinant = (0..3).map(|j| a[0][j] * cofactor[0][j]).sum::<f64>();
    let mut inverse = [[0.0; 3]; 3];
    for (i, row) in inverse.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = cofactor[j][i] / determinant;
        }
    }
    (determinant, inverse)
}

/// Stiffness and consistent mass of the element `index` whose nodes lie at `nodes` (m, Cartesian).
///
/// `K_ab = int lambda grad N_a (x) grad N_b + mu grad N_b (x) grad N_a + mu (grad N_a . grad N_b) I dV`,
/// `M_ab = int rho N_a N_b dV`, both by 3 x 3 x 3 Gauss points.
///
/// # Errors
/// [`ModelError::ElementInverted`] if the Jacobian is not positive at an integration point.
pub fn matrices(
    index: usize,
    nodes: &[[f64; 3]; NODES],
    material: &Material,
) -> Result<ElementMatrices, ModelError> {
    let lambda = material.youngs_modulus_pa * material.poisson_ratio
        / ((1.0 + material.poisson_ratio) * (1.0 - 2.0 * material.poisson_ratio));
    let mu = material.youngs_modulus_pa / (2.0 * (1.0 + material.poisson_ratio));
    let mut stiffness = vec![[[[0.0; 3]; 3]; NODES]; NODES];
    let mut mass = [[0.0; NODES]; NODES];
    for point in 0..27 {
        let rule = [GAUSS[point % 3], GAUSS[point / 3 % 3], GAUSS[point / 9]];
        let (value, natural) = shape_functions(rule.map(|(abscissa, _)| abscissa));
        let (determinant, gradient) = global_gradient(&natural, nodes);
        // Written so that a NaN is refused too.
        if determinant.is_nan() || determinant <= 0.0 {
            return Err(ModelError::ElementInverted {
                element: index,
                point,
                determinant,
            });
        }
        let volume = determinant * rule.iter().map(|&(_, weight)| weight).product::<f64>();
        for a in 0..NODES {
            for b in 0..NODES {
                mass[a][b] += material.density_kg_per_m3 * volume * value[a] * value[b];
                let dot = (0..3).map(|i| gradient[a][i] * gradient[b][i]).sum::<f64>();
                for i in 0..3 {
                    for j in 0..3 {
                        stiffness[a][b][i][j] += volume
                            * (lambda * gradient[a][i] * gradient[b][j]
                                + mu * gradient[a][j] * gradient[b][i]);
                    }
                    stiffness[a][b][i][i] += volume * mu * dot;
                }
            }
        }
    }
    Ok(ElementMatrices { stiffness, mass })
}

/// Determinant of the Jacobian and the gradients of the shape functions by (x, y, z), 1/m.
fn global_gradient(
    natural: &[[f64; 3]; NODES],
    nodes: &[[f64; 3]; NODES],
) -> (f64, [[f64; 3]; NODES]) {
    // jacobian[i][j] = d x_j / d xi_i, so that d N / d x = jacobian^-1 d N / d xi.
    let mut jacobian = [[0.0; 3]; 3];
    for (slope, position) in natural.iter().zip(nodes) {
        for i in 0..3 {
            for j in 0..3 {
                jacobian[i][j] += slope[i] * position[j];
            }
        }
    }
    let (determinant, inverse) = determinant_and_inverse(jacobian);
    let gradient = natural.map(|slope| inverse.map(|row| (0..3).map(|i| row[i] * slope[i]).sum()));
    (determinant, gradient)
}

#[cfg(test)]
mod tests {
    use super::{NATURAL_COORDINATES, NODES, shape_functions};

    #[test]
    fn shape_functions_are_one_at_their_node_and_nought_at_the_others() {
        for (a, &node) in NATURAL_COORDINATES.iter().enumerate() {
            let (value, derivative) = shape_functions(node);
            for (b, &at) in value.iter().enumerate() {
                assert!(
                    (at - f64::from(u8::from(a == b))).abs() < 1e-15,
                    "N_{b} at node {a}: {at}"
                );
            }
            for i in 0..3 {
                let sum: f64 = derivative.iter().map(|slope| slope[i]).sum();
                assert!(sum.abs() < 1e-14, "the gradients at node {a} sum to {sum}");
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let point = [0.31, -0.57, 0.83];
        let (_, derivative) = shape_functions(point);
        for i in 0..3 {
            let step = 1e-6;
            let (mut above, mut below) = (point, point);
            above[i] += step;
            below[i] -= step;
            let (above, below) = (shape_functions(above).0, shape_functions(below).0);
            for a in 0..NODES {
                let difference = (above[a] - below[a]) / (2.0 * step);
                assert!(
                    (difference - derivative[a][i]).abs() < 1e-9,
                    "node {a}, direction {i}"
                );
            }
        }
    }
}
