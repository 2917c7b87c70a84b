//! The sides of a contact as an import file spells them: `BODY.SET`, `next.BODY.SET` and `ground`.

use std::fmt;

use super::problem::body_name;
use crate::input::{Problem, nearest};
use crate::model::sector::sector_model::Body;

/// What does not move, and what stands before a surface of the next sector: as in lumped sectors of a study.
const GROUND: &str = "ground";
const NEXT: &str = "next.";
const BODIES: [Body; 3] = [Body::Blisk, Body::Ring, Body::Damper];

/// A surface of a body, of the sector or of the next one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Surface {
    pub body: Body,
    pub is_next: bool,
    /// Node set, element set or surface of the mesh that holds the body.
    pub set: String,
}

/// One of the two sides of a contact.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Side {
    Surface(Surface),
    Ground,
}

impl Surface {
    /// A surface of the sector itself.
    pub fn own(body: Body, set: &str) -> Self {
        Self {
            body,
            is_next: false,
            set: set.to_owned(),
        }
    }

    /// What stands before the name of the set.
    pub fn prefix(&self) -> String {
        let next = if self.is_next { NEXT } else { "" };
        format!("{next}{}.", body_name(self.body))
    }

    /// The body in messages.
    pub fn owner(&self) -> String {
        let next = if self.is_next { "next sector's " } else { "" };
        format!("{next}{}", body_name(self.body))
    }

    /// Whether it is the same surface: names of sets are compared without case.
    pub fn is(&self, other: &Self) -> bool {
        let set = self.set.eq_ignore_ascii_case(&other.set);
        set && self.body == other.body && self.is_next == other.is_next
    }
}

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.prefix(), self.set)
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Surface(surface) => write!(f, "{surface}"),
            Self::Ground => f.write_str(GROUND),
        }
    }
}

impl Side {
    /// Reads a side.
    pub fn of(text: &str) -> Result<Self, Problem> {
        if text == GROUND {
            return Ok(Self::Ground);
        }
        let (is_next, rest) = match text.strip_prefix(NEXT) {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let (word, set) = rest.split_once('.').unwrap_or((rest, ""));
        let body = BODIES.into_iter().find(|&body| body_name(body) == word);
        match body {
            Some(body) if !set.is_empty() => Ok(Self::Surface(Surface {
                is_next,
                ..Surface::own(body, set)
            })),
            _ => Err(Problem::NotAccepted {
                value: format!("{text:?}"),
                accepted: "BODY.SET or next.BODY.SET, BODY being blisk, ring or damper and SET a set of its mesh; as second also ground"
                    .to_owned(),
                suggestion: meant(is_next, word, set),
            }),
        }
    }
}

/// What a side that is none may be meant for.
fn meant(is_next: bool, word: &str, set: &str) -> Option<String> {
    if set.is_empty() {
        let ground = nearest(word, &[GROUND.to_owned()]).filter(|_| !is_next);
        return ground.map(|word| format!("\"{word}\""));
    }
    let names = BODIES.map(|body| body_name(body).to_owned());
    let next = if is_next { NEXT } else { "" };
    nearest(word, &names).map(|body| format!("\"{next}{body}.{set}\""))
}

#[cfg(test)]
mod tests {
    use super::{Side, Surface};
    use crate::input::Problem;
    use crate::model::sector::sector_model::Body;

    #[test]
    fn sides_are_read_as_they_are_written() {
        for (text, body, is_next, set) in [
            ("blisk.EDGE", Body::Blisk, false, "EDGE"),
            ("next.blisk.EDGE", Body::Blisk, true, "EDGE"),
            ("damper.next.A", Body::Damper, false, "next.A"),
            ("ring.7", Body::Ring, false, "7"),
            ("next.damper.ground", Body::Damper, true, "ground"),
        ] {
            let surface = Surface {
                is_next,
                ..Surface::own(body, set)
            };
            assert_eq!(surface.to_string(), text);
            assert_eq!(Side::of(text), Ok(Side::Surface(surface)), "{text}");
        }
        assert_eq!(Side::of("ground"), Ok(Side::Ground));
        for (text, meant) in [
            ("EDGE", None),
            ("grond", Some("\"ground\"")),
            ("blisk.", None),
            ("next.EDGE", None),
            ("next.ground", None),
            ("bilsk.EDGE", Some("\"blisk.EDGE\"")),
            ("next.dampr.EDGE", Some("\"next.damper.EDGE\"")),
        ] {
            let Err(Problem::NotAccepted { suggestion, .. }) = Side::of(text) else {
                panic!("{text}");
            };
            assert_eq!(suggestion.as_deref(), meant, "{text}");
        }
    }
}
