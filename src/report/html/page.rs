//! The page: answers first, then figures, tables and provenance.

use std::fmt::Write;

use super::first_screen::{contents, first_screen};
use super::model::{figure_html, model};
use super::table::Table;
use super::tables;
use crate::input::term_of;
use crate::report::figures::friction_words;
use crate::report::plot::{escaped, page_style};
use crate::report::words::{loads_and_limits, tied};
use crate::report::{FIGURES, FigureName, GroupReport, StudyReport, Wheels, figure, setting};

/// Style of everything but the plots.
const STYLE: &str = include_str!("page.css");

/// The report as a page of its own: no script, no font, no image from elsewhere; the same numbers give the
/// same bytes.
#[must_use]
pub fn html_report(report: &StudyReport) -> String {
    let name = escaped(&report.summary.name);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"generator\" content=\"blisk {version}\">\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <title>{name}: forced response under random mistuning</title>\n<style>\n{}{STYLE}</style>\n</head>\n<body>\n",
        page_style(),
        version = escaped(&report.provenance.version),
    );
    page.push_str(&header(report));
    page.push_str("<main>\n");
    for (place, group) in report.groups.iter().enumerate() {
        // The ladder is of the study, not of one of its sections.
        let settings = if place == 0 {
            tables::settings(report)
        } else {
            String::new()
        };
        page.push_str(&first_screen(report, group, place));
        if place == 0 {
            page.push_str(&contents(report));
            page.push_str(&warnings(report));
            page.push_str(&model(report));
        }
        page.push_str(&figures_of(report, group, place));
        page.push_str(&tables_of(report, group, place, &settings));
    }
    page.push_str(&end(report));
    page.push_str("</main>\n");
    // Writing to a String cannot fail.
    let _ = writeln!(
        page,
        "<footer>Made by blisk {} from the tables of this study; the same numbers are in \
         <code>blisk report DIR --json</code>, and one table for a spreadsheet in <code>blisk stats DIR --csv</code>.</footer>\n</body>\n</html>",
        escaped(&report.provenance.version)
    );
    page
}

fn header(report: &StudyReport) -> String {
    let summary = &report.summary;
    let first = { report.groups.first() }.map_or(&[][..], |group| &group.scenarios);
    let loads = loads_and_limits(first.iter().map(|&own| &summary.scenarios[own]));
    let settings = match report.groups.len() {
        0 | 1 => String::new(),
        several => format!(" in {several} settings"),
    };
    let (failed, planned) = (summary.rows.failed(), summary.rows.planned());
    let rows = if failed == 0 {
        format!("all {planned} rows have a result")
    } else {
        format!("{failed} of {planned} rows failed")
    };
    let stop = summary.stop.as_ref().map_or_else(String::new, |stop| {
        let met = if stop.met { "reached" } else { "not reached" };
        format!(
            " The wanted width of P{} was {met}; bounds hold at {:.1} %, so that all looks together hold with 95 %.",
            stop.wanted.percentile,
            100.0 * stop.confidence
        )
    });
    format!(
        "<header>\n<h1>Mistuned forced response</h1>\n<p class=\"quiet\">Study “{}”, bladed disks with {}: \
         {} patterns, {loads}{settings}; {rows}.{stop}</p>\n</header>\n",
        escaped(&summary.name),
        friction_words(report),
        summary.patterns,
    )
}

fn warnings(report: &StudyReport) -> String {
    let warnings = report.warnings_in_words();
    if warnings.is_empty() {
        return String::new();
    }
    let mut items = String::new();
    for warning in warnings {
        let _ = writeln!(items, "<li>{}</li>", escaped(&tied(&warning)));
    }
    format!(
        "<section id=\"warnings\">\n<h2>Warnings</h2>\n<ul class=\"warnings\">\n{items}</ul>\n</section>\n"
    )
}

/// Words of the page, which `blisk explain` knows too.
const TERMS: [&str; 12] = [
    "normal load N",
    "stuck (contact, load)",
    "slide (contact, load)",
    "free (contact, load)",
    "pattern",
    "amplification factor",
    "tuned wheel",
    "peak amplitude",
    "percentile P50, P95, P99",
    "bounds, 95 % interval",
    "stated error, numerical error",
    "crossing",
];

fn words() -> String {
    let mut table = Table::of_facts();
    for term in TERMS.into_iter().filter_map(term_of) {
        table.fact(term.word, term.meaning);
    }
    format!(
        "<section id=\"words\">\n<h2>Words</h2>\n<details><summary>What the words of this page mean</summary>\n{}</details>\n</section>\n",
        table.html()
    )
}

/// Figures of the population, then those of single wheels.
fn figures_of(report: &StudyReport, group: &GroupReport, place: usize) -> String {
    let several = report.groups.len() > 1;
    let heading = |words: &str| {
        if several {
            format!("{words}: {}", setting(group))
        } else {
            words.to_owned()
        }
    };
    let mut html = String::new();
    for (id, words, wheels) in [
        ("population", "The population", false),
        ("wheels", "Single wheels", true),
    ] {
        let _ = writeln!(
            html,
            "<section id=\"{id}-{place}\">\n<h2>{}</h2>",
            escaped(&heading(words))
        );
        if let (true, Wheels::NotSolved { reason }) = (wheels, &group.wheels) {
            let _ = writeln!(
                html,
                "<p class=\"quiet\">No wheels were solved again: {}.</p>",
                escaped(reason)
            );
        }
        html.push_str("<div class=\"figures\">\n");
        for (name, words, _) in FIGURES {
            // The main figure stands beside the answer, those of the model in its section.
            let elsewhere = name == FigureName::Amplitude || name.is_of_model();
            let again = name == FigureName::Accuracy && place > 0;
            if name.is_of_wheels() != wheels || elsewhere || again {
                continue;
            }
            if let Some(drawn) = figure(report, group, name) {
                html.push_str(&figure_html(&drawn, &format!("{words}-{place}")));
            }
        }
        html.push_str("</div>\n</section>\n");
    }
    html
}

fn tables_of(report: &StudyReport, group: &GroupReport, place: usize, settings: &str) -> String {
    format!(
        "<section id=\"numbers-{place}\">\n<h2>Numbers: {}</h2>\n<h3>Peak amplitude, 95 % bounds in brackets</h3>\n{}{}\
         <h3>Amplification factor, 95 % bounds in brackets</h3>\n{}\
         <h3>Numerical error (median of the rows) beside the statistical interval, both relative</h3>\n{}\
         <h3>Tail fits at the chosen load, a second opinion beside the sample</h3>\n{}\
         <p class=\"quiet\">* outside of the bounds of the sample; + beyond 1 − 1/n, where no value of the sample \
         reaches. – not estimable.</p>\n{settings}</section>\n",
        escaped(&setting(group)),
        tables::amplitudes(report, group),
        tables::stresses(report, group),
        tables::factors(report, group),
        tables::errors(report, group),
        tables::tails(report, group),
    )
}

fn end(report: &StudyReport) -> String {
    let made = &report.provenance;
    let pretty = |value: &serde_json::Value| {
        let text = serde_json::to_string_pretty(value).unwrap_or_default();
        escaped(&text)
    };
    format!(
        "<section id=\"accounting\">\n<h2>Accounting</h2>\n<p class=\"quiet\">Every planned row by status; failed rows stand at both \
         infinities in the bounds. Last column: one-sided 95 % bound.</p>\n{}</section>\n{}\
         <section id=\"provenance\">\n<h2>Provenance</h2>\n{}<details><summary>The study with every default filled in</summary>\n\
         <pre>{}</pre></details>\n<details><summary>Settings that the program chose</summary>\n<pre>{}</pre></details>\n\
         </section>\n",
        tables::accounting(report),
        words(),
        tables::provenance(report),
        pretty(&made.study),
        pretty(&made.chosen),
    )
}
