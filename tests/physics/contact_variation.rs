//! Contact that differs from wheel to wheel, sector to sector and pair to pair.

use std::f64::consts::SQRT_2;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::lumped;
use blisk::population::monte_carlo::{ResponseRow, RowSolver};
use blisk::response::forced_response::{AmplitudeMeasure, SolverOptions};
use blisk::response::friction::PairParameters;
use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::{
    ContactFactors, ContactQuantity, ContactSource, ContactVariation, Distribution, FactorLaw,
    PairFactors, Pattern, PatternSource, VariesPer,
};

use super::contact::random::Random;
use super::sector_sources::lumped::lumped24;
use super::wheels::{Wheel, full, pattern, relative, solve_row};

const LOAD: f64 = 50.0;

fn tight() -> SolverOptions {
    SolverOptions {
        residual_tolerance: 1e-11,
        peak_tolerance: 1e-5,
        amplitude: AmplitudeMeasure::Fundamental,
        ..SolverOptions::default()
    }
}

fn wheel() -> Wheel {
    Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    }
}

fn row(solver: &RowSolver, pattern: &Pattern, load: f64) -> ResponseRow {
    let (_, row) = solve_row(solver, pattern, full(load));
    assert_eq!(row.status, Status::Ok);
    row
}

fn varied(deviations: &[f64], factors: Vec<PairFactors>) -> Pattern {
    Pattern {
        contact: ContactFactors::new(factors),
        ..pattern(deviations)
    }
}

/// On a model without reduction, a factor of the whole wheel is another study.
#[test]
fn a_factor_of_the_wheel_is_a_study_with_that_contact() {
    let wheel = wheel();
    let deviations = wheel.deviations(&mut Random(7), 0.03);
    let nominal = wheel.solver(&[1, 3], tight());
    let amplitude = |row: ResponseRow| row.peak_amplitude_m.expect("solved");
    let with = |factors: PairFactors| {
        amplitude(row(&nominal, &varied(&deviations, vec![factors; 24]), LOAD))
    };

    let load = PairFactors {
        normal_load: 1.3,
        ..PairFactors::default()
    };
    let expected = amplitude(row(&nominal, &pattern(&deviations), 1.3 * LOAD));
    assert!(relative(with(load), expected) < 3e-5, "normal load");
    // The law knows friction coefficient and normal load as a product where the load is constant.
    let friction = PairFactors {
        friction_coefficient: 1.3,
        ..PairFactors::default()
    };
    assert!(relative(with(friction), expected) < 3e-5, "friction");

    let stiffer = PairFactors {
        tangential_stiffness: 1.4,
        ..PairFactors::default()
    };
    let other = PairParameters {
        tangential_stiffness_n_per_m: 1.4 * wheel.sector.tangential_stiffness_n_per_m,
        ..wheel.sector
    };
    let other = Wheel {
        amplitude_n: 10.0,
        ..Wheel::of(
            &lumped::build(&lumped24()).unwrap(),
            wheel.law,
            other,
            wheel.damping,
            BasisChoice::CraigBampton,
        )
    };
    let expected = amplitude(row(
        &other.solver(&[1, 3], tight()),
        &pattern(&deviations),
        LOAD,
    ));
    assert!(relative(with(stiffer), expected) < 3e-5, "stiffness");
    assert!(relative(with(stiffer), with(PairFactors::default())) > 1e-3);
}

#[test]
fn a_turned_wheel_answers_alike() {
    let wheel = wheel();
    let solver = wheel.solver(&[1, 3], tight());
    let deviations = wheel.deviations(&mut Random(8), 0.03);
    let mut random = Random(9);
    let factors: Vec<PairFactors> = (0..24)
        .map(|_| {
            let draw = random.vector(3, 0.2);
            PairFactors {
                friction_coefficient: 1.0 + draw[0],
                tangential_stiffness: 1.0 + draw[1],
                normal_load: 1.0 + draw[2],
                ..PairFactors::default()
            }
        })
        .collect();
    let own = row(&solver, &varied(&deviations, factors.clone()), LOAD);
    let (mut turned, mut turned_factors) = (deviations.clone(), factors);
    turned.rotate_right(5);
    turned_factors.rotate_right(5);
    let other = row(&solver, &varied(&turned, turned_factors), LOAD);
    assert_eq!(
        (own.peak_blade.unwrap() + 5) % 24,
        other.peak_blade.unwrap()
    );
    let difference = relative(
        own.peak_amplitude_m.unwrap(),
        other.peak_amplitude_m.unwrap(),
    );
    assert!(difference < 3e-5, "{difference:e}");
}

#[test]
fn impossible_contact_is_an_invalid_pattern() {
    let wheel = wheel();
    let solver = wheel.solver(&[1], tight());
    for factor in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let factors = PairFactors {
            tangential_stiffness: factor,
            ..PairFactors::default()
        };
        let (_, row) = solve_row(&solver, &varied(&[0.0; 24], vec![factors; 24]), full(LOAD));
        assert_eq!(row.status, Status::InvalidPattern);
        assert_eq!(row.peak_amplitude_m, None);
    }
}

fn source(variations: Vec<ContactVariation>) -> PatternSource {
    PatternSource::WithContact {
        blades: Box::new(PatternSource::Random {
            seed: 11,
            count: 20_000,
            sectors: 4,
            distribution: Distribution::Normal,
        }),
        contact: ContactSource {
            seed: 11,
            sectors: 4,
            pairs: 3,
            variations,
        },
    }
}

fn variation(quantity: ContactQuantity, law: FactorLaw, per: VariesPer) -> ContactVariation {
    ContactVariation {
        quantity,
        law,
        standard_deviation: 0.2,
        per,
    }
}

#[test]
fn factors_follow_their_law_and_nothing_else() {
    let friction = variation(
        ContactQuantity::FrictionCoefficient,
        FactorLaw::Relative(Distribution::Normal),
        VariesPer::Wheel,
    );
    let stiffness = variation(
        ContactQuantity::TangentialStiffness,
        FactorLaw::Lognormal,
        VariesPer::Pair,
    );
    let load = variation(
        ContactQuantity::NormalLoad,
        FactorLaw::Relative(Distribution::Uniform),
        VariesPer::Sector,
    );
    let all = source(vec![friction, stiffness, load]);
    let one = source(vec![load]);
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    let mut products = 0.0;
    for id in 0..20_000 {
        let full = all.pattern(id, Some(0.05)).expect("a pattern");
        let alone = one.pattern(id, Some(0.05)).expect("a pattern");
        assert_eq!(full.deviations, alone.deviations);
        let pairs = full.contact.pairs();
        assert_eq!(pairs.len(), 12);
        assert!(pairs.iter().all(|pair| {
            pair.friction_coefficient.to_bits() == pairs[0].friction_coefficient.to_bits()
        }));
        for (place, (pair, other)) in pairs.iter().zip(alone.contact.pairs()).enumerate() {
            assert_eq!(pair.normal_load.to_bits(), other.normal_load.to_bits());
            let own_sector = pairs[place / 3 * 3].normal_load;
            assert_eq!(pair.normal_load.to_bits(), own_sector.to_bits());
            assert!((pair.normal_load - 1.0).abs() <= 0.2 * 3.0_f64.sqrt());
        }
        let values = [
            (pairs[0].friction_coefficient - 1.0) / 0.2,
            pairs[7].tangential_stiffness.ln() / 0.2,
            (pairs[4].normal_load - 1.0) / 0.2,
        ];
        for (k, value) in values.into_iter().enumerate() {
            sums[k] += value / 20_000.0;
            squares[k] += value * value / 20_000.0;
        }
        products += values[0] * values[1] / 20_000.0;
    }
    // Five standard errors of 20,000 draws.
    for k in 0..3 {
        assert!(sums[k].abs() < 5.0 / 20_000.0_f64.sqrt(), "{}", sums[k]);
        assert!((squares[k] - 1.0).abs() < 5.0 * SQRT_2 / 20_000.0_f64.sqrt());
    }
    assert!(products.abs() < 5.0 / 20_000.0_f64.sqrt());
}
