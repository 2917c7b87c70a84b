//! `CITATION.cff` names the version and the licences of `Cargo.toml`.

use std::path::Path;

/// The value of a key at the first level.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let line = text.lines().find_map(|line| line.strip_prefix(key));
    line?
        .strip_prefix(": ")
        .map(|value| value.trim_matches('"'))
}

#[test]
fn the_citation_is_of_this_version_and_its_licences() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("CITATION.cff");
    let text = std::fs::read_to_string(path).expect("CITATION.cff");
    assert_eq!(value(&text, "cff-version"), Some("1.2.0"));
    assert_eq!(value(&text, "version"), Some(env!("CARGO_PKG_VERSION")));
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let manifest = std::fs::read_to_string(manifest).expect("Cargo.toml");
    let manifest: toml::Table = manifest.parse().expect("TOML");
    let licences = manifest["package"]["license"].as_str().expect("a licence");
    let listed = text.split("license:\n").nth(1).expect("licences");
    let listed: Vec<&str> = listed
        .lines()
        .map_while(|line| line.strip_prefix("  - "))
        .collect();
    assert_eq!(listed.join(" OR "), licences);
}
