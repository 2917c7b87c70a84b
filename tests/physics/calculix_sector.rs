//! A cyclic sector from a mesh written for `CalculiX`.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::path::Path;

use blisk::linalg::{Complex64, SymmetricSparse};
use blisk::model::sector::hexahedron20::NODES;
use blisk::model::sector::{
    AssembledMesh, Body, Component, Material, ObservedNode, SectorModel, SolidElement, SolidMesh,
    validate,
};

const STEEL: Material = Material {
    youngs_modulus_pa: 2.0e11,
    poisson_ratio: 0.3,
    density_kg_per_m3: 7800.0,
};

/// A `CalculiX` mesh as far as the test needs it: C3D20 elements, and node sets by name.
struct Deck {
    mesh: SolidMesh,
    sets: HashMap<String, Vec<usize>>,
}

/// Reads `*NODE`, `*ELEMENT` and `*NSET`; node numbers become indices from 0.
fn read_deck(path: &Path) -> Deck {
    let text = std::fs::read_to_string(path).unwrap();
    let mut mesh = SolidMesh {
        materials: vec![STEEL],
        ..SolidMesh::default()
    };
    let mut sets: HashMap<String, Vec<usize>> = HashMap::new();
    let (mut keyword, mut set, mut pending) = (String::new(), String::new(), Vec::new());
    for line in text.lines() {
        if let Some(card) = line.strip_prefix('*') {
            card.split(',').next().unwrap().clone_into(&mut keyword);
            card.split("NSET=")
                .nth(1)
                .unwrap_or_default()
                .clone_into(&mut set);
            continue;
        }
        let words = line
            .split(',')
            .map(str::trim)
            .filter(|word| !word.is_empty());
        match keyword.as_str() {
            "NODE" => {
                let values: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
                assert_eq!(
                    values[0] as usize,
                    mesh.nodes_m.len() + 1,
                    "nodes count up from 1"
                );
                mesh.nodes_m.push([values[1], values[2], values[3]]);
            }
            "ELEMENT" => {
                pending.extend(words.map(|word| word.parse::<usize>().unwrap()));
                if pending.len() == NODES + 1 {
                    let nodes = std::array::from_fn(|i| pending[i + 1] - 1);
                    let element = SolidElement {
                        nodes,
                        material: 0,
                        body: Body::Blisk,
                        blade: false,
                    };
                    mesh.elements.push(element);
                    pending.clear();
                }
            }
            "NSET" => sets
                .entry(set.clone())
                .or_default()
                .extend(words.map(|word| word.parse::<usize>().unwrap() - 1)),
            _ => {}
        }
    }
    mesh.clamped_nodes.clone_from(&sets["BORE"]);
    Deck { mesh, sets }
}

/// Pairs each free dof of the low set with the same component of the node one sector on.
fn cyclic_pairs(
    assembled: &AssembledMesh,
    low: &[usize],
    high: &[usize],
    sectors: usize,
) -> Vec<(usize, usize)> {
    let dof_of: HashMap<(usize, Component), usize> = assembled
        .dofs
        .iter()
        .enumerate()
        .map(|(index, dof)| ((dof.node, dof.component), index))
        .collect();
    let position: HashMap<usize, [f64; 3]> = assembled
        .dofs
        .iter()
        .map(|dof| (dof.node, dof.position_m))
        .collect();
    let (sin, cos) = (TAU / sectors as f64).sin_cos();
    let mut pairs = Vec::new();
    for node in low {
        let Some(&[x, y, z]) = position.get(node) else {
            continue;
        };
        let image = [x * cos - y * sin, x * sin + y * cos, z];
        let partner = high
            .iter()
            .copied()
            .find(|other| {
                position
                    .get(other)
                    .is_some_and(|at| (0..3).all(|i| (at[i] - image[i]).abs() < 1e-9))
            })
            .unwrap();
        for component in [Component::Radial, Component::Tangential, Component::Axial] {
            pairs.push((dof_of[&(*node, component)], dof_of[&(partner, component)]));
        }
    }
    pairs
}

/// The sector of `tests/data/ccx_sector`, as assembled by this program.
pub fn calculix_sector() -> SectorModel {
    let sectors = 24;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/ccx_sector");
    let deck = read_deck(&folder.join("mesh_c3d20.inc"));
    let assembled = deck.mesh.assemble().unwrap();
    let cyclic_pairs = cyclic_pairs(&assembled, &deck.sets["LEFT"], &deck.sets["RIGHT"], sectors);
    let tip = deck.sets["TIP"][0];
    let tip_dof = assembled
        .dofs
        .iter()
        .position(|dof| dof.node == tip)
        .unwrap();
    let n = assembled.dofs.len();
    let model = SectorModel {
        name: "ccx".to_owned(),
        sectors,
        stiffness: assembled.stiffness,
        mass: assembled.mass,
        blade_stiffness: SymmetricSparse::from_lower_triplets(n, &[]),
        dofs: assembled.dofs,
        cyclic_pairs,
        contact_pairs: Vec::new(),
        force: vec![(tip_dof, Complex64::new(1.0, 0.0))],
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "tip".to_owned(),
            node: tip,
        }],
    };
    validate(&model).unwrap();
    model
}
