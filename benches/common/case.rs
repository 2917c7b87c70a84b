//! A study of `studies/`, reduced and ready to be timed: its first mistuned pattern under its loads.

use std::path::Path;
use std::sync::Arc;

use blisk::model::ReducedModel;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction, ReductionOptions};
use blisk::model::sector::SectorModel;
use blisk::population::monte_carlo::{RowSettings, RowSolver};
use blisk::response::forced_response::{
    ContactCondition, Excited, FrequencyBand, Harmonics, LimitsWanted, Peak, PointSettings, Wheel,
    mistuned_window, peak, tuned_span, wheel_force,
};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{ContactInterface, HarmonicSystem, HarmonicTransform};
use blisk::response::mistuning::{ContactFactors, Deviations, Pattern, StructuralModes};
use blisk::study::{Study, load_sector_model, pattern_source};

/// A reduced study and its first patterns.
pub struct Case {
    pub name: &'static str,
    pub study: Study,
    pub solver: RowSolver,
    pub patterns: Vec<Pattern>,
    harmonics: Vec<u32>,
    contact: (ContactLaw, PairParameters),
    settings: PointSettings,
    tuned: Excited,
}

/// The study file `name` of `studies/`.
pub fn study(name: &str) -> Study {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Study::read(&root.join("studies").join(format!("{name}.toml"))).expect("a valid study")
}

/// The sector of a study and what it is reduced to.
pub struct Model {
    sector: SectorModel,
    reduced: Arc<ReducedModel>,
}

impl Model {
    /// Built or read, and reduced, with the basis that the study fixes.
    pub fn new(study: &Study) -> Self {
        let sector = load_sector_model(study).expect("a valid model");
        let contact = study.contact.as_ref().expect("a study with contact");
        let normal = contact.normal_stiffness_n_per_m.unwrap_or(0.0);
        let tangential = contact.tangential_stiffness_n_per_m;
        let [normal, first, second] = contact.law.springs(normal, tangential);
        let stiffness = ContactStiffness {
            normal_n_per_m: normal,
            tangential_1_n_per_m: first,
            tangential_2_n_per_m: second,
        };
        let (stick, slide) = (study.reduction.stick_modes, study.reduction.slide_modes);
        let choice = BasisChoice::StickSlide {
            stick: stick.unwrap_or(4),
            slide: slide.unwrap_or(4),
        };
        let modes = study.reduction.craig_bampton_modes;
        let modes = modes.unwrap_or(ReductionOptions::FIRST_CRAIG_BAMPTON_MODES);
        let reduction = Reduction::new(&sector, stiffness, modes, 0).expect("reduced");
        let reduced = Arc::new(reduction.reduce(choice, None).expect("reduced"));
        Self { sector, reduced }
    }
}

impl Case {
    /// The case `name` with its first `patterns` patterns; `basis` is the one that the study fixes.
    pub fn new(name: &'static str, patterns: u32) -> Self {
        Self::of(name, study(name), patterns)
    }

    /// The same with harmonics 1 and 3: small enough for its whole Jacobian.
    pub fn with_whole_jacobian(name: &'static str, patterns: u32) -> Self {
        let mut study = study(name);
        study.solver.harmonics = Harmonics::Set(vec![1, 3]);
        Self::of(name, study, patterns)
    }

    /// A study as it is given; its basis is a fixed one.
    pub fn of(name: &'static str, study: Study, patterns: u32) -> Self {
        Self::with_model(name, &Model::new(&study), study, patterns)
    }

    /// A study whose model is reduced already.
    pub fn with_model(name: &'static str, model: &Model, study: Study, patterns: u32) -> Self {
        let contact = study.contact.as_ref().expect("a study with contact");
        let Model { sector, reduced } = model;
        let harmonics = match &study.solver.harmonics {
            Harmonics::Auto => vec![1, 3],
            Harmonics::Set(set) => set.clone(),
        };
        let contact = (contact.law, contact.sector_parameters(0.0));
        let settings = RowSettings {
            harmonics: harmonics.clone(),
            contact: Some(contact),
            ring: study.contact.as_ref().expect("a study with contact").ring,
            damping: study.damping,
            amplitude_n: study.amplitude_n,
            projection: study.mistuning.projection,
            solver: study.solver.clone(),
        };
        let source = pattern_source(&study, sector).expect("patterns");
        let deviation = study.standard_deviations[0];
        let patterns = source
            .ids()
            .into_iter()
            .take(patterns as usize)
            .filter_map(|id| source.pattern(id, deviation))
            .collect();
        let geometry = reduced.contact.clone();
        let point_settings = PointSettings::new(&study.solver, &harmonics, Some(contact), geometry);
        let tuned_wheel = Excited::tuned(
            reduced,
            &ContactFactors::default(),
            study.engine_orders[0],
            study.amplitude_n,
            study.damping,
            &harmonics,
            LimitsWanted {
                stuck: true,
                slide: true,
                free: true,
            },
        );
        Self {
            name,
            settings: point_settings.expect("enough samples"),
            tuned: tuned_wheel,
            solver: RowSolver::new(reduced.clone(), settings).expect("enough samples"),
            patterns,
            harmonics,
            contact,
            study,
        }
    }

    /// The harmonic set.
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// The wheel of `pattern` in these harmonics, excited by the first engine order of the study.
    pub fn excited(&self, pattern: &Pattern, harmonics: &[u32]) -> Excited {
        let basis = self.solver.basis();
        let Deviations::PerBlade(values) = &pattern.deviations else {
            panic!("one deviation per blade");
        };
        let change = basis.blade_stiffness_change(values);
        let modes = StructuralModes::of_wheel(basis, &change).expect("finite");
        let force = wheel_force(basis, &modes, self.engine_order(), self.study.amplitude_n);
        let wanted = LimitsWanted {
            stuck: true,
            slide: true,
            free: false,
        };
        let wheel = Wheel::mistuned(
            modes,
            basis.model(),
            &ContactFactors::default(),
            self.study.damping,
            wanted,
        );
        Excited::wheel(&wheel, force, harmonics)
    }

    fn engine_order(&self) -> u32 {
        self.study.engine_orders[0]
    }

    /// The peak of a pattern whose wheel is `excited`.
    pub fn peak(&self, pattern: &Pattern, excited: &Excited, condition: ContactCondition) -> Peak {
        let span = tuned_span(&self.tuned, condition, None).expect("a resonance");
        let window = mistuned_window(span, pattern.largest_deviation(), FrequencyBand::Auto);
        let (options, settings) = (&self.study.solver, &self.settings);
        let tolerance = options.peak_tolerance;
        peak(excited, condition, settings, window, tolerance)
    }

    /// The harmonic balance equation of `excited` under a normal load per sector.
    pub fn system(&self, excited: &Excited, normal_load_n: f64) -> HarmonicSystem {
        let (law, sector) = self.contact;
        let geometry = self.solver.basis().model().contact.clone();
        let sector = PairParameters {
            normal_load_n,
            ..sector
        };
        let pairs = geometry.weights.iter().map(|&w| sector.share(w)).collect();
        let interface = ContactInterface {
            law,
            geometry,
            pairs,
        };
        let set: Vec<usize> = self.harmonics.iter().map(|&k| k as usize).collect();
        let samples = self.study.solver.samples_per_period;
        let transform = HarmonicTransform::new(&set, samples).expect("enough samples");
        HarmonicSystem::new(
            excited.blocks.clone(),
            excited.force.clone(),
            interface,
            Arc::new(transform),
        )
    }

    /// The loads of the study with friction, N.
    pub fn loads(&self) -> Vec<f64> {
        let conditions = self.study.contacts.iter();
        conditions.filter_map(|c| c.normal_load_n()).collect()
    }
}
