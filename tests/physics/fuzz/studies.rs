//! Study files.

use std::fs;
use std::path::Path;

use blisk::response::forced_response::{ContactCondition, FrequencyBand, Harmonics};
use blisk::study::{
    ModelSource, Problem, STUDY_TEMPLATE, Study, StudyError, load_sector_model, pattern_source,
};

use super::mutator::Mutator;
use super::{assert_clear, run};

/// The study files of the package and the template, without the comments at their heads.
fn originals() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    let mut texts: Vec<String> = paths
        .into_iter()
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    texts.push(STUDY_TEMPLATE.to_owned());
    assert!(texts.len() > 3);
    for text in &mut texts {
        let start = text.find("schema").unwrap();
        text.drain(..start);
    }
    texts
}

/// Beside the package's studies, so that the files they name are found.
fn path() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/spoiled.toml")
}

#[test]
fn a_spoiled_study_is_read_or_refused() {
    let originals = originals();
    let spoil = |case| {
        let mut mutator = Mutator::new(case);
        let text = mutator.one_of(&originals).clone();
        let bytes = mutator.spoil(text.as_bytes());
        String::from_utf8_lossy(&bytes).into_owned().into_bytes()
    };
    let accepted = run(spoil, |_, bytes| {
        let text = std::str::from_utf8(bytes).unwrap();
        match Study::parse(&path(), text) {
            Ok(study) => {
                assert_within_limits(&study);
                true
            }
            Err(error) => {
                assert_says_what_and_where(&error, text);
                false
            }
        }
    });
    assert!(accepted > 0, "none of the changes is harmless");
}

/// What every accepted study holds to, whatever was spoiled in its file.
fn assert_within_limits(study: &Study) {
    assert!(study.amplitude_n.is_finite() && study.amplitude_n > 0.0);
    assert!(study.patterns >= 1 && !study.engine_orders.is_empty());
    assert!(!study.contacts.is_empty() && !study.standard_deviations.is_empty());
    for contact in &study.contacts {
        if let ContactCondition::Full { normal_load_n } = contact {
            assert!(normal_load_n.is_finite() && normal_load_n.is_sign_positive());
        }
    }
    for deviation in study.standard_deviations.iter().flatten() {
        assert!((0.0..=0.5).contains(deviation));
    }
    if let Some(contact) = &study.contact {
        assert!(contact.friction_coefficient >= 0.0);
        assert!(contact.tangential_stiffness_n_per_m.is_finite());
    }
    if let Harmonics::Set(set) = &study.solver.harmonics {
        assert!(set.contains(&1) && study.solver.samples_per_period >= 4 * set.len());
    }
    if let FrequencyBand::Fixed { start_hz, stop_hz } = study.solver.frequency_band {
        assert!(start_hz > 0.0 && start_hz < stop_hz && stop_hz.is_finite());
    }
    // JSON has no NaN and no infinity: a number lost in the manifest would read `null`.
    let resolved = study.resolved();
    for key in ["damping", "excitation", "sweep", "solver"] {
        assert!(
            !resolved[key].to_string().contains("null") || resolved[key].is_null(),
            "{resolved}"
        );
    }
    if matches!(study.model, ModelSource::Lumped(_)) {
        match load_sector_model(study) {
            Ok(model) => {
                assert!((1..=10_000).contains(&model.sectors));
                if let Err(error) = pattern_source(study, &model) {
                    assert_clear(&error.to_string());
                }
            }
            Err(error) => assert_clear(&error.to_string()),
        }
    }
}

/// Every finding names a line of the file, a key unless the file is no TOML, and what is accepted.
fn assert_says_what_and_where(error: &StudyError, text: &str) {
    assert_clear(&error.to_string().replace("src/", ""));
    let StudyError::Invalid { findings, .. } = error else {
        return;
    };
    assert!(!findings.is_empty());
    for finding in findings {
        let lines = text.split('\n').count();
        assert!(
            (1..=lines).contains(&finding.line),
            "line {} of {lines}: {error}",
            finding.line
        );
        match &finding.problem {
            Problem::Syntax { message } => assert_clear(message),
            Problem::Missing { accepted } | Problem::NotAccepted { accepted, .. } => {
                assert!(!accepted.is_empty() && !finding.key.is_empty(), "{error}");
            }
            Problem::UnknownKey { .. } | Problem::Conflict { .. } => {
                assert!(!finding.key.is_empty(), "{error}");
            }
        }
    }
}

/// Tables and lists nested beyond any sense are refused, not followed to the end of the stack.
#[test]
fn deep_nesting_is_refused() {
    let depth = 100_000;
    for text in [
        format!("a = {}", "[".repeat(depth)),
        format!("a = {}{}", "[".repeat(depth), "]".repeat(depth)),
        format!("a = {}1{}", "{ a = ".repeat(depth), " }".repeat(depth)),
        format!("a{} = 1", ".a".repeat(depth)),
        format!("[a{}]", ".a".repeat(depth)),
        format!("[[a{}]]", ".a".repeat(depth)),
    ] {
        let error = Study::parse(&path(), &text).unwrap_err();
        let shown: String = error.to_string().chars().take(200).collect();
        assert!(matches!(error, StudyError::Invalid { .. }), "{shown}");
    }
}

/// Values at the limits of the machine, in a sound study: refused with their key, or accepted.
#[test]
fn studies_with_an_extreme_value_are_refused_or_sound() {
    let sound =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/lumped24.toml"))
            .unwrap();
    Study::parse(&path(), &sound).unwrap();
    for (key, from, bad) in [
        (
            "excitation.amplitude_n",
            "amplitude_n = 10.0",
            &["0.0", "-0.0", "-1", "nan", "inf"][..],
        ),
        (
            "damping.rayleigh",
            "mass_per_s = 0.0, stiffness_s = 9.0e-7",
            &["mass_per_s = 0.0, stiffness_s = 0.0"],
        ),
        (
            "sweep.normal_load_n",
            "normal_load_n = [50]",
            &[
                "[-1e-300]",
                "[nan]",
                "[inf]",
                "[]",
                "[50, 50.0]",
                "[0, -0.0]",
            ],
        ),
        (
            "contact.friction_coefficient",
            "friction_coefficient = 0.3",
            &["-1e-9", "nan", "inf", "11"],
        ),
        (
            "contact.tangential_stiffness_n_per_m",
            "tangential_stiffness_n_per_m = 8.0e5",
            &["0", "-1", "nan", "inf"],
        ),
        (
            "excitation.engine_orders",
            "engine_orders = [3]",
            &["[]", "[3, 3]", "[10001]"],
        ),
        (
            "solver.samples_per_period",
            "samples_per_period = 128",
            &["0", "15", "65537", "9223372036854775807"],
        ),
        (
            "solver.harmonics",
            "harmonics = [1, 3]",
            &["[]", "[3]", "[3, 1]", "[1, 1]", "[1, 101]"],
        ),
    ] {
        let name = from.split(" = ").next().unwrap();
        for value in bad {
            let to = if value.contains('=') {
                (*value).to_owned()
            } else {
                format!("{name} = {value}")
            };
            let text = sound.replace(from, &to);
            assert_ne!(text, sound, "{key}");
            let error = Study::parse(&path(), &text).unwrap_err();
            let message = error.to_string();
            assert!(
                message.contains(key) && message.contains("accepted"),
                "{key} = {value}: {message}"
            );
        }
    }
}
