//! Every command that the documents show is run on a small stand-in, or is listed with the reason why it is not.

use std::collections::BTreeMap;
use std::path::Path;

use clap::Parser;

use crate::blisk::{GOOD, Place};
use crate::documentation::{PROGRAM, commands, pages};

/// Study files of the documents, and the names of the studies that stand in for them.
const STUDIES: [(&str, &str); 7] = [
    ("study.toml", "small"),
    ("data/study.toml", "small"),
    ("ring.toml", "quickstart"),
    ("studies/quickstart.toml", "quickstart"),
    ("studies/underplatform.toml", "underplatform"),
    ("studies/calculix/study_rest.toml", "calculix-rest"),
    ("studies/calculix/study_speed.toml", "calculix-speed"),
];

/// Import files of the documents, and those of `tests/data/calculix_wheel` that stand in for them.
const IMPORTS: [(&str, &str); 3] = [
    ("wheel.toml", "wheel_speed.toml"),
    ("wheel_rest.toml", "wheel_rest.toml"),
    ("check_rest.toml", "wheel_rest.toml"),
];

/// What needs a folder without results.
const STARTING: [&str; 4] = ["init", "run", "import", "estimate"];

/// Commands of the documents that are not run, by their beginning, and why.
const NOT_RUN: [(&str, &str); 40] = [
    ("cargo install --path .", "installs outside of the clone"),
    ("cargo test", "is the run that this test is in, or an hour"),
    (
        "BLISK_VALIDATION_SECTIONS=",
        "is a run of tests for an hour",
    ),
    ("BLISK_WRITE_MAP=", "writes a page of the clone"),
    ("BLISK_WRITE_KEYS=", "writes a page of the clone"),
    ("cargo build --timings", "compiles everything from nothing"),
    ("cargo check", "compiles everything from nothing"),
    (
        "cargo doc",
        "writes the documentation of the crate; the stage documentation of .ci/run does too",
    ),
    (
        "cargo run --release --example",
        "is a program; tests/library runs what it runs",
    ),
    ("cargo bench", "takes many minutes"),
    ("cargo fmt", "the stage format of .ci/run runs it"),
    (
        "cargo +nightly fuzz",
        "needs the nightly compiler; the stage fuzz of .ci/run runs it",
    ),
    (
        "cargo deny",
        "asks the network; the stage deny of .ci/run runs what needs none",
    ),
    (
        "cargo publish",
        "sends the package to crates.io; the stage package of .ci/run tries it without sending",
    ),
    ("cd \"$PBS_O_WORKDIR\"", "is the scheduler's folder"),
    ("qsub", "needs PBS; the program's part of it is run"),
    ("array=$(qsub", "needs PBS"),
    ("bash ring-slurm.sh", "needs Slurm; tests/slurm has it"),
    (
        "studies/calculix/run.sh",
        "needs gmsh and ccx; the stage calculix of .ci/run runs it",
    ),
    ("studies/validation/run.sh", "solves for an hour"),
    (
        "python3 studies/optimal-load/run.py",
        "solves for hours; tests/readers/optimal_load.py tries it small",
    ),
    ("apt-get install", "installs outside of the clone"),
    ("cargo build --release", "compiles everything from nothing"),
    (
        "python3 benches/peers/run.py",
        "needs the other programs that it measures",
    ),
    ("python3 benches/scaling/run.py", "measures for minutes"),
    (
        "python3 benches/accuracy/run.py",
        "measures for minutes, and needs pyarrow",
    ),
    (
        "python3 benches/golden/run.py",
        "compares two release builds for minutes",
    ),
    (
        "python3 docs/site.py",
        "needs mdBook; the stage site of .ci/run runs it",
    ),
    ("python docs/figures.py", "writes a figure of the clone"),
    ("rsvg-convert", "is no part of a clone"),
    (
        "python docs/quickstart.py",
        "writes a figure of the clone, and needs pyarrow",
    ),
    ("gmsh", "is no part of a clone"),
    ("ccx", "is no part of a clone"),
    ("pip install", "installs outside of the clone"),
    (
        "python3 -m venv",
        "makes an environment outside of the clone",
    ),
    (
        "python -m pytest",
        "needs the Python package; the stage python of .ci/run runs it",
    ),
    (
        "python studies/ansys/",
        "needs ansys-mapdl-reader; tests/readers/ansys_files.py runs it",
    ),
    (
        "python -m blisk.examples",
        "needs the Python package; python/tests/test_examples.py runs it",
    ),
    (
        "python recipe",
        "needs the Python package; python/tests/test_ten_tasks.py runs it",
    ),
    (
        "sed -i",
        "writes keys that a stand-in has not; python/tests/test_ten_tasks.py runs it",
    ),
];

/// First words of the lines and spans that are commands of other programs.
const OTHERS: [&str; 19] = [
    "cargo ",
    "ccx ",
    "gmsh ",
    "git ",
    "bash ",
    "sh ",
    "sbatch ",
    "qsub ",
    "array=",
    "python ",
    "python3 ",
    "pip ",
    "sed ",
    "cd ",
    "apt-get ",
    "rsvg-convert ",
    "studies/calculix/run.sh",
    "studies/validation/run.sh",
    "BLISK_",
];

/// What a document's place-holder stands for in a command, after the word before it.
fn value(command: &str, before: &str, word: &str) -> String {
    let out = ["--out", "--export"].contains(&before);
    let text = match (word, before, command) {
        ("FILE", _, "report") if out => "new.html",
        ("FILE", _, "init") if out => "new.toml",
        ("FILE" | "FILE.csv", ..) if out => "new.csv",
        ("FILE.parquet", ..) => "new.parquet",
        ("FILE.svg", ..) => "new.svg",
        ("FILE" | "FILE.toml", _, "import") => "wheel.toml",
        ("DIR", _, "merge") => "shared/ring",
        ("DIR" | "BUNDLE", ..) if out => "new",
        ("DIR", ..) => "results/small",
        ("DIR/load-*", ..) => "results/search/load-*",
        ("STUDY", ..) | ("FILE", "--study", _) => "study.toml",
        ("FIGURE", ..) => "amplitude",
        ("SHELL", ..) => "bash",
        ("KEY", ..) => "solver",
        ("WORD", ..) => "friction",
        ("NAME", "--example", _) => "quickstart",
        ("START:STOP:COUNT", ..) => "300:400:3",
        ("LOW:HIGH", ..) => "45:60",
        ("HZ", ..) => "2000",
        ("RPM=BUNDLE", ..) => "0=exported",
        ("k/n", ..) => "1/2",
        ("T", "--time", _) => "01:00:00",
        ("N", "--load", _) => "50",
        ("N", "--patterns", "estimate") => "600",
        ("N", "--pilot" | "--sample" | "--patterns" | "--frequencies", _) => "3",
        ("N", "--threads" | "--tasks", _) => "2",
        ("M", "--solves", _) => "60",
        ("I", "--scenario" | "--baseline", _) | ("S", "--seed", _) => "1",
        ("ID", "--pattern", _) => "5",
        ("P", ..) => "95",
        ("Q", "--quantity", _) => "peak_amplitude_m",
        ("R", "--resolution", _) => "0.1",
        // Folders of a cluster lie in the folder of the test.
        _ => word.trim_matches('"').trim_start_matches('/'),
    };
    text.to_owned()
}

/// What a command needs that is only named: its operands, then its options.
fn required(
    command: &str,
) -> (
    &'static [&'static str],
    &'static [(&'static str, &'static str)],
) {
    match command {
        "import" => (&["wheel.toml"], &[("--out", "new")]),
        "stats" | "report" | "status" | "compare" => (&["results/small"], &[]),
        "plot" => (&["results/small", "amplitude"], &[]),
        "merge" => (&["shared/ring"], &[("--out", "shared/ring")]),
        "completions" => (&["bash"], &[]),
        "explain" => (&["solver"], &[]),
        "slurm" => (&["study.toml"], &[("--tasks", "2")]),
        "optimum" => (&["study.toml"], &[("--between", "45:60")]),
        "response" => (
            &["study.toml"],
            &[
                ("--pattern", "tuned"),
                ("--load", "50"),
                ("--frequencies", "300:400:3"),
                ("--out", "new.csv"),
            ],
        ),
        _ => (&["study.toml"], &[]),
    }
}

/// Whether a word still has a place-holder: a part in capitals.
fn unfilled(word: &str) -> bool {
    let parts = word.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
    parts
        .filter(|part| !part.is_empty())
        .any(|part| part.chars().all(|letter| letter.is_ascii_uppercase()))
}

/// The command lines that a documented one stands for: without and with what is in brackets, and every alternative.
fn meant(documented: &str) -> Vec<Vec<String>> {
    let text = documented.replace("\\|", "|").replace("...", " ");
    let mut without = text.clone();
    while let (Some(start), Some(end)) = (without.find('['), without.find(']')) {
        without.replace_range(start..=end, "");
    }
    let with = text.replace(['[', ']'], " ");
    let mut lines: Vec<Vec<String>> = Vec::new();
    for text in [without, with] {
        let words: Vec<&str> = text.split_whitespace().collect();
        let most = words.iter().map(|word| word.split('|').count()).max();
        for alternative in 0..most.unwrap_or(0) {
            let chosen = words.iter().map(|word| {
                let mut all = word.split('|');
                let first = all.clone().next().expect("a word");
                all.nth(alternative).unwrap_or(first)
            });
            let line = filled(&chosen.collect::<Vec<_>>());
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
    }
    lines
}

/// A command line with values in the place of place-holders, and with what it lacks.
fn filled(words: &[&str]) -> Vec<String> {
    let command = words[0];
    let mut line: Vec<String> = Vec::new();
    for (place, word) in words.iter().enumerate() {
        let before = if place == 0 { "" } else { words[place - 1] };
        line.push(value(command, before, word));
    }
    let whole = ["blisk".to_owned()].into_iter().chain(line.clone());
    let refused = blisk::cli::Arguments::try_parse_from(whole).err();
    let lacks = clap::error::ErrorKind::MissingRequiredArgument;
    if refused.is_some_and(|error| error.kind() == lacks) {
        let (operands, options) = required(command);
        if line.get(1).is_none_or(|word| word.starts_with("--")) {
            drop(line.splice(1..1, operands.iter().map(|&word| word.to_owned())));
        }
        for (option, value) in options {
            if !line.iter().any(|word| word == option) {
                line.extend([option, value].map(|word| (*word).to_owned()));
            }
        }
    }
    line
}

/// Commands of the program that a script or a manifest of a scheduler holds.
fn embedded(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in page.lines() {
        for start in ["exec blisk ", "env blisk ", "$(blisk ", "command: [blisk, "] {
            if let Some((_, rest)) = line.split_once(start) {
                let end = rest.find([')', ']']).unwrap_or(rest.len());
                found.push(rest[..end].replace(',', ""));
            }
        }
    }
    found
}

/// Commands of other programs: lines of shell blocks, and lines and spans that begin with their names.
fn others(page: &str) -> Vec<String> {
    let other = |text: &str| {
        !PROGRAM
            .iter()
            .any(|program| format!("{text} ").starts_with(program))
    };
    let mut found: Vec<String> = Vec::new();
    let mut block: Option<&str> = None;
    for line in page.lines() {
        if let Some(language) = line.strip_prefix("```") {
            block = block.is_none().then_some(language);
            continue;
        }
        let text = line.trim();
        let named = OTHERS.iter().any(|start| text.starts_with(start));
        let wanted = match block {
            Some("sh" | "bash" | "console") => !text.is_empty() && !text.starts_with('#'),
            Some(_) => false,
            None => line.starts_with("    ") && named,
        };
        if wanted && other(text) && !text.contains("exec blisk ") {
            found.push(text.to_owned());
        }
        if block.is_none() {
            let spans = line.split('`').skip(1).step_by(2);
            let named = spans.filter(|span| OTHERS.iter().any(|start| span.starts_with(start)));
            found.extend(
                named
                    .filter(|span| other(span))
                    .filter(|span| !span.starts_with("BLISK_") || span.contains(' '))
                    .map(str::to_owned),
            );
        }
    }
    found
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).expect("a copy");
        }
    }
}

/// A small study in the place of a documented one.
fn stand_in(name: &str, patterns: u32) -> String {
    GOOD.replace("name = \"small\"", &format!("name = \"{name}\""))
        .replace("seed = 7", "seed = 9")
        .replace("patterns = 10", &format!("patterns = {patterns}"))
}

/// A folder with the stand-ins of all files that commands read.
fn inputs() -> Place {
    let place = Place::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let wheel = root.join("tests/data/calculix_wheel");
    copy(&wheel, &place.path("."));
    for (file, source) in IMPORTS {
        std::fs::copy(wheel.join(source), place.path(file)).expect("a copy");
    }
    for (file, name) in STUDIES {
        let path = place.path(file);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        place.write(file, &stand_in(name, 75));
        // The stand-in writes where the documents say that the study does.
        if let Ok(study) = std::fs::read_to_string(root.join(file)) {
            assert!(study.contains(&format!("name = \"{name}\"")), "{file}");
        }
    }
    place
}

/// The same with what commands on results read.
fn results() -> Place {
    let place = inputs();
    for line in [
        "run study.toml",
        "run ring.toml",
        "run studies/calculix/study_rest.toml",
        "run studies/calculix/study_speed.toml",
        "run study.toml --out shared/ring --shard 1/2",
        "run study.toml --out shared/ring --shard 2/2",
        "model study.toml --export exported",
        "optimum study.toml --between 45:60 --resolution 0.3 --out results/search",
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let ended = place.run(&words);
        assert_eq!(ended.code, 0, "{line}: {}{}", ended.stdout, ended.stderr);
    }
    for folder in ["data/ring", "results/ring"] {
        copy(&place.path("shared/ring"), &place.path(folder));
    }
    // A folder of shards is merged before its report.
    let merged = place.run(&["merge", "results/ring", "--out", "results/ring"]);
    assert_eq!(merged.code, 0, "{}{}", merged.stdout, merged.stderr);
    place
}

/// Runs a command line in a copy of the prepared folder; what is wrong with how it ended.
fn fault(line: &[String], prepared: &Place) -> Option<String> {
    let place = Place::new();
    if line[0] != "init" {
        copy(&prepared.path("."), &place.path("."));
    }
    let mut words: Vec<String> = Vec::new();
    for word in line {
        if let Some(start) = word.strip_suffix('*') {
            let (folder, start) = start.rsplit_once('/').expect("a folder");
            let entries = std::fs::read_dir(place.path(folder)).expect("a folder");
            let names = entries.map(|entry| entry.expect("an entry").file_name());
            let mut names: Vec<String> = names.filter_map(|name| name.into_string().ok()).collect();
            names.retain(|name| name.starts_with(start));
            names.sort();
            words.extend(names.iter().map(|name| format!("{folder}/{name}")));
        } else {
            words.push(word.clone());
        }
    }
    let has = |word: &str| words.iter().any(|other| other == word);
    // An estimate is of many patterns; an accepted error chooses the harmonics.
    if words[0] == "estimate" {
        place.write("study.toml", &stand_in("small", 600));
    }
    if has("--accuracy") {
        let open = stand_in("small", 20).replace("harmonics = [1, 3]\n", "");
        place.write("study.toml", &open);
    }
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_blisk"));
    // The scheduler's share of an array of 8.
    if words.last().is_some_and(|word| word == "--shard") || has("--shard") && has("data/ring") {
        command.envs([("BLISK_SHARD_COUNT", "8"), ("BLISK_SHARD_INDEX", "1")]);
    }
    let ended = command.args(&words).current_dir(place.path(".")).output();
    let ended = ended.expect("the binary starts");
    let out = words.iter().position(|word| word == "--out");
    // What a script for a cluster names is written by the cluster.
    let now = out.filter(|_| words[0] != "slurm");
    let written = now.is_none_or(|option| place.path(&words[option + 1]).exists());
    let fine = ended.status.code() == Some(0) && written;
    let told = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (!fine).then(|| {
        let (stdout, stderr) = (told(&ended.stdout), told(&ended.stderr));
        format!("{:?}, written: {written}\n{stdout}{stderr}", ended.status)
    })
}

#[test]
fn every_documented_command_runs() {
    // Each command line once, with the first place that shows it.
    let mut lines: BTreeMap<Vec<String>, String> = BTreeMap::new();
    for (name, page) in pages() {
        for documented in commands(&page).into_iter().chain(embedded(&page)) {
            for line in meant(&documented) {
                let shown = format!("{name}: blisk {documented}");
                let open = line.iter().find(|word| unfilled(word));
                assert!(open.is_none(), "{shown}: no value for {open:?}");
                lines.entry(line).or_insert(shown);
            }
        }
    }
    let (inputs, results) = (inputs(), results());
    let mut faults = Vec::new();
    for (line, shown) in &lines {
        let starting = STARTING.contains(&line[0].as_str());
        let prepared = if starting { &inputs } else { &results };
        if let Some(fault) = fault(line, prepared) {
            faults.push(format!("{shown}\nas blisk {}: {fault}", line.join(" ")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
    assert!(lines.len() > 80, "{}", lines.len());
}

#[test]
fn every_documented_command_of_another_program_has_a_reason_not_to_run() {
    let shown: Vec<(String, String)> = pages()
        .into_iter()
        .flat_map(|(name, page)| {
            others(&page)
                .into_iter()
                .map(move |text| (name.clone(), text))
        })
        .collect();
    let listed = |text: &str| NOT_RUN.iter().any(|(start, _)| text.starts_with(start));
    let open: Vec<_> = shown.iter().filter(|(_, text)| !listed(text)).collect();
    assert!(open.is_empty(), "neither run nor listed: {open:#?}");
    for (start, reason) in NOT_RUN {
        let occurs = shown.iter().any(|(_, text)| text.starts_with(start));
        assert!(occurs, "`{start}` ({reason}) occurs in no document");
    }
}
