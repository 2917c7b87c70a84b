//! Contacts of an import that are refused, each with key, value and what is accepted.

use std::fs;

use blisk::model::sector::import::import;

use super::sides::{Bricks, WEDGE};

fn refusal(bricks: &Bricks, tables: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    bricks.write(folder.path(), tables);
    let path = folder.path().join("import.toml");
    import(&path).unwrap_err().to_string()
}

/// Text of the tables of the wedge, what is put in its place, and what the message must say.
type Case = (&'static str, &'static str, &'static [&'static str]);

fn assert_refused(bricks: &Bricks, cases: &[Case]) {
    for (from, to, words) in cases {
        let spoiled = WEDGE.replacen(from, to, 1);
        assert_ne!(WEDGE, spoiled, "{from}");
        let message = refusal(bricks, &spoiled);
        for word in *words {
            assert!(message.contains(word), "{from:?} -> {to:?}: {message}");
        }
    }
}

#[test]
fn sides_are_refused_with_key_and_value() {
    let cases: &[Case] = &[
        (
            "second = \"damper.FLANK\"",
            "second = \"damper.FLANK\"\nweight = 3",
            &[
                "contact[0].weight: the share of a contact is relative to those of the others, and contact[1] has none; accepted: weight in every contact or in none",
            ],
        ),
        (
            "second = \"damper.FAR\"",
            "second = \"damper.FAR\"\nweight = 3",
            &[
                "contact[1].weight: the share of a contact is relative",
                "contact[0] has none",
            ],
        ),
        (
            "second = \"damper.FAR\"",
            "second = \"damper.FAR\"\nweight = 0.0",
            &["contact[1].weight = 0", "accepted: ", "above 0"],
        ),
        (
            "second = \"damper.FLANK\"",
            "second = \"blisk.high_side\"",
            &[
                "import.toml:19: contact[0].second: it is the first side, too; accepted: another surface",
            ],
        ),
        (
            "first = \"blisk.HIGH_SIDE\"",
            "first = \"ground\"",
            &[
                "contact[0].first = \"ground\" is not accepted; accepted: BODY.SET or next.BODY.SET, as normals",
            ],
        ),
        (
            "first = \"damper.OUTER\"",
            "first = \"next.damper.OUTER\"",
            &[
                "contact[2].first: the ground is the same for every sector; accepted: a surface of the sector itself",
            ],
        ),
        (
            "second = \"damper.FAR\"",
            "second = \"next.damper.FAR\"",
            &["contact[1].second: both sides are of the next sector; accepted: one of them"],
        ),
        (
            "\"damper.FLANK\"",
            "\"dampr.FLANK\"",
            &[
                "contact[0].second = \"dampr.FLANK\" is not accepted; did you mean \"damper.FLANK\"?; accepted: BODY.SET",
                "^^^^",
            ],
        ),
        (
            "\"damper.FLANK\"",
            "\"FLANK\"",
            &["contact[0].second = \"FLANK\" is not accepted; accepted: BODY.SET or next.BODY.SET"],
        ),
        (
            "\"ground\"",
            "\"grond\"",
            &["contact[2].second = \"grond\" is not accepted; did you mean \"ground\"?"],
        ),
        (
            "\"damper.FLANK\"",
            "\"damper.FLNK\"",
            &[
                "contact[0].second = \"damper.FLNK\" is not accepted; did you mean \"damper.FLANK\"?",
                "accepted: damper.SET, SET being a set of ",
                "mesh: ALL, ",
            ],
        ),
        (
            "\"next.blisk.LOW_SIDE\"",
            "\"next.blisk.LOW_SDE\"",
            &[
                "contact[1].first = \"next.blisk.LOW_SDE\" is not accepted; did you mean \"next.blisk.LOW_SIDE\"?",
            ],
        ),
        (
            "second = \"damper.FLANK\"\n",
            "",
            &["contact[0].second is missing; accepted: BODY.SET, next.BODY.SET or ground"],
        ),
        (
            "second = \"damper.FLANK\"\n",
            "second = \"damper.FLANK\"\nring = \"FLANK\"\n",
            &[
                "contact[0].first: surfaces of blisk and ring are also given; accepted: blisk and ring, or",
            ],
        ),
        (
            "second = \"damper.FLANK\"\n",
            "secnd = \"damper.FLANK\"\n",
            &["unknown key contact[0].secnd; did you mean second?"],
        ),
    ];
    assert_refused(&Bricks::wedge(), cases);
}

#[test]
fn contacts_and_bodies_that_do_not_go_together_are_refused() {
    let cases: &[Case] = &[
        (
            "[damper]\nset = \"WEDGE\"\ngrounding_hz = 0.5\n",
            "",
            &[
                "damper is missing; accepted: a table with the files of the damper, as contact[0].second is a surface",
            ],
        ),
        (
            "\"damper.FLANK\"",
            "\"ring.FLANK\"",
            &[
                "ring is missing; accepted: a table with the files of the ring, as contact[0].second is",
            ],
        ),
        (
            "set = \"WEDGE\"",
            "set = \"WEDGE\"\nlow_face = \"LOW\"",
            &["unknown key damper.low_face"],
        ),
        (
            "set = \"WEDGE\"",
            "",
            &[
                "damper.set is missing; accepted: the set of the damper's nodes or elements",
                "`damper.mesh`",
            ],
        ),
        (
            "set = \"WEDGE\"",
            "set = \"WEGDE\"",
            &["damper.set = \"WEGDE\" is not accepted; did you mean \"WEDGE\"?"],
        ),
        (
            "set = \"WEDGE\"",
            "set = \"WEDGE\"\nmesh = \"mesh\"",
            &["damper.set: files of the damper are also given; accepted: one of the two"],
        ),
        (
            "second = \"damper.FLANK\"\n",
            "second = \"damper.FLANK\"\npairing = \"projection\"\n",
            &[
                "contact[0].pairing = \"projection\" is not accepted; accepted: \"nodes\": only a ring is projected",
            ],
        ),
        (
            "second = \"ground\"\n",
            "second = \"ground\"\nweights = \"equal\"\n",
            &[
                "contact[2].weights: they are shared out among all contacts, and are others in contact[0]; accepted",
            ],
        ),
        (
            "second = \"ground\"\n",
            "second = \"ground\"\nnormal = [1, 0, 0]\n",
            &[
                "contact[2].normal: nodes with this key have no area, those of contact[0]",
                "weights = \"equal\"",
            ],
        ),
        (
            "second = \"ground\"\n",
            "second = \"ground\"\nnormal = [0, 0, 0]\n",
            &["contact[2].normal: the normal has no direction"],
        ),
        (
            "[[contact]]\nfirst = \"damper.OUTER\"\nsecond = \"ground\"\n",
            "[[contact]]\nfirst = \"damper.flank\"\nsecond = \"blisk.HIGH_SIDE\"\n",
            &["contact[2].first: contact[0] joins the same surfaces; accepted: each two once"],
        ),
    ];
    assert_refused(&Bricks::wedge(), cases);
    // Nothing holds it, with contacts of others and without any.
    let held = "[[contact]]\nfirst = \"blisk.HIGH_SIDE\"\nsecond = \"ground\"\n";
    let unheld = "nothing holds the damper: no contact has a surface of it; accepted: a [[contact]] with damper.SET";
    for tables in ["", held] {
        let message = refusal(
            &Bricks::wedge(),
            &format!("[damper]\nset = \"WEDGE\"\n{tables}"),
        );
        assert!(message.contains(unheld), "{message}");
    }
    let ring = "[ring]\nset = \"WEDGE\"\nlow_face = \"LOW\"\nhigh_face = \"HIGH\"\n";
    let message = refusal(&Bricks::wedge(), &format!("{ring}{held}"));
    assert!(message.contains("nothing holds the ring"), "{message}");
    let both = format!("{WEDGE}{ring}[[contact]]\nfirst = \"ring.FAR\"\nsecond = \"ground\"\n");
    let message = refusal(&Bricks::wedge(), &both);
    assert!(
        message.contains("damper.set: node 17 is in ring.set, too"),
        "{message}"
    );
}

#[test]
fn surfaces_that_do_not_meet_are_refused_with_nodes_and_distances() {
    let cases: &[Case] = &[
        (
            "\"damper.FLANK\"",
            "\"damper.OUTER\"",
            &[
                "node 12 of the blisk's contact surface is 9.99",
                "e-1 m from the nearest node of the damper's (node 18)",
                "accepted: at most 3.16",
                "`contact[0].tolerance_m`",
            ],
        ),
        (
            "second = \"damper.FAR\"",
            "second = \"damper.FLANK\"",
            &[
                "of the next sector's blisk's contact surface is ",
                "of the damper's (node",
            ],
        ),
        (
            "first = \"damper.OUTER\"\nsecond = \"ground\"",
            "first = \"damper.FAR\"\nsecond = \"next.blisk.HIGH_SIDE\"",
            &[
                "of the damper's contact surface is ",
                "of the next sector's blisk's (node",
            ],
        ),
        (
            "second = \"damper.FLANK\"\n",
            "second = \"damper.EDGE\"\n",
            &[
                "no outer element face of the damper has all its nodes in EDGE; accepted: a node set that holds whole faces, or a surface of element faces, or contact[0].normal for nodes without faces",
            ],
        ),
        (
            "\"damper.FLANK\"",
            "\"damper.TIP\"",
            &["no outer element face of the damper has all its nodes in TIP"],
        ),
        (
            "second = \"damper.FLANK\"\n",
            "second = \"damper.EDGE\"\nnormal = [0, 1, 0]\ntolerance_m = 1.0\n[[contact]]\nfirst = \"damper.WEDGE\"\nsecond = \"next.blisk.TIP\"\nnormal = [0, 1, 0]\n",
            &["contact[2].weights"],
        ),
    ];
    assert_refused(&Bricks::wedge(), cases);
    let only = |contact: &str| {
        format!("[damper]\nset = \"WEDGE\"\n[[contact]]\nnormal = [0, 1, 0]\n{contact}")
    };
    for (contact, words) in [
        (
            "first = \"blisk.HIGH_SIDE\"\nsecond = \"damper.EDGE\"\ntolerance_m = 1.1\n",
            "of the blisk's contact surface both meet node 18 of the damper's; accepted: one each (`contact[0].tolerance_m`",
        ),
        (
            "first = \"damper.TIP\"\nsecond = \"ground\"\n",
            "no free node of the damper is in TIP; accepted: a set of nodes of that body",
        ),
    ] {
        let message = refusal(&Bricks::wedge(), &only(contact));
        assert!(message.contains(words), "{message}");
    }
    // A body without height has sides without area.
    let flat = WEDGE.replace(
        "blisk.HIGH_SIDE\"\nsecond = \"damper.FLANK",
        "damper.FLANK\"\nsecond = \"blisk.HIGH_SIDE",
    );
    let message = refusal(&Bricks::wedge_of(35.0, 0.0), &flat);
    for words in [
        "the faces of FLANK at node ",
        "have no area, or face each other; accepted: faces of one side",
    ] {
        assert!(message.contains(words), "{message}");
    }
    // Within a tolerance that is wide, but at another angle: components would not mean the same.
    let wide = WEDGE.replace("[[contact]]\n", "[[contact]]\ntolerance_m = 0.1\n");
    let message = refusal(&Bricks::wedge_of(35.1, 1.0), &wide);
    for words in [
        "contact pair 0: node ",
        "rad apart; accepted: the same theta within",
    ] {
        assert!(message.contains(words), "{message}");
    }
    let message = refusal(
        &Bricks::wedge_of(35.0, 1.0),
        &WEDGE
            .replace("damper.FLANK\"\n", "damper.WEDGE\"\npairing = \"nodes\"\n")
            .replace("blisk.HIGH_SIDE", "next.damper.FAR"),
    );
    assert!(
        message.contains("of the next sector's damper's contact surface is"),
        "{message}"
    );
    let mut tied = Bricks::wedge();
    tied.tied = Some((9, 17));
    let message = refusal(&tied, WEDGE);
    assert!(
        message.contains("accepted: blisk and damper without tie or contact"),
        "{message}"
    );
}

/// A wheel of one sector has no neighbour; the blade of a wheel that has touches itself nowhere.
#[test]
fn contact_over_the_cut_faces_needs_two_points() {
    let folder = tempfile::tempdir().unwrap();
    Bricks::wedge().write(folder.path(), WEDGE);
    let path = folder.path().join("import.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("sectors = 8", "sectors = 1")).unwrap();
    let message = import(&path).unwrap_err().to_string();
    let words = "contact[1].first: a wheel of one sector has no next one; accepted: surfaces of the sector itself";
    assert!(message.contains(words), "{message}");
    let joined = "[[contact]]\nfirst = \"blisk.HIGH\"\nsecond = \"next.blisk.LOW\"\n";
    let message = refusal(&Bricks::disk_and_blade(), joined);
    assert!(
        message.contains("accepted: two different points"),
        "{message}"
    );
}
