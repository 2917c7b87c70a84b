//! What can be wrong with named masses and what joins them.

use thiserror::Error;

/// A refused mass, spring or contact of a lumped sector: the value found and what is accepted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ChainProblem {
    /// A name that is not well formed, or stands twice.
    #[error(
        "it is {name:?}; accepted: a name of its own of letters, digits, - and _, other than ground"
    )]
    Name {
        /// The name.
        name: String,
    },
    /// A name that no mass has.
    #[error("there is no mass {name:?}; accepted: {}", known.join(", "))]
    UnknownMass {
        /// The name.
        name: String,
        /// Names of the masses.
        known: Vec<String>,
    },
    /// Two ends that are one, or of which none is a mass of the sector.
    #[error(
        "it is [{:?}, {:?}]; accepted: two different ends, one of them a mass of the sector, the other a mass, next.NAME or ground",
        between[0],
        between[1]
    )]
    Ends {
        /// The ends as written.
        between: [String; 2],
    },
    /// A mistuned spring that ends in the next sector.
    #[error(
        "a spring to the next sector belongs to two blades; accepted: mistuned = true on springs of one sector"
    )]
    MistunedAcross,
    /// No spring is mistuned.
    #[error(
        "no spring has mistuned = true; accepted: at least one, whose sum is the blade's stiffness"
    )]
    NothingMistuned,
    /// There are springs or contacts without masses.
    #[error("there is none; accepted: at least one [[model.lumped.mass]]")]
    NoMass,
    /// No mass is forced.
    #[error("it is missing; accepted: the name of the mass on which 1 N acts")]
    NoForce,
    /// A key of blade, disk or ring beside named masses.
    #[error("it is {value}; accepted: no such key beside [[model.lumped.mass]]")]
    BesideNames {
        /// The value.
        value: f64,
    },
}
