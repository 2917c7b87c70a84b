//! The harmonics of a set with the wheel that each lives in, in the order of the unknowns, and the motions at the contact rows.
//!
//! Unknowns are real: for harmonic 0 the modal coordinates, for every other harmonic first the real, then the imaginary
//! parts. The contact rows C lead from the unknowns of a harmonic to its coefficients of the contact displacement.

use std::ops::Range;
use std::sync::Arc;

use super::{ContactStiffnessMatrix, Structure};
use crate::linalg::{
    Matrix, add_times, add_times_vector, add_transpose_times, add_transpose_times_vector,
};

/// One harmonic of the set: its number, and the structure it lives in.
#[derive(Debug, Clone)]
pub struct HarmonicBlock {
    /// Harmonic k.
    pub harmonic: u32,
    /// Structure; the wheel's is shared by all harmonics, a tuned wave has one per harmonic.
    pub structure: Arc<Structure>,
    /// Linear stuck contact stiffness of that structure.
    pub stuck: Arc<ContactStiffnessMatrix>,
}

impl HarmonicBlock {
    /// Number of complex unknowns: modal coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.structure.size()
    }
}

/// The harmonics of a set in their order.
#[derive(Debug, Clone)]
pub(in crate::response::harmonic_balance) struct HarmonicBlocks {
    blocks: Vec<HarmonicBlock>,
    /// First unknown of each block, and the number of unknowns at the end.
    start: Vec<usize>,
    /// First real coefficient of each block.
    coefficient: Vec<usize>,
    /// Whether all harmonics have the same real matrices, those of a wheel: the unknowns are then one matrix
    /// with a column per real coefficient.
    shared: bool,
}

impl HarmonicBlocks {
    /// The set of `blocks`, one at least.
    pub(super) fn new(blocks: Vec<HarmonicBlock>) -> Self {
        let mut start = vec![0];
        let mut coefficient = Vec::new();
        let (mut unknowns, mut coefficients) = (0, 0);
        for block in &blocks {
            let parts = if block.harmonic == 0 { 1 } else { 2 };
            coefficient.push(coefficients);
            coefficients += parts;
            unknowns += parts * block.size();
            start.push(unknowns);
        }
        let shared = blocks.iter().all(|block| {
            Arc::ptr_eq(&block.structure, &blocks[0].structure)
                && Arc::ptr_eq(&block.stuck, &blocks[0].stuck)
                && block.structure.contact().imaginary.is_none()
                && block.stuck.imaginary.is_none()
        });
        Self {
            blocks,
            start,
            coefficient,
            shared,
        }
    }

    /// The harmonics with their structures.
    pub(super) fn as_slice(&self) -> &[HarmonicBlock] {
        &self.blocks
    }

    /// Number of real unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.start[self.blocks.len()]
    }

    /// Unknowns of the blocks at these places.
    pub(in crate::response::harmonic_balance) fn unknowns_of(
        &self,
        places: Range<usize>,
    ) -> Range<usize> {
        self.start[places.start]..self.start[places.end]
    }

    /// First real coefficient of every block.
    pub(in crate::response::harmonic_balance) fn coefficients(&self) -> &[usize] {
        &self.coefficient
    }

    /// Place of harmonic 1 among the blocks.
    pub(super) fn fundamental(&self) -> usize {
        self.blocks
            .iter()
            .position(|block| block.harmonic == 1)
            .unwrap_or(0)
    }

    /// Whether all harmonics have the same real matrices.
    pub(super) fn are_shared(&self) -> bool {
        self.shared
    }

    /// Number of contact rows over all sectors.
    pub(super) fn contact_rows(&self) -> usize {
        self.blocks[0].structure.contact().real.rows()
    }

    /// Largest number of modal coordinates of a harmonic.
    pub(super) fn largest(&self) -> usize {
        let sizes = self.blocks.iter().map(|block| block.structure.size());
        sizes.max().unwrap_or(0)
    }

    /// From now on the stuck contact has these springs at the contact rows, N/m.
    pub(super) fn set_springs(&mut self, springs: &[f64]) {
        let mut renewed: Vec<(Arc<Structure>, Arc<ContactStiffnessMatrix>)> = Vec::new();
        for block in &mut self.blocks {
            let known = renewed
                .iter()
                .find(|(structure, _)| Arc::ptr_eq(structure, &block.structure));
            let stuck = known.map_or_else(
                || Arc::new(block.structure.contact_stiffness(springs)),
                |(_, stuck)| Arc::clone(stuck),
            );
            renewed.push((Arc::clone(&block.structure), Arc::clone(&stuck)));
            block.stuck = stuck;
        }
    }

    /// Coefficients of `C x`.
    pub(in crate::response::harmonic_balance) fn contact_displacement(
        &self,
        x: &[f64],
        displacement: &mut [f64],
    ) {
        displacement.fill(0.0);
        if self.shared {
            let rows = &self.blocks[0].structure.contact().real;
            let size = (rows.rows(), x.len() / rows.columns().max(1), rows.columns());
            add_times(displacement, rows.as_slice(), x, size);
            return;
        }
        let n_rows = self.contact_rows();
        for link in self.links() {
            let x = &x[link.unknown..link.unknown + link.size];
            let d = &mut displacement[link.coefficient * n_rows..][..n_rows];
            add_times_vector(d, link.sign, link.rows.as_slice(), x);
        }
    }

    /// `residual += C^H G`, where harmonics have matrices of their own.
    pub(super) fn add_contact_force(&self, correction: &[f64], residual: &mut [f64]) {
        let n_rows = self.contact_rows();
        for link in self.links() {
            let r = &mut residual[link.unknown..link.unknown + link.size];
            let g = &correction[link.coefficient * n_rows..][..n_rows];
            add_transpose_times_vector(r, link.sign, link.rows.as_slice(), g);
        }
    }

    /// `residual += C^T (k_c d + G)` for displacements d and corrections G at the contact rows, where all harmonics have
    /// the same matrices; `contact_force` has their size.
    pub(super) fn add_shared_force(
        &self,
        displacement: &[f64],
        correction: &[f64],
        contact_force: &mut [f64],
        residual: &mut [f64],
    ) {
        let block = &self.blocks[0];
        let rows = &block.structure.contact().real;
        let columns = displacement.chunks_exact(rows.rows());
        let corrections = correction.chunks_exact(rows.rows());
        let forces = contact_force.chunks_exact_mut(rows.rows());
        for ((force, displacement), correction) in forces.zip(columns).zip(corrections) {
            let springs = block.stuck.springs.iter();
            let both = displacement.iter().zip(correction);
            for ((force, spring), (d, g)) in force.iter_mut().zip(springs).zip(both) {
                *force = spring * d + g;
            }
        }
        let (n, count) = (rows.columns(), residual.len() / rows.columns().max(1));
        let size = (n, count, rows.rows());
        add_transpose_times(residual, n, 1.0, rows.as_slice(), contact_force, size);
    }

    /// How the real unknowns enter the real coefficients of the contact displacement:
    /// `Re d = Re C Re x - Im C Im x`, `Im d = Re C Im x + Im C Re x`.
    pub(super) fn links(&self) -> Vec<Link<'_>> {
        let mut links = Vec::new();
        for (index, block) in self.blocks.iter().enumerate() {
            let size = block.structure.size();
            let (unknown, coefficient) = (self.start[index], self.coefficient[index]);
            let contact = block.structure.contact();
            let mut link = |from: usize, to: usize, sign: f64, rows| {
                links.push(Link {
                    unknown: unknown + from * size,
                    size,
                    coefficient: coefficient + to,
                    sign,
                    rows,
                });
            };
            link(0, 0, 1.0, &contact.real);
            if block.harmonic > 0 {
                link(1, 1, 1.0, &contact.real);
                if let Some(imaginary) = &contact.imaginary {
                    link(1, 0, -1.0, imaginary);
                    link(0, 1, 1.0, imaginary);
                }
            }
        }
        links
    }
}

/// One real block of the map from unknowns to contact coefficients.
pub(super) struct Link<'a> {
    pub(super) unknown: usize,
    pub(super) size: usize,
    pub(super) coefficient: usize,
    pub(super) sign: f64,
    pub(super) rows: &'a Matrix<f64>,
}
