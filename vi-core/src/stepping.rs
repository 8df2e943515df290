//! The equations of one step from a node, in the unknowns `(v, h)`: `q1 = q0 + h v`, `t1 = t0 + h`.
//!
//! For a node, h and v, the traits return the residuals of the discrete equations ([`crate::discrete`]), with
//! derivatives and rounding-error bounds. They also return the increments of momentum and energy. Every rule implements
//! [`FixedStepping`]. Rules whose steps have a density also implement [`EnergyStepping`].

use crate::discrete::DiscreteLagrangian;
use crate::error::StepError;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::linear::Matrix;
use crate::motion::Motion;
use crate::newton::FLOOR;
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::rules::Own;
use nalgebra::{SMatrix, SVector};

/// The momentum equation of a step of given length by the rule R.
///
/// Systems are small and `Copy`. Cold paths get a copy, so that the hot loop stays in registers.
#[diagnostic::on_unimplemented(
    message = "`{Self}` takes no fixed steps by the rule `{R}`",
    note = "add `discretize midpoint;` to `{Self}`; `Own` is the first rule of that clause, and `discretize midpoint, trapezoidal;` adds another",
    note = "`Gauss` and `EnergyPreservingGauss` need no rule",
    note = "a system with constraints takes the steps of `Gauss`; `Gauss::<1>` is its midpoint rule"
)]
pub trait FixedStepping<const N: usize, T: Real = f64, R = Own>: Lagrangian<N, T> + Copy {
    /// Matrix type of A, with its zero pattern.
    type Jacobian: Matrix<N, T>;
    /// Matrix type of the other [`MomentumDerivatives`], with their joint zero pattern.
    type StepMatrix: Matrix<N, T>;
    /// Name of the rule, unless it is the first rule of the system. A checkpoint stores it.
    const RULE: Option<&'static str> = None;
    /// Whether A depends on parameters and h only. The equation is then linear, and A is inverted once per run.
    const CONSTANT_JACOBIAN: bool;
    /// Whether v and the momentum increment are an affine function of (q, p) with constant coefficients: A is constant,
    /// the increment is linear in the state, and nothing depends on the time. Pays off for a few coordinates only.
    const CLOSED_FORM: bool = false;
    /// Whether the functions of a momentum step are short. They are then inlined and compute rounding scales only on
    /// request, so that a loop over trajectories vectorizes.
    const INLINED: bool = false;

    /// [`FixedStepping::CONSTANT_JACOBIAN`]. This function and the next two return their constants, except those of a
    /// system that is known at run time only.
    #[inline(always)]
    fn has_constant_jacobian(&self) -> bool {
        Self::CONSTANT_JACOBIAN
    }
    /// [`FixedStepping::CLOSED_FORM`].
    #[inline(always)]
    fn has_closed_form(&self) -> bool {
        Self::CLOSED_FORM
    }
    /// [`FixedStepping::INLINED`].
    #[inline(always)]
    fn is_inlined(&self) -> bool {
        Self::INLINED
    }

    /// Evaluates the momentum equation at the trial velocity `v` for the step length `h`.
    ///
    /// At `h = 0` its root is the velocity of the momenta `p`.
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, Self::Jacobian>;
    /// Evaluates its residual, and the momentum increment of the step.
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T>;
    /// Evaluates the derivatives of that residual and of the momentum increment with respect to q0 and v.
    fn momentum_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumDerivatives<Self::Jacobian, Self::StepMatrix>;
    /// Rounding-error bound of that residual by running error analysis, in units of `ε`.
    fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N>;
    /// Discrete energy `E1 = −D3 L_d − g_d⁺` at the end of the step. It does not depend on the momenta and energy of
    /// the node.
    fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T;
}

/// Momentum and energy equation of a step of unknown length by the rule R.
///
/// Only rules whose step density D keeps its sign implement it, because the length follows from `h² D/8 = H − E`. The
/// density of the trapezoidal rule, `|V_q|² − 2 v·V_qq v`, changes its sign in every period of an oscillator.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no energy-preserving step of order 2 by the rule `{R}`",
    label = "no rule of this system has a step density",
    note = "add `discretize midpoint;` to `{Self}`, or `midpoint` to its `discretize`: the midpoint rule has a step density",
    note = "`EnergyPreservingGauss` needs no rule; `FixedStep` and `Composition` take any"
)]
pub trait EnergyStepping<const N: usize, T: Real = f64, R = Own>: FixedStepping<N, T, R> {
    /// Step density `D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)`, with derivatives along the trajectory.
    ///
    /// For small h an energy-preserving step exists as long as D keeps its sign.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix is singular, [`StepError::NonFinite`] if a derivative of L or f is
    /// not finite.
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError>;
    /// Evaluates the momentum and energy equations at the trial `(v, h)`.
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, Self::Jacobian>;
    /// Evaluates both residuals, and the increments of momentum and energy.
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T>;
    /// Evaluates the derivatives of both residuals and of both increments with respect to q0 and (v, h).
    fn extended_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> ExtendedDerivatives<N, T, Self::Jacobian, Self::StepMatrix>;
    /// Rounding-error bounds of both residuals, by running error analysis.
    fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T>;
}

/// A system that evaluates in other number types. Every generated system does.
pub trait Convertible<const N: usize>: Motion<N> {
    /// The same system over the numbers T.
    type In<T: Real>: Motion<N, T, Kind = Self::Kind> + Parameters<T>;
    /// Whether Gauss steps evaluate all stages in SIMD vectors, with one copy of the code per instruction set.
    const SIDE_BY_SIDE: bool = true;

    /// Converts the system; every parameter is rounded to T.
    fn convert<T: Real>(&self) -> Self::In<T>;
}

/// A system that steps by the rule R over every number type. Generated systems implement it for the rules of their
/// `discretize`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` takes no fixed steps by the rule `{R}`",
    note = "add `discretize midpoint;` to `{Self}`; `Own` is the first rule of that clause, and `discretize midpoint, trapezoidal;` adds another",
    note = "`Gauss` and `EnergyPreservingGauss` need no rule"
)]
pub trait Discretized<const N: usize, R = Own>:
    FixedStepping<N, f64, R> + DiscreteLagrangian<N, f64, R> + Convertible<N>
{
    /// The same system over the numbers T.
    type Steps<T: Real>: Motion<N, T> + FixedStepping<N, T, R> + DiscreteLagrangian<N, T, R> + Parameters<T>;

    /// Converts the system; every parameter is rounded to T.
    fn steps<T: Real>(&self) -> Self::Steps<T>;
}

/// A system that can be integrated in batches, each member with its own parameters.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be integrated in an ensemble",
    note = "add `discretize midpoint;` to `{Self}`: an ensemble takes fixed steps"
)]
pub trait Batch<const N: usize>: Discretized<N> + Send + Sync {
    /// The parameters of W systems, in structure-of-arrays layout.
    type Rows<const W: usize>: Clone + core::fmt::Debug + Send + Sync;

    /// Packs the parameters of W systems.
    fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W>;
    /// Unpacks the system of this index.
    fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self;
}

/// The momentum equation at a trial velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumEquation<const N: usize, T = f64, J = SMatrix<T, N, N>> {
    /// `−D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// `A = ∂r/∂v`: row i, column j is `∂r_i/∂v_j`.
    pub jacobian: J,
}

/// Momentum and energy equation at a trial `(v, h)`. Its rows are combined and scaled so that the condition number does
/// not depend on `h`.
///
/// With the momentum row `r` and the energy row `e = D1 L_d + g_d⁻ − E0`, the combined row is `c = e − v·r`. Its
/// leading terms, of order one, cancel symbolically. A Newton step `(δv, δh)` solves
///
/// ```text
/// [ A                 ∂r/∂h               ] [ δv/h ]     [ r/h  ]
/// [ (∂e/∂v − v·A)/h   (∂e/∂h − v·∂r/∂h)/h ] [ δh/h ] = − [ c/h² ]
/// ```
///
/// The Schur complement of `A` is `−D/4` to leading order.
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

/// The residual of the momentum equation, and the increment from the same evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumResidual<const N: usize, T = f64> {
    /// `r = −D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// Sums of the absolute values of the terms of r, including those of inner sums. The rounding error of r is at
    /// least an ulp of this.
    pub scale: SVector<T, N>,
    /// `p1 − p0`; see [`Increment::momentum`].
    pub increment: SVector<T, N>,
}

/// The residuals of both equations, and the increments from the same evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedResidual<const N: usize, T = f64> {
    /// `r = −D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// Sums of the absolute values of the terms of r, as in [`MomentumResidual`].
    pub scale: SVector<T, N>,
    /// `c = e − v·r`, `e = D1 L_d + g_d⁻ − E0`.
    pub energy_residual: T,
    /// Sum of the absolute values of the terms of c.
    pub energy_scale: T,
    /// `p1 − p0` and `E1 − E0`.
    pub increment: Increment<N, T>,
}

/// Derivatives of the momentum equation. Row i, column j is the derivative of entry i with respect to coordinate or
/// velocity j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumDerivatives<J, D> {
    /// `∂r/∂q0`.
    pub residual_dq: D,
    /// `A = ∂r/∂v`.
    pub residual_dv: J,
    /// `∂(p1 − p0)/∂q0`.
    pub increment_dq: D,
    /// `∂(p1 − p0)/∂v`.
    pub increment_dv: D,
}

/// Derivatives of both equations. Those with respect to p0 and E0 are `∂r/∂p0 = −1` and `∂e/∂E0 = −1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedDerivatives<const N: usize, T, J, D> {
    /// The momentum row, and `p1 − p0`.
    pub momentum: MomentumDerivatives<J, D>,
    /// `∂r/∂h`.
    pub residual_dh: SVector<T, N>,
    /// `∂(p1 − p0)/∂h`.
    pub increment_dh: SVector<T, N>,
    /// `∂e/∂q0 − v·∂r/∂q0`, e the energy row.
    pub energy_dq: SVector<T, N>,
    /// `(∂e/∂v − v·A)/h`.
    pub energy_dv: SVector<T, N>,
    /// `(∂e/∂h − v·∂r/∂h)/h`.
    pub energy_dh: T,
    /// `∂(E1 − E0)/∂q0`.
    pub energy_increment_dq: SVector<T, N>,
    /// `∂(E1 − E0)/∂v`.
    pub energy_increment_dv: SVector<T, N>,
    /// `∂(E1 − E0)/∂h`.
    pub energy_increment_dh: T,
}

/// Rounding-error bounds of the residuals at a trial `(v, h)`, in units of `ε`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding<const N: usize, T = f64> {
    /// Bounds of the momentum residuals.
    pub residual: SVector<T, N>,
    /// Bound of the combined energy residual c.
    pub energy_residual: T,
    /// Bound of the energy residual `e = D1 L_d + g_d⁻ − E0` itself. In stiff steps it is far below that of c, which
    /// contains v·(h/2) L_q.
    pub energy: T,
}

/// Rounding-error bound of the momentum residual. `system` evaluates in numbers that carry a bound of their rounding
/// error; v and h are the numbers nearest to a root.
#[doc(hidden)]
pub fn momentum_rounding<const N: usize, T: Real>(
    system: &impl FixedStepping<N, Rounded>,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> SVector<T, N> {
    let node = node.map(|number| Rounded::exact(number.to_f64()));
    system.momentum_residual(&node, nearest(h), &v.map(nearest)).residual.map(ulps)
}

/// Rounding-error bounds of both residuals; see [`momentum_rounding`].
#[doc(hidden)]
pub fn extended_rounding<const N: usize, T: Real>(
    system: &impl EnergyStepping<N, Rounded>,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> Rounding<N, T> {
    let node = node.map(|number| Rounded::exact(number.to_f64()));
    let (step, velocity) = (nearest(h), v.map(nearest));
    let measured = system.extended_residual(&node, step, &velocity);
    // Rows at their rounding floor bound e by e = c + v·r.
    let by_rows = measured.energy_residual + velocity.dot(&measured.residual);
    let size = |numbers: &SVector<Rounded, N>| numbers.map(|number| number.to_f64().abs());
    let momenta = size(&node.p) + size(&measured.increment.momentum);
    let own = node.energy.to_f64().abs() + measured.increment.energy.to_f64().abs() + momenta.dot(&size(&velocity));
    let left = by_rows.to_f64().abs() / (FLOOR * T::EPSILON);
    // The analysis of e itself costs more, so it runs only if the rows are at their floor and still leave e above its
    // size. Numbers of fewer digits evaluate another e.
    let is_small = left <= own && T::EPSILON <= f64::EPSILON;
    let energy = if is_small {
        own
    } else if left > by_rows.ulps() {
        by_rows.ulps()
    } else {
        let kept = node.energy + node.energy_low + measured.increment.energy;
        (system.discrete_energy(&node, step, &velocity) - kept).ulps()
    };
    Rounding {
        residual: measured.residual.map(ulps),
        energy_residual: ulps(measured.energy_residual),
        energy: T::real(energy),
    }
}

/// The nearest representable number, with its bound.
fn nearest<T: Real>(number: T) -> Rounded {
    Rounded::nearest(number.to_f64())
}

/// The rounding-error bound, in units of `ε`.
fn ulps<T: Real>(number: Rounded) -> T {
    T::real(number.ulps())
}

/// Increments of momentum and energy over one solved step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increment<const N: usize, T = f64> {
    /// `p1 − p0 = D2 L_d + D4 L_d + f_d⁻ + f_d⁺`; for the midpoint rule `h (L_q + f)`.
    pub momentum: SVector<T, N>,
    /// `E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺`; for the midpoint rule `−h (L_t − f·v)`.
    pub energy: T,
}

impl<const N: usize, T: Real> Node<N, T> {
    /// The node at the end of the step `(v, h)` of a system.
    #[inline(always)]
    pub(crate) fn advanced(
        mut self,
        system: &impl Lagrangian<N, T>,
        h: T,
        v: &SVector<T, N>,
        increment: &Increment<N, T>,
    ) -> Self {
        self.advance(h, v, &increment.momentum);
        // The increment of a conservative system is the constant zero, which the compiler may not drop from a sum.
        if !system.conserves_energy() {
            self.add_energy(increment.energy);
        }
        self
    }

    /// The node at this (t, q) from which `(v, h)` is the step. It has the momenta `p0 = −D2 L_d − f_d⁻` and the energy
    /// `E0 = D1 L_d + g_d⁻`.
    pub(crate) fn leaving<S: EnergyStepping<N, T>>(self, system: &S, h: T, v: &SVector<T, N>) -> Self {
        let zeros = SVector::zeros();
        let bare = Self { p: zeros, p_low: zeros, energy: T::zero(), energy_low: T::zero(), ..self };
        let equations = system.extended_system(&bare, h, v);
        let p = equations.momentum.residual;
        // The energy row is e = c + v·r, and r = p0 because the node has zero momentum.
        Self { p, energy: equations.energy_residual + v.dot(&p), ..bare }
    }
}
