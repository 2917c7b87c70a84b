//! Every command that a page of the site shows is one that the program knows, and those that can be are run.

use std::path::Path;

use clap::{CommandFactory, Parser};

use crate::blisk::{GOOD, Place};

/// Pages with commands: those of the site, and those that a repository is known by.
pub fn pages() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = root.join("docs");
    let summary = std::fs::read_to_string(docs.join("SUMMARY.md")).expect("the table of contents");
    let of_site = summary
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next());
    let of_site = of_site.map(|page| docs.join(page).canonicalize().expect("a page of the site"));
    let others = [
        "docs/SUMMARY.md",
        "python/README.md",
        ".github/ISSUE_TEMPLATE/import-fails.md",
        ".github/ISSUE_TEMPLATE/wrong-number.md",
    ];
    let root = &root.canonicalize().expect("the clone");
    let mut paths: Vec<_> = of_site.chain(others.map(|page| root.join(page))).collect();
    paths.sort();
    let read = |path: &Path| std::fs::read_to_string(path).expect("a page");
    let name = |path: &Path| {
        path.strip_prefix(root)
            .expect("inside")
            .display()
            .to_string()
    };
    paths.iter().map(|path| (name(path), read(path))).collect()
}

/// What begins a command line of the program.
pub const PROGRAM: [&str; 3] = [
    "blisk ",
    "cargo run --release -- ",
    "cargo run --release --locked -- ",
];

/// The arguments of every command of a page: between backticks, or as a line of its own.
pub fn commands(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut of = |text: &str| {
        for program in PROGRAM {
            if let Some(arguments) = text.strip_prefix(program) {
                found.push(arguments.to_owned());
            }
        }
    };
    for line in page.lines() {
        // A comment, or where the output goes, is the shell's.
        let line = line.trim_start().split("  #").next().unwrap_or_default();
        of(line.split(" > ").next().unwrap_or_default().trim_end());
    }
    let flowing = page.replace('\n', " ");
    for code in flowing.split('`').skip(1).step_by(2) {
        of(code.split(" > ").next().unwrap_or_default().trim());
    }
    found
}

/// A command line with values in the place of what stands for them: alternatives by their first, options in
/// brackets included.
fn with_values(command: &str) -> Vec<String> {
    let plain = command
        .replace("\\|", "|")
        .replace(['[', ']'], " ")
        .replace("...", " ");
    let mut words: Vec<String> = Vec::new();
    for word in plain.split_whitespace() {
        let first = if word.starts_with("--") {
            word
        } else {
            word.split('|').next().expect("a word")
        };
        let before = words.last().map(String::as_str);
        let value = match (first, before) {
            ("DIR" | "BUNDLE", _) => "results/small",
            ("FILE", Some("--out")) => "out.csv",
            ("STUDY" | "FILE.toml" | "FILE", _) => "study.toml",
            ("FIGURE", _) => "amplitude",
            ("SHELL", _) => "bash",
            ("KEY", _) => "solver",
            ("NAME", _) => "quickstart",
            ("START:STOP:COUNT", _) => "300:400:3",
            ("LOW:HIGH", _) => "30:300",
            ("RPM=BUNDLE", _) => "0=bundle",
            ("k/n", _) => "1/2",
            ("T", _) => "01:00:00",
            ("tuned", Some("--pattern")) => "tuned",
            ("I" | "ID" | "N" | "S" | "M", _) => "5",
            ("P", _) => "95",
            ("R", _) => "0.1",
            ("HZ", _) => "2500",
            ("Q", _) => "peak_amplitude_m",
            (other, _) => other,
        };
        words.push(value.to_owned());
    }
    words
}

#[test]
fn every_command_of_the_documentation_is_one_of_the_program() {
    let mut count = 0;
    for (name, page) in pages() {
        for command in commands(&page) {
            // A command that is only named lacks what it needs.
            let words = with_values(&command);
            let line = ["blisk".to_owned()].into_iter().chain(words.clone());
            if let Err(error) = blisk::cli::Arguments::try_parse_from(line) {
                // Help and version end the reading of a command line, and are no errors.
                if !error.use_stderr() {
                    continue;
                }
                let lacks = error.kind() == clap::error::ErrorKind::MissingRequiredArgument;
                let shortened = words.len() < 3 || command.contains("...");
                assert!(lacks && shortened, "{name}: blisk {command}\n{error}");
            }
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}

fn page_of_commands() -> String {
    let found = pages()
        .into_iter()
        .find(|(name, _)| name == "docs/commands.md");
    found.expect("docs/commands.md").1
}

/// The commands under every heading of a text, each once and in its order: of lines that `name` finds a command in.
fn under_headings(
    text: &str,
    heading: impl Fn(&str) -> Option<String>,
    name: impl Fn(&str) -> Option<String>,
) -> Vec<(String, Vec<String>)> {
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for line in text.lines() {
        if let Some(heading) = heading(line) {
            groups.push((heading, Vec::new()));
        } else if let (Some(name), Some((_, names))) = (name(line), groups.last_mut())
            && !names.contains(&name)
        {
            names.push(name);
        }
    }
    groups.retain(|(_, names)| !names.is_empty());
    groups
}

#[test]
fn the_help_and_the_page_of_commands_have_every_command_under_one_heading() {
    let groups: Vec<(String, Vec<String>)> = blisk::cli::GROUPS
        .iter()
        .map(|(heading, names)| {
            let names = names.iter().map(|&name| name.to_owned());
            ((*heading).to_owned(), names.collect())
        })
        .collect();
    let known = blisk::cli::Arguments::command();
    let shown = |command: &&clap::Command| !command.is_hide_set();
    let known = known
        .get_subcommands()
        .filter(shown)
        .map(clap::Command::get_name);
    let known: std::collections::BTreeSet<&str> = known.collect();
    let grouped: Vec<&str> = groups
        .iter()
        .flat_map(|(_, names)| names)
        .map(String::as_str)
        .collect();
    assert_eq!(grouped.len(), known.len());
    assert_eq!(known, grouped.into_iter().collect());
    let word = |text: &str| text.split([' ', '`']).next().map(str::to_owned);
    let of_page = under_headings(
        &page_of_commands(),
        |line| line.strip_prefix("## ").map(str::to_owned),
        |line| word(line.strip_prefix("| `blisk ")?),
    );
    assert_eq!(of_page, groups);
    let help = Place::new().run(&["--help"]).stdout;
    let of_help = under_headings(
        &help,
        |line| line.strip_suffix(':').map(str::to_owned),
        |line| word(line.strip_prefix("  ")?).filter(|name| known.contains(name.as_str())),
    );
    assert_eq!(of_help, groups, "{help}");
    let widest = help.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(100), "{widest:?}");
}

#[test]
fn the_commands_of_their_page_run_on_a_small_study() {
    let study = GOOD.replace("patterns = 10", "patterns = 75");
    let place = Place::with(&study);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let page = page_of_commands();
    let mut run = Vec::new();
    for line in page.lines().filter(|line| line.starts_with("| `blisk ")) {
        let command = commands(line).into_iter().next().expect("a command");
        // What is in brackets may be left out; what needs a cluster, an import or another folder is tested elsewhere.
        let mut short = command;
        while let (Some(start), Some(end)) = (short.find('['), short.find(']')) {
            short.replace_range(start..=end, "");
        }
        let mut words = with_values(&short);
        let name = words[0].clone();
        if ["import", "slurm", "merge", "estimate"].contains(&name.as_str()) {
            continue;
        }
        if name == "init" {
            words.extend(["--out", "new.toml"].map(str::to_owned));
        }
        // The folder is not in the place that the name of the study says.
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let words: Vec<&str> = match words.as_slice() {
            ["verify", .., "--scenario", _, "--pattern", _]
                if !words.contains(&"--time-domain") =>
            {
                vec![
                    "verify",
                    "results/small",
                    "--scenario",
                    "1",
                    "--pattern",
                    "5",
                ]
            }
            // The sample and the threads of a short run, so that the test is one.
            ["plan", ..] => vec!["plan", "study.toml", "--pilot", "3"],
            ["verify", "study.toml"] => vec!["verify", "study.toml", "--sample", "2"],
            ["verify", "study.toml", "--dense-sweep"] => {
                vec!["verify", "study.toml", "--dense-sweep", "--sample", "1"]
            }
            ["optimum", ..] => vec![
                "optimum",
                "study.toml",
                "--between",
                "30:300",
                "--resolution",
                "0.5",
            ],
            all => all.to_vec(),
        };
        let ended = place.run(&words);
        // A verification may find something to say about this study.
        let fine = ended.code == 0 || words[0] == "verify" && ended.code == 11;
        assert!(
            fine,
            "blisk {}: {} {}{}",
            words.join(" "),
            ended.code,
            ended.stdout,
            ended.stderr
        );
        run.push(name);
    }
    assert!(run.len() >= 18, "{run:?}");
}

/// Lines of the blocks of shell commands of a page, in order.
fn shell_lines(page: &str) -> Vec<String> {
    let blocks = page.split("```").skip(1).step_by(2);
    let blocks = blocks.filter_map(|block| block.strip_prefix("sh\n"));
    let lines = blocks.flat_map(str::lines);
    lines
        .filter(|line| !line.is_empty())
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_tutorial_runs_from_its_first_study_to_its_last_command() {
    let (_, tutorial) = pages()
        .into_iter()
        .find(|(name, _)| name == "docs/tutorial.md")
        .expect("docs/tutorial.md");
    let place = Place::new();
    let lines = shell_lines(&tutorial);
    assert_eq!(lines[0], "cargo install --path . --locked");
    for line in &lines[1..] {
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(words[0], "blisk", "{line}");
        let ended = place.run(&words[1..]);
        assert_eq!(ended.code, 0, "{line}: {}{}", ended.stdout, ended.stderr);
        if words[1] == "init" {
            // A wheel of masses and few patterns in the place of one of finite elements.
            let small = GOOD
                .replace("name = \"small\"", "name = \"quickstart\"")
                .replace("patterns = 10", "patterns = 80")
                .replace(
                    "[\"slide\", 50, \"stuck\"]",
                    "[\"slide\", 320, 800, \"stuck\"]",
                );
            place.write("ring.toml", &small);
        }
    }
    let last =
        std::fs::read_to_string(place.path("results/quickstart/summary.txt")).expect("a summary");
    assert!(last.contains("80 patterns"), "{last}");
    // The search starts from the loads of the study.
    assert!(!place.path("results/quickstart-optimum/load-320").exists());
    assert!(place.path("results/quickstart/report.html").exists());
    assert!(lines.len() >= 9, "{lines:?}");
}
