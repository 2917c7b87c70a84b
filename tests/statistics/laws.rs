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
    /// Logarithm normal with standard deviation 0.5.
    Lognormal,
    /// Weibull of shape 2, mirrored: bounded above by 3.
    Weibull,
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
            Self::Lognormal => {
                use statrs::distribution::ContinuousCDF;
                (0.5 * statrs::distribution::Normal::standard().inverse_cdf(p)).exp()
            }
            Self::Weibull => 3.0 - (-p.ln()).sqrt(),
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

/// How two uniform numbers depend on each other.
#[derive(Clone, Copy, Debug)]
pub enum Copula {
    /// Clayton with this parameter: low values go together.
    Clayton(f64),
    /// Its mirror image: high values go together.
    SurvivalClayton(f64),
    /// Student's t with this correlation and 4 degrees of freedom: both ends go together.
    StudentT(f64),
}

impl Copula {
    /// Pairs of uniform numbers of replica `replica`.
    pub fn pairs(self, replica: u64, n: usize) -> (Vec<f64>, Vec<f64>) {
        use rand_distr::{ChiSquared, Exp1, Gamma, StandardNormal};
        use statrs::distribution::{ContinuousCDF, StudentsT};
        let mut stream = resampling_stream(replica, 8765, 0);
        let inside = |u: f64| u.clamp(1e-16, 1.0 - 1e-16);
        let student = StudentsT::new(0.0, 1.0, 4.0).expect("a law");
        let chi = ChiSquared::new(4.0).expect("a law");
        let mut clayton = |theta: f64| -> (f64, f64) {
            let gamma = Gamma::new(1.0 / theta, 1.0).expect("a shape");
            let frailty: f64 = stream.sample(gamma);
            let [u, v] = [stream.sample(Exp1), stream.sample(Exp1)]
                .map(|exponential: f64| inside((1.0 + exponential / frailty).powf(-1.0 / theta)));
            (u, v)
        };
        match self {
            Self::Clayton(theta) => (0..n).map(|_| clayton(theta)).unzip(),
            Self::SurvivalClayton(theta) => (0..n)
                .map(|_| {
                    let (u, v) = clayton(theta);
                    (inside(1.0 - u), inside(1.0 - v))
                })
                .unzip(),
            Self::StudentT(rho) => (0..n)
                .map(|_| {
                    let x: f64 = stream.sample(StandardNormal);
                    let z: f64 = stream.sample(StandardNormal);
                    let chi: f64 = stream.sample(chi);
                    let scale = (4.0 / chi).sqrt();
                    let y = rho * x + (1.0 - rho * rho).sqrt() * z;
                    (
                        inside(student.cdf(scale * x)),
                        inside(student.cdf(scale * y)),
                    )
                })
                .unzip(),
        }
    }
}
