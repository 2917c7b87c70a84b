//! Where the program finds a peak: the place at which the truth begins to look, and nothing else of it.

use blisk::population::monte_carlo::Scenario;
use blisk::response::forced_response::ContactCondition;
use blisk::response::mistuning::PatternSource;
use blisk::settings::{Engine, EngineSource, ReducedEngineSource};
use blisk::study::{Study, pattern_source};

use super::cases::{Condition, Wheel, folder};

/// Settings that find a place, not a height.
const SETTINGS: &str = "\n[reduction]\nbasis = \"stick_slide\"\nstick_modes = 6\nslide_modes = 6\n\n[solver]\nharmonics = [1, 3]\n\
                        peak_tolerance = 1e-3\n";

pub struct Hints {
    engine: Box<dyn Engine>,
    patterns: PatternSource,
    engine_order: u32,
}

impl Hints {
    pub fn new(wheel: &Wheel) -> Self {
        let path = folder(&wheel.name).join("study.toml");
        let text = std::fs::read_to_string(&path).expect("a study") + SETTINGS;
        let study = Study::parse(&path, &text).expect("a study");
        Self {
            engine: ReducedEngineSource
                .build(&study, &wheel.model, None)
                .expect("an engine"),
            patterns: pattern_source(&study, &wheel.model).expect("patterns"),
            engine_order: study.engine_orders[0],
        }
    }

    /// Frequency of the peak of a pattern, or of the tuned wheel, Hz.
    pub fn frequency_hz(&self, pattern: Option<usize>, condition: Condition) -> Option<f64> {
        let scenario = Scenario {
            index: 0,
            load_case: None,
            engine_order: self.engine_order,
            standard_deviation: None,
            contact: match condition {
                Condition::Friction(normal_load_n) => ContactCondition::Full { normal_load_n },
                Condition::Slide => ContactCondition::Slide,
                Condition::Stuck => ContactCondition::Stuck,
                Condition::Free => ContactCondition::Free,
            },
        };
        let tuned = self.engine.tuned(&scenario);
        let Some(pattern) = pattern else {
            return tuned.frequency_hz;
        };
        let pattern = self
            .patterns
            .pattern(pattern as u32, None)
            .expect("a pattern");
        let row = self.engine.rows(&pattern, &[(&scenario, &tuned)]).remove(0);
        row.peak_frequency_hz.or(tuned.frequency_hz)
    }
}
