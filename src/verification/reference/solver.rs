//! One frequency after the other on the full-contact model: attempts, amplitudes, work.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::ReferenceSettings;
use super::contact::ContactForces;
use super::newton::{CondensedHarmonic, CondensedSystem, NewtonSolution, load};
use super::receptance::SprungStructure;
use super::structure::{FullStructure, force};
use crate::linalg::Complex64;
use crate::model::ReducedModel;
use crate::model::cyclic::nodal_diameter_of;
use crate::response::forced_response::{AmplitudeMeasure, ContactCondition};
use crate::response::friction::{PairParameters, Ring};
use crate::response::harmonic_balance::{ContactShares, DriftingRing, Status, let_creep};
use crate::response::mistuning::{ContactFactors, Pattern};

/// Work done on a row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ReferenceWork {
    /// Frequencies solved.
    pub solves: u64,
    /// Newton iterations, all attempts.
    pub newton_iterations: u64,
}

/// A converged frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferencePoint {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude of every blade, m; one for a tuned wheel.
    pub amplitudes_m: Vec<f64>,
    /// Residual force relative to the excitation; 0 for a linear limit.
    pub residual: f64,
    /// Shares of slipping and separated pairs.
    pub shares: ContactShares,
    /// Displacement at the contact rows, harmonic by harmonic; empty for a linear limit.
    displacement: Vec<f64>,
}

/// Solver of one wheel under one excitation and contact condition.
pub struct ReferenceSolver {
    /// The structure each harmonic lives in, with the springs of the condition.
    structures: Vec<(u32, Arc<SprungStructure>)>,
    force: Vec<Complex64>,
    /// Nonlinear contact; none for a linear limit.
    contact: Option<ContactForces>,
    settings: ReferenceSettings,
    points: Vec<ReferencePoint>,
    failures: Vec<(f64, Status)>,
    work: ReferenceWork,
}

impl ReferenceSolver {
    /// The tuned wheel as one sector (`pattern` none: harmonic k in nodal diameter `k EO mod N`), or
    /// the whole wheel with `pattern`. `model` is a Craig-Bampton model with every contact dof.
    ///
    /// # Errors
    /// The pattern cannot be applied.
    pub fn new(
        model: &ReducedModel,
        settings: &ReferenceSettings,
        engine_order: u32,
        condition: ContactCondition,
        pattern: Option<&Pattern>,
    ) -> Result<Self, Status> {
        let springs = match condition {
            ContactCondition::Full { .. } | ContactCondition::Stuck => Some(&model.springs.stick),
            ContactCondition::Slide => Some(&model.springs.slide),
            ContactCondition::Free => None,
        };
        let nominal = ContactFactors::default();
        let factors = pattern.map_or(&nominal, |pattern| &pattern.contact);
        if !factors.are_possible() {
            return Err(Status::InvalidPattern);
        }
        let springs = springs.map(|sector| factors.springs(sector, &model.contact.rows));
        let sprung = |structure| {
            Arc::new(SprungStructure::new(
                Arc::new(structure),
                springs.as_deref(),
            ))
        };
        let nonlinear = match (condition, settings.contact) {
            (ContactCondition::Full { normal_load_n }, Some((law, sector))) => Some((
                law,
                PairParameters {
                    normal_load_n,
                    ..sector
                },
            )),
            _ => None,
        };
        let harmonics = match nonlinear {
            Some(_) => settings.harmonics(),
            None => vec![1],
        };
        let structures: Vec<(u32, Arc<SprungStructure>)> = match pattern {
            None => harmonics
                .iter()
                .map(|&harmonic| {
                    let wave = nodal_diameter_of(harmonic, engine_order, model.sectors);
                    let tuned = FullStructure::tuned_wave(model, wave, settings.damping);
                    (harmonic, sprung(tuned))
                })
                .collect(),
            Some(pattern) => {
                let wheel = FullStructure::mistuned_wheel(
                    model,
                    pattern,
                    settings.projection,
                    settings.damping,
                );
                let wheel = sprung(wheel.ok_or(Status::InvalidPattern)?);
                harmonics.iter().map(|&k| (k, Arc::clone(&wheel))).collect()
            }
        };
        let sectors = if pattern.is_some() { model.sectors } else { 1 };
        let contact = nonlinear.map(|(law, sector)| {
            let transform = Arc::clone(&settings.transform);
            let geometry = model.contact.clone();
            ContactForces::new(law, sector, factors, geometry, sectors, transform)
        });
        Ok(Self {
            structures,
            force: force(model, engine_order, settings.amplitude_n, pattern.is_some()),
            contact,
            settings: settings.clone(),
            points: Vec::new(),
            failures: Vec::new(),
            work: ReferenceWork::default(),
        })
    }

    /// Its settings.
    #[must_use]
    pub fn settings(&self) -> &ReferenceSettings {
        &self.settings
    }

    /// Converged frequencies in the order in which they were solved.
    #[must_use]
    pub fn points(&self) -> &[ReferencePoint] {
        &self.points
    }

    /// Frequencies, Hz, that could not be solved.
    #[must_use]
    pub fn failures(&self) -> &[(f64, Status)] {
        &self.failures
    }

    /// Work done so far.
    #[must_use]
    pub fn work(&self) -> ReferenceWork {
        self.work
    }

    /// Solves at one frequency, Hz.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    pub fn solve(&mut self, frequency_hz: f64) -> Result<&ReferencePoint, Status> {
        self.work.solves += 1;
        match self.point(frequency_hz) {
            Ok(point) => {
                self.points.push(point);
                Ok(&self.points[self.points.len() - 1])
            }
            Err(status) => {
                self.failures.push((frequency_hz, status));
                Err(status)
            }
        }
    }

    fn point(&mut self, frequency_hz: f64) -> Result<ReferencePoint, Status> {
        let structures = self.structures.clone();
        let Some(contact) = self.contact.take() else {
            return self.linear_point(&structures[0].1, frequency_hz);
        };
        let solved = self.nonlinear_point(&structures, &contact, frequency_hz);
        self.contact = Some(contact);
        solved
    }

    fn linear_point(
        &self,
        structure: &SprungStructure,
        frequency_hz: f64,
    ) -> Result<ReferencePoint, Status> {
        let factors = structure.factor(1, TAU * frequency_hz);
        let response = factors.ok_or(Status::SingularJacobian)?.forced(&self.force);
        if response.observed.iter().any(|u| !u.is_finite()) {
            return Err(Status::NonFinite);
        }
        Ok(ReferencePoint {
            frequency_hz,
            amplitudes_m: self.amplitudes(&[(1, response.observed)]),
            residual: 0.0,
            shares: ContactShares::default(),
            displacement: Vec::new(),
        })
    }

    fn nonlinear_point(
        &mut self,
        structures: &[(u32, Arc<SprungStructure>)],
        contact: &ContactForces,
        frequency_hz: f64,
    ) -> Result<ReferencePoint, Status> {
        let omega = TAU * frequency_hz;
        let harmonics: Option<Vec<CondensedHarmonic<'_>>> = structures
            .iter()
            .map(|(harmonic, structure)| {
                let factors = structure.factor(*harmonic, omega)?;
                Some(CondensedHarmonic {
                    harmonic: *harmonic,
                    structure: structure.structure(),
                    receptance: factors.receptance(),
                    forced: (*harmonic == 1).then(|| factors.forced(&self.force)),
                })
            })
            .collect();
        let force_norm = self
            .force
            .iter()
            .map(Complex64::norm_sqr)
            .sum::<f64>()
            .sqrt();
        let system = CondensedSystem {
            harmonics: harmonics.ok_or(Status::SingularJacobian)?,
            force_norm,
            rows: structures[0].1.structure().contact_rows(),
        };
        let solution = match self.settings.ring {
            Ring::Locked => self.attempts(&system, contact, frequency_hz)?,
            Ring::Creeping => self.creeping(&system, contact, frequency_hz)?,
        };
        let observed: Vec<(u32, Vec<Complex64>)> = system
            .places()
            .map(|(start, harmonic)| {
                let force = load(&solution.force[start..], harmonic.harmonic, system.rows);
                let mut observed = harmonic.receptance.observed.times_vector(&force);
                for (row, u) in observed.iter_mut().enumerate() {
                    let forced = harmonic.forced.as_ref().map(|forced| forced.observed[row]);
                    *u = forced.unwrap_or_default() - *u;
                }
                (harmonic.harmonic, observed)
            })
            .collect();
        Ok(ReferencePoint {
            frequency_hz,
            amplitudes_m: self.amplitudes(&observed),
            residual: solution.residual,
            shares: solution.shares,
            displacement: solution.displacement,
        })
    }

    /// With a ring that is free to creep.
    fn creeping(
        &mut self,
        system: &CondensedSystem<'_>,
        contact: &ContactForces,
        frequency_hz: f64,
    ) -> Result<NewtonSolution, Status> {
        let mut ring = CreepingRing {
            solver: self,
            system,
            contact: contact.with_load_factor(1.0),
            frequency_hz,
            solution: None,
        };
        match let_creep(&mut ring) {
            Status::Ok => ring.solution.ok_or(Status::Stagnated),
            status => Err(status),
        }
    }

    /// From the nearest solved frequency, from the stuck solution, by homotopy in normal load.
    fn attempts(
        &mut self,
        system: &CondensedSystem<'_>,
        contact: &ContactForces,
        frequency_hz: f64,
    ) -> Result<NewtonSolution, Status> {
        let distance = |point: &&ReferencePoint| (point.frequency_hz - frequency_hz).abs();
        let nearest = self
            .points
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .map(|point| point.displacement.clone());
        for start in nearest.into_iter().chain([system.stuck()]) {
            let solution = self.newton(system, contact, start);
            if solution.status == Status::Ok {
                return Ok(solution);
            }
        }
        self.lower_normal_load(system, contact)
    }

    fn newton(
        &mut self,
        system: &CondensedSystem<'_>,
        contact: &ContactForces,
        start: Vec<f64>,
    ) -> NewtonSolution {
        let solution = system.solve(contact, start, self.settings.residual_tolerance);
        self.work.newton_iterations += solution.iterations;
        solution
    }

    /// From a load at which every pair sticks down to that of the condition, in steps of its
    /// logarithm that are halved on failure.
    fn lower_normal_load(
        &mut self,
        system: &CondensedSystem<'_>,
        contact: &ContactForces,
    ) -> Result<NewtonSolution, Status> {
        const HIGHEST: f64 = 256.0;
        const SMALLEST_STEP: f64 = 1.0 / 128.0;
        let (mut exponent, mut step, mut current) = (1.0, 0.125, system.stuck());
        loop {
            let next = f64::max(exponent - step, 0.0);
            let loaded = contact.with_load_factor(HIGHEST.powf(next));
            let solution = self.newton(system, &loaded, current.clone());
            if solution.status == Status::Ok && next <= 0.0 {
                return Ok(solution);
            }
            if solution.status == Status::Ok {
                current = solution.displacement;
                exponent = next;
            } else if step > SMALLEST_STEP {
                step *= 0.5;
            } else {
                return Err(solution.status);
            }
        }
    }

    /// Amplitude of every blade from the observed displacement of each harmonic.
    fn amplitudes(&self, observed: &[(u32, Vec<Complex64>)]) -> Vec<f64> {
        let blades = self.structures[0].1.structure().blades();
        (0..blades)
            .map(|blade| match self.settings.amplitude {
                AmplitudeMeasure::Fundamental => observed
                    .iter()
                    .filter(|(harmonic, _)| *harmonic == 1)
                    .flat_map(|(_, u)| &u[3 * blade..3 * blade + 3])
                    .map(Complex64::norm_sqr)
                    .sum::<f64>()
                    .sqrt(),
                AmplitudeMeasure::TimeMaximum => {
                    time_maximum(observed, blade, self.settings.time_samples)
                }
            })
            .collect()
    }
}

/// Largest norm of a blade's displacement over `instants` of a period, harmonic 0 left out.
fn time_maximum(observed: &[(u32, Vec<Complex64>)], blade: usize, instants: usize) -> f64 {
    (0..instants)
        .map(|instant| {
            let angle = TAU * instant as f64 / instants as f64;
            (3 * blade..3 * blade + 3)
                .map(|row| {
                    observed
                        .iter()
                        .filter(|(harmonic, _)| *harmonic > 0)
                        .map(|(harmonic, u)| {
                            let turn = Complex64::from_polar(1.0, f64::from(*harmonic) * angle);
                            (u[row] * turn).re
                        })
                        .sum::<f64>()
                        .powi(2)
                })
                .sum::<f64>()
        })
        .fold(0.0, f64::max)
        .sqrt()
}

/// A wheel at one frequency, whose ring creeps.
struct CreepingRing<'a, 'b> {
    solver: &'a mut ReferenceSolver,
    system: &'a CondensedSystem<'b>,
    contact: ContactForces,
    frequency_hz: f64,
    /// The last one, from which the next one is sought.
    solution: Option<NewtonSolution>,
}

impl DriftingRing for CreepingRing<'_, '_> {
    fn pairs(&self) -> &[PairParameters] {
        self.contact.first_pairs()
    }

    fn free_motions(&self) -> [bool; 2] {
        self.contact.free_ring_motions()
    }

    fn drift_m(&self) -> [f64; 2] {
        self.contact.ring_drift_m()
    }

    fn set_drift(&mut self, drift_m: [f64; 2]) {
        self.contact.set_ring_drift(drift_m);
    }

    fn mean_friction_n(&mut self) -> [f64; 2] {
        let solution = self.solution.as_ref();
        solution.map_or([f64::NAN; 2], |solution| {
            self.contact.mean_friction_n(&solution.displacement)
        })
    }

    fn solve(&mut self) -> Status {
        let Self {
            solver,
            system,
            contact,
            ..
        } = self;
        let solved = match self.solution.take() {
            Some(known) => {
                let next = solver.newton(system, contact, known.displacement);
                let status = next.status;
                (status == Status::Ok).then_some(next).ok_or(status)
            }
            None => solver.attempts(system, contact, self.frequency_hz),
        };
        let status = solved.as_ref().err().copied();
        self.solution = solved.ok();
        status.unwrap_or(Status::Ok)
    }
}
