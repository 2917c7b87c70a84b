//! From a cyclic sector to a reduced model: Craig-Bampton once, then a basis of a chosen size.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use serde::Serialize;

use rayon::prelude::*;

use super::basis::basis_of;
use super::blade::{blade_energy, cantilever_modes};
use super::craig_bampton::{CraigBampton, pencil};
use super::nodal_diameter_damping::NodalDiameterDamping;
use crate::linalg::{Complex64, Matrix};
use crate::model::blade_energy::BladeEnergy;
use crate::model::cyclic::CyclicSector;
use crate::model::reduced_model::{
    BasisChoice, ContactSprings, NodalDiameterReport, ReducedModel, ReducedNodalDiameter,
};
use crate::model::sector::{ModelError, SectorModel};

/// Number of frequencies per nodal diameter in the report.
const REPORTED_FREQUENCIES: usize = 6;

/// The Craig-Bampton models of the nodal diameters 0..=N/2 of a sector: each made once, when it is asked for,
/// then reduced further as often as a choice of basis asks for.
#[derive(Debug)]
pub struct Reduction<'a> {
    name: &'a str,
    sector: CyclicSector<'a>,
    springs: ContactSprings,
    craig_bampton_modes: usize,
    sensitivity_vectors: usize,
    residual_vectors: bool,
    damping: NodalDiameterDamping,
    force_factors: Vec<(u32, f64)>,
    models: Vec<OnceLock<CraigBampton>>,
}

/// Per-sector contact stiffness, N/m, in normal, first and second tangential direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactStiffness {
    /// Normal stiffness kn; 0 where the law has none.
    pub normal_n_per_m: f64,
    /// Stiffness kt along the first tangent.
    pub tangential_1_n_per_m: f64,
    /// Stiffness kt along the second tangent; 0 where the law has none.
    pub tangential_2_n_per_m: f64,
}

impl<'a> Reduction<'a> {
    /// Craig-Bampton models with `craig_bampton_modes` fixed-interface modes, nodal diameters in
    /// parallel, and `sensitivity_vectors` to blade stiffness in each.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite.
    pub fn new(
        model: &'a SectorModel,
        stiffness: ContactStiffness,
        craig_bampton_modes: usize,
        sensitivity_vectors: usize,
    ) -> Result<Self, ModelError> {
        Self::on_demand(model, stiffness, craig_bampton_modes, sensitivity_vectors).completed()
    }

    /// Craig-Bampton models with `craig_bampton_modes` fixed-interface modes and `sensitivity_vectors` to blade stiffness in
    /// each, none of them made yet: each is made when it is first needed.
    #[must_use]
    pub fn on_demand(
        model: &'a SectorModel,
        stiffness: ContactStiffness,
        craig_bampton_modes: usize,
        sensitivity_vectors: usize,
    ) -> Self {
        let sector = CyclicSector::new(model);
        let springs = ContactSprings {
            stick: sector.contact().springs([
                stiffness.normal_n_per_m,
                stiffness.tangential_1_n_per_m,
                stiffness.tangential_2_n_per_m,
            ]),
            slide: sector
                .contact()
                .springs([stiffness.normal_n_per_m, 0.0, 0.0]),
        };
        Self {
            name: &model.name,
            sector,
            springs,
            craig_bampton_modes,
            sensitivity_vectors,
            residual_vectors: false,
            damping: NodalDiameterDamping::default(),
            force_factors: Vec::new(),
            models: (0..=model.sectors / 2).map(|_| OnceLock::new()).collect(),
        }
    }

    /// This reduction with modes damped by nodal diameter besides what damps the structure.
    #[must_use]
    pub fn with_damping(self, damping: NodalDiameterDamping) -> Self {
        Self { damping, ..self }
    }

    /// This reduction with a factor on the force vector under each engine order of `force_factors`; 1 under all others.
    #[must_use]
    pub fn with_force_factors(self, force_factors: Vec<(u32, f64)>) -> Self {
        Self {
            force_factors,
            ..self
        }
    }

    /// This reduction with a residual vector for each constraint mode in the models that are made from now on.
    #[must_use]
    pub fn with_residual_vectors(self) -> Self {
        Self {
            residual_vectors: true,
            ..self
        }
    }

    /// Number of sectors N.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.sector.sectors()
    }

    /// This reduction with the models of all nodal diameters made, in parallel.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite.
    pub fn completed(self) -> Result<Self, ModelError> {
        (0..self.models.len())
            .into_par_iter()
            .try_for_each(|h| self.model(h).map(|_| ()))?;
        Ok(self)
    }

    /// Copy of this reduction in which every model made so far has its first `modes` fixed-interface modes alone: for
    /// [`BasisChoice::CraigBampton`], the basis of all coordinates.
    #[must_use]
    pub fn with_fewer_modes(&self, modes: usize) -> Self {
        let fewer = |model: &OnceLock<CraigBampton>| {
            let fewer_modes = OnceLock::new();
            if let Some(model) = model.get() {
                fewer_modes.get_or_init(|| model.with_fewer_modes(modes));
            }
            fewer_modes
        };
        Self {
            name: self.name,
            sector: self.sector.clone(),
            springs: self.springs.clone(),
            craig_bampton_modes: modes,
            sensitivity_vectors: self.sensitivity_vectors,
            residual_vectors: self.residual_vectors,
            damping: self.damping.clone(),
            force_factors: self.force_factors.clone(),
            models: self.models.iter().map(fewer).collect(),
        }
    }

    fn model(&self, h: usize) -> Result<&CraigBampton, ModelError> {
        if let Some(model) = self.models[h].get() {
            return Ok(model);
        }
        let model = CraigBampton::new(
            &self.sector,
            h,
            self.craig_bampton_modes,
            self.residual_vectors,
        )?
        .with_blade_sensitivity(
            &self.sector,
            &self.springs.stick,
            self.sensitivity_vectors,
        )?;
        Ok(self.models[h].get_or_init(|| model))
    }

    /// The Craig-Bampton models made so far, in order of their nodal diameters.
    pub fn models(&self) -> impl Iterator<Item = &CraigBampton> {
        self.models.iter().filter_map(OnceLock::get)
    }

    /// Whether every nodal diameter keeps all of its dofs, so that any basis is the whole space.
    #[must_use]
    pub fn is_whole_space(&self) -> bool {
        self.models().next().is_some() && self.models().all(|model| model.whole_space)
    }

    /// Fixed-interface modes of a nodal diameter, where it has so many.
    #[must_use]
    pub fn fixed_interface_modes(&self) -> usize {
        self.craig_bampton_modes
    }

    /// Number of contact rows of a sector.
    #[must_use]
    pub fn contact_rows(&self) -> usize {
        self.sector.contact().row_count()
    }

    /// One nodal diameter in the given basis.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite.
    pub fn nodal_diameter(
        &self,
        h: usize,
        choice: BasisChoice,
    ) -> Result<ReducedNodalDiameter, ModelError> {
        Ok(self.project(h, choice)?.0)
    }

    /// The reduced model of the wheel in the given basis, with `cantilever_modes` of the blade
    /// where the mistuning goes through them.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite, or the blade has no cantilever modes.
    pub fn reduce(
        &self,
        choice: BasisChoice,
        cantilever_mode_count: Option<usize>,
    ) -> Result<ReducedModel, ModelError> {
        let mut model = self.reduce_in_factors(choice, cantilever_mode_count)?;
        model.blade_energy = BladeEnergy::Gram(model.blade_energy.gram().into_owned());
        Ok(model)
    }

    /// [`Self::reduce`] with the blade's strain energy in the form that takes less memory: for a large basis, where few columns of the
    /// energy are asked for.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite, or the blade has no cantilever modes.
    pub fn reduce_large(
        &self,
        choice: BasisChoice,
        cantilever_mode_count: Option<usize>,
    ) -> Result<ReducedModel, ModelError> {
        let mut model = self.reduce_in_factors(choice, cantilever_mode_count)?;
        if model.blade_energy.memory_bytes() > 8 * model.blade_energy.size().pow(2) {
            model.blade_energy = BladeEnergy::Gram(model.blade_energy.gram().into_owned());
        }
        Ok(model)
    }

    fn reduce_in_factors(
        &self,
        choice: BasisChoice,
        cantilever_mode_count: Option<usize>,
    ) -> Result<ReducedModel, ModelError> {
        let all: Vec<usize> = (0..self.models.len()).collect();
        let (mut model, bases) = self.nodal_diameters(choice, &all)?;
        model.cantilever = cantilever_mode_count
            .map(|count| cantilever_modes(&self.sector, &bases, count))
            .transpose()?;
        model.blade_energy = blade_energy(&self.sector, &bases);
        Ok(model)
    }

    /// The reduced model of the wheel without the blade's stiffness in it: of the tuned wheel only,
    /// and much cheaper.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite.
    pub fn tuned(&self, choice: BasisChoice) -> Result<ReducedModel, ModelError> {
        let all: Vec<usize> = (0..self.models.len()).collect();
        Ok(self.nodal_diameters(choice, &all)?.0)
    }

    /// The reduced model, without the blade's stiffness, of a tuned wheel that answers in the nodal diameters `wanted`
    /// alone; the other nodal diameters have no modes.
    ///
    /// # Errors
    /// If a mass or stiffness is not positive definite.
    pub fn tuned_in(
        &self,
        choice: BasisChoice,
        wanted: &[usize],
    ) -> Result<ReducedModel, ModelError> {
        Ok(self.nodal_diameters(choice, wanted)?.0)
    }

    /// The reduced model but for the blade, and the basis of each nodal diameter (`n_dofs x n_modes`).
    fn nodal_diameters(
        &self,
        choice: BasisChoice,
        wanted: &[usize],
    ) -> Result<(ReducedModel, Vec<Matrix<Complex64>>), ModelError> {
        let projected = (0..self.models.len())
            .into_par_iter()
            .map(|h| {
                if wanted.contains(&h) {
                    self.project(h, choice)
                } else {
                    Ok(self.without_modes(h))
                }
            })
            .collect::<Result<Vec<_>, _>>()?;
        let mut nodal_diameters = Vec::new();
        let mut bases = Vec::new();
        let mut report = Vec::new();
        for (nodal_diameter, basis, line) in projected {
            nodal_diameters.push(nodal_diameter);
            bases.push(basis);
            report.push(line);
        }
        let model = ReducedModel {
            name: self.name.to_owned(),
            sectors: self.sector.sectors(),
            basis: choice,
            whole_space: self.is_whole_space(),
            nodal_diameters,
            contact: self.sector.contact().clone(),
            springs: self.springs.clone(),
            blade_energy: BladeEnergy::unknown(),
            cantilever: None,
            force_factors: self.force_factors.clone(),
            report,
        };
        Ok((model, bases))
    }

    /// Reduced matrices, the basis over the independent dofs (`n_dofs x n_modes`), and the report.
    fn project(
        &self,
        h: usize,
        choice: BasisChoice,
    ) -> Result<(ReducedNodalDiameter, Matrix<Complex64>, NodalDiameterReport), ModelError> {
        let model = self.model(h)?;
        // All coordinates of Craig-Bampton are a basis as they stand, and are nobody's to report.
        let is_basis = model.whole_space || choice != BasisChoice::CraigBampton;
        let basis = is_basis.then(|| basis_of(model, &self.springs, choice));
        let basis = basis.transpose()?;
        let (eigenvalues, v) = match &basis {
            Some(basis) => {
                let v = &basis.vectors;
                let mass = v.adjoint_times(&model.mass.times(v));
                let stiffness = v.adjoint_times(&model.stiffness.times(v));
                let (eigenvalues, rotation) = pencil(&stiffness, &mass, h)?;
                (eigenvalues, v.times(&rotation))
            }
            None => pencil(&model.stiffness, &model.mass, h)?,
        };
        let full = model.recovery.times(&v);
        let observed = self.sector.observed_dofs();
        let observed = Matrix::from_fn(3, full.columns(), |i, j| {
            observed[i].map_or(Complex64::default(), |dof| full[(dof, j)])
        });
        // One product per load case, so that each is the same with and without the others.
        let forces = self.sector.forces();
        let projected = |basis: &Matrix<Complex64>| {
            let columns = forces.iter().map(|force| basis.adjoint_times(force));
            columns.reduce(|left, right| left.beside(&right))
        };
        let none = || Matrix::zeros(full.columns(), 0);
        let blade = || self.sector.blade_stiffness();
        let reduced = ReducedNodalDiameter {
            added_damping_per_s: self.damping.of_modes(h, &eigenvalues, &full, blade),
            contact: model.contact.times(&v),
            observed,
            force: projected(&full).unwrap_or_else(none),
            conjugate_force: projected(&full.conjugate()).unwrap_or_else(none),
            eigenvalues,
        };
        let report = match &basis {
            Some(basis) => NodalDiameterReport {
                nodal_diameter: h,
                craig_bampton_size: model.size(),
                candidates: basis.singular_values.len(),
                rank: basis.rank(),
                condition: basis.condition(),
                stick_frequencies_hz: frequencies_hz(&model.modes(&self.springs.stick)?.0),
                slide_frequencies_hz: frequencies_hz(&model.modes(&self.springs.slide)?.0),
                free_frequencies_hz: frequencies_hz(&pencil(&model.stiffness, &model.mass, h)?.0),
            },
            None => unreported(h, model.size()),
        };
        Ok((reduced, full, report))
    }
}

impl Reduction<'_> {
    /// [`Self::project`] onto nothing.
    fn without_modes(
        &self,
        h: usize,
    ) -> (ReducedNodalDiameter, Matrix<Complex64>, NodalDiameterReport) {
        let reduced = ReducedNodalDiameter {
            contact: Matrix::zeros(self.contact_rows(), 0),
            observed: Matrix::zeros(3, 0),
            force: Matrix::zeros(0, self.sector.load_cases()),
            conjugate_force: Matrix::zeros(0, self.sector.load_cases()),
            added_damping_per_s: Vec::new(),
            eigenvalues: Vec::new(),
        };
        let basis = Matrix::zeros(self.sector.dimension(), 0);
        (reduced, basis, unreported(h, 0))
    }
}

/// The line of a nodal diameter without a basis of its own.
fn unreported(nodal_diameter: usize, craig_bampton_size: usize) -> NodalDiameterReport {
    NodalDiameterReport {
        nodal_diameter,
        craig_bampton_size,
        candidates: craig_bampton_size,
        rank: craig_bampton_size,
        condition: 1.0,
        stick_frequencies_hz: Vec::new(),
        slide_frequencies_hz: Vec::new(),
        free_frequencies_hz: Vec::new(),
    }
}

fn frequencies_hz(eigenvalues: &[f64]) -> Vec<f64> {
    eigenvalues
        .iter()
        .take(REPORTED_FREQUENCIES)
        .map(|value| value.max(0.0).sqrt() / TAU)
        .collect()
}
