//! Tables: what is written is what is read, described and bounded.

use std::path::Path;

use blisk::population::monte_carlo::{ResponseRow, Scenario};
use blisk::population::table::{
    ColumnKind, ColumnSpec, Compression, CurveFormat, CurvePoint, DISTRIBUTION_COLUMNS,
    MAIN_EFFECT_COLUMNS, PATTERN_COLUMNS, PERCENTILE_COLUMNS, RESPONSE_COLUMNS, ResponseReader,
    ResponseWriter, TableHeader, VERIFICATION_COLUMNS, write_curve,
};
use blisk::response::forced_response::ContactCondition;
use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::PairFactors;
use polars::prelude::PlSmallStr;

fn header(compression: Compression) -> TableHeader {
    TableHeader {
        study_digest: "abc".to_owned(),
        compression,
        load_cases: Vec::new(),
    }
}

fn scenarios() -> Vec<Scenario> {
    let contacts = [
        ContactCondition::Full {
            normal_load_n: 160.0,
        },
        ContactCondition::Stuck,
    ];
    contacts
        .into_iter()
        .enumerate()
        .map(|(index, contact)| Scenario {
            index,
            load_case: None,
            engine_order: 3,
            standard_deviation: (index == 0).then_some(0.03),
            contact,
        })
        .collect()
}

fn row(pattern: u32, scenario: usize) -> ResponseRow {
    let status = Status::ALL[pattern as usize % Status::ALL.len()];
    let good = status == Status::Ok;
    ResponseRow {
        scenario,
        pattern,
        status,
        contact_factors: (scenario == 0).then(|| PairFactors {
            friction_coefficient: 1.0 + f64::from(pattern),
            tangential_stiffness: 0.5,
            normal_stiffness: 0.25,
            normal_load: 2.0,
        }),
        peak_amplitude_m: good.then_some(1.0 / f64::from(pattern + 3)),
        peak_frequency_hz: good.then_some(1e3),
        peak_blade: good.then_some(23),
        amplification_factor: good.then_some(f64::MIN_POSITIVE),
        peak_bracketed: good.then_some(true),
        harmonics: "0-1-3".to_owned(),
        nonlinear_solves: u64::from(pattern) << 33,
        newton_iterations: 3,
        factorisations: 2,
        retries: 1,
        residual: good.then_some(1e-300),
        slipping_fraction: None,
        separated_fraction: good.then_some(0.0),
        mean_friction_circumferential_n: good.then_some(-1.5),
        mean_friction_axial_n: good.then_some(0.25),
        shortcut: "none".to_owned(),
        sampling_error: good.then_some(-2e-4),
        harmonic_error: None,
        stated_error: good.then_some(0.013),
        error_within_tolerance: good.then_some(pattern.is_multiple_of(2)),
        basis: "stick_slide 4+4".to_owned(),
    }
}

#[test]
fn rows_come_back_as_they_were_written_over_several_row_groups() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for compression in [Compression::Zstd, Compression::Snappy] {
        let path = folder.path().join("responses.parquet");
        let rows: Vec<ResponseRow> = (0..70_000)
            .flat_map(|pattern| [row(pattern, 0), row(pattern, 1)])
            .collect();
        let mut writer =
            ResponseWriter::create(&path, &scenarios(), &header(compression), &[]).expect("create");
        // Batches of odd sizes must not show in the file.
        for batch in rows.chunks(9_973) {
            writer.write(batch.to_vec()).expect("write");
        }
        writer.finish().expect("finish");
        let mut reader = ResponseReader::open(&path).expect("open");
        assert_eq!(
            (reader.rows(), reader.study_digest()),
            (rows.len(), Some("abc"))
        );
        let mut read = Vec::new();
        loop {
            let batch = reader.next_batch().expect("batch");
            if batch.is_empty() {
                break;
            }
            read.extend(batch);
        }
        assert!(read == rows);
    }
    let leftovers = std::fs::read_dir(folder.path()).expect("read").count();
    assert_eq!(leftovers, 1, "no temporary file stays");
}

#[test]
fn an_unfinished_table_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("responses.parquet");
    let mut writer = ResponseWriter::create(&path, &scenarios(), &header(Compression::Zstd), &[])
        .expect("create");
    writer.write([row(0, 0)]).expect("write");
    drop(writer);
    assert_eq!(std::fs::read_dir(folder.path()).expect("read").count(), 0);
}

/// Name, type and unit of each column that `docs/results.md` has in the section of the table `file`. `load_case` is left
/// out, which only the tables of some studies have; a type or unit that the page does not repeat is empty.
fn documented(file: &str) -> Vec<[String; 3]> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/results.md");
    let page = std::fs::read_to_string(page).expect("the page of results");
    let head = format!("## `{file}`\n");
    let section = page.split_once(&head).expect("a section of the table").1;
    let section = section.split("\n## ").next().expect("a section");
    // The first table of the section.
    let rows = section
        .lines()
        .skip_while(|line| !line.starts_with("| column | type | unit |"))
        .skip(2)
        .take_while(|line| line.starts_with('|'));
    let mut columns = Vec::new();
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let names = cells[1].split(", ").map(|name| name.trim_matches('`'));
        for name in names.filter(|name| *name != "load_case") {
            columns.push([name, cells[2], cells[3]].map(str::to_owned));
        }
    }
    columns
}

#[test]
fn columns_are_the_documented_ones_in_order() {
    let tables = [
        ("responses.parquet", RESPONSE_COLUMNS),
        ("percentiles.parquet", PERCENTILE_COLUMNS),
        ("main_effects.parquet", MAIN_EFFECT_COLUMNS),
        ("distribution.parquet", DISTRIBUTION_COLUMNS),
        ("patterns.parquet", PATTERN_COLUMNS),
        ("verification.parquet", VERIFICATION_COLUMNS),
    ];
    for (file, columns) in tables {
        let documented = documented(file);
        let names: Vec<&str> = documented.iter().map(|[name, ..]| name.as_str()).collect();
        let declared: Vec<&str> = columns.iter().map(|column| column.name).collect();
        assert_eq!(names, declared, "{file}");
        for ([name, kind, unit], column) in documented.iter().zip(columns) {
            // Only `responses.parquet` has the type of all its columns; others refer to it for some.
            let repeated = !kind.is_empty() || file == "responses.parquet";
            if repeated {
                assert_eq!(*kind, format!("{:?}", column.kind), "{file}: {name}");
                let count = matches!(column.kind, ColumnKind::Int32 | ColumnKind::Int64);
                let own = if count { "" } else { column.unit };
                assert_eq!(unit, own, "{file}: {name}");
            }
        }
    }
}

#[test]
fn a_curve_in_csv_reads_back_to_the_last_digit() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let points = [
        CurvePoint {
            frequency_hz: 340.1,
            blade: 0,
            amplitude_m: Some(1.0 / 3.0 * 1e-4),
            status: Status::Ok,
        },
        CurvePoint {
            frequency_hz: 340.1,
            blade: 1,
            amplitude_m: None,
            status: Status::Diverged,
        },
    ];
    let path = folder.path().join("curve.csv");
    write_curve(&path, CurveFormat::Csv, &points, &header(Compression::Zstd)).expect("write");
    let text = std::fs::read_to_string(&path).expect("read");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "frequency_hz,blade,amplitude_m,status");
    let amplitude: f64 = lines[1]
        .split(',')
        .nth(2)
        .expect("a field")
        .parse()
        .expect("a number");
    assert_eq!(Some(amplitude), points[0].amplitude_m);
    assert_eq!(lines[2], "340.1,1,,diverged");
}

#[test]
fn every_field_of_the_arrow_schema_has_the_unit_and_the_description_of_its_column() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("responses.parquet");
    let header = header(Compression::Zstd);
    let writer = ResponseWriter::create(&path, &scenarios(), &header, &[]);
    let mut writer = writer.expect("a writer");
    writer.write([row(0, 0), row(0, 1)]).expect("rows");
    writer.finish().expect("a table");
    let mut file = std::fs::File::open(&path).expect("a table");
    let metadata = polars_parquet::read::read_metadata(&mut file).expect("a footer");
    let schema = polars_parquet::read::infer_schema(&metadata).expect("an Arrow schema");
    assert!(schema.len() > 20);
    for field in schema.iter_values() {
        let of_field = |column: &&ColumnSpec| field.name == column.name;
        let column = RESPONSE_COLUMNS.iter().find(of_field).expect("a column");
        let own = field.metadata.as_ref().expect("metadata of the field");
        assert_eq!(own.get("unit").map(PlSmallStr::as_str), Some(column.unit));
        let description = own.get("description").map(PlSmallStr::as_str);
        assert_eq!(description, Some(column.description));
        assert!(!column.description.is_empty());
    }
}
