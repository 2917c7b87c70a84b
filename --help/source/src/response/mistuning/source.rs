//! Where the patterns of a study come from: a law and a seed, or a table.

use super::{
    ContactFactors, ContactSource, Deviations, Distribution, Pattern, PatternTable, pattern_stream,
};

/// Source of the patterns of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum PatternSource {
    /// Drawn from a law; pattern `id` depends on the seed and `id` alone, so the first n patterns
    /// of a longer study are the same.
    Random {
        /// Seed of the study.
        seed: u64,
        /// Number of patterns; their ids are `0..count`.
        count: u32,
        /// Blades of a pattern.
        sectors: usize,
        /// Law of a blade's deviation.
        distribution: Distribution,
    },
    /// Read from a file.
    Table(PatternTable),
    /// The blades of another source, with random contact.
    WithContact {
        /// Source of the blades.
        blades: Box<PatternSource>,
        /// Source of the contact.
        contact: ContactSource,
    },
}

impl PatternSource {
    /// Ids of the patterns, ascending.
    #[must_use]
    pub fn ids(&self) -> Vec<u32> {
        match self {
            Self::Random { count, .. } => (0..*count).collect(),
            Self::Table(table) => table.ids(),
            Self::WithContact { blades, .. } => blades.ids(),
        }
    }

    /// Pattern `id`, or none if the source has no such pattern.
    ///
    /// Random patterns are unit draws, one per blade in blade order, times `standard_deviation`
    /// (1 if none is given); the same unit draws serve every standard deviation. A pattern from a
    /// table is taken as it stands there.
    #[must_use]
    pub fn pattern(&self, id: u32, standard_deviation: Option<f64>) -> Option<Pattern> {
        match self {
            Self::Random {
                seed,
                count,
                sectors,
                distribution,
            } => (id < *count).then(|| {
                let scale = standard_deviation.unwrap_or(1.0);
                let unit = distribution.unit_draws(&mut pattern_stream(*seed, id), *sectors);
                Pattern {
                    id,
                    deviations: Deviations::PerBlade(
                        unit.into_iter().map(|draw| scale * draw).collect(),
                    ),
                    contact: ContactFactors::default(),
                }
            }),
            Self::Table(table) => table.pattern(id),
            Self::WithContact { blades, contact } => {
                let pattern = blades.pattern(id, standard_deviation)?;
                Some(Pattern {
                    contact: contact.factors(id),
                    ..pattern
                })
            }
        }
    }
}
