//! The built-in bladed disk with its damper: options to sector model.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::error::ModelError;
use super::parametric_cylinder::Cylinder;
use super::parametric_mesh::ParametricMesh;
use super::parametric_options::{Damper, DamperBody, ParametricOptions};
use super::rigid::with_rigid_damper;
use super::sector_model::{Body, Component, ObservedNode, SectorModel};
use super::validate::validate;
use crate::linalg::{Complex64, SymmetricSparse};

/// Builds the sector of the built-in bladed disk.
///
/// 1 N acts on the leading edge of the tip, normal to the tip's chord: `(cos, -sin)` of the tip's stagger
/// angle in (theta, z). Observed are `tip_le` and `tip_te`, at mid-thickness. The contact pairs are corner nodes that
/// face each other, off the cyclic faces, each with its share of the contact surface (see the mesh): of flange and ring,
/// of platforms and the body between them, of neighbouring shrouds, or of the platform's underside and the ground.
///
/// # Errors
/// If an option is out of range or the geometry folds an element.
pub fn build(options: &ParametricOptions) -> Result<SectorModel, ModelError> {
    options.check()?;
    if let Some(cylinder) = Cylinder::of(options) {
        cylinder.check(options)?;
    }
    let layout = ParametricMesh::new(options);
    let assembled = layout.mesh.assemble()?;
    let first_dof: HashMap<usize, usize> = assembled
        .dofs
        .iter()
        .enumerate()
        .filter(|(_, dof)| dof.component == Component::Radial)
        .map(|(index, dof)| (dof.node, index))
        .collect();
    let is_loose: Vec<bool> = assembled
        .dofs
        .iter()
        .map(|dof| dof.body != Body::Blisk)
        .collect();
    let grounding = (TAU * options.ring_grounding_frequency_hz).powi(2);
    let stiffness = grounded(&assembled.stiffness, &assembled.mass, &is_loose, grounding);

    let mut cyclic_pairs = Vec::new();
    for (low, high) in layout.face_nodes() {
        if let (Some(low), Some(high)) = (first_dof.get(&low), first_dof.get(&high)) {
            cyclic_pairs.extend((0..3).map(|component| (low + component, high + component)));
        }
    }
    cyclic_pairs.sort_unstable();
    let contact_pairs = layout.contact_pairs();
    let mut force = Vec::new();
    let mut observed = Vec::new();
    if let Some((leading, trailing)) = layout.tip_nodes() {
        let stagger = (options.blade_stagger_angle_deg + options.blade_twist_deg).to_radians();
        let tip = first_dof[&leading];
        force.push((tip + 1, Complex64::new(stagger.cos(), 0.0)));
        force.push((tip + 2, Complex64::new(-stagger.sin(), 0.0)));
        observed.push(ObservedNode {
            name: "tip_le".to_owned(),
            node: leading,
        });
        observed.push(ObservedNode {
            name: "tip_te".to_owned(),
            node: trailing,
        });
    }
    let mut model = SectorModel {
        name: "parametric".to_owned(),
        sectors: options.sectors,
        stiffness,
        mass: assembled.mass,
        blade_stiffness: assembled.blade_stiffness,
        dofs: assembled.dofs,
        cyclic_pairs,
        contact_pairs,
        force,
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed,
    };
    if options.damper == Damper::Underplatform && options.damper_body == DamperBody::Rigid {
        model = with_rigid_damper(model, grounding);
    }
    validate(&model)?;
    Ok(model)
}

/// `K + grounding M` on the dofs of ring or damper.
fn grounded(
    stiffness: &SymmetricSparse,
    mass: &SymmetricSparse,
    is_loose: &[bool],
    grounding: f64,
) -> SymmetricSparse {
    let on_damper = mass
        .lower_entries()
        .filter(|&(row, column, _)| is_loose[row] && is_loose[column])
        .map(|(row, column, value)| (row, column, grounding * value));
    let triplets: Vec<_> = stiffness.lower_entries().chain(on_damper).collect();
    SymmetricSparse::from_lower_triplets(stiffness.dimension(), &triplets)
}
