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

#[cfg(test)]
mod tests {
    // Values of exact formulas are exact.
    #![allow(clippy::float_cmp)]

    use super::*;
    use crate::real::{Lane, Lanes, Rounded, Series};

    /// `x / (1 + x²)`.
    struct Rational;
    impl Function<1> for Rational {
        fn value<T: Number>(&self, [x]: [T; 1]) -> T {
            x / (T::one() + x * x)
        }
    }

    /// `x² y³ + sin(x y)`.
    struct OfTwo;
    impl Function<2> for OfTwo {
        fn value<T: Number>(&self, [x, y]: [T; 2]) -> T {
            x * x * y * y * y + (x * y).sin()
        }
    }

    /// `x y² z³`.
    struct OfThree;
    impl Function<3> for OfThree {
        fn value<T: Number>(&self, [x, y, z]: [T; 3]) -> T {
            x * y * y * z * z * z
        }
    }

    /// `√x` above zero, `x²` elsewhere. The arm that is not selected may have no derivative, or no value.
    struct Selected;
    impl Function<1> for Selected {
        fn value<T: Number>(&self, [x]: [T; 1]) -> T {
            x.if_positive(x.sqrt(), x * x)
        }
    }

    /// Relative error, or absolute below 1.
    fn error(found: f64, wanted: f64) -> f64 {
        (found - wanted).abs() / wanted.abs().max(1.0)
    }

    #[test]
    fn derivatives_of_one_argument_are_exact() {
        for x in [-3.0_f64, -0.4, 0.0, 0.7, 12.0] {
            let d = 1.0 + x * x;
            let (value, [slope], [[second]], [[[third]]]) = Differentiated(Rational).jet_3([x]);
            let wanted = [
                x / d,
                (1.0 - x * x) / (d * d),
                2.0 * x * (x * x - 3.0) / d.powi(3),
                -6.0 * (x.powi(4) - 6.0 * x * x + 1.0) / d.powi(4),
            ];
            let worst = [value, slope, second, third]
                .iter()
                .zip(wanted)
                .fold(0.0, |worst: f64, (f, w)| worst.max(error(*f, w)));
            // Measured: 1e-15.
            assert!(worst <= 1e-14, "{x}: {worst:e}");
            let (value_2, slope_2, second_2) = Differentiated(Rational).jet_2([x]);
            assert_eq!((value_2, slope_2, second_2), (value, [slope], [[second]]));
            assert_eq!(Differentiated(Rational).jet_1([x]), (value, [slope]));
            assert_eq!(Differentiated(Rational).jet_0([x]), value);
        }
    }

    #[test]
    fn partial_derivatives_are_those_of_the_formula() {
        let [x, y] = [0.8_f64, -1.3];
        let (sin, cos) = (x * y).sin_cos();
        let (value, gradient, hessian, third) = Differentiated(OfTwo).jet_3([x, y]);
        assert!(error(value, x * x * y.powi(3) + sin) <= 1e-15);
        let mixed = 6.0 * x * y * y + cos - x * y * sin;
        let wanted = [2.0 * x * y.powi(3) + y * cos, 3.0 * x * x * y * y + x * cos];
        let wanted_hessian = [[2.0 * y.powi(3) - y * y * sin, mixed], [mixed, 6.0 * x * x * y - x * x * sin]];
        let xxy = 6.0 * y * y - 2.0 * y * sin - x * y * y * cos;
        let xyy = 12.0 * x * y - 2.0 * x * sin - x * x * y * cos;
        let wanted_third = [[[-y.powi(3) * cos, xxy], [xxy, xyy]], [[xxy, xyy], [xyy, 6.0 * x * x - x.powi(3) * cos]]];
        for i in 0..2 {
            assert!(error(gradient[i], wanted[i]) <= 1e-15);
            for j in 0..2 {
                assert!(error(hessian[i][j], wanted_hessian[i][j]) <= 1e-15);
                // Measured: 2e-16.
                assert!((0..2).all(|k| error(third[i][j][k], wanted_third[i][j][k]) <= 2e-15), "{i}, {j}");
            }
        }
        let (value, gradient, hessian, third) = Differentiated(OfThree).jet_3([2.0, 3.0, 0.5]);
        assert_eq!((value, gradient), (2.25, [1.125, 1.5, 13.5]));
        assert_eq!(hessian, [[0.0, 0.75, 6.75], [0.75, 0.5, 9.0], [6.75, 9.0, 54.0]]);
        assert_eq!((third[0][1][2], third[2][2][2], third[1][1][2], third[0][0][0]), (4.5, 108.0, 3.0, 0.0));
    }

    #[test]
    fn an_arm_leaves_no_trace_of_the_other() {
        let jet = |x: f64| {
            let (value, [slope], [[second]]) = Differentiated(Selected).jet_2([x]);
            [value, slope, second]
        };
        assert_eq!((jet(4.0), jet(-3.0), jet(0.0)), ([2.0, 0.25, -0.03125], [9.0, -6.0, 2.0], [0.0, 0.0, 2.0]));
        assert!(jet(f64::NAN).into_iter().all(f64::is_nan));
        let series = |x: f64| Selected.value([Series::variable(x)]);
        assert_eq!([series(4.0).derivative(1), series(4.0).derivative(2)], [0.25, -0.03125]);
        assert_eq!([0, 1, 2, 3].map(|order| series(-3.0).derivative(order)), [9.0, -6.0, 2.0, 0.0]);
        let rounded = Selected.value([Rounded::nearest(-3.0)]);
        assert_eq!((rounded.to_f64(), Selected.value([-3.0_f32])), (9.0, 9.0));
        // |x| e(x) twice, and the rounding of the square.
        assert!((rounded.error() - 27.0).abs() <= 1e-12, "{rounded:?}");
    }

    #[test]
    fn lanes_branch_apart_in_all_derivatives() {
        let x = [4.0, -3.0, 0.0, f64::NAN];
        let (Lanes(values), [Lanes(slopes)], [[Lanes(seconds)]]) =
            Differentiated(Selected).jet_2([Lanes::<4, true>(x)]);
        for lane in 0..4 {
            let (value, [slope], [[second]]) = Differentiated(Selected).jet_2([x[lane]]);
            let alone = Differentiated(Selected).jet_2([Lane::<true>::new(x[lane])]);
            let found = [values[lane], slopes[lane], seconds[lane]];
            for (a, b) in found.into_iter().zip([value, slope, second]) {
                assert!(a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(), "{found:?}");
            }
            assert!(alone.0.get().to_bits() == value.to_bits() || value.is_nan());
        }
    }

    /// In each lane, a slope of zero stays zero times an infinite derivative, and a base of zero without a logarithm.
    #[test]
    fn limits_hold_in_each_lane() {
        type Varied = Dual<Lanes<2, false>>;
        let varied = |value, slope| Varied { value: Lanes(value), slope: Lanes(slope) };
        let root = varied([0.0, 4.0], [0.0, 1.0]).sqrt();
        assert_eq!((root.value, root.slope), (Lanes([0.0, 2.0]), Lanes([0.0, 0.25])));
        let power = varied([0.0, 1.0], [0.0; 2]).pow(varied([1.5, 2.0], [1.0, 0.0]));
        assert_eq!((power.value, power.slope), (Lanes([0.0, 1.0]), Lanes([0.0, 0.0])));
        let limit = varied([f64::NAN, 3.0], [f64::NAN, 2.0]).zero_where(varied([0.0, 1.0], [1.0; 2]), 1);
        assert_eq!((limit.value, limit.slope), (Lanes([0.0, 3.0]), Lanes([0.0, 2.0])));
        let Lanes([unknown, known]) = varied([1.0, 3.0], [1.0, 2.0]).zero_where(varied([0.0, 1.0], [1.0; 2]), 0).slope;
        assert!(unknown.is_nan() && known == 2.0);
    }
}
