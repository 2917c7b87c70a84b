//! Transforms: sums against FFT, round trip, largest norm over a period.

use blisk::response::harmonic_balance::{HarmonicTransform, TransformError};

use super::random::Random;

const SETS: [&[usize]; 5] = [
    &[1],
    &[1, 3],
    &[1, 3, 5],
    &[0, 1, 2, 3, 4, 5, 6, 7],
    &[0, 2, 5, 6, 9, 11, 12, 13, 14, 15, 17, 19, 20],
];

#[test]
fn sums_and_fft_agree_and_invert_each_other() {
    let mut random = Random(11);
    for harmonics in SETS {
        for n_samples in [63, 128, 512] {
            for n_channels in [1, 3, 4] {
                let transform = HarmonicTransform::new(harmonics, n_samples).unwrap();
                let n = transform.n_coefficients();
                let mut scratch = transform.scratch();
                let coefficients = random.vector(n_channels * n, 1.0);
                let mut by_sums = vec![0.0; n_channels * n_samples];
                let (mut by_fft, mut automatic) = (by_sums.clone(), by_sums.clone());
                transform.synthesize_by_sums(&coefficients, &mut by_sums);
                transform.synthesize_by_fft(&coefficients, &mut by_fft, &mut scratch);
                transform.synthesize(&coefficients, &mut automatic, &mut scratch);
                let close =
                    |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
                assert!(close(&by_sums, &by_fft) && close(&by_sums, &automatic));

                let mut back = vec![0.0; n_channels * n];
                transform.project(&by_sums, &mut back, &mut scratch);
                assert!(close(&coefficients, &back));

                let noise = random.vector(n_channels * n_samples, 1.0);
                let mut other = back.clone();
                transform.project_by_sums(&noise, &mut back);
                transform.project_by_fft(&noise, &mut other, &mut scratch);
                assert!(close(&back, &other));
            }
        }
    }
}

#[test]
fn samples_are_the_fourier_series() {
    let transform = HarmonicTransform::new(&[0, 1, 3], 48).unwrap();
    let mut samples = vec![0.0; 48];
    transform.synthesize_by_sums(&[0.5, 1.0, -2.0, 0.25, 0.75], &mut samples);
    for (j, x) in samples.iter().enumerate() {
        let tau = std::f64::consts::TAU * j as f64 / 48.0;
        // Re((1 - 2i) e^{i tau}) = cos tau + 2 sin tau.
        let expected =
            0.5 + tau.cos() + 2.0 * tau.sin() + 0.25 * (3.0 * tau).cos() - 0.75 * (3.0 * tau).sin();
        assert!((x - expected).abs() < 1e-14);
    }
}

#[test]
fn cumulative_projection_is_that_of_a_step() {
    let transform = HarmonicTransform::new(&[0, 1, 4], 50).unwrap();
    let step: Vec<f64> = (0..50)
        .map(|j| f64::from(u8::from((7..31).contains(&j))))
        .collect();
    let mut coefficients = vec![0.0; 5];
    transform.project_by_sums(&step, &mut coefficients);
    for (c, coefficient) in coefficients.iter().enumerate() {
        let cumulative = transform.cumulative_projection(c);
        assert!((cumulative[31] - cumulative[7] - coefficient).abs() < 1e-15);
    }
}

#[test]
fn largest_norm_leaves_the_mean_out() {
    let transform = HarmonicTransform::new(&[0, 1, 2], 1024).unwrap();
    // x = 7 + 3 cos, y = -1 + 4 cos: the norm is 5 |cos|.
    let straight = [7.0, 3.0, 0.0, 0.0, 0.0, -1.0, 4.0, 0.0, 0.0, 0.0];
    assert!((transform.largest_norm(&straight) - 5.0).abs() < 1e-14);
    // x = cos + cos 2 tau: 2 at tau = 0.
    assert!((transform.largest_norm(&[0.0, 1.0, 0.0, 1.0, 0.0]) - 2.0).abs() < 1e-14);
    // A circle has the norm of its radius at every instant, though the fundamental's complex norm
    // is sqrt(2).
    let circle = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    assert!((transform.largest_norm(&circle) - 1.0).abs() < 1e-14);
}

#[test]
fn impossible_sets_are_refused() {
    let error =
        |harmonics: &[usize], samples| HarmonicTransform::new(harmonics, samples).unwrap_err();
    assert_eq!(
        error(&[1, 1], 64),
        TransformError::NotAscending {
            before: 1,
            after: 1
        }
    );
    assert_eq!(
        error(&[3, 1], 64),
        TransformError::NotAscending {
            before: 3,
            after: 1
        }
    );
    assert_eq!(
        error(&[1, 32], 64),
        TransformError::TooFewSamples {
            harmonic: 32,
            samples: 64
        }
    );
    assert_eq!(
        error(&[1, 32], 64).to_string(),
        "harmonic 32 needs more than 64 samples per period, not 64"
    );
}
