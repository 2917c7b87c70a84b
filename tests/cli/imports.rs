//! `blisk import` from outside: a bundle that a study reads, exit codes, JSON.

use std::path::{Path, PathBuf};
use std::process::Command;

use blisk::model::sector::import::{IMPORT_TEMPLATES, import_keys, import_schema};

use crate::blisk::Place;
use crate::study_keys::{as_json, violations};

fn wheel() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/calculix_wheel/wheel_speed.toml")
}

/// The wheel at speed has an indefinite stiffness without contact; with contact it is solved.
const STUDY: &str = r#"schema = 1
[study]
name = "imported"
seed = 1
patterns = 2
[model]
source = "bundle"
[model.bundle]
path = "bundle"
[reduction]
basis = "stick_slide"
stick_modes = 3
slide_modes = 3
[contact]
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 2.0e7
normal_stiffness_n_per_m = 4.0e7
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [2]
amplitude_n = 1.0
[mistuning]
distribution = { kind = "normal", standard_deviation = 0.01 }
[sweep]
normal_load_n = ["slide", 100, "stuck"]
[solver]
harmonics = [1]
"#;

#[test]
fn a_wheel_of_calculix_goes_from_its_files_to_results() {
    let place = Place::with(STUDY);
    let file = wheel();
    let arguments = [
        "import",
        file.to_str().expect("UTF-8"),
        "--out",
        "bundle",
        "--frequencies",
        "3",
    ];
    let ended = place.run(&arguments);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stderr.contains("wrote the sector bundle bundle"),
        "{}",
        ended.stderr
    );
    for part in [
        "24 sectors",
        "288 dofs",
        "6000.000 rpm",
        "6 pairs",
        "by nodal diameter",
    ] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
    let frequencies =
        std::fs::read_to_string(place.path("bundle/frequencies.csv")).expect("written");
    assert_eq!(frequencies.lines().count(), 1 + 13 * 3);
    let ended = place.run(&["run", "study.toml", "--out", "results"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stdout.contains("6 rows ok, 0 failed"),
        "{}",
        ended.stdout
    );
}

#[test]
fn an_import_reports_as_json_and_prints_equations() {
    let place = Place::new();
    let file = wheel();
    let file = file.to_str().expect("UTF-8");
    let ended = place.run(&["import", file, "--out", "bundle", "--json"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let report: serde_json::Value = serde_json::from_str(&ended.stdout).expect("JSON");
    assert_eq!(report["contact"]["pairs"], 6);
    assert_eq!(report["bodies"][1]["body"], "ring");
    let ended = place.run(&["import", file, "--equations", "ring"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stdout.starts_with("*NSET,NSET=RING_CYCLIC"),
        "{}",
        ended.stdout
    );
}

#[test]
fn a_refused_import_ends_with_the_code_of_its_cause() {
    let place = Place::new();
    for (name, content, code, message) in [
        (
            "bad.toml",
            "code = \"calculix\"\nname = 1\n",
            4,
            "bad.toml:2",
        ),
        (
            "files.toml",
            "code = \"calculix\"\nname = \"x\"\nsectors = 3\n[blisk]\njob = \"absent\"\nblade_job = \"absent\"\nlow_face = \"A\"\nhigh_face = \"B\"\n\
             [[force]]\nnode = 1\ncomponent = \"z\"\n[[observe]]\nname = \"x\"\nnode = 1\n",
            7,
            "absent.inp",
        ),
    ] {
        place.write(name, content);
        let ended = place.run(&["import", name, "--out", "bundle"]);
        assert_eq!(ended.code, code, "{}", ended.stderr);
        assert!(ended.stderr.contains(message), "{}", ended.stderr);
        assert!(!place.path("bundle").exists());
    }
    assert_eq!(place.run(&["import"]).code, 2);
    assert_eq!(place.run(&["import", "bad.toml"]).code, 2);
    assert_eq!(place.run(&["import", "none.toml", "--out", "b"]).code, 7);
}

/// A bundle of a solid whose stiffness lost its couplings, as a study reads it.
#[test]
fn a_study_of_a_bundle_without_couplings_ends_with_4() {
    let place = Place::with(STUDY);
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wheel8");
    std::fs::create_dir(place.path("bundle")).expect("a folder");
    for entry in std::fs::read_dir(data).expect("a bundle") {
        let path = entry.expect("an entry").path();
        if path.is_file() {
            let name = path
                .file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            let mut text = std::fs::read_to_string(&path).expect("a file");
            if name == "K.mtx" {
                let kept: Vec<&str> = text
                    .lines()
                    .skip(1)
                    .filter(|line| {
                        let words: Vec<&str> = line.split_whitespace().collect();
                        words.len() == 3 && words[0] == words[1]
                    })
                    .collect();
                // The first of them is the line of sizes.
                let n = kept.len() - 1;
                text = format!(
                    "%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {n}\n{}\n",
                    kept[1..].join("\n")
                );
            }
            place.write(&format!("bundle/{name}"), &text);
        }
    }
    let ended = place.run(&["model", "study.toml"]);
    assert_eq!(ended.code, 4, "{}", ended.stderr);
    for words in [
        "K couples none of the 208 nodes",
        "was only one triangle of it written",
    ] {
        assert!(ended.stderr.contains(words), "{}", ended.stderr);
    }
}

/// Name and text of a file of a finite-element code, and what the answer to it must hold.
const FOREIGN: [(&str, &str, [&str; 3]); 13] = [
    (
        "wheel.cdb",
        "/COM,ANSYS RELEASE\n/PREP7\n",
        ["a mesh of Ansys", "--template ansys", "`blisk.mesh`"],
    ),
    (
        "wheel.txt",
        "/COM,ANSYS RELEASE\n/PREP7\n",
        ["a mesh of Ansys", "--template ansys", "`blisk.mesh`"],
    ),
    (
        "file.full",
        "\u{0}\u{1}",
        [
            "matrices of Ansys",
            "full_to_matrix_market.py file.full",
            "--template ansys",
        ],
    ),
    (
        "file.rst",
        "\u{0}\u{1}",
        [
            "result file of Ansys",
            "full_to_matrix_market.py",
            "WRFULL,1",
        ],
    ),
    (
        "k.mapping",
        "  Matrix Eqn   Node   DOF\n",
        ["rows of Ansys", "`blisk.dofs`", "--template ansys"],
    ),
    (
        "k.matrix",
        "title\n  1\n",
        ["Harwell-Boeing", "`blisk.stiffness`", "--template ansys"],
    ),
    (
        "k.mtx",
        "%%MatrixMarket matrix coordinate real symmetric\n",
        [
            "Matrix Market",
            "matrix_format = \"matrix_market\"",
            "`blisk.stiffness`",
        ],
    ),
    (
        "wheel.inp",
        "*NODE,NSET=ALL\n1,0,0,0\n",
        [
            "a deck of CalculiX or Abaqus",
            "--template calculix",
            "`blisk.job`",
        ],
    ),
    (
        "wheel.sti",
        "1 1 2.0\n",
        [
            "a matrix file of CalculiX",
            "--template calculix",
            "`blisk.job`",
        ],
    ),
    (
        "wheel.bdf",
        "BEGIN BULK\nGRID,1,,0.,0.,0.\n",
        ["bulk data of Nastran", "--template nastran", "`blisk.mesh`"],
    ),
    (
        "wheel.pch",
        "DMIG    KAAX           0       6\n",
        [
            "a punch file of Nastran",
            "--template nastran",
            "`blisk.stiffness`",
        ],
    ),
    (
        "wheel.op4",
        "       2       2       6       2KAA\n",
        ["OUTPUT4", "matrix_format = \"op4\"", "--template nastran"],
    ),
    (
        "wheel.op2",
        "\u{0}\u{1}",
        [
            "result file of Nastran",
            "OUTPUT4 in ASCII",
            "--template nastran",
        ],
    ),
];

#[test]
fn a_file_of_another_code_in_the_place_of_an_import_file_is_answered_with_the_command_to_type() {
    let place = Place::new();
    for (name, text, words) in FOREIGN {
        place.write(name, text);
        let ended = place.run(&["import", name, "--out", "bundle"]);
        assert_eq!(ended.code, 2, "{name}: {}", ended.stderr);
        assert!(
            ended.stderr.contains("not an import file"),
            "{}",
            ended.stderr
        );
        for part in words {
            assert!(
                ended.stderr.contains(part),
                "{name}: {part}: {}",
                ended.stderr
            );
        }
    }
    // What is an import file by its text is one under any name.
    place.write("import.inp", "code = \"calculix\"\n");
    let ended = place.run(&["import", "import.inp", "--out", "bundle"]);
    assert_eq!(ended.code, 4, "{}", ended.stderr);
    assert!(
        ended.stderr.contains("sectors is missing"),
        "{}",
        ended.stderr
    );
}

#[test]
fn a_mesh_of_another_code_is_refused_by_what_it_is_and_what_is_accepted() {
    let place = Place::new();
    let (_, template) = { IMPORT_TEMPLATES.iter() }
        .find(|(name, _)| *name == "nastran")
        .expect("a template");
    place.write("wheel.toml", &template.replace("wheel.bdf", "sector.cdb"));
    place.write("sector.cdb", "/PREP7\nN,R5.3,LOC, -1,\n");
    let ended = place.run(&["import", "wheel.toml", "--out", "bundle"]);
    assert_eq!(ended.code, 4, "{}", ended.stderr);
    for words in [
        "sector.cdb",
        "mesh_format",
        "\"nastran\"",
        "it is a mesh of Ansys",
        "accepted: bulk data of Nastran with GRID, or the mesh_format of this file: calculix, ansys or nastran",
    ] {
        assert!(ended.stderr.contains(words), "{words}: {}", ended.stderr);
    }
}

#[test]
fn templates_explanations_and_the_schema_of_import_files_are_printed() {
    let place = Place::new();
    for (code, text) in IMPORT_TEMPLATES {
        let ended = place.run(&["import", "--template", code]);
        assert_eq!(
            (ended.code, ended.stdout.as_str()),
            (0, text),
            "{}",
            ended.stderr
        );
    }
    assert_eq!(place.run(&["import", "--template", "abaqus"]).code, 2);
    let all = place.run(&["explain", "import"]);
    assert_eq!(all.code, 0, "{}", all.stderr);
    for key in import_keys() {
        let name = format!("import.{}", key.key);
        assert!(all.stdout.contains(&name), "{name}");
        let ended = place.run(&["explain", &name]);
        assert_eq!(ended.code, 0, "{name}: {}", ended.stderr);
        assert!(ended.stdout.starts_with(&name), "{name}: {}", ended.stdout);
    }
    let short = place.run(&["explain", "contact.pairing"]);
    assert!(
        short.stdout.starts_with("import.contact.pairing\n"),
        "{}",
        short.stdout
    );
    let wrong = place.run(&["explain", "import.contact.pairin"]);
    assert_eq!(wrong.code, 2);
    assert!(
        wrong
            .stderr
            .contains("did you mean import.contact.pairing?"),
        "{}",
        wrong.stderr
    );
    let printed = place.run(&["schema", "--import"]).stdout;
    let printed: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(printed, import_schema());
}

#[test]
fn the_schema_of_import_files_accepts_all_there_are_and_the_guide_has_every_key() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let schema = import_schema();
    let mut texts: Vec<String> = IMPORT_TEMPLATES.map(|(_, text)| text.to_owned()).to_vec();
    for folder in ["studies/calculix", "tests/data/calculix_wheel"] {
        for state in ["rest", "speed"] {
            let path = root.join(folder).join(format!("wheel_{state}.toml"));
            texts.push(std::fs::read_to_string(path).expect("an import file"));
        }
    }
    texts.push(texts[0].replace("\n[contact]", "\n[[contact]]"));
    let wedge = "[damper]\nset = \"W\"\n[[contact]]\nfirst = \"damper.W\"\nsecond = \"ground\"\n\n[[contact]]";
    texts.push(texts[0].replace("\n[contact]", &format!("\n{wedge}")));
    for text in &texts {
        assert_eq!(
            violations(&schema, &as_json(text), ""),
            Vec::<String>::new(),
            "{text}"
        );
    }
    for (good, bad) in [
        ("sectors = 24", "sectors = 0"),
        ("sectors = 24", "sektors = 24"),
        ("\n[contact]", "\n[contact]\npairing = \"near\""),
        ("\n[contact]", "\n[[contact]]\npairing = \"near\""),
        ("\n[contact]", "\n[[contact]]\nthird = \"ground\""),
        ("component = \"z\"", ""),
    ] {
        let spoiled = texts[0].replace(good, bad);
        assert_ne!(
            violations(&schema, &as_json(&spoiled), ""),
            Vec::<String>::new(),
            "{bad}"
        );
    }
    let guide = std::fs::read_to_string(root.join("docs/import.md")).expect("the guide");
    let table = guide
        .split("## What is done with it")
        .next()
        .expect("its first part");
    for key in import_keys() {
        let name = key.key.rsplit('.').next().expect("a name");
        let named = [
            format!("`{name}`"),
            format!("`[{name}]`"),
            format!("`[[{name}]]`"),
        ];
        assert!(named.iter().any(|name| table.contains(name)), "{}", key.key);
    }
}

#[test]
fn an_import_file_may_come_through_a_pipe() {
    let place = Place::new();
    let output = Command::new("sh")
        .args([
            "-c",
            "printf 'code = \"calculix\"\\n' | \"$0\" import /dev/stdin --out out",
        ])
        .arg(env!("CARGO_BIN_EXE_blisk"))
        .current_dir(place.path("."))
        .output()
        .expect("a shell");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.contains("sectors is missing"), "{stderr}");
    assert!(!stderr.contains("code is missing"), "{stderr}");
}

#[test]
fn the_guide_names_the_scripts_for_ansys() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let guide = std::fs::read_to_string(root.join("docs/import.md")).expect("the guide");
    for entry in std::fs::read_dir(root.join("studies/ansys")).expect("the scripts") {
        let entry = entry.expect("a script").path();
        if entry.is_dir() {
            continue; // What Python leaves there.
        }
        let name = entry.file_name().expect("a name");
        let path = format!("studies/ansys/{}", name.display());
        assert!(guide.contains(&path), "docs/import.md does not name {path}");
    }
}
