//! The periodic state of a slider in the tangential plane: an isotropic spring in series with
//! Coulomb friction whose limit is a circle.
//!
//! The tangential force is `T_j = kt x_j + y_j` in both directions (`x`, `y`, `T` are plane
//! vectors). The offset `y` stays where it is unless the limit pushes it: with the trial force
//! `d = y_{j-1} + kt x_j` and `R_j = mu N_j`,
//!
//! ```text
//! |d| <= R_j:  y_j = y_{j-1}                          sticks
//! |d| >  R_j:  y_j = R_j n - kt x_j,   n = d / |d|    slips, against the force
//! ```
//!
//! the projection of `y_{j-1}` on the disk of radius `R_j` round `-kt x_j`, which is the implicit
//! step of Coulomb's slip law in the plane. It is the discrete form of the contact kinematics of
//! Yang & Menq (1998): stick, slip and separation with both tangents coupled.
//!
//! **Periodic state.** One period is a chain of projections, so it brings no two histories further
//! apart. If the disks have a point in common the slider ends there and sticks for good; else all
//! histories end in one periodic state, for a projection on a disk draws everything outside it
//! strictly together. The disks' intersection is no disk, so unlike
//! [`PeriodicSlider`](super::PeriodicSlider) there is no closed form: periods are marched from
//! `y = 0` until the slider sticks throughout a period or the period closes. Where the slip is much
//! shorter than `R / kt`, offsets across the slip fade slowly; so from the second period on each
//! is followed by a share `f` of a Newton step on `P(y) - y = 0` for the map `P` of the period,
//!
//! ```text
//! y <- y + f s,    s = (I - P'(y))^-1 (P(y) - y)
//! ```
//!
//! `f` is the first of 1, 1/2, 1/4, ... after which the next step with the same derivative would be
//! shorter (natural monotonicity test, Deuflhard 2004, section 3.3). The distance `|P(y) - y|` is no
//! measure: where the slip is short it tells little of the offset across it, and whole steps that
//! enlarge it go to and fro for good. Where no `f` serves, the marched `P(y)` follows. Motion along
//! one line from rest reaches its state within the first period, as in `PeriodicSlider`. Where the
//! slider sticks for good, its offset is the one at which this march arrives; only its mean, which
//! the displacements without their means do not determine, depends on it.
//!
//! **Derivative**, exact for the discrete map, with `m` at right angles to `n`, `lost = (|d| -
//! R)/|d|`:
//!
//! ```text
//! dy_j = A dy_{j-1} - (I - A) kt dx_j + n dR_j,    A = (1 - lost) m m^T,    I - A = n n^T + lost m m^T
//! ```

/// Periods marched at most; a state that has not closed by then is reported as such.
const MAX_PERIODS: usize = 200;

/// Distance over a period, relative to the largest elastic force `kt |x|`, up to which the state
/// counts as closed and slip as none.
const CLOSURE: f64 = 1e-13;

/// Start of the march under a drift, in units of the largest forces.
const FAR_AHEAD: f64 = 1e3;

/// Share of a Newton step below which none is tried.
const LEAST_SHARE: f64 = 1.0 / 64.0;
/// A share f of a step is kept if the next step with the same derivative is at most `1 - f / 4` as long.
const SHORTENED: f64 = 0.25;

/// One sample at which the slider slips, and the derivative of its projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    /// Sample at which it slips.
    pub sample: usize,
    /// Direction `n` of the force.
    pub direction: [f64; 2],
    /// `(|d| - R) / |d|`, in (0, 1].
    pub lost: f64,
}

impl Slip {
    /// `m`, at right angles to [`Self::direction`].
    #[must_use]
    pub fn across(&self) -> [f64; 2] {
        [-self.direction[1], self.direction[0]]
    }
}

/// Offset history and slips of one slider; its buffers are reused from call to call.
///
/// Forces are in N, displacements in m; every history has `n_samples` equidistant samples of one
/// period.
#[derive(Debug, Clone)]
pub struct CoupledSlider {
    n_samples: usize,
    /// Along t1, then t2 (`2 * n_samples`).
    offset: Vec<f64>,
    slips: Vec<Slip>,
    /// `I - P'` of the period last marched, row after row.
    lost: [[f64; 2]; 2],
    slipping: bool,
    closed: bool,
    periods: usize,
}

/// A marched period.
struct Period {
    end: [f64; 2],
    /// Path of the slips, as a force.
    slipped: f64,
}

/// A share of a Newton step that is tried.
struct Trial {
    start: [f64; 2],
    /// Where the period from `start` ended.
    marched: [f64; 2],
    /// `I - P'` of that period.
    lost: [[f64; 2]; 2],
    step: [f64; 2],
    share: f64,
}

/// Where the next period starts, and what is tried by that; nothing where it is only marched on.
type Next = ([f64; 2], Option<Trial>);

impl Trial {
    /// The whole step after a period from `start` to `marched`; no step where the derivative has none.
    fn whole(start: [f64; 2], marched: [f64; 2], lost: [[f64; 2]; 2]) -> Next {
        let change = [0, 1].map(|axis| marched[axis] - start[axis]);
        match solve2(lost, change) {
            None => (marched, None),
            Some(step) => Self {
                start,
                marched,
                lost,
                step,
                share: 1.0,
            }
            .next(),
        }
    }

    /// Half the share, or where the period ended below the least one.
    fn halved(self) -> Next {
        let share = 0.5 * self.share;
        if share < LEAST_SHARE {
            return (self.marched, None);
        }
        Self { share, ..self }.next()
    }

    fn next(self) -> Next {
        let offset = [0, 1].map(|axis| self.start[axis] + self.share * self.step[axis]);
        (offset, Some(self))
    }

    /// Whether the share is kept, from which on a period changes the offset by `change`.
    fn is_kept(&self, change: [f64; 2]) -> bool {
        let next = solve2(self.lost, change);
        next.is_some_and(|next| norm(next) <= (1.0 - SHORTENED * self.share) * norm(self.step))
    }
}

impl CoupledSlider {
    /// Buffers for histories of `n_samples` samples.
    #[must_use]
    pub fn new(n_samples: usize) -> Self {
        Self {
            n_samples,
            offset: vec![0.0; 2 * n_samples],
            slips: Vec::with_capacity(n_samples),
            lost: [[0.0; 2]; 2],
            slipping: false,
            closed: true,
            periods: 0,
        }
    }

    /// Solves for the periodic offset; returns whether the slider slips at any sample.
    ///
    /// `displacement_m` (`n_samples` along either tangent) is the tangential displacement,
    /// `normal_load_n` (`n_samples`, all >= 0) the normal load. Values that are not finite are not
    /// reported here: the linear part of the force carries them on.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn solve(
        &mut self,
        tangential_stiffness_n_per_m: f64,
        friction_coefficient: f64,
        displacement_m: [&[f64]; 2],
        normal_load_n: &[f64],
    ) -> bool {
        self.solve_drifting(
            tangential_stiffness_n_per_m,
            friction_coefficient,
            displacement_m,
            normal_load_n,
            [0.0; 2],
        )
    }

    /// Solves for the periodic offset under a displacement that besides grows steadily by `drift_m` per period,
    /// in either direction; returns whether the slider slips at any sample.
    ///
    /// Periodic is then the force: the offset grows by `kt drift / n` before every sample. The march
    /// starts far ahead of the drift, whence it reaches at once the points of the disks that lie
    /// furthest ahead, to which a small drift would drag the slider in many periods.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn solve_drifting(
        &mut self,
        tangential_stiffness_n_per_m: f64,
        friction_coefficient: f64,
        displacement_m: [&[f64]; 2],
        normal_load_n: &[f64],
        drift_m: [f64; 2],
    ) -> bool {
        for history in [displacement_m[0], displacement_m[1], normal_load_n] {
            assert_eq!(history.len(), self.n_samples, "samples of a history");
        }
        let (kt, mu) = (tangential_stiffness_n_per_m, friction_coefficient);
        self.rest();
        let largest = displacement_m[0]
            .iter()
            .zip(displacement_m[1])
            .map(|(x1, x2)| x1 * x1 + x2 * x2)
            .fold(0.0, |largest, square| {
                // Not f64::max, which would lose what is not a number.
                if square <= largest { largest } else { square }
            })
            .sqrt();
        if !largest.is_finite() {
            return false;
        }
        let negligible = CLOSURE * kt * largest;
        let growth = drift_m.map(|drift| kt * drift / self.n_samples as f64);
        let drift = norm(drift_m);
        let ahead = if drift > 0.0 {
            let limit = mu * normal_load_n.iter().copied().fold(0.0, f64::max);
            FAR_AHEAD * (kt * largest + limit) / drift
        } else {
            0.0
        };
        let mut start = drift_m.map(|drift| ahead * drift);
        let mut tried: Option<Trial> = None;
        self.closed = false;
        while self.periods < MAX_PERIODS {
            self.periods += 1;
            let histories = (displacement_m, normal_load_n);
            let period = self.march((kt, mu), histories, start, growth);
            let marched = period.end;
            let change = [marched[0] - start[0], marched[1] - start[1]];
            if period.slipped <= negligible && drift == 0.0 {
                self.closed = true;
                break;
            }
            if norm(change) <= negligible {
                self.closed = true;
                self.slipping = true;
                break;
            }
            (start, tried) = match tried.take() {
                Some(trial) if !trial.is_kept(change) => trial.halved(),
                _ if self.periods == 1 => (marched, None),
                _ => Trial::whole(start, marched, self.lost),
            };
        }
        if self.closed && !self.slipping {
            self.slips.clear();
        }
        self.slipping |= !self.closed;
        self.slipping
    }

    /// Sets the slider to rest: zero offset at every sample, no slips.
    pub fn rest(&mut self) {
        if self.periods == 0 {
            // At rest since it was made, or put to rest.
            return;
        }
        self.offset.fill(0.0);
        self.slips.clear();
        self.slipping = false;
        self.closed = true;
        self.periods = 0;
    }

    /// Offset `y_j` = `T_j - kt x_j` along t1 and t2, N (`n_samples` each): the correction to the
    /// force of the stuck spring.
    #[must_use]
    pub fn offset_n(&self) -> [&[f64]; 2] {
        let (first, second) = self.offset.split_at(self.n_samples);
        [first, second]
    }

    /// Both offset histories, that along t1 first (`2 * n_samples`).
    #[must_use]
    pub fn offsets_n(&self) -> &[f64] {
        &self.offset
    }

    /// Whether the slider slips at any sample of the period.
    #[must_use]
    pub fn is_slipping(&self) -> bool {
        self.slipping
    }

    /// Whether the state is periodic: marching one more period changes it by no more than 1e-13 of
    /// the largest elastic force. If not, the offset is that of the last period marched.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Periods marched to find the state.
    #[must_use]
    pub fn periods(&self) -> usize {
        self.periods
    }

    /// Slips of the period, ascending; slip i rules the samples from its own up to the one before
    /// the next slip, the last one across the end of the period.
    #[must_use]
    pub fn slips(&self) -> &[Slip] {
        &self.slips
    }

    /// `(I - P')^-1 v` for the map P of the period; none where the slider does not slip.
    #[must_use]
    pub fn close(&self, v: [f64; 2]) -> Option<[f64; 2]> {
        solve2(self.lost, v)
    }

    /// One period from the offset `start`, which grows by `growth` per sample: fills offsets, slips and `I - P'`.
    fn march(
        &mut self,
        (kt, mu): (f64, f64),
        (x, load): ([&[f64]; 2], &[f64]),
        start: [f64; 2],
        growth: [f64; 2],
    ) -> Period {
        let [mut y1, mut y2] = start;
        let mut slipped = 0.0;
        let mut lost_before = [[0.0; 2]; 2];
        self.slips.clear();
        let (first, second) = self.offset.split_at_mut(self.n_samples);
        let histories = x[0].iter().zip(x[1]).zip(load);
        let offsets = first.iter_mut().zip(second);
        for (sample, (((&x1, &x2), &load), (out1, out2))) in histories.zip(offsets).enumerate() {
            let (elastic1, elastic2, limit) = (kt * x1, kt * x2, mu * load);
            (y1, y2) = (y1 + growth[0], y2 + growth[1]);
            let (d1, d2) = (y1 + elastic1, y2 + elastic2);
            let square = d1 * d1 + d2 * d2;
            if square > limit * limit {
                let length = square.sqrt();
                // Rounding can make the two equal.
                if length > limit {
                    let direction = [d1 / length, d2 / length];
                    let lost = (length - limit) / length;
                    y1 = limit * direction[0] - elastic1;
                    y2 = limit * direction[1] - elastic2;
                    slipped += length - limit;
                    let slip = Slip {
                        sample,
                        direction,
                        lost,
                    };
                    lost_before = lost_after(&slip, lost_before);
                    self.slips.push(slip);
                }
            }
            (*out1, *out2) = (y1, y2);
        }
        self.lost = lost_before;
        Period {
            end: [y1, y2],
            slipped,
        }
    }
}

/// `I - A M = (I - A) + A (I - M)`, without the cancellation of a difference from I.
fn lost_after(slip: &Slip, before: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let (n, m, lost) = (slip.direction, slip.across(), slip.lost);
    let across: [f64; 2] = std::array::from_fn(|k| {
        lost * m[k] + (1.0 - lost) * (m[0] * before[0][k] + m[1] * before[1][k])
    });
    std::array::from_fn(|i| std::array::from_fn(|k| n[i] * n[k] + m[i] * across[k]))
}

/// Solution of `matrix z = v`; none if it is singular.
fn solve2(matrix: [[f64; 2]; 2], v: [f64; 2]) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    let solution = [
        (d * v[0] - b * v[1]) / determinant,
        (a * v[1] - c * v[0]) / determinant,
    ];
    solution.iter().all(|z| z.is_finite()).then_some(solution)
}

fn norm(v: [f64; 2]) -> f64 {
    (v[0] * v[0] + v[1] * v[1]).sqrt()
}
