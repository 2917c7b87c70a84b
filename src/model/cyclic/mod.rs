//! Cyclic symmetry: nodal diameters, engine-order aliasing, matrices per nodal diameter.
//!
//! Signs, fixed here once: the wheel's displacement is `u_n = (1/sqrt N) sum_h U_h e^{+i h n alpha}`
//! for sector n = 0..N-1 with `alpha = 2 pi / N`; on the cyclic faces `u_high = e^{+i h alpha} u_low`;
//! the force on sector n is `f e^{+i EO n alpha}` and time enters as `Re(U_k e^{+i k omega t})`.
//! In a tuned wheel temporal harmonic k therefore lives in nodal diameter `h = k EO mod N` alone.
//! Components are cylindrical at each node's own angle, so that a face condition is a scalar phase.

mod centrifugal;
mod contact_rows;
mod cyclic_sector;
mod natural_frequencies;
mod nodal_diameter;

pub use centrifugal::{CentrifugalContact, CentrifugalError, Hoop, centrifugal_contact};
pub use contact_rows::{
    ContactGeometry, ContactRow, Direction, RowEntry, pair_tangents, ring_free,
};
pub use cyclic_sector::CyclicSector;
pub use natural_frequencies::{contact_free_frequencies_hz, natural_frequencies_hz};
pub use nodal_diameter::{NodalDiameter, nodal_diameter_of, phase};
