//! Several numbers per operation: SIMD lanes inside one formula.
//!
//! Formulas generic over [`Real`] compute with W numbers at once, so that every operation of a long formula, also in
//! loops over coordinates, becomes a vector instruction. [`Lane`](super::Lane) is for short formulas: there the
//! compiler vectorizes the surrounding loop.

use super::{Number, Real, sine};
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// W numbers. `FUSED`: whether sines use fused multiply-add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const W: usize, const FUSED: bool>(pub [f64; W]);

impl<const W: usize, const FUSED: bool> Lanes<W, FUSED> {
    /// Applies a function to each.
    #[inline(always)]
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        let mut all = self;
        let mut i = 0;
        while i < W {
            all.0[i] = function(all.0[i]);
            i += 1;
        }
        all
    }

    /// Applies a function to each pair.
    #[inline(always)]
    fn pairs(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let mut all = self;
        let mut i = 0;
        while i < W {
            all.0[i] = function(all.0[i], other.0[i]);
            i += 1;
        }
        all
    }

    /// Whether a predicate holds for all of them.
    #[inline(always)]
    fn all(self, is_so: impl Fn(f64) -> bool) -> bool {
        self.0.into_iter().fold(true, |all, number| all & is_so(number))
    }
}

macro_rules! operations {
    ($($operator:ident $function:ident $assigning:ident $assign:ident $operation:tt),*) => {$(
        impl<const W: usize, const FUSED: bool> $operator for Lanes<W, FUSED> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self { self.pairs(other, |a, b| a $operation b) }
        }
        impl<const W: usize, const FUSED: bool> $assigning for Lanes<W, FUSED> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) { *self = *self $operation other; }
        }
    )*};
}

operations!(Add add AddAssign add_assign +, Sub sub SubAssign sub_assign -, Mul mul MulAssign mul_assign *);

impl<const W: usize, const FUSED: bool> Div for Lanes<W, FUSED> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.pairs(other, |a, b| a / b)
    }
}

impl<const W: usize, const FUSED: bool> Neg for Lanes<W, FUSED> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl<const W: usize, const FUSED: bool> num_traits::Zero for Lanes<W, FUSED> {
    #[inline(always)]
    fn zero() -> Self {
        Self([0.0; W])
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.all(|number| number == 0.0)
    }
}

impl<const W: usize, const FUSED: bool> num_traits::One for Lanes<W, FUSED> {
    #[inline(always)]
    fn one() -> Self {
        Self([1.0; W])
    }
}

macro_rules! functions {
    ($($function:ident),*) => {$(
        #[inline(always)]
        fn $function(self) -> Self { self.each(Number::$function) }
    )*};
}

macro_rules! functions_of_two {
    ($($function:ident),*) => {$(
        #[inline(always)]
        fn $function(self, other: Self) -> Self { self.pairs(other, Number::$function) }
    )*};
}

impl<const W: usize, const FUSED: bool> Number for Lanes<W, FUSED> {
    #[inline(always)]
    fn real(value: f64) -> Self {
        Self([value; W])
    }
    functions!(recip, sqrt, exp, ln, tan, asin, acos, atan, sinh, cosh, tanh, abs, sign);
    functions_of_two!(atan2, hypot, pow);
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// NaN for angles that only the library reduces, as with [`Lane`](super::Lane).
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let mut sines = self;
        let mut cosines = self;
        for i in 0..W {
            let near = self.0[i].abs() <= sine::LARGEST;
            let (s, c) = sine::sin_cos::<f64, FUSED>(self.0[i]);
            sines.0[i] = if near { s } else { f64::NAN };
            cosines.0[i] = if near { c } else { f64::NAN };
        }
        (sines, cosines)
    }
    #[inline(always)]
    fn zero_where(self, base: Self, _derivatives: u8) -> Self {
        self.pairs(base, |number, base| if base == 0.0 { 0.0 } else { number })
    }
    #[inline(always)]
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        let mut all = self;
        for i in 0..W {
            all.0[i] = self.0[i].if_positive(then.0[i], otherwise.0[i]);
        }
        all
    }
    #[inline(always)]
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        let mut constants = [Self([0.0; W]); C];
        for i in 0..W {
            for (constant, found) in constants.iter_mut().zip(find(arguments.map(|argument| argument.0[i]))) {
                constant.0[i] = found;
            }
        }
        constants
    }
}

impl<const W: usize, const FUSED: bool> Real for Lanes<W, FUSED> {
    const EPSILON: f64 = f64::EPSILON;

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.pairs(other, Real::max)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.all(f64::is_finite)
    }
    #[inline(always)]
    fn is_positive(self) -> bool {
        self.all(|number| number > 0.0)
    }
    #[inline(always)]
    fn is_at_most(self, bound: Self) -> bool {
        let mut all = true;
        for i in 0..W {
            all &= self.0[i] <= bound.0[i];
        }
        all
    }
    /// The first lane; code that needs every lane does not use this.
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.0.first().copied().unwrap_or(f64::NAN)
    }
}
