//! The wheels, loads and patterns of the truth: drawn once by a seed, kept in `tests/data/truth/NAME/`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use blisk::model::sector::SectorModel;
use blisk::study::{Study, load_sector_model};

use super::contact::Law;
use super::iteration::{Case, Contact};

/// Of everything that is drawn.
const SEED: u64 = 20_261_123;
/// Patterns of a wheel: each is one row with friction and one without.
pub const PATTERNS: usize = 70;
/// Loads of a wheel; pattern i has load i modulo this number.
pub const LOADS: usize = 10;
/// Loads relative to the one under which every pair of the tuned wheel sticks at its stuck peak ([`HELD`]): one is drawn from each
/// tenth of the way between them, on a logarithmic scale. Below a twentieth pairs separate.
const LOADS_OF_STICKING: [f64; 2] = [0.01, 0.9];
/// Standard deviations of the blades' stiffness, drawn alike.
const STANDARD_DEVIATIONS: [f64; 3] = [0.01, 0.03, 0.06];

pub const WHEELS: [&str; 11] = [
    "wheel8",
    "wheel24",
    "built-in",
    "odd",
    "half",
    "heavy-ring",
    "wedges",
    "shrouds",
    "ground",
    "sliding-shrouds",
    "cylinders",
];
/// Those of them with another damper than a ring.
pub const OTHER_DAMPERS: [&str; 5] = [
    "wedges",
    "shrouds",
    "ground",
    "sliding-shrouds",
    "cylinders",
];
/// Those of them whose loads are relative to the one under which no pair slips or opens, in the place of that under which the normal load
/// would hold every pair if it stayed the same. At the angles of "shrouds" tips press on each other far more than they slide, so that nine
/// pairs of ten open under all of its loads.
pub const HELD: [&str; 2] = ["sliding-shrouds", "cylinders"];

const WEDGE: &str = r#"damper = "underplatform""#;
const CYLINDER: &str = r#"damper = "underplatform", damper_shape = "cylinder""#;
const SHROUD: &str = r#"damper = "shroud""#;
const GROUND: &str = r#"damper = "blade_to_ground""#;

/// Numbers without pattern (Steele et al. 2014, `splitmix64`).
struct Numbers(u64);

impl Numbers {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.between(0.0, choices.len() as f64) as usize]
    }

    /// Of mean 0 and standard deviation 1 (Box and Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.between(f64::MIN_POSITIVE, 1.0).ln()).sqrt();
        radius * self.between(0.0, std::f64::consts::TAU).cos()
    }
}

pub fn folder(wheel: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/truth")
        .join(wheel)
}

/// The study of a wheel: physics alone.
fn study_text(wheel: &str, numbers: &mut Numbers) -> String {
    let digits = |value: f64| format!("{value:.3e}").parse::<f64>().expect("a number");
    let mut parametric = |sectors: u32, ring: [f64; 2], disk: [f64; 2]| {
        let thickness = digits(0.005 * numbers.between(ring[0], ring[1]));
        format!(
            "source = \"parametric\"\nparametric = {{ sectors = {sectors}, ring_thickness_m = {thickness}, \
             disk_thickness_m = {}, blade_height_m = {}, blade_stagger_angle_deg = {}, blade_twist_deg = {} }}",
            digits(0.006 * numbers.between(disk[0], disk[1])),
            digits(0.080 * numbers.between(0.85, 1.15)),
            digits(numbers.between(20.0, 40.0)),
            digits(numbers.between(10.0, 25.0)),
        )
    };
    let damped = |damper: &str, angle: &str, [low, high]: [f64; 2], numbers: &mut Numbers| {
        format!(
            "source = \"parametric\"\nparametric = {{ sectors = 9, {damper}, blade_height_m = {}, \
             blade_stagger_angle_deg = {}, blade_twist_deg = {}, {angle} = {} }}",
            digits(0.080 * numbers.between(0.85, 1.15)),
            digits(numbers.between(20.0, 40.0)),
            digits(numbers.between(10.0, 25.0)),
            digits(numbers.between(low, high)),
        )
    };
    let bundle = |name| format!("source = \"bundle\"\nbundle = {{ path = \"../../{name}\" }}");
    let (ordinary, heavy, thin) = ([0.8, 1.4], [1.6, 2.2], [0.55, 0.75]);
    let (model, order) = match wheel {
        "wheel8" | "wheel24" => (bundle(wheel), 3),
        "built-in" => ("source = \"parametric\"".to_owned(), 3),
        "odd" => (parametric(13, ordinary, ordinary), 4),
        "half" => (parametric(12, ordinary, ordinary), 6),
        "wedges" => (damped(WEDGE, "flank_angle_deg", [25.0, 45.0], numbers), 3),
        "cylinders" => (
            damped(CYLINDER, "platform_height_m", [0.007, 0.010], numbers),
            3,
        ),
        "shrouds" => (damped(SHROUD, "shroud_angle_deg", [15.0, 45.0], numbers), 2),
        "sliding-shrouds" => (
            damped(SHROUD, "shroud_angle_deg", [-60.0, -35.0], numbers),
            3,
        ),
        "ground" => (
            damped(GROUND, "platform_height_m", [0.005, 0.008], numbers),
            3,
        ),
        _ => (parametric(16, heavy, thin), 2),
    };
    let (friction, kt, kn) = match wheel {
        "wheel8" => (0.3, 4e8, 8e8),
        "wheel24" => (0.3, 1e8, 2e8),
        "built-in" => (0.15, 1e8, 1e8),
        _ if OTHER_DAMPERS.contains(&wheel) => {
            let kt = digits(10.0_f64.powf(numbers.between(7.2, 7.8)));
            let kn = digits(kt * numbers.between(1.0, 2.0));
            (digits(numbers.between(0.1, 0.4)), kt, kn)
        }
        _ => {
            let kt = digits(10.0_f64.powf(numbers.between(7.7, 8.7)));
            let kn = digits(kt * numbers.between(1.0, 2.0));
            (digits(numbers.between(0.1, 0.4)), kt, kn)
        }
    };
    format!(
        "# Drawn by tests/truth, seed {SEED}.\nschema = 1\n\
         study = {{ name = \"truth-{wheel}\", seed = {SEED} }}\n\
         excitation = {{ engine_orders = [{order}], amplitude_n = 1.0 }}\n\
         damping = {{ structural_loss_factor = 0.002 }}\n\
         mistuning = {{ file = \"patterns.csv\" }}\n\n[model]\n{model}\n\n[contact]\nlaw = \"simplified_3d\"\n\
         friction_coefficient = {friction}\ntangential_stiffness_n_per_m = {kt:e}\nnormal_stiffness_n_per_m = {kn:e}\n"
    )
}

/// Draws a wheel and writes its folder; `sticking_n` finds the load under which its tuned wheel sticks.
pub fn draw(wheel: &str, sticking_n: impl Fn(&Wheel) -> f64) {
    let place = WHEELS
        .iter()
        .position(|own| *own == wheel)
        .expect("a wheel");
    let mut numbers = Numbers(SEED + place as u64);
    let folder = folder(wheel);
    std::fs::create_dir_all(&folder).expect("a folder");
    let study = folder.join("study.toml");
    let physics = study_text(wheel, &mut numbers);
    let sweep = |loads: &str| format!("{physics}\n[sweep]\nnormal_load_n = [{loads}]\n");
    std::fs::write(&study, sweep("\"slide\", \"stuck\", \"free\"")).expect("written");
    let write_patterns = |patterns: &[Vec<f64>]| {
        let mut text = "pattern,blade,deviation\n".to_owned();
        for (pattern, deviations) in patterns.iter().enumerate() {
            for (blade, deviation) in deviations.iter().enumerate() {
                writeln!(text, "{pattern},{blade},{deviation}").expect("a string");
            }
        }
        std::fs::write(folder.join("patterns.csv"), text).expect("written");
    };
    let sectors = sectors_of(&physics, wheel);
    let mut patterns = Vec::new();
    for _ in 0..PATTERNS {
        let deviation = numbers.one_of(&STANDARD_DEVIATIONS);
        let own = (0..sectors).map(|_| (1e6 * deviation * numbers.normal()).round() / 1e6);
        patterns.push(own.collect::<Vec<f64>>());
    }
    write_patterns(&patterns);
    let sticking_n = sticking_n(&Wheel::read(wheel));
    let [low, high] = LOADS_OF_STICKING.map(f64::ln);
    let loads: Vec<String> = (0..LOADS)
        .map(|place| (place as f64 + numbers.between(0.0, 1.0)) / LOADS as f64)
        .map(|way| sticking_n * (low + (high - low) * way).exp())
        .map(|load_n| format!("{load_n:.3e}").parse::<f64>().expect("a number"))
        .map(|load_n| load_n.to_string())
        .collect();
    let all = format!("{}, \"slide\", \"stuck\", \"free\"", loads.join(", "));
    std::fs::write(study, sweep(&all)).expect("written");
}

fn sectors_of(physics: &str, wheel: &str) -> usize {
    let written = physics.split("sectors = ").nth(1);
    match (wheel, written) {
        ("wheel8", _) => 8,
        (_, Some(rest)) => rest
            .split(',')
            .next()
            .expect("a number")
            .parse()
            .expect("a number"),
        _ => 24,
    }
}

/// A wheel as its folder has it.
pub struct Wheel {
    pub name: String,
    pub model: SectorModel,
    pub loads_n: Vec<f64>,
    patterns: Vec<Vec<f64>>,
    loss_factor: f64,
    engine_order: u32,
    law: Law,
}

/// What is solved with a pattern.
#[derive(Clone, Copy, PartialEq)]
pub enum Condition {
    Friction(f64),
    Slide,
    Stuck,
    Free,
}

impl std::fmt::Display for Condition {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Friction(load) => write!(f, "{load}"),
            Self::Slide => f.write_str("slide"),
            Self::Stuck => f.write_str("stuck"),
            Self::Free => f.write_str("free"),
        }
    }
}

impl Wheel {
    pub fn read(name: &str) -> Self {
        let path = folder(name).join("study.toml");
        let study = Study::read(&path).expect("a study");
        let model = load_sector_model(&study).expect("a model");
        let text = std::fs::read_to_string(&path).expect("a study");
        let table: toml::Table = text.parse().expect("TOML");
        let as_number = |value: &toml::Value| {
            value
                .as_float()
                .or(value.as_integer().map(|own| own as f64))
        };
        let number = |name: &str, key: &str| as_number(&table[name][key]).expect("a number");
        let loads = table["sweep"]["normal_load_n"].as_array().expect("loads");
        let csv = std::fs::read_to_string(folder(name).join("patterns.csv")).expect("patterns");
        let mut patterns = vec![Vec::new(); PATTERNS];
        for line in csv.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            let pattern: usize = cells[0].parse().expect("a number");
            patterns[pattern].push(cells[2].parse().expect("a number"));
        }
        let orders = table["excitation"]["engine_orders"]
            .as_array()
            .expect("a list");
        Self {
            name: name.to_owned(),
            loads_n: loads.iter().filter_map(as_number).collect(),
            patterns,
            loss_factor: number("damping", "structural_loss_factor"),
            engine_order: orders[0].as_integer().expect("an engine order") as u32,
            law: Law {
                normal_load_n: 0.0,
                normal_stiffness_n_per_m: number("contact", "normal_stiffness_n_per_m"),
                tangential_stiffness_n_per_m: number("contact", "tangential_stiffness_n_per_m"),
                friction_coefficient: number("contact", "friction_coefficient"),
            },
            model,
        }
    }

    /// Contact parameters of a sector, without load.
    pub fn law(&self) -> Law {
        self.law
    }

    /// What pattern `pattern` is solved under: with friction, or without.
    pub fn condition(&self, pattern: usize, with_friction: bool) -> Condition {
        match (with_friction, pattern % 3) {
            (true, _) => Condition::Friction(self.loads_n[pattern % LOADS]),
            (false, 0) => Condition::Slide,
            (false, 1) => Condition::Stuck,
            (false, _) => Condition::Free,
        }
    }

    /// The case of a pattern, or of the tuned wheel.
    pub fn case(&self, pattern: Option<usize>, condition: Condition) -> Case {
        let (kn, kt) = (
            self.law.normal_stiffness_n_per_m,
            self.law.tangential_stiffness_n_per_m,
        );
        Case {
            loss_factor: self.loss_factor,
            engine_order: self.engine_order,
            deviations: match pattern {
                Some(pattern) => self.patterns[pattern].clone(),
                None => vec![0.0; self.model.sectors],
            },
            contact: match condition {
                Condition::Friction(normal_load_n) => Contact::Friction(Law {
                    normal_load_n,
                    ..self.law
                }),
                Condition::Slide => Contact::Springs(kn, 0.0),
                Condition::Stuck => Contact::Springs(kn, kt),
                Condition::Free => Contact::Springs(0.0, 0.0),
            },
        }
    }
}
