//! Files as the codes write them, after their manuals; they share nothing with the readers.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::cartesian::CartesianMatrix;

/// `.dof`: `node.direction`.
pub fn calculix_dofs(matrix: &CartesianMatrix) -> String {
    let lines = matrix
        .rows
        .iter()
        .map(|(node, i)| format!("{node}.{}\n", i + 1));
    lines.collect()
}

/// `.sti` or `.mas`: upper triangle, 14 digits.
pub fn calculix_matrix(matrix: &CartesianMatrix) -> String {
    let mut upper: Vec<_> = matrix.lower.iter().map(|&(i, j, v)| (j, i, v)).collect();
    upper.sort_by_key(|&(row, column, _)| (column, row));
    let mut text = String::new();
    for (row, column, value) in upper {
        writeln!(text, "{} {} {value:.13e}", row + 1, column + 1).unwrap();
    }
    text
}

/// A deck of nodes and sets, the sets in the three ways of writing them.
pub fn calculix_deck(nodes: &BTreeMap<usize, [f64; 3]>, sets: &[(&str, Vec<usize>)]) -> String {
    let mut text = "*HEADING\n made by a test\n** a comment\n*Node, nset = all\n".to_owned();
    for (node, [x, y, z]) in nodes {
        writeln!(text, "{node}, {x:e}, {y:e},{z:e}").unwrap();
    }
    for (name, members) in sets {
        let consecutive = members.windows(2).all(|pair| pair[1] == pair[0] + 1);
        if consecutive {
            writeln!(
                text,
                "*NSET,NSET={name},GENERATE\n{},{}",
                members[0],
                members[members.len() - 1]
            )
            .unwrap();
        } else {
            writeln!(text, "*NSET,NSET={name}_part").unwrap();
            for line in members.chunks(8) {
                let words: Vec<String> = line.iter().map(ToString::to_string).collect();
                writeln!(text, "{},", words.join(", ")).unwrap();
            }
            writeln!(text, "*NSET,\nNSET={name}\n{name}_PART").unwrap();
        }
    }
    text
}

/// Rows as the mapping file of Ansys' `HBMAT` or a CSV table.
pub fn dof_table(matrix: &CartesianMatrix, csv: bool) -> String {
    let mut text = if csv {
        "row,node,direction\n".to_owned()
    } else {
        "  Matrix Eqn        Node         DOF\n".to_owned()
    };
    for (row, (node, i)) in matrix.rows.iter().enumerate() {
        let (row, direction) = (row + 1, ["UX", "UY", "UZ"][*i]);
        if csv {
            writeln!(text, "{row},{node},{}", i + 1).unwrap();
        } else {
            writeln!(text, "{row:12}{node:12}{direction:>12}").unwrap();
        }
    }
    text
}

pub fn matrix_market(matrix: &CartesianMatrix) -> String {
    let n = matrix.rows.len();
    let mut text = format!(
        "%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {}\n",
        matrix.lower.len()
    );
    for (row, column, value) in &matrix.lower {
        writeln!(text, "{} {} {value:e}", row + 1, column + 1).unwrap();
    }
    text
}

/// Stiffness, mass and the blade's stiffness of one run in Matrix Market files, each with its table of rows.
pub fn matrix_market_run(
    folder: &Path,
    stiffness: &CartesianMatrix,
    mass: &CartesianMatrix,
    blade: &CartesianMatrix,
) {
    for (name, text) in [
        ("K.mtx", matrix_market(stiffness)),
        ("M.mtx", matrix_market(mass)),
        ("dofs.csv", dof_table(stiffness, true)),
        ("blade.mtx", matrix_market(blade)),
        ("blade.csv", dof_table(blade, true)),
    ] {
        fs::write(folder.join(name), text).unwrap();
    }
}

/// The keys of an import file for such a run.
pub const MATRIX_MARKET_KEYS: &str = "mesh = \"mesh\"\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.csv\"\n\
    blade_stiffness = \"blade.mtx\"\nblade_dofs = \"blade.csv\"\n";

/// Both triangles, by column then row.
fn full(matrix: &CartesianMatrix) -> Vec<(usize, usize, f64)> {
    let mirrored = matrix
        .lower
        .iter()
        .filter(|(i, j, _)| i != j)
        .map(|&(i, j, v)| (j, i, v));
    let mut entries: Vec<_> = matrix.lower.iter().copied().chain(mirrored).collect();
    entries.sort_by_key(|&(row, column, _)| (column, row));
    entries
}

/// A number in `width` characters as Fortran's `E`, `D`: two digits of exponent.
fn fortran(value: f64, width: usize, digits: usize, letter: char) -> String {
    let text = format!("{value:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!(
        "{:>width$}",
        format!("{mantissa}{letter}{sign}{:02}", exponent.abs())
    )
}

/// Harwell-Boeing: one triangle (`RSA`) as Ansys writes it, one value a line with `D` exponents, or
/// both (`RUA`), several values a line.
pub fn harwell_boeing(matrix: &CartesianMatrix, symmetric: bool) -> String {
    let entries = if symmetric {
        matrix.lower.clone()
    } else {
        full(matrix)
    };
    let n = matrix.rows.len();
    let (integers, values) = if symmetric { (1, 1) } else { (8, 3) };
    let mut pointers = vec![1];
    for column in 0..n {
        let count = entries.iter().filter(|entry| entry.1 == column).count();
        pointers.push(pointers[column] + count);
    }
    let lines = |count: usize, per_line: usize| count.div_ceil(per_line);
    let (p, i, v) = (
        lines(n + 1, integers),
        lines(entries.len(), integers),
        lines(entries.len(), values),
    );
    let mut text = format!("{:<72}{:<8}\n", "Stiffness matrix", "KAA");
    writeln!(text, "{:14}{p:14}{i:14}{v:14}{:14}", p + i + v, 0).unwrap();
    let kind = if symmetric { "RSA" } else { "RUA" };
    writeln!(text, "{kind:14}{n:14}{n:14}{:14}{:14}", entries.len(), 0).unwrap();
    let formats = if symmetric {
        ["(1I14)", "(1I14)", "(1D26.17)"]
    } else {
        ["(8I10)", "(8I10)", "(1P,3E25.16)"]
    };
    writeln!(
        text,
        "{:<16}{:<16}{:<20}{:<20}",
        formats[0], formats[1], formats[2], formats[2]
    )
    .unwrap();
    let width = if symmetric { 14 } else { 10 };
    let indices: Vec<usize> = entries.iter().map(|entry| entry.0 + 1).collect();
    for list in [pointers, indices] {
        for line in list.chunks(integers) {
            let words = line
                .iter()
                .map(|number| format!("{number:width$}"))
                .collect::<Vec<_>>()
                .concat();
            writeln!(text, "{words}").unwrap();
        }
    }
    for line in entries.chunks(values) {
        let word = |entry: &(usize, usize, f64)| {
            if symmetric {
                fortran(entry.2, 26, 17, 'D')
            } else {
                fortran(entry.2, 25, 16, 'E')
            }
        };
        writeln!(text, "{}", line.iter().map(word).collect::<String>()).unwrap();
    }
    text
}

/// The three forms of an OUTPUT4 matrix.
#[derive(Clone, Copy, PartialEq)]
pub enum Op4 {
    Dense,
    Sparse,
    BigSparse,
}

/// One matrix in Nastran's OUTPUT4 form, after the User's Guide.
pub fn op4(matrix: &CartesianMatrix, name: &str, form: Op4) -> String {
    let n = matrix.rows.len();
    let rows = if form == Op4::BigSparse {
        -(n as i64)
    } else {
        n as i64
    };
    let mut text = format!("{n:8}{rows:8}{:8}{:8}{name:<8}1P,3E23.16\n", 6, 2);
    let entries = full(matrix);
    for column in 0..n {
        let own: Vec<_> = entries
            .iter()
            .filter(|entry| entry.1 == column && entry.2 != 0.0)
            .collect();
        let (first, last) = (own[0].0, own[own.len() - 1].0);
        if form == Op4::Dense {
            let mut values = vec![0.0; last - first + 1];
            for entry in own {
                values[entry.0 - first] = entry.2;
            }
            writeln!(text, "{:8}{:8}{:8}", column + 1, first + 1, values.len()).unwrap();
            op4_values(&mut text, &values);
            continue;
        }
        // Strings of consecutive rows.
        let mut strings: Vec<(usize, Vec<f64>)> = Vec::new();
        for entry in own {
            match strings.last_mut() {
                Some((start, values)) if *start + values.len() == entry.0 => values.push(entry.2),
                _ => strings.push((entry.0, vec![entry.2])),
            }
        }
        // Words of a string: two for each value, and its head of one or two.
        let head = if form == Op4::BigSparse { 2 } else { 1 };
        let words: usize = strings
            .iter()
            .map(|(_, values)| 2 * values.len() + head)
            .sum();
        writeln!(text, "{:8}{:8}{words:8}", column + 1, 0).unwrap();
        for (start, values) in strings {
            let length = 2 * values.len() + 1;
            if form == Op4::BigSparse {
                writeln!(text, "{length:8}{:8}", start + 1).unwrap();
            } else {
                writeln!(text, "{:12}", length * 65536 + start + 1).unwrap();
            }
            op4_values(&mut text, &values);
        }
    }
    writeln!(text, "{:8}{:8}{:8}", n + 1, 1, 1).unwrap();
    op4_values(&mut text, &[1.0]);
    text
}

fn op4_values(text: &mut String, values: &[f64]) {
    for line in values.chunks(3) {
        let words: String = line
            .iter()
            .map(|&value| fortran(value, 23, 16, 'E'))
            .collect();
        writeln!(text, "{words}").unwrap();
    }
}

/// A DMIG matrix in large fields (as punched, with column 73 to 80) or free fields.
pub fn dmig(matrix: &CartesianMatrix, name: &str, large: bool) -> String {
    let mut text = if large {
        format!("DMIG    {name:<8}       0       6       2       0\n")
    } else {
        format!("$ stiffness\nDMIG,{name},0,6,2,0\n")
    };
    for (column, (node, i)) in matrix.rows.iter().enumerate() {
        let entries = matrix
            .lower
            .iter()
            .filter(|entry| entry.1 == column && entry.2 != 0.0);
        if large {
            writeln!(
                text,
                "DMIG*   {name:<16}{node:16}{:16}{:16}*{column:>7}",
                i + 1,
                ""
            )
            .unwrap();
        } else {
            write!(text, "DMIG,{name},{node},{},", i + 1).unwrap();
        }
        for (at, entry) in entries.enumerate() {
            let (row_node, row_i) = matrix.rows[entry.0];
            if large {
                let value = fortran(entry.2, 16, 9, 'D');
                writeln!(
                    text,
                    "*{column:<7}{row_node:16}{:16}{value}{:16}*",
                    row_i + 1,
                    ""
                )
                .unwrap();
            } else if at == 0 {
                writeln!(text, ",{row_node},{},{:e},", row_i + 1, entry.2).unwrap();
            } else {
                writeln!(text, "+,{row_node},{},{:e}", row_i + 1, entry.2).unwrap();
            }
        }
    }
    text
}

/// Nastran bulk data: grid points in large fields, and sets.
pub fn nastran_bulk(nodes: &BTreeMap<usize, [f64; 3]>, sets: &[(&str, Vec<usize>)]) -> String {
    let mut text = "$ made by a test\nBEGIN BULK\n".to_owned();
    for (node, position) in nodes {
        let [x, y, z] = position.map(|value| fortran(value, 16, 9, 'E').replace('E', ""));
        writeln!(
            text,
            "GRID*   {node:16}{:16}{x:>16}{y:>16}\n*       {z:>16}",
            ""
        )
        .unwrap();
    }
    for (name, members) in sets {
        let mut fields: Vec<String> = vec![(*name).to_owned()];
        fields.extend(members.iter().map(ToString::to_string));
        for (index, line) in fields.chunks(8).enumerate() {
            let words = line
                .iter()
                .map(|word| format!("{word:>8}"))
                .collect::<Vec<_>>()
                .concat();
            writeln!(text, "{:8}{words}", if index == 0 { "SET1" } else { "+" }).unwrap();
        }
    }
    text.push_str("ENDDATA\n");
    text
}

/// A `.cdb` of Ansys: node block, then components with ranges.
pub fn ansys_cdb(nodes: &BTreeMap<usize, [f64; 3]>, sets: &[(&str, Vec<usize>)]) -> String {
    let mut text = "/COM,ANSYS RELEASE 2024 R1\n/PREP7\n".to_owned();
    writeln!(
        text,
        "NBLOCK,6,SOLID,{:10},{:10}\n(3i9,6e24.16e3)",
        nodes.len(),
        nodes.len()
    )
    .unwrap();
    for (node, position) in nodes {
        write!(text, "{node:9}{:9}{:9}", 0, 0).unwrap();
        // Noughts at the end of the line are left out.
        let count = position
            .iter()
            .rposition(|&value| value != 0.0)
            .map_or(0, |at| at + 1);
        for &value in &position[..count] {
            write!(text, "{}", fortran(value, 24, 16, 'E')).unwrap();
        }
        text.push('\n');
    }
    text.push_str("N,R5.3,LOC,       -1,\n");
    for (name, members) in sets {
        // A negative number ends a range.
        let mut items: Vec<i64> = Vec::new();
        let mut at = 0;
        while at < members.len() {
            let mut end = at;
            while end + 1 < members.len() && members[end + 1] == members[end] + 1 {
                end += 1;
            }
            items.push(members[at] as i64);
            if end > at {
                items.push(-(members[end] as i64));
            }
            at = end + 1;
        }
        writeln!(
            text,
            "CMBLOCK,{name:<8},NODE,{:8}  ! users node component definition\n(8i10)",
            items.len()
        )
        .unwrap();
        for line in items.chunks(8) {
            let words = line
                .iter()
                .map(|item| format!("{item:10}"))
                .collect::<Vec<_>>()
                .concat();
            writeln!(text, "{words}").unwrap();
        }
    }
    text.push_str("FINISH\n");
    text
}
