//! What the tests of several files share. Each file uses its part of it.
#![allow(dead_code, unused_macros, unused_imports)]
// Step numbers and drawn mantissas are far below 2^53.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub(crate) mod ending;
pub(crate) mod exact;
pub(crate) mod reference;
pub(crate) mod scenes;

/// The next entry of a fixed sequence in (0, 1) that looks random: a linear congruence (Knuth, MMIX).
pub(crate) struct Sequence(u64);

impl Sequence {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(1))
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64) / ((1_u64 << 53) as f64)
    }

    /// An entry in (low, high).
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}
