//! The import files that `blisk import --template` prints import, once the files that they name are there.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;

use blisk::input::Value;
use blisk::model::sector::ModelError;
use blisk::model::sector::import::{IMPORT_TEMPLATES, import, import_keys};

use super::calculix::folder as calculix_wheel;
use super::small::Small;

fn template(code: &str) -> &'static str {
    let found = IMPORT_TEMPLATES.iter().find(|(name, _)| *name == code);
    found.unwrap().1
}

#[test]
fn the_template_of_calculix_imports_the_wheel_of_calculix() {
    let folder = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(calculix_wheel()).unwrap() {
        let path = entry.unwrap().path();
        let name = path
            .file_name()
            .unwrap()
            .to_str()
            .unwrap()
            .replace("_rest.", ".");
        fs::copy(&path, folder.path().join(name)).unwrap();
    }
    let path = folder.path().join("import.toml");
    fs::write(&path, template("calculix")).unwrap();
    let imported = import(&path).unwrap();
    assert_eq!(imported.model.contact_pairs.len(), 6);
}

#[test]
fn the_templates_of_ansys_and_nastran_import_files_in_their_formats() {
    let sets = [
        "LOW",
        "HIGH",
        "RING_LOW",
        "RING_HIGH",
        "LANDING",
        "RING_OUTER",
    ];
    let ansys = Small::ansys_with(sets, vec![("TIP", vec![2])]);
    let nastran = Small::nastran_with(vec![("8", vec![2]), ("9", vec![2])]);
    let punch = nastran.text("punch");
    let at = punch
        .find("KBLADE")
        .and_then(|at| punch[..at].rfind("DMIG"))
        .unwrap();
    let cases = [
        (
            "ansys",
            vec![
                ("wheel.cdb", ansys.text("mesh").to_owned()),
                ("stiffness.matrix", ansys.text("K").to_owned()),
                ("mass.matrix", ansys.text("M").to_owned()),
                ("stiffness.mapping", ansys.text("K.mapping").to_owned()),
                ("blade.matrix", ansys.text("B").to_owned()),
                ("blade.mapping", ansys.text("B.mapping").to_owned()),
            ],
        ),
        (
            "nastran",
            vec![
                ("wheel.bdf", nastran.text("mesh").to_owned()),
                ("wheel.pch", punch[..at].to_owned()),
                ("blade.pch", punch[at..].replace("KBLADE", "KAAX  ")),
            ],
        ),
    ];
    for (code, files) in cases {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let path = folder.path().join("import.toml");
        // The stand-in has 8 sectors.
        let text = template(code).replace("sectors = 24 ", "sectors = 8 ");
        fs::write(&path, &text).unwrap();
        let imported = import(&path).unwrap_or_else(|error| panic!("{code}: {error}"));
        assert_eq!(imported.model.contact_pairs.len(), 2, "{code}");
        // Without its files it is refused for the first of them, not for what it says.
        let alone = tempfile::tempdir().unwrap();
        let path = alone.path().join("import.toml");
        fs::write(&path, template(code)).unwrap();
        let error = import(&path).unwrap_err();
        assert!(matches!(error, ModelError::File { .. }), "{code}: {error}");
    }
}

/// What is wrong in an import file, by key.
fn findings(text: &str) -> Vec<(usize, String, String)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("import.toml");
    fs::write(&path, text).unwrap();
    match import(&path) {
        Err(ModelError::ImportFile { findings, .. }) => findings
            .into_iter()
            .map(|finding| (finding.line, finding.key.clone(), finding.to_string()))
            .collect(),
        Err(ModelError::File { .. }) => Vec::new(),
        other => panic!("{other:?}"),
    }
}

/// A value that a key accepts, as it is written.
fn sample(value: Value) -> String {
    match value {
        Value::Name(names) => format!("\"{}\"", names[0]),
        Value::Text(_) => "\"x\"".to_owned(),
        Value::Number(_) | Value::Whole(..) => "1".to_owned(),
        Value::Vector(count) => format!("{:?}", vec![1.0; count as usize]),
        other => panic!("{other:?}"),
    }
}

/// An import file with every key, or without one.
fn every_key(left_out: &str) -> String {
    let mut text = String::new();
    for key in import_keys() {
        let name = key.key.rsplit('.').next().unwrap();
        match key.value {
            Value::Table => writeln!(text, "[{}]", key.key).unwrap(),
            Value::Tables => writeln!(text, "[[{}]]", key.key).unwrap(),
            // Either a node or a set; either sets or files of their own for blade and ring.
            _ if key.key == left_out || name == "node" => {}
            _ if ["blisk.blade_elements", "ring.set"].contains(&key.key.as_str()) => {}
            value => writeln!(text, "{name} = {}", sample(value)).unwrap(),
        }
    }
    text
}

#[test]
fn every_key_of_an_import_file_is_one_that_its_reader_knows() {
    assert_eq!(findings(&every_key("")), []);
    let mut missed = BTreeSet::new();
    for key in import_keys() {
        if matches!(key.value, Value::Table | Value::Tables) {
            continue;
        }
        let table = key.key.rsplit_once('.').map_or("", |(table, _)| table);
        let found = findings(&every_key(&key.key));
        let misses = found.iter().any(|(_, missing, said)| {
            missing.replace("[0]", "") == key.key && said.contains("is missing")
        });
        let needed = key.required || ["force.set", "observe.set"].contains(&key.key.as_str());
        assert_eq!(misses, needed, "{}: {found:?}", key.key);
        missed.extend(misses.then_some(table.to_owned()));
    }
    assert!(missed.len() >= 5, "{missed:?}");
}

#[test]
fn everything_that_is_wrong_in_an_import_file_is_told_at_once() {
    let text = "\
cod = \"ansys\"
name = \"x\"
sectors = 0
axis = \"w\"

[blisk]
mesh = 3
low_fase = \"LOW\"

[contact]
blisk = \"A\"
ring = \"B\"
pairing = \"projektion\"
tolerance_m = -1.0

[[force]]
node = 1
set = \"TIP\"
component = \"z\"
re = inf

[[observe]]
name = \"tip\"
";
    let found = findings(text);
    let expected = [
        (
            1,
            "code is missing; accepted: \"calculix\", \"ansys\", \"nastran\"",
        ),
        (1, "unknown key cod; did you mean code?"),
        (
            3,
            "sectors = 0 is not accepted; accepted: whole number, 1 to 10000",
        ),
        (4, "axis = \"w\" is not accepted"),
        (
            7,
            "blisk.mesh = 3 is not accepted; accepted: a path, relative to the import file",
        ),
        (8, "unknown key blisk.low_fase; did you mean low_face?"),
        (6, "blisk.high_face is missing"),
        (6, "blisk.low_face is missing"),
        (
            13,
            "contact.pairing = \"projektion\" is not accepted; did you mean \"projection\"?",
        ),
        (
            14,
            "contact.tolerance_m = -1.0 is not accepted; accepted: at least 0",
        ),
        (
            20,
            "force[0].re = inf is not accepted; accepted: any finite number",
        ),
    ];
    for (line, words) in expected {
        let told = found
            .iter()
            .any(|(at, _, said)| *at == line && said.starts_with(words));
        assert!(told, "{line}: {words}: {found:#?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    // What keys have to do with each other, once each of them is accepted.
    let text = "\
code = \"nastran\"
matrix_format = \"op4\"
name = \"x\"
sectors = 3
[blisk]
low_face = \"1\"
high_face = \"2\"
[contact]
blisk = \"A\"
ring = \"B\"
[[force]]
node = 1
set = \"TIP\"
component = \"z\"
[[observe]]
name = \"tip\"
";
    let keys: BTreeSet<String> = findings(text).into_iter().map(|(_, key, _)| key).collect();
    let expected = [
        "blisk.blade_elements",
        "blisk.dofs",
        "blisk.mass",
        "blisk.mesh",
        "blisk.stiffness",
        "force[0].set",
        "observe[0].set",
        "ring",
    ];
    assert_eq!(keys, expected.map(str::to_owned).into());
}

#[test]
fn sets_that_no_mesh_has_are_told_at_once_with_the_nearest_name() {
    let folder = tempfile::tempdir().unwrap();
    Small::calculix().write(folder.path());
    let path = folder.path().join("import.toml");
    let text = fs::read_to_string(&path).unwrap();
    let spoiled = text
        .replace("\"HIGH\"", "\"HIHG\"")
        .replace("\"RLOW\"", "\"RLW\"")
        .replace("ring = \"OUT\"", "ring = \"OUTER\"");
    fs::write(&path, spoiled).unwrap();
    let error = import(&path).unwrap_err();
    let message = error.to_string();
    for words in [
        "blisk.high_face = \"HIHG\" is not accepted; did you mean \"HIGH\"?",
        "ring.low_face = \"RLW\" is not accepted; did you mean \"RLOW\"?",
        "contact.ring = \"OUTER\" is not accepted; did you mean \"OUT\"?",
        "^^^^^^",
    ] {
        assert!(message.contains(words), "{words}: {message}");
    }
}
