//! The two-family basis of the paper against either family alone, at the same number of vectors.

use blisk::model::reduction::Basis;
use blisk::response::forced_response::ContactCondition;
use rayon::prelude::*;

use super::super::support::Case;
use super::models::reference_wheel;
use super::report::{Section, Verdict, percent, table};

/// Vectors per nodal diameter, both families together.
const SIZES: [usize; 3] = [4, 8, 12];
/// Stick modes of the basis that the others are held against: more than there are, so that it is the whole space.
const REFERENCE_MODES: usize = 1000;

/// A basis of a nodal diameter.
#[derive(Clone, Copy)]
struct Choice {
    stick: usize,
    slide: usize,
}

/// Worst errors of the bases of one size, none where a peak was not found.
struct Compared {
    wheel: &'static str,
    vectors: usize,
    both: Option<f64>,
    stick: Option<f64>,
    slide: Option<f64>,
}

pub fn section() -> Section {
    let wheels = [
        ("wheel8", [200.0, 400.0, 1600.0]),
        ("wheel24", [160.0, 320.0, 1280.0]),
    ];
    let rows: Vec<Compared> = wheels
        .par_iter()
        .with_max_len(1)
        .flat_map_iter(|&(wheel, loads)| of_wheel(wheel, loads))
        .collect();
    let shown =
        |error: Option<f64>| error.map_or_else(|| "a peak was not found".to_owned(), percent);
    let cells: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            vec![
                row.wheel.to_owned(),
                row.vectors.to_string(),
                shown(row.both),
                shown(row.stick),
                shown(row.slide),
            ]
        })
        .collect();
    let header = [
        "wheel",
        "vectors per nodal diameter",
        "stick and slide, half each",
        "stick alone",
        "slide alone",
    ];
    Section {
        compared:
            "Worst error of the peak amplitude over the tuned wheel, pattern 1 and three normal loads without separation (harmonic 1, 128 samples), \
             against the whole space of 25 fixed-interface modes."
            .to_owned(),
        body: table(&header, &cells),
        verdicts: verdicts(&rows),
    }
}

fn verdicts(rows: &[Compared]) -> Vec<Verdict> {
    let better = rows.iter().filter(|row| {
        let other = |error: Option<f64>| error.unwrap_or(f64::INFINITY);
        row.both
            .is_some_and(|both| both < other(row.stick) && both < other(row.slide))
    });
    let better = better.count();
    vec![Verdict::claim(
        "both-families",
        format!(
            "stick and slide modes together are more accurate than as many of either family: in {better} of {} sizes",
            rows.len()
        ),
        better == rows.len(),
    )]
}

fn of_wheel(wheel: &'static str, loads: [f64; 3]) -> Vec<Compared> {
    let reference = Choice {
        stick: REFERENCE_MODES,
        slide: 1,
    };
    let mut choices = vec![reference];
    for vectors in SIZES {
        choices.extend([
            Choice {
                stick: vectors / 2,
                slide: vectors / 2,
            },
            Choice {
                stick: vectors,
                slide: 0,
            },
            Choice {
                stick: 0,
                slide: vectors,
            },
        ]);
    }
    let found: Vec<Vec<Option<f64>>> = choices
        .par_iter()
        .with_max_len(1)
        .map(|choice| peaks(wheel, *choice, loads))
        .collect();
    let errors: Vec<Option<f64>> = found[1..]
        .iter()
        .map(|found_peaks| worst_error(found_peaks, &found[0]))
        .collect();
    SIZES
        .iter()
        .zip(errors.chunks(3))
        .map(|(&vectors, errors)| Compared {
            wheel,
            vectors,
            both: errors[0],
            stick: errors[1],
            slide: errors[2],
        })
        .collect()
}

/// Peak amplitudes, m, of the tuned wheel and of pattern 1 under each load; none where not found.
fn peaks(wheel: &str, choice: Choice, loads: [f64; 3]) -> Vec<Option<f64>> {
    let mut study = reference_wheel(wheel, &loads, Some(&[1]));
    study.solver.peak_tolerance = 1e-4;
    (
        study.reduction.basis,
        study.reduction.stick_modes,
        study.reduction.slide_modes,
    ) = (Basis::StickSlide, Some(choice.stick), Some(choice.slide));
    let case = Case::new(study);
    let pattern = case.pattern(1, None);
    loads
        .par_iter()
        .with_max_len(1)
        .flat_map_iter(|&normal_load_n| {
            let contact = ContactCondition::Full { normal_load_n };
            let tuned = case.tuned(contact);
            [
                tuned.amplitude_m,
                case.row(&pattern, contact, &tuned).peak_amplitude_m,
            ]
        })
        .collect()
}

fn worst_error(found: &[Option<f64>], reference: &[Option<f64>]) -> Option<f64> {
    let mut errors = found
        .iter()
        .zip(reference)
        .map(|(found, reference)| Some(((*found)? / (*reference)? - 1.0).abs()));
    errors.try_fold(0.0, |worst: f64, error| Some(worst.max(error?)))
}
