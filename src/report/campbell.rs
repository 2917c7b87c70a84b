//! Campbell table: natural frequencies per nodal diameter over speed, and where engine orders cross them.

use std::fmt;

use serde::Serialize;

use super::text_table::TextTable;
use crate::model::cyclic::nodal_diameter_of;

/// Frequencies of one mode at the speeds of the table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CampbellMode {
    /// `stuck`, `slide` or `free`.
    pub contact: &'static str,
    /// Nodal diameter.
    pub nodal_diameter: usize,
    /// Place among the modes of its nodal diameter by frequency, from 1.
    pub mode: usize,
    /// Natural frequency at each speed, Hz; negative where rotation softens more than there is to soften.
    pub frequency_hz: Vec<f64>,
}

/// A speed at which an engine order meets a mode that it can excite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CampbellCrossing {
    /// Engine order.
    pub engine_order: u32,
    /// Nodal diameter that it excites: `EO mod N`, or N less that.
    pub nodal_diameter: usize,
    /// Whether the excited wave travels against the order's (`EO mod N` above N/2).
    pub backward: bool,
    /// `stuck`, `slide` or `free`.
    pub contact: &'static str,
    /// Place of the mode, from 1.
    pub mode: usize,
    /// Speed, revolutions per minute.
    pub speed_rpm: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Whether the speed lies outside of those whose frequencies are known.
    pub extrapolated: bool,
}

/// Frequencies and crossings of a wheel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CampbellReport {
    /// Name of the model.
    pub model: String,
    /// Sectors of the wheel.
    pub sectors: usize,
    /// Speeds at which the model is given, revolutions per minute, ascending; empty: one model for all.
    pub speed_rpm: Vec<f64>,
    /// Range of speeds that was asked for, revolutions per minute.
    pub range_rpm: Option<[f64; 2]>,
    /// Modes in the order contact, nodal diameter, frequency.
    pub modes: Vec<CampbellMode>,
    /// Candidate crossings in the order engine order, speed.
    pub crossings: Vec<CampbellCrossing>,
}

impl CampbellReport {
    /// The crossings of `modes` with `engine_orders`.
    ///
    /// The square of a mode's frequency is taken as linear in the square of the speed between two speeds (exact for
    /// stress stiffening and spin softening of an unchanged mode shape) and beyond them as next to them;
    /// with one model it is constant.
    #[must_use]
    pub fn new(
        model: String,
        sectors: usize,
        speed_rpm: Vec<f64>,
        range_rpm: Option<[f64; 2]>,
        modes: Vec<CampbellMode>,
        engine_orders: &[u32],
    ) -> Self {
        let mut report = Self {
            model,
            sectors,
            speed_rpm,
            range_rpm,
            modes,
            crossings: Vec::new(),
        };
        let mut orders = engine_orders.to_vec();
        orders.sort_unstable();
        orders.dedup();
        for engine_order in orders {
            let mut crossings: Vec<CampbellCrossing> = report
                .modes
                .iter()
                .flat_map(|mode| report.of_mode(mode, engine_order))
                .collect();
            crossings.sort_by(|a, b| a.speed_rpm.total_cmp(&b.speed_rpm));
            report.crossings.extend(crossings);
        }
        report
    }

    /// Frequency of a mode of this report at a speed, Hz; negative where there is less stiffness than none.
    pub(super) fn frequency_at(&self, mode: &CampbellMode, speed_rpm: f64) -> f64 {
        if self.speed_rpm.len() < 2 {
            return mode.frequency_hz[0];
        }
        let speeds: Vec<f64> = self.speed_rpm.iter().map(|rpm| rpm / 60.0).collect();
        let square = (speed_rpm / 60.0).powi(2);
        let pieces = stretches(&squares(&speeds), &squares(&mode.frequency_hz));
        let piece = pieces.iter().find(|piece| square < piece.high);
        let eigenvalue = piece.map_or(f64::NAN, |piece| piece.constant + piece.slope * square);
        eigenvalue.signum() * eigenvalue.abs().sqrt()
    }

    fn of_mode(&self, mode: &CampbellMode, engine_order: u32) -> Vec<CampbellCrossing> {
        let excited = nodal_diameter_of(1, engine_order, self.sectors);
        if excited.index != mode.nodal_diameter || engine_order == 0 {
            return Vec::new();
        }
        let in_range = |speed: f64| {
            self.range_rpm
                .is_none_or(|[low, high]| (low..=high).contains(&speed))
        };
        let order = f64::from(engine_order);
        let crossing = |speed_rpm: f64| CampbellCrossing {
            engine_order,
            nodal_diameter: mode.nodal_diameter,
            backward: excited.conjugate,
            contact: mode.contact,
            mode: mode.mode,
            speed_rpm,
            frequency_hz: order * speed_rpm / 60.0,
            extrapolated: match (self.speed_rpm.first(), self.speed_rpm.last()) {
                (Some(&low), Some(&high)) => speed_rpm < low || speed_rpm > high,
                _ => false,
            },
        };
        // (turns per second)^2 and Hz^2.
        let speeds = squares(
            &self
                .speed_rpm
                .iter()
                .map(|rpm| rpm / 60.0)
                .collect::<Vec<_>>(),
        );
        let eigenvalues = squares(&mode.frequency_hz);
        stretches(&speeds, &eigenvalues)
            .into_iter()
            .filter_map(|stretch| stretch.crossing(order))
            .map(|square| crossing(60.0 * square.sqrt()))
            .filter(|found| found.speed_rpm > 0.0 && in_range(found.speed_rpm))
            .collect()
    }
}

/// `f^2 = constant + slope * n^2` for `n^2` from `low` to `high`, both in 1/s^2.
struct Stretch {
    constant: f64,
    slope: f64,
    low: f64,
    high: f64,
}

impl Stretch {
    /// The square of the speed at which `order * n = f`.
    fn crossing(&self, order: f64) -> Option<f64> {
        let square = self.constant / (order * order - self.slope);
        (square.is_finite() && square >= self.low && square < self.high).then_some(square)
    }
}

/// Squares with the signs of the values.
fn squares(values: &[f64]) -> Vec<f64> {
    values
        .iter()
        .map(|value| value.signum() * value * value)
        .collect()
}

/// The frequency of a mode over all speeds, piece by piece.
fn stretches(speeds: &[f64], eigenvalues: &[f64]) -> Vec<Stretch> {
    let pieces = speeds.len().max(2) - 1;
    let piece = |place: usize| {
        let slope = if speeds.len() > 1 {
            (eigenvalues[place + 1] - eigenvalues[place]) / (speeds[place + 1] - speeds[place])
        } else {
            0.0
        };
        let start = speeds.get(place).copied().unwrap_or(0.0);
        Stretch {
            constant: eigenvalues[place] - slope * start,
            slope,
            low: if place == 0 { 0.0 } else { start },
            high: if place + 1 == pieces {
                f64::INFINITY
            } else {
                speeds[place + 1]
            },
        }
    };
    (0..pieces).map(piece).collect()
}

impl fmt::Display for CampbellReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "model {}: {} sectors", self.model, self.sectors)?;
        if self.speed_rpm.len() > 1 {
            writeln!(
                f,
                "frequency squared linear in speed squared between the models; * beyond their speeds"
            )?;
        } else {
            writeln!(
                f,
                "frequencies are those of one model at every speed: neither stress stiffening nor spin softening"
            )?;
        }
        let mut header = vec!["contact".to_owned(), "ND".to_owned(), "mode".to_owned()];
        if self.speed_rpm.is_empty() {
            header.push("Hz".to_owned());
        }
        header.extend(self.speed_rpm.iter().map(|rpm| format!("Hz at {rpm} rpm")));
        let names: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = TextTable::new(&names);
        for mode in &self.modes {
            let keys = [
                mode.contact.to_owned(),
                mode.nodal_diameter.to_string(),
                mode.mode.to_string(),
            ];
            let frequencies = mode.frequency_hz.iter().map(|hz| format!("{hz:.2}"));
            table.row(keys.into_iter().chain(frequencies).collect());
        }
        writeln!(f, "\n{table}")?;
        if self.crossings.is_empty() {
            return write!(f, "no crossings");
        }
        let mut table = TextTable::new(&["EO", "ND", "wave", "contact", "mode", "rpm", "Hz"]);
        for crossing in &self.crossings {
            let mark = if crossing.extrapolated { "*" } else { "" };
            table.row(vec![
                crossing.engine_order.to_string(),
                crossing.nodal_diameter.to_string(),
                wave(crossing, self.sectors).to_owned(),
                crossing.contact.to_owned(),
                crossing.mode.to_string(),
                format!("{:.1}{mark}", crossing.speed_rpm),
                format!("{:.2}", crossing.frequency_hz),
            ]);
        }
        write!(f, "{table}")
    }
}

/// How the excited wave travels, seen from the wheel.
fn wave(crossing: &CampbellCrossing, sectors: usize) -> &'static str {
    if crossing.nodal_diameter == 0 || 2 * crossing.nodal_diameter == sectors {
        "standing"
    } else if crossing.backward {
        "N - h"
    } else {
        "h"
    }
}
