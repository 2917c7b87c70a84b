//! Mistuning in reduced coordinates against the assembled wheel, and component mode mistuning.

use std::sync::Arc;

use blisk::linalg::{Matrix, SymmetricSparse, hermitian_pencil};
use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, Reduction};
use blisk::model::sector::{LumpedOptions, SectorModel, lumped};
use blisk::population::monte_carlo::{RowSettings, RowSolver};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, Ring};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::{
    ContactFactors, Deviations, Pattern, Projection, StructuralModes, WheelBasis,
};

use super::contact::random::Random;
use super::sector_sources::lumped::{lumped24, one_dof, wheel};
use super::wheels::{
    ENGINE_ORDER, pattern, relative, scenario, solve_row, springs, wheel8_contact, wheel8_sector,
};

fn wheel8(choice: BasisChoice, fixed_modes: usize, sensitivity: usize) -> Arc<ReducedModel> {
    reduce(&wheel8_sector(), choice, fixed_modes, sensitivity, None)
}

fn reduce(
    sector: &SectorModel,
    choice: BasisChoice,
    fixed_modes: usize,
    sensitivity: usize,
    cantilever_modes: Option<usize>,
) -> Arc<ReducedModel> {
    let stiffness = springs(ContactLaw::Simplified3d, wheel8_contact());
    let reduction = Reduction::new(sector, stiffness, fixed_modes, sensitivity).unwrap();
    Arc::new(reduction.reduce(choice, cantilever_modes).unwrap())
}

fn eigenvalues(basis: &WheelBasis, change: &Matrix<f64>) -> Vec<f64> {
    StructuralModes::of_wheel(basis, change)
        .unwrap()
        .eigenvalues
}

fn dense(matrix: &SymmetricSparse) -> Matrix<f64> {
    let mut dense = Matrix::zeros(matrix.dimension(), matrix.dimension());
    for (row, column, value) in matrix.entries() {
        dense[(row, column)] += value;
    }
    dense
}

/// Eigenvalues of the wheel assembled sector by sector, each blade with its own stiffness.
fn assembled_eigenvalues(model: &SectorModel, deviations: &[f64]) -> Vec<f64> {
    let per_sector = model.dofs.len() - model.cyclic_pairs.len();
    let mut stiffness = dense(&wheel(model, &model.stiffness, per_sector));
    let mass = dense(&wheel(model, &model.mass, per_sector));
    for (sector, deviation) in deviations.iter().enumerate() {
        for (row, column, value) in model.blade_stiffness.entries() {
            let at = |dof| sector * per_sector + dof;
            stiffness[(at(row), at(column))] += deviation * value;
        }
    }
    hermitian_pencil(&stiffness, &mass).unwrap().0
}

#[test]
fn exact_projection_has_the_eigenvalues_of_the_assembled_wheel() {
    let mut random = Random(51);
    for options in [
        lumped24(),
        one_dof(24),
        one_dof(7),
        LumpedOptions {
            sectors: 5,
            ..lumped24()
        },
    ] {
        let model = lumped::build(&options).unwrap();
        let basis = WheelBasis::new(reduce(&model, BasisChoice::CraigBampton, 25, 0, None));
        for size in [0.01, 0.3] {
            let deviations = random.vector(options.sectors, size);
            let exact = assembled_eigenvalues(&model, &deviations);
            let found = eigenvalues(&basis, &basis.blade_stiffness_change(&deviations));
            assert_eq!(found.len(), exact.len());
            for (found, exact) in found.iter().zip(&exact) {
                assert!(relative(*found, *exact) < 1e-10, "{found} {exact}");
            }
        }
    }
}

#[test]
fn blades_on_a_rigid_disk_follow_the_root_of_their_stiffness() {
    let options = LumpedOptions {
        blade_coupling_stiffness_n_per_m: 0.0,
        ..one_dof(6)
    };
    let model = lumped::build(&options).unwrap();
    let basis = WheelBasis::new(reduce(&model, BasisChoice::CraigBampton, 25, 0, Some(1)));
    for change in [
        basis.blade_stiffness_change(&[0.2; 6]),
        basis.cantilever_stiffness_change(|_, _| 0.2).unwrap(),
    ] {
        for (mistuned, tuned) in eigenvalues(&basis, &change).iter().zip(basis.eigenvalues()) {
            assert!(relative((mistuned / tuned).sqrt(), 1.2_f64.sqrt()) < 1e-13);
        }
    }
}

fn largest_difference(a: &Matrix<f64>, b: &Matrix<f64>) -> f64 {
    let size = |m: &Matrix<f64>| m.as_slice().iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    let mut difference = a.clone();
    for (entry, other) in difference.as_mut_slice().iter_mut().zip(b.as_slice()) {
        *entry -= other;
    }
    size(&difference) / size(a)
}

#[test]
fn all_cantilever_modes_of_a_blade_on_a_rigid_root_are_the_exact_projection() {
    let mut random = Random(52);
    let model = lumped::build(&lumped24()).unwrap();
    let basis = WheelBasis::new(reduce(&model, BasisChoice::CraigBampton, 25, 0, Some(9)));
    let deviations = random.vector(24, 0.1);
    let exact = basis.blade_stiffness_change(&deviations);
    let through_modes = basis
        .cantilever_stiffness_change(|blade, _| deviations[blade])
        .unwrap();
    let error = largest_difference(&exact, &through_modes);
    assert!(error < 1e-12, "{error:e}");
}

#[test]
fn cantilever_modes_approach_the_exact_projection_up_to_the_strain_of_the_root() {
    let choice = BasisChoice::StickSlide { stick: 4, slide: 4 };
    let trace = |change: &Matrix<f64>| (0..change.rows()).map(|i| change[(i, i)]).sum::<f64>();
    let share = |modes| {
        let basis = WheelBasis::new(reduce(&wheel8_sector(), choice, 25, 0, Some(modes)));
        let through_modes = basis.cantilever_stiffness_change(|_, _| 1.0).unwrap();
        trace(&through_modes) / trace(&basis.blade_stiffness_change(&[1.0; 8]))
    };
    let shares = [1, 3, 10, 30].map(share);
    println!(
        "share of the blade's strain energy seen by 1, 3, 10, 30 cantilever modes: {shares:.4?}"
    );
    assert!(
        shares
            .windows(2)
            .all(|pair| pair[0] <= pair[1] * (1.0 + 1e-12)),
        "{shares:?}"
    );
    assert!(
        shares[3] < 1.0 && shares[3] - shares[2] < 0.002,
        "{shares:?}"
    );
}

#[test]
fn eigenvalues_fall_towards_the_exact_ones_as_the_basis_grows() {
    let deviations = Random(53).vector(8, 0.2);
    let lowest = |choice| {
        let basis = WheelBasis::new(wheel8(choice, 25, 0));
        let values = eigenvalues(&basis, &basis.blade_stiffness_change(&deviations));
        values[..20].to_vec()
    };
    let stick_slide = |modes| BasisChoice::StickSlide {
        stick: modes,
        slide: modes,
    };
    let nested = [
        stick_slide(3),
        stick_slide(5),
        stick_slide(8),
        BasisChoice::CraigBampton,
    ];
    let values = nested.map(lowest);
    for pair in values.windows(2) {
        for (coarse, fine) in pair[0].iter().zip(&pair[1]) {
            // Rounding is that of the highest eigenvalues, which the sliding ring's 987 feel.
            assert!(*fine <= coarse * (1.0 + 1e-10) + 1e-3, "{coarse} {fine}");
        }
    }
}

fn solver(model: &Arc<ReducedModel>, projection: Projection) -> RowSolver {
    let settings = RowSettings {
        harmonics: vec![1],
        contact: Some((ContactLaw::Simplified3d, wheel8_contact())),
        ring: Ring::Locked,
        damping: Damping::StructuralLossFactor(0.002),
        amplitude_n: 1.0,
        projection,
        solver: SolverOptions::default(),
    };
    RowSolver::new(Arc::clone(model), settings).unwrap()
}

fn stuck_peak(model: &Arc<ReducedModel>, projection: Projection, pattern: &Pattern) -> f64 {
    let row = solve_row(&solver(model, projection), pattern, ContactCondition::Stuck).1;
    assert_eq!(row.status, Status::Ok);
    row.peak_amplitude_m.unwrap()
}

/// Amplitude of every blade round the first peak, stuck.
fn stuck_curve(model: &Arc<ReducedModel>, pattern: &Pattern) -> Vec<f64> {
    let frequencies: Vec<f64> = (550..680).map(f64::from).collect();
    let solver = solver(model, Projection::Exact);
    let curve = solver.curve(
        ENGINE_ORDER,
        ContactCondition::Stuck,
        Some(pattern),
        &frequencies,
    );
    let points = curve.unwrap().into_iter();
    points.flat_map(|(_, blades)| blades.unwrap()).collect()
}

/// Errors of peak and curve against a reference, the latter relative to its largest value.
fn stuck_errors(
    model: &Arc<ReducedModel>,
    pattern: &Pattern,
    (peak, curve): &(f64, Vec<f64>),
) -> [f64; 2] {
    let largest = curve.iter().copied().fold(0.0, f64::max);
    let off = stuck_curve(model, pattern)
        .iter()
        .zip(curve)
        .map(|(found, expected)| (found - expected).abs() / largest)
        .fold(0.0, f64::max);
    let found = stuck_peak(model, Projection::Exact, pattern);
    [relative(found, *peak), off]
}

#[test]
fn sensitivity_vectors_keep_large_mistuning_accurate() {
    let mut random = Random(54);
    let patterns: Vec<Pattern> = (0..3)
        .map(|_| pattern(&random.vector(8, 0.2 * 3.0_f64.sqrt())))
        .collect();
    let whole = wheel8(BasisChoice::CraigBampton, 25, 4);
    let reference: Vec<(f64, Vec<f64>)> = patterns
        .iter()
        .map(|pattern| {
            let peak = stuck_peak(&whole, Projection::Exact, pattern);
            (peak, stuck_curve(&whole, pattern))
        })
        .collect();
    for choice in [
        BasisChoice::StickAttachment { stick: 4 },
        BasisChoice::StickSlide { stick: 2, slide: 2 },
    ] {
        let [without, with] = [0, 2].map(|sensitivity| {
            let model = wheel8(choice, 25, sensitivity);
            let rows = patterns.iter().zip(&reference);
            rows.map(|(pattern, reference)| stuck_errors(&model, pattern, reference))
                .fold([0.0_f64; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
        });
        println!("{choice}, 20 %, peak and curve: {without:.4?}, with two vectors {with:.4?}");
        assert!(with[0] < 0.004, "{choice}: {with:?}");
        assert!(
            with[0] < 0.2 * without[0] && with[1] < 0.2 * without[1],
            "{choice}"
        );
    }
}

/// One deviation per blade and mode.
fn per_mode(modes: &[u32], deviation: impl Fn(usize, u32) -> f64) -> Pattern {
    let values = (0..8).flat_map(|blade| modes.iter().map(move |&mode| (blade, mode)));
    Pattern {
        id: 0,
        deviations: Deviations::PerMode {
            modes: modes.to_vec(),
            values: values.map(|(blade, mode)| deviation(blade, mode)).collect(),
        },
        contact: ContactFactors::default(),
    }
}

#[test]
fn a_deviation_of_every_mode_is_one_of_the_blade() {
    let deviations = Random(55).vector(8, 0.05);
    let choice = BasisChoice::StickSlide { stick: 4, slide: 4 };
    let model = reduce(&wheel8_sector(), choice, 25, 0, Some(3));
    let of_blade = stuck_peak(&model, Projection::CantileverModes, &pattern(&deviations));
    let every_mode = per_mode(&[0, 1, 2], |blade, _| deviations[blade]);
    let of_modes = stuck_peak(&model, Projection::Exact, &every_mode);
    assert!(relative(of_modes, of_blade) < 1e-12);
    // The first bending mode rules the first peak: a deviation of the third alone hardly moves it.
    let tuned = stuck_peak(&model, Projection::Exact, &pattern(&[0.0; 8]));
    let first = per_mode(&[0], |blade, _| deviations[blade]);
    let third = per_mode(&[2], |blade, _| deviations[blade]);
    let [first, third] = [first, third].map(|p| stuck_peak(&model, Projection::Exact, &p));
    assert!(relative(first, of_blade) < 0.1 * relative(tuned, of_blade));
    assert!(relative(third, tuned) < 0.1 * relative(of_blade, tuned));
}

#[test]
fn a_blade_without_stiffness_is_an_invalid_pattern() {
    let model = wheel8(BasisChoice::StickSlide { stick: 2, slide: 2 }, 25, 0);
    let solver = solver(&model, Projection::Exact);
    let scenario = scenario(ContactCondition::Stuck);
    let tuned = solver.tuned(&scenario);
    for deviation in [-1.0, -1.5, f64::NAN, f64::INFINITY] {
        let mut deviations = [0.0; 8];
        deviations[5] = deviation;
        let row = solver
            .rows(&pattern(&deviations), &[(&scenario, &tuned)])
            .remove(0);
        assert_eq!(
            (row.status, row.peak_amplitude_m),
            (Status::InvalidPattern, None)
        );
    }
}
