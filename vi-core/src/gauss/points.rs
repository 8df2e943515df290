//! The equations of motion at a point, generic and type-erased.
//!
//! Every system implements [`Points`] with inlined functions. [`ErasedSystem`] is the same system behind a pointer. Cold paths
//! use it: slow convergence and once-per-step measurements. They are compiled once per number of coordinates and
//! stages, for all systems of a program. They make up three fifths of the code of a step.

use crate::linear::Matrix;
use crate::motion::{Motion, Point, PointDerivatives, Sides};
use crate::real::{Real, Rounded};
use crate::stepping::Convertible;
use nalgebra::{SMatrix, SVector};

/// From this number of coordinates on, a step keeps the masses of an earlier iteration: their inverses take longer than
/// the rest. Measured for chains of links and 4 stages: 12 links 2.9, 40 links 5 times as fast.
pub(crate) const MANY: usize = 12;

/// Form of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EquationForm {
    /// Constant mass matrix, and forces of the position alone: [`Motion::SEPARABLE`].
    Separable,
    /// Constant mass matrix: [`Motion::CONSTANT_MASS`].
    ConstantMass,
    /// Variable mass matrix.
    VaryingMass,
    /// Variable mass matrix, and momenta that other coordinates scale: [`Motion::CURVILINEAR`].
    Curvilinear,
    /// No mass matrix: [`Motion::is_first_order`].
    FirstOrder,
}

impl EquationForm {
    /// The form of the equations of a type; `None` for a type of systems that differ.
    const fn known<Y: Motion<N, T>, const N: usize, T: Real>() -> Option<Self> {
        if Y::INTERPRETED {
            None
        } else {
            Some(Self::from([!Y::WITHOUT_VELOCITY.is_empty(), Y::SEPARABLE, Y::CONSTANT_MASS, Y::CURVILINEAR]))
        }
    }

    /// The form of the equations of a system.
    #[inline(always)]
    fn of<const N: usize, T: Real>(system: &impl Motion<N, T>) -> Self {
        Self::from([
            system.is_first_order(),
            system.is_separable(),
            system.has_constant_mass(),
            system.is_curvilinear(),
        ])
    }

    /// The form of equations that are of first order, separable, with a constant mass matrix, curvilinear.
    const fn from(are: [bool; 4]) -> Self {
        match are {
            [true, ..] => Self::FirstOrder,
            [_, true, ..] => Self::Separable,
            [_, _, true, _] => Self::ConstantMass,
            [.., true] => Self::Curvilinear,
            _ => Self::VaryingMass,
        }
    }

    /// Whether the mass matrix varies.
    pub(crate) const fn varies_mass(self) -> bool {
        matches!(self, Self::VaryingMass | Self::Curvilinear)
    }

    /// Whether the type of a system guarantees this form. `if const { … }` then does not compile the other branch.
    pub(crate) const fn is_known(self, known: Option<Self>) -> bool {
        matches!(known, Some(known) if known as u8 == self as u8)
    }
}

/// Equations of motion over the numbers T.
pub(crate) trait Points<const N: usize, T: Real> {
    /// Matrix type of the mass matrix.
    type Mass: Matrix<N, T>;

    /// The form, if the type of the system determines it.
    const FORM: Option<EquationForm>;

    /// The form of the equations.
    fn form(&self) -> EquationForm;
    /// [`Motion::moving`].
    fn moving(&self) -> usize;
    /// [`Motion::point`].
    fn at(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass>;
    /// [`Motion::sides`].
    fn sides_at(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Sides<N, T>;
    /// [`Motion::sides_and_inverse`].
    #[inline(always)]
    fn sides_and_inverse_at(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        inverse: &mut SMatrix<T, N, N>,
    ) -> Sides<N, T> {
        self.at(t, q, v).sides_and_inverse(inverse)
    }
    /// [`Motion::applied_force`].
    #[inline(always)]
    fn force_at(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.sides_at(t, q, v).force
    }
}

impl<Y: Motion<N, T>, const N: usize, T: Real> Points<N, T> for Y {
    type Mass = Y::Mass;

    const FORM: Option<EquationForm> = EquationForm::known::<Y, N, T>();

    #[inline(always)]
    fn form(&self) -> EquationForm {
        EquationForm::of(self)
    }

    #[inline(always)]
    fn moving(&self) -> usize {
        Motion::moving(self)
    }

    #[inline(always)]
    fn at(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Y::Mass> {
        self.point(t, q, v)
    }

    #[inline(always)]
    fn sides_at(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Sides<N, T> {
        self.sides(t, q, v)
    }

    #[inline(always)]
    fn sides_and_inverse_at(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        inverse: &mut SMatrix<T, N, N>,
    ) -> Sides<N, T> {
        self.sides_and_inverse(t, q, v, inverse)
    }

    #[inline(always)]
    fn force_at(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.applied_force(t, q, v)
    }
}

/// Fewest stages whose iteration follows momenta. Its contraction proves no step: near solutions beyond a pole it is small.
/// Resolved stages prove it, but three are not resolved where a velocity changes its sign.
const FOLLOWING: usize = 4;

/// Whether an iteration of S stages evaluates forces at the velocities of the momenta.
#[inline(always)]
pub(crate) fn follows_momenta<Y: Points<N, T>, T: Real, const N: usize, const S: usize>(system: &Y) -> bool {
    S >= FOLLOWING && system.moving() < MANY && system.form() == EquationForm::Curvilinear
}

/// A point with a dense mass matrix, for any system.
type AnyPoint<const N: usize, T> = Point<N, T, SMatrix<T, N, N>>;

/// Derivatives of the equations at a point, for any system.
pub(crate) type AnyDerivatives<const N: usize> = PointDerivatives<SMatrix<f64, N, N>>;

/// A type-erased system.
trait Erased<const N: usize> {
    fn form(&self) -> EquationForm;
    fn moving(&self) -> usize;
    fn without_velocity(&self) -> &'static [bool];
    fn plain(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> AnyPoint<N, f64>;
    fn sides(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Sides<N, f64>;
    fn derivatives(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> AnyDerivatives<N>;
    fn rounded(&self, t: Rounded, q: &SVector<Rounded, N>, v: &SVector<Rounded, N>) -> AnyPoint<N, Rounded>;
}

impl<S: Convertible<N>, const N: usize> Erased<N> for S {
    fn form(&self) -> EquationForm {
        EquationForm::of(self)
    }

    fn moving(&self) -> usize {
        Motion::moving(self)
    }

    fn without_velocity(&self) -> &'static [bool] {
        Motion::without_velocity(self)
    }

    fn plain(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> AnyPoint<N, f64> {
        dense(self, t, q, v)
    }

    fn sides(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Sides<N, f64> {
        // Few coordinates do without this copy of their equations.
        if const { N < MANY } { self.plain(t, q, v).sides() } else { self.convert::<f64>().sides(t, q, v) }
    }

    fn derivatives(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> AnyDerivatives<N> {
        let PointDerivatives { momentum_dq, mass, force_dq, force_dv } =
            self.convert::<f64>().point_derivatives(t, q, v);
        PointDerivatives {
            momentum_dq: momentum_dq.dense(),
            mass: mass.dense(),
            force_dq: force_dq.dense(),
            force_dv: force_dv.dense(),
        }
    }

    fn rounded(&self, t: Rounded, q: &SVector<Rounded, N>, v: &SVector<Rounded, N>) -> AnyPoint<N, Rounded> {
        dense(self, t, q, v)
    }
}

/// Evaluates a point over the numbers T, with a dense mass matrix.
fn dense<S: Convertible<N>, T: Real, const N: usize>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> AnyPoint<N, T> {
    let Point { momentum, force, mass } = system.convert::<T>().point(t, q, v);
    Point { momentum, force, mass: mass.dense() }
}

/// A type-erased system.
#[derive(Clone, Copy)]
pub(crate) struct ErasedSystem<'a, const N: usize> {
    system: &'a dyn Erased<N>,
    /// Whether its iterations evaluate forces at the velocities of the last iteration in curvilinear coordinates, too.
    is_lagging: bool,
}

impl<'a, const N: usize> ErasedSystem<'a, N> {
    /// Erases the type of the system.
    pub(crate) fn of<S: Convertible<N>>(system: &'a S) -> Self {
        Self { system, is_lagging: false }
    }

    /// The same system, with iterations that do not follow momenta: their contraction proves a step.
    pub(crate) fn lagging(self) -> Self {
        Self { is_lagging: true, ..self }
    }

    /// [`Motion::without_velocity`].
    pub(crate) fn without_velocity(&self) -> &'static [bool] {
        self.system.without_velocity()
    }

    /// Derivatives of L_v and L_q + f.
    pub(crate) fn derivatives(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> AnyDerivatives<N> {
        self.system.derivatives(t, q, v)
    }
}

macro_rules! erased_points {
    ($($number:ty, $point:ident, $sides:expr);*) => {$(
        impl<const N: usize> Points<N, $number> for ErasedSystem<'_, N> {
            type Mass = SMatrix<$number, N, N>;

            const FORM: Option<EquationForm> = None;

            fn form(&self) -> EquationForm {
                match self.system.form() {
                    EquationForm::Curvilinear if self.is_lagging => EquationForm::VaryingMass,
                    form => form,
                }
            }

            fn moving(&self) -> usize {
                self.system.moving()
            }

            fn at(&self, t: $number, q: &SVector<$number, N>, v: &SVector<$number, N>) -> AnyPoint<N, $number> {
                self.system.$point(t, q, v)
            }

            fn sides_at(&self, t: $number, q: &SVector<$number, N>, v: &SVector<$number, N>) -> Sides<N, $number> {
                $sides(self, t, q, v)
            }
        }
    )*};
}

erased_points! {
    f64, plain, |of: &Self, t, q: &_, v: &_| of.system.sides(t, q, v);
    Rounded, rounded, |of: &Self, t, q: &_, v: &_| of.system.rounded(t, q, v).sides()
}
