//! Acceleration, flow and reaction of a system with constraints at a state.
//!
//! Velocities of momenta satisfy the constraints too. With multipliers μ, which are zero for consistent momenta,
//!
//! ```text
//! L_v(t, q, v) = p + Aᵀμ        A v + a = 0
//! ```

use super::{border, bordered, diagonal, inertia, is_reduced, reaction_of, reaction_terms, spread};
use crate::error::{BORDERED_MASS, Residuals, StepError};
use crate::kind::Multipliers;
use crate::lagrangian::Flow;
use crate::linear::{Bordered, Rectangular, Unsolvable};
use crate::motion::Motion;
use crate::newton::{FLOOR, roundings};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::State;
use crate::vector::worse;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

const ITERATIONS: u32 = 40;
const HALVINGS: u32 = 12;
/// Largest residual that corrections no longer reduce, in ulps of the terms outside of L_v: terms that cancel inside of
/// L_v are larger.
const STALLED: f64 = 64.0;
/// A reduction of the residual by this factor shows that the factors of the bordered matrix are still good.
const GOOD: f64 = 1e-3;

/// Largest value of a constraint, and of its rate, over the size of its terms, at a point whose acceleration is
/// requested: users compute such points to fewer digits than nodes have.
const SATISFIED: f64 = 1e-9;

/// The same at a state whose reaction is requested: a cubic between two nodes is off the constraints by O(h⁴).
const NEAR: f64 = 1e-2;

/// A velocity of momenta.
pub(crate) struct Velocity<const N: usize, T, M> {
    pub(crate) v: SVector<T, N>,
    /// `L_v(v)`.
    pub(crate) momentum: SVector<T, N>,
    /// `L_v(v) − p = Aᵀμ`.
    pub(crate) mu: M,
    pub(crate) residual: f64,
}

/// The error of a bordered matrix at the time t.
pub(crate) fn unsolvable(failure: Unsolvable, t: f64) -> StepError {
    match failure {
        Unsolvable::Singular => StepError::Singular { t, matrix: BORDERED_MASS },
        Unsolvable::NonFinite => StepError::NonFinite { t, quantity: BORDERED_MASS, expression: None },
    }
}

/// Acceleration and multipliers Λ of the motion at (t, q, v). Factors the bordered matrix.
///
/// # Errors
/// [`StepError::Singular`] and [`StepError::NonFinite`].
pub(crate) fn accelerations<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    bordered: &mut Bordered<T>,
) -> Result<(SVector<T, N>, Multipliers<S, N, T>), StepError> {
    let (gradients, _) = system.constraint_gradients(t, q);
    let (rates_dq, mut multipliers) = system.constraint_rate_derivatives(t, q, v);
    let factored = border(bordered, system, &system.point(t, q, v).mass, &gradients);
    factored.map_err(|failure| unsolvable(failure, t.to_f64()))?;
    let mut a = system.applied(t, q, v);
    for (entry, row) in multipliers.as_mut().iter_mut().zip(rates_dq.rows()) {
        *entry = -(*entry + row.dot(v));
    }
    bordered.solve(&mut a, multipliers.as_mut());
    if a.iter().chain(multipliers.as_ref()).all(|entry| entry.is_finite()) {
        Ok((a, multipliers))
    } else {
        Err(StepError::NonFinite { t: t.to_f64(), quantity: "acceleration", expression: None })
    }
}

/// The velocity of the momenta p by Newton iteration from a guess. It satisfies the constraints; the multipliers are
/// the impulse that makes p consistent. Factors the bordered matrix.
///
/// # Errors
/// [`StepError::Singular`], [`StepError::NonFinite`], and [`StepError::NotConverged`] with h = 0.
pub(crate) fn velocity<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    (t, q, p): (T, &SVector<T, N>, &SVector<T, N>),
    guess: &SVector<T, N>,
    bordered: &mut Bordered<T>,
) -> Result<Velocity<N, T, Multipliers<S, N, T>>, StepError> {
    let (gradients, offsets) = system.constraint_gradients(t, q);
    let mut zero = offsets;
    zero.as_mut().fill(T::zero());
    let at = |v: SVector<T, N>, mu: Multipliers<S, N, T>| {
        let point = system.point(t, q, &v);
        let reaction = reaction_of(&gradients, mu.as_ref());
        let of_reaction = reaction_terms(&gradients, mu.as_ref());
        let momentum = (point.momentum - p) - reaction;
        let inertia = inertia(&point.mass, &v);
        let mass = diagonal(&point.mass);
        let [momenta, _] = spread(&point.mass, &v, p);
        let mut residual = 0.0;
        let mut known = SVector::<T, N>::zeros();
        for i in 0..N {
            let scale = point.momentum[i].abs() + p[i].abs() + inertia[i] + of_reaction[i] + momenta[i];
            residual = worse(roundings(momentum[i], scale), residual);
            // A velocity is known to the terms of its momentum.
            known[i] = if mass[i].is_positive() { scale / mass[i] } else { T::zero() };
        }
        let mut strict = residual;
        let mut rates = offsets;
        for (rate, gradient) in rates.as_mut().iter_mut().zip(gradients.rows()) {
            let scale = rate.abs() + gradient.terms(&v);
            *rate += gradient.dot(&v);
            strict = worse(roundings(*rate, scale), strict);
            residual = worse(roundings(*rate, scale + gradient.terms(&known)), residual);
        }
        (Velocity { v, momentum: point.momentum, mu, residual }, momentum, rates, point.mass, strict)
    };
    // `strict` is the residual over the terms of the rates alone, which may be smaller than the roundings of velocities.
    let (mut found, mut momentum, mut rates, mut mass, mut strict) = at(*guess, zero);
    let (mut iterations, mut residuals, mut is_factored) = (0, Residuals::new(), false);
    loop {
        residuals.push(found.residual);
        if found.residual.is_nan() {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "momentum equation", expression: None });
        }
        // Regular at every accepted velocity.
        if !is_factored {
            let factored = border(bordered, system, &mass, &gradients);
            factored.map_err(|failure| unsolvable(failure, t.to_f64()))?;
        }
        if strict <= 1.0 {
            return Ok(found);
        }
        let (mut correction, mut impulses) = (momentum, rates);
        bordered.solve(&mut correction, impulses.as_mut());
        // Near the floor a shorter correction changes nothing.
        let halvings = if found.residual <= FLOOR { 0 } else { HALVINGS };
        let next = (0..=halvings).find_map(|halved| {
            let part = T::real(0.5_f64.powi(i32::try_from(halved).unwrap_or(0)));
            let mut mu = found.mu;
            for (mu, impulse) in mu.as_mut().iter_mut().zip(impulses.as_ref()) {
                *mu -= *impulse * part;
            }
            let next = at(found.v - correction * part, mu);
            let is_nearer = found.residual > FLOOR && next.0.residual < found.residual;
            Some(next).filter(|next| is_nearer || is_reduced(next.4, strict))
        });
        match next {
            Some(next) if iterations < ITERATIONS => {
                is_factored = next.0.residual < GOOD * found.residual;
                (found, momentum, rates, mass, strict) = next;
            }
            _ if found.residual <= STALLED => return Ok(found),
            _ => {
                let (t, residual) = (t.to_f64(), found.residual);
                return Err(StepError::NotConverged { t, h: 0.0, iterations, residual, residuals, turn: 0.0 });
            }
        }
        iterations += 1;
    }
}

/// The acceleration of a system with constraints at a point (t, q, v) that satisfies them.
///
/// # Errors
/// [`StepError::InconsistentStart`] if the coordinates or the velocities do not satisfy a constraint, to nine digits of
/// its terms; [`StepError::DroppedConstraint`] for a dropped one; [`StepError::Singular`] if the bordered mass matrix is
/// singular; [`StepError::NonFinite`] if a derivative is not finite.
pub fn constrained_acceleration<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    satisfied(system, (t, q, v))?;
    accelerations(system, (t, q, v), &mut bordered(system)).map(|(acceleration, _)| acceleration)
}

/// Checks that a point satisfies the constraints. Points that are not finite pass: their acceleration is not finite.
///
/// # Errors
/// [`StepError::InconsistentStart`], [`StepError::DroppedConstraint`].
fn satisfied<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
) -> Result<(), StepError> {
    near(system, (t, q, v), SATISFIED)?;
    match system.broken(t, q, v) {
        Some((r, residual)) if residual.is_finite() => {
            let (t, residual) = (t.to_f64(), residual.to_f64());
            Err(StepError::DroppedConstraint { t, constraint: system.constraint_names()[r], residual })
        }
        _ => Ok(()),
    }
}

/// Checks that a point is off no constraint by more than this part of the terms of its row.
///
/// # Errors
/// [`StepError::InconsistentStart`].
fn near<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    part: f64,
) -> Result<(), StepError> {
    let point = system.point(t, q, v);
    let [_, positions] = spread(&point.mass, q, &SVector::zeros());
    let [_, velocities] = spread(&point.mass, v, &point.momentum);
    // An angle has the size of a radian, and so have coordinates that are all zero.
    let is_unit = |i: usize| system.spaces()[i].is_angle() || q.iter().all(|entry| entry.to_f64() == 0.0);
    let sizes = SVector::<T, N>::from_fn(|i, _| {
        let size = q[i].abs() + positions[i];
        if is_unit(i) { size + T::one() } else { size }
    });
    let values = system.constraints(t, q);
    let (gradients, offsets) = system.constraint_gradients(t, q);
    let is_off = |value: T, terms: T| value.to_f64().abs() > part * terms.to_f64();
    for (r, constraint) in system.constraint_names().iter().enumerate().filter(|(r, _)| !system.is_dropped(*r)) {
        let (value, offset, row) = (values.as_ref()[r], offsets.as_ref()[r], gradients.row(r));
        let rate = row.dot(v) + offset;
        let of_value = row.terms(&sizes) + (offset * t).abs();
        let of_rate = row.terms(v) + row.terms(&velocities) + offset.abs();
        // At rest a velocity is the rounding of a rounding, which no motion shows, in any unit of time.
        let floor = T::real(f64::EPSILON * f64::EPSILON / part) * of_value;
        if is_off(value, of_value) || is_off(rate, of_rate + floor) {
            let (residual, rate) = (value.to_f64(), rate.to_f64());
            return Err(StepError::InconsistentStart { constraint, residual, rate });
        }
    }
    Ok(())
}

/// The flow of a system with constraints at (t, q, p): the force is `L_q + f + AᵀΛ`, the power `f·v − L_t − Λ·a`.
///
/// The velocity satisfies the constraints. Inconsistent momenta have that of the nearest consistent ones.
///
/// # Errors
/// As [`constrained_acceleration`]; [`StepError::NotConverged`] if no velocity has these momenta.
pub fn constrained_flow<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    p: &SVector<T, N>,
) -> Result<Flow<N, T>, StepError> {
    let bordered = &mut bordered(system);
    let Velocity { v, .. } = from_rest(system, (t, q, p), bordered)?;
    let (_, multipliers) = accelerations(system, (t, q, &v), bordered)?;
    let (gradients, offsets) = system.constraint_gradients(t, q);
    let reaction = reaction_of(&gradients, multipliers.as_ref());
    let of_constraints = offsets.as_ref().iter().zip(multipliers.as_ref());
    let power = of_constraints.fold(system.power(t, q, &v), |sum, (a, multiplier)| sum - *a * *multiplier);
    Ok(Flow { v, force: system.point(t, q, &v).force + reaction, power })
}

/// [`velocity`] from rest; from the momenta as a guess if that fails.
///
/// # Errors
/// The errors of the second guess.
pub(crate) fn from_rest<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    (t, q, p): (T, &SVector<T, N>, &SVector<T, N>),
    bordered: &mut Bordered<T>,
) -> Result<Velocity<N, T, Multipliers<S, N, T>>, StepError> {
    velocity(system, (t, q, p), &SVector::zeros(), bordered).or_else(|failure| match failure {
        StepError::Singular { .. } => Err(failure),
        _ => velocity(system, (t, q, p), p, bordered),
    })
}

impl<const N: usize, T: Scalar> State<N, T> {
    /// The multipliers Λ of the motion at this state, one for each constraint, in the order of
    /// [`Motion::CONSTRAINTS`]. They are as accurate as the state: dense output leaves it a little off the constraints.
    /// Their unit is that of energy over that of the constraint; for a nonholonomic constraint, of power over that of the constraint.
    ///
    /// # Errors
    /// As [`State::velocity`]; [`StepError::Singular`] if the constraints are redundant here;
    /// [`StepError::InconsistentStart`] for coordinates off a constraint by more than a hundredth of its terms.
    pub fn reaction<S: Motion<N, T>>(&self, system: &S) -> Result<Multipliers<S, N, T>, StepError> {
        let node = Node::new(*self, T::zero());
        let bordered = &mut bordered(system);
        let found = node.check_finite(T::zero()).and_then(|()| from_rest(system, (self.t, &self.q, &self.p), bordered));
        let found = found.and_then(|Velocity { v, .. }| {
            near(system, (self.t, &self.q, &v), NEAR)?;
            accelerations(system, (self.t, &self.q, &v), bordered)
        });
        found.map(|(_, multipliers)| multipliers).map_err(|failure| failure.explained_at(system, &node, T::zero()))
    }

    /// The reaction `AᵀΛ` at this state: the generalized force of all constraints on each coordinate.
    ///
    /// # Errors
    /// As [`State::reaction`].
    pub fn reaction_force<S: Motion<N, T>>(&self, system: &S) -> Result<SVector<T, N>, StepError> {
        let multipliers = self.reaction(system)?;
        let (gradients, _) = system.constraint_gradients(self.t, &self.q);
        Ok(reaction_of(&gradients, multipliers.as_ref()))
    }
}
