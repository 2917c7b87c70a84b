//! The table `[contact.variation]`: from the file, and back.

use super::check::Check;
use crate::response::friction::ContactOptions;
use crate::response::mistuning::{ContactQuantity, ContactVariation, Distribution, FactorLaw};
use crate::study::keys::contact::{FactorKind, FactorTable, VariationTable};

/// Largest accepted standard deviation of the logarithm of a factor: 95 % between 1/50 and 50.
const LARGEST_LOGARITHMIC: f64 = 2.0;
/// Largest accepted standard deviation of a factor itself.
const LARGEST_RELATIVE: f64 = 0.5;

/// What of the contact varies, in the order of its columns.
pub(super) fn contact_variations(
    check: &mut Check,
    table: &VariationTable,
    contact: &ContactOptions,
) -> Vec<ContactVariation> {
    ContactQuantity::ALL
        .into_iter()
        .filter_map(|quantity| {
            let factor = match quantity {
                ContactQuantity::FrictionCoefficient => &table.friction_coefficient,
                ContactQuantity::TangentialStiffness => &table.tangential_stiffness,
                ContactQuantity::NormalStiffness => &table.normal_stiffness,
                ContactQuantity::NormalLoad => &table.normal_load,
            };
            let key = format!("contact.variation.{}", quantity.name());
            let factor = factor.as_ref()?;
            let absent = quantity == ContactQuantity::NormalStiffness
                && contact.normal_stiffness_n_per_m.unwrap_or(0.0) <= 0.0;
            if absent {
                check.conflict(
                    &key,
                    "the contact has no normal stiffness; accepted: contact.normal_stiffness_n_per_m above 0",
                );
            }
            variation(check, &key, quantity, factor)
        })
        .collect()
}

fn variation(
    check: &mut Check,
    key: &str,
    quantity: ContactQuantity,
    table: &FactorTable,
) -> Option<ContactVariation> {
    let kind_key = format!("{key}.kind");
    let Some(kind) = table.kind else {
        check.missing(&kind_key);
        return None;
    };
    let largest = match kind {
        FactorKind::Lognormal => LARGEST_LOGARITHMIC,
        _ => LARGEST_RELATIVE,
    };
    let deviation_key = format!("{key}.standard_deviation");
    let accepted = format!("a number above 0, up to {largest}");
    let Some(standard_deviation) = table.standard_deviation else {
        check.missing_for(&deviation_key, &accepted);
        return None;
    };
    if !(standard_deviation > 0.0 && standard_deviation <= largest) {
        check.refuse_for(&deviation_key, &accepted);
    }
    let truncation_key = format!("{key}.truncation");
    let law = match (kind, table.truncation) {
        (FactorKind::TruncatedNormal, None) => {
            check.missing(&truncation_key);
            return None;
        }
        (FactorKind::TruncatedNormal, Some(truncation)) => {
            let truncation = check.judged(&truncation_key, truncation);
            FactorLaw::Relative(Distribution::TruncatedNormal { truncation })
        }
        (_, Some(_)) => {
            check.conflict(
                &truncation_key,
                "this law is not cut off; accepted: kind = \"truncated_normal\"",
            );
            return None;
        }
        (FactorKind::Normal, None) => FactorLaw::Relative(Distribution::Normal),
        (FactorKind::Uniform, None) => FactorLaw::Relative(Distribution::Uniform),
        (FactorKind::Lognormal, None) => FactorLaw::Lognormal,
    };
    Some(ContactVariation {
        quantity,
        law,
        standard_deviation,
        per: table.per.unwrap_or_default(),
    })
}

/// What of the contact varies as a study file has it.
pub(super) fn variation_table(variations: &[ContactVariation]) -> VariationTable {
    let mut table = VariationTable::default();
    for variation in variations {
        let factor = match variation.quantity {
            ContactQuantity::FrictionCoefficient => &mut table.friction_coefficient,
            ContactQuantity::TangentialStiffness => &mut table.tangential_stiffness,
            ContactQuantity::NormalStiffness => &mut table.normal_stiffness,
            ContactQuantity::NormalLoad => &mut table.normal_load,
        };
        let (kind, truncation) = match variation.law {
            FactorLaw::Lognormal => (FactorKind::Lognormal, None),
            FactorLaw::Relative(Distribution::Normal) => (FactorKind::Normal, None),
            FactorLaw::Relative(Distribution::Uniform) => (FactorKind::Uniform, None),
            FactorLaw::Relative(Distribution::TruncatedNormal { truncation }) => {
                (FactorKind::TruncatedNormal, Some(truncation))
            }
        };
        *factor = Some(FactorTable {
            kind: Some(kind),
            standard_deviation: Some(variation.standard_deviation),
            truncation,
            per: Some(variation.per),
        });
    }
    table
}
