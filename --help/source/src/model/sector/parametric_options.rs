//! Dimensions, materials and mesh of the built-in bladed disk, with their defaults and limits.

use serde::{Deserialize, Serialize};

use super::error::ModelError;
use super::error_place::Accepted;
use super::hexahedron20::Material;

/// What damps the built-in bladed disk by friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Damper {
    /// A ring under the rim's flange.
    #[default]
    Ring,
    /// A wedge or a cylinder between the platforms of neighbouring blades, pressed outwards into their gap.
    Underplatform,
    /// Shrouds of neighbouring blades, that touch one another.
    Shroud,
    /// The platform of each blade on the ground.
    BladeToGround,
}

/// The form of an underplatform damper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DamperShape {
    /// A wedge, whose flanks lie on those of the platforms.
    #[default]
    Wedge,
    /// A cylinder along the axis, that touches either flank on a line in its middle.
    Cylinder,
}

/// What the body of an underplatform damper is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DamperBody {
    /// Solid elements.
    #[default]
    Elastic,
    /// Six dofs at its centre of mass.
    Rigid,
}

/// The built-in bladed disk with its damper; lengths in m.
///
/// Seen in the (z, r) plane, from the axis outwards: a web of constant thickness round z = 0, clamped
/// at the bore; a rim, as wide as `rim_axial_width_m`, centred on z = 0; a flange, the outer layer of the
/// rim continued towards +z; under the flange's free end the ring. The blade stands on the rim. Other dampers have neither
/// flange nor ring, but a plate round the blade's section: a platform above the rim, or a shroud.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ParametricOptions {
    /// Number of sectors N. Default 24.
    pub sectors: usize,
    /// The damper. Default ring.
    pub damper: Damper,
    /// The form of an underplatform damper. Default wedge.
    pub damper_shape: DamperShape,
    /// The body of an underplatform damper. Default elastic.
    pub damper_body: DamperBody,
    /// Radius of the bore, where the disk is clamped. Default 0.06.
    pub bore_radius_m: f64,
    /// Outer radius of the rim, on which the blade stands. Default 0.205.
    pub rim_radius_m: f64,
    /// Radial thickness of the rim. Default 0.010.
    pub rim_thickness_m: f64,
    /// Axial width of the rim. Default 0.040.
    pub rim_axial_width_m: f64,
    /// Axial thickness of the disk's web. Default 0.006.
    pub disk_thickness_m: f64,
    /// Axial length of the flange beyond the rim. Default 0.014.
    pub flange_length_m: f64,
    /// Radial thickness of the flange, at most that of the rim. Default 0.010.
    pub flange_thickness_m: f64,
    /// Axial width of the ring, which ends where the flange ends; at most the flange's length. Default 0.014.
    pub ring_axial_width_m: f64,
    /// Radial thickness of the ring. Default 0.005.
    pub ring_thickness_m: f64,
    /// Height of the blade above the rim. Default 0.080.
    pub blade_height_m: f64,
    /// Axial chord at the root, at most the rim's width; the chord is this over cos(stagger). Default 0.040.
    pub blade_root_axial_chord_m: f64,
    /// Axial chord at the tip. Default 0.032.
    pub blade_tip_axial_chord_m: f64,
    /// Thickness at the root, normal to the chord. Default 0.0055.
    pub blade_root_thickness_m: f64,
    /// Thickness at the tip, normal to the chord. Default 0.003.
    pub blade_tip_thickness_m: f64,
    /// Angle from the axis to the chord at the root, positive from +z towards +theta. Default 30.0.
    pub blade_stagger_angle_deg: f64,
    /// Stagger angle at the tip less that at the root; linear in between. Default 20.0.
    pub blade_twist_deg: f64,
    /// Height of the platform's underside above the rim. Default 0.006.
    pub platform_height_m: f64,
    /// Radial thickness of the platform, and of the wedge. Default 0.006.
    pub platform_thickness_m: f64,
    /// Gap between two platforms at their outer side. Default 0.003.
    pub platform_gap_m: f64,
    /// Angle between the flank of the platform and the radius. Default 35.0.
    pub flank_angle_deg: f64,
    /// Height of the shroud's outer side above the rim, as a share of the blade's. Default 1.0.
    pub shroud_height_share: f64,
    /// Radial thickness of the shroud. Default 0.004.
    pub shroud_thickness_m: f64,
    /// Angle between the contact face of the shroud and the axis. Default 30.0.
    pub shroud_angle_deg: f64,
    /// Young's modulus of disk and blade, Pa. Default 2.1e11.
    pub blisk_youngs_modulus_pa: f64,
    /// Poisson's ratio of disk and blade. Default 0.3.
    pub blisk_poisson_ratio: f64,
    /// Density of disk and blade. Default 7850.0.
    pub blisk_density_kg_per_m3: f64,
    /// Young's modulus of ring or damper body, Pa. Default 2.1e11.
    pub ring_youngs_modulus_pa: f64,
    /// Poisson's ratio of ring or damper body. Default 0.3.
    pub ring_poisson_ratio: f64,
    /// Density of ring or damper body. Default 7850.0.
    pub ring_density_kg_per_m3: f64,
    /// Frequency f of the weak grounding `(2 pi f)^2 M` of ring or damper body, which contact alone holds otherwise. Default 5.0.
    pub ring_grounding_frequency_hz: f64,
    /// Elements along the radius of the web. Default 3.
    pub disk_radial_elements: usize,
    /// Elements through the axial thickness of the web. Default 1.
    pub disk_axial_elements: usize,
    /// Elements of the rim and the root along z, on each side of the web. Default 1.
    pub rim_axial_elements: usize,
    /// Elements along the flange over the ring's width. Default 1.
    pub flange_axial_elements: usize,
    /// Elements between the blade and each cyclic face. Default 1.
    pub passage_elements: usize,
    /// Elements through the thickness of the blade. Default 1.
    pub blade_thickness_elements: usize,
    /// Elements along the height of the blade. Default 5.
    pub blade_radial_elements: usize,
    /// Elements through the radial thickness of the ring. Default 1.
    pub ring_radial_elements: usize,
}

impl Default for ParametricOptions {
    fn default() -> Self {
        Self {
            sectors: 24,
            damper: Damper::Ring,
            damper_shape: DamperShape::Wedge,
            damper_body: DamperBody::Elastic,
            bore_radius_m: 0.06,
            rim_radius_m: 0.205,
            rim_thickness_m: 0.010,
            rim_axial_width_m: 0.040,
            disk_thickness_m: 0.006,
            flange_length_m: 0.014,
            flange_thickness_m: 0.010,
            ring_axial_width_m: 0.014,
            ring_thickness_m: 0.005,
            blade_height_m: 0.080,
            blade_root_axial_chord_m: 0.040,
            blade_tip_axial_chord_m: 0.032,
            blade_root_thickness_m: 0.0055,
            blade_tip_thickness_m: 0.003,
            blade_stagger_angle_deg: 30.0,
            blade_twist_deg: 20.0,
            platform_height_m: 0.006,
            platform_thickness_m: 0.006,
            platform_gap_m: 0.003,
            flank_angle_deg: 35.0,
            shroud_height_share: 1.0,
            shroud_thickness_m: 0.004,
            shroud_angle_deg: 30.0,
            blisk_youngs_modulus_pa: 2.1e11,
            blisk_poisson_ratio: 0.3,
            blisk_density_kg_per_m3: 7850.0,
            ring_youngs_modulus_pa: 2.1e11,
            ring_poisson_ratio: 0.3,
            ring_density_kg_per_m3: 7850.0,
            ring_grounding_frequency_hz: 5.0,
            disk_radial_elements: 3,
            disk_axial_elements: 1,
            rim_axial_elements: 1,
            flange_axial_elements: 1,
            passage_elements: 1,
            blade_thickness_elements: 1,
            blade_radial_elements: 5,
            ring_radial_elements: 1,
        }
    }
}

/// Largest number of sectors accepted; below three a sector spans half a turn or more.
const SECTORS: (usize, usize) = (3, 1000);
/// Largest number of elements in one direction.
const MAX_ELEMENTS: usize = 64;
/// Largest stagger angle at root and tip, deg: beyond it the elements are too sheared.
const MAX_STAGGER_DEG: f64 = 65.0;
/// Least angle of a wedge's flank, deg: below it friction may hold what the flank pressed together.
const LEAST_FLANK_DEG: f64 = 5.0;

impl ParametricOptions {
    /// Inner radius of the rim, m.
    #[must_use]
    pub fn rim_inner_radius_m(&self) -> f64 {
        self.rim_radius_m - self.rim_thickness_m
    }

    /// Inner radius of the flange, which is the outer radius of the ring, m.
    #[must_use]
    pub fn flange_inner_radius_m(&self) -> f64 {
        self.rim_radius_m - self.flange_thickness_m
    }

    /// Half the angle of the blade's root at the rim, rad: `t / (2 r cos(stagger))`.
    #[must_use]
    pub fn blade_half_angle_rad(&self) -> f64 {
        let cosine = self.blade_stagger_angle_deg.to_radians().cos();
        self.blade_root_thickness_m / (2.0 * self.rim_radius_m * cosine)
    }

    /// Material of disk and blade, then of ring or damper body.
    #[must_use]
    pub fn materials(&self) -> [Material; 2] {
        [
            Material {
                youngs_modulus_pa: self.blisk_youngs_modulus_pa,
                poisson_ratio: self.blisk_poisson_ratio,
                density_kg_per_m3: self.blisk_density_kg_per_m3,
            },
            Material {
                youngs_modulus_pa: self.ring_youngs_modulus_pa,
                poisson_ratio: self.ring_poisson_ratio,
                density_kg_per_m3: self.ring_density_kg_per_m3,
            },
        ]
    }

    /// Checks every value and the order of the radii and widths.
    ///
    /// # Errors
    /// [`ModelError::Option`] with the key, the value and what is accepted.
    pub fn check(&self) -> Result<(), ModelError> {
        self.check_counts()?;
        self.check_signs()?;
        self.check_order()?;
        self.check_shelf()
    }

    fn check_counts(&self) -> Result<(), ModelError> {
        count("sectors", self.sectors, SECTORS)?;
        for (key, value) in [
            ("disk_radial_elements", self.disk_radial_elements),
            ("disk_axial_elements", self.disk_axial_elements),
            ("rim_axial_elements", self.rim_axial_elements),
            ("flange_axial_elements", self.flange_axial_elements),
            ("passage_elements", self.passage_elements),
            ("blade_thickness_elements", self.blade_thickness_elements),
            ("blade_radial_elements", self.blade_radial_elements),
            ("ring_radial_elements", self.ring_radial_elements),
        ] {
            count(key, value, (1, MAX_ELEMENTS))?;
        }
        Ok(())
    }

    fn check_signs(&self) -> Result<(), ModelError> {
        for (key, value) in [
            ("bore_radius_m", self.bore_radius_m),
            ("rim_radius_m", self.rim_radius_m),
            ("rim_thickness_m", self.rim_thickness_m),
            ("rim_axial_width_m", self.rim_axial_width_m),
            ("disk_thickness_m", self.disk_thickness_m),
            ("flange_length_m", self.flange_length_m),
            ("flange_thickness_m", self.flange_thickness_m),
            ("ring_axial_width_m", self.ring_axial_width_m),
            ("ring_thickness_m", self.ring_thickness_m),
            ("blade_height_m", self.blade_height_m),
            ("blade_root_axial_chord_m", self.blade_root_axial_chord_m),
            ("blade_tip_axial_chord_m", self.blade_tip_axial_chord_m),
            ("blade_root_thickness_m", self.blade_root_thickness_m),
            ("blade_tip_thickness_m", self.blade_tip_thickness_m),
            ("platform_height_m", self.platform_height_m),
            ("platform_thickness_m", self.platform_thickness_m),
            ("platform_gap_m", self.platform_gap_m),
            ("shroud_height_share", self.shroud_height_share),
            ("shroud_thickness_m", self.shroud_thickness_m),
            ("blisk_youngs_modulus_pa", self.blisk_youngs_modulus_pa),
            ("blisk_density_kg_per_m3", self.blisk_density_kg_per_m3),
            ("ring_youngs_modulus_pa", self.ring_youngs_modulus_pa),
            ("ring_density_kg_per_m3", self.ring_density_kg_per_m3),
        ] {
            accept(
                key,
                value,
                value.is_finite() && value > 0.0,
                Accepted::Positive,
            )?;
        }
        let grounding = self.ring_grounding_frequency_hz;
        let valid = grounding.is_finite() && grounding >= 0.0;
        accept(
            "ring_grounding_frequency_hz",
            grounding,
            valid,
            Accepted::NonNegative,
        )?;
        for (key, value) in [
            ("blisk_poisson_ratio", self.blisk_poisson_ratio),
            ("ring_poisson_ratio", self.ring_poisson_ratio),
        ] {
            accept(
                key,
                value,
                (0.0..0.5).contains(&value),
                Accepted::Range(0.0, 0.5),
            )?;
        }
        let limits = -MAX_STAGGER_DEG..MAX_STAGGER_DEG;
        let accepted = Accepted::Range(limits.start, limits.end);
        let root = self.blade_stagger_angle_deg;
        accept(
            "blade_stagger_angle_deg",
            root,
            limits.contains(&root),
            accepted,
        )?;
        let twist = self.blade_twist_deg;
        let accepted = Accepted::Range(limits.start - root, limits.end - root);
        accept(
            "blade_twist_deg",
            twist,
            limits.contains(&(root + twist)),
            accepted,
        )
    }

    /// Platform and shroud: their angles, and that the blade holds them.
    fn check_shelf(&self) -> Result<(), ModelError> {
        for (key, angle_deg, lowest) in [
            ("flank_angle_deg", self.flank_angle_deg, LEAST_FLANK_DEG),
            ("shroud_angle_deg", self.shroud_angle_deg, -MAX_STAGGER_DEG),
        ] {
            let is_possible = (lowest..MAX_STAGGER_DEG).contains(&angle_deg);
            let accepted = Accepted::Range(lowest, MAX_STAGGER_DEG);
            accept(key, angle_deg, is_possible, accepted)?;
        }
        let height = self.platform_height_m;
        let limit = self.blade_height_m - self.platform_thickness_m;
        let accepted = Accepted::BelowM("blade_height_m - platform_thickness_m", limit);
        accept("platform_height_m", height, height < limit, accepted)?;
        let share = self.shroud_height_share;
        let accepted = Accepted::Range(0.0, 1.0 + f64::EPSILON);
        accept("shroud_height_share", share, share <= 1.0, accepted)?;
        let thickness = self.shroud_thickness_m;
        let limit = share * self.blade_height_m;
        let accepted = Accepted::BelowM("shroud_height_share * blade_height_m", limit);
        accept("shroud_thickness_m", thickness, thickness < limit, accepted)?;
        let gap = self.platform_gap_m;
        let pitch_m = std::f64::consts::TAU / self.sectors as f64 * self.rim_radius_m;
        let accepted = Accepted::BelowM("the pitch of the blades at the rim", pitch_m);
        accept("platform_gap_m", gap, gap < pitch_m, accepted)?;
        self.check_room_of_platform()
    }

    /// Checks that gap and flank leave a platform beside the blade: at its underside, where the flank reaches furthest.
    fn check_room_of_platform(&self) -> Result<(), ModelError> {
        let flank_deg = match self.damper {
            Damper::Ring | Damper::Shroud => return Ok(()),
            Damper::Underplatform => self.flank_angle_deg,
            Damper::BladeToGround => 0.0,
        };
        let room_m = self.room_m(self.platform_height_m);
        let flank_m = |angle_deg: f64| self.platform_thickness_m * angle_deg.to_radians().tan();
        let limit_m = 2.0 * (room_m - flank_m(flank_deg));
        if limit_m <= 0.0 && room_m > flank_m(LEAST_FLANK_DEG) {
            let steepest_deg = (room_m / self.platform_thickness_m).atan().to_degrees();
            let accepted = Accepted::Range(LEAST_FLANK_DEG, steepest_deg);
            return accept("flank_angle_deg", flank_deg, false, accepted);
        }
        let gap_m = self.platform_gap_m;
        let accepted = Accepted::BelowM("what blade and flank leave of the pitch", limit_m);
        accept("platform_gap_m", gap_m, gap_m < limit_m, accepted)
    }

    /// Half of the room between two blades at a height above the rim, m: the blade's surface at the end of its chord
    /// reaches furthest along theta.
    pub(super) fn room_m(&self, height_m: f64) -> f64 {
        let share = height_m / self.blade_height_m;
        let between = |root: f64, tip: f64| root + share * (tip - root);
        let radius_m = self.rim_radius_m + height_m;
        let stagger = (self.blade_stagger_angle_deg + share * self.blade_twist_deg).to_radians();
        let chord_m = between(self.blade_root_axial_chord_m, self.blade_tip_axial_chord_m);
        let thickness_m = between(self.blade_root_thickness_m, self.blade_tip_thickness_m);
        let reach_m = 0.5 * (chord_m * stagger.tan().abs() + thickness_m / stagger.cos());
        let half_pitch = std::f64::consts::PI / self.sectors as f64;
        radius_m * (half_pitch - reach_m / radius_m).tan()
    }

    fn check_order(&self) -> Result<(), ModelError> {
        let limit = self.rim_inner_radius_m();
        let accepted = Accepted::BelowM("rim_radius_m - rim_thickness_m", limit);
        accept(
            "bore_radius_m",
            self.bore_radius_m,
            self.bore_radius_m < limit,
            accepted,
        )?;
        for (key, value, what, limit) in [
            (
                "flange_thickness_m",
                self.flange_thickness_m,
                "rim_thickness_m",
                self.rim_thickness_m,
            ),
            (
                "ring_axial_width_m",
                self.ring_axial_width_m,
                "flange_length_m",
                self.flange_length_m,
            ),
            (
                "disk_thickness_m",
                self.disk_thickness_m,
                "rim_axial_width_m",
                self.rim_axial_width_m,
            ),
            (
                "blade_root_axial_chord_m",
                self.blade_root_axial_chord_m,
                "rim_axial_width_m",
                self.rim_axial_width_m,
            ),
        ] {
            accept(key, value, value <= limit, Accepted::AtMostM(what, limit))?;
        }
        let limit = self.flange_inner_radius_m();
        let accepted = Accepted::BelowM("the inner radius of the flange", limit);
        accept(
            "ring_thickness_m",
            self.ring_thickness_m,
            self.ring_thickness_m < limit,
            accepted,
        )?;
        // The root must leave room for the passage: its angle stays below the pitch.
        let pitch = std::f64::consts::TAU / self.sectors as f64;
        let thickness = self.blade_root_thickness_m;
        let limit = thickness * pitch / (2.0 * self.blade_half_angle_rad());
        let accepted = Accepted::BelowM("the pitch of the roots normal to the chord", limit);
        accept(
            "blade_root_thickness_m",
            thickness,
            thickness < limit,
            accepted,
        )
    }
}

pub(super) fn accept(
    key: &str,
    value: f64,
    valid: bool,
    accepted: Accepted,
) -> Result<(), ModelError> {
    if valid {
        return Ok(());
    }
    Err(ModelError::Option {
        key: format!("model.parametric.{key}"),
        value,
        accepted,
    })
}

fn count(key: &str, value: usize, (low, high): (usize, usize)) -> Result<(), ModelError> {
    let valid = (low..=high).contains(&value);
    accept(key, value as f64, valid, Accepted::Count(low, high))
}
