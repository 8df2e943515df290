//! The rival: the Runge–Kutta method of order 8 of Dormand and Prince (DOP853), of the crate `differential-equations`.
//!
//! In: the acceleration of a system, an initial state, the end time, and a tolerance, relative and absolute. Out: the
//! final state, each step on the way, and the number of accelerations. The library evaluates fifteen accelerations per
//! accepted step, three of them for dense output, which cannot be disabled. The count is always active: one addition
//! per some ten operations of a stage.

use core::array;
use core::cell::Cell;
use core::fmt;
use differential_equations::control::ControlFlag;
use differential_equations::error::Error;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::ExplicitRungeKutta;
use differential_equations::ode::{ODE, solve_ode};
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;
use differential_equations::traits::State;
use vi_core::check::Trajectory;
use vi_core::{Lagrangian, SVector, StepError};

/// The reason why a run did not reach its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ended {
    /// A step failed, or the acceleration.
    Step(StepError),
    /// The rival stopped at this time, for this reason.
    Rival(f64, &'static str),
    /// The steps became too short to finish the run.
    Short(f64),
    /// The final state is not finite.
    NonFinite,
}

impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.reason().fmt(f),
            Self::Rival(t, reason) => write!(f, "{reason} at t = {t:.9}"),
            Self::Short(t) => write!(f, "the steps became so short that the run was stopped at t = {t:.9}"),
            Self::NonFinite => f.write_str("a number is not finite at the end"),
        }
    }
}

impl From<StepError> for Ended {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

/// Coordinates and velocities as the library stores them.
#[derive(Clone, Copy, Debug)]
struct Phase<const N: usize>([[f64; N]; 2]);

impl<const N: usize> Phase<N> {
    fn of(motion: &Trajectory<N>) -> Self {
        Self([motion.q.into(), motion.v.into()])
    }

    fn at(&self, t: f64) -> Trajectory<N> {
        let [q, v] = self.0;
        Trajectory { t, q: q.into(), v: v.into() }
    }
}

impl<const N: usize> State<f64> for Phase<N> {
    fn len(&self) -> usize {
        2 * N
    }

    fn get_component(&self, index: usize) -> f64 {
        self.0.as_flattened()[index]
    }

    fn set_component(&mut self, index: usize, value: f64) {
        self.0.as_flattened_mut()[index] = value;
    }

    fn map_components_mut<F: FnMut(usize, &mut f64)>(&mut self, mut f: F) {
        self.0.as_flattened_mut().iter_mut().enumerate().for_each(|(index, entry)| f(index, entry));
    }

    fn zeros_like(&self) -> Self {
        Self::zeros()
    }

    fn zeros() -> Self {
        Self(array::from_fn(|_| [0.0; N]))
    }

    fn mul_add_assign(&mut self, alpha: f64, other: &Self) {
        self.add_scaled(alpha, other);
    }

    fn scale_mut(&mut self, alpha: f64) {
        self.scale_by(alpha);
    }
}

/// The motion as a first-order system. If the acceleration fails, the library gets NaN and shortens its step. If that
/// does not help, the run ends with the failure of the acceleration.
struct Equations<'a, S> {
    system: S,
    evaluations: &'a Cell<u64>,
    failure: Cell<Option<StepError>>,
}

impl<S: Lagrangian<N>, const N: usize> ODE<f64, Phase<N>> for Equations<'_, S> {
    fn diff(&self, t: f64, y: &Phase<N>, dydt: &mut Phase<N>) {
        self.evaluations.update(|count| count + 1);
        let [q, v] = y.0;
        let acceleration = self.system.acceleration(t, &q.into(), &v.into()).unwrap_or_else(|error| {
            self.failure.set(Some(error));
            SVector::repeat(f64::NAN)
        });
        dydt.0 = [v, acceleration.into()];
    }
}

/// Passes on every accepted step, and stores the last.
struct StepObserver<'a, const N: usize> {
    last: Trajectory<N>,
    show: &'a mut dyn FnMut(&Trajectory<N>),
}

impl<const N: usize> Solout<f64, Phase<N>> for StepObserver<'_, N> {
    fn solout<I: Interpolation<f64, Phase<N>> + ?Sized>(
        &mut self,
        t: f64,
        _t_prev: f64,
        y: &Phase<N>,
        _y_prev: &Phase<N>,
        _interpolator: &mut I,
        _solution: &mut Solution<f64, Phase<N>>,
    ) -> ControlFlag<f64, Phase<N>> {
        self.last = y.at(t);
        (self.show)(&self.last);
        ControlFlag::Continue
    }
}

/// The motion at `end`. `show` gets the initial state and every step; `evaluations` grows by the number of
/// accelerations.
///
/// # Errors
/// The reason why the run did not reach `end`.
pub fn motion<S: Lagrangian<N>, const N: usize>(
    system: S,
    start: &Trajectory<N>,
    end: f64,
    tolerance: f64,
    evaluations: &Cell<u64>,
    show: &mut dyn FnMut(&Trajectory<N>),
) -> Result<Trajectory<N>, Ended> {
    let equations = Equations { system, evaluations, failure: Cell::new(None) };
    let mut solver = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance).max_steps(usize::MAX);
    let mut watch = StepObserver { last: *start, show };
    let solved = solve_ode(&mut solver, &equations, start.t, end, &Phase::of(start), &mut watch).map(drop);
    let last = watch.last;
    match (solved, equations.failure.get()) {
        (Ok(()), _) => Ok(last),
        (Err(_), Some(failure)) => Err(Ended::Step(failure)),
        (Err(Error::Stiffness { .. }), _) => Err(Ended::Rival(last.t, "the solver reported stiff equations")),
        (Err(Error::StepSize { .. }), _) => Err(Ended::Rival(last.t, "the step became too small")),
        (Err(_), _) => Err(Ended::Rival(last.t, "the solver failed")),
    }
}
