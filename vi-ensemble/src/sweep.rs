//! One step of a block: a loop over its trajectories without a branch.
//!
//! In: the nodes before the step, and velocities to start from. Out: the nodes after it, the velocities of the step, and which
//! trajectories were refused; what stands in the rows of those has no meaning. Each trajectory is corrected and measured as in
//! `FixedStep`:
//!
//! ```text
//! correct    v = v0 − A⁻¹ r(v0)
//! measure    r(v) and p1 − p0, by one evaluation at v
//! accept     where each row is at most ε times the sum of the absolute values of its terms
//! ```
//!
//! What is left of a row is carried to the next step.

use crate::dispatch::Loop;
use crate::lane::Lane;
use crate::layout::{HALF, LaneIndex, Nodes, Row, Rows};
use nalgebra::SVector;
use vi_core::linear::Matrix;
use vi_core::{Batch, MomentumResidual, Node, Stepping};

/// What does not change during a run.
#[derive(Clone, Debug)]
pub(crate) struct Fixed<B> {
    /// The parameters of each trajectory.
    pub(crate) systems: B,
    /// Its time at the start.
    pub(crate) t: Row,
    pub(crate) h: f64,
}

/// What a sweep leads to.
#[derive(Clone, Debug)]
pub(crate) struct Reached<const N: usize> {
    /// The nodes after the step.
    pub(crate) nodes: Nodes<N>,
    /// The velocities to start from; then those of the step.
    pub(crate) velocity: Rows<N>,
    /// What the last step left of the momentum rows, and what this one leaves.
    pub(crate) remainders: [Rows<N>; 2],
    /// All bits one where a trajectory was refused, none elsewhere.
    pub(crate) refused: Row<u64>,
    /// All bits one where there is a trajectory that has not ended.
    pub(crate) running: Row<u64>,
}

/// A trajectory of the block, before the step.
struct Trajectory<const N: usize, const FUSED: bool, S> {
    system: S,
    node: Node<N, Lane<FUSED>>,
    h: Lane<FUSED>,
    remainder: SVector<Lane<FUSED>, N>,
}

/// A step of one trajectory.
struct Step<const N: usize, const FUSED: bool> {
    v: SVector<Lane<FUSED>, N>,
    increment: SVector<Lane<FUSED>, N>,
    remainder: SVector<Lane<FUSED>, N>,
    accepted: bool,
}

impl<const N: usize, const FUSED: bool, S: Stepping<N, Lane<FUSED>>> Trajectory<N, FUSED, S> {
    /// The step after a Newton step from v.
    #[inline(always)]
    fn step(&self, v: &SVector<Lane<FUSED>, N>) -> Step<N, FUSED> {
        let equation = self.system.momentum_equation(&self.node, self.h, v);
        let v = v - equation.jacobian.solve(&(equation.residual + self.remainder));
        let MomentumResidual { residual, magnitude, increment } = self.system.momentum_residual(&self.node, self.h, &v);
        let remainder = residual + self.remainder;
        let mut accepted = true;
        for k in 0..N {
            // A scale that overflows proves nothing.
            let rounding = (magnitude[k] * Lane::new(f64::EPSILON)).get();
            accepted &= remainder[k].get().abs() <= rounding && rounding < f64::MAX * f64::EPSILON;
        }
        Step { v, increment, remainder, accepted }
    }
}

/// The step of every trajectory from the velocities that stand in `reached`; or, `AGAIN`, of those that were refused from where they
/// came, while the others stay as they are. Whether a running trajectory was refused.
pub(crate) struct Sweep<'a, S: Batch<N>, const N: usize, const AGAIN: bool> {
    pub(crate) fixed: &'a Fixed<[S::Rows<HALF>; 2]>,
    pub(crate) elapsed: f64,
    pub(crate) before: &'a Nodes<N>,
    pub(crate) reached: &'a mut Reached<N>,
}

impl<S: Batch<N>, const N: usize, const AGAIN: bool> Loop for Sweep<'_, S, N, AGAIN> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { fixed, elapsed, before, reached } = self;
        // Arguments do not overlap, so far as the compiler knows; what stands in a struct of references may.
        sweep::<S, N, FUSED, AGAIN>(fixed, elapsed, before, reached)
    }
}

/// A step is a chain of operations that wait for each other, and longer than what a processor looks ahead: two
/// trajectories, one of each half, are written into each other, so that it finds work in one while the other waits.
#[inline(always)]
fn sweep<S: Batch<N>, const N: usize, const FUSED: bool, const AGAIN: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    elapsed: f64,
    before: &Nodes<N>,
    reached: &mut Reached<N>,
) -> bool {
    let mut any = 0;
    for index in 0..HALF {
        let (first, second) = (LaneIndex { half: 0, index }, LaneIndex { half: 1, index });
        let a = trajectory::<S, N, FUSED>(fixed, elapsed, before, reached, first);
        let b = trajectory::<S, N, FUSED>(fixed, elapsed, before, reached, second);
        let (step_a, step_b) = (a.step(&reached.velocity.get(first)), b.step(&reached.velocity.get(second)));
        any |= reached.take::<FUSED, AGAIN>(first, &a.node, a.h, &step_a);
        any |= reached.take::<FUSED, AGAIN>(second, &b.node, b.h, &step_b);
    }
    any != 0
}

/// The trajectory in this lane.
#[inline(always)]
fn trajectory<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    elapsed: f64,
    before: &Nodes<N>,
    reached: &Reached<N>,
    lane: LaneIndex,
) -> Trajectory<N, FUSED, S::In<Lane<FUSED>>> {
    Trajectory {
        system: S::pick::<Lane<FUSED>, HALF>(&fixed.systems[lane.half], lane.index),
        node: before.get(lane, fixed.t.get(lane) + elapsed),
        h: Lane::new(fixed.h),
        remainder: reached.remainders[0].get(lane),
    }
}

impl<const N: usize> Reached<N> {
    /// Takes the step of one trajectory; all bits one where it is running and was refused.
    #[inline(always)]
    fn take<const FUSED: bool, const AGAIN: bool>(
        &mut self,
        lane: LaneIndex,
        start: &Node<N, Lane<FUSED>>,
        h: Lane<FUSED>,
        step: &Step<N, FUSED>,
    ) -> u64 {
        let kept = AGAIN && self.refused.get(lane) == 0;
        let mut node = *start;
        node.advance(h, &(step.v * h), &step.increment);
        self.nodes.set_unless(kept, lane, &node);
        self.velocity.set_unless(kept, lane, &step.v);
        self.remainders[1].set_unless(kept, lane, &step.remainder);
        let refused = if step.accepted || kept { 0 } else { u64::MAX };
        self.refused.set(lane, refused);
        refused & self.running.get(lane)
    }
}

/// `Σ weight · velocity` over the last steps, the newest first, into `guess`.
pub(crate) struct Extrapolate<'a, const N: usize> {
    pub(crate) weights: &'a [f64],
    pub(crate) velocities: &'a [Box<Rows<N>>],
    pub(crate) guess: &'a mut Rows<N>,
}

impl<const N: usize> Loop for Extrapolate<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        *self.guess = Rows::zeros();
        for (weight, velocity) in self.weights.iter().zip(self.velocities) {
            self.guess.add::<FUSED>(*weight, velocity);
        }
    }
}
