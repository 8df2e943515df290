//! Double-double numbers: sums of two `f64`, accurate to 1e-27 of their terms.
//!
//! In: a formula generic over [`Real`]. Out: its value with an error far below a rounding of `f64`. Source of sum,
//! product and quotient: Hida, Li, Bailey, *Quad-double arithmetic*. The crate `twofloat` computes `1/3` and `exp` to
//! `f64` accuracy only.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use vi_core::real::{Number, Real};

/// The sum of two numbers, the second at most half an ulp of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twice {
    high: f64,
    low: f64,
}

/// `a + b` and its rounding error.
fn two_sum(a: f64, b: f64) -> Twice {
    let high = a + b;
    let of_b = high - a;
    Twice { high, low: (a - (high - of_b)) + (b - of_b) }
}

const HALF_PI: Twice = Twice { high: core::f64::consts::FRAC_PI_2, low: 6.123_233_995_736_766e-17 };
const LN_2: Twice = Twice { high: core::f64::consts::LN_2, low: 2.319_046_813_846_3e-17 };

impl Twice {
    pub(crate) fn new(high: f64, low: f64) -> Self {
        two_sum(high, low)
    }

    /// `Σ x^k/k!` over the terms k = first, first + step, …, from the term of `first`.
    fn series(square: Self, term: Self, first: u32, step: u32) -> Self {
        let (mut sum, mut term, mut k) = (term, term, first);
        for _ in 0..24 {
            for factor in 1..=step {
                term = term / Self::real(f64::from(k + factor));
            }
            term *= square;
            k += step;
            sum += term;
        }
        sum
    }

    /// `e^x − 1`, with all digits for small x.
    fn exp_m1(self) -> Self {
        if self.high.abs() > 0.4 {
            return self.exp() - Self::real(1.0);
        }
        Self::series(self, self, 1, 1)
    }
}

impl Add for Twice {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = two_sum(self.high, other.high);
        let low = two_sum(self.low, other.low);
        let sum = two_sum(high.high, high.low + low.high);
        two_sum(sum.high, sum.low + low.low)
    }
}

impl Neg for Twice {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Twice {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twice {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        two_sum(high, low)
    }
}

impl Div for Twice {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let mut quotient = Self::real(0.0);
        let mut left = self;
        for _ in 0..3 {
            let part = Self::real(left.high / other.high);
            left -= other * part;
            quotient += part;
        }
        quotient
    }
}

macro_rules! assigning {
    ($($operator:ident $function:ident $operation:tt),*) => {$(
        impl $operator for Twice {
            fn $function(&mut self, other: Self) {
                *self = *self $operation other;
            }
        }
    )*};
}
assigning!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *);

impl num_traits::Zero for Twice {
    fn zero() -> Self {
        Self::real(0.0)
    }
    fn is_zero(&self) -> bool {
        self.high == 0.0
    }
}

impl num_traits::One for Twice {
    fn one() -> Self {
        Self::real(1.0)
    }
}

impl Number for Twice {
    fn real(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
    fn recip(self) -> Self {
        Self::real(1.0) / self
    }
    fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return self;
        }
        let root = Self::real(self.high.sqrt());
        let better = root + (self - root * root) / (root + root);
        better + (self - better * better) / (better + better)
    }
    fn exp(self) -> Self {
        let turns = (self.high / core::f64::consts::LN_2).round();
        let reduced = (self - LN_2 * Self::real(turns)) * Self::real(1.0 / 256.0);
        let mut less_one = reduced.exp_m1();
        for _ in 0..8 {
            less_one = less_one + less_one + less_one * less_one;
        }
        (less_one + Self::real(1.0)) * Self::real(turns.exp2())
    }
    fn ln(self) -> Self {
        let mut value = Self::real(self.high.ln());
        for _ in 0..2 {
            value += self * (-value).exp() - Self::real(1.0);
        }
        value
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.high / HALF_PI.high).round();
        let x = self - HALF_PI * Self::real(quarters);
        let square = -(x * x);
        let sine = Self::series(square, x, 1, 2);
        let cosine = Self::series(square, Self::real(1.0), 0, 2);
        match quarters.rem_euclid(4.0) {
            q if q < 0.5 => (sine, cosine),
            q if q < 1.5 => (cosine, -sine),
            q if q < 2.5 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }
    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }
    fn asin(self) -> Self {
        self.atan2((Self::real(1.0) - self * self).sqrt())
    }
    fn acos(self) -> Self {
        (Self::real(1.0) - self * self).sqrt().atan2(self)
    }
    fn atan(self) -> Self {
        self.atan2(Self::real(1.0))
    }
    fn atan2(self, other: Self) -> Self {
        let angle = Self::real(self.high.atan2(other.high));
        let (sine, cosine) = angle.sin_cos();
        let left = (self * cosine - other * sine) / (other * cosine + self * sine);
        angle + left - left * left * left / Self::real(3.0)
    }
    fn sinh(self) -> Self {
        let less_one = self.exp_m1();
        (less_one + less_one / (less_one + Self::real(1.0))) * Self::real(0.5)
    }
    fn cosh(self) -> Self {
        let power = self.exp();
        (power + power.recip()) * Self::real(0.5)
    }
    fn tanh(self) -> Self {
        let less_one = (self + self).exp_m1();
        if less_one.high.is_infinite() { Self::real(1.0) } else { less_one / (less_one + Self::real(2.0)) }
    }
    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }
    fn sign(self) -> Self {
        Self::real(Number::sign(self.high))
    }
    fn hypot(self, other: Self) -> Self {
        (self * self + other * other).sqrt()
    }
    fn pow(self, exponent: Self) -> Self {
        if self.high == 0.0 { Self::real(0.0_f64.powf(exponent.high)) } else { (self.ln() * exponent).exp() }
    }
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        let arm = if self.high > 0.0 { then } else { otherwise };
        if self.high.is_nan() { self } else { arm }
    }
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        find(arguments.map(|argument| argument.high)).map(Self::real)
    }
}

impl Real for Twice {
    const EPSILON: f64 = 1e-31;

    fn max(self, other: Self) -> Self {
        if (other - self).high > 0.0 { other } else { self }
    }
    fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }
    fn is_positive(self) -> bool {
        self.high > 0.0
    }
    fn is_at_most(self, bound: Self) -> bool {
        (self - bound).high <= 0.0
    }
    fn to_f64(self) -> f64 {
        self.high
    }
}

/// Each function has an inverse, or an identity, to 1e-27 of its terms, and its first digits are those of `f64`.
#[test]
fn functions_have_their_digits() {
    let one = Twice::real(1.0);
    for x in [0.7, -0.3, 1e-3, 0.999, 3.1, -12.5, 40.3] {
        let x = Twice::new(x, x * 1e-17);
        let (sine, cosine) = x.sin_cos();
        let size = x.abs().exp();
        let pairs = [
            ("third", one / Twice::real(3.0) * Twice::real(3.0), one, one),
            ("sin² + cos²", sine * sine + cosine * cosine, one, one),
            ("ln exp", x.exp().ln(), x, x.abs().max(one)),
            ("sqrt", x.abs().sqrt() * x.abs().sqrt(), x.abs(), x.abs()),
            ("atan2", sine.atan2(cosine).tan(), x.tan(), (one + x.tan() * x.tan()) * x.abs().max(one)),
            ("asin", sine.asin().sin(), sine, one),
            ("acos", cosine.acos().cos(), cosine, one),
            ("cosh² − sinh²", x.cosh() * x.cosh(), one + x.sinh() * x.sinh(), size * size),
            ("tanh", x.tanh() * x.cosh(), x.sinh(), size),
            ("doubled sine", (x + x).sin(), (sine + sine) * cosine, x.abs().max(one)),
            ("sum of exponents", (x + one).exp(), x.exp() * one.exp(), (x + one).exp() * x.abs().max(one)),
            (
                "pow",
                x.abs().pow(Twice::real(1.5)),
                x.abs() * x.abs().sqrt(),
                x.abs() * x.abs().sqrt() * Twice::real(8.0),
            ),
        ];
        for (name, found, wanted, size) in pairs {
            let error = ((found - wanted) / size).to_f64().abs();
            // Measured: 3e-28, for `cosh² − sinh²` at 40.3: `exp` squares its error.
            assert!(error <= 1e-27, "{name} of {x:?}: {found:?}, not {wanted:?}: {error:e}");
        }
        let near = Twice::real(x.high);
        for (found, wanted) in [(near.sin(), x.high.sin()), (near.exp(), x.high.exp()), (near.sinh(), x.high.sinh())] {
            assert!((found.to_f64() - wanted).abs() <= 4.0 * f64::EPSILON * wanted.abs(), "{found:?}, {wanted}");
        }
    }
}
