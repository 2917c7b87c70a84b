//! Matrix Market files.

use std::fs;
use std::path::Path;

use blisk::linalg::SymmetricSparse;
use blisk::model::sector::{LineProblem, ModelError, matrix_market};

use super::mutator::Mutator;
use super::{assert_clear, folder, run};
use crate::contact::random::Random;

const SYMMETRIC: &str = "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n4 4 6\n\
    1 1 2.5\n2 1 -1e-3\n2 2 3.25e2\n3 3 1\n4 3 -0.5\n4 4 7\n";
const GENERAL: &str = "%%MatrixMarket matrix coordinate integer general\n3 3 5\n\
    1 1 2\n1 2 -1\n2 1 -1\n2 2 3\n3 3 1\n";

fn read(folder: &Path, case: u64, bytes: &[u8]) -> Result<SymmetricSparse, ModelError> {
    let path = folder.join(format!("{case}.mtx"));
    fs::write(&path, bytes).unwrap();
    let read = matrix_market::read(&path);
    if let Ok(matrix) = &read {
        matrix_market::write(matrix, "read and written", &path).unwrap();
        assert_eq!(bits(&matrix_market::read(&path).unwrap()), bits(matrix));
    }
    fs::remove_file(&path).unwrap();
    read
}

/// Places and bits of every entry: an equal number of another sign is another one.
fn bits(matrix: &SymmetricSparse) -> (usize, Vec<(usize, usize, u64)>) {
    let entries = matrix.lower_entries();
    let bits = entries.map(|(row, column, value)| (row, column, value.to_bits()));
    (matrix.dimension(), bits.collect())
}

#[test]
fn a_spoiled_matrix_is_read_or_refused() {
    let folder = folder();
    let spoil = |case| {
        let mut mutator = Mutator::new(case);
        let file = *mutator.one_of(&[SYMMETRIC, GENERAL]);
        mutator.spoil(file.as_bytes())
    };
    let accepted = run(spoil, |case, bytes| {
        match read(folder.path(), case, bytes) {
            Ok(matrix) => {
                let mut entries = matrix.lower_entries();
                assert!(entries.all(|(row, column, value)| {
                    column <= row && row < matrix.dimension() && value.is_finite()
                }));
                true
            }
            Err(error) => {
                assert_clear(&error.to_string());
                if let ModelError::Line { line, .. } = error {
                    let lines = String::from_utf8_lossy(bytes).lines().count();
                    assert!((1..=lines.max(1)).contains(&line));
                }
                false
            }
        }
    });
    assert!(accepted > 0, "none of the changes is harmless");
}

#[test]
fn random_matrices_read_back_to_the_last_bit() {
    let folder = folder();
    let extremes = [
        0.0,
        -0.0,
        5e-324,
        -5e-324,
        f64::MIN_POSITIVE,
        f64::MAX,
        f64::MIN,
        1.0 / 3.0,
    ];
    for case in 0..200 {
        let mut random = Random(case);
        let n = random.integer(1, 30);
        let triplets: Vec<(usize, usize, f64)> = (0..random.integer(0, 60))
            .map(|_| {
                let row = random.integer(0, n - 1);
                let value = match random.integer(0, 2) {
                    0 => extremes[random.integer(0, extremes.len() - 1)],
                    _ => random.uniform(-1.0, 1.0) * random.magnitude(1e-300, 1e300),
                };
                (row, random.integer(0, row), value)
            })
            .collect();
        let mut once: Vec<(usize, usize, f64)> = Vec::new();
        for entry in triplets {
            if !once
                .iter()
                .any(|other| (other.0, other.1) == (entry.0, entry.1))
            {
                once.push(entry);
            }
        }
        let matrix = SymmetricSparse::from_lower_triplets(n, &once);
        let path = folder.path().join("matrix.mtx");
        matrix_market::write(&matrix, "random", &path).unwrap();
        assert_eq!(
            bits(&matrix_market::read(&path).unwrap()),
            bits(&matrix),
            "{case}"
        );
    }
}

/// What a file says of its size costs nothing: a size beyond reason is refused at its line, and a number
/// of entries that do not follow is one.
#[test]
fn a_huge_declared_size_is_refused_before_memory_is_reserved() {
    let folder = folder();
    for size in [
        "10000001",
        "1000000000000",
        "9223372036854775807",
        "18446744073709551615",
    ] {
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n{size} {size} 0\n");
        let error = read(folder.path(), 0, text.as_bytes()).unwrap_err();
        let expected = size.parse::<usize>().unwrap();
        assert!(
            matches!(error, ModelError::Line { line: 2, problem: LineProblem::TooLarge { dimension, .. }, .. } if dimension == expected),
            "{error}"
        );
        assert!(
            error.to_string().contains("accepted: at most 10000000"),
            "{error}"
        );
    }
    let text = "%%MatrixMarket matrix coordinate real symmetric\n2 2 18446744073709551615\n1 1 1\n";
    let error = read(folder.path(), 0, text.as_bytes()).unwrap_err();
    assert!(
        matches!(
            error,
            ModelError::Line {
                problem: LineProblem::Truncated { found: 1, .. },
                ..
            }
        ),
        "{error}"
    );
}
