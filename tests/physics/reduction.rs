//! Craig-Bampton models and bases against the unreduced sector, and what is refused.

use blisk::linalg::{Complex64, Matrix, SymmetricSparse, hermitian_eigen, lowest_modes};
use blisk::model::ReducedNodalDiameter;
use blisk::model::cyclic::CyclicSector;
use blisk::model::reduction::{BasisChoice, ContactStiffness, CraigBampton, Reduction};
use blisk::model::sector::{ModelError, ParametricOptions, SectorModel, lumped, parametric};
use blisk::response::friction::ContactLaw;

use super::sector_sources::lumped::{lumped24, one_dof};
use super::wheels::{relative, springs, wheel8_contact, wheel8_sector};

/// Eigenvalue of 100 Hz. Those of the sliding ring at 5 Hz carry the rounding of the highest ones
/// and are compared on the scale of this one.
const LOW: f64 = 3.9e5;

fn wheel8_springs() -> ContactStiffness {
    springs(ContactLaw::Simplified3d, wheel8_contact())
}

/// Springs of a sector's contact rows: none, sliding, sticking.
fn spring_states(sector: &CyclicSector<'_>) -> [Vec<f64>; 3] {
    let ContactStiffness {
        normal_n_per_m: kn,
        tangential_1_n_per_m: kt,
        ..
    } = wheel8_springs();
    [[0.0; 3], [kn, 0.0, 0.0], [kn, kt, kt]].map(|total| sector.contact().springs(total))
}

/// Lowest eigenvalues of the unreduced sector.
fn unreduced(sector: &CyclicSector<'_>, h: usize, springs: &[f64], count: usize) -> Vec<f64> {
    let stiffness = sector
        .stiffness(h)
        .plus(1.0, &sector.contact_stiffness(springs, h));
    let factor = stiffness.factor().unwrap();
    lowest_modes(&factor, &sector.mass(h), 0.0, count)
        .unwrap()
        .0
}

#[test]
fn craig_bampton_frequencies_approach_the_unreduced_ones_from_above() {
    let built_in = parametric::build(&ParametricOptions::default()).unwrap();
    for (model, diameters) in [
        (wheel8_sector(), vec![0, 1, 2, 3, 4]),
        (built_in, vec![0, 3, 12]),
    ] {
        let sector = CyclicSector::new(&model);
        let mut worst = [0.0_f64; 2];
        for h in diameters {
            let reduced =
                [25, 50].map(|modes| CraigBampton::new(&sector, h, modes, false).unwrap());
            for springs in spring_states(&sector) {
                let exact = unreduced(&sector, h, &springs, 8);
                let [coarse, fine] = reduced.each_ref().map(|model| {
                    let (found, _) = model.modes(&springs).unwrap();
                    excess(&found, &exact)
                });
                for (mode, eigenvalue) in exact.iter().enumerate() {
                    let at = format!("{} h = {h} mode {mode}: {coarse:?}", model.name);
                    assert!(
                        fine[mode] > -1e-9 && coarse[mode] > fine[mode] - 1e-9,
                        "{at}"
                    );
                    worst[1] = worst[1].max(coarse[mode]);
                    if *eigenvalue < 36.0 * LOW {
                        worst[0] = worst[0].max(coarse[mode]);
                    }
                }
            }
        }
        println!(
            "{}: below 600 Hz {:.1e}, first eight {:.1e}",
            model.name, worst[0], worst[1]
        );
        assert!(worst[0] < 1e-4 && worst[1] < 1e-2, "{worst:?}");
    }
}

/// Residual vectors beside 25 fixed-interface modes come nearer to the unreduced sector than 50 such modes alone, and the first 25
/// of 50 modes with them are a model made with 25.
#[test]
fn residual_vectors_are_worth_more_than_twice_the_modes() {
    let model = wheel8_sector();
    let sector = CyclicSector::new(&model);
    for h in 0..=4 {
        let plain = CraigBampton::new(&sector, h, 50, false).unwrap();
        let residual = CraigBampton::new(&sector, h, 25, true).unwrap();
        let fewer = CraigBampton::new(&sector, h, 50, true)
            .unwrap()
            .with_fewer_modes(25);
        for springs in spring_states(&sector) {
            let exact = unreduced(&sector, h, &springs, 12);
            let [plain, residual, fewer] = [&plain, &residual, &fewer].map(|model| {
                let (found, _) = model.modes(&springs).unwrap();
                excess(&found, &exact).into_iter().fold(0.0, f64::max)
            });
            assert!(
                residual < 0.2 * plain + 1e-9,
                "h = {h}: {residual:.1e} {plain:.1e}"
            );
            assert!(
                (fewer - residual).abs() < 2e-8,
                "h = {h}: {residual:.3e} {fewer:.3e}"
            );
        }
    }
}

/// Relative excess in frequency, mode by mode.
fn excess(found: &[f64], exact: &[f64]) -> Vec<f64> {
    let pairs = found.iter().zip(exact);
    pairs
        .map(|(found, exact)| 0.5 * (found - exact) / exact.max(LOW))
        .collect()
}

/// Eigenvalues of a reduced nodal diameter with contact springs.
fn eigenvalues_with_contact(reduced: &ReducedNodalDiameter, springs: &[f64]) -> Vec<f64> {
    let n = reduced.eigenvalues.len();
    let loaded = Matrix::from_fn(springs.len(), n, |row, mode| {
        reduced.contact[(row, mode)] * springs[row]
    });
    let mut stiffness = reduced.contact.adjoint_times(&loaded);
    for (mode, &eigenvalue) in reduced.eigenvalues.iter().enumerate() {
        stiffness[(mode, mode)] += Complex64::from(eigenvalue);
    }
    hermitian_eigen(&stiffness).unwrap().0
}

#[test]
fn a_basis_holds_the_modes_it_is_made_of() {
    let model = wheel8_sector();
    let reduction = Reduction::new(&model, wheel8_springs(), 25, 0).unwrap();
    let sector = CyclicSector::new(&model);
    let [_, slide, stick] = spring_states(&sector);
    for (choice, states) in [
        (
            BasisChoice::StickSlide { stick: 3, slide: 3 },
            vec![&slide, &stick],
        ),
        (BasisChoice::StickAttachment { stick: 3 }, vec![&stick]),
    ] {
        for (h, whole) in reduction.models().enumerate() {
            let reduced = reduction.nodal_diameter(h, choice).unwrap();
            for springs in &states {
                let (expected, _) = whole.modes(springs).unwrap();
                let found = eigenvalues_with_contact(&reduced, springs);
                for (found, expected) in found.iter().zip(&expected).take(3) {
                    let error = (found - expected).abs() / expected.max(LOW);
                    assert!(error < 1e-9, "{choice} h = {h}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn rank_and_condition_of_every_basis_are_reported() {
    let model = wheel8_sector();
    let reduction = Reduction::new(&model, wheel8_springs(), 25, 0).unwrap();
    let whole = reduction.models().next().unwrap().size();
    for modes in [2, 6, 20, 28] {
        let choice = BasisChoice::StickSlide {
            stick: modes,
            slide: modes,
        };
        let reduced = reduction.reduce(choice, None).unwrap();
        for (line, nd) in reduced.report.iter().zip(&reduced.nodal_diameters) {
            assert_eq!(line.rank, nd.eigenvalues.len());
            assert!(line.candidates >= line.rank && line.rank <= whole.min(2 * modes));
            assert!(
                line.condition >= 1.0 && line.condition < 1e8,
                "{}",
                line.condition
            );
            // Few modes of two kinds are independent; more than the space holds are not.
            assert_eq!(
                line.rank < line.candidates || 2 * modes > whole,
                2 * modes > whole
            );
        }
    }
}

#[test]
fn few_dofs_are_kept_whole_whatever_basis_is_asked_for() {
    let none = ContactStiffness {
        normal_n_per_m: 0.0,
        tangential_1_n_per_m: 8e5,
        tangential_2_n_per_m: 0.0,
    };
    for (options, dofs) in [(lumped24(), 3), (one_dof(24), 1)] {
        let model = lumped::build(&options).unwrap();
        let reduction = Reduction::new(&model, none, 25, 2).unwrap();
        assert!(reduction.is_whole_space());
        let sector = CyclicSector::new(&model);
        let choice = BasisChoice::StickSlide { stick: 1, slide: 1 };
        let reduced = reduction.reduce(choice, None).unwrap();
        assert!(reduced.whole_space);
        for (h, nd) in reduced.nodal_diameters.iter().enumerate() {
            let springs = vec![0.0; sector.contact().row_count()];
            let exact = unreduced(&sector, h, &springs, dofs);
            assert_eq!(nd.eigenvalues.len(), dofs);
            for (found, exact) in nd.eigenvalues.iter().zip(exact) {
                assert!(relative(*found, exact) < 1e-11, "h = {h}");
            }
        }
    }
}

/// The same sector with another diagonal entry of a matrix.
fn with_diagonal(matrix: &SymmetricSparse, dof: usize, entry: f64) -> SymmetricSparse {
    let entries: Vec<_> = matrix
        .lower_entries()
        .map(|(row, column, value)| {
            let changed = (row, column) == (dof, dof);
            (row, column, if changed { entry } else { value })
        })
        .collect();
    SymmetricSparse::from_lower_triplets(matrix.dimension(), &entries)
}

#[test]
fn an_indefinite_mass_or_stiffness_is_refused_with_its_nodal_diameter() {
    let negative = |matrix: &SymmetricSparse| {
        let entry = -0.5 * matrix.diagonal()[100];
        with_diagonal(matrix, 100, entry)
    };
    let sound = wheel8_sector();
    let refusal = |model: SectorModel| {
        Reduction::new(&model, wheel8_springs(), 25, 0)
            .map(|_| ())
            .unwrap_err()
    };
    let heavy = SectorModel {
        mass: negative(&sound.mass),
        ..sound.clone()
    };
    assert!(matches!(
        refusal(heavy),
        ModelError::MassNotPositiveDefinite { nodal_diameter: _ }
    ));
    let soft = SectorModel {
        stiffness: negative(&sound.stiffness),
        ..sound
    };
    assert!(matches!(
        refusal(soft),
        ModelError::StiffnessNotPositiveDefinite { .. }
    ));
}
