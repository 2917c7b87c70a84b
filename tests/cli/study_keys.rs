//! The declarations of the keys against the parser, the examples, the documentation and the JSON Schema.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use blisk::study::{
    EXAMPLES, KeySpec, Problem, Study, StudyError, Value, keys, load_sector_model, study_schema,
};
use serde_json::Value as Json;

use crate::blisk::{GOOD, Place};

/// What the parser finds wrong in `text`.
fn findings(text: &str) -> Vec<(String, Problem)> {
    match Study::parse(Path::new("study.toml"), text) {
        Ok(_) => Vec::new(),
        Err(StudyError::Invalid { findings, .. }) => findings
            .into_iter()
            .map(|finding| (finding.key, finding.problem))
            .collect(),
        Err(other) => panic!("{other}"),
    }
}

/// The table that a key is in, and its own name.
fn split(key: &str) -> (&str, &str) {
    key.rsplit_once('.').unwrap_or(("", key))
}

/// The names right below a table.
fn children(table: &str) -> BTreeSet<String> {
    keys()
        .iter()
        .filter(|key| split(&key.key).0 == table)
        .map(|key| split(&key.key).1.to_owned())
        .collect()
}

/// A study file with nothing but `key = value`.
fn alone(key: &str, value: &str) -> String {
    match split(key) {
        ("", name) => format!("{name} = {value}\n"),
        (table, name) => {
            let is_list = |key: &KeySpec| key.key == table && key.value == Value::Tables;
            let table = if keys().iter().any(is_list) {
                format!("[[{table}]]")
            } else {
                format!("[{table}]")
            };
            format!("{table}\n{name} = {value}\n")
        }
    }
}

#[test]
fn every_table_has_the_keys_that_the_parser_knows() {
    let tables = keys();
    let root = ("", &Value::Table);
    let tables = tables.iter().map(|key| (key.key.as_str(), &key.value));
    let tables = tables.filter(|(_, value)| matches!(value, Value::Table | Value::Tables));
    for (table, value) in tables.chain([root]) {
        let key = format!("{table}.no_such_key");
        let mut text = alone(key.trim_start_matches('.'), "1");
        if *value == Value::Tables {
            text = format!("[[{table}]]\nno_such_key = 1\n");
        }
        let found = findings(&text);
        let [(_, Problem::UnknownKey { accepted, .. })] = found.as_slice() else {
            panic!("[{table}]: {found:?}");
        };
        let accepted: BTreeSet<String> = accepted.iter().cloned().collect();
        assert_eq!(accepted, children(table), "[{table}]");
    }
}

#[test]
fn every_name_that_a_key_accepts_is_one_that_the_parser_knows() {
    let mut count = 0;
    for key in keys() {
        let Value::Name(names) = key.value else {
            continue;
        };
        let found = findings(&alone(&key.key, "\"no such name\""));
        let [(_, Problem::NotAccepted { accepted, .. })] = found.as_slice() else {
            panic!("{}: {found:?}", key.key);
        };
        let accepted: BTreeSet<&str> = accepted.split(", ").collect();
        let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        let own: BTreeSet<&str> = quoted.iter().map(String::as_str).collect();
        assert_eq!(own, accepted, "{}", key.key);
        count += 1;
    }
    assert!(count > 15);
}

/// A study that has every table; `replaced` is the text of one of its lines and what stands there instead.
fn full(replaced: (&str, &str)) -> String {
    let study = GOOD
        .replace("law = \"macro_slip_1d\"", "law = \"simplified_3d\"\nnormal_stiffness_n_per_m = 1.0e8")
        .replace(
            "[damping]",
            "[contact.variation.normal_load]\nkind = \"normal\"\nstandard_deviation = 0.1\n\n[damping]",
        )
        .replace("patterns = 10", "patterns = 100")
        + "\n[stop]\npercentile = 50\nrelative_width = 0.2\n\n[output]\n\n[reduction]\n";
    assert!(study.contains(replaced.0), "{}", replaced.0);
    study.replace(replaced.0, replaced.1)
}

#[test]
fn a_key_is_required_exactly_where_the_parser_misses_it() {
    assert_eq!(findings(&full(("", ""))), []);
    let study = full(("", ""));
    let mut table = String::new();
    let mut missed = 0;
    for line in study.lines() {
        if let Some(name) = line.strip_prefix('[') {
            table = name.trim_end_matches(']').to_owned();
        }
        let Some((name, _)) = line.split_once(" = ") else {
            continue;
        };
        let full_key = format!("{table}.{name}");
        let full_key = full_key.trim_start_matches('.');
        let key = keys()
            .into_iter()
            .find(|key| key.key == full_key)
            .expect("a known key");
        let found = findings(&full((line, "")));
        let misses = found
            .iter()
            .any(|(key, problem)| key == full_key && matches!(problem, Problem::Missing { .. }));
        let said = key.required || key.default.starts_with("required");
        // Those of the models are missed when the model is built, and a damping or a law may be another.
        let of_model = full_key.starts_with("model.lumped.");
        let instead = [
            "damping.structural_loss_factor",
            "mistuning.distribution",
            "sweep.standard_deviation",
        ];
        if !of_model && !instead.contains(&full_key) {
            assert_eq!(misses, said, "{full_key}: {found:?}");
            missed += usize::from(misses);
        }
    }
    assert!(missed >= 12, "{missed}");
}

/// Numbers just outside of a range, and its included ends.
fn around(key: &KeySpec) -> (Vec<String>, Vec<String>) {
    match key.value {
        Value::Number(range) => {
            let (mut outside, mut inside) = (Vec::new(), Vec::new());
            for (end, step) in [(range.low, -1.0), (range.high, 1.0)] {
                let Some((end, included)) = end else { continue };
                // As near as a number of four digits can be.
                let near = end + step * 1e-4 * f64::max(end.abs(), 1e-2 * f64::from(end == 0.0));
                outside.push(format!("{near:e}"));
                if included {
                    inside.push(format!("{end:e}"));
                } else {
                    outside.push(format!("{end:e}"));
                }
            }
            (outside, inside)
        }
        Value::Whole(low, high) => {
            let outside = [low.checked_sub(1), high.checked_add(1)];
            let outside = outside.into_iter().flatten().map(|n| n.to_string());
            (outside.collect(), vec![low.to_string(), high.to_string()])
        }
        _ => (Vec::new(), Vec::new()),
    }
}

/// The full study with `key = value`, in the place of what it says there.
fn with(key: &str, value: &str) -> String {
    let study = full(("", ""));
    let (table, name) = split(key);
    let mut document: toml::Table = study.parse().expect("TOML");
    let mut inner = &mut document;
    for step in table.split('.').filter(|step| !step.is_empty()) {
        inner = inner
            .entry(step)
            .or_insert_with(|| toml::Value::Table(toml::Table::new()))
            .as_table_mut()
            .expect("a table");
    }
    let parsed: toml::Table = format!("value = {value}").parse().expect("TOML");
    inner.insert(name.to_owned(), parsed["value"].clone());
    toml::to_string(&document).expect("TOML")
}

#[test]
fn ranges_end_where_those_of_the_parser_end() {
    // Accepted only with another kind or law, or bounded by another key.
    let by_others = [
        "mistuning.distribution.truncation",
        "mistuning.distribution.standard_deviation",
        "mistuning.cantilever_mode_count",
        "reduction.stick_modes",
        "reduction.slide_modes",
        "damping.modal_ratio",
        "damping.rayleigh.mass_per_s",
        "damping.rayleigh.stiffness_s",
    ];
    let refused = |key: &str, text: &str| {
        let found = findings(text);
        // A whole number beyond those of its type is refused as a value of the file.
        found.iter().any(|(own, problem)| {
            own == key
                && matches!(
                    problem,
                    Problem::NotAccepted { .. } | Problem::Syntax { .. }
                )
        })
    };
    let mut ends = 0;
    for key in keys() {
        let name = key.key.as_str();
        let of_model = name.starts_with("model.");
        let other_kind = by_others.contains(&name)
            || name.starts_with("contact.variation.")
                && !name.ends_with(".normal_load.standard_deviation");
        if of_model || other_kind {
            continue;
        }
        let (outside, inside) = around(&key);
        for value in outside {
            // 0.5 is the largest of the kind that the study has, 2 that of lognormal.
            assert!(refused(name, &with(name, &value)), "{name} = {value}");
            ends += 1;
        }
        for value in inside {
            if name == "contact.variation.normal_load.standard_deviation"
                || (name, value.as_str()) == ("study.patterns", "1")
            {
                continue;
            }
            assert!(!refused(name, &with(name, &value)), "{name} = {value}");
            ends += 1;
        }
    }
    assert!(ends > 50, "{ends}");
}

#[test]
fn ranges_of_the_models_end_where_the_models_refuse() {
    let mut ends = 0;
    for key in keys() {
        let (table, name) = split(&key.key);
        let (source, table_text) = match table {
            "model.parametric" => ("parametric", String::new()),
            "model.lumped" => (
                "lumped",
                "sectors = 6\nblade_mass_kg = 0.25\ndisk_mass_kg = 1.0\nring_mass_kg = 0.03\nblade_stiffness_n_per_m = 2.5e6\n"
                    .lines()
                    .filter(|line| !line.starts_with(&format!("{name} ")))
                    .fold(String::new(), |text, line| text + line + "\n"),
            ),
            _ => continue,
        };
        for value in around(&key).0 {
            let start = GOOD.find("source = ").expect("a model");
            let end = GOOD.find("[contact]").expect("contact");
            let text = format!(
                "{}source = \"{source}\"\n[{table}]\n{table_text}{name} = {value}\n{}",
                &GOOD[..start],
                &GOOD[end..]
            );
            let refused = match Study::parse(Path::new("study.toml"), &text) {
                Err(StudyError::Invalid { findings, .. }) => {
                    findings.iter().any(|finding| finding.key == key.key)
                }
                Err(_) => false,
                Ok(study) => {
                    let refused = load_sector_model(&study)
                        .map(|_| ())
                        .expect_err("an error")
                        .to_string();
                    // The twist is bounded with the angle of the root.
                    refused.matches(&key.key).count() == 1
                }
            };
            assert!(refused, "{} = {value}", key.key);
            ends += 1;
        }
    }
    assert!(ends > 50, "{ends}");
}

#[test]
fn defaults_are_those_of_the_resolved_study() {
    let resolved = Study::parse(Path::new("study.toml"), GOOD)
        .expect("a valid study")
        .resolved();
    let resolved = serde_json::to_value(resolved).expect("JSON");
    let mut compared = 0;
    for key in keys() {
        let written = key.default.trim_matches('`');
        let Ok(document) = format!("value = {written}").parse::<toml::Table>() else {
            continue;
        };
        let default = serde_json::to_value(&document["value"]).expect("JSON");
        let of_study = key.key.split('.').fold(&resolved, |json, step| &json[step]);
        if of_study.is_null()
            || key.key.starts_with("model.")
            || GOOD.contains(&format!("{} =", split(&key.key).1))
        {
            continue;
        }
        let same = match (default.as_f64(), of_study.as_f64()) {
            (Some(a), Some(b)) => a.total_cmp(&b).is_eq(),
            _ => default == *of_study,
        };
        assert!(same, "{}: {default} and {of_study}", key.key);
        compared += 1;
    }
    assert!(compared >= 10, "{compared}");
    let parametric = blisk::model::sector::ParametricOptions::default();
    let parametric = serde_json::to_value(parametric).expect("JSON");
    for key in keys()
        .iter()
        .filter(|key| key.key.starts_with("model.parametric."))
    {
        let document = format!("value = {}", key.default.trim_matches('`'));
        let document = document.parse::<toml::Table>().expect("TOML");
        let default = serde_json::to_value(&document["value"]).expect("JSON");
        let own = &parametric[split(&key.key).1];
        let same = match (default.as_f64(), own.as_f64()) {
            (Some(default), Some(own)) => default.total_cmp(&own).is_eq(),
            _ => default == *own,
        };
        assert!(same, "{}: {default} and {own}", key.key);
    }
}

/// Words of JSON Schema that [`violations`] checks or may pass over.
const KNOWN: [&str; 19] = [
    "$schema",
    "title",
    "description",
    "type",
    "properties",
    "required",
    "additionalProperties",
    "minProperties",
    "maxProperties",
    "enum",
    "anyOf",
    "items",
    "minItems",
    "maxItems",
    "uniqueItems",
    "minimum",
    "maximum",
    "exclusiveMinimum",
    "exclusiveMaximum",
];

/// What of `value` the schema does not accept; the part of JSON Schema that the schema uses.
pub fn violations(schema: &Json, value: &Json, place: &str) -> Vec<String> {
    let refuse = |why: &str| vec![format!("{place}: {why}")];
    for word in schema.as_object().expect("an object").keys() {
        assert!(KNOWN.contains(&word.as_str()), "{word} is not checked here");
    }
    if let Some(choices) = schema["anyOf"].as_array() {
        let fits = choices
            .iter()
            .any(|choice| violations(choice, value, place).is_empty());
        return if fits {
            Vec::new()
        } else {
            refuse("none of the choices")
        };
    }
    if let Some(names) = schema["enum"].as_array() {
        return if names.contains(value) {
            Vec::new()
        } else {
            refuse("no such name")
        };
    }
    let is = match schema["type"].as_str().expect("a type") {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        other => panic!("{other} is not checked here"),
    };
    if !is {
        return refuse("another type");
    }
    let mut found = Vec::new();
    if let Some(number) = value.as_f64() {
        let end = |word: &str| schema[word].as_f64();
        let fits = end("minimum").is_none_or(|end| number >= end)
            && end("maximum").is_none_or(|end| number <= end)
            && end("exclusiveMinimum").is_none_or(|end| number > end)
            && end("exclusiveMaximum").is_none_or(|end| number < end);
        if !fits {
            found.extend(refuse("out of range"));
        }
    }
    if let Some(fields) = value.as_object() {
        for name in schema["required"].as_array().into_iter().flatten() {
            let name = name.as_str().expect("a name");
            if !fields.contains_key(name) {
                found.push(format!("{place}.{name}: missing"));
            }
        }
        let count = |word: &str| schema[word].as_u64().map(|count| count as usize);
        let few = count("minProperties").is_some_and(|least| fields.len() < least);
        let many = count("maxProperties").is_some_and(|most| fields.len() > most);
        if few || many {
            found.extend(refuse("number of keys"));
        }
        for (name, value) in fields {
            match schema["properties"].get(name) {
                Some(schema) => found.extend(violations(schema, value, &format!("{place}.{name}"))),
                None => found.push(format!("{place}.{name}: unknown")),
            }
        }
    }
    if let Some(values) = value.as_array() {
        let count = |word: &str| schema[word].as_u64().map(|count| count as usize);
        let few = count("minItems").is_some_and(|least| values.len() < least);
        let many = count("maxItems").is_some_and(|most| values.len() > most);
        let repeated = values
            .iter()
            .enumerate()
            .any(|(at, value)| values[..at].contains(value));
        if few || many || repeated && schema["uniqueItems"] == true {
            found.extend(refuse("number of values"));
        }
        for value in values {
            found.extend(violations(&schema["items"], value, place));
        }
    }
    found
}

/// The full study with two load cases.
fn with_load_cases(replaced: (&str, &str)) -> String {
    let cases = "[[excitation.load_case]]\nname = \"own\"\n\n[[excitation.load_case]]\nname = \"side\"\n\
                 node = \"blade\"\ndirection = [0.0, 1.0, 0.0]\nengine_orders = [1, 2]\n\
                 amplitude_n = [1.0, 0.5]\n";
    assert!(cases.contains(replaced.0), "{}", replaced.0);
    full(("", "")) + &cases.replacen(replaced.0, replaced.1, 1)
}

#[test]
fn load_cases_are_accepted_and_refused_by_the_parser_and_by_the_schema() {
    let schema = study_schema();
    let good = with_load_cases(("", ""));
    assert_eq!(
        violations(&schema, &as_json(&good), ""),
        Vec::<String>::new()
    );
    assert_eq!(findings(&good), []);
    for (part, bad, key) in [
        ("name = \"own\"\n", "", "excitation.load_case[0].name"),
        (
            "engine_orders = [1, 2]",
            "engine_orders = [1, 1]",
            "excitation.load_case[1].engine_orders",
        ),
        (
            "engine_orders = [1, 2]",
            "engine_orders = [20000, 2]",
            "excitation.load_case[1].engine_orders",
        ),
        (
            "[1.0, 0.5]",
            "[1.0, -0.5]",
            "excitation.load_case[1].amplitude_n",
        ),
        (
            "direction = [0.0, 1.0, 0.0]",
            "direction = \"theta\"",
            "excitation.load_case[1].direction",
        ),
    ] {
        let text = with_load_cases((part, bad));
        assert_ne!(
            violations(&schema, &as_json(&text), ""),
            Vec::<String>::new(),
            "{bad}"
        );
        assert!(
            findings(&text).iter().any(|(own, _)| own == key),
            "{bad}: {:?}",
            findings(&text)
        );
    }
}

/// What keys have to do with each other is known to the parser alone.
#[test]
fn keys_of_load_cases_that_do_not_fit_together_are_refused() {
    let good = with_load_cases(("", ""));
    for (part, bad, key, words) in [
        (
            "name = \"own\"",
            "name = \"side\"",
            "excitation.load_case[1].name",
            "a name of its own",
        ),
        (
            "name = \"own\"",
            "name = \"-\"",
            "excitation.load_case[0].name",
            "letters, digits",
        ),
        (
            "[0.0, 1.0, 0.0]",
            "[0.0, 0.0, 0.0]",
            "excitation.load_case[1].direction",
            "not all 0",
        ),
        (
            "[0.0, 1.0, 0.0]",
            "[0.0, 1.0]",
            "excitation.load_case[1].direction",
            "three numbers",
        ),
        (
            "direction = [0.0, 1.0, 0.0]\n",
            "",
            "excitation.load_case[1].direction",
            "three numbers",
        ),
        (
            "node = \"blade\"",
            "force = \"f.csv\"",
            "excitation.load_case[1].direction",
            "belongs to node",
        ),
        (
            "node = \"blade\"",
            "force = \"f.csv\"\nnode = \"blade\"",
            "excitation.load_case[1].node",
            "one of force and node",
        ),
        (
            "[1.0, 0.5]",
            "[1.0]",
            "excitation.load_case[1].amplitude_n",
            "a list of 2",
        ),
        (
            "name = \"own\"\n",
            "name = \"own\"\nengine_orders = [2]\n",
            "excitation.engine_orders",
            "every load case has its own",
        ),
    ] {
        let found = findings(&with_load_cases((part, bad)));
        let told = found
            .iter()
            .any(|(own, problem)| own == key && format!("{problem:?}").contains(words));
        assert!(told, "{bad}: {found:?}");
    }
    let open = good.replace("[solver]\nharmonics = [1, 3]\n", "");
    assert_ne!(open, good);
    let accurate = findings(&(open + "\n[accuracy]\namplitude_error = 0.01\n"));
    assert!(accurate.is_empty(), "{accurate:?}");
}

pub fn as_json(text: &str) -> Json {
    let document: toml::Table = text.parse().expect("TOML");
    serde_json::to_value(document).expect("JSON")
}

#[test]
fn the_schema_accepts_every_example_and_refuses_what_the_parser_refuses() {
    let schema = study_schema();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut count = 0;
    for folder in [root.clone(), root.join("validation"), root.join("calculix")] {
        for entry in std::fs::read_dir(folder).expect("the studies") {
            let path = entry.expect("an entry").path();
            let name = path
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            // The import files of the CalculiX example are no studies.
            let is_toml = path.extension().is_some_and(|ending| ending == "toml");
            if !is_toml || name.starts_with("wheel_") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a study");
            assert_eq!(
                violations(&schema, &as_json(&text), ""),
                Vec::<String>::new(),
                "{name}"
            );
            count += 1;
        }
    }
    assert!(count >= 10, "{count}");
    assert_eq!(
        violations(&schema, &as_json(&full(("", ""))), ""),
        Vec::<String>::new()
    );
    for (good, bad) in [
        ("seed = 7", ""),
        ("seed = 7", "seed = -1"),
        ("seed = 7", "sed = 7"),
        ("schema = 1", "schema = 2"),
        ("kind = \"normal\" }", "kind = \"gauss\" }"),
        ("friction_coefficient = 0.3", "friction_coefficient = 11"),
        ("friction_coefficient = 0.3", ""),
        (
            "structural_loss_factor = 0.002",
            "structural_loss_factor = 0.002\nmodal_ratio = 0.1",
        ),
        ("structural_loss_factor = 0.002", ""),
        ("engine_orders = [2]", "engine_orders = []"),
        ("engine_orders = [2]", "engine_orders = [2, 2]"),
        ("\"slide\", 50", "\"sliding\", 50"),
        ("harmonics = [1, 3]", "harmonics = \"all\""),
        ("standard_deviation = [0.03]", "standard_deviation = [0.6]"),
    ] {
        let text = full((good, bad));
        assert_ne!(
            violations(&schema, &as_json(&text), ""),
            Vec::<String>::new(),
            "{bad}"
        );
        assert_ne!(findings(&text), [], "{bad}");
    }
}

/// The tables of keys that docs/study-file.md has, each with its rows, as the declarations of the keys say them.
fn declared() -> BTreeMap<String, Vec<String>> {
    let mut tables: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for key in keys() {
        if key.value == Value::Table {
            continue;
        }
        // One table stands for those of all contact parameters, and some short tables for one inside of it.
        let (table, name) = split(&key.key);
        let (table, name) = match table {
            "contact.variation.friction_coefficient" => ("contact.variation", name.to_owned()),
            other if other.starts_with("contact.variation.") => continue,
            "damping.rayleigh" => ("damping", format!("rayleigh.{name}")),
            "mistuning.distribution" => ("mistuning", format!("distribution.{name}")),
            "" => ("The study file", name.to_owned()),
            other => (other, name.to_owned()),
        };
        let row = format!(
            "| `{name}` | {} | {} | {} |",
            key.default, key.value, key.meaning
        );
        let rows = tables.entry(table.to_owned()).or_default();
        rows.push(row.replace("  |", " |"));
    }
    tables
}

/// `page` with the rows of `tables` under their headings, in the place of those that are there.
fn with_rows(page: &str, mut tables: BTreeMap<String, Vec<String>>) -> String {
    let mut table = String::new();
    let mut lines: Vec<String> = Vec::new();
    for line in page.lines() {
        if let Some(heading) = line.strip_prefix('#') {
            let name = heading.trim_start_matches('#').trim();
            let name = name.trim_matches(['`', '[', ']']);
            name.trim_end_matches("]`").clone_into(&mut table);
        }
        if line.starts_with("| `") {
            lines.extend(tables.remove(&table).unwrap_or_default());
        } else {
            lines.push(line.to_owned());
        }
    }
    assert!(
        tables.is_empty(),
        "docs/study-file.md has no table under the headings of {:?}",
        tables.keys()
    );
    lines.join("\n") + "\n"
}

#[test]
fn the_documentation_says_what_the_declarations_of_the_keys_say() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/study-file.md");
    let page = std::fs::read_to_string(&path).expect("the documentation");
    let expected = with_rows(&page, declared());
    if std::env::var_os("BLISK_WRITE_KEYS").is_some() {
        std::fs::write(&path, &expected).expect("the documentation is written");
        return;
    }
    let missing = expected.lines().zip(page.lines());
    let missing = missing.filter(|(expected, written)| expected != written);
    let first = missing.map(|(expected, _)| expected).next();
    assert!(
        expected == page,
        "docs/study-file.md is not what the keys say, first at: {first:?}; BLISK_WRITE_KEYS=1 writes it"
    );
}

#[test]
fn explain_says_what_a_key_accepts_and_suggests_what_was_meant() {
    let place = Place::new();
    let one = place.run(&["explain", "solver.peak_tolerance"]);
    assert_eq!(one.code, 0);
    for words in [
        "solver.peak_tolerance\n",
        "1e-10 to 0.1",
        "1e-3",
        "peak amplitude",
    ] {
        assert!(one.stdout.contains(words), "{}", one.stdout);
    }
    let all = place.run(&["explain", "--json"]);
    let all: Vec<Json> = serde_json::from_str(&all.stdout).expect("JSON");
    assert_eq!(all.len(), keys().len());
    assert!(
        place
            .run(&["explain", "solver"])
            .stdout
            .contains("solver.harmonics")
    );
    for (wrong, meant) in [
        ("peak_tolerence", "solver.peak_tolerance"),
        ("solver.peak_tolerence", "solver.peak_tolerance"),
    ] {
        let ended = place.run(&["explain", wrong]);
        assert_eq!(ended.code, 2);
        assert!(
            ended.stderr.contains(&format!("did you mean {meant}")),
            "{}",
            ended.stderr
        );
    }
    let printed: Json = serde_json::from_str(&place.run(&["schema"]).stdout).expect("JSON");
    assert_eq!(printed, study_schema());
}

#[test]
fn explain_proposes_near_names_alone() {
    let place = Place::new();
    for (wrong, meant) in [
        ("harmonix", "did you mean solver.harmonics?"),
        (
            "Patterms",
            "did you mean study.patterns or output.patterns?",
        ),
        ("engine oders", "did you mean excitation.engine_orders or "),
        ("import.sektors", "did you mean import.sectors?"),
        // Columns, statuses, figures and terms too.
        ("stated_eror", "did you mean stated error or stated_error?"),
        ("stagnatd", "did you mean stagnated?"),
        ("nodal diametre", "did you mean nodal diameter?"),
    ] {
        let ended = place.run(&["explain", wrong]);
        assert_eq!((ended.code, ended.stdout.as_str()), (2, ""), "{wrong}");
        assert!(ended.stderr.contains(meant), "{wrong}: {}", ended.stderr);
    }
    for wrong in ["xyzzy", "zq", "import.xyzzy", "turbocharger"] {
        let ended = place.run(&["explain", wrong]);
        assert_eq!((ended.code, ended.stdout.as_str()), (2, ""), "{wrong}");
        let error = ended.stderr.split_whitespace().collect::<Vec<_>>();
        let error = error.join(" ");
        assert!(!error.contains("did you mean"), "{error}");
        for words in [
            wrong,
            "`blisk explain` lists them",
            "`blisk explain import`",
        ] {
            assert!(error.contains(words), "{wrong}: {error}");
        }
    }
}

#[test]
fn every_example_is_a_study_that_init_writes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut names: BTreeSet<String> = ["template".to_owned()].into();
    for entry in std::fs::read_dir(folder).expect("the studies") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            names.insert(
                path.file_stem()
                    .expect("a name")
                    .to_string_lossy()
                    .into_owned(),
            );
        }
    }
    assert_eq!(
        names,
        EXAMPLES
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .collect()
    );
    for (name, text) in EXAMPLES {
        let place = Place::new();
        let file = format!("{name}.toml");
        let ended = place.run(&["init", "--example", name, "--out", &file]);
        assert_eq!((ended.code, ended.stderr.as_str()), (0, ""), "{name}");
        let written = std::fs::read_to_string(place.path(&file)).expect("a study");
        // Data of the repository stand beside the study.
        assert_eq!(written, text.replace("../tests/data/", ""), "{name}");
        let ended = place.run(&["check", &file]);
        assert_eq!(ended.code, 0, "{name}: {}", ended.stderr);
        // Another `init` finds its data there, and takes no other for them.
        if written != text {
            let folder = written.split("wheel24").count().min(2);
            let data = ["lumped24/mistuning.csv", "wheel24/force.csv"][folder - 1];
            let again = ["init", "--example", name, "--out", "again.toml"];
            assert_eq!(place.run(&again).code, 0, "{name}");
            place.write(data, "dof,re,im\n");
            let again = ["init", "--example", name, "--out", "third.toml"];
            let ended = place.run(&again);
            assert_eq!(ended.code, 7, "{name}");
            assert!(ended.stderr.contains(data), "{}", ended.stderr);
            assert!(!place.path("third.toml").exists());
        }
    }
    let place = Place::new();
    assert_eq!(place.run(&["init", "--example", "no-such"]).code, 2);
}

/// The smallest example that reads data gives results where it was written; the larger ones are checked alone.
#[test]
fn a_small_example_runs_where_init_wrote_it() {
    let place = Place::new();
    let init = ["init", "--example", "lumped24", "--out", "lumped24.toml"];
    assert_eq!(place.run(&init).code, 0);
    let ended = place.run(&["run", "lumped24.toml"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stdout.contains("rows ok, 0 failed"),
        "{}",
        ended.stdout
    );
}

#[test]
fn completions_name_every_command() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ended = place.run(&["completions", shell]);
        assert_eq!((ended.code, ended.stderr.as_str()), (0, ""), "{shell}");
        for command in ["run", "report", "explain", "optimum"] {
            assert!(ended.stdout.contains(command), "{shell}: {command}");
        }
    }
    assert_eq!(place.run(&["completions", "tcsh"]).code, 2);
}
