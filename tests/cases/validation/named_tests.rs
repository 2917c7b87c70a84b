//! The oracles that a test holds and no number of this report shows.

use std::path::{Path, PathBuf};

use super::super::support::package;
use super::report::{Section, Verdict, table};

/// What is held, and by which test.
const HELD: [(&str, &str); 30] = [
    (
        "loop of a Jenkins element, point by point",
        "loop_is_exact_point_by_point",
    ),
    ("the same, marched in time", "a_jenkins_loop_point_by_point"),
    (
        "slip starts at the same amplitude whatever the normal motion",
        "slip_starts_at_the_same_amplitude_whatever_the_normal_motion",
    ),
    (
        "transition criteria of Yang, Chu and Menq",
        "transitions_along_one_tangent_are_those_of_yang_chu_and_menq",
    ),
    (
        "the same in the plane",
        "transitions_in_the_plane_are_those_along_the_force",
    ),
    (
        "circular motion under coulomb_3d",
        "circular_motion_has_a_force_of_constant_size_and_known_lead",
    ),
    (
        "coulomb_3d along one tangent is simplified_3d",
        "motion_along_one_tangent_is_that_of_simplified_3d",
    ),
    (
        "periodic state of a slider, by marching",
        "periodic_state_is_where_many_marched_periods_end",
    ),
    (
        "sampling error of second order",
        "sampling_error_falls_with_the_square_of_the_number_of_samples",
    ),
    (
        "derivative of a pair, by differences",
        "jacobian_is_the_difference_quotient_away_from_kinks",
    ),
    (
        "energy balance",
        "what_the_excitation_puts_in_is_dissipated",
    ),
    (
        "resonance above 4 mu N / pi unbounded",
        "friction_alone_does_not_bound_the_resonance_if_the_force_is_above_4_mu_n_over_pi",
    ),
    (
        "constant load of zero is no ring",
        "constant_load_of_zero_is_no_ring",
    ),
    ("Den Hartog, marched in time", "den_hartog_without_stops"),
    (
        "tuned sector is the tuned wheel, every blade in phase",
        "every_blade_of_a_tuned_wheel_follows_the_last_at_the_phase_of_its_harmonic",
    ),
    (
        "mirrored wheel answers the mirrored engine order",
        "a_mirrored_wheel_answers_the_mirrored_engine_order",
    ),
    (
        "orientation of repeated modes",
        "the_orientation_of_degenerate_modes_does_not_matter",
    ),
    (
        "eigenvalues of the assembled mistuned wheel",
        "exact_projection_has_the_eigenvalues_of_the_assembled_wheel",
    ),
    (
        "rigid disk: frequencies follow the root of the stiffness",
        "blades_on_a_rigid_disk_follow_the_root_of_their_stiffness",
    ),
    (
        "all cantilever modes are the exact projection",
        "all_cantilever_modes_of_a_blade_on_a_rigid_root_are_the_exact_projection",
    ),
    (
        "eigenvalues from above as the basis grows",
        "eigenvalues_fall_towards_the_exact_ones_as_the_basis_grows",
    ),
    (
        "condition of the joint stick and slide basis",
        "the_condition_of_the_joint_basis_is_that_of_the_table",
    ),
    (
        "a quarter of a half-bandwidth reads 0.992 of a peak",
        "a_grid_of_a_quarter_half_bandwidth_reads_at_least_0_992_of_a_peak",
    ),
    (
        "Whitehead's bound: known values",
        "the_bound_has_its_known_values",
    ),
    (
        "Whitehead's bound on 10,000 random systems",
        "no_blade_exceeds_whiteheads_bound_on_ten_thousand_random_systems",
    ),
    (
        "statistics of 20,000 patterns at six standard deviations",
        "twenty_thousand_patterns_have_the_known_statistics",
    ),
    (
        "lumped24 by another code, harmonics 1 and 3",
        "two_harmonics_and_128_samples_meet_the_reference_to_a_millionth",
    ),
    (
        "lumped24 by another code, harmonics to 15",
        "eight_odd_harmonics_meet_the_physical_answer",
    ),
    (
        "folds of an opening contact in closed form",
        "both_folds_of_an_opening_contact_are_found_where_the_closed_form_has_them",
    ),
    (
        "ranks of order statistics, published table",
        "ranks_are_those_of_the_published_table",
    ),
];

pub fn section() -> Section {
    let found: Vec<bool> = HELD.iter().map(|(_, test)| is_a_test(test)).collect();
    let cells: Vec<Vec<String>> = HELD
        .iter()
        .map(|(what, test)| vec![(*what).to_owned(), format!("`{test}`")])
        .collect();
    Section {
        compared: "Exact properties whose test runs with `cargo test --release` and is not repeated here; that a test of this name exists is checked."
            .to_owned(),
        body: table(&["oracle", "test"], &cells),
        verdicts: vec![Verdict::share("tests-exist", "tests that exist", found, 1.0)],
    }
}

/// Panics unless there is a test of this name.
pub fn assert_is_a_test(name: &str) {
    assert!(is_a_test(name), "no test is called {name}");
}

fn is_a_test(name: &str) -> bool {
    let line = format!("fn {name}() {{");
    sources(&package("tests"))
        .iter()
        .any(|path| std::fs::read_to_string(path).unwrap().contains(&line))
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                sources(&path)
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                vec![path]
            } else {
                Vec::new()
            }
        })
        .collect()
}
