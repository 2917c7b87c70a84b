//! The 20-node brick and its assembly: rigid bodies, patch test, total mass, `CalculiX` frequencies.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::path::Path;

use blisk::linalg::{Matrix, hermitian_eigen, lowest_modes};
use blisk::model::cyclic::CyclicSector;
use blisk::model::sector::hexahedron20::{self, NATURAL_COORDINATES, NODES};
use blisk::model::sector::{Body, Component, Material, ModelError, SolidElement, SolidMesh};

use super::calculix_sector::calculix_sector;

const STEEL: Material = Material {
    youngs_modulus_pa: 2.0e11,
    poisson_ratio: 0.3,
    density_kg_per_m3: 7800.0,
};

/// A brick of 40 x 30 x 20 mm, curved and skewed, away from the axis.
fn distorted_brick() -> [[f64; 3]; NODES] {
    NATURAL_COORDINATES.map(|[u, v, w]| {
        [
            0.100 + 0.020 * u + 0.003 * v * w + 0.002 * u * v,
            0.050 + 0.015 * v + 0.002 * u * u + 0.001 * w,
            0.010 * w + 0.002 * u * v - 0.0015 * v * v,
        ]
    })
}

/// A brick of straight edges, 40 x 30 x 20 mm.
fn straight_brick() -> [[f64; 3]; NODES] {
    NATURAL_COORDINATES.map(|[u, v, w]| [0.020 * u, 0.015 * v, 0.010 * w])
}

/// `K u` of an element, node by node.
fn forces(nodes: &[[f64; 3]; NODES], displacement: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<[f64; 3]> {
    let element = hexahedron20::matrices(0, nodes, &STEEL).unwrap();
    element
        .stiffness
        .iter()
        .map(|row| {
            let mut force = [0.0; 3];
            for (block, &position) in row.iter().zip(nodes) {
                let u = displacement(position);
                for (total, stiffness) in force.iter_mut().zip(block) {
                    *total += (0..3).map(|j| stiffness[j] * u[j]).sum::<f64>();
                }
            }
            force
        })
        .collect()
}

#[test]
fn rigid_motions_cost_no_energy_and_are_the_only_ones() {
    let nodes = distorted_brick();
    let scale = hexahedron20::matrices(0, &nodes, &STEEL).unwrap().stiffness[0][0][0][0];
    let motions: [fn([f64; 3]) -> [f64; 3]; 6] = [
        |_| [1.0, 0.0, 0.0],
        |_| [0.0, 1.0, 0.0],
        |_| [0.0, 0.0, 1.0],
        |[_, y, z]| [0.0, -z, y],
        |[x, _, z]| [z, 0.0, -x],
        |[x, y, _]| [-y, x, 0.0],
    ];
    for (index, motion) in motions.into_iter().enumerate() {
        for force in forces(&nodes, motion) {
            for value in force {
                assert!(
                    value.abs() < 1e-12 * scale,
                    "motion {index}: force {value:e}"
                );
            }
        }
    }

    let element = hexahedron20::matrices(0, &nodes, &STEEL).unwrap();
    let full = Matrix::from_fn(3 * NODES, 3 * NODES, |i, j| {
        element.stiffness[i / 3][j / 3][i % 3][j % 3]
    });
    let (values, _) = hermitian_eigen(&full).unwrap();
    let largest = values[values.len() - 1];
    let zero = values
        .iter()
        .filter(|value| value.abs() < 1e-10 * largest)
        .count();
    assert_eq!(zero, 6, "eigenvalues {values:?}");
    assert!(
        values[6] > 1e-6 * largest,
        "the seventh eigenvalue is {:e}",
        values[6]
    );
}

#[test]
fn mass_of_an_element_is_density_times_volume() {
    let element = hexahedron20::matrices(0, &straight_brick(), &STEEL).unwrap();
    let total: f64 = element.mass.iter().flatten().sum();
    let exact = STEEL.density_kg_per_m3 * 0.040 * 0.030 * 0.020;
    assert!(
        (total / exact - 1.0).abs() < 1e-14,
        "{total} instead of {exact}"
    );
}

#[test]
fn consistent_mass_integrates_quadratic_fields_exactly() {
    // u = x^2 lies in the element's space, so u^T M u = int rho x^4 dV = rho V a^4 / 5.
    let nodes = straight_brick();
    let element = hexahedron20::matrices(0, &nodes, &STEEL).unwrap();
    let mut energy = 0.0;
    for (row, a) in element.mass.iter().zip(&nodes) {
        for (mass, b) in row.iter().zip(&nodes) {
            energy += mass * a[0].powi(2) * b[0].powi(2);
        }
    }
    let exact = STEEL.density_kg_per_m3 * 0.040 * 0.030 * 0.020 * 0.020_f64.powi(4) / 5.0;
    assert!(
        (energy / exact - 1.0).abs() < 1e-13,
        "{energy:e} instead of {exact:e}"
    );
}

#[test]
fn an_element_turned_inside_out_is_refused() {
    let mut nodes = straight_brick();
    for node in &mut nodes {
        node[2] = -node[2];
    }
    let error = hexahedron20::matrices(7, &nodes, &STEEL).unwrap_err();
    assert!(
        matches!(error, ModelError::ElementInverted { element: 7, .. }),
        "{error}"
    );
    assert!(error.to_string().contains("element 7"), "{error}");
}

/// Two by two by two bricks round a displaced inner node, off the axis.
fn patch() -> SolidMesh {
    let mut index: HashMap<[usize; 3], usize> = HashMap::new();
    let mut mesh = SolidMesh {
        materials: vec![STEEL],
        ..SolidMesh::default()
    };
    for cell in 0..8 {
        let cell = [cell % 2, cell / 2 % 2, cell / 4];
        let nodes = NATURAL_COORDINATES.map(|natural| {
            let point = [0, 1, 2].map(|i| 2 * cell[i] + (natural[i] + 1.0) as usize);
            let next = mesh.nodes_m.len();
            let node = *index.entry(point).or_insert(next);
            if node == next {
                mesh.nodes_m.push(patch_position(point));
            }
            node
        });
        mesh.elements.push(SolidElement {
            nodes,
            material: 0,
            body: Body::Blisk,
            blade: true,
        });
    }
    mesh
}

/// Corners of the patch, the inner one displaced; edges straight, midside nodes in the middle.
fn patch_position(point: [usize; 3]) -> [f64; 3] {
    let corner = |point: [usize; 3]| {
        let mut position = [0.10, 0.04, -0.02];
        for i in 0..3 {
            position[i] += 0.01 * point[i] as f64;
        }
        if point == [2, 2, 2] {
            position[0] += 0.004;
            position[1] -= 0.003;
            position[2] += 0.005;
        }
        position
    };
    let below = corner(point.map(|i| i - i % 2));
    let above = corner(point.map(|i| i + i % 2));
    [0, 1, 2].map(|i| 0.5 * (below[i] + above[i]))
}

#[test]
fn distorted_patch_reproduces_constant_strain() {
    let mesh = patch();
    let assembled = mesh.assemble().unwrap();
    // u = G x with a gradient of all nine entries, turned to each node's own frame.
    let gradient = [[1.0, 0.3, -0.2], [0.5, -0.7, 0.4], [-0.1, 0.6, 0.8]];
    let displacement: Vec<f64> = assembled
        .dofs
        .iter()
        .map(|dof| {
            let u = gradient.map(|row| (0..3).map(|i| row[i] * dof.position_m[i]).sum::<f64>());
            let [x, y, _] = dof.position_m;
            let (c, s) = (x / x.hypot(y), y / x.hypot(y));
            match dof.component {
                Component::Radial => c * u[0] + s * u[1],
                Component::Tangential => c * u[1] - s * u[0],
                Component::Axial => u[2],
                _ => unreachable!("a solid has no rotations"),
            }
        })
        .collect();
    // No force on the inner nodes: the field is in equilibrium.
    let force = assembled.stiffness.multiply(&displacement);
    let largest = force
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let inside = |position: [f64; 3]| {
        let low = [0.10, 0.04, -0.02];
        (0..3).all(|i| position[i] > low[i] + 1e-9 && position[i] < low[i] + 0.04 - 1e-9)
    };
    let mut inner = 0;
    for (dof, value) in assembled.dofs.iter().zip(&force) {
        if inside(dof.position_m) {
            inner += 1;
            assert!(
                value.abs() < 1e-12 * largest,
                "node {}: {value:e} of {largest:e}",
                dof.node
            );
        }
    }
    assert_eq!(inner, 21, "seven inner nodes: the centre and its six edges");
    // The strain energy is that of the constant strain: V (lambda tr(e)^2 + 2 mu e:e).
    let energy: f64 = displacement.iter().zip(&force).map(|(u, f)| u * f).sum();
    let (e, nu) = (STEEL.youngs_modulus_pa, STEEL.poisson_ratio);
    let (lambda, mu) = (
        e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        e / (2.0 * (1.0 + nu)),
    );
    let trace: f64 = (0..3).map(|i| gradient[i][i]).sum();
    let strain = |i: usize, j: usize| 0.5 * (gradient[i][j] + gradient[j][i]);
    let squares: f64 = (0..9).map(|at| strain(at / 3, at % 3).powi(2)).sum();
    let exact = 0.04_f64.powi(3) * (lambda * trace * trace + 2.0 * mu * squares);
    assert!(
        (energy / exact - 1.0).abs() < 1e-12,
        "{energy:e} instead of {exact:e}"
    );
}

#[test]
fn free_node_on_the_axis_is_refused_and_a_clamped_one_is_not() {
    let mut mesh = SolidMesh {
        nodes_m: straight_brick()
            .map(|[x, y, z]| [x + 0.02, y + 0.015, z])
            .to_vec(),
        elements: vec![SolidElement {
            nodes: std::array::from_fn(|i| i),
            material: 0,
            body: Body::Blisk,
            blade: false,
        }],
        materials: vec![STEEL],
        clamped_nodes: Vec::new(),
    };
    let error = mesh.assemble().unwrap_err();
    assert!(
        matches!(error, ModelError::NodeOnAxis { node: 0, .. }),
        "{error}"
    );
    mesh.clamped_nodes = vec![0, 4, 16];
    assert_eq!(mesh.assemble().unwrap().dofs.len(), 3 * 17);
}

#[test]
fn meshes_that_refer_to_nothing_are_refused_with_element_and_value() {
    type Case = (fn(&mut SolidMesh), fn(&ModelError) -> bool, &'static str);
    let cases: [Case; 4] = [
        (
            |mesh| mesh.elements[3].nodes[5] = 5000,
            |error| matches!(error, ModelError::ElementNode { .. }),
            "element 3 has node 5000",
        ),
        (
            |mesh| mesh.elements[3].material = 1,
            |error| matches!(error, ModelError::ElementMaterial { .. }),
            "element 3 has material 1",
        ),
        (
            |mesh| mesh.elements[3].body = Body::Ring,
            |error| matches!(error, ModelError::ElementBody { .. }),
            "element 3 shares node",
        ),
        (
            |mesh| mesh.clamped_nodes.push(5000),
            |error| matches!(error, ModelError::ClampedNode { .. }),
            "clamped node 5000",
        ),
    ];
    for (spoil, kind, part) in cases {
        let mut mesh = patch();
        spoil(&mut mesh);
        let error = mesh.assemble().unwrap_err();
        let message = error.to_string();
        assert!(kind(&error) && message.contains(part), "{message}");
    }
}

#[test]
fn calculix_frequencies_of_nodal_diameters_0_to_6_are_met() {
    let model = calculix_sector();
    let sector = CyclicSector::new(&model);
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/ccx_sector/frequencies.csv");
    let table = std::fs::read_to_string(table).unwrap();
    let mut computed: HashMap<usize, Vec<f64>> = HashMap::new();
    let (mut rows, mut worst) = (0, 0.0_f64);
    for row in table.lines().skip(1) {
        let words: Vec<&str> = row.split(',').collect();
        let (h, mode): (usize, usize) = (words[0].parse().unwrap(), words[1].parse().unwrap());
        let reference: f64 = words[2].parse().unwrap();
        let values = computed.entry(h).or_insert_with(|| {
            let (stiffness, mass) = (sector.stiffness(h), sector.mass(h));
            let factor = stiffness.factor().unwrap();
            lowest_modes(&factor, &mass, 0.0, 5).unwrap().0
        });
        let frequency = values[mode - 1].sqrt() / TAU;
        worst = worst.max((frequency / reference - 1.0).abs());
        rows += 1;
    }
    assert_eq!(rows, 35);
    assert!(worst < 1e-4, "worst relative difference {worst:e}");
    // The table has seven digits; the elements are the same.
    assert!(worst < 1e-6, "worst relative difference {worst:e}");
}
