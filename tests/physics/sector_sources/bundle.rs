//! Bundles: what is written reads back bit for bit, and the reference wheels are what they say.

use blisk::model::sector::{
    LumpedOptions, ModelError, ParametricOptions, SectorModel, bundle, lumped, parametric,
};

use super::data;

fn written_and_read(model: &SectorModel) -> SectorModel {
    let directory = tempfile::tempdir().unwrap();
    bundle::write(model, directory.path()).unwrap();
    bundle::read(directory.path()).unwrap()
}

#[test]
fn a_written_model_reads_back_bit_for_bit() {
    let lumped = lumped::build(&LumpedOptions {
        sectors: 5,
        blade_mass_kg: 0.1,
        blade_stiffness_n_per_m: 1.0 / 3.0 * 1e6,
        blade_coupling_stiffness_n_per_m: 1e3,
        ..LumpedOptions::default()
    });
    let mut wheel8 = bundle::read(&data("wheel8")).unwrap();
    "a \"quoted\" name\nof two lines".clone_into(&mut wheel8.name);
    wheel8.force[0].1.im = -0.0;
    for model in [
        lumped.unwrap(),
        parametric::build(&ParametricOptions::default()).unwrap(),
        wheel8,
    ] {
        let back = written_and_read(&model);
        assert_eq!(back, model);
        let bits = |model: &SectorModel| -> Vec<u64> {
            let matrices = [&model.stiffness, &model.mass, &model.blade_stiffness];
            let entries = matrices
                .into_iter()
                .flat_map(blisk::linalg::SymmetricSparse::lower_entries);
            let force = model
                .force
                .iter()
                .flat_map(|(_, force)| [force.re, force.im]);
            entries
                .map(|entry| entry.2)
                .chain(force)
                .map(f64::to_bits)
                .collect()
        };
        assert_eq!(bits(&back), bits(&model));
    }
}

#[test]
fn reference_wheels_are_read_whole() {
    for (name, sectors, dofs, pairs, force) in
        [("wheel8", 8, 756, 4, 1.0), ("wheel24", 24, 1068, 6, 1.0)]
    {
        let model = bundle::read(&data(name)).unwrap();
        assert_eq!(
            (model.sectors, model.dofs.len(), model.contact_pairs.len()),
            (sectors, dofs, pairs)
        );
        let found: f64 = model.force.iter().map(|(_, force)| force.norm_sqr()).sum();
        assert!((found - force).abs() < 1e-12);
        assert_eq!(model.observed[0].name, "tip_le");
    }
}

#[test]
fn a_name_that_csv_cannot_hold_is_refused() {
    let mut model = bundle::read(&data("wheel8")).unwrap();
    "tip, leading".clone_into(&mut model.observed[1].name);
    let directory = tempfile::tempdir().unwrap();
    let error = bundle::write(&model, directory.path()).unwrap_err();
    assert!(
        matches!(error, ModelError::NameNotWritable { index: 1, .. }),
        "{error}"
    );
    assert!(error.to_string().contains("tip, leading"), "{error}");
}

/// Files of two models never read as one: the header goes before the first file of the new model is written.
#[test]
fn a_bundle_that_was_replaced_in_part_is_refused() {
    let model = bundle::read(&data("wheel8")).unwrap();
    let directory = tempfile::tempdir().unwrap();
    bundle::write(&model, directory.path()).unwrap();
    let mass = directory.path().join("M.mtx");
    std::fs::remove_file(&mass).unwrap();
    std::fs::create_dir(&mass).unwrap();
    bundle::write(&model, directory.path()).unwrap_err();
    std::fs::remove_dir(&mass).unwrap();
    std::fs::write(&mass, "").unwrap();
    let error = bundle::read(directory.path()).unwrap_err().to_string();
    assert!(error.contains("model.toml"), "{error}");
}

#[test]
fn a_missing_bundle_is_named() {
    let error = bundle::read(&data("no-such-wheel")).unwrap_err();
    assert!(matches!(error, ModelError::File { .. }), "{error}");
    assert!(error.to_string().contains("no-such-wheel"), "{error}");
}
