//! Small wheels of solid elements with every built-in damper.

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{Damper, DamperShape, ParametricOptions, SectorModel, parametric};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;

use crate::wheels::Wheel;

pub const SECTORS: usize = 8;
pub const LOSS_FACTOR: f64 = 0.004;

/// A damper with its stiffness along tangents and normal, N/m.
#[derive(Clone, Copy)]
pub struct Kind {
    pub name: &'static str,
    damper: Damper,
    shape: DamperShape,
    stiffness_n_per_m: [f64; 2],
}

const fn kind(name: &'static str, damper: Damper, stiffness_n_per_m: [f64; 2]) -> Kind {
    Kind {
        name,
        damper,
        shape: DamperShape::Wedge,
        stiffness_n_per_m,
    }
}

pub const KINDS: [Kind; 5] = [
    kind("ring", Damper::Ring, [1e8, 1e8]),
    kind("wedge", Damper::Underplatform, [4e7, 8e7]),
    Kind {
        shape: DamperShape::Cylinder,
        ..kind("cylinder", Damper::Underplatform, [4e7, 8e7])
    },
    kind("shroud", Damper::Shroud, [1e7, 2e7]),
    kind("ground", Damper::BladeToGround, [4e7, 8e7]),
];

impl Kind {
    pub fn sector(&self) -> SectorModel {
        parametric::build(&ParametricOptions {
            sectors: SECTORS,
            damper: self.damper,
            damper_shape: self.shape,
            blade_radial_elements: 3,
            disk_radial_elements: 2,
            ..ParametricOptions::default()
        })
        .unwrap()
    }

    pub fn wheel(&self, law: ContactLaw) -> Wheel {
        let [tangential, normal] = self.stiffness_n_per_m;
        let contact = PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: normal,
            tangential_stiffness_n_per_m: tangential,
            friction_coefficient: 0.3,
        };
        let damping = Damping::StructuralLossFactor(LOSS_FACTOR);
        let basis = BasisChoice::StickSlide { stick: 3, slide: 3 };
        Wheel::of(&self.sector(), law, contact, damping, basis)
    }
}
