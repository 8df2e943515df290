//! Derivatives of functions that the compiler of `lagrangian!` cannot see through.
//!
//! A function generic over [`Number`] is evaluated in nested dual numbers, which gives its value and all partial
//! derivatives up to an order. A [`Table`](crate::table::Table) differentiates its polynomials instead. Both are
//! [`Jets`].
//!
//! ```
//! use vi_core::function::{Differentiated, Function, Jets};
//! use vi_core::real::Number;
//!
//! /// Lift coefficient at the angle of attack a, in radians.
//! fn cl<T: Number>(a: T) -> T {
//!     T::real(6.0) * a / (T::one() + a * a)
//! }
//!
//! struct Cl;
//! impl Function<1> for Cl {
//!     fn value<T: Number>(&self, [a]: [T; 1]) -> T {
//!         cl(a)
//!     }
//! }
//!
//! let (value, [slope], [[curvature]]) = Differentiated(Cl).jet_2([0.0]);
//! assert_eq!([value, slope, curvature], [0.0, 6.0, 0.0]);
//! ```

use crate::lagrangian::Undefined;
use crate::real::{Dual, Number, Real, Slopes};
use core::array;

/// A function of K arguments, in every number type.
pub trait Function<const K: usize> {
    /// The value at `arguments`.
    fn value<T: Number>(&self, arguments: [T; K]) -> T;
}

/// First partial derivatives.
pub type Gradient<T, const K: usize> = [T; K];
/// Second partial derivatives, a symmetric matrix.
pub type Hessian<T, const K: usize> = [[T; K]; K];
/// Third partial derivatives, symmetric in all indices.
pub type ThirdDerivatives<T, const K: usize> = [[[T; K]; K]; K];

/// A function of K arguments with its partial derivatives, in numbers T.
pub trait Jets<T, const K: usize> {
    /// The value.
    fn jet_0(&self, arguments: [T; K]) -> T;
    /// The value and the gradient.
    fn jet_1(&self, arguments: [T; K]) -> (T, Gradient<T, K>);
    /// The value, the gradient and the second derivatives.
    fn jet_2(&self, arguments: [T; K]) -> (T, Gradient<T, K>, Hessian<T, K>);
    /// The value and the derivatives up to the third.
    fn jet_3(&self, arguments: [T; K]) -> (T, Gradient<T, K>, Hessian<T, K>, ThirdDerivatives<T, K>);
}

/// A function whose derivatives are computed by dual numbers.
#[derive(Clone, Copy, Debug)]
pub struct Differentiated<F>(pub F);

impl<F> Differentiated<F> {
    /// The reason why the function has no value at finite arguments: its value is not finite. It names the first
    /// argument.
    pub fn undefined<T: Real, const K: usize>(&self, function: &'static str, arguments: [T; K]) -> Option<Undefined>
    where
        F: Function<K>,
    {
        let is_finite = |number: &T| number.is_finite();
        let argument = arguments.first().filter(|_| arguments.iter().all(is_finite))?.to_f64();
        (!self.0.value(arguments).is_finite()).then_some(Undefined { function, argument, range: None })
    }
}

/// A number with its derivatives with respect to K arguments.
type Varied<T, const K: usize> = Dual<T, Slopes<T, K>>;

/// The arguments as variables, each with a slope of one in its own direction.
#[inline]
fn varied<T: Real, const K: usize>(arguments: [T; K]) -> [Varied<T, K>; K] {
    array::from_fn(|k| Dual {
        value: arguments[k],
        slope: Slopes(array::from_fn(|j| if j == k { T::one() } else { T::zero() })),
    })
}

impl<T: Real, F: Function<K>, const K: usize> Jets<T, K> for Differentiated<F> {
    #[inline]
    fn jet_0(&self, arguments: [T; K]) -> T {
        self.0.value(arguments)
    }

    #[inline]
    fn jet_1(&self, arguments: [T; K]) -> (T, Gradient<T, K>) {
        let Dual { value, slope: Slopes(gradient) } = self.jet_0(varied(arguments));
        (value, gradient)
    }

    #[inline]
    fn jet_2(&self, arguments: [T; K]) -> (T, Gradient<T, K>, Hessian<T, K>) {
        let (value, gradient) = self.jet_1(varied(arguments));
        (value.value, value.slope.0, gradient.map(|entry| entry.slope.0))
    }

    #[inline]
    fn jet_3(&self, arguments: [T; K]) -> (T, Gradient<T, K>, Hessian<T, K>, ThirdDerivatives<T, K>) {
        let (value, gradient, hessian) = self.jet_2(varied(arguments));
        let third = hessian.map(|row| row.map(|entry| entry.slope.0));
        (value.value, value.slope.0, gradient.map(|entry| entry.slope.0), third)
    }
}
