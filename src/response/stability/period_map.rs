//! The linear map of one period: a small disturbance of a periodic motion, and of the sliders, to what is left of it.
//!
//! The state is `(q, q', w)`: modal positions and velocities of the wheel without contact, wave after wave, and the slider
//! positions of every pair. In every step the structure is exact and the contact is solved for at its end,
//!
//! ```text
//! y = y* + W f,    f = f_0 + T y
//! ```
//!
//! y are the motions of contact rows and blade strain (with the rates of the strain), f the forces on them, W what a force at
//! the end of the step does, T the tangent of the contact in this step and of the blade deviations. `(I - T W) f = f_0 + T y*`
//! is solved by GMRES, preconditioned sector by sector: within a step sectors hardly feel each other.

use super::contact_path::ContactPath;
use super::contact_tangent::{FrictionChange, StepChange};
use super::sector_waves::SectorWaves;
use super::wave_step::{Compliance, WaveStep};
use crate::linalg::{LuWorkspace, Matrix, add_times_vector, gmres};
use crate::response::receptance::FreeWheel;

/// Share of the largest force at which the forces of a step count as found.
const FORCE_TOLERANCE: f64 = 1e-10;
/// Products for the forces of a step from which on they do not count as found.
const MOST_PRODUCTS: usize = 120;
/// Modes above this many radians per step follow their forces as springs.
const RESOLVED: f64 = 0.8;
/// Numbers kept of the preconditioner at most.
const MOST_KEPT: usize = 100_000_000;

/// The map of one period.
#[derive(Debug)]
pub(super) struct PeriodMap {
    pub(super) waves: Vec<WaveStep>,
    pub(super) transform: SectorWaves,
    pub(super) contact: ContactPath,
    /// `delta`, coordinate after coordinate, and the viscous part of its force over its elastic one, s.
    deviations: Vec<f64>,
    damping_s: f64,
    strains: usize,
    step: Instant,
    rest: Instant,
    /// Factor on every component of the state that makes squares energies.
    scale: Vec<f64>,
}

/// Compliances at an instant and what precedes the solution of its forces.
#[derive(Debug)]
struct Instant {
    /// W of every wave as `[Re, -Im; Im, Re]`, column-major.
    waves: Vec<Matrix<f64>>,
    /// `(I - T W_0)^-1` with the block of W of a sector.
    inverses: Vec<Matrix<f64>>,
    /// Which of `inverses` applies, step after step, sector after sector.
    places: Vec<usize>,
}

/// Everything that one period moves.
pub(super) struct Moving {
    pub(super) position: Vec<Vec<f64>>,
    velocity: Vec<Vec<f64>>,
    pub(super) sliders: Vec<f64>,
    /// Motions of every sector: contact, strain, rates of the strain.
    pub(super) motion: Vec<f64>,
    before: Vec<f64>,
    /// Forces of every sector: contact, strain.
    force: Vec<f64>,
    modal: Vec<Vec<f64>>,
    wave_force: Vec<f64>,
    wave_motion: Vec<f64>,
}

impl PeriodMap {
    /// Of a wheel about the motion that `contact` goes along, at the angular frequency `omega`; none if a step cannot be
    /// solved for, or the wheel is too large.
    pub(super) fn new(wheel: &FreeWheel, contact: ContactPath, omega: f64) -> Option<Self> {
        let step_s = std::f64::consts::TAU / omega / contact.steps as f64;
        let strains = wheel.waves.first()?.strain.rows();
        let kept = (step_s, RESOLVED / step_s);
        let steps = wheel.waves.iter().enumerate().map(|(h, wave)| {
            let real = h == 0 || 2 * h == wheel.sectors;
            WaveStep::new(wave, real, wheel.loss_factor, omega, kept)
        });
        let (waves, compliances): (Vec<WaveStep>, Vec<Compliance>) = steps.unzip();
        let transform = SectorWaves::new(wheel.sectors);
        let mut map = Self {
            step: Instant::of(compliances.iter().map(|compliance| &compliance.of_step)),
            rest: Instant::of(compliances.iter().map(|compliance| &compliance.at_rest)),
            scale: Vec::new(),
            deviations: wheel.deviations.clone(),
            damping_s: wheel.loss_factor / omega,
            waves,
            transform,
            contact,
            strains,
        };
        map.scale = map.energies(omega);
        map.precondition()?;
        Some(map)
    }

    /// Number of components of the state.
    #[must_use]
    pub(super) fn size(&self) -> usize {
        self.scale.len()
    }

    pub(super) fn channels(&self) -> (usize, usize) {
        let forces = self.contact.sector_rows + self.strains;
        (forces, forces + self.strains)
    }

    fn energies(&self, omega: f64) -> Vec<f64> {
        let mut scale = Vec::new();
        for wave in &self.waves {
            let parts = if wave.real { 1 } else { 2 };
            for _ in 0..parts {
                let stiffness = wave.eigenvalues.iter().map(|lambda| lambda.max(0.0));
                scale.extend(stiffness.map(|lambda| (lambda + omega * omega).sqrt()));
            }
            scale.extend(std::iter::repeat_n(1.0, parts * wave.size()));
        }
        let sliders = self.contact.tangential.iter();
        scale.extend(sliders.flat_map(|kt| [kt.max(f64::MIN_POSITIVE).sqrt(); 2]));
        scale
    }

    /// `(I - T W_0)^-1` of every step and sector; the same one where the tangent stays.
    fn precondition(&mut self) -> Option<()> {
        let rest = self.contact.at_rest();
        let pairs = self.contact.pair_rows.len();
        for sector in 0..self.transform.sectors() {
            let changes = &rest[sector * pairs..][..pairs];
            let inverse = self.inverse(changes, sector, &self.rest)?;
            self.rest.places.push(self.rest.inverses.len());
            self.rest.inverses.push(inverse);
        }
        let mut last: Vec<Option<(Vec<StepChange>, usize)>> = vec![None; self.transform.sectors()];
        for step in 0..self.contact.steps {
            for (sector, last) in last.iter_mut().enumerate() {
                let changes = self.contact.of_sector(step, sector);
                let place = match last {
                    Some((before, place)) if same_end(before, changes) => *place,
                    _ => {
                        let inverse = self.inverse(changes, sector, &self.step)?;
                        let place = self.step.inverses.len();
                        if place * inverse.as_slice().len() > MOST_KEPT {
                            return None;
                        }
                        *last = Some((changes.to_vec(), place));
                        self.step.inverses.push(inverse);
                        place
                    }
                };
                self.step.places.push(place);
            }
        }
        Some(())
    }

    fn inverse(&self, pairs: &[StepChange], sector: usize, at: &Instant) -> Option<Matrix<f64>> {
        let (forces, motions) = self.channels();
        let block = self.transform.sector_block(&at.waves, (motions, forces));
        let mut factors = LuWorkspace::<f64>::new(forces);
        for column in 0..forces {
            let mut force = vec![0.0; forces];
            self.tangent(pairs, sector, block.column(column), &mut force);
            for (row, force) in force.iter().enumerate() {
                let unit = f64::from(u8::from(row == column));
                factors.matrix_mut()[column * forces + row] = unit - force;
            }
        }
        if !factors.factor() {
            return None;
        }
        let mut inverse = Matrix::identity(forces);
        factors.solve_columns(&mut inverse);
        Some(inverse)
    }

    /// `f += T y` of a sector.
    fn tangent(&self, pairs: &[StepChange], sector: usize, motion: &[f64], force: &mut [f64]) {
        let kt = &self.contact.tangential[sector * pairs.len()..];
        for ((change, rows), kt) in pairs.iter().zip(&self.contact.pair_rows).zip(kt) {
            let at = rows.map(|row| row.map_or(0.0, |row| motion[row]));
            if let Some(row) = rows[0] {
                force[row] -= change.normal * at[0];
            }
            for tangent in 0..2 {
                let Some(row) = rows[1 + tangent] else {
                    continue;
                };
                force[row] -= match change.friction[tangent] {
                    FrictionChange::None => 0.0,
                    FrictionChange::Stick => kt * at[1 + tangent],
                    FrictionChange::Moves(slopes) => product(&slopes.after, &at),
                };
            }
        }
        let (forces, _) = self.channels();
        let sectors = self.transform.sectors();
        for strain in 0..self.strains {
            let place = self.contact.sector_rows + strain;
            let delta = self.deviations[strain * sectors + sector];
            force[place] -= delta * (motion[place] + self.damping_s * motion[forces + strain]);
        }
    }

    /// `f_0` of a sector: what sliders and the motion before the step leave in the forces after it.
    fn memory(
        &self,
        pairs: &[StepChange],
        sector: usize,
        (sliders, before): (&[f64], &[f64]),
        force: &mut [f64],
    ) {
        force.fill(0.0);
        let first = sector * pairs.len();
        for (place, (change, rows)) in pairs.iter().zip(&self.contact.pair_rows).enumerate() {
            let kt = self.contact.tangential[first + place];
            let pair_sliders = [0, 1].map(|tangent| sliders[2 * (first + place) + tangent]);
            let at = rows.map(|row| row.map_or(0.0, |row| before[row]));
            for tangent in 0..2 {
                let Some(row) = rows[1 + tangent] else {
                    continue;
                };
                force[row] = match change.friction[tangent] {
                    FrictionChange::None => 0.0,
                    FrictionChange::Stick => kt * pair_sliders[tangent],
                    FrictionChange::Moves(slopes) => {
                        -product(&slopes.memory, &pair_sliders) - product(&slopes.before, &at)
                    }
                };
            }
        }
    }

    /// Sliders after a step to `motion`.
    fn follow(&self, pairs: &[StepChange], sector: usize, moving: &mut Moving) {
        let (forces, motions) = self.channels();
        let first = sector * pairs.len();
        let motion = &moving.motion[sector * motions..][..motions];
        let force = &moving.force[sector * forces..][..forces];
        for (place, (change, rows)) in pairs.iter().zip(&self.contact.pair_rows).enumerate() {
            let kt = self.contact.tangential[first + place];
            for tangent in 0..2 {
                let Some(row) = rows[1 + tangent] else {
                    continue;
                };
                let slider = &mut moving.sliders[2 * (first + place) + tangent];
                match change.friction[tangent] {
                    FrictionChange::Stick => {}
                    FrictionChange::None => *slider = motion[row],
                    // The force on the wheel is -T.
                    FrictionChange::Moves(_) => *slider = motion[row] + force[row] / kt,
                }
            }
        }
    }

    /// Forces and motions at the end of a step (of the instant between two periods for none) from the motions without
    /// forces there; none if they are not found.
    fn solve(&self, step: Option<usize>, rest: &[StepChange], moving: &mut Moving) -> Option<()> {
        let sectors = self.transform.sectors();
        let (forces, motions) = self.channels();
        let pairs = self.contact.pair_rows.len();
        let of = |sector: usize| match step {
            Some(step) => self.contact.of_sector(step, sector),
            None => &rest[sector * pairs..][..pairs],
        };
        let (at, first) = match step {
            Some(step) => (&self.step, step * sectors),
            None => (&self.rest, 0),
        };
        let precondition = |sector: usize, force: &[f64], to: &mut [f64]| {
            let inverse = &at.inverses[at.places[first + sector]];
            to.fill(0.0);
            add_times_vector(to, 1.0, inverse.as_slice(), force);
        };
        let mut right = vec![0.0; sectors * forces];
        let mut sector_force = vec![0.0; forces];
        for (sector, right) in right.chunks_exact_mut(forces).enumerate() {
            let motion = &moving.motion[sector * motions..][..motions];
            let before = &moving.before[sector * motions..][..motions];
            self.memory(
                of(sector),
                sector,
                (&moving.sliders, before),
                &mut sector_force,
            );
            self.tangent(of(sector), sector, motion, &mut sector_force);
            precondition(sector, &sector_force, right);
        }
        let mut motion = vec![0.0; sectors * motions];
        let Moving {
            wave_force,
            wave_motion,
            ..
        } = moving;
        let solved = gmres(&right, FORCE_TOLERANCE, MOST_PRODUCTS, |force| {
            self.yields(at, force, (wave_force, wave_motion), &mut motion);
            let mut left = vec![0.0; force.len()];
            for (sector, left) in left.chunks_exact_mut(forces).enumerate() {
                sector_force.fill(0.0);
                self.tangent(
                    of(sector),
                    sector,
                    &motion[sector * motions..][..motions],
                    &mut sector_force,
                );
                for (entry, force) in sector_force.iter_mut().zip(&force[sector * forces..]) {
                    *entry = force - *entry;
                }
                precondition(sector, &sector_force, left);
            }
            left
        });
        let force = solved.x;
        if solved.products >= MOST_PRODUCTS || !force.iter().all(|f| f.is_finite()) {
            return None;
        }
        self.yields(at, &force, (wave_force, wave_motion), &mut motion);
        moving.force = force;
        for (sum, added) in moving.motion.iter_mut().zip(&motion) {
            *sum += added;
        }
        Some(())
    }

    /// `W f` of all sectors.
    fn yields(
        &self,
        at: &Instant,
        force: &[f64],
        (wave_force, wave_motion): (&mut [f64], &mut [f64]),
        motion: &mut [f64],
    ) {
        let (forces, motions) = self.channels();
        self.transform.to_waves(force, forces, wave_force);
        for (h, compliance) in at.waves.iter().enumerate() {
            let motion = &mut wave_motion[2 * h * motions..][..2 * motions];
            let force = &wave_force[2 * h * forces..][..2 * forces];
            motion.fill(0.0);
            add_times_vector(motion, 1.0, compliance.as_slice(), force);
        }
        self.transform.to_sectors(wave_motion, motions, motion);
    }

    /// Modal forces of the forces at this instant.
    fn spread(&self, moving: &mut Moving) {
        let (forces, _) = self.channels();
        for (h, wave) in self.waves.iter().enumerate() {
            let force = &moving.wave_force[2 * h * forces..][..2 * forces];
            let (re, im) = moving.modal[h].split_at_mut(wave.size());
            wave.force([&force[..forces], &force[forces..]], re, im);
        }
    }

    /// Motions of all sectors from the modes.
    pub(super) fn observe(&self, moving: &mut Moving) {
        let (_, motions) = self.channels();
        for (h, wave) in self.waves.iter().enumerate() {
            let (q, v) = (&moving.position[h], &moving.velocity[h]);
            let out = &mut moving.wave_motion[2 * h * motions..][..2 * motions];
            let (re, im) = out.split_at_mut(motions);
            let n = wave.size();
            wave.observe([&q[..n], &q[n..]], [&v[..n], &v[n..]], re, im);
        }
        self.transform
            .to_sectors(&moving.wave_motion, motions, &mut moving.motion);
    }

    /// What one period makes of a scaled state; none if the forces of a step are not found.
    #[must_use]
    pub(super) fn apply(&self, state: &[f64]) -> Option<Vec<f64>> {
        let mut moving = self.unpacked(state);
        let rest = self.contact.at_rest();
        self.observe(&mut moving);
        self.solve(None, &rest, &mut moving)?;
        self.spread(&mut moving);
        for step in 0..self.contact.steps {
            for (h, wave) in self.waves.iter().enumerate() {
                let n = wave.size();
                let position = moving.position[h].chunks_exact_mut(n.max(1));
                let velocity = moving.velocity[h].chunks_exact_mut(n.max(1));
                let forces = moving.modal[h].chunks_exact(n.max(1));
                for ((q, v), p) in position.zip(velocity).zip(forces) {
                    wave.advance(q, v);
                    wave.push(q, v, p);
                }
            }
            std::mem::swap(&mut moving.before, &mut moving.motion);
            self.observe(&mut moving);
            self.solve(Some(step), &rest, &mut moving)?;
            self.spread(&mut moving);
            for (h, wave) in self.waves.iter().enumerate() {
                let n = wave.size();
                let position = moving.position[h].chunks_exact_mut(n.max(1));
                let velocity = moving.velocity[h].chunks_exact_mut(n.max(1));
                let forces = moving.modal[h].chunks_exact(n.max(1));
                for ((q, v), p) in position.zip(velocity).zip(forces) {
                    wave.push(q, v, p);
                }
            }
            for sector in 0..self.transform.sectors() {
                self.follow(self.contact.of_sector(step, sector), sector, &mut moving);
            }
        }
        Some(self.packed(&moving))
    }

    pub(super) fn unpacked(&self, state: &[f64]) -> Moving {
        let mut parts = state.iter().zip(&self.scale).map(|(x, scale)| x / scale);
        let (mut position, mut velocity) = (Vec::new(), Vec::new());
        for wave in &self.waves {
            let n = wave.size();
            let given = if wave.real { n } else { 2 * n };
            for field in [&mut position, &mut velocity] {
                let mut coordinates: Vec<f64> = parts.by_ref().take(given).collect();
                coordinates.resize(2 * n, 0.0);
                field.push(coordinates);
            }
        }
        let sliders = parts.collect();
        let sectors = self.transform.sectors();
        let (forces, motions) = self.channels();
        let waves = self.waves.len();
        Moving {
            modal: position.iter().map(|wave| vec![0.0; wave.len()]).collect(),
            position,
            velocity,
            sliders,
            motion: vec![0.0; sectors * motions],
            before: vec![0.0; sectors * motions],
            force: vec![0.0; sectors * forces],
            wave_force: vec![0.0; 2 * waves * forces],
            wave_motion: vec![0.0; 2 * waves * motions],
        }
    }

    pub(super) fn packed(&self, moving: &Moving) -> Vec<f64> {
        let mut state = Vec::with_capacity(self.scale.len());
        for (h, wave) in self.waves.iter().enumerate() {
            let given = if wave.real {
                wave.size()
            } else {
                2 * wave.size()
            };
            state.extend_from_slice(&moving.position[h][..given]);
            state.extend_from_slice(&moving.velocity[h][..given]);
        }
        state.extend_from_slice(&moving.sliders);
        for (x, scale) in state.iter_mut().zip(&self.scale) {
            *x *= scale;
        }
        state
    }
}

impl Instant {
    fn of<'a>(compliances: impl Iterator<Item = &'a Matrix<crate::linalg::Complex64>>) -> Self {
        let waves = compliances.map(|compliance| {
            let (rows, columns) = (compliance.rows(), compliance.columns());
            Matrix::from_fn(2 * rows, 2 * columns, |i, j| {
                let entry = compliance[(i % rows, j % columns)];
                match (i < rows, j < columns) {
                    (true, true) | (false, false) => entry.re,
                    (true, false) => -entry.im,
                    (false, true) => entry.im,
                }
            })
        });
        Self {
            waves: waves.collect(),
            inverses: Vec::new(),
            places: Vec::new(),
        }
    }
}

/// Whether two steps of a sector answer what is after them alike.
fn same_end(a: &[StepChange], b: &[StepChange]) -> bool {
    let slopes = |friction: &FrictionChange| match friction {
        FrictionChange::None => None,
        FrictionChange::Stick => Some(None),
        FrictionChange::Moves(slopes) => Some(Some(slopes.after)),
    };
    let same = |(a, b): (&StepChange, &StepChange)| {
        a.normal.total_cmp(&b.normal).is_eq()
            && slopes(&a.friction[0]) == slopes(&b.friction[0])
            && slopes(&a.friction[1]) == slopes(&b.friction[1])
    };
    a.iter().zip(b).all(same)
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
