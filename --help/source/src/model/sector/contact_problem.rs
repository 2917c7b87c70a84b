//! What can be wrong with a contact pair of a sector model.

use std::fmt;

use thiserror::Error;

use super::sector_model::ContactSide;

/// A refused contact pair: the value found and what is accepted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContactProblem {
    /// A node belongs to the wrong body, where the columns of the bundle say which one is on which.
    #[error(
        "node {node} is on the wrong body; accepted: the blisk node on the blisk, the ring node on the ring"
    )]
    Body {
        /// The node.
        node: usize,
    },
    /// A point in contact with itself, or a ground that is the first side.
    #[error(
        "it joins {first} and {second}; accepted: two different points, of which the second may be the ground"
    )]
    Sides {
        /// First side.
        first: ContactSide,
        /// Second side.
        second: ContactSide,
    },
    /// Contact with the next sector of a wheel that has none.
    #[error("it reaches the next sector of a wheel of one sector; accepted: at least 2 sectors")]
    OneSector,
    /// The sides have different components.
    #[error(
        "{first} and {second} have different components, {first_has} and {second_has}; accepted: the same components on both"
    )]
    Components {
        /// First side.
        first: ContactSide,
        /// Second side.
        second: ContactSide,
        /// Components of the first side, as a bundle names them.
        first_has: String,
        /// Components of the second side.
        second_has: String,
    },
    /// The sides stand at different angles.
    #[error(
        "{first} and {second} are {difference_rad:e} rad apart; accepted: the same theta within {tolerance_rad:e} rad"
    )]
    Angle {
        /// First side.
        first: ContactSide,
        /// Second side.
        second: ContactSide,
        /// Difference of their angles, rad.
        difference_rad: f64,
        /// Largest difference accepted, rad.
        tolerance_rad: f64,
    },
    /// The normal is not of unit length.
    #[error("the normal has length {length}; accepted: 1 within 1e-6")]
    Normal {
        /// Length of the normal.
        length: f64,
    },
    /// The weight is not positive.
    #[error("weight is {weight}; accepted: above 0")]
    Weight {
        /// The weight.
        weight: f64,
    },
}

impl fmt::Display for ContactSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Node(node) => write!(f, "node {node}"),
            Self::NextSector(node) => write!(f, "node {node} of the next sector"),
            Self::Ground => f.write_str("the ground"),
        }
    }
}
