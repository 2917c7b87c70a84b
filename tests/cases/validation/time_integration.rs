//! Harmonic balance with converged harmonics against direct time integration on the same reduced model.

use std::ops::RangeInclusive;
use std::sync::Arc;

use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::response::forced_response::{AmplitudeMeasure, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::{Deviations, WheelBasis};
use blisk::study::{Study, load_sector_model, pattern_source};
use blisk::verification::time_integration::{
    PointCase, PointComparison, TimeOptions, compare_point,
};
use rayon::prelude::*;

use super::super::support::package;
use super::report::{Section, Verdict, percent, set_name, signed_percent, table};

/// A point: wheel, pattern of its file (none: tuned), load, frequency, harmonics of the harmonic balance.
struct Point {
    study: &'static str,
    /// Loss factor where it is not that of the study.
    loss_factor: Option<f64>,
    pattern: Option<u32>,
    normal_load_n: f64,
    frequency_hz: f64,
    harmonics: Vec<u32>,
    solver: SolverOptions,
    options: TimeOptions,
}

impl Point {
    fn wheel8(
        normal_load_n: f64,
        pattern: Option<u32>,
        frequency_hz: f64,
        harmonics: RangeInclusive<u32>,
        maximum_periods: usize,
    ) -> Self {
        Self {
            study: "validation/wheel8",
            loss_factor: None,
            pattern,
            normal_load_n,
            frequency_hz,
            harmonics: harmonics.collect(),
            solver: SolverOptions {
                samples_per_period: 512,
                ..SolverOptions::default()
            },
            options: TimeOptions {
                maximum_periods,
                ..TimeOptions::default()
            },
        }
    }

    /// With ten times its damping, under loads at which it has no stable periodic motion without.
    fn damped_wheel8(normal_load_n: f64, pattern: Option<u32>, frequency_hz: f64) -> Self {
        Self {
            loss_factor: Some(0.02),
            ..Self::wheel8(normal_load_n, pattern, frequency_hz, 0..=9, 3000)
        }
    }

    fn lumped24(pattern: Option<u32>, frequency_hz: f64) -> Self {
        Self {
            study: "lumped24",
            loss_factor: None,
            pattern,
            normal_load_n: 50.0,
            frequency_hz,
            harmonics: (1..=15).step_by(2).collect(),
            solver: SolverOptions {
                samples_per_period: 1024,
                amplitude: AmplitudeMeasure::TimeMaximum,
                ..SolverOptions::default()
            },
            options: TimeOptions {
                steps_per_period: 512,
                minimum_periods: 60,
                ..TimeOptions::default()
            },
        }
    }

    fn compare(&self) -> Result<PointComparison, Status> {
        let study = Study::read(&package(&format!("studies/{}.toml", self.study))).unwrap();
        let model = load_sector_model(&study).unwrap();
        let contact = study.contact.as_ref().unwrap();
        let kt = contact.tangential_stiffness_n_per_m;
        let kn = contact.normal_stiffness_n_per_m.unwrap_or(0.0);
        let springs = ContactStiffness {
            normal_n_per_m: kn,
            tangential_1_n_per_m: kt,
            tangential_2_n_per_m: if contact.law == ContactLaw::MacroSlip1d {
                0.0
            } else {
                kt
            },
        };
        let reduction = Reduction::new(&model, springs, 25, 0).unwrap();
        let reduced = reduction
            .reduce(BasisChoice::StickAttachment { stick: 4 }, None)
            .unwrap();
        let basis = WheelBasis::new(Arc::new(reduced));
        let change = self.pattern.map(|id| {
            let source = pattern_source(&study, &model).unwrap();
            match source.pattern(id, None).unwrap().deviations {
                Deviations::PerBlade(blades) => basis.blade_stiffness_change(&blades),
                Deviations::PerMode { .. } => panic!("deviations per blade are compared"),
            }
        });
        let case = PointCase {
            basis: &basis,
            stiffness_change: change.as_ref(),
            damping: self
                .loss_factor
                .map_or(study.damping, Damping::StructuralLossFactor),
            engine_order: study.engine_orders[0],
            amplitude_n: study.amplitude_n,
            law: contact.law,
            sector: PairParameters {
                normal_load_n: self.normal_load_n,
                normal_stiffness_n_per_m: kn,
                tangential_stiffness_n_per_m: kt,
                friction_coefficient: contact.friction_coefficient,
            },
            factors: &blisk::response::mistuning::ContactFactors::default(),
            harmonics: &self.harmonics,
            solver: &self.solver,
            frequency_hz: self.frequency_hz,
        };
        compare_point(&case, &self.options)
    }

    fn is_lumped(&self) -> bool {
        self.study == "lumped24"
    }

    fn who(&self) -> String {
        self.pattern
            .map_or_else(|| "tuned".to_owned(), |id| format!("pattern {id}"))
    }
}

/// What the contacts do at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Regime {
    MicroSlip,
    GrossSlip,
    Separation,
}

impl Regime {
    /// From the shares of pairs that slip and open at any step of the last period.
    fn of(found: &PointComparison) -> Self {
        let shares = found.settled.shares;
        if shares.separated > 0.0 {
            Self::Separation
        } else if shares.slipping < 1.0 {
            Self::MicroSlip
        } else {
            Self::GrossSlip
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::MicroSlip => "micro-slip",
            Self::GrossSlip => "gross slip",
            Self::Separation => "separation",
        }
    }
}

fn points() -> Vec<Point> {
    let mut points = vec![
        Point::wheel8(1600.0, None, 617.28, 1..=31, 3000),
        Point::wheel8(1600.0, Some(1), 616.04, 1..=7, 3000),
        Point::wheel8(800.0, None, 616.5, 1..=31, 3000),
        Point::wheel8(400.0, Some(1), 614.25, 1..=15, 3000),
        Point::wheel8(400.0, None, 615.08, 1..=15, 300),
        Point::wheel8(100.0, None, 612.88, 0..=15, 300),
        Point::wheel8(100.0, Some(1), 612.0, 0..=5, 300),
        Point::damped_wheel8(60.0, None, 613.96),
        Point::damped_wheel8(60.0, Some(1), 612.5),
        Point::damped_wheel8(30.0, None, 613.36),
        Point::damped_wheel8(30.0, Some(1), 612.0),
    ];
    for pattern in [None, Some(0)] {
        for frequency_hz in [347.5, 350.5, 354.5] {
            points.push(Point::lumped24(pattern, frequency_hz));
        }
    }
    points
}

pub fn section() -> Section {
    let found: Vec<(Point, Result<PointComparison, Status>)> = points()
        .into_par_iter()
        .with_max_len(1)
        .map(|point| {
            let compared = point.compare();
            (point, compared)
        })
        .collect();
    let rows: Vec<Vec<String>> = found
        .iter()
        .map(|(point, found)| row(point, found))
        .collect();
    let header = [
        "wheel",
        "pattern",
        "load per sector, N",
        "frequency, Hz",
        "harmonics",
        "regime",
        "slipping",
        "separated",
        "ends as",
        "largest blade: time - harmonic balance",
        "any blade",
        "steps per period",
        "periods",
    ];
    Section {
        compared: "The same reduced model (`stick_attachment` 4), pattern and viscous damping on both sides; the march starts from the harmonic \
                   balance solution and its step is halved until the largest amplitude changes by less than 0.1 %. `ok`: the motion became periodic; \
                   `work_budget`: it did not within the periods given, so the periodic solution is unstable there or settles more slowly than that; \
                   its difference is then that of the last period. The regime follows from the pairs that slip and open over the last period: some \
                   that stick is micro-slip, none gross slip. Amplitude of lumped24: largest value over a period."
            .to_owned(),
        body: table(&header, &rows)
            + "\nWhere it is not periodic at 400 N, tuned, the instability was confirmed by Floquet multipliers of a second program (docs/formulation.md, section 10).\n",
        verdicts: verdicts(&found),
    }
}

fn row(point: &Point, found: &Result<PointComparison, Status>) -> Vec<String> {
    let wheel = point.study.rsplit('/').next().unwrap();
    let damped = point
        .loss_factor
        .map_or(String::new(), |factor| format!(", loss factor {factor}"));
    let mut cells = vec![
        format!("{wheel}{damped}"),
        point.who(),
        format!("{}", point.normal_load_n),
        format!("{}", point.frequency_hz),
        span(&point.harmonics),
    ];
    match found {
        Err(status) => {
            cells.extend(["-", "-", "-"].map(str::to_owned));
            cells.push(status.name().to_owned());
            cells.extend(["-", "-", "-", "-"].map(str::to_owned));
        }
        Ok(found) => {
            let shares = found.settled.shares;
            let last = found.steps.last().unwrap();
            let periods: usize = found.steps.iter().map(|study| study.periods).sum();
            cells.extend([
                Regime::of(found).name().to_owned(),
                format!("{:.2}", shares.slipping),
                format!("{:.2}", shares.separated),
                found.status.name().to_owned(),
                signed_percent(found.largest_difference()),
                percent(found.blade_difference()),
                last.steps_per_period.to_string(),
                periods.to_string(),
            ]);
        }
    }
    cells
}

/// A long set by its ends.
fn span(harmonics: &[u32]) -> String {
    let (first, last) = (harmonics[0], harmonics[harmonics.len() - 1]);
    if harmonics.len() < 4 {
        set_name(harmonics)
    } else if harmonics[1] - harmonics[0] == 2 {
        format!("{first} to {last}, odd")
    } else {
        format!("{first} to {last}")
    }
}

fn verdicts(found: &[(Point, Result<PointComparison, Status>)]) -> Vec<Verdict> {
    let ended: Vec<(&Point, &PointComparison)> = found
        .iter()
        .filter_map(|(point, found)| Some((point, found.as_ref().ok()?)))
        .collect();
    let periodic = |lumped: bool| {
        ended
            .iter()
            .filter(move |(point, found)| found.status == Status::Ok && point.is_lumped() == lumped)
    };
    let mut verdicts = vec![
        Verdict::at_most(
            "wheel8-largest-blade",
            "wheel8, largest blade, points that became periodic",
            periodic(false).map(|(_, found)| found.largest_difference().abs()),
            5e-3,
        ),
        Verdict::at_most(
            "lumped24-largest-blade",
            "lumped24, largest blade",
            periodic(true).map(|(_, found)| found.largest_difference().abs()),
            1e-4,
        ),
        Verdict::at_most(
            "lumped24-any-blade",
            "lumped24, any blade",
            periodic(true).map(|(_, found)| found.blade_difference()),
            2e-4,
        ),
    ];
    for regime in [Regime::MicroSlip, Regime::GrossSlip, Regime::Separation] {
        let agrees = |tuned: bool| {
            ended.iter().any(|(point, found)| {
                !point.is_lumped()
                    && Regime::of(found) == regime
                    && point.pattern.is_none() == tuned
                    && found.reached(5e-3)
            })
        };
        verdicts.push(Verdict::share(
            &format!("wheel8-periodic-in-{}", regime.name().replace(' ', "-")),
            &format!(
                "wheel8 in {}, tuned and mistuned: a periodic motion within 0.5 % seen",
                regime.name()
            ),
            [agrees(true), agrees(false)],
            1.0,
        ));
    }
    verdicts
}
