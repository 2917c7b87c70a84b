//! The platform or shroud of the built-in blade: a plate round its section, with edges that meet the damper.

use std::f64::consts::TAU;

use super::parametric_cylinder::Cylinder;
use super::parametric_options::{Damper, ParametricOptions};

/// A plate of the blade between two radii, from edge to edge.
#[derive(Debug, Clone)]
pub(super) struct Shelf {
    damper: Damper,
    /// Inner and outer radius, m.
    pub(super) radii_m: [f64; 2],
    /// Radius at which a cylinder touches it, m.
    touch_m: Option<f64>,
    /// Radii where the blade begins and ends, m.
    blade_m: [f64; 2],
    /// Half of the angle of a sector, rad.
    half_pitch_rad: f64,
    /// Half of the gap between two platforms at their outer radius, m.
    half_gap_m: f64,
    /// Angle of the edge, rad: of a platform from the radius, of a shroud from the axis.
    angle_rad: f64,
}

impl Shelf {
    /// The shelf of the options; none with a ring.
    pub(super) fn of(options: &ParametricOptions) -> Option<Self> {
        let rim = options.rim_radius_m;
        let tip = rim + options.blade_height_m;
        let platform = rim + options.platform_height_m;
        let shroud = rim + options.shroud_height_share * options.blade_height_m;
        let radii_m = match options.damper {
            Damper::Ring => return None,
            Damper::Underplatform | Damper::BladeToGround => {
                [platform, platform + options.platform_thickness_m]
            }
            Damper::Shroud => [shroud - options.shroud_thickness_m, shroud],
        };
        let angle_deg = match options.damper {
            Damper::Shroud => options.shroud_angle_deg,
            Damper::Underplatform => options.flank_angle_deg,
            Damper::Ring | Damper::BladeToGround => 0.0,
        };
        Some(Self {
            damper: options.damper,
            radii_m,
            touch_m: Cylinder::of(options).map(|cylinder| cylinder.touch_m),
            blade_m: [rim, tip],
            half_pitch_rad: 0.5 * TAU / options.sectors as f64,
            half_gap_m: 0.5 * options.platform_gap_m,
            angle_rad: angle_deg.to_radians(),
        })
    }

    /// Radii at which its elements end, ascending, m.
    pub(super) fn levels_m(&self) -> Vec<f64> {
        let [inner, outer] = self.radii_m;
        let ends = [Some(inner), self.touch_m, Some(outer)];
        ends.into_iter().flatten().collect()
    }

    /// Whether a radius lies within it.
    pub(super) fn holds(&self, radius_m: f64) -> bool {
        self.radii_m[0] < radius_m && radius_m < self.radii_m[1]
    }

    /// Elements of the part of the blade round a radius: one between two levels of the shelf, of the others their share of `all`.
    pub(super) fn elements(&self, radius_m: f64, all: usize) -> usize {
        let [inner, outer] = self.radii_m;
        let [root, tip] = self.blade_m;
        let length = if radius_m < inner {
            inner - root
        } else if radius_m < outer {
            return 1;
        } else {
            tip - outer
        };
        let share = length / (tip - root) * all as f64;
        (share.round() as usize).max(1)
    }

    /// Distance of the edge from the radial plane between the blade and its neighbour, m.
    fn distance_m(&self, radius_m: f64) -> f64 {
        match self.damper {
            Damper::Ring | Damper::Shroud => 0.0,
            Damper::Underplatform | Damper::BladeToGround => {
                self.half_gap_m + (self.radii_m[1] - radius_m) * self.angle_rad.tan()
            }
        }
    }

    /// Cartesian position of the edge, m, on the side of +theta (`side` 1) or -theta (-1).
    ///
    /// Flanks of a platform are planes along the axis, at the flank's angle from the radial plane between two blades;
    /// edges of a shroud lie in that plane, turned by the shroud's angle about the radius.
    pub(super) fn edge(&self, side: f64, radius_m: f64, z_m: f64) -> [f64; 3] {
        let (x, y) = (radius_m, -side * self.distance_m(radius_m));
        let turn = side * self.half_pitch_rad + self.shroud_turn(z_m) / radius_m;
        let (sin, cos) = turn.sin_cos();
        [x * cos - y * sin, x * sin + y * cos, z_m]
    }

    /// Unit outward normal of the edge in (r, theta, z) of its own angle; that of a platform on the ground is of its
    /// underside.
    pub(super) fn normal(&self, side: f64, radius_m: f64) -> [f64; 3] {
        let (sin, cos) = self.angle_rad.sin_cos();
        match self.damper {
            Damper::Ring | Damper::BladeToGround => [-1.0, 0.0, 0.0],
            Damper::Shroud => [0.0, side * cos, -side * sin],
            Damper::Underplatform => {
                // From the frame of the radial plane between the blades to that of the point.
                let (sin_own, cos_own) = (-side * self.distance_m(radius_m))
                    .atan2(radius_m)
                    .sin_cos();
                let (r, theta) = (-sin, side * cos);
                [
                    r * cos_own + theta * sin_own,
                    theta * cos_own - r * sin_own,
                    0.0,
                ]
            }
        }
    }

    /// How far the edge of a shroud is shifted along theta at a height z, m.
    fn shroud_turn(&self, z_m: f64) -> f64 {
        match self.damper {
            Damper::Shroud => z_m * self.angle_rad.tan(),
            Damper::Ring | Damper::Underplatform | Damper::BladeToGround => 0.0,
        }
    }
}
