//! The cylinder between two platforms of the built-in bladed disk: its size, where it touches, and the mesh of its section.
//!
//! In the radial plane between two blades, with x along r, a the angle of the flanks, g half of the gap at the outer side
//! of the platforms and h their thickness, it touches either flank in its middle:
//!
//! ```text
//! R cos a = g + h tan(a) / 2,    x_axis = x_middle - R sin a
//! ```
//!
//! The section is a rectangle of 2 x 2 elements with 8 more round it. Its corners lie towards the two points of contact
//! and opposite to them, so that the centre of mass lies on the axis.

use super::error::ModelError;
use super::error_place::Accepted;
use super::parametric_options::{Damper, DamperShape, ParametricOptions, accept};

/// Size of the rectangle inside, as a share of the circle's.
const CORE: f64 = 0.5;
/// Half elements across the section, and from its middle to the edge of the rectangle.
const ACROSS: usize = 8;
const CORE_HALF: usize = 2;

/// A cylinder between two platforms.
#[derive(Debug, Clone)]
pub(super) struct Cylinder {
    radius_m: f64,
    /// Distance of its own axis from that of the wheel, m.
    axis_m: f64,
    /// Radius at which it touches the flanks, along the radial plane between the blades, m.
    pub(super) touch_m: f64,
    /// Angle between flank and radius, rad.
    flank_rad: f64,
}

impl Cylinder {
    /// The two points of contact in the lattice of the section: on the own blade's side, and on the next one's.
    pub(super) const TOUCHING: [[usize; 2]; 2] = [[2, ACROSS], [ACROSS - 2, ACROSS]];

    /// The cylinder of the options; none with another damper.
    pub(super) fn of(options: &ParametricOptions) -> Option<Self> {
        let is_cylinder = options.damper == Damper::Underplatform
            && options.damper_shape == DamperShape::Cylinder;
        is_cylinder.then(|| {
            let flank_rad = options.flank_angle_deg.to_radians();
            let (sin, cos) = flank_rad.sin_cos();
            let half_thickness_m = 0.5 * options.platform_thickness_m;
            let from_plane_m = 0.5 * options.platform_gap_m + half_thickness_m * flank_rad.tan();
            let touch_m = options.rim_radius_m + options.platform_height_m + half_thickness_m;
            let radius_m = from_plane_m / cos;
            Self {
                radius_m,
                axis_m: touch_m - radius_m * sin,
                touch_m,
                flank_rad,
            }
        })
    }

    /// Checks that rim and blades leave room for the cylinder.
    pub(super) fn check(&self, options: &ParametricOptions) -> Result<(), ModelError> {
        let height_m = options.platform_height_m;
        let lowest_m = self.axis_m - self.radius_m;
        let limit_m = height_m - (lowest_m - options.rim_radius_m);
        let accepted = Accepted::AboveM("what keeps the cylinder off the rim", limit_m);
        let is_off = lowest_m > options.rim_radius_m;
        accept("platform_height_m", height_m, is_off, accepted)?;
        let room_m = options.room_m(height_m);
        let is_between = self.radius_m < room_m;
        let thickness_m = options.platform_thickness_m;
        let (tan, cos) = (self.flank_rad.tan(), self.flank_rad.cos());
        let limit_m = 2.0 * room_m * cos - thickness_m * tan;
        if limit_m > 0.0 {
            let accepted = Accepted::BelowM("what blade and cylinder leave of the pitch", limit_m);
            return accept(
                "platform_gap_m",
                options.platform_gap_m,
                is_between,
                accepted,
            );
        }
        let limit_m = 2.0 * room_m * cos / tan;
        let accepted = Accepted::BelowM("what keeps the cylinder off the blades", limit_m);
        accept("platform_thickness_m", thickness_m, is_between, accepted)
    }

    /// Elements of the section: places along theta and along r. The four in the corners of the lattice have no area.
    pub(super) fn cells() -> impl Iterator<Item = [usize; 2]> {
        let all = 0..ACROSS / 2;
        let cells = all
            .clone()
            .flat_map(move |i| all.clone().map(move |k| [i, k]));
        let is_end = |place: usize| place == 0 || place == ACROSS / 2 - 1;
        cells.filter(move |&[i, k]| !(is_end(i) && is_end(k)))
    }

    /// The one name of a lattice point: a line from a corner of the rectangle to the circle is the edge of two elements.
    pub(super) fn own_point([i, j, k]: [usize; 3]) -> [usize; 3] {
        let middle = ACROSS / 2;
        let (across, along) = (i.abs_diff(middle), k.abs_diff(middle));
        if across <= CORE_HALF || along != CORE_HALF {
            return [i, j, k];
        }
        let towards = |is_up: bool, by: usize| if is_up { middle + by } else { middle - by };
        [
            towards(i > middle, CORE_HALF),
            j,
            towards(k > middle, across),
        ]
    }

    /// Position in the section, m: along the radial plane between the blades from the wheel's axis, and normal to it.
    pub(super) fn section_m(&self, [i, k]: [usize; 2]) -> [f64; 2] {
        let middle = (ACROSS / 2) as f64;
        let (across, along) = (i as f64 - middle, k as f64 - middle);
        let [x, y] = self.quarter_m(along.abs(), across.abs());
        [self.axis_m + x.copysign(along), y.copysign(across)]
    }

    /// Position in the quarter towards a point of contact, from the axis of the cylinder, m.
    fn quarter_m(&self, along: f64, across: f64) -> [f64; 2] {
        let (half, quarter_turn) = (CORE_HALF as f64, std::f64::consts::FRAC_PI_2);
        let (sin, cos) = self.flank_rad.sin_cos();
        let inside = |along: f64, across: f64| {
            let size_m = CORE * self.radius_m / half;
            [size_m * sin * along, size_m * cos * across]
        };
        let beyond = (along.max(across) - half) / half;
        if beyond <= 0.0 {
            return inside(along, across);
        }
        // Elements towards r span the angle from the radius to the point of contact, the others what is left of 90 deg.
        let span_rad = if along > half {
            quarter_turn - self.flank_rad
        } else {
            self.flank_rad
        };
        let (share, base) = if along > half {
            (across / half, inside(half, across))
        } else {
            (along / half, inside(along, half))
        };
        let angle = if along > half {
            share * span_rad
        } else {
            quarter_turn - share * span_rad
        };
        let is_between_corners = share > 0.0 && share < 1.0;
        let radius_m = if is_between_corners {
            self.bulge_m(span_rad)
        } else {
            self.radius_m
        };
        let on_circle = [radius_m * angle.cos(), radius_m * angle.sin()];
        [0, 1].map(|axis| base[axis] + beyond * (on_circle[axis] - base[axis]))
    }

    /// Radius of a node between two corners, m: a parabola through it encloses the area of the arc, so that the mass of the
    /// section is that of its circle.
    fn bulge_m(&self, span_rad: f64) -> f64 {
        let half = 0.5 * span_rad;
        let height = 0.375 * (span_rad - span_rad.sin()) / half.sin();
        self.radius_m * (half.cos() + height)
    }
}
