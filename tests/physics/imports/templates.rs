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

/// What the templates say of dampers other than a ring is an import file, too.
#[test]
fn the_wedge_of_each_template_stands_in_the_place_of_its_ring() {
    for (code, text) in IMPORT_TEMPLATES {
        let (head, tail) = text.split_once("[ring]").unwrap();
        let (_, tail) = tail.split_once("# Dampers other than a ring").unwrap();
        let (wedge, tail) = tail.split_once("\n\n").unwrap();
        let wedge = wedge.lines().skip(1).map(|line| line.replacen("# ", "", 1));
        let wedge: Vec<String> = wedge.collect();
        let text = format!("{head}{}\n\n{tail}", wedge.join("\n"));
        assert_eq!(wedge.len(), 11, "{text}");
        assert_eq!(findings(&text), [], "{code}: {text}");
        // Shares by the user in the place of those by area: in both contacts, or in none.
        let shared = text.replace("# weight = ", "weight = ");
        assert_eq!(shared.matches("\nweight = ").count(), 2, "{shared}");
        assert_eq!(findings(&shared), [], "{code}: {shared}");
        let one = text.replacen("# weight = ", "weight = ", 1);
        assert!(findings(&one)[0].1.contains("weight"), "{code}");
        // It would be missed.
        let without = text.replace("damper.", "blisk.");
        assert!(findings(&without)[0].2.contains("nothing holds the damper"));
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

/// Keys in the place of others.
const INSTEAD: [&str; 5] = [
    "blisk.blade_elements",
    "ring.set",
    "damper.set",
    "contact.first",
    "contact.second",
];

/// An import file with every key, or without one.
fn every_key(left_out: &str) -> String {
    let mut text = String::new();
    for key in import_keys() {
        let name = key.key.rsplit('.').next().unwrap();
        match key.value {
            Value::Table | Value::TableOrTables => writeln!(text, "[{}]", key.key).unwrap(),
            Value::Tables => writeln!(text, "[[{}]]", key.key).unwrap(),
            // Either a node or a set; either sets or files of their own for blade, ring and damper; either
            // `blisk` and `ring` or the sides of a contact.
            _ if key.key == left_out || name == "node" => {}
            _ if INSTEAD.contains(&key.key.as_str()) => {}
            value => writeln!(text, "{name} = {}", sample(value)).unwrap(),
        }
    }
    text
}

#[test]
fn every_key_of_an_import_file_is_one_that_its_reader_knows() {
    // A contact of blisk and ring alone holds no damper.
    let unheld = |text: &str| {
        let found = findings(text).into_iter();
        found
            .filter(|(_, key, _)| key != "damper")
            .collect::<Vec<_>>()
    };
    assert_eq!(unheld(&every_key("")), []);
    assert_eq!(
        findings(&every_key("")).len(),
        1,
        "nothing holds the damper"
    );
    let mut missed = BTreeSet::new();
    for key in import_keys() {
        if matches!(
            key.value,
            Value::Table | Value::Tables | Value::TableOrTables
        ) {
            continue;
        }
        let table = key.key.rsplit_once('.').map_or("", |(table, _)| table);
        let found = findings(&every_key(&key.key));
        let misses = found.iter().any(|(_, missing, said)| {
            missing.replace("[0]", "") == key.key && said.contains("is missing")
        });
        let either = ["force.set", "observe.set", "contact.blisk", "contact.ring"];
        let needed = key.required || either.contains(&key.key.as_str());
        assert_eq!(misses, needed, "{}: {found:?}", key.key);
        missed.extend(misses.then_some(table.to_owned()));
    }
    assert!(missed.len() >= 5, "{missed:?}");
}

/// A list of contacts has every key of a contact as well, and needs both of its sides.
#[test]
fn every_key_of_a_contact_is_one_of_a_list_of_contacts() {
    let listed = |sides: &str| {
        let start = every_key("").find("[contact]").unwrap();
        let text = every_key("").replacen("[contact]", "[[contact]]", 1);
        let (head, tail) = text.split_at(start);
        let kept = |line: &&str| !line.starts_with("blisk =") && !line.starts_with("ring =");
        let tail: Vec<&str> = tail.lines().filter(kept).collect();
        let tail = tail.join("\n");
        let with_sides = tail.replacen("[[contact]]", &format!("[[contact]]\n{sides}"), 1);
        let damper = "[[contact]]\nfirst = \"damper.A\"\nsecond = \"ground\"\nweights = \"equal\"\nweight = 1.0\n";
        findings(&format!("{head}{damper}{with_sides}"))
    };
    let both = "first = \"blisk.x\"\nsecond = \"ring.x\"";
    assert_eq!(listed(both), []);
    for (sides, missing) in [
        ("first = \"blisk.x\"", "contact[1].second"),
        ("second = \"ring.x\"", "contact[1].first"),
    ] {
        let found = listed(sides);
        let [(_, key, said)] = found.as_slice() else {
            panic!("{found:?}");
        };
        assert_eq!(key, missing);
        assert!(said.contains("is missing; accepted: BODY.SET"), "{said}");
    }
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
