//! The nodes of the two cyclic faces that are one node of the wheel.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::problem::ImportProblem;

/// Pairs of nodes, and how well they meet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FacePairs {
    /// `(low, high)`.
    pub pairs: Vec<(usize, usize)>,
    /// Largest distance between a high node and its low node turned by one sector, m.
    pub worst_m: f64,
}

/// Pairs each node of the low face with the nearest node of the high one, after a turn by one sector
/// about z.
pub(super) fn match_faces(
    low: &BTreeMap<usize, [f64; 3]>,
    high: &BTreeMap<usize, [f64; 3]>,
    sectors: usize,
    tolerance_m: f64,
) -> Result<FacePairs, ImportProblem> {
    let alpha = TAU / sectors as f64;
    let mut owner: BTreeMap<usize, usize> = BTreeMap::new();
    let mut pairs = Vec::with_capacity(low.len());
    let mut worst_m = 0.0_f64;
    for (&node, &position) in low {
        let Some((nearest, distance_m)) = nearest(turned_by(position, alpha), high) else {
            return Err(ImportProblem::FaceCount {
                low: low.len(),
                high: 0,
            });
        };
        if distance_m > tolerance_m {
            let backwards = low
                .values()
                .all(|&p| nearest_distance(turned_by(p, -alpha), high) <= tolerance_m);
            let hint = if backwards {
                ": the faces meet the other way round, so low_face and high_face are to be exchanged"
            } else {
                ": are `sectors`, `axis` and `units` right?"
            };
            return Err(ImportProblem::FaceMismatch {
                node,
                nearest,
                distance_m,
                tolerance_m,
                hint,
            });
        }
        if let Some(&first) = owner.get(&nearest) {
            return Err(ImportProblem::FaceTwice {
                first,
                second: node,
                high: nearest,
            });
        }
        owner.insert(nearest, node);
        worst_m = worst_m.max(distance_m);
        pairs.push((node, nearest));
    }
    if low.len() != high.len() {
        return Err(ImportProblem::FaceCount {
            low: low.len(),
            high: high.len(),
        });
    }
    Ok(FacePairs { pairs, worst_m })
}

/// A position turned about z.
pub(super) fn turned_by([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos, z]
}

/// The node nearest to a position, the one with the lowest number among equals.
pub(super) fn nearest(
    position: [f64; 3],
    among: &BTreeMap<usize, [f64; 3]>,
) -> Option<(usize, f64)> {
    among
        .iter()
        .map(|(&node, &other)| (node, distance(position, other)))
        .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))
}

fn nearest_distance(position: [f64; 3], among: &BTreeMap<usize, [f64; 3]>) -> f64 {
    nearest(position, among).map_or(f64::INFINITY, |(_, distance)| distance)
}

pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
