//! Combinations of the ladder under trial: those worth measuring for an accepted error, and the one taken.

use super::TriedSetting;
use crate::population::statistics::ErrorBound;
use crate::response::friction::ContactLaw;
use crate::settings::ladder::{
    HarmonicLevel, Knob, LadderSearch, LadderSetting, LadderSpace, Measured, Proposal,
};
use crate::study::{AccuracyOptions, PipelineError, Study};

/// Combinations measured at most, under one contact law.
const MOST_MEASURED: usize = 8;
/// Share of the predicted error of a combination that failed, above which others are not measured.
const BETTER: f64 = 0.9;
/// Tolerances that are tried instead of those of the base where the accepted error is at least so large:
/// samples, residual, peak.
const LOOSE: [(f64, (usize, f64, f64)); 2] = [(0.01, (64, 1e-4, 3e-3)), (0.003, (64, 1e-6, 1e-3))];

/// Levels that are worth trying for an accepted error, with what `study` says itself.
pub(super) fn levels(
    study: &Study,
    space: &LadderSpace,
    base: &LadderSetting,
    accuracy: AccuracyOptions,
    finest: f64,
) -> Vec<(Knob, LadderSetting)> {
    let accepted = accuracy.amplitude_error;
    let mut levels = space.one_at_a_time(base, finest);
    levels.retain(|(knob, setting)| match knob {
        Knob::Basis => true,
        // An automatic set of a tolerance beyond what is accepted is a set of the list.
        Knob::Harmonics => match &setting.harmonics {
            HarmonicLevel::Set(_) => true,
            HarmonicLevel::Automatic(tolerance) => *tolerance <= accepted,
        },
        // A law without a spring along t2 has other limits, and its error is beyond anything that is asked for.
        Knob::ContactLaw => {
            let has_its_springs = setting.law.tangents() == base.law.tangents();
            let simpler = accuracy.simpler_contact_law && has_its_springs;
            simpler || setting.law == base.law
        }
        Knob::SamplesPerPeriod
        | Knob::ResidualTolerance
        | Knob::PeakTolerance
        | Knob::Projection => false,
    });
    let loose = LOOSE.into_iter().find(|(error, _)| accepted >= *error);
    for knob in [
        Knob::SamplesPerPeriod,
        Knob::ResidualTolerance,
        Knob::PeakTolerance,
    ] {
        levels.push((knob, base.clone()));
        if let Some((_, (samples, residual, peak))) = loose {
            let other = LadderSetting {
                samples_per_period: samples,
                residual_tolerance: residual,
                peak_tolerance: peak,
                ..base.clone()
            };
            let moved = base.with(knob, &other);
            if moved != *base {
                levels.push((knob, moved));
            }
        }
    }
    for (_, level) in &mut levels {
        *level = level.clone().but_for_those_of(study);
    }
    levels.dedup();
    levels
}

/// What was tried under one contact law: how wrong predictions are under one says nothing of another, which has other
/// harmonics.
struct TriedUnder {
    law: ContactLaw,
    measured: usize,
    /// Either predicted error above which combinations are not measured.
    beyond: [f64; 2],
}

/// Combinations under trial.
pub(super) struct Trials {
    accepted: f64,
    pub(super) tried: Vec<TriedSetting>,
    /// Operations of all rows measured.
    pub(super) operations: f64,
    /// The best so far with its errors: the cheapest of those accepted, else the most accurate.
    pub(super) taken: Option<(Measured, ErrorBound)>,
}

impl Trials {
    /// None tried yet.
    pub(super) fn new(accepted: f64) -> Self {
        Self {
            accepted,
            tried: Vec::new(),
            operations: 0.0,
            taken: None,
        }
    }

    /// Measures combinations that `study` does not contradict, the cheapest first, and takes the best.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub(super) fn among(
        &mut self,
        search: &mut LadderSearch<'_, '_>,
        study: &Study,
        most_operations: f64,
    ) -> Result<(), PipelineError> {
        let mut proposals = search.proposals();
        proposals.retain(|proposal| {
            let stated = proposal.setting.clone().but_for_those_of(study);
            proposal.operations <= most_operations && proposal.setting == stated
        });
        let mut of_laws: Vec<TriedUnder> = Vec::new();
        for proposal in &proposals {
            let cheapest = self.taken.as_ref().map(|(taken, _)| taken.operations());
            if cheapest.is_some_and(|cheapest| proposal.operations >= cheapest) {
                break;
            }
            let law = proposal.setting.law;
            let place = of_laws.iter().position(|tried| tried.law == law);
            let place = place.unwrap_or_else(|| {
                of_laws.push(TriedUnder {
                    law,
                    measured: 0,
                    beyond: [self.accepted; 2],
                });
                of_laws.len() - 1
            });
            let tried = &mut of_laws[place];
            let predicted = proposal.predicted.map(|bound| bound.worst);
            let promised = [0, 1].map(|kind| predicted[kind] <= tried.beyond[kind]);
            if tried.measured >= MOST_MEASURED || promised == [false; 2] {
                continue;
            }
            tried.measured += 1;
            if let Some(reached) = self.reached(search, proposal)? {
                // As much better as this one was too bad, and a little more.
                let ratio = BETTER.min(BETTER * self.accepted / reached);
                for kind in (0..2).filter(|&kind| promised[kind]) {
                    tried.beyond[kind] = ratio * predicted[kind];
                }
            }
        }
        if self.taken.is_some() {
            return Ok(());
        }
        // None is accepted: the one that is nearest to the best levels together.
        let best = proposals.iter().min_by(|a, b| {
            let [a, b] = [a, b].map(|proposal| proposal.predicted[1].worst);
            a.total_cmp(&b)
        });
        if let Some(best) = best {
            let measured = search.measure(&best.setting)?;
            self.taken = self
                .note(search, &measured)
                .map(|errors| (measured, errors));
        }
        Ok(())
    }

    /// Measures a combination: none if it is accepted, and then the one taken if it is the cheapest; else
    /// the error that it reached.
    fn reached(
        &mut self,
        search: &mut LadderSearch<'_, '_>,
        proposal: &Proposal,
    ) -> Result<Option<f64>, PipelineError> {
        let (measured, whole) = search.measure_within(&proposal.setting, self.accepted)?;
        let Some(errors) = self.note(search, &measured) else {
            return Ok(Some(f64::INFINITY));
        };
        if !whole {
            return Ok(Some(errors.worst));
        }
        if errors.p95_upper > self.accepted {
            return Ok(Some(errors.p95_upper));
        }
        let operations = measured.operations();
        let cheaper = |(taken, _): &(Measured, ErrorBound)| operations < taken.operations();
        if self.taken.as_ref().is_none_or(cheaper) {
            self.taken = Some((measured, errors));
        }
        Ok(None)
    }

    /// Records what was measured, and gives its errors.
    fn note(&mut self, search: &LadderSearch<'_, '_>, measured: &Measured) -> Option<ErrorBound> {
        let errors = search.error_of(measured);
        let rows = measured.rows.iter();
        self.operations += rows.map(|row| row.operations).sum::<f64>();
        let words: Vec<String> = Knob::ALL
            .into_iter()
            .map(|knob| measured.setting.level(knob))
            .collect();
        self.tried.push(TriedSetting {
            setting: words.join(", "),
            rows: measured.rows.len() as u64,
            worst: errors.map_or(f64::INFINITY, |errors| errors.worst),
            operations: measured.operations(),
        });
        errors
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::settings::ladder::setting::tests::{setting, space};

    /// A study with these lines at its end.
    fn study(lines: &str) -> Study {
        let text = format!(
            "schema = 1\n[study]\nname = \"a\"\nseed = 1\npatterns = 3\n[model]\nsource = \"lumped\"\n\
             [model.lumped]\nsectors = 6\nblade_mass_kg = 1\nblade_stiffness_n_per_m = 1e6\ndisk_mass_kg = 1\n\
             ring_mass_kg = 1\n[contact]\nlaw = \"macro_slip_1d\"\nfriction_coefficient = 0.3\n\
             tangential_stiffness_n_per_m = 1e6\n[damping]\nstructural_loss_factor = 0.01\n\
             [excitation]\nengine_orders = [2]\n[mistuning]\ndistribution = {{ kind = \"normal\" }}\n\
             [sweep]\nnormal_load_n = [10]\nstandard_deviation = [0.01]\n{lines}"
        );
        Study::parse(Path::new("study.toml"), &text).expect("a study")
    }

    #[test]
    fn the_law_of_the_study_stays_unless_another_is_allowed() {
        let law = ContactLaw::Coulomb3d;
        let space = space(law);
        let base = setting(law, HarmonicLevel::Set(vec![1, 3]));
        let study = study("");
        let laws = |simpler_contact_law| {
            let accuracy = AccuracyOptions {
                simpler_contact_law,
                ..AccuracyOptions::within(0.01)
            };
            let levels = levels(&study, &space, &base, accuracy, 0.002);
            let of_law = levels.iter().filter(|(knob, _)| *knob == Knob::ContactLaw);
            of_law.map(|(_, level)| level.law).collect::<Vec<_>>()
        };
        assert_eq!(laws(false), [law]);
        // All of them but those along one tangent, in their order.
        let mut expected = ContactLaw::ALL.to_vec();
        expected.retain(|&law| law != ContactLaw::MacroSlip1d);
        assert_eq!(laws(true), expected);
    }

    #[test]
    fn levels_keep_to_what_the_study_says_itself() {
        let law = ContactLaw::MacroSlip1d;
        let base = setting(law, HarmonicLevel::Set(vec![1, 3]));
        let levels_of = |lines: &str| {
            let study = study(&format!("[solver]\n{lines}"));
            let base = base.clone().but_for_those_of(&study);
            let accuracy = AccuracyOptions::within(0.01);
            levels(&study, &space(law), &base, accuracy, 0.002)
        };
        let harmonics = |levels: &[(Knob, LadderSetting)]| {
            let of_harmonics = levels.iter().filter(|(knob, _)| *knob == Knob::Harmonics);
            of_harmonics
                .map(|(_, level)| level.harmonics.to_string())
                .collect::<Vec<_>>()
        };
        assert!(harmonics(&levels_of("")).len() > 1);
        let stated = levels_of("harmonics = [1, 3, 17]\npeak_tolerance = 2e-4");
        assert_eq!(harmonics(&stated), ["1-3-17"]);
        for (_, level) in stated {
            assert!(level.samples_per_period >= 68, "{level:?}");
            assert_eq!(level.peak_tolerance.to_bits(), 2e-4_f64.to_bits());
        }
        let automatic = levels_of("harmonics = \"auto\"\nharmonic_tolerance = 3e-3");
        assert_eq!(harmonics(&automatic), ["auto 0.003"]);
    }
}
