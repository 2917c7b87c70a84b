//! What a group opens with: three numbers, whether anything is wrong, the main figure, and the folded answers.

use std::fmt::Write;

use super::headline::{BigNumber, big_numbers, in_one_line};
use super::health::health;
use super::measured_wheels::of_measured_wheels;
use super::model::figure_html;
use crate::report::plot::escaped;
use crate::report::words::tied;
use crate::report::{Answer, FigureName, GroupReport, StudyReport, answers, figure, setting};

/// Numbers, main figure and answers of a group.
pub(super) fn first_screen(report: &StudyReport, group: &GroupReport, place: usize) -> String {
    let mut html = format!(
        "<section id=\"answer-{place}\">\n<h2>{}</h2>\n<div class=\"first\">\n<div class=\"numbers\">\n",
        escaped(&setting(group))
    );
    for BigNumber {
        label,
        value,
        told,
        notes,
        more,
        is_open,
    } in of_measured_wheels(report, group).unwrap_or_else(|| big_numbers(report, group))
    {
        let class = if is_open { "number look" } else { "number" };
        // Writing to a String cannot fail.
        let _ = write!(
            html,
            "<div class=\"{class}\"><p class=\"label\">{}</p><p class=\"value\">{}</p>",
            escaped(&label),
            escaped(&tied(&value))
        );
        if let Some(told) = told {
            let _ = write!(html, "<p class=\"told\">{}</p>", escaped(&tied(&told)));
        }
        for note in marked_up(&notes, more) {
            let _ = write!(html, "<p class=\"note\">{note}</p>");
        }
        html.push_str("</div>\n");
    }
    if place == 0 {
        html.push_str(&health_of(report));
    }
    html.push_str("</div>\n");
    if let Some(drawn) = figure(report, group, FigureName::Amplitude) {
        html.push_str(&figure_html(&drawn, &format!("amplitude-{place}")));
    }
    html.push_str("</div>\n");
    html.push_str(&folded(report, group));
    html.push_str("</section>\n");
    html
}

/// Letters of a line of notes on a telephone.
const LINE: usize = 40;

/// Notes, and the link to more of the page: beside the last note where both are one line.
fn marked_up(notes: &[String], more: Option<(String, String)>) -> Vec<String> {
    let mut lines: Vec<String> = notes.iter().map(|note| escaped(&tied(note))).collect();
    let Some((target, words)) = more else {
        return lines;
    };
    let link = format!("<a href=\"#{target}\">{}</a>", escaped(&words));
    let letters = |text: &String| text.chars().count() + words.chars().count() + 2;
    match (lines.last_mut(), notes.last()) {
        (Some(line), Some(note)) if letters(note) <= LINE => {
            line.push_str("; ");
            line.push_str(&link);
        }
        _ => lines.push(link),
    }
    lines
}

/// Findings that are named, and on a telephone.
const NAMED: usize = 4;
const NAMED_NARROW: usize = 3;

fn health_of(report: &StudyReport) -> String {
    let mut html = String::new();
    for (place, found) in health(report).into_iter().enumerate() {
        let _ = write!(
            html,
            "<div class=\"health {}\"><p><strong>{}</strong></p>",
            found.class,
            escaped(&tied(&found.verdict))
        );
        if !found.findings.is_empty() {
            html.push_str("<ul>");
            let all = found.findings.len();
            // The last one takes no more room than that there is one more.
            let [named, narrow] =
                [NAMED, NAMED_NARROW].map(|named| if all == named + 1 { all } else { named });
            for (place, finding) in found.findings.iter().take(named).enumerate() {
                let class = if place < narrow {
                    ""
                } else {
                    " class=\"spacious\""
                };
                let _ = write!(html, "<li{class}>{}</li>", escaped(&tied(finding)));
            }
            for (named, class) in [(named, "spacious"), (narrow, "narrow")] {
                if all > named {
                    let _ = write!(html, "<li class=\"{class}\">and {} more</li>", all - named);
                }
            }
            html.push_str("</ul>");
        }
        if place == 0 && found.class != "good" {
            html.push_str(
                "<p><a href=\"#warnings\">All, and what to do: section “Warnings”</a></p>",
            );
        }
        html.push_str("</div>\n");
    }
    html
}

/// The questions with their answers; what each rests on is folded.
fn folded(report: &StudyReport, group: &GroupReport) -> String {
    let mut html = "<div class=\"answers\">\n".to_owned();
    for Answer {
        question,
        verdict,
        reasons,
    } in answers(report, group)
    {
        let _ = writeln!(
            html,
            "<details class=\"answer\"><summary><span class=\"question\">{}</span> <span class=\"verdict\">{}</span></summary>",
            escaped(&tied(&question)),
            escaped(&tied(&verdict))
        );
        for reason in reasons {
            let _ = writeln!(html, "<p>{}</p>", escaped(&tied(&reason)));
        }
        html.push_str("</details>\n");
    }
    html.push_str("</div>\n");
    html
}

/// Links to the parts of the page; of several groups each with its answer.
pub(super) fn contents(report: &StudyReport) -> String {
    let several = report.groups.len() > 1;
    // On paper links between several settings still say what each answers.
    let class = if several { "several" } else { "one" };
    let mut html = format!(
        "<nav id=\"contents\" class=\"{class}\" aria-label=\"Contents\">\n<h2>Contents</h2>\n<ul>\n"
    );
    let mut entry = |target: &str, words: &str| {
        let _ = writeln!(
            html,
            "<li><a href=\"#{target}\">{}</a></li>",
            escaped(&tied(words))
        );
    };
    if !report.warnings_in_words().is_empty() {
        entry("warnings", "Warnings");
    }
    entry("model", "The model");
    for (place, group) in report.groups.iter().enumerate() {
        if several {
            entry(&format!("answer-{place}"), &in_one_line(report, group));
        } else {
            entry("population-0", "The population");
            entry("wheels-0", "Single wheels");
            entry("numbers-0", "Numbers");
        }
    }
    entry("accounting", "Accounting");
    entry("words", "Words");
    entry("provenance", "Provenance");
    html.push_str("</ul>\n</nav>\n");
    html
}
