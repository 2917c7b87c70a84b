//! The table `[excitation]`, engine orders, amplitudes and load cases: from the file, and back.

use std::collections::BTreeSet;
use std::path::Path;

use super::check::Check;
use crate::population::monte_carlo::LoadCaseName;
use crate::study::keys::excitation::{EXCITATION_N, ExcitationTable, LoadCaseTable};
use crate::study::keys::written::OneOrMore;
use crate::study::{ForceSource, LoadCase, Study};

/// What `[excitation]` came to.
pub(super) struct Excited {
    /// Engine orders; with load cases, those of all of them.
    pub(super) engine_orders: Vec<u32>,
    /// Factor on the force vector, and those of the engine orders where each has its own.
    pub(super) amplitudes: Amplitudes,
    /// Load cases.
    pub(super) load_cases: Vec<LoadCase>,
}

/// One factor for all engine orders, or one each.
type Amplitudes = (f64, Vec<f64>);

pub(super) fn excitation(
    check: &mut Check,
    study_file: &Path,
    excitation: ExcitationTable,
) -> Excited {
    let Some(cases) = excitation.load_case else {
        let engine_orders = engine_orders(check, "excitation", excitation.engine_orders.as_deref());
        let orders = engine_orders.len();
        return Excited {
            amplitudes: amplitudes(check, "excitation", excitation.amplitude_n.as_ref(), orders),
            engine_orders,
            load_cases: Vec::new(),
        };
    };
    if cases.is_empty() {
        check.refuse_for(
            "excitation.load_case",
            "at least one [[excitation.load_case]], or none of them and engine_orders",
        );
    }
    for (key, is_used) in [
        (
            "engine_orders",
            cases.iter().any(|case| case.engine_orders.is_none()),
        ),
        (
            "amplitude_n",
            cases.iter().any(|case| case.amplitude_n.is_none()),
        ),
    ] {
        let key = format!("excitation.{key}");
        if !is_used && check.is_written(&key) {
            check.conflict(
                &key,
                "every load case has its own; accepted: one of the two",
            );
        }
    }
    let mut load_cases: Vec<LoadCase> = Vec::new();
    let mut names = BTreeSet::new();
    for (place, case) in cases.into_iter().enumerate() {
        let table = format!("excitation.load_case[{place}]");
        let name = name(check, &table, case.name.as_deref(), &mut names);
        let force = force(check, study_file, &table, &case);
        let (owner, orders) = match case.engine_orders {
            None if excitation.engine_orders.is_some() => ("excitation", &excitation.engine_orders),
            _ => (table.as_str(), &case.engine_orders),
        };
        let engine_orders = engine_orders(check, owner, orders.as_deref());
        let (owner, amplitude_n) = match case.amplitude_n {
            None => ("excitation", &excitation.amplitude_n),
            Some(_) => (table.as_str(), &case.amplitude_n),
        };
        let (amplitude_n, amplitudes_n) =
            amplitudes(check, owner, amplitude_n.as_ref(), engine_orders.len());
        if let Some(name) = name {
            load_cases.push(LoadCase {
                name,
                force,
                engine_orders,
                amplitude_n,
                amplitudes_n,
            });
        }
    }
    let mut seen = BTreeSet::new();
    let orders = load_cases.iter().flat_map(|case| &case.engine_orders);
    Excited {
        engine_orders: orders
            .copied()
            .filter(|&order| seen.insert(order))
            .collect(),
        amplitudes: (1.0, Vec::new()),
        load_cases,
    }
}

fn name(
    check: &mut Check,
    table: &str,
    written: Option<&str>,
    before: &mut BTreeSet<String>,
) -> Option<LoadCaseName> {
    let key = format!("{table}.name");
    let Some(written) = written else {
        check.missing(&key);
        return None;
    };
    let name = LoadCaseName::new(written).filter(|_| before.insert(written.to_owned()));
    if name.is_none() {
        check.refuse(&key);
    }
    name
}

fn force(check: &mut Check, study_file: &Path, table: &str, case: &LoadCaseTable) -> ForceSource {
    let direction_key = format!("{table}.direction");
    match (&case.force, &case.node) {
        (Some(_), Some(_)) => {
            let reason = "a load case has one force vector; accepted: one of force and node";
            check.conflict(&format!("{table}.node"), reason);
        }
        (Some(written), None) => {
            if case.direction.is_some() {
                check.conflict(&direction_key, "it belongs to node, which is not there");
            }
            return ForceSource::File {
                written: written.clone(),
                path: Study::beside(study_file, written),
            };
        }
        (None, Some(node)) => {
            let direction = case.direction.as_deref();
            match direction.map(<[f64; 3]>::try_from) {
                Some(Ok(direction))
                    if direction.iter().all(|part| part.is_finite())
                        && direction.iter().any(|part| *part != 0.0) =>
                {
                    return ForceSource::Node {
                        node: node.clone(),
                        direction,
                    };
                }
                Some(_) => check.refuse(&direction_key),
                None => check.missing(&direction_key),
            }
        }
        (None, None) if case.direction.is_some() => {
            check.conflict(&direction_key, "it belongs to node, which is not there");
        }
        (None, None) => {}
    }
    ForceSource::Model
}

/// Engine orders of the table `table`; empty, and a finding, where they are missing or refused.
fn engine_orders(check: &mut Check, table: &str, raw: Option<&[u32]>) -> Vec<u32> {
    let key = format!("{table}.engine_orders");
    let orders = raw.unwrap_or_default().to_vec();
    let mut sorted = orders.clone();
    sorted.sort_unstable();
    sorted.dedup();
    if raw.is_none() {
        check.missing(&key);
    } else if orders.is_empty() || sorted.len() < orders.len() || sorted.last() > Some(&10_000) {
        check.refuse(&key);
    }
    orders
}

/// Factor on the force vector, and those of the engine orders where each has its own.
fn amplitudes(
    check: &mut Check,
    table: &str,
    raw: Option<&OneOrMore>,
    orders: usize,
) -> Amplitudes {
    let key = format!("{table}.amplitude_n");
    let possible = |amplitude: &f64| EXCITATION_N.holds(*amplitude);
    match raw {
        None => (1.0, Vec::new()),
        Some(OneOrMore::One(amplitude)) => {
            if !possible(amplitude) {
                check.refuse(&key);
            }
            (*amplitude, Vec::new())
        }
        Some(OneOrMore::List(amplitudes)) => {
            if amplitudes.len() != orders || !amplitudes.iter().all(possible) {
                let accepted = format!(
                    "a number from 1e-30 to 1e30, in N, or a list of {orders}, one per engine order"
                );
                check.refuse_for(&key, &accepted);
            }
            (1.0, amplitudes.clone())
        }
    }
}

/// `[excitation]` as a study file has it.
pub(super) fn excitation_table(study: &Study) -> ExcitationTable {
    if study.load_cases.is_empty() {
        return ExcitationTable {
            engine_orders: Some(study.engine_orders.clone()),
            amplitude_n: Some(written(study.amplitude_n, &study.amplitudes_n)),
            load_case: None,
        };
    }
    let cases = study.load_cases.iter();
    let cases = cases.map(|case| {
        let mut table = LoadCaseTable {
            name: Some(case.name.to_string()),
            engine_orders: Some(case.engine_orders.clone()),
            amplitude_n: Some(written(case.amplitude_n, &case.amplitudes_n)),
            ..LoadCaseTable::default()
        };
        match &case.force {
            ForceSource::Model => {}
            ForceSource::File { written, .. } => table.force = Some(written.clone()),
            ForceSource::Node { node, direction } => {
                table.node = Some(node.clone());
                table.direction = Some(direction.to_vec());
            }
        }
        table
    });
    ExcitationTable {
        load_case: Some(cases.collect()),
        ..ExcitationTable::default()
    }
}

/// A factor on the force vector as a study file has it.
fn written(amplitude_n: f64, amplitudes_n: &[f64]) -> OneOrMore {
    if amplitudes_n.is_empty() {
        OneOrMore::One(amplitude_n)
    } else {
        OneOrMore::List(amplitudes_n.to_vec())
    }
}
