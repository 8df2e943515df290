//! Helpers shared by the tests of two programs.
#![allow(dead_code, reason = "each program uses a part")]
// Step numbers and random mantissas are far below 2^53.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub(crate) mod ending;
pub(crate) mod exact;
pub(crate) mod reference;
pub(crate) mod scenes;
pub(crate) mod twice;

/// The next entry of a fixed pseudo-random sequence in (0, 1): a linear congruence (Knuth, MMIX).
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

/// Least-squares slope of (log h, log error), without points at the rounding plateau.
pub(crate) fn slope(name: &str, points: &[(f64, f64)], plateau: f64) -> f64 {
    let kept: Vec<(f64, f64)> =
        points.iter().filter(|(_, error)| *error > plateau).map(|(h, error)| (h.ln(), error.ln())).collect();
    assert!(kept.len() >= 3, "{name}: only {} points above the plateau: {points:?}", kept.len());
    let mean = |one: fn(&(f64, f64)) -> f64| kept.iter().map(one).sum::<f64>() / kept.iter().map(|_| 1.0).sum::<f64>();
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let products = |one: fn(f64, f64) -> f64| kept.iter().map(|(a, b)| one(a - x, b - y)).sum::<f64>();
    let slope = products(|a, b| a * b) / products(|a, _| a * a);
    println!(
        "{name}: slope {slope:.4} over {} points, errors {:.1e} to {:.1e}",
        kept.len(),
        points[0].1,
        points[points.len() - 1].1
    );
    slope
}

/// Checks that the error of steps with `stages` stages has twice that order, within a tolerance. The reference is
/// accurate to 1e-14.
pub(crate) fn assert_order_of(stages: usize, name: &str, points: &[(f64, f64)], tolerance: f64) {
    let slope = slope(&format!("{name}, {stages} stages"), points, 1e-13);
    let expected = f64::from(2 * u32::try_from(stages).expect("a few stages"));
    assert!((slope - expected).abs() <= tolerance * expected, "{name}, {stages} stages: slope {slope}, {points:?}");
}
