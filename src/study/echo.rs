//! A study in words, from the study file and its sector model.

use super::excitation::excitations;
use super::{MistuningSource, Study};
use crate::linalg::Complex64;
use crate::model::cyclic::nodal_diameter_of;
use crate::model::sector::{Component, SectorModel};
use crate::population::monte_carlo::sampling_tolerance;
use crate::population::statistics::{CONFIDENCE, smallest_sample};
use crate::report::{
    EchoedExcitation, EchoedLoad, EchoedModel, Remark, RowTolerance, StudyEcho, Travel, basis_words,
};
use crate::response::forced_response::Harmonics;
use crate::response::harmonic_balance::Damping;

/// Friction limit over the force at resonance from which on no pair is likely to slip.
const STICKS: f64 = 10.0;
/// Friction limit over the force below which friction hardly counts.
const SLIDES: f64 = 1e-3;
/// Standard deviation of the blades' stiffness that is large for a wheel.
const LARGE_DEVIATION: f64 = 0.1;
/// Percentiles of the report.
const REPORTED: [u32; 2] = [95, 99];

/// `study` on the sector `sector`, in words.
#[must_use]
pub fn echo(study: &Study, sector: &SectorModel) -> StudyEcho {
    let scenarios = study.scenarios();
    let friction = scenarios
        .iter()
        .filter(|scenario| scenario.contact.normal_load_n().is_some());
    let patterns = u64::from(study.patterns);
    let sectors = sector.sectors;
    let excitations = echoed_excitations(study, sector);
    StudyEcho {
        name: study.name.clone(),
        patterns,
        seed: study.seed,
        model: EchoedModel {
            name: sector.name.clone(),
            sectors,
            sector_dofs: sector.dofs.len(),
            contact_pairs: sector.contact_pairs.len(),
        },
        mistuning: mistuning(study),
        contact: contact(study),
        loads: study
            .contacts
            .iter()
            .map(|condition| EchoedLoad {
                contact: condition.name(),
                normal_load_n: condition.normal_load_n(),
                wheel_load_n: condition.normal_load_n().map(|load| load * sectors as f64),
            })
            .collect(),
        damping: damping(study),
        settings: settings(study),
        scenarios: scenarios.len() as u64,
        rows: scenarios.len() as u64 * patterns,
        friction_rows: friction.count() as u64 * patterns,
        remarks: remarks(study, sector, &excitations),
        excitations,
    }
}

fn echoed_excitations(study: &Study, sector: &SectorModel) -> Vec<EchoedExcitation> {
    let mut found = Vec::new();
    for (place, case) in excitations(study).iter().enumerate() {
        let case_study = &case.study;
        let force = sector.load_case_forces.get(place).unwrap_or(&sector.force);
        let force_n = case_study.amplitude_n * sum_of_magnitudes(sector, force);
        for (order, &engine_order) in case_study.engine_orders.iter().enumerate() {
            let wave = nodal_diameter_of(1, engine_order, sector.sectors);
            let travels = if wave.index == 0 || 2 * wave.index == sector.sectors {
                Travel::Standing
            } else if wave.conjugate {
                Travel::Backwards
            } else {
                Travel::Forwards
            };
            found.push(EchoedExcitation {
                load_case: case.name,
                engine_order,
                force_dofs: force.iter().filter(|(_, value)| value.norm() > 0.0).count(),
                force_n: force_n * case_study.amplitudes_n.get(order).copied().unwrap_or(1.0),
                nodal_diameter: wave.index,
                travels,
            });
        }
    }
    found
}

/// Sum of the magnitudes of the forces on a sector, those along r, along theta and along z as components of one. Forces that
/// cancel each other excite a wheel too, so that signs do not count. Moments are taken as forces at 1 m.
fn sum_of_magnitudes(sector: &SectorModel, force: &[(usize, Complex64)]) -> f64 {
    let mut along: Vec<(Component, f64)> = Vec::new();
    for &(dof, value) in force {
        let component = sector.dofs[dof].component;
        match along.iter_mut().find(|known| known.0 == component) {
            Some(known) => known.1 += value.norm(),
            None => along.push((component, value.norm())),
        }
    }
    along.iter().map(|(_, sum)| sum * sum).sum::<f64>().sqrt()
}

fn mistuning(study: &Study) -> String {
    match &study.mistuning.source {
        MistuningSource::File { written, .. } => format!("blade stiffness, patterns of {written}"),
        MistuningSource::Law(law) => {
            let deviations: Vec<String> = study
                .standard_deviations
                .iter()
                .flatten()
                .map(|deviation| format!("{} %", round(100.0 * deviation)))
                .collect();
            let law = law.name().replace('_', " ");
            format!(
                "blade stiffness, {law} law, standard deviation {}",
                deviations.join(", ")
            )
        }
    }
}

fn contact(study: &Study) -> Option<String> {
    let contact = study.contact.as_ref()?;
    let normal = contact
        .normal_stiffness_n_per_m
        .map_or_else(String::new, |stiffness| {
            format!(", normal {stiffness:e} N/m")
        });
    let varied: Vec<&str> = study
        .contact_variations
        .iter()
        .map(|variation| variation.quantity.name())
        .collect();
    let varied = if varied.is_empty() {
        String::new()
    } else {
        format!("; random: {}", varied.join(", "))
    };
    Some(format!(
        "{}: friction coefficient {}, stiffness per sector tangential {:e} N/m{normal}{varied}",
        contact.law.name(),
        contact.friction_coefficient,
        contact.tangential_stiffness_n_per_m
    ))
}

fn damping(study: &Study) -> String {
    let damping = match study.damping {
        Damping::StructuralLossFactor(factor) => format!("structural loss factor {factor}"),
        Damping::ModalRatio(ratio) => format!("modal ratio {ratio}"),
        Damping::Rayleigh {
            mass_per_s,
            stiffness_s,
        } => format!("Rayleigh, {mass_per_s} 1/s on the mass and {stiffness_s} s on the stiffness"),
    };
    match study.nodal_diameter_damping {
        Some(_) => format!("{damping}, and ratios by nodal diameter"),
        None => damping,
    }
}

fn settings(study: &Study) -> String {
    if let Some(accuracy) = study.accuracy {
        let percent = round(100.0 * accuracy.amplitude_error);
        return format!(
            "chosen by the program for an error of {percent} % of the amplitude of 95 % of the rows (accuracy.amplitude_error)"
        );
    }
    let harmonics = match &study.solver.harmonics {
        Harmonics::Auto => "chosen for each load".to_owned(),
        Harmonics::Set(set) => {
            let names: Vec<String> = set.iter().map(u32::to_string).collect();
            names.join(", ")
        }
    };
    let basis = serde_json::json!(study.reduction.basis);
    let basis = basis_words(basis.as_str().unwrap_or_default());
    let held = RowTolerance {
        sampling_tolerance: Some(sampling_tolerance(study.solver.peak_tolerance)),
        harmonic_tolerance: Some(study.solver.harmonic_tolerance),
    };
    let mut loads = study.contacts.iter();
    let with_friction = loads.any(|own| own.normal_load_n().is_some());
    let held = if with_friction {
        format!("; {}", held.in_words(None))
    } else {
        String::new()
    };
    format!("harmonics {harmonics}; {basis}{held}")
}

fn remarks(study: &Study, sector: &SectorModel, excitations: &[EchoedExcitation]) -> Vec<Remark> {
    let sectors = sector.sectors;
    let mut remarks: Vec<Remark> = Vec::new();
    for excitation in excitations {
        let remark = Remark::AliasedEngineOrder {
            engine_order: excitation.engine_order,
            sectors,
            nodal_diameter: excitation.nodal_diameter,
            travels: excitation.travels,
        };
        let aliased = 2 * u64::from(excitation.engine_order) > sectors as u64;
        if aliased && !remarks.contains(&remark) {
            remarks.push(remark);
        }
    }
    let forces = excitations.iter().map(|excitation| excitation.force_n);
    let largest_force_n = forces.clone().fold(0.0, f64::max);
    let loads = study.contacts.iter();
    let loads = loads.filter_map(|condition| condition.normal_load_n());
    if let Some(contact) = &study.contact {
        let limit = |load: f64| contact.friction_coefficient * load;
        let highest = loads.clone().fold(f64::NEG_INFINITY, f64::max);
        let resonant_force_n = gain(study.damping).map(|gain| gain * largest_force_n);
        if let Some(resonant_force_n) = resonant_force_n
            && limit(highest) > STICKS * resonant_force_n
        {
            remarks.push(Remark::LargeLoad {
                normal_load_n: highest,
                wheel_load_n: highest * sectors as f64,
                friction_limit_n: limit(highest),
                resonant_force_n,
            });
        }
        let lowest = loads.fold(f64::INFINITY, f64::min);
        let force_n = forces.fold(f64::INFINITY, f64::min);
        if limit(lowest) < SLIDES * force_n {
            remarks.push(Remark::SmallLoad {
                normal_load_n: lowest,
                friction_limit_n: limit(lowest),
                force_n,
            });
        }
    }
    let deviations = study.standard_deviations.iter().flatten();
    let largest = deviations.copied().fold(0.0, f64::max);
    if largest > LARGE_DEVIATION {
        remarks.push(Remark::LargeDeviation {
            standard_deviation: largest,
        });
    }
    let pairs = sector.pairs_without_friction();
    if pairs > 0 {
        remarks.push(Remark::NoFriction {
            pairs,
            contact_pairs: sector.contact_pairs.len(),
        });
    }
    let patterns = u64::from(study.patterns);
    let is_measured = matches!(study.mistuning.source, MistuningSource::File { .. });
    for percent in REPORTED {
        let needed = smallest_sample(f64::from(percent) / 100.0, CONFIDENCE);
        // Of one wheel the peak is the answer.
        if patterns < needed && !(is_measured && patterns == 1) {
            remarks.push(Remark::FewPatterns {
                percent,
                needed,
                wheels_in_file: is_measured.then_some(patterns),
            });
        }
    }
    remarks
}

/// Motion at an undisturbed resonance over the static one; none where it depends on the frequency.
fn gain(damping: Damping) -> Option<f64> {
    match damping {
        Damping::StructuralLossFactor(factor) => Some(1.0 / factor),
        Damping::ModalRatio(ratio) => Some(0.5 / ratio),
        Damping::Rayleigh { .. } => None,
    }
}

/// A percentage without the digits that rounding makes.
fn round(percent: f64) -> f64 {
    (1e6 * percent).round() / 1e6
}
