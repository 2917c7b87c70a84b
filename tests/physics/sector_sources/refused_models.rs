//! Sector models that are refused, one case per kind, each with its place and value.

use std::sync::LazyLock;

use blisk::linalg::{Complex64, SymmetricSparse};
use blisk::model::sector::{
    Body, Component, ContactPair, ContactProblem, ContactSide, Dof, ModelError, ObservedNode,
    SectorModel, bundle, validate,
};

use super::data;

static WHEEL: LazyLock<SectorModel> = LazyLock::new(|| bundle::read(&data("wheel24")).unwrap());

/// The same matrix with some entries replaced or added.
fn with(matrix: &SymmetricSparse, row: usize, column: usize, value: f64) -> SymmetricSparse {
    let mut triplets: Vec<_> = matrix
        .lower_entries()
        .filter(|&(i, j, _)| (i, j) != (row, column))
        .collect();
    triplets.push((row, column, value));
    SymmetricSparse::from_lower_triplets(matrix.dimension(), &triplets)
}

/// A high dof, an inner dof and the node of each.
fn high_dof(model: &SectorModel) -> usize {
    model.cyclic_pairs[0].1
}

fn is_contact(error: &ModelError, is: fn(&ContactProblem) -> bool) -> bool {
    matches!(error, ModelError::Contact { problem, .. } if is(problem))
}

struct Case {
    name: &'static str,
    spoil: fn(&mut SectorModel),
    kind: fn(&ModelError) -> bool,
    message: &'static str,
}

/// The diagonal alone: what is left where the wrong triangle was kept.
fn diagonal(matrix: &SymmetricSparse) -> SymmetricSparse {
    let entries: Vec<_> = matrix.lower_entries().filter(|&(i, j, _)| i == j).collect();
    SymmetricSparse::from_lower_triplets(matrix.dimension(), &entries)
}

/// A lumped mass is one.
#[test]
fn a_mass_without_couplings_is_accepted() {
    let mut model = WHEEL.clone();
    model.mass = diagonal(&model.mass);
    validate(&model).unwrap();
}

const MATRIX_CASES: [Case; 11] = [
    Case {
        name: "K without couplings",
        spoil: |m| m.stiffness = diagonal(&m.stiffness),
        kind: |e| matches!(e, ModelError::NoCouplings { .. }),
        message: "K couples none of the",
    },
    Case {
        name: "K_blade without couplings",
        spoil: |m| m.blade_stiffness = diagonal(&m.blade_stiffness),
        kind: |e| matches!(e, ModelError::NoCouplings { .. }),
        message: "K_blade couples none of the",
    },
    Case {
        name: "no sectors",
        spoil: |m| m.sectors = 0,
        kind: |e| matches!(e, ModelError::NoSectors),
        message: "sectors is 0",
    },
    Case {
        name: "no dofs",
        spoil: |m| m.dofs.clear(),
        kind: |e| matches!(e, ModelError::NoDofs),
        message: "at least 1",
    },
    Case {
        name: "wrong size",
        spoil: |m| m.mass = SymmetricSparse::from_lower_triplets(3, &[]),
        kind: |e| matches!(e, ModelError::MatrixSize { .. }),
        message: "M is 3 x 3 but there are 1068 dofs",
    },
    Case {
        name: "NaN in K",
        spoil: |m| m.stiffness = with(&m.stiffness, 7, 5, f64::NAN),
        kind: |e| matches!(e, ModelError::NotFinite { .. }),
        message: "K entry (dof 7, dof 5) is NaN",
    },
    Case {
        name: "negative mass",
        spoil: |m| m.mass = with(&m.mass, 7, 7, -0.5),
        kind: |e| matches!(e, ModelError::NegativeDiagonal { .. }),
        message: "M has -5e-1 on the diagonal of dof 7",
    },
    Case {
        name: "indefinite mass",
        spoil: |m| m.mass = with(&m.mass, 7, 5, 3.0),
        kind: |e| matches!(e, ModelError::Indefinite { .. }),
        message: "(dof 7, dof 5) is 3e0",
    },
    Case {
        name: "blade entry outside K",
        spoil: |m| {
            // A small coupling of two blade dofs that K does not have.
            let (row, column) = (617, 409);
            let entries: Vec<_> = m
                .stiffness
                .lower_entries()
                .filter(|&(i, j, _)| (i, j) != (row, column))
                .collect();
            m.stiffness = SymmetricSparse::from_lower_triplets(1068, &entries);
            m.blade_stiffness = with(&m.blade_stiffness, row, column, 1e-3);
        },
        kind: |e| matches!(e, ModelError::BladeEntryOutsideStiffness { .. }),
        message: "K_blade has 1e-3 at (dof 617, dof 409)",
    },
    Case {
        name: "blade share above K",
        spoil: |m| m.blade_stiffness = with(&m.blade_stiffness, 616, 616, 1e15),
        kind: |e| matches!(e, ModelError::BladeShareExceedsStiffness { .. }),
        message: "K_blade has 1e15 on the diagonal of dof 616",
    },
    Case {
        name: "blade stiffness on the high face",
        spoil: |m| m.blade_stiffness = with(&m.blade_stiffness, high_dof(m), high_dof(m), 1.0),
        kind: |e| matches!(e, ModelError::OnHighFace { .. }),
        message: "dof 9 on the high cyclic face",
    },
];

const DOF_CASES: [Case; 10] = [
    Case {
        name: "position not finite",
        spoil: |m| m.dofs[4].position_m[1] = f64::INFINITY,
        kind: |e| matches!(e, ModelError::NotFinite { .. }),
        message: "y of dof 4 is inf",
    },
    Case {
        name: "dof twice",
        spoil: |m| m.dofs[4].component = Component::Radial,
        kind: |e| matches!(e, ModelError::DuplicateDof { .. }),
        message: "dofs 3 and 4 are both component r",
    },
    Case {
        name: "node in two places",
        spoil: |m| m.dofs[4].position_m[0] += 1e-3,
        kind: |e| matches!(e, ModelError::NodeInconsistent { .. }),
        message: "dofs 3 and 4 of node",
    },
    Case {
        name: "cyclic dof out of range",
        spoil: |m| m.cyclic_pairs[2].1 = 5000,
        kind: |e| matches!(e, ModelError::DofOutOfRange { .. }),
        message: "cyclic pair 2 refers to dof 5000; accepted: 0 to 1067",
    },
    Case {
        name: "cyclic dof twice",
        spoil: |m| m.cyclic_pairs[2].1 = m.cyclic_pairs[1].1,
        kind: |e| matches!(e, ModelError::CyclicDuplicate { .. }),
        message: "cyclic pair 2 refers to dof 10, which cyclic pair 1 has too",
    },
    Case {
        name: "cyclic components differ",
        spoil: |m| {
            let (first, second) = (m.cyclic_pairs[0].1, m.cyclic_pairs[1].1);
            m.cyclic_pairs[0].1 = second;
            m.cyclic_pairs[1].1 = first;
        },
        kind: |e| matches!(e, ModelError::CyclicMismatch { .. }),
        message: "cyclic pair 0 (dofs 0 and 10)",
    },
    Case {
        name: "cyclic nodes not one sector apart",
        spoil: |m| m.sectors = 25,
        kind: |e| matches!(e, ModelError::CyclicPosition { .. }),
        message: "cyclic pair 0 (dofs 0 and 9)",
    },
    Case {
        name: "one component unpaired",
        spoil: |m| {
            m.cyclic_pairs.remove(1);
        },
        kind: |e| matches!(e, ModelError::CyclicUnpaired { .. }),
        message: "component t of node 0",
    },
    Case {
        name: "a node unpaired",
        spoil: |m| {
            m.cyclic_pairs.drain(0..3);
        },
        kind: |e| matches!(e, ModelError::CyclicUnpaired { .. }),
        message: "dof 0 (component r of node 0)",
    },
    Case {
        name: "faces swapped",
        spoil: |m| {
            for pair in &mut m.cyclic_pairs {
                *pair = (pair.1, pair.0);
            }
        },
        kind: |e| matches!(e, ModelError::CyclicPosition { .. }),
        message: "off the low node turned by one sector",
    },
];

const CONTACT_CASES: [Case; 14] = [
    Case {
        name: "contact node unknown",
        spoil: |m| m.contact_pairs[1].second = ContactSide::Node(9999),
        kind: |e| matches!(e, ModelError::NodeUnknown { .. }),
        message: "contact pair 1 refers to node 9999",
    },
    Case {
        name: "contact on the high face",
        spoil: |m| m.contact_pairs[1].first = ContactSide::Node(m.dofs[high_dof(m)].node),
        kind: |e| matches!(e, ModelError::OnHighFace { .. }),
        message: "contact pair 1 refers to node",
    },
    Case {
        name: "contact of a point with itself",
        spoil: |m| m.contact_pairs[1].second = m.contact_pairs[1].first,
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Sides { .. })),
        message: "contact pair 1: it joins node 302 and node 302",
    },
    Case {
        name: "contact of the ground",
        spoil: |m| m.contact_pairs[1].first = ContactSide::Ground,
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Sides { .. })),
        message: "contact pair 1: it joins the ground and node",
    },
    Case {
        name: "contact across a wheel of one sector",
        spoil: |m| {
            m.sectors = 1;
            m.cyclic_pairs.clear();
            let node = m.contact_pairs[1].first.node().unwrap();
            m.contact_pairs[1].second = ContactSide::NextSector(node);
        },
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::OneSector)),
        message: "contact pair 1: it reaches the next sector of a wheel of one sector",
    },
    Case {
        name: "contact with a point of the next sector that is elsewhere",
        spoil: |m| {
            let node = m.contact_pairs[1].second.node().unwrap();
            m.contact_pairs[1].second = ContactSide::NextSector(node);
        },
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Angle { .. })),
        message: "of the next sector are 2.6",
    },
    Case {
        name: "a damper that nothing holds",
        spoil: |m| {
            let node = m.dofs.iter().map(|dof| dof.node).max().unwrap() + 1;
            let dof = Dof {
                node,
                body: Body::Damper,
                ..m.dofs[0].clone()
            };
            m.dofs.push(dof);
            let n = m.dofs.len();
            let grown = |matrix: &SymmetricSparse, own: f64| {
                let entries = matrix.lower_entries().chain([(n - 1, n - 1, own)]);
                SymmetricSparse::from_lower_triplets(n, &entries.collect::<Vec<_>>())
            };
            m.stiffness = grown(&m.stiffness, 1.0);
            m.mass = grown(&m.mass, 1.0);
            m.blade_stiffness = grown(&m.blade_stiffness, 0.0);
        },
        kind: |e| matches!(e, ModelError::DamperWithoutContact { .. }),
        message: "belongs to a damper that no contact pair touches",
    },
    Case {
        name: "contact pair twice",
        spoil: |m| {
            let pair: ContactPair = m.contact_pairs[0].clone();
            m.contact_pairs.push(pair);
        },
        kind: |e| matches!(e, ModelError::ContactDuplicate { .. }),
        message: "contact pairs 0 and 6",
    },
    Case {
        name: "contact nodes at different angles",
        spoil: |m| m.contact_pairs[0].second = m.contact_pairs[2].second,
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Angle { .. })),
        message: "contact pair 0: node 269 and node 341",
    },
    Case {
        name: "normal not of unit length",
        spoil: |m| m.contact_pairs[2].normal = [-2.0, 0.0, 0.0],
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Normal { .. })),
        message: "contact pair 2: the normal has length 2",
    },
    Case {
        name: "normal not finite",
        spoil: |m| m.contact_pairs[2].normal[1] = f64::NAN,
        kind: |e| matches!(e, ModelError::NotFinite { .. }),
        message: "contact pair 2 is NaN",
    },
    Case {
        name: "weight of nought",
        spoil: |m| m.contact_pairs[2].weight = 0.0,
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Weight { .. })),
        message: "contact pair 2: weight is 0",
    },
    Case {
        name: "weights do not sum to one",
        spoil: |m| {
            m.contact_pairs.pop();
        },
        kind: |e| matches!(e, ModelError::ContactWeightSum { .. }),
        message: "the contact weights sum to 0.819",
    },
    Case {
        name: "contact nodes with different components",
        spoil: |m| {
            // Moves the axial dof of the first ring node to a node of its own.
            let node = m.contact_pairs[0].second.node().unwrap();
            for dof in &mut m.dofs {
                if dof.node == node && dof.component == Component::Axial {
                    dof.node = 100_000;
                }
            }
        },
        kind: |e| is_contact(e, |p| matches!(p, ContactProblem::Components { .. })),
        message: "contact pair 0: node 269 and node 339 have different components, (r, t, z) and (r, t); accepted: the same",
    },
];

const LOAD_CASES: [Case; 10] = [
    Case {
        name: "force dof out of range",
        spoil: |m| m.force[1].0 = 1068,
        kind: |e| matches!(e, ModelError::DofOutOfRange { .. }),
        message: "force entry 1 refers to dof 1068",
    },
    Case {
        name: "force on the high face",
        spoil: |m| m.force[1].0 = high_dof(m),
        kind: |e| matches!(e, ModelError::OnHighFace { .. }),
        message: "force entry 1 refers to dof 9 on the high cyclic face",
    },
    Case {
        name: "force not finite",
        spoil: |m| m.force[1].1.im = f64::NEG_INFINITY,
        kind: |e| matches!(e, ModelError::NotFinite { .. }),
        message: "force entry 1 is -inf",
    },
    Case {
        name: "dof forced twice",
        spoil: |m| m.force[1].0 = m.force[0].0,
        kind: |e| matches!(e, ModelError::ForceDuplicate { .. }),
        message: "force entries 0 and 1 both act on dof 616",
    },
    Case {
        name: "force of nought",
        spoil: |m| m.force = vec![(616, Complex64::new(0.0, 0.0))],
        kind: |e| matches!(e, ModelError::NoForce),
        message: "no force",
    },
    Case {
        name: "force so small that powers of the response vanish",
        spoil: |m| m.force = vec![(616, Complex64::new(0.0, 9e-31))],
        kind: |e| matches!(e, ModelError::ForceOutOfRange { .. }),
        message: "the largest entry is 9e-31 N; accepted: 1e-30 to 1e30 N",
    },
    Case {
        name: "force so large that powers of the response overflow",
        spoil: |m| m.force = vec![(616, Complex64::new(2e30, 0.0))],
        kind: |e| matches!(e, ModelError::ForceOutOfRange { .. }),
        message: "the largest entry is 2e30 N; accepted: 1e-30 to 1e30 N",
    },
    Case {
        name: "nothing observed",
        spoil: |m| m.observed.clear(),
        kind: |e| matches!(e, ModelError::NoObservedNode),
        message: "at least one",
    },
    Case {
        name: "observed on the high face",
        spoil: |m| m.observed[1].node = m.dofs[high_dof(m)].node,
        kind: |e| matches!(e, ModelError::OnHighFace { .. }),
        message: "observed node 1 refers to node",
    },
    Case {
        name: "observed names alike",
        spoil: |m| {
            m.observed.push(ObservedNode {
                name: "tip_le".to_owned(),
                node: 100,
            });
        },
        kind: |e| matches!(e, ModelError::ObservedDuplicate { .. }),
        message: "observed nodes 0 and 2 are both named \"tip_le\"",
    },
];

#[test]
fn each_kind_of_bad_model_is_refused_with_place_and_value() {
    validate(&WHEEL).unwrap();
    let cases = MATRIX_CASES
        .iter()
        .chain(&DOF_CASES)
        .chain(&CONTACT_CASES)
        .chain(&LOAD_CASES);
    for case in cases {
        let mut model = WHEEL.clone();
        (case.spoil)(&mut model);
        let error = validate(&model).expect_err(case.name);
        let message = error.to_string();
        assert!((case.kind)(&error), "{}: {message}", case.name);
        assert!(message.contains(case.message), "{}: {message}", case.name);
        assert!(message.contains("accepted"), "{}: {message}", case.name);
    }
}

#[test]
fn a_body_of_its_own_is_no_partner() {
    // The low face of the ring paired with the blisk's node at the same place.
    let mut model = WHEEL.clone();
    let pair = model
        .cyclic_pairs
        .iter()
        .position(|&(low, _)| model.dofs[low].body == Body::Ring)
        .unwrap();
    let (low, high) = model.cyclic_pairs[pair];
    let node = model.dofs[high].node;
    for dof in &mut model.dofs {
        if dof.node == node {
            dof.body = Body::Blisk;
        }
    }
    let error = validate(&model).unwrap_err();
    assert!(
        matches!(error, ModelError::CyclicMismatch { low: l, high: h, .. } if (l, h) == (low, high)),
        "{error}"
    );
}
