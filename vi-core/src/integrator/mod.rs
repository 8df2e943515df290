//! One way to run a motion: what every integrator does.
//!
//! In: an integrator, and what a user wants of its motion: the state at a time, at many times, where a function vanishes; other
//! parameters or another state from now on. Out: states, or the typed error of the step that fails.
//!
//! | file | what it adds to a step |
//! |---|---|
//! | `path` | the motion between the two nodes of a step, as polynomials |
//! | `grid` | states at given times |
//! | `events` | states at which functions of the motion change their sign |
//! | `search` | the search of one step for them |
//! | `side` | the side of zero on which a function is at a node |
//!
//! A STATE AT A TIME t is reached by a last step that is exactly as long as is left: it is as accurate as a node, of the full order of the
//! method. Steps to times of a grid and to events that are recorded are taken aside, so that the run itself goes on as if nothing had been asked:
//! its steps are those of [`Integrator::step`], bit for bit.

mod events;
mod grid;
mod path;
mod search;
mod side;

pub use events::{Crossing, Crossings, Event, Events, Met, Moment};
pub use grid::Grid;
pub use path::{Hermite, Path};

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::node::Node;
use crate::state::State;
use nalgebra::SVector;

/// Methods of [`Integrator`] that a type has by the same name already.
macro_rules! own {
    ($($method:ident),*) => {
        $($crate::integrator::own!(@$method);)*
    };
    (@step) => {
        #[inline(always)]
        fn step(&mut self) -> Result<$crate::State<N>, $crate::StepError> {
            self.step()
        }
    };
    (@step_of) => {
        fn step_of(&mut self, h: f64) -> Result<$crate::State<N>, $crate::StepError> {
            self.step_of(h)
        }
    };
    (@node) => {
        fn node(&self) -> &$crate::node::Node<N> {
            self.node()
        }
    };
    (@system) => {
        fn system(&self) -> &Self::System {
            self.system()
        }
    };
    (@h) => {
        fn h(&self) -> f64 {
            self.h()
        }
    };
    (@discrete_energy) => {
        fn discrete_energy(&self) -> Option<f64> {
            self.discrete_energy()
        }
    };
    (@checkpoint) => {
        fn checkpoint(&self) -> Self::Checkpoint {
            self.checkpoint()
        }
    };
}
pub(crate) use own;

/// Part of a step by which the last one may be longer.
const LONGER: f64 = 1e-6;

/// What all integrators share; see the [module](self). Time has the unit that the system gives it, and so have steps.
pub trait Integrator<const N: usize>: Clone {
    /// The system that moves.
    type System: Lagrangian<N> + Copy;
    /// The motion between the nodes of a step.
    type Path: Path<N> + 'static;
    /// Everything that a run carries, with the name and the parameters of the system.
    type Checkpoint;

    /// A step is at most so many times as long as [`Integrator::h`] says: 1 where it is always that long, infinite where
    /// nothing is known.
    const LONGEST: f64;

    /// Takes one step, and returns the state reached.
    ///
    /// # Errors
    /// Why there is no step. The integrator holds the last good state, and a further call returns the same error.
    fn step(&mut self) -> Result<State<N>, StepError>;

    /// Takes one step of the length `h` instead of the next one. [`Integrator::h`] stays, and so does the energy that an energy-preserving run keeps.
    ///
    /// # Errors
    /// As [`Integrator::step`], but this error is not kept: the next step may be another. [`StepError::InvalidInput`] for an h that is zero,
    /// subnormal or not finite, or negative where steps lead forward only.
    fn step_of(&mut self, h: f64) -> Result<State<N>, StepError>;

    /// The node reached last: the state with the low parts of its sums.
    fn node(&self) -> &Node<N>;

    /// The system.
    fn system(&self) -> &Self::System;

    /// Length of a step: the one given; where steps find their own, that of the last one.
    fn h(&self) -> f64;

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the last step; an energy-preserving run has kept it. `None` before the first step, after a step of
    /// another length ([`Integrator::step_of`]) and, of Gauss steps, after a change of parameters, where it is not finite, and of a composition, whose step is no interval of one
    /// discrete Lagrangian. The energy at the node, [`Integrator::energy`], is another number.
    fn discrete_energy(&self) -> Option<f64>;

    /// Changes parameters of the system, from the node reached last on: coordinates and momenta stay. An error of the last step is forgotten.
    ///
    /// An energy-preserving run goes on with what the change brought: `E` gains `H_new − H_old` at the node.
    ///
    /// What is said of the last step, as its discrete energy and its path, is by the new parameters from then on. Of Gauss steps nothing is said but the
    /// cubic path between the nodes, until the next step. The last step has no derivative from then on: call [`crate::derivatives::Differentiable::vary`] before.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a parameter that is not finite; [`StepError::Singular`], [`StepError::NotConverged`] or [`StepError::NonFinite`] where the
    /// system with these parameters has no velocity or no energy at the node: the parameters are then what they were.
    fn set_parameters(&mut self, change: impl FnOnce(&mut Self::System)) -> Result<(), StepError>;

    /// Goes on from another state: after an impact, or in another frame. An error of the last step is forgotten.
    ///
    /// An energy-preserving run goes on with the energy that was brought: `E` gains `H(state) − H(node)`.
    ///
    /// # Errors
    /// As a new run from there. The run is then what it was.
    fn set_state(&mut self, state: State<N>) -> Result<(), StepError>;

    /// The motion over the last step, which began at `before`.
    ///
    /// # Errors
    /// [`StepError::Singular`], [`StepError::NotConverged`] or [`StepError::NonFinite`] where no velocity belongs to the momenta at its ends.
    fn path(&self, before: &State<N>) -> Result<Self::Path, StepError>;

    /// Everything that the run carries, to be stored and resumed bit for bit. Allocates.
    fn checkpoint(&self) -> Self::Checkpoint;

    /// The state reached last.
    fn state(&self) -> State<N> {
        self.node().state()
    }

    /// Time of the state reached last.
    fn t(&self) -> f64 {
        self.node().t
    }

    /// Velocity at the state reached last, by its momenta.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    fn velocity(&self) -> Result<SVector<f64, N>, StepError> {
        self.state().velocity(self.system())
    }

    /// The energy `H = v·∂L/∂v − L` at the state reached last, in the units of L.
    ///
    /// # Errors
    /// Those of [`State::energy`].
    fn energy(&self) -> Result<f64, StepError> {
        self.state().energy(self.system())
    }

    /// The time from the node reached last to `t`, by both parts of its time.
    fn time_to(&self, t: f64) -> f64 {
        let node = self.node();
        (t - node.t) - node.t_low
    }

    /// Takes steps up to the time `t`, the last of which ends there: then `state().t` is t.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a time that is not finite, or not ahead of the run; else that of the step that fails, after which the run holds
    /// the last good state.
    fn propagate_until(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.check_ahead(t)?;
        // The loop has an integrator of its own: behind a pointer its numbers would go through memory in every step.
        let mut run = self.clone();
        let mut outcome = Ok(false);
        while let Ok(false) = outcome {
            outcome = run.approach(t);
        }
        *self = run;
        outcome.map(|_| self.state())
    }

    /// The states at the given times, in the order in which the run meets them: an iterator, which takes steps as it needs them. The run ends at its last
    /// node that is not beyond the last of the times.
    fn propagate_grid<'a>(&'a mut self, times: &'a [f64]) -> Grid<'a, Self, N> {
        Grid::new(self, times)
    }

    /// Goes on to the first event, or to the time `until` if there is none before. The run ends there: its state is the one returned. All events of that
    /// instant are in the crossing; see [`Crossing`].
    ///
    /// # Errors
    /// As [`Integrator::propagate_until`], [`StepError::NonFinite`] for a function that is not finite, and [`StepError::CannotLeave`] if the run begins at a
    /// zero of an event of one direction and the motion leads through it again at that instant.
    fn next_event(&mut self, events: impl Events<N>, until: f64) -> Result<Option<Crossing<N>>, StepError> {
        Crossings::new(self, events, until).stop()
    }

    /// [`Integrator::next_event`] for one event.
    ///
    /// # Errors
    /// As there.
    fn until_event(&mut self, event: Event<N>, end: f64) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(event, end)
    }

    /// Goes on to where `g` rises, or to the time `end`: [`Integrator::next_event`] for [`Event::rising`].
    ///
    /// # Errors
    /// As there.
    fn until_rising(
        &mut self,
        g: impl Fn(&Moment<N>) -> f64 + 'static,
        end: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(Event::rising(g), end)
    }

    /// Goes on to where `g` falls, or to the time `end`: [`Integrator::next_event`] for [`Event::falling`].
    ///
    /// # Errors
    /// As there.
    fn until_falling(
        &mut self,
        g: impl Fn(&Moment<N>) -> f64 + 'static,
        end: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(Event::falling(g), end)
    }

    /// The events up to the time `until`, in their order: an iterator, which takes steps as it needs them. The run keeps its own steps, but for the last, which ends
    /// at `until`.
    fn events<'a>(&'a mut self, events: impl Events<N> + 'a, until: f64) -> Crossings<'a, N> {
        Crossings::new(self, events, until)
    }

    /// Whether the run can go on to the time `t`.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] where it cannot.
    #[doc(hidden)]
    fn check_ahead(&self, t: f64) -> Result<(), StepError> {
        if t.is_finite() && self.time_to(t) * self.h().signum() >= 0.0 {
            return Ok(());
        }
        let allowed = "finite, and ahead of the run";
        Err(StepError::InvalidInput { input: "the time to propagate to", allowed, value: t })
    }

    /// Takes one step toward the time `t`, which ends there where the next one would end beyond; returns whether it did.
    #[doc(hidden)]
    fn approach(&mut self, t: f64) -> Result<bool, StepError> {
        let left = self.time_to(t);
        if left == 0.0 {
            self.set_time(t);
            return Ok(true);
        }
        let direction = self.h().signum();
        // Up to a rounding of t the last step may be longer than h, so that none of the length of a rounding follows: but by a part of it only,
        // since far from zero a rounding is many steps.
        let rounding = (f64::EPSILON * t.abs()).min(LONGER * self.h().abs());
        let beyond = (self.longest() - left) * direction + rounding;
        if beyond < 0.0 {
            return self.step().map(|_| false);
        }
        if Self::LONGEST > 1.0 {
            let ahead = self.after_a_step()?;
            if ahead.time_to(t) * direction >= 0.0 {
                *self = ahead;
                return Ok(false);
            }
        }
        self.end_at(t).map(|()| true)
    }

    /// The next step is no longer than this, which has the sign of [`Integrator::h`].
    #[doc(hidden)]
    fn longest(&self) -> f64 {
        Self::LONGEST * self.h()
    }

    /// Takes one step that ends at the time `t`.
    #[doc(hidden)]
    fn end_at(&mut self, t: f64) -> Result<(), StepError> {
        let left = self.time_to(t);
        // A length below the smallest of a step is none.
        if !left.is_normal() {
            self.set_time(t);
            return Ok(());
        }
        // Where the next step ends there, it is that one.
        let is_next = Self::LONGEST <= 1.0 && left.to_bits() == self.h().to_bits();
        let outcome = if is_next { self.step_apart() } else { self.step_of(left) };
        outcome.map(|_| self.set_time(t))
    }

    /// The run after the next step.
    #[doc(hidden)]
    fn after_a_step(&self) -> Result<Self, StepError> {
        let mut ahead = self.clone();
        ahead.step_apart().map(|_| ahead)
    }

    /// [`Integrator::step`] where it is no loop: a step is inlined wherever it stands, and one more copy of it serves all these places.
    #[doc(hidden)]
    #[inline(never)]
    fn step_apart(&mut self) -> Result<State<N>, StepError> {
        self.step()
    }

    /// Sets the time of the node reached last, to which it is equal but for rounding.
    #[doc(hidden)]
    fn set_time(&mut self, t: f64);
}

/// A system with changed parameters.
///
/// # Errors
/// [`StepError::InvalidInput`] for a parameter that is not finite.
pub(crate) fn changed<S: Lagrangian<N> + Copy, const N: usize>(
    system: &S,
    change: impl FnOnce(&mut S),
) -> Result<S, StepError> {
    let mut system = *system;
    change(&mut system);
    let values = (0..S::PARAMETERS.len()).map(|index| system.parameter(index));
    match values.into_iter().find(|value| !value.is_finite()) {
        Some(value) => Err(StepError::InvalidInput { input: "a parameter", allowed: "finite", value }),
        None => Ok(system),
    }
}
