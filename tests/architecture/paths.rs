//! Reads the paths from `crate`, `super` and `self` in Rust sources: no compiler, just enough grammar.

use std::collections::BTreeMap;
use std::path::Path;

/// One source file without comments, strings and tests, and the paths it names.
pub struct Source {
    /// Path of the file, for messages.
    pub name: String,
    /// Its module path from the crate root; empty for `lib.rs` and `main.rs`.
    pub module: Vec<String>,
    /// The text as it stands in the file.
    pub text: String,
    /// Full paths within the crate that it names, from the crate root.
    pub paths: Vec<Vec<String>>,
    /// The text without comments, strings and tests.
    pub code: String,
}

/// Every `.rs` file under `root`, which is the crate root.
pub fn sources(root: &Path) -> Vec<Source> {
    let mut found = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let inside = path.strip_prefix(root).unwrap().with_extension("");
                let mut module: Vec<&str> =
                    inside.iter().map(|part| part.to_str().unwrap()).collect();
                if matches!(module.last(), Some(&"mod" | &"lib" | &"main")) {
                    module.pop();
                }
                let text = std::fs::read_to_string(&path).unwrap();
                found.push(Source::new(&path, &module, &text));
            }
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

impl Source {
    pub fn new(path: &Path, module: &[&str], text: &str) -> Self {
        let code = code_of(text);
        let module: Vec<String> = module.iter().map(|&part| part.to_owned()).collect();
        Self {
            name: path.display().to_string(),
            paths: paths_of(&code, &module, path.ends_with("mod.rs")),
            module,
            text: text.to_owned(),
            code,
        }
    }

    /// The file as seen from `src/`.
    pub fn inside(&self) -> String {
        let name = self.name.replace('\\', "/");
        name.rsplit_once("/src/")
            .map_or(name.clone(), |(_, inside)| inside.to_owned())
    }

    /// Whether `word` stands in the code, not as the end of a longer name.
    pub fn has_word(&self, word: &str) -> bool {
        self.code.match_indices(word).any(|(at, _)| {
            let before = self.code[..at].chars().next_back();
            !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':')
        })
    }
}

/// The files of a crate and what they name.
pub struct Crate<'a> {
    pub files: &'a [Source],
    by_module: BTreeMap<&'a [String], usize>,
}

impl<'a> Crate<'a> {
    pub fn new(files: &'a [Source]) -> Self {
        let modules = files.iter().enumerate();
        Self {
            by_module: modules
                .map(|(at, source)| (source.module.as_slice(), at))
                .collect(),
            files,
        }
    }

    /// The file in which what `path` names stands; none for what is outside the crate.
    pub fn file_of(&self, path: &[String]) -> Option<usize> {
        let longest = (1..=path.len()).rev();
        let module = { longest }.find(|&length| self.by_module.contains_key(&path[..length]))?;
        let file = self.by_module[&path[..module]];
        let Some(item) = path.get(module) else {
            return Some(file);
        };
        let offers = |offered: &&Vec<String>| {
            offered.len() > module + 1
                && offered[..module] == path[..module]
                && offered.last() == Some(item)
        };
        match self.files[file].paths.iter().find(offers) {
            Some(offered) => self.file_of(offered),
            None => Some(file),
        }
    }
}

/// The text up to its tests, without comments and the content of strings.
fn code_of(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or(text);
    let mut code = String::new();
    for line in text.lines() {
        let mut in_string = false;
        let mut characters = line.chars().peekable();
        while let Some(c) = characters.next() {
            match c {
                '\\' if in_string => {
                    characters.next();
                }
                '"' => in_string = !in_string,
                '/' if !in_string && characters.peek() == Some(&'/') => break,
                _ if !in_string => code.push(c),
                _ => {}
            }
        }
        code.push('\n');
    }
    code
}

fn paths_of(code: &str, module: &[String], is_mod: bool) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    for keyword in ["crate::", "super::"] {
        for (at, _) in code.match_indices(keyword) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
                continue;
            }
            let mut rest = &code[at..];
            let mut base: Vec<String> = Vec::new();
            if keyword == "super::" {
                base = module.to_vec();
                while let Some(after) = rest.strip_prefix("super::") {
                    base.pop();
                    rest = after;
                }
            } else {
                rest = &rest[keyword.len()..];
            }
            let mut found = Vec::new();
            tree(rest, &base, &mut found);
            paths.extend(found.into_iter().map(|path| (at, path)));
        }
    }
    if is_mod {
        // What a module offers of its own children: `pub use child::{...};`, or within the crate, `pub(crate) use`.
        for (at, _) in code.match_indices(" use ") {
            let line = code[..at].rsplit('\n').next().unwrap_or_default();
            if !line.trim_start().starts_with("pub") {
                continue;
            }
            let rest = &code[at + " use ".len()..];
            if !rest.starts_with("crate::") && !rest.starts_with("super::") {
                let mut found = Vec::new();
                tree(rest, module, &mut found);
                paths.extend(found.into_iter().map(|path| (at, path)));
            }
        }
    }
    paths.sort_by_key(|(at, _)| *at);
    paths.into_iter().map(|(_, path)| path).collect()
}

/// Reads one `a::b::{c, d::e as f}` at the start of `text` and returns what follows it.
fn tree<'a>(text: &'a str, base: &[String], paths: &mut Vec<Vec<String>>) -> &'a str {
    let mut path = base.to_vec();
    let mut rest = text.trim_start();
    loop {
        if let Some(inside) = rest.strip_prefix('{') {
            rest = inside.trim_start();
            while !rest.starts_with('}') && !rest.is_empty() {
                rest = tree(rest, &path, paths);
                rest = rest.trim_start().trim_start_matches(',').trim_start();
            }
            return rest.strip_prefix('}').unwrap_or(rest);
        }
        let end = rest
            .find(|c: char| !(c.is_alphanumeric() || c == '_'))
            .unwrap_or(rest.len());
        let word = &rest[..end];
        rest = &rest[end..];
        if word != "self" && !word.is_empty() {
            path.push(word.to_owned());
        }
        match rest.strip_prefix("::") {
            Some(after) if !after.starts_with('<') => rest = after,
            _ => break,
        }
    }
    paths.push(path);
    let after = rest.trim_start();
    match after.strip_prefix("as ") {
        Some(renamed) => {
            let end = renamed
                .find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(renamed.len());
            &renamed[end..]
        }
        None => rest.strip_prefix('*').unwrap_or(rest),
    }
}
