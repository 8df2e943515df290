//! The number that loops over trajectories compute with.
//!
//! In: formulas generic over [`Real`]. Out: the same in `f64`, one trajectory at a time, without a branch or a call in
//! what can do without, so that the compiler widens the loop around it to as many lanes as the processor has. An explicit
//! vector type would choose its instructions when it is compiled, before the processor is known.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use vi_core::real::{Real, sine};

/// One lane: a number whose sine and cosine have no slow path. `FUSED`: whether products are added in one instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lane<const FUSED: bool>(pub(crate) f64);

macro_rules! operators {
    ($($operator:ident $function:ident),*) => {$(
        impl<const FUSED: bool> $operator for Lane<FUSED> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self { Self(self.0.$function(other.0)) }
        }
    )*};
}

macro_rules! assignments {
    ($($operator:ident $function:ident),*) => {$(
        impl<const FUSED: bool> $operator for Lane<FUSED> {
            #[inline(always)]
            fn $function(&mut self, other: Self) { self.0.$function(other.0); }
        }
    )*};
}

macro_rules! functions {
    ($($function:ident($($argument:ident),*)),*) => {$(
        #[inline(always)]
        fn $function(self, $($argument: Self),*) -> Self { Self(Real::$function(self.0, $($argument.0),*)) }
    )*};
}

operators!(Add add, Sub sub, Mul mul, Div div);
assignments!(AddAssign add_assign, SubAssign sub_assign, MulAssign mul_assign);

impl<const FUSED: bool> Neg for Lane<FUSED> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<const FUSED: bool> num_traits::Zero for Lane<FUSED> {
    #[inline(always)]
    fn zero() -> Self {
        Self(0.0)
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl<const FUSED: bool> num_traits::One for Lane<FUSED> {
    #[inline(always)]
    fn one() -> Self {
        Self(1.0)
    }
}

impl<const FUSED: bool> Real for Lane<FUSED> {
    /// The compiler widens one to so many, or half: formulas that choose by this choose what suits a vector.
    const LANES: usize = 8;
    const EPSILON: f64 = f64::EPSILON;

    #[inline(always)]
    fn real(value: f64) -> Self {
        Self(value)
    }
    functions!(recip(), sqrt(), exp(), ln(), tan(), asin(), acos(), atan(), sinh(), cosh(), tanh(), abs(), sign());
    functions!(atan2(other), hypot(other), pow(exponent), max(other));
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Not a number for angles that only the library reduces: the trajectory takes that step by itself.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let near = self.0.abs() <= sine::LARGEST;
        let (s, c) = sine::sin_cos::<FUSED>(self.0);
        if near { (Self(s), Self(c)) } else { (Self(f64::NAN), Self(f64::NAN)) }
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    #[inline(always)]
    fn is_positive(self) -> bool {
        self.0 > 0.0
    }
    #[inline(always)]
    fn at_most(self, bound: Self) -> Self {
        Self(Real::at_most(self.0, bound.0))
    }
    #[inline(always)]
    fn is_above(self, bound: Self) -> Self {
        Self(Real::is_above(self.0, bound.0))
    }
    #[inline(always)]
    fn holds(self) -> bool {
        self.0 != 0.0
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.0
    }
    #[inline(always)]
    fn least_magnitude(self) -> f64 {
        self.0.abs()
    }
}
