//! Which rows of a study settings are judged by: a few scenarios that stand for all of them, and a few patterns.

use crate::population::monte_carlo::{HarmonicChoice, LoadCaseName, Scenario};
use crate::population::statistics::draw_in;
use crate::response::mistuning::PatternSource;
use crate::study::{MistuningSource, Study};

/// Stream of the sample of patterns of a file.
const SAMPLE_STREAM: u64 = u64::MAX - 1;
/// Load cases of a sample at most.
const LOAD_CASES: usize = 3;
/// What harmonic 1 leaves out of two tuned peaks is the same within this: rounding decides nothing.
const ALIKE: f64 = 1e-4;

/// The rows that settings are compared on.
#[derive(Debug, Clone, PartialEq)]
pub struct LadderSample {
    /// Scenarios under friction, with their indices in the study.
    pub scenarios: Vec<Scenario>,
    /// Ids of the patterns.
    pub patterns: Vec<u32>,
}

impl LadderSample {
    /// Load cases of its scenarios, each once; none in a study without.
    #[must_use]
    pub fn load_cases(&self) -> Vec<LoadCaseName> {
        let scenarios = self.scenarios.iter();
        distinct(scenarios.filter_map(|scenario| scenario.load_case))
    }
}

/// The first `count` patterns of a law, each a draw of its own, so that a longer study has the same; of
/// a file, whose order may mean something, as many drawn at random.
pub(crate) fn sample_of_patterns(
    study: &Study,
    patterns: &PatternSource,
    count: usize,
) -> Vec<u32> {
    let ids = patterns.ids();
    match &study.mistuning.source {
        MistuningSource::Law(_) => ids.into_iter().take(count).collect(),
        MistuningSource::File { .. } => draw_in(SAMPLE_STREAM, ids.len(), count, study.seed)
            .into_iter()
            .map(|place| ids[place])
            .collect(),
    }
}

/// What harmonic 1 alone leaves out of the tuned peaks under one force vector.
pub(in crate::settings) type Remainders = (Option<LoadCaseName>, Vec<HarmonicChoice>);

/// The scenarios under friction by which settings are judged: of engine orders and standard deviations
/// the lowest, middle and highest; of loads the lowest, the highest, and that at which harmonic 1 alone
/// leaves out most of the tuned peak, by `remainders`: a load in the middle of the list need not be
/// where the contact is most nonlinear. Load cases have no order of their own: the three of the least, middle and largest
/// remainder, each with the lowest and highest of its engine orders.
pub(in crate::settings) fn sampled_scenarios(
    study: &Study,
    remainders: &[Remainders],
) -> Vec<Scenario> {
    let excited = sampled_orders(study, remainders);
    let mut deviations = study.standard_deviations.clone();
    deviations.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    let deviations = ends_and_middle(&deviations);
    let loads = sampled_loads(study, remainders);
    let mut scenarios = study.scenarios();
    scenarios.retain(|scenario| {
        let load = scenario.contact.normal_load_n();
        let is_excited = |(load_case, orders): &(Option<LoadCaseName>, Vec<u32>)| {
            *load_case == scenario.load_case && orders.contains(&scenario.engine_order)
        };
        load.is_some_and(|load| loads.contains(&load))
            && excited.iter().any(is_excited)
            && deviations.contains(&scenario.standard_deviation)
    });
    scenarios
}

/// Most scenarios that a sample of `study` can have.
#[must_use]
pub(in crate::settings) fn most_scenarios(study: &Study) -> usize {
    let loads = study.contacts.iter();
    let loads = loads.filter(|contact| contact.normal_load_n().is_some());
    let cases = study.excited_orders();
    let most = most_orders(cases.len());
    let mut orders: Vec<usize> = cases
        .iter()
        .map(|(_, orders)| orders.len().min(most))
        .collect();
    orders.sort_unstable_by(|a, b| b.cmp(a));
    let orders: usize = orders.iter().take(LOAD_CASES).sum();
    loads.count().min(3) * orders * study.standard_deviations.len().min(3)
}

/// `study` with the engine orders, load cases and loads of `scenarios` alone. A load case that has none of them keeps
/// its place, by which its force vector is known to the model, and has no engine order.
pub(super) fn of_sample(study: &Study, scenarios: &[Scenario]) -> Study {
    let mut selected = study.clone();
    selected.contacts = distinct(scenarios.iter().map(|scenario| scenario.contact));
    let orders_of = |load_case: Option<LoadCaseName>| -> Vec<u32> {
        let of_case = scenarios
            .iter()
            .filter(|scenario| scenario.load_case == load_case);
        distinct(of_case.map(|scenario| scenario.engine_order))
    };
    let amplitudes_of = |orders: &[u32], amplitudes: &[f64], sampled: &[u32]| -> Vec<f64> {
        let each = orders.iter().zip(amplitudes);
        each.filter(|(order, _)| sampled.contains(order))
            .map(|(_, &amplitude)| amplitude)
            .collect()
    };
    if selected.load_cases.is_empty() {
        let sampled = orders_of(None);
        selected.amplitudes_n =
            amplitudes_of(&selected.engine_orders, &selected.amplitudes_n, &sampled);
        selected.engine_orders = sampled;
        return selected;
    }
    for case in &mut selected.load_cases {
        let sampled = orders_of(Some(case.name));
        case.amplitudes_n = amplitudes_of(&case.engine_orders, &case.amplitudes_n, &sampled);
        case.engine_orders = sampled;
    }
    selected.engine_orders = distinct(scenarios.iter().map(|scenario| scenario.engine_order));
    selected
}

/// Every value once, in the order of its first appearance.
pub(super) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for value in values {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    found
}

/// Engine orders of a load case at most, of so many cases.
fn most_orders(cases: usize) -> usize {
    if cases > 1 { 2 } else { 3 }
}

/// Load cases of the sample with their engine orders.
fn sampled_orders(
    study: &Study,
    remainders: &[Remainders],
) -> Vec<(Option<LoadCaseName>, Vec<u32>)> {
    let mut cases = study.excited_orders();
    let most = most_orders(cases.len());
    let left_out = |load_case: Option<LoadCaseName>| {
        let of_case = remainders.iter().filter(|(name, _)| *name == load_case);
        (largest(of_case.flat_map(|(_, choices)| choices)) / ALIKE).round()
    };
    cases.sort_by(|a, b| left_out(a.0).total_cmp(&left_out(b.0)));
    ends_and_middle(&cases)
        .into_iter()
        .map(|(load_case, orders)| {
            let mut orders = orders.to_vec();
            orders.sort_unstable();
            let mut sampled = ends_and_middle(&orders);
            if sampled.len() > most {
                sampled.remove(1);
            }
            (load_case, sampled)
        })
        .collect()
}

fn sampled_loads(study: &Study, remainders: &[Remainders]) -> Vec<f64> {
    let contacts = study.contacts.iter();
    let mut loads: Vec<f64> = contacts
        .filter_map(|contact| contact.normal_load_n())
        .collect();
    loads.sort_by(f64::total_cmp);
    let [first, between @ .., last] = loads.as_slice() else {
        return loads;
    };
    let left_out = |load: f64| {
        let of_load = |choice: &&HarmonicChoice| choice.contact.normal_load_n() == Some(load);
        largest(
            remainders
                .iter()
                .flat_map(|(_, choices)| choices)
                .filter(of_load),
        )
    };
    // The first of several that leave out as much.
    let hardest = between
        .iter()
        .copied()
        .rev()
        .max_by(|&a, &b| left_out(a).total_cmp(&left_out(b)));
    let mut sampled = vec![*first];
    sampled.extend(hardest);
    sampled.push(*last);
    sampled
}

fn largest<'a>(choices: impl Iterator<Item = &'a HarmonicChoice>) -> f64 {
    choices
        .filter_map(|choice| choice.remainder)
        .fold(0.0, f64::max)
}

/// First, middle and last of a sorted list.
fn ends_and_middle<T: Clone>(sorted: &[T]) -> Vec<T> {
    match sorted {
        [] | [_] | [_, _] => sorted.to_vec(),
        [first, .., last] => vec![
            first.clone(),
            sorted[(sorted.len() - 1) / 2].clone(),
            last.clone(),
        ],
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::response::forced_response::ContactCondition;

    fn study(excitation: &str) -> Study {
        let text = format!(
            "schema = 1\n[study]\nname = \"a\"\nseed = 1\npatterns = 3\n[model]\nsource = \"lumped\"\n\
             [model.lumped]\nsectors = 6\nblade_mass_kg = 1\nblade_stiffness_n_per_m = 1e6\ndisk_mass_kg = 1\n\
             ring_mass_kg = 1\n[contact]\nlaw = \"macro_slip_1d\"\nfriction_coefficient = 0.3\n\
             tangential_stiffness_n_per_m = 1e6\n[damping]\nstructural_loss_factor = 0.01\n\
             [mistuning]\ndistribution = {{ kind = \"normal\" }}\n[sweep]\n\
             normal_load_n = [10, \"stuck\", 20, 5, 40]\nstandard_deviation = [0.01]\n{excitation}"
        );
        Study::parse(Path::new("study.toml"), &text).expect("a study")
    }

    /// Load cases of these names under engine orders 4, 1, 3 and 2, with an amplitude for each.
    fn cases(names: &[&str]) -> Study {
        let case = |name: &&str| {
            format!(
                "[[excitation.load_case]]\nname = \"{name}\"\nengine_orders = [4, 1, 3, 2]\n\
                 amplitude_n = [40, 10, 30, 20]\n"
            )
        };
        study(&names.iter().map(case).collect::<String>())
    }

    fn left_out(name: Option<&str>, of_loads: &[(f64, Option<f64>)]) -> Remainders {
        let choice = |&(normal_load_n, remainder): &(f64, Option<f64>)| HarmonicChoice {
            sampling: None,
            reduced_model: None,
            engine_order: 1,
            contact: ContactCondition::Full { normal_load_n },
            harmonics: vec![1],
            remainder,
        };
        let name = name.and_then(LoadCaseName::new);
        (name, of_loads.iter().map(choice).collect())
    }

    /// Load case, engine order and load of each scenario of the sample.
    fn sampled(study: &Study, remainders: &[Remainders]) -> Vec<(String, u32, f64)> {
        let scenarios = sampled_scenarios(study, remainders);
        assert!(scenarios.len() <= most_scenarios(study));
        let all = study.scenarios();
        assert!(
            scenarios
                .iter()
                .all(|scenario| all[scenario.index] == *scenario)
        );
        let of = |scenario: &Scenario| {
            let name = scenario
                .load_case
                .map_or_else(String::new, |name| name.to_string());
            let load_n = scenario.contact.normal_load_n().expect("friction");
            (name, scenario.engine_order, load_n)
        };
        scenarios.iter().map(of).collect()
    }

    #[test]
    fn a_study_without_load_cases_has_its_ends_middle_and_hardest_load() {
        let study =
            study("[excitation]\nengine_orders = [4, 1, 3, 2]\namplitude_n = [40, 10, 30, 20]\n");
        let remainders = [left_out(None, &[(10.0, Some(0.1)), (20.0, Some(0.2))])];
        let expected: Vec<(String, u32, f64)> = [4, 1, 2]
            .into_iter()
            .flat_map(|order| [20.0, 5.0, 40.0].map(|load| (String::new(), order, load)))
            .collect();
        assert_eq!(sampled(&study, &remainders), expected);
        assert_eq!(most_scenarios(&study), 9);
        let reduced = of_sample(&study, &sampled_scenarios(&study, &remainders));
        // Each engine order keeps the amplitude that is its own.
        assert_eq!(reduced.force_factors(), [(4, 40.0), (1, 10.0), (2, 20.0)]);
        assert_eq!(reduced.contacts.len(), 3);
        // One load case is what the study would be without.
        let one = cases(&["one"]);
        let of_one = sampled(&one, &[left_out(Some("one"), &[(20.0, Some(0.2))])]);
        let without_name = of_one.into_iter().map(|row| (String::new(), row.1, row.2));
        assert_eq!(without_name.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn of_many_load_cases_three_are_taken_by_what_harmonic_1_leaves_out() {
        let study = cases(&["a", "b", "c", "d"]);
        let remainders = [
            left_out(Some("a"), &[(10.0, Some(0.3)), (20.0, Some(0.01))]),
            left_out(Some("b"), &[(10.0, Some(0.02))]),
            left_out(Some("c"), &[(10.0, None), (20.0, Some(0.1))]),
            left_out(Some("d"), &[(20.0, Some(0.2))]),
        ];
        let sample = sampled(&study, &remainders);
        let names = distinct(sample.iter().map(|row| row.0.clone()));
        assert_eq!(names, ["a", "b", "c"]);
        let orders = distinct(sample.iter().map(|row| row.1));
        assert_eq!(orders, [4, 1]);
        let loads = distinct(sample.iter().map(|row| row.2));
        assert_eq!(loads, [10.0, 5.0, 40.0]);
        assert_eq!((sample.len(), most_scenarios(&study)), (18, 18));
        // The fourth keeps its place among the force vectors.
        let reduced = of_sample(&study, &sampled_scenarios(&study, &remainders));
        assert_eq!(reduced.load_cases.len(), 4);
        assert!(reduced.load_cases[3].engine_orders.is_empty());
        assert_eq!(reduced.load_cases[0].engine_orders, [4, 1]);
        assert_eq!(reduced.load_cases[0].amplitudes_n, [40.0, 10.0]);
        // A difference that rounding can make is none.
        let alike = |name, last| left_out(Some(name), &[(20.0, Some(0.1 + last))]);
        let one = [
            alike("a", 3e-13),
            alike("b", 2e-13),
            alike("c", 1e-13),
            alike("d", 0.0),
        ];
        let sample = sampled(&study, &one);
        let names = distinct(sample.into_iter().map(|row| row.0));
        assert_eq!(names, ["a", "b", "d"]);
    }
}
