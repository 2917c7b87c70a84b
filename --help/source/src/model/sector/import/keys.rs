//! Every key of an import file: what `blisk explain`, the JSON Schema and docs/import.md say of it.

use serde_json::Value as Json;

use crate::input::Value::{Name, Number, Table, TableOrTables, Tables, Text, Vector, Whole};
use crate::input::{Entry, KeySpec, REQUIRED, Range, Value, entry, schema_of};
use crate::model::sector::sector_model::MAX_SECTORS;

const FILE: Value = Text("a path, relative to the import file");
const SET: Value = Text("a set of the mesh");
const NODE: Value = Whole(1, 999_999_999_999);
const ZERO_OR_MORE: Value = Number(Range::at_least(0.0));
const MATRIX: Value = Text("the name of a matrix in the file");
const ONLY_ONE: &str = "the only one; of DMIG `KAAX` or `MAAX`";
const OF_JOB: &str = "that of the job; required without one";
const NO_JOB: &str = "none";
const SIDE: &str = "`BODY.SET` or `next.BODY.SET`, BODY being `blisk`, `ring` or `damper` and SET a set of its mesh";
const SIDE_OR_GROUND: &str = "`BODY.SET`, `next.BODY.SET` or `ground`, BODY being `blisk`, `ring` or `damper` and SET a set of its mesh";

/// The keys before those of the bodies beside the blisk, in the order of docs/import.md.
const HEAD: &[Entry] = &[
    entry(
        "code",
        Name(&["calculix", "ansys", "nastran"]),
        REQUIRED,
        "the code that wrote the files; decides the two formats below",
    ),
    entry(
        "mesh_format",
        Name(&["calculix", "ansys", "nastran"]),
        "that of `code`",
        "a deck of CalculiX or Abaqus, a `.cdb` of Ansys, or bulk data of Nastran",
    ),
    entry(
        "matrix_format",
        Name(&["calculix", "harwell_boeing", "matrix_market", "op4", "dmig"]),
        "by `code`: `calculix`, `harwell_boeing`, `dmig`",
        "the format of stiffness and mass",
    ),
    entry("name", Text("a name"), REQUIRED, "name of the model"),
    entry(
        "sectors",
        Whole(1, MAX_SECTORS as i64),
        REQUIRED,
        "number of sectors of the wheel",
    ),
    entry(
        "units",
        Name(&["m-kg-s", "mm-t-s"]),
        "`\"m-kg-s\"`",
        "units of the files; `mm-t-s`: mm, tonne, N",
    ),
    entry(
        "axis",
        Name(&["x", "y", "z"]),
        "`\"z\"`",
        "axis of rotation, through the origin",
    ),
    entry(
        "position_tolerance_m",
        ZERO_OR_MORE,
        "1e-6 of the largest distance from the origin",
        "how far a node of the high face may be from its node of the low face turned by a sector, m",
    ),
    entry("blisk", Table, REQUIRED, "the files of the blisk"),
    entry(
        "blisk.mesh",
        FILE,
        "`JOB.inp` of the job; required without one",
        "nodes, elements and sets",
    ),
    entry(
        "blisk.job",
        Text("the name of a CalculiX job, relative to the import file"),
        NO_JOB,
        "CalculiX: stands for `JOB.inp`, `.sti`, `.mas` and `.dof`",
    ),
    entry("blisk.stiffness", FILE, OF_JOB, "the stiffness"),
    entry(
        "blisk.mass",
        FILE,
        "that of the job; the file of the stiffness for OP4 and DMIG; else required",
        "the mass",
    ),
    entry(
        "blisk.dofs",
        FILE,
        "that of the job; none for DMIG; else required",
        "the table that gives node and direction of each row",
    ),
    entry(
        "blisk.stiffness_name",
        MATRIX,
        ONLY_ONE,
        "matrix within an OP4 or DMIG file",
    ),
    entry(
        "blisk.mass_name",
        MATRIX,
        ONLY_ONE,
        "matrix within an OP4 or DMIG file",
    ),
    entry(
        "blisk.low_face",
        SET,
        REQUIRED,
        "nodes of the low cyclic face; turned by +360/N degrees it is the high face",
    ),
    entry(
        "blisk.high_face",
        SET,
        REQUIRED,
        "nodes of the high cyclic face",
    ),
    entry(
        "blisk.blade_elements",
        Text("an element set of the mesh"),
        "required without matrices of the blade",
        "elements of the blade, assembled here: `C3D20`, isotropic, at rest",
    ),
    entry(
        "blisk.blade_job",
        Text("the name of a CalculiX job, relative to the import file"),
        NO_JOB,
        "CalculiX: the job that wrote the stiffness of the blade alone",
    ),
    entry(
        "blisk.blade_stiffness",
        FILE,
        "that of `blade_job`",
        "the stiffness of the blade alone, same nodes",
    ),
    entry(
        "blisk.blade_dofs",
        FILE,
        "that of `blade_job`, or `blisk.dofs`",
        "the table of rows of the stiffness of the blade alone",
    ),
    entry(
        "blisk.blade_stiffness_name",
        MATRIX,
        ONLY_ONE,
        "matrix within an OP4 or DMIG file",
    ),
];

/// The keys of the files of a body beside the blisk, below its table.
const FILES: &[Entry] = &[
    entry(
        "mesh",
        FILE,
        "`JOB.inp` of the job",
        "nodes, elements and sets, where the body has files of its own",
    ),
    entry(
        "job",
        Text("the name of a CalculiX job, relative to the import file"),
        NO_JOB,
        "CalculiX: stands for `JOB.inp`, `.sti`, `.mas` and `.dof`",
    ),
    entry("stiffness", FILE, OF_JOB, "the stiffness"),
    entry(
        "mass",
        FILE,
        "that of the job; the file of the stiffness for OP4 and DMIG; else required",
        "the mass",
    ),
    entry(
        "dofs",
        FILE,
        "that of the job; none for DMIG; else required",
        "the table that gives node and direction of each row",
    ),
    entry(
        "stiffness_name",
        MATRIX,
        ONLY_ONE,
        "matrix within an OP4 or DMIG file",
    ),
    entry(
        "mass_name",
        MATRIX,
        ONLY_ONE,
        "matrix within an OP4 or DMIG file",
    ),
];

const RING: &[Entry] = &[entry(
    "ring",
    Table,
    "no ring",
    "the files of the ring, or its set in those of the blisk",
)];

const OF_RING: &[Entry] = &[
    entry(
        "low_face",
        SET,
        REQUIRED,
        "nodes of the low cyclic face of the ring",
    ),
    entry(
        "high_face",
        SET,
        REQUIRED,
        "nodes of the high cyclic face of the ring",
    ),
    entry(
        "set",
        SET,
        "required where the ring has no files of its own",
        "nodes or elements of the ring in the blisk's files",
    ),
    entry(
        "grounding_hz",
        ZERO_OR_MORE,
        "0",
        "adds `(2 pi f)^2 M` on the ring, so that its free motions are not singular, Hz",
    ),
];

const DAMPER: &[Entry] = &[entry(
    "damper",
    Table,
    "no damper",
    "the files of a body of one sector that contact alone holds, or its set in those of the blisk",
)];

const OF_DAMPER: &[Entry] = &[
    entry(
        "set",
        SET,
        "required where the damper has no files of its own",
        "nodes or elements of the damper in the blisk's files",
    ),
    entry(
        "grounding_hz",
        ZERO_OR_MORE,
        "0",
        "adds `(2 pi f)^2 M` on the damper, so that its free motions are not singular, Hz",
    ),
];

/// The keys after those of the bodies.
const TAIL: &[Entry] = &[
    entry(
        "contact",
        TableOrTables,
        "required with a ring or a damper",
        "the surfaces that touch, two in each table",
    ),
    entry(
        "contact.blisk",
        SET,
        "required without `first`",
        "the blisk's surface: a node set that holds whole element faces, or a surface of element faces; stands for `first = \"blisk.SET\"`",
    ),
    entry(
        "contact.ring",
        SET,
        "required without `second`",
        "the ring's surface, likewise; stands for `second = \"ring.SET\"`",
    ),
    entry(
        "contact.first",
        Text(SIDE),
        "required without `blisk`",
        "the side out of which normals point: its body, and a set as of `blisk`; after `next.` that of the next sector",
    ),
    entry(
        "contact.second",
        Text(SIDE_OR_GROUND),
        "required without `ring`",
        "the side that it touches, likewise, or the ground; one of the two is of the sector itself",
    ),
    entry(
        "contact.tolerance_m",
        ZERO_OR_MORE,
        "`position_tolerance_m`",
        "largest distance between the nodes of a pair, m",
    ),
    entry(
        "contact.pairing",
        Name(&["nodes", "projection"]),
        "`\"nodes\"`",
        "`nodes`: node to node; `projection`: surfaces of blisk and ring that do not match",
    ),
    entry(
        "contact.weights",
        Name(&["area", "equal"]),
        "`\"area\"`",
        "how much a pair counts among those of all contacts: the area that its node stands for, or the same for all",
    ),
    entry(
        "contact.weight",
        Number(Range::above(0.0).up_to(1e30)),
        "by `weights` among the pairs of all contacts",
        "share of this contact in stiffness and normal load of the sector, relative to the other contacts; in every contact or in none",
    ),
    entry(
        "contact.normal",
        Vector(3),
        "from the faces",
        "outward normal of the first side in (r, theta, z), for meshes without elements; weights are then equal",
    ),
    entry(
        "force",
        Tables,
        REQUIRED,
        "forces in N per newton of `excitation.amplitude_n`, each shared equally by its nodes",
    ),
    entry(
        "force.node",
        NODE,
        "required without `set`",
        "the node that the force acts on",
    ),
    entry(
        "force.set",
        SET,
        "required without `node`",
        "the nodes that share the force",
    ),
    entry(
        "force.component",
        Name(&["r", "t", "z"]),
        REQUIRED,
        "direction of the force: radial, tangential or axial",
    ),
    entry("force.re", Number(Range::ANY), "1", "real part, N"),
    entry("force.im", Number(Range::ANY), "0", "imaginary part, N"),
    entry(
        "observe",
        Tables,
        REQUIRED,
        "observed nodes; the first one carries the peak metric",
    ),
    entry(
        "observe.name",
        Text("a name"),
        REQUIRED,
        "name of the node in tables",
    ),
    entry("observe.node", NODE, "required without `set`", "the node"),
    entry(
        "observe.set",
        SET,
        "required without `node`",
        "a set of one node",
    ),
];

/// Every key of an import file in the order of docs/import.md.
#[must_use]
pub fn import_keys() -> Vec<KeySpec> {
    let groups = [
        ("", HEAD),
        ("", RING),
        ("ring.", FILES),
        ("ring.", OF_RING),
        ("", DAMPER),
        ("damper.", FILES),
        ("damper.", OF_DAMPER),
        ("", TAIL),
    ];
    let named = |(table, entries): (&str, &'static [Entry])| {
        let key = |entry: &Entry| KeySpec::new(entry, format!("{table}{}", entry.key));
        entries.iter().map(key).collect::<Vec<_>>()
    };
    groups.into_iter().flat_map(named).collect()
}

/// JSON Schema (draft 7) of import files. What keys have to do with each other is said by `blisk import`.
#[must_use]
pub fn import_schema() -> Json {
    schema_of("Import file of blisk", &import_keys())
}
