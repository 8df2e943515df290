//! What a system says of itself: the traits that `lagrangian!` implements.
//!
//! Signs and slots are those of `docs/mathematics.md`. Over one interval `(t0, q0) → (t1, q1)`, `h = t1 − t0`:
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0          momentum equation
//!  D1 L_d + g_d⁻ = E0          energy equation
//!  p1 =  D4 L_d + f_d⁺
//!  E1 = −D3 L_d − g_d⁺
//! ```

use crate::linear::Matrix;
use crate::real::Rounded;
use crate::{Interval, Node, Real, StepError};
use nalgebra::{SMatrix, SVector};

/// The continuous system: Lagrangian `L(t, q, v)` and generalized force `f(t, q, v)`.
pub trait Lagrangian<const N: usize, T: Real = f64> {
    /// Name of the system, as declared.
    const NAME: &'static str;
    /// Names of the coordinates, as declared.
    const COORDINATES: [&'static str; N];
    /// Whether neither L nor f depends on the time.
    const AUTONOMOUS: bool;
    /// Whether there is a generalized force.
    const FORCED: bool;
    /// Which coordinates do not appear in L and have no force: their momenta are conserved.
    const CYCLIC: [bool; N];
    /// Names of the parameters, as declared.
    const PARAMETERS: &'static [&'static str] = &[];

    /// The value of the parameter of this index in [`Lagrangian::PARAMETERS`].
    fn parameter(&self, _index: usize) -> T {
        T::zero()
    }
    /// L(t, q, v).
    fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// Energy `v·∂L/∂v − L`.
    fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// Momentum `∂L/∂v`.
    fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>;
    /// Generalized force f; zero where none is declared.
    fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>;
    /// Acceleration `a = (∂²L/∂v²)⁻¹ (L_q + f − L_vt − L_vq v)`.
    ///
    /// # Errors
    /// [`StepError::Singular`] where the mass matrix cannot be inverted.
    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError>;
    /// Step density `D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)`, derivatives along the motion.
    /// An energy-preserving step exists, for small h, while D keeps its sign.
    ///
    /// # Errors
    /// [`StepError::Singular`] where the mass matrix cannot be inverted.
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError>;
    /// Where a value was lost: the first of what L and f are made of that is not finite at `(t, q, v)`, as text; parts
    /// before wholes. `None` where everything is finite, and for a system that does not say.
    fn non_finite(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> Option<&'static str> {
        None
    }
}

/// The discrete system: the discrete Lagrangian, its slot derivatives, discrete forces and powers.
pub trait DiscreteLagrangian<const N: usize, T: Real = f64>: Lagrangian<N, T> {
    /// Discrete Lagrangian `L_d(t0, q0, t1, q1)`.
    fn ld(&self, interval: &Interval<N, T>) -> T;
    /// `∂L_d/∂t0`.
    fn d1_ld(&self, interval: &Interval<N, T>) -> T;
    /// `∂L_d/∂q0`.
    fn d2_ld(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// `∂L_d/∂t1`.
    fn d3_ld(&self, interval: &Interval<N, T>) -> T;
    /// `∂L_d/∂q1`.
    fn d4_ld(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// Discrete force on `δq0`.
    fn fd_minus(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// Discrete force on `δq1`.
    fn fd_plus(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// Discrete power on `δt0`.
    fn gd_minus(&self, interval: &Interval<N, T>) -> T;
    /// Discrete power on `δt1`.
    fn gd_plus(&self, interval: &Interval<N, T>) -> T;
}

/// The equations of one step from a node, in the unknowns `(v, h)`: `q1 = q0 + h v`, `t1 = t0 + h`.
///
/// A system is a few numbers, or a reference to them, and copied: what is lent to the rare paths of a step is a copy, so that
/// the numbers of the common path stay in registers.
pub trait Stepping<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// The form of A, by its zero pattern.
    type Jacobian: Matrix<N, T>;
    /// Whether A depends on parameters and h only: the equation is linear, and A is inverted once per run.
    const CONSTANT_JACOBIAN: bool;
    /// Whether v and what a step adds to p are a constant matrix times (q, p), but for a constant: A is constant, the momenta
    /// gain what is linear in the state, and nothing depends on the time. Worth it for a few coordinates only.
    const CLOSED_FORM: bool = false;
    /// Whether the functions of a momentum step are short. Then they are inlined, the magnitudes of their terms are computed only
    /// where they are asked for, and a loop over trajectories becomes vector instructions.
    const INLINED: bool = false;

    /// Momentum equation at the trial velocity `v`, the step `h` given. Defined at `h = 0` too, where its root is the
    /// velocity that belongs to `p`.
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, Self::Jacobian>;
    /// The residual of that equation, and what the momenta gain over the step.
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T>;
    /// Momentum and energy equation at the trial `(v, h)`.
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, Self::Jacobian>;
    /// The residuals of both, and what momentum and energy gain over the step.
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T>;
    /// What the rounding of both residuals is measured in.
    fn rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T>;
}

/// The momentum equation at a trial velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumEquation<const N: usize, T = f64, J = SMatrix<T, N, N>> {
    /// `−D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// `A`, the derivative of the residual by `v`: row i, column j is `∂r_i/∂v_j`.
    pub jacobian: J,
}

/// Momentum and energy equation at a trial `(v, h)`, rows combined and scaled so that the condition number does not
/// depend on `h`.
///
/// With the momentum row `r` and the energy row `e = D1 L_d + g_d⁻ − E0`, the combined row is `c = e − v·r`; its
/// leading terms, of order one, are cancelled symbolically. A Newton step `(δv, δh)` solves
///
/// ```text
/// [ A                 ∂r/∂h               ] [ δv/h ]     [ r/h  ]
/// [ (∂e/∂v − v·A)/h   (∂e/∂h − v·∂r/∂h)/h ] [ δh/h ] = − [ c/h² ]
/// ```
///
/// whose Schur complement of `A` is `−D/4` to leading order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedSystem<const N: usize, T = f64, J = SMatrix<T, N, N>> {
    /// The momentum row `r` and its block `A`.
    pub momentum: MomentumEquation<N, T, J>,
    /// `∂r/∂h`.
    pub residual_dh: SVector<T, N>,
    /// `c = e − v·r`, unscaled.
    pub energy_residual: T,
    /// `(∂e/∂v − v·A)/h`.
    pub energy_dv: SVector<T, N>,
    /// `(∂e/∂h − v·∂r/∂h)/h`.
    pub energy_dh: T,
}

/// The residual of the momentum equation, and what follows from the same evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumResidual<const N: usize, T = f64> {
    /// `r = −D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// Sums of the absolute values of the terms of r, sums inside them term by term: r is known to an ulp of this at best.
    pub magnitude: SVector<T, N>,
    /// `p1 − p0`; see [`Increment::momentum`].
    pub increment: SVector<T, N>,
}

/// The residuals of both equations, and what follows from the same evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedResidual<const N: usize, T = f64> {
    /// `r = −D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// Sums of the absolute values of the terms of r, as in [`MomentumResidual`].
    pub magnitude: SVector<T, N>,
    /// `c = e − v·r`, `e = D1 L_d + g_d⁻ − E0`.
    pub energy_residual: T,
    /// The same sum for c.
    pub energy_magnitude: T,
    /// `p1 − p0` and `E1 − E0`.
    pub increment: Increment<N, T>,
}

/// What rounding moves the residuals at a trial `(v, h)` by at most, in ulps of 1: a residual of `ε` times this is one rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding<const N: usize, T = f64> {
    /// Of each momentum residual.
    pub residual: SVector<T, N>,
    /// Of the combined energy residual c.
    pub energy_residual: T,
}

impl<const N: usize, T: Real> Rounding<N, T> {
    /// That of a system, given in numbers that carry a bound of their rounding; v and h are the numbers nearest to a root.
    pub fn of(system: &impl Stepping<N, Rounded>, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Self {
        let nearest = |number: T| Rounded::nearest(number.to_f64());
        let node = node.map(|number| Rounded::exact(number.to_f64()));
        let found = system.extended_residual(&node, nearest(h), &v.map(nearest));
        // Bounds are in halves of an ulp.
        let ulps = |number: Rounded| T::real(0.5 * number.error());
        Self { residual: found.residual.map(ulps), energy_residual: ulps(found.energy_residual) }
    }
}

/// What momentum and energy gain over one solved step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increment<const N: usize, T = f64> {
    /// `p1 − p0 = D2 L_d + D4 L_d + f_d⁻ + f_d⁺`; for the midpoint rule `h (L_q + f)`.
    pub momentum: SVector<T, N>,
    /// `E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺`; for the midpoint rule `−h (L_t − f·v)`.
    pub energy: T,
}

/// The parameters of a system, by name; [`Lagrangian::PARAMETERS`] lists them.
pub trait Parameters<T: Real = f64> {
    /// The parameter of this name, for reading and writing.
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T>;
}

/// A system of which many can be integrated at once, each with its own parameters.
pub trait Batch<const N: usize>: Stepping<N> + Copy + Send + Sync {
    /// The parameters of W systems, side by side.
    type Rows<const W: usize>: Clone + core::fmt::Debug + Send + Sync;
    /// The system in another kind of number.
    type In<T: Real>: Stepping<N, T>;
    /// The parameters of W systems, side by side.
    fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W>;
    /// One of the systems, every parameter rounded to `T`.
    fn pick<T: Real, const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self::In<T>;
}

/// What a system says of itself, said by what dereferences to it.
macro_rules! lagrangian_of_target {
    ($of:ty) => {
        impl<const N: usize, T: Real, S: Lagrangian<N, T>> Lagrangian<N, T> for $of {
            const NAME: &'static str = S::NAME;
            const COORDINATES: [&'static str; N] = S::COORDINATES;
            const AUTONOMOUS: bool = S::AUTONOMOUS;
            const FORCED: bool = S::FORCED;
            const CYCLIC: [bool; N] = S::CYCLIC;
            const PARAMETERS: &'static [&'static str] = S::PARAMETERS;

            fn parameter(&self, index: usize) -> T {
                S::parameter(self, index)
            }

            #[inline]
            fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
                S::lagrangian(self, t, q, v)
            }

            #[inline]
            fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
                S::energy(self, t, q, v)
            }

            #[inline]
            fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
                S::momentum(self, t, q, v)
            }

            #[inline]
            fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
                S::force(self, t, q, v)
            }

            #[inline]
            fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
                S::acceleration(self, t, q, v)
            }

            #[inline]
            fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError> {
                S::step_density(self, t, q, v)
            }

            fn non_finite(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<&'static str> {
                S::non_finite(self, t, q, v)
            }
        }
    };
}

pub(crate) use lagrangian_of_target;

// A system may be lent as well as given.
lagrangian_of_target!(&S);

impl<const N: usize, T: Real, S: DiscreteLagrangian<N, T>> DiscreteLagrangian<N, T> for &S {
    #[inline]
    fn ld(&self, interval: &Interval<N, T>) -> T {
        S::ld(self, interval)
    }

    #[inline]
    fn d1_ld(&self, interval: &Interval<N, T>) -> T {
        S::d1_ld(self, interval)
    }

    #[inline]
    fn d2_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        S::d2_ld(self, interval)
    }

    #[inline]
    fn d3_ld(&self, interval: &Interval<N, T>) -> T {
        S::d3_ld(self, interval)
    }

    #[inline]
    fn d4_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        S::d4_ld(self, interval)
    }

    #[inline]
    fn fd_minus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        S::fd_minus(self, interval)
    }

    #[inline]
    fn fd_plus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        S::fd_plus(self, interval)
    }

    #[inline]
    fn gd_minus(&self, interval: &Interval<N, T>) -> T {
        S::gd_minus(self, interval)
    }

    #[inline]
    fn gd_plus(&self, interval: &Interval<N, T>) -> T {
        S::gd_plus(self, interval)
    }
}

impl<const N: usize, T: Real, S: Stepping<N, T>> Stepping<N, T> for &S {
    type Jacobian = S::Jacobian;
    const CONSTANT_JACOBIAN: bool = S::CONSTANT_JACOBIAN;
    const CLOSED_FORM: bool = S::CLOSED_FORM;
    const INLINED: bool = S::INLINED;

    #[inline(always)]
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, S::Jacobian> {
        S::momentum_equation(self, node, h, v)
    }

    #[inline(always)]
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
        S::momentum_residual(self, node, h, v)
    }

    #[inline(always)]
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, S::Jacobian> {
        S::extended_system(self, node, h, v)
    }

    #[inline(always)]
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
        S::extended_residual(self, node, h, v)
    }

    fn rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
        S::rounding(self, node, h, v)
    }
}
