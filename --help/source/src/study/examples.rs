//! The studies that come with the program, and the files that they read.

/// Name and text of every example, the template of `blisk init` first.
pub const EXAMPLES: [(&str, &str); 10] = [
    ("template", super::STUDY_TEMPLATE),
    ("quickstart", include_str!("../../studies/quickstart.toml")),
    ("wheel", include_str!("../../studies/wheel.toml")),
    ("lumped24", include_str!("../../studies/lumped24.toml")),
    ("one-dof", include_str!("../../studies/one-dof.toml")),
    (
        "underplatform",
        include_str!("../../studies/underplatform.toml"),
    ),
    ("shroud", include_str!("../../studies/shroud.toml")),
    (
        "blade-to-ground",
        include_str!("../../studies/blade-to-ground.toml"),
    ),
    (
        "laxalde-2007",
        include_str!("../../studies/laxalde-2007.toml"),
    ),
    (
        "contact-uncertainty",
        include_str!("../../studies/contact-uncertainty.toml"),
    ),
];

/// Where the examples have their data, seen from `studies/`.
const DATA: &str = "../tests/data/";

/// A file of `tests/data` by its path there.
macro_rules! data {
    ($path:literal) => {
        ($path, include_str!(concat!("../../tests/data/", $path)))
    };
}

/// The files that examples read, by folder and path.
const DATA_FILES: [(&str, &str); 11] = [
    data!("lumped24/mistuning.csv"),
    data!("wheel24/model.toml"),
    data!("wheel24/K.mtx"),
    data!("wheel24/M.mtx"),
    data!("wheel24/K_blade.mtx"),
    data!("wheel24/dofs.csv"),
    data!("wheel24/cyclic.csv"),
    data!("wheel24/contact.csv"),
    data!("wheel24/force.csv"),
    data!("wheel24/observe.csv"),
    data!("wheel24/reference/patterns.csv"),
];

/// An example as it is written elsewhere: its data stand beside it, in folders of their own.
#[must_use]
pub fn example_beside_its_data(text: &str) -> (String, Vec<(&'static str, &'static str)>) {
    let reads = |(path, _): &&(&str, &str)| {
        let folder = path.split('/').next().unwrap_or_default();
        text.contains(&format!("{DATA}{folder}"))
    };
    let files = DATA_FILES.iter().filter(reads).copied().collect();
    (text.replace(DATA, ""), files)
}
