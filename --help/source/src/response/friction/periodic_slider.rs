//! The periodic state of one Jenkins element (spring in series with a Coulomb slider), in closed
//! form.
//!
//! The tangential force is `T_j = kt x_j + y_j`; the offset `y` of the slider stays where it is
//! unless the limit pushes it, `y_j = clip(y_{j-1}, a_j, b_j)` with
//!
//! ```text
//! a_j = -mu N_j - kt x_j,    b_j = mu N_j - kt x_j,    a_j <= b_j since N_j >= 0.
//! ```
//!
//! A chain of clips is a clip: `clip(clip(y, L, H), a, b) = clip(y, clip(L, a, b), clip(H, a, b))`.
//! One period thus maps `y` to `clip(y, L, H)`, and its fixed points are `[L, H]`:
//!
//! * `max a <= min b`: `[L, H] = [max a, min b]`, the slider sticks for good and `y` is the point
//!   nearest to 0;
//! * otherwise `L = H`: every history ends in the one periodic state that passes through `y = L` at
//!   the period's end.
//!
//! Clips are exact in floating point, so the state closes to the last bit and no warm-up periods
//! are marched. Where `y` was last clipped at sample r, at the bound of sign s (+1 for `b`, -1 for
//! `a`), its derivative is exact:
//!
//! ```text
//! y_j = -kt x_r + s mu N_r,    dy_j = -kt dx_r + s mu dN_r.
//! ```
//!
//! The transitions between stick, slip and separation are those of Yang, Chu & Menq (1998).

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use crate::linalg::{Loops, vectorized};

/// Stretches of the period that are marched side by side: the chain of clips is bound by latency,
/// not by work.
const STRETCHES: usize = 4;

/// Offset history and clips of one slider; its buffers are reused from call to call.
///
/// Forces are in N, displacements in m; every history has `n_samples` equidistant samples of one
/// period.
#[derive(Debug, Clone)]
pub struct PeriodicSlider {
    lower: Vec<f64>,
    upper: Vec<f64>,
    offset: Vec<f64>,
    slipping: bool,
    clip_samples: Vec<usize>,
    clip_signs: Vec<f64>,
    n_clips: usize,
}

impl PeriodicSlider {
    /// Buffers for histories of `n_samples` samples.
    #[must_use]
    pub fn new(n_samples: usize) -> Self {
        Self {
            lower: vec![0.0; n_samples],
            upper: vec![0.0; n_samples],
            offset: vec![0.0; n_samples],
            slipping: false,
            clip_samples: vec![0; n_samples],
            clip_signs: vec![0.0; n_samples],
            n_clips: 0,
        }
    }

    /// Solves for the periodic offset; returns whether the slider slips at any sample.
    ///
    /// `displacement_m` (`n_samples`) is the tangential displacement, `normal_load_n` (`n_samples`,
    /// all >= 0) the normal load. Values that are not finite are not reported here: the linear part
    /// of the force carries them on.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn solve(
        &mut self,
        tangential_stiffness_n_per_m: f64,
        friction_coefficient: f64,
        displacement_m: &[f64],
        normal_load_n: &[f64],
    ) -> bool {
        assert_eq!(
            displacement_m.len(),
            self.offset.len(),
            "samples of the displacement"
        );
        assert_eq!(
            normal_load_n.len(),
            self.offset.len(),
            "samples of the normal load"
        );
        vectorized(Solve {
            slider: self,
            kt: tangential_stiffness_n_per_m,
            mu: friction_coefficient,
            x: displacement_m,
            load: normal_load_n,
        });
        self.slipping
    }

    /// Solves for the periodic offset under a displacement that besides grows steadily by `drift_m`
    /// per period; returns whether the slider slips at any sample.
    ///
    /// Periodic is then the force, not the position of the slider: `y_j = clip(y_{j-1} + kt drift/n,
    /// a_j, b_j)` with the bounds of the periodic part of the displacement. One period maps y to
    /// `clip(y + kt drift, L, H)`, so with a drift forwards every history ends at `y = H`, where the
    /// chain started from infinity ends; backwards at L. The derivative at a given drift is that of
    /// the clips.
    ///
    /// # Panics
    /// A history does not have `n_samples` samples.
    pub fn solve_drifting(
        &mut self,
        tangential_stiffness_n_per_m: f64,
        friction_coefficient: f64,
        displacement_m: &[f64],
        normal_load_n: &[f64],
        drift_m: f64,
    ) -> bool {
        let slipping = self.solve(
            tangential_stiffness_n_per_m,
            friction_coefficient,
            displacement_m,
            normal_load_n,
        );
        let growth = tangential_stiffness_n_per_m * drift_m / self.offset.len() as f64;
        if growth == 0.0 {
            return slipping;
        }
        let mut y = f64::INFINITY.copysign(growth);
        // First to where the histories end, then through the period.
        for _ in 0..2 {
            let bounds = self.lower.iter().zip(&self.upper);
            for (offset, (&a, &b)) in self.offset.iter_mut().zip(bounds) {
                y = clip(y + growth, a, b);
                *offset = y;
            }
        }
        self.slipping = true;
        true
    }

    /// Sets the slider to rest: zero offset at every sample, no clips.
    pub fn rest(&mut self) {
        self.offset.fill(0.0);
        self.slipping = false;
        self.n_clips = 0;
    }

    /// Finds the clips of the state last solved for: all that the derivative needs.
    ///
    /// A slider sticking with zero offset has none; one sticking with another offset has one, the
    /// first sample that attains the bound.
    pub fn locate_clips(&mut self) {
        let n_samples = self.offset.len();
        let mut n_clips = 0;
        if self.slipping {
            let (lower, upper) = (&self.lower[..n_samples], &self.upper[..n_samples]);
            for (j, &y) in self.offset.iter().enumerate() {
                // lower <= y <= upper always, so these are equalities.
                let at_lower = y <= lower[j];
                let at_upper = y >= upper[j];
                self.clip_samples[n_clips] = j;
                // Both bounds at once: no normal load, hence no limit that could move.
                self.clip_signs[n_clips] = f64::from(i8::from(at_upper) - i8::from(at_lower));
                n_clips += usize::from(at_lower | at_upper);
            }
        } else {
            let y = self.offset.first().copied().unwrap_or(0.0);
            let clip = if y > 0.0 {
                self.lower.iter().position(|&a| a >= y).map(|j| (j, -1.0))
            } else if y < 0.0 {
                self.upper.iter().position(|&b| b <= y).map(|j| (j, 1.0))
            } else {
                None
            };
            if let Some((j, sign)) = clip {
                self.clip_samples[0] = j;
                self.clip_signs[0] = sign;
                n_clips = 1;
            }
        }
        self.n_clips = n_clips;
    }

    /// Offset `y_j` = `T_j - kt x_j`, N (`n_samples`): the correction to the force of the stuck
    /// spring.
    #[must_use]
    pub fn offset_n(&self) -> &[f64] {
        &self.offset
    }

    /// Whether the slider slips at any sample of the period.
    #[must_use]
    pub fn is_slipping(&self) -> bool {
        self.slipping
    }

    /// Samples r at which the offset is clipped, ascending; clip i rules the samples from `r_i` up
    /// to the one before `r_{i+1}`, the last one across the end of the period. Empty until
    /// [`Self::locate_clips`] is called.
    #[must_use]
    pub fn clip_samples(&self) -> &[usize] {
        &self.clip_samples[..self.n_clips]
    }

    /// Signs s of the clips: +1 at the upper bound, -1 at the lower one, 0 where both coincide (no
    /// normal load).
    #[must_use]
    pub fn clip_signs(&self) -> &[f64] {
        &self.clip_signs[..self.n_clips]
    }

    /// Fills `a` and `b`; returns `(max a, min b)`.
    #[inline(always)]
    fn bound(&mut self, kt: f64, mu: f64, x: &[f64], load: &[f64]) -> (f64, f64) {
        const LANES: usize = 4;
        let mut highest_lower = [f64::NEG_INFINITY; LANES];
        let mut lowest_upper = [f64::INFINITY; LANES];
        let chunks = self
            .lower
            .chunks_mut(LANES)
            .zip(self.upper.chunks_mut(LANES));
        for ((a, b), (x, load)) in chunks.zip(x.chunks(LANES).zip(load.chunks(LANES))) {
            for (lane, ((a, b), (&x, &load))) in
                a.iter_mut().zip(b).zip(x.iter().zip(load)).enumerate()
            {
                let (limit, elastic) = (mu * load, kt * x);
                *a = -limit - elastic;
                *b = limit - elastic;
                highest_lower[lane] = larger(*a, highest_lower[lane]);
                lowest_upper[lane] = smaller(*b, lowest_upper[lane]);
            }
        }
        (
            highest_lower.into_iter().fold(f64::NEG_INFINITY, larger),
            lowest_upper.into_iter().fold(f64::INFINITY, smaller),
        )
    }

    /// Fills the offsets of a slipping slider.
    #[inline(always)]
    fn march(&mut self) {
        let length = self.offset.len() / STRETCHES;
        let (lower, lower_rest) = self.lower.split_at(STRETCHES * length);
        let (upper, upper_rest) = self.upper.split_at(STRETCHES * length);
        let (offset, offset_rest) = self.offset.split_at_mut(STRETCHES * length);
        let lower = stretches(lower, length);
        let upper = stretches(upper, length);

        // The clip that each stretch amounts to, then the one of the period: a point, for the
        // slider slips.
        let mut low = [f64::NEG_INFINITY; STRETCHES];
        let mut high = [f64::INFINITY; STRETCHES];
        for i in 0..length {
            for s in 0..STRETCHES {
                low[s] = clip(low[s], lower[s][i], upper[s][i]);
                high[s] = clip(high[s], lower[s][i], upper[s][i]);
            }
        }
        let mut y = 0.0;
        for (&a, &b) in low
            .iter()
            .zip(&high)
            .chain(lower_rest.iter().zip(upper_rest))
        {
            y = clip(y, a, b);
        }

        let mut state = [0.0; STRETCHES];
        for s in 0..STRETCHES {
            state[s] = y;
            y = clip(y, low[s], high[s]);
        }
        let [first, second, third, fourth] = stretches_mut(offset, length);
        for i in 0..length {
            for s in 0..STRETCHES {
                state[s] = clip(state[s], lower[s][i], upper[s][i]);
            }
            [first[i], second[i], third[i], fourth[i]] = state;
        }
        for (offset, (&a, &b)) in offset_rest
            .iter_mut()
            .zip(lower_rest.iter().zip(upper_rest))
        {
            y = clip(y, a, b);
            *offset = y;
        }
    }
}

/// What [`PeriodicSlider::solve`] is asked for.
struct Solve<'a> {
    slider: &'a mut PeriodicSlider,
    kt: f64,
    mu: f64,
    x: &'a [f64],
    load: &'a [f64],
}

impl Loops for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            slider,
            kt,
            mu,
            x,
            load,
        } = self;
        let (highest_lower, lowest_upper) = slider.bound(kt, mu, x, load);
        slider.n_clips = 0;
        slider.slipping = highest_lower > lowest_upper;
        if slider.slipping {
            slider.march();
        } else {
            slider.offset.fill(clip(0.0, highest_lower, lowest_upper));
        }
    }
}

/// `values` (`STRETCHES * length`) cut into its stretches.
fn stretches(values: &[f64], length: usize) -> [&[f64]; STRETCHES] {
    std::array::from_fn(|s| &values[s * length..][..length])
}

/// `values` (`STRETCHES * length`) cut into its stretches, to be written to.
fn stretches_mut(values: &mut [f64], length: usize) -> [&mut [f64]; STRETCHES] {
    let (first, rest) = values.split_at_mut(length);
    let (second, rest) = rest.split_at_mut(length);
    let (third, fourth) = rest.split_at_mut(length);
    [first, second, third, fourth]
}

/// `y` confined to `[a, b]`; plain comparisons, each of which is one machine instruction.
#[inline(always)]
fn clip(y: f64, a: f64, b: f64) -> f64 {
    smaller(b, larger(a, y))
}

#[inline(always)]
fn larger(a: f64, y: f64) -> f64 {
    if a > y { a } else { y }
}

#[inline(always)]
fn smaller(b: f64, y: f64) -> f64 {
    if b < y { b } else { y }
}
