//! Sectors of masses and springs as a study states them: blade, disk and ring by keys of their own, or any masses by name.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::chain::{self, Chain, Contact, End, Mass, Spring};
use super::chain_problem::ChainProblem;
use super::error::ModelError;
use super::error_place::Accepted;
use super::sector_model::{Body, MAX_SECTORS, SectorModel};

/// Masses and springs of one sector; an absent key is 0, and a mass of 0 means no such mass.
///
/// Either the keys of blade, disk and ring, or the tables of masses with names: [`Self::mass`], [`Self::spring`] and
/// [`Self::contact`]. With `x_b, x_d, x_r` the tangential displacements of blade, disk and ring of sector n:
/// blade spring `k_b (x_b - x_d)` (to ground without a disk), blade coupling, disk coupling and ring
/// coupling `k (2 x_n - x_{n-1} - x_{n+1})`, disk and ring to ground, and a spring that locates the
/// ring on the disk. For N = 1 a coupling has no effect; for N = 2 two springs join the sectors.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LumpedOptions {
    /// Number of sectors N, at least 1.
    pub sectors: usize,
    /// Mass of the blade, kg; above 0.
    pub blade_mass_kg: f64,
    /// Mass of the disk's sector, kg.
    pub disk_mass_kg: f64,
    /// Mass of the ring's sector, kg; needs a disk.
    pub ring_mass_kg: f64,
    /// Spring of the blade to the disk, or to ground without one, N/m; above 0. It is `K_blade`.
    pub blade_stiffness_n_per_m: f64,
    /// Spring from blade to next blade, N/m.
    pub blade_coupling_stiffness_n_per_m: f64,
    /// Spring from disk to ground, N/m.
    pub disk_ground_stiffness_n_per_m: f64,
    /// Spring from disk to next disk, N/m.
    pub disk_coupling_stiffness_n_per_m: f64,
    /// Spring from ring to ground, N/m.
    pub ring_ground_stiffness_n_per_m: f64,
    /// Spring from ring to next ring, N/m.
    pub ring_coupling_stiffness_n_per_m: f64,
    /// Spring that locates the ring on the disk, N/m; not the contact stiffness.
    pub ring_disk_stiffness_n_per_m: f64,
    /// Masses with names, in the place of the keys above but `sectors`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub mass: Vec<NamedMass>,
    /// Springs between named masses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spring: Vec<NamedSpring>,
    /// Contacts between named masses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contact: Vec<NamedContact>,
    /// Named mass on which 1 N acts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<String>,
    /// Named masses that are observed, the first of which has the amplitude; empty: the one with the force.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub observe: Vec<String>,
}

/// A mass with a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedMass {
    /// Its name: letters, digits, `-` and `_`, and not `ground`.
    pub name: String,
    /// Mass, kg; above 0.
    pub mass_kg: f64,
    /// The body that it belongs to.
    #[serde(default = "blisk")]
    pub body: Body,
}

/// A spring between two named masses, or a named mass and the ground.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedSpring {
    /// Its ends: names of masses, `next.NAME` for the mass of the next sector, or `ground`.
    pub between: [String; 2],
    /// Stiffness, N/m; above 0.
    pub stiffness_n_per_m: f64,
    /// Whether the deviation of the blade changes it: the sum of these springs is `K_blade`.
    #[serde(default)]
    pub mistuned: bool,
}

/// A contact between two named masses, or a named mass and the ground.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedContact {
    /// Its ends, as those of [`NamedSpring::between`]; friction acts on their relative motion.
    pub between: [String; 2],
    /// Share of the sector's contact stiffness and normal load, relative to those of the other contacts.
    #[serde(default = "one")]
    pub weight: f64,
}

fn blisk() -> Body {
    Body::Blisk
}

fn one() -> f64 {
    1.0
}

/// Radii at which blade, disk and ring are placed, m.
const RADIUS_M: [f64; 3] = [1.5, 1.0, 0.9];
/// Radius of named masses, and the height between two of them, m.
const NAMED_RADIUS_M: f64 = 1.0;
const NAMED_STEP_M: f64 = 0.1;
/// The name of what does not move, and what stands before the name of a mass of the next sector.
const GROUND: &str = "ground";
const NEXT: &str = "next.";

impl LumpedOptions {
    fn check_sectors(&self) -> Result<(), ModelError> {
        if self.sectors == 0 || self.sectors > MAX_SECTORS {
            let accepted = Accepted::Count(1, MAX_SECTORS);
            return Err(refused("sectors", self.sectors as f64, accepted));
        }
        Ok(())
    }

    /// Masses and springs of blade, disk and ring by key; the first two are required.
    fn keys_of_three(&self) -> [(&'static str, f64); 10] {
        [
            ("blade_mass_kg", self.blade_mass_kg),
            ("blade_stiffness_n_per_m", self.blade_stiffness_n_per_m),
            ("disk_mass_kg", self.disk_mass_kg),
            ("ring_mass_kg", self.ring_mass_kg),
            (
                "blade_coupling_stiffness_n_per_m",
                self.blade_coupling_stiffness_n_per_m,
            ),
            (
                "disk_ground_stiffness_n_per_m",
                self.disk_ground_stiffness_n_per_m,
            ),
            (
                "disk_coupling_stiffness_n_per_m",
                self.disk_coupling_stiffness_n_per_m,
            ),
            (
                "ring_ground_stiffness_n_per_m",
                self.ring_ground_stiffness_n_per_m,
            ),
            (
                "ring_coupling_stiffness_n_per_m",
                self.ring_coupling_stiffness_n_per_m,
            ),
            (
                "ring_disk_stiffness_n_per_m",
                self.ring_disk_stiffness_n_per_m,
            ),
        ]
    }

    /// The keys of blade, disk and ring: values, and the mass that each needs.
    fn check(&self) -> Result<(), ModelError> {
        self.check_sectors()?;
        for (place, (key, value)) in self.keys_of_three().into_iter().enumerate() {
            let is_required = place < 2;
            if is_required {
                positive(key, value)?;
            } else if !(value.is_finite() && value >= 0.0) {
                return Err(refused(key, value, Accepted::NonNegative));
            }
        }
        let disk = ("disk_mass_kg", self.disk_mass_kg);
        let ring = ("ring_mass_kg", self.ring_mass_kg);
        for (key, value, (mass_key, mass)) in [
            ("ring_mass_kg", self.ring_mass_kg, disk),
            (
                "disk_ground_stiffness_n_per_m",
                self.disk_ground_stiffness_n_per_m,
                disk,
            ),
            (
                "disk_coupling_stiffness_n_per_m",
                self.disk_coupling_stiffness_n_per_m,
                disk,
            ),
            (
                "ring_ground_stiffness_n_per_m",
                self.ring_ground_stiffness_n_per_m,
                ring,
            ),
            (
                "ring_coupling_stiffness_n_per_m",
                self.ring_coupling_stiffness_n_per_m,
                ring,
            ),
            (
                "ring_disk_stiffness_n_per_m",
                self.ring_disk_stiffness_n_per_m,
                ring,
            ),
        ] {
            if value > 0.0 && mass == 0.0 {
                return Err(ModelError::NeedsMass {
                    key: full_key(key),
                    value,
                    mass_key: full_key(mass_key),
                });
            }
        }
        Ok(())
    }

    /// Blade, disk and ring as a chain.
    fn of_keys(&self) -> Chain {
        let [blade, disk, ring] = [0, 1, 2];
        let has_disk = self.disk_mass_kg > 0.0;
        let has_ring = self.ring_mass_kg > 0.0;
        let kinds = [
            (self.blade_mass_kg, Body::Blisk),
            (self.disk_mass_kg, Body::Blisk),
            (self.ring_mass_kg, Body::Ring),
        ];
        let masses = kinds.into_iter().zip(RADIUS_M);
        let root = if has_disk {
            End::Mass(disk)
        } else {
            End::Ground
        };
        let springs = [
            (disk, End::Ground, self.disk_ground_stiffness_n_per_m),
            (ring, End::Ground, self.ring_ground_stiffness_n_per_m),
            (blade, root, self.blade_stiffness_n_per_m),
            (ring, End::Mass(disk), self.ring_disk_stiffness_n_per_m),
            (
                blade,
                End::Next(blade),
                self.blade_coupling_stiffness_n_per_m,
            ),
            (disk, End::Next(disk), self.disk_coupling_stiffness_n_per_m),
            (ring, End::Next(ring), self.ring_coupling_stiffness_n_per_m),
        ];
        let contact = Contact {
            ends: [End::Mass(disk), End::Mass(ring)],
            weight: 1.0,
        };
        Chain {
            sectors: self.sectors,
            masses: masses
                .filter(|((kg, _), _)| *kg > 0.0)
                .map(|((kg, body), radius_m)| Mass {
                    kg,
                    body,
                    place_m: [radius_m, 0.0],
                })
                .collect(),
            springs: springs
                .into_iter()
                .filter(|(.., stiffness)| *stiffness > 0.0)
                .map(|(mass, other, stiffness_n_per_m)| Spring {
                    ends: [End::Mass(mass), other],
                    stiffness_n_per_m,
                    is_mistuned: mass == blade && other == root,
                })
                .collect(),
            contacts: has_ring.then_some(contact).into_iter().collect(),
            forced: blade,
            observed: vec![("blade".to_owned(), blade)],
        }
    }

    /// Whether masses have names.
    fn has_names(&self) -> bool {
        !self.mass.is_empty()
            || !self.spring.is_empty()
            || !self.contact.is_empty()
            || self.force.is_some()
            || !self.observe.is_empty()
    }

    /// Named masses as a chain.
    fn of_names(&self) -> Result<Chain, ModelError> {
        self.check_sectors()?;
        self.check_no_other_keys()?;
        let masses = self.named_masses()?;
        let mut springs = Vec::new();
        for (place, spring) in self.spring.iter().enumerate() {
            let key = format!("spring[{place}]");
            let ends = self.ends(&key, &spring.between)?;
            let stiffness_n_per_m = spring.stiffness_n_per_m;
            positive(&format!("{key}.stiffness_n_per_m"), stiffness_n_per_m)?;
            if spring.mistuned && ends.iter().any(|end| matches!(end, End::Next(_))) {
                let key = format!("{key}.mistuned");
                return Err(wrong(&key, ChainProblem::MistunedAcross));
            }
            springs.push(Spring {
                ends,
                stiffness_n_per_m,
                is_mistuned: spring.mistuned,
            });
        }
        if !springs.iter().any(|spring| spring.is_mistuned) {
            return Err(wrong("spring", ChainProblem::NothingMistuned));
        }
        let mut contacts = Vec::new();
        let weights: f64 = self.contact.iter().map(|contact| contact.weight).sum();
        for (place, contact) in self.contact.iter().enumerate() {
            let key = format!("contact[{place}]");
            let ends = self.ends(&key, &contact.between)?;
            positive(&format!("{key}.weight"), contact.weight)?;
            contacts.push(Contact {
                ends,
                weight: contact.weight / weights,
            });
        }
        let Some(force) = &self.force else {
            return Err(wrong("force", ChainProblem::NoForce));
        };
        let forced = self.place_of("force", force)?;
        let mut observed = Vec::new();
        for (place, name) in self.observe.iter().enumerate() {
            let key = format!("observe[{place}]");
            observed.push((name.clone(), self.place_of(&key, name)?));
        }
        if observed.is_empty() {
            observed.push((force.clone(), forced));
        }
        Ok(Chain {
            sectors: self.sectors,
            masses,
            springs,
            contacts,
            forced,
            observed,
        })
    }

    /// The named masses, each name well formed and its own.
    fn named_masses(&self) -> Result<Vec<Mass>, ModelError> {
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        let mut masses = Vec::new();
        for (place, mass) in self.mass.iter().enumerate() {
            let (key, name) = (format!("mass[{place}]"), mass.name.as_str());
            let well_formed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            let accepted = !name.is_empty() && name.chars().all(well_formed) && name != GROUND;
            if !accepted || seen.insert(name, place).is_some() {
                let name = name.to_owned();
                let problem = ChainProblem::Name { name };
                return Err(wrong(&format!("{key}.name"), problem));
            }
            positive(&format!("{key}.mass_kg"), mass.mass_kg)?;
            masses.push(Mass {
                kg: mass.mass_kg,
                body: mass.body,
                place_m: [NAMED_RADIUS_M, NAMED_STEP_M * place as f64],
            });
        }
        if masses.is_empty() {
            return Err(wrong("mass", ChainProblem::NoMass));
        }
        Ok(masses)
    }

    /// What a spring or a contact joins: two ends, of which one is a mass of the sector.
    fn ends(&self, key: &str, between: &[String; 2]) -> Result<[End; 2], ModelError> {
        let mut ends = [End::Ground; 2];
        for (place, (end, word)) in ends.iter_mut().zip(between).enumerate() {
            let key = format!("{key}.between[{place}]");
            *end = match (word.as_str(), word.strip_prefix(NEXT)) {
                (GROUND, _) => End::Ground,
                (_, Some(name)) => End::Next(self.place_of(&key, name)?),
                (name, None) => End::Mass(self.place_of(&key, name)?),
            };
        }
        // The ground is the second end of a contact.
        if ends[0] == End::Ground {
            ends.swap(0, 1);
        }
        let is_own = |end: &End| matches!(end, End::Mass(_));
        if ends[0] == ends[1] || !ends.iter().any(is_own) {
            let between = between.clone();
            return Err(wrong(
                &format!("{key}.between"),
                ChainProblem::Ends { between },
            ));
        }
        Ok(ends)
    }

    /// Place of the mass with a name.
    fn place_of(&self, key: &str, name: &str) -> Result<usize, ModelError> {
        let place = self.mass.iter().position(|mass| mass.name == name);
        place.ok_or_else(|| {
            let known = self.mass.iter().map(|mass| mass.name.clone());
            let problem = ChainProblem::UnknownMass {
                name: name.to_owned(),
                known: known.collect(),
            };
            wrong(key, problem)
        })
    }

    /// Refuses a key of blade, disk or ring beside named masses.
    fn check_no_other_keys(&self) -> Result<(), ModelError> {
        for (key, value) in self.keys_of_three() {
            if value != 0.0 {
                return Err(wrong(key, ChainProblem::BesideNames { value }));
            }
        }
        Ok(())
    }
}

/// Builds the sector. Every node has the tangential component alone.
///
/// Of blade, disk and ring, dof 0 is the blade, then come disk and ring, then the high face of each coupled mass. 1 N acts on
/// the blade, which is the observed node; with a ring, disk and ring form one contact pair with normal (-1, 0, 0) and weight 1.
///
/// # Errors
/// If an option is out of range, a spring or the ring lacks the mass it hangs on, or a name means no mass.
pub fn build(options: &LumpedOptions) -> Result<SectorModel, ModelError> {
    if options.has_names() {
        return chain::build(&options.of_names()?);
    }
    options.check()?;
    chain::build(&options.of_keys())
}

fn positive(key: &str, value: f64) -> Result<(), ModelError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(refused(key, value, Accepted::Positive))
    }
}

fn full_key(key: &str) -> String {
    format!("model.lumped.{key}")
}

fn refused(key: &str, value: f64, accepted: Accepted) -> ModelError {
    ModelError::Option {
        key: full_key(key),
        value,
        accepted,
    }
}

fn wrong(key: &str, problem: ChainProblem) -> ModelError {
    ModelError::Chain {
        key: full_key(key),
        problem,
    }
}
