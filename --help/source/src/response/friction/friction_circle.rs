//! Friction of both tangents together on the circle `|T| <= mu N`, exact on a straight step.
//!
//! Over a step, `s` from 0 to 1, path `p` and limit `R(s) = R0 + s (R1 - R0)`:
//!
//! ```text
//! stick    T(s) = T0 + s kt p,    until |T(s)| = R(s)
//! slip     T = R e(theta),  e at the angle theta from p:
//!          R theta' = -kt |p| sin(theta)
//!          tan(theta1/2) = tan(theta0/2) exp(-kt |p| (1 - s0) ln(R1/R) / (R1 - R))
//! ```
//!
//! Slip goes on while `kt |p| cos(theta) > R1 - R0`; on a straight step theta falls, so slip once
//! begun lasts to the end of the step. `|T(s)| - R(s)` of a sticking pair is convex, so it slips if
//! and only if the trial force at the end lies outside (friction circle of Yang & Menq 1998).

/// Friction at the end of the step and whether it slipped; `start` lies within the circle of radius
/// `limits[0] >= 0`, `limits[1] > 0`, `trial_path` is `kt p`; all in N.
pub(super) fn slide_on_circle(
    start: [f64; 2],
    trial_path: [f64; 2],
    limits: [f64; 2],
) -> ([f64; 2], bool) {
    let after = |share: f64| [0, 1].map(|axis| start[axis] + share * trial_path[axis]);
    let trial = after(1.0);
    if norm(trial) <= limits[1] {
        return (trial, false);
    }
    let begin = slip_begin(start, trial_path, limits);
    let limit = limits[0] + begin * (limits[1] - limits[0]);
    let remaining = (1.0 - begin) * norm(trial_path);
    if remaining <= 0.0 {
        return (trial.map(|t| limits[1] / norm(trial) * t), true);
    }
    let direction = trial_path.map(|p| p / norm(trial_path));
    // From no load at all the force takes the direction of the path at once.
    let mut tangent = 0.0;
    if limit > 0.0 {
        let at = after(begin);
        let along = at[0] * direction[0] + at[1] * direction[1];
        let across = direction[0] * at[1] - direction[1] * at[0];
        tangent = (0.5 * across.atan2(along)).tan()
            * (-remaining * mean_inverse([limit, limits[1]])).exp();
    }
    let (sine, cosine) = (2.0 * tangent.atan()).sin_cos();
    let force = [
        limits[1] * (cosine * direction[0] - sine * direction[1]),
        limits[1] * (cosine * direction[1] + sine * direction[0]),
    ];
    (force, true)
}

/// Share of the step at which the sticking force leaves the circle, given that it ends outside:
/// the root of `a s^2 + 2 b s + c`, `c <= 0`, at which that turns positive.
fn slip_begin(start: [f64; 2], path: [f64; 2], [first, last]: [f64; 2]) -> f64 {
    let growth = last - first;
    let a = path[0] * path[0] + path[1] * path[1] - growth * growth;
    let b = start[0] * path[0] + start[1] * path[1] - first * growth;
    let c = (start[0] * start[0] + start[1] * start[1] - first * first).min(0.0);
    let root = (b * b - a * c).max(0.0).sqrt();
    let begin = if b > 0.0 {
        -c / (b + root)
    } else {
        (root - b) / a
    };
    // Without a path and a change of load, rounding alone lies outside: 0/0.
    if begin.is_finite() {
        begin.clamp(0.0, 1.0)
    } else {
        1.0
    }
}

/// Mean of `1/R` for R going linearly from `first` to `last`.
fn mean_inverse([first, last]: [f64; 2]) -> f64 {
    let growth = (last - first) / first;
    if growth.abs() < 1e-4 {
        (1.0 - growth / 2.0 + growth * growth / 3.0) / first
    } else {
        growth.ln_1p() / (last - first)
    }
}

fn norm([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Radial return in very many small steps.
    fn stepped(start: [f64; 2], path: [f64; 2], [first, last]: [f64; 2], steps: u32) -> [f64; 2] {
        let mut force = start;
        for step in 1..=steps {
            let share = f64::from(step) / f64::from(steps);
            let limit = first + share * (last - first);
            for (f, p) in force.iter_mut().zip(path) {
                *f += p / f64::from(steps);
            }
            let size = norm(force);
            if size > limit {
                force = force.map(|f| limit / size * f);
            }
        }
        force
    }

    #[test]
    fn the_exact_step_is_the_limit_of_small_radial_returns() {
        let mut seed = 1_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        let (mut slips, mut sticks) = (0, 0);
        for _ in 0..200 {
            let limits = [number().abs(), number().abs() + 0.01];
            let start = [0.7 * limits[0] * number(), 0.7 * limits[0] * number()];
            let path = [2.0 * number(), 2.0 * number()];
            let (found, slipped) = slide_on_circle(start, path, limits);
            let fine = stepped(start, path, limits, 20_000);
            let error = norm([found[0] - fine[0], found[1] - fine[1]]);
            assert!(
                error < 2e-4 * limits[1].max(1.0),
                "{error:e}: {start:?} {path:?} {limits:?}"
            );
            slips += i32::from(slipped);
            sticks += i32::from(!slipped);
        }
        assert!(slips > 50 && sticks > 10, "{slips} slips, {sticks} sticks");
    }

    #[test]
    fn a_step_in_two_halves_is_the_same_step() {
        let (start, path, limits) = ([0.3, -0.6], [0.9, 1.4], [0.8, 1.1]);
        let (whole, slipped) = slide_on_circle(start, path, limits);
        let middle = 0.5 * (limits[0] + limits[1]);
        let half = path.map(|p| 0.5 * p);
        let (first, _) = slide_on_circle(start, half, [limits[0], middle]);
        let (second, _) = slide_on_circle(first, half, [middle, limits[1]]);
        assert!(slipped && norm([whole[0] - second[0], whole[1] - second[1]]) < 1e-14);
    }

    #[test]
    fn along_one_line_the_circle_is_a_jenkins_element() {
        for (start, path, last) in [
            (0.5, 1.0, 0.8),
            (0.5, -2.0, 0.8),
            (0.5, 0.2, 0.8),
            (0.9, -0.1, 0.3),
        ] {
            let (found, slipped) = slide_on_circle([0.0, start], [0.0, path], [1.0, last]);
            let trial: f64 = start + path;
            assert!((found[1] - trial.clamp(-last, last)).abs() < 1e-15 && found[0].abs() < 1e-15);
            assert_eq!(slipped, trial.abs() > last);
        }
    }
}
