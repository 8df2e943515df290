//! The number type of loops over trajectories.
//!
//! Formulas generic over [`Real`] compute in `f64`, one trajectory at a time. They avoid branches and calls, so that
//! the compiler vectorizes the surrounding loop for the processor's lanes. An explicit vector type would fix its
//! instructions at compile time, before the processor is known.
//!
//! The compiler may not fuse operations on its own. A product therefore stays a pair of factors until an addition
//! follows, and `a b + c` is one instruction if the processor has it. The compiler knows which values are products, so
//! that the pair costs nothing at run time.

use super::{Number, Real, sine};
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// One lane: a number whose sine and cosine have no slow path. `FUSED`: whether to use fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub struct Lane<const FUSED: bool> {
    /// The number, or its first factor.
    value: f64,
    /// Its second factor; 1 for a plain number, so that reading it needs no branch.
    factor: f64,
    product: bool,
}

impl<const FUSED: bool> Lane<FUSED> {
    /// The lane of a number.
    #[must_use]
    #[inline(always)]
    pub fn new(value: f64) -> Self {
        Self { value, factor: 1.0, product: false }
    }

    /// `a b + c`, rounded once if the processor supports it.
    #[must_use]
    #[inline(always)]
    pub fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
        if FUSED { a.mul_add(b, c) } else { a * b + c }
    }

    /// The number.
    #[must_use]
    #[inline(always)]
    pub fn get(self) -> f64 {
        self.value * self.factor
    }
}

impl<const FUSED: bool> PartialEq for Lane<FUSED> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.get() == other.get()
    }
}

impl<const FUSED: bool> Add for Lane<FUSED> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        if !FUSED {
            return Self::new(self.value + other.value);
        }
        let (fused, added) = if self.product { (self, other) } else { (other, self) };
        Self::new(fused.value.mul_add(fused.factor, added.get()))
    }
}

impl<const FUSED: bool> Sub for Lane<FUSED> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const FUSED: bool> Mul for Lane<FUSED> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (value, factor) = (self.get(), other.get());
        if FUSED { Self { value, factor, product: true } } else { Self::new(value * factor) }
    }
}

impl<const FUSED: bool> Div for Lane<FUSED> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::new(self.get() / other.get())
    }
}

impl<const FUSED: bool> Neg for Lane<FUSED> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

macro_rules! assignments {
    ($($operator:ident $function:ident $operation:ident),*) => {$(
        impl<const FUSED: bool> $operator for Lane<FUSED> {
            #[inline(always)]
            fn $function(&mut self, other: Self) { *self = (*self).$operation(other); }
        }
    )*};
}

assignments!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul);

impl<const FUSED: bool> num_traits::Zero for Lane<FUSED> {
    #[inline(always)]
    fn zero() -> Self {
        Self::new(0.0)
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.get() == 0.0
    }
}

impl<const FUSED: bool> num_traits::One for Lane<FUSED> {
    #[inline(always)]
    fn one() -> Self {
        Self::new(1.0)
    }
}

macro_rules! functions {
    ($($function:ident($($argument:ident),*)),*) => {$(
        #[inline(always)]
        fn $function(self, $($argument: Self),*) -> Self { Self::new(Number::$function(self.get(), $($argument.get()),*)) }
    )*};
}

impl<const FUSED: bool> Number for Lane<FUSED> {
    #[inline(always)]
    fn real(value: f64) -> Self {
        Self::new(value)
    }
    functions!(recip(), sqrt(), exp(), ln(), tan(), asin(), acos(), atan(), sinh(), cosh(), tanh(), abs(), sign());
    functions!(atan2(other), hypot(other), pow(exponent));
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// NaN for angles that only the library reduces: the trajectory takes that step alone.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let angle = self.get();
        let near = angle.abs() <= sine::LARGEST;
        let (s, c) = sine::sin_cos::<f64, FUSED>(angle);
        let (s, c) = if near { (s, c) } else { (f64::NAN, f64::NAN) };
        (Self::new(s), Self::new(c))
    }
    #[inline(always)]
    fn zero_where(self, base: Self, _derivatives: u8) -> Self {
        // A select, without a branch.
        Self::new(if base.get() == 0.0 { 0.0 } else { self.get() })
    }
    #[inline(always)]
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        Self::new(self.get().if_positive(then.get(), otherwise.get()))
    }
    #[inline(always)]
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        find(arguments.map(Self::get)).map(Self::new)
    }
}

impl<const FUSED: bool> Real for Lane<FUSED> {
    const EPSILON: f64 = f64::EPSILON;

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::new(Real::max(self.get(), other.get()))
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.get().is_finite()
    }
    #[inline(always)]
    fn is_positive(self) -> bool {
        self.get() > 0.0
    }
    #[inline(always)]
    fn is_at_most(self, bound: Self) -> bool {
        self.get() <= bound.get()
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.get()
    }
}
