//! One step of a block: a loop over its trajectories without a branch.
//!
//! In: the nodes before the step, and velocities to start from. Out: the nodes after it, the velocities of the step, and which
//! trajectories were refused; what stands in the rows of those has no meaning. Each trajectory is corrected and measured as in
//! `FixedStep`:
//!
//! ```text
//! correct    v = v0 − A⁻¹ r(v0)
//! measure    r(v) and p1 − p0, by one evaluation at v
//! accept     where each row, with what is carried to it, is at most ε times the sum of the absolute values of its terms
//! ```
//!
//! What is left of a row then is carried to the next step. So a row itself is at most ε times this sum and that of the step before;
//! where the sums shrink, that it is at most [`FLOOR`] ε times its own is asked too.

use crate::layout::{HALF, LaneIndex, Nodes, Row, Rows};
use nalgebra::SVector;
use vi_core::linear::Matrix;
use vi_core::node::Node;
use vi_core::real::Lane;
use vi_core::stepping::{Batch, FixedStepping, MomentumResidual};
use vi_core::support::two_sum;
use vi_dispatch::Loop;

/// Roundings that a row may leave.
const FLOOR: f64 = 4.0;

/// What does not change during a run.
#[derive(Clone, Debug)]
pub(crate) struct Fixed<B> {
    /// The parameters of each trajectory.
    pub(crate) systems: B,
    /// Its time at the start.
    pub(crate) t: Row,
    pub(crate) h: f64,
}

/// Time since the start, with what rounding took from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elapsed {
    pub(crate) t: f64,
    pub(crate) t_low: f64,
}

impl Elapsed {
    /// After so many steps of length h.
    #[allow(clippy::cast_precision_loss)]
    pub(crate) fn after(steps: u64, h: f64) -> Self {
        let t = steps as f64 * h;
        Self { t, t_low: (steps as f64).mul_add(h, -t) }
    }

    /// The time of a trajectory that began at `start`, and what rounding took from it.
    #[inline(always)]
    pub(crate) fn since(self, start: f64) -> (f64, f64) {
        let (t, low) = two_sum(start, self.t);
        (t, low + self.t_low)
    }
}

/// Which trajectories a sweep refuses.
#[derive(Clone, Debug)]
pub(crate) struct Verdict {
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

impl<const N: usize, const FUSED: bool, S: FixedStepping<N, Lane<FUSED>>> Trajectory<N, FUSED, S> {
    /// The step after a Newton step from v.
    #[inline(always)]
    fn step(&self, v: &SVector<Lane<FUSED>, N>) -> Step<N, FUSED> {
        let equation = self.system.momentum_equation(&self.node, self.h, v);
        let v = v - equation.jacobian.solve_unchecked(&(equation.residual + self.remainder));
        let MomentumResidual { residual, scale, increment } = self.system.momentum_residual(&self.node, self.h, &v);
        let remainder = residual + self.remainder;
        let mut accepted = true;
        for k in 0..N {
            // A scale that overflows proves nothing.
            let rounding = (scale[k] * Lane::new(f64::EPSILON)).get();
            accepted &= remainder[k].get().abs() <= rounding && rounding < f64::MAX * f64::EPSILON;
            accepted &= residual[k].get().abs() <= FLOOR * rounding;
        }
        Step { v, increment, remainder, accepted }
    }

    /// Writes the step to its lane; all bits one where the trajectory is running and was refused.
    #[inline(always)]
    fn take<const AGAIN: bool>(
        &self,
        step: &Step<N, FUSED>,
        lane: LaneIndex,
        after: &mut Nodes<N>,
        velocity: &mut Rows<N>,
        verdict: &mut Verdict,
    ) -> u64 {
        let kept = AGAIN && verdict.refused.get(lane) == 0;
        let mut node = self.node;
        node.advance(self.h, &step.v, &step.increment);
        // A sum, not a number where one of its terms is not: what solves the equations need not lead anywhere.
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

/// The step of every trajectory from the velocities given, which become those of the step; or, `AGAIN`, of those that were refused
/// from where they came, while the others stay as they are. Whether a running trajectory was refused.
pub(crate) struct Sweep<'a, S: Batch<N>, const N: usize, const AGAIN: bool> {
    pub(crate) fixed: &'a Fixed<[S::Rows<HALF>; 2]>,
    pub(crate) elapsed: Elapsed,
    pub(crate) before: &'a Nodes<N>,
    pub(crate) after: &'a mut Nodes<N>,
    pub(crate) velocity: &'a mut Rows<N>,
    pub(crate) verdict: &'a mut Verdict,
}

impl<S: Batch<N>, const N: usize, const AGAIN: bool> Loop for Sweep<'_, S, N, AGAIN> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { fixed, elapsed, before, after, velocity, verdict } = self;
        // Arguments do not overlap, so far as the compiler knows; what stands in a struct of references may.
        sweep::<S, N, FUSED, AGAIN>(fixed, elapsed, before, after, velocity, verdict)
    }
}

/// A step is a chain of operations that wait for each other, and longer than what a processor looks ahead: two
/// trajectories, one of each half, are written into each other, so that it finds work in one while the other waits.
#[inline(always)]
fn sweep<S: Batch<N>, const N: usize, const FUSED: bool, const AGAIN: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    elapsed: Elapsed,
    before: &Nodes<N>,
    after: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Verdict,
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
        self.guess.set_sum::<FUSED>(self.weights, self.velocities);
    }
}
