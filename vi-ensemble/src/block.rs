//! Trajectories side by side.
//!
//! In: [`WIDTH`] systems and states, or fewer. Out: where each is after so many steps, or how it ended. A trajectory that a
//! sweep refuses takes that step alone, by the same equations solved to the rounding floor; where that fails it has ended,
//! and its place is filled with what no one looks at.

use crate::dispatch::{self, Instructions};
use crate::ensemble::{Ended, HALF, WIDTH};
use crate::rows::{Nodes, Place, Row, Rows};
use crate::sweep::{Clock, DEPTH, Fixed, Verdict};
use nalgebra::SVector;
use vi_core::{Batch, FixedStep, Node, State, StepError, fixed_step};

/// Steps between two that learn.
const INTERVAL: u64 = 64;

/// Trajectories side by side; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Block<S: Batch<N>, const N: usize> {
    fixed: Fixed<[S::Rows<HALF>; 2]>,
    h: f64,
    steps: u64,
    instructions: Instructions,
    /// The last node, and room for the next one.
    nodes: [Box<Nodes<N>>; 2],
    /// The velocities of the last steps, the newest first.
    velocities: [Box<Rows<N>>; DEPTH],
    verdict: Box<Verdict>,
    /// How many trajectories have not ended.
    running: usize,
    ended: Vec<Option<Ended<N>>>,
}

impl<S: Batch<N>, const N: usize> Block<S, N> {
    /// The block of these trajectories, at least one and at most [`WIDTH`].
    pub(crate) fn new(trajectories: &[(S, State<N>)], h: f64, instructions: Instructions) -> Self {
        let count = trajectories.len();
        // The last trajectory stands in for those that are not there.
        let all: [(S, State<N>); WIDTH] = core::array::from_fn(|lane| trajectories[lane.min(count - 1)]);
        let fixed = Fixed {
            systems: [0, HALF].map(|first| S::rows(&core::array::from_fn(|index| all[first + index].0))),
            t: Row::filled(0.0),
        };
        let verdict = Verdict {
            radius: Row::filled(0.0),
            length: Row::filled(0.0),
            refused: Row::filled(0),
            running: Row::filled(0),
        };
        let mut block = Self {
            fixed,
            h,
            steps: 0,
            instructions,
            nodes: core::array::from_fn(|_| Box::new(Nodes::zeros())),
            velocities: core::array::from_fn(|_| Box::new(Rows::zeros())),
            verdict: Box::new(verdict),
            running: count,
            ended: vec![None; count],
        };
        for (lane, (system, state)) in all.iter().enumerate() {
            let place = Place::of(lane);
            block.fixed.t.set(place, state.t);
            block.verdict.running.set(place, if lane < count { u64::MAX } else { 0 });
            block.nodes[0].set(place, &Node::new(*state, 0.0));
            match FixedStep::new(system, *state, h) {
                Ok(start) => block.velocities.iter_mut().for_each(|v| v.set(place, &start.v())),
                Err(error) => block.end(lane, *state, error),
            }
        }
        block
    }

    /// Ends a trajectory.
    fn end(&mut self, lane: usize, state: State<N>, error: StepError) {
        if let Some(ended) = self.ended.get_mut(lane) {
            *ended = Some(Ended { state, steps: self.steps, error });
            self.running -= 1;
        }
        self.verdict.running.set(Place::of(lane), 0);
    }

    /// How many trajectories there are, ended or not.
    pub(crate) fn len(&self) -> usize {
        self.ended.len()
    }

    /// How many have not ended.
    pub(crate) fn running(&self) -> usize {
        self.running
    }

    /// The state of a trajectory.
    pub(crate) fn result(&self, lane: usize) -> Result<State<N>, Ended<N>> {
        self.ended[lane].map_or_else(|| Ok(self.node(lane).state()), Err)
    }

    /// The last node of a trajectory.
    fn node(&self, lane: usize) -> Node<N> {
        let place = Place::of(lane);
        self.nodes[0].get(place, self.fixed.t.get(place) + self.elapsed())
    }

    /// Time since the start.
    #[allow(clippy::cast_precision_loss)]
    fn elapsed(&self) -> f64 {
        self.steps as f64 * self.h
    }

    /// Takes `steps` steps, or as many as there are trajectories for.
    pub(crate) fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            if self.running == 0 {
                return;
            }
            self.step();
        }
    }

    fn step(&mut self) {
        let instructions = self.instructions;
        let clock = Clock { elapsed: self.elapsed(), h: self.h };
        let Self { fixed, nodes: [start, end], velocities, verdict, .. } = self;
        let [v1, v2, v3, v4, v5, v6, v7, v8, v9, v10, oldest] = velocities;
        // Before there are enough velocities, every step starts from the last one.
        let refused = if self.steps < DEPTH as u64 || self.steps.is_multiple_of(INTERVAL) {
            dispatch::lesson::<S, N>(instructions, fixed, clock, start, end, oldest, verdict, v1)
        } else {
            dispatch::foretold::<S, N>(
                instructions,
                fixed,
                clock,
                start,
                end,
                oldest,
                verdict,
                v1,
                v2,
                v3,
                v4,
                v5,
                v6,
                v7,
                v8,
                v9,
                v10,
            ) && dispatch::again::<S, N>(instructions, fixed, clock, start, end, oldest, verdict)
        };
        if refused {
            self.take_alone();
        }
        self.nodes.swap(0, 1);
        self.velocities.rotate_right(1);
        self.steps += 1;
    }

    /// The step of every trajectory that was refused.
    #[cold]
    fn take_alone(&mut self) {
        for lane in 0..WIDTH {
            let place = Place::of(lane);
            if self.verdict.refused.get(place) & self.verdict.running.get(place) == 0 {
                continue;
            }
            let node = self.node(lane);
            match self.alone(&node, lane) {
                Ok((next, v)) => {
                    self.nodes[1].set(place, &next);
                    self.velocities[DEPTH - 1].set(place, &v);
                }
                Err(error) => self.end(lane, node.state(), error),
            }
        }
    }

    /// The next node of one trajectory and the velocity that leads there.
    fn alone(&self, node: &Node<N>, lane: usize) -> Result<(Node<N>, SVector<f64, N>), StepError> {
        let place = Place::of(lane);
        let system = S::pick::<f64, HALF>(&self.fixed.systems[place.half], place.index);
        let [last, before, ..] = [0, 1].map(|index| self.velocities[index].get(place));
        let v = fixed_step::velocity(&system, node, self.h, last * 2.0 - before, last)?;
        let gain = vi_core::Stepping::increment(&system, node, self.h, &v);
        let mut next = *node;
        next.advance(self.h, &(v * self.h), &gain.momentum);
        next.check_finite(node.t)?;
        Ok((next, v))
    }
}
