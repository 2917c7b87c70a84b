//! Structured mesh of the built-in bladed disk and its damper: a lattice in (theta, z, r) and the map to space.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::assembly::{SolidElement, SolidMesh};
use super::hexahedron20::NATURAL_COORDINATES;
use super::parametric_axis::Axis;
use super::parametric_cylinder::Cylinder;
use super::parametric_options::{Damper, ParametricOptions};
use super::parametric_shelf::Shelf;
use super::sector_model::{Body, ContactPair, ContactSide};

/// Lattice point in half elements: (theta, z, r); even in all three = corner of elements.
type Point = [usize; 3];

/// The mesh and where to find its faces, contact and tip.
pub(super) struct ParametricMesh<'a> {
    options: &'a ParametricOptions,
    /// Angle before the shear that follows the stagger, rad.
    theta: Axis,
    z: Axis,
    /// Radii of disk, rim and blade.
    r: Axis,
    /// Radii of the ring.
    ring_r: Axis,
    /// The platform or shroud of the blade, where the damper needs one.
    shelf: Option<Shelf>,
    /// The body between two platforms, where it is a cylinder.
    cylinder: Option<Cylinder>,
    nodes: BTreeMap<(Body, Point), usize>,
    pub(super) mesh: SolidMesh,
}

/// Half elements across a wedge between two platforms.
const ACROSS_WEDGE: usize = 4;

impl<'a> ParametricMesh<'a> {
    /// Lays out the mesh; the options have been checked.
    pub(super) fn new(options: &'a ParametricOptions) -> Self {
        let (half_pitch, half_blade) = (
            0.5 * TAU / options.sectors as f64,
            options.blade_half_angle_rad(),
        );
        let theta = Axis::new(
            &[-half_pitch, -half_blade, half_blade, half_pitch],
            |angle| {
                if angle.abs() < half_blade {
                    options.blade_thickness_elements
                } else {
                    options.passage_elements
                }
            },
        );
        let (half_rim, half_disk) = (
            0.5 * options.rim_axial_width_m,
            0.5 * options.disk_thickness_m,
        );
        let half_chord = 0.5 * options.blade_root_axial_chord_m;
        let flange_end = half_rim + options.flange_length_m;
        let ring_start = flange_end - options.ring_axial_width_m;
        let mut levels = [
            -half_rim,
            -half_chord,
            -half_disk,
            half_disk,
            half_chord,
            half_rim,
            ring_start,
            flange_end,
        ];
        levels.sort_by(f64::total_cmp);
        let z = Axis::new(&levels, |z| {
            if z.abs() < half_disk {
                options.disk_axial_elements
            } else if z.abs() < half_rim {
                options.rim_axial_elements
            } else {
                options.flange_axial_elements
            }
        });
        let rim = options.rim_radius_m;
        let shelf = Shelf::of(options);
        let cylinder = Cylinder::of(options);
        let mut levels = vec![
            options.bore_radius_m,
            options.rim_inner_radius_m(),
            options.flange_inner_radius_m(),
            rim,
        ];
        levels.extend(shelf.iter().flat_map(Shelf::levels_m));
        levels.push(rim + options.blade_height_m);
        let r = Axis::new(&levels, |radius| {
            if radius < options.rim_inner_radius_m() {
                options.disk_radial_elements
            } else if radius < rim {
                1
            } else {
                let all = options.blade_radial_elements;
                shelf
                    .as_ref()
                    .map_or(all, |shelf| shelf.elements(radius, all))
            }
        });
        let ring_outer = options.flange_inner_radius_m();
        let ring_r = Axis::new(&[ring_outer - options.ring_thickness_m, ring_outer], |_| {
            options.ring_radial_elements
        });
        let mesh = SolidMesh {
            materials: options.materials().to_vec(),
            ..SolidMesh::default()
        };
        let mut built = Self {
            options,
            theta,
            z,
            r,
            ring_r,
            shelf,
            cylinder,
            nodes: BTreeMap::new(),
            mesh,
        };
        built.add_elements();
        built.clamp_bore();
        built
    }

    fn add_elements(&mut self) {
        for k in 0..self.r.elements() {
            for j in 0..self.z.elements() {
                for i in 0..self.theta.elements() {
                    let (theta, z, r) = (self.theta.middle(i), self.z.middle(j), self.r.middle(k));
                    let blade = r > self.options.rim_radius_m;
                    if self.in_blisk(theta, z, r) {
                        self.add_element([i, j, k], Body::Blisk, blade);
                    }
                }
            }
        }
        match self.options.damper {
            Damper::Ring => self.add_ring(),
            Damper::Underplatform => self.add_damper(),
            Damper::Shroud | Damper::BladeToGround => {}
        }
    }

    fn add_ring(&mut self) {
        let flange_end = 0.5 * self.options.rim_axial_width_m + self.options.flange_length_m;
        for k in 0..self.ring_r.elements() {
            for j in 0..self.z.elements() {
                if self.z.middle(j) < flange_end - self.options.ring_axial_width_m {
                    continue;
                }
                for i in 0..self.theta.elements() {
                    self.add_element([i, j, k], Body::Ring, false);
                }
            }
        }
    }

    /// The body between the platform of the blade and that of the next one: their lattice in z, and that of a wedge in r.
    fn add_damper(&mut self) {
        let Some(radii_m) = self.shelf.as_ref().map(|shelf| shelf.radii_m) else {
            return;
        };
        let half_chord = 0.5 * self.options.blade_root_axial_chord_m;
        let beside: Vec<usize> = (0..self.z.elements())
            .filter(|&j| self.z.middle(j).abs() < half_chord)
            .collect();
        if self.cylinder.is_some() {
            for [i, k] in Cylinder::cells() {
                for &j in &beside {
                    self.add_element([i, j, k], Body::Damper, false);
                }
            }
            return;
        }
        for k in 0..self.r.elements() {
            let r = self.r.middle(k);
            if r < radii_m[0] || radii_m[1] < r {
                continue;
            }
            for &j in &beside {
                for i in 0..ACROSS_WEDGE / 2 {
                    self.add_element([i, j, k], Body::Damper, false);
                }
            }
        }
    }

    /// Whether the middle of an element lies in disk, rim, flange or blade.
    fn in_blisk(&self, theta: f64, z: f64, r: f64) -> bool {
        let o = self.options;
        let half_rim = 0.5 * o.rim_axial_width_m;
        if r > o.rim_radius_m {
            let shelf = self.shelf.as_ref();
            let in_shelf = shelf.is_some_and(|shelf| shelf.holds(r));
            let in_width = theta.abs() < o.blade_half_angle_rad() || in_shelf;
            in_width && z.abs() < 0.5 * o.blade_root_axial_chord_m
        } else if r > o.rim_inner_radius_m() {
            let has_flange = o.damper == Damper::Ring;
            z.abs() < half_rim || (has_flange && z > half_rim && r > o.flange_inner_radius_m())
        } else {
            z.abs() < 0.5 * o.disk_thickness_m
        }
    }

    /// Adds the element `cell`; natural axes are r, theta, z, a right-handed order.
    fn add_element(&mut self, cell: [usize; 3], body: Body, blade: bool) {
        let nodes = NATURAL_COORDINATES.map(|[radial, tangential, axial]| {
            let natural = [tangential, axial, radial];
            let mut point = [0; 3];
            for axis in 0..3 {
                point[axis] = 2 * cell[axis] + (natural[axis] + 1.0) as usize;
            }
            self.node(body, point)
        });
        let material = usize::from(body != Body::Blisk);
        self.mesh.elements.push(SolidElement {
            nodes,
            material,
            body,
            blade,
        });
    }

    /// Node at a lattice point of a body, made when first asked for.
    fn node(&mut self, body: Body, mut point: Point) -> usize {
        if body == Body::Damper && self.cylinder.is_some() {
            point = Cylinder::own_point(point);
        }
        let position = self.position(body, point);
        let next = self.mesh.nodes_m.len();
        let node = *self.nodes.entry((body, point)).or_insert(next);
        if node == next {
            self.mesh.nodes_m.push(position);
        }
        node
    }

    /// Cartesian position of a lattice point, m.
    ///
    /// Up to the rim: `theta + z tan(stagger) / r_rim`, held beyond the root's chord, so that the rim's
    /// lattice carries the staggered root. Blade at height share `s`, chordwise `v` and thicknesswise
    /// `u` in [-1, 1]: `z = v a(s) / 2`, `theta = (z tan(stagger(s)) + u t(s) / (2 cos(stagger(s)))) / r`:
    /// sections lie on cylinders, and both edges are cut normal to the axis. A shelf goes straight from the blade's
    /// surface to its own edge, and a damper body from one edge to that of the next blade.
    fn position(&self, body: Body, [i, j, k]: Point) -> [f64; 3] {
        let o = self.options;
        if body == Body::Damper {
            return self.damper_position([i, j, k]);
        }
        let (theta, z) = (self.theta.0[i], self.z.0[j]);
        let r = if body == Body::Ring {
            self.ring_r.0[k]
        } else {
            self.r.0[k]
        };
        let half_chord = 0.5 * o.blade_root_axial_chord_m;
        let (angle, z) = if body == Body::Blisk && k > self.rim_index() {
            let s = (r - o.rim_radius_m) / o.blade_height_m;
            let stagger = (o.blade_stagger_angle_deg + s * o.blade_twist_deg).to_radians();
            let chord = self.axial_chord_m(r);
            let thickness =
                o.blade_root_thickness_m + s * (o.blade_tip_thickness_m - o.blade_root_thickness_m);
            let (u, v) = (theta / o.blade_half_angle_rad(), z / half_chord);
            let z = 0.5 * v * chord;
            if let Some(shelf) = self.shelf.as_ref().filter(|_| u.abs() > 1.0) {
                let side = u.signum();
                let surface = (z * stagger.tan() + 0.5 * side * thickness / stagger.cos()) / r;
                let surface = [r * surface.cos(), r * surface.sin(), z];
                let (half_blade, half_pitch) = (o.blade_half_angle_rad(), self.half_pitch());
                let share = (theta.abs() - half_blade) / (half_pitch - half_blade);
                return between(surface, shelf.edge(side, r, z), share);
            }
            (
                (z * stagger.tan() + 0.5 * u * thickness / stagger.cos()) / r,
                z,
            )
        } else {
            let shear = o.blade_stagger_angle_deg.to_radians().tan() / o.rim_radius_m;
            (theta + shear * z.clamp(-half_chord, half_chord), z)
        };
        [r * angle.cos(), r * angle.sin(), z]
    }

    /// Position of a lattice point of a damper body, m: the edges of a wedge are those of the platforms on both sides.
    fn damper_position(&self, [i, j, k]: Point) -> [f64; 3] {
        let Some(shelf) = &self.shelf else {
            return [0.0; 3];
        };
        let z_m =
            |r: f64| self.z.0[j] * self.axial_chord_m(r) / self.options.blade_root_axial_chord_m;
        if let Some(cylinder) = &self.cylinder {
            let [x, y] = cylinder.section_m([i, k]);
            let (sin, cos) = self.half_pitch().sin_cos();
            return [x * cos - y * sin, x * sin + y * cos, z_m(cylinder.touch_m)];
        }
        let r = self.r.0[k];
        let z = z_m(r);
        let (sin, cos) = (2.0 * self.half_pitch()).sin_cos();
        let [x, y, _] = shelf.edge(-1.0, r, z);
        let next = [x * cos - y * sin, x * sin + y * cos, z];
        between(shelf.edge(1.0, r, z), next, i as f64 / ACROSS_WEDGE as f64)
    }

    /// Axial chord of the blade at a radius, m.
    fn axial_chord_m(&self, radius_m: f64) -> f64 {
        let o = self.options;
        let share = (radius_m - o.rim_radius_m) / o.blade_height_m;
        o.blade_root_axial_chord_m
            + share * (o.blade_tip_axial_chord_m - o.blade_root_axial_chord_m)
    }

    fn half_pitch(&self) -> f64 {
        0.5 * TAU / self.options.sectors as f64
    }

    fn rim_index(&self) -> usize {
        self.r.index_of(self.options.rim_radius_m)
    }

    fn clamp_bore(&mut self) {
        self.mesh.clamped_nodes = self
            .nodes
            .iter()
            .filter(|((body, point), _)| *body == Body::Blisk && point[2] == 0)
            .map(|(_, &node)| node)
            .collect();
    }

    /// Nodes `(low, high)` of the cyclic faces, clamped ones among them; edges of a shelf are free.
    pub(super) fn face_nodes(&self) -> Vec<(usize, usize)> {
        let (last, rim) = (self.theta.0.len() - 1, self.rim_index());
        let on_face = |body: Body, point: &Point| match body {
            Body::Blisk => point[0] == 0 && point[2] <= rim,
            Body::Ring => point[0] == 0,
            Body::Damper => false,
        };
        self.nodes
            .iter()
            .filter(|((body, point), _)| on_face(*body, point))
            .filter_map(|(&(body, [_, j, k]), &low)| {
                self.nodes
                    .get(&(body, [last, j, k]))
                    .map(|&high| (low, high))
            })
            .collect()
    }

    /// Contact pairs of the damper. Their weights are shares of the contact surface.
    pub(super) fn contact_pairs(&self) -> Vec<ContactPair> {
        let mut pairs = match self.options.damper {
            Damper::Ring => self.ring_pairs(),
            Damper::Underplatform | Damper::Shroud | Damper::BladeToGround => self.shelf_pairs(),
        };
        let whole: f64 = pairs.iter().map(|pair| pair.weight).sum();
        for pair in &mut pairs {
            pair.weight /= whole;
        }
        pairs
    }

    /// Facing corner nodes of flange and ring on the lines that lie on neither cyclic face. The flange's inner surface
    /// faces the axis.
    ///
    /// Weight = tributary area of the node on the contact surface: half of each neighbouring element in theta and z (the
    /// lumping of bilinear faces, always positive, where consistent quadratic corner weights are negative). The outer
    /// halves at the cyclic faces fall to the nearest line.
    fn ring_pairs(&self) -> Vec<ContactPair> {
        let o = self.options;
        let flange_end = 0.5 * o.rim_axial_width_m + o.flange_length_m;
        let first_z = self.z.index_of(flange_end - o.ring_axial_width_m);
        let flange_r = self.r.index_of(o.flange_inner_radius_m());
        let ring_r = self.ring_r.0.len() - 1;
        let (last_theta, last_z) = (self.theta.0.len() - 1, self.z.0.len() - 1);
        let mut facing = Vec::new();
        for i in (2..last_theta).step_by(2) {
            let low = if i == 2 {
                self.theta.0[0]
            } else {
                self.theta.0[i - 1]
            };
            let high = if i + 2 == last_theta {
                self.theta.0[last_theta]
            } else {
                self.theta.0[i + 1]
            };
            for j in (first_z..=last_z).step_by(2) {
                let below = self.z.0[j.max(first_z + 1) - 1];
                let above = self.z.0[(j + 1).min(last_z)];
                let nodes = (
                    self.nodes.get(&(Body::Blisk, [i, j, flange_r])),
                    self.nodes.get(&(Body::Ring, [i, j, ring_r])),
                );
                if let (Some(&blisk_node), Some(&ring_node)) = nodes {
                    facing.push(ContactPair {
                        first: ContactSide::Node(blisk_node),
                        second: ContactSide::Node(ring_node),
                        normal: [-1.0, 0.0, 0.0],
                        weight: (high - low) * (above - below),
                        load_weight: None,
                    });
                }
            }
        }
        facing
    }

    /// The four corners of each edge of the shelf, a quarter of its face each, with what they touch: the damper body, the
    /// shelf of the next blade, or the ground. A cylinder touches the two ends of a line.
    fn shelf_pairs(&self) -> Vec<ContactPair> {
        let Some(shelf) = &self.shelf else {
            return Vec::new();
        };
        let o = self.options;
        let ends_z = [-0.5, 0.5].map(|side| self.z.index_of(side * o.blade_root_axial_chord_m));
        let touched_m = match &self.cylinder {
            Some(cylinder) => vec![cylinder.touch_m],
            // On the ground stands the underside alone.
            None if o.damper == Damper::BladeToGround => vec![shelf.radii_m[0]],
            None => shelf.radii_m.to_vec(),
        };
        let last = self.theta.0.len() - 1;
        let node = |body: Body, point: Point| self.nodes[&(body, point)];
        let mut pairs = Vec::new();
        for k in touched_m.into_iter().map(|radius| self.r.index_of(radius)) {
            for j in ends_z {
                let [low, high] = [0, last].map(|i| node(Body::Blisk, [i, j, k]));
                let r = self.r.0[k];
                let mut add = |first, second, side: f64| {
                    pairs.push(ContactPair {
                        first,
                        second,
                        normal: shelf.normal(side, r),
                        weight: 1.0,
                        load_weight: None,
                    });
                };
                match o.damper {
                    Damper::Ring => {}
                    Damper::Underplatform => {
                        let body = match self.cylinder {
                            Some(_) => Cylinder::TOUCHING.map(|[i, k]| [i, j, k]),
                            None => [0, ACROSS_WEDGE].map(|i| [i, j, k]),
                        };
                        let body = body.map(|point| node(Body::Damper, point));
                        add(ContactSide::Node(high), ContactSide::Node(body[0]), 1.0);
                        add(
                            ContactSide::NextSector(low),
                            ContactSide::Node(body[1]),
                            -1.0,
                        );
                    }
                    Damper::Shroud => {
                        add(ContactSide::Node(high), ContactSide::NextSector(low), 1.0);
                    }
                    Damper::BladeToGround => {
                        add(ContactSide::Node(high), ContactSide::Ground, 1.0);
                        add(ContactSide::Node(low), ContactSide::Ground, -1.0);
                    }
                }
            }
        }
        pairs
    }

    /// Nodes at mid-thickness of the blade's tip: leading edge (least z), trailing edge.
    pub(super) fn tip_nodes(&self) -> Option<(usize, usize)> {
        let half_chord = 0.5 * self.options.blade_root_axial_chord_m;
        let (i, k) = (self.theta.index_of(0.0), self.r.0.len() - 1);
        let edge = |z: f64| {
            self.nodes
                .get(&(Body::Blisk, [i, self.z.index_of(z), k]))
                .copied()
        };
        Some((edge(-half_chord)?, edge(half_chord)?))
    }
}

/// The point at a share of the way between two points, m.
fn between(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]))
}
