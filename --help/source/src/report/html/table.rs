//! An HTML table under construction.

use std::fmt::Write;

use crate::report::plot::escaped;

/// Rows of cells under a header; cells are HTML.
#[derive(Debug, Clone)]
pub(super) struct Table {
    class: &'static str,
    header: Vec<String>,
    rows: Vec<(bool, Vec<String>)>,
}

impl Table {
    pub(super) fn new(header: &[&str]) -> Self {
        Self {
            class: "",
            header: header.iter().map(|cell| escaped(cell)).collect(),
            rows: Vec::new(),
        }
    }

    /// A table of names and what they stand for.
    pub(super) fn of_facts() -> Self {
        Self {
            class: "facts",
            ..Self::new(&[])
        }
    }

    pub(super) fn row(&mut self, cells: Vec<String>) {
        self.rows.push((false, cells));
    }

    /// A row that stands out if `chosen`.
    pub(super) fn row_chosen(&mut self, chosen: bool, cells: Vec<String>) {
        self.rows.push((chosen, cells));
    }

    pub(super) fn fact(&mut self, name: &str, value: &str) {
        self.row(vec![escaped(name), escaped(value)]);
    }

    /// The table in a box that scrolls where it is too wide.
    pub(super) fn html(&self) -> String {
        let mut html = format!("<div class=\"wide\"><table class=\"{}\">\n", self.class);
        let cells = |tag: &str, cells: &[String]| -> String {
            let cells = cells.iter().map(|cell| format!("<{tag}>{cell}</{tag}>"));
            cells.collect()
        };
        if !self.header.is_empty() {
            // Writing to a String cannot fail.
            let _ = writeln!(
                html,
                "<thead><tr>{}</tr></thead>",
                cells("th", &self.header)
            );
        }
        html.push_str("<tbody>\n");
        for (chosen, row) in &self.rows {
            let class = if *chosen { " class=\"chosen\"" } else { "" };
            let _ = writeln!(html, "<tr{class}>{}</tr>", cells("td", row));
        }
        html.push_str("</tbody></table></div>\n");
        html
    }
}
