//! A basis of vectors that hardly differ: duplicates, a light ring, sixty contact pairs.

use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix, SymmetricSparse, hermitian_pencil, orthonormal_basis};
use blisk::model::reduction::{BasisChoice, Reduction};
use blisk::model::sector::{
    Body, Component, ContactPair, ContactSide, Dof, LumpedOptions, ObservedNode, SectorModel,
    lumped, validate,
};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;

use super::wheels::{ORDER, SECTORS, amplitude, solved, uneven};
use crate::sector_sources::data;
use crate::sector_sources::lumped::{lumped24, wheel as assembled};
use crate::wheels::{Wheel, full, relative, springs};

/// Pairs of a sector of [`comb`].
const PAIRS: usize = 60;

/// Masses of its blade.
const BLADE: usize = 40;

/// A blade of forty masses on an elastic disk that touches an elastic ring at sixty places: 162 dofs, one
/// direction. More lies between the contacts than a Craig-Bampton model of 25 modes keeps.
fn comb(link: f64) -> SectorModel {
    let alpha = std::f64::consts::TAU / SECTORS as f64;
    let mut dofs = Vec::new();
    let mut add = |radius: f64, angle: f64, body: Body| {
        dofs.push(Dof {
            node: dofs.len(),
            component: Component::Tangential,
            position_m: [radius * angle.cos(), radius * angle.sin(), 0.0],
            body,
        });
        dofs.len() - 1
    };
    let place = |i: usize| alpha * (i as f64 + 0.5) / PAIRS as f64;
    let blade: Vec<usize> = (0..BLADE)
        .map(|i| add(1.5 - 0.01 * i as f64, 0.5 * alpha, Body::Blisk))
        .collect();
    let disk: Vec<usize> = (0..PAIRS)
        .map(|i| add(1.0, place(i), Body::Blisk))
        .collect();
    let ring: Vec<usize> = (0..PAIRS).map(|i| add(0.9, place(i), Body::Ring)).collect();
    // The last place of a sector is tied to the first of the next one.
    let next = add(1.0, place(PAIRS), Body::Blisk);
    let next_ring = add(0.9, place(PAIRS), Body::Ring);
    let mut stiffness = Vec::new();
    let mut spring = |a: usize, b: Option<usize>, k: f64| {
        stiffness.push((a, a, k));
        if let Some(b) = b {
            stiffness.extend([(b, b, k), (a.max(b), a.min(b), -k)]);
        }
    };
    let share = 1.0 / PAIRS as f64;
    for i in 0..PAIRS {
        spring(disk[i], None, 7.0e6 * share);
        spring(ring[i], Some(disk[i]), 1.0e4 * share);
        spring(disk[i], Some(*disk.get(i + 1).unwrap_or(&next)), link);
        spring(ring[i], Some(*ring.get(i + 1).unwrap_or(&next_ring)), link);
    }
    // From tip to root, as stiff in all as the one spring of the chain.
    let mut blade_stiffness = Vec::new();
    for i in 0..BLADE {
        let next = *blade.get(i + 1).unwrap_or(&disk[PAIRS / 2]);
        let k = 2.5e6 * BLADE as f64;
        spring(blade[i], Some(next), k);
        blade_stiffness.extend([
            (blade[i], blade[i], k),
            (next, next, k),
            (next, blade[i], -k),
        ]);
    }
    let mut mass: Vec<_> = blade.iter().map(|&i| (i, i, 0.25 / BLADE as f64)).collect();
    mass.extend(disk.iter().map(|&i| (i, i, share)));
    mass.extend(ring.iter().map(|&i| (i, i, 0.03 * share)));
    let n = dofs.len();
    let model = SectorModel {
        name: "comb".to_owned(),
        sectors: SECTORS,
        stiffness: SymmetricSparse::from_lower_triplets(n, &stiffness),
        mass: SymmetricSparse::from_lower_triplets(n, &mass),
        blade_stiffness: SymmetricSparse::from_lower_triplets(n, &blade_stiffness),
        dofs,
        cyclic_pairs: vec![(disk[0], next), (ring[0], next_ring)],
        contact_pairs: (0..PAIRS)
            .map(|i| ContactPair {
                first: ContactSide::Node(disk[i]),
                second: ContactSide::Node(ring[i]),
                normal: [-1.0, 0.0, 0.0],
                weight: share,
                load_weight: None,
            })
            .collect(),
        force: vec![(blade[0], Complex64::new(1.0, 0.0))],
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "blade".to_owned(),
            node: blade[0],
        }],
    };
    validate(&model).unwrap();
    model
}

fn contact(kt: f64) -> PairParameters {
    PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: 0.3,
    }
}

fn wheel(sector: &SectorModel, kt: f64, basis: BasisChoice) -> Wheel {
    Wheel {
        amplitude_n: 10.0,
        ..Wheel::of(
            sector,
            ContactLaw::MacroSlip1d,
            contact(kt),
            Damping::StructuralLossFactor(0.002),
            basis,
        )
    }
}

fn peak(wheel: &Wheel, contact: ContactCondition) -> f64 {
    let options = SolverOptions {
        peak_tolerance: 1e-6,
        ..SolverOptions::default()
    };
    amplitude(
        &solved(
            &wheel.solver(&[1], options),
            ORDER,
            &uneven(SECTORS, 0.03),
            contact,
        )
        .1,
    )
}

/// Without contact springs stick and slide modes are the same: the basis keeps each once, and every
/// linear result is that of half of it.
#[test]
fn duplicated_modes_are_dropped_and_change_nothing() {
    let sector = comb(1e9);
    for modes in [1, 4, 8] {
        let twice = BasisChoice::StickSlide {
            stick: modes,
            slide: modes,
        };
        let once = BasisChoice::StickSlide {
            stick: modes,
            slide: 0,
        };
        let [twice, once] = [twice, once].map(|basis| wheel(&sector, 0.0, basis));
        for (line, of_one) in twice.model.report.iter().zip(&once.model.report) {
            assert_eq!((line.candidates, line.rank), (2 * modes, of_one.rank));
            assert_eq!(of_one.rank, modes);
            assert!(line.condition < 1e4, "{}", line.condition);
        }
        let pairs = twice
            .model
            .nodal_diameters
            .iter()
            .zip(&once.model.nodal_diameters);
        for (found, expected) in pairs {
            for (found, expected) in found.eigenvalues.iter().zip(&expected.eigenvalues) {
                assert!(relative(*found, *expected) < 1e-9);
            }
        }
        let [twice, once] = [twice, once].map(|wheel| peak(&wheel, ContactCondition::Free));
        assert!(relative(twice, once) < 1e-8, "{modes} modes");
    }
}

/// Slide modes that differ from the stick modes by a billionth: below the threshold of rank they are
/// dropped, above it they are kept, and the peak under friction is the same to the difference.
#[test]
fn nearly_duplicated_modes_change_nothing_but_the_rank() {
    let sector = comb(1e9);
    let basis = BasisChoice::StickSlide { stick: 4, slide: 4 };
    let reference = peak(&wheel(&sector, 1e-3, basis), ContactCondition::Free);
    for kt in [1e-3, 1e-1, 1e1, 1e3] {
        let wheel = wheel(&sector, kt, basis);
        let line = &wheel.model.report[1];
        println!(
            "kt = {kt:e} N/m: rank {} of 8, condition {:.1e}",
            line.rank, line.condition
        );
        assert!(line.condition < 1e8, "{}", line.condition);
        let free = peak(&wheel, ContactCondition::Free);
        assert!(
            relative(free, reference) < 1e-3,
            "{kt:e}: {}",
            relative(free, reference)
        );
    }
}

/// Sixty pairs along an elastic interface: each basis against the whole Craig-Bampton space.
#[test]
fn sixty_pairs_in_sixty_places_are_solved() {
    let sector = comb(1e9);
    let reference = wheel(&sector, 8e5, BasisChoice::CraigBampton);
    for load in [20.0, 60.0] {
        let exact = peak(&reference, full(load));
        for (basis, bound) in [
            (BasisChoice::StickAttachment { stick: 4 }, 1e-3),
            (BasisChoice::StickSlide { stick: 4, slide: 4 }, 5e-3),
            (
                BasisChoice::StickSlide {
                    stick: 10,
                    slide: 10,
                },
                1e-3,
            ),
        ] {
            let reduced = wheel(&sector, 8e5, basis);
            let error = relative(peak(&reduced, full(load)), exact);
            println!(
                "{basis}, {load} N: {error:.1e}, rank {}",
                reduced.model.report[1].rank
            );
            assert!(error < bound, "{basis}, {load} N: {error:e}");
        }
    }
}

/// Condition of the Gram matrix of 24 stuck and 24 free modes of the lumped wheel, those that move the
/// blades most, each set mass-orthonormal, for rings of other mass and stiffness (all springs of the
/// ring) and contacts soft to rigid: `tests/data/lumped24/condition.csv`, by scipy on matrices that `condition.py`
/// beside it builds without this program. A stiff contact with a lighter ring is worse; with a soft one the condition
/// is bad throughout.
#[test]
fn the_condition_of_the_joint_basis_is_that_of_the_table() {
    let path = data("lumped24").join("condition.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 9);
    for row in rows {
        let (ring, kt, expected) = (row[0], row[1], row[2]);
        let found = joint_condition(ring, kt);
        // The table has five digits; of a condition of 1e8 rounding leaves about eight.
        assert!(
            relative(found, expected) < 1e-4,
            "ring x {ring:e}, {kt:e} N/m: {found:e}, table {expected:e}"
        );
    }
}

/// Of the wheel in physical coordinates: the 24 modes that move the blades most, of each linear limit.
fn joint_condition(ring: f64, kt: f64) -> f64 {
    let own = lumped24();
    let options = LumpedOptions {
        ring_mass_kg: ring * own.ring_mass_kg,
        ring_coupling_stiffness_n_per_m: ring * own.ring_coupling_stiffness_n_per_m,
        ring_disk_stiffness_n_per_m: ring * own.ring_disk_stiffness_n_per_m,
        ..own
    };
    let model = lumped::build(&options).unwrap();
    let dense = |matrix: &SymmetricSparse| {
        let mut dense = Matrix::<f64>::zeros(matrix.dimension(), matrix.dimension());
        for (row, column, value) in matrix.entries() {
            dense[(row, column)] += value;
        }
        dense
    };
    let mass = dense(&assembled(&model, &model.mass, 3));
    let slide = dense(&assembled(&model, &model.stiffness, 3));
    let mut stick = slide.clone();
    for sector in 0..24 {
        let (disk, ring) = (3 * sector + 1, 3 * sector + 2);
        for (i, j, sign) in [
            (disk, disk, 1.0),
            (ring, ring, 1.0),
            (disk, ring, -1.0),
            (ring, disk, -1.0),
        ] {
            stick[(i, j)] += sign * kt;
        }
    }
    let blade_modes = |stiffness: &Matrix<f64>| {
        let (_, modes) = hermitian_pencil(stiffness, &mass).unwrap();
        let participation = |mode: usize| -> f64 {
            (0..24)
                .map(|sector| modes[(3 * sector, mode)].powi(2))
                .sum()
        };
        let mut order: Vec<usize> = (0..modes.columns()).collect();
        order.sort_by(|&a, &b| participation(b).total_cmp(&participation(a)));
        Matrix::from_fn(modes.rows(), 24, |i, j| modes[(i, order[j])])
    };
    let joint = blade_modes(&stick).beside(&blade_modes(&slide));
    let basis = orthonormal_basis(&joint, &mass, 1e-14).unwrap();
    // Singular values of the columns; the Gram matrix has their squares.
    basis.condition().powi(2)
}

/// A ring of a ten-thousandth of its mass and stiffness: rank and condition are reported, and the peak
/// under friction of a small basis is that of the whole space.
#[test]
fn a_light_ring_degrades_no_basis() {
    for factor in [1e-4, 10.0] {
        let sector = comb(1e9);
        let scaled = |matrix: &SymmetricSparse| {
            let entries: Vec<_> = matrix
                .lower_entries()
                .map(|(row, column, value)| {
                    let in_ring = sector.dofs[row].body == Body::Ring
                        && sector.dofs[column].body == Body::Ring;
                    (row, column, if in_ring { factor * value } else { value })
                })
                .collect();
            SymmetricSparse::from_lower_triplets(matrix.dimension(), &entries)
        };
        // The springs that locate the ring on the disk are dropped, so that scaling leaves K definite.
        let held: Vec<_> = sector
            .stiffness
            .lower_entries()
            .filter(|&(row, column, _)| sector.dofs[row].body == sector.dofs[column].body)
            .collect();
        let held = SymmetricSparse::from_lower_triplets(sector.dofs.len(), &held);
        let light = SectorModel {
            stiffness: scaled(&held),
            mass: scaled(&sector.mass),
            ..sector.clone()
        };
        let reduction = Reduction::new(
            &light,
            springs(ContactLaw::MacroSlip1d, contact(8e5)),
            25,
            0,
        )
        .unwrap();
        let basis = BasisChoice::StickSlide { stick: 8, slide: 8 };
        let reduced = reduction.reduce(basis, None).unwrap();
        for line in &reduced.report {
            assert!(
                line.condition < 1e8 && line.rank > 8,
                "{factor:e}: {line:?}"
            );
        }
        let small = Wheel {
            model: Arc::new(reduced),
            ..wheel(&light, 8e5, BasisChoice::StickAttachment { stick: 4 })
        };
        let whole = wheel(&light, 8e5, BasisChoice::CraigBampton);
        let error = relative(peak(&small, full(60.0)), peak(&whole, full(60.0)));
        println!("ring x {factor:e}: {error:.1e}");
        assert!(error < 1e-3, "ring x {factor:e}: {error:e}");
    }
}
