//! Random streams of resamples: seeded by the study, apart from those of its patterns.

use chacha20::ChaCha8Rng;
use rand::SeedableRng;

/// Resamples behind every interval and probability that is bootstrapped.
pub const RESAMPLES: u32 = 2000;

/// The stream of one resample. Streams of patterns have numbers below 2^32, those of resamples the
/// highest bit, so that no two ever overlap (Bernstein 2008).
#[must_use]
pub fn resampling_stream(seed: u64, topic: u32, resample: u32) -> ChaCha8Rng {
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    stream.set_stream(1 << 63 | u64::from(topic) << 32 | u64::from(resample));
    stream
}
