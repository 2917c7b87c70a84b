//! Scenarios in the words of a reader: loads and what else tells them apart, in the place of their numbers.

use super::words::{excitation, load_with_unit, trimmed};
use super::{ScenarioSummary, StudySummary};

impl StudySummary {
    /// The scenarios of these indices by load, engine order and standard deviation; of the last two only what differs
    /// within the study.
    #[must_use]
    pub(super) fn scenarios_in_words(&self, indices: &[usize]) -> String {
        let groups = self.scenarios.chunk_by(ScenarioSummary::same_group);
        let parts: Vec<String> = groups
            .filter_map(|group| {
                let meant: Vec<&ScenarioSummary> = { group.iter() }
                    .filter(|own| indices.contains(&own.scenario))
                    .collect();
                let first = meant.first()?;
                let loads = if meant.len() == group.len() && group.len() > 1 {
                    "all loads".to_owned()
                } else {
                    let loads = { meant.iter() };
                    let loads = loads.map(|own| load_with_unit(own.contact, own.normal_load_n));
                    loads.collect::<Vec<_>>().join(", ")
                };
                let told = self.told_apart(first);
                Some(if told.is_empty() {
                    loads
                } else {
                    format!("{loads} ({told})")
                })
            })
            .collect();
        parts.join("; ")
    }

    /// What tells the group of a scenario from the others of the study; empty where there is one group alone.
    fn told_apart(&self, own: &ScenarioSummary) -> String {
        let differs = |same: &dyn Fn(&ScenarioSummary) -> bool| !self.scenarios.iter().all(same);
        let excitations = differs(&|other| {
            other.load_case == own.load_case && other.engine_order == own.engine_order
        });
        let deviations = differs(&|other| other.standard_deviation == own.standard_deviation);
        let deviation = own
            .standard_deviation
            .filter(|_| deviations)
            .map(|deviation| format!("standard deviation {} %", trimmed(100.0 * deviation)));
        let excitation = excitations.then(|| excitation(own.load_case, own.engine_order));
        let told: Vec<String> = excitation.into_iter().chain(deviation).collect();
        told.join(", ")
    }
}

/// How many loads in newtons and how many linear limits there are, in words.
pub(super) fn loads_and_limits<'a>(
    scenarios: impl IntoIterator<Item = &'a ScenarioSummary>,
) -> String {
    let (mut loads, mut limits) = (0, 0);
    for scenario in scenarios {
        if scenario.normal_load_n.is_some() {
            loads += 1;
        } else {
            limits += 1;
        }
    }
    let counted = |count: usize, word: &str| match count {
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    };
    match (loads, limits) {
        (_, 0) => counted(loads, "load"),
        (0, _) => counted(limits, "linear limit"),
        _ => format!(
            "{} and {}",
            counted(loads, "load"),
            counted(limits, "linear limit")
        ),
    }
}
