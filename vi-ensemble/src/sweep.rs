//! One step of a block: loops over its trajectories without a branch.
//!
//! In: the nodes before the step, the velocities of the last five. Out: the nodes after it, the velocity of the step in
//! the place of the oldest one, and which trajectories were refused. What stands in the rows of a refused trajectory has no
//! meaning.
//!
//! ```text
//! foretold   v = 7 (v1 − v6) − 21 (v2 − v5) + 35 (v3 − v4) + v7, one Newton step δ, accepted where |δ|² ≤ ρ²; ρ is learnt
//! again      another Newton step of those that were refused, accepted where it is also half as long as the one before
//! lesson     v = v1, three Newton steps: ρ² = ε |δ1|²/(4 |δ2|), ε one rounding of the larger of v and v7
//! ```
//!
//! After a Newton step δ the next one is C |δ|², so that one shorter than ρ leaves less than a rounding.

// What is lent by itself does not overlap, so far as the compiler knows; what stands in a struct of references may.
#![allow(clippy::too_many_arguments)]

use crate::ensemble::WIDTH;
use crate::lane::Lane;
use crate::rows::{Nodes, Row, Rows};
use nalgebra::SVector;
use vi_core::linear::Matrix;
use vi_core::{Batch, Node, Real, Stepping};

/// Velocities that the next one is foretold from.
pub(crate) const DEPTH: usize = 7;

/// What does not change during a run.
#[derive(Clone, Debug)]
pub(crate) struct Fixed<B> {
    /// The parameters of each trajectory.
    pub(crate) systems: B,
    /// Its time at the start.
    pub(crate) t: Row,
}

/// The time passed since the start, and the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) elapsed: f64,
    pub(crate) h: f64,
}

/// Whether a step is accepted.
#[derive(Clone, Debug)]
pub(crate) struct Verdict {
    /// ρ².
    pub(crate) radius: Row,
    /// |δ|² of the last Newton step.
    pub(crate) length: Row,
    /// All bits one where the trajectory was refused, none elsewhere.
    pub(crate) refused: Row<u64>,
}

/// A trajectory of the block, before the step.
struct Trajectory<const N: usize, T, S> {
    system: S,
    node: Node<N, T>,
    h: T,
}

/// A Newton step, to be subtracted, and its squared length.
struct Correction<const N: usize, T> {
    step: SVector<T, N>,
    length: T,
}

impl<B> Fixed<B> {
    #[inline(always)]
    fn trajectory<S, const N: usize, const FUSED: bool>(
        &self,
        clock: Clock,
        nodes: &Nodes<N>,
        lane: usize,
    ) -> Trajectory<N, Lane<FUSED>, S::In<Lane<FUSED>>>
    where
        S: Batch<N, Rows<WIDTH> = B>,
    {
        let system = S::pick::<_, WIDTH>(&self.systems, lane);
        Trajectory { system, node: nodes.lane(lane, self.t.0[lane] + clock.elapsed), h: Lane(clock.h) }
    }
}

impl<const N: usize, const FUSED: bool, S: Stepping<N, Lane<FUSED>>> Trajectory<N, Lane<FUSED>, S> {
    /// The Newton step from v.
    #[inline(always)]
    fn correction(&self, v: &SVector<Lane<FUSED>, N>) -> Correction<N, Lane<FUSED>> {
        let equation = self.system.momentum_equation(&self.node, self.h, v);
        let step = equation.jacobian.solve(&equation.residual);
        Correction { length: length_squared(&step), step }
    }

    /// Sets the rows of this trajectory at the end of the step.
    #[inline(always)]
    fn set(&self, end: &mut Nodes<N>, velocity: &mut Rows<N>, lane: usize, v: &SVector<Lane<FUSED>, N>) {
        let gain = self.system.increment(&self.node, self.h, v);
        end.set_lane(lane, &self.node.moved(self.h, v, &gain.momentum));
        velocity.set_lane(lane, v);
    }
}

#[inline(always)]
fn length_squared<const N: usize, T: Real>(vector: &SVector<T, N>) -> T {
    let mut sum = T::zero();
    for k in 0..N {
        sum += vector[k] * vector[k];
    }
    sum
}

/// All bits one where `accepted` does not hold.
#[inline(always)]
fn mask(accepted: bool) -> u64 {
    if accepted { 0 } else { u64::MAX }
}

/// The step from the velocities foretold.
#[inline(always)]
pub(crate) fn foretold<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<S::Rows<WIDTH>>,
    clock: Clock,
    start: &Nodes<N>,
    end: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Verdict,
    v1: &Rows<N>,
    v2: &Rows<N>,
    v3: &Rows<N>,
    v4: &Rows<N>,
    v5: &Rows<N>,
    v6: &Rows<N>,
) {
    for lane in 0..WIDTH {
        let trajectory = fixed.trajectory::<S, N, FUSED>(clock, start, lane);
        let oldest = velocity.lane(lane);
        let far = (v2.lane(lane) - v5.lane(lane)) * Lane(-21.0) + (v3.lane(lane) - v4.lane(lane)) * Lane(35.0) + oldest;
        let guess = (v1.lane(lane) - v6.lane(lane)) * Lane(7.0) + far;
        let Correction { step, length } = trajectory.correction(&guess);
        trajectory.set(end, velocity, lane, &(guess - step));
        verdict.length.0[lane] = length.0;
        verdict.refused.0[lane] = mask(length.0 <= verdict.radius.0[lane]);
    }
}

/// Another Newton step for those that were refused; the others stay as they are.
#[inline(always)]
pub(crate) fn again<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<S::Rows<WIDTH>>,
    clock: Clock,
    start: &Nodes<N>,
    end: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Verdict,
) {
    for lane in 0..WIDTH {
        let trajectory = fixed.trajectory::<S, N, FUSED>(clock, start, lane);
        let v = velocity.lane(lane);
        let Correction { step, length } = trajectory.correction(&v);
        let refused = verdict.refused.0[lane];
        let v = SVector::from(core::array::from_fn(|k| if refused == 0 { v[k] } else { v[k] - step[k] }));
        trajectory.set(end, velocity, lane, &v);
        let accepted = length.0 <= verdict.radius.0[lane] && length.0 <= 0.25 * verdict.length.0[lane];
        verdict.refused.0[lane] = refused & mask(accepted);
    }
}

/// The step from the last velocity, and how far a Newton step may be trusted.
#[inline(always)]
pub(crate) fn lesson<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<S::Rows<WIDTH>>,
    clock: Clock,
    start: &Nodes<N>,
    end: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Verdict,
    v1: &Rows<N>,
) {
    for lane in 0..WIDTH {
        let trajectory = fixed.trajectory::<S, N, FUSED>(clock, start, lane);
        let v = v1.lane(lane);
        let first = trajectory.correction(&v);
        let v = v - first.step;
        let second = trajectory.correction(&v);
        let rounding = length_squared(&v).max(length_squared(&velocity.lane(lane))).0 * (f64::EPSILON * f64::EPSILON);
        let v = v - second.step;
        let third = trajectory.correction(&v);
        trajectory.set(end, velocity, lane, &(v - third.step));
        // Two steps that are both rounding say nothing but that rounding is all that is left.
        let measured = rounding.sqrt() * first.length.0 * 0.25 / second.length.0.max(rounding).sqrt();
        let radius = if second.length.0 <= 0.25 * first.length.0 { measured } else { 0.0 };
        let radius = if radius >= rounding { radius } else { rounding };
        verdict.radius.0[lane] = radius;
        verdict.refused.0[lane] = mask(third.length.0 <= radius && second.length.0 <= first.length.0.max(rounding));
    }
}
