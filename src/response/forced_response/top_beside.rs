//! The top of a row beside a solution of the same wheel, with other harmonics or on another engine.

use super::point::Point;
use super::point_settings::PointSettings;
use super::receptance_points::{EngineRow, growth_of, observed};
use crate::response::friction::Ring;
use crate::response::harmonic_balance::{ContactShares, Status};
use crate::response::receptance::{ContactForces, WheelSolution, WheelSolver, embedded, overlay};

/// Times that forces are turned with the motion of their sector.
const TURNS: usize = 2;

/// Largest amplitude, m, of a row near `point`, a solution of the same wheel on this or on another engine. None where a solution is not
/// found.
///
/// Few harmonics lead to the top, under what all of them leave on these at the point, and all of them are solved there once
/// (`corrected_peak.rs`). Where few do not follow, it is the height at the top of a parabola through the point and two others `step_hz` on
/// either side, with all harmonics.
#[must_use]
pub fn receptance_top_m(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    point: &Point,
    step_hz: f64,
    tolerance: f64,
) -> Option<f64> {
    let mut all = row.solver(settings, &settings.transform);
    let follows = !is_closed(point.shares);
    let few = if follows {
        settings.opening()
    } else {
        settings.search()
    };
    // A ring that creeps drifts by the mean friction of all harmonics.
    let few = few.filter(|_| all.is_nonlinear() && settings.ring == Ring::Locked);
    let few = few.and_then(|few| few.at_samples_of(settings).ok());
    let led = few.and_then(|few| {
        let mut led = LedTop::new(row, &few, settings, &mut all, point)?;
        led.top_m(&mut all, step_hz, tolerance)
    });
    if led.is_some() {
        return led;
    }
    let start = [point.solution.clone()];
    let mut height_m = |frequency_hz: f64| {
        all.set_ring_drift(point.ring_drift_m);
        let (solved, _) = all.solve(frequency_hz, &start, tolerance);
        solved.ok()?;
        Some(largest_m(&mut all, settings, None))
    };
    let (top_hz, _) = climbed(point.frequency_hz, step_hz, &mut height_m)?;
    height_m(top_hz)
}

fn is_closed(shares: ContactShares) -> bool {
    shares.separated <= 0.0
}

/// The largest amplitude, m, of the solution last solved, where the amplitude of every blade grows by `growth`.
fn largest_m(
    solver: &mut WheelSolver<'_>,
    settings: &PointSettings,
    growth: Option<&[f64]>,
) -> f64 {
    let observed = observed(solver, &settings.amplitude);
    let mut amplitudes_m = settings.amplitude.of_observed(&observed);
    for (amplitude_m, growth) in amplitudes_m.iter_mut().zip(growth.into_iter().flatten()) {
        *amplitude_m *= growth;
    }
    amplitudes_m.into_iter().fold(0.0, f64::max)
}

/// A top that few harmonics lead to, under what all of them leave on these at a solution.
struct LedTop<'a> {
    few: WheelSolver<'a>,
    of_few: &'a PointSettings,
    of_all: &'a PointSettings,
    /// Whether the few harmonics have the mean motion, and so follow a contact that opens.
    follows: bool,
    /// Where all harmonics are known: frequency, Hz, motions, and those of the few harmonics among them.
    frequency_hz: f64,
    motions: Vec<f64>,
    part: Vec<f64>,
    /// What all harmonics leave there on the few of them, and the amplitude of every blade with all over that with the few.
    left: ContactForces,
    growth: Option<Vec<f64>>,
}

impl<'a> LedTop<'a> {
    /// With what all harmonics leave at `point`, which may be a solution on another engine.
    fn new(
        row: &EngineRow<'a>,
        of_few: &'a PointSettings,
        of_all: &'a PointSettings,
        all: &mut WheelSolver<'_>,
        point: &Point,
    ) -> Option<Self> {
        let mut led = Self {
            few: row.solver(of_few, &of_few.transform),
            of_few,
            of_all,
            follows: of_few.harmonics().contains(&0),
            frequency_hz: point.frequency_hz,
            motions: Vec::new(),
            part: Vec::new(),
            left: ContactForces::default(),
            growth: None,
        };
        led.take(all, point.frequency_hz, point.solution.clone())?;
        Some(led)
    }

    /// Takes what all harmonics leave at their solution `motions` at a frequency, Hz.
    fn take(
        &mut self,
        all: &mut WheelSolver<'_>,
        frequency_hz: f64,
        motions: Vec<f64>,
    ) -> Option<()> {
        self.frequency_hz = frequency_hz;
        self.part = embedded(&motions, all.harmonics(), self.few.harmonics());
        let of_few = self.few.contact_forces_at(&self.part)?;
        self.left = all.contact_forces_at(&motions)?.beyond(&of_few);
        self.motions = motions;
        Some(())
    }

    /// The height, m, of the top, with all harmonics at the frequency at which few of them have it.
    fn top_m(&mut self, all: &mut WheelSolver<'_>, step_hz: f64, tolerance: f64) -> Option<f64> {
        let near_hz = self.frequency_hz;
        let (top_hz, _) = climbed(near_hz, step_hz, |hz| self.height_m(hz, tolerance))?;
        let start = self.start(all, top_hz, tolerance)?;
        let (solved, _) = all.solve(top_hz, &[start], tolerance);
        let solved = self.followed(solved)?;
        let middle_m = largest_m(all, self.of_all, None);
        self.growth = Some(growth_of(all, self.of_all, &self.few, self.of_few));
        self.take(all, top_hz, solved.motions)?;
        let sides_hz = [-step_hz, step_hz].map(|way| top_hz + way);
        let [low_m, high_m] = sides_hz.map(|hz| self.height_m(hz, tolerance));
        Some(vertex([low_m?, middle_m, high_m?]).1)
    }

    /// A solution, unless a contact opens there that few harmonics do not follow.
    fn followed(&self, solved: Result<WheelSolution, Status>) -> Option<WheelSolution> {
        let follows = |solved: &WheelSolution| self.follows || is_closed(solved.shares);
        solved.ok().filter(follows)
    }

    /// Motions of the few harmonics at a frequency, Hz, under what all of them leave, which turns with the motion of its sector, and the
    /// phases, rad, by which they are ahead of those where all harmonics are known. None where they are not found, or a contact opens.
    fn solve(&mut self, frequency_hz: f64, tolerance: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut forces = self.left.clone();
        let mut motions = self.part.clone();
        let mut phases = Vec::new();
        for _ in 0..TURNS {
            self.few.add_forces(forces);
            let (solved, _) = self.few.solve(frequency_hz, &[motions], tolerance);
            motions = self.followed(solved)?.motions;
            phases = self.few.phases_ahead(&self.part, &motions);
            forces = self.few.forces_ahead(&self.left, &phases);
        }
        Some((motions, phases))
    }

    fn height_m(&mut self, frequency_hz: f64, tolerance: f64) -> Option<f64> {
        self.solve(frequency_hz, tolerance)?;
        Some(largest_m(
            &mut self.few,
            self.of_few,
            self.growth.as_deref(),
        ))
    }

    /// Motions to solve all harmonics from at a frequency, Hz: the few of them, and the others turned with these.
    fn start(
        &mut self,
        all: &WheelSolver<'_>,
        frequency_hz: f64,
        tolerance: f64,
    ) -> Option<Vec<f64>> {
        let (few, phases) = self.solve(frequency_hz, tolerance)?;
        let mut start = all.turned_ahead(&self.motions, &phases);
        let (from, to) = (self.few.harmonics(), all.harmonics());
        overlay(&mut start, &few, from, to);
        Some(start)
    }
}

/// The top of a parabola through heights at -1, 0 and 1: its place and height; the highest of them where it has none between.
fn vertex([low, middle, high]: [f64; 3]) -> (f64, f64) {
    let (slope, curvature) = (0.5 * (high - low), high - 2.0 * middle + low);
    if curvature < 0.0 && slope.abs() < -curvature {
        let place = -slope / curvature;
        return (place, middle + 0.5 * slope * place);
    }
    [(-1.0, low), (0.0, middle), (1.0, high)]
        .into_iter()
        .fold(
            (0.0, middle),
            |best, sample| if sample.1 > best.1 { sample } else { best },
        )
}

/// Steps by which a top is climbed at most.
const MOST_STEPS: usize = 8;

/// A top of a row beside a solution that was found with less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TopBeside {
    /// Amplitude, m.
    pub amplitude_m: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// What the amplitude may be off by, relative, because a solution had not settled.
    pub unsettled: f64,
}

/// The top of a row near `point`, a solution of the same wheel in harmonics `from`, which are among those of `settings`; climbed by steps of
/// `step_hz`. None where a solution does not settle, or the top is further away than some steps.
#[must_use]
pub fn receptance_top_beside(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    (point, from): (&Point, &[u32]),
    step_hz: f64,
    tolerance: f64,
) -> Option<TopBeside> {
    let mut solver = row.solver(settings, &settings.transform);
    let mut motions = embedded(&point.solution, from, settings.harmonics());
    solver.set_ring_drift(point.ring_drift_m);
    let mut unsettled = 0.0_f64;
    let height_m = |frequency_hz: f64| -> Option<f64> {
        let (settled, left) = solver.settle(frequency_hz, &motions, tolerance)?;
        motions = settled;
        unsettled = unsettled.max(left);
        Some(largest_m(&mut solver, settings, None))
    };
    let (frequency_hz, amplitude_m) = climbed(point.frequency_hz, step_hz, height_m)?;
    Some(TopBeside {
        amplitude_m,
        frequency_hz,
        unsettled,
    })
}

/// Frequency, Hz, and height, m, of the top that is climbed from a frequency by steps of `step_hz`; none where a height is not found, or the
/// top is further away than some steps.
fn climbed(
    from_hz: f64,
    step_hz: f64,
    mut height_m: impl FnMut(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let mut place = from_hz;
    let middle = height_m(place)?;
    let low = height_m(place - step_hz)?;
    let mut heights = [low, middle, height_m(place + step_hz)?];
    for _ in 0..MOST_STEPS {
        let [low, middle, high] = heights;
        if low > middle && low >= high {
            place -= step_hz;
            heights = [height_m(place - step_hz)?, low, middle];
        } else if high > middle {
            place += step_hz;
            heights = [middle, high, height_m(place + step_hz)?];
        } else {
            let (steps, height_m) = vertex(heights);
            return Some((place + steps * step_hz, height_m));
        }
    }
    None
}
