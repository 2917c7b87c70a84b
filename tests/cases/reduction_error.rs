//! The error of `stick_slide` on mistuned wheels, against rows on tuned receptances.

use std::collections::BTreeMap;

use blisk::model::reduction::Basis;
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::study::Study;
use rayon::prelude::*;

use super::support::{Case, package};

/// Of the blades' relative stiffness.
const STANDARD_DEVIATION: f64 = 0.03;

type Column = fn(&ResponseRow) -> Option<f64>;

/// A wheel with the loads it is compared under.
struct Wheel {
    name: &'static str,
    model: &'static str,
    tangential_stiffness: f64,
    normal_stiffness: f64,
    loads: &'static [f64],
    harmonics: &'static [u32],
    patterns: u32,
}

const THICK_RING: Wheel = Wheel {
    name: "thick ring",
    model: "source = \"parametric\"\nparametric = { sectors = 9, blade_height_m = 0.05, ring_thickness_m = 0.009, ring_axial_width_m = 0.010, rim_thickness_m = 0.012 }",
    tangential_stiffness: 5e8,
    normal_stiffness: 5e8,
    loads: &[200.0, 400.0, 800.0],
    harmonics: &[1],
    patterns: 2,
};

const SOFT_CONTACT: Wheel = Wheel {
    name: "soft contact",
    model: "source = \"parametric\"\nparametric = { sectors = 10, blade_height_m = 0.06, disk_thickness_m = 0.004, rim_thickness_m = 0.012 }",
    tangential_stiffness: 2e7,
    normal_stiffness: 4e7,
    loads: &[50.0, 100.0, 200.0],
    harmonics: &[1],
    patterns: 2,
};

const WHEELS: [Wheel; 6] = [
    Wheel {
        name: "wheel8",
        model: "source = \"bundle\"\nbundle = { path = \"../tests/data/wheel8\" }",
        tangential_stiffness: 4e8,
        normal_stiffness: 8e8,
        loads: &[200.0, 400.0, 1600.0],
        harmonics: &[1],
        patterns: 2,
    },
    Wheel {
        name: "wheel8 {1,3}",
        model: "source = \"bundle\"\nbundle = { path = \"../tests/data/wheel8\" }",
        tangential_stiffness: 4e8,
        normal_stiffness: 8e8,
        loads: &[200.0, 400.0, 1600.0],
        harmonics: &[1, 3],
        patterns: 1,
    },
    Wheel {
        name: "wheel24",
        model: "source = \"bundle\"\nbundle = { path = \"../tests/data/wheel24\" }",
        tangential_stiffness: 1e8,
        normal_stiffness: 2e8,
        loads: &[160.0, 320.0, 1280.0],
        harmonics: &[1],
        patterns: 1,
    },
    Wheel {
        name: "thin ring",
        model: "source = \"parametric\"\nparametric = { sectors = 12, blade_height_m = 0.1, ring_thickness_m = 0.003, disk_thickness_m = 0.004 }",
        tangential_stiffness: 1e8,
        normal_stiffness: 1e8,
        loads: &[100.0, 200.0, 800.0],
        harmonics: &[1],
        patterns: 2,
    },
    THICK_RING,
    SOFT_CONTACT,
];

impl Wheel {
    fn case(&self, reduction: &str) -> Case {
        let Self {
            model,
            loads,
            tangential_stiffness: kt,
            normal_stiffness: kn,
            harmonics,
            ..
        } = self;
        // One Craig-Bampton model for all bases of a table.
        let modes = if reduction.contains("craig_bampton_modes") {
            ""
        } else {
            "craig_bampton_modes = 25"
        };
        let text = format!(
            r#"schema = 1
study = {{ name = "reduction-error", seed = 20240917, patterns = 10 }}
excitation = {{ engine_orders = [3], amplitude_n = 1.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ distribution = {{ kind = "normal" }} }}
sweep = {{ normal_load_n = {loads:?}, standard_deviation = [{STANDARD_DEVIATION}] }}

[model]
{model}

[reduction]
{modes}
{reduction}

[contact]
law = "simplified_3d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = {kt:e}
normal_stiffness_n_per_m = {kn:e}

[solver]
harmonics = {harmonics:?}
samples_per_period = 256
peak_tolerance = 1e-5
"#
        );
        Case::new(Study::parse(&package("studies/reduction-error.toml"), &text).unwrap())
    }
}

/// Errors of one basis, all relative.
struct Measured {
    basis: String,
    /// Of the tuned peak, which the program measures on one sector.
    tuned_peak: f64,
    /// Of the mistuned peaks under each load, largest over patterns.
    amplitudes: Vec<f64>,
    /// Largest over all of them.
    frequency: f64,
}

impl Measured {
    /// The largest error of a mistuned peak.
    fn amplitude(&self) -> f64 {
        self.amplitudes.iter().copied().fold(0.0, f64::max)
    }
}

fn stick_slide(modes: usize) -> String {
    format!("basis = \"stick_slide\"\nstick_modes = {modes}\nslide_modes = {modes}")
}

/// Nothing left out: no basis has more modes than there are.
const WHOLE: &str = "basis = \"stick_slide\"\nstick_modes = 1000\nslide_modes = 1";

/// Every pattern under every load.
fn rows(wheel: &Wheel, case: &Case) -> Vec<ResponseRow> {
    let jobs: Vec<(u32, f64)> = (0..wheel.patterns)
        .flat_map(|id| wheel.loads.iter().map(move |&load| (id, load)))
        .collect();
    jobs.par_iter()
        .map(|&(id, normal_load_n)| {
            let contact = ContactCondition::Full { normal_load_n };
            let pattern = case.pattern(id, Some(STANDARD_DEVIATION));
            case.row(&pattern, contact, &case.tuned(contact))
        })
        .collect()
}

/// Largest relative difference of a column.
fn worst(own: &[ResponseRow], reference: &[ResponseRow], column: Column) -> f64 {
    own.iter()
        .zip(reference)
        .map(|(own, reference)| (column(own).unwrap() / column(reference).unwrap() - 1.0).abs())
        .fold(0.0, f64::max)
}

/// Rows on tuned receptances.
fn reference(wheel: &Wheel) -> Vec<ResponseRow> {
    let reference = rows(wheel, &wheel.case("basis = \"tuned_receptances\""));
    let closed = |row: &ResponseRow| row.separated_fraction.unwrap() < 0.05;
    assert!(reference.iter().all(closed));
    reference
}

fn measure(wheel: &Wheel, reduction: &str, reference: &[ResponseRow]) -> Measured {
    let case = wheel.case(reduction);
    let facts = case.reduction();
    let tried = facts["tuned_peak_errors"].as_array().unwrap();
    let taken = tried.last().unwrap();
    let rows = rows(wheel, &case);
    let under = |load: usize| {
        let of = |rows: &[ResponseRow]| -> Vec<ResponseRow> {
            let of_load = rows.iter().skip(load).step_by(wheel.loads.len());
            of_load.cloned().collect()
        };
        worst(&of(&rows), &of(reference), |row| row.peak_amplitude_m)
    };
    Measured {
        basis: taken["basis"].as_str().unwrap().to_owned(),
        tuned_peak: taken["error"].as_f64().unwrap(),
        amplitudes: (0..wheel.loads.len()).map(under).collect(),
        frequency: worst(&rows, reference, |row| row.peak_frequency_hz),
    }
}

/// A table of docs/reduction-error.md: the cells after the first two of each row, by those two.
fn documented(header: &str) -> BTreeMap<[String; 2], Vec<f64>> {
    let page = std::fs::read_to_string(package("docs/reduction-error.md")).unwrap();
    let rows = page.lines().skip_while(|line| *line != header).skip(2);
    let rows = rows.take_while(|line| line.starts_with('|'));
    rows.map(|line| {
        let mut cells = line.trim_matches('|').split('|').map(str::trim);
        let mut name = || cells.next().unwrap().to_owned();
        let names = [name(), name()];
        (names, cells.map(|cell| cell.parse().unwrap()).collect())
    })
    .collect()
}

/// Rows as they are found, held against a table of the page at the end: each is printed as the page has to have it.
struct Table {
    page: BTreeMap<[String; 2], Vec<f64>>,
    digits: &'static [usize],
    rows: usize,
    wrong: Vec<String>,
}

impl Table {
    fn new(header: &str, digits: &'static [usize]) -> Self {
        Self {
            page: documented(header),
            digits,
            rows: 0,
            wrong: Vec::new(),
        }
    }

    /// The numbers of a row are those of the page to its last digit, or to 2 % where that is more.
    fn hold(&mut self, row: &[String; 2], found: &[f64]) {
        let cells = found.iter().zip(self.digits);
        let cells: Vec<String> = cells
            .map(|(own, &digits)| format!("{own:.digits$}"))
            .collect();
        let line = format!("| {} | {} | {} |", row[0], row[1], cells.join(" | "));
        println!("{line}");
        let written = self.page.get(row).map_or(&[][..], Vec::as_slice);
        let agrees = |((found, written), digits): ((&f64, &f64), &usize)| {
            let last_digit = 1.001 * 10.0_f64.powi(-(*digits as i32));
            (found - written).abs() <= f64::max(0.02 * written, last_digit)
        };
        let pairs = || found.iter().zip(written).zip(self.digits);
        if written.len() != found.len() || !pairs().all(agrees) {
            self.wrong.push(format!("{line}; the page: {written:?}"));
        }
        self.rows += 1;
    }

    fn assert_is_that_of_the_page(&self) {
        assert!(self.wrong.is_empty(), "{}", self.wrong.join("\n"));
        assert_eq!(self.rows, self.page.len());
    }
}

#[test]
#[ignore = "about 4 minutes: the table of docs/reduction-error.md"]
fn the_table_of_reduction_errors_is_that_of_the_page() {
    let mut table = Table::new(
        "| wheel | basis | tuned peak | lightest load | middle | heaviest | frequency |",
        &[3, 3, 3, 3, 4],
    );
    for wheel in &WHEELS {
        let reference = reference(wheel);
        for modes in [2, 4, 6, 8, 10] {
            let found = measure(wheel, &stick_slide(modes), &reference);
            let errors = std::iter::once(found.tuned_peak).chain(found.amplitudes);
            let numbers: Vec<f64> = errors
                .chain([found.frequency])
                .map(|share| 100.0 * share)
                .collect();
            table.hold(&[wheel.name.to_owned(), found.basis], &numbers);
        }
    }
    table.assert_is_that_of_the_page();
}

#[test]
#[ignore = "about 1 minute: the table of fixed-interface modes of docs/reduction-error.md"]
fn the_table_of_fixed_interface_modes_is_that_of_the_page() {
    let mut table = Table::new("| wheel | modes | reach | tuned peak, % |", &[1, 3]);
    for wheel in &WHEELS {
        let case = |modes: usize| wheel.case(&format!("craig_bampton_modes = {modes}\n{WHOLE}"));
        let tuned = |case: &Case| -> Vec<f64> {
            let at = |&normal_load_n| case.tuned(ContactCondition::Full { normal_load_n });
            wheel
                .loads
                .iter()
                .map(|load| at(load).amplitude_m.unwrap())
                .collect()
        };
        let reference = tuned(&case(80));
        for modes in [3, 5, 8, 12, 25, 38] {
            let case = case(modes);
            let error = tuned(&case)
                .iter()
                .zip(&reference)
                .map(|(own, reference)| (own / reference - 1.0).abs())
                .fold(0.0, f64::max);
            let reach = case.reduction()["craig_bampton_reach"].as_f64().unwrap();
            let row = [wheel.name.to_owned(), modes.to_string()];
            let numbers = [reach, 100.0 * error];
            table.hold(&row, &numbers);
        }
    }
    table.assert_is_that_of_the_page();
}

/// Tuned receptances leave out nothing of the contact: their rows are those of the whole space of a model with so many more
/// fixed-interface modes that it needs no residual vectors.
fn without_a_basis(wheel: &Wheel) {
    let own = rows(wheel, &wheel.case("basis = \"tuned_receptances\""));
    let whole = format!("craig_bampton_modes = 120\n{WHOLE}");
    let reference = rows(wheel, &wheel.case(&whole));
    let amplitude = worst(&own, &reference, |row| row.peak_amplitude_m);
    let frequency = worst(&own, &reference, |row| row.peak_frequency_hz);
    println!("tuned receptances: amplitude {amplitude:.1e}, frequency {frequency:.1e}");
    assert!(amplitude < 3e-3 && frequency < 2e-4);
}

#[test]
fn more_modes_of_stick_slide_bring_rows_nearer_to_those_on_tuned_receptances() {
    let wheel = Wheel {
        loads: &[200.0, 400.0],
        patterns: 1,
        ..THICK_RING
    };
    let reference = reference(&wheel);
    let found = [4, 6, 10].map(|modes| measure(&wheel, &stick_slide(modes), &reference));
    for pair in found.windows(2) {
        assert!(pair[1].tuned_peak < pair[0].tuned_peak);
        assert!(pair[1].amplitude() < pair[0].amplitude());
    }
    assert!(found[0].amplitude() > 0.02 && found[2].amplitude() < 0.002);
    without_a_basis(&wheel);
}

/// A mode is missing in a nodal diameter that the tuned peak does not move in.
#[test]
fn the_tuned_peak_does_not_show_what_stick_slide_leaves_out_of_a_mistuned_wheel() {
    let wheel = Wheel {
        loads: &[50.0, 200.0],
        patterns: 1,
        ..SOFT_CONTACT
    };
    let missing = measure(&wheel, &stick_slide(6), &reference(&wheel));
    assert!(missing.tuned_peak < 1e-3 && missing.amplitude() > 0.05);
    without_a_basis(&wheel);
}

/// The study that ships says physics only, and states nothing that is not so.
#[test]
fn the_quickstart_warns_of_nothing_that_is_not_so() {
    let mut study = Study::read(&package("studies/quickstart.toml")).unwrap();
    let normal_load_n = 320.0;
    let contact = ContactCondition::Full { normal_load_n };
    study.contacts = vec![contact];
    study.solver.peak_tolerance = 1e-4;
    let shipped = Case::new(study.clone());
    let warnings = shipped.warnings();
    assert!(warnings.is_empty(), "{warnings:?}");
    let row_of = |case: &Case| {
        let pattern = case.pattern(0, Some(STANDARD_DEVIATION));
        case.row(&pattern, contact, &case.tuned(contact))
    };
    let own = row_of(&shipped);
    assert_eq!(own.basis, "tuned_receptances");
    // The same harmonics with 20 vectors per nodal diameter.
    let set = own.harmonics.split('-').map(|k| k.parse().unwrap());
    study.solver.harmonics = Harmonics::Set(set.collect());
    study.reduction.basis = Basis::StickSlide;
    (study.reduction.stick_modes, study.reduction.slide_modes) = (Some(10), Some(10));
    let fine = row_of(&Case::new(study));
    let error = own.peak_amplitude_m.unwrap() / fine.peak_amplitude_m.unwrap() - 1.0;
    println!("{}: {error:.1e}", own.harmonics);
    assert!(error.abs() < 5e-3, "{error}");
    assert!(own.stated_error.unwrap() < 0.01);
}
