//! Writing a bundle.

use std::fmt::Write as _;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use super::header::{FILE_NAME, Header};
use super::read::{CONTACT, CYCLIC, DOFS, FORCE, GROUND, OBSERVE, RIGID, RING_CONTACT};
use crate::model::sector::error::ModelError;
use crate::model::sector::matrix_market;
use crate::model::sector::sector_model::{
    Body, ContactPair, ContactSide, ObservedNode, SectorModel,
};
use crate::model::sector::validate::validate;

/// Writes `model` as a bundle into `directory`, made if absent; files of the same names are replaced. The header
/// goes first and comes last: a bundle that was not written to its end has none, and is refused.
///
/// Reading the bundle gives the same model bit for bit.
///
/// # Errors
/// A model that is refused, a name that CSV without quoting cannot hold, or a file that cannot be
/// written.
pub fn write(model: &SectorModel, directory: &Path) -> Result<(), ModelError> {
    validate(model)?;
    for (index, observed) in model.observed.iter().enumerate() {
        let name = &observed.name;
        if !ObservedNode::is_name(name) {
            return Err(ModelError::NameNotWritable {
                index,
                name: name.clone(),
            });
        }
    }
    let file_error = |path: &Path| {
        let path = path.to_owned();
        |source| ModelError::File { path, source }
    };
    fs::create_dir_all(directory).map_err(file_error(directory))?;
    let old_header = directory.join(FILE_NAME);
    match fs::remove_file(&old_header) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            return Err(file_error(&old_header)(error));
        }
        _ => {}
    }
    let header = Header::new(&model.name, model.sectors, !model.rigid_points.is_empty());
    let files = &header.files;
    for (matrix, comment, name) in [
        (&model.stiffness, "sector stiffness, N/m", &files.stiffness),
        (&model.mass, "sector mass, kg", &files.mass),
        (
            &model.blade_stiffness,
            "share of the blade in the stiffness, N/m",
            &files.blade_stiffness,
        ),
    ] {
        matrix_market::write(matrix, comment, &directory.join(name))?;
    }
    let header_text =
        toml::to_string(&header).map_err(|source| ModelError::HeaderNotWritable { source })?;
    let header_name = FILE_NAME.to_owned();
    let tables = [
        (dofs(model), &files.dofs),
        (cyclic(model), &files.cyclic),
        (contact(model), &files.contact),
        (force(model), &files.force),
        (observe(model), &files.observe),
    ];
    let rigid = files.rigid.iter().map(|name| (rigid(model), name));
    let last = [(header_text, &header_name)];
    for (text, name) in tables.into_iter().chain(rigid).chain(last) {
        let path = directory.join(name);
        fs::write(&path, text).map_err(file_error(&path))?;
    }
    Ok(())
}

// Writing to a string cannot fail, so the results of `writeln!` below are dropped. `{:e}` prints the
// shortest digits that read back as the same number.

fn dofs(model: &SectorModel) -> String {
    let mut text = format!("{DOFS}\n");
    for (index, dof) in model.dofs.iter().enumerate() {
        let [x, y, z] = dof.position_m;
        let body = match dof.body {
            Body::Blisk => "blisk",
            Body::Ring => "ring",
            Body::Damper => "damper",
        };
        let _ = writeln!(
            text,
            "{index},{},{},{x:e},{y:e},{z:e},{body}",
            dof.node, dof.component
        );
    }
    text
}

fn cyclic(model: &SectorModel) -> String {
    let mut text = format!("{CYCLIC}\n");
    for (low, high) in &model.cyclic_pairs {
        let _ = writeln!(text, "{low},{high}");
    }
    text
}

fn rigid(model: &SectorModel) -> String {
    let mut text = format!("{RIGID}\n");
    for point in &model.rigid_points {
        let [x, y, z] = point.position_m;
        let (node, reference) = (point.node, point.reference);
        let _ = writeln!(text, "{node},{reference},{x:e},{y:e},{z:e}");
    }
    text
}

/// Pairs of blisk and ring alone are written as readers of such bundles know them.
fn contact(model: &SectorModel) -> String {
    let pairs = &model.contact_pairs;
    let ring_pairs: Option<Vec<[usize; 2]>> =
        pairs.iter().map(|pair| ring_pair(model, pair)).collect();
    let columns = if ring_pairs.is_some() {
        RING_CONTACT
    } else {
        CONTACT
    };
    let mut text = format!("{columns}\n");
    for (index, pair) in pairs.iter().enumerate() {
        let sides = match &ring_pairs {
            Some(nodes) => format!("{},{}", nodes[index][0], nodes[index][1]),
            None => format!("{},{}", side(pair.first), side(pair.second)),
        };
        let [nr, nt, nz] = pair.normal;
        let _ = writeln!(
            text,
            "{index},{sides},{nr:e},{nt:e},{nz:e},{:e}",
            pair.weight
        );
    }
    text
}

/// Node and sector of a side.
fn side(side: ContactSide) -> String {
    match side {
        ContactSide::Node(node) => format!("{node},0"),
        ContactSide::NextSector(node) => format!("{node},1"),
        ContactSide::Ground => format!("{GROUND},0"),
    }
}

/// Blisk node and ring node of a pair that has these two.
fn ring_pair(model: &SectorModel, pair: &ContactPair) -> Option<[usize; 2]> {
    let on = |side: ContactSide, body: Body| match side {
        ContactSide::Node(node) => {
            let (body_of_node, _) = model.place_of(node)?;
            (body_of_node == body).then_some(node)
        }
        ContactSide::NextSector(_) | ContactSide::Ground => None,
    };
    Some([on(pair.first, Body::Blisk)?, on(pair.second, Body::Ring)?])
}

fn force(model: &SectorModel) -> String {
    let mut text = format!("{FORCE}\n");
    for (dof, value) in &model.force {
        let _ = writeln!(text, "{dof},{:e},{:e}", value.re, value.im);
    }
    text
}

fn observe(model: &SectorModel) -> String {
    let mut text = format!("{OBSERVE}\n");
    for observed in &model.observed {
        let _ = writeln!(text, "{},{}", observed.name, observed.node);
    }
    text
}
