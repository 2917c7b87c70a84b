//! Sector bundles: one file of a sound bundle spoiled, and what is made of those still accepted.

use std::fs;
use std::path::Path;

use blisk::linalg::SymmetricSparse;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::{
    Body, Component, ContactPair, ContactSide, Dof, LumpedOptions, ModelError, RigidPoint,
    SectorModel, bundle, lumped, validate,
};

use super::mutator::Mutator;
use super::{assert_clear, folder, run};
use crate::contact::random::Random;
use crate::extremes::wheels::spatial_sector;
use crate::sector_sources::lumped::lumped24;

/// Those of every bundle, and that of the points of rigid bodies.
const FILES: [&str; 10] = [
    "model.toml",
    "K.mtx",
    "M.mtx",
    "K_blade.mtx",
    "dofs.csv",
    "cyclic.csv",
    "contact.csv",
    "force.csv",
    "observe.csv",
    "rigid.csv",
];
/// Files of a bundle without rigid bodies.
const WITHOUT_RIGID: usize = FILES.len() - 1;

fn models() -> [SectorModel; 2] {
    let options = LumpedOptions {
        sectors: 3,
        ..lumped24()
    };
    [lumped::build(&options).unwrap(), spatial_sector(3)]
}

/// A sector between whose disk and that of the next one a rigid body lies, held by two pairs and a weak spring.
fn with_a_rigid_body() -> SectorModel {
    let mut model = spatial_sector(3);
    let n = model.dofs.len();
    let (disk, reference) = (1, 10);
    let (_, [x, y, _]) = model.place_of(disk).unwrap();
    let turned = |angle: f64, z_m: f64| {
        let (sin, cos) = angle.sin_cos();
        [x * cos - y * sin, x * sin + y * cos, z_m]
    };
    let alpha = std::f64::consts::TAU / 3.0;
    model.dofs.extend(Component::RIGID.map(|component| Dof {
        node: reference,
        component,
        position_m: turned(0.5 * alpha, 0.0),
        body: Body::Damper,
    }));
    let diagonal = |value: f64| (0..6).map(move |own| (n + own, n + own, value));
    for (matrix, value) in [
        (&mut model.stiffness, Some(1e3)),
        (&mut model.mass, Some(1e-2)),
        (&mut model.blade_stiffness, None),
    ] {
        let entries = matrix
            .lower_entries()
            .chain(value.into_iter().flat_map(diagonal));
        let entries: Vec<_> = entries.collect();
        *matrix = SymmetricSparse::from_lower_triplets(n + 6, &entries);
    }
    for (node, angle, first) in [
        (11, 0.0, ContactSide::Node(disk)),
        (12, alpha, ContactSide::NextSector(disk)),
    ] {
        model.rigid_points.push(RigidPoint {
            node,
            reference,
            position_m: turned(angle, 0.01),
        });
        model.contact_pairs.push(ContactPair {
            first,
            second: ContactSide::Node(node),
            normal: [-1.0, 0.0, 0.0],
            weight: 1.0,
            load_weight: None,
        });
    }
    for pair in &mut model.contact_pairs {
        pair.weight = 1.0 / 3.0;
    }
    validate(&model).unwrap();
    model
}

/// Which model, which file, and the bytes that take its place.
fn spoiled(case: u64, originals: &[Vec<Vec<u8>>]) -> (usize, usize, Vec<u8>) {
    let mut mutator = Mutator::new(case);
    let (model, file) = (
        mutator.0.integer(0, originals.len() - 1),
        mutator.0.integer(0, originals[0].len() - 1),
    );
    let bytes = mutator.spoil(&originals[model][file]);
    (model, file, bytes)
}

/// The bundle with one file replaced; the folder holds the originals before and after.
fn read_with(
    folder: &Path,
    originals: &[Vec<u8>],
    file: usize,
    bytes: &[u8],
) -> Result<SectorModel, ModelError> {
    if !folder.exists() {
        fs::create_dir_all(folder).unwrap();
        for (name, original) in FILES.iter().zip(originals) {
            fs::write(folder.join(name), original).unwrap();
        }
    }
    let path = folder.join(FILES[file]);
    fs::write(&path, bytes).unwrap();
    let read = bundle::read(folder);
    fs::write(&path, &originals[file]).unwrap();
    read
}

#[test]
fn a_spoiled_bundle_is_read_or_refused() {
    hold(&models(), &FILES[..WITHOUT_RIGID]);
}

#[test]
fn a_spoiled_bundle_with_a_rigid_body_is_read_or_refused() {
    hold(&[with_a_rigid_body()], &FILES);
}

fn hold(models: &[SectorModel], files: &[&str]) {
    let folder = folder();
    let written = |model: &SectorModel| -> Vec<Vec<u8>> {
        bundle::write(model, folder.path()).unwrap();
        let read = |file: &&str| fs::read(folder.path().join(file)).unwrap();
        files.iter().map(read).collect()
    };
    let originals: Vec<_> = models.iter().map(written).collect();
    let accepted = run(
        |case| spoiled(case, &originals).2,
        |case, bytes| {
            let (model, file, _) = spoiled(case, &originals);
            // A folder for each thread: no two of them read it at once.
            let thread = rayon::current_thread_index().unwrap_or(0);
            let place = folder.path().join(format!("{thread}-{model}"));
            match read_with(&place, &originals[model], file, bytes) {
                Ok(model) => {
                    validate(&model).unwrap();
                    written_and_read(&model, &folder.path().join(format!("{thread}-written")));
                    reduced_or_refused(&model);
                    true
                }
                Err(error) => {
                    assert_clear(&error.to_string());
                    false
                }
            }
        },
    );
    assert!(accepted > 0, "none of the changes is harmless");
}

/// A model that was read can be written, unless the name of a node forbids it, and is the same again.
fn written_and_read(model: &SectorModel, place: &Path) {
    match bundle::write(model, place) {
        Ok(()) => assert_eq!(&bundle::read(place).unwrap(), model),
        Err(error) => assert!(
            matches!(error, ModelError::NameNotWritable { .. }),
            "{error}"
        ),
    }
}

/// A model that passed the checks is reduced to finite numbers, or the reduction says why not.
fn reduced_or_refused(model: &SectorModel) {
    if model.sectors > 50 {
        return;
    }
    let springs = ContactStiffness {
        normal_n_per_m: 1e6,
        tangential_1_n_per_m: 8e5,
        tangential_2_n_per_m: 8e5,
    };
    let reduced = Reduction::new(model, springs, 25, 0)
        .and_then(|reduction| reduction.reduce(BasisChoice::CraigBampton, None));
    match reduced {
        Ok(reduced) => {
            for nd in &reduced.nodal_diameters {
                assert!(nd.eigenvalues.iter().all(|value| value.is_finite()));
            }
        }
        Err(error) => assert_clear(&error.to_string()),
    }
}

#[test]
fn random_models_read_back_equal() {
    let folder = folder();
    for case in 0..100 {
        let mut random = Random(case);
        let mut draw = |low: f64, high: f64| random.magnitude(low, high);
        let options = LumpedOptions {
            blade_mass_kg: draw(1e-12, 1e12),
            disk_mass_kg: draw(1e-12, 1e12),
            ring_mass_kg: draw(1e-12, 1e12),
            blade_stiffness_n_per_m: draw(1e-9, 1e15),
            blade_coupling_stiffness_n_per_m: draw(1e-9, 1e15),
            disk_ground_stiffness_n_per_m: draw(1e-9, 1e15),
            disk_coupling_stiffness_n_per_m: draw(1e-9, 1e15),
            ring_ground_stiffness_n_per_m: draw(1e-9, 1e15),
            ring_coupling_stiffness_n_per_m: draw(1e-9, 1e15),
            ring_disk_stiffness_n_per_m: draw(1e-9, 1e15),
            sectors: random.integer(1, 10_000),
            ..LumpedOptions::default()
        };
        let model = lumped::build(&options).unwrap();
        bundle::write(&model, folder.path()).unwrap();
        assert_eq!(bundle::read(folder.path()).unwrap(), model, "{options:?}");
    }
}

/// The number of sectors of a bundle is bounded, as it is for the other sources.
#[test]
fn a_bundle_of_too_many_sectors_is_refused() {
    let model = SectorModel {
        cyclic_pairs: Vec::new(),
        ..models()[0].clone()
    };
    for sectors in [10_001, 1 << 40, usize::MAX] {
        let error = validate(&SectorModel {
            sectors,
            ..model.clone()
        })
        .unwrap_err();
        assert!(
            matches!(error, ModelError::TooManySectors { .. }),
            "{error}"
        );
        assert!(
            error.to_string().contains("accepted: 1 to 10000"),
            "{error}"
        );
    }
}

/// Entries so large or so small that their product overflows or vanishes are judged as they are.
#[test]
fn matrices_at_the_ends_of_the_range_are_judged_by_their_own_entries() {
    for scale in [1e-250, 1e250] {
        let model = models()[0].clone();
        let scaled = |matrix: &SymmetricSparse, factor: f64| {
            let entries: Vec<_> = matrix
                .lower_entries()
                .map(|(row, column, value)| {
                    (
                        row,
                        column,
                        value * scale * if row == column { 1.0 } else { factor },
                    )
                })
                .collect();
            SymmetricSparse::from_lower_triplets(matrix.dimension(), &entries)
        };
        let of = |factor: f64| SectorModel {
            stiffness: scaled(&model.stiffness, factor),
            blade_stiffness: scaled(&model.blade_stiffness, factor),
            ..model.clone()
        };
        validate(&of(1.0)).unwrap();
        let error = validate(&of(1e9)).unwrap_err();
        assert!(
            matches!(error, ModelError::Indefinite { .. }),
            "{scale:e}: {error}"
        );
    }
}
