//! What an import found, for the user to judge it by.

use std::fmt;

use serde::Serialize;

use super::problem::body_name;
use crate::model::sector::sector_model::Body;

/// Where the blade's stiffness comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BladeSource {
    /// Matrices of a run with the blade alone.
    Matrices,
    /// Assembled here from the elements of the blade.
    Elements,
}

/// One body of the sector.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyReport {
    /// `blisk`, `ring` or `damper`.
    pub body: &'static str,
    /// Free nodes.
    pub nodes: usize,
    /// Dofs, both cyclic faces included.
    pub dofs: usize,
    /// Mass of the free nodes, kg: without that which the held nodes carry.
    pub mass_kg: f64,
    /// Whether the mass couples no two nodes: it is lumped, or the entries that would do so were lost.
    pub mass_is_lumped: bool,
    /// What is added to the node numbers of the file.
    pub node_offset: usize,
    /// A static step stands before the matrices; none where the files do not tell.
    pub prestressed: Option<bool>,
    /// Speed of the centrifugal load in the run, rad/s.
    pub rotation_rad_per_s: Option<f64>,
    /// Pairs of nodes on the cyclic faces; 0 for a damper, which has none.
    pub cyclic_node_pairs: usize,
    /// Largest distance between a node of the high face and its image of the low face, m.
    pub worst_face_mismatch_m: f64,
    /// Largest force by a unit shift along the axis, over the largest diagonal stiffness: nought where
    /// nothing holds the body; none where something does.
    pub rigid_shift_residual: Option<f64>,
}

/// Two surfaces in contact.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SurfacesReport {
    /// The first side as an import file spells it, `BODY.SET`.
    pub first: String,
    /// The second side, or `ground`.
    pub second: String,
    /// Pairs of a sector.
    pub pairs: usize,
    /// Largest distance between the nodes of a pair, m.
    pub worst_distance_m: f64,
    /// Largest distance accepted, m.
    pub tolerance_m: f64,
    /// Largest angle between the first side's normal and the opposite of the second's, degrees.
    pub worst_normal_angle_deg: f64,
    /// Area of a sector's contact, m^2 (the number of nodes where normals were given).
    pub area_m2: f64,
    /// Nodes of the second side that no node of the first meets.
    pub second_nodes_without_pair: usize,
}

impl SurfacesReport {
    /// What they have beyond the contact as a whole, which is all that there is to say of one among several.
    fn write(&self, f: &mut fmt::Formatter<'_>, is_one_of_several: bool) -> fmt::Result {
        let (first, second) = (&self.first, &self.second);
        if is_one_of_several {
            writeln!(
                f,
                "  {first} on {second}: {} pairs, worst distance {:.2e} m, normals within {:.2} degrees",
                self.pairs, self.worst_distance_m, self.worst_normal_angle_deg
            )?;
        }
        match self.second_nodes_without_pair {
            0 => Ok(()),
            count if first.starts_with("blisk.") && second.starts_with("ring.") => writeln!(
                f,
                "  {count} nodes of the ring's surface meet no node of the blisk"
            ),
            count => writeln!(f, "  {count} nodes of {second} meet no node of {first}"),
        }
    }
}

/// The contact of a sector: that of all its surfaces.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ContactReport {
    /// Pairs of a sector.
    pub pairs: usize,
    /// Largest distance between the nodes of a pair, m.
    pub worst_distance_m: f64,
    /// Largest distance accepted, m.
    pub tolerance_m: f64,
    /// Largest angle between the first side's normal and the opposite of the second's, degrees.
    pub worst_normal_angle_deg: f64,
    /// Area of a sector's contact, m^2 (the number of nodes where normals were given).
    pub area_m2: f64,
    /// Nodes of the ring that were projected on the blisk's faces, where the meshes do not match.
    pub projected_ring_nodes: Option<usize>,
    /// Pairs without a displacement along their normal, whose load is constant under every contact law.
    /// Absent: every pair has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub constant_load_pairs: Option<usize>,
    /// Pairs without a displacement across their normal, in which nothing can rub. Absent: every pair has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pairs_without_friction: Option<usize>,
    /// Nodes of the second sides (the ring's surface) that no node of the first meets.
    pub ring_nodes_without_pair: usize,
    /// Each two surfaces.
    pub surfaces: Vec<SurfacesReport>,
}

impl ContactReport {
    /// What the surfaces are as a whole, each of several, and which pairs do less than others.
    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "contact: {} pairs, worst distance {:.2e} m (tolerance {:.2e} m), normals within {:.2} degrees, area {:.6e} m^2",
            self.pairs,
            self.worst_distance_m,
            self.tolerance_m,
            self.worst_normal_angle_deg,
            self.area_m2
        )?;
        if let Some(nodes) = self.projected_ring_nodes {
            writeln!(
                f,
                "  {nodes} nodes of the ring follow the nodes of the blisk's faces"
            )?;
        }
        for surface in &self.surfaces {
            surface.write(f, self.surfaces.len() > 1)?;
        }
        if let Some(pairs) = self.constant_load_pairs {
            writeln!(
                f,
                "  {pairs} pairs have no displacement along their normal: their normal load is constant under every contact law"
            )?;
        }
        if let Some(pairs) = self.pairs_without_friction {
            writeln!(
                f,
                "  {pairs} pairs have no displacement across their normal: they have no direction to rub in"
            )?;
        }
        Ok(())
    }
}

/// Facts about an import.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportReport {
    /// Name of the model.
    pub name: String,
    /// Sectors of the wheel.
    pub sectors: usize,
    /// Tolerance on the cyclic faces, m.
    pub position_tolerance_m: f64,
    /// Whether the high face was put where the low face turned by a sector is, as the two are further
    /// apart than a bundle allows, yet within the tolerance.
    pub high_face_moved: bool,
    /// Bodies.
    pub bodies: Vec<BodyReport>,
    /// Source of the blade's stiffness.
    pub blade_source: BladeSource,
    /// Dofs that the blade's stiffness acts on.
    pub blade_dofs: usize,
    /// Contact; none of a blisk alone.
    pub contact: Option<ContactReport>,
    /// Frequency by which the ring is grounded, Hz.
    pub ring_grounding_hz: f64,
    /// Frequency by which the damper is grounded, Hz.
    pub damper_grounding_hz: f64,
    /// Forced dofs.
    pub forced_dofs: usize,
    /// Observed nodes, by name and number.
    pub observed: Vec<(String, usize)>,
}

impl fmt::Display for ImportReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {} sectors", self.name, self.sectors)?;
        for body in &self.bodies {
            write!(
                f,
                "{}: {} free nodes, {} dofs, {:.6} kg",
                body.body, body.nodes, body.dofs, body.mass_kg
            )?;
            match (body.prestressed, body.rotation_rad_per_s) {
                (Some(true), Some(speed)) => writeln!(
                    f,
                    ", prestressed by rotation at {speed:.6} rad/s ({:.3} rpm)",
                    speed * 30.0 / std::f64::consts::PI
                )?,
                (Some(true), None) => writeln!(f, ", prestressed by a static step")?,
                (Some(false), _) => writeln!(f, ", not prestressed")?,
                (None, _) => writeln!(f)?,
            }
            if body.body != body_name(Body::Damper) {
                writeln!(
                    f,
                    "  cyclic faces: {} node pairs, worst mismatch {:.2e} m (tolerance {:.2e} m)",
                    body.cyclic_node_pairs, body.worst_face_mismatch_m, self.position_tolerance_m
                )?;
            }
            if let Some(residual) = body.rigid_shift_residual {
                writeln!(
                    f,
                    "  force of a rigid shift along the axis: {residual:.1e} of the stiffness"
                )?;
            }
            if body.mass_is_lumped {
                writeln!(
                    f,
                    "  the mass couples no two nodes: it is lumped (if it should not be, one triangle of it was lost)"
                )?;
            }
            if body.node_offset > 0 {
                writeln!(f, "  node numbers of its file + {}", body.node_offset)?;
            }
        }
        if self.high_face_moved {
            writeln!(
                f,
                "the nodes of the high face are written at the low face turned by a sector"
            )?;
        }
        let source = match self.blade_source {
            BladeSource::Matrices => "matrices of the blade alone",
            BladeSource::Elements => "elements assembled here",
        };
        writeln!(f, "blade: {} dofs, from {source}", self.blade_dofs)?;
        if let Some(contact) = &self.contact {
            contact.write(f)?;
        }
        for (body, hz) in [
            (Body::Ring, self.ring_grounding_hz),
            (Body::Damper, self.damper_grounding_hz),
        ] {
            let name = body_name(body);
            if self.bodies.iter().any(|report| report.body == name) {
                writeln!(f, "{name} grounded at {hz} Hz")?;
            }
        }
        let observed: Vec<String> = self
            .observed
            .iter()
            .map(|(name, node)| format!("{name} (node {node})"))
            .collect();
        write!(
            f,
            "{} forced dofs, observed: {}",
            self.forced_dofs,
            observed.join(", ")
        )
    }
}
