//! Steppers that are timed.
//!
//! In: a stepper of any type. Out: a [`Run`], so that steppers of different types are in one list. It contains the loop
//! over the steps, so that a step is inlined into the loop as in a user's program.

use std::cell::Cell;
use vi_core::derivatives::{Covector, Differentiable, Objective, Tangent, gradient};
use vi_core::stepping::{Batch, Convertible};
use vi_core::{Lagrangian, Method, State, StepError};
use vi_ensemble::Ensemble;

/// A stepper that takes one step at a time.
pub trait Stepper: Clone {
    /// Takes one step.
    ///
    /// # Panics
    /// If the step does not exist; every run here has all its steps.
    fn step(&mut self);
    /// Time, coordinates and momenta, in this order.
    fn state(&self) -> Vec<f64>;
}

/// A stepper of any kind, at the start of its run.
pub trait Run {
    /// The state after a number of steps from the start.
    fn run(&self, steps: usize) -> Vec<f64>;
}

impl<S: Stepper> Run for S {
    #[inline(never)]
    fn run(&self, steps: usize) -> Vec<f64> {
        // A copy may live in registers.
        let mut stepper = self.clone();
        for _ in 0..steps {
            stepper.step();
        }
        stepper.state()
    }
}

/// The result of a step, which must exist.
#[inline]
fn taken<T>(outcome: Result<T, StepError>) -> T {
    outcome.unwrap_or_else(|failure| panic!("{failure}"))
}

fn flat<const N: usize>(state: State<N>) -> Vec<f64> {
    [state.t].into_iter().chain(state.q.iter().copied()).chain(state.p.iter().copied()).collect()
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Stepper for vi_core::Run<M, S, N> {
    #[inline]
    fn step(&mut self) {
        taken(vi_core::Run::step(self));
    }

    // A call with the address of the run would keep it in memory.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn state(&self) -> Vec<f64> {
        flat(vi_core::Run::state(self))
    }
}

/// One block of trajectories or less, which the thread that asks moves by itself.
impl<S: Batch<N>, const N: usize> Run for Ensemble<S, N> {
    fn run(&self, steps: usize) -> Vec<f64> {
        let mut ensemble = self.clone();
        Ensemble::run(&mut ensemble, steps as u64);
        match ensemble.results().next() {
            Some(Ok(state)) => flat(state),
            outcome => panic!("no state, but {outcome:?}"),
        }
    }
}

impl<M: Differentiable<S, N>, S: Convertible<N>, const N: usize> Stepper for Tangent<M, S, N> {
    fn step(&mut self) {
        taken(Tangent::step(self));
    }

    fn state(&self) -> Vec<f64> {
        flat(self.run().state())
    }
}

/// A stepper of the same system in other coordinates: its state is cut or filled up to the length of that of the others.
#[derive(Clone, Debug)]
pub struct Other<S>(pub S, pub usize);

impl<S: Stepper> Stepper for Other<S> {
    #[inline]
    fn step(&mut self) {
        self.0.step();
    }

    fn state(&self) -> Vec<f64> {
        let Self(stepper, length) = self;
        let mut state = stepper.state();
        state.resize(*length, 0.0);
        state
    }
}

/// The gradient of the last coordinate that a run reaches, and whether all of its nodes are kept, or as few as may be.
pub struct Adjoint<M: Method<S, N>, S, const N: usize> {
    /// The run.
    pub run: vi_core::Run<M, S, N>,
    /// Whether all nodes are kept.
    pub keeps_all: bool,
}

impl<M: Differentiable<S, N>, S: Convertible<N>, const N: usize> Run for Adjoint<M, S, N> {
    fn run(&self, steps: usize) -> Vec<f64> {
        let end = Cell::new(None);
        let kept = if self.keeps_all { steps } else { 0 };
        let steps = steps as u64;
        taken(gradient(&self.run, steps, kept, &Last { steps, end: &end }));
        flat(end.get().expect("the sweep begins at the end"))
    }
}

/// The last coordinate after a number of steps, and the state there.
struct Last<'a, const N: usize> {
    steps: u64,
    end: &'a Cell<Option<State<N>>>,
}

impl<M: Method<S, N>, S, const N: usize> Objective<M, S, N> for Last<'_, N> {
    fn slope(&self, step: u64, state: &State<N>) -> Covector<N> {
        let mut slope = Covector::zero();
        if step == self.steps {
            self.end.set(Some(*state));
            slope.q[N - 1] = 1.0;
        }
        slope
    }
}
