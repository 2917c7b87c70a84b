//! The validation report: the program against references, measured anew by one command.
//!
//! `cargo test --release --test cases -- --ignored --nocapture the_validation_report` writes
//! `results/validation/report.md`.

mod basis_families;
mod nodal_diameters;
mod optimal_load;
mod reference_rows;

use std::fmt::Write;

use super::support::package;

/// A section of the report: its title and its text in Markdown.
struct Section {
    title: &'static str,
    text: String,
}

/// A table in Markdown.
fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let names: Vec<String> = header.iter().map(|&name| name.to_owned()).collect();
    let rule = vec!["---".to_owned(); header.len()];
    rows.iter()
        .fold(line(&names) + &line(&rule), |text, row| text + &line(row))
}

fn percent(share: f64) -> String {
    format!("{:.3} %", 100.0 * share)
}

#[test]
#[ignore = "takes many minutes; writes results/validation/report.md"]
fn the_validation_report() {
    let sections: [fn() -> Section; 4] = [
        reference_rows::section,
        basis_families::section,
        optimal_load::section,
        nodal_diameters::section,
    ];
    let mut report = format!(
        "# Validation report\n\nblisk {}. Made by `cargo test --release --test cases -- --ignored --nocapture \
         the_validation_report`; see studies/validation/README.md. Errors are relative.\n",
        env!("CARGO_PKG_VERSION")
    );
    for section in sections {
        let Section { title, text } = section();
        println!("## {title}\n\n{text}");
        write!(report, "\n## {title}\n\n{text}").unwrap();
    }
    let folder = package("results/validation");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("report.md"), report).unwrap();
}
