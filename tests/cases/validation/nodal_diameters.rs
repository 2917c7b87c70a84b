//! How well the ring works by nodal diameter.

use blisk::response::forced_response::ContactCondition;
use blisk::study::{Engine, EngineSource, ReducedEngineSource, Study, load_sector_model};
use rayon::prelude::*;

use super::super::support::package;
use super::{Section, table};

pub(super) fn section() -> Section {
    let study = Study::read(&package("studies/validation/nodal-diameters.toml")).unwrap();
    let model = load_sector_model(&study).unwrap();
    let engine = ReducedEngineSource.build(&study, &model, None).unwrap();
    let rows: Vec<Vec<String>> = study
        .engine_orders
        .par_iter()
        .map(|&engine_order| row(&study, engine.as_ref(), engine_order))
        .collect();
    let header = [
        "nodal diameter",
        "slide, um",
        "stuck, um",
        "lowest over loads, um",
        "at, N",
        "slide over lowest",
        "separated there",
    ];
    let text = format!(
        "Built-in wheel, tuned, one harmonic; the lowest of the tuned peaks over the normal loads of studies/validation/nodal-diameters.toml, \
         for engine orders equal to the nodal diameter. Basis {}.\n\n{}",
        engine.model_report().basis,
        table(&header, &rows)
    );
    Section {
        title: "Effect of the ring by nodal diameter",
        text,
    }
}

fn row(study: &Study, engine: &dyn Engine, engine_order: u32) -> Vec<String> {
    let tuned: Vec<_> = study
        .scenarios()
        .into_iter()
        .filter(|scenario| scenario.engine_order == engine_order)
        .map(|scenario| (scenario.contact, engine.tuned(&scenario)))
        .collect();
    let of = |wanted: ContactCondition| {
        let found = tuned.iter().find(|(contact, _)| *contact == wanted);
        found.and_then(|(_, tuned)| tuned.amplitude_m).unwrap()
    };
    let (slide, stuck) = (of(ContactCondition::Slide), of(ContactCondition::Stuck));
    let lowest = tuned
        .iter()
        .filter_map(|(contact, tuned)| Some((contact.normal_load_n()?, tuned.amplitude_m?, tuned)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let (load, amplitude, at) = lowest.unwrap();
    vec![
        engine_order.to_string(),
        format!("{:.2}", 1e6 * slide),
        format!("{:.2}", 1e6 * stuck),
        format!("{:.2}", 1e6 * amplitude),
        format!("{load}"),
        format!("{:.2}", slide / amplitude),
        format!("{:.2}", at.separated_fraction.unwrap()),
    ]
}
