//! A figure: its name, its words and its drawing.

use serde::Serialize;

use crate::report::plot::{WIDTH, escaped, standalone_style};

/// The figures that there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FigureName {
    /// Peak amplitude against normal load.
    Amplitude,
    /// Amplification factor against normal load.
    AmplificationFactor,
    /// Statistical and numerical error against normal load.
    Uncertainty,
    /// Error of measured settings against their cost.
    Accuracy,
    /// Distribution of the peak amplitude at one load.
    AmplitudeDistribution,
    /// Distribution of the amplification factor at one load.
    AmplificationFactorDistribution,
    /// Response curves of the median wheel.
    MedianResponse,
    /// Response curves of the worst wheel.
    WorstResponse,
    /// Amplitudes and deviations of the blades of the worst wheel.
    WorstBlades,
    /// Contact of the worst wheel at its peak.
    Contact,
    /// The sector of the model with its contact.
    Sector,
    /// Natural frequencies over speed.
    Campbell,
    /// Natural frequencies over nodal diameter.
    Safe,
}

/// Every figure in the order of a report, with its name on the command line and what it shows.
pub const FIGURES: [(FigureName, &str, &str); 13] = [
    (
        FigureName::Amplitude,
        "amplitude",
        "peak amplitude against normal load: percentiles with bounds, tuned wheel, linear limits",
    ),
    (
        FigureName::AmplificationFactor,
        "amplification-factor",
        "amplification factor against normal load",
    ),
    (
        FigureName::AmplitudeDistribution,
        "amplitude-distribution",
        "distribution of the peak amplitude at the chosen load, with its band and a tail fit",
    ),
    (
        FigureName::AmplificationFactorDistribution,
        "amplification-factor-distribution",
        "the same of the amplification factor",
    ),
    (
        FigureName::Uncertainty,
        "uncertainty",
        "statistical and numerical error of a percentile against normal load",
    ),
    (
        FigureName::Accuracy,
        "accuracy",
        "what accuracy costs, where the folder has a tradeoff.parquet or the study [accuracy]",
    ),
    (
        FigureName::MedianResponse,
        "median-response",
        "response curve of the median wheel at the chosen load, with its linear limits",
    ),
    (
        FigureName::WorstResponse,
        "worst-response",
        "the same of the worst wheel",
    ),
    (
        FigureName::WorstBlades,
        "worst-blades",
        "amplitudes and deviations of the blades of the worst wheel",
    ),
    (
        FigureName::Contact,
        "contact",
        "stick, slip and separation of the contact pairs of the worst wheel at its peak",
    ),
    (
        FigureName::Sector,
        "sector",
        "the sector of the model: bodies, contact, force, observed nodes",
    ),
    (
        FigureName::Campbell,
        "campbell",
        "Campbell diagram: natural frequencies of the tuned wheel over speed, with the engine orders",
    ),
    (
        FigureName::Safe,
        "safe",
        "SAFE diagram: natural frequencies over nodal diameter, with the engine orders at one speed",
    ),
];

impl FigureName {
    /// Whether it shows single wheels, which are solved again for it.
    #[must_use]
    pub fn is_of_wheels(self) -> bool {
        matches!(
            self,
            Self::MedianResponse | Self::WorstResponse | Self::WorstBlades | Self::Contact
        )
    }

    /// Whether it shows the model of the study, for which its inputs are read.
    #[must_use]
    pub fn is_of_model(self) -> bool {
        matches!(self, Self::Sector | Self::Campbell | Self::Safe)
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        let found = FIGURES.iter().find(|(name, ..)| *name == self);
        found.map_or("", |(_, name, _)| name)
    }
}

/// A drawing with its words.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Which one it is.
    pub name: FigureName,
    /// What stands above it.
    pub title: String,
    /// Engine order and standard deviation that it is of.
    pub setting: String,
    /// What stands below it: what is drawn, and how to read it.
    pub caption: String,
    /// Height, user units.
    pub(super) height: f64,
    /// Elements of the drawing.
    pub(super) body: String,
}

impl Figure {
    /// The drawing as an element of a page, whose style sheet it shares; `place` tells it from the other
    /// drawings of the page.
    pub(in crate::report) fn inline(&self, place: &str) -> String {
        format!(
            "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-labelledby=\"{place}-title {place}-description\">\n\
             <title id=\"{place}-title\">{title}</title>\n<desc id=\"{place}-description\">{caption}</desc>\n{body}</svg>\n",
            height = self.height,
            title = escaped(&self.title),
            caption = escaped(&self.caption),
            body = self.body,
        )
    }

    /// The drawing as a file of its own, on white.
    #[must_use]
    pub fn standalone(&self) -> String {
        const HEAD: f64 = 48.0;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 {top} {WIDTH} {full}\" width=\"{WIDTH}\" height=\"{full}\" role=\"img\" aria-labelledby=\"title description\">\n\
             <title id=\"title\">{title}</title>\n<desc id=\"description\">{caption}</desc>\n<style>\n{style}</style>\n\
             <rect x=\"0\" y=\"{top}\" width=\"{WIDTH}\" height=\"{full}\" fill=\"#ffffff\"/>\n\
             <text class=\"strong\" x=\"{middle}\" y=\"-26\" text-anchor=\"middle\">{title}</text>\n\
             <text class=\"quiet small\" x=\"{middle}\" y=\"-8\" text-anchor=\"middle\">{setting}</text>\n{body}</svg>\n",
            top = -HEAD,
            full = self.height + HEAD,
            middle = WIDTH / 2.0,
            title = escaped(&self.title),
            setting = escaped(&self.setting),
            caption = escaped(&self.caption),
            style = standalone_style(),
            body = self.body,
        )
    }
}
