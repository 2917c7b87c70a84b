//! A finite-element mesh as other codes number it: nodes, solid elements, sets, surfaces.

use std::collections::{BTreeMap, BTreeSet};

/// A solid element type, by its nodes; reduced integration and the like do not matter here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ElementKind {
    Tetrahedron4,
    Tetrahedron10,
    Wedge6,
    Wedge15,
    Brick8,
    Brick20,
}

/// Corners of the faces S1, S2, ... in the order of Abaqus and `CalculiX`, nodes from 0.
const TETRAHEDRON_FACES: [&[usize]; 4] = [&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]];
const WEDGE_FACES: [&[usize]; 5] = [
    &[0, 1, 2],
    &[3, 4, 5],
    &[0, 1, 4, 3],
    &[1, 2, 5, 4],
    &[2, 0, 3, 5],
];
const BRICK_FACES: [&[usize]; 6] = [
    &[0, 1, 2, 3],
    &[4, 7, 6, 5],
    &[0, 4, 5, 1],
    &[1, 5, 6, 2],
    &[2, 6, 7, 3],
    &[3, 7, 4, 0],
];
/// The two corners of each midside node, in the order of the midside nodes.
const TETRAHEDRON_EDGES: [(usize, usize); 6] = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];
const WEDGE_EDGES: [(usize, usize); 9] = [
    (0, 1),
    (1, 2),
    (2, 0),
    (3, 4),
    (4, 5),
    (5, 3),
    (0, 3),
    (1, 4),
    (2, 5),
];
const BRICK_EDGES: [(usize, usize); 12] = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 4),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
];

impl ElementKind {
    /// Types of Abaqus and `CalculiX` that are read.
    pub const ACCEPTED: &'static str =
        "C3D4, C3D6, C3D8, C3D8R, C3D8I, C3D10, C3D15, C3D20, C3D20R (keep solid elements only)";

    /// The type of that name in Abaqus and `CalculiX`.
    pub fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "C3D4" => Self::Tetrahedron4,
            "C3D10" | "C3D10T" => Self::Tetrahedron10,
            "C3D6" => Self::Wedge6,
            "C3D15" => Self::Wedge15,
            "C3D8" | "C3D8R" | "C3D8I" => Self::Brick8,
            "C3D20" | "C3D20R" => Self::Brick20,
            _ => return None,
        })
    }

    /// What the type is called in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tetrahedron4 => "a tetrahedron of 4 nodes",
            Self::Tetrahedron10 => "a tetrahedron of 10 nodes",
            Self::Wedge6 => "a wedge of 6 nodes",
            Self::Wedge15 => "a wedge of 15 nodes",
            Self::Brick8 => "a brick of 8 nodes",
            Self::Brick20 => "a brick of 20 nodes",
        }
    }

    pub fn node_count(self) -> usize {
        match self {
            Self::Tetrahedron4 => 4,
            Self::Tetrahedron10 => 10,
            Self::Wedge6 => 6,
            Self::Wedge15 => 15,
            Self::Brick8 => 8,
            Self::Brick20 => 20,
        }
    }

    fn corners(self) -> &'static [&'static [usize]] {
        match self {
            Self::Tetrahedron4 | Self::Tetrahedron10 => &TETRAHEDRON_FACES,
            Self::Wedge6 | Self::Wedge15 => &WEDGE_FACES,
            Self::Brick8 | Self::Brick20 => &BRICK_FACES,
        }
    }

    pub fn face_count(self) -> usize {
        self.corners().len()
    }

    /// Local nodes of a face: its corners in turn, then the midside nodes between them.
    pub fn face(self, face: usize) -> Vec<usize> {
        let corners = self.corners()[face];
        let edges: &[(usize, usize)] = match self {
            Self::Tetrahedron10 => &TETRAHEDRON_EDGES,
            Self::Wedge15 => &WEDGE_EDGES,
            Self::Brick20 => &BRICK_EDGES,
            _ => return corners.to_vec(),
        };
        let corner_count = self.node_count() - edges.len();
        let midsides = (0..corners.len()).filter_map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            let at = edges
                .iter()
                .position(|&(c, d)| (c, d) == (a, b) || (d, c) == (a, b))?;
            Some(corner_count + at)
        });
        corners.iter().copied().chain(midsides).collect()
    }
}

/// A solid element: nodes in the order of Abaqus and `CalculiX`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Element {
    pub kind: ElementKind,
    pub nodes: Vec<usize>,
}

/// An isotropic material as far as a mesh file gives it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct MeshMaterial {
    pub elastic: Option<(f64, f64)>,
    pub density: Option<f64>,
}

/// What a deck says of the run that wrote the matrices.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct RunFacts {
    /// A step stores the matrices.
    pub stores_matrices: bool,
    /// A static step stands before it.
    pub prestressed: bool,
    /// `omega^2` of the last `CENTRIF` load, (rad/s)^2.
    pub centrifugal: Option<f64>,
}

/// A mesh; all numbers are those of the code that made it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Mesh {
    /// Positions in the unit of the file.
    pub nodes: BTreeMap<usize, [f64; 3]>,
    pub elements: BTreeMap<usize, Element>,
    pub node_sets: BTreeMap<String, BTreeSet<usize>>,
    pub element_sets: BTreeMap<String, BTreeSet<usize>>,
    /// Faces `(element, face from 0)` of each surface.
    pub surfaces: BTreeMap<String, BTreeSet<(usize, usize)>>,
    pub materials: BTreeMap<String, MeshMaterial>,
    /// Material of each element set with a section.
    pub sections: BTreeMap<String, String>,
    /// Nodes with a boundary condition.
    pub held: BTreeSet<usize>,
    pub run: RunFacts,
}

impl Mesh {
    /// Adds a node; false if it is there already, elsewhere.
    #[expect(
        clippy::float_cmp,
        reason = "the same node is written with the same digits"
    )]
    pub fn add_node(&mut self, number: usize, position: [f64; 3]) -> bool {
        let old = self.nodes.insert(number, position);
        old.is_none_or(|old| old == position)
    }

    /// Nodes of a node set, of an element set or of a surface of that name.
    pub fn nodes_of(&self, name: &str) -> Option<BTreeSet<usize>> {
        let name = name.to_ascii_uppercase();
        if let Some(nodes) = self.node_sets.get(&name) {
            return Some(nodes.clone());
        }
        if let Some(elements) = self.element_sets.get(&name) {
            return Some(self.nodes_of_elements(elements));
        }
        let faces = self.surfaces.get(&name)?;
        Some(
            faces
                .iter()
                .flat_map(|&(element, face)| self.face_nodes(element, face))
                .collect(),
        )
    }

    pub fn nodes_of_elements(&self, elements: &BTreeSet<usize>) -> BTreeSet<usize> {
        elements
            .iter()
            .filter_map(|number| self.elements.get(number))
            .flat_map(|element| element.nodes.iter().copied())
            .collect()
    }

    /// Nodes of a face, corners first.
    pub fn face_nodes(&self, element: usize, face: usize) -> Vec<usize> {
        let Some(element) = self.elements.get(&element) else {
            return Vec::new();
        };
        element
            .kind
            .face(face)
            .iter()
            .map(|&local| element.nodes[local])
            .collect()
    }

    /// The faces of a surface, or the outer faces whose nodes all lie in a set.
    pub fn faces_of(&self, name: &str) -> Option<Vec<(usize, usize)>> {
        let upper = name.to_ascii_uppercase();
        if let Some(faces) = self.surfaces.get(&upper) {
            return Some(faces.iter().copied().collect());
        }
        let nodes = self.nodes_of(name)?;
        // A face between two elements is no outer one.
        let mut seen: BTreeMap<Vec<usize>, Vec<(usize, usize)>> = BTreeMap::new();
        for (&number, element) in &self.elements {
            for face in 0..element.kind.face_count() {
                let mut face_nodes = self.face_nodes(number, face);
                if face_nodes.iter().all(|node| nodes.contains(node)) {
                    face_nodes.sort_unstable();
                    seen.entry(face_nodes).or_default().push((number, face));
                }
            }
        }
        let mut faces: Vec<(usize, usize)> = seen
            .into_values()
            .filter(|owners| owners.len() == 1)
            .flatten()
            .collect();
        faces.sort_unstable();
        Some(faces)
    }

    /// Names of all sets and surfaces.
    pub fn set_names(&self) -> BTreeSet<String> {
        let sets = self.node_sets.keys().chain(self.element_sets.keys());
        sets.chain(self.surfaces.keys()).cloned().collect()
    }

    /// Material of an element, by the section of a set it belongs to.
    pub fn material_of(&self, element: usize) -> Option<MeshMaterial> {
        let (_, material) = self.sections.iter().find(|(set, _)| {
            self.element_sets
                .get(*set)
                .is_some_and(|members| members.contains(&element))
        })?;
        self.materials.get(material).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::ElementKind;

    #[test]
    fn faces_of_quadratic_elements_have_their_midsides_in_turn() {
        // The faces S1 and S4 of a C3D20 and S3 of a C3D10, written out by hand.
        assert_eq!(ElementKind::Brick20.face(0), [0, 1, 2, 3, 8, 9, 10, 11]);
        assert_eq!(ElementKind::Brick20.face(3), [1, 5, 6, 2, 17, 13, 18, 9]);
        assert_eq!(ElementKind::Tetrahedron10.face(2), [1, 3, 2, 8, 9, 5]);
        assert_eq!(ElementKind::Wedge15.face(3), [1, 2, 5, 4, 7, 14, 10, 13]);
        for kind in [
            ElementKind::Tetrahedron10,
            ElementKind::Wedge15,
            ElementKind::Brick20,
        ] {
            for face in 0..kind.face_count() {
                let corners = kind.corners()[face].len();
                assert_eq!(kind.face(face).len(), 2 * corners);
            }
        }
    }
}
