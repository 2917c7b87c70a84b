//! Commented import files to begin with.

/// Name of a code and an import file for its files.
pub const IMPORT_TEMPLATES: [(&str, &str); 3] = [
    ("calculix", include_str!("templates/calculix.toml")),
    ("ansys", include_str!("templates/ansys.toml")),
    ("nastran", include_str!("templates/nastran.toml")),
];
