//! Damage and forgery of stored files, for the tests of several binaries.

use std::path::Path;

use serde_json::Value;

/// Numbers without pattern to the eye (Steele et al. 2014, `splitmix64`).
pub struct Numbers(pub u64);

impl Numbers {
    /// The next one, from 0 to `bound` without it.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

/// Changes a file that ends in a checksum of itself, and makes that checksum fit again.
pub fn forge(path: &Path, change: impl FnOnce(&mut Value)) {
    let text = std::fs::read_to_string(path).expect("read");
    let mut value: Value = serde_json::from_str(&text).expect("JSON");
    value.as_object_mut().expect("an object").remove("checksum");
    change(&mut value);
    let text = serde_json::to_string_pretty(&value).expect("JSON");
    let body = text.strip_suffix("\n}").expect("an object");
    let checksum = blake3::hash(body.as_bytes()).to_hex();
    let whole = format!("{body},\n  \"checksum\": \"{checksum}\"\n}}\n");
    std::fs::write(path, whole).expect("written");
}
