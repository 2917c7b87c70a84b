//! All contact laws: what each is stands in its file, and what it makes of a pair is asked here.

mod coulomb_3d;
mod macro_slip;
mod simplified_3d;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::law_parts::LawParts;
use super::{
    ContactHistory, PairDisplacement, PairMemory, PairParameters, PairState, PeriodicSlider,
    SideBySide, TangentialFriction,
};

/// Declares the laws, from simple to full, each with its parts.
macro_rules! contact_laws {
    ($( $(#[$meaning:meta])* $law:ident = $parts:path, )*) => {
        /// Contact law of a node pair.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum ContactLaw {
            $( $(#[$meaning])* $law, )*
        }

        impl ContactLaw {
            const COUNT: usize = [$( stringify!($law) ),*].len();
            /// Every law, from simple to full.
            pub const ALL: [Self; Self::COUNT] = [$( Self::$law ),*];

            const fn parts(self) -> &'static LawParts {
                match self {
                    $( Self::$law => &$parts, )*
                }
            }
        }
    };
}

contact_laws! {
    /// Friction along the first tangent only, limit `mu N0`; normal spring bilateral where given.
    MacroSlip1d = macro_slip::ALONG_ONE,
    /// Friction along both tangents, each by itself, limit `mu N0`; normal spring bilateral where given.
    MacroSlip2d = macro_slip::ALONG_BOTH,
    /// Variable normal load `max(0, N0 + kn g)` and two independent tangential Jenkins elements.
    Simplified3d = simplified_3d::LAW,
    /// Variable normal load `max(0, N0 + kn g)` and both tangents coupled by the friction circle.
    Coulomb3d = coulomb_3d::LAW,
}

impl ContactLaw {
    /// The names of all laws in a study, in their order.
    pub const NAMES: [&str; Self::COUNT] = {
        let mut names = [""; Self::COUNT];
        let mut at = 0;
        while at < names.len() {
            names[at] = Self::ALL[at].parts().name;
            at += 1;
        }
        names
    };

    /// Whether the normal load follows the normal displacement.
    #[must_use]
    pub fn has_variable_load(self) -> bool {
        self.parts().has_variable_load
    }

    /// Name in a study.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.parts().name
    }

    /// Friction along the tangents.
    #[must_use]
    pub fn friction(self) -> TangentialFriction {
        self.parts().friction
    }

    /// How all pairs of a wheel are evaluated at once, if they can be.
    #[must_use]
    pub fn side_by_side(self) -> SideBySide {
        self.parts().side_by_side
    }

    /// Whether the friction along one tangent depends on the motion along the other.
    #[must_use]
    pub fn couples_tangents(self) -> bool {
        self.friction() == TangentialFriction::FrictionCircle
    }

    /// Tangents along which there is friction, and a spring of the linear limits: t1, or both.
    #[must_use]
    pub fn tangents(self) -> usize {
        match self.friction() {
            TangentialFriction::Jenkins { tangents } => tangents,
            TangentialFriction::FrictionCircle => 2,
        }
    }

    /// Springs along n, t1, t2 of a pair with these stiffnesses, N/m.
    #[must_use]
    pub fn springs(self, normal_n_per_m: f64, tangential_n_per_m: f64) -> [f64; 3] {
        let second = match self.tangents() {
            1 => 0.0,
            _ => tangential_n_per_m,
        };
        [normal_n_per_m, tangential_n_per_m, second]
    }
}

impl Serialize for ContactLaw {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for ContactLaw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let is_named = |law: &Self| law.name() == name;
        let law = Self::ALL.into_iter().find(is_named);
        law.ok_or_else(|| D::Error::unknown_variant(&name, &Self::NAMES))
    }
}

impl PairParameters {
    /// Whether the pair certainly sticks throughout, in contact and with zero offset, if its
    /// displacement along n, t1, t2 never exceeds `excursions_m`: `kt |x| < mu (N0 - kn |g|)`.
    #[must_use]
    pub fn surely_sticks(&self, law: ContactLaw, excursions_m: [f64; 3]) -> bool {
        let [normal, first, second] = excursions_m;
        let load = if law.has_variable_load() {
            self.normal_load_n - self.normal_stiffness_n_per_m * normal
        } else {
            self.normal_load_n
        };
        let tangential = match law.friction() {
            TangentialFriction::Jenkins { tangents: 1 } => first,
            TangentialFriction::Jenkins { .. } => first.max(second),
            TangentialFriction::FrictionCircle => first.hypot(second),
        };
        load > 0.0
            && self.tangential_stiffness_n_per_m * tangential < self.friction_coefficient * load
    }
}

impl ContactHistory {
    /// Applies `law` to the displacement.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn respond(
        &mut self,
        law: ContactLaw,
        parameters: &PairParameters,
        displacement: PairDisplacement<'_>,
    ) -> PairState {
        self.respond_drifting(law, parameters, displacement, [0.0; 2])
    }

    /// Applies `law` to a displacement that besides grows steadily by `drift_m` per period along t1
    /// and t2; the forces are periodic all the same.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn respond_drifting(
        &mut self,
        law: ContactLaw,
        parameters: &PairParameters,
        displacement: PairDisplacement<'_>,
        drift_m: [f64; 2],
    ) -> PairState {
        self.drift_m = drift_m;
        assert_eq!(
            displacement.normal.len(),
            self.normal_load.len(),
            "samples of the closing"
        );
        self.friction = law.friction();
        self.state = (law.parts().respond)(self, parameters, displacement);
        self.state
    }

    /// Tangential corrections along t1 and t2, N (`n_samples` each): the offsets of the sliders.
    #[must_use]
    pub fn tangential_correction_n(&self) -> [&[f64]; 2] {
        match self.friction {
            TangentialFriction::Jenkins { .. } => {
                self.sliders.each_ref().map(PeriodicSlider::offset_n)
            }
            TangentialFriction::FrictionCircle => self.coupled.offset_n(),
        }
    }

    /// Mean friction force along t1 and t2 that the displacements without their means cause, N.
    #[must_use]
    pub fn mean_friction_n(&self) -> [f64; 2] {
        let mean = |offset: &[f64]| offset.iter().sum::<f64>() / offset.len() as f64;
        self.tangential_correction_n().map(mean)
    }
}

impl PairMemory {
    /// Contact force on the blisk's side of the equation along n, t1, t2, N, the static load left out.
    #[must_use]
    pub fn force_n(&self, law: ContactLaw, parameters: &PairParameters) -> [f64; 3] {
        let spring = parameters.normal_stiffness_n_per_m * self.displacement_m[0];
        let normal = if law.has_variable_load() && self.separated() {
            -parameters.normal_load_n
        } else {
            spring
        };
        [normal, self.friction_n[0], self.friction_n[1]]
    }
}

/// The pair after a step to `displacement_m` (n, t1, t2), straight from where it was.
#[must_use]
pub fn march(
    law: ContactLaw,
    parameters: &PairParameters,
    before: &PairMemory,
    displacement_m: [f64; 3],
) -> PairMemory {
    (law.parts().march)(parameters, before, displacement_m)
}
