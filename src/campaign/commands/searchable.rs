//! Which studies have no best load to search, and what answers the question in its place.

use crate::population::statistics::{CONFIDENCE, PERCENTILES, smallest_sample};
use crate::study::{PipelineError, Study};

/// Refuses a study that the lowest percentile over loads cannot be searched of.
///
/// # Errors
/// Several standard deviations, no contact, loads by rotation, or too few patterns for the percentile.
pub(super) fn refuse(study: &Study, percent: f64) -> Result<(), PipelineError> {
    let deviations = study.standard_deviations.len();
    let needed = smallest_sample(percent / 100.0, CONFIDENCE);
    let reason = if deviations != 1 {
        format!(
            "a search takes a study with one standard deviation, sweep.standard_deviation has {deviations}; accepted: one of \
             them, like [{}]; `blisk run` takes all of them at the loads of sweep.normal_load_n",
            study.standard_deviations[0].unwrap_or(0.03)
        )
    } else if study.contact.is_none() {
        "the study has no [contact], so there is no normal load to search; accepted: a study with [contact] \
         (`blisk explain contact`)"
            .to_owned()
    } else if study.rotation.is_some() {
        "a search is over newtons; accepted: a study without contact.normal_load; `blisk run` compares the speeds of \
         contact.normal_load.speed_rpm"
            .to_owned()
    } else if u64::from(study.patterns) < needed {
        no_interval(study, percent, needed)
    } else {
        return Ok(());
    };
    Err(PipelineError::NoOptimum { reason })
}

/// That the percentile of so few patterns has no interval, and what does.
fn no_interval(study: &Study, percent: f64, needed: u64) -> String {
    let patterns = study.patterns;
    if study.standard_deviations != [None] {
        let estimable =
            |own: &u32| u64::from(patterns) >= smallest_sample(f64::from(*own) / 100.0, CONFIDENCE);
        let lower = { PERCENTILES.into_iter().rev() }
            .find(|own| estimable(own) && f64::from(*own) < percent);
        let lower = lower.map_or_else(String::new, |lower| {
            format!(", or --percentile {lower}, for which they are enough")
        });
        return format!(
            "P{percent} of {patterns} patterns has no interval; accepted: study.patterns from {needed} on{lower}"
        );
    }
    let (wheels, which) = match patterns {
        1 => (
            "one wheel has no percentile to search".to_owned(),
            "the load with the lowest peak of this wheel",
        ),
        _ => (
            format!("P{percent} of {patterns} wheels has no interval"),
            "the load under which the worst of these wheels is lowest",
        ),
    };
    format!(
        "{wheels}; accepted: a mistuning.file of {needed} wheels or more; for {which}, list loads in sweep.normal_load_n, \
         `blisk run {}` and read it in `blisk report DIR`; for a percentile of random wheels, take mistuning.distribution in the \
         place of mistuning.file, with study.patterns from {needed} on and sweep.standard_deviation",
        study.path.display()
    )
}
