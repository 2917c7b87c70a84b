//! Files of finite-element codes: decks, dof tables, matrices, import files.

use std::fs;

use blisk::model::sector::ModelError;
use blisk::model::sector::import::import;

use super::mutator::Mutator;
use super::{assert_clear, folder, run};
use crate::imports::lumped::wedge;
use crate::imports::small::Small;

#[test]
fn spoiled_files_of_other_codes_are_read_or_refused() {
    hold(&[
        Small::calculix(),
        Small::ansys(),
        Small::nastran(),
        Small::op4(),
    ]);
}

/// A ring that a list states, and a damper body between a sector and the next one.
#[test]
fn spoiled_files_with_lists_of_contacts_are_read_or_refused() {
    let mut ring = Small::calculix();
    for (name, text) in &mut ring.files {
        if *name == "import.toml" {
            assert!(text.contains("[contact]\nblisk = \""), "{text}");
            *text = text
                .replace("[contact]\nblisk = \"", "[[contact]]\nfirst = \"blisk.")
                .replace("\nring = \"", "\nsecond = \"ring.");
        }
    }
    let mut weighted = wedge();
    let (_, text) = { weighted.files.iter_mut() }
        .find(|(name, _)| *name == "import.toml")
        .unwrap();
    assert_eq!(text.matches("[[contact]]\n").count(), 2, "{text}");
    *text = text.replace("[[contact]]\n", "[[contact]]\nweight = 2.5\n");
    hold(&[ring, wedge(), weighted]);
}

fn hold(sources: &[Small]) {
    let folder = folder();
    for (place, source) in sources.iter().enumerate() {
        let sound = folder.path().join(format!("sound-{place}"));
        fs::create_dir(&sound).unwrap();
        source.write(&sound);
        import(&sound.join("import.toml")).unwrap();
    }
    // Which source and which of its files follow from the case, for `spoil` and the check alike.
    let choice = |case: u64| {
        let source = &sources[case as usize % sources.len()];
        let file = (case as usize / sources.len()) % source.files.len();
        (source, file)
    };
    let spoil = |case: u64| {
        let (source, file) = choice(case);
        Mutator::new(case).spoil(source.files[file].1.as_bytes())
    };
    let accepted = run(spoil, |case, bytes| {
        let (source, file) = choice(case);
        let own = folder.path().join(case.to_string());
        fs::create_dir(&own).unwrap();
        source.write(&own);
        let path = own.join(source.files[file].0);
        fs::write(&path, bytes).unwrap();
        let imported = import(&own.join("import.toml"));
        fs::remove_dir_all(&own).unwrap();
        match imported {
            Ok(_) => true,
            Err(error) => {
                assert_clear(&error.to_string());
                if let ModelError::ImportFile {
                    path: named,
                    findings,
                } = &error
                    && *named == path
                {
                    let lines = String::from_utf8_lossy(bytes).lines().count().max(1);
                    assert!(!findings.is_empty());
                    for finding in findings {
                        assert!((1..=lines).contains(&finding.line), "{finding:?}");
                    }
                }
                if let ModelError::ImportLine {
                    path: named, line, ..
                }
                | ModelError::Line {
                    path: named, line, ..
                } = error
                    && named == path
                {
                    let lines = String::from_utf8_lossy(bytes).lines().count();
                    assert!((1..=lines.max(1)).contains(&line), "{line} of {lines}");
                }
                false
            }
        }
    });
    assert!(accepted > 0, "none of the changes is harmless");
}

/// A file that was cut off anywhere is refused, or means the same: nothing in between.
#[test]
fn truncated_matrices_are_refused() {
    let matrices = [
        (
            Small::calculix(),
            vec!["job.sti", "job.mas", "job.dof", "blade.dof"],
        ),
        (Small::ansys(), vec!["K", "M", "K.mapping", "B"]),
        (Small::op4(), vec!["op4", "dofs", "blade"]),
    ];
    for (source, files) in matrices {
        for name in files {
            let (_, text) = source.files.iter().find(|file| file.0 == name).unwrap();
            for at in (0..text.trim_end().len()).step_by(23) {
                let folder = folder();
                source.write(folder.path());
                fs::write(folder.path().join(name), &text[..at]).unwrap();
                let imported = import(&folder.path().join("import.toml"));
                let error = imported.err().map(|error| error.to_string());
                assert_clear(&error.unwrap_or_else(|| panic!("{name} cut at {at} is accepted")));
            }
        }
    }
}
