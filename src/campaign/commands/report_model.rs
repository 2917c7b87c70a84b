//! The model of a study for its report: masses of its bodies, frequencies, and where its parts are.

use std::collections::BTreeMap;

use super::campbell::{CampbellRequest, campbell};
use crate::model::sector::{Body, Component, ContactSide, SectorModel};
use crate::report::{
    BodyMass, ContactFacts, ContactPlace, ModelSection, PictureNode, SectorPicture, ShownModel,
};
use crate::study::{Study, echo};

/// Modes of each nodal diameter and contact.
const MODES: usize = 6;
/// Nodes of a mesh up to which its neighbours are joined.
const JOINED_NODES: usize = 20_000;

/// The model of a study on `sector`; one without natural frequencies is not shown, and the reason is kept.
pub(super) fn shown_model(study: &Study, sector: &SectorModel) -> ShownModel {
    let models = [(None, sector.clone())];
    let request = CampbellRequest {
        study,
        models: &models,
        engine_orders: &[],
        modes: MODES,
        range_rpm: None,
    };
    match campbell(&request) {
        Ok(campbell) => ShownModel::Shown(Box::new(ModelSection {
            echo: echo(study, sector),
            contact: study.contact.as_ref().map(|contact| ContactFacts {
                law: contact.law.name(),
                friction_coefficient: contact.friction_coefficient,
                tangential_stiffness_n_per_m: contact.tangential_stiffness_n_per_m,
                normal_stiffness_n_per_m: contact.normal_stiffness_n_per_m,
            }),
            masses: masses(sector),
            campbell,
            sector: picture(sector),
        })),
        Err(error) => ShownModel::NotShown {
            reason: error.to_string(),
        },
    }
}

/// Mass of each body: `1^T M 1` over its dofs in one direction. Axial where there is such a dof, as its direction
/// is the same at every node.
fn masses(sector: &SectorModel) -> Vec<BodyMass> {
    let directions = [Component::Axial, Component::Tangential, Component::Radial];
    let of_body = |body: Body| {
        let along = |direction: Component| -> Vec<bool> {
            { sector.dofs.iter() }
                .map(|dof| dof.body == body && dof.component == direction)
                .collect()
        };
        let counted = { directions.into_iter().map(along) }
            .find(|counted| counted.iter().any(|&is_counted| is_counted))?;
        let sector_kg = { sector.mass.lower_entries() }
            .filter(|&(row, column, _)| counted[row] && counted[column])
            .map(|(row, column, kg)| if row == column { kg } else { 2.0 * kg })
            .sum();
        Some(BodyMass { body, sector_kg })
    };
    [Body::Blisk, Body::Ring, Body::Damper]
        .into_iter()
        .filter_map(of_body)
        .collect()
}

fn picture(sector: &SectorModel) -> SectorPicture {
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    let mut nodes = Vec::new();
    for dof in &sector.dofs {
        places.entry(dof.node).or_insert_with(|| {
            nodes.push(PictureNode {
                body: dof.body,
                position_m: dof.position_m,
            });
            nodes.len() - 1
        });
    }
    let position = |node: usize| sector.place_of(node).map(|(_, position_m)| position_m);
    let side = |side: ContactSide| match side {
        ContactSide::Node(node) => position(node),
        ContactSide::NextSector(node) => {
            position(node).map(|position_m| advanced(position_m, sector.sectors))
        }
        ContactSide::Ground => None,
    };
    let contacts = { sector.contact_pairs.iter() }
        .filter_map(|pair| {
            Some(ContactPlace {
                first_m: side(pair.first)?,
                second_m: side(pair.second),
                weight: pair.weight,
            })
        })
        .collect();
    let forces = std::iter::once(&sector.force).chain(&sector.load_case_forces);
    let mut forced: Vec<usize> = forces
        .flatten()
        .filter(|(_, newtons)| newtons.norm_sqr() > 0.0)
        .map(|&(dof, _)| sector.dofs[dof].node)
        .collect();
    forced.sort_unstable();
    forced.dedup();
    let is_of_masses = nodes.len() == sector.dofs.len();
    let mut links = coupled(sector, &places);
    if !is_of_masses {
        links = neighbours(&nodes, &links);
    }
    SectorPicture {
        is_of_masses,
        links,
        nodes,
        contacts,
        forced_m: forced.into_iter().filter_map(position).collect(),
        observed_m: { sector.observed.iter() }
            .filter_map(|observed| position(observed.node))
            .collect(),
    }
}

/// Pairs of nodes with a stiffness between them.
fn coupled(sector: &SectorModel, places: &BTreeMap<usize, usize>) -> Vec<(usize, usize)> {
    if places.len() > JOINED_NODES {
        return Vec::new();
    }
    let of_dof: Vec<usize> = { sector.dofs.iter() }
        .map(|dof| places[&dof.node])
        .collect();
    let mut pairs: Vec<(usize, usize)> = { sector.stiffness.lower_entries() }
        .filter(|&(_, _, stiffness)| stiffness.abs() > 0.0)
        .map(|(row, column, _)| (of_dof[column], of_dof[row]))
        .filter(|(a, b)| a != b)
        .map(|(a, b)| (a.min(b), a.max(b)))
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The pairs that no third node coupled to both lies between: the relative neighbours of Toussaint (1980), which are
/// the edges of elements and not the diagonals through them.
fn neighbours(nodes: &[PictureNode], coupled: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for &(a, b) in coupled {
        beside[a].push(b);
        beside[b].push(a);
    }
    let distance = |a: usize, b: usize| {
        let (a, b) = (nodes[a].position_m, nodes[b].position_m);
        let squares = [0, 1, 2].map(|axis| (a[axis] - b[axis]).powi(2));
        squares.iter().sum::<f64>()
    };
    let between = |a: usize, b: usize| {
        // Rounding must not part the sides of a cube.
        let length = (1.0 - 1e-6) * distance(a, b);
        { beside[a].iter() }.any(|&c| c != b && distance(a, c) < length && distance(b, c) < length)
    };
    let kept = coupled.iter().filter(|&&(a, b)| !between(a, b));
    kept.copied().collect()
}

/// The position `[x, y, z]`, m, turned about the z axis to the same place in the next sector.
fn advanced([x, y, z]: [f64; 3], sectors: usize) -> [f64; 3] {
    let (sin, cos) = (std::f64::consts::TAU / sectors as f64).sin_cos();
    [cos * x - sin * y, sin * x + cos * y, z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sector::{ParametricOptions, parametric};

    #[test]
    fn the_mass_of_the_ring_is_that_of_its_section_times_its_circumference() {
        let options = ParametricOptions::default();
        let sector = parametric::build(&options).expect("a sector");
        let found = masses(&sector);
        let ring = found.iter().find(|body_mass| body_mass.body == Body::Ring);
        let outer_m = options.rim_radius_m - options.flange_thickness_m;
        let inner_m = outer_m - options.ring_thickness_m;
        let section_m2 = std::f64::consts::PI * (outer_m.powi(2) - inner_m.powi(2));
        let wheel_kg = options.ring_density_kg_per_m3 * options.ring_axial_width_m * section_m2;
        let sector_kg = wheel_kg / options.sectors as f64;
        let error = ring.expect("a ring").sector_kg / sector_kg - 1.0;
        // Elements follow the arc by parabolas.
        assert!(error.abs() < 1e-4, "{error}");
    }

    #[test]
    fn neighbours_in_a_brick_are_its_edges_and_not_its_diagonals() {
        let nodes: Vec<PictureNode> = (0..8)
            .map(|corner| PictureNode {
                body: Body::Blisk,
                position_m: [
                    f64::from(corner & 1),
                    0.4 * f64::from((corner >> 1) & 1),
                    0.1 * f64::from((corner >> 2) & 1),
                ],
            })
            .collect();
        // An element couples each of its nodes with every other.
        let coupled: Vec<(usize, usize)> = (0..8)
            .flat_map(|a| (a + 1..8).map(move |b| (a, b)))
            .collect();
        let found = neighbours(&nodes, &coupled);
        assert_eq!(found.len(), 12, "{found:?}");
        for (a, b) in found {
            assert_eq!((a ^ b).count_ones(), 1, "corners {a} and {b}");
        }
    }
}
