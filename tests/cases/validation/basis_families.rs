//! The two-family basis of the paper against either family alone, at the same number of vectors.

use blisk::model::reduction::Basis;
use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::study::Study;

use super::super::support::{Case, package};
use super::{Section, percent, table};

pub(super) fn section() -> Section {
    let mut rows = Vec::new();
    for (wheel, loads) in [
        ("wheel8", [200.0, 400.0, 1600.0]),
        ("wheel24", [160.0, 320.0, 1280.0]),
    ] {
        let reference = peaks(wheel, Basis::StickAttachment, 12, None, loads);
        for vectors in [4, 8, 12] {
            let families = [(vectors / 2, vectors / 2), (vectors, 0), (0, vectors)];
            let errors = families.map(|(stick, slide)| {
                let found = peaks(wheel, Basis::StickSlide, stick, Some(slide), loads);
                worst_error(&found, &reference)
            });
            let mut row = vec![wheel.to_owned(), vectors.to_string()];
            row.extend(errors);
            rows.push(row);
        }
    }
    let header = [
        "model",
        "vectors per nodal diameter",
        "stick and slide, half each",
        "stick alone",
        "slide alone",
    ];
    let text = format!(
        "Worst error of the peak amplitude over the tuned wheel, one mistuned pattern and three normal loads (one harmonic), against \
         `stick_attachment` with 12 stick modes.\n\n{}",
        table(&header, &rows)
    );
    Section {
        title: "Two families of modes against either alone",
        text,
    }
}

/// Peak amplitudes, m, of the tuned wheel and of pattern 1 under each load; none where not found.
fn peaks(
    wheel: &str,
    basis: Basis,
    stick: usize,
    slide: Option<usize>,
    loads: [f64; 3],
) -> Vec<Option<f64>> {
    let mut study = Study::read(&package(&format!("studies/validation/{wheel}.toml"))).unwrap();
    study.solver.harmonics = Harmonics::Set(vec![1]);
    study.reduction.basis = basis;
    study.reduction.stick_modes = Some(stick);
    study.reduction.slide_modes = slide;
    let case = Case::new(study);
    let pattern = case.pattern(1, None);
    loads
        .into_iter()
        .flat_map(|normal_load_n| {
            let contact = ContactCondition::Full { normal_load_n };
            let tuned = case.tuned(contact);
            [
                tuned.amplitude_m,
                case.row(&pattern, contact, &tuned).peak_amplitude_m,
            ]
        })
        .collect()
}

fn worst_error(found: &[Option<f64>], reference: &[Option<f64>]) -> String {
    let mut errors = found
        .iter()
        .zip(reference)
        .map(|(found, reference)| Some(((*found)? / (*reference)? - 1.0).abs()));
    let worst = errors.try_fold(0.0, |worst: f64, error| Some(worst.max(error?)));
    worst.map_or_else(|| "a peak was not found".to_owned(), percent)
}
