//! `model.toml` of a bundle.

use serde::{Deserialize, Serialize};

use crate::model::sector::line_problem::LineProblem;

/// Name of the header file.
pub(super) const FILE_NAME: &str = "model.toml";
/// Value of `format`.
const FORMAT: &str = "ring-damper-sector";
/// Value of `version`.
const VERSION: u32 = 1;
/// Value of `units`.
const UNITS: &str = "SI";

/// Content of `model.toml`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Header {
    format: String,
    version: u32,
    pub(super) name: String,
    pub(super) sectors: usize,
    units: String,
    pub(super) files: Files,
}

/// Names of the other files, relative to the bundle's directory.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Files {
    pub(super) stiffness: String,
    pub(super) mass: String,
    pub(super) blade_stiffness: String,
    pub(super) dofs: String,
    pub(super) cyclic: String,
    pub(super) contact: String,
    pub(super) force: String,
    pub(super) observe: String,
    /// Points of rigid bodies, of a model that has some.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) rigid: Option<String>,
}

impl Header {
    /// Header of a bundle with the usual file names, that of the points of rigid bodies only if it has some.
    pub(super) fn new(name: &str, sectors: usize, has_rigid: bool) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            name: name.to_owned(),
            sectors,
            units: UNITS.to_owned(),
            files: Files {
                stiffness: "K.mtx".to_owned(),
                mass: "M.mtx".to_owned(),
                blade_stiffness: "K_blade.mtx".to_owned(),
                dofs: "dofs.csv".to_owned(),
                cyclic: "cyclic.csv".to_owned(),
                contact: "contact.csv".to_owned(),
                force: "force.csv".to_owned(),
                observe: "observe.csv".to_owned(),
                rigid: has_rigid.then(|| "rigid.csv".to_owned()),
            },
        }
    }

    /// Parses the text and checks format, version and units; an error carries its line.
    pub(super) fn parse(text: &str) -> Result<Self, (usize, LineProblem)> {
        let header: Self = toml::from_str(text).map_err(|error| {
            let offset = error.span().map_or(0, |span| span.start.min(text.len()));
            let line = 1 + text
                .bytes()
                .take(offset)
                .filter(|&byte| byte == b'\n')
                .count();
            (
                line,
                LineProblem::Toml {
                    message: error.message().to_owned(),
                },
            )
        })?;
        for (key, found, accepted) in [
            ("format", header.format.clone(), FORMAT.to_owned()),
            ("version", header.version.to_string(), VERSION.to_string()),
            ("units", header.units.clone(), UNITS.to_owned()),
        ] {
            if found != accepted {
                return Err((
                    line_of(text, key),
                    LineProblem::Header {
                        key,
                        found,
                        accepted,
                    },
                ));
            }
        }
        Ok(header)
    }
}

/// Line on which `key` is set; 1 if it is written in a way this does not see.
fn line_of(text: &str, key: &str) -> usize {
    text.lines()
        .position(|line| {
            line.split('=')
                .next()
                .is_some_and(|word| word.trim() == key)
        })
        .map_or(1, |index| index + 1)
}
