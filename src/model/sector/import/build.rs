//! From an import file to a sector model: one call per stage.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::path::Path;

use super::contact_tables::Contact;
use super::cyclic_faces::{FacePairs, match_faces, turned_by};
use super::cylindrical::{Frames, Node};
use super::files::OtherBody;
use super::import_file::ImportFile;
use super::matrices::Matrices;
use super::problem::{ImportProblem, body_name};
use super::projection::{Projected, project};
use super::report::{BodyReport, ImportReport};
use super::run::Run;
use super::side::Side;
use super::source::refuse;
use super::tables::{ForceDirection, Pairing};
use super::{blade, contact};
use crate::linalg::{Complex64, SymmetricSparse};
use crate::model::sector::error::ModelError;
use crate::model::sector::layout::position_tolerance_of;
use crate::model::sector::sector_model::{Body, Component, ObservedNode, SectorModel};
use crate::model::sector::validate::validate;

/// An imported sector.
#[derive(Debug)]
pub struct Imported {
    /// The model, validated.
    pub model: SectorModel,
    /// What was found.
    pub report: ImportReport,
}

/// Reads the files that the import file names and makes a sector model of them.
///
/// # Errors
/// A file that cannot be read, a line that is not what its format says, parts that do not go together,
/// or a model that is refused.
pub fn import(path: &Path) -> Result<Imported, ModelError> {
    let file = ImportFile::read(path)?;
    let runs = Run::read_meshes(&file)?;
    let mut nodes: BTreeMap<usize, Node> = runs.iter().flat_map(|run| run.nodes(&file)).collect();
    let mut matrices: Vec<Matrices> = runs
        .iter()
        .map(|run| run.matrices(&file))
        .collect::<Result<_, _>>()?;
    let free = matrices
        .iter()
        .flat_map(|run| &run.rows)
        .map(|&(node, _)| node)
        .collect();
    let mut faces = cyclic_faces(&file, &runs, &nodes, &free)?;
    let projected = project_ring(&file, &runs, &mut nodes, &mut matrices, &mut faces)?;
    let rows = || matrices.iter().flat_map(|run| run.rows.iter().copied());
    let high_face_moved = place_high_face(&mut nodes, &faces, file.sectors);
    let frames = Frames::new(rows(), &nodes, path)?;
    let n = frames.dofs.len();
    let factor = file.units.stiffness_and_mass();
    let assembled = |of: fn(&Matrices) -> &SymmetricSparse| {
        matrices
            .iter()
            .flat_map(|run| frames.turn(&run.rows, of(run), factor))
            .collect::<Vec<_>>()
    };
    let mut stiffness = assembled(|run| &run.stiffness);
    let mass: Vec<(usize, usize, f64)> = assembled(|run| &run.mass)
        .into_iter()
        .filter(|&(.., value)| value != 0.0)
        .collect();
    let bodies = body_reports(&file, &runs, &frames, &faces, &stiffness, &mass);
    for other in &file.others {
        let hz = file.grounding_hz(other.body);
        ground(&mut stiffness, &mass, &frames, other.body, hz);
    }
    let (mut blade, blade_source) = blade::stiffness(&file, &runs[0], &frames)?;
    blade.retain(|&(.., value)| value != 0.0);
    let low_of_high = faces
        .values()
        .flat_map(|faces| &faces.pairs)
        .map(|&(low, high)| (high, low))
        .collect();
    let sector = contact::Sector {
        nodes: &nodes,
        frames: &frames,
        low_of_high: &low_of_high,
        projected,
        tolerance_m: tolerance_m(&file, &nodes),
    };
    let (contact_pairs, contact) = contact::pairs(&file, &runs, &sector)?;
    let force = force(&file, &runs, &frames, &low_of_high)?;
    let observed = observed(&file, &runs)?;
    let blade_dofs: BTreeSet<usize> = blade
        .iter()
        .flat_map(|&(row, column, _)| [row, column])
        .collect();
    let mut report = ImportReport {
        name: file.name.clone(),
        sectors: file.sectors,
        position_tolerance_m: tolerance_m(&file, &nodes),
        high_face_moved,
        bodies,
        blade_source,
        blade_dofs: blade_dofs.len(),
        contact,
        ring_grounding_hz: file.grounding_hz(Body::Ring),
        damper_grounding_hz: file.grounding_hz(Body::Damper),
        forced_dofs: force.len(),
        observed: observed
            .iter()
            .map(|node| (node.name.clone(), node.node))
            .collect(),
    };
    let model = SectorModel {
        name: file.name.clone(),
        sectors: file.sectors,
        stiffness: SymmetricSparse::from_lower_triplets(n, &stiffness),
        mass: SymmetricSparse::from_lower_triplets(n, &mass),
        blade_stiffness: SymmetricSparse::from_lower_triplets(n, &blade),
        cyclic_pairs: cyclic_dofs(&file, &frames, &faces)?,
        dofs: frames.dofs,
        contact_pairs,
        force,
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed,
    };
    validate(&model)?;
    if let Some(contact) = &mut report.contact {
        let pairs = model.pairs_without_friction();
        contact.pairs_without_friction = Some(pairs).filter(|&count| count > 0);
    }
    Ok(Imported { model, report })
}

/// Makes the ring's contact nodes follow the blisk's, if the import file asks for it.
fn project_ring(
    file: &ImportFile,
    runs: &[Run],
    nodes: &mut BTreeMap<usize, Node>,
    matrices: &mut [Matrices],
    faces: &mut BTreeMap<&'static str, FacePairs>,
) -> Result<Option<Projected>, ModelError> {
    let is_projected = |contact: &&Contact| contact.pairing == Pairing::Projection;
    let contact = file.contacts.iter().find(is_projected);
    let Some((contact, Side::Surface(ring))) = contact.map(|contact| (contact, &contact.second))
    else {
        return Ok(None);
    };
    let tolerance_m = contact.tolerance_m.unwrap_or(tolerance_m(file, nodes));
    let of_ring = runs.iter().position(|run| run.holds(Body::Ring));
    let matrices = &mut matrices[of_ring.unwrap_or_default()];
    project(
        file,
        (contact, ring),
        runs,
        tolerance_m,
        nodes,
        matrices,
        faces,
    )
    .map(Some)
}

/// Tolerance on positions: the import file's, or what a bundle accepts.
fn tolerance_m(file: &ImportFile, nodes: &BTreeMap<usize, Node>) -> f64 {
    file.position_tolerance_m
        .unwrap_or_else(|| position_tolerance_of(nodes.values().map(|node| node.position_m)))
}

/// Low and high set of each body that has them, with the run that holds them.
pub(super) fn face_sets<'a>(
    file: &'a ImportFile,
    runs: &'a [Run],
) -> impl Iterator<Item = (Body, &'a Run, [&'a str; 2])> {
    let blisk = [file.blisk.low_face.as_str(), file.blisk.high_face.as_str()];
    let others = file
        .others
        .iter()
        .filter_map(|OtherBody { body, table, .. }| {
            let names = [table.low_face.as_deref()?, table.high_face.as_deref()?];
            Some((*body, names))
        });
    std::iter::once((Body::Blisk, blisk))
        .chain(others)
        .map(move |(body, names)| (body, Run::of(runs, body), names))
}

/// Pairs of the free nodes on the faces of each body.
pub(super) fn cyclic_faces(
    file: &ImportFile,
    runs: &[Run],
    nodes: &BTreeMap<usize, Node>,
    free: &BTreeSet<usize>,
) -> Result<BTreeMap<&'static str, FacePairs>, ModelError> {
    let tolerance_m = tolerance_m(file, nodes);
    let mut faces = BTreeMap::new();
    for (body, run, names) in face_sets(file, runs) {
        let mut sides = Vec::new();
        for name in names {
            let side: BTreeMap<usize, [f64; 3]> = run
                .set(name)
                .into_iter()
                .map(|node| node + run.offset)
                .filter(|node| free.contains(node) && nodes[node].body == body)
                .map(|node| (node, nodes[&node].position_m))
                .collect();
            sides.push(side);
        }
        let pairs = match_faces(&sides[0], &sides[1], file.sectors, tolerance_m)
            .map_err(|problem| refuse(&run.mesh_path, problem))?;
        faces.insert(body_name(body), pairs);
    }
    Ok(faces)
}

/// Puts the high face where the low face turned by a sector is, if the two are further apart than a
/// bundle allows; the user's tolerance has let them pass.
fn place_high_face(
    nodes: &mut BTreeMap<usize, Node>,
    faces: &BTreeMap<&'static str, FacePairs>,
    sectors: usize,
) -> bool {
    let allowed = position_tolerance_of(nodes.values().map(|node| node.position_m));
    let moved = faces.values().any(|faces| faces.worst_m > allowed);
    if moved {
        for &(low, high) in faces.values().flat_map(|faces| &faces.pairs) {
            let image = turned_by(nodes[&low].position_m, TAU / sectors as f64);
            if let Some(node) = nodes.get_mut(&high) {
                node.position_m = image;
            }
        }
    }
    moved
}

/// Pairs of dofs from pairs of nodes: both must be free in the same components.
fn cyclic_dofs(
    file: &ImportFile,
    frames: &Frames,
    faces: &BTreeMap<&'static str, FacePairs>,
) -> Result<Vec<(usize, usize)>, ModelError> {
    let mut pairs = Vec::new();
    for &(low, high) in faces.values().flat_map(|faces| &faces.pairs) {
        for component in 0..3 {
            match (frames.dof(low, component), frames.dof(high, component)) {
                (Some(low), Some(high)) => pairs.push((low, high)),
                (None, None) => {}
                _ => {
                    return Err(refuse(
                        &file.path,
                        ImportProblem::FaceComponents { low, high },
                    ));
                }
            }
        }
    }
    Ok(pairs)
}

fn body_reports(
    file: &ImportFile,
    runs: &[Run],
    frames: &Frames,
    faces: &BTreeMap<&'static str, FacePairs>,
    stiffness: &[(usize, usize, f64)],
    mass: &[(usize, usize, f64)],
) -> Vec<BodyReport> {
    let axial = |dof: usize, body: Body| {
        frames.dofs[dof].body == body && frames.dofs[dof].component == Component::Axial
    };
    let report = |body: Body, run: &Run| {
        // e^T M e and K e for the unit shift e along z.
        let mut mass_kg = 0.0;
        for &(row, column, value) in mass {
            if axial(row, body) && axial(column, body) {
                mass_kg += if row == column { value } else { 2.0 * value };
            }
        }
        let mass_is_lumped = mass.iter().all(|&(row, column, _)| {
            let (row, column) = (&frames.dofs[row], &frames.dofs[column]);
            row.body != body || row.node == column.node
        });
        let mut force = vec![0.0; frames.dofs.len()];
        let mut largest = 0.0_f64;
        for &(row, column, value) in stiffness {
            if frames.dofs[row].body == body && row == column {
                largest = largest.max(value);
            }
            if axial(column, body) {
                force[row] += value;
            }
            if axial(row, body) && row != column {
                force[column] += value;
            }
        }
        let residual = force
            .iter()
            .fold(0.0_f64, |worst, value| worst.max(value.abs()))
            / largest;
        let of_body = |dof: &&crate::model::sector::Dof| dof.body == body;
        let nodes: BTreeSet<usize> = frames
            .dofs
            .iter()
            .filter(of_body)
            .map(|dof| dof.node)
            .collect();
        let facts = &run.mesh.run;
        let faces = faces.get(body_name(body));
        BodyReport {
            body: body_name(body),
            nodes: nodes.len(),
            dofs: frames.dofs.iter().filter(of_body).count(),
            mass_kg,
            mass_is_lumped,
            node_offset: run.offset,
            prestressed: facts.stores_matrices.then_some(facts.prestressed),
            rotation_rad_per_s: facts
                .centrifugal
                .filter(|_| facts.prestressed)
                .map(|squared| squared.abs().sqrt()),
            cyclic_node_pairs: faces.map_or(0, |faces| faces.pairs.len()),
            worst_face_mismatch_m: faces.map_or(0.0, |faces| faces.worst_m),
            rigid_shift_residual: (body != Body::Blisk).then_some(residual),
        }
    };
    let others = file.others.iter().map(|other| other.body);
    std::iter::once(Body::Blisk)
        .chain(others)
        .map(|body| report(body, Run::of(runs, body)))
        .collect()
}

/// Adds `(2 pi f)^2 M` on the dofs of a body to the stiffness.
fn ground(
    stiffness: &mut Vec<(usize, usize, f64)>,
    mass: &[(usize, usize, f64)],
    frames: &Frames,
    body: Body,
    frequency_hz: f64,
) {
    let omega = TAU * frequency_hz;
    if omega > 0.0 {
        let of_body = |&&(row, _, _): &&(usize, usize, f64)| frames.dofs[row].body == body;
        let springs = mass.iter().filter(of_body);
        stiffness.extend(springs.map(|&(row, column, value)| (row, column, omega * omega * value)));
    }
}

/// Nodes that a force or an observed point names: a node, or those of a set.
fn named_nodes(runs: &[Run], node: Option<usize>, set: Option<&String>) -> Vec<usize> {
    let run = |name: &String| runs.iter().find(|run| !run.set(name).is_empty());
    match set.and_then(|name| Some((run(name)?, name))) {
        Some((run, name)) => {
            let nodes = run.set(name);
            nodes.into_iter().map(|node| node + run.offset).collect()
        }
        None => node.into_iter().collect(),
    }
}

/// The force: each entry is shared equally by its nodes, those of the high face acting on the low one.
fn force(
    file: &ImportFile,
    runs: &[Run],
    frames: &Frames,
    low_of_high: &BTreeMap<usize, usize>,
) -> Result<Vec<(usize, Complex64)>, ModelError> {
    let mut sum: BTreeMap<usize, Complex64> = BTreeMap::new();
    for (index, table) in file.force.iter().enumerate() {
        let nodes = named_nodes(runs, table.node, table.set.as_ref());
        if let Some(node) = table.node
            && !runs.iter().any(|run| run.has_node(node))
        {
            let reason = format!("no mesh has node {node}; accepted: the number of a node");
            return Err(file.refuse_value(&format!("force[{index}].node"), reason));
        }
        let nodes: BTreeSet<usize> = nodes
            .into_iter()
            .map(|node| low_of_high.get(&node).copied().unwrap_or(node))
            .collect();
        let component = match table.component {
            ForceDirection::Radial => 0,
            ForceDirection::Tangential => 1,
            ForceDirection::Axial => 2,
        };
        for &node in &nodes {
            let Some(dof) = frames.dof(node, component) else {
                let reason = format!(
                    "node {node} is not free in that direction; accepted: nodes that are free there"
                );
                return Err(file.refuse_value(&format!("force[{index}].component"), reason));
            };
            *sum.entry(dof).or_default() += Complex64::new(table.re, table.im) / nodes.len() as f64;
        }
    }
    Ok(sum.into_iter().collect())
}

fn observed(file: &ImportFile, runs: &[Run]) -> Result<Vec<ObservedNode>, ModelError> {
    let mut observed = Vec::new();
    for (index, table) in file.observe.iter().enumerate() {
        let nodes = named_nodes(runs, table.node, table.set.as_ref());
        let [node] = nodes.as_slice() else {
            let reason = format!(
                "the set has {} nodes; accepted: a set of one node",
                nodes.len()
            );
            return Err(file.refuse_value(&format!("observe[{index}].set"), reason));
        };
        observed.push(ObservedNode {
            name: table.name.clone(),
            node: *node,
        });
    }
    Ok(observed)
}
