//! The two-family basis of the paper against either family alone, at the same number of vectors.

use blisk::model::reduction::Basis;
use blisk::response::forced_response::ContactCondition;
use rayon::prelude::*;

use super::super::support::Case;
use super::models::reference_wheel;
use super::report::{Section, Verdict, percent, table};

/// Vectors per nodal diameter, both families together.
const SIZES: [usize; 3] = [4, 8, 12];
/// Stick modes of the basis that the others are held against.
const REFERENCE_MODES: usize = 12;

/// A basis of a nodal diameter.
#[derive(Clone, Copy)]
enum Choice {
    Modes { stick: usize, slide: usize },
    Attachment { stick: usize },
}

/// Worst errors of the bases of one size, none where a peak was not found.
struct Compared {
    wheel: &'static str,
    vectors: usize,
    both: Option<f64>,
    stick: Option<f64>,
    slide: Option<f64>,
    attachment: Option<f64>,
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
                shown(row.attachment),
            ]
        })
        .collect();
    let header = [
        "wheel",
        "vectors per nodal diameter",
        "stick and slide, half each",
        "stick alone",
        "slide alone",
        "half as many stick modes, and attachment vectors",
    ];
    Section {
        compared: format!(
            "Worst error of the peak amplitude over the tuned wheel, pattern 1 and three normal loads without separation (harmonic 1, 128 samples), \
             against `stick_attachment` with {REFERENCE_MODES} stick modes. The last column is `stick_attachment`, which has one vector per contact \
             direction more (12 on wheel8, 18 on wheel24) and is no basis of the same size."
        ),
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
    let attachment = rows.iter().map(|row| row.attachment.unwrap_or(f64::NAN));
    vec![
        Verdict::claim(
            "both-families",
            format!(
                "stick and slide modes together are more accurate than as many of either family: in {better} of {} sizes",
                rows.len()
            ),
            better == rows.len(),
        ),
        Verdict::at_most(
            "stick-attachment",
            "stick_attachment, any size",
            attachment,
            2e-3,
        ),
    ]
}

fn of_wheel(wheel: &'static str, loads: [f64; 3]) -> Vec<Compared> {
    let reference = Choice::Attachment {
        stick: REFERENCE_MODES,
    };
    let mut choices = vec![reference];
    for vectors in SIZES {
        choices.extend([
            Choice::Modes {
                stick: vectors / 2,
                slide: vectors / 2,
            },
            Choice::Modes {
                stick: vectors,
                slide: 0,
            },
            Choice::Modes {
                stick: 0,
                slide: vectors,
            },
            Choice::Attachment { stick: vectors / 2 },
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
        .zip(errors.chunks(4))
        .map(|(&vectors, errors)| Compared {
            wheel,
            vectors,
            both: errors[0],
            stick: errors[1],
            slide: errors[2],
            attachment: errors[3],
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
    ) = match choice {
        Choice::Modes { stick, slide } => (Basis::StickSlide, Some(stick), Some(slide)),
        Choice::Attachment { stick } => (Basis::StickAttachment, Some(stick), None),
    };
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
