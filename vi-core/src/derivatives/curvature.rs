//! Second derivatives of a number that depends on the end of a step.
//!
//! The unknowns u of a step solve `R(u, z) = 0`, and its end is `Z(u, z)`. For weights w of the end, the multipliers μ
//! make the derivative of Φ with respect to u zero:
//!
//! ```text
//! Φ(u, z) = w·Z(u, z) + μ·R(u, z)        R_uᵀ μ = −Z_uᵀ w
//! ```
//!
//! Then the second derivative of `w·Z(u(z), z)` along δz and δz' is that of Φ along (δu, δz) and (δu', δz'). δu is the
//! change of u along δz. No second derivative of u is needed. Nested dual numbers differentiate Φ.

use super::variation::{
    Covector, TOGETHER, Variation, Varied, not_finite, singular_mass, slope_along, unsolved, velocity_along,
};
use crate::error::StepError;
use crate::kind::Kind;
use crate::lagrangian::Parameters;
use crate::linear::{self, Matrix};
use crate::motion::{Motion, Sides};
use crate::node::Node;
use crate::real::{Dual, Number as _, Real as _};
use crate::state::State;
use crate::stepping::{Convertible, Discretized, FixedStepping as _, MomentumDerivatives, MomentumResidual};
use alloc::vec::Vec;
use nalgebra::{DMatrix, SVector};

/// A number with its derivatives along one direction, along several others, and along pairs of them.
pub(crate) type Curved = Dual<Varied>;

/// One direction and up to [`TOGETHER`] others.
#[derive(Clone, Copy)]
pub(crate) struct Pairs<'a, D> {
    one: &'a D,
    others: &'a [D],
}

impl<D> Pairs<'_, D> {
    /// The number with its derivative along each direction; `of` selects it.
    pub(crate) fn number(&self, value: f64, of: impl Fn(&D) -> f64) -> Curved {
        let mut number = Curved::real(value);
        number.slope.value = of(self.one);
        for (slope, other) in number.value.slope.0.iter_mut().zip(self.others) {
            *slope = of(other);
        }
        number
    }

    /// The vector with its derivatives along each direction.
    pub(crate) fn vector<const N: usize>(
        &self,
        value: &SVector<f64, N>,
        of: impl Fn(&D) -> &SVector<f64, N>,
    ) -> SVector<Curved, N> {
        SVector::from_fn(|k, _| self.number(value[k], |direction| of(direction)[k]))
    }

    /// Sets the derivatives of the parameters of these names.
    pub(crate) fn vary<Y: Parameters<Curved>>(&self, names: &[&str], mut system: Y, of: impl Fn(&D) -> &[f64]) -> Y {
        for (index, name) in names.iter().enumerate() {
            let slope = |direction: &D| of(direction).get(index).copied().unwrap_or(0.0);
            if slope(self.one) == 0.0 && self.others.iter().all(|other| slope(other) == 0.0) {
                continue;
            }
            if let Some(parameter) = system.parameter_mut(name) {
                *parameter = self.number(parameter.to_f64(), slope);
            }
        }
        system
    }
}

/// The second derivatives of a number along all pairs of directions.
///
/// # Errors
/// [`StepError::NonFinite`] for the step from the time `t`.
pub(crate) fn second_derivatives<D>(
    directions: &[D],
    t: f64,
    of: impl Fn(Pairs<'_, D>) -> Curved,
) -> Result<DMatrix<f64>, StepError> {
    let mut matrix = DMatrix::zeros(directions.len(), directions.len());
    for (row, one) in directions.iter().enumerate() {
        for (chunk, others) in directions[row..].chunks(TOGETHER).enumerate() {
            let found = of(Pairs { one, others }).slope.slope.0;
            for (column, second) in (row + chunk * TOGETHER..directions.len()).zip(found) {
                matrix[(row, column)] = second;
                matrix[(column, row)] = second;
            }
        }
    }
    if matrix.iter().all(|entry| entry.is_finite()) { Ok(matrix) } else { Err(not_finite(t)) }
}

/// [`Motion::sides`], not inlined: it is large over these numbers.
#[inline(never)]
pub(crate) fn sides<Y: Motion<N, Curved>, const N: usize>(
    system: &Y,
    t: Curved,
    q: &SVector<Curved, N>,
    v: &SVector<Curved, N>,
) -> Sides<N, Curved> {
    system.sides(t, q, v)
}

/// A tangent vector with the velocity along it.
struct TangentWithVelocity<const N: usize> {
    start: Variation<N>,
    v: SVector<f64, N>,
}

/// The first derivatives of `w·q + y·v(t, q, p)` at a state with respect to q and p, and its second derivatives along
/// pairs of tangent vectors. `None` for systems with constraints, and for those whose L is linear in the velocities.
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix is singular; those of [`State::velocity`]; [`StepError::NonFinite`].
pub fn velocity_curvature<S: Convertible<N>, const N: usize>(
    system: &S,
    state: &State<N>,
    directions: &[Variation<N>],
    [w, y]: [&SVector<f64, N>; 2],
) -> Result<Option<(Covector<N>, DMatrix<f64>)>, StepError> {
    if S::Kind::COUNT > 0 || system.is_first_order() {
        return Ok(None);
    }
    let State { t, q, .. } = state;
    let v = state.velocity(system)?;
    let along = |start: &Variation<N>| {
        let v = velocity_along(system, state, &v, start)?;
        Ok(TangentWithVelocity { start: start.clone(), v })
    };
    let directions = directions.iter().map(along).collect::<Result<Vec<_>, StepError>>()?;
    let derivatives = system.point_derivatives(*t, q, &v);
    // L_v(t, q, v) = p
    let multipliers = linear::solve(&derivatives.mass.dense(), &-y).ok_or(singular_mass(*t))?;
    let curved = system.convert::<Curved>();
    let matrix = second_derivatives(&directions, *t, |pairs| {
        let system = pairs.vary(system.parameters(), curved, |of| &of.start.parameters);
        let t = pairs.number(*t, |of| of.start.t);
        let q = pairs.vector(q, |of| &of.start.q);
        let v = pairs.vector(&v, |of| &of.v);
        sides(&system, t, &q, &v).momentum.dot(&multipliers.map(Curved::real))
    })?;
    let q = w + derivatives.momentum_dq.dense().tr_mul(&multipliers);
    Ok(Some((Covector { q, p: -multipliers, ..Covector::zero() }, matrix)))
}

/// The first derivatives of the weighted end of the momentum step `(v, h)` from a node with respect to q and p, and its
/// second derivatives along pairs of tangent vectors. The length h is `part` times that of a whole step.
pub(super) fn of_momentum_step<S: Discretized<N>, const N: usize>(
    system: &S,
    node: &Node<N>,
    [h, part]: [f64; 2],
    v: &SVector<f64, N>,
    variations: &[Variation<N>],
    end: &Covector<N>,
) -> Result<(Covector<N>, DMatrix<f64>), StepError> {
    let derivatives = &system.momentum_derivatives(node, h, v);
    let MomentumDerivatives { residual_dq, residual_dv, increment_dq, increment_dv } = derivatives;
    let right = -(end.q * h + increment_dv.dense().tr_mul(&end.p));
    let unsolved = |right: &_| unsolved(residual_dv, right, node.t);
    let multipliers = linear::solve(&residual_dv.dense().transpose(), &right).ok_or_else(|| unsolved(&right))?;
    let mut directions = Vec::with_capacity(variations.len());
    for variations in variations.chunks(TOGETHER) {
        let system: S::Steps<Varied> = Variation::steps(variations, system);
        let length = Variation::number(variations, h, |variation| part * variation.h);
        let varied = system.momentum_residual(&Variation::node(variations, node), length, &v.map(Dual::fixed));
        for (direction, start) in variations.iter().enumerate() {
            let residual = slope_along(direction, &varied.residual);
            let v = -linear::solve(residual_dv, &residual).ok_or_else(|| unsolved(&residual))?;
            directions.push(TangentWithVelocity { start: start.clone(), v });
        }
    }
    let curved = system.steps::<Curved>();
    let matrix = second_derivatives(&directions, node.t, |pairs| {
        let system = pairs.vary(system.parameters(), curved, |of| &of.start.parameters);
        let t = pairs.number(node.t, |of| of.start.t);
        let q = pairs.vector(&node.q, |of| &of.start.q);
        let h = pairs.number(h, |of| part * of.start.h);
        let v = pairs.vector(v, |of| &of.v);
        // Momenta are in the residual alone, linearly.
        let node = Node { t, q, ..node.map(Curved::real) };
        let MomentumResidual { residual, increment, .. } = system.momentum_residual(&node, h, &v);
        let [drift, kick] = [&end.q, &end.p].map(|weights| weights.map(Curved::real));
        residual.dot(&multipliers.map(Curved::real)) + increment.dot(&kick) + h * v.dot(&drift)
    })?;
    let q = end.q + residual_dq.dense().tr_mul(&multipliers) + increment_dq.dense().tr_mul(&end.p);
    Ok((Covector { q, p: end.p - multipliers, ..Covector::zero() }, matrix))
}
