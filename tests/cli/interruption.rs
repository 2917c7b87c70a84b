//! Runs that are killed, asked to stop, locked out or out of disk come to the bytes of an undisturbed one.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::blisk::{GOOD, Place, ended, signal};

const TABLES: [&str; 5] = [
    "responses.parquet",
    "scenarios.parquet",
    "patterns.parquet",
    "summary.txt",
    "manifest.json",
];

fn study(patterns: u32) -> String {
    GOOD.replace("patterns = 10", &format!("patterns = {patterns}"))
}

fn bytes(place: &Place, results: &str) -> Vec<Vec<u8>> {
    let folder = place.path(results);
    TABLES
        .map(|table| std::fs::read(folder.join(table)).expect(table))
        .to_vec()
}

/// The tables of an undisturbed run, and how long it took.
fn undisturbed(place: &Place) -> (Vec<Vec<u8>>, Duration) {
    let began = Instant::now();
    let run = place.run(&["run", "study.toml", "--out", "undisturbed"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    (bytes(place, "undisturbed"), began.elapsed())
}

/// Waits until a part of `results` is stored.
fn await_part(place: &Place, results: &str) {
    let parts = place.path(results).join("parts");
    let began = Instant::now();
    let stored = |parts: &Path| {
        let mut entries = std::fs::read_dir(parts).into_iter().flatten().flatten();
        entries.any(|entry| entry.file_name().to_string_lossy().starts_with("part-"))
    };
    while !stored(&parts) {
        assert!(began.elapsed() < Duration::from_mins(1), "no part appears");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Kills a run of `study` at `kills` instants of its way, no two alike, then lets it end.
fn killed(kills: u32, study: &str) {
    let place = Place::with(study);
    let (expected, mut whole) = undisturbed(&place);
    let mut attempts = 0;
    let mut done = 0;
    let mut round = 0;
    while done < kills {
        assert!(attempts < 10 * kills, "{done} kills of {attempts} attempts");
        let out = format!("killed{round}");
        for continued in 0..5 {
            let mut child = place.start(&["run", "study.toml", "--out", &out]);
            // A sequence that fills the time of a run evenly (golden ratio).
            let share = (f64::from(attempts) * 0.618_033_988_75).fract();
            attempts += 1;
            std::thread::sleep(whole.mul_f64(share));
            let was_running = child.try_wait().expect("a child").is_none();
            child.kill().expect("killed");
            child.wait().expect("ended");
            if was_running {
                done += 1;
                continue;
            }
            // The machine may have been busier when the undisturbed run was timed.
            if continued == 0 {
                whole = whole.mul_f64(share);
            }
            break;
        }
        let run = place.run(&["run", "study.toml", "--out", &out]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        assert!(bytes(&place, &out) == expected, "after {done} kills");
        round += 1;
    }
}

#[test]
fn kills_while_settings_are_chosen_change_neither_the_choice_nor_a_row() {
    let open = study(12).replace("[solver]\nharmonics = [1, 3]\n", "");
    killed(8, &format!("{open}[accuracy]\namplitude_error = 0.01\n"));
}

#[test]
fn thirty_kills_lose_and_double_no_row() {
    killed(30, &study(24));
}

/// `cargo test --release --test cli -- --ignored three_hundred`
#[test]
#[ignore = "some minutes"]
fn three_hundred_kills_lose_and_double_no_row() {
    killed(300, &study(200));
}

#[test]
fn a_signal_stores_what_is_solved_and_the_same_command_continues() {
    let place = Place::with(&study(400));
    let expected = undisturbed(&place).0;
    for (name, code) in [("INT", 130), ("TERM", 143), ("HUP", 143), ("USR1", 143)] {
        let child = place.start(&["run", "study.toml", "--out", name]);
        await_part(&place, name);
        assert!(signal(&child, name));
        let asked = Instant::now();
        let stopped = ended(child);
        assert!(asked.elapsed() < Duration::from_secs(5), "{name}");
        assert_eq!(stopped.code, code, "{name}: {}", stopped.stderr);
        assert!(
            stopped.stderr.contains("rows are stored in"),
            "{}",
            stopped.stderr
        );
    }
    let stats = place.run(&["stats", "TERM"]);
    assert_eq!(stats.code, 0, "{}", stats.stderr);
    assert!(
        stats
            .stdout
            .starts_with("UNFINISHED: these are the statistics of ")
    );
    let status = place.run(&["status", "TERM"]);
    assert!(status.stdout.contains("not running"), "{}", status.stdout);
    let run = place.run(&["run", "study.toml", "--out", "TERM"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(!run.stderr.contains("reused 0"), "{}", run.stderr);
    assert!(bytes(&place, "TERM") == expected);
    // Once more ends it at once, whatever it is at.
    let child = place.start(&["run", "study.toml", "--out", "twice"]);
    await_part(&place, "twice");
    assert!(signal(&child, "INT"));
    assert!(signal(&child, "INT"));
    let asked = Instant::now();
    assert_eq!(ended(child).code, 130);
    assert!(asked.elapsed() < Duration::from_secs(2));
}

#[test]
fn a_signal_that_is_ignored_from_the_start_stays_ignored() {
    let place = Place::with(&study(60));
    let line = format!(
        "trap '' HUP; exec {} run study.toml --out kept",
        env!("CARGO_BIN_EXE_blisk")
    );
    let child = Command::new("sh")
        .args(["-c", &line])
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a shell");
    await_part(&place, "kept");
    assert!(signal(&child, "HUP"));
    let run = ended(child);
    assert_eq!(run.code, 0, "{}", run.stderr);
}

#[test]
fn a_living_process_keeps_others_out_and_a_killed_one_is_taken_over() {
    let place = Place::with(&study(400));
    let mut child = place.start(&["run", "study.toml", "--out", "out"]);
    await_part(&place, "out");
    assert!(signal(&child, "STOP"));
    let holder = format!("process {} on ", child.id());
    let refused = place.run(&["run", "study.toml", "--out", "out"]);
    assert_eq!(refused.code, 10, "{}", refused.stderr);
    assert!(refused.stderr.contains(&holder), "{}", refused.stderr);
    let status = place.run(&["status", "out", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&status.stdout).expect("JSON");
    assert_eq!(
        (&value["work"], &value["planned"]),
        (&"running".into(), &1200.into())
    );
    assert_eq!(value["holder"]["process"], child.id());
    assert!(
        value["rows"]["planned"]
            .as_u64()
            .is_some_and(|rows| rows >= 24)
    );
    // A reader that is broken off leaves nothing behind.
    let mut reader = place.start(&["status", "out"]);
    reader.kill().expect("killed");
    reader.wait().expect("ended");
    child.kill().expect("killed");
    child.wait().expect("ended");
    let status = place.run(&["status", "out"]);
    assert!(
        status.stdout.contains("was broken off"),
        "{}",
        status.stdout
    );
    place.write("study.toml", &study(401));
    let run = place.run(&["run", "study.toml", "--out", "out"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let expected = format!("taken over from {holder}");
    assert!(run.stderr.contains(&expected), "{}", run.stderr);
    assert!(!run.stderr.contains("reused 0"), "{}", run.stderr);
}

#[test]
fn shards_run_side_by_side_and_merge_to_the_tables_of_a_run_at_once() {
    let place = Place::with(&study(60));
    let expected = undisturbed(&place).0;
    // One shard alone: the two that nobody has begun are not in the count of rows, and the line says so.
    let first = place.run(&["run", "study.toml", "--out", "out", "--shard", "1/3"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    let status = place.run(&["status", "out"]).stdout;
    assert!(
        status.contains("60 of 60 rows")
            && status.contains("; 2 of 3 shards not begun, their rows not counted")
            && status.contains("shards not finished: 2,3"),
        "{status}"
    );
    let workers: Vec<Child> = (1..=3)
        .map(|number| {
            let shard = format!("{number}/3");
            place.start(&["run", "study.toml", "--out", "out", "--shard", &shard])
        })
        .collect();
    for worker in workers {
        let worker = ended(worker);
        assert_eq!(worker.code, 0, "{}", worker.stderr);
    }
    let status = place.run(&["status", "out"]);
    assert!(
        status.stdout.contains("finished, 180 of 180 rows") && !status.stdout.contains("not begun"),
        "{}",
        status.stdout
    );
    let early = place.run(&["report", "out"]);
    assert_ne!(early.code, 0);
    assert!(
        early
            .stderr
            .contains("`blisk merge out --out out` makes it"),
        "{}",
        early.stderr
    );
    let missing = place.run(&[
        "merge",
        "out/shards/3-of-3",
        "out/shards/1-of-3",
        "--out",
        "no",
    ]);
    assert_eq!(missing.code, 2, "{}", missing.stderr);
    assert!(
        missing.stderr.contains("missing shards: 2/3"),
        "{}",
        missing.stderr
    );
    let merged = place.run(&["merge", "out", "--out", "out"]);
    assert_eq!(merged.code, 0, "{}", merged.stderr);
    assert!(bytes(&place, "out") == expected);
    let again = place.run(&["run", "study.toml", "--out", "out"]);
    assert!(
        again.stderr.contains("nothing to solve"),
        "{}",
        again.stderr
    );
}

#[test]
fn the_scheduler_says_which_shard_and_how_many_threads() {
    let place = Place::with(&study(10));
    let run = |variables: &[(&str, &str)], arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_blisk"))
            .args(["run", "study.toml"])
            .args(arguments)
            .envs(variables.iter().copied())
            .current_dir(place.path("."))
            .output();
        output.expect("the binary starts")
    };
    let array = [
        ("SLURM_ARRAY_TASK_ID", "2"),
        ("SLURM_ARRAY_TASK_MIN", "1"),
        ("SLURM_ARRAY_TASK_MAX", "4"),
        ("SLURM_ARRAY_TASK_COUNT", "4"),
        ("SLURM_CPUS_PER_TASK", "3"),
    ];
    assert!(run(&array, &["--out", "array", "--shard"]).status.success());
    let record = place.path("array/shards/2-of-4/runs/1.json");
    let text = std::fs::read_to_string(record).expect("a record");
    assert!(text.contains("\"threads\": 3"), "{text}");
    let outside = run(&[], &["--shard", "auto"]);
    assert_eq!(outside.status.code(), Some(2));
    let whole = run(&array, &["--out", "whole"]);
    assert!(whole.status.success() && place.path("whole/responses.parquet").exists());
}

#[test]
fn a_full_disk_ends_with_7_and_a_remedy_and_the_run_continues() {
    let place = Place::with(&study(60));
    let expected = undisturbed(&place).0;
    let limited = |bytes: u32| {
        // Files cannot grow beyond the limit: what a full disk or a quota does.
        let line = format!(
            "trap '' XFSZ; ulimit -f {}; exec {} run study.toml --out full",
            bytes / 512,
            env!("CARGO_BIN_EXE_blisk")
        );
        let output = Command::new("sh")
            .args(["-c", &line])
            .current_dir(place.path("."))
            .output();
        let output = output.expect("a shell");
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), words)
    };
    // Too little for the lock, the reduced model, the manifest and the tables.
    for bytes in [0, 4096, 7168, 16_384] {
        let (code, words) = limited(bytes);
        assert_eq!(code, Some(7), "{words}");
        assert!(words.contains("full"), "{words}");
        assert!(words.contains("; free some space"), "{words}");
    }
    let run = place.run(&["run", "study.toml", "--out", "full"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(bytes(&place, "full") == expected);
}

#[test]
fn a_damaged_table_exits_with_8_and_is_repaired() {
    let place = Place::with(&study(10));
    let expected = undisturbed(&place).0;
    let table = place.path("undisturbed/responses.parquet");
    let mut content = std::fs::read(&table).expect("read");
    content[1000] ^= 16;
    std::fs::write(&table, &content).expect("written");
    for command in [
        &["run", "study.toml", "--out", "undisturbed"][..],
        &["stats", "undisturbed"],
        &["verify", "undisturbed"],
        &["verify", "undisturbed", "--scenario", "1", "--pattern", "3"],
        &["status", "undisturbed"],
    ] {
        let refused = place.run(command);
        assert_eq!(refused.code, 8, "{command:?}: {}", refused.stderr);
        assert!(
            refused
                .stderr
                .contains("undisturbed/responses.parquet is damaged")
                && refused.stderr.contains("--repair"),
            "{}",
            refused.stderr
        );
    }
    let repaired = place.run(&["verify", "undisturbed", "--repair"]);
    assert_eq!(repaired.code, 0, "{}", repaired.stderr);
    let words = "solved 30 rows again, reused 0; every table is the same bytes as before";
    assert!(repaired.stdout.contains(words), "{}", repaired.stdout);
    assert!(bytes(&place, "undisturbed") == expected);
    let aside = std::fs::read(place.path("undisturbed/damaged/responses.parquet"));
    assert!(aside.expect("set aside") == content);
    let again = place.run(&["verify", "undisturbed", "--repair"]);
    assert!(
        again.stdout.contains("no file is damaged"),
        "{}",
        again.stdout
    );
}

#[test]
fn the_script_for_slurm_is_sound_and_writes_over_nothing() {
    let place = Place::with(&study(10));
    let arguments = ["slurm", "study.toml", "--tasks", "4", "--time", "00:10:00"];
    let wrote = place.run(&arguments);
    assert_eq!(wrote.code, 0, "{}", wrote.stderr);
    let script = place.path("small-slurm.sh");
    let text = std::fs::read_to_string(&script).expect("written");
    for line in [
        "--array=\"${1:-1-4}\"",
        "#SBATCH --time=00:10:00\n",
        "#SBATCH --requeue\n",
        "#SBATCH --signal=B:USR1@120\n",
        "--shard \"$SLURM_ARRAY_TASK_ID/4\"",
        "scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\"",
        "--dependency=\"afterok:${array%%;*}\"",
        "merge \"$results\"/shards/*-of-4 --out \"$results\"",
    ] {
        assert!(text.contains(line), "{line} in {text}");
    }
    let parsed = Command::new("bash").arg("-n").arg(&script).status();
    assert!(parsed.expect("a shell").success());
    let again = place.run(&arguments);
    assert_eq!(again.code, 7, "{}", again.stderr);
    assert!(again.stderr.contains("exists already"), "{}", again.stderr);
}
