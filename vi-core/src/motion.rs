//! The motion of a system at one point, in the form that collocation needs: `q' = v, p' = L_q + f + AᵀΛ, p = L_v`.
//!
//! One evaluation at a point (t, q, v) gives both sides of `p = L_v` and of `p' = L_q + f`, and the mass matrix:
//!
//! ```text
//! momentum   L_v(t, q, v)          mass   M = L_vv(t, q, v)          force   L_q + f          power   dE/dt = f·v − L_t
//! ```
//!
//! Sensitivities and Newton iteration also need the derivatives with respect to q and v ([`PointDerivatives`]).
//!
//! K constraints hold along every motion of a system of the kind [`Bound<K>`](crate::kind::Bound); a system of the kind
//! [`Free`](crate::kind::Free) has none. Both types of constraints may be in one system; holonomic ones come first:
//!
//! ```text
//! holonomic       g(t, q) = 0              A = ∂g/∂q    a = ∂g/∂t
//! nonholonomic    A(t, q) v + a(t, q) = 0
//! ```
//!
//! A system with the clause `time_scale = g;` also gives g of the time transformation `dt = g(t, q) dτ`
//! ([`TimeScale`]).
//!
//! The velocity of given momenta follows from `v + M⁻¹ (p − L_v(v))`. One correction is exact if L is quadratic in v;
//! otherwise iterate.

use crate::kind::{Gradients, Kind, Multipliers, ReactionMatrix};
use crate::lagrangian::Lagrangian;
use crate::linear::{Block, Matrix};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// The motion of a system with or without constraints; see the [module](self).
///
/// Systems are small and `Copy`. Cold paths get a copy, so that the hot loop stays in registers. Times, coordinates and
/// velocities are in the units of the system.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no equations of motion",
    note = "every `lagrangian!` implements them"
)]
pub trait Motion<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// [`Free`](crate::kind::Free), or [`Bound<K>`](crate::kind::Bound) of K constraints.
    type Kind: Kind;
    /// Matrix type of M, with its zero pattern.
    type Mass: Matrix<N, T>;
    /// Matrix type of [`PointDerivatives`], with the joint zero pattern of all its matrices.
    type PointMatrix: Matrix<N, T>;
    /// Whether M depends on the parameters only.
    const CONSTANT_MASS: bool;
    /// Whether a coordinate scales the momentum of another one, as r that of φ in polar coordinates: `∂p_φ/∂r` is not
    /// zero, but `∂p_r/∂φ` and `∂p_φ/∂v_r` are. Gauss steps then evaluate forces at the velocities of the momenta. It is
    /// false for large systems, whose derivatives are loops.
    const CURVILINEAR: bool = false;
    /// Whether `L_v = M v` with constant M, and neither L_q nor f depends on v. The system is then `q'' = M⁻¹ (L_q +
    /// f)`.
    const SEPARABLE: bool = false;
    /// Whether the motion splits into kicks and drifts: [`Motion::SEPARABLE`], or `L = y·x' − T(y) − V(t, x)` of a system
    /// of first order with forces of time and x alone, and the y in the order of the x.
    const SPLITS: bool = Self::SEPARABLE;
    /// Whether the system has a time scale g. It is then a [`TimeScale`], and [`Motion::scaled_point`] returns g.
    const SCALES_TIME: bool = false;
    /// Whether L_v is M v with a constant diagonal M, and `L_q + f` depends on t alone: point masses in a uniform field.
    const POINT_MASSES: bool = false;
    /// For each coordinate of a system whose L is linear in the velocities, whether L does not contain its velocity; empty
    /// for all other systems. See [`first_order`](mod@crate::first_order).
    const WITHOUT_VELOCITY: &'static [bool] = &[];
    /// Names of the constraints as declared, entries of arrays as `link[3]`. Holonomic constraints come first.
    const CONSTRAINTS: &'static [&'static str] = &[];
    /// The number of holonomic constraints.
    const HOLONOMIC: usize = 0;
    /// The order of elimination of coordinates and multipliers, for all nonzeros of the matrices of this trait together;
    /// without blocks, dense elimination. Multiplier r is unknown N + r.
    const BLOCKS: &'static [Block] = &[];

    /// [`Motion::CONSTANT_MASS`]. This function and the following ones without arguments return their constants, except
    /// those of a system that is known at run time only.
    #[inline(always)]
    fn has_constant_mass(&self) -> bool {
        Self::CONSTANT_MASS
    }
    /// [`Motion::CURVILINEAR`].
    #[inline(always)]
    fn is_curvilinear(&self) -> bool {
        Self::CURVILINEAR
    }
    /// [`Motion::SEPARABLE`].
    #[inline(always)]
    fn is_separable(&self) -> bool {
        Self::SEPARABLE
    }
    /// [`Motion::SPLITS`].
    #[inline(always)]
    fn splits(&self) -> bool {
        Self::SPLITS
    }
    /// [`Motion::SCALES_TIME`].
    #[inline(always)]
    fn scales_time(&self) -> bool {
        Self::SCALES_TIME
    }
    /// [`Motion::POINT_MASSES`].
    #[inline(always)]
    fn has_point_masses(&self) -> bool {
        Self::POINT_MASSES
    }
    /// [`Motion::WITHOUT_VELOCITY`].
    #[inline(always)]
    fn without_velocity(&self) -> &'static [bool] {
        Self::WITHOUT_VELOCITY
    }
    /// Whether L is linear in the velocities.
    #[inline(always)]
    fn is_first_order(&self) -> bool {
        !self.without_velocity().is_empty()
    }
    /// The number of moving coordinates, which come first. Systems of a text may have more, at rest at 0, with the mass
    /// 1 and without forces. Steps leave them out in expensive loops.
    #[inline(always)]
    fn moving(&self) -> usize {
        N
    }
    /// [`Motion::CONSTRAINTS`].
    #[inline(always)]
    fn constraint_names(&self) -> &'static [&'static str] {
        Self::CONSTRAINTS
    }
    /// [`Motion::HOLONOMIC`].
    #[inline(always)]
    fn holonomic(&self) -> usize {
        Self::HOLONOMIC
    }
    /// [`Motion::BLOCKS`].
    #[inline(always)]
    fn blocks(&self) -> &'static [Block] {
        Self::BLOCKS
    }
    /// Evaluates `L_v`, `L_q + f` and M at a point.
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass>;
    /// The same without M.
    #[inline(always)]
    fn sides(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Sides<N, T> {
        self.point(t, q, v).sides()
    }
    /// [`Motion::sides`]; sets the entries of M⁻¹ among the moving coordinates. They are unspecified if M is singular.
    #[inline(always)]
    fn sides_and_inverse(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        inverse: &mut SMatrix<T, N, N>,
    ) -> Sides<N, T> {
        self.point(t, q, v).sides_and_inverse(inverse)
    }
    /// `L_q + f` alone.
    #[inline(always)]
    fn applied_force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.sides(t, q, v).force
    }
    /// Evaluates the derivatives of both sides at a point.
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix>;
    /// `f·v − L_t`, the rate of change of the energy without the power `−Λ·a` of the constraints.
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// Evaluates everything that a step in transformed time needs at a point. Without a time scale, g = 1.
    #[inline(always)]
    fn scaled_point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ScaledPoint<N, T, Self::Mass> {
        ScaledPoint {
            point: self.point(t, q, v),
            energy: self.energy(t, q, v),
            power: self.power(t, q, v),
            g: T::one(),
            g_dq: SVector::zeros(),
            g_dt: T::zero(),
        }
    }

    // Functions of the constraints. A free system has the provided ones. A bound system without its own does not
    // compile.

    /// `L_q + f − L_vt − L_vq v`: M times the acceleration without the reaction. Zero at the velocity of a system of first
    /// order, which needs its own function.
    fn applied(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        const { assert!(Self::Kind::COUNT == 0, "a system with constraints needs its own `applied`") };
        let unknown = |_| SVector::repeat(T::real(f64::NAN));
        let acceleration = self.acceleration(t, q, v).unwrap_or_else(unknown);
        self.point(t, q, v).mass.multiply(&acceleration)
    }
    /// g(t, q) of the holonomic constraints; zero for the others.
    fn constraints(&self, _t: T, _q: &SVector<T, N>) -> Multipliers<Self, N, T> {
        const { assert!(Self::Kind::COUNT == 0, "a system with constraints needs its own `constraints`") };
        Self::Kind::no_multipliers()
    }
    /// A and a: `g_q` and `g_t` of a holonomic constraint; the coefficients of v and the rest of a nonholonomic one.
    fn constraint_gradients(&self, _t: T, _q: &SVector<T, N>) -> (Gradients<Self, N, T>, Multipliers<Self, N, T>) {
        const { assert!(Self::Kind::COUNT == 0, "a system with constraints needs its own `constraint_gradients`") };
        (Self::Kind::no_gradients(), Self::Kind::no_multipliers())
    }
    /// `(A v + a)_q`, one row for each constraint, and `(A v + a)_t`.
    fn constraint_rate_derivatives(
        &self,
        _t: T,
        _q: &SVector<T, N>,
        _v: &SVector<T, N>,
    ) -> (Gradients<Self, N, T>, Multipliers<Self, N, T>) {
        const { assert!(Self::Kind::COUNT == 0, "a system with constraints needs its own rate derivatives") };
        (Self::Kind::no_gradients(), Self::Kind::no_multipliers())
    }
    /// `∂(Aᵀλ)/∂q` for constant multipliers λ. Row i, column j is the derivative of entry i with respect to coordinate
    /// j.
    fn reaction_derivatives(
        &self,
        _t: T,
        _q: &SVector<T, N>,
        _multipliers: &Multipliers<Self, N, T>,
    ) -> ReactionMatrix<Self, N, T> {
        const { assert!(Self::Kind::COUNT == 0, "a system with constraints needs its own `reaction_derivatives`") };
        Self::Kind::no_reaction()
    }
    /// Whether the constraint of this index follows from the others and has no multiplier: its gradients are then zero.
    /// Only [`Independent`](crate::constrained::Independent) drops constraints.
    fn is_dropped(&self, _constraint: usize) -> bool {
        false
    }
    /// The system without the constraints of these indices, which have to follow from the others; `None` if its type keeps
    /// all. Only [`Independent`](crate::constrained::Independent) drops some.
    fn without(&self, _constraints: &[usize]) -> Option<Self> {
        None
    }
    /// The first dropped constraint that does not hold at a node, by its index, with its value.
    fn broken(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> Option<(usize, T)> {
        None
    }
}

/// A system with a time scale, `dt = g(t, q) dτ`, from the clause `time_scale = g;` of `lagrangian!`.
/// [`Motion::scaled_point`] returns g.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no time scale",
    label = "this system declares no time scale",
    note = "write the clause `time_scale = …;` in its `lagrangian!`, as `time_scale = r^(3/2);`",
    note = "`Gauss` takes steps of a given length in time without it"
)]
pub trait TimeScale<const N: usize, T: Real = f64>: Motion<N, T> {}

/// A system with [`Motion::SPLITS`], whose motion splits into kicks and drifts ([`Splitting`](crate::Splitting)). Generated systems with this form implement it.
#[diagnostic::on_unimplemented(
    message = "the motion of `{Self}` does not split into kicks and drifts",
    label = "this system has no constant mass matrix, or forces that depend on velocities",
    note = "`Splitting` takes `L = v·M v/2 − V(t, q)` with a constant M, or `H = T(p) + V(t, q)`, and forces of time and coordinates alone",
    note = "`Gauss` integrates every system without constraints"
)]
pub trait Separable<const N: usize, T: Real = f64>: Motion<N, T> {}

/// The equations of motion at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<const N: usize, T, M> {
    /// `L_v`.
    pub momentum: SVector<T, N>,
    /// `L_q + f`.
    pub force: SVector<T, N>,
    /// `M = L_vv`.
    pub mass: M,
}

/// Both sides of the equations of motion at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides<const N: usize, T> {
    /// `L_v`.
    pub momentum: SVector<T, N>,
    /// `L_q + f`.
    pub force: SVector<T, N>,
}

impl<const N: usize, T, M> Point<N, T, M> {
    /// The point without its mass matrix.
    #[inline(always)]
    pub fn sides(self) -> Sides<N, T> {
        Sides { momentum: self.momentum, force: self.force }
    }

    /// [`Motion::sides_and_inverse`].
    #[inline(always)]
    pub(crate) fn sides_and_inverse(self, inverse: &mut SMatrix<T, N, N>) -> Sides<N, T>
    where
        T: Real,
        M: Matrix<N, T>,
    {
        *inverse = self.mass.inverse_unchecked();
        self.sides()
    }
}

/// Derivatives of the equations of motion at a point (t, q, v). Row i, column j is the derivative of entry i with
/// respect to coordinate or velocity j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointDerivatives<D> {
    /// `∂L_v/∂q`.
    pub momentum_dq: D,
    /// `∂L_v/∂v = L_vv`.
    pub mass: D,
    /// `∂(L_q + f)/∂q`.
    pub force_dq: D,
    /// `∂(L_q + f)/∂v`.
    pub force_dv: D,
}

/// The equations of motion and the time scale at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledPoint<const N: usize, T, M> {
    /// The point.
    pub point: Point<N, T, M>,
    /// `v·L_v − L`.
    pub energy: T,
    /// `f·v − L_t`.
    pub power: T,
    /// g = dt/dτ.
    pub g: T,
    /// `∂g/∂q`.
    pub g_dq: SVector<T, N>,
    /// `∂g/∂t`.
    pub g_dt: T,
}
