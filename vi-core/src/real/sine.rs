//! Sine and cosine without a branch or a call, so that a loop over trajectories vectorizes.
//!
//! For an angle x in radians, |x| ≤ [`LARGEST`], sin x and cos x are accurate to 0.8 ulp. With n the integer nearest to
//! x · 2/π, the reduced angle `x − n π/2 = y + y_low` is in [−π/4, π/4] up to rounding,
//!
//! ```text
//! sin y = y − y³ S(y²)      cos y = 1 − y²/2 + y⁴ C(y²)
//! ```
//!
//! and n mod 4 determines the exchange of both and their signs. π/2 is subtracted in three parts (Cody and Waite), the
//! first two of 33 bits, so that their products with n are exact; the polynomials are those of fdlibm.

use core::ops::{Add, BitXor, Mul, Neg, Shl, Sub};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;
use wide::{f64x2, f64x4, u64x2, u64x4};

/// Largest reducible angle, in radians: up to it n has 16 bits. Beyond, and for NaN, use the library.
pub const LARGEST: f64 = 1.0e5;
/// Largest reducible angle in single precision, in radians: n has 10 bits.
pub const LARGEST_SINGLE: f32 = 1.0e3;

/// π/2 as the sum of three numbers, the first two with 33 bits.
const HALF_PI: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
/// π/2 as the sum of four numbers of single precision, the first three with 14 bits.
const HALF_PI_SINGLE: [f32; 4] = [1.570_678_7, 1.176_148_65e-4, 9.920_313e-10, 6.223_372e-14];

const S: [f64; 6] = [
    1.666_666_666_666_663_2e-1,
    -8.333_333_333_322_49e-3,
    1.984_126_982_985_795e-4,
    -2.755_731_370_707_006_8e-6,
    2.505_076_025_340_686_3e-8,
    -1.589_690_995_211_55e-10,
];
const C: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// A number, or a vector of numbers.
pub trait Vector: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
    /// The bits of the numbers.
    type Bits: Copy + Shl<u32, Output = Self::Bits> + BitXor<Output = Self::Bits>;
    /// Adding this number rounds to an integer, stored in the lowest bits: 1.5 · 2⁵² in double precision.
    const ROUNDING: f64 = 6_755_399_441_055_744.0;
    /// Position of the sign bit.
    const SIGN: u32 = 63;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// `self · b + c` in one operation.
    #[must_use]
    fn fused(self, b: Self, c: Self) -> Self;
    /// The bits.
    fn bits(self) -> Self::Bits;
    /// The numbers with these bits.
    fn from_bits(bits: Self::Bits) -> Self;
    /// The sign bit, in place.
    fn highest(bits: Self::Bits) -> Self::Bits;
    /// `bits` if `odd` is odd, otherwise zero.
    fn where_odd(odd: Self::Bits, bits: Self::Bits) -> Self::Bits;

    /// `x − n π/2` as a number and its low part.
    #[inline(always)]
    fn reduced<const FUSED: bool>(x: Self, n: Self) -> (Self, Self) {
        let [first, second, third] = HALF_PI;
        let (rest, part) = (multiply_add::<Self, FUSED>(n, Self::splat(-first), x), n * Self::splat(second));
        let (most, last) = (rest - part, n * Self::splat(third));
        let y = most - last;
        // Rounding errors of both differences, off the critical path.
        (y, ((most - y) - last) + ((rest - most) - part))
    }
}

macro_rules! impl_vector {
    ($($vector:ty, $bits:ty, $splat:expr, $wrapping_sub:expr;)*) => {$(
        impl Vector for $vector {
            type Bits = $bits;
            #[inline(always)]
            fn splat(value: f64) -> Self { $splat(value) }
            #[inline(always)]
            fn fused(self, b: Self, c: Self) -> Self { self.mul_add(b, c) }
            #[inline(always)]
            fn bits(self) -> $bits { self.to_bits() }
            #[inline(always)]
            fn from_bits(bits: $bits) -> Self { <$vector>::from_bits(bits) }
            #[inline(always)]
            fn highest(bits: $bits) -> $bits { bits & <$bits>::from(1_u64 << 63) }
            #[inline(always)]
            fn where_odd(odd: $bits, bits: $bits) -> $bits {
                bits & $wrapping_sub(<$bits>::from(0_u64), odd & <$bits>::from(1_u64))
            }
        }
    )*};
}

impl_vector! {
    f64, u64, core::convert::identity, u64::wrapping_sub;
    f64x2, u64x2, f64x2::splat, core::ops::Sub::sub;
    f64x4, u64x4, f64x4::splat, core::ops::Sub::sub;
}

// Single precision on its own, for processors that compute double precision by calls.
impl Vector for f32 {
    type Bits = u32;
    const ROUNDING: f64 = 12_582_912.0;
    const SIGN: u32 = 31;

    #[allow(clippy::cast_possible_truncation)] // rounded, as coefficients are
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        self.mul_add(b, c)
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        self.to_bits()
    }

    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self::from_bits(bits)
    }

    #[inline(always)]
    fn highest(bits: u32) -> u32 {
        bits & 1 << Self::SIGN
    }

    #[inline(always)]
    fn where_odd(odd: u32, bits: u32) -> u32 {
        bits & 0_u32.wrapping_sub(odd & 1)
    }

    #[inline(always)]
    fn reduced<const FUSED: bool>(x: Self, n: Self) -> (Self, Self) {
        let [first, second, third, fourth] = HALF_PI_SINGLE;
        let (rest, part) = (x - n * first, n * second);
        let (most, last) = (rest - part, n * third);
        let y = most - last;
        (y, ((most - y) - last) + ((rest - most) - part) - n * fourth)
    }
}

/// Sine and cosine of x, in this order, for |x| ≤ [`LARGEST`]. `FUSED` requires code compiled for a processor with
/// fused multiply-add; elsewhere each of them would be a call.
#[inline(always)]
#[must_use]
pub fn sin_cos<V: Vector, const FUSED: bool>(x: V) -> (V, V) {
    let shifted = multiply_add::<V, FUSED>(x, V::splat(core::f64::consts::FRAC_2_PI), V::splat(V::ROUNDING));
    let (quarter, n) = (shifted.bits(), shifted - V::splat(V::ROUNDING));
    let (y, y_low) = V::reduced::<FUSED>(x, n);
    let (s, c) = (sine::<V, FUSED>(y, y_low).bits(), cosine::<V, FUSED>(y, y_low).bits());
    // An exchange written with `if` becomes a jump, which the processor mispredicts for varying angles.
    let exchange = V::where_odd(quarter, s ^ c);
    // The second bit of n, and of n + 1, moved to the sign bit.
    let second = quarter << (V::SIGN - 1);
    (
        V::from_bits(s ^ exchange ^ V::highest(second)),
        V::from_bits(c ^ exchange ^ V::highest(second ^ (quarter << V::SIGN))),
    )
}

/// Sines and cosines of several angles as [`sin_cos`], up to four at a time.
#[inline(always)]
#[must_use]
pub fn sin_cos_each<const K: usize, const FUSED: bool>(angles: [f64; K]) -> [(f64, f64); K] {
    let mut pairs = [(0.0, 0.0); K];
    for (pairs, angles) in pairs.chunks_mut(4).zip(angles.chunks(4)) {
        match (pairs, angles) {
            ([pair], &[x]) => *pair = sin_cos::<f64, FUSED>(x),
            ([first, second], &[x, y]) => {
                let (sines, cosines) = sin_cos::<f64x2, FUSED>(f64x2::new([x, y]));
                let ([s, t], [c, d]) = (sines.to_array(), cosines.to_array());
                (*first, *second) = ((s, c), (t, d));
            }
            (pairs, angles) => {
                let (sines, cosines) = sin_cos::<f64x4, FUSED>(f64x4::from(angles));
                let both = sines.to_array().into_iter().zip(cosines.to_array());
                pairs.iter_mut().zip(both).for_each(|(pair, both)| *pair = both);
            }
        }
    }
    pairs
}

/// `a b + c`.
#[inline(always)]
fn multiply_add<V: Vector, const FUSED: bool>(a: V, b: V, c: V) -> V {
    if FUSED { a.fused(b, c) } else { a * b + c }
}

/// The polynomial of degree 5 in z; paired terms shorten the dependency chain.
#[inline(always)]
fn polynomial<V: Vector, const FUSED: bool>(c: &[f64; 6], z: V) -> V {
    let square = z * z;
    let pair = |low: f64, high: f64| multiply_add::<V, FUSED>(z, V::splat(high), V::splat(low));
    let upper = multiply_add::<V, FUSED>(square, pair(c[4], c[5]), pair(c[2], c[3]));
    multiply_add::<V, FUSED>(square, upper, pair(c[0], c[1]))
}

#[inline(always)]
fn sine<V: Vector, const FUSED: bool>(y: V, y_low: V) -> V {
    let z = y * y;
    let low = multiply_add::<V, FUSED>(V::splat(0.5) * z, y_low, -y_low);
    // A difference, so that sin(−0) = −0.
    y - multiply_add::<V, FUSED>(z * y, polynomial::<V, FUSED>(&S, z), low)
}

#[inline(always)]
fn cosine<V: Vector, const FUSED: bool>(y: V, y_low: V) -> V {
    let z = y * y;
    let half = V::splat(0.5) * z;
    let most = V::splat(1.0) - half;
    let low = multiply_add::<V, FUSED>(-y, y_low, (V::splat(1.0) - most) - half);
    most + multiply_add::<V, FUSED>(z * z, polynomial::<V, FUSED>(&C, z), low)
}

#[cfg(test)]
mod tests {
    use super::{LARGEST, LARGEST_SINGLE, sin_cos, sin_cos_each};
    use core::f64::consts::{FRAC_PI_2, PI, TAU};
    use std::vec::Vec;

    /// The numbers next to multiples of π/2, whose reduction loses most digits, with their sine and cosine, from 60
    /// digits rounded once.
    const HARD: [(f64, f64, f64); 12] = [
        (FRAC_PI_2, 1.0, 6.123_233_995_736_766e-17),
        (PI, 1.224_646_799_147_353_2e-16, -1.0),
        (4.712_388_980_384_69, -1.0, -1.836_970_198_721_029_7e-16),
        (TAU, -2.449_293_598_294_706_4e-16, 1.0),
        (22_743.560_015_663_308, -1.0, -1.809_873_820_013_507_8e-16),
        (45_487.120_031_326_616, 3.619_747_640_027_015_6e-16, -1.0),
        (46_066.743_875_913_93, -1.0, 1.359_307_039_318_883_7e-16),
        (90_394.616_218_065_92, -1.0, -1.221_854_995_939_993e-15),
        (90_974.240_062_653_23, -7.239_495_280_054_031e-16, 1.0),
        (91_553.863_907_240_55, 1.0, 2.260_440_600_708_132e-16),
        (92_133.487_751_827_87, -2.718_614_078_637_767_3e-16, -1.0),
        (92_713.111_596_415_18, -1.0, 7.697_668_757_983_666e-16),
    ];

    /// Numbers of double precision between a and b.
    fn distance(a: f64, b: f64) -> u64 {
        // Numbers of one sign are ordered as their bits; across zero they are far apart.
        if a.is_sign_negative() == b.is_sign_negative() { a.to_bits().abs_diff(b.to_bits()) } else { u64::MAX }
    }

    fn worst<const FUSED: bool>(x: f64, (sine, cosine): (f64, f64)) -> u64 {
        let (s, c) = sin_cos::<f64, FUSED>(x);
        distance(s, sine).max(distance(c, cosine))
    }

    /// Angles of all sizes, spread evenly in each of four ranges.
    fn angles() -> impl Iterator<Item = f64> {
        (0..1_000_000_u32).map(|index| {
            let fraction = (f64::from(index) * 0.618_033_988_749_894_9).fract() * 2.0 - 1.0;
            fraction * [0.8, 10.0, 1000.0, LARGEST][index as usize % 4]
        })
    }

    #[test]
    fn a_million_angles_are_within_one_number_of_the_library() {
        // The library of this platform is within 0.55 ulp. Measured: 1, fused and not.
        for x in angles() {
            let library = x.sin_cos();
            assert!(worst::<false>(x, library) <= 1 && worst::<true>(x, library) <= 1, "{x:e}");
        }
    }

    #[test]
    fn next_to_multiples_of_a_quarter_turn_no_digit_is_lost() {
        // Measured: 1, fused and not.
        for (x, sine, cosine) in HARD {
            assert!(worst::<false>(x, (sine, cosine)) <= 1 && worst::<true>(x, (sine, cosine)) <= 1, "{x:e}");
            assert!(worst::<false>(-x, (-sine, cosine)) <= 1 && worst::<true>(-x, (-sine, cosine)) <= 1, "-{x:e}");
        }
    }

    #[test]
    fn angles_at_once_are_angles_one_by_one() {
        fn agree<const K: usize, const FUSED: bool>(angles: [f64; K]) {
            let bits = |pairs: [(f64, f64); K]| pairs.map(|(s, c)| (s.to_bits(), c.to_bits()));
            assert_eq!(bits(sin_cos_each::<K, FUSED>(angles)), bits(angles.map(sin_cos::<f64, FUSED>)), "{angles:?}");
        }
        let all: Vec<f64> = angles().step_by(97).chain(HARD.map(|(x, ..)| x)).chain([0.0, -0.0]).collect();
        for x in all.windows(5) {
            agree::<2, false>([x[0], x[1]]);
            agree::<3, false>([x[0], x[1], x[2]]);
            agree::<5, false>([x[0], x[1], x[2], x[3], x[4]]);
        }
        // Without the instruction, vectors are never fused.
        #[cfg(target_feature = "fma")]
        all.windows(4).for_each(|x| agree::<4, true>([x[0], x[1], x[2], x[3]]));
    }

    #[test]
    #[allow(clippy::cast_possible_truncation)] // rounded
    fn single_precision_is_within_one_number_of_double_precision() {
        // Every third number of single precision from a milliradian on, of both signs; measured: 1, fused and not.
        let distance = |a: f32, b: f64| {
            let b = b as f32;
            if a.is_sign_negative() == b.is_sign_negative() { a.to_bits().abs_diff(b.to_bits()) } else { u32::MAX }
        };
        let mut worst = 0;
        for bits in (1e-3_f32.to_bits()..=LARGEST_SINGLE.to_bits()).step_by(3) {
            let x = f32::from_bits(bits ^ bits << 31);
            let (sine, cosine) = sin_cos::<f64, false>(f64::from(x));
            for (s, c) in [sin_cos::<f32, false>(x), sin_cos::<f32, true>(x)] {
                worst = worst.max(distance(s, sine)).max(distance(c, cosine));
            }
        }
        assert_eq!(worst, 1);
    }

    #[test]
    fn zero_keeps_its_sign() {
        assert_eq!(sin_cos::<f32, false>(-0.0).0.to_bits(), (-0.0_f32).to_bits());
        assert_eq!(sin_cos::<f64, false>(-0.0).0.to_bits(), (-0.0_f64).to_bits());
        assert_eq!(sin_cos::<f64, true>(-0.0).0.to_bits(), (-0.0_f64).to_bits());
        assert_eq!(sin_cos::<f64, false>(0.0), (0.0, 1.0));
    }
}
