//! Files of finite-element codes that are refused, each with file, line, value and what is accepted.

use std::fs;

use blisk::model::sector::ModelError;
use blisk::model::sector::import::import;

use super::small::Small;

fn refusal(small: &Small, file: &str, change: &dyn Fn(&str) -> String) -> ModelError {
    let folder = tempfile::tempdir().unwrap();
    small.write(folder.path());
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    let changed = change(&text);
    assert_ne!(text, changed, "{file} is unchanged");
    fs::write(&path, changed).unwrap();
    import(&folder.path().join("import.toml")).unwrap_err()
}

#[test]
fn the_small_sector_is_accepted_in_every_format() {
    for small in [
        Small::calculix(),
        Small::ansys(),
        Small::nastran(),
        Small::op4(),
    ] {
        let folder = tempfile::tempdir().unwrap();
        small.write(folder.path());
        let imported = import(&folder.path().join("import.toml")).unwrap();
        assert_eq!(imported.model.dofs.len(), 48);
        assert_eq!(imported.model.contact_pairs.len(), 2);
        for pair in &imported.model.contact_pairs {
            assert!(
                (pair.weight - 0.5).abs() < 1e-9 && pair.normal[0] < -0.9,
                "{pair:?}"
            );
        }
    }
}

/// File, text in it, what is put in its place, and what the message must say.
type Case = (
    &'static str,
    &'static str,
    &'static str,
    &'static [&'static str],
);

fn assert_refused(small: &Small, cases: &[Case]) {
    for (file, from, to, words) in cases {
        let change = |text: &str| text.replacen(from, to, 1);
        let message = refusal(small, file, &change).to_string();
        for word in *words {
            assert!(
                message.contains(word),
                "{file}, {from:?} -> {to:?}: {message}"
            );
        }
    }
}

#[test]
fn import_files_are_refused_with_key_and_value() {
    let cases: &[Case] = &[
        (
            "import.toml",
            "sectors",
            "sektors",
            &[
                "import.toml:3",
                "unknown key sektors; did you mean sectors?",
            ],
        ),
        (
            "import.toml",
            "sectors = 8",
            "sectors = 0",
            &[
                "import.toml:3: sectors = 0 is not accepted",
                "accepted: whole number, 1 to 10000",
            ],
        ),
        (
            "import.toml",
            "\"calculix\"",
            "\"abaqus\"",
            &["import.toml:1", "abaqus", "calculix"],
        ),
        (
            "import.toml",
            "\"LOW\"",
            "\"LEFT\"",
            &[
                "import.toml:8: blisk.low_face = \"LEFT\" is not accepted",
                "accepted: a set of ",
                "HIGH, IN",
            ],
        ),
        (
            "import.toml",
            "sectors = 8",
            "sectors = 9",
            &[
                "node 1 of the low face",
                "accepted: at most",
                "are `sectors`",
            ],
        ),
        (
            "import.toml",
            "low_face = \"LOW\"\nhigh_face = \"HIGH\"",
            "low_face = \"HIGH\"\nhigh_face = \"LOW\"",
            &["low_face and high_face are to be exchanged"],
        ),
        (
            "import.toml",
            "[[force]]\nnode = 2\ncomponent = \"z\"\n",
            "",
            &["force is missing; accepted: one or more tables [[force]]"],
        ),
        (
            "import.toml",
            "component = \"z\"",
            "component = \"x\"",
            &[
                "force[0].component = \"x\" is not accepted",
                "\"r\", \"t\", \"z\"",
            ],
        ),
        (
            "import.toml",
            "blisk = \"IN\"",
            "blisk = \"LOW\"",
            &["contact surface", "accepted: at most"],
        ),
        (
            "import.toml",
            "ring = \"OUT\"",
            "ring = \"ALL_PART\"",
            &["contact.ring = \"ALL_PART\" is not accepted"],
        ),
        (
            "import.toml",
            "set = \"RING\"\n",
            "",
            &["ring.set is missing"],
        ),
        (
            "import.toml",
            "blade_job = \"blade\"",
            "",
            &["blisk.blade_elements is missing", "blisk.blade_job"],
        ),
        (
            "import.toml",
            "blade_job = \"blade\"",
            "blade_elements = \"DISK\"",
            &["element 1 of the blade", "a brick of 8 nodes", "C3D20"],
        ),
    ];
    assert_refused(&Small::calculix(), cases);
}

#[test]
fn what_cannot_be_in_an_import_file_together_is_refused() {
    let cases: &[Case] = &[
        (
            "import.toml",
            "blade_job = \"blade\"",
            "blade_job = \"blade\"\nblade_elements = \"DISK\"",
            &[
                "blisk.blade_elements",
                "also given; accepted: one of the two",
            ],
        ),
        (
            "import.toml",
            "set = \"RING\"\n",
            "set = \"RING\"\njob = \"ring\"\n",
            &["ring.set", "also given; accepted: one of the two"],
        ),
        (
            "import.toml",
            "[contact]",
            "[contact]\nnormal = [0, 0, 0]",
            &["contact.normal", "the normal has no direction"],
        ),
        (
            "import.toml",
            "name = \"tip\"",
            "name = \"tip, outer\"",
            &["observe[0].name", "accepted: no comma"],
        ),
        (
            "import.toml",
            "node = 2\ncomponent",
            "node = 2222\ncomponent",
            &["force[0].node", "no mesh has node 2222"],
        ),
        (
            "mesh",
            "*NSET,NSET=LOW,GENERATE\n1,4",
            "*NSET,NSET=LOW",
            &["blisk.low_face", "the set is empty; accepted: a set with"],
        ),
    ];
    assert_refused(&Small::calculix(), cases);
}

#[test]
fn decks_are_refused_with_file_line_and_value() {
    let cases: &[Case] = &[
        (
            "mesh",
            "C3D8,",
            "S4,",
            &["mesh:", "element type S4", "C3D20R"],
        ),
        (
            "mesh",
            "\n4,8,7",
            "\n4,8",
            &["mesh:", "element 1 has 7 nodes", "accepted: 8"],
        ),
        (
            "mesh",
            "1,1,2,6",
            "1,1,2,66",
            &["mesh:", "node 66 is not in the mesh"],
        ),
        (
            "mesh",
            "1e0, 0e0,0e0",
            "1e0, 0e0,zero",
            &["mesh:5", "z is \"zero\"", "a finite number"],
        ),
        (
            "mesh",
            "*STEP",
            "*INCLUDE,INPUT=mesh\n*STEP",
            &["mesh:", "files are included 17 deep"],
        ),
        (
            "mesh",
            "*STEP",
            "*INCLUDE,INPUT=absent.inc\n*STEP",
            &["absent.inc: No such file"],
        ),
        (
            "mesh",
            "*STEP",
            "*CYCLIC SYMMETRY MODEL,N=8\n*STEP",
            &["mesh:", "*CYCLIC SYMMETRY MODEL", "nodal diameter"],
        ),
        (
            "mesh",
            "*STEP",
            "*PART,NAME=A\n*STEP",
            &["mesh:", "*PART", "flat deck"],
        ),
        (
            "mesh",
            "*NSET,NSET=LOW,GENERATE\n1,4",
            "*NSET,NSET=LOW\nNOWHERE",
            &["mesh:", "NOWHERE"],
        ),
    ];
    assert_refused(&Small::calculix(), cases);
}

#[test]
fn matrices_of_calculix_are_refused_with_file_line_and_value() {
    let cases: &[Case] = &[
        (
            "job.dof",
            "1.1\n",
            "1.4\n",
            &["job.dof:1", "1.4", "direction 1, 2 or 3"],
        ),
        (
            "job.dof",
            "1.1\n",
            "9.1\n",
            &["job.dof: row 1", "node 9", "not in the mesh"],
        ),
        (
            "job.dof",
            "1.1\n",
            "1.2\n",
            &["job.dof: `row 2` is direction 2 of node 1"],
        ),
        (
            "job.sti",
            "1 1 1",
            "1 49 1",
            &["job.sti:1", "up to row 49", "48 rows"],
        ),
        (
            "job.sti",
            "1 1 1.0000000000000e2\n",
            "",
            &["job.sti: row 1 (node 1, direction 1) has no diagonal"],
        ),
        (
            "job.sti",
            "1 1 1.0000000000000e2\n",
            "1 1 1e2\n1 1 1e2\n",
            &["job.sti: the entry (1, 1) stands twice"],
        ),
        (
            "job.sti",
            "1 1 1.0",
            "1 1 one",
            &["job.sti:1", "value is \"one"],
        ),
        (
            "job.sti",
            "3 6 -2.5",
            "3 45 -2.5",
            &["job.sti", "nodes 17 and 1 belong to different bodies"],
        ),
        (
            "job.mas",
            "1 1 1.0000000000000e0",
            "1 1 -1.0000000000000e0",
            &["M has -1e0 on the diagonal"],
        ),
        ("blade.dof", "2.3\n", "12.9\n", &["blade.dof:6", "12.9"]),
    ];
    assert_refused(&Small::calculix(), cases);
}

/// Components are turned to r and theta: x without y has no meaning there, z alone has.
#[test]
fn nodes_held_in_one_direction_of_the_plane_are_refused() {
    let refused = |kept: fn(&(usize, usize)) -> bool| {
        let folder = tempfile::tempdir().unwrap();
        Small::calculix_of(kept).write(folder.path());
        import(&folder.path().join("import.toml"))
            .err()
            .map(|error| error.to_string())
    };
    let half = refused(|row| *row != (8, 0)).unwrap();
    assert!(half.contains("node 8 has direction y but not x"), "{half}");
    let one_side = refused(|row| *row != (8, 2)).unwrap();
    assert!(
        one_side.contains("nodes 4 and 8 of the cyclic faces are not free"),
        "{one_side}"
    );
    let tied = refused(|&(node, _)| node != 8).unwrap();
    assert!(tied.contains("node 4 of the low face"), "{tied}");
    assert_eq!(refused(|row| !matches!(row, (4 | 8, 0 | 1))), None);
}

#[test]
fn files_of_ansys_are_refused_with_file_line_and_value() {
    let cases: &[Case] = &[
        ("K", "RSA", "CSA", &["K:3", "CSA", "RSA"]),
        ("K", "(1D26.17)", "(A26)    ", &["K:4", "(A26)", "(8I10)"]),
        (
            "K",
            "            48",
            "            47",
            &["K:3", "47", "48"],
        ),
        (
            "K.mapping",
            "1           1          UX",
            "1           1        ROTX",
            &["K.mapping:2", "ROTX", "UX, UY, UZ"],
        ),
        (
            "K.mapping",
            "           2           1",
            "           3           1",
            &["K.mapping:3", "is 3", "accepted: 2"],
        ),
        ("mesh", "(3i9,6e24.16e3)", "(free)", &["mesh:4", "(free)"]),
        (
            "mesh",
            "N,R5.3,LOC,       -1,",
            "       x",
            &["mesh:21", "\"x\""],
        ),
        (
            "mesh",
            "        8        0        1",
            "        9        0        1",
            &["mesh:", "element 1 has 27 nodes", "accepted: 9"],
        ),
    ];
    assert_refused(&Small::ansys(), cases);
    for file in ["K", "M", "mesh"] {
        let cut = refusal(&Small::ansys(), file, &|text| {
            let lines: Vec<&str> = text.lines().collect();
            lines[..lines.len() - 3].join("\n")
        });
        let message = cut.to_string();
        assert!(
            message.contains("cut off") || message.contains("set ") || message.contains("no outer"),
            "{file}: {message}"
        );
    }
}

#[test]
fn files_of_nastran_are_refused_with_file_line_and_value() {
    let cases: &[Case] = &[
        (
            "punch",
            "KAAX           0       6",
            "KAAX           0       9",
            &["punch:1", "is 9", "6 (symmetric)"],
        ),
        (
            "punch",
            "6       2       0",
            "6       4       0",
            &["punch:1", "is 4", "real"],
        ),
        (
            "punch",
            "               1               1                *",
            "               1               4                *",
            &["punch:2", "\"4\"", "1, 2 or 3"],
        ),
        (
            "punch",
            "DMIG,MAAX,0",
            "DMIG,MBBX,0",
            &["punch:268", "DMIG MAAX 1", "after the header"],
        ),
        (
            "mesh",
            "CHEXA,2,1,11",
            "CHEXA,2,1,99",
            &["mesh", "node 99 is not in the mesh"],
        ),
        (
            "mesh",
            "CHEXA,2,1,11,12",
            "CHEXA,2,1,11",
            &["mesh:", "element 2 has 7 nodes"],
        ),
        (
            "mesh",
            "GRID*                  1                ",
            "GRID*                  1               7",
            &["mesh:3", "CP is \"7\"", "basic"],
        ),
    ];
    assert_refused(&Small::nastran(), cases);
    let cases: &[Case] = &[
        ("op4", "1P,3E23.16", "1P,3X23.16", &["op4:1", "1P,5E16.9"]),
        (
            "op4",
            "       2KAA",
            "       4KAA",
            &["op4", "complex", "real"],
        ),
        ("op4", "MAA", "MBB", &["no matrix MAA", "KAA, MBB"]),
        ("dofs", "1,1,1", "1,1,5", &["dofs:2", "1,1,5", "UX, UY, UZ"]),
    ];
    assert_refused(&Small::op4(), cases);
    let cut = refusal(&Small::op4(), "op4", &|text| {
        text[..text.len() - 60].to_owned()
    });
    assert!(cut.to_string().contains("cut off"), "{cut}");
}
