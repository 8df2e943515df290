//! One step of a block: a branch-free loop over its trajectories.
//!
//! In: the nodes before the step and initial velocities. Out: the nodes after it, the velocities of the step, and the
//! rejected trajectories, whose rows are meaningless. Each trajectory takes the Newton step and the acceptance test of
//! `FixedStep`:
//!
//! ```text
//! correct    v = v0 − A⁻¹ r(v0)
//! measure    r(v) and p1 − p0, by one evaluation at v
//! accept     if each row, plus its carried residual, is at most ε times the sum of the absolute values of its terms
//! ```
//!
//! The next step carries the remaining residual. So a row is at most ε times its own sum plus that of the previous
//! step. In case the sums shrink, the test also requires at most [`FLOOR`] ε times its own sum.

use crate::layout::{HALF, LaneIndex, Nodes, Row, Rows};
use nalgebra::SVector;
use vi_core::linear::Matrix;
use vi_core::node::Node;
use vi_core::real::Lane;
use vi_core::stepping::{Batch, FixedStepping, MomentumResidual};
use vi_core::support::two_sum;
use vi_dispatch::Loop;

/// Maximum residual of a row, in roundings.
const FLOOR: f64 = 4.0;

/// Constants of a run.
#[derive(Clone, Debug)]
pub(crate) struct Fixed<B> {
    /// The parameters of each trajectory.
    pub(crate) systems: B,
    /// The times of the trajectories at the start.
    pub(crate) t: Row,
    pub(crate) h: f64,
}

/// Time since the start, with its low part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elapsed {
    pub(crate) t: f64,
    pub(crate) t_low: f64,
}

impl Elapsed {
    /// The time elapsed after `steps` steps of length h.
    #[allow(clippy::cast_precision_loss)]
    pub(crate) fn after(steps: u64, h: f64) -> Self {
        let t = steps as f64 * h;
        Self { t, t_low: (steps as f64).mul_add(h, -t) }
    }

    /// The time of a trajectory that started at `start`, with its low part.
    #[inline(always)]
    pub(crate) fn since(self, start: f64) -> (f64, f64) {
        let (t, low) = two_sum(start, self.t);
        (t, low + self.t_low)
    }
}

/// The trajectories rejected by a pass.
#[derive(Clone, Debug)]
pub(crate) struct Rejections {
    /// All bits one if the trajectory was rejected, otherwise zero.
    pub(crate) refused: Row<u64>,
    /// All bits one if the trajectory exists and has not ended.
    pub(crate) running: Row<u64>,
}

/// A trajectory of the block before the step.
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

impl<const N: usize, const FUSED: bool, S: FixedStepping<N, Lane<FUSED>>> Trajectory<N, FUSED, S> {
    /// The step after one Newton iteration from v.
    #[inline(always)]
    fn step(&self, v: &SVector<Lane<FUSED>, N>) -> Step<N, FUSED> {
        let equation = self.system.momentum_equation(&self.node, self.h, v);
        let v = v - equation.jacobian.solve_unchecked(&(equation.residual + self.remainder));
        let MomentumResidual { residual, scale, increment } = self.system.momentum_residual(&self.node, self.h, &v);
        let remainder = residual + self.remainder;
        let mut accepted = true;
        for k in 0..N {
            // An infinite scale accepts nothing.
            let rounding = (scale[k] * Lane::new(f64::EPSILON)).get();
            accepted &= remainder[k].get().abs() <= rounding && rounding < f64::MAX * f64::EPSILON;
            accepted &= residual[k].get().abs() <= FLOOR * rounding;
        }
        Step { v, increment, remainder, accepted }
    }

    /// Writes the step to its lane; returns all bits one if the trajectory is running and was rejected.
    #[inline(always)]
    fn take<const AGAIN: bool>(
        &self,
        step: &Step<N, FUSED>,
        lane: LaneIndex,
        after: &mut Nodes<N>,
        velocity: &mut Rows<N>,
        verdict: &mut Rejections,
    ) -> u64 {
        let kept = AGAIN && verdict.refused.get(lane) == 0;
        let mut node = self.node;
        node.advance(self.h, &step.v, &step.increment);
        // NaN if any term is not finite: a solution of the equations may have no finite end.
        let sum = (0..N).fold(0.0, |sum, k| sum + (node.q[k].get() * 0.0 + node.p[k].get() * 0.0));
        let accepted = step.accepted && sum == 0.0;
        after.set_unless(kept, lane, &node);
        after.remainder.set_unless(kept, lane, &step.remainder);
        velocity.set_unless(kept, lane, &step.v);
        let refused = if accepted || kept { 0 } else { u64::MAX };
        verdict.refused.set(lane, refused);
        refused & verdict.running.get(lane)
    }
}

/// Takes the step of every trajectory from the given velocities and overwrites these. With `AGAIN`, repeats it for
/// rejected trajectories only. Returns whether a running trajectory was rejected.
pub(crate) struct Pass<'a, S: Batch<N>, const N: usize, const AGAIN: bool> {
    pub(crate) fixed: &'a Fixed<[S::Rows<HALF>; 2]>,
    pub(crate) elapsed: Elapsed,
    pub(crate) before: &'a Nodes<N>,
    pub(crate) after: &'a mut Nodes<N>,
    pub(crate) velocity: &'a mut Rows<N>,
    pub(crate) verdict: &'a mut Rejections,
}

impl<S: Batch<N>, const N: usize, const AGAIN: bool> Loop for Pass<'_, S, N, AGAIN> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { fixed, elapsed, before, after, velocity, verdict } = self;
        // Separate arguments tell LLVM that the references do not alias; fields of a struct do not.
        pass::<S, N, FUSED, AGAIN>(fixed, elapsed, before, after, velocity, verdict)
    }
}

/// A step is a dependency chain longer than the reorder window of a processor. Interleaving two trajectories, one per
/// half, fills the pipeline.
#[inline(always)]
fn pass<S: Batch<N>, const N: usize, const FUSED: bool, const AGAIN: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    elapsed: Elapsed,
    before: &Nodes<N>,
    after: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Rejections,
) -> bool {
    let mut any = 0;
    for index in 0..HALF {
        let (a, b) = (LaneIndex { half: 0, index }, LaneIndex { half: 1, index });
        let first = trajectory::<S, N, FUSED>(fixed, elapsed, before, a);
        let second = trajectory::<S, N, FUSED>(fixed, elapsed, before, b);
        let step_of_first = first.step(&velocity.get(a));
        let step_of_second = second.step(&velocity.get(b));
        any |= first.take::<AGAIN>(&step_of_first, a, after, velocity, verdict);
        any |= second.take::<AGAIN>(&step_of_second, b, after, velocity, verdict);
    }
    any != 0
}

/// The trajectory in this lane.
#[inline(always)]
fn trajectory<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    elapsed: Elapsed,
    before: &Nodes<N>,
    lane: LaneIndex,
) -> Trajectory<N, FUSED, S::Steps<Lane<FUSED>>> {
    Trajectory {
        system: S::from_rows(&fixed.systems[lane.half], lane.index).steps(),
        node: before.get(lane, elapsed.since(fixed.t.get(lane))),
        h: Lane::new(fixed.h),
        remainder: before.remainder.get(lane),
    }
}

/// Writes `Σ weight · velocity` over the last steps, newest first, into `guess`.
pub(crate) struct Extrapolate<'a, const N: usize> {
    pub(crate) weights: &'a [f64],
    pub(crate) velocities: &'a [Box<Rows<N>>],
    pub(crate) guess: &'a mut Rows<N>,
}

impl<const N: usize> Loop for Extrapolate<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.guess.set_sum::<FUSED>(self.weights, self.velocities);
    }
}
