//! The studies that come with the program.

/// Name and text of every example, the template of `blisk init` first.
pub const EXAMPLES: [(&str, &str); 6] = [
    ("template", super::STUDY_TEMPLATE),
    ("quickstart", include_str!("../../studies/quickstart.toml")),
    ("wheel", include_str!("../../studies/wheel.toml")),
    ("lumped24", include_str!("../../studies/lumped24.toml")),
    ("one-dof", include_str!("../../studies/one-dof.toml")),
    (
        "contact-uncertainty",
        include_str!("../../studies/contact-uncertainty.toml"),
    ),
];
