//! What can be wrong with a sector model, its options or its files.

use std::path::PathBuf;

use thiserror::Error;

use super::chain_problem::ChainProblem;
use super::contact_problem::ContactProblem;
use super::error_place::{Accepted, Item, Matrix, Place, StiffnessKind};
use super::import::ImportProblem;
use super::line_problem::LineProblem;
use super::rigid_problem::RigidProblem;
use super::sector_model::Component;
use crate::input::{Finding, listed};

/// A refused model: what is wrong, where, the value found and what is accepted.
#[derive(Debug, Error)]
pub enum ModelError {
    /// An option lies outside what is accepted.
    #[error("`{key}` is {value}; accepted: {accepted}")]
    Option {
        /// Full key, such as `model.parametric.rim_radius_m`.
        key: String,
        /// Value found.
        value: f64,
        /// What is accepted.
        accepted: Accepted,
    },
    /// A named mass of a lumped sector, or what joins two of them, is refused.
    #[error("`{key}`: {problem}")]
    Chain {
        /// Full key, such as `model.lumped.spring[1].between`.
        key: String,
        /// What is wrong with it.
        problem: ChainProblem,
    },
    /// A lumped spring or the ring hangs on a mass that the model does not have.
    #[error(
        "`{key}` is {value} but there is no such mass to hold it; accepted: 0, or a positive `{mass_key}`"
    )]
    NeedsMass {
        /// Full key of the spring or mass.
        key: String,
        /// Value found, in the unit of the key.
        value: f64,
        /// Full key of the mass that is missing.
        mass_key: String,
    },
    /// A file of a bundle cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file or directory.
        path: PathBuf,
        /// What the system reports.
        source: std::io::Error,
    },
    /// A line of a bundle's file is refused.
    #[error("{}:{line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: LineProblem,
    },
    /// A line of a file of another code is refused.
    #[error("{}:{line}: {problem}", path.display())]
    ImportLine {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: Box<ImportProblem>,
    },
    /// A file of another code, or what several of them make up, is refused.
    #[error("{}: {problem}", path.display())]
    Import {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: Box<ImportProblem>,
    },
    /// Keys or values of an import file are not accepted; every one that was found.
    #[error("{}", listed(path, findings))]
    ImportFile {
        /// The import file.
        path: PathBuf,
        /// What was found.
        findings: Vec<Finding>,
    },
    /// A name cannot stand in the unquoted CSV files of a bundle.
    #[error(
        "observed node {index} is named {name:?}; accepted in a bundle: a name without comma, quote or line break"
    )]
    NameNotWritable {
        /// Index of the observed node.
        index: usize,
        /// The name.
        name: String,
    },
    /// The header of a bundle cannot be put into words.
    #[error("the bundle's header cannot be written: {source}")]
    HeaderNotWritable {
        /// What the TOML writer reports.
        source: toml::ser::Error,
    },
    /// An element refers to a node that is not there.
    #[error("element {element} has node {node}; accepted: 0 to {}", nodes.saturating_sub(1))]
    ElementNode {
        /// Index of the element.
        element: usize,
        /// Node referred to.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// An element refers to a material that is not there.
    #[error("element {element} has material {material}; accepted: an index below {materials}")]
    ElementMaterial {
        /// Index of the element.
        element: usize,
        /// Material referred to.
        material: usize,
        /// Number of materials.
        materials: usize,
    },
    /// An element shares a node with an element of the other body.
    #[error(
        "element {element} shares node {node} with the other body; accepted: bodies with nodes of their own"
    )]
    ElementBody {
        /// Index of the element.
        element: usize,
        /// The shared node.
        node: usize,
    },
    /// An element is turned inside out or degenerate.
    #[error(
        "element {element} has Jacobian determinant {determinant:e} at integration point {point}; accepted: positive (nodes in C3D20 order, no fold)"
    )]
    ElementInverted {
        /// Index of the element.
        element: usize,
        /// Integration point, 0 to 26.
        point: usize,
        /// Determinant of the Jacobian, m^3.
        determinant: f64,
    },
    /// A clamped node is not in the mesh.
    #[error("clamped node {node} is not in the mesh; accepted: 0 to {}", nodes.saturating_sub(1))]
    ClampedNode {
        /// The node.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// A free node lies on the axis of rotation, where radial and tangential are not defined.
    #[error(
        "node {node} lies on the axis (radius {radius_m:e} m); accepted: a free node off the axis, or a clamped one"
    )]
    NodeOnAxis {
        /// The node.
        node: usize,
        /// Its distance from the axis, m.
        radius_m: f64,
    },
    /// The number of sectors is nought.
    #[error("sectors is 0; accepted: at least 1")]
    NoSectors,
    /// The wheel has more sectors than can be solved.
    #[error("sectors is {sectors}; accepted: 1 to {most}")]
    TooManySectors {
        /// Number of sectors found.
        sectors: usize,
        /// Largest number accepted.
        most: usize,
    },
    /// The model has no degree of freedom.
    #[error("the model has no degree of freedom; accepted: at least 1")]
    NoDofs,
    /// A matrix and the dof table differ in size.
    #[error("{matrix} is {found} x {found} but there are {dofs} dofs; accepted: {dofs} x {dofs}")]
    MatrixSize {
        /// The matrix.
        matrix: Matrix,
        /// Its dimension.
        found: usize,
        /// Number of dofs.
        dofs: usize,
    },
    /// A number is NaN or infinite.
    #[error("{place} is {value}; accepted: a finite number")]
    NotFinite {
        /// Where it stands.
        place: Place,
        /// The value.
        value: f64,
    },
    /// A diagonal entry is negative.
    #[error("{matrix} has {value:e} on the diagonal of dof {dof}; accepted: 0 or more")]
    NegativeDiagonal {
        /// The matrix.
        matrix: Matrix,
        /// The dof.
        dof: usize,
        /// The entry.
        value: f64,
    },
    /// An entry off the diagonal is too large for a positive semidefinite matrix.
    #[error(
        "{matrix} is indefinite: entry (dof {row}, dof {column}) is {value:e}; accepted: at most {limit:e} in magnitude, the root of the product of its diagonal entries"
    )]
    Indefinite {
        /// The matrix.
        matrix: Matrix,
        /// Row, as a dof.
        row: usize,
        /// Column, as a dof.
        column: usize,
        /// The entry.
        value: f64,
        /// Largest magnitude a semidefinite matrix can have there.
        limit: f64,
    },
    /// The mass of a nodal diameter is not positive definite.
    #[error(
        "the mass matrix of nodal diameter {nodal_diameter} is not positive definite; accepted: a positive definite cyclic mass in every nodal diameter"
    )]
    MassNotPositiveDefinite {
        /// Nodal diameter h.
        nodal_diameter: usize,
    },
    /// A stiffness of a nodal diameter is not positive definite.
    #[error(
        "the {what} stiffness of nodal diameter {nodal_diameter} is not positive definite; accepted: a model that is held, by its clamp and a weak grounding of ring or damper body"
    )]
    StiffnessNotPositiveDefinite {
        /// Nodal diameter h.
        nodal_diameter: usize,
        /// Which stiffness.
        what: StiffnessKind,
    },
    /// No blade dof moves when the blade's root is held.
    #[error(
        "every blade dof also belongs to other structure, so the blade has no cantilever modes; accepted: projection = \"exact\", or a blade with dofs of its own"
    )]
    NoFreeBladeDof,
    /// The blade held at its root has no positive definite stiffness and mass.
    #[error(
        "the blade held at its root has no positive definite stiffness and mass; accepted: a K_blade that is positive definite on the blade's own dofs"
    )]
    CantileverNotPositiveDefinite,
    /// A stiffness couples none of the nodes of a solid.
    #[error(
        "{matrix} couples none of the {nodes} nodes that it has; accepted: the stiffness of a solid, with its entries off the diagonal (was only one triangle of it written, and the other one kept?)"
    )]
    NoCouplings {
        /// The matrix.
        matrix: Matrix,
        /// Nodes with an entry.
        nodes: usize,
    },
    /// A blade stiffness stands where the structure has none.
    #[error(
        "K_blade has {value:e} at (dof {row}, dof {column}) where K has no entry; accepted: a share of K"
    )]
    BladeEntryOutsideStiffness {
        /// Row, as a dof.
        row: usize,
        /// Column, as a dof.
        column: usize,
        /// The entry, N/m.
        value: f64,
    },
    /// The blade's share of a diagonal stiffness is more than the whole.
    #[error(
        "K_blade has {blade:e} on the diagonal of dof {dof} but K has {whole:e}; accepted: a share of K"
    )]
    BladeShareExceedsStiffness {
        /// The dof.
        dof: usize,
        /// Entry of `K_blade`, N/m.
        blade: f64,
        /// Entry of `K`, N/m.
        whole: f64,
    },
    /// A dof stands twice.
    #[error(
        "dofs {first} and {second} are both component {component} of node {node}; accepted: each component of a node once"
    )]
    DuplicateDof {
        /// First dof.
        first: usize,
        /// Second dof.
        second: usize,
        /// Node of both.
        node: usize,
        /// Component of both.
        component: Component,
    },
    /// The dofs of a node disagree in position or body.
    #[error(
        "dofs {first} and {second} of node {node} differ in position or body; accepted: one position and one body per node"
    )]
    NodeInconsistent {
        /// Node of both.
        node: usize,
        /// First dof.
        first: usize,
        /// Second dof.
        second: usize,
    },
    /// A dof that is not in the model.
    #[error("{place} refers to dof {dof}; accepted: 0 to {}", dofs.saturating_sub(1))]
    DofOutOfRange {
        /// Where it is referred to.
        place: Place,
        /// The dof.
        dof: usize,
        /// Number of dofs.
        dofs: usize,
    },
    /// A node without dofs.
    #[error("{place} refers to node {node}, which has no dof; accepted: a node of the dof table")]
    NodeUnknown {
        /// Where it is referred to.
        place: Place,
        /// The node.
        node: usize,
    },
    /// A dof or node of the high face where none may stand.
    #[error(
        "{place} refers to {item} on the high cyclic face, which belongs to the next sector; accepted: the low face or the interior"
    )]
    OnHighFace {
        /// Where it is referred to.
        place: Place,
        /// The dof or node.
        item: Item,
    },
    /// A dof stands in two cyclic pairs, or is paired with itself.
    #[error(
        "cyclic pair {pair} refers to dof {dof}, which cyclic pair {other} has too; accepted: each dof in one pair"
    )]
    CyclicDuplicate {
        /// The pair.
        pair: usize,
        /// The dof.
        dof: usize,
        /// The earlier pair, or the same one.
        other: usize,
    },
    /// The dofs of a cyclic pair differ in component or body.
    #[error(
        "cyclic pair {pair} (dofs {low} and {high}) joins different components or bodies; accepted: the same component of the same body on both faces"
    )]
    CyclicMismatch {
        /// The pair.
        pair: usize,
        /// Dof on the low face.
        low: usize,
        /// Dof on the high face.
        high: usize,
    },
    /// The nodes of a cyclic pair do not lie one sector apart.
    #[error(
        "cyclic pair {pair} (dofs {low} and {high}): the high node is {distance_m:e} m off the low node turned by one sector; accepted: at most {tolerance_m:e} m"
    )]
    CyclicPosition {
        /// The pair.
        pair: usize,
        /// Dof on the low face.
        low: usize,
        /// Dof on the high face.
        high: usize,
        /// Distance between the high node and the turned low node, m.
        distance_m: f64,
        /// Largest distance accepted, m.
        tolerance_m: f64,
    },
    /// A dof on a cyclic face without partner.
    #[error(
        "dof {dof} (component {component} of node {node}) lies on a cyclic face but stands in no cyclic pair; accepted: every dof of both faces paired"
    )]
    CyclicUnpaired {
        /// The dof.
        dof: usize,
        /// Its node.
        node: usize,
        /// Its component.
        component: Component,
    },
    /// Something is wrong with a contact pair.
    #[error("contact pair {pair}: {problem}")]
    Contact {
        /// The pair.
        pair: usize,
        /// What is wrong with it.
        problem: ContactProblem,
    },
    /// Something is wrong with a point of a rigid body.
    #[error("rigid point {point}: {problem}")]
    Rigid {
        /// The point, by its place in the list.
        point: usize,
        /// What is wrong with it.
        problem: RigidProblem,
    },
    /// A damper body that no contact pair touches.
    #[error(
        "node {node} belongs to a damper that no contact pair touches; accepted: dampers held by contact"
    )]
    DamperWithoutContact {
        /// A node of the damper.
        node: usize,
    },
    /// The contact weights do not sum to one.
    #[error("the contact weights sum to {sum}; accepted: 1 within 1e-6")]
    ContactWeightSum {
        /// The sum.
        sum: f64,
    },
    /// Two contact pairs join the same nodes.
    #[error("contact pairs {first} and {second} join the same nodes; accepted: each pair once")]
    ContactDuplicate {
        /// First pair.
        first: usize,
        /// Second pair.
        second: usize,
    },
    /// A dof is forced twice.
    #[error(
        "force entries {first} and {second} both act on dof {dof}; accepted: one entry per dof"
    )]
    ForceDuplicate {
        /// First entry.
        first: usize,
        /// Second entry.
        second: usize,
        /// The dof.
        dof: usize,
    },
    /// There is no force.
    #[error(
        "the model has no force (or only zeros); accepted: at least one dof with a force other than 0"
    )]
    NoForce,
    /// The force is so small or large that powers of the response would vanish or overflow.
    #[error(
        "force: the largest entry is {largest_n:e} N; accepted: 1e-30 to 1e30 N per newton of excitation.amplitude_n"
    )]
    ForceOutOfRange {
        /// Largest entry, N.
        largest_n: f64,
    },
    /// No node is observed.
    #[error("no node is observed; accepted: at least one (the first carries the peak metric)")]
    NoObservedNode,
    /// Two observed nodes share a name.
    #[error(
        "observed nodes {first} and {second} are both named {name:?}; accepted: names of their own"
    )]
    ObservedDuplicate {
        /// First entry.
        first: usize,
        /// Second entry.
        second: usize,
        /// The shared name.
        name: String,
    },
}
