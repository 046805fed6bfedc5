//! The hash of names of files and of the sources of a build: FNV-1a with 128 bits. It does not depend on the version of
//! Rust. The build script includes this file.

/// A hash of bytes that arrive in parts.
pub struct Hash(u128);

impl Hash {
    /// The hash of no bytes.
    pub fn new() -> Self {
        Hash(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    /// Adds a part. Its length is added too, so that the limits between parts change the hash.
    pub fn add(&mut self, part: &[u8]) {
        let length = (part.len() as u64).to_le_bytes();
        for byte in length.iter().chain(part) {
            self.0 ^= u128::from(*byte);
            self.0 = self.0.wrapping_mul(0x0100_0000_0000_0000_0000_013b);
        }
    }

    /// The hash as 32 hexadecimal digits.
    pub fn digits(&self) -> String {
        format!("{:032x}", self.0)
    }
}
