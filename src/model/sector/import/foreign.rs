//! Files of finite-element codes that are given in the place of an import file, and what to do with each.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// A kind of file, by what its name ends in and by what its text begins with.
struct Kind {
    endings: &'static [&'static str],
    begins: &'static [&'static str],
    /// What it is.
    what: &'static str,
    /// What to type, `FILE` being its name.
    next: &'static str,
    /// Where its name goes then.
    usage: &'static str,
}

const TEMPLATE_ANSYS: &str = "`blisk import --template ansys > wheel.toml` writes an import file";
const TEMPLATE_CALCULIX: &str =
    "`blisk import --template calculix > wheel.toml` writes an import file";
const TEMPLATE_NASTRAN: &str =
    "`blisk import --template nastran > wheel.toml` writes an import file";

const MESH: &str = "; name FILE in it as `blisk.mesh`, then `blisk import wheel.toml --out bundle`";
const MATRIX: &str = "; name FILE in it as `blisk.stiffness` or `blisk.mass`, then `blisk import wheel.toml --out bundle`";
const ROWS: &str = "; name FILE in it as `blisk.dofs`, then `blisk import wheel.toml --out bundle`";
const JOB: &str = "; name its job, FILE without the ending, in it as `blisk.job`, then `blisk import wheel.toml --out bundle`";

const KINDS: &[Kind] = &[
    Kind {
        endings: &["cdb"],
        begins: &["/COM,", "/PREP7", "NBLOCK,", "/NOPR"],
        what: "a mesh of Ansys",
        next: TEMPLATE_ANSYS,
        usage: MESH,
    },
    Kind {
        endings: &["full"],
        begins: &[],
        what: "the binary file of assembled matrices of Ansys",
        next: "`python studies/ansys/full_to_matrix_market.py FILE` writes its matrices as text; then `blisk import --template ansys > wheel.toml` writes an import file for them",
        usage: "",
    },
    Kind {
        endings: &["rst", "rth", "emat"],
        begins: &[],
        what: "a binary result file of Ansys, which holds no assembled matrices",
        next: "write the .full file (`WRFULL,1`) and use HBMAT or `python studies/ansys/full_to_matrix_market.py file.full`; then `blisk import --template ansys > wheel.toml` writes an import file",
        usage: "",
    },
    Kind {
        endings: &["mapping"],
        begins: &[],
        what: "a table of matrix rows of Ansys",
        next: TEMPLATE_ANSYS,
        usage: ROWS,
    },
    Kind {
        endings: &["mtx"],
        begins: &["%%MATRIXMARKET"],
        what: "a matrix in the Matrix Market format",
        next: "`blisk import --template ansys > wheel.toml` writes an import file; set `matrix_format = \"matrix_market\"`",
        usage: MATRIX,
    },
    Kind {
        endings: &["sti", "mas", "dof"],
        begins: &[],
        what: "a matrix file of CalculiX",
        next: TEMPLATE_CALCULIX,
        usage: JOB,
    },
    Kind {
        endings: &["inp", "inc"],
        begins: &["*HEADING", "*NODE", "*INCLUDE", "*ELEMENT", "**"],
        what: "a deck of CalculiX or Abaqus",
        next: TEMPLATE_CALCULIX,
        usage: JOB,
    },
    Kind {
        endings: &["frd", "odb"],
        begins: &[],
        what: "a result file, which holds no assembled matrices",
        next: "store the matrices with `*FREQUENCY,SOLVER=MATRIXSTORAGE`; then `blisk import --template calculix > wheel.toml` writes an import file",
        usage: "",
    },
    Kind {
        endings: &["bdf", "nas", "dat"],
        begins: &["BEGIN BULK", "GRID", "CEND", "SOL ", "$"],
        what: "bulk data of Nastran",
        next: TEMPLATE_NASTRAN,
        usage: MESH,
    },
    Kind {
        endings: &["pch"],
        begins: &["DMIG"],
        what: "a punch file of Nastran",
        next: TEMPLATE_NASTRAN,
        usage: MATRIX,
    },
    Kind {
        endings: &["op4"],
        begins: &[],
        what: "an OUTPUT4 file of Nastran",
        next: "`blisk import --template nastran > wheel.toml` writes an import file; set `matrix_format = \"op4\"`",
        usage: MATRIX,
    },
    Kind {
        endings: &["op2"],
        begins: &[],
        what: "a binary result file of Nastran, which is not read",
        next: "write the matrices as DMIG (`EXTSEOUT`) or as OUTPUT4 in ASCII; then `blisk import --template nastran > wheel.toml` writes an import file",
        usage: "",
    },
    Kind {
        endings: &["matrix", "hb", "rsa", "rua"],
        begins: &[],
        what: "a matrix in the Harwell-Boeing format",
        next: TEMPLATE_ANSYS,
        usage: MATRIX,
    },
];

/// Bytes that are read to recognise a file.
const BEGINNING: u64 = 1 << 20;

/// What a file of a finite-element code is, and the command to type, where `path` is one and no import file;
/// none for a file that cannot be read, or can be read only once.
#[must_use]
pub fn foreign(path: &Path) -> Option<String> {
    let kind = kind_of(path)?;
    let advice =
        format!("{}{}", kind.next, kind.usage).replace("FILE", &path.display().to_string());
    Some(format!(
        "{} is {}, not an import file; {advice}",
        path.display(),
        kind.what
    ))
}

/// What a file of a finite-element code is; none for another file.
pub(super) fn what_is(path: &Path) -> Option<&'static str> {
    Some(kind_of(path)?.what)
}

fn kind_of(path: &Path) -> Option<&'static Kind> {
    if !path.metadata().is_ok_and(|found| found.is_file()) {
        return None;
    }
    let mut bytes = Vec::new();
    File::open(path)
        .ok()?
        .take(BEGINNING)
        .read_to_end(&mut bytes)
        .ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let is_toml = !bytes.contains(&0) && toml::de::DeTable::parse(&text).is_ok();
    if is_toml {
        return None;
    }
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let first = text.lines().find(|line| !line.trim().is_empty());
    let first = first.unwrap_or_default().trim_start().to_ascii_uppercase();
    let by_name = |kind: &&Kind| {
        ending
            .as_ref()
            .is_some_and(|ending| kind.endings.contains(&ending.as_str()))
    };
    let by_text = |kind: &&Kind| kind.begins.iter().any(|start| first.starts_with(start));
    let named = KINDS.iter().find(by_name);
    named.or_else(|| KINDS.iter().find(by_text))
}
