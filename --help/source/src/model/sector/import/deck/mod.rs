//! Decks of `CalculiX` and Abaqus: keyword lines that begin with `*`, data lines between them.

mod cards;
mod read;

pub(super) use read::read;
