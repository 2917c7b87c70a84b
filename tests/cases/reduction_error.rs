//! Indicators of the reduction error, found on one tuned sector, against the true error of mistuned wheels.

use blisk::response::forced_response::ContactCondition;
use blisk::study::Study;
use rayon::prelude::*;

use super::support::{Case, package};

/// A wheel with the loads it is compared under.
struct Wheel {
    name: &'static str,
    model: &'static str,
    tangential_stiffness: f64,
    normal_stiffness: f64,
    friction: f64,
    loads: &'static [f64],
    harmonics: &'static [u32],
    patterns: u32,
}

const WHEELS: [Wheel; 6] = [
    Wheel {
        name: "wheel8",
        model: "source = \"bundle\"\nbundle = { path = \"../tests/data/wheel8\" }",
        tangential_stiffness: 4e8,
        normal_stiffness: 8e8,
        friction: 0.3,
        loads: &[200.0, 400.0, 1600.0],
        harmonics: &[1],
        patterns: 2,
    },
    Wheel {
        name: "wheel8 {1,3}",
        model: "source = \"bundle\"\nbundle = { path = \"../tests/data/wheel8\" }",
        tangential_stiffness: 4e8,
        normal_stiffness: 8e8,
        friction: 0.3,
        loads: &[200.0, 400.0, 1600.0],
        harmonics: &[1, 3],
        patterns: 1,
    },
    Wheel {
        name: "wheel24",
        model: "source = \"bundle\"\nbundle = { path = \"../tests/data/wheel24\" }",
        tangential_stiffness: 1e8,
        normal_stiffness: 2e8,
        friction: 0.3,
        loads: &[160.0, 320.0, 1280.0],
        harmonics: &[1],
        patterns: 1,
    },
    Wheel {
        name: "thin ring",
        model: "source = \"parametric\"\nparametric = { sectors = 12, blade_height_m = 0.1, ring_thickness_m = 0.003, disk_thickness_m = 0.004 }",
        tangential_stiffness: 1e8,
        normal_stiffness: 1e8,
        friction: 0.3,
        loads: &[100.0, 200.0, 800.0],
        harmonics: &[1],
        patterns: 2,
    },
    Wheel {
        name: "thick ring",
        model: "source = \"parametric\"\nparametric = { sectors = 9, blade_height_m = 0.05, ring_thickness_m = 0.009, ring_axial_width_m = 0.010, rim_thickness_m = 0.012 }",
        tangential_stiffness: 5e8,
        normal_stiffness: 5e8,
        friction: 0.3,
        loads: &[200.0, 400.0, 800.0],
        harmonics: &[1],
        patterns: 2,
    },
    Wheel {
        name: "soft contact",
        model: "source = \"parametric\"\nparametric = { sectors = 10, blade_height_m = 0.06, disk_thickness_m = 0.004, rim_thickness_m = 0.012 }",
        tangential_stiffness: 2e7,
        normal_stiffness: 4e7,
        friction: 0.3,
        loads: &[50.0, 100.0, 200.0],
        harmonics: &[1],
        patterns: 2,
    },
];

impl Wheel {
    fn case(&self, reduction: &str, loads: &[f64]) -> Case {
        let Self {
            model,
            tangential_stiffness: kt,
            normal_stiffness: kn,
            friction,
            harmonics,
            ..
        } = self;
        let text = format!(
            r#"schema = 1
study = {{ name = "reduction-error", seed = 20240917, patterns = 10 }}
excitation = {{ engine_orders = [3], amplitude_n = 1.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ distribution = {{ kind = "normal" }} }}
sweep = {{ normal_load_n = {loads:?}, standard_deviation = [0.03] }}

[model]
{model}

[reduction]
{reduction}

[contact]
law = "simplified_3d"
friction_coefficient = {friction}
tangential_stiffness_n_per_m = {kt:e}
normal_stiffness_n_per_m = {kn:e}

[solver]
harmonics = {harmonics:?}
samples_per_period = 256
peak_tolerance = 1e-5
"#
        );
        Case::new(Study::parse(&package("studies/reduction-error.toml"), &text).unwrap())
    }
}

#[test]
#[ignore = "probe"]
fn probe() {
    let loads = [
        25.0, 50.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0, 6400.0,
    ];
    WHEELS.par_iter().for_each(|wheel| {
        let case = wheel.case(
            "basis = \"stick_slide\"\nstick_modes = 6\nslide_modes = 6",
            &loads,
        );
        let mut out = format!("{} pairs {}\n", wheel.name, case.reduction());
        for load in loads {
            let t = case.tuned(ContactCondition::Full {
                normal_load_n: load,
            });
            let p = case.pattern(0, Some(0.03));
            let r = case.row(
                &p,
                ContactCondition::Full {
                    normal_load_n: load,
                },
                &t,
            );
            out += &format!(
                "  {load} {:?} {:?} slip {:?} sep {:?} | {:?} slip {:?} sep {:?} {:?}\n",
                t.amplitude_m,
                t.frequency_hz,
                t.slipping_fraction,
                t.separated_fraction,
                r.peak_amplitude_m,
                r.slipping_fraction,
                r.separated_fraction,
                r.status
            );
        }
        println!("{out}");
    });
}

const BASES: [&str; 7] = [
    "basis = \"stick_slide\"\nstick_modes = 2\nslide_modes = 2",
    "basis = \"stick_slide\"\nstick_modes = 4\nslide_modes = 4",
    "basis = \"stick_slide\"\nstick_modes = 6\nslide_modes = 6",
    "basis = \"stick_slide\"\nstick_modes = 10\nslide_modes = 10",
    "basis = \"stick_attachment\"\nstick_modes = 4",
    "basis = \"stick_attachment\"\nstick_modes = 14",
    "basis = \"auto\"",
];

fn rows(
    wheel: &Wheel,
    reduction: &str,
) -> (Case, Vec<blisk::population::monte_carlo::ResponseRow>) {
    let case = wheel.case(reduction, wheel.loads);
    let jobs: Vec<(u32, f64)> = (0..wheel.patterns)
        .flat_map(|p| wheel.loads.iter().map(move |&l| (p, l)))
        .collect();
    let rows = jobs
        .par_iter()
        .map(|&(id, normal_load_n)| {
            let contact = ContactCondition::Full { normal_load_n };
            case.row(&case.pattern(id, Some(0.03)), contact, &case.tuned(contact))
        })
        .collect();
    (case, rows)
}

#[test]
#[ignore = "table"]
fn table() {
    for wheel in &WHEELS {
        let modes = if wheel.name == "wheel24" { 10 } else { 200 };
        let (case, reference) = rows(
            wheel,
            &format!("basis = \"stick_attachment\"\nstick_modes = {modes}"),
        );
        println!(
            "{} reference {} reach {}",
            wheel.name,
            case.basis(),
            case.reduction()["craig_bampton_reach"]
        );
        let more = wheel.case(
            "craig_bampton_modes = 38\nbasis = \"stick_attachment\"\nstick_modes = 200",
            wheel.loads,
        );
        for &normal_load_n in wheel.loads {
            let c = ContactCondition::Full { normal_load_n };
            println!(
                "   38 modes: {:.5} %",
                100.0
                    * (case.tuned(c).amplitude_m.unwrap() / more.tuned(c).amplitude_m.unwrap()
                        - 1.0)
            );
        }
        for row in &reference {
            println!(
                "   {:?} {:?} sep {:?}",
                row.peak_amplitude_m, row.peak_frequency_hz, row.separated_fraction
            );
        }
        for basis in BASES {
            let (case, own) = rows(wheel, basis);
            let facts = case.reduction();
            let facts = facts["tuned_peak_errors"]
                .as_array()
                .unwrap()
                .last()
                .unwrap();
            let worst = |value: fn(&blisk::population::monte_carlo::ResponseRow) -> f64| {
                own.iter()
                    .zip(&reference)
                    .map(|(a, b)| (value(a) / value(b) - 1.0).abs())
                    .fold(0.0, f64::max)
            };
            let percent = |v: &serde_json::Value| 100.0 * v.as_f64().unwrap();
            let cd = &facts["contact_displacement"];
            println!(
                "{:24} {:20} tuned {:.4} own {:.4} (k {} h {} N0 {}) any {:.4} (k {} h {} N0 {}) mistuned {:.4} frequency {:.5}",
                wheel.name,
                facts["basis"],
                percent(&facts["error"]),
                percent(&cd["tuned"]["error"]),
                cd["tuned"]["harmonic"],
                cd["tuned"]["nodal_diameter"],
                cd["tuned"]["normal_load_n"],
                percent(&cd["mistuned"]["error"]),
                cd["mistuned"]["harmonic"],
                cd["mistuned"]["nodal_diameter"],
                cd["mistuned"]["normal_load_n"],
                100.0 * worst(|r| r.peak_amplitude_m.unwrap_or(f64::NAN)),
                100.0 * worst(|r| r.peak_frequency_hz.unwrap_or(f64::NAN))
            );
        }
    }
}
