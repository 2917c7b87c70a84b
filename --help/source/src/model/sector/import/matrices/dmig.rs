//! Matrices as Nastran's DMIG bulk data entries, in a punch or bulk data file: small, large or free fields.

use std::collections::BTreeMap;
use std::path::Path;

use crate::model::sector::error::ModelError;
use crate::model::sector::import::bulk;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::{Source, real};
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::matrix_market::integer;

/// Grid point and direction (0, 1, 2) of a row.
type Point = (usize, usize);

/// Entries of one matrix by the points of row and column.
#[derive(Debug, Default)]
pub(super) struct PointMatrix {
    pub entries: BTreeMap<(Point, Point), f64>,
    /// Whether one triangle stands for both.
    pub symmetric: bool,
}

/// Reads the matrix `name`.
pub(super) fn matrix(path: &Path, name: &str) -> Result<PointMatrix, ModelError> {
    let source = Source::read(path)?;
    source.require_last_line_end()?;
    let mut matrix: Option<PointMatrix> = None;
    let mut names: Vec<String> = Vec::new();
    for entry in bulk::entries(&source) {
        if entry.name != "DMIG" {
            continue;
        }
        let field = |index: usize| entry.field(index);
        let line = entry.line;
        let is_header = field(1) == "0";
        if is_header {
            names.push(field(0).to_ascii_uppercase());
        }
        if !field(0).eq_ignore_ascii_case(name) {
            continue;
        }
        if is_header {
            let symmetric =
                header(field(2), field(3)).map_err(|problem| source.refuse(line, problem))?;
            matrix = Some(PointMatrix {
                symmetric,
                ..PointMatrix::default()
            });
            continue;
        }
        let Some(matrix) = &mut matrix else {
            let problem = ImportProblem::Line {
                what: "column of a DMIG matrix",
                found: format!("DMIG {} {}", field(0), field(1)),
                accepted: "columns after the header DMIG NAME 0 ...",
            };
            return Err(source.refuse(line, problem));
        };
        let refuse = |problem: ImportProblem| source.refuse(line, problem);
        let column = point(&source, line, field(1), field(2))?;
        for group in entry.fields_from(4).chunks(4) {
            let word = |index: usize| group.get(index).map_or("", |&(_, word)| word);
            let line = group.first().map_or(line, |&(line, _)| line);
            if word(0).is_empty() && word(2).is_empty() {
                continue;
            }
            let row = point(&source, line, word(0), word(1))?;
            let value = real("a value", word(2)).map_err(|problem| source.refuse(line, problem))?;
            let key = if matrix.symmetric {
                (row.max(column), row.min(column))
            } else {
                (row, column)
            };
            if matrix.entries.insert(key, value).is_some() {
                return Err(refuse(ImportProblem::Line {
                    what: "entry of its own",
                    found: format!(
                        "{} {} in column {} {}",
                        row.0,
                        row.1 + 1,
                        column.0,
                        column.1 + 1
                    ),
                    accepted: "each entry once, one triangle of a symmetric matrix",
                }));
            }
        }
    }
    matrix.ok_or_else(|| {
        source.refuse_whole(ImportProblem::MatrixUnknown {
            name: name.to_owned(),
            accepted: names.join(", "),
        })
    })
}

/// Whether the matrix is symmetric, from form and type.
fn header(form: &str, kind: &str) -> Result<bool, ImportProblem> {
    let symmetric = match form {
        "6" => true,
        "1" => false,
        _ => {
            return Err(ImportProblem::MatrixKind {
                what: "the form of the DMIG matrix",
                found: form.to_owned(),
                accepted: "6 (symmetric) or 1 (square)",
            });
        }
    };
    if matches!(kind, "1" | "2") {
        Ok(symmetric)
    } else {
        Err(ImportProblem::MatrixKind {
            what: "the type of the DMIG matrix",
            found: kind.to_owned(),
            accepted: "1 or 2 (real)",
        })
    }
}

fn point(source: &Source, line: usize, grid: &str, component: &str) -> Result<Point, ModelError> {
    let grid = integer("a grid point", grid).map_err(|problem| source.refuse(line, problem))?;
    match component {
        "1" => Ok((grid, 0)),
        "2" => Ok((grid, 1)),
        "3" => Ok((grid, 2)),
        _ => Err(source.refuse(
            line,
            LineProblem::NotAWord {
                field: "the component",
                found: component.to_owned(),
                accepted: "1, 2 or 3: displacements of solid elements",
            },
        )),
    }
}
