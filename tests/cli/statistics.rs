//! What the commands say about populations: the same counts everywhere, comparisons.

use crate::blisk::{GOOD, Place};

/// A wheel whose blades lose their stiffness in some patterns.
fn with_failures() -> String {
    GOOD.replace("patterns = 10", "patterns = 80")
        .replace(
            "standard_deviation = [0.03]",
            "standard_deviation = [0.05, 0.6]",
        )
        .replace("[\"slide\", 50, \"stuck\"]", "[\"slide\", 50]")
}

#[test]
fn rows_are_counted_the_same_in_table_manifest_summary_json_and_exit_code() {
    let place = Place::with(&with_failures());
    let run = place.run(&["run", "study.toml", "--json"]);
    let summary: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let manifest = std::fs::read_to_string(place.path("results/small/manifest.json"));
    let manifest: serde_json::Value =
        serde_json::from_str(&manifest.expect("manifest")).expect("JSON");
    let mut total = [0_u64; 3];
    for (place, scenario) in summary["scenarios"]
        .as_array()
        .expect("a list")
        .iter()
        .enumerate()
    {
        let counts = &manifest["scenarios"][place]["counts"];
        let keys = ["planned", "ok", "failed"];
        for (sum, key) in total.iter_mut().zip(keys) {
            assert_eq!(
                scenario["rows"][key], counts[key],
                "scenario {place}, {key}"
            );
            *sum += counts[key].as_u64().expect("a count");
        }
        let by_status = counts["by_status"].as_object().expect("a table");
        assert_eq!(&scenario["rows"]["by_status"], &counts["by_status"]);
        let all: u64 = by_status
            .values()
            .filter_map(serde_json::Value::as_u64)
            .sum();
        assert_eq!(all, 80);
        let failed = all - by_status["ok"].as_u64().expect("a count");
        assert_eq!(counts["failed"], failed);
        let bound = scenario["rows"]["failed_share_upper_bound"]
            .as_f64()
            .expect("a share");
        assert!(bound > failed as f64 / 80.0 && bound <= 1.0);
    }
    assert_eq!(total[0], 320);
    assert_eq!(total[0], total[1] + total[2]);
    assert!(
        total[2] > 10,
        "this study is meant to fail in many patterns"
    );
    for (sum, key) in total.iter().zip(["planned", "ok", "failed"]) {
        assert_eq!(summary["rows"][key], *sum);
        assert_eq!(manifest["counts"][key], *sum);
    }
    let text = std::fs::read_to_string(place.path("results/small/summary.txt")).expect("summary");
    let line = format!("{} rows ok, {} failed", total[1], total[2]);
    assert!(text.contains(&line), "{text}");
    // Failures beyond the gate of P95 cost its value, in both commands.
    assert_eq!(run.code, 5);
    assert_eq!(place.run(&["stats", "results/small"]).code, 5);
}
