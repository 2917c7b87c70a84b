//! What can be wrong with a finite-element model that is imported.

use thiserror::Error;

use crate::model::sector::error_place::Matrix;
use crate::model::sector::sector_model::Body;

/// A refused model or file of another code: the value found and what is accepted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ImportProblem {
    /// A value of the import file is not accepted.
    #[error("`{key}` is {found}; accepted: {accepted}")]
    Value {
        /// Full key.
        key: String,
        /// Value found.
        found: String,
        /// What is accepted.
        accepted: String,
    },
    /// A keyword of a deck that makes its matrices or sets unusable.
    #[error("{keyword} is not accepted: {reason}")]
    Keyword {
        /// The keyword.
        keyword: String,
        /// Why not, and what to do.
        reason: &'static str,
    },
    /// A keyword without a parameter that it needs.
    #[error("{keyword} has no parameter {parameter}; accepted: {keyword}, {parameter}=...")]
    ParameterMissing {
        /// The keyword.
        keyword: String,
        /// The parameter.
        parameter: &'static str,
    },
    /// Included files include each other.
    #[error(
        "files are included {depth} deep; accepted: at most {most} (does a file include itself?)"
    )]
    IncludeDepth {
        /// Depth reached.
        depth: usize,
        /// Largest depth.
        most: usize,
    },
    /// An element type without known faces.
    #[error("element type {found} is not known; accepted: {accepted}")]
    ElementType {
        /// Type found.
        found: String,
        /// Types accepted.
        accepted: &'static str,
    },
    /// An element with a wrong number of nodes.
    #[error("element {element} has {found} nodes; accepted: {expected}")]
    ElementNodes {
        /// Number of the element.
        element: usize,
        /// Nodes found.
        found: usize,
        /// Nodes of its type.
        expected: usize,
    },
    /// Something is defined a second time, differently.
    #[error("{what} {number} is defined a second time, differently; accepted: once")]
    Redefined {
        /// Node or element.
        what: &'static str,
        /// Its number.
        number: usize,
    },
    /// A node or element that nothing defines.
    #[error("{what} {number} is not in the mesh; accepted: a {what} that the mesh defines")]
    Undefined {
        /// Node or element.
        what: &'static str,
        /// Its number.
        number: usize,
    },
    /// A set of a deck that refers to one that is not there.
    #[error("{key} {name} is not in the mesh; accepted: one of {accepted}")]
    SetUnknown {
        /// Kind of the set.
        key: String,
        /// Name.
        name: String,
        /// Names there are.
        accepted: String,
    },
    /// The file stops in the middle.
    #[error("the file is cut off: {what}")]
    CutOff {
        /// What is missing.
        what: String,
    },
    /// Matrix row and dof table do not go together.
    #[error(
        "the matrix has entries up to row {found}, the dof table {rows} rows; accepted: a table of the same run"
    )]
    RowOutside {
        /// Row found, from 1.
        found: usize,
        /// Rows of the table.
        rows: usize,
    },
    /// A row has nothing on its diagonal.
    #[error(
        "row {row} (node {node}, direction {direction}) has no diagonal entry; accepted: a whole matrix without the rows of held directions (was the file cut off?)"
    )]
    NoDiagonal {
        /// Row, from 1.
        row: usize,
        /// Its node.
        node: usize,
        /// Its direction, 1 to 3.
        direction: usize,
    },
    /// An entry stands twice.
    #[error("the entry ({row}, {column}) stands twice; accepted: each entry once")]
    Repeated {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
    /// A matrix given in full is not symmetric.
    #[error(
        "the matrix is not symmetric: entry ({row}, {column}) is {value:e} but ({column}, {row}) is {mirror:e}; accepted: equal values"
    )]
    NotSymmetric {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// Entry (row, column).
        value: f64,
        /// Entry (column, row).
        mirror: f64,
    },
    /// A kind of matrix that is not read.
    #[error("{what} is {found}; accepted: {accepted}")]
    MatrixKind {
        /// Which field of the file.
        what: &'static str,
        /// Value found.
        found: String,
        /// What is accepted.
        accepted: &'static str,
    },
    /// A line that is none of the format.
    #[error("{found:?} is no {what}; accepted: {accepted}")]
    Line {
        /// What was expected.
        what: &'static str,
        /// The line found.
        found: String,
        /// What is accepted.
        accepted: &'static str,
    },
    /// A matrix that the file does not hold.
    #[error("there is no matrix {name}; accepted: one of {accepted}")]
    MatrixUnknown {
        /// Name.
        name: String,
        /// Names in the file.
        accepted: String,
    },
    /// A row of a node that the mesh does not have.
    #[error(
        "row {row} belongs to node {node}, which is not in the mesh; accepted: rows of the mesh's nodes (C3D8I has internal rows: take C3D8 or C3D20; the expanded nodes of shells and beams are not read)"
    )]
    RowOfUnknownNode {
        /// Row, from 1.
        row: usize,
        /// Its node.
        node: usize,
    },
    /// A node with one direction in the plane of rotation only.
    #[error(
        "node {node} has direction {has} but not {lacks}; accepted: both, or neither (held), as components are turned to r and theta"
    )]
    HalfHeld {
        /// The node.
        node: usize,
        /// Direction present.
        has: &'static str,
        /// Direction absent.
        lacks: &'static str,
    },
    /// The faces do not meet under a turn by one sector.
    #[error(
        "node {node} of the low face, turned by one sector, is {distance_m:e} m from the nearest node of the high face (node {nearest}); accepted: at most {tolerance_m:e} m (`position_tolerance_m`){hint}"
    )]
    FaceMismatch {
        /// Node of the low face.
        node: usize,
        /// Nearest node of the high face.
        nearest: usize,
        /// Distance of the two nodes, m.
        distance_m: f64,
        /// Largest distance accepted, m.
        tolerance_m: f64,
        /// What else may be the matter.
        hint: &'static str,
    },
    /// The faces have different numbers of free nodes.
    #[error(
        "the low face has {low} free nodes, the high face {high}; accepted: as many (is a face tied, or held on one side only?)"
    )]
    FaceCount {
        /// Free nodes of the low face.
        low: usize,
        /// Free nodes of the high face.
        high: usize,
    },
    /// Two nodes of the low face meet the same one of the high face.
    #[error(
        "nodes {first} and {second} of the low face both meet node {high} of the high face; accepted: one each (`position_tolerance_m` smaller than the mesh)"
    )]
    FaceTwice {
        /// First node.
        first: usize,
        /// Second node.
        second: usize,
        /// Node of the high face.
        high: usize,
    },
    /// A node of a face is not free in the same directions as its partner.
    #[error(
        "nodes {low} and {high} of the cyclic faces are not free in the same directions; accepted: faces held alike and not tied (`*EQUATION, REMOVE ALL` in the matrix step)"
    )]
    FaceComponents {
        /// Node of the low face.
        low: usize,
        /// Node of the high face.
        high: usize,
    },
    /// No element face lies in a set.
    #[error("no outer element face of the {} has all its nodes in {name}; accepted: a node set that holds whole faces, or a surface of element faces{normal}", body_name(*body))]
    NoFaces {
        /// Body.
        body: Body,
        /// Name of the set.
        name: String,
        /// The key that takes the place of faces, if it is to be named.
        normal: String,
    },
    /// A set of a contact has no free node of its body.
    #[error("no free node of the {} is in {name}; accepted: a set of nodes of that body with rows in the matrices", body_name(*body))]
    NoFreeNodes {
        /// Body.
        body: Body,
        /// Name of the set.
        name: String,
    },
    /// The faces at a node give no area or no normal.
    #[error(
        "the faces of {name} at node {node} have no area, or face each other; accepted: faces of one side of a body, with an area"
    )]
    NoArea {
        /// The surface.
        name: String,
        /// The node.
        node: usize,
    },
    /// A contact node without partner.
    #[error(
        "node {node} of the {first}'s contact surface is {distance_m:e} m from the nearest node of the {second}'s (node {nearest}); accepted: at most {tolerance_m:e} m (`{key}.tolerance_m`)"
    )]
    ContactMismatch {
        /// Key of the contact.
        key: String,
        /// Owner of the first surface.
        first: String,
        /// Owner of the second surface.
        second: String,
        /// Node on the first surface.
        node: usize,
        /// Nearest node on the second.
        nearest: usize,
        /// Distance of the two nodes, m.
        distance_m: f64,
        /// Largest distance accepted, m.
        tolerance_m: f64,
    },
    /// An element of the blade that cannot be assembled here.
    #[error(
        "element {element} of the blade is {found}, which is not assembled here; accepted: C3D20, or `blisk.blade_job` with the matrices of the blade alone"
    )]
    BladeElement {
        /// The element.
        element: usize,
        /// Type of the element.
        found: &'static str,
    },
    /// An element of the blade has no material.
    #[error(
        "element {element} of the blade has no isotropic material; accepted: a *SOLID SECTION with *ELASTIC, or `blisk.blade_job` with the matrices of the blade alone"
    )]
    NoMaterial {
        /// The element.
        element: usize,
    },
    /// A blade matrix has rows that the whole has not.
    #[error(
        "row {row} of the blade's matrix is direction {direction} of node {node}, which the whole model does not have; accepted: the same mesh"
    )]
    BladeRow {
        /// Row, from 1.
        row: usize,
        /// Node.
        node: usize,
        /// Direction, 1 to 3.
        direction: usize,
    },
    /// Two bodies are one structure.
    #[error(
        "nodes {first} and {second} belong to different bodies but the stiffness couples them; accepted: {} and {} without tie or contact in the matrix step",
        body_name(bodies[0]),
        body_name(bodies[1])
    )]
    BodiesCoupled {
        /// Node of one body.
        first: usize,
        /// Node of the other body.
        second: usize,
        /// The bodies.
        bodies: [Body; 2],
    },
    /// Two contact nodes of the first side meet one of the second.
    #[error(
        "nodes {} and {} of the {first}'s contact surface both meet node {met} of the {second}'s; accepted: one each (`{key}.tolerance_m` smaller than the mesh)",
        nodes[0],
        nodes[1]
    )]
    ContactTwice {
        /// Key of the contact.
        key: String,
        /// Owner of the first surface.
        first: String,
        /// Owner of the second surface.
        second: String,
        /// The two nodes of the first surface.
        nodes: [usize; 2],
        /// Node of the second.
        met: usize,
    },
    /// No node of the ring lies on the blisk's contact surface.
    #[error(
        "no node of the ring's contact surface is within {tolerance_m:e} m of the blisk's (nearest: node {nearest}, {distance_m:e} m); accepted: surfaces that touch, or a larger `{key}.tolerance_m`"
    )]
    NothingProjected {
        /// Key of the contact.
        key: String,
        /// Nearest node of the ring.
        nearest: usize,
        /// Its distance, m.
        distance_m: f64,
        /// Largest distance accepted, m.
        tolerance_m: f64,
    },
    /// The ring's mesh cannot follow that of the blisk.
    #[error(
        "the {ring} nodes of the ring do not determine the motion at the {blisk} nodes of the blisk's contact surface; accepted: a ring meshed as finely as the blisk there, or finer"
    )]
    RingTooCoarse {
        /// Nodes of the ring that lie on the surface.
        ring: usize,
        /// Nodes of the blisk that they follow.
        blisk: usize,
    },
    /// A stiffness couples no node with another.
    #[error(
        "{matrix} has no entry off the diagonal that couples two nodes; accepted: the whole matrix, or one triangle where the format says so (was only one triangle written, and the other one kept?)"
    )]
    NoCouplings {
        /// The matrix.
        matrix: Matrix,
    },
    /// A matrix does not couple the nodes of an element.
    #[error(
        "{matrix} does not couple nodes {first} and {second} of element {element}: {coupled} of {pairs} pairs of its nodes are coupled; accepted: a matrix of this mesh, with all of its entries, and its own table of rows (is only one triangle left, or are the rows in another order than the table's?)"
    )]
    NotCoupled {
        /// The matrix.
        matrix: Matrix,
        /// Number of the element.
        element: usize,
        /// A node of the element.
        first: usize,
        /// Another node of the element, not coupled with `first`.
        second: usize,
        /// Pairs of its nodes that are coupled.
        coupled: usize,
        /// Pairs of its free nodes.
        pairs: usize,
    },
    /// A matrix whose entries off the diagonal all stand on one side of it, where both are expected.
    #[error(
        "{entries} entries stand {side} the diagonal and none on the other side; accepted: both triangles, or a file that declares the matrix symmetric (is only one triangle written?)"
    )]
    OneTriangle {
        /// Entries off the diagonal.
        entries: usize,
        /// `above` or `below`.
        side: &'static str,
    },
    /// A node whose matrix rows are in a coordinate system of its own.
    #[error(
        "node {node} has a rotated coordinate system ({angles} degrees); accepted: nodes in global Cartesian directions (NROTAT none)"
    )]
    NodeRotated {
        /// The node.
        node: usize,
        /// Its angles.
        angles: String,
    },
}

pub(super) fn body_name(body: Body) -> &'static str {
    match body {
        Body::Blisk => "blisk",
        Body::Ring => "ring",
        Body::Damper => "damper",
    }
}
