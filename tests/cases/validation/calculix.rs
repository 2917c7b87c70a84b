//! Frequencies of a cyclic sector of 20-node bricks by `CalculiX`.

use std::f64::consts::TAU;

use blisk::linalg::lowest_modes;
use blisk::model::cyclic::CyclicSector;
use rayon::prelude::*;

use super::super::support::{Row, Table, package};
use super::calculix_sector::calculix_sector;
use super::report::{Section, Verdict, table};

/// Modes per nodal diameter of the reference.
const MODES: usize = 5;

pub fn section() -> Section {
    let reference = Table::read(&package("tests/data/ccx_sector/frequencies.csv"));
    let rows: Vec<Row<'_>> = reference.rows().collect();
    let model = calculix_sector();
    let sector = CyclicSector::new(&model);
    let groups: Vec<&[Row<'_>]> = rows
        .chunk_by(|a, b| a.text("nodal_diameter") == b.text("nodal_diameter"))
        .collect();
    let compared: Vec<(usize, Vec<(f64, f64)>)> = groups
        .par_iter()
        .map(|group| {
            let h = group[0].number("nodal_diameter") as usize;
            let factor = sector.stiffness(h).factor().unwrap();
            let (values, _) = lowest_modes(&factor, &sector.mass(h), 0.0, MODES).unwrap();
            let pairs = group.iter().map(|row| {
                let mode = row.number("mode") as usize;
                (values[mode - 1].sqrt() / TAU, row.number("frequency_hz"))
            });
            (h, pairs.collect())
        })
        .collect();
    let relative = |(own, other): &(f64, f64)| (own / other - 1.0).abs();
    let cells: Vec<Vec<String>> = compared
        .iter()
        .map(|(h, pairs)| {
            let worst = pairs.iter().map(relative).fold(0.0, f64::max);
            let list = |of: fn(&(f64, f64)) -> f64| {
                let values: Vec<String> = pairs
                    .iter()
                    .map(|pair| format!("{:.4}", of(pair)))
                    .collect();
                values.join(", ")
            };
            vec![
                h.to_string(),
                list(|pair| pair.0),
                list(|pair| pair.1),
                format!("{worst:.1e}"),
            ]
        })
        .collect();
    let header = [
        "nodal diameter",
        "ours, Hz",
        "CalculiX, Hz",
        "worst relative difference",
    ];
    let count: usize = compared.iter().map(|(_, pairs)| pairs.len()).sum();
    Section {
        compared: format!(
            "The lowest {MODES} natural frequencies of nodal diameters 0 to 6, {count} in all, of a disk and blade of C3D20 elements: mesh and \
             frequencies (seven digits) of CalculiX 2.20, matrices and cyclic conditions of this program."
        ),
        body: table(&header, &cells),
        verdicts: vec![Verdict::at_most(
            "frequency",
            "frequency",
            compared
                .iter()
                .flat_map(|(_, pairs)| pairs.iter().map(relative)),
            1e-4,
        )],
    }
}
