//! Systems with and without constraints: what differs between them, behind one trait.
//!
//! In: a system that implements [`Collocation`](vi_core::collocation::Collocation), or
//! [`Constrained`](vi_core::Constrained). Out: its constraints, their reactions, and states on them. No system implements
//! both traits, but the compiler does not know that: so the kind of a system is a type of its own, [`Unconstrained`] or
//! [`WithConstraints`].

#[cfg(feature = "derivatives")]
use crate::control::{Linear, Rest};
use crate::simulation::{Parametric, RunnableWithConstraints};
use vi_core::constrained::{Extended, Projected};
#[cfg(feature = "derivatives")]
use vi_core::control::{ConstrainedDynamics, Dynamics as _};
#[cfg(feature = "derivatives")]
use vi_core::linear::Matrix as _;
use vi_core::linear::Rectangular as _;
#[cfg(feature = "derivatives")]
use vi_core::nalgebra::SMatrix;
use vi_core::{Lagrangian as _, SVector, State, StepError};

/// Time, coordinates and velocities.
pub(crate) type Point<'a, const N: usize> = (f64, &'a SVector<f64, N>, &'a SVector<f64, N>);

/// The kind of a system: with or without constraints.
pub trait Mechanics<S: Parametric<N>, const N: usize>: Send + Sync + 'static {
    /// Names of the constraints.
    const CONSTRAINTS: &'static [&'static str];

    /// The state on the constraints that is nearest to a point, as [`State::projected`].
    ///
    /// # Errors
    /// As [`State::projected`].
    fn projected(system: &S, at: Point<'_, N>) -> Result<Projected<N>, StepError>;
    /// A state on the constraints from a point that may be far from them, as [`State::assembled`].
    ///
    /// # Errors
    /// As [`State::assembled`].
    #[cfg(feature = "derivatives")]
    fn assembled(system: &S, at: Point<'_, N>) -> Result<Projected<N>, StepError>;
    /// Appends the multipliers Λ at a state, as [`State::reaction`].
    ///
    /// # Errors
    /// As [`State::reaction`].
    fn reaction(system: &S, state: &State<N>, out: &mut Vec<f64>) -> Result<(), StepError>;
    /// The generalized force of all constraints at a state, as [`State::reaction_force`].
    ///
    /// # Errors
    /// As [`State::reaction`].
    fn reaction_force(system: &S, state: &State<N>) -> Result<SVector<f64, N>, StepError>;
    /// The acceleration at a point, which may be off the constraints, as
    /// [`vi_core::constrained::Extended`].
    ///
    /// # Errors
    /// [`StepError::Singular`], [`StepError::NonFinite`].
    fn extended_acceleration(system: &S, at: Point<'_, N>) -> Result<SVector<f64, N>, StepError>;
    /// Appends g of each constraint at a point, zero for nonholonomic ones; then `A v + a` of each.
    fn residuals(system: &S, at: Point<'_, N>, out: &mut Vec<f64>);
    /// The mass matrix at a point.
    #[cfg(feature = "derivatives")]
    fn mass_matrix(system: &S, at: Point<'_, N>) -> SMatrix<f64, N, N>;
    /// The bias b at a point: `M v' + b` is the reaction `AᵀΛ`, zero without constraints.
    #[cfg(feature = "derivatives")]
    fn bias(system: &S, at: Point<'_, N>) -> SVector<f64, N>;
    /// The linearization at a point.
    ///
    /// # Errors
    /// As [`vi_core::control::Dynamics::linearization`], or [`vi_core::control::ConstrainedDynamics::linearization`].
    #[cfg(feature = "derivatives")]
    fn linearization(system: &S, at: Point<'_, N>) -> Result<Linear, StepError>;
    /// The equilibrium near coordinates.
    ///
    /// # Errors
    /// As [`vi_core::control::Dynamics::equilibrium`], or [`vi_core::control::ConstrainedDynamics::equilibrium`].
    #[cfg(feature = "derivatives")]
    fn equilibrium(system: &S, t: f64, guess: SVector<f64, N>) -> Result<Rest, StepError>;
}

/// The kind of systems without constraints.
#[derive(Clone, Copy, Debug)]
pub struct Unconstrained;

/// The kind of systems with constraints.
#[derive(Clone, Copy, Debug)]
pub struct WithConstraints;

/// What [`Mechanics`] asks of a system without constraints: control needs more than its runs.
#[cfg(not(feature = "derivatives"))]
use crate::simulation::Parametric as Free;
#[cfg(feature = "derivatives")]
use crate::simulation::Runnable as Free;

impl<S: Free<N>, const N: usize> Mechanics<S, N> for Unconstrained {
    const CONSTRAINTS: &'static [&'static str] = &[];

    fn projected(system: &S, (t, q, v): Point<'_, N>) -> Result<Projected<N>, StepError> {
        let state = State::at(system, t, *q, *v);
        Ok(Projected { state, moved_q: SVector::zeros(), moved_v: SVector::zeros(), energy_lost: 0.0 })
    }

    #[cfg(feature = "derivatives")]
    fn assembled(system: &S, at: Point<'_, N>) -> Result<Projected<N>, StepError> {
        <Self as Mechanics<S, N>>::projected(system, at)
    }

    fn reaction(_: &S, _: &State<N>, _: &mut Vec<f64>) -> Result<(), StepError> {
        Ok(())
    }

    fn reaction_force(_: &S, _: &State<N>) -> Result<SVector<f64, N>, StepError> {
        Ok(SVector::zeros())
    }

    fn extended_acceleration(system: &S, (t, q, v): Point<'_, N>) -> Result<SVector<f64, N>, StepError> {
        system.acceleration(t, q, v)
    }

    fn residuals(_: &S, _: Point<'_, N>, _: &mut Vec<f64>) {}

    #[cfg(feature = "derivatives")]
    fn mass_matrix(system: &S, (t, q, v): Point<'_, N>) -> SMatrix<f64, N, N> {
        system.mass_matrix(t, *q, *v)
    }

    #[cfg(feature = "derivatives")]
    fn bias(system: &S, (t, q, v): Point<'_, N>) -> SVector<f64, N> {
        system.bias(t, *q, *v)
    }

    #[cfg(feature = "derivatives")]
    fn linearization(system: &S, (t, q, v): Point<'_, N>) -> Result<Linear, StepError> {
        system.linearization(t, *q, *v).map(Linear::from)
    }

    #[cfg(feature = "derivatives")]
    fn equilibrium(system: &S, t: f64, guess: SVector<f64, N>) -> Result<Rest, StepError> {
        Rest::of(&system.equilibrium(t, guess)?)
    }
}

impl<S: RunnableWithConstraints<N>, const N: usize> Mechanics<S, N> for WithConstraints {
    const CONSTRAINTS: &'static [&'static str] = S::CONSTRAINTS;

    fn projected(system: &S, (t, q, v): Point<'_, N>) -> Result<Projected<N>, StepError> {
        State::projected(system, t, *q, *v)
    }

    #[cfg(feature = "derivatives")]
    fn assembled(system: &S, (t, q, v): Point<'_, N>) -> Result<Projected<N>, StepError> {
        State::assembled(system, t, *q, *v)
    }

    fn reaction(system: &S, state: &State<N>, out: &mut Vec<f64>) -> Result<(), StepError> {
        out.extend_from_slice(state.reaction(system)?.as_ref());
        Ok(())
    }

    fn reaction_force(system: &S, state: &State<N>) -> Result<SVector<f64, N>, StepError> {
        state.reaction_force(system)
    }

    fn extended_acceleration(system: &S, (t, q, v): Point<'_, N>) -> Result<SVector<f64, N>, StepError> {
        Extended(*system).acceleration(t, q, v)
    }

    fn residuals(system: &S, (t, q, v): Point<'_, N>, out: &mut Vec<f64>) {
        out.extend_from_slice(system.constraints(t, q).as_ref());
        let (gradients, offsets) = system.constraint_gradients(t, q);
        out.extend(gradients.rows().zip(offsets.as_ref()).map(|(gradient, offset)| gradient.dot(v) + offset));
    }

    #[cfg(feature = "derivatives")]
    fn mass_matrix(system: &S, (t, q, v): Point<'_, N>) -> SMatrix<f64, N, N> {
        system.point(t, q, v).mass.dense()
    }

    #[cfg(feature = "derivatives")]
    fn bias(system: &S, (t, q, v): Point<'_, N>) -> SVector<f64, N> {
        -system.applied(t, q, v)
    }

    #[cfg(feature = "derivatives")]
    fn linearization(system: &S, (t, q, v): Point<'_, N>) -> Result<Linear, StepError> {
        ConstrainedDynamics::linearization(system, t, *q, *v).map(Linear::from)
    }

    #[cfg(feature = "derivatives")]
    fn equilibrium(system: &S, t: f64, guess: SVector<f64, N>) -> Result<Rest, StepError> {
        Rest::on_constraints(&ConstrainedDynamics::equilibrium(system, t, guess)?)
    }
}

/// The largest of the absolute values; NaN if one is NaN.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| if value.is_nan() || value.abs() > most { value.abs() } else { most })
}
