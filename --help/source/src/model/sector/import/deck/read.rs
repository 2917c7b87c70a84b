//! Nodes, solid elements, sets, surfaces, materials and the course of the run from a deck.

use std::collections::BTreeSet;
use std::path::Path;

use super::cards::{Card, Cards, Place};
use crate::model::sector::error::ModelError;
use crate::model::sector::import::mesh::{Element, ElementKind, Mesh, MeshMaterial};
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::real;
use crate::model::sector::line_problem::{LinePart, LineProblem};
use crate::model::sector::matrix_market::integer;

/// What stands in a set: resolved when the whole deck is read.
enum Member {
    Number(usize),
    Range(usize, usize, usize),
    Set(String),
}

/// Members of a set with the line that names them.
struct Membership {
    nodes: bool,
    set: String,
    members: Vec<(Place, Member)>,
}

/// A face, or the same face of every element of a set.
struct FaceLine {
    surface: String,
    place: Place,
    owner: Member,
    face: usize,
}

struct Reader<'a> {
    cards: &'a Cards,
    mesh: Mesh,
    memberships: Vec<Membership>,
    faces: Vec<FaceLine>,
    held: Vec<(Place, Member)>,
    /// Where each element ends.
    element_places: Vec<(usize, Place)>,
    material: Option<String>,
    /// Steps begun so far, and static ones among them.
    steps: usize,
    static_steps: usize,
}

/// Reads a deck with all that it includes.
pub(in crate::model::sector::import) fn read(path: &Path) -> Result<Mesh, ModelError> {
    let cards = Cards::read(path)?;
    let mut reader = Reader {
        cards: &cards,
        mesh: Mesh::default(),
        memberships: Vec::new(),
        faces: Vec::new(),
        held: Vec::new(),
        element_places: Vec::new(),
        material: None,
        steps: 0,
        static_steps: 0,
    };
    for card in &cards.cards {
        reader.card(card)?;
    }
    reader.resolve()
}

impl Reader<'_> {
    fn card(&mut self, card: &Card) -> Result<(), ModelError> {
        match card.keyword.as_str() {
            "*NODE" => self.nodes(card),
            "*ELEMENT" => self.elements(card),
            "*NSET" => self.set(card, true),
            "*ELSET" => self.set(card, false),
            "*SURFACE" => self.surface(card),
            // A condition of a step may be gone when the matrices are stored.
            "*BOUNDARY" if self.steps == 0 => {
                self.boundary(card);
                Ok(())
            }
            "*MATERIAL" => {
                self.material = card.name("NAME");
                Ok(())
            }
            "*ELASTIC" | "*DENSITY" => self.property(card),
            "*SOLID SECTION" => {
                if let (Some(set), Some(material)) = (card.name("ELSET"), card.name("MATERIAL")) {
                    self.mesh.sections.insert(set, material);
                }
                Ok(())
            }
            "*PART" | "*INSTANCE" | "*ASSEMBLY" => {
                let reason = "a flat deck is read; write one without parts and assemblies";
                self.refuse_keyword(card, reason)
            }
            "*CYCLIC SYMMETRY MODEL" => {
                let reason = "the matrices would be those of one nodal diameter; store them by a \
                              deck without it, its cut faces free";
                self.refuse_keyword(card, reason)
            }
            _ => self.step(card),
        }
    }

    fn refuse_keyword(&self, card: &Card, reason: &'static str) -> Result<(), ModelError> {
        let keyword = card.keyword.clone();
        Err(self
            .cards
            .refuse(card.place, ImportProblem::Keyword { keyword, reason }))
    }

    /// The course of the run: what was loaded before the matrices were stored.
    fn step(&mut self, card: &Card) -> Result<(), ModelError> {
        match card.keyword.as_str() {
            "*STEP" => self.steps += 1,
            "*STATIC" => self.static_steps += 1,
            "*FREQUENCY" => {
                let stores = card
                    .name("SOLVER")
                    .is_some_and(|name| name == "MATRIXSTORAGE");
                if stores && !self.mesh.run.stores_matrices {
                    self.mesh.run.stores_matrices = true;
                    self.mesh.run.prestressed = self.static_steps > 0;
                }
            }
            "*DLOAD" if !self.mesh.run.stores_matrices => {
                if card.name("OP").is_some_and(|operation| operation == "NEW") {
                    self.mesh.run.centrifugal = None;
                }
                for &place in &card.data {
                    let words = self.cards.words(place);
                    if let [_, label, value, ..] = words.as_slice()
                        && label.eq_ignore_ascii_case("CENTRIF")
                    {
                        let value = real("omega^2 of CENTRIF", value)
                            .map_err(|problem| self.cards.refuse(place, problem))?;
                        self.mesh.run.centrifugal = Some(value);
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn nodes(&mut self, card: &Card) -> Result<(), ModelError> {
        let mut numbers = Vec::new();
        for &place in &card.data {
            let refuse = |problem: LineProblem| self.cards.refuse(place, problem);
            let words = self.cards.words(place);
            if words.len() > 4 {
                return Err(refuse(LineProblem::FieldCount {
                    found: words.len(),
                    expected: 4,
                    what: LinePart::Columns("node, x, y, z"),
                }));
            }
            let number =
                integer("the node number", words.first().unwrap_or(&"")).map_err(refuse)?;
            let mut position = [0.0; 3];
            for (axis, word) in words.iter().skip(1).enumerate() {
                // A coordinate left out, as a Fortran reader sees it, is nought.
                if !word.is_empty() {
                    position[axis] = real(["x", "y", "z"][axis], word).map_err(refuse)?;
                }
            }
            if !self.mesh.add_node(number, position) {
                let what = "node";
                let problem = ImportProblem::Redefined { what, number };
                return Err(self.cards.refuse(place, problem));
            }
            numbers.push((place, Member::Number(number)));
        }
        self.join(card, "NSET", true, numbers);
        Ok(())
    }

    fn join(&mut self, card: &Card, parameter: &str, nodes: bool, members: Vec<(Place, Member)>) {
        if let Some(set) = card.name(parameter) {
            self.memberships.push(Membership {
                nodes,
                set,
                members,
            });
        }
    }

    fn elements(&mut self, card: &Card) -> Result<(), ModelError> {
        let Some(kind_name) = card.name("TYPE") else {
            let problem = ImportProblem::ParameterMissing {
                keyword: card.keyword.clone(),
                parameter: "TYPE",
            };
            return Err(self.cards.refuse(card.place, problem));
        };
        let Some(kind) = ElementKind::of_name(&kind_name) else {
            let problem = ImportProblem::ElementType {
                found: kind_name,
                accepted: ElementKind::ACCEPTED,
            };
            return Err(self.cards.refuse(card.place, problem));
        };
        let length = kind.node_count() + 1;
        let mut pending: Vec<usize> = Vec::with_capacity(length);
        let mut numbers = Vec::new();
        for &place in &card.data {
            for word in self.cards.words(place) {
                let value = integer("an element or node number", word)
                    .map_err(|problem| self.cards.refuse(place, problem))?;
                pending.push(value);
            }
            if pending.len() < length {
                continue;
            }
            let number = pending[0];
            if pending.len() > length {
                let problem = ImportProblem::ElementNodes {
                    element: number,
                    found: pending.len() - 1,
                    expected: length - 1,
                };
                return Err(self.cards.refuse(place, problem));
            }
            let element = Element {
                kind,
                nodes: pending.split_off(1),
            };
            pending.clear();
            if self.mesh.elements.insert(number, element).is_some() {
                let what = "element";
                let problem = ImportProblem::Redefined { what, number };
                return Err(self.cards.refuse(place, problem));
            }
            self.element_places.push((number, place));
            numbers.push((place, Member::Number(number)));
        }
        if let Some(&element) = pending.first() {
            let problem = ImportProblem::ElementNodes {
                element,
                found: pending.len() - 1,
                expected: length - 1,
            };
            let place = card.data.last().copied().unwrap_or(card.place);
            return Err(self.cards.refuse(place, problem));
        }
        self.join(card, "ELSET", false, numbers);
        Ok(())
    }

    fn set(&mut self, card: &Card, nodes: bool) -> Result<(), ModelError> {
        let parameter = if nodes { "NSET" } else { "ELSET" };
        if card.name(parameter).is_none() {
            let problem = ImportProblem::ParameterMissing {
                keyword: card.keyword.clone(),
                parameter,
            };
            return Err(self.cards.refuse(card.place, problem));
        }
        let mut members = Vec::new();
        for &place in &card.data {
            let words = self.cards.words(place);
            if card.has("GENERATE") {
                members.push((place, self.range(place, &words)?));
            } else {
                for word in words {
                    members.push((place, member(word)));
                }
            }
        }
        self.join(card, parameter, nodes, members);
        Ok(())
    }

    /// `first, last[, increment]`.
    fn range(&self, place: Place, words: &[&str]) -> Result<Member, ModelError> {
        let refuse = |problem: LineProblem| self.cards.refuse(place, problem);
        let (first, last, step) = match words {
            [first, last] => (*first, *last, "1"),
            [first, last, step] => (*first, *last, *step),
            _ => {
                return Err(refuse(LineProblem::FieldCount {
                    found: words.len(),
                    expected: 3,
                    what: LinePart::Columns("first, last, increment"),
                }));
            }
        };
        let step = integer("the increment", step).map_err(refuse)?;
        Ok(Member::Range(
            integer("the first number", first).map_err(refuse)?,
            integer("the last number", last).map_err(refuse)?,
            step.max(1),
        ))
    }

    fn surface(&mut self, card: &Card) -> Result<(), ModelError> {
        let Some(name) = card.name("NAME") else {
            let problem = ImportProblem::ParameterMissing {
                keyword: card.keyword.clone(),
                parameter: "NAME",
            };
            return Err(self.cards.refuse(card.place, problem));
        };
        if card.name("TYPE").is_some_and(|kind| kind == "NODE") {
            let mut members = Vec::new();
            for &place in &card.data {
                let words = self.cards.words(place);
                members.extend(words.first().map(|word| (place, member(word))));
            }
            self.memberships.push(Membership {
                nodes: true,
                set: name,
                members,
            });
            return Ok(());
        }
        for &place in &card.data {
            let words = self.cards.words(place);
            let face = match words.as_slice() {
                [_, face] => face
                    .strip_prefix(['S', 's'])
                    .and_then(|digit| digit.parse::<usize>().ok())
                    .filter(|face| (1..=6).contains(face)),
                _ => None,
            };
            let Some(face) = face else {
                let problem = ImportProblem::Line {
                    what: "face of a surface",
                    found: self.cards.text(place).to_owned(),
                    accepted: "element or element set, S1 to S6",
                };
                return Err(self.cards.refuse(place, problem));
            };
            self.faces.push(FaceLine {
                surface: name.clone(),
                place,
                owner: member(words[0]),
                face: face - 1,
            });
        }
        Ok(())
    }

    fn boundary(&mut self, card: &Card) {
        for &place in &card.data {
            let words = self.cards.words(place);
            self.held
                .extend(words.first().map(|word| (place, member(word))));
        }
    }

    fn property(&mut self, card: &Card) -> Result<(), ModelError> {
        let (Some(name), Some(&place)) = (self.material.clone(), card.data.first()) else {
            return Ok(());
        };
        let refuse = |problem: LineProblem| self.cards.refuse(place, problem);
        let words = self.cards.words(place);
        let number = |field: &'static str, at: usize| {
            real(field, words.get(at).copied().unwrap_or("")).map_err(refuse)
        };
        let mut material = self.mesh.materials.get(&name).copied().unwrap_or_default();
        if card.keyword == "*DENSITY" {
            material.density = Some(number("the density", 0)?);
        } else if card.name("TYPE").is_none_or(|kind| kind.starts_with("ISO")) {
            material.elastic = Some((number("Young's modulus", 0)?, number("Poisson's ratio", 1)?));
        } else {
            material = MeshMaterial {
                elastic: None,
                ..material
            };
        }
        self.mesh.materials.insert(name, material);
        Ok(())
    }

    /// Turns names and ranges to numbers, now that all are known, and checks that they exist.
    fn resolve(mut self) -> Result<Mesh, ModelError> {
        for membership in std::mem::take(&mut self.memberships) {
            let mut numbers = BTreeSet::new();
            for (place, member) in membership.members {
                numbers.extend(self.numbers(place, member, membership.nodes)?);
            }
            let sets = if membership.nodes {
                &mut self.mesh.node_sets
            } else {
                &mut self.mesh.element_sets
            };
            sets.entry(membership.set).or_default().extend(numbers);
        }
        for (place, member) in std::mem::take(&mut self.held) {
            let numbers = self.numbers(place, member, true)?;
            self.mesh.held.extend(numbers);
        }
        for line in std::mem::take(&mut self.faces) {
            for element in self.numbers(line.place, line.owner, false)? {
                let faces = self.mesh.elements[&element].kind.face_count();
                if line.face >= faces {
                    let problem = ImportProblem::Line {
                        what: "face of a surface",
                        found: self.cards.text(line.place).to_owned(),
                        accepted: "a face that the element has",
                    };
                    return Err(self.cards.refuse(line.place, problem));
                }
                let surface = self.mesh.surfaces.entry(line.surface.clone());
                surface.or_default().insert((element, line.face));
            }
        }
        for &(element, place) in &self.element_places {
            let nodes = &self.mesh.elements[&element].nodes;
            if let Some(&number) = nodes
                .iter()
                .find(|node| !self.mesh.nodes.contains_key(node))
            {
                let what = "node";
                let problem = ImportProblem::Undefined { what, number };
                return Err(self.cards.refuse(place, problem));
            }
        }
        Ok(self.mesh)
    }

    fn numbers(
        &self,
        place: Place,
        member: Member,
        nodes: bool,
    ) -> Result<BTreeSet<usize>, ModelError> {
        let what = if nodes { "node" } else { "element" };
        let exists = |number: &usize| {
            if nodes {
                self.mesh.nodes.contains_key(number)
            } else {
                self.mesh.elements.contains_key(number)
            }
        };
        match member {
            Member::Number(number) if exists(&number) => Ok(BTreeSet::from([number])),
            Member::Number(number) => Err(self
                .cards
                .refuse(place, ImportProblem::Undefined { what, number })),
            Member::Range(first, last, step) => {
                let chosen = |number: &usize| (number - first).is_multiple_of(step);
                Ok(if first > last {
                    BTreeSet::new()
                } else if nodes {
                    let range = self.mesh.nodes.range(first..=last);
                    range.map(|(&number, _)| number).filter(chosen).collect()
                } else {
                    let range = self.mesh.elements.range(first..=last);
                    range.map(|(&number, _)| number).filter(chosen).collect()
                })
            }
            Member::Set(name) => {
                let sets = if nodes {
                    &self.mesh.node_sets
                } else {
                    &self.mesh.element_sets
                };
                sets.get(&name).cloned().ok_or_else(|| {
                    let accepted = sets.keys().cloned().collect::<Vec<_>>().join(", ");
                    let key = format!("{what} set");
                    let problem = ImportProblem::SetUnknown {
                        key,
                        name,
                        accepted,
                    };
                    self.cards.refuse(place, problem)
                })
            }
        }
    }
}

fn member(word: &str) -> Member {
    word.parse()
        .map_or_else(|_| Member::Set(word.to_ascii_uppercase()), Member::Number)
}
