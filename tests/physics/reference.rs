//! The full-contact model against the fast path on the very same space: two codes, one equation.

use std::sync::Arc;

use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, DampedModes, NodalDiameterDamping, Reduction};
use blisk::population::monte_carlo::{RowSettings, RowSolver};
use blisk::response::forced_response::{AmplitudeMeasure, ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, Ring};
use blisk::response::harmonic_balance::{Damping, HarmonicTransform, Status};
use blisk::response::mistuning::{ContactFactors, Deviations, PairFactors, Pattern, Projection};
use blisk::verification::reference::{
    ReferencePoint, ReferenceSettings, ReferenceSolver, reference_peak,
};

use super::contact::random::Random;
use super::wheels::{
    ENGINE_ORDER, Wheel, full, pattern, scenario, springs, wheel8_contact, wheel8_sector,
};

/// Bound on the relative difference of two solutions of the same equation.
const SAME: f64 = 1e-9;

/// A wheel and how it is solved.
struct Case {
    model: Arc<ReducedModel>,
    settings: RowSettings,
}

impl Case {
    /// Solid elements, every contact dof and six fixed-interface modes per nodal diameter.
    fn wheel8(damping: Damping, harmonics: &[u32], projection: Projection) -> Self {
        Self::wheel8_under(ContactLaw::Simplified3d, damping, harmonics, projection)
    }

    fn wheel8_under(
        law: ContactLaw,
        damping: Damping,
        harmonics: &[u32],
        projection: Projection,
    ) -> Self {
        let sector = wheel8_sector();
        let reduction = Reduction::new(&sector, springs(law, wheel8_contact()), 6, 0).unwrap();
        let cantilever = (projection == Projection::CantileverModes).then_some(3);
        let model = reduction
            .reduce(BasisChoice::CraigBampton, cantilever)
            .unwrap();
        Self {
            model: Arc::new(model),
            settings: RowSettings {
                harmonics: harmonics.to_vec(),
                contact: Some((law, wheel8_contact())),
                ring: Ring::Locked,
                damping,
                amplitude_n: 1.0,
                projection,
                solver: options(AmplitudeMeasure::Fundamental),
            },
        }
    }

    fn lumped24(harmonics: &[u32], amplitude: AmplitudeMeasure) -> Self {
        let wheel = Wheel {
            amplitude_n: 10.0,
            ..Wheel::lumped24()
        };
        Self {
            settings: wheel.settings(harmonics, options(amplitude)),
            model: wheel.model,
        }
    }

    fn reference(&self) -> ReferenceSettings {
        let solver = &self.settings.solver;
        let set: Vec<usize> = self
            .settings
            .harmonics
            .iter()
            .map(|&k| k as usize)
            .collect();
        let transform = HarmonicTransform::new(&set, solver.samples_per_period).unwrap();
        ReferenceSettings {
            transform: Arc::new(transform),
            residual_tolerance: 1e-11,
            peak_tolerance: ReferenceSettings::PEAK_TOLERANCE,
            contact: self.settings.contact,
            ring: self.settings.ring,
            damping: self.settings.damping,
            amplitude_n: self.settings.amplitude_n,
            amplitude: solver.amplitude,
            time_samples: solver.time_samples,
            projection: self.settings.projection,
        }
    }

    /// Largest difference of any blade relative to the largest blade; slipping and separated shares of
    /// the last frequency.
    fn difference(
        &self,
        contact: ContactCondition,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> (f64, f64, f64) {
        let fast = RowSolver::new(Arc::clone(&self.model), self.settings.clone()).unwrap();
        let fast = fast
            .curve(ENGINE_ORDER, contact, pattern, frequencies_hz)
            .unwrap();
        let mut reference = ReferenceSolver::new(
            &self.model,
            &self.reference(),
            ENGINE_ORDER,
            contact,
            pattern,
        )
        .unwrap();
        let mut worst = (0.0_f64, 0.0, 0.0);
        for (frequency_hz, fast) in fast {
            let fast = fast.unwrap();
            let point = reference.solve(frequency_hz).unwrap();
            let own: Vec<f64> = match point.amplitudes_m.as_slice() {
                [one] => vec![*one; fast.len()],
                all => all.to_vec(),
            };
            let largest = fast.iter().copied().fold(0.0, f64::max);
            assert_eq!(own.len(), fast.len());
            for (own, fast) in own.iter().zip(&fast) {
                worst.0 = worst.0.max((own - fast).abs() / largest);
            }
            (worst.1, worst.2) = (point.shares.slipping, point.shares.separated);
        }
        worst
    }

    /// Largest difference of the highest blade from that of another case on the full-contact model, relative.
    fn reference_change(
        &self,
        other: &Self,
        contact: ContactCondition,
        pattern: &Pattern,
        frequencies_hz: &[f64],
    ) -> f64 {
        let of = |case: &Self| {
            let (settings, pattern) = (case.reference(), Some(pattern));
            ReferenceSolver::new(&case.model, &settings, ENGINE_ORDER, contact, pattern).unwrap()
        };
        let (mut own, mut other) = (of(self), of(other));
        let largest =
            |point: &ReferencePoint| point.amplitudes_m.iter().copied().fold(0.0, f64::max);
        let changes = frequencies_hz.iter().map(|&hz| {
            let own = largest(own.solve(hz).unwrap());
            (largest(other.solve(hz).unwrap()) / own - 1.0).abs()
        });
        changes.fold(0.0, f64::max)
    }

    fn assert_same(
        &self,
        contact: ContactCondition,
        pattern: &Pattern,
        frequencies_hz: &[f64],
    ) -> (f64, f64) {
        let (tuned, ..) = self.difference(contact, None, frequencies_hz);
        let (wheel, slipping, separated) = self.difference(contact, Some(pattern), frequencies_hz);
        println!(
            "{contact:?} {:?}: tuned {tuned:.1e}, mistuned {wheel:.1e}, slipping {slipping:.2}, separated {separated:.2}",
            self.settings.harmonics
        );
        assert!(
            tuned < SAME && wheel < SAME,
            "{contact:?}: {tuned:e} {wheel:e}"
        );
        (slipping, separated)
    }
}

fn options(amplitude: AmplitudeMeasure) -> SolverOptions {
    SolverOptions {
        residual_tolerance: 1e-11,
        amplitude,
        ..SolverOptions::default()
    }
}

fn deviations(sectors: usize) -> Vec<f64> {
    Random(91).vector(sectors, 0.05)
}

#[test]
fn two_codes_agree_on_slipping_wheels_under_every_damping() {
    let frequencies = [611.0, 614.0, 617.0];
    for damping in [
        Damping::StructuralLossFactor(0.002),
        Damping::ModalRatio(1e-3),
    ] {
        let case = Case::wheel8(damping, &[1, 3], Projection::Exact);
        let (slipping, _) = case.assert_same(full(300.0), &pattern(&deviations(8)), &frequencies);
        assert!(slipping > 0.2, "{slipping}");
    }
    let lumped = Case::lumped24(&[1, 3], AmplitudeMeasure::Fundamental);
    let (slipping, _) = lumped.assert_same(
        full(50.0),
        &pattern(&deviations(24)),
        &[345.0, 350.0, 355.0],
    );
    assert!(slipping > 0.2, "{slipping}");
}

#[test]
fn two_codes_agree_on_pairs_that_differ() {
    let case = Case::wheel8(
        Damping::StructuralLossFactor(0.002),
        &[0, 1, 2],
        Projection::Exact,
    );
    let count = 8 * case.model.contact.weights.len();
    let draws = Random(23).vector(4 * count, 0.3);
    let factors = draws.chunks(4).map(|draw| PairFactors {
        friction_coefficient: draw[0].exp(),
        tangential_stiffness: draw[1].exp(),
        normal_stiffness: draw[2].exp(),
        normal_load: draw[3].exp(),
    });
    let pattern = Pattern {
        contact: ContactFactors::new(factors.collect()),
        ..pattern(&deviations(8))
    };
    let (slipping, _) = case.assert_same(full(300.0), &pattern, &[611.0, 614.0, 617.0]);
    assert!(slipping > 0.2, "{slipping}");
    case.assert_same(ContactCondition::Stuck, &pattern, &[614.0]);
    case.assert_same(ContactCondition::Slide, &pattern, &[612.0]);
}

#[test]
fn two_codes_agree_on_the_friction_circle_and_under_a_constant_normal_load() {
    for law in [ContactLaw::Coulomb3d, ContactLaw::MacroSlip2d] {
        let damping = Damping::StructuralLossFactor(0.002);
        let case = Case::wheel8_under(law, damping, &[1, 3], Projection::Exact);
        let frequencies = [611.0, 614.0, 617.0];
        let (slipping, _) = case.assert_same(full(300.0), &pattern(&deviations(8)), &frequencies);
        assert!(slipping > 0.2, "{law:?}: {slipping}");
    }
}

#[test]
fn two_codes_agree_on_a_ring_that_creeps() {
    let damping = Damping::StructuralLossFactor(0.002);
    let (pattern, frequencies) = (pattern(&deviations(8)), [611.0, 614.0, 617.0]);
    for law in [ContactLaw::Simplified3d, ContactLaw::Coulomb3d] {
        let locked = Case::wheel8_under(law, damping, &[1, 3], Projection::Exact);
        let mut case = Case::wheel8_under(law, damping, &[1, 3], Projection::Exact);
        case.settings.ring = Ring::Creeping;
        let mut creeping = 0;
        for load in [100.0, 200.0, 300.0] {
            let (found, ..) = case.difference(full(load), Some(&pattern), &frequencies);
            let change = case.reference_change(&locked, full(load), &pattern, &frequencies);
            println!("{law:?}, {load} N: {found:.1e}, beside a locked ring {change:.1e}");
            assert!(found < 1e-6, "{found:e}");
            creeping += u32::from(change > 1e-4);
        }
        assert!(creeping > 0);
    }
}

#[test]
fn two_codes_agree_where_contacts_separate() {
    let case = Case::wheel8(
        Damping::StructuralLossFactor(0.002),
        &[0, 1, 2],
        Projection::Exact,
    );
    let (_, separated) = case.assert_same(full(50.0), &pattern(&deviations(8)), &[610.5, 612.5]);
    assert!(separated > 0.1, "{separated}");
}

#[test]
fn two_codes_agree_on_cantilever_modes_linear_limits_and_time_maxima() {
    let case = Case::wheel8(
        Damping::StructuralLossFactor(0.002),
        &[1],
        Projection::CantileverModes,
    );
    let per_mode = Pattern {
        id: 0,
        deviations: Deviations::PerMode {
            modes: vec![0, 1, 2],
            values: Random(17).vector(24, 0.05),
        },
        contact: ContactFactors::default(),
    };
    for pattern in [pattern(&deviations(8)), per_mode] {
        for contact in [
            ContactCondition::Stuck,
            ContactCondition::Slide,
            ContactCondition::Free,
            full(400.0),
        ] {
            case.assert_same(contact, &pattern, &[612.0, 616.0]);
        }
    }
    let lumped = Case::lumped24(&[1, 3, 5], AmplitudeMeasure::TimeMaximum);
    lumped.assert_same(full(50.0), &pattern(&deviations(24)), &[350.0, 353.0]);
}

#[test]
fn the_peak_is_that_of_a_dense_sweep_wherever_it_was_expected() {
    let case = Case::lumped24(&[1, 3], AmplitudeMeasure::Fundamental);
    let fast = RowSolver::new(Arc::clone(&case.model), case.settings.clone()).unwrap();
    for load in [20.0, 50.0, 200.0] {
        let pattern = pattern(&deviations(24));
        let scenario = scenario(full(load));
        let tuned_hz = fast.tuned(&scenario).frequency_hz;
        let plan = fast
            .search_plan(&scenario, Some(&pattern), tuned_hz)
            .unwrap();
        let solver = || {
            ReferenceSolver::new(
                &case.model,
                &case.reference(),
                ENGINE_ORDER,
                scenario.contact,
                Some(&pattern),
            )
            .unwrap()
        };
        let mut sweep = solver();
        let (low, high) = plan.band_hz;
        let highest = (0..=600)
            .map(|i| low + (high - low) * f64::from(i) / 600.0)
            .map(|hz| {
                let point = sweep.solve(hz).unwrap();
                point.amplitudes_m.iter().copied().fold(0.0, f64::max)
            })
            .fold(0.0, f64::max);
        for expected_hz in [
            None,
            Some(low + 0.1 * (high - low)),
            Some(0.5 * (low + high)),
        ] {
            let found = reference_peak(&mut solver(), &plan, expected_hz);
            assert_eq!(found.status, Status::Ok);
            let gain = found.amplitude_m.unwrap() / highest - 1.0;
            println!(
                "{load} N, {expected_hz:?}: {gain:+.2e} in {} solves",
                found.work.solves
            );
            // Above the best of the grid, by no more than the grid can miss.
            assert!(
                (-1e-4..5e-3).contains(&gain),
                "{load} N {expected_hz:?}: {gain:e}"
            );
        }
    }
}

#[test]
fn newton_on_the_contact_rows_converges_as_newton_does() {
    let case = Case::wheel8(
        Damping::StructuralLossFactor(0.002),
        &[1, 3],
        Projection::Exact,
    );
    let pattern = pattern(&deviations(8));
    let mut solver = ReferenceSolver::new(
        &case.model,
        &case.reference(),
        ENGINE_ORDER,
        full(300.0),
        Some(&pattern),
    )
    .unwrap();
    let residual = solver.solve(613.0).unwrap().residual;
    let from_stuck = solver.work().newton_iterations;
    solver.solve(613.01).unwrap();
    let from_beside = solver.work().newton_iterations - from_stuck;
    println!("{from_stuck} from stuck, {from_beside} from beside, residual {residual:e}");
    // A wrong derivative would converge linearly at best.
    assert!(residual <= 1e-11 && from_stuck <= 20 && from_beside <= 6);
}

#[test]
fn a_blade_of_no_stiffness_is_a_status() {
    let case = Case::lumped24(&[1], AmplitudeMeasure::Fundamental);
    let mut deviations = deviations(24);
    deviations[3] = -1.0;
    let refused = ReferenceSolver::new(
        &case.model,
        &case.reference(),
        ENGINE_ORDER,
        full(50.0),
        Some(&pattern(&deviations)),
    );
    assert_eq!(refused.err(), Some(Status::InvalidPattern));
}

#[test]
fn two_codes_agree_under_damping_by_nodal_diameter() {
    let mut case = Case::wheel8(
        Damping::StructuralLossFactor(0.002),
        &[1, 3],
        Projection::Exact,
    );
    let sector = wheel8_sector();
    let law = ContactLaw::Simplified3d;
    let reduction = Reduction::new(&sector, springs(law, wheel8_contact()), 6, 0)
        .unwrap()
        .with_damping(NodalDiameterDamping {
            ratios: vec![0.004, 0.001, 0.003, 0.0015, 0.002],
            modes: DampedModes::Blade,
        });
    case.model = Arc::new(reduction.reduce(BasisChoice::CraigBampton, None).unwrap());
    for contact in [full(300.0), ContactCondition::Stuck, ContactCondition::Free] {
        case.assert_same(contact, &pattern(&deviations(8)), &[611.0, 614.0]);
    }
}

#[test]
fn shares_of_the_normal_load_are_factors_on_it() {
    let even = Case::wheel8(
        Damping::StructuralLossFactor(0.002),
        &[0, 1, 2],
        Projection::Exact,
    );
    let mut sector = wheel8_sector();
    let draws = Random(29).vector(sector.contact_pairs.len(), 0.4);
    let factor = |place: usize| draws[place].exp();
    let weights: Vec<f64> = sector
        .contact_pairs
        .iter()
        .map(|pair| pair.weight)
        .collect();
    let whole: f64 = (0..draws.len())
        .map(|place| weights[place] * factor(place))
        .sum();
    for (place, pair) in sector.contact_pairs.iter_mut().enumerate() {
        pair.load_weight = Some(pair.weight * factor(place) / whole);
    }
    let law = ContactLaw::Simplified3d;
    let reduction = Reduction::new(&sector, springs(law, wheel8_contact()), 6, 0).unwrap();
    let uneven = Case {
        model: Arc::new(reduction.reduce(BasisChoice::CraigBampton, None).unwrap()),
        settings: even.settings.clone(),
    };
    let frequencies = [611.0, 614.0];
    uneven.assert_same(full(300.0), &pattern(&deviations(8)), &frequencies);
    let factors = (0..8 * draws.len()).map(|place| PairFactors {
        normal_load: factor(place % draws.len()) / whole,
        ..PairFactors::default()
    });
    let varied = Pattern {
        contact: ContactFactors::new(factors.collect()),
        ..pattern(&deviations(8))
    };
    let curve = |case: &Case, pattern: &Pattern| {
        let solver = RowSolver::new(Arc::clone(&case.model), case.settings.clone()).unwrap();
        let points = solver
            .curve(ENGINE_ORDER, full(300.0), Some(pattern), &frequencies)
            .unwrap();
        points
            .into_iter()
            .flat_map(|(_, point)| point.unwrap())
            .collect::<Vec<f64>>()
    };
    let nominal = pattern(&deviations(8));
    let (shared, expected) = (curve(&uneven, &nominal), curve(&even, &varied));
    let largest = expected.iter().copied().fold(0.0, f64::max);
    for (own, other) in shared.iter().zip(&expected) {
        assert!((own - other).abs() < SAME * largest, "{own} {other}");
    }
    let changed = curve(&even, &nominal)
        .iter()
        .zip(&shared)
        .any(|(a, b)| (a - b).abs() > 1e-3 * largest);
    assert!(changed);
}
