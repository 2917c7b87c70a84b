//! Finite elements, eight blades: harmonic balance with converged harmonics against time integration
//! on the same reduced model.

use std::sync::Arc;

use blisk::linalg::Matrix;
use blisk::model::reduction::BasisChoice;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::WheelBasis;
use blisk::response::time_integration::{PointCase, PointComparison, TimeOptions, compare_point};

use super::super::wheels::{ENGINE_ORDER, Wheel, wheel8_contact, wheel8_sector};
use super::deviations;

fn wheel() -> Wheel {
    Wheel::of(
        &wheel8_sector(),
        ContactLaw::Simplified3d,
        wheel8_contact(),
        Damping::StructuralLossFactor(0.002),
        BasisChoice::StickAttachment { stick: 4 },
    )
}

fn compare(
    load: f64,
    mistuned: bool,
    frequency_hz: f64,
    harmonics: &[u32],
    options: &TimeOptions,
) -> Result<PointComparison, Status> {
    let wheel = wheel();
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let change: Option<Matrix<f64>> = mistuned.then(|| {
        basis.blade_stiffness_change(&deviations("wheel8/reference", "patterns.csv", 1, 8))
    });
    let solver = SolverOptions {
        samples_per_period: 512,
        ..SolverOptions::default()
    };
    let case = PointCase {
        basis: &basis,
        stiffness_change: change.as_ref(),
        damping: wheel.damping,
        engine_order: ENGINE_ORDER,
        amplitude_n: 1.0,
        law: wheel.law,
        sector: PairParameters {
            normal_load_n: load,
            ..wheel.sector
        },
        harmonics,
        solver: &solver,
        frequency_hz,
    };
    compare_point(&case, options)
}

#[test]
fn scratch() {
    let load: f64 = std::env::var("LOAD").unwrap().parse().unwrap();
    let f: f64 = std::env::var("FREQ").unwrap().parse().unwrap();
    let top: u32 = std::env::var("TOP").unwrap().parse().unwrap();
    let first: u32 = std::env::var("FIRST").unwrap().parse().unwrap();
    let mistuned = std::env::var("MIST").is_ok();
    let harmonics: Vec<u32> = (first..=top).collect();
    let found = compare(
        load,
        mistuned,
        f,
        &harmonics,
        &TimeOptions {
            steps_per_period: std::env::var("STEPS").unwrap().parse().unwrap(),
            maximum_periods: std::env::var("MAXP").unwrap().parse().unwrap(),
            ..TimeOptions::default()
        },
    );
    match found {
        Err(status) => println!("HB: {status:?}"),
        Ok(found) => println!(
            "{load} {f} {first}..{top} {mistuned}: HB {:?}\n time {:?}\n mean {:?}\n {:.2e} {:.2e} {:?} {:?} blade {:.1e} force {:.1e} drift {:.1e} creep {:e} {:?} it {}",
            found.harmonic_balance_m,
            found.time_m,
            found.settled.mean_fundamental_m,
            found.largest_difference(),
            found.blade_difference(),
            found.status,
            found.steps,
            found.settled.blade_change,
            found.settled.force_change,
            found.settled.drift,
            found.settled.creep_m,
            found.settled.shares,
            found.settled.contact_iterations
        ),
    }
}

#[test]
fn scratch_dump() {
    use blisk::response::forced_response::*;
    use blisk::response::harmonic_balance::ContactInterface;
    use blisk::response::mistuning::StructuralModes;
    use blisk::response::time_integration::*;
    use std::io::Write;
    let env = |n: &str| std::env::var(n).unwrap().parse::<f64>().unwrap();
    let (load, f, top, first) = (
        env("LOAD"),
        env("FREQ"),
        env("TOP") as u32,
        env("FIRST") as u32,
    );
    let (steps, periods) = (env("STEPS") as usize, env("PERIODS") as usize);
    let harmonics: Vec<u32> = (first..=top).collect();
    let mut wheel = wheel();
    if let Ok(pin) = std::env::var("PIN") {
        let pin: f64 = pin.parse().unwrap();
        let mut model = (*wheel.model).clone();
        for l in &mut model.nodal_diameters[0].eigenvalues {
            if *l < 2000.0 {
                *l = (std::f64::consts::TAU * pin).powi(2);
            }
        }
        wheel.model = Arc::new(model);
    }
    if let Ok(eta) = std::env::var("ETA") {
        wheel.damping = Damping::StructuralLossFactor(eta.parse().unwrap());
    }
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let omega = std::f64::consts::TAU * f;
    let modes =
        StructuralModes::of_wheel(&basis, &Matrix::zeros(basis.size(), basis.size())).unwrap();
    let all: Vec<f64> = modes
        .eigenvalues
        .iter()
        .map(|l| l.max(0.0).sqrt() / std::f64::consts::TAU)
        .collect();
    println!(
        "{} modes {:?} .. {:?}",
        all.len(),
        &all[..40],
        &all[all.len() - 8..]
    );
    let force = wheel_force(&basis, &modes, 3, 1.0);
    let w = blisk::response::forced_response::Wheel::mistuned(
        modes.clone(),
        basis.model(),
        wheel.damping,
        LimitsWanted::default(),
    );
    let excited = Excited::wheel(&w, force, &harmonics).with_viscous_damping(omega);
    let waves = Excited::tuned(
        &wheel.model,
        3,
        1.0,
        wheel.damping,
        &harmonics,
        LimitsWanted::default(),
    )
    .with_viscous_damping(omega);
    let sector = PairParameters {
        normal_load_n: load,
        ..wheel.sector
    };
    let settings = PointSettings::new(
        &SolverOptions {
            samples_per_period: 512,
            ..SolverOptions::default()
        },
        &harmonics,
        Some((wheel.law, sector)),
        wheel.model.contact.clone(),
    )
    .unwrap();
    let mut ps = PointSolver::new(
        &waves,
        ContactCondition::Full {
            normal_load_n: load,
        },
        &settings,
    );
    let point = ps.solve(f).unwrap().clone();
    println!("HB {:?} slip {:?}", point.amplitudes_m, point.shares);
    if std::env::var("HBONLY").is_ok() {
        return;
    }
    let motion = Motion::of_waves(&basis, &modes, 3, &waves, &point);
    let interface = ContactInterface {
        law: wheel.law,
        geometry: wheel.model.contact.clone(),
        pairs: wheel
            .model
            .contact
            .weights
            .iter()
            .map(|&x| sector.share(x))
            .collect(),
    };
    let marched = MarchedWheel {
        structure: &excited.linear.structure,
        interface: &interface,
        force: &excited.force,
        omega,
    };
    let start = motion.start(&marched, steps);
    println!("balance {:?}", &start.balance_n[..12]);
    let mut st = TimeStepper::new(&marched, &start, steps).unwrap();
    let mut out =
        std::io::BufWriter::new(std::fs::File::create(std::env::var("OUT").unwrap()).unwrap());
    let every = std::env::var("EVERY").map_or(steps, |e| e.parse().unwrap());
    for step in 0..steps * periods {
        st.advance().unwrap();
        if (step + 1) % every == 0 {
            let obs = excited
                .linear
                .structure
                .observed()
                .real
                .times_vector(st.position());
            let line: Vec<String> = obs
                .iter()
                .chain(st.contact_displacement_m())
                .chain(st.contact_force_n())
                .map(|x| format!("{x:e}"))
                .collect();
            writeln!(out, "{}", line.join(",")).unwrap();
        }
    }
}
