//! One random stream per pattern, so that a pattern depends on nothing but the seed and its id.

use chacha20::ChaCha8Rng;
use rand::SeedableRng;

/// Name of the generator in manifests; a change of the numbers it gives changes the name.
pub const GENERATOR: &str = "ChaCha8, seed_from_u64(seed), stream = pattern id; rand_distr 0.6";

/// The stream of `pattern` under `seed`.
///
/// The seed is spread over the 256-bit key of the cipher and the pattern id is its 64-bit nonce
/// (Bernstein 2008, `ChaCha`, a variant of Salsa20): streams of different patterns never overlap,
/// and neither order nor thread count can change one.
#[must_use]
pub fn pattern_stream(seed: u64, pattern: u32) -> ChaCha8Rng {
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    stream.set_stream(u64::from(pattern));
    stream
}

/// The stream of the contact parameter at `place` of all (`ContactQuantity::ALL`), of `pattern`: streams of blades have numbers below
/// 2^32, these the second highest bit and the place above the id.
#[must_use]
pub fn contact_stream(seed: u64, place: usize, pattern: u32) -> ChaCha8Rng {
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    stream.set_stream(1 << 62 | (place as u64) << 32 | u64::from(pattern));
    stream
}
