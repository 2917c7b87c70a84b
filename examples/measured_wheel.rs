//! One measured wheel with a friction ring: from the frequencies of its blades to its peak under several normal loads.
//!
//!     cargo run --release --example measured_wheel

use std::error::Error;
use std::io::Write;

use blisk::options::{ContactLaw, Ring};
use blisk::{
    ContactCondition, ContactOptions, Damping, Engine, LumpedOptions, Mistuning, Numerics, Problem,
    lumped_sector,
};

/// Frequency of each blade by itself, Hz, in the direction of rotation, and that of the design.
pub(crate) const BLADES_HZ: [f64; 8] = [503.9, 498.2, 506.1, 501.0, 496.4, 504.7, 500.3, 507.2];
pub(crate) const DESIGN_HZ: f64 = 502.0;

/// Normal loads of the ring per sector, N.
pub(crate) const LOADS_N: [f64; 3] = [10.0, 40.0, 160.0];

/// Relative deviation of the stiffness of each blade: `(f / f0)^2 - 1`.
pub(crate) fn deviations() -> Vec<f64> {
    let deviation = |hz: &f64| (hz / DESIGN_HZ).powi(2) - 1.0;
    BLADES_HZ.iter().map(deviation).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    told(&mut std::io::stdout())
}

/// Writes what is found to `out`.
pub(crate) fn told(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    // Blade, disk and ring of a sector; the ring touches the disk.
    let sector = lumped_sector(&LumpedOptions {
        sectors: BLADES_HZ.len(),
        blade_mass_kg: 0.25,
        disk_mass_kg: 1.0,
        ring_mass_kg: 0.03,
        blade_stiffness_n_per_m: 2.5e6,
        disk_ground_stiffness_n_per_m: 7.0e6,
        disk_coupling_stiffness_n_per_m: 2.5e5,
        ring_coupling_stiffness_n_per_m: 8.0e5,
        ring_disk_stiffness_n_per_m: 1.0e4,
        ..LumpedOptions::default()
    })?;
    let mistuning = Mistuning::Measured(vec![deviations()]);
    let loads = LOADS_N.map(|normal_load_n| ContactCondition::Full { normal_load_n });
    let problem = Problem {
        contact: Some(ContactOptions {
            law: ContactLaw::MacroSlip1d,
            friction_coefficient: 0.3,
            tangential_stiffness_n_per_m: 8.0e5,
            normal_stiffness_n_per_m: None,
            ring: Ring::Locked,
        }),
        amplitude_n: 10.0,
        conditions: loads.to_vec(),
        ..Problem::new(Damping::StructuralLossFactor(0.002), &[3], mistuning)
    };
    let numerics = Numerics {
        harmonics: Some(vec![1, 3]),
        ..Numerics::default()
    };
    let engine = Engine::build(&sector, &problem, &numerics)?;
    for scenario in engine.scenarios() {
        let row = engine.peak(&engine.wheel(0, scenario)?, scenario);
        let peak = row.peak_amplitude_m.zip(row.amplification_factor);
        let (peak_m, factor) = peak.ok_or_else(|| row.status.name())?;
        writeln!(
            out,
            "{} N: peak {peak_m:.6e} m, {factor:.4} times that of the tuned wheel, within {:.1} %",
            scenario.contact.normal_load_n().unwrap_or(0.0),
            100.0 * row.stated_error.unwrap_or(f64::NAN)
        )?;
    }
    Ok(())
}
