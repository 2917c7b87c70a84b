//! A study in words, before anything is solved, with remarks on what is unusual.

use std::fmt;

use serde::Serialize;

use super::warning::read_each_wheel;
use super::words::{excitation, force, hanging, load_words, trimmed};
use crate::population::monte_carlo::LoadCaseName;

/// What a study asks for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyEcho {
    /// Name.
    pub name: String,
    /// Number of patterns, at most where the study may stop before.
    pub patterns: u64,
    /// Seed of the patterns.
    pub seed: u64,
    /// The model.
    pub model: EchoedModel,
    /// What deviates and by which law.
    pub mistuning: String,
    /// Contact law with its parameters; none for a model without contact.
    pub contact: Option<String>,
    /// Contact conditions, as written.
    pub loads: Vec<EchoedLoad>,
    /// What excites the wheel.
    pub excitations: Vec<EchoedExcitation>,
    /// Damping of the structure.
    pub damping: String,
    /// How it is solved.
    pub settings: String,
    /// Number of scenarios.
    pub scenarios: u64,
    /// Number of rows.
    pub rows: u64,
    /// Number of rows under friction; all other rows are linear and take next to no time.
    pub friction_rows: u64,
    /// What is unusual.
    pub remarks: Vec<Remark>,
}

/// The model of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EchoedModel {
    /// Name.
    pub name: String,
    /// Number of sectors.
    pub sectors: usize,
    /// Degrees of freedom of a sector.
    pub sector_dofs: usize,
    /// Contact pairs of a sector.
    pub contact_pairs: usize,
}

/// A contact condition of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EchoedLoad {
    /// `full`: friction under a normal load; or the linear limit.
    pub contact: &'static str,
    /// Normal load per sector, N.
    pub normal_load_n: Option<f64>,
    /// Normal load of the whole wheel, N.
    pub wheel_load_n: Option<f64>,
}

/// An engine order of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EchoedExcitation {
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Sum of the magnitudes of the forces on a sector, N; those along r, theta and z are components of one.
    pub force_n: f64,
    /// How many dofs of a sector they act on.
    pub force_dofs: usize,
    /// Nodal diameter that it excites in the tuned wheel.
    pub nodal_diameter: usize,
    /// How the wave travels.
    pub travels: Travel,
}

impl EchoedExcitation {
    /// The force, and what it excites.
    pub(super) fn in_words(&self) -> String {
        let over = match self.force_dofs {
            1 => " on each sector".to_owned(),
            dofs => format!(" in sum over {dofs} dofs of each sector"),
        };
        format!(
            "{}{over}: excites nodal diameter {}, {}",
            force(self.force_n),
            self.nodal_diameter,
            self.travels
        )
    }
}

/// How a wave of the wheel travels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Travel {
    /// With the engine order.
    Forwards,
    /// Against the engine order.
    Backwards,
    /// The wave stands: nodal diameter 0, or half the number of sectors.
    Standing,
}

impl fmt::Display for Travel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Forwards => "travelling forwards",
            Self::Backwards => "travelling backwards",
            Self::Standing => "a standing wave",
        })
    }
}

/// Something unusual that is accepted.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "remark", rename_all = "snake_case")]
pub enum Remark {
    /// The blades cannot tell an engine order from a lower one.
    AliasedEngineOrder {
        /// The engine order.
        engine_order: u32,
        /// Number of sectors.
        sectors: usize,
        /// Nodal diameter that it excites.
        nodal_diameter: usize,
        /// How the wave travels.
        travels: Travel,
    },
    /// A load so large that no pair is likely to slip.
    LargeLoad {
        /// The load per sector, N.
        normal_load_n: f64,
        /// The load of the whole wheel, N.
        wheel_load_n: f64,
        /// Friction limit of a sector, N.
        friction_limit_n: f64,
        /// Force on a sector times the gain of an undisturbed resonance, N.
        resonant_force_n: f64,
    },
    /// A load so small that friction hardly counts.
    SmallLoad {
        /// The load per sector, N.
        normal_load_n: f64,
        /// Friction limit of a sector, N.
        friction_limit_n: f64,
        /// Force on a sector, N.
        force_n: f64,
    },
    /// Blades that deviate more than those of a wheel usually do.
    LargeDeviation {
        /// The standard deviation, relative.
        standard_deviation: f64,
    },
    /// A percentile of the tables that has no value for lack of patterns.
    FewPatterns {
        /// The percentile in percent.
        percent: u32,
        /// Smallest number of patterns with an interval.
        needed: u64,
        /// Wheels in `mistuning.file`; absent: patterns are drawn.
        #[serde(skip_serializing_if = "Option::is_none")]
        wheels_in_file: Option<u64>,
    },
    /// Contact pairs in which nothing can rub.
    NoFriction {
        /// Pairs of a sector without a displacement across their normal.
        pairs: usize,
        /// Pairs of a sector.
        contact_pairs: usize,
    },
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AliasedEngineOrder {
                engine_order,
                sectors,
                nodal_diameter,
                travels,
            } => write!(
                f,
                "engine order {engine_order} on {sectors} sectors excites nodal diameter {nodal_diameter}, \
                 {travels}: {sectors} blades cannot tell it from an engine order of at most {}",
                sectors / 2
            ),
            Self::LargeLoad {
                normal_load_n,
                wheel_load_n,
                friction_limit_n,
                resonant_force_n,
            } => write!(
                f,
                "a normal load of {} per sector is {} on the wheel; its friction limit, {} per sector, is far \
                 above the force of the excitation at resonance, {}, so that every pair is likely to stick as \
                 under the linear solution stuck; loads are per sector, not those of the wheel",
                force(*normal_load_n),
                force(*wheel_load_n),
                force(*friction_limit_n),
                force(*resonant_force_n)
            ),
            Self::SmallLoad {
                normal_load_n,
                friction_limit_n,
                force_n,
            } => write!(
                f,
                "a normal load of {} per sector has the friction limit {} per sector, far below the force of \
                 the excitation, {}: every pair is likely to slide as under the linear solution slide",
                force(*normal_load_n),
                force(*friction_limit_n),
                force(*force_n)
            ),
            Self::LargeDeviation { standard_deviation } => write!(
                f,
                "a standard deviation of {} % of the blades' stiffness is large; 0.03 means 3 %",
                trimmed(100.0 * standard_deviation)
            ),
            Self::FewPatterns {
                percent,
                needed,
                wheels_in_file: None,
            } => write!(
                f,
                "P{percent} will have no value: a 95 % interval needs {needed} patterns"
            ),
            Self::FewPatterns {
                percent,
                needed,
                wheels_in_file: Some(wheels),
            } => write!(
                f,
                "P{percent} will have no value: a 95 % interval needs {needed} wheels, mistuning.file holds \
                 {wheels}; {}",
                read_each_wheel(*wheels)
            ),
            Self::NoFriction {
                pairs,
                contact_pairs,
            } => write!(
                f,
                "{pairs} of {contact_pairs} contact pairs of a sector have no displacement across their normal: \
                 they have no direction to rub in"
            ),
        }
    }
}

impl fmt::Display for StudyEcho {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let model = &self.model;
        let mut lines = vec![
            ("study", format!("{}, seed {}", self.name, self.seed)),
            (
                "model",
                format!(
                    "{}: {} sectors of {} dofs, {} contact pairs each",
                    model.name, model.sectors, model.sector_dofs, model.contact_pairs
                ),
            ),
            ("mistuning", self.mistuning.clone()),
        ];
        lines.extend(self.contact.clone().map(|contact| ("contact", contact)));
        lines.push(("loads", self.loads_in_words()));
        for own in &self.excitations {
            lines.push((
                "excitation",
                format!(
                    "{}, {}",
                    excitation(own.load_case, own.engine_order),
                    own.in_words()
                ),
            ));
        }
        lines.push(("damping", self.damping.clone()));
        lines.push(("settings", self.settings.clone()));
        lines.push((
            "to solve",
            format!(
                "{} patterns x {} scenarios = {} rows, {} of them with friction",
                self.patterns, self.scenarios, self.rows, self.friction_rows
            ),
        ));
        for (subject, words) in lines {
            let head = format!("{subject:<12}");
            writeln!(f, "{}", hanging(&head, &" ".repeat(12), &words))?;
        }
        for remark in &self.remarks {
            writeln!(f, "{}", hanging("remark: ", "  ", &remark.to_string()))?;
        }
        Ok(())
    }
}

impl StudyEcho {
    fn loads_in_words(&self) -> String {
        let loads: Vec<&EchoedLoad> = self
            .loads
            .iter()
            .filter(|own| own.normal_load_n.is_some())
            .collect();
        let numbers: Vec<String> = loads
            .iter()
            .map(|own| load_words(own.contact, own.normal_load_n))
            .collect();
        let limits: Vec<&str> = self
            .loads
            .iter()
            .filter(|own| own.normal_load_n.is_none())
            .map(|own| own.contact)
            .collect();
        let limits = limits.join(", ");
        let of_wheel = loads.last().and_then(|own| {
            let (of_sector, of_wheel) = own.normal_load_n.zip(own.wheel_load_n)?;
            let sectors = self.model.sectors;
            Some(format!(
                " ({} per sector is {} on all {sectors})",
                force(of_sector),
                force(of_wheel)
            ))
        });
        match (numbers.is_empty(), limits.is_empty()) {
            (true, _) => format!("the linear solutions {limits}"),
            (false, true) => format!(
                "{} N per sector{}",
                numbers.join(", "),
                of_wheel.unwrap_or_default()
            ),
            (false, false) => format!(
                "{} N per sector{}, and the linear solutions {limits}",
                numbers.join(", "),
                of_wheel.unwrap_or_default()
            ),
        }
    }
}
