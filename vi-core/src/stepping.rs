//! The equations of one step from a node, in the unknowns `(v, h)`: `q1 = q0 + h v`, `t1 = t0 + h`.
//!
//! In: a node, h and v. Out: the residuals of the discrete equations there ([`crate::discrete`]), their derivatives, what their
//! rounding is measured in, and what momentum and energy gain. A rule gives [`FixedStepping`]; one whose steps have a density gives
//! [`EnergyStepping`] besides.

use crate::collocation::Collocation;
use crate::discrete::DiscreteLagrangian;
use crate::error::StepError;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::linear::Matrix;
use crate::newton::FLOOR;
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::rules::Own;
use nalgebra::{SMatrix, SVector};

/// The momentum equation of a step by the rule R, its length given.
///
/// Systems are small and `Copy`. Cold paths get a copy, so that the hot loop stays in registers.
#[diagnostic::on_unimplemented(
    message = "`{Self}` takes no fixed steps by the rule `{R}`",
    note = "add `discretize midpoint;` to `{Self}`; `Own` is the first rule of that clause, and `discretize midpoint, trapezoidal;` adds another",
    note = "`Gauss` and `EnergyPreservingGauss` need no rule"
)]
pub trait FixedStepping<const N: usize, T: Real = f64, R = Own>: Lagrangian<N, T> + Copy {
    /// The form of A, by its zero pattern.
    type Jacobian: Matrix<N, T>;
    /// The form of the other matrices of [`MomentumDerivatives`], by the zero pattern of all of them.
    type StepMatrix: Matrix<N, T>;
    /// Name of the rule, where it is not the one that the system is declared with: a checkpoint is of one rule.
    const RULE: Option<&'static str> = None;
    /// Whether A depends on parameters and h only: the equation is linear, and A is inverted once per run.
    const CONSTANT_JACOBIAN: bool;
    /// Whether v and what a step adds to p are a constant matrix times (q, p), but for a constant: A is constant, the momenta
    /// gain what is linear in the state, and nothing depends on the time. Worth it for a few coordinates only.
    const CLOSED_FORM: bool = false;
    /// Whether the functions of a momentum step are short. Then they are inlined, the rounding scales are computed only
    /// where they are asked for, and a loop over trajectories becomes vector instructions.
    const INLINED: bool = false;

    /// Momentum equation at the trial velocity `v`, the step `h` given. Defined at `h = 0` too, where its root is the
    /// velocity that belongs to `p`.
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, Self::Jacobian>;
    /// The residual of that equation, and what the momenta gain over the step.
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T>;
    /// How that residual, and what the momenta gain, change with the coordinates of the node and with v.
    fn momentum_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumDerivatives<Self::Jacobian, Self::StepMatrix>;
    /// What the rounding of that residual is measured in, by running error analysis: a residual of `ε` times this is one rounding.
    fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N>;
    /// Discrete energy `E1 = −D3 L_d − g_d⁺` at the end of the step; what momentum and energy the node has does not matter.
    fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T;
}

/// Momentum and energy equation of a step by the rule R, whose length is an unknown.
///
/// Implemented for rules whose steps have a density D that keeps its sign: the length of a step follows from `h² D/8 = H − E`. That of
/// the trapezoidal rule is `|V_q|² − 2 v·V_qq v`, which changes its sign in every swing of an oscillator.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no energy-preserving step of order 2 by the rule `{R}`",
    label = "no rule of this system gives a step its length",
    note = "add `discretize midpoint;` to `{Self}`, or `midpoint` to its `discretize`: the midpoint rule has a step density",
    note = "`EnergyPreservingGauss` needs no rule; `FixedStep` and `Composition` take any"
)]
pub trait EnergyStepping<const N: usize, T: Real = f64, R = Own>: FixedStepping<N, T, R> {
    /// Step density `D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)`, derivatives along the motion.
    /// An energy-preserving step exists, for small h, while D keeps its sign.
    ///
    /// # Errors
    /// [`StepError::Singular`] where the mass matrix cannot be inverted, [`StepError::NonFinite`] where a derivative of L or f is not finite.
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError>;
    /// Momentum and energy equation at the trial `(v, h)`.
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, Self::Jacobian>;
    /// The residuals of both, and what momentum and energy gain over the step.
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T>;
    /// How both residuals, and what momentum and energy gain, change with the coordinates of the node and with (v, h).
    fn extended_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> ExtendedDerivatives<N, T, Self::Jacobian, Self::StepMatrix>;
    /// What the rounding of both residuals is measured in, by running error analysis.
    fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T>;
}

/// A system that can be evaluated in other kinds of numbers, as every generated one can.
pub trait Convertible<const N: usize> {
    /// The same system in the numbers T.
    type In<T: Real>: Collocation<N, T> + Parameters<T>;
    /// Whether Gauss steps evaluate their stages side by side, in vectors, with a copy for each set of instructions.
    const SIDE_BY_SIDE: bool = true;

    /// The same system, every parameter rounded to T.
    fn convert<T: Real>(&self) -> Self::In<T>;
}

/// A system that takes steps by the rule R in every kind of number, as a generated one does by the rules of its `discretize`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` takes no fixed steps by the rule `{R}`",
    note = "add `discretize midpoint;` to `{Self}`; `Own` is the first rule of that clause, and `discretize midpoint, trapezoidal;` adds another",
    note = "`Gauss` and `EnergyPreservingGauss` need no rule"
)]
pub trait Discretized<const N: usize, R = Own>:
    FixedStepping<N, f64, R> + DiscreteLagrangian<N, f64, R> + Convertible<N>
{
    /// The same system in the numbers T.
    type Steps<T: Real>: Collocation<N, T> + FixedStepping<N, T, R> + DiscreteLagrangian<N, T, R> + Parameters<T>;

    /// The same system, every parameter rounded to T.
    fn steps<T: Real>(&self) -> Self::Steps<T>;
}

/// A system of which many can be integrated at once, each with its own parameters.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be integrated in an ensemble",
    note = "add `discretize midpoint;` to `{Self}`: an ensemble takes fixed steps"
)]
pub trait Batch<const N: usize>: Discretized<N> + Send + Sync {
    /// The parameters of W systems, side by side.
    type Rows<const W: usize>: Clone + core::fmt::Debug + Send + Sync;

    /// The parameters of W systems, side by side.
    fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W>;
    /// One of the systems.
    fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self;
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
    pub scale: SVector<T, N>,
    /// `p1 − p0`; see [`Increment::momentum`].
    pub increment: SVector<T, N>,
}

/// The residuals of both equations, and what follows from the same evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtendedResidual<const N: usize, T = f64> {
    /// `r = −D2 L_d − f_d⁻ − p0`.
    pub residual: SVector<T, N>,
    /// Sums of the absolute values of the terms of r, as in [`MomentumResidual`].
    pub scale: SVector<T, N>,
    /// `c = e − v·r`, `e = D1 L_d + g_d⁻ − E0`.
    pub energy_residual: T,
    /// The same sum for c.
    pub energy_scale: T,
    /// `p1 − p0` and `E1 − E0`.
    pub increment: Increment<N, T>,
}

/// How the momentum equation changes: row i, column j is the derivative of entry i by coordinate or velocity j.
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

/// How both equations change. With p0 and E0 they change by `∂r/∂p0 = −1`, `∂e/∂E0 = −1`.
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

/// What rounding moves the residuals at a trial `(v, h)` by at most, in ulps of 1: a residual of `ε` times this is one rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding<const N: usize, T = f64> {
    /// Of each momentum residual.
    pub residual: SVector<T, N>,
    /// Of the combined energy residual c.
    pub energy_residual: T,
    /// Of the energy residual `e = D1 L_d + g_d⁻ − E0` itself. In stiff steps it is far below that of c, which holds v·(h/2) L_q.
    pub energy: T,
}

/// What the rounding of the momentum residual is measured in: that of a system, given in numbers that carry a bound of their
/// rounding; v and h are the numbers nearest to a root.
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

/// The same of both residuals.
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
    // e = c + v·r, as rows at their floor bound it.
    let by_rows = measured.energy_residual + velocity.dot(&measured.residual);
    let size = |numbers: &SVector<Rounded, N>| numbers.map(|number| number.to_f64().abs());
    let momenta = size(&node.p) + size(&measured.increment.momentum);
    let own = node.energy.to_f64().abs() + measured.increment.energy.to_f64().abs() + momenta.dot(&size(&velocity));
    let left = by_rows.to_f64().abs() / (FLOOR * T::EPSILON);
    // Its own analysis is asked for where that matters: where the rows are at their floor, and what they contain leaves e above its size.
    // Numbers of fewer digits measure another e than this one.
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

/// The number nearest to the one that is meant.
fn nearest<T: Real>(number: T) -> Rounded {
    Rounded::nearest(number.to_f64())
}

/// The bound of a rounding.
fn ulps<T: Real>(number: Rounded) -> T {
    T::real(number.ulps())
}

/// What momentum and energy gain over one solved step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increment<const N: usize, T = f64> {
    /// `p1 − p0 = D2 L_d + D4 L_d + f_d⁻ + f_d⁺`; for the midpoint rule `h (L_q + f)`.
    pub momentum: SVector<T, N>,
    /// `E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺`; for the midpoint rule `−h (L_t − f·v)`.
    pub energy: T,
}

impl<const N: usize, T: Real> Node<N, T> {
    /// The node at the end of the step `(v, h)` of a system.
    #[inline]
    pub(crate) fn advanced<S: Lagrangian<N, T>>(
        mut self,
        h: T,
        v: &SVector<T, N>,
        increment: &Increment<N, T>,
    ) -> Self {
        self.advance(h, v, &increment.momentum);
        // Else the increment is the number zero, which the compiler may not leave out of a sum.
        if !S::AUTONOMOUS || S::FORCED {
            self.add_energy(increment.energy);
        }
        self
    }

    /// The same place with the momenta and the energy that make `(v, h)` the step from here:
    /// `p0 = −D2 L_d − f_d⁻`, `E0 = D1 L_d + g_d⁻`.
    pub(crate) fn leaving<S: EnergyStepping<N, T>>(self, system: &S, h: T, v: &SVector<T, N>) -> Self {
        let zeros = SVector::zeros();
        let bare = Self { p: zeros, p_low: zeros, energy: T::zero(), energy_low: T::zero(), ..self };
        let equations = system.extended_system(&bare, h, v);
        let p = equations.momentum.residual;
        // The energy row is e = c + v·r, and r is all of p0 where the node has no momentum.
        Self { p, energy: equations.energy_residual + v.dot(&p), ..bare }
    }
}
