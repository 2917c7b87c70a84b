//! Files of a bundle that are refused, each with its file, line and value.

use std::fs;
use std::path::Path;

use blisk::model::sector::{LineProblem, LumpedOptions, ModelError, bundle, lumped, matrix_market};

/// A small bundle to spoil: 4 dofs (blade, disk and the high face of both) on 3 sectors.
fn write_small_bundle(directory: &Path) {
    let model = lumped::build(&LumpedOptions {
        sectors: 3,
        blade_mass_kg: 1.0,
        disk_mass_kg: 2.0,
        blade_stiffness_n_per_m: 100.0,
        blade_coupling_stiffness_n_per_m: 10.0,
        disk_ground_stiffness_n_per_m: 50.0,
        disk_coupling_stiffness_n_per_m: 20.0,
        ..LumpedOptions::default()
    });
    bundle::write(&model.unwrap(), directory).unwrap();
}

/// Replaces `from` by `to` in a file of the bundle, reads it, and returns the refusal.
fn spoiled(file: &str, from: &str, to: &str) -> ModelError {
    let directory = tempfile::tempdir().unwrap();
    write_small_bundle(directory.path());
    let path = directory.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{file} has no {from:?}:\n{text}");
    fs::write(&path, text.replacen(from, to, 1)).unwrap();
    bundle::read(directory.path()).unwrap_err()
}

#[test]
fn spoiled_lines_are_refused_with_file_line_and_value() {
    type Kind = fn(&LineProblem) -> bool;
    let cases: [(&str, &str, &str, usize, &str, Kind); 17] = [
        ("model.toml", "sectors = 3", "sectors = -3", 4, "-3", |p| {
            matches!(p, LineProblem::Toml { .. })
        }),
        (
            "model.toml",
            "sectors = 3",
            "sector = 3",
            4,
            "sector",
            |p| matches!(p, LineProblem::Toml { .. }),
        ),
        ("model.toml", "version = 1", "version = 2", 2, "2", |p| {
            matches!(p, LineProblem::Header { .. })
        }),
        ("model.toml", "\"SI\"", "\"mm\"", 5, "mm", |p| {
            matches!(p, LineProblem::Header { .. })
        }),
        (
            "K.mtx",
            "real symmetric",
            "complex hermitian",
            1,
            "complex hermitian",
            |p| matches!(p, LineProblem::Banner { .. }),
        ),
        ("K.mtx", "4 4 ", "4 5 ", 3, "4 x 5", |p| {
            matches!(p, LineProblem::NotSquare { .. })
        }),
        ("K.mtx", "1 1 1.1e2", "1 1 1.1e2x", 4, "1.1e2x", |p| {
            matches!(p, LineProblem::NotANumber { .. })
        }),
        ("K.mtx", "1 1 1.1e2", "1 1 NaN", 4, "NaN", |p| {
            matches!(p, LineProblem::NotANumber { .. })
        }),
        ("K.mtx", "1 1 1.1e2", "1 -1 1.1e2", 4, "-1", |p| {
            matches!(p, LineProblem::NotAnInteger { .. })
        }),
        ("K.mtx", "1 1 1.1e2", "5 1 1.1e2", 4, "(5, 1)", |p| {
            matches!(p, LineProblem::EntryOutside { .. })
        }),
        ("K.mtx", "2 1 -1e2", "1 2 -1e2", 5, "(1, 2)", |p| {
            matches!(p, LineProblem::AboveDiagonal { .. })
        }),
        ("K.mtx", "2 1 -1e2", "1 1 -1e2", 5, "line 4", |p| {
            matches!(p, LineProblem::Repeated { .. })
        }),
        ("dofs.csv", "0,0,t", "0,0,x", 2, "\"x\"", |p| {
            matches!(p, LineProblem::NotAWord { .. })
        }),
        ("dofs.csv", "1,1,t", "2,1,t", 3, "is 2", |p| {
            matches!(p, LineProblem::OutOfOrder { .. })
        }),
        (
            "cyclic.csv",
            "low_dof,high_dof",
            "low,high",
            1,
            "low,high",
            |p| matches!(p, LineProblem::NotAWord { .. }),
        ),
        ("force.csv", "0,1e0,0e0", "0,1e0", 2, "2 values", |p| {
            matches!(p, LineProblem::FieldCount { .. })
        }),
        ("observe.csv", "blade,0", "blade,zero", 2, "zero", |p| {
            matches!(p, LineProblem::NotAnInteger { .. })
        }),
    ];
    for (file, from, to, line, value, kind) in cases {
        let error = spoiled(file, from, to);
        let message = error.to_string();
        let ModelError::Line { problem, .. } = &error else {
            panic!("{file} with {to:?}: {message}");
        };
        assert!(kind(problem), "{file} with {to:?}: {message}");
        assert!(
            message.contains(&format!("{file}:{line}: ")),
            "{file} with {to:?}: {message}"
        );
        assert!(message.contains(value), "{file} with {to:?}: {message}");
    }
}

/// A Matrix Market file of this text, read.
fn matrix(text: &str) -> Result<blisk::linalg::SymmetricSparse, ModelError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("A.mtx");
    fs::write(&path, text).unwrap();
    matrix_market::read(&path)
}

#[test]
fn general_matrices_are_taken_if_exactly_symmetric() {
    let matrix = matrix(
        "%%MatrixMarket matrix coordinate integer general\n% comment\n\n2 2 4\n1 1 3\n1 2 -1\n2 1 -1\n2 2 4\n",
    );
    assert_eq!(
        matrix.unwrap().lower_entries().collect::<Vec<_>>(),
        [(0, 0, 3.0), (1, 0, -1.0), (1, 1, 4.0)]
    );
}

#[test]
fn asymmetry_is_named_with_both_values() {
    for (entries, line, mirror) in [
        (
            "1 2 -1.0\n2 1 -1.0000000000000002\n2 2 4",
            4,
            "-1.0000000000000002e0",
        ),
        ("1 2 -1.0\n1 1 2.0\n2 2 4", 4, "(2, 1) is 0e0"),
    ] {
        let head = "%%MatrixMarket matrix coordinate real general\n% c\n2 2 3\n";
        let error = matrix(&format!("{head}{entries}\n")).unwrap_err();
        let message = error.to_string();
        assert!(
            matches!(
                error,
                ModelError::Line {
                    problem: LineProblem::NotSymmetric { .. },
                    ..
                }
            ),
            "{message}"
        );
        assert!(message.contains(&format!("A.mtx:{line}: ")), "{message}");
        assert!(
            message.contains("(1, 2) is -1e0") && message.contains(mirror),
            "{message}"
        );
    }
}

#[test]
fn files_that_end_early_or_late_are_refused() {
    type Kind = fn(&LineProblem) -> bool;
    let head = "%%MatrixMarket matrix coordinate real symmetric\n";
    let cases: [(String, &str, Kind); 4] = [
        (String::new(), "banner", |p| {
            matches!(p, LineProblem::Missing(_))
        }),
        (head.to_owned(), "rows columns entries", |p| {
            matches!(p, LineProblem::Missing(_))
        }),
        (format!("{head}1 1 2\n1 1 3\n"), "1 of 2", |p| {
            matches!(p, LineProblem::Truncated { .. })
        }),
        (
            format!("{head}1 1 1\n1 1 3\n1 1 4\n"),
            "the 1 entries",
            |p| matches!(p, LineProblem::Surplus { .. }),
        ),
    ];
    for (text, part, kind) in cases {
        let error = matrix(&text).unwrap_err();
        let message = error.to_string();
        assert!(message.contains(part), "{message}");
        assert!(
            matches!(&error, ModelError::Line { problem, .. } if kind(problem)),
            "{message}"
        );
    }
}

#[test]
fn a_missing_file_of_a_bundle_is_named() {
    let directory = tempfile::tempdir().unwrap();
    write_small_bundle(directory.path());
    fs::remove_file(directory.path().join("contact.csv")).unwrap();
    let error = bundle::read(directory.path()).unwrap_err();
    assert!(error.to_string().contains("contact.csv"), "{error}");
}

/// With the columns of a ring, the first node is on the blisk and the second on the ring.
#[test]
fn the_columns_of_a_ring_say_which_node_is_on_which_body() {
    let directory = tempfile::tempdir().unwrap();
    write_small_bundle(directory.path());
    let text = "pair,blisk_node,ring_node,nr,nt,nz,weight\n0,0,1,-1,0,0,1\n";
    fs::write(directory.path().join("contact.csv"), text).unwrap();
    let error = bundle::read(directory.path()).unwrap_err().to_string();
    let expected = "contact pair 0: node 1 is on the wrong body";
    assert!(error.contains(expected), "{error}");
}

/// With the columns of any two sides, a side is a node of sector 0 or 1, and the second one may be the ground.
#[test]
fn sides_of_other_contacts_are_refused_with_line_and_value() {
    let header = "pair,first_node,first_sector,second_node,second_sector,nr,nt,nz,weight";
    for (pair, accepted) in [
        (
            "0,1,2,2,0,-1,0,0,1",
            "first_sector is \"2\"; accepted: 0 or 1",
        ),
        ("0,1,0,earth,0,-1,0,0,1", "second_node is \"earth\""),
        ("0,ground,0,2,0,-1,0,0,1", "first_node is \"ground\""),
        ("0,1,0,1,0,-1,0,0,1", "it joins node 1 and node 1"),
    ] {
        let directory = tempfile::tempdir().unwrap();
        write_small_bundle(directory.path());
        let text = format!("{header}\n{pair}\n");
        fs::write(directory.path().join("contact.csv"), text).unwrap();
        let error = bundle::read(directory.path()).unwrap_err().to_string();
        assert!(error.contains(accepted), "{error}");
    }
}

/// A header line that is neither is told the columns that are nearer to it.
#[test]
fn a_wrong_header_of_contacts_is_told_the_columns_it_is_nearest_to() {
    let ring = "pair,blisk_node,ring_node,nr,nt,nz,weight";
    let any = "pair,first_node,first_sector,second_node,second_sector,nr,nt,nz,weight";
    for (header, accepted) in [
        ("pair,blade_node,ring_node,nr,nt,nz,weight", ring),
        (
            "pair,first_node,sector,second_node,sector,nr,nt,nz,weight",
            any,
        ),
        ("", ring),
    ] {
        let directory = tempfile::tempdir().unwrap();
        write_small_bundle(directory.path());
        let text = format!("{header}\n0,0,1,-1,0,0,1\n");
        fs::write(directory.path().join("contact.csv"), text).unwrap();
        let error = bundle::read(directory.path()).unwrap_err().to_string();
        assert!(error.contains(accepted), "{error}");
        assert!(accepted == any || !error.contains(any), "{error}");
    }
}
