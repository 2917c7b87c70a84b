//! Nodes, solid elements and components from a `.cdb` of Ansys (`CDWRITE`): `NBLOCK`, `EBLOCK`, `CMBLOCK`.

use std::collections::BTreeSet;
use std::path::Path;

use super::mesh::{Element, ElementKind, Mesh};
use super::problem::ImportProblem;
use super::source::{Source, real};
use crate::model::sector::error::ModelError;
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::matrix_market::integer;

/// Fields of an element's line before its nodes.
const ELEMENT_FIELDS: usize = 11;
/// Nodes on the first line of an element.
const NODES_ON_FIRST_LINE: usize = 8;

/// Largest width and repetition in a Fortran format: no line is longer than their product.
const MOST_IN_FORMAT: usize = 64;

struct Reader<'a> {
    source: &'a Source,
    lines: Vec<&'a str>,
    at: usize,
    mesh: Mesh,
}

/// Reads a `.cdb`. Other commands, and elements that are no tetrahedra, wedges or bricks, are passed over.
pub(super) fn read(path: &Path) -> Result<Mesh, ModelError> {
    let source = Source::read(path)?;
    let mut reader = Reader {
        source: &source,
        lines: source.text.lines().collect(),
        at: 0,
        mesh: Mesh::default(),
    };
    while reader.at < reader.lines.len() {
        let line = reader.lines[reader.at];
        reader.at += 1;
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        match words[0].to_ascii_uppercase().as_str() {
            "NBLOCK" => reader.nodes()?,
            "EBLOCK" => reader.elements(&words)?,
            "CMBLOCK" => reader.component(&words)?,
            _ => {}
        }
    }
    for element in reader.mesh.elements.values() {
        let known = |node: &&usize| !reader.mesh.nodes.contains_key(node);
        if let Some(&number) = element.nodes.iter().find(known) {
            let what = "node";
            return Err(source.refuse_whole(ImportProblem::Undefined { what, number }));
        }
    }
    Ok(reader.mesh)
}

impl<'a> Reader<'a> {
    fn next(&mut self, block: &str) -> Result<&'a str, ModelError> {
        let line = self.lines.get(self.at).copied();
        self.at += 1;
        line.ok_or_else(|| {
            let what = format!("{block} has no end");
            self.source.refuse_whole(ImportProblem::CutOff { what })
        })
    }

    fn refuse(&self, problem: LineProblem) -> ModelError {
        self.source.refuse(self.at, problem)
    }

    /// The Fortran format under a block command: width of its whole numbers, how many of them stand
    /// before the first real number, and the width of those.
    fn format(&mut self, block: &str) -> Result<(usize, usize, usize), ModelError> {
        let line = self.next(block)?;
        let upper = line.trim().to_ascii_uppercase();
        let inner = upper.trim_start_matches('(').trim_end_matches(')');
        let mut integers = (0, 0);
        let mut real_width = 0;
        for part in inner.split(',') {
            let Some(letter) = part.find(['I', 'E', 'F', 'D', 'G']) else {
                continue;
            };
            let count = part[..letter].trim().parse().unwrap_or(1);
            let width: String = part[letter + 1..]
                .chars()
                .take_while(char::is_ascii_digit)
                .collect();
            let width = width.parse().unwrap_or(0);
            if part.as_bytes()[letter] == b'I' {
                integers = (width, count);
            } else {
                real_width = width;
            }
        }
        if integers.0 == 0 || integers.0.max(integers.1).max(real_width) > MOST_IN_FORMAT {
            return Err(self.source.refuse(
                self.at,
                ImportProblem::MatrixKind {
                    what: "a Fortran format",
                    found: line.trim().to_owned(),
                    accepted: "one like (3i9,6e21.13e3) or (19i9)",
                },
            ));
        }
        Ok((integers.0, integers.1, real_width))
    }

    fn nodes(&mut self) -> Result<(), ModelError> {
        let (width, integers, real_width) = self.format("NBLOCK")?;
        loop {
            let line = self.next("NBLOCK")?;
            let field = |start: usize, width: usize| {
                line.get(start..)
                    .map_or("", |rest| rest.get(..width).unwrap_or(rest))
                    .trim()
            };
            if line.trim_start().starts_with(['N', 'n']) || line.trim() == "-1" {
                return Ok(());
            }
            let number = integer("the node number", field(0, width)).map_err(|p| self.refuse(p))?;
            let mut position = [0.0; 3];
            for (axis, value) in position.iter_mut().enumerate() {
                let word = field(integers * width + axis * real_width, real_width);
                // Coordinates of nought at the end of a line are left out.
                if !word.is_empty() {
                    *value = real(["x", "y", "z"][axis], word).map_err(|p| self.refuse(p))?;
                }
            }
            let angles: Vec<&str> = (3..6)
                .map(|axis| field(integers * width + axis * real_width, real_width))
                .filter(|word| !word.is_empty())
                .collect();
            for word in &angles {
                if real("an angle of the node", word).map_err(|p| self.refuse(p))? != 0.0 {
                    let angles = angles.join(" ");
                    let problem = ImportProblem::NodeRotated {
                        node: number,
                        angles,
                    };
                    return Err(self.source.refuse(self.at, problem));
                }
            }
            if !self.mesh.add_node(number, position) {
                let what = "node";
                let problem = ImportProblem::Redefined { what, number };
                return Err(self.source.refuse(self.at, problem));
            }
        }
    }

    /// The whole numbers of a line in fields of `width`.
    fn integers(&self, line: &str, width: usize) -> Result<Vec<i64>, ModelError> {
        let line = line.trim_end();
        let mut numbers = Vec::new();
        let mut start = 0;
        while let Some(rest) = line.get(start..).filter(|rest| !rest.is_empty()) {
            let word = rest.get(..width).unwrap_or(rest).trim();
            let number = word.parse().map_err(|_| {
                self.refuse(LineProblem::NotAnInteger {
                    field: "a number of the block",
                    found: word.to_owned(),
                })
            })?;
            numbers.push(number);
            start += width;
        }
        Ok(numbers)
    }

    fn elements(&mut self, words: &[&str]) -> Result<(), ModelError> {
        let (width, ..) = self.format("EBLOCK")?;
        let solid = words.iter().any(|word| word.eq_ignore_ascii_case("SOLID"));
        loop {
            let line = self.next("EBLOCK")?;
            if line.trim() == "-1" {
                return Ok(());
            }
            if !solid {
                continue;
            }
            let fields = self.integers(line, width)?;
            let count = fields.get(8).copied().unwrap_or(-1);
            let number = fields.get(10).copied().unwrap_or(-1);
            let (Ok(count @ 1..=20), Ok(number)) =
                (usize::try_from(count), usize::try_from(number))
            else {
                return Err(self.source.refuse(
                    self.at,
                    ImportProblem::Line {
                        what: "element of an EBLOCK",
                        found: line.trim().to_owned(),
                        accepted: "11 numbers, the ninth the number of nodes, the last that of the element, then nodes",
                    },
                ));
            };
            let mut nodes = fields[ELEMENT_FIELDS..].to_vec();
            if count > NODES_ON_FIRST_LINE {
                let line = self.next("EBLOCK")?;
                nodes.extend(self.integers(line, width)?);
            }
            if nodes.len() != count {
                let problem = ImportProblem::ElementNodes {
                    element: number,
                    found: nodes.len(),
                    expected: count,
                };
                return Err(self.source.refuse(self.at, problem));
            }
            let nodes: Vec<usize> = nodes.iter().map(|&node| node.max(0) as usize).collect();
            if let Some(element) = solid_of(&nodes)
                && self.mesh.elements.insert(number, element).is_some()
            {
                let what = "element";
                let problem = ImportProblem::Redefined { what, number };
                return Err(self.source.refuse(self.at, problem));
            }
        }
    }

    /// `CMBLOCK,NAME,NODE|ELEM,count`: a negative number ends a range that the number before begins.
    fn component(&mut self, words: &[&str]) -> Result<(), ModelError> {
        let kind = words.get(2).copied().unwrap_or("").to_ascii_uppercase();
        let count_word = words
            .get(3)
            .map_or("", |word| word.split('!').next().unwrap_or("").trim());
        let count = integer("the number of items", count_word).map_err(|p| self.refuse(p))?;
        let (width, ..) = self.format("CMBLOCK")?;
        let mut items: Vec<i64> = Vec::new();
        while items.len() < count {
            let line = self.next("CMBLOCK")?;
            let numbers = self.integers(line, width)?;
            if numbers.is_empty() {
                let what = format!("CMBLOCK has {} of {count} items", items.len());
                return Err(self.source.refuse(self.at, ImportProblem::CutOff { what }));
            }
            items.extend(numbers);
        }
        let nodes = kind == "NODE";
        let mut members = BTreeSet::new();
        let mut last = 0;
        for item in items {
            let number = item.unsigned_abs() as usize;
            let known: Vec<usize> = match (item < 0, nodes) {
                (true, _) if last > number => Vec::new(),
                (true, true) => self
                    .mesh
                    .nodes
                    .range(last..=number)
                    .map(|(&n, _)| n)
                    .collect(),
                (true, false) => self
                    .mesh
                    .elements
                    .range(last..=number)
                    .map(|(&n, _)| n)
                    .collect(),
                (false, true) => self
                    .mesh
                    .nodes
                    .contains_key(&number)
                    .then_some(number)
                    .into_iter()
                    .collect(),
                (false, false) => self
                    .mesh
                    .elements
                    .contains_key(&number)
                    .then_some(number)
                    .into_iter()
                    .collect(),
            };
            if nodes && item >= 0 && known.is_empty() {
                let what = "node";
                return Err(self
                    .source
                    .refuse(self.at, ImportProblem::Undefined { what, number }));
            }
            members.extend(known);
            last = number;
        }
        let name = words.get(1).copied().unwrap_or("").to_ascii_uppercase();
        if nodes {
            self.mesh.node_sets.insert(name, members);
        } else if kind.starts_with("ELEM") {
            self.mesh.element_sets.insert(name, members);
        }
        Ok(())
    }
}

/// The solid that a list of nodes stands for; wedges and tetrahedra may be bricks with repeated nodes
/// (SOLID185, SOLID186). None for pyramids and whatever else.
fn solid_of(nodes: &[usize]) -> Option<Element> {
    let pick = |kind: ElementKind, order: &[usize]| {
        let nodes: Vec<usize> = order.iter().map(|&at| nodes[at]).collect();
        (!nodes.contains(&0)).then_some(Element { kind, nodes })
    };
    let corners = nodes.get(..8);
    let wedge = corners.is_some_and(|n| n[2] == n[3] && n[6] == n[7] && n[4] != n[5]);
    let tetrahedron =
        corners.is_some_and(|n| n[2] == n[3] && n[4] == n[5] && n[5] == n[6] && n[6] == n[7]);
    let pyramid = corners.is_some_and(|n| n[2] != n[3] && n[4] == n[5]);
    match nodes.len() {
        _ if pyramid => None,
        4 => pick(ElementKind::Tetrahedron4, &[0, 1, 2, 3]),
        10 => pick(ElementKind::Tetrahedron10, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
        8 if tetrahedron => pick(ElementKind::Tetrahedron4, &[0, 1, 2, 4]),
        8 if wedge => pick(ElementKind::Wedge6, &[0, 1, 2, 4, 5, 6]),
        8 => pick(ElementKind::Brick8, &[0, 1, 2, 3, 4, 5, 6, 7]),
        20 if tetrahedron => pick(
            ElementKind::Tetrahedron10,
            &[0, 1, 2, 4, 8, 9, 11, 16, 17, 18],
        ),
        20 if wedge => pick(
            ElementKind::Wedge15,
            &[0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18],
        ),
        20 => pick(
            ElementKind::Brick20,
            &[
                0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19,
            ],
        ),
        _ => None,
    }
}
