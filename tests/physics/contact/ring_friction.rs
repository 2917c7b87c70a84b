//! Mean friction on the ring: per row, and its sign.

use super::super::wheels::{ENGINE_ORDER, Wheel, full, pattern, relative, solve_row};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::ContactLaw;

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
