//! A study in shards comes to the same bytes as at once, however it is cut and in whatever order.

use std::path::{Path, PathBuf};

use blisk::campaign::{RunRequest, merge, run_shard, set_other_builds_aside, status_of_folder};
use blisk::population::table::Shard;
use blisk::settings::ReducedEngineSource;
use blisk::study::{PipelineError, Study};

use crate::folder::{Silent, bytes, copy, files, reference, run_in};
use crate::mock_engine::{MockSource, study};

/// Solves a shard, and gives its folder.
fn solve(results: &Path, study: &Study, number: u32, count: u32) -> PathBuf {
    let shard = Shard { number, count };
    let request = RunRequest {
        study,
        results,
        threads: 1,
    };
    run_shard(request, shard, &MockSource::default(), &Silent).expect("a shard");
    results.join("shards").join(shard.folder_name())
}

/// A permutation of `0..count` without pattern to the eye.
fn shuffled(count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|place| (place * 7919 + 13) % 1009);
    order
}

#[test]
fn every_cut_merges_to_the_same_bytes_in_any_order() {
    let expected = reference(100);
    let study = study(100, |text| text);
    for count in [1, 2, 3, 7, 64] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let order = shuffled(count as usize);
        let shards: Vec<PathBuf> = order
            .iter()
            .map(|&place| solve(folder.path(), &study, place as u32 + 1, count))
            .collect();
        for merged in ["a", "b"] {
            let out = folder.path().join(merged);
            let mut shards = shards.clone();
            if merged == "b" {
                shards.reverse();
            }
            let outcome = merge(&shards, &out, None, &ReducedEngineSource).expect("merged");
            assert_eq!(outcome.rows_reused, 400);
            assert!(bytes(&out) == expected, "{count} shards");
        }
        // The results folder names all of its shards, and takes their results.
        merge(
            &[folder.path().to_owned()],
            folder.path(),
            None,
            &ReducedEngineSource,
        )
        .expect("merged in place");
        assert!(bytes(folder.path()) == expected, "{count} shards in place");
        let status = status_of_folder(folder.path()).expect("a status");
        assert!(status.missing_shards.is_empty());
        assert_eq!((status.rows.planned(), status.planned), (400, 400));
    }
}

#[test]
fn more_shards_than_patterns_are_refused() {
    let study = study(5, |text| text);
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (number, count) in [(1, u32::MAX), (6, 6), (0, 5), (6, 5), (1, 0), (0, 0)] {
        let request = RunRequest {
            study: &study,
            results: folder.path(),
            threads: 1,
        };
        let shard = Shard { number, count };
        let refused = run_shard(request, shard, &MockSource::default(), &Silent);
        let words = refused.expect_err("no such share").to_string();
        assert!(words.contains("n from 1 to 5"), "{words}");
    }
    assert!(std::fs::read_dir(folder.path()).expect("a folder").count() == 0);
    for number in 1..=5 {
        solve(folder.path(), &study, number, 5);
    }
    merge(
        &[folder.path().to_owned()],
        folder.path(),
        None,
        &ReducedEngineSource,
    )
    .expect("merged");
    assert!(bytes(folder.path()) == reference(5));
}

#[test]
fn a_folder_named_like_a_shard_of_billions_is_no_shard() {
    let small = study(20, |text| text);
    let folder = tempfile::tempdir().expect("a temporary folder");
    for number in 1..=3 {
        solve(folder.path(), &small, number, 4);
    }
    for name in ["1-of-4294967295", "1-of-99999", "0-of-0"] {
        std::fs::create_dir_all(folder.path().join("shards").join(name)).expect("made");
    }
    let status = status_of_folder(folder.path()).expect("a status");
    assert_eq!(status.missing_shards, [4]);
    let shards: Vec<PathBuf> = (1..=3)
        .map(|number| folder.path().join(format!("shards/{number}-of-4")))
        .collect();
    refused(&shards, &folder.path().join("out"), "missing shards: 4/4");
}

fn refused(shards: &[PathBuf], out: &Path, expected: &str) -> PipelineError {
    let error = merge(shards, out, None, &ReducedEngineSource).expect_err(expected);
    assert!(error.to_string().contains(expected), "{error}");
    assert!(!out.join("manifest.json").exists());
    error
}

#[test]
fn missing_doubled_foreign_unfinished_and_damaged_shards_are_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let place = |name: &str| folder.path().join(name);
    let small = study(20, |text| text);
    let shards: Vec<PathBuf> = (1..=4)
        .map(|number| solve(&place("r"), &small, number, 4))
        .collect();
    let out = place("out");
    refused(&shards[1..3], &out, "missing shards: 1/4, 4/4");
    let status = status_of_folder(&place("r")).expect("a status");
    assert!(status.missing_shards.is_empty());
    copy(&shards[0], &place("copy"));
    let doubled: Vec<PathBuf> = shards.iter().cloned().chain([place("copy")]).collect();
    refused(&doubled, &out, "shard 1/4 is there twice");
    let other = study(20, |text| text.replace("seed = 7", "seed = 8"));
    let foreign = [solve(&place("other"), &other, 1, 4), shards[1].clone()];
    let error = refused(&foreign, &out, "study.seed");
    assert!(matches!(error, PipelineError::DifferentShards { .. }));
    let longer = study(21, |text| text);
    let foreign = [solve(&place("longer"), &longer, 1, 4), shards[1].clone()];
    refused(
        &foreign,
        &out,
        "study.patterns: 20 in the first, 21 in the second",
    );
    let coarser = [solve(&place("r"), &small, 1, 2), shards[1].clone()];
    refused(&coarser, &out, "all must be cut into the same number");
    run_in(&place("whole"), &small, 1, &MockSource::default()).expect("run");
    refused(&[place("whole")], &out, "holds a whole study");
    refused(&[place("nothing")], &out, "holds no results");
    std::fs::remove_dir_all(place("r").join("shards/1-of-2")).expect("removed");
    let table = shards[2].join("responses.parquet");
    let mut content = std::fs::read(&table).expect("read");
    let middle = content.len() / 2;
    content[middle] ^= 4;
    std::fs::write(&table, content).expect("written");
    let error = refused(&shards, &out, "3-of-4/responses.parquet is damaged");
    assert!(matches!(error, PipelineError::Table(_)));
}

#[test]
fn shards_of_machines_that_calculate_differently_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let small = study(20, |text| text);
    let one = solve(&folder.path().join("a"), &small, 1, 2);
    let results = folder.path().join("b");
    let source = MockSource {
        model: "another last bit".to_owned(),
        ..MockSource::default()
    };
    let request = RunRequest {
        study: &small,
        results: &results,
        threads: 1,
    };
    let shard = Shard {
        number: 2,
        count: 2,
    };
    run_shard(request, shard, &source, &Silent).expect("a shard");
    let two = results.join("shards/2-of-2");
    refused(
        &[one, two],
        &folder.path().join("out"),
        "machines calculate differently",
    );
}

#[test]
fn a_shard_is_continued_and_belongs_to_one_cut() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let small = study(40, |text| text);
    let shard = solve(folder.path(), &small, 2, 4);
    solve(folder.path(), &small, 2, 4);
    let request = RunRequest {
        study: &study(80, |text| text),
        results: folder.path(),
        threads: 1,
    };
    let wanted = Shard {
        number: 2,
        count: 4,
    };
    let refused = run_shard(request, wanted, &MockSource::default(), &Silent);
    let error = refused.expect_err("other patterns");
    assert!(
        error.to_string().contains("80 (fixed in a shard)"),
        "{error}"
    );
    let refused = run_in(&shard, &small, 1, &MockSource::default()).expect_err("not a study");
    assert!(
        refused
            .to_string()
            .contains("--shard: 2/4 in the folder, all"),
        "{refused}"
    );
}

#[test]
#[cfg(unix)]
fn a_link_in_the_place_of_a_shard_is_not_followed() {
    use std::os::unix::fs::symlink;
    let small = study(20, |text| text);
    let shard = Shard {
        number: 1,
        count: 2,
    };
    for name in ["shards", "shards/1-of-2"] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (results, elsewhere) = (folder.path().join("r"), folder.path().join("elsewhere"));
        std::fs::create_dir_all(elsewhere.join("1-of-2")).expect("made");
        let link = results.join(name);
        std::fs::create_dir_all(link.parent().expect("a folder")).expect("made");
        symlink(&elsewhere, &link).expect("linked");
        let request = RunRequest {
            study: &small,
            results: &results,
            threads: 1,
        };
        let run = run_shard(request, shard, &MockSource::default(), &Silent).map(drop);
        let anew = set_other_builds_aside(&results, &small, Some(shard)).map(drop);
        for refused in [run, anew] {
            let words = refused.expect_err(name).to_string();
            assert!(words.contains("symbolic link"), "{name}: {words}");
        }
        assert!(files(&elsewhere).is_empty(), "{name}");
    }
}
