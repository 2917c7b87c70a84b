//! Rows of the truth: each peak with fixed-interface modes doubled until it stays, and what it took.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::{Mutex, OnceLock};
use std::time::Instant;

use faer::Mat;

use super::cases::{Condition, OTHER_DAMPERS, Wheel, folder};
use super::contact::Period;
use super::dampers::within_one_sector;
use super::iteration::{Case, solve};
use super::peak::{Peak, peak};
use super::sector::Sector;

/// Samples of a period.
const SAMPLES: usize = 512;
/// Harmonics of the truth, and of what it is checked with on every tenth row.
const HIGHEST: u32 = 15;
const HIGHEST_OF_CHECK: u32 = 25;
/// Every so many rows are solved with more harmonics too.
const CHECKED: usize = 10;
/// Change of a peak with twice the modes at which they are enough.
const CHANGE_BY_MODES: f64 = 2e-4;
const FEWEST_MODES: usize = 40;
const MOST_MODES: usize = 320;
/// With wedges and cylinders: a peak may be the same with 80 and 160 modes, and another one with 320.
const FEWEST_MODES_UNDER_PLATFORMS: usize = 160;
/// With other dampers than rings, whose pairs more modes soften.
const MOST_MODES_OF_OTHERS: usize = 640;

/// A row of `truth.csv`.
#[derive(Clone, Debug)]
pub struct Row {
    pub pattern: usize,
    pub condition: String,
    /// None where no solution was reached.
    pub amplitude_m: Option<f64>,
    pub frequency_hz: f64,
    pub blade: usize,
    pub modes: usize,
    /// Relative change of the peak by the last doubling of the modes.
    pub change_by_modes: f64,
    /// Relative change of the peak by harmonics up to 25; none where it was not looked at.
    pub change_by_harmonics: Option<f64>,
    pub opening_pairs: usize,
    pub slipping_pairs: usize,
    pub points: usize,
    pub seconds: f64,
}

pub const HEADER: &str = "pattern,condition,amplitude_m,frequency_hz,blade,modes,change_by_modes,change_by_harmonics,\
                          opening_pairs,slipping_pairs,points,seconds";

impl Row {
    /// Normal load, N; none for a linear limit.
    pub fn load_n(&self) -> Option<f64> {
        self.condition.parse().ok()
    }

    /// Whether twice as many modes no longer change the peak.
    pub fn is_settled(&self) -> bool {
        self.change_by_modes < CHANGE_BY_MODES
    }

    fn line(&self) -> String {
        let shown = |value: Option<f64>| value.map_or(String::new(), |own| format!("{own:e}"));
        let mut line = format!("{},{}", self.pattern, self.condition);
        let _ = write!(
            line,
            ",{},{},{},{},{:.2e},{},{},{},{},{:.1}",
            shown(self.amplitude_m),
            self.frequency_hz,
            self.blade,
            self.modes,
            self.change_by_modes,
            shown(self.change_by_harmonics),
            self.opening_pairs,
            self.slipping_pairs,
            self.points,
            self.seconds
        );
        line
    }

    fn of_line(line: &str) -> Self {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells[at].parse::<f64>().expect("a number");
        let whole = |at: usize| cells[at].parse::<usize>().expect("a whole number");
        let known = |at: usize| (!cells[at].is_empty()).then(|| number(at));
        Self {
            pattern: whole(0),
            condition: cells[1].to_owned(),
            amplitude_m: known(2),
            frequency_hz: number(3),
            blade: whole(4),
            modes: whole(5),
            change_by_modes: number(6),
            change_by_harmonics: known(7),
            opening_pairs: whole(8),
            slipping_pairs: whole(9),
            points: whole(10),
            seconds: number(11),
        }
    }
}

fn file(wheel: &str) -> PathBuf {
    folder(wheel).join("truth.csv")
}

/// The rows that are stored.
pub fn stored(wheel: &str) -> Vec<Row> {
    let text = std::fs::read_to_string(file(wheel)).unwrap_or_default();
    text.lines().skip(1).map(Row::of_line).collect()
}

/// Adds a row to those that are stored.
pub fn store(wheel: &str, row: &Row) {
    static WRITING: Mutex<()> = Mutex::new(());
    let _alone = WRITING.lock().expect("no panic");
    let path = file(wheel);
    let is_new = !path.exists();
    let options = &mut std::fs::OpenOptions::new();
    let mut file = options
        .create(true)
        .append(true)
        .open(path)
        .expect("a file");
    if is_new {
        writeln!(file, "{HEADER}").expect("written");
    }
    writeln!(file, "{}", row.line()).expect("written");
}

/// Puts the rows in order.
pub fn sort(wheel: &str) {
    let mut rows = stored(wheel);
    let is_linear = |row: &Row| row.condition.parse::<f64>().is_err();
    rows.sort_by_key(|row| (is_linear(row), row.pattern));
    let lines: Vec<String> = rows.iter().map(Row::line).collect();
    let text = format!("{HEADER}\n{}\n", lines.join("\n"));
    std::fs::write(file(wheel), text).expect("written");
}

/// Sectors of a wheel by their number of modes, made when first wanted.
pub struct Sectors<'a> {
    wheel: &'a Wheel,
    made: BTreeMap<usize, OnceLock<Sector>>,
    fewest_modes: usize,
    most_modes: usize,
}

impl<'a> Sectors<'a> {
    pub fn new(wheel: &'a Wheel) -> Self {
        let doubled = |modes: &usize| Some(2 * modes);
        let all = std::iter::successors(Some(FEWEST_MODES), doubled);
        let is_other = OTHER_DAMPERS.contains(&wheel.name.as_str());
        let most_modes = if is_other {
            MOST_MODES_OF_OTHERS
        } else {
            MOST_MODES
        };
        let made = all.take_while(|modes| *modes <= most_modes);
        let fewest_modes = if ["wedges", "cylinders"].contains(&wheel.name.as_str()) {
            FEWEST_MODES_UNDER_PLATFORMS
        } else {
            FEWEST_MODES
        };
        Self {
            wheel,
            fewest_modes,
            made: made.map(|modes| (modes, OnceLock::new())).collect(),
            most_modes,
        }
    }

    pub fn with(&self, modes: usize) -> &Sector {
        self.made[&modes].get_or_init(|| {
            let model = within_one_sector(self.wheel.model.clone());
            Sector::new(&model, modes)
        })
    }
}

/// The harmonics of a condition up to `highest`.
fn harmonics(condition: Condition, highest: u32) -> Vec<u32> {
    match condition {
        Condition::Friction(_) => (0..=highest).collect(),
        _ => vec![1],
    }
}

/// A motion with the harmonics of one period as one with those of another, which has more of them.
fn padded(motion: &Mat<f64>, from: &Period, to: &Period) -> Mat<f64> {
    let mut found = Mat::zeros(to.coefficients(), motion.ncols());
    for (place, k) in to.harmonics.iter().enumerate() {
        if let Some(before) = from.harmonics.iter().position(|own| own == k) {
            let count = if *k == 0 { 1 } else { 2 };
            for part in 0..count {
                for row in 0..motion.ncols() {
                    found[(to.first(place) + part, row)] = motion[(from.first(before) + part, row)];
                }
            }
        }
    }
    found
}

/// A motion to start from: a few harmonics, then more, each set from the one before.
fn start(sector: &Sector, case: &Case, period: &Period, hint_hz: f64) -> Option<Mat<f64>> {
    const HIGHEST: [u32; 6] = [1, 3, 5, 7, 9, 12];
    let mut found: Option<(Mat<f64>, Period)> = None;
    for highest in HIGHEST {
        let set: Vec<u32> = if highest == 1 {
            vec![1]
        } else {
            (0..=highest).collect()
        };
        let own = Period::new(&set, period.samples());
        let before = found
            .as_ref()
            .map(|(motion, from)| padded(motion, from, &own));
        let point = solve(sector, case, &own, hint_hz, before.as_ref());
        let opens = point.as_ref().is_none_or(|point| point.opening_pairs > 0);
        if let Some(point) = point {
            found = Some((point.motion, own));
        }
        // Where nothing opens, three harmonics are near enough.
        if highest >= 3 && !opens {
            break;
        }
    }
    found.map(|(motion, from)| padded(&motion, &from, period))
}

/// Solves the row of a pattern, whose peak is looked for round `hint_hz`.
pub fn solve_row(
    sectors: &Sectors<'_>,
    wheel: &Wheel,
    pattern: usize,
    condition: Condition,
    hint_hz: f64,
) -> Row {
    let began = Instant::now();
    let case = wheel.case(Some(pattern), condition);
    let period = Period::new(&harmonics(condition, HIGHEST), SAMPLES);
    let mut row = Row {
        pattern,
        condition: condition.to_string(),
        amplitude_m: None,
        frequency_hz: hint_hz,
        blade: 0,
        modes: sectors.fewest_modes,
        change_by_modes: f64::INFINITY,
        change_by_harmonics: None,
        opening_pairs: 0,
        slipping_pairs: 0,
        points: 0,
        seconds: 0.0,
    };
    let sector = sectors.with(row.modes);
    let begin = match condition {
        Condition::Friction(_) => start(sector, &case, &period, hint_hz),
        _ => None,
    };
    let mut found = peak(sector, &case, &period, hint_hz, begin.as_ref());
    while let Some(Peak { top, points, .. }) = &found {
        row.points += points;
        if row.change_by_modes < CHANGE_BY_MODES || row.modes == sectors.most_modes {
            break;
        }
        let more = sectors.with(2 * row.modes);
        let next = peak(more, &case, &period, top.frequency_hz, Some(&top.motion));
        if let Some(next) = &next {
            row.modes *= 2;
            row.change_by_modes = (next.top.amplitude_m() / top.amplitude_m() - 1.0).abs();
        }
        found = next;
    }
    if let Some(Peak { top, .. }) = &found {
        row.amplitude_m = Some(top.amplitude_m());
        row.frequency_hz = top.frequency_hz;
        row.opening_pairs = top.opening_pairs;
        row.slipping_pairs = top.slipping_pairs;
        let height = |blade: &usize| top.amplitudes_m[*blade];
        row.blade = (0..top.amplitudes_m.len())
            .max_by(|a, b| height(a).total_cmp(&height(b)))
            .expect("blades");
        let has_friction = matches!(condition, Condition::Friction(_));
        if has_friction && pattern.is_multiple_of(CHECKED) {
            let more = Period::new(&harmonics(condition, HIGHEST_OF_CHECK), SAMPLES);
            let start = padded(&top.motion, &period, &more);
            let sector = sectors.with(row.modes);
            let checked = peak(sector, &case, &more, top.frequency_hz, Some(&start));
            let height = checked.map(|own| own.top.amplitude_m());
            row.change_by_harmonics = height.map(|own| own / top.amplitude_m() - 1.0);
        }
    }
    row.seconds = began.elapsed().as_secs_f64();
    row
}
