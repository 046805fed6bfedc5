//! Identifies the state for which a workspace was prepared, so that states need not be compared. Takes the inputs of a
//! step; gives numbers that are equal only for equal histories.

use core::sync::atomic::{AtomicU64, Ordering};

/// A number that identifies a state by its trajectory and its steps so far. Two states with equal stamps
/// are equal. Stamps never reach an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp(u64);

static NEXT: AtomicU64 = AtomicU64::new(1);

impl Stamp {
    /// A stamp that differs from all others.
    pub fn fresh() -> Self {
        Self(mixed(NEXT.fetch_add(1, Ordering::Relaxed)))
    }

    /// The stamp that belongs to no state.
    pub fn none() -> Self {
        Self(0)
    }

    /// The stamp of the state after a step of `h` by the model with the stamp `model`.
    #[inline]
    #[must_use]
    pub fn after(self, model: Stamp, h: f64) -> Self {
        Self(mixed(self.0 ^ mixed(model.0 ^ h.to_bits())).max(1))
    }
}

/// Mixes the bits of a number (the finaliser of splitmix64, Steele and others 2014).
#[inline]
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
