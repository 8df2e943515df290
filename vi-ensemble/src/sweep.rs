//! One step of a block: loops over its trajectories without a branch.
//!
//! In: the nodes before the step, the velocities of the last eleven. Out: the nodes after it, the velocity of the step in
//! the place of the oldest one, and which trajectories were refused. What stands in the rows of a refused trajectory has no
//! meaning.
//!
//! ```text
//! foretold   v = 11 (v1 − v10) − 55 (v2 − v9) + 165 (v3 − v8) − 330 (v4 − v7) + 462 (v5 − v6) + v11,
//!            for one degree of freedom v = 7 (v1 − v6) − 21 (v2 − v5) + 35 (v3 − v4) + v7;
//!            one Newton step δ, accepted where |δ|² ≤ ρ²; ρ is learnt
//! again      another Newton step of those that were refused, accepted where by both of them a third is a rounding
//! lesson     v = v1, three Newton steps: ρ² = ε |δ1|²/(4 |δ2|), ε one rounding of the larger of v and v11
//! ```
//!
//! After a Newton step δ the next one is C |δ|², so that one shorter than ρ leaves a quarter of a rounding or less; and so
//! do the gains of the momenta, which are carried from the guess to the solution by their derivatives.
//!
//! The order of the guess is the same for all. Of coupled pendula (h = 0.01, amplitude 1) order 6 is refused in 22 steps of
//! 100, order 8 in 4 and order 10 in 0.1, and a second Newton step is one for the whole block. Rounding, 2000 times
//! amplified by such a sum, is far below ρ. For one degree of freedom order 6 is refused nowhere.

// What is lent by itself does not overlap, so far as the compiler knows; what stands in a struct of references may.
#![allow(clippy::too_many_arguments)]

use crate::cramer;
use crate::ensemble::HALF;
use crate::lane::Lane;
use crate::rows::{Nodes, Place, Row, Rows};
use nalgebra::SVector;
use vi_core::{Batch, Node, Stepping};

/// Velocities that the next one is foretold from.
pub(crate) const DEPTH: usize = 11;

/// Part of a rounding that Newton's iteration may leave.
const SHARE: f64 = 0.25;

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
    /// All bits one where there is a trajectory that has not ended.
    pub(crate) running: Row<u64>,
}

/// A vector of one trajectory.
pub(crate) type Vector<const N: usize, const FUSED: bool> = SVector<Lane<FUSED>, N>;

/// A trajectory of the block, before the step.
struct Trajectory<const N: usize, const FUSED: bool, S> {
    system: S,
    node: Node<N, Lane<FUSED>>,
    h: Lane<FUSED>,
}

/// What a Newton step leads to.
struct Reached<const N: usize, const FUSED: bool> {
    v: Vector<N, FUSED>,
    /// What the momenta gain over the step of velocity v.
    gain: Vector<N, FUSED>,
    /// |δ|²; not a number where a gain is none.
    length: f64,
}

impl<B> Fixed<[B; 2]> {
    #[inline(always)]
    fn trajectory<S: Batch<N, Rows<HALF> = B>, const N: usize, const FUSED: bool>(
        &self,
        clock: Clock,
        nodes: &Nodes<N>,
        place: Place,
    ) -> Trajectory<N, FUSED, S::In<Lane<FUSED>>> {
        let system = S::pick::<Lane<FUSED>, HALF>(&self.systems[place.half], place.index);
        let t = self.t.get(place) + clock.elapsed;
        Trajectory { system, node: nodes.lane(place, t), h: Lane::new(clock.h) }
    }
}

impl<const N: usize, const FUSED: bool, S: Stepping<N, Lane<FUSED>>> Trajectory<N, FUSED, S> {
    /// The velocity after a Newton step from v, and |δ|².
    #[inline(always)]
    fn corrected(&self, v: &Vector<N, FUSED>) -> (Vector<N, FUSED>, f64) {
        let step = cramer::solve(&self.system.momentum_equation(&self.node, self.h, v));
        (v - step, length_squared(&step))
    }

    /// The same with the gain of the momenta: at the solution, where the equations are linear and no C tells what
    /// else would be left out; else carried there from v by its derivatives.
    #[inline(always)]
    fn reached(&self, v: &Vector<N, FUSED>) -> Reached<N, FUSED> {
        let (v, gain, length) = if S::CONSTANT_JACOBIAN {
            let (v, length) = self.corrected(v);
            (v, self.system.increment(&self.node, self.h, &v).momentum, length)
        } else {
            self.carried(v)
        };
        let mut finite = Lane::<FUSED>::new(length);
        for k in 0..N {
            finite += gain[k] * Lane::new(0.0);
        }
        Reached { v, gain, length: finite.get() }
    }

    /// The velocity after a Newton step from v, the gain of the momenta there, and |δ|².
    #[inline(always)]
    fn carried(&self, v: &Vector<N, FUSED>) -> (Vector<N, FUSED>, Vector<N, FUSED>, f64) {
        let place = self.node.place::<S>(self.h, v);
        let mut step = *v;
        let gain = self.system.momentum_step(
            &self.node,
            &place,
            self.h,
            v,
            // A call would keep the loop from becoming vector instructions.
            #[inline(always)]
            |equation| {
                step = -cramer::solve(equation);
                step
            },
        );
        (v + step, gain, length_squared(&step))
    }

    /// The node at the end of the step.
    #[inline(always)]
    fn end(&self, step: &Reached<N, FUSED>) -> Node<N, Lane<FUSED>> {
        let mut node = self.node;
        node.advance(self.h, &(step.v * self.h), &step.gain);
        node
    }
}

#[inline(always)]
fn length_squared<const N: usize, const FUSED: bool>(vector: &Vector<N, FUSED>) -> f64 {
    let mut sum = vector[0] * vector[0];
    for k in 1..N {
        sum += vector[k] * vector[k];
    }
    sum.get()
}

/// All bits one where `accepted` does not hold.
#[inline(always)]
fn mask(accepted: bool) -> u64 {
    if accepted { 0 } else { u64::MAX }
}

/// The velocity after those of the last steps: pairs of them with the weight of their difference, and the oldest.
#[inline(always)]
fn extrapolated<const N: usize, const FUSED: bool, const PAIRS: usize>(
    place: Place,
    pairs: [(&Rows<N>, &Rows<N>, f64); PAIRS],
    oldest: &Rows<N>,
) -> Vector<N, FUSED> {
    let mut guess = oldest.lane(place);
    for k in 0..N {
        for (newer, older, weight) in pairs.iter().rev() {
            guess[k] += (newer.entry(k, place) - older.entry(k, place)) * Lane::new(*weight);
        }
    }
    guess
}

/// The step from the velocities foretold; whether a running trajectory was refused.
///
/// A step is a chain of operations that wait for each other, and longer than what a processor looks ahead: two
/// trajectories, one of each half, are written into each other, so that it finds work in one while the other waits.
#[inline(always)]
pub(crate) fn foretold<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
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
    v7: &Rows<N>,
    v8: &Rows<N>,
    v9: &Rows<N>,
    v10: &Rows<N>,
) -> bool {
    let few = [(v1, v6, 7.0), (v2, v5, -21.0), (v3, v4, 35.0)];
    let many = [(v1, v10, 11.0), (v2, v9, -55.0), (v3, v8, 165.0), (v4, v7, -330.0), (v5, v6, 462.0)];
    let mut any = 0;
    for index in 0..HALF {
        let [a, b] = [Place { half: 0, index }, Place { half: 1, index }];
        // A linear equation is solved by one step from anywhere.
        let [guess_a, guess_b]: [Vector<N, FUSED>; 2] = if S::CONSTANT_JACOBIAN {
            [v1.lane(a), v1.lane(b)]
        } else if N == 1 {
            [extrapolated(a, few, v7), extrapolated(b, few, v7)]
        } else {
            [extrapolated(a, many, velocity), extrapolated(b, many, velocity)]
        };
        let trajectory_a = fixed.trajectory::<S, N, FUSED>(clock, start, a);
        let trajectory_b = fixed.trajectory::<S, N, FUSED>(clock, start, b);
        let reached_a = trajectory_a.reached(&guess_a);
        let reached_b = trajectory_b.reached(&guess_b);
        end.set_lane(a, &trajectory_a.end(&reached_a));
        end.set_lane(b, &trajectory_b.end(&reached_b));
        velocity.set_lane(a, &reached_a.v);
        velocity.set_lane(b, &reached_b.v);
        any |= verdict.judge(a, reached_a.length) | verdict.judge(b, reached_b.length);
    }
    any != 0
}

impl Verdict {
    /// All bits one where a running trajectory is refused.
    #[inline(always)]
    fn judge(&mut self, place: Place, length: f64) -> u64 {
        self.length.set(place, length);
        mask(length <= self.radius.get(place)) & self.running.get(place)
    }
}

/// Another Newton step for those that were refused, the others stay as they are; whether a running trajectory is still
/// refused.
#[inline(always)]
pub(crate) fn again<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    clock: Clock,
    start: &Nodes<N>,
    end: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Verdict,
) -> bool {
    let mut any = 0;
    for half in 0..2 {
        for index in 0..HALF {
            let place = Place { half, index };
            let (before, radius) = (verdict.length.get(place), verdict.radius.get(place));
            let good = before <= radius;
            let trajectory = fixed.trajectory::<S, N, FUSED>(clock, start, place);
            let reached = trajectory.reached(&velocity.lane(place));
            end.set_lane_unless(good, place, &trajectory.end(&reached));
            velocity.set_lane_unless(good, place, &reached.v);
            // Two steps are their own lesson, newer than the last one: the next is |δ2|³/|δ1|², squared here.
            let next = reached.length * (reached.length / before) * (reached.length / before);
            let rounding = length_squared(&reached.v) * (SHARE * f64::EPSILON * SHARE * f64::EPSILON);
            let shorter = reached.length <= 0.25 * before && next <= rounding;
            let refused = mask(good || reached.length <= radius && shorter);
            verdict.refused.set(place, refused);
            any |= refused & verdict.running.get(place);
        }
    }
    any != 0
}

/// The step from the last velocity, and how far a Newton step may be trusted; whether a running trajectory was refused.
#[inline(always)]
pub(crate) fn lesson<S: Batch<N>, const N: usize, const FUSED: bool>(
    fixed: &Fixed<[S::Rows<HALF>; 2]>,
    clock: Clock,
    start: &Nodes<N>,
    end: &mut Nodes<N>,
    velocity: &mut Rows<N>,
    verdict: &mut Verdict,
    v1: &Rows<N>,
) -> bool {
    let mut any = 0;
    for half in 0..2 {
        for index in 0..HALF {
            let place = Place { half, index };
            let trajectory = fixed.trajectory::<S, N, FUSED>(clock, start, place);
            let (v, first) = trajectory.corrected(&v1.lane(place));
            let (v, second) = trajectory.corrected(&v);
            let reached = trajectory.reached(&v);
            let oldest = length_squared(&velocity.lane::<Lane<FUSED>>(place));
            let rounding = length_squared(&v).max(oldest) * (f64::EPSILON * f64::EPSILON);
            end.set_lane(place, &trajectory.end(&reached));
            velocity.set_lane(place, &reached.v);
            // Two steps that are both rounding say nothing but that rounding is all that is left.
            let measured = rounding.sqrt() * first * SHARE / second.max(rounding).sqrt();
            let learnt = second <= 0.25 * first && measured >= rounding;
            let radius = if learnt { measured } else { rounding };
            let radius = if S::CONSTANT_JACOBIAN { f64::MAX } else { radius };
            verdict.radius.set(place, radius);
            let refused = mask(reached.length <= radius && second <= first.max(rounding));
            verdict.refused.set(place, refused);
            any |= refused & verdict.running.get(place);
        }
    }
    any != 0
}
