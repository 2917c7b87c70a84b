//! The three contact laws over the loads of the wheel of 24 blades, and a ring that creeps.

use blisk::response::forced_response::ContactCondition;
use blisk::response::friction::{ContactLaw, Ring};
use blisk::study::Study;
use rayon::prelude::*;

use super::super::support::Case;
use super::models::{Amplitude, reference_wheel, shown};
use super::report::{Section, Verdict, percent, signed_percent, table, worst};

/// Laws, the full one first: the others are documented simplifications of it.
const LAWS: [ContactLaw; 3] = [
    ContactLaw::Coulomb3d,
    ContactLaw::Simplified3d,
    ContactLaw::MacroSlip1d,
];
const LOADS_N: [f64; 6] = [160.0, 240.0, 320.0, 480.0, 640.0, 1280.0];
/// What counts as a small change of the peak.
const NEAR: f64 = 0.03;
/// At which pattern 1 is solved too.
const MISTUNED_LOADS_N: [f64; 3] = [160.0, 320.0, 1280.0];

pub fn section() -> Section {
    let (laws, rings) = rayon::join(of_laws, of_rings);
    let header = [
        "pattern",
        "load per sector, N",
        "coulomb_3d, µm",
        "simplified_3d, µm",
        "change",
        "macro_slip_1d, µm",
        "change",
    ];
    let cells: Vec<Vec<String>> = laws
        .iter()
        .map(|(pattern, load, [coulomb, simplified, slip])| {
            vec![
                (*pattern).to_owned(),
                format!("{load}"),
                shown(*coulomb),
                shown(*simplified),
                shown_change(*simplified, *coulomb),
                shown(*slip),
                shown_change(*slip, *coulomb),
            ]
        })
        .collect();
    let ring_header = [
        "wheel",
        "load per sector, N",
        "locked, µm",
        "creeping, µm",
        "change",
    ];
    let ring_cells: Vec<Vec<String>> = rings
        .iter()
        .map(|(wheel, load, [locked, creeping])| {
            vec![
                (*wheel).to_owned(),
                format!("{load}"),
                shown(*locked),
                shown(*creeping),
                shown_change(*creeping, *locked),
            ]
        })
        .collect();
    Section {
        compared: "Peaks of wheel24 with harmonics 1 and 3 and the basis `auto` takes for each law, peak tolerance 1e-4; change against `coulomb_3d`, the \
                   law with the friction circle. Below, tuned wheels with `simplified_3d`, harmonics 1 and 3, and a ring that something holds or that \
                   gives way to mean friction. The third column of either table is the fuller model, the others show what a simplification costs."
            .to_owned(),
        body: table(&header, &cells) + "\n" + &table(&ring_header, &ring_cells),
        verdicts: verdicts(&laws, &rings),
    }
}

/// Tuned wheel or pattern, load, peak under each law.
type OfLaws = (&'static str, f64, [Amplitude; 3]);
/// Wheel, load, peak with a locked and with a creeping ring.
type OfRings = (&'static str, f64, [Amplitude; 2]);

fn verdicts(laws: &[OfLaws], rings: &[OfRings]) -> Vec<Verdict> {
    let solved = laws.iter().flat_map(|(_, _, found)| found.iter());
    let solved = solved.chain(rings.iter().flat_map(|(_, _, found)| found.iter()));
    let of_simplified = laws.iter().map(|(_, _, found)| change(found[1], found[0]));
    let of_macro_slip = laws.iter().map(|(_, _, found)| change(found[2], found[0]));
    let of_creep = rings.iter().map(|(_, _, found)| change(found[1], found[0]));
    vec![
        Verdict::share("peaks-found", "peaks found", solved.map(Result::is_ok), 1.0),
        stays_near("simplified_3d", of_simplified),
        stays_near("macro_slip_1d", of_macro_slip),
        stays_near("a creeping ring", of_creep),
    ]
}

/// That a simplification changes the peaks that were found by little.
fn stays_near(what: &str, changes: impl Iterator<Item = f64>) -> Verdict {
    let (worst, count) = worst(changes.map(f64::abs).filter(|change| !change.is_nan()));
    Verdict::claim(
        &what.replace([' ', '_'], "-"),
        format!(
            "{what} changes the peak by at most {}: {} at worst of {count}",
            percent(NEAR),
            percent(worst)
        ),
        count > 0 && worst <= NEAR,
    )
}

fn change(own: Amplitude, other: Amplitude) -> f64 {
    match (own, other) {
        (Ok(own), Ok(other)) => own / other - 1.0,
        _ => f64::NAN,
    }
}

fn shown_change(own: Amplitude, other: Amplitude) -> String {
    let change = change(own, other);
    if change.is_nan() {
        "-".to_owned()
    } else {
        signed_percent(change)
    }
}

fn study(wheel: &str, loads: &[f64], law: ContactLaw, ring: Ring) -> Study {
    let mut study = reference_wheel(wheel, loads, Some(&[1, 3]));
    study.solver.peak_tolerance = 1e-4;
    let contact = study.contact.as_mut().unwrap();
    (contact.law, contact.ring) = (law, ring);
    study
}

/// Tuned wheel and pattern 1, load, peak under each law.
fn of_laws() -> Vec<OfLaws> {
    let places: Vec<(&'static str, f64)> = LOADS_N
        .map(|load| ("tuned", load))
        .into_iter()
        .chain(MISTUNED_LOADS_N.map(|load| ("1", load)))
        .collect();
    let peaks: Vec<Vec<Amplitude>> = LAWS
        .par_iter()
        .with_max_len(1)
        .map(|&law| {
            let case = Case::new(study("wheel24", &LOADS_N, law, Ring::Locked));
            let solve = |&(pattern, normal_load_n): &(&str, f64)| {
                let contact = ContactCondition::Full { normal_load_n };
                let tuned = case.tuned(contact);
                if pattern == "tuned" {
                    return tuned.amplitude_m.ok_or(tuned.status);
                }
                let row = case.row(&case.pattern(1, None), contact, &tuned);
                row.peak_amplitude_m.ok_or(row.status)
            };
            places.par_iter().with_max_len(1).map(solve).collect()
        })
        .collect();
    places
        .iter()
        .enumerate()
        .map(|(at, &(pattern, load))| (pattern, load, [0, 1, 2].map(|law| peaks[law][at])))
        .collect()
}

/// Tuned wheels: wheel, load, peak with a locked and with a creeping ring.
fn of_rings() -> Vec<OfRings> {
    let wheels = [
        ("wheel8", [200.0, 400.0, 1600.0]),
        ("wheel24", [160.0, 320.0, 1280.0]),
    ];
    wheels
        .par_iter()
        .with_max_len(1)
        .flat_map_iter(|&(wheel, loads)| {
            let peaks = [Ring::Locked, Ring::Creeping].map(|ring| {
                let case = Case::new(study(wheel, &loads, ContactLaw::Simplified3d, ring));
                loads.map(|normal_load_n| {
                    let tuned = case.tuned(ContactCondition::Full { normal_load_n });
                    tuned.amplitude_m.ok_or(tuned.status)
                })
            });
            let rows = loads.into_iter().enumerate();
            rows.map(move |(at, load)| (wheel, load, [peaks[0][at], peaks[1][at]]))
                .collect::<Vec<_>>()
        })
        .collect()
}
