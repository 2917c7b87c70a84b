//! Mean friction on the ring, and the ring that creeps under it.

use blisk::model::reduction::BasisChoice;
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::{
    ContactCondition, PointSettings, PointSolver, SolverOptions,
};
use blisk::response::friction::{ContactLaw, CoupledSlider, PeriodicSlider, Ring};
use blisk::response::harmonic_balance::HarmonicTransform;

use super::super::wheels::{
    ENGINE_ORDER, Wheel, full, pattern, relative, scenario, solve_row, wheel8_sector,
};
use super::random::Random;

/// Forces of the return map after `periods` periods of a displacement that grows by `drift` per
/// period, from no force: the last period.
fn marched(
    kt: f64,
    x: [&[f64]; 2],
    limit: &[f64],
    drift: [f64; 2],
    periods: usize,
) -> Vec<[f64; 2]> {
    let n = limit.len();
    let mut force = [0.0_f64; 2];
    let mut history = vec![force; n];
    for _ in 0..periods {
        for j in 0..n {
            for k in 0..2 {
                let moved = x[k][j] - x[k][(j + n - 1) % n] + drift[k] / n as f64;
                force[k] += kt * moved;
            }
            let size = force[0].hypot(force[1]);
            if size > limit[j] {
                force = force.map(|component| component * (limit[j] / size));
            }
            history[j] = force;
        }
    }
    history
}

#[test]
fn under_a_drift_the_force_is_that_of_many_marched_periods() {
    let mut random = Random(51);
    let mut checked = 0;
    for case in 0..300 {
        let n = random.integer(12, 130);
        let transform = HarmonicTransform::new(&[1, 2, 3], n).unwrap();
        let mut history = || {
            let mut samples = vec![0.0; n];
            transform.synthesize_by_sums(&random.vector(6, 1.0), &mut samples);
            samples
        };
        let (first, second, closing) = (history(), history(), history());
        let (kt, mu) = (random.magnitude(0.3, 3.0), random.uniform(0.1, 0.9));
        let n0 = random.magnitude(0.3, 10.0);
        let load: Vec<f64> = closing.iter().map(|g| (n0 + g).max(0.0)).collect();
        let limit: Vec<f64> = load.iter().map(|load| mu * load).collect();
        let drift = [0, 1].map(|_| random.uniform(-1.0, 1.0));
        let rest = vec![0.0; n];
        let mut slider = PeriodicSlider::new(n);
        slider.solve_drifting(kt, mu, &first, &load, drift[0]);
        let brute = marched(kt, [&first, &rest], &limit, [drift[0], 0.0], 400);
        let mut coupled = CoupledSlider::new(n);
        coupled.solve_drifting(kt, mu, [&first, &second], &load, drift);
        assert!(slider.is_slipping() && coupled.is_slipping() && coupled.is_closed());
        let plane = marched(kt, [&first, &second], &limit, drift, 800);
        // Where a little slip fades slowly across its direction, the march is not there yet.
        let earlier = marched(kt, [&first, &second], &limit, drift, 400);
        let moved = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).hypot(a[1] - b[1]);
        let arrived = plane.iter().zip(&earlier).map(moved).all(|d| d < 1e-12);
        checked += usize::from(arrived);
        let [y1, y2] = coupled.offset_n();
        for j in 0..n {
            let along = kt * first[j] + slider.offset_n()[j];
            assert!((along - brute[j][0]).abs() < 1e-9, "case {case}");
            let error =
                (kt * first[j] + y1[j] - plane[j][0]).hypot(kt * second[j] + y2[j] - plane[j][1]);
            assert!(!arrived || error < 1e-9, "case {case}: {error:e}");
        }
    }
    println!("{checked} of 300 marches arrived");
    assert!(checked > 250);
}

#[test]
fn a_drift_as_good_as_none_holds_a_stuck_slider_at_the_end_of_its_play() {
    let n = 64;
    let angle = |j: usize| std::f64::consts::TAU * j as f64 / 64.0;
    let x: Vec<f64> = (0..n).map(|j| angle(j).cos()).collect();
    let load = vec![3.0; n];
    for sign in [1.0, -1.0] {
        // kt x ranges over [-1, 1] within a limit of 3: the offset may lie in [-2, 2].
        let mut slider = PeriodicSlider::new(n);
        slider.solve_drifting(1.0, 1.0, &x, &load, sign * 1e-9);
        assert!(
            slider
                .offset_n()
                .iter()
                .all(|y| (y - sign * 2.0).abs() < 2e-9)
        );
        let mut coupled = CoupledSlider::new(n);
        coupled.solve_drifting(1.0, 1.0, [&x, &vec![0.0; n]], &load, [sign * 1e-9, 0.0]);
        assert!(coupled.is_closed());
        let [along, across] = coupled.offset_n();
        assert!(along.iter().all(|y| (y - sign * 2.0).abs() < 2e-9));
        assert!(across.iter().all(|y| y.abs() < 1e-9));
    }
}

/// Peaks with a locked and with a creeping ring: one that all pairs let go, or one that the pairs
/// that stick hold.
#[test]
fn a_creeping_ring_feels_no_mean_friction_unless_pairs_that_stick_take_it() {
    let (mut creeping, mut held) = (0, 0);
    let law = ContactLaw::Simplified3d;
    for load in [200.0, 400.0, 1600.0] {
        let found = [Ring::Locked, Ring::Creeping].map(|ring| {
            let wheel = Wheel {
                law,
                ring,
                ..Wheel::wheel8()
            };
            assert_eq!(wheel.model.contact.ring_free, [true, true]);
            let solver = wheel.solver(&[1, 3], SolverOptions::default());
            solver.tuned_peak(ENGINE_ORDER, full(load))
        });
        let [one, other] = found.each_ref().map(|peak| peak.amplitude_m().unwrap());
        let points = found.each_ref().map(|peak| peak.point.as_ref().unwrap());
        let friction = found.each_ref().map(|peak| peak.mean_friction_n.unwrap());
        let drift = points[1].ring_drift_m;
        println!(
            "{law:?} {load} N: slipping {:.2}, mean friction {:.3?} N -> {:.1?} N, drift {:.1e} {:.1e} m, peak {:+.3} %, iterations {} -> {}",
            points[0].shares.slipping,
            friction[0],
            friction[1],
            drift[0],
            drift[1],
            100.0 * (other / one - 1.0),
            found[0].work.newton_iterations,
            found[1].work.newton_iterations,
        );
        for motion in 0..2 {
            if drift[motion].abs() > 0.0 {
                // The ring gives way to the friction that it feels when locked.
                creeping += 1;
                assert!(drift[motion] * friction[0][motion] > 0.0);
                assert!(friction[1][motion].abs() < 1e-6 * load);
            } else {
                held += 1;
            }
        }
        let change = relative(other, one);
        if drift.iter().all(|drift| drift.abs() <= 0.0) {
            // The searches take other points on their way; at one frequency there is no difference.
            assert!(change < 1e-5, "{change:e}");
            let [one, other] = [Ring::Locked, Ring::Creeping]
                .map(|ring| amplitude_at(&Wheel::wheel8(), ring, load, points[0].frequency_hz));
            assert!(relative(other, one) < 1e-9, "{one:e} {other:e}");
        } else {
            assert!(change < 5e-2, "{change:e}");
        }
    }
    assert!(creeping > 0 && held > 0, "{creeping} {held}");
}

/// Mistuned wheels, by Newton's method on a basis and on the receptances of that basis: the drift that both seek is the same, all
/// else is not.
#[test]
fn a_mistuned_wheel_with_a_creeping_ring_is_that_of_newton_s_method() {
    for law in [ContactLaw::Simplified3d, ContactLaw::Coulomb3d] {
        mistuned_on_both(law);
    }
}

fn mistuned_on_both(law: ContactLaw) {
    let wheel = Wheel {
        law,
        ring: Ring::Creeping,
        ..Wheel::wheel8()
    };
    let held = Wheel {
        ring: Ring::Locked,
        ..wheel.clone()
    };
    let options = || SolverOptions {
        peak_tolerance: 1e-6,
        residual_tolerance: 1e-10,
        ..SolverOptions::default()
    };
    let by_newton = wheel.newton_solver(&[1, 3], options());
    let on_receptances = wheel.solver(&[1, 3], options());
    let mut random = Random(11);
    let mut creeping = 0;
    for load in [200.0, 400.0, 1600.0] {
        let pattern = pattern(&wheel.deviations(&mut random, 0.03));
        let rows =
            [&by_newton, &on_receptances].map(|solver| solve_row(solver, &pattern, full(load)).1);
        let [expected, found] = rows.each_ref().map(|row| row.peak_amplitude_m.unwrap());
        let limit_n = 1e-6 * wheel.sector.friction_coefficient * load;
        let locked = held.solver(&[1, 3], options());
        let locked = solve_row(&locked, &pattern, full(load)).1;
        let force_n = |row: &ResponseRow| row.mean_friction_circumferential_n.unwrap();
        println!(
            "{law:?}, {load} N: {:+.1e}, mean friction {:.2} N locked, {:.1e} and {:.1e} N creeping",
            found / expected - 1.0,
            force_n(&locked),
            force_n(&rows[0]),
            force_n(&rows[1])
        );
        assert!(relative(found, expected) < 1e-5);
        if force_n(&rows[0]).abs() < limit_n {
            creeping += 1;
            assert!(force_n(&locked).abs() > 100.0 * limit_n);
            assert!(force_n(&rows[1]).abs() < limit_n);
        } else {
            assert!(relative(force_n(&rows[1]), force_n(&rows[0])) < 1e-2);
        }
    }
    assert!((1..3).contains(&creeping), "{creeping}");
}

/// The tuned wheel with all its contact, mean motion and even harmonics: one sector by Newton's method, all of them on receptances.
#[test]
fn a_tuned_wheel_with_a_creeping_ring_is_its_one_sector() {
    let wheel8 = Wheel::wheel8();
    let wheel = Wheel {
        ring: Ring::Creeping,
        ..Wheel::of(
            &wheel8_sector(),
            wheel8.law,
            wheel8.sector,
            wheel8.damping,
            BasisChoice::CraigBampton,
        )
    };
    let options = SolverOptions {
        peak_tolerance: 1e-6,
        residual_tolerance: 1e-10,
        ..SolverOptions::default()
    };
    let solver = wheel.solver(&[0, 1, 2, 3, 5], options);
    for load in [200.0, 400.0] {
        let sector = solver.tuned_peak(ENGINE_ORDER, full(load));
        let expected = sector.amplitude_m().unwrap();
        let found = solver.tuned(&scenario(full(load))).amplitude_m.unwrap();
        let drift = sector.point.unwrap().ring_drift_m;
        println!(
            "{load} N: {:+.1e}, drift {drift:?} m",
            found / expected - 1.0
        );
        assert!(relative(found, expected) < 1e-5);
        assert!(drift.iter().any(|drift| drift.abs() > 1e-9));
    }
}

fn amplitude_at(wheel: &Wheel, ring: Ring, load: f64, frequency_hz: f64) -> f64 {
    let contact = Some((wheel.law, wheel.sector));
    let geometry = wheel.model.contact.clone();
    let settings = PointSettings::new(&SolverOptions::default(), &[1, 3], contact, geometry);
    let settings = settings.unwrap().with_ring(ring);
    let tuned = wheel.tuned(&[1, 3]);
    let mut solver = PointSolver::new(&tuned, full(load), &settings);
    solver.solve(frequency_hz).unwrap().largest_amplitude_m()
}

#[test]
fn the_tuned_wheel_has_the_mean_friction_of_its_one_sector() {
    for law in [ContactLaw::Simplified3d, ContactLaw::Coulomb3d] {
        let wheel = Wheel {
            law,
            ..Wheel::wheel8()
        };
        let options = SolverOptions {
            peak_tolerance: 1e-6,
            residual_tolerance: 1e-10,
            ..SolverOptions::default()
        };
        let solver = wheel.solver(&[1, 3], options);
        let load = full(250.0);
        let sector = solver.tuned_peak(ENGINE_ORDER, load);
        let [circumferential, axial] = sector.mean_friction_n.unwrap();
        let row = solve_row(&solver, &pattern(&[0.0; 8]), load).1;
        let of_row = [
            row.mean_friction_circumferential_n.unwrap(),
            row.mean_friction_axial_n.unwrap(),
        ];
        println!("{law:?}: {circumferential:.4} N and {axial:.4} N per sector, {of_row:?}");
        // Where the peak lies exactly, and the offset of pairs that stick, differ a little.
        assert!(circumferential.abs() > 0.1);
        assert!(relative(of_row[0], circumferential) < 1e-2);
        assert!((of_row[1] - axial).abs() < 1e-2 * circumferential.abs());

        let stuck = solve_row(&solver, &pattern(&[0.0; 8]), ContactCondition::Stuck).1;
        assert_eq!(stuck.mean_friction_axial_n, None);
    }
}
