//! The keys of the models of a study file.

use super::Value::{Name, Number, Table, Text, Whole};
use super::{Range, Value};
use crate::input::{Entry, REQUIRED, entry};

const ABOVE_ZERO: Value = Number(Range::above(0.0));
const AT_LEAST_ZERO: Value = Number(Range::at_least(0.0));

/// The table `[model]` and those below it.
pub(super) const MODEL_KEYS: &[Entry] = &[
    entry("model", Table, REQUIRED, "where the sector comes from"),
    entry(
        "model.source",
        Name(&["parametric", "lumped", "bundle"]),
        REQUIRED,
        "only the table of that source may be present",
    ),
    entry(
        "model.bundle",
        Table,
        "",
        "a sector bundle ([sector-bundle.md](sector-bundle.md))",
    ),
    entry(
        "model.bundle.path",
        Text("a folder"),
        REQUIRED,
        "folder of a sector bundle, relative to the study file",
    ),
    entry("model.lumped", Table, "", "masses and springs"),
    entry(
        "model.lumped.sectors",
        Whole(1, 10_000),
        "required, checked with the model",
        "number of sectors N",
    ),
    entry(
        "model.lumped.blade_mass_kg",
        ABOVE_ZERO,
        "required, checked with the model",
        "blade, kg",
    ),
    entry(
        "model.lumped.disk_mass_kg",
        AT_LEAST_ZERO,
        "0",
        "disk, per sector, kg",
    ),
    entry(
        "model.lumped.ring_mass_kg",
        AT_LEAST_ZERO,
        "0",
        "ring, per sector, needs a disk, kg",
    ),
    entry(
        "model.lumped.blade_stiffness_n_per_m",
        ABOVE_ZERO,
        "required, checked with the model",
        "blade to disk, or to ground without a disk; this spring is mistuned, N/m",
    ),
    entry(
        "model.lumped.blade_coupling_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "blade to next blade, N/m",
    ),
    entry(
        "model.lumped.disk_ground_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "disk to ground, N/m",
    ),
    entry(
        "model.lumped.disk_coupling_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "disk to next disk, N/m",
    ),
    entry(
        "model.lumped.ring_ground_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "ring to ground, N/m",
    ),
    entry(
        "model.lumped.ring_coupling_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "ring to next ring, N/m",
    ),
    entry(
        "model.lumped.ring_disk_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "locates the ring on the disk; not the contact stiffness, N/m",
    ),
    entry("model.parametric", Table, "", "the built-in bladed disk"),
    entry(
        "model.parametric.sectors",
        Whole(3, 1000),
        "24",
        "number of sectors N",
    ),
    entry(
        "model.parametric.bore_radius_m",
        ABOVE_ZERO,
        "0.06",
        "clamped; below the inner radius of the rim, m",
    ),
    entry(
        "model.parametric.rim_radius_m",
        ABOVE_ZERO,
        "0.205",
        "outer radius of the rim, m",
    ),
    entry(
        "model.parametric.rim_thickness_m",
        ABOVE_ZERO,
        "0.010",
        "radial, m",
    ),
    entry(
        "model.parametric.rim_axial_width_m",
        ABOVE_ZERO,
        "0.040",
        "m",
    ),
    entry(
        "model.parametric.disk_thickness_m",
        ABOVE_ZERO,
        "0.006",
        "axial thickness of the web; at most the rim's width, m",
    ),
    entry(
        "model.parametric.flange_length_m",
        ABOVE_ZERO,
        "0.014",
        "axial, beyond the rim, m",
    ),
    entry(
        "model.parametric.flange_thickness_m",
        ABOVE_ZERO,
        "0.010",
        "radial; at most the rim's thickness, m",
    ),
    entry(
        "model.parametric.ring_axial_width_m",
        ABOVE_ZERO,
        "0.014",
        "at most the flange's length, m",
    ),
    entry(
        "model.parametric.ring_thickness_m",
        ABOVE_ZERO,
        "0.005",
        "radial; below the flange's inner radius, m",
    ),
    entry(
        "model.parametric.blade_height_m",
        ABOVE_ZERO,
        "0.080",
        "above the rim, m",
    ),
    entry(
        "model.parametric.blade_root_axial_chord_m",
        ABOVE_ZERO,
        "0.040",
        "at most the rim's width, m",
    ),
    entry(
        "model.parametric.blade_tip_axial_chord_m",
        ABOVE_ZERO,
        "0.032",
        "m",
    ),
    entry(
        "model.parametric.blade_root_thickness_m",
        ABOVE_ZERO,
        "0.0055",
        "normal to the chord; must leave room for the passage, m",
    ),
    entry(
        "model.parametric.blade_tip_thickness_m",
        ABOVE_ZERO,
        "0.003",
        "normal to the chord, m",
    ),
    entry(
        "model.parametric.blade_stagger_angle_deg",
        Number(Range::at_least(-65.0).below(65.0)),
        "30.0",
        "axis to chord at the root, from +z towards +theta, deg",
    ),
    entry(
        "model.parametric.blade_twist_deg",
        Number(Range::above(-130.0).below(130.0)),
        "20.0",
        "stagger of the tip less that of the root; the tip's stagger within the limits of the root's, deg",
    ),
    entry(
        "model.parametric.blisk_youngs_modulus_pa",
        ABOVE_ZERO,
        "2.1e11",
        "disk and blade, Pa",
    ),
    entry(
        "model.parametric.blisk_poisson_ratio",
        Number(Range::at_least(0.0).below(0.5)),
        "0.3",
        "",
    ),
    entry(
        "model.parametric.blisk_density_kg_per_m3",
        ABOVE_ZERO,
        "7850.0",
        "kg/m3",
    ),
    entry(
        "model.parametric.ring_youngs_modulus_pa",
        ABOVE_ZERO,
        "2.1e11",
        "Pa",
    ),
    entry(
        "model.parametric.ring_poisson_ratio",
        Number(Range::at_least(0.0).below(0.5)),
        "0.3",
        "",
    ),
    entry(
        "model.parametric.ring_density_kg_per_m3",
        ABOVE_ZERO,
        "7850.0",
        "kg/m3",
    ),
    entry(
        "model.parametric.ring_grounding_frequency_hz",
        AT_LEAST_ZERO,
        "5.0",
        "weak grounding `(2 pi f)^2 M` of the ring, which only contact holds otherwise, Hz",
    ),
    entry(
        "model.parametric.disk_radial_elements",
        Whole(1, 64),
        "3",
        "along the radius of the web",
    ),
    entry(
        "model.parametric.disk_axial_elements",
        Whole(1, 64),
        "1",
        "through the web",
    ),
    entry(
        "model.parametric.rim_axial_elements",
        Whole(1, 64),
        "1",
        "of rim and root, on each side of the web",
    ),
    entry(
        "model.parametric.flange_axial_elements",
        Whole(1, 64),
        "1",
        "along the flange over the ring",
    ),
    entry(
        "model.parametric.passage_elements",
        Whole(1, 64),
        "1",
        "between blade and each cyclic face",
    ),
    entry(
        "model.parametric.blade_thickness_elements",
        Whole(1, 64),
        "1",
        "",
    ),
    entry(
        "model.parametric.blade_radial_elements",
        Whole(1, 64),
        "5",
        "along the height",
    ),
    entry(
        "model.parametric.ring_radial_elements",
        Whole(1, 64),
        "1",
        "",
    ),
];
