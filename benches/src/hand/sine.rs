//! Sine and cosine of one angle without a branch or a call, so that they are inlined and overlap with the surrounding
//! code.
//!
//! In: an angle of at most 10⁵ rad. Out: both to one and a half ulp of 1. The angle is reduced to [−π/4, π/4] by π/2 in three parts
//! (Cody and Waite), and the polynomials are those of FreeBSD's `k_sin.c` and `k_cos.c`.

use super::mul_add;

/// π/2 as a sum; the first two parts have zeros at the end, and their multiples by 17-bit integers are exact.
const PIO2: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
/// 1.5 · 2⁵²: a number plus this is rounded to an integer, which is then in the last bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// (sin x, cos x).
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    let turned = mul_add(x, core::f64::consts::FRAC_2_PI, ROUND);
    let quarter = turned.to_bits();
    let n = turned - ROUND;
    let x = mul_add(-n, PIO2[2], mul_add(-n, PIO2[1], mul_add(-n, PIO2[0], x)));
    let xx = x * x;
    let x4 = xx * xx;
    // Evaluation in pairs has a shorter dependency chain than Horner's scheme.
    let high = mul_add(xx, 1.589_690_995_211_55e-10, -2.505_076_025_340_686_4e-8);
    let low = mul_add(xx, 2.755_731_370_707_006_8e-6, -1.984_126_982_985_795e-4);
    let lowest = mul_add(xx, 8.333_333_333_322_49e-3, -1.666_666_666_666_663_2e-1);
    let sine = mul_add(x * xx, mul_add(x4, mul_add(x4, high, low), lowest), x);
    let high = mul_add(xx, -1.135_964_755_778_819_5e-11, 2.087_572_321_298_175e-9);
    let low = mul_add(xx, -2.755_731_435_139_066_3e-7, 2.480_158_728_947_673e-5);
    let lowest = mul_add(xx, -1.388_888_888_887_411e-3, 4.166_666_666_666_66e-2);
    let cosine = mul_add(x4, mul_add(x4, mul_add(x4, high, low), lowest), mul_add(-0.5, xx, 1.0));
    // Odd quarters swap the two; the sine changes sign in the quarters 2 and 3, the cosine in 1 and 2.
    let odd = 0_u64.wrapping_sub(quarter & 1);
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let swap = (sine ^ cosine) & odd;
    (
        f64::from_bits(sine ^ swap ^ ((quarter & 2) << 62)),
        f64::from_bits(cosine ^ swap ^ ((quarter.wrapping_add(1) & 2) << 62)),
    )
}

/// The longest turn from one angle to another for which two terms of the series are exact to rounding: its cube over 6 is 1e-17.
const LONGEST_TURN: f64 = 4e-6;

/// An angle with its sine and cosine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angle {
    x: f64,
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
}

impl Angle {
    #[inline]
    pub(crate) fn at(x: f64) -> Self {
        let (sine, cosine) = sin_cos(x);
        Self { x, sine, cosine }
    }

    /// The angle `x`, next to this one as a rule: then its sine and cosine are these ones, turned.
    #[inline]
    pub(crate) fn near(&self, x: f64) -> Self {
        let turn = x - self.x;
        if turn.abs() > LONGEST_TURN {
            return Self::at(x);
        }
        let half = 0.5 * turn * turn;
        let sine = self.sine + mul_add(self.cosine, turn, -(self.sine * half));
        let cosine = self.cosine - mul_add(self.sine, turn, self.cosine * half);
        Self { x, sine, cosine }
    }
}

#[cfg(test)]
mod tests {
    use super::{Angle, sin_cos};

    #[test]
    fn angles_are_turned_to_rounding() {
        let mut worst = 0.0_f64;
        for i in 0..100_000 {
            let x = f64::from(i) * 1e-3;
            for turn in [3.9e-6, -1e-7, 1e-2] {
                let angle = Angle::at(x).near(x + turn);
                let (sine, cosine) = (x + turn).sin_cos();
                worst = worst.max((angle.sine - sine).abs()).max((angle.cosine - cosine).abs());
            }
        }
        // Measured: 2.3e-16.
        assert!(worst < 3e-16);
    }

    #[test]
    fn agrees_with_the_library() {
        let mut worst = 0.0_f64;
        for i in -2_000_000..=2_000_000 {
            let x = f64::from(i) * 1.234_567e-3;
            let (sine, cosine) = sin_cos(x);
            worst = worst.max((sine - x.sin()).abs()).max((cosine - x.cos()).abs());
        }
        assert!(worst < 3e-16);
    }
}
