use super::support::*;
use blisk::model::reduction::BasisChoice;
use blisk::response::forced_response::*;

#[test]
fn debug_newton() {
    let case = Case::wheel24();
    for choice in [BasisChoice::StickAttachment { stick: 4 }] {
        let model = case.reduce(choice);
        let t = tuned(&model, &[1]);
        for samples in [128, 512] {
        let s = settings(&case, &model, &[1], samples);
        let mut solver = PointSolver::new(&t, ContactCondition::Full { normal_load_n: 320.0 }, &s);
        for f in [550.0, 555., 558., 560., 561., 562., 564., 566., 570.] {
            let w0 = solver.work();
            let r = solver.solve(f).map(|p| (p.amplitudes_m[0], p.shares)).ok();
            let w = solver.work();
            eprintln!("{f:.3} {r:?} it {} retry {}", w.newton_iterations - w0.newton_iterations, w.retries - w0.retries);
        }
        }
    }
}
