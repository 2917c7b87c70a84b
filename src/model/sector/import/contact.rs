//! Contact pairs from the surfaces on which blisk and ring touch.

use std::collections::BTreeMap;

use super::cyclic_faces::nearest;
use super::cylindrical::{Frames, Node};
use super::import_file::ImportFile;
use super::problem::ImportProblem;
use super::projection::Projected;
use super::report::ContactReport;
use super::run::Run;
use super::source::refuse;
use super::surface::{NodalArea, add_face};
use super::tables::{ContactTable, Weights};
use crate::model::sector::error::ModelError;
use crate::model::sector::sector_model::{Body, ContactPair, ContactSide};

/// What the sector looks like to the contact: nodes, frames, and the low node of each high one.
pub(super) struct Sector<'a> {
    pub nodes: &'a BTreeMap<usize, Node>,
    pub frames: &'a Frames,
    pub low_of_high: &'a BTreeMap<usize, usize>,
    /// What was projected, where the ring's nodes do not match.
    pub projected: Option<Projected>,
    /// Largest distance between the nodes of a pair where the import file gives none, m.
    pub tolerance_m: f64,
}

/// The pairs, blisk node by blisk node, and how well the surfaces meet.
pub(super) fn pairs(
    file: &ImportFile,
    table: &ContactTable,
    runs: &[Run],
    sector: &Sector<'_>,
) -> Result<(Vec<ContactPair>, ContactReport), ModelError> {
    let mut blisk = surface(table, runs, sector, Body::Blisk)?;
    let ring = match sector.projected {
        None => surface(table, runs, sector, Body::Ring)?,
        Some(Projected { offset, .. }) => {
            // The ring has a node at each node of the blisk's surface that it covers.
            blisk.retain(|node, _| sector.frames.is_free(node + offset));
            let facing = blisk.iter().map(|(node, nodal)| {
                let normal_m2 = nodal.normal_m2.map(|part| -part);
                (
                    node + offset,
                    NodalArea {
                        normal_m2,
                        ..*nodal
                    },
                )
            });
            facing.collect()
        }
    };
    let tolerance_m = table.tolerance_m.unwrap_or(sector.tolerance_m);
    let positions: BTreeMap<usize, [f64; 3]> = ring
        .keys()
        .map(|&node| (node, sector.nodes[&node].position_m))
        .collect();
    let mut owner: BTreeMap<usize, usize> = BTreeMap::new();
    let mut report = ContactReport {
        tolerance_m,
        ..ContactReport::default()
    };
    let mut pairs = Vec::with_capacity(blisk.len());
    for (&node, nodal) in &blisk {
        let Some((other, distance_m)) = nearest(sector.nodes[&node].position_m, &positions) else {
            continue;
        };
        if distance_m > tolerance_m {
            let problem = ImportProblem::ContactMismatch {
                node,
                nearest: other,
                distance_m,
                tolerance_m,
            };
            return Err(refuse(&file.path, problem));
        }
        if let Some(first) = owner.insert(other, node) {
            let problem = ImportProblem::ContactTwice {
                first,
                second: node,
                ring: other,
            };
            return Err(refuse(&file.path, problem));
        }
        report.worst_distance_m = report.worst_distance_m.max(distance_m);
        report.area_m2 += nodal.area_m2;
        let normal = unit(nodal.normal_m2);
        let facing = unit(ring[&other].normal_m2);
        let cosine: f64 = -(0..3).map(|i| normal[i] * facing[i]).sum::<f64>();
        let angle_deg = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        report.worst_normal_angle_deg = report.worst_normal_angle_deg.max(angle_deg);
        pairs.push(ContactPair {
            first: ContactSide::Node(node),
            second: ContactSide::Node(other),
            normal,
            weight: nodal.area_m2,
            load_weight: None,
        });
    }
    let count = pairs.len() as f64;
    for pair in &mut pairs {
        pair.weight = match table.weights {
            Weights::Area => pair.weight / report.area_m2,
            Weights::Equal => 1.0 / count,
        };
    }
    report.pairs = pairs.len();
    report.ring_nodes_without_pair = ring.len() - owner.len();
    if let Some(projected) = sector.projected {
        report.projected_ring_nodes = Some(projected.nodes);
        report.worst_distance_m = projected.worst_distance_m;
        report.ring_nodes_without_pair = projected.left_out;
    }
    Ok((pairs, report))
}

/// Area and normal (in r, theta, z) of each node of a body's surface; nodes of the high face count as
/// those of the low face, whose neighbour in the sector before brings their share.
fn surface(
    table: &ContactTable,
    runs: &[Run],
    sector: &Sector<'_>,
    body: Body,
) -> Result<BTreeMap<usize, NodalArea>, ModelError> {
    let name = match body {
        Body::Blisk => &table.blisk,
        Body::Ring | Body::Damper => &table.ring,
    };
    let run = runs.iter().rev().find(|run| run.holds(body));
    let run = run.unwrap_or(&runs[0]);
    let mut cartesian: BTreeMap<usize, NodalArea> = BTreeMap::new();
    if let Some(normal) = table.normal {
        // Without elements there are no areas; the surface is its nodes.
        let sign = if body == Body::Blisk { 1.0 } else { -1.0 };
        let nodes = run.set(name);
        let nodal = NodalArea {
            area_m2: 1.0,
            normal_m2: normal.map(|n| sign * n),
        };
        let folded = nodes.iter().map(|node| {
            let node = node + run.offset;
            sector.low_of_high.get(&node).copied().unwrap_or(node)
        });
        return Ok(folded
            .filter(|&node| sector.frames.is_free(node))
            .map(|node| (node, nodal))
            .collect());
    }
    let faces: Vec<(usize, usize)> = run
        .mesh
        .faces_of(name)
        .unwrap_or_default()
        .into_iter()
        .filter(|&(element, _)| {
            let nodes = &run.mesh.elements[&element].nodes;
            nodes.iter().all(|&node| run.body_of(node) == body)
        })
        .collect();
    if faces.is_empty() {
        let name = name.clone();
        return Err(refuse(
            &run.mesh_path,
            ImportProblem::NoFaces { body, name },
        ));
    }
    for (element, face) in faces {
        let place = |node: &usize| sector.nodes[&(node + run.offset)].position_m;
        let nodes = run.mesh.face_nodes(element, face);
        let positions: Vec<[f64; 3]> = nodes.iter().map(place).collect();
        let all = &run.mesh.elements[&element].nodes;
        let mut inside = [0.0; 3];
        for node in all {
            let position = place(node);
            for i in 0..3 {
                inside[i] += position[i] / all.len() as f64;
            }
        }
        let numbers: Vec<usize> = nodes.iter().map(|node| node + run.offset).collect();
        add_face(&mut cartesian, &numbers, &positions, inside);
    }
    let mut folded: BTreeMap<usize, NodalArea> = BTreeMap::new();
    for (node, nodal) in cartesian {
        if !sector.frames.is_free(node) {
            continue;
        }
        let normal = sector.frames.components(node, nodal.normal_m2);
        let low = sector.low_of_high.get(&node).copied().unwrap_or(node);
        let sum = folded.entry(low).or_default();
        sum.area_m2 += nodal.area_m2;
        for (total, part) in sum.normal_m2.iter_mut().zip(normal) {
            *total += part;
        }
    }
    Ok(folded)
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    vector.map(|v| v / length)
}
