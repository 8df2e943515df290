//! Trajectories in vector lanes.
//!
//! In: up to [`WIDTH`] systems and states. Out: the state of each after a number of steps, or how it ended. A step
//! starts from extrapolated velocities,
//!
//! ```text
//! v0 = Σ_j (−1)^j C(n, j + 1) v_j,  j = 0 … n − 1        the polynomial of degree n − 1 through the last n, j = 0 the newest
//! ```
//!
//! Then one pass over the block takes the step, and a second pass repeats it for rejected trajectories. A trajectory
//! that is still rejected takes the step alone: the same equations, converged to the rounding floor. If that fails, the
//! trajectory ends, and its lane is filled with values that nothing reads.

use crate::ended::Ended;
use crate::layout::{HALF, LaneIndex, Nodes, Row, Rows, WIDTH};
use crate::pass::{Elapsed, Extrapolate, Fixed, Pass, Rejections};
use nalgebra::SVector;
use vi_core::node::Node;
use vi_core::stepping::Batch;
use vi_core::support::{
    Turns, are_far, has_angles, reduced_angles, state_with_turns, step_alone, weights as extrapolation,
};
use vi_core::{FixedStep, Starts, State, StepError};
use vi_dispatch::Instructions;

/// Maximum number of velocities in the extrapolation. For coupled pendula (h = 0.01, amplitude 1), degree 6 is rejected
/// in 22 of 100 steps, degree 8 in 4 and degree 10 in 0.1. One rejection costs a second pass for the whole block.
const DEPTH: usize = 11;

/// Maximum number of velocities in the extrapolation for one degree of freedom, for which degree 6 is never rejected.
const DEPTH_OF_ONE: usize = 7;

/// Trajectories in vector lanes; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Block<S: Batch<N>, const N: usize> {
    fixed: Fixed<[S::Rows<HALF>; 2]>,
    steps: u64,
    instructions: Instructions,
    /// The last nodes, and a buffer for the next ones.
    nodes: [Box<Nodes<N>>; 2],
    /// The velocities of the last steps, newest first, and a buffer for the next ones.
    velocities: Vec<Box<Rows<N>>>,
    /// Weights of the extrapolation.
    weights: Vec<f64>,
    verdict: Box<Rejections>,
    /// Number of trajectories that have not ended.
    running: usize,
    ended: Vec<Option<Ended<N>>>,
    /// Whole turns of the angles of each lane; its node is without them.
    turns: [Turns<N>; WIDTH],
}

impl<S: Batch<N>, const N: usize> Block<S, N> {
    /// A block of at least one and at most [`WIDTH`] trajectories.
    pub(crate) fn new(trajectories: &[(S, State<N>)], h: f64, instructions: Instructions) -> Self {
        let count = trajectories.len();
        // The last trajectory fills the unused lanes.
        let all: [(S, State<N>); WIDTH] = core::array::from_fn(|number| trajectories[number.min(count - 1)]);
        let fixed = Fixed {
            systems: [0, HALF].map(|first| S::rows(&core::array::from_fn(|index| all[first + index].0))),
            t: Row::filled(0.0),
            h,
        };
        let depth = if N == 1 { DEPTH_OF_ONE } else { DEPTH };
        let mut block = Self {
            fixed,
            steps: 0,
            instructions,
            nodes: [Box::new(Nodes::zeros()), Box::new(Nodes::zeros())],
            velocities: vec![Box::new(Rows::zeros()); depth + 1],
            weights: Vec::new(),
            verdict: Box::new(Rejections { refused: Row::filled(0), running: Row::filled(0) }),
            running: count,
            ended: vec![None; count],
            turns: [Turns::zeros(); WIDTH],
        };
        for (number, (system, state)) in all.iter().enumerate() {
            let lane = LaneIndex::of(number);
            block.fixed.t.set(lane, state.t);
            block.verdict.running.set(lane, if number < count { u64::MAX } else { 0 });
            block.nodes[0].set(lane, &Node::new(*state, 0.0));
            match system.at_state(*state).integrate(FixedStep, h) {
                Ok(start) => block.velocities[0].set(lane, &start.v()),
                Err(error) => block.end(number, *state, error),
            }
        }
        block
    }

    /// Ends a trajectory.
    fn end(&mut self, number: usize, state: State<N>, error: StepError) {
        if let Some(ended) = self.ended.get_mut(number) {
            *ended = Some(Ended { state, steps: self.steps, error });
            self.running -= 1;
        }
        self.verdict.running.set(LaneIndex::of(number), 0);
    }

    /// Number of trajectories, including ended ones.
    pub(crate) fn len(&self) -> usize {
        self.ended.len()
    }

    /// Number of trajectories that have not ended.
    pub(crate) fn running(&self) -> usize {
        self.running
    }

    /// The state of a trajectory.
    pub(crate) fn result(&self, number: usize) -> Result<State<N>, Ended<N>> {
        self.ended[number].map_or_else(|| Ok(self.state(number)), Err)
    }

    /// The velocity of the last step of a trajectory; before the first step, the velocity of its momenta.
    #[cfg(test)]
    pub(crate) fn velocity(&self, number: usize) -> SVector<f64, N> {
        self.velocities[0].get(LaneIndex::of(number))
    }

    /// The last node of a trajectory.
    pub(crate) fn node(&self, number: usize) -> Node<N> {
        let lane = LaneIndex::of(number);
        self.nodes[0].get(lane, self.elapsed().since(self.fixed.t.get(lane)))
    }

    /// The last state of one trajectory.
    fn state(&self, number: usize) -> State<N> {
        state_with_turns::<S, N, f64>(&self.node(number), &self.turns[number])
    }

    fn elapsed(&self) -> Elapsed {
        Elapsed::after(self.steps, self.fixed.h)
    }

    /// Takes `steps` steps, or fewer if all trajectories end.
    pub(crate) fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            if self.running == 0 {
                return;
            }
            if const { has_angles::<S, N, f64>() } {
                self.reduce();
            }
            self.step();
        }
    }

    /// Reduces angles that are far from zero, as a run does before a step.
    fn reduce(&mut self) {
        for number in 0..WIDTH {
            let lane = LaneIndex::of(number);
            if self.verdict.running.get(lane) == 0 || !are_far(&self.system(lane), &self.nodes[0].q(lane)) {
                continue;
            }
            let node = self.node(number);
            match reduced_angles(&self.system(lane), (node.q, node.q_low, self.turns[number])) {
                Ok((q, q_low, turns)) => {
                    self.nodes[0].set(lane, &Node { q, q_low, ..node });
                    self.turns[number] = turns;
                }
                Err(error) => self.end(number, self.state(number), error),
            }
        }
    }

    fn system(&self, lane: LaneIndex) -> S {
        S::from_rows(&self.fixed.systems[lane.half], lane.index)
    }

    fn step(&mut self) {
        let (instructions, elapsed) = (self.instructions, self.elapsed());
        let Self { fixed, nodes: [before, after], velocities, weights, verdict, .. } = self;
        let Some((velocity, known)) = velocities.split_last_mut() else { return };
        // One velocity is known before the first step, and one more after each step.
        if weights.len() < known.len() {
            let degree = weights.len();
            *weights = extrapolation::<DEPTH>(degree)[..=degree].to_vec();
        }
        instructions.run(Extrapolate { weights, velocities: known, guess: velocity });
        let refused = instructions.run(Pass::<S, N, false> { fixed, elapsed, before, after, velocity, verdict })
            && instructions.run(Pass::<S, N, true> { fixed, elapsed, before, after, velocity, verdict });
        if refused {
            self.take_alone();
        }
        self.nodes.swap(0, 1);
        self.velocities.rotate_right(1);
        self.steps += 1;
    }

    /// Takes the step of each rejected trajectory alone.
    #[cold]
    fn take_alone(&mut self) {
        for number in 0..WIDTH {
            let lane = LaneIndex::of(number);
            if self.verdict.refused.get(lane) & self.verdict.running.get(lane) == 0 {
                continue;
            }
            let (system, node) = (self.system(lane), self.node(number));
            let last: SVector<f64, N> = self.velocities[0].get(lane);
            match step_alone(&system, &node, self.fixed.h, last) {
                Ok((next, v)) => {
                    self.nodes[1].set(lane, &next);
                    self.nodes[1].remainder.set(lane, &SVector::<f64, N>::zeros());
                    self.restart(lane, v, v - last);
                }
                Err(error) => self.end(number, self.state(number), error),
            }
        }
    }

    /// Replaces the velocity history of a trajectory by a line that ends in v, which extrapolation of any degree
    /// continues. Velocities before an unpredictable step do not predict the next ones, and all trajectories of a block
    /// share the degree.
    fn restart(&mut self, lane: LaneIndex, v: SVector<f64, N>, change: SVector<f64, N>) {
        let Some((newest, known)) = self.velocities.split_last_mut() else { return };
        newest.set(lane, &v);
        let mut before = v;
        for velocities in known {
            before -= change;
            velocities.set(lane, &before);
        }
    }
}
