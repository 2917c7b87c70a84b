//! Contact pairs from the surfaces that touch: of the sector, of the next one, and the ground.
//!
//! A node of the high face is the node of the low face one sector on. Each side is hence a list of low or inner
//! nodes, each with the sector in which it stands, and what counts of a pair is how many sectors its second node is
//! ahead of its first.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::contact_tables::Contact;
use super::cyclic_faces::{nearest, turned_by};
use super::cylindrical::{Frames, Node};
use super::import_file::ImportFile;
use super::problem::ImportProblem;
use super::projection::Projected;
use super::report::{ContactReport, SurfacesReport};
use super::run::Run;
use super::side::{Side, Surface};
use super::source::refuse;
use super::surface::{NodalArea, add_face};
use super::tables::Pairing;
use crate::model::sector::error::ModelError;
use crate::model::sector::sector_model::{ContactPair, ContactSide};

/// Least length of the mean of the unit normals at a node: below, its faces turn away from each other.
const LEAST_NORMAL: f64 = 1e-6;

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

/// Area and normal (in r, theta, z) of the nodes of a surface: low or inner node, and sectors ahead.
type SurfaceNodes = BTreeMap<(usize, i64), NodalArea>;

/// A pair's two sides with the area and normal of the first.
struct Pair {
    first: ContactSide,
    second: ContactSide,
    nodal: NodalArea,
    /// Part that the pair has of the weights that the contacts have of their own; 0 without such.
    share: f64,
}

/// The pairs of all contacts, each contact by the nodes of its first side, and how well the surfaces meet.
pub(super) fn pairs(
    file: &ImportFile,
    runs: &[Run],
    sector: &Sector<'_>,
) -> Result<(Vec<ContactPair>, Option<ContactReport>), ModelError> {
    let mut pairs = Vec::new();
    let mut report = ContactReport::default();
    for contact in &file.contacts {
        let (mut pairs_of_contact, surfaces) = pairs_of(file, contact, runs, sector)?;
        if let Some(weight) = contact.weight {
            share_out(weight, contact.is_equal(), &mut pairs_of_contact);
        }
        for pair in pairs_of_contact {
            add(&mut pairs, pair);
        }
        report.worst_distance_m = report.worst_distance_m.max(surfaces.worst_distance_m);
        report.tolerance_m = report.tolerance_m.max(surfaces.tolerance_m);
        let angle_deg = report.worst_normal_angle_deg;
        report.worst_normal_angle_deg = angle_deg.max(surfaces.worst_normal_angle_deg);
        report.area_m2 += surfaces.area_m2;
        report.ring_nodes_without_pair += surfaces.second_nodes_without_pair;
        report.surfaces.push(surfaces);
    }
    report.pairs = pairs.len();
    let constant = pairs
        .iter()
        .filter(|pair| has_constant_load(sector.frames, pair));
    report.constant_load_pairs = Some(constant.count()).filter(|&count| count > 0);
    report.projected_ring_nodes = sector.projected.map(|projected| projected.nodes);
    let is_equal = file.contacts.iter().all(Contact::is_equal);
    let given: Option<f64> = file.contacts.iter().map(|contact| contact.weight).sum();
    match given {
        // A pair of two contacts has both shares.
        Some(sum) => pairs.iter_mut().for_each(|pair| pair.share /= sum),
        None => share_out(1.0, is_equal, &mut pairs),
    }
    let pairs = pairs.into_iter().map(|pair| ContactPair {
        first: pair.first,
        second: pair.second,
        normal: unit(pair.nodal.normal_m2),
        weight: pair.share,
        load_weight: None,
    });
    Ok((
        pairs.collect(),
        (!file.contacts.is_empty()).then_some(report),
    ))
}

/// Gives pairs their shares of `weight`: by area, or alike.
fn share_out(weight: f64, is_equal: bool, pairs: &mut [Pair]) {
    let whole: f64 = pairs.iter().map(|pair| pair.nodal.area_m2).sum();
    let count = pairs.len() as f64;
    for pair in pairs {
        pair.share = if is_equal {
            weight / count
        } else {
            weight * (pair.nodal.area_m2 / whole)
        };
    }
}

/// Whether a pair has no displacement along its normal, so that its normal load stays what it is at rest.
fn has_constant_load(frames: &Frames, pair: &Pair) -> bool {
    let normal = unit(pair.nodal.normal_m2);
    let moves = |node: usize| {
        (0..3).any(|component| {
            normal[component].abs() > LEAST_NORMAL && frames.dof(node, component).is_some()
        })
    };
    ![pair.first, pair.second]
        .iter()
        .filter_map(|side| side.node())
        .any(moves)
}

/// Adds a pair, to the same one if that is there: at the edge of two surfaces, or on both cyclic faces.
fn add(pairs: &mut Vec<Pair>, pair: Pair) {
    let same = |known: &&mut Pair| (known.first, known.second) == (pair.first, pair.second);
    match pairs.iter_mut().find(same) {
        Some(known) => {
            known.nodal.add(pair.nodal);
            known.share += pair.share;
        }
        None => pairs.push(pair),
    }
}

/// The pairs of one contact.
fn pairs_of(
    file: &ImportFile,
    contact: &Contact,
    runs: &[Run],
    sector: &Sector<'_>,
) -> Result<(Vec<Pair>, SurfacesReport), ModelError> {
    let mut first = surface(contact, &contact.first, runs, sector)?;
    let mut report = SurfacesReport {
        first: contact.first.to_string(),
        second: contact.second.to_string(),
        tolerance_m: contact.tolerance_m.unwrap_or(sector.tolerance_m),
        ..SurfacesReport::default()
    };
    let mut pairs = Vec::new();
    match &contact.second {
        Side::Ground => {
            for (&(node, _), &nodal) in &first {
                let pair = Pair {
                    first: ContactSide::Node(node),
                    second: ContactSide::Ground,
                    nodal,
                    share: 0.0,
                };
                add(&mut pairs, pair);
            }
        }
        Side::Surface(other) => {
            let second = match sector.projected {
                Some(Projected { offset, .. }) if contact.pairing == Pairing::Projection => {
                    // The ring has a node at each node of the blisk's surface that it covers.
                    first.retain(|(node, _), _| sector.frames.is_free(node + offset));
                    let facing = first.iter();
                    facing
                        .map(|(&(node, ahead), nodal)| ((node + offset, ahead), nodal.facing()))
                        .collect()
                }
                _ => surface(contact, other, runs, sector)?,
            };
            let facing = Facing::new(file, contact, other, sector, &second);
            pairs = facing.pairs(&first, &mut report)?;
        }
    }
    if let Some(normal) = contact.normal {
        for pair in &mut pairs {
            pair.nodal = NodalArea::of_node(normal);
        }
    }
    report.pairs = pairs.len();
    for pair in &pairs {
        report.area_m2 += pair.nodal.area_m2;
        let length = length(pair.nodal.normal_m2);
        if length.is_nan() || length <= LEAST_NORMAL * pair.nodal.area_m2 {
            let problem = ImportProblem::NoArea {
                name: contact.first.to_string(),
                node: pair.first.node().unwrap_or_default(),
            };
            return Err(refuse(&file.path, problem));
        }
    }
    if let Some(projected) = sector.projected
        && contact.pairing == Pairing::Projection
    {
        report.worst_distance_m = projected.worst_distance_m;
        report.second_nodes_without_pair = projected.left_out;
    }
    Ok((pairs, report))
}

/// The second side of a contact, as the nodes of the first one look for theirs on it.
struct Facing<'a> {
    file: &'a ImportFile,
    contact: &'a Contact,
    other: &'a Surface,
    sector: &'a Sector<'a>,
    nodes: &'a SurfaceNodes,
    /// Positions of the nodes in the frame of their sector, m, by the sectors that they are ahead; and of all.
    ahead: [BTreeMap<usize, [f64; 3]>; 2],
    all: BTreeMap<usize, [f64; 3]>,
}

/// A node of the second side that one of the first meets.
#[derive(Clone, Copy)]
struct Met {
    node: usize,
    /// Sectors that it is ahead of the first node.
    ahead: i64,
    distance_m: f64,
}

impl<'a> Facing<'a> {
    fn new(
        file: &'a ImportFile,
        contact: &'a Contact,
        other: &'a Surface,
        sector: &'a Sector<'a>,
        nodes: &'a SurfaceNodes,
    ) -> Self {
        let positions = |chosen: &dyn Fn(i64) -> bool| {
            let positioned = nodes.keys().filter(|(_, ahead)| chosen(*ahead));
            positioned
                .map(|&(node, _)| (node, sector.nodes[&node].position_m))
                .collect()
        };
        Self {
            file,
            contact,
            other,
            sector,
            nodes,
            ahead: [
                positions(&|ahead| ahead == 0),
                positions(&|ahead| ahead == 1),
            ],
            all: positions(&|_| true),
        }
    }

    /// The node nearest to a point of the first side, which stands in the sector `ahead` of the side's own.
    ///
    /// Where there is none, nodes of the high face count as those of the low face: a set may hold those of one face alone.
    fn met(&self, position_m: [f64; 3], ahead: i64, tolerance_m: f64) -> Option<Met> {
        let alpha = TAU / self.file.sectors as f64;
        let between = i64::from(self.other.is_next) - i64::from(self.contact.first.is_next);
        // A wheel of one sector has no next one.
        let most = i64::from(self.file.sectors > 1);
        let among = |nodes: &BTreeMap<usize, [f64; 3]>, ahead: i64| {
            // As little rounding as there can be within a sector.
            let place = if ahead == 0 {
                position_m
            } else {
                turned_by(position_m, -(ahead as f64) * alpha)
            };
            let (node, distance_m) = nearest(place, nodes).filter(|_| ahead.abs() <= most)?;
            Some(Met {
                node,
                ahead,
                distance_m,
            })
        };
        let closer = |a: Option<Met>, b: Option<Met>| match (a, b) {
            (Some(a), Some(b)) if b.distance_m < a.distance_m => Some(b),
            (a, b) => a.or(b),
        };
        let closest = closer(
            among(&self.ahead[0], between - ahead),
            among(&self.ahead[1], between + 1 - ahead),
        );
        match closest {
            Some(met) if met.distance_m <= tolerance_m => closest,
            _ => closer(among(&self.all, between), closest),
        }
    }

    /// The pairs of the first side's nodes, in their order.
    fn pairs(
        &self,
        first: &SurfaceNodes,
        report: &mut SurfacesReport,
    ) -> Result<Vec<Pair>, ModelError> {
        let tolerance_m = report.tolerance_m;
        let mut owner: BTreeMap<usize, (usize, i64)> = BTreeMap::new();
        let mut pairs = Vec::with_capacity(first.len());
        for (&(node, ahead), &nodal) in first {
            let position_m = self.sector.nodes[&node].position_m;
            let Some(met) = self.met(position_m, ahead, tolerance_m) else {
                continue;
            };
            if met.distance_m > tolerance_m {
                return Err(
                    self.refuse(|first, second, key| ImportProblem::ContactMismatch {
                        key,
                        first,
                        second,
                        node,
                        nearest: met.node,
                        distance_m: met.distance_m,
                        tolerance_m,
                    }),
                );
            }
            let place = (node, met.ahead);
            let earlier = *owner.entry(met.node).or_insert(place);
            if earlier != place {
                return Err(
                    self.refuse(|first, second, key| ImportProblem::ContactTwice {
                        key,
                        first,
                        second,
                        nodes: [earlier.0, node],
                        met: met.node,
                    }),
                );
            }
            report.worst_distance_m = report.worst_distance_m.max(met.distance_m);
            let side = |node, is_ahead| {
                if is_ahead {
                    ContactSide::NextSector(node)
                } else {
                    ContactSide::Node(node)
                }
            };
            let pair = Pair {
                first: side(node, met.ahead < 0),
                second: side(met.node, met.ahead > 0),
                nodal,
                share: 0.0,
            };
            add(&mut pairs, pair);
        }
        report.second_nodes_without_pair = self.all.len() - owner.len();
        // Normals that were given have nothing to face.
        if self.contact.normal.is_none() {
            report.worst_normal_angle_deg = self.worst_angle_deg(&pairs);
        }
        Ok(pairs)
    }

    /// Largest angle between the normals of pairs and the opposite of those that they face, degrees.
    fn worst_angle_deg(&self, pairs: &[Pair]) -> f64 {
        // Both cyclic faces have a share in the normal of a node on them.
        let mut whole: BTreeMap<usize, NodalArea> = BTreeMap::new();
        for (&(node, _), &nodal) in self.nodes {
            whole.entry(node).or_default().add(nodal);
        }
        let angle_deg = |pair: &Pair| {
            let facing = unit(whole[&pair.second.node()?].normal_m2);
            let normal = unit(pair.nodal.normal_m2);
            let cosine: f64 = -(0..3).map(|i| normal[i] * facing[i]).sum::<f64>();
            Some(cosine.clamp(-1.0, 1.0).acos().to_degrees())
        };
        pairs.iter().filter_map(angle_deg).fold(0.0, f64::max)
    }

    fn refuse(&self, problem: impl FnOnce(String, String, String) -> ImportProblem) -> ModelError {
        let (first, second) = (self.contact.first.owner(), self.other.owner());
        refuse(
            &self.file.path,
            problem(first, second, self.contact.key.clone()),
        )
    }
}

/// Area and normal of each free node of a side. Nodes of the high face stand on the low face of the sector ahead.
fn surface(
    contact: &Contact,
    side: &Surface,
    runs: &[Run],
    sector: &Sector<'_>,
) -> Result<SurfaceNodes, ModelError> {
    let run = Run::of(runs, side.body);
    let (body, name) = (side.body, side.set.clone());
    let mut cartesian: BTreeMap<usize, NodalArea> = BTreeMap::new();
    if contact.normal.is_some() {
        // The surface is its nodes. What their normal is, is said of the pairs.
        let nodes = run.set(&name);
        let of_body = nodes.into_iter().filter(|&node| run.body_of(node) == body);
        cartesian.extend(of_body.map(|node| (node + run.offset, NodalArea::default())));
    } else {
        let faces = run.mesh.faces_of(&name).unwrap_or_default();
        let faces = faces.into_iter().filter(|(element, _)| {
            let nodes = &run.mesh.elements[element].nodes;
            nodes.iter().all(|&node| run.body_of(node) == body)
        });
        let mut has_face = false;
        for (element, face) in faces {
            has_face = true;
            add_face_of(run, sector, element, face, &mut cartesian);
        }
        if !has_face {
            let is_list = contact.key != "contact";
            let normal = if is_list {
                format!(", or {}.normal for nodes without faces", contact.key)
            } else {
                String::new()
            };
            return Err(refuse(
                &run.mesh_path,
                ImportProblem::NoFaces { body, name, normal },
            ));
        }
        if cartesian.is_empty() {
            let node = run.set(&name).into_iter().next().unwrap_or_default();
            return Err(refuse(&run.mesh_path, ImportProblem::NoArea { name, node }));
        }
    }
    let mut nodes = SurfaceNodes::new();
    for (node, nodal) in cartesian {
        if !sector.frames.is_free(node) {
            continue;
        }
        let normal_m2 = sector.frames.components(node, nodal.normal_m2);
        let place = match sector.low_of_high.get(&node) {
            Some(&low) => (low, 1),
            None => (node, 0),
        };
        nodes.insert(place, NodalArea { normal_m2, ..nodal });
    }
    if nodes.is_empty() {
        return Err(refuse(
            &run.mesh_path,
            ImportProblem::NoFreeNodes { body, name },
        ));
    }
    Ok(nodes)
}

/// Adds the area of an element's face to its nodes.
fn add_face_of(
    run: &Run,
    sector: &Sector<'_>,
    element: usize,
    face: usize,
    areas: &mut BTreeMap<usize, NodalArea>,
) {
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
    add_face(areas, &numbers, &positions, inside);
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = length(vector);
    vector.map(|v| v / length)
}
