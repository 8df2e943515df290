//! The law of step lengths for motions that may be reversed.
//!
//! The length h of a step solves
//!
//! ```text
//! h Ω = ε
//! ```
//!
//! with the frequency Ω of the forces along the step (`phase.rs`), which does not change when the step is reversed. The map
//! is time-symmetric, so the energy of a reversible motion does not drift. Steps that follow a measured error drift.
//! Source: E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, VIII.3.1.
//!
//! The equation is solved by secants: first on the polynomials of a solved step, which approximate the ends of shorter
//! and longer steps, then by steps of these lengths, each from the stages of the one before. The explicit law of Hairer
//! and Söderlind (SIAM J. Sci. Comput. 26, 2005), ρ₊ = ρ₋ + ε ω'/ω with h = ε/ρ, needs one step instead of three.
//! But if ω changes much within a step, as with few steps in the period of an oscillator, ρ departs from ω.
//!
//! With terms that are linear in the velocities a motion is not reversible: steps back still return, but no law bounds
//! the energy error.

use super::decaying::FEWEST;
use super::phase::{MotionPoint, Phase, phase};
use super::{End, Following, LONGEST, Law, Of, Solver, Steps, TRIALS, moves_time, taken};
use crate::error::StepError;
use crate::gauss::polynomial::{integrals, polynomials, sum};
use crate::gauss::stages::{Stages, coefficients};
use crate::method::gauss::{StageSolver as _, solver};
use crate::method::{Method, Problem};
use crate::node::Node;
use crate::stepping::Convertible;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// If the phase of the first step to the power of its order is smaller and there is no time scale, no force sets the
/// lengths of the others. They then have the phase [`USUAL`] for each stage, and are at most as long as the first one.
const FREE: f64 = 1e-12;
const USUAL: f64 = 0.1;
/// The largest deviation of ln h Ω from ln ε of an accepted step. After [`FEW`] lengths it is [`ROUGH`]: then rounding of
/// the positions changes the phase, as near a collision.
const NEAR: f64 = 1e-10;
const ROUGH: f64 = 1e-8;
const FEW: usize = 15;
/// The least logarithmic slope of the phase in the length. If ω falls along a step it may be negative; lengths then
/// follow from halving.
const LEAST_SLOPE: f64 = 0.25;
/// The deviation up to which lengths are tried on the polynomials of a step.
const CLOSE: f64 = 1e-4;
/// The longest length that the polynomials of a step predict, in units of its length.
const BEYOND: f64 = 1.25;
/// Most lengths that are tried on them.
const FORESEEN: usize = 8;
/// The logarithm of the phase of the first half of a step over that of the step, above which its measure misses an
/// oscillation: exact means give at most −0.58, those of steps that keep their errors at most −0.4.
const HALF: f64 = -0.3;
/// The largest phase of steps after the first one: three places measure longer ones poorly.
const MOST: f64 = 2.0;
/// A phase that three places measure in any case.
const SHORT: f64 = 1.5;
/// Lengths without a quick step, mostly much too long, after which a step is solved in any way.
const QUICK: usize = 4;
/// The largest factor between the lengths of two steps of which one proves the other.
const PROVING: f64 = 1.5;

/// The data of the law between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[doc(hidden)]
pub struct Reversible {
    /// ε, with the sign of the steps.
    phase: f64,
    /// The floor of Ω.
    floor: f64,
    /// The guess of the next length, divided by the last one.
    ahead: f64,
    /// Ratio of the last two lengths.
    ratio: f64,
    /// Logarithmic slope of the phase of the last step in its length.
    slope: f64,
}

/// The search for the length of a step.
#[derive(Clone)]
struct PhaseSearch {
    /// A length that is too short, and one that is too long or has no step.
    between: [f64; 2],
    /// The logarithm of the last length tried, and that of its phase over ε.
    last: Option<[f64; 2]>,
    /// The logarithm of the length before, and the slope between both.
    chord: Option<[f64; 2]>,
    /// Logarithmic slope of the phase in the length.
    slope: f64,
}

impl PhaseSearch {
    /// Between two lengths, before one is tried.
    fn new(between: [f64; 2], slope: f64) -> Self {
        Self { between, last: None, chord: None, slope }
    }

    /// The length to try after one without a step.
    fn shorter(&mut self, h: f64) -> f64 {
        self.between[1] = h;
        self.halved(h)
    }

    /// The length halfway from those that are too short to this one.
    fn halved(&self, h: f64) -> f64 {
        0.5 * (self.between[0] + h)
    }

    /// The slope at a length, by the last three.
    fn learn(&mut self, h: f64, off: f64) {
        let length = h.abs().ln();
        if let Some([last, off_last]) = self.last.replace([length, off]) {
            let chord = (off - off_last) / (length - last);
            let bend = self.chord.map_or(0.0, |[first, before]| (chord - before) / (length - first));
            let slope = chord + bend * (length - last);
            // Lengths that are equal but for rounding have none.
            if slope.is_finite() {
                self.slope = slope.max(LEAST_SLOPE);
            }
            self.chord = Some([last, chord]);
        }
    }

    /// The length to try after this one, by the slope, or halfway between those that are too short and too long.
    fn next(&mut self, h: f64, off: f64) -> f64 {
        self.between[usize::from(off > 0.0)] = h;
        let next = h * (-off / self.slope).clamp(-1.0, 1.0).exp();
        let [short, long] = self.between;
        // False for NaN.
        if (next - short) / (long - short) > 0.0 && (long - next) / (long - short) > 0.0 {
            next
        } else {
            0.5 * (short + long)
        }
    }
}

impl Reversible {
    /// The law of the first step, of the length h between two nodes: its phase is that of all others.
    ///
    /// # Errors
    /// As [`State::velocity`](crate::State::velocity); [`StepError::TimeScale`].
    pub(super) fn of_first<S: Convertible<N>, const N: usize, const STAGES: usize>(
        system: &S,
        [start, end]: [&Node<N>; 2],
        h: f64,
    ) -> Result<Self, StepError> {
        let [start, end] = [MotionPoint::of(system, start)?, MotionPoint::of(system, end)?];
        #[allow(clippy::cast_precision_loss)] // 16 stages at most
        let stages = STAGES as f64;
        let is_felt = |found: &Phase| system.scales_time() || found.value().powf(2.0 * stages) > FREE;
        let found = phase(system, [&start, &end], [h.abs(), 0.0])?.filter(is_felt);
        let usual = USUAL * stages;
        let floor = if found.is_some() { LONGEST.recip() } else { usual } / h.abs();
        let found = found.unwrap_or(Phase::constant(usual));
        let slope = found.slope().max(LEAST_SLOPE);
        Ok(Self { phase: found.value().min(MOST).copysign(h), floor, ahead: 1.0, ratio: 1.0, slope })
    }

    /// The law after a change of the system or of the state.
    pub(super) fn resumed(self) -> Self {
        Self { ahead: 1.0, ratio: 1.0, ..self }
    }

    /// Whether the numbers of a checkpoint with steps of the sign of h are those of a law.
    pub(super) fn is_valid(&self, h: f64) -> bool {
        let Self { phase, floor, ahead, ratio, slope } = *self;
        [phase * h.signum(), floor, ahead, ratio, slope].iter().all(|number| *number > 0.0 && number.is_normal())
    }

    /// The step whose phase is that of the first one.
    ///
    /// # Errors
    /// The errors of the solver for the shortest length tried; [`StepError::LengthsLost`] if no length has this phase.
    pub(super) fn next<S: Convertible<N>, const N: usize, const STAGES: usize>(
        &self,
        at: Of<'_, S, N, STAGES>,
        memory: &Following<Steps<S, N, STAGES>>,
        cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
    ) -> Result<End<S, N, STAGES>, StepError> {
        let Problem { system, node, .. } = at;
        let Self { phase: wanted, floor, ahead, ratio: before, slope } = *self;
        let Following { steps, h: last, .. } = memory;
        let start = MotionPoint::of(system, node)?;
        let mut search = PhaseSearch::new([0.0, wanted / floor], slope);
        let mut h = last * ahead;
        let mut guess = Solver::<S, N, STAGES>::resized(system, steps, node, h)?;
        let mut failure = StepError::LengthsLost { t: node.t, h: *last };
        // The polynomials of fewer stages are too rough.
        let mut is_first = STAGES >= FEWEST;
        let (mut quick, mut is_near) = (QUICK, false);
        for trial in 0..TRIALS {
            if !moves_time(h, node.t)? {
                break;
            }
            let (solver, at) = (solver::<S, N, STAGES>(), Problem { h, ..at });
            let step = match (is_near, quick) {
                (true, _) => solver.solve_near(at, &guess, cache).map(Some),
                (false, 0) => solver.solve(at, &guess, cache).map(Some),
                (false, _) => solver.quickly(at, &guess, cache),
            };
            let tried = step.and_then(|step| {
                let Some(step) = step else { return Ok(None) };
                let (end, steps) = taken::<S, N, STAGES>(at, &guess, cache, step);
                Ok(Some((MotionPoint::of(system, &end)?, end, steps)))
            });
            let (there, end, steps) = match tried {
                Ok(Some(found)) => found,
                left => {
                    h = if let Err(error) = left {
                        failure = error;
                        search.shorter(h)
                    } else {
                        quick -= 1;
                        search.halved(h)
                    };
                    is_near = false;
                    guess = Solver::<S, N, STAGES>::resized(system, &memory.steps, node, h)?;
                    continue;
                }
            };
            // Without a value of the stiffness the length is accepted.
            let found = phase(system, [&start, &there], [h.abs(), floor])?;
            let found = found.unwrap_or(Phase::constant(wanted));
            let off = found.off(wanted);
            search.learn(h, off);
            if off.abs() < if trial < FEW { NEAR } else { ROUGH } {
                if self.is_too_long::<S, N, STAGES>(system, (&start, node), (&steps, h)) {
                    search = PhaseSearch::new([0.0, h], slope);
                    (h, is_near) = (search.halved(h), false);
                    guess = Solver::<S, N, STAGES>::again(system, &steps, node, h)?;
                    continue;
                }
                let ratio = h / last;
                // Ratios change by nearly equal factors, until the forces turn.
                let ahead = found.ratio().min(ratio * (ratio / before).clamp(0.7, 1.4));
                let law = Law::Reversible(Self { ahead, ratio, slope: search.slope, ..*self });
                return Ok((end, Following { steps, h, law: Some(law), ..*memory }));
            }
            let solved = h;
            h = if core::mem::take(&mut is_first) {
                self.foreseen::<S, N, STAGES>(system, (&start, node), (&steps, h), (&mut search, off))
            } else {
                search.next(h, off)
            };
            is_near = h / solved < PROVING && solved / h < PROVING;
            guess = Solver::<S, N, STAGES>::again(system, &steps, node, h)?;
        }
        Err(failure)
    }

    /// Whether the first half of a step has nearly its phase or more, so that the places where the phase is measured miss
    /// an oscillation.
    fn is_too_long<S: Convertible<N>, const N: usize, const STAGES: usize>(
        &self,
        system: &S,
        start: (&MotionPoint<S, N>, &Node<N>),
        (steps, h): (&Steps<S, N, STAGES>, f64),
    ) -> bool {
        if self.phase.abs() < SHORT {
            return false;
        }
        let velocity = coefficients(&Solver::<S, N, STAGES>::velocities(system, steps));
        let half = self.on_polynomial(system, start, (&velocity, h), 0.5 * h);
        half.is_some_and(|half| half.off(self.phase) > HALF)
    }

    /// The phase of a step of some length, on the polynomials of the velocity in a step of the length h.
    fn on_polynomial<S: Convertible<N>, const N: usize, const STAGES: usize>(
        &self,
        system: &S,
        (start, node): (&MotionPoint<S, N>, &Node<N>),
        (velocity, h): (&Stages<N, STAGES>, f64),
        length: f64,
    ) -> Option<Phase> {
        let part = length / h;
        let q = node.q + sum(velocity, &integrals(part)) * h;
        let there = MotionPoint::at(system, (node.t + length, q, sum(velocity, &polynomials(part))));
        phase(system, [start, &there], [length.abs(), self.floor]).ok()?
    }

    /// The length to try after the step of the length h, by secants on the polynomials of that step: they
    /// approximate the ends of shorter and somewhat longer steps.
    fn foreseen<S: Convertible<N>, const N: usize, const STAGES: usize>(
        &self,
        system: &S,
        (start, node): (&MotionPoint<S, N>, &Node<N>),
        (steps, h): (&Steps<S, N, STAGES>, f64),
        (search, mut off): (&mut PhaseSearch, f64),
    ) -> f64 {
        let mut tried = search.next(h, off);
        let mut on = search.clone();
        let velocity = coefficients(&Solver::<S, N, STAGES>::velocities(system, steps));
        for _ in 0..FORESEEN {
            if tried / h > BEYOND {
                break;
            }
            let Some(found) = self.on_polynomial(system, (start, node), (&velocity, h), tried) else { break };
            off = found.off(self.phase);
            on.learn(tried, off);
            tried = on.next(tried, off);
            // The slope here is that of the steps, up to the error of the polynomials.
            *search = PhaseSearch::new(search.between, on.slope);
            if off.abs() < CLOSE {
                break;
            }
        }
        tried
    }
}
