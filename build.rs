//! The identity of a build, for `src/identity.rs`: what the program is made from, as one digest.
//!
//! Covered: every file below `src/`, `build.rs`, `Cargo.toml`, `Cargo.lock`, the features, the optimisation level, the
//! target with its features, and what `rustc -vV` says. Paths count relative to the package and a line may end either
//! way, so that the same sources in another folder are the same build. Documentation, tests and the examples that
//! `blisk init` writes are not covered: no number is calculated from them.
//!
//! The commit is no part of the digest. It is one whose covered files are those of this build, which stays true when
//! later commits leave these files alone; so nothing of `.git` has to be watched, and a commit costs no compilation.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// What is covered, relative to the package.
const COVERED: [&str; 4] = ["Cargo.lock", "Cargo.toml", "build.rs", "src"];

/// Hexadecimal digits of an identity.
const DIGITS: usize = 32;

fn main() {
    let root = Path::new(".");
    for place in COVERED {
        // A path that is not there would have this script run at every build.
        if root.join(place).exists() {
            println!("cargo::rerun-if-changed={place}");
        }
    }
    let files = match covered_files(root) {
        Ok(files) => files,
        Err(error) => panic!("cannot read the sources of the package: {error}"),
    };
    let identity = identity_of(&files, &settings());
    println!("cargo::rustc-env=BLISK_BUILD={identity}");
    println!("cargo::rustc-env=BLISK_COMMIT={}", commit_of(root));
}

/// Content of every covered file by its path, with `/` between folders and one character at the end of a line.
pub(crate) fn covered_files(root: &Path) -> std::io::Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    for place in COVERED {
        let path = root.join(place);
        if path.is_dir() {
            add_folder(&path, place, &mut files)?;
        } else if path.exists() {
            files.insert(place.to_owned(), content_of(&path)?);
        }
    }
    Ok(files)
}

fn add_folder(
    folder: &Path,
    name: &str,
    files: &mut BTreeMap<String, Vec<u8>>,
) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{name}/{own}");
        if path.is_dir() {
            add_folder(&path, &name, files)?;
        } else {
            files.insert(name, content_of(&path)?);
        }
    }
    Ok(())
}

fn content_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut content = std::fs::read(path)?;
    if !content.contains(&b'\r') {
        return Ok(content);
    }
    let ends_line = |place: usize| content[place..].starts_with(b"\r\n");
    let kept: Vec<usize> = (0..content.len()).filter(|&at| !ends_line(at)).collect();
    content = kept.into_iter().map(|place| content[place]).collect();
    Ok(content)
}

/// What the compiler is told and which one it is, by name.
fn settings() -> BTreeMap<String, String> {
    let of_build = |name: &str| {
        name.starts_with("CARGO_FEATURE_")
            || ["OPT_LEVEL", "TARGET", "CARGO_CFG_TARGET_FEATURE"].contains(&name)
    };
    let mut settings: BTreeMap<String, String> = std::env::vars()
        .filter(|(name, _)| of_build(name))
        .collect();
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = match Command::new(&compiler).arg("-vV").output() {
        Ok(output) if output.status.success() => output.stdout,
        _ => panic!("cannot run {} -vV", compiler.display()),
    };
    let version = String::from_utf8_lossy(&version).replace("\r\n", "\n");
    settings.insert("rustc -vV".to_owned(), version);
    settings
}

/// The identity of `files` compiled with `settings`, hexadecimal.
pub(crate) fn identity_of(
    files: &BTreeMap<String, Vec<u8>>,
    settings: &BTreeMap<String, String>,
) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut add = |part: &[u8]| {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    };
    for (name, value) in settings {
        add(name.as_bytes());
        add(value.as_bytes());
    }
    add(b"files");
    for (name, content) in files {
        add(name.as_bytes());
        add(content);
    }
    hasher.finalize().to_hex()[..DIGITS].to_owned()
}

/// The commit whose covered files are those below `root`; `, changed` after it where some are not; `none` without one.
pub(crate) fn commit_of(root: &Path) -> String {
    let git = |arguments: &[&str], places: &[&str]| -> Option<String> {
        let output = Command::new("git")
            .args(arguments)
            .args(places)
            .current_dir(root)
            // A look at the state of the files is not to write the index.
            .env("GIT_OPTIONAL_LOCKS", "0")
            .output()
            .ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    // Sources unpacked inside of another repository are none of its files.
    let tracked = git(&["ls-files", "--error-unmatch", "--"], &["Cargo.toml"]);
    let commit = tracked.and_then(|_| git(&["rev-parse", "--verify", "HEAD"], &[]));
    let Some(commit) = commit else {
        return "none".to_owned();
    };
    match git(&["status", "--porcelain", "--"], &COVERED).as_deref() {
        Some("") => commit,
        _ => format!("{commit}, changed"),
    }
}
