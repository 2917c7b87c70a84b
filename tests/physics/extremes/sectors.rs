//! Few, many, odd and even sectors; engine orders of nought, half the sectors and beyond; one contact
//! pair and sixty.

use std::f64::consts::TAU;

use blisk::linalg::Complex64;
use blisk::model::sector::{ContactPair, LumpedOptions, SectorModel, lumped};
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::{
    ContactCondition, PointSettings, PointSolver, SolverOptions,
};
use blisk::response::harmonic_balance::Status;

use super::wheels::{
    CHAIN_LOADS, ORDER, SECTORS, amplitude, chain, one_dimensional, solved, spatial,
    spatial_sector, tight, under, uneven, with_sector,
};
use crate::wheels::{ENGINE_ORDER, Wheel, full, relative};

fn of_sectors(sectors: usize) -> Wheel {
    one_dimensional(&LumpedOptions { sectors, ..chain() })
}

/// Engine orders that a wheel of N sectors tells apart, and some that it does not.
fn orders(sectors: usize) -> Vec<u32> {
    let n = sectors as u32;
    let mut orders = vec![0, 1, n / 2, n - 1, n, n + 1, 2 * n + n / 2];
    orders.sort_unstable();
    orders.dedup();
    orders
}

const CI_SECTORS: [usize; 7] = [1, 2, 3, 5, 24, 25, 92];

/// Samples that are a multiple of the sectors, at least 128: only then does every sector of a travelling
/// wave see its force at the same phases, and turning the wheel by a sector changes no number.
fn samples(sectors: usize) -> usize {
    sectors * 128_usize.div_ceil(sectors)
}

/// Settings under which sectors are alike; wheels on which nine digits would be dear take six.
fn quick(sectors: usize) -> SolverOptions {
    SolverOptions {
        samples_per_period: samples(sectors),
        peak_tolerance: if sectors <= 5 { 1e-9 } else { 1e-6 },
        ..tight()
    }
}

fn bound(sectors: usize) -> f64 {
    10.0 * quick(sectors).peak_tolerance
}

/// One sector stands for the tuned wheel, whatever its size and the engine order.
#[test]
fn the_tuned_sector_is_the_tuned_wheel() {
    for sectors in CI_SECTORS {
        let solver = of_sectors(sectors).solver(&[1], quick(sectors));
        let contacts: &[ContactCondition] = if sectors == 92 {
            &[
                ContactCondition::Stuck,
                ContactCondition::Full {
                    normal_load_n: 20.0,
                },
            ]
        } else {
            &[
                ContactCondition::Stuck,
                ContactCondition::Slide,
                ContactCondition::Free,
                ContactCondition::Full { normal_load_n: 5.0 },
                ContactCondition::Full {
                    normal_load_n: 20.0,
                },
            ]
        };
        let orders = if sectors == 92 {
            vec![46, 93]
        } else {
            orders(sectors)
        };
        for order in orders {
            for &contact in contacts {
                let row = solved(&solver, order, &vec![0.0; sectors], contact).1;
                let error = relative(row.amplification_factor.unwrap(), 1.0);
                assert!(
                    error < bound(sectors),
                    "{sectors}, EO {order}, {contact:?}: {error:e}"
                );
            }
        }
    }
}

/// With samples that are no multiple of the sectors, sectors differ by the error of sampling: it is below
/// 1e-3 at 128 samples and falls with them.
#[test]
fn sectors_out_of_step_with_the_samples_differ_by_the_error_of_sampling() {
    for sectors in [3, 5] {
        let error = |samples_per_period: usize| {
            let options = SolverOptions {
                samples_per_period,
                ..tight()
            };
            let solver = of_sectors(sectors).solver(&[1], options);
            let row = solved(&solver, ORDER, &vec![0.0; sectors], full(20.0)).1;
            relative(row.amplification_factor.unwrap(), 1.0)
        };
        let [coarse, fine] = [128, 2048].map(error);
        println!("N = {sectors}: {coarse:.1e} with 128 samples, {fine:.1e} with 2048");
        assert!(
            coarse < 1e-3 && fine < 1e-5,
            "{sectors}: {coarse:e}, {fine:e}"
        );
    }
}

/// In the tuned wheel every blade moves like the last one, later by `2 pi k EO / N` in harmonic k.
#[test]
fn every_blade_of_a_tuned_wheel_follows_the_last_at_the_phase_of_its_harmonic() {
    let harmonics = [1, 3];
    for sectors in [3, 5, 24] {
        let wheel = of_sectors(sectors);
        let excited = wheel.mistuned(&vec![0.0; sectors], &harmonics);
        let settings = PointSettings::new(
            &quick(sectors),
            &harmonics,
            Some((wheel.law, wheel.sector)),
            wheel.model.contact.clone(),
        )
        .unwrap();
        let condition = full(20.0);
        let at = wheel
            .solver(&harmonics, quick(sectors))
            .tuned_peak(ENGINE_ORDER, condition);
        let frequency_hz = at.point.as_ref().unwrap().frequency_hz;
        let mut solver = PointSolver::new(&excited, condition, &settings);
        let point = solver.solve(frequency_hz).unwrap();
        assert!(point.shares.slipping > 0.0);
        let structure = &excited.linear.structure;
        let n = structure.size();
        for (block, harmonic) in harmonics.into_iter().enumerate() {
            let (re, im) = point.solution[2 * n * block..2 * n * (block + 1)].split_at(n);
            let along = |part: &[f64]| structure.observed().real.times_vector(part);
            // The tangential displacement of each blade: the second of three rows.
            let (re, im) = (along(re), along(im));
            let blade = |i: usize| Complex64::new(re[3 * i + 1], im[3 * i + 1]);
            let angle = TAU * f64::from(harmonic * ENGINE_ORDER) / sectors as f64;
            for i in 0..sectors {
                let error = (blade(i) - blade(0) * Complex64::cis(angle * i as f64)).norm();
                assert!(
                    error < 1e-8 * blade(0).norm(),
                    "{sectors}, {harmonic}, {i}: {error:e}"
                );
            }
        }
    }
}

/// Turning the pattern by any number of sectors turns the response.
#[test]
fn turning_the_pattern_turns_the_response_on_any_wheel() {
    for sectors in CI_SECTORS {
        let solver = of_sectors(sectors).solver(&[1], quick(sectors));
        let deviations = uneven(sectors, 0.03);
        for contact in [ContactCondition::Stuck, full(20.0)] {
            let still = solved(&solver, ORDER, &deviations, contact).1;
            let shifts = if sectors == 92 {
                vec![37]
            } else {
                vec![1 % sectors, sectors / 2]
            };
            for shift in shifts {
                let mut turned = deviations.clone();
                turned.rotate_right(shift);
                let turned = solved(&solver, ORDER, &turned, contact).1;
                let error = relative(amplitude(&turned), amplitude(&still));
                assert!(
                    error < bound(sectors),
                    "{sectors}, {shift}, {contact:?}: {error:e}"
                );
                let blade = (still.peak_blade.unwrap() + shift as u32) % sectors as u32;
                assert_eq!(turned.peak_blade, Some(blade), "{sectors}, {shift}");
            }
        }
    }
}

/// A wheel of N sectors cannot tell EO from EO + N: the rows are the same to the last bit.
#[test]
fn engine_orders_a_wheel_apart_are_one() {
    for sectors in [1, 2, 3, 5, 24, 25] {
        let solver = of_sectors(sectors).solver(&[1, 3], quick(sectors));
        let deviations = uneven(sectors, 0.03);
        for order in [0, 1, sectors as u32 / 2] {
            for contact in [ContactCondition::Stuck, full(20.0)] {
                let of = |order: u32| solved(&solver, order, &deviations, contact).1;
                let alias = order + sectors as u32;
                assert_eq!(of(order), of(alias), "{sectors}, EO {order}, {contact:?}");
            }
        }
    }
}

/// The lumped sector is its own mirror image: EO and N - EO answer mirrored patterns alike.
#[test]
fn a_mirrored_wheel_answers_the_mirrored_engine_order() {
    for sectors in [3, 5, 24, 25] {
        let solver = of_sectors(sectors).solver(&[1, 3], quick(sectors));
        let deviations = uneven(sectors, 0.03);
        let mirrored: Vec<f64> = (0..sectors)
            .map(|n| deviations[(sectors - n) % sectors])
            .collect();
        for order in [0, 1, sectors as u32 / 2] {
            for contact in [ContactCondition::Stuck, full(20.0)] {
                let one = solved(&solver, order, &deviations, contact).1;
                let mirror = sectors as u32 - order;
                let other = solved(&solver, mirror, &mirrored, contact).1;
                let error = relative(amplitude(&other), amplitude(&one));
                assert!(
                    error < bound(sectors),
                    "{sectors}, EO {order}, {contact:?}: {error:e}"
                );
                let blade = (sectors as u32 - one.peak_blade.unwrap()) % sectors as u32;
                assert_eq!(other.peak_blade, Some(blade), "{sectors}, EO {order}");
            }
        }
    }
}

/// Every engine order of a general sector, with separation and without, ends with a status.
#[test]
fn every_engine_order_of_a_general_sector_ends_with_a_status() {
    for sectors in [1, 2, 3, 4, 5] {
        let wheel = with_sector(&spatial(), &spatial_sector(sectors));
        let solver = wheel.solver(&[1, 3], SolverOptions::default());
        for order in 0..=2 * sectors as u32 {
            for load in [20.0, 200.0, 1e4] {
                let row = solved(&solver, order, &uneven(sectors, 0.03), full(load)).1;
                if row.status != Status::Ok {
                    println!("{sectors}, EO {order}, {load} N: {}", row.status.name());
                }
                assert!(
                    row.status == Status::Ok || load < 1e4,
                    "{sectors}, EO {order}"
                );
            }
        }
    }
}

/// The pairs of a sector, each replaced by `count` of them that share its weight on the same nodes.
fn split(model: &SectorModel, count: usize) -> SectorModel {
    let share = |pair: &ContactPair| ContactPair {
        weight: pair.weight / count as f64,
        ..pair.clone()
    };
    SectorModel {
        contact_pairs: model
            .contact_pairs
            .iter()
            .flat_map(|pair| std::iter::repeat_n(share(pair), count))
            .collect(),
        ..model.clone()
    }
}

/// Sixty pairs on the same nodes, each with a sixtieth of load and stiffness, are one pair.
#[test]
fn sixty_pairs_in_one_place_are_one_pair() {
    let row = |wheel: &Wheel, load: f64| -> ResponseRow {
        let solver = wheel.solver(&[1, 3], tight());
        solved(&solver, ORDER, &uneven(SECTORS, 0.04), full(load)).1
    };
    let one = one_dimensional(&chain());
    let sixty = with_sector(&one, &split(&lumped::build(&chain()).unwrap(), 60));
    for load in CHAIN_LOADS {
        let (expected, found) = (row(&one, load), row(&sixty, load));
        let error = relative(amplitude(&found), amplitude(&expected));
        assert!(error < 1e-9, "{load} N: {error:e}");
        assert_eq!(found.slipping_fraction, expected.slipping_fraction);
    }
    let one = spatial();
    let sixty = with_sector(&one, &split(&spatial_sector(SECTORS), 60));
    for load in [60.0, 200.0, 1e4] {
        let (expected, found) = (row(&one, load), row(&sixty, load));
        let error = relative(amplitude(&found), amplitude(&expected));
        assert!(error < 1e-9, "{load} N: {error:e}");
        assert_eq!(found.separated_fraction, expected.separated_fraction);
    }
}

/// Tuned references of every engine order exist for the law and its limits, also on one sector.
#[test]
fn a_wheel_of_one_sector_has_one_answer_for_every_engine_order() {
    let solver = of_sectors(1).solver(&[1, 3], tight());
    for contact in [ContactCondition::Free, ContactCondition::Stuck, full(20.0)] {
        let of = |order: u32| solver.tuned(&under(order, contact));
        for order in [1, 2, 10_000] {
            assert_eq!(of(order), of(0), "EO {order}, {contact:?}");
        }
    }
}
