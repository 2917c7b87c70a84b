//! Tables that give node and direction of each matrix row: the mapping file of Ansys (`HBMAT` with
//! `Mapping = YES`), and CSV files `row,node,direction`.

use std::path::Path;

use super::Rows;
use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::Source;
use crate::model::sector::line_problem::{LinePart, LineProblem};

/// Rows counted from 1 in the first column, nodes in the second, directions in the third; lines
/// before the first such line are headings.
pub(super) fn rows(path: &Path) -> Result<Rows, ModelError> {
    let source = Source::read(path)?;
    let mut rows: Rows = Vec::new();
    for (number, line) in source.lines() {
        if line.trim().is_empty() {
            continue;
        }
        let words: Vec<&str> = line
            .split([',', ' ', '\t'])
            .map(str::trim)
            .filter(|word| !word.is_empty())
            .collect();
        let parsed = match words.as_slice() {
            [row, node, direction] => row
                .parse::<usize>()
                .ok()
                .zip(node.parse::<usize>().ok())
                .zip(direction_of(direction)),
            _ => None,
        };
        match parsed {
            Some(((row, node), direction)) if row == rows.len() + 1 => rows.push((node, direction)),
            Some(((found, _), _)) => {
                let problem = ImportProblem::Value {
                    key: "the matrix row".to_owned(),
                    found: found.to_string(),
                    accepted: format!("{} (rows count up from 1)", rows.len() + 1),
                };
                return Err(source.refuse(number, problem));
            }
            None if rows.is_empty() && !begins_with_number(line) => {}
            None => {
                let problem = ImportProblem::Line {
                    what: "row of a dof table",
                    found: line.to_owned(),
                    accepted: "row, node and direction: UX, UY, UZ, or 1, 2, 3 (directions count from 1)",
                };
                return Err(source.refuse(number, problem));
            }
        }
    }
    if rows.is_empty() {
        let what = LinePart::Columns("row, node, direction");
        return Err(source.refuse(1, LineProblem::Missing(what)));
    }
    Ok(rows)
}

fn begins_with_number(line: &str) -> bool {
    line.trim_start().starts_with(|c: char| c.is_ascii_digit())
}

fn direction_of(word: &str) -> Option<usize> {
    Some(match word.to_ascii_uppercase().as_str() {
        "UX" | "X" | "1" => 0,
        "UY" | "Y" | "2" => 1,
        "UZ" | "Z" | "3" => 2,
        _ => return None,
    })
}
