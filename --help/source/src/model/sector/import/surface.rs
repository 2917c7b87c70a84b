//! Area and normal that each node of a surface stands for.
//!
//! A face's area is shared out in proportion to `int N_a^2 dA`, the diagonal of its consistent mass
//! (Hinton, Rock and Zienkiewicz 1976): unlike `int N_a dA` this is positive at every node of a
//! quadratic face, as weights of contact pairs must be.

use std::collections::BTreeMap;

/// What a node stands for: area, m^2, and the area-weighted normal, m^2.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct NodalArea {
    pub area_m2: f64,
    pub normal_m2: [f64; 3],
}

impl NodalArea {
    /// A node whose normal is given, and whose area is not known.
    pub fn of_node(normal_m2: [f64; 3]) -> Self {
        Self {
            area_m2: 1.0,
            normal_m2,
        }
    }

    /// Adds the share of other faces.
    pub fn add(&mut self, other: Self) {
        self.area_m2 += other.area_m2;
        for (total, part) in self.normal_m2.iter_mut().zip(other.normal_m2) {
            *total += part;
        }
    }

    /// What faces it.
    pub fn facing(&self) -> Self {
        Self {
            normal_m2: self.normal_m2.map(|part| -part),
            ..*self
        }
    }
}

/// Abscissae and weights of the three-point Gauss rule on [-1, 1].
const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

/// Points `(L1, L2)` and weights of the six-point rule of degree 4 on a triangle of area 1/2
/// (Strang and Fix 1973).
const TRIANGLE: [([f64; 2], f64); 6] = {
    const A: f64 = 0.445_948_490_915_964_9;
    const B: f64 = 0.091_576_213_509_770_74;
    const WA: f64 = 0.111_690_794_839_005_74;
    const WB: f64 = 0.054_975_871_827_660_93;
    [
        ([A, A], WA),
        ([A, 1.0 - 2.0 * A], WA),
        ([1.0 - 2.0 * A, A], WA),
        ([B, B], WB),
        ([B, 1.0 - 2.0 * B], WB),
        ([1.0 - 2.0 * B, B], WB),
    ]
};

/// Adds the areas and normals of a face to those of its nodes. `positions`: corners in turn, then the
/// midside nodes between them; `inside`: a point on the side of the element, so that normals point away.
pub(super) fn add_face(
    areas: &mut BTreeMap<usize, NodalArea>,
    nodes: &[usize],
    positions: &[[f64; 3]],
    inside: [f64; 3],
) {
    let count = positions.len();
    let mut share = vec![0.0; count];
    let mut normal = vec![[0.0; 3]; count];
    let mut area = 0.0;
    let mut outward = 0.0;
    for (point, weight) in rule(count) {
        let FacePoint {
            value,
            position,
            along,
        } = FacePoint::of(positions, point);
        let cross = cross(along[0], along[1]);
        let jacobian = cross.iter().map(|c| c * c).sum::<f64>().sqrt();
        area += weight * jacobian;
        outward += weight
            * (0..3)
                .map(|i| cross[i] * (position[i] - inside[i]))
                .sum::<f64>();
        for a in 0..count {
            share[a] += weight * value[a] * value[a] * jacobian;
            for (total, part) in normal[a].iter_mut().zip(cross) {
                *total += weight * value[a] * value[a] * part;
            }
        }
    }
    let total: f64 = share.iter().sum();
    if total <= 0.0 {
        return;
    }
    let sign = if outward < 0.0 { -1.0 } else { 1.0 };
    for (a, &node) in nodes.iter().enumerate() {
        let nodal = areas.entry(node).or_default();
        nodal.area_m2 += area * share[a] / total;
        for (sum, part) in nodal.normal_m2.iter_mut().zip(normal[a]) {
            *sum += sign * area * part / total;
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Points and weights for a face of `count` nodes: 3 and 6 triangles, 4 and 8 quadrilaterals.
fn rule(count: usize) -> Vec<([f64; 2], f64)> {
    if count.is_multiple_of(3) {
        return TRIANGLE.to_vec();
    }
    let mut points = Vec::with_capacity(9);
    for (xi, a) in GAUSS {
        for (eta, b) in GAUSS {
            points.push(([xi, eta], a * b));
        }
    }
    points
}

/// Corners of the reference quadrilateral.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// A point of a face.
pub(super) struct FacePoint {
    /// Values of the shape functions.
    pub value: Vec<f64>,
    /// Position, in the unit of the nodes.
    pub position: [f64; 3],
    /// Derivatives of the position by the natural coordinates.
    pub along: [[f64; 3]; 2],
}

impl FacePoint {
    /// The point at the natural coordinates `point` of the face with nodes at `positions`.
    pub(super) fn of(positions: &[[f64; 3]], point: [f64; 2]) -> Self {
        let (value, slope) = shape_functions(positions.len(), point);
        let mut position = [0.0; 3];
        let mut along = [[0.0; 3]; 2];
        for ((node, value), slope) in positions.iter().zip(&value).zip(&slope) {
            for i in 0..3 {
                position[i] += value * node[i];
                along[0][i] += slope[0] * node[i];
                along[1][i] += slope[1] * node[i];
            }
        }
        Self {
            value,
            position,
            along,
        }
    }
}

/// Shape functions of a face and their derivatives.
fn shape_functions(count: usize, [x, y]: [f64; 2]) -> (Vec<f64>, Vec<[f64; 2]>) {
    let mut value = Vec::with_capacity(count);
    let mut slope = Vec::with_capacity(count);
    if count.is_multiple_of(3) {
        // Area coordinates; the third is 1 - x - y. Corner i: L_i (2 L_i - 1); midside of i and j: 4 L_i L_j.
        let l = [x, y, 1.0 - x - y];
        let d = [[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]];
        for i in 0..3 {
            let (v, factor) = if count == 3 {
                (l[i], 1.0)
            } else {
                (l[i] * (2.0 * l[i] - 1.0), 4.0 * l[i] - 1.0)
            };
            value.push(v);
            slope.push(d[i].map(|s| factor * s));
        }
        for i in 0..count - 3 {
            let j = (i + 1) % 3;
            value.push(4.0 * l[i] * l[j]);
            slope.push([0, 1].map(|k| 4.0 * (d[i][k] * l[j] + l[i] * d[j][k])));
        }
        return (value, slope);
    }
    // Bilinear, and serendipity of 8 nodes: corners (1 + a x)(1 + b y)(a x + b y - 1) / 4, midsides
    // (1 - x^2)(1 + b y) / 2 and (1 + a x)(1 - y^2) / 2.
    for [a, b] in CORNERS {
        let (p, q) = (1.0 + a * x, 1.0 + b * y);
        if count == 4 {
            value.push(0.25 * p * q);
            slope.push([0.25 * a * q, 0.25 * b * p]);
        } else {
            let r = a * x + b * y - 1.0;
            value.push(0.25 * p * q * r);
            slope.push([0.25 * a * q * (r + p), 0.25 * b * p * (r + q)]);
        }
    }
    for i in 0..count - 4 {
        let (first, second) = (CORNERS[i], CORNERS[(i + 1) % 4]);
        let [a, b] = [0, 1].map(|k| 0.5 * (first[k] + second[k]));
        if a == 0.0 {
            let q = 1.0 + b * y;
            value.push(0.5 * (1.0 - x * x) * q);
            slope.push([-x * q, 0.5 * (1.0 - x * x) * b]);
        } else {
            let p = 1.0 + a * x;
            value.push(0.5 * p * (1.0 - y * y));
            slope.push([0.5 * a * (1.0 - y * y), -y * p]);
        }
    }
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face of a plane: its area, a unit normal, and shares that sum to it.
    fn areas(positions: &[[f64; 3]], inside: [f64; 3]) -> Vec<NodalArea> {
        let nodes: Vec<usize> = (0..positions.len()).collect();
        let mut areas = BTreeMap::new();
        add_face(&mut areas, &nodes, positions, inside);
        areas.into_values().collect()
    }

    #[test]
    fn plane_faces_share_their_area_and_point_away_from_the_element() {
        let corners = [
            [0.0, 0.0, 1.0],
            [2.0, 0.0, 1.0],
            [2.0, 3.0, 1.0],
            [0.0, 3.0, 1.0],
        ];
        let middle =
            |i: usize, j: usize, p: &[[f64; 3]]| [0, 1, 2].map(|k| 0.5 * (p[i][k] + p[j][k]));
        let quadratic: Vec<[f64; 3]> = corners
            .iter()
            .copied()
            .chain((0..4).map(|i| middle(i, (i + 1) % 4, &corners)))
            .collect();
        let triangle: Vec<[f64; 3]> = corners[..3]
            .iter()
            .copied()
            .chain((0..3).map(|i| middle(i, (i + 1) % 3, &corners)))
            .collect();
        for (positions, area) in [
            (corners.to_vec(), 6.0),
            (quadratic, 6.0),
            (corners[..3].to_vec(), 3.0),
            (triangle, 3.0),
        ] {
            for (inside, z) in [([1.0, 1.0, 0.0], 1.0), ([1.0, 1.0, 2.0], -1.0)] {
                let shares = areas(&positions, inside);
                let sum: f64 = shares.iter().map(|share| share.area_m2).sum();
                assert!((sum - area).abs() < 1e-12, "{sum}");
                for share in shares {
                    assert!(share.area_m2 > 0.0);
                    assert!((share.normal_m2[2] - z * share.area_m2).abs() < 1e-12);
                    assert!(share.normal_m2[0].abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_serendipity_rectangle_gives_3_to_its_corners_and_16_to_its_midsides_of_76() {
        let corners = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let midsides = [
            [0.5, 0.0, 0.0],
            [1.0, 0.5, 0.0],
            [0.5, 1.0, 0.0],
            [0.0, 0.5, 0.0],
        ];
        let positions: Vec<[f64; 3]> = corners.into_iter().chain(midsides).collect();
        let shares = areas(&positions, [0.5, 0.5, -1.0]);
        for (a, share) in shares.iter().enumerate() {
            let expected = if a < 4 { 3.0 } else { 16.0 } / 76.0;
            assert!((share.area_m2 - expected).abs() < 1e-14, "{share:?}");
        }
    }

    #[test]
    fn shape_functions_are_one_at_their_node_and_their_slopes_those_of_differences() {
        let places: [&[[f64; 2]]; 2] = [
            &[
                [1.0, 0.0],
                [0.0, 1.0],
                [0.0, 0.0],
                [0.5, 0.5],
                [0.0, 0.5],
                [0.5, 0.0],
            ],
            &[
                [-1.0, -1.0],
                [1.0, -1.0],
                [1.0, 1.0],
                [-1.0, 1.0],
                [0.0, -1.0],
                [1.0, 0.0],
                [0.0, 1.0],
                [-1.0, 0.0],
            ],
        ];
        for (count, places) in [
            (3, places[0]),
            (6, places[0]),
            (4, places[1]),
            (8, places[1]),
        ] {
            for (a, &place) in places.iter().take(count).enumerate() {
                let (value, _) = shape_functions(count, place);
                for (b, &v) in value.iter().enumerate() {
                    assert!(
                        (v - f64::from(u8::from(a == b))).abs() < 1e-14,
                        "{count}: {a} {b}"
                    );
                }
            }
            let point = [0.21, 0.37];
            let (_, slope) = shape_functions(count, point);
            for k in 0..2 {
                let (mut above, mut below) = (point, point);
                above[k] += 1e-6;
                below[k] -= 1e-6;
                let (above, below) = (
                    shape_functions(count, above).0,
                    shape_functions(count, below).0,
                );
                for a in 0..count {
                    let difference = (above[a] - below[a]) / 2e-6;
                    assert!((difference - slope[a][k]).abs() < 1e-9, "{count}: {a} {k}");
                }
            }
        }
    }
}
