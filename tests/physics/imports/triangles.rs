//! Matrices of which one triangle was lost: refused by every reader that can meet one, with the likely cause.

use std::fs;

use blisk::model::sector::ModelError;
use blisk::model::sector::import::import;
use blisk::model::sector::matrix_market;

use super::calculix::folder as calculix_wheel;
use super::small::Small;

/// What an import of the small sector says after a change of one of its files; nothing where it is accepted.
fn said(small: &Small, file: &str, change: impl Fn(&str) -> String) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    small.write(folder.path());
    let changed = change(small.text(file));
    assert_ne!(changed, small.text(file), "{file} is unchanged");
    fs::write(folder.path().join(file), changed).unwrap();
    let imported = import(&folder.path().join("import.toml"));
    imported.err().map(|error| error.to_string())
}

/// Lines `row column value` that `kept` chooses.
fn entries(text: &str, kept: impl Fn(usize, usize) -> bool) -> String {
    let chosen = text.lines().filter(|line| {
        let mut words = line.split_whitespace().map(str::parse::<usize>);
        let [row, column] = [(); 2].map(|()| words.next().unwrap().unwrap());
        kept(row, column)
    });
    chosen.flat_map(|line| [line, "\n"]).collect()
}

#[test]
fn a_stiffness_without_couplings_is_refused_for_the_whole_and_for_the_blade() {
    let diagonal = |text: &str| entries(text, |row, column| row == column);
    for (file, matrix) in [("job.sti", "K"), ("blade.sti", "K_blade")] {
        let message = said(&Small::calculix(), file, diagonal).unwrap();
        for word in [
            format!("{file}: {matrix} has no entry off the diagonal that couples two nodes"),
            "was only one triangle written".to_owned(),
        ] {
            assert!(message.contains(&word), "{message}");
        }
    }
}

/// Both at once: then neither has an entry where the other lacks it.
#[test]
fn both_matrices_without_couplings_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let small = Small::calculix();
    small.write(folder.path());
    for file in ["job.sti", "blade.sti"] {
        let diagonal = entries(small.text(file), |row, column| row == column);
        fs::write(folder.path().join(file), diagonal).unwrap();
    }
    let message = import(&folder.path().join("import.toml"))
        .unwrap_err()
        .to_string();
    let words = "K has no entry off the diagonal that couples two nodes";
    assert!(message.contains(words), "{message}");
}

#[test]
fn a_lumped_mass_is_accepted_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let small = Small::calculix();
    small.write(folder.path());
    let path = folder.path().join("import.toml");
    let consistent = import(&path).unwrap().report;
    let lumped = entries(small.text("job.mas"), |row, column| row == column);
    fs::write(folder.path().join("job.mas"), lumped).unwrap();
    let report = import(&path).unwrap().report;
    for (report, lumped) in [(consistent, false), (report, true)] {
        for body in &report.bodies {
            assert_eq!(body.mass_is_lumped, lumped);
        }
        assert_eq!(report.to_string().contains("it is lumped"), lumped);
    }
}

/// Sorting rows between two programs that take one triangle each leaves those couplings whose nodes kept their order.
#[test]
fn a_matrix_that_lost_some_of_its_couplings_is_refused() {
    // Rows 1 to 3 are node 1, and so on: couplings with an odd sum of both numbers are lost.
    let half = |text: &str| {
        entries(text, |row, column| {
            (row.div_ceil(3) + column.div_ceil(3)) % 2 == 0
        })
    };
    for (file, matrix) in [("job.sti", "K"), ("job.mas", "M")] {
        let message = said(&Small::calculix(), file, half).unwrap();
        for word in [
            format!("{file}: {matrix} does not couple nodes 1 and 2 of element 1: 12 of 28 pairs"),
            "only one triangle left".to_owned(),
        ] {
            assert!(message.contains(&word), "{message}");
        }
    }
    // One coupling of 28 may vanish.
    let one = |text: &str| {
        entries(text, |row, column| {
            (row.div_ceil(3), column.div_ceil(3)) != (1, 8)
        })
    };
    assert_eq!(said(&Small::calculix(), "job.mas", one), None);
}

/// The table of a real wheel in the order of another run: its matrices are whole, and couple the wrong nodes.
#[test]
fn a_table_of_rows_in_another_order_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(calculix_wheel()).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
    }
    let table = folder.path().join("blisk_rest.dof");
    let mut rows: Vec<String> = fs::read_to_string(&table)
        .unwrap()
        .lines()
        .map(str::to_owned)
        .collect();
    // As text, node 10 stands before node 9.
    rows.sort();
    fs::write(&table, rows.join("\n") + "\n").unwrap();
    let error = import(&folder.path().join("wheel_rest.toml")).unwrap_err();
    let message = error.to_string();
    for word in [
        "blisk_rest.sti: K does not couple nodes",
        "another order than the table's",
    ] {
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn one_triangle_is_refused_where_the_file_does_not_say_symmetric() {
    // Files of one triangle, and the word that says so replaced by the one for both.
    for (small, file, symmetric, whole) in [
        (Small::nastran(), "punch", "DMIG,MAAX,0,6", "DMIG,MAAX,0,1"),
        (Small::ansys(), "K", "RSA", "RUA"),
    ] {
        let message = said(&small, file, |text| text.replace(symmetric, whole)).unwrap();
        assert!(
            message.contains("168 entries stand below the diagonal and none on the other side")
                && message.contains("is only one triangle written"),
            "{message}"
        );
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("A.mtx");
    for (banner, refused) in [("general", true), ("symmetric", false)] {
        let head = format!("%%MatrixMarket matrix coordinate real {banner}\n3 3 5\n");
        let text = "1 1 4\n2 1 -1\n2 2 4\n3 2 -1\n3 3 4\n";
        fs::write(&path, head + text).unwrap();
        match matrix_market::read(&path) {
            Ok(_) => assert!(!refused),
            Err(error) => {
                assert!(
                    refused && matches!(error, ModelError::Line { .. }),
                    "{error}"
                );
                let message = error.to_string();
                let words = "2 entries stand below the diagonal and none on the other side";
                assert!(message.contains(words), "{message}");
            }
        }
    }
}
