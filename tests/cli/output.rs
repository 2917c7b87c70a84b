//! What is printed arrives whole, or the command says that it did not; and no name out of a file gives orders to
//! a terminal.

use std::fs::File;
use std::process::{Command, Stdio};

use clap::CommandFactory;

use crate::blisk::{Ended, GOOD, Place};

/// A folder with a finished study in `done`, its shards in `cut`, and an unfinished one in `begun`.
fn prepared() -> Place {
    let place = Place::with(GOOD);
    place.write(
        "sixty.toml",
        &GOOD.replace("patterns = 10", "patterns = 60"),
    );
    for arguments in [
        &["run", "study.toml", "--out", "done"][..],
        &["run", "study.toml", "--out", "cut", "--shard", "1/2"],
        &["run", "study.toml", "--out", "cut", "--shard", "2/2"],
    ] {
        let run = place.run(arguments);
        assert_eq!(run.code, 0, "{}", run.stderr);
    }
    place
}

/// Command lines of the command `name` that print a result, at least one; each is given once and at most once more
/// with `--json`.
fn command_lines(name: &str) -> Vec<Vec<&str>> {
    let lines: &[&str] = match name {
        "init" => &["init --out new.toml"],
        "check" => &["check study.toml"],
        "model" => &["model study.toml", "model study.toml --export bundle"],
        "campbell" => &["campbell study.toml"],
        "import" => &[
            "import WHEEL --out imported",
            "import WHEEL --equations blisk",
        ],
        "plan" => &["plan study.toml --pilot 2"],
        "run" => &["run study.toml --out done", "run study.toml --out new"],
        "merge" => &["merge cut --out cut"],
        "slurm" => &["slurm study.toml --tasks 2 --script new.sh"],
        "status" => &["status done", "status done --missing"],
        "response" => &[
            "response study.toml --pattern 0 --load 50 --frequencies 500:510:3 --out curve.csv",
            "response study.toml --pattern 0 --load 50 --frequencies 500:510:3 --out curve.csv --continuation",
        ],
        "replay" => &["replay done --scenario 1 --pattern 3"],
        "verify" => &[
            "verify done --sample 1",
            "verify done --sample 1 --dense-sweep",
            "verify done --sample 1 --time-domain",
            "verify done --repair",
            "verify done --scenario 1 --pattern 3",
        ],
        "compare" => &["compare done --percentile 50"],
        "optimum" => {
            &["optimum study.toml --between 40:60 --percentile 50 --resolution 0.5 --out optimum"]
        }
        "tradeoff" => &["tradeoff study.toml --patterns 2 --out done"],
        "estimate" => &["estimate sixty.toml --solves 60 --target mean --out estimate"],
        "stats" => &["stats done", "stats done --tails"],
        "report" => &["report done --no-curves", "report done --out page.html"],
        "plot" => &["plot done amplitude --out figure.svg"],
        "explain" => &["explain", "explain solver.peak_tolerance"],
        "schema" => &["schema"],
        "completions" => &["completions bash", "completions zsh", "completions fish"],
        "man" => &["man --out man"],
        other => panic!("blisk {other} needs a command line here that prints its result"),
    };
    lines.iter().map(|line| line.split(' ').collect()).collect()
}

fn run_to(place: &Place, arguments: &[&str], stdout: impl Into<Stdio>) -> Ended {
    let wheel = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/calculix_wheel/wheel_speed.toml"
    );
    let arguments = arguments
        .iter()
        .map(|word| if *word == "WHEEL" { wheel } else { word });
    let output = Command::new(env!("CARGO_BIN_EXE_blisk"))
        .args(arguments)
        .current_dir(place.path("."))
        .stdout(stdout)
        .output()
        .expect("the binary starts");
    Ended {
        code: output.status.code().expect("it ends by itself"),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

#[cfg(target_os = "linux")]
fn full() -> File {
    let full = File::options().write(true).open("/dev/full");
    full.expect("a device that is always full")
}

#[cfg(target_os = "linux")]
fn is_said(place: &Place, line: &[&str]) {
    let ended = run_to(place, line, full());
    assert_eq!(ended.code, 7, "blisk {}: {}", line.join(" "), ended.stderr);
    assert!(
        ended
            .stderr
            .contains("cannot write the result to standard output: No space left on device"),
        "blisk {}: {}",
        line.join(" "),
        ended.stderr
    );
}

/// Every command of the program, so that a new one cannot be forgotten.
#[cfg(target_os = "linux")]
#[test]
fn a_result_of_any_command_that_cannot_be_written_ends_with_7() {
    let place = prepared();
    let mut program = blisk::cli::Arguments::command();
    program.build();
    for command in program.get_subcommands() {
        let name = command.get_name();
        is_said(&place, &[name, "--help"]);
        for line in command_lines(name) {
            is_said(&place, &line);
            for file in ["new.toml", "new.sh"] {
                let _ = std::fs::remove_file(place.path(file));
            }
            let has_json = command
                .get_arguments()
                .any(|own| own.get_long() == Some("json"));
            if has_json && !line.contains(&"--missing") && !line.contains(&"--equations") {
                is_said(&place, &[&line[..], &["--json"]].concat());
            }
        }
    }
    for line in [&["--help"][..], &["--version"], &["-h"]] {
        is_said(&place, line);
    }
}

#[test]
fn a_disk_that_fills_up_on_the_way_ends_with_7_too() {
    let place = prepared();
    for line in ["schema", "stats done --json", "explain"] {
        // A file cannot grow beyond the limit: what a full disk or a quota does after some blocks.
        let shell = format!(
            "trap '' XFSZ; ulimit -f 1; exec {} {line} > out.txt",
            env!("CARGO_BIN_EXE_blisk")
        );
        let output = Command::new("sh")
            .args(["-c", &shell])
            .current_dir(place.path("."))
            .output()
            .expect("a shell");
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(7), "{line}: {words}");
        assert!(words.contains("not complete"), "{line}: {words}");
        let written = std::fs::metadata(place.path("out.txt")).expect("begun");
        assert!((1..=1024).contains(&written.len()), "{line}: {written:?}");
    }
}

#[test]
fn a_reader_who_has_read_enough_ends_nothing_with_an_error() {
    let place = prepared();
    for line in [
        "schema",
        "stats done",
        "explain",
        "--help",
        "completions bash",
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_blisk"))
            .args(line.split(' '))
            .current_dir(place.path("."))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the binary starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{line}: {words}");
        assert!(words.is_empty(), "{line}: {words}");
    }
}

/// What a terminal takes for orders: escape sequences of 7 and of 8 bits, a return that hides the line before it,
/// a backspace, and a turned direction of writing.
const ORDERS: &str = "\u{1b}]0;owned\u{7}\u{1b}[2J\u{9b}31m\r\u{8}\u{202e}";

fn gives_no_orders(ended: &Ended, what: &str) {
    for text in [&ended.stdout, &ended.stderr] {
        let order = |c: char| (c.is_control() && c != '\n' && c != '\t') || c == '\u{202e}';
        assert!(!text.contains(order), "{what}: {text:?}");
    }
}

#[test]
fn no_name_out_of_a_file_gives_orders_to_a_terminal() {
    let place = prepared();
    // A key, a value, a syntax error and a path, as a study may have them.
    let escapes: Vec<String> = ORDERS
        .chars()
        .map(|c| format!("\\u{:04x}", u32::from(c)))
        .collect();
    let in_toml = escapes.concat();
    for (file, text) in [
        ("key.toml", format!("{GOOD}\"{in_toml}\" = 1\n")),
        (
            "value.toml",
            GOOD.replace("\"macro_slip_1d\"", &format!("\"{in_toml}\"")),
        ),
        (
            "syntax.toml",
            GOOD.replace("seed = 7", &format!("seed = {ORDERS}")),
        ),
        (
            "path.toml",
            GOOD.replace("source = \"lumped\"", "source = \"bundle\"")
                .replace(
                    "[model.lumped]",
                    &format!("[model.bundle]\npath = \"{in_toml}\"\n[other]"),
                ),
        ),
        (
            "name.toml",
            GOOD.replace("\"small\"", &format!("\"{in_toml}\"")),
        ),
    ] {
        place.write(file, &text);
        for line in [
            &["check", file][..],
            &["run", file],
            &["plan", file, "--json"],
        ] {
            let ended = place.run(line);
            assert_ne!(ended.code, 0, "{file}");
            gives_no_orders(&ended, file);
        }
    }
    // Names of files and folders, and arguments that clap repeats.
    let study = format!("{ORDERS}.toml");
    place.write(&study, GOOD);
    for line in [
        &["check", &study][..],
        &["check", &study, "--json"],
        &["run", &study, "--out", &format!("out{ORDERS}")],
        &["stats", &format!("out{ORDERS}")],
        &["stats", ORDERS],
        &["explain", ORDERS],
        &["stats", &format!("--{ORDERS}")],
        &["plot", "done", ORDERS],
        &["verify", "done", "--scenario", ORDERS, "--pattern", "1"],
    ] {
        gives_no_orders(&place.run(line), &format!("{line:?}"));
    }
    // Names in an import file and in a bundle.
    place.write(
        "import.toml",
        &format!("name = \"{in_toml}\"\nother = \"{in_toml}\"\n"),
    );
    gives_no_orders(
        &place.run(&["import", "import.toml", "--out", "b"]),
        "import",
    );
    let exported = place.run(&["model", "study.toml", "--export", "bundle"]);
    assert_eq!(exported.code, 0, "{}", exported.stderr);
    let header = std::fs::read_to_string(place.path("bundle/model.toml")).expect("a header");
    let renamed: Vec<String> = header
        .lines()
        .map(|line| {
            if line.starts_with("name = ") {
                format!("name = \"{in_toml}\"")
            } else {
                line.to_owned()
            }
        })
        .collect();
    place.write("bundle/model.toml", &renamed.join("\n"));
    let of_bundle = GOOD.split("[model]").next().expect("a head").to_owned()
        + "[model]\nsource = \"bundle\"\n[model.bundle]\npath = \"bundle\"\n[contact]"
        + GOOD.split("[contact]").nth(1).expect("the rest");
    place.write("bundle.toml", &of_bundle);
    for line in [
        &["check", "bundle.toml"][..],
        &["model", "bundle.toml"],
        &["model", "bundle.toml", "--json"],
    ] {
        let shown = place.run(line);
        assert_eq!(shown.code, 0, "{}", shown.stderr);
        gives_no_orders(&shown, "bundle");
    }
}

#[test]
fn an_argument_with_an_end_of_line_never_enters_the_script_for_slurm() {
    let place = Place::with(GOOD);
    let injected = "1\n#SBATCH --account=other\nrm -rf /tmp/none";
    for (option, value) in [
        ("--time", injected),
        ("--time", "1:00;reboot"),
        ("--time", "$(reboot)"),
        ("--time", ""),
        ("--out", "results\n#SBATCH --account=other"),
        ("--script", "script\u{1b}[2J.sh"),
    ] {
        let mut line = vec!["slurm", "study.toml", "--tasks", "2", option, value];
        if option != "--script" {
            line.extend(["--script", "script.sh"]);
        }
        let refused = place.run(&line);
        assert_eq!(refused.code, 2, "{option} {value:?}: {}", refused.stderr);
        assert!(refused.stderr.contains("accepted: "), "{}", refused.stderr);
        assert!(!place.path("script.sh").exists(), "{option} {value:?}");
    }
    for value in [
        "30",
        "30:00",
        "12:00:00",
        "2-0",
        "2-12:30",
        "2-12:30:00",
        "UNLIMITED",
    ] {
        let script = format!("{}.sh", value.replace(':', "_"));
        let wrote = place.run(&[
            "slurm",
            "study.toml",
            "--tasks",
            "2",
            "--time",
            value,
            "--script",
            &script,
        ]);
        assert_eq!(wrote.code, 0, "{value}: {}", wrote.stderr);
    }
}
