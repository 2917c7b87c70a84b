//! Known laws to draw from: bounded, unbounded, heavy, and with atoms.

use blisk::population::statistics::resampling_stream;
use rand::RngExt;

/// A law by its quantile function; with atoms where that is constant.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    Uniform,
    Exponential,
    /// Largest values, bounded above, shape -0.2.
    Bounded,
    /// Pareto with exponent 1.5: no variance.
    Heavy,
    /// The bounded law rounded to steps of 0.25.
    Rounded,
    /// 0 with probability 0.6, 1 with 0.36, 2 with the rest.
    Atoms,
}

pub const LAWS: [Law; 6] = [
    Law::Uniform,
    Law::Exponential,
    Law::Bounded,
    Law::Heavy,
    Law::Rounded,
    Law::Atoms,
];

impl Law {
    /// The left-continuous inverse of the distribution function.
    pub fn quantile(self, p: f64) -> f64 {
        match self {
            Self::Uniform => p,
            Self::Exponential => -(-p).ln_1p(),
            Self::Bounded => (1.0 - (-p.ln()).powf(0.2)) / 0.2,
            Self::Heavy => (1.0 - p).powf(-1.0 / 1.5),
            Self::Rounded => (Self::Bounded.quantile(p) * 4.0).round() / 4.0,
            Self::Atoms => f64::from(u8::from(p > 0.6) + u8::from(p > 0.96)),
        }
    }
}

/// Uniform numbers between 0 and 1, of replica `replica`.
pub fn uniform(replica: u64, n: usize) -> Vec<f64> {
    let mut stream = resampling_stream(replica, 1234, 0);
    (0..n).map(|_| stream.random_range(1e-16..1.0)).collect()
}

/// Sorted values of the law.
pub fn sample(law: Law, replica: u64, n: usize) -> Vec<f64> {
    let mut values: Vec<f64> = uniform(replica, n)
        .into_iter()
        .map(|u| law.quantile(u))
        .collect();
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// Pairs of uniform numbers whose normal scores have the correlation `rho`.
pub fn correlated(replica: u64, n: usize, rho: f64) -> (Vec<f64>, Vec<f64>) {
    let mut stream = resampling_stream(replica, 4321, 0);
    let normal = statrs::distribution::Normal::standard();
    let phi = |x: f64| {
        use statrs::distribution::ContinuousCDF;
        normal.cdf(x).clamp(1e-16, 1.0 - 1e-16)
    };
    (0..n)
        .map(|_| {
            let x: f64 = stream.sample(rand_distr::StandardNormal);
            let z: f64 = stream.sample(rand_distr::StandardNormal);
            (phi(x), phi(rho * x + (1.0 - rho * rho).sqrt() * z))
        })
        .unzip()
}
