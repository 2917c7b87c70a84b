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
        compared
            .stdout
            .contains("load case disk, engine order 1, standard deviation 3 %, against"),
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
    place.write("faint.csv", "dof,re,im\n0,1e-80,0.0\n");
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
        (
            "force = \"faint.csv\"",
            "excitation.load_case[0].force",
            "accepted: 1e-30 to 1e30 N",
        ),
        (
            "amplitude_n = 1e-31",
            "excitation.load_case[0].amplitude_n = 1e-31",
            "from 1e-30 to 1e30, in N",
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

/// A wheel imported from a finite-element code, its basis left to the program.
fn imported(basis: &str, bundle: &str, name: &str, excitation: &str) -> String {
    format!(
        "schema = 1\n\n[study]\nname = \"{name}\"\nseed = 1\npatterns = 2\n\n[model]\nsource = \"bundle\"\n\n\
         [model.bundle]\npath = \"{bundle}\"\n\n[reduction]\nbasis = \"{basis}\"\n\n[contact]\n\
         friction_coefficient = 0.3\ntangential_stiffness_n_per_m = 2.0e7\nnormal_stiffness_n_per_m = 4.0e7\n\n\
         [damping]\nstructural_loss_factor = 0.002\n\n[mistuning]\n\
         distribution = {{ kind = \"normal\", standard_deviation = 0.01 }}\n\n[sweep]\n\
         normal_load_n = [\"stuck\", 40]\n\n[solver]\nharmonics = [1]\n\n{excitation}"
    )
}

#[test]
fn an_imported_finite_element_wheel_has_one_basis_for_all_its_forces() {
    let wheel = Path::new(env!("CARGO_MANIFEST_DIR"));
    let wheel = wheel.join("tests/data/calculix_wheel/wheel_rest.toml");
    let wheel = wheel.to_str().expect("a path");
    let place = Place::new();
    // The tip along r and t; the wheel's own force is along z.
    let second = "dof,re,im\n192,0.6,0.0\n193,0.0,0.8\n";
    place.write("second.csv", second);
    for bundle in ["own", "other"] {
        let ended = place.run(&["import", wheel, "--out", bundle]);
        assert_eq!(ended.code, 0, "{}", ended.stderr);
    }
    assert_ne!(
        std::fs::read_to_string(place.path("own/force.csv")).expect("a force"),
        second
    );
    place.write("other/force.csv", second);
    let cases = "[excitation]\nengine_orders = [2]\n\n[[excitation.load_case]]\nname = \"own\"\n\n\
                 [[excitation.load_case]]\nname = \"second\"\nforce = \"second.csv\"\namplitude_n = 4.0\n";
    let plain = "[excitation]\nengine_orders = [2]\n";
    let strong = "[excitation]\nengine_orders = [2]\namplitude_n = 4.0\n";
    let mut bases = Vec::new();
    for (bundle, name, excitation) in [
        ("own", "cases", cases),
        ("own", "first", plain),
        ("other", "second", strong),
    ] {
        let text = imported("stick_slide", bundle, name, excitation);
        place.write("study.toml", &text);
        let ended = place.run(&["run", "study.toml"]);
        assert_eq!(ended.code, 0, "{name}: {}{}", ended.stdout, ended.stderr);
        let manifest = Manifest::read(&place.path(&format!("results/{name}")));
        let chosen = manifest.expect("a manifest").expect("there").chosen;
        bases.push(chosen["basis"].as_str().expect("a basis").to_owned());
    }
    let stated = |row: &ResponseRow| ResponseRow {
        // The error of the basis is the largest under both forces.
        stated_error: None,
        ..row.clone()
    };
    let of_case = |case| rows(&place, "cases", Some(case));
    let (own, other) = (of_case("own"), of_case("second"));
    let (first, second) = (rows(&place, "first", None), rows(&place, "second", None));
    // The harder of the two forces decides the basis of both, and has what it has alone.
    assert_eq!(bases[0], bases[1]);
    assert_eq!(own.len(), 4);
    assert!(own.iter().map(stated).eq(first.iter().map(stated)));
    // The other one meets its error with fewer vectors too.
    assert_ne!(bases[0], bases[2]);
    for (own, alone) in other.iter().zip(&second) {
        let amplitude = |row: &ResponseRow| row.peak_amplitude_m.expect("a peak");
        let ratio = amplitude(own) / amplitude(alone);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        assert!(own.stated_error >= Some((ratio - 1.0).abs()));
    }
    assert!(other.iter().any(|row| row.slipping_fraction > Some(0.0)));
}

/// A small sector, of which the fixed-interface modes of the default are half of the degrees of freedom.
#[test]
fn an_imported_finite_element_wheel_is_solved_by_default_and_by_a_basis() {
    let wheel = Path::new(env!("CARGO_MANIFEST_DIR"));
    let wheel = wheel.join("tests/data/calculix_wheel/wheel_rest.toml");
    let place = Place::new();
    let ended = place.run(&["import", wheel.to_str().expect("a path"), "--out", "own"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    for basis in ["auto", "stick_slide"] {
        let text = imported(basis, "own", basis, "[excitation]\nengine_orders = [2]\n");
        place.write("study.toml", &text);
        let ended = place.run(&["run", "study.toml"]);
        assert_eq!(ended.code, 0, "{basis}: {}{}", ended.stdout, ended.stderr);
    }
    let (own, by_basis) = (
        rows(&place, "auto", None),
        rows(&place, "stick_slide", None),
    );
    assert_eq!(own.len(), 4);
    for (own, other) in own.iter().zip(&by_basis) {
        assert_eq!(own.basis, "tuned_receptances");
        let amplitude = |row: &ResponseRow| row.peak_amplitude_m.expect("a peak");
        let ratio = amplitude(own) / amplitude(other);
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
    }
}

/// [`study`] with this accepted error in the place of its harmonics, at two loads.
fn accurate(name: &str, excitation: &str, accepted: f64) -> String {
    let study = study(name, excitation)
        .replace("[solver]\nharmonics = [1, 3]\n", "")
        .replace("[\"slide\", 50, \"stuck\"]", "[50, \"stuck\", 150]")
        .replace("patterns = 10", "patterns = 40");
    format!("{study}\n[accuracy]\namplitude_error = {accepted}\n")
}

fn chosen(place: &Place, name: &str) -> serde_json::Value {
    let manifest = Manifest::read(&place.path(&format!("results/{name}")));
    manifest.expect("a manifest").expect("there").chosen["accuracy"].clone()
}

#[test]
fn an_accepted_error_chooses_settings_that_hold_under_every_load_case() {
    let place = Place::new();
    place.write("disk.csv", "dof,re,im\n1,1.0,0.5\n");
    let run = |name: &str, study: &str, more: &[&str]| {
        place.write("study.toml", study);
        let out = format!("results/{name}");
        let ended = place.run(&[&["run", "study.toml", "--out", &out], more].concat());
        assert_eq!(ended.code, 0, "{}{}", ended.stdout, ended.stderr);
    };
    // One load case is the study without it, evidence included.
    let plain = "[excitation]\nengine_orders = [2]\namplitude_n = 10.0\n";
    run("plain", &accurate("a", plain, 0.02), &[]);
    run("first", &accurate("a", ON_BLADE, 0.02), &[]);
    let (of_plain, mut of_first) = (chosen(&place, "plain"), chosen(&place, "first"));
    let evidence = of_first["evidence"].as_object_mut().expect("evidence");
    let names = evidence.remove("load_cases").expect("named scenarios");
    assert_eq!(names, serde_json::json!(["blade", "blade"]));
    let of_blade = evidence.remove("errors_of_load_cases").expect("errors");
    assert_eq!(of_blade[0]["amplitude"], of_plain["evidence"]["amplitude"]);
    assert_eq!(of_first, of_plain);
    assert_eq!(
        rows(&place, "first", Some("blade")),
        rows(&place, "plain", None)
    );

    let both = accurate("a", &format!("{ON_BLADE}{ON_DISK}"), 0.02);
    run("both", &both, &["--threads", "1"]);
    run("threads", &both, &["--threads", "2"]);
    for table in ["responses.parquet", "manifest.json"] {
        let read = |name| std::fs::read(place.path(&format!("results/{name}/{table}")));
        assert!(read("both").expect(table) == read("threads").expect(table));
    }
    let of_both = chosen(&place, "both");
    assert_eq!(of_both["met"], true);
    let evidence = &of_both["evidence"];
    let names = ["blade", "blade", "disk", "disk", "disk", "disk"];
    assert_eq!(evidence["load_cases"], serde_json::json!(names));
    let errors = evidence["errors_of_load_cases"].as_array().expect("errors");
    let counts: Vec<_> = errors
        .iter()
        .map(|own| {
            let worst = own["amplitude"]["worst"].as_f64().expect("an error");
            assert!(worst <= 0.02, "{own}");
            (own["load_case"].as_str(), own["amplitude"]["rows"].as_u64())
        })
        .collect();
    assert_eq!(
        counts,
        [(Some("blade"), Some(12)), (Some("disk"), Some(24))]
    );
    // What is claimed holds on all rows of each case, against settings that leave nothing out.
    let tight = accurate("a", &format!("{ON_BLADE}{ON_DISK}"), 0.02).replace(
        "[accuracy]\namplitude_error = 0.02\n",
        "[reduction]\nbasis = \"stick_slide\"\n[solver]\nharmonic_tolerance = 1e-3\nsamples_per_period = 512\n\
         residual_tolerance = 1e-10\npeak_tolerance = 1e-4\n",
    );
    run("tight", &tight, &[]);
    for case in ["blade", "disk"] {
        let (own, exact) = (
            rows(&place, "both", Some(case)),
            rows(&place, "tight", Some(case)),
        );
        let error = |(own, exact): (&ResponseRow, &ResponseRow)| {
            (own.peak_amplitude_m.expect("a peak") / exact.peak_amplitude_m.expect("a peak") - 1.0)
                .abs()
        };
        let errors: Vec<f64> = own.iter().zip(&exact).map(error).collect();
        let within = errors.iter().filter(|&&error| error <= 0.02).count();
        assert!(
            within as f64 >= 0.95 * errors.len() as f64,
            "{case}: {errors:?}"
        );
        assert!(errors.iter().any(|&error| error > 0.0), "{case}");
    }
    let replay = [
        "verify",
        "results/both",
        "--scenario",
        "5",
        "--pattern",
        "3",
    ];
    let replay = place.run(&replay);
    assert!(replay.stdout.contains("bit-identical"), "{}", replay.stdout);
}

#[test]
fn a_trade_off_says_under_which_load_case_its_rows_are() {
    let place = Place::new();
    place.write("disk.csv", "dof,re,im\n1,1.0,0.5\n");
    let trade = |excitation: &str, out: &str, more: &[&str]| {
        place.write("study.toml", &study("a", excitation));
        let ended = place.run(
            &[
                &["tradeoff", "study.toml", "--patterns", "3", "--out", out],
                more,
            ]
            .concat(),
        );
        assert_eq!(ended.code, 0, "{}", ended.stderr);
        ended.stdout
    };
    let both = format!("{ON_BLADE}{ON_DISK}");
    let more = ["--reference", "full", "--json"];
    let report = json(&trade(&both, "both", &more));
    assert_eq!(
        report["load_cases"],
        serde_json::json!(["blade", "disk", "disk"])
    );
    assert_eq!(report["scenarios"], serde_json::json!([1, 4, 7]));
    let checks = report["reference"]["full_contact"]
        .as_array()
        .expect("checks");
    for (check, name) in checks.iter().zip(["blade", "disk", "disk"]) {
        assert_eq!(check["load_case"], name);
        let error = check["amplitude_error"].as_f64().expect("an error");
        assert!(error.abs() < 3e-4, "{check}");
    }
    assert_eq!(checks.len(), 3);
    for choice in report["choices"].as_array().expect("choices") {
        let cases = choice["load_cases"].as_array().expect("errors");
        let chosen = choice["setting"].as_u64().expect("a setting") as usize;
        let of = |own: &serde_json::Value| own["amplitude"]["worst"].as_f64().expect("an error");
        let worst = cases.iter().map(of).fold(0.0, f64::max);
        assert!((worst - of(&report["settings"][chosen])).abs() == 0.0);
    }
    let names = text_column(&place.path("both/tradeoff_rows.parquet"), "load_case");
    let settings = report["settings"].as_array().expect("settings").len();
    let of_blade = names.iter().filter(|name| *name == "blade").count();
    assert_eq!((names.len(), of_blade), (9 * settings, 3 * settings));
    let shown = trade(&both, "shown", &[]);
    for words in [
        "load case blade: loads 50 N per sector; load case disk: loads 50, 50 N per sector",
        "of its rows under load case disk: median",
    ] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
    // One load case costs and errs as the study without it, whose report names none.
    let plain = "[excitation]\nengine_orders = [2]\namplitude_n = 10.0\n";
    let of_settings = |report: &serde_json::Value| {
        let mut settings = report["settings"].clone();
        for setting in settings.as_array_mut().expect("settings") {
            setting["cpu_s"] = serde_json::Value::Null;
        }
        settings
    };
    let plain = json(&trade(plain, "plain", &["--json"]));
    let first = json(&trade(ON_BLADE, "first", &["--json"]));
    assert_eq!(of_settings(&plain), of_settings(&first));
    assert!(plain.get("load_cases").is_none());
}

/// What a search in the folder `out` reports.
fn search(place: &Place, study: &str, out: &str, more: &[&str]) -> String {
    place.write("study.toml", study);
    let request = "optimum study.toml --between 50:400 --percentile 50 --resolution 1 --out";
    let request: Vec<&str> = request.split(' ').chain([out]).collect();
    let ended = place.run(&[&request, more].concat());
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    ended.stdout
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn the_best_load_is_that_of_the_worst_load_case_of_each_wheel() {
    let place = Place::new();
    place.write("disk.csv", "dof,re,im\n1,1.0,0.5\n");
    let both = study("a", &format!("{ON_BLADE}{ON_DISK}"));
    let report = json(&search(&place, &both, "results/search", &["--json"]));
    let excitations = report["excitations"].as_array().expect("excitations");
    let names: Vec<_> = excitations
        .iter()
        .map(|own| (own["load_case"].as_str(), own["engine_order"].as_u64()))
        .collect();
    assert_eq!(
        names,
        [
            (Some("blade"), Some(2)),
            (Some("disk"), Some(1)),
            (Some("disk"), Some(2))
        ]
    );
    let loads = report["best"]["loads"].as_array().expect("loads");
    assert!(loads.len() >= 3);
    let value = |load: &serde_json::Value| load["percentile"]["value"].as_f64().expect("a value");
    let mut highest = Vec::new();
    for (place_of_load, load) in loads.iter().enumerate() {
        // By hand from the rows: the median of the largest amplitude of each wheel.
        let folder = format!(
            "search/load-{}",
            load["normal_load_n"].as_f64().expect("a load")
        );
        let [blade, disk] = ["blade", "disk"].map(|case| rows(&place, &folder, Some(case)));
        let mut largest: Vec<f64> = (0..10)
            .map(|pattern| {
                let of_wheel = blade
                    .iter()
                    .chain(&disk)
                    .filter(|row| row.pattern == pattern);
                let amplitudes = of_wheel.map(|row| row.peak_amplitude_m.expect("a peak"));
                amplitudes.fold(0.0, f64::max)
            })
            .collect();
        largest.sort_by(f64::total_cmp);
        assert!(value(load).total_cmp(&largest[4]).is_eq());
        let alone = excitations.iter();
        let alone = alone.map(|own| (value(&own["best"]["loads"][place_of_load]), own));
        let (most, own) = alone
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("excitations");
        assert!(value(load) >= most);
        assert_eq!(load["load_case"], own["load_case"]);
        assert_eq!(load["engine_order"], own["engine_order"]);
        highest.push(load["engine_order"].as_u64());
    }
    // The wave under which the wheels are worst is another at low and at high loads, and the best load between.
    assert_eq!((highest[0], highest[loads.len() - 1]), (Some(2), Some(1)));
    let lowest = loads.iter().map(value).fold(f64::INFINITY, f64::min);
    let best = report["normal_load_n"].as_f64().expect("a load");
    let place_of_best = loads
        .iter()
        .position(|load| load["normal_load_n"].as_f64() == Some(best));
    assert!(
        value(&loads[place_of_best.expect("solved")])
            .total_cmp(&lowest)
            .is_eq()
    );
    assert!(
        excitations
            .iter()
            .any(|own| own["normal_load_n"].as_f64() != Some(best))
    );
    let shown = search(&place, &both, "results/search", &[]);
    for words in [
        "each wheel by its largest",
        "highest under",
        "lowest at",
        "load case disk, engine order 1",
    ] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
}

#[test]
fn a_search_with_one_load_case_is_that_without_and_settings_are_chosen_for_all() {
    let place = Place::new();
    place.write("disk.csv", "dof,re,im\n1,1.0,0.5\n");
    let plain = study(
        "a",
        "[excitation]\nengine_orders = [2]\namplitude_n = 10.0\n",
    );
    let plain = json(&search(&place, &plain, "plain", &["--json"]));
    let first = study("a", ON_BLADE);
    let mut first = json(&search(&place, &first, "first", &["--json"]));
    for load in first["best"]["loads"].as_array_mut().expect("loads") {
        let name = load.as_object_mut().expect("a load").remove("load_case");
        assert_eq!(name, Some(serde_json::json!("blade")));
    }
    assert_eq!(first, plain);
    assert!(plain.get("excitations").is_none());
    // Settings by error are chosen once, for all load cases, and close to those that leave more out.
    let both = format!("{ON_BLADE}{ON_DISK}");
    let accurate = accurate("a", &both, 0.02).replace("patterns = 40", "patterns = 10");
    let accurate = json(&search(&place, &accurate, "accurate", &["--json"]));
    let few = json(&search(&place, &study("a", &both), "few", &["--json"]));
    let value = |report: &serde_json::Value| {
        let first = &report["best"]["loads"][0]["percentile"]["value"];
        first.as_f64().expect("a value")
    };
    let ratio = value(&accurate) / value(&few);
    assert!((1e-9..0.2).contains(&(ratio - 1.0).abs()), "{ratio}");
}

#[test]
fn folders_with_the_same_load_cases_are_compared_case_by_case() {
    let place = Place::new();
    place.write("disk.csv", "dof,re,im\n1,1.0,0.5\n");
    let third = ON_DISK.replace("\"disk\"", "\"third\"");
    let write = |name: &str, excitation: &str, friction: &str| {
        let study = study(name, excitation).replace("friction_coefficient = 0.3", friction);
        place.write("study.toml", &study);
        let ended = place.run(&["run", "study.toml"]);
        assert_eq!(ended.code, 0, "{}", ended.stderr);
    };
    write(
        "one",
        &format!("{ON_BLADE}{ON_DISK}"),
        "friction_coefficient = 0.3",
    );
    // Another order of the cases, and one more.
    write(
        "two",
        &format!("{ON_DISK}{third}{ON_BLADE}"),
        "friction_coefficient = 0.2",
    );
    let request = [
        "compare",
        "results/one",
        "results/two",
        "--percentile",
        "50",
        "--json",
    ];
    let ended = place.run(&request);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let report: serde_json::Value = serde_json::from_str(&ended.stdout).expect("JSON");
    let of_amplitude = &report["quantities"][0];
    let comparisons = of_amplitude["comparisons"].as_array().expect("pairs");
    assert_eq!(comparisons.len(), 9);
    for pair in comparisons {
        for key in ["load_case", "engine_order", "contact", "normal_load_n"] {
            assert_eq!(pair["baseline"][key], pair["candidate"][key], "{pair}");
        }
        assert_eq!(pair["pairing"], "same_patterns");
        assert_eq!(
            (&pair["baseline"]["folder"], &pair["candidate"]["folder"]),
            (&0.into(), &1.into())
        );
    }
    let names: Vec<_> = comparisons
        .iter()
        .map(|pair| pair["candidate"]["load_case"].as_str())
        .collect();
    let count = |name| names.iter().filter(|own| **own == Some(name)).count();
    assert_eq!((count("blade"), count("disk")), (3, 6));
    let unmatched = report["unmatched"].as_array().expect("a list");
    assert_eq!(unmatched.len(), 6);
    assert!(unmatched.iter().all(|own| own["load_case"] == "third"));
}

#[test]
fn a_force_on_several_dofs_is_told_by_the_sum_of_their_magnitudes() {
    let place = Place::new();
    // 5 N and, against it, 13 N along theta.
    place.write("disk.csv", "dof,re,im\n0,3.0,4.0\n1,-5.0,-12.0\n");
    place.write("study.toml", &study("spread", ON_DISK));
    let ended = place.run(&["check", "study.toml"]);
    let text = ended
        .stdout
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    // 18 N, times 20 and 40 for the two engine orders.
    for words in [
        "load case disk, engine order 1, 360 N in sum over 2 dofs of each sector: excites",
        "load case disk, engine order 2, 720 N in sum over 2 dofs of each sector: excites",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}
