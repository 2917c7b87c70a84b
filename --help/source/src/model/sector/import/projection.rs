//! A ring whose contact nodes do not match the blisk's: its surface moves as the blisk's nodes would have it.
//!
//! Each contact node j of the ring is projected on the nearest face of the blisk's surface, with the
//! weights `N_a` of the face's nodes there. At every node a of that surface the ring gets a node of its
//! own, and `u_j = sum_a N_a(x_j) u_a` takes the place of the ring's node: `K' = T^T K T`, `M' = T^T M T`. The
//! contact is then one of facing nodes. The ring's surface keeps the motions that the blisk's faces can
//! follow, so its mesh should be as fine as the blisk's, or finer.

use std::collections::{BTreeMap, BTreeSet};

use super::contact_tables::Contact;
use super::cyclic_faces::{FacePairs, distance};
use super::cylindrical::Node;
use super::import_file::ImportFile;
use super::matrices::Matrices;
use super::problem::{ImportProblem, body_name};
use super::run::{Run, round_up};
use super::side::Surface;
use super::source::refuse;
use super::surface::FacePoint;
use crate::linalg::{Matrix, SymmetricSparse, hermitian_eigen};
use crate::model::sector::error::ModelError;
use crate::model::sector::sector_model::Body;

/// Least eigenvalue of `W^T W`, over the largest, for which the ring's nodes determine the new ones.
const LEAST_EIGENVALUE: f64 = 1e-6;
/// Weights below this are rounding of a node that lies on an edge.
const LEAST_WEIGHT: f64 = 1e-9;

/// What a projection did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Projected {
    /// Nodes of the ring that follow new ones.
    pub nodes: usize,
    /// Nodes of the ring's surface that are too far from the blisk's.
    pub left_out: usize,
    /// Largest distance between a node and the blisk's surface, m.
    pub worst_distance_m: f64,
    /// Added to the number of a blisk node for the ring's node there.
    pub offset: usize,
}

/// A face of the blisk's surface.
struct Face {
    nodes: Vec<usize>,
    positions: Vec<[f64; 3]>,
}

/// Replaces the ring's contact nodes in `nodes`, `matrices` (those of the ring's run) and `faces`.
pub(super) fn project(
    file: &ImportFile,
    (contact, ring_surface): (&Contact, &Surface),
    runs: &[Run],
    tolerance_m: f64,
    nodes: &mut BTreeMap<usize, Node>,
    matrices: &mut Matrices,
    faces: &mut BTreeMap<&'static str, FacePairs>,
) -> Result<Projected, ModelError> {
    let surface = blisk_faces(contact, runs, nodes)?;
    let run = Run::of(runs, Body::Ring);
    let ring_nodes = run.set(&ring_surface.set);
    let count = ring_nodes.len();
    let ring_nodes = ring_nodes.into_iter().map(|node| node + run.offset);
    let weights = ring_weights(
        file,
        contact,
        ring_nodes,
        tolerance_m,
        nodes,
        matrices,
        &surface,
    )?;
    let followed: BTreeSet<usize> = weights
        .values()
        .flat_map(|(list, _)| list.keys().copied())
        .collect();
    require_rank(file, &weights, &followed)?;
    let offset = nodes.keys().next_back().map_or(1, |&last| round_up(last));
    for &node in &followed {
        let position_m = nodes[&node].position_m;
        nodes.insert(
            node + offset,
            Node {
                position_m,
                body: Body::Ring,
            },
        );
    }
    condense(matrices, &weights, &followed, offset);
    let low_high: BTreeMap<usize, usize> = faces[body_name(Body::Blisk)]
        .pairs
        .iter()
        .copied()
        .collect();
    if let Some(ring) = faces.get_mut(body_name(Body::Ring)) {
        ring.pairs
            .retain(|(low, high)| !weights.contains_key(low) && !weights.contains_key(high));
        for (low, high) in low_high {
            match (followed.contains(&low), followed.contains(&high)) {
                (true, true) => ring.pairs.push((low + offset, high + offset)),
                (false, false) => {}
                _ => {
                    return Err(refuse(
                        &file.path,
                        ImportProblem::FaceComponents { low, high },
                    ));
                }
            }
        }
    }
    Ok(Projected {
        nodes: weights.len(),
        left_out: count - weights.len(),
        worst_distance_m: weights
            .values()
            .fold(0.0, |worst, (_, distance)| worst.max(*distance)),
        offset,
    })
}

fn blisk_faces(
    contact: &Contact,
    runs: &[Run],
    nodes: &BTreeMap<usize, Node>,
) -> Result<Vec<Face>, ModelError> {
    let run = &runs[0];
    let name = contact.first.set.clone();
    let faces = run.mesh.faces_of(&name).unwrap_or_default();
    if faces.is_empty() {
        let problem = ImportProblem::NoFaces {
            body: Body::Blisk,
            name,
            normal: String::new(),
        };
        return Err(refuse(&run.mesh_path, problem));
    }
    let face = |(element, face)| {
        let numbers: Vec<usize> = run
            .mesh
            .face_nodes(element, face)
            .iter()
            .map(|node| node + run.offset)
            .collect();
        Face {
            positions: numbers.iter().map(|node| nodes[node].position_m).collect(),
            nodes: numbers,
        }
    };
    Ok(faces.into_iter().map(face).collect())
}

/// Weights of the blisk's nodes for each ring node, and its distance from the surface, m.
type Weights = BTreeMap<usize, (BTreeMap<usize, f64>, f64)>;

fn ring_weights(
    file: &ImportFile,
    contact: &Contact,
    ring_nodes: impl Iterator<Item = usize>,
    tolerance_m: f64,
    nodes: &BTreeMap<usize, Node>,
    matrices: &Matrices,
    surface: &[Face],
) -> Result<Weights, ModelError> {
    let free: BTreeSet<usize> = matrices.rows.iter().map(|&(node, _)| node).collect();
    let mut weights = Weights::new();
    let mut nearest_of_all = (0, f64::INFINITY);
    for node in ring_nodes {
        if !free.contains(&node) || nodes[&node].body != Body::Ring {
            continue;
        }
        let position = nodes[&node].position_m;
        let projections = surface.iter().map(|face| {
            let (values, distance) = closest_point(&face.positions, position);
            (face, values, distance)
        });
        let Some((face, values, distance)) = projections.min_by(|a, b| a.2.total_cmp(&b.2)) else {
            continue;
        };
        if distance < nearest_of_all.1 {
            nearest_of_all = (node, distance);
        }
        if distance > tolerance_m {
            continue;
        }
        let kept = face
            .nodes
            .iter()
            .copied()
            .zip(values)
            .filter(|(_, value)| value.abs() > LEAST_WEIGHT);
        weights.insert(node, (kept.collect(), distance));
    }
    if weights.is_empty() {
        let (nearest, distance_m) = nearest_of_all;
        return Err(refuse(
            &file.path,
            ImportProblem::NothingProjected {
                key: contact.key.clone(),
                nearest,
                distance_m,
                tolerance_m,
            },
        ));
    }
    Ok(weights)
}

/// The ring's nodes must determine the new ones: `W^T W` of the weights is to be well conditioned.
fn require_rank(
    file: &ImportFile,
    weights: &Weights,
    followed: &BTreeSet<usize>,
) -> Result<(), ModelError> {
    let order: BTreeMap<usize, usize> = followed
        .iter()
        .enumerate()
        .map(|(i, &node)| (node, i))
        .collect();
    let mut gram: Matrix<f64> = Matrix::zeros(order.len(), order.len());
    for (list, _) in weights.values() {
        for (a, wa) in list {
            for (b, wb) in list {
                gram[(order[a], order[b])] += wa * wb;
            }
        }
    }
    let (ring, blisk) = (weights.len(), followed.len());
    let ratio = hermitian_eigen(&gram)
        .ok()
        .and_then(|(values, _)| Some(values.first()? / values.last()?))
        .unwrap_or(0.0);
    if ratio >= LEAST_EIGENVALUE {
        return Ok(());
    }
    Err(refuse(
        &file.path,
        ImportProblem::RingTooCoarse { ring, blisk },
    ))
}

/// `T^T A T` for stiffness and mass, and the rows that remain.
fn condense(matrices: &mut Matrices, weights: &Weights, followed: &BTreeSet<usize>, offset: usize) {
    let mut rows: Vec<(usize, usize)> = matrices
        .rows
        .iter()
        .copied()
        .filter(|(node, _)| !weights.contains_key(node))
        .collect();
    rows.extend(
        followed
            .iter()
            .flat_map(|&node| [0, 1, 2].map(|i| (node + offset, i))),
    );
    rows.sort_unstable();
    let place = |row: (usize, usize)| rows.binary_search(&row).unwrap_or_default();
    // Row of T for each old row.
    let targets: Vec<Vec<(usize, f64)>> = matrices
        .rows
        .iter()
        .map(|&(node, direction)| match weights.get(&node) {
            None => vec![(place((node, direction)), 1.0)],
            Some((list, _)) => list
                .iter()
                .map(|(&a, &weight)| (place((a + offset, direction)), weight))
                .collect(),
        })
        .collect();
    let condensed = |matrix: &SymmetricSparse| {
        let mut triplets = Vec::new();
        for (row, column, value) in matrix.entries() {
            for &(i, wi) in &targets[row] {
                for &(j, wj) in &targets[column] {
                    if i >= j {
                        triplets.push((i, j, wi * value * wj));
                    }
                }
            }
        }
        SymmetricSparse::from_lower_triplets(rows.len(), &triplets)
    };
    matrices.stiffness = condensed(&matrices.stiffness);
    matrices.mass = condensed(&matrices.mass);
    matrices.rows = rows;
}

/// Values of the shape functions at the point of a face nearest to `target`, and its distance.
///
/// Gauss-Newton on `|x(p) - target|^2`, the natural coordinates kept within the face.
fn closest_point(positions: &[[f64; 3]], target: [f64; 3]) -> (Vec<f64>, f64) {
    const STEPS: usize = 30;
    let count = positions.len();
    let triangle = count.is_multiple_of(3);
    let start = if triangle { [1.0 / 3.0; 2] } else { [0.0; 2] };
    let mut point = start;
    for _ in 0..STEPS {
        let FacePoint {
            position, along, ..
        } = FacePoint::of(positions, point);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let off = [0, 1, 2].map(|i| target[i] - position[i]);
        let (a, b, c) = (
            dot(along[0], along[0]),
            dot(along[0], along[1]),
            dot(along[1], along[1]),
        );
        let (p, q) = (dot(along[0], off), dot(along[1], off));
        let determinant = a * c - b * b;
        if determinant <= 0.0 {
            break;
        }
        let free = [
            point[0] + (c * p - b * q) / determinant,
            point[1] + (a * q - b * p) / determinant,
        ];
        let next = if triangle {
            within_triangle(free)
        } else {
            within_square(point, free, [a, b, c], [p, q])
        };
        let moved = (next[0] - point[0]).abs() + (next[1] - point[1]).abs();
        point = next;
        if moved < 1e-14 {
            break;
        }
    }
    let nearest = FacePoint::of(positions, point);
    let off = distance(nearest.position, target);
    (nearest.value, off)
}

/// A step that leaves the square ends on the edge that it crosses; the other coordinate is then sought
/// along that edge alone, by the metric `[a, b; b, c]` and the gradient `slope` at `point`.
fn within_square(
    point: [f64; 2],
    free: [f64; 2],
    [a, b, c]: [f64; 3],
    slope: [f64; 2],
) -> [f64; 2] {
    let Some(crossed) = (0..2).find(|&k| free[k].abs() > 1.0) else {
        return free;
    };
    let other = 1 - crossed;
    let mut next = free;
    next[crossed] = free[crossed].clamp(-1.0, 1.0);
    let along = if other == 0 { a } else { c };
    let moved = (slope[other] - b * (next[crossed] - point[crossed])) / along;
    next[other] = (point[other] + moved).clamp(-1.0, 1.0);
    next
}

/// A point outside of the triangle, put on its nearest edge in area coordinates.
fn within_triangle(free: [f64; 2]) -> [f64; 2] {
    let next = free.map(|value| value.clamp(0.0, 1.0));
    let excess = (next[0] + next[1] - 1.0).max(0.0);
    next.map(|value| (value - 0.5 * excess).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::closest_point;

    const SQUARE: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];

    #[test]
    fn points_over_a_face_have_its_shape_functions_as_weights() {
        let (weights, distance) = closest_point(&SQUARE, [0.5, 0.25, 0.1]);
        assert!((distance - 0.1).abs() < 1e-14);
        for (weight, expected) in weights.iter().zip([0.5625, 0.1875, 0.0625, 0.1875]) {
            assert!((weight - expected).abs() < 1e-14, "{weights:?}");
        }
        let triangle = &SQUARE[..3];
        let (weights, distance) = closest_point(triangle, [1.5, 0.25, -0.2]);
        assert!((distance - 0.2).abs() < 1e-14);
        for (weight, expected) in weights.iter().zip([0.25, 0.5, 0.25]) {
            assert!((weight - expected).abs() < 1e-14, "{weights:?}");
        }
    }

    #[test]
    fn points_beside_a_face_belong_to_its_nearest_edge_or_corner() {
        for (target, expected, distance) in [
            ([0.5, -0.3, 0.4], [0.75, 0.25, 0.0, 0.0], 0.5),
            ([2.3, 0.75, 0.0], [0.0, 0.25, 0.75, 0.0], 0.3),
            ([-0.3, -0.4, 0.0], [1.0, 0.0, 0.0, 0.0], 0.5),
            ([2.6, 1.8, 0.0], [0.0, 0.0, 1.0, 0.0], 1.0),
        ] {
            let (weights, found) = closest_point(&SQUARE, target);
            assert!((found - distance).abs() < 1e-12, "{target:?}: {found}");
            for (weight, expected) in weights.iter().zip(expected) {
                assert!((weight - expected).abs() < 1e-12, "{target:?}: {weights:?}");
            }
        }
    }
}
