//! Every command that works for a while, ended at any instant by a signal or a kill: the next call comes to the bytes
//! of an undisturbed one, and nothing is left over.

use std::path::Path;
use std::process::Child;
use std::time::{Duration, Instant};

use crate::blisk::{GOOD, Place, ended, signal};

/// Time after a signal within which a command has to end.
const AT_ONCE: Duration = Duration::from_secs(5);

/// A command, what has to be there before it, and the files that it makes.
struct Job {
    name: &'static str,
    study: String,
    before: Vec<Vec<&'static str>>,
    command: Vec<&'static str>,
    files: &'static [&'static str],
    /// A byte of this file is changed before the command.
    damaged: Option<&'static str>,
    /// What is to be given after it.
    after: Option<Vec<&'static str>>,
}

const TABLES: &[&str] = &[
    "out/responses.parquet",
    "out/scenarios.parquet",
    "out/patterns.parquet",
    "out/summary.txt",
    "out/manifest.json",
];

fn words(line: &'static str) -> Vec<&'static str> {
    line.split(' ').collect()
}

fn jobs() -> Vec<Job> {
    let study = |patterns: u32| GOOD.replace("patterns = 10", &format!("patterns = {patterns}"));
    let finished = || vec![words("run study.toml --out out")];
    let job = |name, patterns, before, command, files| Job {
        name,
        study: study(patterns),
        before,
        command: words(command),
        files,
        damaged: None,
        after: None,
    };
    vec![
        job("run", 60, vec![], "run study.toml --out out", TABLES),
        job(
            "estimate",
            200,
            vec![],
            "estimate study.toml --solves 60 --target mean --out out",
            &["out/sample.parquet", "out/estimate.json", "out/summary.txt"],
        ),
        job(
            "optimum",
            20,
            vec![],
            "optimum study.toml --between 40:60 --percentile 50 --resolution 0.2 --out out",
            &[
                "out/load-40/responses.parquet",
                "out/load-60/responses.parquet",
                "out/load-60/manifest.json",
            ],
        ),
        job(
            "tradeoff",
            10,
            vec![],
            "tradeoff study.toml --patterns 2 --out out",
            &["out/tradeoff.parquet", "out/tradeoff_rows.parquet"],
        ),
        job(
            "merge",
            40,
            vec![
                words("run study.toml --out out --shard 1/2"),
                words("run study.toml --out out --shard 2/2"),
            ],
            "merge out --out out",
            TABLES,
        ),
        Job {
            // What a killed report leaves is hidden, and taken away by the next command that writes results.
            after: Some(words("run study.toml --out out")),
            ..job("report", 40, finished(), "report out", &["out/report.html"])
        },
        job(
            "verify",
            20,
            finished(),
            "verify out --sample 4",
            &["out/verification.parquet"],
        ),
        Job {
            damaged: Some("out/responses.parquet"),
            after: Some(words("run study.toml --out out")),
            ..job("repair", 60, finished(), "verify out --repair", TABLES)
        },
    ]
}

impl Job {
    /// A folder in which the command can begin.
    fn place(&self) -> Place {
        let place = Place::with(&self.study);
        for line in &self.before {
            let before = place.run(line);
            assert_eq!(before.code, 0, "{}: {}", self.name, before.stderr);
        }
        if let Some(damaged) = self.damaged {
            let path = place.path(damaged);
            let mut content = std::fs::read(&path).expect("a table");
            content[1000] ^= 16;
            std::fs::write(&path, content).expect("written");
        }
        place
    }

    fn bytes(&self, place: &Place) -> Vec<Vec<u8>> {
        let read = |file: &&str| std::fs::read(place.path(file)).expect(file);
        self.files.iter().map(read).collect()
    }

    fn finish(&self, place: &Place) -> Vec<Vec<u8>> {
        for line in std::iter::once(&self.command).chain(&self.after) {
            let end = place.run(line);
            assert_eq!(end.code, 0, "{}: {}", self.name, end.stderr);
        }
        self.bytes(place)
    }
}

/// Files of interrupted writes of tables and texts below `folder`.
fn leftovers(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if path.is_dir() && name != "next" {
            found.extend(leftovers(&path));
        } else if name == "next" || name.contains(".tmp") {
            found.push(path.display().to_string());
        }
    }
    found
}

/// A sequence that depends on its seed alone.
struct Sequence(u64);

impl Sequence {
    fn below_one(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Interrupts `job` at `wanted` instants, up to three times on its way to one end; gives the longest time from a signal to the end of the
/// process.
fn interrupted(job: &Job, wanted: u32, seed: u64) -> Duration {
    let place = job.place();
    let began = Instant::now();
    let expected = job.finish(&place);
    let mut whole = began.elapsed();
    let mut sequence = Sequence(seed);
    let (mut done, mut attempts, mut longest) = (0, 0, Duration::ZERO);
    while done < wanted {
        let place = job.place();
        for _ in 0..3 {
            assert!(attempts < 20 * wanted, "{}: {done} of {attempts}", job.name);
            attempts += 1;
            let mut child = place.start(&job.command);
            std::thread::sleep(whole.mul_f64(sequence.below_one()));
            if child.try_wait().expect("a child").is_some() {
                // The machine may have been busier when the undisturbed run was timed.
                whole = whole.mul_f64(0.9);
                break;
            }
            let (name, code) =
                [("INT", 130), ("TERM", 143), ("KILL", -1)][(3.0 * sequence.below_one()) as usize];
            // It may have ended meanwhile.
            signal(&child, name);
            let asked = Instant::now();
            let stopped = ended(child);
            let took = asked.elapsed();
            // Without a word only where the signal came before the program was there, or after its end.
            let before = -1;
            assert!(
                [code, 0, before].contains(&stopped.code),
                "{} {name}: {}: {}",
                job.name,
                stopped.code,
                stopped.stderr
            );
            if name != "KILL" {
                assert!(took < AT_ONCE, "{} {name}: {took:?}", job.name);
                longest = longest.max(took);
            }
            if stopped.code > 0 {
                assert!(
                    stopped.stderr.contains("interrupted: ")
                        && ["the same command", "`blisk run` continues"]
                            .iter()
                            .any(|words| stopped.stderr.contains(words)),
                    "{} {name}: {}",
                    job.name,
                    stopped.stderr
                );
            }
            if stopped.code == 0 {
                break;
            }
            done += 1;
        }
        let found = job.finish(&place);
        assert!(
            found == expected,
            "{} after {done} interruptions, seed {seed}",
            job.name
        );
        let left = leftovers(&place.path("."));
        assert!(
            left.is_empty(),
            "{} after {done} interruptions: {left:?}",
            job.name
        );
    }
    longest
}

#[test]
fn every_working_command_comes_to_the_same_bytes_after_interruptions() {
    for (place, job) in jobs().iter().enumerate() {
        interrupted(job, 3, 1 + place as u64);
    }
}

/// `cargo test --release --test cli -- --ignored three_hundred_interruptions`
#[test]
#[ignore = "some minutes"]
fn three_hundred_interruptions_of_every_working_command_end_in_the_same_bytes() {
    let jobs = jobs();
    let each = 300_u32.div_ceil(jobs.len() as u32);
    for (place, job) in jobs.iter().enumerate() {
        interrupted(job, each, 100 + place as u64);
    }
}

/// A wheel whose rows take minutes.
fn slow() -> String {
    GOOD.replace("sectors = 6", "sectors = 600")
        .replace("patterns = 10", "patterns = 200")
        .replace("\"slide\", 50, \"stuck\"", "50")
        .replace(
            "[1, 3]",
            "[1, 3, 5, 7, 9, 11, 13]\nsamples_per_period = 512",
        )
}

/// Its rows are given up after some seconds, or, where nothing is stored anyway, at once.
#[test]
fn a_signal_ends_every_solving_command_in_time_though_one_row_takes_minutes() {
    let place = Place::with(&slow());
    let stores = [
        "run study.toml --out run --threads 1",
        "estimate study.toml --solves 60 --out estimate --threads 1",
        "optimum study.toml --between 40:60 --out optimum --threads 1",
    ];
    let keeps_nothing = [
        "plan study.toml --threads 1",
        "tradeoff study.toml --out tradeoff --threads 1",
        "response study.toml --pattern 0 --load 50 --frequencies 400:500:50 --out curve.csv",
    ];
    let all = [&stores[..], &keeps_nothing[..]].concat();
    for (name, code) in [("INT", 130), ("TERM", 143)] {
        let children: Vec<Child> = all.iter().map(|line| place.start(&words(line))).collect();
        std::thread::sleep(Duration::from_secs(2));
        let asked = Instant::now();
        for child in &children {
            // It may have ended meanwhile.
            signal(child, name);
        }
        for (line, child) in all.iter().zip(children) {
            let stopped = ended(child);
            assert!(asked.elapsed() < AT_ONCE, "{line}: {:?}", asked.elapsed());
            assert_eq!(stopped.code, code, "{line}: {}", stopped.stderr);
            let said = if stores.contains(line) {
                stopped.stderr.contains("stored")
                    && stopped.stderr.contains("the same command continues")
            } else {
                stopped
                    .stderr
                    .contains("kept; the same command begins again")
            };
            assert!(said, "{line}: {}", stopped.stderr);
        }
        assert!(!place.path("curve.csv").exists());
        let left = leftovers(&place.path("."));
        assert!(left.is_empty(), "{left:?}");
    }
}
