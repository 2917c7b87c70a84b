//! The parts of an error message: places, matrices and accepted values.

use std::fmt;

use super::sector_model::Component;

/// Values that an option accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Accepted {
    /// Above nought and finite.
    Positive,
    /// Nought or more and finite.
    NonNegative,
    /// A whole number between two limits, both included.
    Count(usize, usize),
    /// A number between two limits, the upper one excluded.
    Range(f64, f64),
    /// At most a length given by other options, m.
    AtMostM(&'static str, f64),
    /// Less than a length given by other options, m.
    BelowM(&'static str, f64),
    /// More than a length given by other options, m.
    AboveM(&'static str, f64),
}

impl fmt::Display for Accepted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Positive => write!(f, "a finite number above 0"),
            Self::NonNegative => write!(f, "a finite number of 0 or more"),
            Self::Count(low, high) => write!(f, "a whole number from {low} to {high}"),
            Self::Range(low, high) => write!(f, "a number from {low} to below {high}"),
            Self::AtMostM(what, limit) => write!(f, "at most {what} = {limit} m"),
            Self::BelowM(what, limit) => write!(f, "below {what} = {limit} m"),
            Self::AboveM(what, limit) => write!(f, "above {what} = {limit} m"),
        }
    }
}

/// A matrix of the sector model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Matrix {
    /// Stiffness `K`.
    Stiffness,
    /// Mass `M`.
    Mass,
    /// Blade stiffness `K_blade`.
    BladeStiffness,
}

impl fmt::Display for Matrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stiffness => "K",
            Self::Mass => "M",
            Self::BladeStiffness => "K_blade",
        })
    }
}

/// A stiffness whose definiteness a solver needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StiffnessKind {
    /// The structure without contact springs.
    Structure,
    /// With normal contact springs only.
    Slide,
    /// With normal and tangential contact springs.
    Stick,
    /// With the contact and observed dofs held.
    FixedInterface,
}

impl fmt::Display for StiffnessKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Structure => "contact-free",
            Self::Slide => "slide",
            Self::Stick => "stick",
            Self::FixedInterface => "fixed-interface",
        })
    }
}

/// A place in a sector model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Entry (row, column) of a matrix, as dofs.
    Entry(Matrix, usize, usize),
    /// Coordinate x, y or z (0, 1, 2) of a dof.
    Position(usize, usize),
    /// Coordinate x, y or z (0, 1, 2) of a point of a rigid body.
    RigidPosition(usize, usize),
    /// A point of a rigid body.
    RigidPoint(usize),
    /// A cyclic pair.
    CyclicPair(usize),
    /// A contact pair.
    ContactPair(usize),
    /// An entry of the force.
    Force(usize),
    /// An observed node.
    Observed(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Entry(matrix, row, column) => {
                write!(f, "{matrix} entry (dof {row}, dof {column})")
            }
            Self::Position(dof, axis) => write!(f, "{} of dof {dof}", ["x", "y", "z"][*axis]),
            Self::RigidPosition(point, axis) => {
                write!(f, "{} of rigid point {point}", ["x", "y", "z"][*axis])
            }
            Self::RigidPoint(point) => write!(f, "rigid point {point}"),
            Self::CyclicPair(pair) => write!(f, "cyclic pair {pair}"),
            Self::ContactPair(pair) => write!(f, "contact pair {pair}"),
            Self::Force(entry) => write!(f, "force entry {entry}"),
            Self::Observed(entry) => write!(f, "observed node {entry}"),
        }
    }
}

/// A dof or a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// A degree of freedom.
    Dof(usize),
    /// A node.
    Node(usize),
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dof(dof) => write!(f, "dof {dof}"),
            Self::Node(node) => write!(f, "node {node}"),
        }
    }
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Radial => "r",
            Self::Tangential => "t",
            Self::Axial => "z",
            Self::RotationRadial => "rr",
            Self::RotationTangential => "rt",
            Self::RotationAxial => "rz",
        })
    }
}
