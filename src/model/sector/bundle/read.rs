//! Reading a bundle.

use std::path::Path;

use super::header::{FILE_NAME, Header};
use super::table::{Table, read_text};
use crate::linalg::Complex64;
use crate::model::sector::contact_problem::ContactProblem;
use crate::model::sector::error::ModelError;
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::matrix_market::{self, integer, number};
use crate::model::sector::sector_model::{
    Body, Component, ContactPair, ContactSide, Dof, ObservedNode, RigidPoint, SectorModel,
};
use crate::model::sector::validate::validate;

/// Columns of each table.
pub(super) const DOFS: &str = "dof,node,component,x,y,z,body";
pub(super) const CYCLIC: &str = "low_dof,high_dof";
pub(super) const RING_CONTACT: &str = "pair,blisk_node,ring_node,nr,nt,nz,weight";
pub(super) const CONTACT: &str =
    "pair,first_node,first_sector,second_node,second_sector,nr,nt,nz,weight";
/// The second node of a pair with the ground.
pub(super) const GROUND: &str = "ground";
pub(super) const FORCE: &str = "dof,re,im";
pub(super) const OBSERVE: &str = "name,node";
pub(super) const RIGID: &str = "node,reference,x,y,z";

/// Reads the bundle in `directory` and validates it.
///
/// # Errors
/// A file that is missing, a line that is not what the format says, or a model that is refused.
pub fn read(directory: &Path) -> Result<SectorModel, ModelError> {
    let header_path = directory.join(FILE_NAME);
    let header =
        Header::parse(&read_text(&header_path)?).map_err(|(line, problem)| ModelError::Line {
            path: header_path,
            line,
            problem,
        })?;
    let files = &header.files;
    let contact = directory.join(&files.contact);
    let contact = Table::read_either(contact, [RING_CONTACT, CONTACT])?;
    let is_ring_contact = contact.columns() == RING_CONTACT;
    let model = SectorModel {
        name: header.name,
        sectors: header.sectors,
        stiffness: matrix_market::read(&directory.join(&files.stiffness))?,
        mass: matrix_market::read(&directory.join(&files.mass))?,
        blade_stiffness: matrix_market::read(&directory.join(&files.blade_stiffness))?,
        dofs: Table::read(directory.join(&files.dofs), DOFS)?.rows(parse_dof)?,
        cyclic_pairs: Table::read(directory.join(&files.cyclic), CYCLIC)?.rows(parse_cyclic)?,
        rigid_points: match &files.rigid {
            Some(name) => Table::read(directory.join(name), RIGID)?.rows(parse_rigid)?,
            None => Vec::new(),
        },
        contact_pairs: if is_ring_contact {
            contact.rows(parse_ring_contact)?
        } else {
            contact.rows(parse_contact)?
        },
        force: Table::read(directory.join(&files.force), FORCE)?.rows(parse_force)?,
        load_case_forces: Vec::new(),
        observed: Table::read(directory.join(&files.observe), OBSERVE)?.rows(parse_observed)?,
    };
    validate(&model)?;
    if is_ring_contact {
        check_bodies(&model)?;
    }
    Ok(model)
}

/// Refuses a pair that is not of blisk and ring, as the columns of its file say.
fn check_bodies(model: &SectorModel) -> Result<(), ModelError> {
    for (pair, contact) in model.contact_pairs.iter().enumerate() {
        for (side, body) in [(contact.first, Body::Blisk), (contact.second, Body::Ring)] {
            let elsewhere = |&node: &usize| {
                let place = model.place_of(node);
                place.is_some_and(|(body_of_node, _)| body_of_node != body)
            };
            if let Some(node) = side.node().filter(elsewhere) {
                return Err(ModelError::Contact {
                    pair,
                    problem: ContactProblem::Body { node },
                });
            }
        }
    }
    Ok(())
}

/// Reads a force vector as a bundle has it: `dof,re,im`, in N.
///
/// # Errors
/// A file that is missing, or a line that is not what the format says.
pub fn read_force(path: &Path) -> Result<Vec<(usize, Complex64)>, ModelError> {
    Table::read(path.to_owned(), FORCE)?.rows(parse_force)
}

fn parse_dof(
    index: usize,
    [dof, node, component, x, y, z, body]: [&str; 7],
) -> Result<Dof, LineProblem> {
    in_order("dof", dof, index)?;
    Ok(Dof {
        node: integer("node", node)?,
        component: match component {
            "r" => Component::Radial,
            "t" => Component::Tangential,
            "z" => Component::Axial,
            "rr" => Component::RotationRadial,
            "rt" => Component::RotationTangential,
            "rz" => Component::RotationAxial,
            other => return Err(not_a_word("component", other, "r, t, z, rr, rt or rz")),
        },
        position_m: [number("x", x)?, number("y", y)?, number("z", z)?],
        body: match body {
            "blisk" => Body::Blisk,
            "ring" => Body::Ring,
            "damper" => Body::Damper,
            other => return Err(not_a_word("body", other, "blisk, ring or damper")),
        },
    })
}

fn parse_cyclic(_: usize, [low, high]: [&str; 2]) -> Result<(usize, usize), LineProblem> {
    Ok((integer("low_dof", low)?, integer("high_dof", high)?))
}

fn parse_rigid(_: usize, [node, reference, x, y, z]: [&str; 5]) -> Result<RigidPoint, LineProblem> {
    Ok(RigidPoint {
        node: integer("node", node)?,
        reference: integer("reference", reference)?,
        position_m: [number("x", x)?, number("y", y)?, number("z", z)?],
    })
}

fn parse_contact(
    index: usize,
    [
        pair,
        first,
        first_sector,
        second,
        second_sector,
        nr,
        nt,
        nz,
        weight,
    ]: [&str; 9],
) -> Result<ContactPair, LineProblem> {
    in_order("pair", pair, index)?;
    let first = side("first_node", first, "first_sector", first_sector)?;
    let second = if second == GROUND {
        ContactSide::Ground
    } else {
        side("second_node", second, "second_sector", second_sector)?
    };
    Ok(ContactPair {
        first,
        second,
        normal: [number("nr", nr)?, number("nt", nt)?, number("nz", nz)?],
        weight: number("weight", weight)?,
        load_weight: None,
    })
}

/// A node of the sector (0) or of the next one (1).
fn side(
    node_field: &'static str,
    node: &str,
    sector_field: &'static str,
    sector: &str,
) -> Result<ContactSide, LineProblem> {
    let node = integer(node_field, node)?;
    match sector {
        "0" => Ok(ContactSide::Node(node)),
        "1" => Ok(ContactSide::NextSector(node)),
        other => Err(not_a_word(sector_field, other, "0 or 1, the next sector")),
    }
}

fn parse_ring_contact(
    index: usize,
    [pair, blisk_node, ring_node, nr, nt, nz, weight]: [&str; 7],
) -> Result<ContactPair, LineProblem> {
    in_order("pair", pair, index)?;
    Ok(ContactPair {
        first: ContactSide::Node(integer("blisk_node", blisk_node)?),
        second: ContactSide::Node(integer("ring_node", ring_node)?),
        normal: [number("nr", nr)?, number("nt", nt)?, number("nz", nz)?],
        weight: number("weight", weight)?,
        load_weight: None,
    })
}

fn parse_force(_: usize, [dof, re, im]: [&str; 3]) -> Result<(usize, Complex64), LineProblem> {
    Ok((
        integer("dof", dof)?,
        Complex64::new(number("re", re)?, number("im", im)?),
    ))
}

fn parse_observed(_: usize, [name, node]: [&str; 2]) -> Result<ObservedNode, LineProblem> {
    if name.is_empty() {
        return Err(not_a_word("name", name, "a name"));
    }
    Ok(ObservedNode {
        name: name.to_owned(),
        node: integer("node", node)?,
    })
}

/// An index that must equal the row's own.
fn in_order(field: &'static str, word: &str, expected: usize) -> Result<(), LineProblem> {
    let found = integer(field, word)?;
    if found == expected {
        Ok(())
    } else {
        Err(LineProblem::OutOfOrder {
            field,
            found,
            expected,
        })
    }
}

fn not_a_word(field: &'static str, found: &str, accepted: &'static str) -> LineProblem {
    LineProblem::NotAWord {
        field,
        found: found.to_owned(),
        accepted,
    }
}
