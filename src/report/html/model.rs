//! The model on the page: what it is, its frequencies, and pictures of both.

use std::fmt::Write;

use super::table::Table;
use crate::model::sector::Body;
use crate::report::figures::{Figure, body_word, figure};
use crate::report::plot::escaped;
use crate::report::words::{excitation, four_digits, tied};
use crate::report::{BodyMass, FIGURES, ModelSection, ShownModel, StudyReport};

/// Modes whose frequencies are listed.
const LISTED: usize = 3;

/// The section of the model.
pub(super) fn model(report: &StudyReport) -> String {
    let mut html = "<section id=\"model\">\n<h2>The model</h2>\n".to_owned();
    match &report.model {
        ShownModel::NotShown { reason } => {
            // Writing to a String cannot fail.
            let _ = writeln!(
                html,
                "<p class=\"quiet\">The model is not shown: {}.</p>",
                escaped(reason)
            );
        }
        ShownModel::Shown(section) => {
            html.push_str("<div class=\"figures\">\n");
            if let Some(group) = report.groups.first() {
                let of_model = FIGURES.iter().filter(|(name, ..)| name.is_of_model());
                for (name, words, _) in of_model {
                    if let Some(drawn) = figure(report, group, *name) {
                        html.push_str(&figure_html(&drawn, &format!("{words}-0")));
                    }
                }
            }
            html.push_str("</div>\n");
            html.push_str(&facts(report, section));
        }
    }
    html.push_str("</section>\n");
    html
}

/// A figure with its title and caption.
pub(super) fn figure_html(drawn: &Figure, id: &str) -> String {
    format!(
        "<figure id=\"{id}\"><h3>{}</h3>\n{}<figcaption>{}</figcaption></figure>\n",
        escaped(&tied(&drawn.title)),
        drawn.inline(id),
        escaped(&tied(&drawn.caption))
    )
}

fn facts(report: &StudyReport, section: &ModelSection) -> String {
    let echo = &section.echo;
    let sectors = echo.model.sectors;
    let mut table = Table::of_facts();
    table.fact("model", &echo.model.name);
    table.fact("sectors", &sectors.to_string());
    table.fact(
        "degrees of freedom",
        &format!(
            "{} per sector, both cyclic faces included",
            echo.model.sector_dofs
        ),
    );
    for mass in &section.masses {
        table.fact(&mass_name(report, mass), &mass_words(mass, sectors));
    }
    table.fact(
        "contact pairs",
        &format!("{} per sector", echo.model.contact_pairs),
    );
    match &section.contact {
        None => table.fact("contact law", "none: a model without contact"),
        Some(contact) => {
            table.fact("contact law", &contact.law.replace('_', " "));
            table.fact(
                "friction coefficient μ",
                &contact.friction_coefficient.to_string(),
            );
            let stiffness = |own: f64| format!("{own:e} N/m per sector");
            table.fact(
                "tangential contact stiffness kt",
                &stiffness(contact.tangential_stiffness_n_per_m),
            );
            table.fact(
                "normal contact stiffness kn",
                &contact
                    .normal_stiffness_n_per_m
                    .map_or_else(|| "none: the normal load is constant".to_owned(), stiffness),
            );
        }
    }
    table.fact("damping", &echo.damping);
    table.fact("mistuning", &echo.mistuning);
    for own in &echo.excitations {
        table.fact(
            &excitation(own.load_case, own.engine_order),
            &own.in_words(),
        );
    }
    table.fact("solved with", &echo.settings);
    for (name, frequencies) in frequencies(section) {
        table.fact(&name, &frequencies);
    }
    for remark in &echo.remarks {
        table.fact("remark", &remark.to_string());
    }
    table.html()
}

fn mass_name(report: &StudyReport, mass: &BodyMass) -> String {
    match mass.body {
        Body::Blisk => "mass of disk and blade".to_owned(),
        body => format!("mass of the {}", body_word(report, body)),
    }
}

fn mass_words(mass: &BodyMass, sectors: usize) -> String {
    let of_wheel = mass.sector_kg * sectors as f64;
    let held = if mass.body == Body::Blisk {
        "; without nodes that are held"
    } else {
        ""
    };
    format!(
        "{} kg per sector, {} kg on the wheel{held}",
        four_digits(mass.sector_kg),
        four_digits(of_wheel)
    )
}

/// The lowest frequencies of each nodal diameter that is excited, by contact.
fn frequencies(section: &ModelSection) -> Vec<(String, String)> {
    let mut excited: Vec<usize> = { section.echo.excitations.iter() }
        .map(|own| own.nodal_diameter)
        .collect();
    excited.sort_unstable();
    excited.dedup();
    let mut found = Vec::new();
    for nodal_diameter in excited {
        for contact in ["stuck", "slide", "free"] {
            let modes = { section.campbell.modes.iter() }
                .filter(|mode| mode.nodal_diameter == nodal_diameter && mode.contact == contact);
            let hz: Vec<String> = modes
                .take(LISTED)
                .map(|mode| format!("{:.2}", mode.frequency_hz[0]))
                .collect();
            if !hz.is_empty() {
                found.push((
                    format!("frequencies, nodal diameter {nodal_diameter}, {contact}"),
                    format!("{} Hz", hz.join(", ")),
                ));
            }
        }
    }
    found
}
