//! Contact rows of the pairs that slip or separate, packed side by side, and what the motion of unknowns changes their forces by.
//!
//! Pairs that neither slip nor separate have no derivative of the correction G and cost nothing; without separation the
//! correction along the normal has none.

use crate::linalg::{Matrix, add_transpose_times};
use crate::response::harmonic_balance::pairs::{ContactInterface, InterfaceWorkspace};

/// Packed rows, buffers of one thread for the Jacobian of one system.
#[derive(Debug)]
pub(super) struct ActiveRows {
    /// The pairs that slip or separate.
    pairs: Vec<usize>,
    /// All contact rows of these pairs, column after column of unknowns.
    motions: Vec<f64>,
    /// Those of them that have a correction, and how many they are.
    forces: Vec<f64>,
    force_rows: usize,
    /// `dG/dd C` at these.
    changes: Vec<f64>,
}

impl ActiveRows {
    /// Buffers for at most `entries` entries of the contact rows of a harmonic.
    pub(super) fn new(entries: usize) -> Self {
        Self {
            pairs: Vec::new(),
            motions: vec![0.0; entries],
            forces: vec![0.0; entries],
            force_rows: 0,
            changes: vec![0.0; entries],
        }
    }

    /// Begins with the pairs that slip or separate; false where there are none.
    pub(super) fn begin(&mut self, contact: &InterfaceWorkspace) -> bool {
        self.pairs.clear();
        let active = (0..contact.active.len()).filter(|&pair| contact.active[pair]);
        self.pairs.extend(active);
        !self.pairs.is_empty()
    }

    /// Packs all contact rows of the pairs: those that motions are taken from.
    pub(super) fn pack_motions(&mut self, interface: &ContactInterface, rows: &Matrix<f64>) {
        pack(interface, &self.pairs, rows, 0, &mut self.motions);
    }

    /// Packs the contact rows of the pairs that have a correction, those along the normal where pairs separate.
    pub(super) fn pack_forces(
        &mut self,
        interface: &ContactInterface,
        rows: &Matrix<f64>,
        separated: bool,
    ) {
        let skipped = usize::from(!separated);
        self.force_rows = pack(interface, &self.pairs, rows, skipped, &mut self.forces);
    }

    /// Derivatives of G times the rows of [`Self::pack_motions`], of `size` columns; `slope` picks the wanted one from
    /// a block of a pair's.
    pub(super) fn change(
        &mut self,
        interface: &ContactInterface,
        contact: &InterfaceWorkspace,
        size: usize,
        slope: impl Fn(&[f64]) -> f64,
    ) {
        let per_sector = interface.per_sector();
        let (mut from, mut to) = (0, 0);
        for _ in 0..size {
            for &pair in &self.pairs {
                let jacobian = &contact.jacobians[pair];
                let places = &interface.geometry.rows[pair % per_sector];
                let source = &self.motions[from..];
                let target = &mut self.changes[to..];
                let normal = places[0].map(|_| source[0]);
                let mut at = usize::from(normal.is_some());
                let mut first = 0;
                if let (Some(normal), true) = (normal, contact.separated) {
                    target[0] = slope(&jacobian.normal_normal) * normal;
                    first = 1;
                }
                let first_tangent = at;
                let mut written = first;
                for (tangent, place) in places[1..].iter().enumerate() {
                    if place.is_some() {
                        target[written] = slope(&jacobian.tangential_tangential[tangent])
                            * source[at]
                            + normal.map_or(0.0, |normal| {
                                slope(&jacobian.tangential_normal[tangent]) * normal
                            });
                        written += 1;
                        at += 1;
                    }
                }
                if let (Some([by_second, by_first]), [_, Some(_), Some(_)]) =
                    (&jacobian.tangential_cross, places)
                {
                    target[first] += slope(by_second) * source[first_tangent + 1];
                    target[first + 1] += slope(by_first) * source[first_tangent];
                }
                from += at;
                to += written;
            }
        }
    }

    /// `target += factor C^T dG/dd C`, a column-major block of `rows x columns` unknowns in columns of `height`.
    pub(super) fn add_product(
        &self,
        target: &mut [f64],
        height: usize,
        factor: f64,
        (rows, columns): (usize, usize),
    ) {
        let count = self.force_rows;
        add_transpose_times(
            target,
            height,
            factor,
            &self.forces[..count * rows],
            &self.changes[..count * columns],
            (rows, columns, count),
        );
    }
}

/// Contact rows of `pairs` side by side into `packed`, without the first `skipped` directions; returns their number.
fn pack(
    interface: &ContactInterface,
    pairs: &[usize],
    rows: &Matrix<f64>,
    skipped: usize,
    packed: &mut [f64],
) -> usize {
    let per_sector = interface.per_sector();
    let sector_rows = interface.geometry.row_count();
    let mut at = 0;
    for column in 0..rows.columns() {
        let source = rows.column(column);
        for &pair in pairs {
            let base = pair / per_sector * sector_rows;
            let places = &interface.geometry.rows[pair % per_sector];
            for row in places[skipped..].iter().flatten() {
                packed[at] = source[base + row];
                at += 1;
            }
        }
    }
    at / rows.columns().max(1)
}
