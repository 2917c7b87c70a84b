//! Random patterns: golden numbers, moments, independence; patterns from a file.

use blisk::response::mistuning::{
    Deviations, Distribution, PatternSource, pattern_stream, read_pattern_csv,
};

fn source(distribution: Distribution, count: u32) -> PatternSource {
    PatternSource::Random {
        seed: 20_240_917,
        count,
        sectors: 24,
        distribution,
    }
}

fn values(source: &PatternSource, id: u32, deviation: f64) -> Vec<f64> {
    match source
        .pattern(id, Some(deviation))
        .expect("the id is there")
        .deviations
    {
        Deviations::PerBlade(values) => values,
        Deviations::PerMode { .. } => panic!("random patterns are per blade"),
    }
}

/// If this fails, a dependency changed its numbers: every stored study would change with it.
#[test]
fn normal_draws_are_those_that_stored_studies_were_made_with() {
    let draws = Distribution::Normal.unit_draws(&mut pattern_stream(20_240_917, 3), 4);
    assert_eq!(draws, GOLDEN_NORMAL);
    let draws = Distribution::Uniform.unit_draws(&mut pattern_stream(20_240_917, 3), 4);
    assert_eq!(draws, GOLDEN_UNIFORM);
}

const GOLDEN_NORMAL: [f64; 4] = [
    -1.166_325_082_691_504_8,
    -0.953_998_284_771_665_6,
    0.573_132_335_940_776_8,
    -0.061_149_968_587_581_01,
];
const GOLDEN_UNIFORM: [f64; 4] = [
    -1.052_395_915_899_566_4,
    -0.702_549_542_495_288_4,
    0.725_840_202_825_465_2,
    -0.121_285_195_795_500_07,
];

#[test]
fn the_first_patterns_of_a_longer_study_are_the_same() {
    let (short, long) = (
        source(Distribution::Normal, 10),
        source(Distribution::Normal, 10_000),
    );
    for id in 0..10 {
        assert_eq!(short.pattern(id, Some(0.03)), long.pattern(id, Some(0.03)));
    }
    assert_eq!(short.pattern(10, Some(0.03)), None);
    assert_eq!(short.ids(), (0..10).collect::<Vec<_>>());
}

#[test]
fn the_same_unit_draws_serve_every_standard_deviation() {
    let source = source(Distribution::Normal, 1);
    let unit = values(&source, 0, 1.0);
    for (small, unit) in values(&source, 0, 0.03).iter().zip(unit) {
        assert!((small - 0.03 * unit).abs() < 1e-16);
    }
}

#[test]
fn every_law_has_zero_mean_unit_deviation_and_its_own_limits() {
    let laws = [
        (Distribution::Normal, f64::INFINITY, 3.0),
        (Distribution::Uniform, 3.0_f64.sqrt(), 1.8),
        // Kurtosis of a normal law cut off at 2, after rescaling: 2.3666...
        (
            Distribution::TruncatedNormal { truncation: 2.0 },
            2.0 / 0.879_626_18,
            2.366,
        ),
        (
            Distribution::TruncatedNormal { truncation: 0.5 },
            1.77,
            1.82,
        ),
    ];
    for (law, limit, kurtosis) in laws {
        let source = source(law, 20_000);
        let draws: Vec<f64> = (0..20_000)
            .flat_map(|id| values(&source, id, 1.0))
            .collect();
        let n = draws.len() as f64;
        let moment = |power: i32| draws.iter().map(|draw| draw.powi(power)).sum::<f64>() / n;
        // Five standard errors of the mean, of the variance and of the fourth moment.
        let name = law.name();
        assert!(
            moment(1).abs() < 5.0 / n.sqrt(),
            "{name}: mean {}",
            moment(1)
        );
        assert!(
            (moment(2) - 1.0).abs() < 5.0 * 1.5 / n.sqrt(),
            "{name}: variance {}",
            moment(2)
        );
        assert!(
            (moment(4) - kurtosis).abs() < 5.0 * 10.0 / n.sqrt(),
            "{name}: {}",
            moment(4)
        );
        assert!(draws.iter().all(|draw| draw.abs() <= limit), "{name}");
    }
}

#[test]
fn the_deviation_of_a_cut_off_normal_law_follows_its_formula() {
    // Numerical integration of x^2 phi(x) over +-c, trapezoidal rule.
    for c in [0.1, 0.5, 1.0, 2.0, 3.0, 10.0] {
        let steps = 200_000;
        let (mut mass, mut second) = (0.0, 0.0);
        for step in 0..=steps {
            let x = -c + 2.0 * c * f64::from(step) / f64::from(steps);
            let weight = if step == 0 || step == steps { 0.5 } else { 1.0 };
            let density = weight * (-0.5 * x * x).exp();
            mass += density;
            second += density * x * x;
        }
        let law = Distribution::TruncatedNormal { truncation: c };
        let expected = (second / mass).sqrt();
        let found = law.parent_standard_deviation();
        assert!(
            (found / expected - 1.0).abs() < 1e-8,
            "c = {c}: {found}, {expected}"
        );
    }
}

#[test]
fn blades_and_neighbouring_patterns_are_uncorrelated() {
    let source = source(Distribution::Normal, 20_001);
    let n = 20_000;
    let patterns: Vec<Vec<f64>> = (0..=n).map(|id| values(&source, id, 1.0)).collect();
    let bound = 5.0 / f64::from(n).sqrt();
    for lag in 1..6 {
        let along: f64 = patterns[..n as usize]
            .iter()
            .map(|p| p[0] * p[lag])
            .sum::<f64>()
            / f64::from(n);
        assert!(along.abs() < bound, "blades 0 and {lag}: {along}");
        let across: f64 = (0..n as usize)
            .map(|i| patterns[i][lag] * patterns[i + 1][lag])
            .sum::<f64>()
            / f64::from(n);
        assert!(
            across.abs() < bound,
            "patterns i and i + 1, blade {lag}: {across}"
        );
    }
}

#[test]
fn patterns_of_a_file_keep_ids_blades_and_modes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("patterns.csv");
    std::fs::write(
        &path,
        "# measured\npattern,blade,deviation\n7,1,-0.02\n7,0,0.01\n\n9,0,0\n9,1,1e-3\n",
    )
    .expect("write");
    let records = read_pattern_csv(&path).expect("a good file");
    assert_eq!(records.ids(), [7, 9]);
    let table = records.for_wheel(2, 10).expect("complete");
    let pattern = table.pattern(7).expect("pattern 7");
    assert_eq!(pattern.deviations, Deviations::PerBlade(vec![0.01, -0.02]));
    std::fs::write(
        &path,
        "pattern,blade,mode,deviation\n0,0,0,0.1\n0,0,2,0.2\n0,1,2,0.4\n0,1,0,0.3\n",
    )
    .expect("write");
    let table = read_pattern_csv(&path)
        .expect("a good file")
        .for_wheel(2, 10)
        .expect("complete");
    let expected = Deviations::PerMode {
        modes: vec![0, 2],
        values: vec![0.1, 0.2, 0.3, 0.4],
    };
    assert_eq!(table.pattern(0).expect("pattern 0").deviations, expected);
}

#[test]
fn a_bad_file_of_patterns_is_refused_with_line_value_and_what_is_accepted() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("p.csv");
    let header = "pattern,blade,deviation\n";
    let cases: [(&str, &[&str]); 13] = [
        ("blade,deviation\n0,0\n", &["no column \"pattern\""]),
        ("", &["the file is empty", "accepted: a header"]),
        (header, &["holds no pattern"]),
        (
            "pattern,blade,devation\n0,0,0\n",
            &["unknown column \"devation\""],
        ),
        (
            "pattern,blade,deviation,blade\n",
            &["\"blade\" stands twice"],
        ),
        (
            "pattern,blade,deviation\n0,0,nan\n",
            &["p.csv:2", "NaN", "above -1"],
        ),
        (
            "pattern,blade,deviation\n0,0,0\n0,1,-1\n",
            &["p.csv:3", "-1", "above -1"],
        ),
        (
            "pattern,blade,deviation\n0,0,abc\n",
            &["p.csv:2", "\"abc\"", "finite number"],
        ),
        (
            "pattern,blade,deviation\n0,-1,0\n",
            &["p.csv:2", "blade", "\"-1\"", "whole number"],
        ),
        ("pattern,blade,deviation\n0,0\n", &["p.csv:2", "3 fields"]),
        (
            "pattern,blade,deviation\n0,0,0\n0,0,0\n",
            &["p.csv:3", "line 2 gives already"],
        ),
        (
            "pattern,blade,deviation\n0,0,0\n0,2,0\n",
            &["p.csv:3", "blade = 2", "0 to 1"],
        ),
        (
            "pattern,blade,deviation\n4,0,0\n",
            &["pattern 4", "blade 1"],
        ),
    ];
    for (content, fragments) in cases {
        std::fs::write(&path, content).expect("write");
        let refused = read_pattern_csv(&path).and_then(|records| records.for_wheel(2, 10));
        let message = refused.expect_err(content).to_string();
        for fragment in fragments {
            assert!(message.contains(fragment), "{content:?}: {message}");
        }
    }
    std::fs::write(&path, "pattern,blade,mode,deviation\n0,0,,0\n0,1,1,0\n").expect("write");
    let mixed = read_pattern_csv(&path).expect("records").for_wheel(2, 10);
    assert!(
        mixed
            .expect_err("mixed modes")
            .to_string()
            .contains("p.csv:2: mode")
    );
}
