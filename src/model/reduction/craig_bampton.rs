//! Craig-Bampton model of one nodal diameter: contact dofs kept, the rest in fixed-interface modes.

use std::f64::consts::TAU;

use crate::linalg::{
    Complex64, HermitianSparse, Matrix, SparseFactor, hermitian_pencil, lowest_modes,
};
use crate::model::cyclic::CyclicSector;
use crate::model::sector::{ModelError, StiffnessKind};

/// At most so many independent dofs, the whole space is the basis.
pub const WHOLE_SPACE_DOFS: usize = 12;
/// Share of their mass below which a combination of residual vectors is known by the others.
const KNOWN_ALREADY: f64 = 1e-8;
/// At most so many interior dofs, the fixed-interface modes are found by a dense solution.
const DENSE_INTERIOR: usize = 60;

/// Craig-Bampton model of nodal diameter h (Craig & Bampton 1968, AIAA J. 6(7)).
///
/// Displacement of the independent dofs `u = T q`, `T = [constraint modes, fixed-interface modes,
/// enrichment]`; sizes: `n_dofs` independent dofs, `size` columns.
#[derive(Debug, Clone)]
pub struct CraigBampton {
    /// Nodal diameter h.
    pub nodal_diameter: usize,
    /// Whether T spans all of the independent dofs.
    pub whole_space: bool,
    /// Highest natural frequency of the fixed-interface modes, Hz; none where none is left out.
    pub highest_fixed_interface_hz: Option<f64>,
    /// Columns of T that are constraint modes, and then those that are fixed-interface modes.
    columns: [usize; 2],
    /// Residual vectors after them.
    residual: Residual,
    /// Enrichment vectors in the columns of T, `size x n_enrichment`: what every basis keeps besides its modes.
    pub enrichment: Matrix<Complex64>,
    /// T, `n_dofs x size`.
    pub recovery: Matrix<Complex64>,
    /// `T^H K T`, contact-free, `size x size`.
    pub stiffness: Matrix<Complex64>,
    /// `T^H M T`, `size x size`.
    pub mass: Matrix<Complex64>,
    /// Relative motion `C T`, `n_rows x size`.
    pub contact: Matrix<Complex64>,
}

/// What is known of the residual vectors of a model.
#[derive(Debug, Clone)]
struct Residual {
    /// Each residual vector as a combination of the responses to the inertia of the constraint modes,
    /// `n_constraint x n_residual`.
    combinations: Matrix<Complex64>,
    /// Eigenvalues of the fixed-interface modes less the shift, (rad/s)^2.
    eigenvalues: Vec<f64>,
}

impl Residual {
    fn none() -> Self {
        Self {
            combinations: Matrix::zeros(0, 0),
            eigenvalues: Vec::new(),
        }
    }
}

impl CraigBampton {
    /// Reduces nodal diameter `h` with `modes` fixed-interface modes, and with residual vectors where they are asked for: what
    /// the inertia of each constraint mode moves outside of the fixed-interface modes, `(K_ii - s M_ii)^-1 (M_ii Psi + M_ib)`. They
    /// are the leading part of what the modes left out do (Kim & Lee 2015, Int. J. Numer. Meth. Engng 103(2)).
    ///
    /// # Errors
    /// If the mass is not positive definite, or the stiffness with held contact is indefinite.
    pub fn new(
        sector: &CyclicSector<'_>,
        h: usize,
        modes: usize,
        with_residual: bool,
    ) -> Result<Self, ModelError> {
        let mass = sector.mass(h);
        let stiffness = sector.stiffness(h);
        mass.factor()
            .map_err(|_| ModelError::MassNotPositiveDefinite { nodal_diameter: h })?;
        let n = sector.dimension();
        if n <= WHOLE_SPACE_DOFS {
            return Ok(Self::project(
                sector,
                h,
                &stiffness,
                &mass,
                Matrix::identity(n),
                true,
            ));
        }
        let boundary = sector.contact_dofs();
        let mut is_boundary = vec![false; n];
        for &dof in &boundary {
            is_boundary[dof] = true;
        }
        let interior: Vec<usize> = (0..n).filter(|&dof| !is_boundary[dof]).collect();
        let held = HeldInterior::new(&stiffness, &mass, &interior, h)?;
        let (eigenvalues, fixed) = held.modes(modes, h)?;
        let constraint = held.constraint_modes(&stiffness, &mass, &interior, &boundary);
        let room = n - boundary.len() - fixed.columns();
        let (residual, vectors) = if with_residual && room >= boundary.len() {
            let inertia = mass.block(&interior, &boundary);
            let (vectors, combinations) =
                held.residual_vectors(&inertia, &constraint, &fixed, h)?;
            let eigenvalues = eigenvalues
                .iter()
                .map(|eigenvalue| eigenvalue - held.shift)
                .collect();
            let residual = Residual {
                combinations,
                eigenvalues,
            };
            (residual, vectors)
        } else {
            (Residual::none(), Matrix::zeros(interior.len(), 0))
        };

        let columns = boundary.len() + fixed.columns() + vectors.columns();
        let mut recovery = Matrix::zeros(n, columns);
        for (column, &dof) in boundary.iter().enumerate() {
            recovery[(dof, column)] = Complex64::new(1.0, 0.0);
            for (row, &at) in interior.iter().enumerate() {
                recovery[(at, column)] = constraint[(row, column)];
            }
        }
        for column in 0..fixed.columns() {
            for (row, &at) in interior.iter().enumerate() {
                recovery[(at, boundary.len() + column)] = fixed[(row, column)];
            }
        }
        for column in 0..vectors.columns() {
            let to = boundary.len() + fixed.columns() + column;
            for (row, &at) in interior.iter().enumerate() {
                recovery[(at, to)] = vectors[(row, column)];
            }
        }
        let whole_space = columns == n;
        let mut model = Self::project(sector, h, &stiffness, &mass, recovery, whole_space);
        model.columns = [boundary.len(), fixed.columns()];
        model.residual = residual;
        model.highest_fixed_interface_hz = eigenvalues
            .last()
            .filter(|_| !whole_space)
            .map(|highest| highest.max(0.0).sqrt() / TAU);
        Ok(model)
    }

    /// This model with T enlarged by the sensitivity to blade stiffness of `count` stick modes,
    /// `(K + C^T k_c C)^-1 K_blade phi_j`: the static response to the force by which a stiffer
    /// blade loads mode j. The modes are those with the largest share of strain energy in the blade.
    ///
    /// # Errors
    /// If the mass or the stuck stiffness is not positive definite.
    pub fn with_blade_sensitivity(
        &self,
        sector: &CyclicSector<'_>,
        stick_springs: &[f64],
        count: usize,
    ) -> Result<Self, ModelError> {
        let h = self.nodal_diameter;
        if self.whole_space || count == 0 {
            return Ok(self.clone());
        }
        let (eigenvalues, vectors) = self.modes(stick_springs)?;
        let blade = sector.blade_stiffness();
        let candidates = vectors.columns().min(10);
        let modes = self.recovery.times(&vectors.column_range(0, candidates));
        let blade_force = blade.times(&modes);
        let energy = modes.adjoint_times(&blade_force);
        let mut order: Vec<usize> = (0..candidates).collect();
        let share = |j: usize| energy[(j, j)].re / eigenvalues[j].abs().max(f64::MIN_POSITIVE);
        order.sort_by(|&a, &b| share(b).total_cmp(&share(a)).then(a.cmp(&b)));
        order.truncate(count);
        order.sort_unstable();
        let chosen = Matrix::from_fn(blade_force.rows(), order.len(), |i, j| {
            blade_force[(i, order[j])]
        });
        let stiffness = sector.stiffness(h);
        let mass = sector.mass(h);
        let stuck = stiffness.plus(1.0, &sector.contact_stiffness(stick_springs, h));
        let factor = stuck
            .factor()
            .map_err(|_| ModelError::StiffnessNotPositiveDefinite {
                nodal_diameter: h,
                what: StiffnessKind::Stick,
            })?;
        let sensitivity = factor.solve(&chosen);
        let recovery = self.enlarge(&mass, &sensitivity)?;
        let mut model = Self::project(sector, h, &stiffness, &mass, recovery, false);
        // Whole vectors, not only their part outside of the Craig-Bampton space: a basis of few
        // modes lacks the part inside as well. With M-orthonormal Phi, c = Phi Phi^H T^H M s.
        let (_, phi) = pencil(&model.stiffness, &model.mass, h)?;
        let loaded = model.recovery.adjoint_times(&mass.times(&sensitivity));
        model.highest_fixed_interface_hz = self.highest_fixed_interface_hz;
        model.columns = self.columns;
        model.residual = self.residual.clone();
        model.enrichment = phi.times(&phi.adjoint_times(&loaded));
        Ok(model)
    }

    /// This model with its first `modes` fixed-interface modes alone; what the modes left out contribute to the residual vectors
    /// stays in these.
    #[must_use]
    pub fn with_fewer_modes(&self, modes: usize) -> Self {
        let [constraint, fixed] = self.columns;
        if modes >= fixed {
            return self.clone();
        }
        let one = Complex64::new(1.0, 0.0);
        let kept = (0..constraint + modes).chain(constraint + fixed..self.size());
        let kept: Vec<usize> = kept.collect();
        let mut within = Matrix::zeros(self.size(), kept.len());
        for (column, &row) in kept.iter().enumerate() {
            within[(row, column)] = one;
        }
        let Residual {
            combinations,
            eigenvalues,
        } = &self.residual;
        for mode in modes..fixed {
            for vector in 0..combinations.columns() {
                let inertia = |b: usize| self.mass[(constraint + mode, b)];
                let part = (0..constraint).map(|b| inertia(b) * combinations[(b, vector)]);
                let part = part.sum::<Complex64>() / eigenvalues[mode];
                within[(constraint + mode, constraint + modes + vector)] = part;
            }
        }
        let both = |a: &Matrix<Complex64>| within.adjoint_times(&a.times(&within));
        Self {
            nodal_diameter: self.nodal_diameter,
            whole_space: false,
            highest_fixed_interface_hz: None,
            columns: [constraint, modes],
            residual: self.residual.clone(),
            enrichment: Matrix::zeros(kept.len(), 0),
            recovery: self.recovery.times(&within),
            stiffness: both(&self.stiffness),
            mass: both(&self.mass),
            contact: self.contact.times(&within),
        }
    }

    /// Eigenvalues (rad/s)^2, ascending, and M-orthonormal modes of the model with contact
    /// springs `springs` (N/m, one per contact row).
    ///
    /// # Errors
    /// If the mass is not positive definite.
    pub fn modes(&self, springs: &[f64]) -> Result<(Vec<f64>, Matrix<Complex64>), ModelError> {
        pencil(
            &self.stiffness_with_contact(springs),
            &self.mass,
            self.nodal_diameter,
        )
    }

    /// `T^H (K + C^T diag(springs) C) T`.
    #[must_use]
    pub fn stiffness_with_contact(&self, springs: &[f64]) -> Matrix<Complex64> {
        let scaled = Matrix::from_fn(self.contact.rows(), self.contact.columns(), |i, j| {
            self.contact[(i, j)] * springs[i]
        });
        let mut sum = self.contact.adjoint_times(&scaled);
        for (entry, &structure) in sum.as_mut_slice().iter_mut().zip(self.stiffness.as_slice()) {
            *entry += structure;
        }
        sum
    }

    /// Number of columns of T.
    #[must_use]
    pub fn size(&self) -> usize {
        self.recovery.columns()
    }

    /// `[T, extra]` where `extra` is first made M-orthogonal to T and to itself, so that the
    /// enlarged mass stays well conditioned; what lies in the span of T already is left out.
    fn enlarge(
        &self,
        mass: &HermitianSparse,
        extra: &Matrix<Complex64>,
    ) -> Result<Matrix<Complex64>, ModelError> {
        let h = self.nodal_diameter;
        let (_, basis) = pencil(&self.stiffness, &self.mass, h)?;
        let mut orthonormal = self.recovery.times(&basis);
        let mut recovery = self.recovery.clone();
        for column in 0..extra.columns() {
            let mut vector = extra.column_range(column, column + 1);
            let norm = |x: &Matrix<Complex64>| x.adjoint_times(&mass.times(x))[(0, 0)].re.sqrt();
            let before = norm(&vector);
            for _ in 0..2 {
                let inside = orthonormal.times(&orthonormal.adjoint_times(&mass.times(&vector)));
                for (entry, &part) in vector.as_mut_slice().iter_mut().zip(inside.as_slice()) {
                    *entry -= part;
                }
            }
            let after = norm(&vector);
            if after > 1e-8 * before {
                for entry in vector.as_mut_slice() {
                    *entry /= after;
                }
                orthonormal = orthonormal.beside(&vector);
                recovery = recovery.beside(&vector);
            }
        }
        Ok(recovery)
    }

    fn project(
        sector: &CyclicSector<'_>,
        nodal_diameter: usize,
        stiffness: &HermitianSparse,
        mass: &HermitianSparse,
        recovery: Matrix<Complex64>,
        whole_space: bool,
    ) -> Self {
        let reduced_stiffness = recovery.adjoint_times(&stiffness.times(&recovery));
        let reduced_mass = recovery.adjoint_times(&mass.times(&recovery));
        let rows = sector.contact_rows(nodal_diameter);
        let contact = Matrix::from_fn(rows.len(), recovery.columns(), |i, j| {
            rows[i]
                .iter()
                .map(|&(dof, factor)| factor * recovery[(dof, j)])
                .sum()
        });
        Self {
            nodal_diameter,
            whole_space,
            highest_fixed_interface_hz: None,
            columns: [recovery.columns(), 0],
            residual: Residual::none(),
            enrichment: Matrix::zeros(recovery.columns(), 0),
            recovery,
            stiffness: reduced_stiffness,
            mass: reduced_mass,
            contact,
        }
    }
}

/// Hermitian pencil solved in real numbers where it is real (nodal diameters 0 and N/2), so that
/// its modes are real, as the basis of a standing wave must be.
pub(super) fn pencil(
    k: &Matrix<Complex64>,
    m: &Matrix<Complex64>,
    nodal_diameter: usize,
) -> Result<(Vec<f64>, Matrix<Complex64>), ModelError> {
    let real = |a: &Matrix<Complex64>| a.as_slice().iter().all(|x| x.im == 0.0);
    let solved = if real(k) && real(m) {
        hermitian_pencil(&k.real(), &m.real()).map(|(values, x)| (values, x.to_complex()))
    } else {
        hermitian_pencil(k, m)
    };
    solved.map_err(|_| ModelError::MassNotPositiveDefinite { nodal_diameter })
}

/// The interior of a sector with its contact dofs held.
struct HeldInterior {
    factor: SparseFactor,
    stiffness: HermitianSparse,
    mass: HermitianSparse,
    /// 0, or negative where the held interior still has rigid-body modes.
    shift: f64,
}

impl HeldInterior {
    fn new(
        stiffness: &HermitianSparse,
        mass: &HermitianSparse,
        interior: &[usize],
        nodal_diameter: usize,
    ) -> Result<Self, ModelError> {
        let stiffness = stiffness.principal(interior);
        let mass = mass.principal(interior);
        let trace = |a: &HermitianSparse| -> f64 {
            a.entries()
                .filter(|&(i, j, _)| i == j)
                .map(|(_, _, value)| value.re)
                .sum()
        };
        for shift in [0.0, -1e-6 * trace(&stiffness) / trace(&mass)] {
            if let Ok(factor) = stiffness.plus(-shift, &mass).factor() {
                return Ok(Self {
                    factor,
                    stiffness,
                    mass,
                    shift,
                });
            }
        }
        Err(ModelError::StiffnessNotPositiveDefinite {
            nodal_diameter,
            what: StiffnessKind::FixedInterface,
        })
    }

    /// Eigenvalues (rad/s)^2, ascending, and modes, `n_interior x count`.
    fn modes(
        &self,
        count: usize,
        nodal_diameter: usize,
    ) -> Result<(Vec<f64>, Matrix<Complex64>), ModelError> {
        let n = self.mass.dimension();
        if n <= DENSE_INTERIOR {
            let all: Vec<usize> = (0..n).collect();
            let (mut values, vectors) = pencil(
                &self.stiffness.block(&all, &all),
                &self.mass.block(&all, &all),
                nodal_diameter,
            )?;
            values.truncate(count);
            return Ok((values, vectors.column_range(0, count.min(n))));
        }
        lowest_modes(&self.factor, &self.mass, self.shift, count)
            .map_err(|_| ModelError::MassNotPositiveDefinite { nodal_diameter })
    }

    /// Response to the inertia of each constraint mode outside of the fixed-interface modes, orthonormal in the mass, with its
    /// combinations of the responses; `inertia` is `M_ib`. What is known by the others already is left out.
    fn residual_vectors(
        &self,
        inertia: &Matrix<Complex64>,
        constraint: &Matrix<Complex64>,
        fixed: &Matrix<Complex64>,
        nodal_diameter: usize,
    ) -> Result<(Matrix<Complex64>, Matrix<Complex64>), ModelError> {
        let mut right = self.mass.times(constraint);
        for (entry, &added) in right.as_mut_slice().iter_mut().zip(inertia.as_slice()) {
            *entry += added;
        }
        let mut response = self.factor.solve(&right);
        for _ in 0..2 {
            let inside = fixed.adjoint_times(&self.mass.times(&response));
            let inside = fixed.times(&inside);
            for (entry, &part) in response.as_mut_slice().iter_mut().zip(inside.as_slice()) {
                *entry -= part;
            }
        }
        let gram = response.adjoint_times(&self.mass.times(&response));
        let count = gram.columns();
        let scales: Vec<f64> = (0..count)
            .map(|i| gram[(i, i)].re.max(f64::MIN_POSITIVE).sqrt().recip())
            .collect();
        let scaled = Matrix::from_fn(count, count, |i, j| gram[(i, j)] * (scales[i] * scales[j]));
        let (sizes, directions) = pencil(&scaled, &Matrix::identity(count), nodal_diameter)?;
        let first = sizes.partition_point(|&size| size < KNOWN_ALREADY * count as f64);
        let combinations = Matrix::from_fn(count, count - first, |i, j| {
            directions[(i, first + j)] * (scales[i] / sizes[first + j].sqrt())
        });
        Ok((response.times(&combinations), combinations))
    }

    /// Static (for a shift, quasi-static) interior response to unit motions of the boundary,
    /// `-(K_ii - s M_ii)^-1 (K_ib - s M_ib)`.
    fn constraint_modes(
        &self,
        stiffness: &HermitianSparse,
        mass: &HermitianSparse,
        interior: &[usize],
        boundary: &[usize],
    ) -> Matrix<Complex64> {
        let mut right = stiffness.block(interior, boundary);
        let inertia = mass.block(interior, boundary);
        for (entry, &m) in right.as_mut_slice().iter_mut().zip(inertia.as_slice()) {
            *entry = -(*entry - m * self.shift);
        }
        self.factor.solve(&right)
    }
}
