//! The small wheels of the battery, and what holds of every row whatever its outcome.

use std::sync::Arc;

use blisk::linalg::{Complex64, SymmetricSparse};
use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{
    Body, Component, ContactPair, ContactSide, Dof, LumpedOptions, ObservedNode, SectorModel,
    lumped,
};
use blisk::population::monte_carlo::{ResponseRow, RowSolver, Scenario, TunedReference};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::Pattern;

use crate::sector_sources::lumped::lumped24;
use crate::wheels::{LUMPED_KT, Wheel, pattern};

/// Sectors of most wheels of the battery.
pub const SECTORS: usize = 5;

/// Engine order of most wheels of the battery.
pub const ORDER: u32 = 1;

/// Blade, disk and ring of the reference chain on five sectors: three dofs per sector, one tangent.
pub fn chain() -> LumpedOptions {
    LumpedOptions {
        sectors: SECTORS,
        ..lumped24()
    }
}

/// One-dimensional friction on masses and springs; the whole space, so that nothing is reduced.
pub fn one_dimensional(options: &LumpedOptions) -> Wheel {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: LUMPED_KT,
        friction_coefficient: 0.3,
    };
    Wheel {
        amplitude_n: 10.0,
        ..Wheel::of(
            &lumped::build(options).unwrap(),
            ContactLaw::MacroSlip1d,
            contact,
            Damping::StructuralLossFactor(0.002),
            BasisChoice::CraigBampton,
        )
    }
}

/// Loads under which the contact of [`one_dimensional`] slips grossly, partly and hardly.
pub const CHAIN_LOADS: [f64; 3] = [5.0, 20.0, 60.0];

/// A sector of three nodes with three directions each (blade, disk, ring) and a general spring between
/// blade and disk, so that a bending blade opens and closes the contact.
pub fn spatial_sector(sectors: usize) -> SectorModel {
    const BLADE: usize = 0;
    const DISK: usize = 1;
    const RING: usize = 2;
    let alpha = std::f64::consts::TAU / sectors as f64;
    let components = [Component::Radial, Component::Tangential, Component::Axial];
    let radius = [1.5, 1.0, 0.9];
    let body = |node: usize| {
        if node == RING {
            Body::Ring
        } else {
            Body::Blisk
        }
    };
    let mut dofs = Vec::new();
    let mut node_at = |node: usize, place: usize, angle: f64| {
        for component in components {
            dofs.push(Dof {
                node,
                component,
                position_m: [
                    radius[place] * angle.cos(),
                    radius[place] * angle.sin(),
                    0.0,
                ],
                body: body(place),
            });
        }
    };
    for node in [BLADE, DISK, RING] {
        node_at(node, node, 0.0);
    }
    node_at(3, DISK, alpha);
    node_at(4, RING, alpha);
    let mut stiffness = Vec::new();
    let mut mass = Vec::new();
    for (node, kg) in [(BLADE, 0.25), (DISK, 1.0), (RING, 0.03)] {
        mass.extend((0..3).map(|i| (3 * node + i, 3 * node + i, kg)));
    }
    for i in 0..3 {
        // To ground: the disk firmly, the ring so weakly that contact alone holds it.
        stiffness.push((3 * DISK + i, 3 * DISK + i, 7.0e6));
        stiffness.push((3 * RING + i, 3 * RING + i, 1.0e3));
        // To the next sector, in the directions of its own frame.
        for (low, high, spring) in [(DISK, 3, 2.5e5), (RING, 4, 8.0e5)] {
            let (low, high) = (3 * low + i, 3 * high + i);
            stiffness.extend([
                (low, low, spring),
                (high, high, spring),
                (high, low, -spring),
            ]);
        }
    }
    // Blade spring: positive definite, with every direction coupled to every other.
    let spring = [
        [6.0e6, 1.5e6, -0.8e6],
        [1.5e6, 2.5e6, 0.6e6],
        [-0.8e6, 0.6e6, 4.0e6],
    ];
    let mut blade = Vec::new();
    for (i, row) in spring.into_iter().enumerate() {
        for (j, entry) in row.into_iter().enumerate() {
            blade.push((3 * DISK + i, 3 * BLADE + j, -entry));
            if i >= j {
                blade.push((3 * BLADE + i, 3 * BLADE + j, entry));
                blade.push((3 * DISK + i, 3 * DISK + j, entry));
            }
        }
    }
    stiffness.extend_from_slice(&blade);
    let n = dofs.len();
    let pairs = |low: usize, high: usize| (0..3).map(move |i| (3 * low + i, 3 * high + i));
    let model = SectorModel {
        name: "spatial".to_owned(),
        sectors,
        stiffness: SymmetricSparse::from_lower_triplets(n, &stiffness),
        mass: SymmetricSparse::from_lower_triplets(n, &mass),
        blade_stiffness: SymmetricSparse::from_lower_triplets(n, &blade),
        dofs,
        cyclic_pairs: pairs(DISK, 3).chain(pairs(RING, 4)).collect(),
        contact_pairs: vec![ContactPair {
            first: ContactSide::Node(DISK),
            second: ContactSide::Node(RING),
            normal: [-1.0, 0.0, 0.0],
            weight: 1.0,
            load_weight: None,
        }],
        force: vec![
            (0, Complex64::new(0.4, 0.0)),
            (1, Complex64::new(1.0, 0.3)),
            (2, Complex64::new(0.0, 0.5)),
        ],
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "blade".to_owned(),
            node: BLADE,
        }],
    };
    blisk::model::sector::validate(&model).unwrap();
    model
}

/// Three-dimensional friction with variable normal load; the whole space of nine dofs per sector.
pub fn spatial() -> Wheel {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 1.6e6,
        tangential_stiffness_n_per_m: LUMPED_KT,
        friction_coefficient: 0.3,
    };
    Wheel {
        amplitude_n: 10.0,
        ..Wheel::of(
            &spatial_sector(SECTORS),
            ContactLaw::Simplified3d,
            contact,
            Damping::StructuralLossFactor(0.002),
            BasisChoice::CraigBampton,
        )
    }
}

/// Settings under which two ways to the same peak agree to nine digits. The samples are a multiple of
/// the sectors, so that every sector of a travelling wave is sampled at the same phases.
pub fn tight() -> SolverOptions {
    SolverOptions {
        samples_per_period: 32 * SECTORS,
        peak_tolerance: 1e-9,
        residual_tolerance: 1e-11,
        ..SolverOptions::default()
    }
}

/// A fixed pattern of the given size on any number of sectors: no two blades alike.
pub fn uneven(sectors: usize, size: f64) -> Vec<f64> {
    (0..sectors)
        .map(|n| {
            let n = n as f64;
            size * (1.7 * n + 0.3 * n * n).cos()
        })
        .collect()
}

/// The scenario of an engine order.
pub fn under(engine_order: u32, contact: ContactCondition) -> Scenario {
    Scenario {
        index: 0,
        load_case: None,
        engine_order,
        standard_deviation: None,
        contact,
    }
}

/// Tuned peak and row of one pattern, checked to be sound.
pub fn solved(
    solver: &RowSolver,
    engine_order: u32,
    deviations: &[f64],
    contact: ContactCondition,
) -> (TunedReference, ResponseRow) {
    solved_pattern(solver, engine_order, &pattern(deviations), contact)
}

/// The same for a pattern of any kind.
pub fn solved_pattern(
    solver: &RowSolver,
    engine_order: u32,
    pattern: &Pattern,
    contact: ContactCondition,
) -> (TunedReference, ResponseRow) {
    let scenario = under(engine_order, contact);
    let tuned = solver.tuned(&scenario);
    let row = solver.rows(pattern, &[(&scenario, &tuned)]).remove(0);
    assert_sound(&tuned, &row);
    (tuned, row)
}

/// No number is not finite, a failed row has none, and the work is bounded.
pub fn assert_sound(tuned: &TunedReference, row: &ResponseRow) {
    let tuned_numbers = [
        tuned.amplitude_m,
        tuned.frequency_hz,
        tuned.slipping_fraction,
    ];
    for number in tuned_numbers {
        assert_eq!(number.is_some(), tuned.status == Status::Ok, "{tuned:?}");
        assert!(number.is_none_or(f64::is_finite), "{tuned:?}");
    }
    let numbers = [
        row.peak_amplitude_m,
        row.peak_frequency_hz,
        row.residual,
        row.slipping_fraction,
        row.separated_fraction,
    ];
    for number in numbers {
        assert_eq!(number.is_some(), row.status == Status::Ok, "{row:?}");
        assert!(number.is_none_or(f64::is_finite), "{row:?}");
    }
    assert!(
        row.amplification_factor.is_none_or(f64::is_finite),
        "{row:?}"
    );
    if row.status == Status::Ok {
        assert_eq!(row.peak_bracketed, Some(true), "{row:?}");
        assert_eq!(
            row.amplification_factor.is_some(),
            tuned.status == Status::Ok
        );
    }
    // 1500 points, each with a ladder of attempts of at most 60 iterations each.
    assert!(row.nonlinear_solves <= 1501, "{row:?}");
    assert!(
        row.newton_iterations <= 60 * 200 * row.nonlinear_solves,
        "{row:?}"
    );
}

/// Amplitude of a row that must have ended well.
pub fn amplitude(row: &ResponseRow) -> f64 {
    assert_eq!(row.status, Status::Ok, "{row:?}");
    row.peak_amplitude_m.unwrap()
}

/// Powers of ten, `steps` per decade, both ends included.
pub fn decades(low: i32, high: i32, steps: u32) -> Vec<f64> {
    let count = (high - low) as u32 * steps;
    (0..=count)
        .map(|step| 10.0_f64.powf(f64::from(low) + f64::from(step) / f64::from(steps)))
        .collect()
}

/// The reduced model of a wheel under another sector.
pub fn with_sector(wheel: &Wheel, sector: &SectorModel) -> Wheel {
    let other = Wheel::of(
        sector,
        wheel.law,
        wheel.sector,
        wheel.damping,
        BasisChoice::CraigBampton,
    );
    Wheel {
        model: Arc::clone(&other.model),
        ..wheel.clone()
    }
}
