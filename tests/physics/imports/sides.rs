//! Contacts between any two surfaces of an import: areas and normals from their faces, over the cut faces, of several bodies.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use blisk::model::sector::import::{Imported, import};
use blisk::model::sector::{Body, ContactPair, ContactSide, SectorModel};

use super::cartesian::CartesianMatrix;
use super::small::Small;
use super::writers;

const SECTORS: usize = 8;
/// Angle of a sector, degrees.
const PITCH_DEG: f64 = 45.0;

/// A sector of bricks with matrices that couple every two nodes of a body weakly.
#[derive(Default)]
pub struct Bricks {
    /// Body, radius, angle in degrees, and height of each node, from 1.
    nodes: Vec<(Body, [f64; 3])>,
    elements: Vec<[usize; 8]>,
    sets: Vec<(&'static str, Vec<usize>)>,
    /// Two nodes that the stiffness couples although they are of two bodies.
    pub tied: Option<(usize, usize)>,
}

impl Bricks {
    /// The node of a body at a place, made when first asked for.
    fn node(&mut self, body: Body, place: [f64; 3]) -> usize {
        let known = self.nodes.iter().position(|node| *node == (body, place));
        known.map_or_else(
            || {
                self.nodes.push((body, place));
                self.nodes.len()
            },
            |at| at + 1,
        )
    }

    /// Adds a brick between two radii, two angles and the heights 0 and `height`.
    fn add(&mut self, body: Body, r: [f64; 2], theta_deg: [f64; 2], height: f64) {
        let mut nodes = [0; 8];
        for (level, z) in [0.0, height].into_iter().enumerate() {
            for (corner, [i, j]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
                nodes[4 * level + corner] = self.node(body, [r[i], theta_deg[j], z]);
            }
        }
        self.elements.push(nodes);
    }

    /// Names the nodes of a body within a range of radii and of angles.
    fn name(&mut self, name: &'static str, body: Body, r: [f64; 2], theta_deg: [f64; 2]) {
        let within = |value: f64, [low, high]: [f64; 2]| low <= value && value <= high;
        let nodes = (1..).zip(&self.nodes);
        let chosen = nodes.filter(|(_, (own, place))| {
            *own == body && within(place[0], r) && within(place[1], theta_deg)
        });
        let chosen = chosen.map(|(node, _)| node).collect();
        self.sets.push((name, chosen));
    }

    /// A disk of one brick, and on it a blade that leaves room for what lies between it and the next.
    pub fn disk_and_blade() -> Self {
        let mut bricks = Self::default();
        let body = Body::Blisk;
        bricks.add(body, [1.0, 2.0], [0.0, PITCH_DEG], 1.0);
        bricks.add(body, [2.0, 3.0], [10.0, 35.0], 1.0);
        bricks.name("LOW", body, [1.0, 2.0], [0.0, 0.0]);
        bricks.name("HIGH", body, [1.0, 2.0], [PITCH_DEG, PITCH_DEG]);
        bricks.name("LOW_SIDE", body, [2.0, 3.0], [10.0, 10.0]);
        bricks.name("HIGH_SIDE", body, [2.0, 3.0], [35.0, 35.0]);
        bricks.name("TIP", body, [3.0, 3.0], [10.0, 35.0]);
        bricks
    }

    /// With a wedge of some height between each blade and the next, from `low_deg` on.
    pub fn wedge_of(low_deg: f64, height: f64) -> Self {
        let mut bricks = Self::disk_and_blade();
        let body = Body::Damper;
        bricks.add(body, [2.0, 3.0], [low_deg, low_deg + 20.0], height);
        bricks.name("WEDGE", body, [2.0, 3.0], [0.0, 90.0]);
        bricks.name("FLANK", body, [2.0, 3.0], [low_deg, low_deg]);
        bricks.name("FAR", body, [2.0, 3.0], [low_deg + 20.0, low_deg + 20.0]);
        bricks.name("OUTER", body, [3.0, 3.0], [0.0, 90.0]);
        bricks.name("EDGE", body, [3.0, 3.0], [low_deg, low_deg]);
        bricks
    }

    pub fn wedge() -> Self {
        Self::wedge_of(35.0, 1.0)
    }

    fn matrix(&self, scale: f64, chosen: impl Fn(usize) -> bool) -> CartesianMatrix {
        let nodes = (1..=self.nodes.len()).filter(|&node| chosen(node));
        let rows: Vec<(usize, usize)> = nodes
            .flat_map(|node| [0, 1, 2].map(|i| (node, i)))
            .collect();
        let mut lower = Vec::new();
        for (column, &(b, j)) in rows.iter().enumerate() {
            lower.push((column, column, scale));
            for (row, &(a, i)) in rows.iter().enumerate().skip(column + 1) {
                let is_one_body = self.nodes[a - 1].0 == self.nodes[b - 1].0;
                if i == j && (is_one_body || self.tied == Some((b, a))) {
                    lower.push((row, column, -0.01 * scale));
                }
            }
        }
        CartesianMatrix { rows, lower }
    }

    /// Mesh and matrices of the nodes that are chosen.
    fn write_run(&self, folder: &Path, chosen: impl Fn(usize) -> bool) {
        let position = |[r, theta_deg, z]: [f64; 3]| {
            let (sin, cos) = theta_deg.to_radians().sin_cos();
            [r * cos, r * sin, z]
        };
        let nodes = (1..).zip(&self.nodes).filter(|(node, _)| chosen(*node));
        let nodes: BTreeMap<usize, [f64; 3]> = nodes
            .map(|(node, (_, place))| (node, position(*place)))
            .collect();
        let whole = |own: &&Vec<usize>| own.iter().all(|&node| chosen(node));
        let sets = self.sets.iter().filter(|(_, own)| whole(&own));
        let sets: Vec<(&str, Vec<usize>)> = sets.cloned().collect();
        let mut mesh = writers::calculix_deck(&nodes, &sets);
        mesh.push_str("*ELEMENT,TYPE=C3D8\n");
        for (number, element) in (1..).zip(&self.elements) {
            if element.iter().all(|&node| chosen(node)) {
                let words: Vec<String> = element.iter().map(ToString::to_string).collect();
                writeln!(mesh, "{number},{}", words.join(",")).unwrap();
            }
        }
        let is_tip = |node: usize| {
            let (body, place) = self.nodes[node - 1];
            body == Body::Blisk && place[0] > 2.5
        };
        fs::create_dir_all(folder).unwrap();
        let (stiffness, mass) = (self.matrix(100.0, &chosen), self.matrix(1.0, &chosen));
        writers::matrix_market_run(folder, &stiffness, &mass, &self.matrix(50.0, is_tip));
        fs::write(folder.join("mesh"), mesh).unwrap();
    }

    /// The files of the sector; `more` are the tables of bodies and contacts.
    pub fn write(&self, folder: &Path, more: &str) {
        self.write_run(folder, |_| true);
        fs::write(folder.join("import.toml"), Self::import_file(more)).unwrap();
    }

    /// The same with the damper in files of its own.
    fn write_apart(&self, folder: &Path, more: &str) {
        let is_damper = |node: usize| self.nodes[node - 1].0 == Body::Damper;
        self.write_run(folder, |node| !is_damper(node));
        self.write_run(&folder.join("damper"), is_damper);
        fs::write(folder.join("import.toml"), Self::import_file(more)).unwrap();
    }

    fn import_file(more: &str) -> String {
        format!(
            "code = \"calculix\"\nmatrix_format = \"matrix_market\"\nname = \"bricks\"\nsectors = {SECTORS}\n[blisk]\n{}\
             low_face = \"LOW\"\nhigh_face = \"HIGH\"\n{more}\n[[force]]\nset = \"TIP\"\ncomponent = \"z\"\n\
             [[observe]]\nname = \"tip\"\nnode = 10\n",
            writers::MATRIX_MARKET_KEYS
        )
    }

    fn imported(&self, more: &str) -> Imported {
        let folder = tempfile::tempdir().unwrap();
        self.write(folder.path(), more);
        import(&folder.path().join("import.toml")).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Radius, angle and height of the node of a side, in the sector that it is in.
    fn place(&self, side: ContactSide) -> [f64; 3] {
        let [r, theta_deg, z] = self.nodes[side.node().unwrap() - 1].1;
        match side {
            ContactSide::NextSector(_) => [r, theta_deg + PITCH_DEG, z],
            ContactSide::Node(_) | ContactSide::Ground => [r, theta_deg, z],
        }
    }
}

/// The wedge, both of its flanks and its outer side.
pub const WEDGE: &str = "[damper]
set = \"WEDGE\"
grounding_hz = 0.5
[[contact]]
first = \"blisk.HIGH_SIDE\"
second = \"damper.FLANK\"
[[contact]]
first = \"next.blisk.LOW_SIDE\"
second = \"damper.FAR\"
[[contact]]
first = \"damper.OUTER\"
second = \"ground\"
";

fn assert_close(found: [f64; 3], expected: [f64; 3], what: &ContactPair) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-12, "{what:?}: {expected:?}");
    }
}

fn weights(model: &SectorModel) -> f64 {
    model.contact_pairs.iter().map(|pair| pair.weight).sum()
}

#[test]
fn weights_are_shares_of_the_areas_of_all_contacts_and_normals_point_out_of_first_sides() {
    let bricks = Bricks::wedge();
    let imported = bricks.imported(WEDGE);
    let model = &imported.model;
    let ten = f64::to_radians(10.0);
    let outer_m2 = 6.0 * ten.sin();
    let whole_m2 = 2.0 + outer_m2;
    assert_eq!(model.contact_pairs.len(), 12);
    assert!((weights(model) - 1.0).abs() < 1e-14);
    for (at, pair) in model.contact_pairs.iter().enumerate() {
        let here = bricks.place(pair.first);
        let (area_m2, normal) = match at / 4 {
            0 => (1.0, [0.0, 1.0, 0.0]),
            1 => (1.0, [0.0, -1.0, 0.0]),
            _ => {
                let side = if here[1] < PITCH_DEG { 1.0 } else { -1.0 };
                (outer_m2, [ten.cos(), side * ten.sin(), 0.0])
            }
        };
        assert!(
            (pair.weight - 0.25 * area_m2 / whole_m2).abs() < 1e-14,
            "{pair:?}"
        );
        assert_close(pair.normal, normal, pair);
        match (at / 4, pair.first, pair.second) {
            (0, ContactSide::Node(_), ContactSide::Node(_))
            | (1, ContactSide::NextSector(_), ContactSide::Node(_)) => {
                assert_close(bricks.place(pair.second), here, pair);
            }
            (2, ContactSide::Node(_), ContactSide::Ground) => {}
            _ => panic!("{pair:?}"),
        }
    }
    let report = imported.report.contact.as_ref().unwrap();
    assert!((report.area_m2 - whole_m2).abs() < 1e-12 && report.worst_normal_angle_deg < 1e-5);
    let sides = report
        .surfaces
        .iter()
        .map(|own| (own.first.as_str(), own.second.as_str()));
    let expected = [
        ("blisk.HIGH_SIDE", "damper.FLANK"),
        ("next.blisk.LOW_SIDE", "damper.FAR"),
        ("damper.OUTER", "ground"),
    ];
    assert_eq!(sides.collect::<Vec<_>>(), expected);
    // The wedge has no faces, and is grounded by its own key.
    let damper = &imported.report.bodies[1];
    assert_eq!(
        (damper.body, damper.nodes, damper.cyclic_node_pairs),
        ("damper", 8, 0)
    );
    let omega_squared = (TAU * 0.5).powi(2);
    for (dof, value) in model.dofs.iter().zip(model.stiffness.diagonal()) {
        let springs = if dof.body == Body::Damper {
            omega_squared
        } else {
            0.0
        };
        assert!((value - 100.0 - springs).abs() < 1e-9, "{dof:?}: {value}");
    }
    let said = imported.report.to_string();
    for words in [
        "damper grounded at 0.5 Hz",
        "damper.OUTER on ground: 4 pairs",
        "contact: 12 pairs",
    ] {
        assert!(said.contains(words), "{said}");
    }
}

/// Equal weights are equal over all contacts, whatever their areas.
#[test]
fn equal_weights_and_given_normals_count_nodes() {
    let bricks = Bricks::wedge();
    let equal = WEDGE.replace("[[contact]]\n", "[[contact]]\nweights = \"equal\"\n");
    let by_area = bricks.imported(WEDGE).model;
    let model = bricks.imported(&equal).model;
    let given = ["[0, 1, 0]", "[0, -2, 0]", "[1, 0, 0]"];
    let mut parts = WEDGE.split("[[contact]]");
    let mut text = parts.next().unwrap().to_owned();
    for (normal, part) in given.into_iter().zip(parts) {
        write!(text, "[[contact]]\nnormal = {normal}{part}").unwrap();
    }
    let by_normal = bricks.imported(&text).model;
    for (at, pair) in model.contact_pairs.iter().enumerate() {
        let (other, own) = (&by_normal.contact_pairs[at], &by_area.contact_pairs[at]);
        for weight in [pair.weight, other.weight] {
            assert!((weight - 1.0 / 12.0).abs() < 1e-15, "{weight}");
        }
        assert_eq!((pair.first, pair.second), (other.first, other.second));
        assert_eq!((pair.first, pair.second), (own.first, own.second));
        assert_close(pair.normal, own.normal, pair);
        let normal = [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]][at / 4];
        assert_close(other.normal, normal, other);
    }
}

/// Within a contact areas decide, between contacts the weights that are given.
#[test]
fn contacts_share_the_sector_by_their_weights() {
    let bricks = Bricks::wedge();
    let by_area = bricks.imported(WEDGE).model;
    let given = [3.0, 1.0, 0.5];
    let mut parts = WEDGE.split("[[contact]]");
    let mut text = parts.next().unwrap().to_owned();
    for (weight, part) in given.into_iter().zip(parts) {
        write!(text, "[[contact]]\nweight = {weight:?}{part}").unwrap();
    }
    let model = bricks.imported(&text).model;
    for (at, weight) in given.into_iter().enumerate() {
        let own = &model.contact_pairs[4 * at..4 * at + 4];
        let areas = &by_area.contact_pairs[4 * at..4 * at + 4];
        let whole: f64 = areas.iter().map(|pair| pair.weight).sum();
        for (pair, area) in own.iter().zip(areas) {
            assert_eq!((pair.first, pair.second), (area.first, area.second));
            let expected = weight / 4.5 * area.weight / whole;
            assert!((pair.weight - expected).abs() < 1e-14, "{pair:?}");
        }
    }
    // With weights of their own, one contact may count nodes where another counts areas.
    let mixed = text.replacen("weight = 1.0", "weight = 1.0\nweights = \"equal\"", 1);
    let model = bricks.imported(&mixed).model;
    for pair in &model.contact_pairs[4..8] {
        assert!((pair.weight - 1.0 / 4.5 / 4.0).abs() < 1e-15, "{pair:?}");
    }
}

/// A damper under the disk, half under one sector and half under the next: on the boundary between them both halves
/// have a share in one pair.
#[test]
fn a_surface_that_ends_on_a_cut_face_goes_on_in_the_next_sector() {
    let half = 0.5 * PITCH_DEG;
    let mut bricks = Bricks::default();
    for side in [[0.0, half], [half, PITCH_DEG]] {
        bricks.add(Body::Blisk, [1.0, 3.0], side, 1.0);
    }
    for side in [[half, PITCH_DEG], [PITCH_DEG, 3.0 * half]] {
        bricks.add(Body::Damper, [0.5, 1.0], side, 1.0);
    }
    let blisk = Body::Blisk;
    bricks.name("LOW", blisk, [1.0, 3.0], [0.0, 0.0]);
    bricks.name("HIGH", blisk, [1.0, 3.0], [PITCH_DEG, PITCH_DEG]);
    bricks.name("UNDER_LOW", blisk, [1.0, 1.0], [0.0, half]);
    bricks.name("UNDER_HIGH", blisk, [1.0, 1.0], [half, PITCH_DEG]);
    bricks.name("TIP", blisk, [3.0, 3.0], [half, half]);
    bricks.name("DAMPER", Body::Damper, [0.5, 1.0], [0.0, 90.0]);
    bricks.name("TOP", Body::Damper, [1.0, 1.0], [half, PITCH_DEG]);
    bricks.name("FAR_TOP", Body::Damper, [1.0, 1.0], [PITCH_DEG, 90.0]);
    let contacts = "[damper]
set = \"DAMPER\"
[[contact]]
first = \"blisk.UNDER_HIGH\"
second = \"damper.TOP\"
[[contact]]
first = \"next.blisk.UNDER_LOW\"
second = \"damper.FAR_TOP\"
";
    let folder = tempfile::tempdir().unwrap();
    bricks.write(folder.path(), contacts);
    let path = folder.path().join("import.toml");
    let text = fs::read_to_string(&path).unwrap();
    let tip = bricks.sets.iter().find(|set| set.0 == "TIP").unwrap().1[0];
    fs::write(&path, text.replace("node = 10", &format!("node = {tip}"))).unwrap();
    // The blade's stiffness is that of nodes off the faces.
    let blade = bricks.matrix(50.0, |node| node == tip || node == tip + 4);
    fs::write(
        folder.path().join("blade.mtx"),
        writers::matrix_market(&blade),
    )
    .unwrap();
    fs::write(
        folder.path().join("blade.csv"),
        writers::dof_table(&blade, true),
    )
    .unwrap();
    let model = import(&path)
        .unwrap_or_else(|error| panic!("{error}"))
        .model;
    assert_eq!(model.contact_pairs.len(), 6);
    assert!((weights(&model) - 1.0).abs() < 1e-14);
    for pair in &model.contact_pairs {
        let (here, there) = (bricks.place(pair.first), bricks.place(pair.second));
        assert_close(here, there, pair);
        let on_boundary = (here[1] - PITCH_DEG).abs() < 1e-9;
        let expected = if on_boundary { 0.25 } else { 0.125 };
        assert!((pair.weight - expected).abs() < 1e-14, "{pair:?}");
        let is_next = here[1] > PITCH_DEG - 1e-9;
        assert_eq!(
            matches!(pair.first, ContactSide::NextSector(_)),
            is_next,
            "{pair:?}"
        );
        // Chords on both sides of the boundary: their mean is radial there.
        if on_boundary {
            assert_close(pair.normal, [-1.0, 0.0, 0.0], pair);
        }
    }
}

/// Shrouds that touch: a pair is with the next sector from whichever side it is stated.
#[test]
fn neighbouring_blades_touch_from_either_side() {
    let mut bricks = Bricks::disk_and_blade();
    bricks.add(Body::Blisk, [3.0, 4.0], [0.0, PITCH_DEG], 1.0);
    bricks.name("SHROUD_LOW", Body::Blisk, [3.0, 4.0], [0.0, 0.0]);
    bricks.name(
        "SHROUD_HIGH",
        Body::Blisk,
        [3.0, 4.0],
        [PITCH_DEG, PITCH_DEG],
    );
    let contact = |first: &str, second: &str| {
        let text = format!("[[contact]]\nfirst = \"{first}\"\nsecond = \"{second}\"\n");
        bricks.imported(&text).model.contact_pairs
    };
    let one = contact("blisk.SHROUD_HIGH", "next.blisk.SHROUD_LOW");
    let other = contact("next.blisk.SHROUD_LOW", "blisk.SHROUD_HIGH");
    assert_eq!((one.len(), other.len()), (4, 4));
    for pair in &one {
        assert_close(pair.normal, [0.0, 1.0, 0.0], pair);
        assert!(matches!(pair.second, ContactSide::NextSector(_)));
        assert_close(bricks.place(pair.first), bricks.place(pair.second), pair);
        let is_back = |own: &&ContactPair| (own.first, own.second) == (pair.second, pair.first);
        let back = other.iter().find(is_back).unwrap();
        assert_close(back.normal, [0.0, -1.0, 0.0], back);
        assert!((pair.weight - 0.25).abs() < 1e-15 && (back.weight - 0.25).abs() < 1e-15);
    }
}

/// Numbers of its nodes are raised; nothing else changes.
#[test]
fn a_damper_in_files_of_its_own_is_that_of_a_set() {
    let bricks = Bricks::wedge();
    let folder = tempfile::tempdir().unwrap();
    let own = "mesh = \"damper/mesh\"\nstiffness = \"damper/K.mtx\"\nmass = \"damper/M.mtx\"\ndofs = \"damper/dofs.csv\"\n";
    bricks.write_apart(folder.path(), &WEDGE.replace("set = \"WEDGE\"\n", own));
    let apart = import(&folder.path().join("import.toml")).unwrap();
    let together = bricks.imported(WEDGE).model;
    let offset = apart.report.bodies[1].node_offset;
    assert_eq!(offset, 100);
    let raised = |side: ContactSide| match side {
        ContactSide::Node(node) if node > 16 => ContactSide::Node(node + offset),
        other => other,
    };
    for (pair, other) in apart
        .model
        .contact_pairs
        .iter()
        .zip(&together.contact_pairs)
    {
        assert_eq!(
            (pair.first, pair.second),
            (raised(other.first), raised(other.second))
        );
        assert_eq!((pair.normal, pair.weight), (other.normal, other.weight));
    }
    assert_eq!(apart.model.stiffness, together.stiffness);
}

/// `[contact]` with `blisk` and `ring` is a list of one, to the last bit; and a ring and a damper may be in one model.
#[test]
fn a_contact_of_blisk_and_ring_is_a_list_of_one() {
    let folder = tempfile::tempdir().unwrap();
    let small = Small::calculix();
    small.write(folder.path());
    let path = folder.path().join("import.toml");
    let alone = import(&path).unwrap();
    let text = small.text("import.toml");
    let sides = "[[contact]]\nfirst = \"blisk.IN\"\nsecond = \"ring.OUT\"";
    let listed = text.replace("[contact]\nblisk = \"IN\"\nring = \"OUT\"", sides);
    for other in [
        text.replace("[contact]", "[[contact]]"),
        listed.clone(),
        listed.replace("[[contact]]", "[contact]"),
        listed.replace("blisk.IN", "blisk.in"),
    ] {
        assert_ne!(text, other);
        fs::write(&path, other).unwrap();
        let other = import(&path).unwrap();
        assert_eq!(alone.model, other.model);
    }
    // A ring under the disk beside the wedge.
    let mut bricks = Bricks::wedge();
    bricks.add(Body::Ring, [0.5, 1.0], [0.0, PITCH_DEG], 1.0);
    let ring = Body::Ring;
    bricks.name("RING", ring, [0.5, 1.0], [0.0, PITCH_DEG]);
    bricks.name("RING_LOW", ring, [0.5, 1.0], [0.0, 0.0]);
    bricks.name("RING_HIGH", ring, [0.5, 1.0], [PITCH_DEG, PITCH_DEG]);
    bricks.name("RING_TOP", ring, [1.0, 1.0], [0.0, PITCH_DEG]);
    bricks.name("BORE", Body::Blisk, [1.0, 1.0], [0.0, PITCH_DEG]);
    let both = format!(
        "[ring]\nset = \"RING\"\nlow_face = \"RING_LOW\"\nhigh_face = \"RING_HIGH\"\n{WEDGE}\
         [[contact]]\nfirst = \"blisk.BORE\"\nsecond = \"ring.RING_TOP\"\n"
    );
    let imported = bricks.imported(&both);
    let bodies: Vec<&str> = imported.report.bodies.iter().map(|own| own.body).collect();
    assert_eq!(bodies, ["blisk", "ring", "damper"]);
    let pairs = &imported.model.contact_pairs;
    assert_eq!(pairs.len(), 14);
    assert!((weights(&imported.model) - 1.0).abs() < 1e-14);
    // Nodes of the high face are those of the low one: two pairs have the area of four nodes.
    let chord = 2.0 * f64::to_radians(0.5 * PITCH_DEG).sin();
    let whole = 2.0 + 6.0 * f64::to_radians(10.0).sin() + chord;
    for pair in &pairs[12..] {
        assert!(pair.normal[0] < -0.9 && (pair.weight - 0.5 * chord / whole).abs() < 1e-14);
    }
}
