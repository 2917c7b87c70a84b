//! How well the ring works by nodal diameter.

use blisk::population::monte_carlo::TunedReference;
use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::settings::{Engine, EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model};
use rayon::prelude::*;

use super::super::support::package;
use super::report::{Section, Verdict, table};

/// The tuned wheel under one engine order, over all loads.
struct Diameter {
    wheel: &'static str,
    engine_order: u32,
    slide_m: f64,
    stuck_m: f64,
    lowest_m: f64,
    load_n: f64,
    separated: f64,
}

impl Diameter {
    /// How far the ring brings the peak down.
    fn effect(&self) -> f64 {
        self.slide_m / self.lowest_m
    }

    fn cells(&self) -> Vec<String> {
        vec![
            self.wheel.to_owned(),
            self.engine_order.to_string(),
            format!("{:.2}", 1e6 * self.slide_m),
            format!("{:.2}", 1e6 * self.stuck_m),
            format!("{:.2}", 1e6 * self.lowest_m),
            format!("{}", self.load_n),
            format!("{:.2}", self.effect()),
            format!("{:.2}", self.separated),
        ]
    }
}

/// Normal loads over amplitude of the excitation, N per N.
const LOADS: [f64; 13] = [
    5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 240.0, 320.0, 480.0, 800.0, 1600.0, 3200.0, 6400.0,
];

pub fn section() -> Section {
    let wheels: Vec<Vec<Diameter>> = [
        ("built-in", "studies/validation/nodal-diameters.toml"),
        ("wheel24", "studies/validation/wheel24.toml"),
        ("wheel8", "studies/validation/wheel8.toml"),
        ("lumped24", "studies/lumped24.toml"),
    ]
    .into_par_iter()
    .with_max_len(1)
    .map(|(wheel, file)| of_wheel(wheel, file))
    .collect();
    let cells: Vec<Vec<String>> = wheels.iter().flatten().map(Diameter::cells).collect();
    let header = [
        "wheel",
        "nodal diameter",
        "slide, µm",
        "stuck, µm",
        "lowest over loads, µm",
        "at, N",
        "slide over lowest",
        "separated there",
    ];
    Section {
        compared: format!(
            "Tuned wheels, harmonic 1, engine order equal to the nodal diameter; the lowest of the tuned peaks over {} normal loads from {} to {} N per \
             N of excitation. The effect of the ring is the peak of the sliding wheel over that lowest one. Where pairs separate at the lowest peak \
             one harmonic is too few, and the row shows a tendency only. The disks of solid elements stiffen with the nodal diameter until blades alone \
             move; that of lumped24 is held by springs to the ground and hardly stiffens, while its ring does.",
            LOADS.len(),
            LOADS[0],
            LOADS[LOADS.len() - 1]
        ),
        body: table(&header, &cells),
        verdicts: wheels.iter().map(|wheel| claim(wheel)).collect(),
    }
}

/// That the ring works best in the low nodal diameters.
fn claim(wheel: &[Diameter]) -> Verdict {
    let best = wheel
        .iter()
        .max_by(|a, b| a.effect().total_cmp(&b.effect()))
        .unwrap();
    let half = wheel.len() / 2;
    let mean =
        |part: &[Diameter]| part.iter().map(Diameter::effect).sum::<f64>() / part.len() as f64;
    let (low, high) = (mean(&wheel[..half]), mean(&wheel[half..]));
    let correlation = rank_correlation(wheel);
    Verdict::claim(
        wheel[0].wheel,
        format!(
            "{}: the ring damps the low nodal diameters most (mean effect of the lower half {low:.2}, of the upper half {high:.2}; greatest in nodal \
             diameter {}; rank correlation with the nodal diameter {correlation:+.2})",
            wheel[0].wheel, best.engine_order
        ),
        low > high && best.engine_order as usize <= half,
    )
}

/// Spearman's rank correlation of the effect with the nodal diameter, which ascends.
fn rank_correlation(wheel: &[Diameter]) -> f64 {
    let n = wheel.len() as f64;
    let rank = |own: &Diameter| {
        let below = wheel.iter().filter(|other| other.effect() < own.effect());
        below.count() as f64
    };
    let squares: f64 = wheel
        .iter()
        .enumerate()
        .map(|(at, diameter)| (rank(diameter) - at as f64).powi(2))
        .sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}

fn of_wheel(wheel: &'static str, file: &str) -> Vec<Diameter> {
    let mut study = Study::read(&package(file)).unwrap();
    let model = load_sector_model(&study).unwrap();
    study.engine_orders = (1..=model.sectors as u32 / 2).collect();
    study.standard_deviations.truncate(1);
    study.solver.harmonics = Harmonics::Set(vec![1]);
    study.solver.samples_per_period = 128;
    study.solver.peak_tolerance = 1e-3;
    study.contacts = LOADS
        .iter()
        .map(|load| ContactCondition::Full {
            normal_load_n: load * study.amplitude_n,
        })
        .chain([ContactCondition::Slide, ContactCondition::Stuck])
        .collect();
    let engine = ReducedEngineSource.build(&study, &model, None).unwrap();
    study
        .engine_orders
        .par_iter()
        .with_max_len(1)
        .map(|&engine_order| diameter(wheel, &study, engine.as_ref(), engine_order))
        .collect()
}

fn diameter(
    wheel: &'static str,
    study: &Study,
    engine: &dyn Engine,
    engine_order: u32,
) -> Diameter {
    let tuned: Vec<(ContactCondition, TunedReference)> = study
        .scenarios()
        .into_par_iter()
        .filter(|scenario| scenario.engine_order == engine_order)
        .map(|scenario| (scenario.contact, engine.tuned(&scenario)))
        .collect();
    let of = |wanted: ContactCondition| {
        let found = tuned.iter().find(|(contact, _)| *contact == wanted);
        found.and_then(|(_, tuned)| tuned.amplitude_m).unwrap()
    };
    let lowest = tuned
        .iter()
        .filter_map(|(contact, tuned)| Some((contact.normal_load_n()?, tuned.amplitude_m?, tuned)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let (load_n, lowest_m, at) = lowest.unwrap();
    Diameter {
        wheel,
        engine_order,
        slide_m: of(ContactCondition::Slide),
        stuck_m: of(ContactCondition::Stuck),
        lowest_m,
        load_n,
        separated: at.separated_fraction.unwrap_or(0.0),
    }
}
