//! No number comes from a file that is not as it was written, or is one of another study.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use blisk::campaign::{ReportRequest, report};
use blisk::settings::ReducedEngineSource;

use crate::blisk::{GOOD, Place};
use crate::forgery::{Numbers, forge};

const RESULTS: &str = "results/small";

/// Studies whose reduced models differ: other wheels, other loads, other settings.
fn variants(count: usize) -> Vec<String> {
    let edits: [&[(&str, &str)]; 8] = [
        &[],
        &[("sectors = 6", "sectors = 8")],
        &[("blade_mass_kg = 0.25", "blade_mass_kg = 0.24")],
        &[(
            "[\"slide\", 50, \"stuck\"]",
            "[\"slide\", 40, 60, \"stuck\"]",
        )],
        &[("harmonics = [1, 3]", "harmonics = \"auto\"")],
        &[("engine_orders = [2]", "engine_orders = [1, 2]")],
        &[(
            "tangential_stiffness_n_per_m = 8.0e5",
            "tangential_stiffness_n_per_m = 6.0e5",
        )],
        &[("[\"slide\", 50, \"stuck\"]", "[50]")],
    ];
    let of = |edit: &&[(&str, &str)]| {
        edit.iter().fold(GOOD.to_owned(), |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replacen(old, new, 1)
        })
    };
    edits.iter().map(of).take(count).collect()
}

/// The only cached model of a results folder.
fn model(results: &Path) -> PathBuf {
    let entries = std::fs::read_dir(results.join("model")).expect("a folder");
    let mut entries: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    assert_eq!(entries.len(), 1, "{entries:?}");
    entries.remove(0)
}

/// Solves `pairs` of `count` studies, each with the model of the other under the name of its own.
fn swap_models(count: usize, pairs: usize) {
    let place = Place::new();
    let studies = variants(count);
    let solve = |study: usize, out: &str| {
        place.write("study.toml", &studies[study]);
        let ended = place.run(&["run", "study.toml", "--out", out]);
        assert_eq!(ended.code, 0, "{}", ended.stderr);
        place.path(out)
    };
    let whole: Vec<PathBuf> = (0..count)
        .map(|study| solve(study, &format!("whole-{study}")))
        .collect();
    let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    let mut tried = 0;
    for (a, b) in all.take(pairs) {
        for (own, other) in [(a, b), (b, a)] {
            let out = format!("swapped-{own}-{other}");
            let name = model(&whole[own]).file_name().expect("a name").to_owned();
            let target = place.path(&out).join("model").join(&name);
            std::fs::create_dir_all(target.parent().expect("a folder")).expect("made");
            std::fs::copy(model(&whole[other]), &target).expect("copied");
            let results = solve(own, &out);
            for table in ["responses.parquet", "scenarios.parquet"] {
                let [found, wanted] = [&results, &whole[own]]
                    .map(|folder| std::fs::read(folder.join(table)).expect("read"));
                assert!(
                    found == wanted,
                    "{table} of study {own} with the model of {other}"
                );
            }
            // The model has been made anew.
            let [found, wanted] =
                [&target, &model(&whole[own])].map(|path| std::fs::read(path).expect("read"));
            assert!(found == wanted, "study {own} keeps the model of {other}");
        }
        tried += 1;
    }
    assert_eq!(tried, pairs);
}

#[test]
fn a_model_of_another_study_is_never_used() {
    swap_models(3, 3);
}

/// `cargo test --release --test cli -- --ignored twenty_pairs`
#[test]
#[ignore = "48 studies: a minute"]
fn models_of_twenty_pairs_of_studies_are_never_used_for_each_other() {
    swap_models(8, 20);
}

#[test]
fn a_whole_cached_model_is_used_again_and_not_written_again() {
    for edit in [
        ("harmonics = [1, 3]", "harmonics = [1, 3]"),
        (
            "harmonics = [1, 3]",
            "harmonics = \"auto\"\nrows_beyond_tolerance = \"resolve\"",
        ),
    ] {
        let place = Place::with(&GOOD.replace(edit.0, edit.1));
        assert_eq!(place.run(&["run", "study.toml"]).code, 0);
        let path = model(&place.path(RESULTS));
        let written = || std::fs::metadata(&path).and_then(|found| found.modified());
        let before = written().expect("a time");
        place.write(
            "study.toml",
            &GOOD.replace(edit.0, edit.1).replace("= 10\n", "= 12\n"),
        );
        let more = place.run(&["run", "study.toml"]);
        assert!(more.stderr.contains("solved 6 rows"), "{}", more.stderr);
        assert_eq!(written().expect("a time"), before, "{}", edit.1);
    }
}

/// Flips `bits` bits of every model in turn, and solves the study.
fn flip_models(bits: usize) {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let results = place.path(RESULTS);
    let wanted = std::fs::read(results.join("responses.parquet")).expect("read");
    let path = model(&results);
    let content = std::fs::read(&path).expect("read");
    let mut numbers = Numbers(3);
    for _ in 0..bits {
        let bit = numbers.below(8 * content.len());
        let mut flipped = content.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        std::fs::write(&path, flipped).expect("written");
        std::fs::remove_file(results.join("responses.parquet")).expect("removed");
        std::fs::remove_file(results.join("manifest.json")).expect("removed");
        let ended = place.run(&["run", "study.toml"]);
        assert_eq!(ended.code, 0, "bit {bit}: {}", ended.stderr);
        let found = std::fs::read(results.join("responses.parquet")).expect("read");
        assert!(found == wanted, "bit {bit}");
        assert!(std::fs::read(&path).expect("read") == content, "bit {bit}");
    }
}

#[test]
fn a_flipped_bit_of_a_cached_model_changes_no_row() {
    flip_models(4);
}

/// A folder with results and a measured trade-off.
fn with_tradeoff() -> Place {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let ended = place.run(&["tradeoff", "study.toml", "--patterns", "2"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    place
}

/// Flips `bits` bits of each file that a report reads, and reports; how many were tried.
fn flip_reported(place: &Place, bits: usize) -> usize {
    let results = place.path(RESULTS);
    let request = ReportRequest {
        results: results.clone(),
        study_file: None,
        curves: false,
        model: true,
    };
    let of_folder = || {
        let found = report(&request, &ReducedEngineSource);
        found.map(|found| serde_json::to_string(&found).expect("JSON"))
    };
    let wanted = of_folder().expect("a report");
    let mut numbers = Numbers(5);
    let mut tried = 0;
    for name in [
        "tradeoff.parquet",
        "checksums.json",
        "manifest.json",
        "responses.parquet",
        "scenarios.parquet",
        "percentiles.parquet",
        "distribution.parquet",
        "patterns.parquet",
        "summary.txt",
        "runs/1.json",
    ] {
        let path = results.join(name);
        let content = std::fs::read(&path).expect(name);
        for _ in 0..bits {
            let bit = numbers.below(8 * content.len());
            let mut flipped = content.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, flipped).expect("written");
            match of_folder() {
                // Nothing in the report is from the record of a run.
                Ok(found) => assert!(name == "runs/1.json" && found == wanted, "{name} {bit}"),
                Err(error) => {
                    let words = error.to_string();
                    assert!(
                        words.contains(name) && words.contains("damaged"),
                        "{name}: {words}"
                    );
                }
            }
            tried += 1;
        }
        std::fs::write(&path, content).expect("restored");
    }
    assert_eq!(of_folder().expect("a report"), wanted);
    tried
}

#[test]
fn a_flipped_bit_of_any_file_that_a_report_reads_is_found() {
    let place = with_tradeoff();
    assert_eq!(flip_reported(&place, 25), 250);
    let noted = place.path(RESULTS).join("checksums.json");
    let before = std::fs::read(&noted).expect("read");
    forge(&noted, |value| {
        value["tables"]["tradeoff.parquet"]["build"] = "another".into();
    });
    let mixed = place.run(&["report", RESULTS, "--no-curves"]);
    assert_eq!(mixed.code, 8, "{}", mixed.stderr);
    let wanted = "build another measured it";
    assert!(mixed.stderr.contains(wanted), "{}", mixed.stderr);
    std::fs::write(&noted, before).expect("restored");
    let path = place.path(RESULTS).join("tradeoff.parquet");
    let content = std::fs::read(&path).expect("read");
    let mut flipped = content.clone();
    flipped[content.len() / 2] ^= 1;
    std::fs::write(&path, flipped).expect("written");
    for command in [
        &["report", RESULTS, "--no-curves"][..],
        &["plot", RESULTS, "accuracy"],
        &["verify", RESULTS, "--integrity"],
    ] {
        let ended = place.run(command);
        assert_eq!(ended.code, 8, "{command:?} {}", ended.stderr);
    }
    let repaired = place.run(&["verify", RESULTS, "--repair"]);
    assert_eq!(repaired.code, 0, "{}", repaired.stderr);
    let whole = place.run(&["verify", RESULTS, "--integrity"]);
    assert_eq!(whole.code, 0, "{}", whole.stdout);
    std::fs::write(&path, content).expect("restored");
    let unknown = place.run(&["report", RESULTS, "--no-curves"]);
    assert_eq!(unknown.code, 8);
    assert!(
        unknown.stderr.contains("checksums.json does not note it"),
        "{}",
        unknown.stderr
    );
}

/// `cargo test --release --test cli -- --ignored flipped_bits`
#[test]
#[ignore = "250 bits of every file: some minutes"]
fn two_hundred_and_fifty_flipped_bits_of_every_file_change_no_number() {
    assert_eq!(flip_reported(&with_tradeoff(), 250), 2500);
    flip_models(250);
}

#[test]
fn integrity_of_every_kind_of_folder_is_told_and_nothing_is_changed() {
    let place = with_tradeoff();
    let study = GOOD.replace("patterns = 10", "patterns = 100");
    place.write("large.toml", &study);
    let estimate = [
        "estimate",
        "large.toml",
        "--out",
        "e",
        "--solves",
        "60",
        "--patterns",
        "100",
    ];
    assert_eq!(place.run(&estimate).code, 0);
    assert_eq!(place.run(&["verify", RESULTS, "--sample", "2"]).code, 0);
    for folder in [RESULTS, "e"] {
        let ended = place.run(&["verify", folder, "--integrity"]);
        assert_eq!(ended.code, 0, "{}{}", ended.stdout, ended.stderr);
        assert!(
            ended.stdout.contains("0 damaged, 0 missing"),
            "{}",
            ended.stdout
        );
        let json = place
            .run(&["verify", folder, "--integrity", "--json"])
            .stdout;
        let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(value["whole"], true);
        assert!(value["integrity"]["build"].is_string());
    }
    let of_study = place.run(&["verify", "study.toml", "--integrity"]);
    assert_eq!(of_study.code, 0, "{}", of_study.stderr);
    std::fs::remove_file(place.path("e/sample.parquet")).expect("removed");
    let ended = place.run(&["verify", "e", "--integrity"]);
    assert_eq!(ended.code, 8);
    assert!(
        ended.stdout.contains("missing     sample.parquet"),
        "{}",
        ended.stdout
    );
    assert_eq!(
        place
            .run(&["verify", RESULTS, "--integrity", "--repair"])
            .code,
        2
    );
}

#[test]
fn a_share_of_more_shards_than_patterns_is_refused_with_the_range() {
    let place = Place::with(GOOD);
    for shard in ["1/4294967295", "11/11"] {
        let ended = place.run(&["run", "study.toml", "--shard", shard]);
        assert_eq!(ended.code, 2, "{}", ended.stderr);
        assert!(ended.stderr.contains("n from 1 to 10"), "{}", ended.stderr);
    }
    let script = place.run(&["slurm", "study.toml", "--tasks", "11"]);
    assert_eq!(script.code, 2, "{}", script.stderr);
    assert!(!place.path("results").exists());
}

/// A copy of this package with one constant changed, compiled with the dependencies of this build.
fn rebuilt() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rebuilt");
    let _ = std::fs::remove_dir_all(&copy);
    for folder in ["src", "benches", "studies", "tests/data", "python"] {
        copy_all(&root.join(folder), &copy.join(folder), &|_| true);
    }
    for file in ["build.rs", "Cargo.toml", "Cargo.lock", "README.md"] {
        std::fs::copy(root.join(file), copy.join(file)).expect(file);
    }
    let binary = Path::new(env!("CARGO_BIN_EXE_blisk"));
    let compiled = binary.parent().expect("a folder");
    let of_dependency = |name: &str| !name.contains("blisk");
    for folder in ["deps", "build", ".fingerprint"] {
        let target = copy.join("target/release").join(folder);
        copy_all(&compiled.join(folder), &target, &of_dependency);
    }
    let source = copy.join("src/response/forced_response/search/envelope.rs");
    let text = std::fs::read_to_string(&source).expect("read");
    let (old, new) = CHANGED;
    assert!(text.contains(old), "{old}");
    std::fs::write(&source, text.replacen(old, new, 1)).expect("written");
    let cargo = Path::new(env!("CARGO"));
    let status = std::process::Command::new(cargo)
        .env("RUSTC", cargo.with_file_name("rustc"))
        .args(["build", "--release", "--locked"])
        .current_dir(&copy)
        .env("CARGO_TARGET_DIR", copy.join("target"))
        .status();
    assert!(status.expect("cargo starts").success());
    copy.join("target/release/blisk")
}

/// The constant that is changed.
const CHANGED: (&str, &str) = (
    "const COMPETITOR: f64 = 0.7;",
    "const COMPETITOR: f64 = 0.6;",
);

fn copy_all(from: &Path, to: &Path, wanted: &dyn Fn(&str) -> bool) {
    std::fs::create_dir_all(to).expect("made");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        if !wanted(&name) {
            continue;
        }
        let target = to.join(&name);
        if path.is_dir() {
            copy_all(&path, &target, &|_| true);
        } else {
            std::fs::copy(&path, &target).expect("copied");
            // Cargo tells by the times whether anything has to be compiled again.
            let written = std::fs::metadata(&path).and_then(|found| found.modified());
            let copied = std::fs::File::options().write(true).open(&target);
            let dated = copied.and_then(|copied| copied.set_modified(written?));
            dated.expect("a time");
        }
    }
}

/// `cargo test --release --test cli -- --ignored rebuilt_program`
#[test]
#[ignore = "compiles the program once more: some minutes"]
fn a_rebuilt_program_with_a_changed_constant_extends_no_folder_of_this_one() {
    let other = rebuilt();
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let run = |more: &[&str]| {
        let output = std::process::Command::new(&other)
            .args(["run", "study.toml"])
            .args(more)
            .current_dir(place.path(""))
            .output()
            .expect("it starts");
        let words = String::from_utf8(output.stderr).expect("UTF-8");
        (output.status.code(), words)
    };
    let before = std::fs::read(place.path(RESULTS).join("responses.parquet")).expect("read");
    place.write(
        "study.toml",
        &GOOD.replace("patterns = 10", "patterns = 20"),
    );
    let (code, words) = run(&[]);
    assert_eq!(code, Some(9), "{words}");
    let version = place.run(&["--version"]).stdout;
    let build = version.lines().find_map(|line| line.strip_prefix("build "));
    let mut wanted = String::new();
    write!(
        wanted,
        "build: stored {}, this program ",
        build.expect("a build")
    )
    .expect("a string");
    assert!(words.contains(&wanted), "{words}");
    let table = || std::fs::read(place.path(RESULTS).join("responses.parquet")).expect("read");
    assert!(table() == before);
    let (code, words) = run(&["--solve-anew"]);
    assert_eq!(code, Some(0), "{words}");
    assert!(words.contains("solved 60 rows, reused 0"), "{words}");
    // Nor is its model taken: both are there.
    let models = std::fs::read_dir(place.path(RESULTS).join("model")).expect("a folder");
    assert_eq!(models.count(), 2);
    let back = place.run(&["run", "study.toml"]);
    assert_eq!(back.code, 9, "{}", back.stderr);
    let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rebuilt");
    std::fs::remove_dir_all(copy).expect("removed");
}
