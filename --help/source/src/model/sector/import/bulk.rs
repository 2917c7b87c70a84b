//! The entries of Nastran's bulk data: fields of 8, fields of 16 (a star after the name), or commas.

use super::source::Source;

/// A bulk data entry: its name, and its fields with the line each stands on.
#[derive(Debug)]
pub(super) struct Entry<'a> {
    pub name: String,
    pub line: usize,
    fields: Vec<(usize, &'a str)>,
}

impl<'a> Entry<'a> {
    /// A field after the name, counted from 0; empty where there is none.
    pub fn field(&self, index: usize) -> &'a str {
        self.fields.get(index).map_or("", |&(_, word)| word)
    }

    /// The fields from `index` on, with their lines.
    pub fn fields_from(&self, index: usize) -> &[(usize, &'a str)] {
        self.fields.get(index..).unwrap_or_default()
    }
}

/// All entries of a file, each with its continuations.
pub(super) fn entries(source: &Source) -> Vec<Entry<'_>> {
    let mut entries: Vec<Entry<'_>> = Vec::new();
    for (line, text) in source.lines() {
        let text = text.split('$').next().unwrap_or("");
        if text.trim().is_empty() {
            continue;
        }
        let (name, fields) = split(text);
        let continues = name.is_empty() || name.starts_with(['+', '*']);
        let fields = fields.into_iter().map(|field| (line, field));
        match entries.last_mut() {
            Some(entry) if continues => entry.fields.extend(fields),
            _ if continues => {}
            _ => entries.push(Entry {
                name: name.trim_end_matches('*').trim().to_ascii_uppercase(),
                line,
                fields: fields.collect(),
            }),
        }
    }
    entries
}

/// First field and the others: eight of 8 characters, four of 16, or as many as there are commas.
fn split(line: &str) -> (&str, Vec<&str>) {
    if line.contains(',') {
        let mut words = line.split(',').map(str::trim);
        let name = words.next().unwrap_or("");
        let mut fields: Vec<&str> = words.collect();
        fields.resize(if name.contains('*') { 4 } else { 8 }, "");
        return (name, fields);
    }
    let piece = |start: usize, width: usize| {
        line.get(start..)
            .map_or("", |rest| rest.get(..width).unwrap_or(rest))
            .trim()
    };
    let name = piece(0, 8);
    let (count, width) = if name.contains('*') { (4, 16) } else { (8, 8) };
    (
        name,
        (0..count).map(|i| piece(8 + i * width, width)).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_large_and_free_fields_are_the_same_entry() {
        let small = "GRID          12        1.5     -2.+1      .5\n";
        let large = "GRID*                 12                             1.5           -2.+1\n*                     .5\n";
        let free = "GRID,12,,1.5,-2.+1,.5 $ a comment\n";
        for text in [small, large, free] {
            let source = Source {
                path: "x.bdf".into(),
                text: text.to_owned(),
            };
            let entries = entries(&source);
            assert_eq!(entries.len(), 1, "{text}");
            assert_eq!(entries[0].name, "GRID");
            let fields: Vec<&str> = (0..5).map(|i| entries[0].field(i)).collect();
            assert_eq!(fields, ["12", "", "1.5", "-2.+1", ".5"], "{text}");
        }
    }
}
