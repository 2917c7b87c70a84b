//! What a study states is what it resolves to, key by key: a key that is left out there would be in no manifest and no
//! digest, and results of two of its values would be taken for those of one study.

use std::collections::BTreeSet;
use std::path::Path;

use blisk::study::{EXAMPLES, KeySpec, Study, Value, keys};
use serde_json::Value as Json;

use crate::blisk::GOOD;

/// Studies that state, beside the examples, every key with a value that is not its default.
fn stated() -> Vec<String> {
    let variation = |quantity: &str| {
        format!(
            "[contact.variation.{quantity}]\nkind = \"truncated_normal\"\nstandard_deviation = 0.1\n\
             truncation = 2.5\nper = \"pair\"\n"
        )
    };
    let variations = [
        "friction_coefficient",
        "tangential_stiffness",
        "normal_stiffness",
        "normal_load",
    ];
    let variations: String = variations.map(variation).concat();
    let contact = "law = \"coulomb_3d\"\nnormal_stiffness_n_per_m = 1.0e8";
    let everything = replaced(&[
        ("law = \"macro_slip_1d\"", contact),
        ("ring_disk_stiffness_n_per_m = 1.0e4", LUMPED),
        ("[damping]", &format!("{variations}\n[damping]")),
        ("structural_loss_factor = 0.002", "modal_ratio = 0.002"),
        ("distribution = { kind = \"normal\" }", MISTUNING),
        ("harmonics = [1, 3]", SOLVER),
        ("patterns = 10", "patterns = 500"),
        (
            "engine_orders = [2]\namplitude_n = 10.0",
            "engine_orders = [2, 1]\namplitude_n = [10.0, 5.0]",
        ),
    ]) + AFTER_SOLVER;
    let load_cases = replaced(&[("engine_orders = [2]\namplitude_n = 10.0", LOAD_CASES)]);
    let accuracy = replaced(&[("harmonics = [1, 3]", "")]) + "[accuracy]\namplitude_error = 0.02\n";
    let creeping = replaced(&[(
        "law = \"macro_slip_1d\"",
        "law = \"macro_slip_1d\"\nring = \"creeping\"",
    )]) + "[reduction]\nbasis = \"stick_slide\"\nstick_modes = 3\nslide_modes = 4\n";
    let start = GOOD.find("sectors = 6").expect("the sectors");
    let end = GOOD.find("[contact]").expect("contact");
    let of_model = |model: &str| format!("{}{model}\n{}", &GOOD[..start], &GOOD[end..]);
    let named_masses = of_model(NAMED_MASSES);
    let bundle = of_model("").replace("\"lumped\"", "\"bundle\"");
    let bundle = bundle.replace("[model.lumped]", "[model.bundle]\npath = \"wheel\"");
    let mut parametric = of_model("").replace("\"lumped\"", "\"parametric\"");
    parametric = parametric.replace(
        "[model.lumped]",
        &format!("[model.parametric]\n{}", parametric_keys()),
    );
    let rotation = |study: &str, keys: &str| {
        let normal_load = format!("{ROTATION}{keys}\n[damping]");
        let study = study.replace("[damping]", &normal_load);
        study.replace("\"slide\", 50, \"stuck\"", "\"slide\"")
    };
    let ring_radius = rotation(GOOD, "ring_radius_m = 0.2\n");
    let solid = of_model("").replace("\"lumped\"", "\"parametric\"");
    let solid = solid.replace("[model.lumped]", "[model.parametric]\nsectors = 12");
    let solid = solid.replace("law = \"macro_slip_1d\"", contact);
    let equilibrium = rotation(&solid, "hoop = \"split\"\nshare = \"equilibrium\"\n");
    vec![
        everything,
        load_cases,
        accuracy,
        creeping,
        equilibrium,
        ring_radius,
        named_masses,
        bundle,
        parametric,
    ]
}

fn replaced(lines: &[(&str, &str)]) -> String {
    let mut study = GOOD.to_owned();
    for (line, instead) in lines {
        assert!(study.contains(line), "{line}");
        study = study.replace(line, instead);
    }
    study
}

/// Every key of the built-in disk, each with another value than its default.
fn parametric_keys() -> String {
    let keys = keys().into_iter();
    keys.filter_map(|key| {
        let name = key.key.strip_prefix("model.parametric.")?;
        Some(format!("{name} = {}\n", another_value(&key)?))
    })
    .collect()
}

/// A value of a key that is not its default; none for those that are no number, name or flag.
fn another_value(key: &KeySpec) -> Option<String> {
    let default = key.default.trim_matches('`');
    match key.value {
        Value::Name(names) => {
            let mut names = names.iter().map(|name| format!("\"{name}\""));
            names.find(|name| name != default)
        }
        Value::Flag => Some((default != "true").to_string()),
        Value::Whole(low, high) => {
            let other = default.parse().map_or(low, |default: i64| default + 1);
            Some(other.min(high).to_string())
        }
        Value::Number(_) => {
            // Near the default, so that it is in its range.
            let default: f64 = default.parse().unwrap_or(1.0);
            Some(format!("{:?}", default * 0.99 + f64::from(default == 0.0)))
        }
        _ => None,
    }
}

/// `study` with the key besides.
fn with(study: &str, key: &str, value: &str) -> Option<String> {
    let mut document: toml::Table = study.parse().expect("TOML");
    let value: toml::Table = format!("value = {value}").parse().expect("TOML");
    let mut steps: Vec<&str> = key.split('.').collect();
    let name = steps.pop()?;
    let mut table = &mut document;
    for step in steps {
        let inner = table
            .entry(step)
            .or_insert_with(|| toml::Value::Table(toml::Table::new()));
        table = inner.as_table_mut()?;
    }
    table.insert(name.to_owned(), value["value"].clone());
    toml::to_string(&document).ok()
}

const LUMPED: &str = "ring_disk_stiffness_n_per_m = 1.0e4
blade_coupling_stiffness_n_per_m = 2.0e3
ring_ground_stiffness_n_per_m = 3.0e3";

const MISTUNING: &str = "projection = \"cantilever_modes\"
cantilever_mode_count = 3
quantity = \"blade_stiffness\"
distribution = { kind = \"truncated_normal\", truncation = 2.0 }";

const SOLVER: &str = "harmonics = [1, 3]
search_harmonics = [1]
harmonic_tolerance = 0.03
rows_beyond_tolerance = \"resolve\"
samples_per_period = 64
residual_tolerance = 1e-9
peak_tolerance = 2e-3
amplitude = \"time_maximum\"
time_samples = 512
frequency_band_hz = [300.0, 600.0]";

const AFTER_SOLVER: &str = "
[reduction]
error = 0.002
craig_bampton_modes = 7
sensitivity_vectors = 1

[nodal_diameter_damping]
damping_ratios = [[2, 0.0008], [3, 0.0012]]
modes = \"all\"

[stop]
percentile = 50
relative_width = 0.2
quantity = \"amplification_factor\"

[output]
patterns = false
compression = \"snappy\"
stress_pa_per_m = 2.0e11
stability = 3
";

const LOAD_CASES: &str = "
[[excitation.load_case]]
name = \"cruise\"
force = \"cruise.csv\"
engine_orders = [2]
amplitude_n = 3.0

[[excitation.load_case]]
name = \"tip\"
node = \"blade\"
direction = [0.0, 1.0, 0.0]
engine_orders = [1, 2]
amplitude_n = [1.0, 0.5]
";

const ROTATION: &str = "[contact.normal_load]
from = \"rotation\"
speed_rpm = [4000.0, 6000.0]
ring_mass_factor = 1.5
";

const NAMED_MASSES: &str = "sectors = 6
force = \"blade\"
observe = [\"disk\", \"blade\"]
mass = [{ name = \"blade\", mass_kg = 0.25 }, { name = \"disk\", mass_kg = 1.0, body = \"damper\" }]
spring = [{ between = [\"blade\", \"disk\"], stiffness_n_per_m = 2.5e6, mistuned = true }]
contact = [{ between = [\"blade\", \"next.blade\"], weight = 2.0 }]";

/// Full names of what `stated` states; each is compared with what stands in its place in `resolved`.
fn compare(
    name: &str,
    stated: &Json,
    resolved: &Json,
    into: &mut BTreeSet<String>,
    wrong: &mut Vec<String>,
) {
    let below = |key: &str| {
        if name.is_empty() {
            key.to_owned()
        } else {
            format!("{name}.{key}")
        }
    };
    match (stated, resolved) {
        (Json::Object(stated), resolved) => {
            for (key, value) in stated {
                compare(&below(key), value, &resolved[key], into, wrong);
            }
        }
        (Json::Array(stated), Json::Array(resolved)) if stated.iter().any(Json::is_object) => {
            assert_eq!(stated.len(), resolved.len(), "{name}");
            for (stated, resolved) in stated.iter().zip(resolved) {
                compare(name, stated, resolved, into, wrong);
            }
        }
        _ => {
            into.insert(name.to_owned());
            if !same(stated, resolved) {
                wrong.push(format!("{name}: {stated} stated, {resolved} resolved"));
            }
        }
    }
}

/// Equal but for the type of numbers; one value for a list of it.
fn same(stated: &Json, resolved: &Json) -> bool {
    match (stated, resolved) {
        (Json::Array(a), Json::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
        }
        _ => match (stated.as_f64(), resolved.as_f64()) {
            (Some(a), Some(b)) => a.total_cmp(&b).is_eq(),
            _ => stated == resolved,
        },
    }
}

#[test]
fn every_key_that_a_study_states_stands_in_the_resolved_study_with_its_value() {
    let examples = EXAMPLES.iter().map(|(_, text)| (*text).to_owned());
    let (mut seen, mut wrong) = (BTreeSet::new(), Vec::new());
    let mut state = |text: &str, seen: &mut BTreeSet<String>| {
        // Beside the examples, which read files.
        let place = concat!(env!("CARGO_MANIFEST_DIR"), "/studies/study.toml");
        let study = Study::parse(Path::new(place), text);
        let study = study.unwrap_or_else(|error| panic!("{error}\n{text}"));
        let document: toml::Table = text.parse().expect("TOML");
        let document = serde_json::to_value(document).expect("JSON");
        let mut resolved = study.resolved();
        // A standard deviation that is written in the distribution is that of the sweep.
        let of_distribution = "/mistuning/distribution/standard_deviation";
        if document.pointer(of_distribution).is_some() {
            resolved["mistuning"]["distribution"]["standard_deviation"] =
                resolved["sweep"]["standard_deviation"][0].clone();
        }
        compare("", &document, &resolved, seen, &mut wrong);
    };
    for text in stated().into_iter().chain(examples) {
        state(&text, &mut seen);
    }
    // A key of its own, which needs no other, is stated here.
    let mut missing = Vec::new();
    for key in keys() {
        let is_table = matches!(
            key.value,
            Value::Table | Value::Tables | Value::TableOrTables
        );
        if is_table || seen.contains(&key.key) {
            continue;
        }
        let value = another_value(&key);
        match value.and_then(|value| with(GOOD, &key.key, &value)) {
            Some(text) => state(&text, &mut seen),
            None => missing.push(key.key),
        }
    }
    assert_eq!(
        missing,
        Vec::<String>::new(),
        "keys that no study of this test states"
    );
    assert_eq!(wrong, Vec::<String>::new());
}
