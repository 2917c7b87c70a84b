//! Several force vectors in one study, from outside: each load case is what it is alone.

use std::path::Path;

use blisk::population::monte_carlo::ResponseRow;
use blisk::population::table::{Manifest, ResponseReader};
use polars::prelude::{ParquetReader, SerReader};

use crate::blisk::{GOOD, Place};

/// [`GOOD`] with this in the place of its excitation.
fn study(name: &str, excitation: &str) -> String {
    GOOD.replace("name = \"small\"", &format!("name = \"{name}\""))
        .replace(
            "[excitation]\nengine_orders = [2]\namplitude_n = 10.0\n",
            excitation,
        )
}

const ON_BLADE: &str =
    "[[excitation.load_case]]\nname = \"blade\"\nengine_orders = [2]\namplitude_n = 10.0\n\n";
const ON_DISK: &str = "[[excitation.load_case]]\nname = \"disk\"\nforce = \"disk.csv\"\n\
                       engine_orders = [1, 2]\namplitude_n = [20.0, 40.0]\n\n";

/// Rows of the results `name` under a load case, without the places of their scenarios.
fn rows(place: &Place, name: &str, load_case: Option<&str>) -> Vec<ResponseRow> {
    let folder = place.path(&format!("results/{name}"));
    let manifest = Manifest::read(&folder).expect("a manifest").expect("there");
    let names: Vec<Option<String>> = manifest
        .scenarios
        .iter()
        .map(|own| own.load_case.map(|name| name.to_string()))
        .collect();
    let first = names.iter().position(|own| own.as_deref() == load_case);
    let first = first.expect("scenarios of the load case");
    let table = folder.join("responses.parquet");
    let mut reader = ResponseReader::open(&table).expect("a table");
    let all = reader.next_batch().expect("rows");
    all.into_iter()
        .filter(|row| names[row.scenario].as_deref() == load_case)
        .map(|row| ResponseRow {
            scenario: row.scenario - first,
            ..row
        })
        .collect()
}

fn run(place: &Place, name: &str, excitation: &str) {
    place.write("study.toml", &study(name, excitation));
    let ended = place.run(&["run", "study.toml"]);
    assert_eq!(ended.code, 0, "{}{}", ended.stdout, ended.stderr);
}

fn text_column(path: &Path, name: &str) -> Vec<String> {
    let file = std::fs::File::open(path).expect("a table");
    let table = ParquetReader::new(file).finish().expect("Parquet");
    let column = table.column(name).expect(name).str().expect("texts");
    column.iter().flatten().map(str::to_owned).collect()
}

#[test]
fn two_load_cases_in_one_study_are_two_studies_of_one_bit_for_bit() {
    let place = Place::new();
    place.write("disk.csv", "dof,re,im\n1,1.0,0.5\n");
    run(&place, "both", &format!("{ON_BLADE}{ON_DISK}"));
    run(&place, "first", ON_BLADE);
    run(&place, "second", ON_DISK);
    run(
        &place,
        "plain",
        "[excitation]\nengine_orders = [2]\namplitude_n = 10.0\n",
    );
    let (blade, disk) = (
        rows(&place, "both", Some("blade")),
        rows(&place, "both", Some("disk")),
    );
    assert_eq!((blade.len(), disk.len()), (30, 60));
    // All wheels are the same, so that the cases can be told apart by their forces alone.
    assert!(blade[0].peak_amplitude_m != disk[0].peak_amplitude_m);
    assert_eq!(blade, rows(&place, "first", Some("blade")));
    assert_eq!(disk, rows(&place, "second", Some("disk")));
    assert_eq!(blade, rows(&place, "plain", None));

    // Tables, reports and commands tell them apart; a study without load cases has no such column.
    let results = place.path("results/both");
    for (table, count) in [("responses", 90), ("scenarios", 9)] {
        let names = text_column(&results.join(format!("{table}.parquet")), "load_case");
        assert_eq!(names.len(), count);
        assert_eq!(
            names.iter().filter(|name| *name == "disk").count(),
            2 * count / 3
        );
    }
    let plain = place.path("results/plain/responses.parquet");
    let plain = ParquetReader::new(std::fs::File::open(plain).expect("a table"));
    let plain = plain.finish().expect("Parquet");
    assert!(plain.column("load_case").is_err());
    let stats = place.run(&["stats", "results/both"]);
    for heading in [
        "load case blade, engine order 2, standard deviation 3 %",
        "load case disk, engine order 1, standard deviation 3 %",
        "load case disk, engine order 2, standard deviation 3 %",
    ] {
        assert!(stats.stdout.contains(heading), "{}", stats.stdout);
    }
    let compared = place.run(&["compare", "results/both", "--percentile", "50"]);
    assert!(
        compared.stdout.contains("slide (disk, EO 1, 3 %)"),
        "{}",
        compared.stdout
    );
    let report = place.run(&["report", "results/both", "--json", "--no-curves"]);
    let report: serde_json::Value = serde_json::from_str(&report.stdout).expect("JSON");
    let groups = report["groups"].as_array().expect("groups");
    let cases: Vec<_> = groups.iter().map(|own| own["load_case"].as_str()).collect();
    assert_eq!(cases, [Some("blade"), Some("disk"), Some("disk")]);
    let out = ["--out", "figure.svg"];
    let which = ["plot", "results/both", "amplitude", "--load-case"];
    let ended = place.run(&[&which[..], &["disk", "--engine-order", "2"], &out].concat());
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert_eq!(place.run(&[&which[..], &["disk"], &out].concat()).code, 2);
    let curve = [
        "response",
        "study.toml",
        "--pattern",
        "1",
        "--load",
        "50",
        "--frequencies",
        "350:370:3",
    ];
    place.write(
        "study.toml",
        &study("both", &format!("{ON_BLADE}{ON_DISK}")),
    );
    let ended = place.run(&[&curve[..], &["--out", "curve.csv"]].concat());
    assert!(
        ended.code == 2 && ended.stderr.contains("one of blade, disk"),
        "{}",
        ended.stderr
    );
    let ended = place.run(&[&curve[..], &["--out", "curve.csv", "--load-case", "blade"]].concat());
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let ended = place.run(&["verify", "study.toml", "--sample", "4"]);
    assert_eq!(ended.code, 0, "{}{}", ended.stdout, ended.stderr);
    let ended = place.run(&["run", "study.toml"]);
    assert!(
        ended.stderr.contains("nothing to solve"),
        "{}",
        ended.stderr
    );
    // Another force in the same file is another study.
    place.write("disk.csv", "dof,re,im\n1,1.0,0.6\n");
    let ended = place.run(&["run", "study.toml"]);
    assert_eq!(ended.code, 9, "{}", ended.stderr);
    assert!(
        ended.stderr.contains("excitation.load_case/disk"),
        "{}",
        ended.stderr
    );
}

#[test]
fn amplitudes_follow_the_force_and_its_phase_is_of_no_account() {
    let place = Place::new();
    // A node of the model as force, the same force of 3 N turned by 90 degrees, and by its name.
    place.write("turned.csv", "dof,re,im\n0,0.0,3.0\n");
    let excitation = "[excitation]\nengine_orders = [2]\n\n\
        [[excitation.load_case]]\nname = \"one\"\namplitude_n = 10.0\n\n\
        [[excitation.load_case]]\nname = \"turned\"\nforce = \"turned.csv\"\namplitude_n = 10.0\n\n\
        [[excitation.load_case]]\nname = \"node\"\nnode = \"blade\"\ndirection = [0, -2, 0]\namplitude_n = 10.0\n";
    let tight = study("scaled", excitation)
        .replace("[\"slide\", 50, \"stuck\"]", "[\"slide\", 50, 150]")
        .replace(
            "harmonics = [1, 3]",
            "harmonics = [1, 3]\npeak_tolerance = 1.0e-8",
        );
    place.write("study.toml", &tight);
    let ended = place.run(&["run", "study.toml"]);
    assert_eq!(ended.code, 0, "{}{}", ended.stdout, ended.stderr);
    let of = |case| rows(&place, "scaled", Some(case));
    let (one, turned, node) = (of("one"), of("turned"), of("node"));
    let amplitude = |rows: &[ResponseRow], scenario: usize, pattern: u32| {
        let row = rows
            .iter()
            .find(|row| row.scenario == scenario && row.pattern == pattern);
        row.and_then(|row| row.peak_amplitude_m).expect("a peak")
    };
    for pattern in 0..10 {
        // u(3 F, 3 N0) = 3 u(F, N0); a linear limit has no load.
        for (own, other) in [(0, 0), (1, 2)] {
            let ratio = amplitude(&turned, other, pattern) / amplitude(&one, own, pattern);
            assert!((ratio / 3.0 - 1.0).abs() < 1e-7, "{pattern}: {ratio}");
        }
        for scenario in 0..3 {
            let ratio = amplitude(&node, scenario, pattern) / amplitude(&one, scenario, pattern);
            assert!((ratio - 1.0).abs() < 1e-9, "{pattern}: {ratio}");
        }
    }
}

/// The wheel of 8 sectors with little to solve.
fn wheel(bundle: &str, name: &str, excitation: &str) -> String {
    format!(
        "schema = 1\n\n[study]\nname = \"{name}\"\nseed = 3\npatterns = 2\n\n[model]\nsource = \"bundle\"\n\n\
         [model.bundle]\npath = \"{bundle}\"\n\n[reduction]\nbasis = \"stick_slide\"\nstick_modes = 4\nslide_modes = 4\n\
         craig_bampton_modes = 25\n\n[contact]\nlaw = \"simplified_3d\"\nfriction_coefficient = 0.3\n\
         tangential_stiffness_n_per_m = 1.0e8\nnormal_stiffness_n_per_m = 2.0e8\n\n[damping]\n\
         structural_loss_factor = 0.002\n\n[mistuning]\ndistribution = {{ kind = \"normal\" }}\n\n[sweep]\n\
         normal_load_n = [\"stuck\", 200]\nstandard_deviation = [0.02]\n\n[solver]\nharmonics = [1]\n\n{excitation}"
    )
}

#[test]
fn an_imported_bundle_has_its_second_force_as_if_it_were_its_own() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wheel8");
    let place = Place::new();
    // The trailing edge of the tip: node 197 of the bundle.
    let dofs = std::fs::read_to_string(data.join("dofs.csv")).expect("dofs");
    let dof = |component: &str| -> String {
        let fits = |line: &&str| {
            let fields: Vec<&str> = line.split(',').collect();
            fields[1] == "197" && fields[2] == component
        };
        let line = dofs.lines().skip(1).find(fits).expect("a dof");
        line.split(',').next().expect("a number").to_owned()
    };
    let second = format!("dof,re,im\n{},0.0,0.8\n{},0.6,0.0\n", dof("t"), dof("z"));
    place.write("second.csv", &second);
    std::fs::create_dir(place.path("other")).expect("a folder");
    for entry in std::fs::read_dir(&data).expect("the bundle") {
        let path = entry.expect("a file").path();
        if path.is_file() {
            let name = path.file_name().expect("a name");
            std::fs::copy(&path, place.path("other").join(name)).expect("a copy");
        }
    }
    place.write("other/force.csv", &second);
    let bundle = data.to_str().expect("a path");
    let cases = "[excitation]\nengine_orders = [2]\n\n[[excitation.load_case]]\nname = \"own\"\n\n\
                 [[excitation.load_case]]\nname = \"second\"\nforce = \"second.csv\"\n";
    let plain = "[excitation]\nengine_orders = [2]\n";
    for (bundle, name, excitation) in [
        (bundle, "cases", cases),
        (bundle, "plain", plain),
        ("other", "other", plain),
    ] {
        place.write("study.toml", &wheel(bundle, name, excitation));
        let ended = place.run(&["run", "study.toml"]);
        assert_eq!(ended.code, 0, "{name}: {}{}", ended.stdout, ended.stderr);
    }
    let stated = |row: ResponseRow| ResponseRow {
        // The error of the basis is the largest under both forces.
        stated_error: None,
        ..row
    };
    for (case, alone) in [("own", "plain"), ("second", "other")] {
        let own: Vec<_> = rows(&place, "cases", Some(case))
            .into_iter()
            .map(stated)
            .collect();
        let alone: Vec<_> = rows(&place, alone, None).into_iter().map(stated).collect();
        assert_eq!(own.len(), 4);
        assert_eq!(own, alone, "{case}");
    }
}

#[test]
fn forces_that_the_model_refuses_are_told_with_key_and_line() {
    let place = Place::new();
    place.write("far.csv", "dof,re,im\n9,1.0,0.0\n");
    place.write("words.csv", "dof,re,im\n0,one,0.0\n");
    place.write("zero.csv", "dof,re,im\n0,0.0,0.0\n");
    for (force, key, words) in [
        (
            "force = \"far.csv\"",
            "excitation.load_case[0].force",
            "dof 9",
        ),
        (
            "force = \"words.csv\"",
            "excitation.load_case[0].force",
            "one",
        ),
        (
            "force = \"zero.csv\"",
            "excitation.load_case[0].force",
            "no force",
        ),
        ("force = \"none.csv\"", "none.csv", "none.csv"),
        (
            "node = \"tip\"\ndirection = [0, 1, 0]",
            "excitation.load_case[0].node",
            "accepted: \"blade\"",
        ),
        (
            "node = \"blade\"\ndirection = [1, 1, 0]",
            "excitation.load_case[0].direction",
            "does not move along r",
        ),
    ] {
        let case = format!(
            "[excitation]\nengine_orders = [2]\n\n[[excitation.load_case]]\nname = \"a\"\n{force}\n"
        );
        place.write("study.toml", &study("bad", &case));
        let ended = place.run(&["check", "study.toml"]);
        assert_ne!(ended.code, 0, "{force}");
        for part in [key, words] {
            assert!(
                ended.stderr.contains(part),
                "{force}: {part}: {}",
                ended.stderr
            );
        }
    }
}
