//! What the keys of the built-in models accept and mean; their fields are those of the options of the models.

use super::ranges::ABOVE_ZERO;
use crate::input::Value::{Flag, List, Name, Number, Tables, Text, Whole};
use crate::input::{Entry, REQUIRED, Range, Value, entry};

const ENDS: Value = List(&Text("name of a mass, `next.NAME`, or `ground`"));
const AT_LEAST_ZERO: Value = Number(Range::at_least(0.0));

pub(super) const LUMPED_KEYS: &[Entry] = &[
    entry(
        "sectors",
        Whole(1, 10_000),
        "required, checked with the model",
        "number of sectors N",
    ),
    entry(
        "blade_mass_kg",
        ABOVE_ZERO,
        "required without `mass`, checked with the model",
        "blade, kg",
    ),
    entry("disk_mass_kg", AT_LEAST_ZERO, "0", "disk, per sector, kg"),
    entry(
        "ring_mass_kg",
        AT_LEAST_ZERO,
        "0",
        "ring, per sector, needs a disk, kg",
    ),
    entry(
        "blade_stiffness_n_per_m",
        ABOVE_ZERO,
        "required without `mass`, checked with the model",
        "blade to disk, or to ground without a disk; this spring is mistuned, N/m",
    ),
    entry(
        "blade_coupling_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "blade to next blade, N/m",
    ),
    entry(
        "disk_ground_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "disk to ground, N/m",
    ),
    entry(
        "disk_coupling_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "disk to next disk, N/m",
    ),
    entry(
        "ring_ground_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "ring to ground, N/m",
    ),
    entry(
        "ring_coupling_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "ring to next ring, N/m",
    ),
    entry(
        "ring_disk_stiffness_n_per_m",
        AT_LEAST_ZERO,
        "0",
        "locates the ring on the disk; not the contact stiffness, N/m",
    ),
    entry(
        "mass",
        Tables,
        "none",
        "masses with names, in the place of blade, disk and ring",
    )
    .with(MASS_KEYS),
    entry("spring", Tables, "none", "springs between named masses").with(SPRING_KEYS),
    entry("contact", Tables, "none", "contacts between named masses").with(CONTACT_KEYS),
    entry(
        "force",
        Text("name of a mass"),
        "required with `mass`",
        "the mass on which 1 N acts",
    ),
    entry(
        "observe",
        List(&Text("name of a mass")),
        "that of `force`",
        "observed masses; the first has the amplitude",
    ),
];

const MASS_KEYS: &[Entry] = &[
    entry(
        "name",
        Text("letters, digits, `-`, `_`, and not `ground`"),
        REQUIRED,
        "names the mass; each has another",
    ),
    entry("mass_kg", ABOVE_ZERO, REQUIRED, "kg"),
    entry(
        "body",
        Name(&["blisk", "ring", "damper"]),
        "`\"blisk\"`",
        "the body that it belongs to; `damper`: one for each sector, held by contact",
    ),
];

const SPRING_KEYS: &[Entry] = &[
    entry(
        "between",
        ENDS,
        REQUIRED,
        "its two ends; one of them is a mass of the sector",
    ),
    entry("stiffness_n_per_m", ABOVE_ZERO, REQUIRED, "N/m"),
    entry(
        "mistuned",
        Flag,
        "`false`",
        "whether the deviation of the blade changes it; at least one is, and none to the next sector",
    ),
];

const CONTACT_KEYS: &[Entry] = &[
    entry(
        "between",
        ENDS,
        REQUIRED,
        "its two ends, as of a spring; friction acts on their relative motion",
    ),
    entry(
        "weight",
        ABOVE_ZERO,
        "1.0",
        "share of the sector's contact stiffness and normal load, relative to the other contacts",
    ),
];

pub(super) const PARAMETRIC_KEYS: &[Entry] = &[
    entry("sectors", Whole(3, 1000), "24", "number of sectors N"),
    entry(
        "damper",
        Name(&["ring", "underplatform", "shroud", "blade_to_ground"]),
        "`\"ring\"`",
        "what damps: a ring under the flange; a wedge or cylinder between the platforms of neighbouring blades; shrouds that touch; the platform on the ground. All but `ring` go without flange and ring",
    ),
    entry(
        "damper_shape",
        Name(&["wedge", "cylinder"]),
        "`\"wedge\"`",
        "the damper of `underplatform`: a wedge that fills the gap between the flanks, or a cylinder that touches each flank on a line in its middle",
    ),
    entry(
        "damper_body",
        Name(&["elastic", "rigid"]),
        "`\"elastic\"`",
        "the damper of `underplatform`: solid elements, or a rigid body with six degrees of freedom",
    ),
    entry(
        "bore_radius_m",
        ABOVE_ZERO,
        "0.06",
        "clamped; below the inner radius of the rim, m",
    ),
    entry(
        "rim_radius_m",
        ABOVE_ZERO,
        "0.205",
        "outer radius of the rim, m",
    ),
    entry("rim_thickness_m", ABOVE_ZERO, "0.010", "radial, m"),
    entry("rim_axial_width_m", ABOVE_ZERO, "0.040", "m"),
    entry(
        "disk_thickness_m",
        ABOVE_ZERO,
        "0.006",
        "axial thickness of the web; at most the rim's width, m",
    ),
    entry(
        "flange_length_m",
        ABOVE_ZERO,
        "0.014",
        "axial, beyond the rim, m",
    ),
    entry(
        "flange_thickness_m",
        ABOVE_ZERO,
        "0.010",
        "radial; at most the rim's thickness, m",
    ),
    entry(
        "ring_axial_width_m",
        ABOVE_ZERO,
        "0.014",
        "at most the flange's length, m",
    ),
    entry(
        "ring_thickness_m",
        ABOVE_ZERO,
        "0.005",
        "radial; below the flange's inner radius, m",
    ),
    entry("blade_height_m", ABOVE_ZERO, "0.080", "above the rim, m"),
    entry(
        "blade_root_axial_chord_m",
        ABOVE_ZERO,
        "0.040",
        "at most the rim's width, m",
    ),
    entry("blade_tip_axial_chord_m", ABOVE_ZERO, "0.032", "m"),
    entry(
        "blade_root_thickness_m",
        ABOVE_ZERO,
        "0.0055",
        "normal to the chord; must leave room for the passage, m",
    ),
    entry(
        "blade_tip_thickness_m",
        ABOVE_ZERO,
        "0.003",
        "normal to the chord, m",
    ),
    entry(
        "blade_stagger_angle_deg",
        Number(Range::at_least(-65.0).below(65.0)),
        "30.0",
        "axis to chord at the root, from +z towards +theta, deg",
    ),
    entry(
        "blade_twist_deg",
        Number(Range::above(-130.0).below(130.0)),
        "20.0",
        "stagger of the tip less that of the root; the tip's stagger within the limits of the root's, deg",
    ),
    entry(
        "platform_height_m",
        ABOVE_ZERO,
        "0.006",
        "underside of the platform above the rim (`underplatform`, `blade_to_ground`), m",
    ),
    entry(
        "platform_thickness_m",
        ABOVE_ZERO,
        "0.006",
        "radial, of the platform and of a wedge, m",
    ),
    entry(
        "platform_gap_m",
        ABOVE_ZERO,
        "0.003",
        "between two platforms at their outer side, m",
    ),
    entry(
        "flank_angle_deg",
        Number(Range::at_least(5.0).below(65.0)),
        "35.0",
        "between the flank of the platform and the radius, deg",
    ),
    entry(
        "shroud_height_share",
        Number(Range::above(0.0).up_to(1.0)),
        "1.0",
        "outer side of the shroud above the rim, as a share of the blade's height (`shroud`)",
    ),
    entry("shroud_thickness_m", ABOVE_ZERO, "0.004", "radial, m"),
    entry(
        "shroud_angle_deg",
        Number(Range::at_least(-65.0).below(65.0)),
        "30.0",
        "between the contact face of the shroud and the axis, deg",
    ),
    entry(
        "blisk_youngs_modulus_pa",
        ABOVE_ZERO,
        "2.1e11",
        "disk and blade, Pa",
    ),
    entry(
        "blisk_poisson_ratio",
        Number(Range::at_least(0.0).below(0.5)),
        "0.3",
        "",
    ),
    entry("blisk_density_kg_per_m3", ABOVE_ZERO, "7850.0", "kg/m3"),
    entry("ring_youngs_modulus_pa", ABOVE_ZERO, "2.1e11", "Pa"),
    entry(
        "ring_poisson_ratio",
        Number(Range::at_least(0.0).below(0.5)),
        "0.3",
        "",
    ),
    entry("ring_density_kg_per_m3", ABOVE_ZERO, "7850.0", "kg/m3"),
    entry(
        "ring_grounding_frequency_hz",
        AT_LEAST_ZERO,
        "5.0",
        "weak grounding `(2 pi f)^2 M` of ring or damper body, which only contact holds otherwise, Hz",
    ),
    entry(
        "disk_radial_elements",
        Whole(1, 64),
        "3",
        "along the radius of the web",
    ),
    entry("disk_axial_elements", Whole(1, 64), "1", "through the web"),
    entry(
        "rim_axial_elements",
        Whole(1, 64),
        "1",
        "of rim and root, on each side of the web",
    ),
    entry(
        "flange_axial_elements",
        Whole(1, 64),
        "1",
        "along the flange over the ring",
    ),
    entry(
        "passage_elements",
        Whole(1, 64),
        "1",
        "between blade and each cyclic face",
    ),
    entry("blade_thickness_elements", Whole(1, 64), "1", ""),
    entry(
        "blade_radial_elements",
        Whole(1, 64),
        "5",
        "along the height",
    ),
    entry("ring_radial_elements", Whole(1, 64), "1", ""),
];
