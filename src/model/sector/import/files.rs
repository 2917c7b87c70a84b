//! The files that an import file names, by body: its own keys, or those that a job stands for.

use std::path::{Path, PathBuf};

use super::matrices::{MatrixFiles, MatrixFormat};
use super::problem::body_name;
use super::tables::{BliskTable, BodyTable};
use crate::input::Problem;
use crate::model::sector::sector_model::Body;

/// Files of one run: its mesh and its matrices.
#[derive(Debug, Clone)]
pub(super) struct RunFiles {
    pub mesh: PathBuf,
    pub matrices: MatrixFiles,
}

/// Keys of the files of one run as written.
struct Keys<'a> {
    /// What stands before the names of the keys: `blisk.`, `ring.`, `damper.` or `blisk.blade_`.
    prefix: &'static str,
    job: Option<&'a PathBuf>,
    stiffness: Option<&'a PathBuf>,
    mass: Option<&'a PathBuf>,
    /// Whether the mass matrix is needed; that of the blade alone is not.
    has_mass: bool,
    dofs: Option<&'a PathBuf>,
    stiffness_name: Option<&'a String>,
    mass_name: Option<&'a String>,
}

/// Which file a key is for.
struct Reader<'a> {
    import_file: &'a Path,
    format: MatrixFormat,
    problems: &'a mut Vec<(String, Problem)>,
}

/// A body beside the blisk.
#[derive(Debug)]
pub(super) struct OtherBody {
    /// Ring or damper.
    pub body: Body,
    pub table: BodyTable,
    /// None where it stands in the blisk's files.
    pub files: Option<RunFiles>,
}

/// Files of the blisk, of the blade alone and of the other bodies; what is missing goes to `problems`.
pub(super) fn files(
    import_file: &Path,
    format: MatrixFormat,
    blisk: &BliskTable,
    others: [(Body, Option<BodyTable>); 2],
    problems: &mut Vec<(String, Problem)>,
) -> (RunFiles, Option<MatrixFiles>, Vec<OtherBody>) {
    let mut reader = Reader {
        import_file,
        format,
        problems,
    };
    let keys = Keys {
        prefix: "blisk.",
        job: blisk.job.as_ref(),
        stiffness: blisk.stiffness.as_ref(),
        mass: blisk.mass.as_ref(),
        has_mass: true,
        dofs: blisk.dofs.as_ref(),
        stiffness_name: blisk.stiffness_name.as_ref(),
        mass_name: blisk.mass_name.as_ref(),
    };
    let of_blisk = reader.run(blisk.mesh.as_ref(), &keys);
    let of_blade = reader.blade(blisk);
    let others = others.into_iter().filter_map(|(body, table)| {
        let table = table?;
        let files = reader.other(body, &table);
        Some(OtherBody { body, table, files })
    });
    let others = others.collect();
    (of_blisk, of_blade, others)
}

impl Reader<'_> {
    /// A path of the import file, which is relative to its folder.
    fn beside(&self, path: &Path) -> PathBuf {
        let folder = self.import_file.parent();
        folder.unwrap_or_else(|| Path::new("")).join(path)
    }

    fn run(&mut self, mesh: Option<&PathBuf>, keys: &Keys<'_>) -> RunFiles {
        let mesh = match (mesh, keys.job) {
            (Some(mesh), _) => self.beside(mesh),
            (None, Some(job)) => self.beside(&with_suffix(job, "inp")),
            (None, None) => {
                let accepted = "the file with nodes, elements and sets";
                let key = format!("{}mesh", keys.prefix);
                self.problems.push(missing(key, accepted));
                PathBuf::new()
            }
        };
        RunFiles {
            mesh,
            matrices: self.matrices(keys),
        }
    }

    /// The files of a body beside the blisk, where it has some of its own.
    fn other(&mut self, body: Body, table: &BodyTable) -> Option<RunFiles> {
        let name = body_name(body);
        if !table.has_files() {
            if table.set.is_none() {
                let accepted = format!(
                    "the set of the {name}'s nodes or elements in the blisk's files, or `{name}.mesh` and its matrices"
                );
                self.problems
                    .push(missing(format!("{name}.set"), &accepted));
            }
            return None;
        }
        if table.set.is_some() {
            let reason = format!("files of the {name} are also given; accepted: one of the two");
            let problem = Problem::Conflict { reason };
            self.problems.push((format!("{name}.set"), problem));
        }
        let keys = Keys {
            prefix: match body {
                Body::Blisk => "blisk.",
                Body::Ring => "ring.",
                Body::Damper => "damper.",
            },
            job: table.job.as_ref(),
            stiffness: table.stiffness.as_ref(),
            mass: table.mass.as_ref(),
            has_mass: true,
            dofs: table.dofs.as_ref(),
            stiffness_name: table.stiffness_name.as_ref(),
            mass_name: table.mass_name.as_ref(),
        };
        Some(self.run(table.mesh.as_ref(), &keys))
    }

    /// The files of the blade's stiffness, where a run of its own wrote it.
    fn blade(&mut self, blisk: &BliskTable) -> Option<MatrixFiles> {
        if blisk.blade_job.is_none() && blisk.blade_stiffness.is_none() {
            if blisk.blade_elements.is_none() {
                let accepted = "the element set of the blade, or `blisk.blade_job` or `blisk.blade_stiffness` with the matrices of the blade alone";
                self.problems
                    .push(missing("blisk.blade_elements", accepted));
            }
            return None;
        }
        // A job of the blade's own has its own table.
        let has_table = blisk.blade_job.is_some() && self.format == MatrixFormat::Calculix;
        let of_blisk = blisk.dofs.as_ref().filter(|_| !has_table);
        Some(self.matrices(&Keys {
            prefix: "blisk.blade_",
            job: blisk.blade_job.as_ref(),
            stiffness: blisk.blade_stiffness.as_ref(),
            mass: None,
            has_mass: false,
            dofs: blisk.blade_dofs.as_ref().or(of_blisk),
            stiffness_name: blisk.blade_stiffness_name.as_ref(),
            mass_name: None,
        }))
    }

    fn matrices(&mut self, keys: &Keys<'_>) -> MatrixFiles {
        let format = self.format;
        let calculix = format == MatrixFormat::Calculix;
        let mut path = |stated: Option<&PathBuf>, suffix: &str, key: &str| match (stated, keys.job)
        {
            (Some(stated), _) => self.beside(stated),
            (None, Some(job)) if calculix => self.beside(&with_suffix(job, suffix)),
            // DMIG names its rows itself.
            (None, _) if key == "dofs" && format == MatrixFormat::Dmig => PathBuf::new(),
            (None, _) => {
                let accepted = match (calculix, key) {
                    (true, _) => "a file, or the key job with the name of the CalculiX job",
                    (false, "dofs") => "a file that gives node and direction of each row",
                    (false, _) => "a file",
                };
                let key = format!("{}{key}", keys.prefix);
                self.problems.push(missing(key, accepted));
                PathBuf::new()
            }
        };
        let one_file = matches!(format, MatrixFormat::Dmig | MatrixFormat::Op4);
        // A punch file holds both.
        let mass = keys.mass.or(keys.stiffness.filter(|_| one_file));
        MatrixFiles {
            format,
            stiffness: path(keys.stiffness, "sti", "stiffness"),
            mass: if keys.has_mass {
                path(mass, "mas", "mass")
            } else {
                PathBuf::new()
            },
            dofs: path(keys.dofs, "dof", "dofs"),
            stiffness_name: keys.stiffness_name.cloned(),
            mass_name: keys.mass_name.cloned(),
        }
    }
}

/// The name of a file of a job; a dot in the name of the job is no suffix.
fn with_suffix(job: &Path, suffix: &str) -> PathBuf {
    let mut name = job.as_os_str().to_owned();
    name.push(".");
    name.push(suffix);
    PathBuf::from(name)
}

/// A finding of a key that is not there.
pub(super) fn missing(key: impl Into<String>, accepted: &str) -> (String, Problem) {
    let accepted = accepted.to_owned();
    (key.into(), Problem::Missing { accepted })
}
