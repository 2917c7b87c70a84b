//! Rigid bodies: how their points move, and a meshed damper body that is made rigid.

use std::collections::BTreeSet;

use super::sector_model::{Body, Component, Dof, RigidPoint, SectorModel};
use crate::linalg::SymmetricSparse;

/// Displacement of a point of a rigid body along `direction`, by unit of each of its six dofs.
///
/// `u(P) = u + w x (P - P_ref)`: `u` and the rotations `w` are in the cylindrical frame at the angle of the reference,
/// `direction` in that at the point's own angle.
#[must_use]
pub fn rigid_motion(
    point_m: [f64; 3],
    reference_m: [f64; 3],
    [along_r, along_theta, along_z]: [f64; 3],
) -> [f64; 6] {
    let angle = |[x, y, _]: [f64; 3]| y.atan2(x);
    let (sin, cos) = (angle(point_m) - angle(reference_m)).sin_cos();
    let d = [
        along_r * cos - along_theta * sin,
        along_r * sin + along_theta * cos,
        along_z,
    ];
    let (sin, cos) = angle(reference_m).sin_cos();
    let [x, y, z] = [0, 1, 2].map(|axis| point_m[axis] - reference_m[axis]);
    let s = [x * cos + y * sin, y * cos - x * sin, z];
    [
        d[0],
        d[1],
        d[2],
        s[1] * d[2] - s[2] * d[1],
        s[2] * d[0] - s[0] * d[2],
        s[0] * d[1] - s[1] * d[0],
    ]
}

/// The model with its meshed damper body made rigid: six dofs at the centre of mass, under a new node number.
///
/// Its mass is `R^T M R` with R the rigid motions of the mesh; its stiffness is `grounding` times that, since a rigid
/// motion strains nothing. The nodes of the body in contact become its points. No force acts on the body, and none of
/// its nodes is observed or on a cyclic face.
pub(super) fn with_rigid_damper(mut model: SectorModel, grounding: f64) -> SectorModel {
    let on_damper = |dof: &Dof| dof.body == Body::Damper;
    let reference_m = centre_of_mass(&model);
    let reference = 1 + model.dofs.iter().map(|dof| dof.node).max().unwrap_or(0);
    let motions = rigid_motions(&model, reference_m);

    let mut kept = vec![None; model.dofs.len()];
    let mut count = 0;
    for (dof, place) in model.dofs.iter().zip(&mut kept) {
        if !on_damper(dof) {
            *place = Some(count);
            count += 1;
        }
    }
    let mut inertia = Vec::new();
    for (column, motion) in motions.iter().enumerate() {
        let moved = model.mass.multiply(motion);
        for (row, other) in motions.iter().enumerate().skip(column) {
            inertia.push((count + row, count + column, dot(other, &moved)));
        }
    }
    let rest = |matrix: &SymmetricSparse, factor: f64| {
        let of_rest = matrix
            .lower_entries()
            .filter_map(|(row, column, value)| Some((kept[row]?, kept[column]?, value)));
        let of_body = inertia.iter().filter(|_| factor != 0.0);
        let of_body = of_body.map(|&(row, column, value)| (row, column, factor * value));
        let triplets: Vec<_> = of_rest.chain(of_body).collect();
        SymmetricSparse::from_lower_triplets(count + motions.len(), &triplets)
    };
    model.stiffness = rest(&model.stiffness, grounding);
    model.mass = rest(&model.mass, 1.0);
    model.blade_stiffness = rest(&model.blade_stiffness, 0.0);
    for (low, high) in &mut model.cyclic_pairs {
        [*low, *high] = [*low, *high].map(|dof| kept[dof].unwrap_or(dof));
    }
    for (dof, _) in &mut model.force {
        *dof = kept[*dof].unwrap_or(*dof);
    }

    let sides = model.contact_pairs.iter();
    let touched: BTreeSet<usize> = sides
        .flat_map(|pair| [pair.first.node(), pair.second.node()])
        .flatten()
        .collect();
    let body = model.dofs.iter().filter(|dof| on_damper(dof));
    model.rigid_points = body
        .filter(|dof| dof.component == Component::Radial && touched.contains(&dof.node))
        .map(|dof| RigidPoint {
            node: dof.node,
            reference,
            position_m: dof.position_m,
        })
        .collect();
    model.dofs.retain(|dof| !on_damper(dof));
    model.dofs.extend(Component::RIGID.map(|component| Dof {
        node: reference,
        component,
        position_m: reference_m,
        body: Body::Damper,
    }));
    model
}

/// Centre of mass of the damper body, m, by its own mass matrix.
fn centre_of_mass(model: &SectorModel) -> [f64; 3] {
    // The body moved along z, and stretched along z by each coordinate.
    let along_z = |value: &dyn Fn([f64; 3]) -> f64| -> Vec<f64> {
        let of = |dof: &Dof| match (dof.body, dof.component) {
            (Body::Damper, Component::Axial) => value(dof.position_m),
            _ => 0.0,
        };
        model.dofs.iter().map(of).collect()
    };
    let moved = model.mass.multiply(&along_z(&|_| 1.0));
    let mass = dot(&along_z(&|_| 1.0), &moved);
    [0, 1, 2].map(|axis| dot(&along_z(&|position_m| position_m[axis]), &moved) / mass)
}

/// The six rigid motions of the damper body on all dofs, by unit of each dof of a reference.
fn rigid_motions(model: &SectorModel, reference_m: [f64; 3]) -> [Vec<f64>; 6] {
    let mut motions = [(); 6].map(|()| vec![0.0; model.dofs.len()]);
    for (place, dof) in model.dofs.iter().enumerate() {
        if dof.body != Body::Damper {
            continue;
        }
        let direction =
            Component::DISPLACEMENTS.map(|component| f64::from(component == dof.component));
        let by_dof = rigid_motion(dof.position_m, reference_m, direction);
        for (motion, value) in motions.iter_mut().zip(by_dof) {
            motion[place] = value;
        }
    }
    motions
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
