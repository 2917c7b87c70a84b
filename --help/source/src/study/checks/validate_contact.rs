//! The checks of the table `[contact.variation]`.

use super::check::Check;
use crate::response::friction::ContactOptions;
use crate::response::mistuning::{
    ContactQuantity, ContactVariation, Distribution, FactorLaw, TRUNCATION_RANGE,
};
use crate::study::raw::{RawContactVariation, RawFactorKind, RawVariation};

/// Largest accepted standard deviation of the logarithm of a factor: 95 % between 1/50 and 50.
const LARGEST_LOGARITHMIC: f64 = 2.0;
/// Largest accepted standard deviation of a factor itself.
const LARGEST_RELATIVE: f64 = 0.5;

/// What of the contact varies, in the order of its columns.
pub(super) fn contact_variations(
    check: &mut Check,
    raw: &RawContactVariation,
    contact: &ContactOptions,
) -> Vec<ContactVariation> {
    ContactQuantity::ALL
        .into_iter()
        .filter_map(|quantity| {
            let raw = match quantity {
                ContactQuantity::FrictionCoefficient => &raw.friction_coefficient,
                ContactQuantity::TangentialStiffness => &raw.tangential_stiffness,
                ContactQuantity::NormalStiffness => &raw.normal_stiffness,
                ContactQuantity::NormalLoad => &raw.normal_load,
            };
            let key = format!("contact.variation.{}", quantity.name());
            let raw = raw.as_ref()?;
            let absent = quantity == ContactQuantity::NormalStiffness
                && contact.normal_stiffness_n_per_m.unwrap_or(0.0) <= 0.0;
            if absent {
                check.conflict(
                    &key,
                    "the contact has no normal stiffness; accepted: contact.normal_stiffness_n_per_m above 0",
                );
            }
            variation(check, &key, quantity, raw)
        })
        .collect()
}

fn variation(
    check: &mut Check,
    key: &str,
    quantity: ContactQuantity,
    raw: &RawVariation,
) -> Option<ContactVariation> {
    let kind_key = format!("{key}.kind");
    let Some(kind) = raw.kind else {
        check.missing(
            &kind_key,
            "\"normal\", \"uniform\", \"truncated_normal\" or \"lognormal\"",
        );
        return None;
    };
    let largest = match kind {
        RawFactorKind::Lognormal => LARGEST_LOGARITHMIC,
        _ => LARGEST_RELATIVE,
    };
    let deviation_key = format!("{key}.standard_deviation");
    let accepted = format!("a number above 0, up to {largest}");
    let Some(standard_deviation) = raw.standard_deviation else {
        check.missing(&deviation_key, &accepted);
        return None;
    };
    let fits = standard_deviation > 0.0 && standard_deviation <= largest;
    check.within(&deviation_key, standard_deviation, fits, &accepted);
    let truncation_key = format!("{key}.truncation");
    let cut_off = format!(
        "a number from {} to {}, in standard deviations of the normal law",
        TRUNCATION_RANGE[0], TRUNCATION_RANGE[1]
    );
    let law = match (kind, raw.truncation) {
        (RawFactorKind::TruncatedNormal, None) => {
            check.missing(&truncation_key, &cut_off);
            return None;
        }
        (RawFactorKind::TruncatedNormal, Some(truncation)) => {
            let law = Distribution::TruncatedNormal { truncation };
            if law.validate().is_err() {
                check.refuse(&truncation_key, &cut_off);
            }
            FactorLaw::Relative(law)
        }
        (_, Some(_)) => {
            check.conflict(
                &truncation_key,
                "this law is not cut off; accepted: kind = \"truncated_normal\"",
            );
            return None;
        }
        (RawFactorKind::Normal, None) => FactorLaw::Relative(Distribution::Normal),
        (RawFactorKind::Uniform, None) => FactorLaw::Relative(Distribution::Uniform),
        (RawFactorKind::Lognormal, None) => FactorLaw::Lognormal,
    };
    Some(ContactVariation {
        quantity,
        law,
        standard_deviation,
        per: raw.per.unwrap_or_default(),
    })
}
