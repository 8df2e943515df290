//! The law of step lengths for irreversible motions: with friction, inputs, or a dependence on time.
//!
//! The velocities of a step are a polynomial. At the end of the step its slope differs from the acceleration:
//!
//! ```text
//! δ = h |v̇(1) − a| = O(h^(S+1))        |x|² = Σ M_ij x_i x_j
//! ```
//!
//! δ also shows a force between the stages that lasts about as long as their distance. The first steps have equal lengths
//! until δ falls, or the system or the state changes. Later steps aim at the largest δ so far: their lengths follow from δ
//! of the last two steps (K. Gustafsson's PI controller: E. Hairer, G. Wanner, *Solving Ordinary Differential Equations
//! II*, IV.2). A step whose δ is too large is taken again, shorter. A nearly right length is kept, so that the next step
//! starts from the stages and the linearization of the last one.
//!
//! The stages of these steps are solved to a part of a tolerance, if the run has one: nothing is preserved that smaller
//! errors would break.
//!
//! A mode that has died out has no acceleration, and does not count. If nothing else is left, its steps are resolved.

use super::{End, Following, LONGEST, Law, Of, Solver, Steps, TRIALS, moves_time, solved};
use crate::error::StepError;
use crate::gauss::stages::coefficients;
use crate::linear::Matrix;
use crate::method::gauss::StageSolver as _;
use crate::method::{Method, Problem};
use crate::node::Node;
use crate::stepping::Convertible;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// With fewer stages δ is too rough.
pub(super) const FEWEST: usize = 3;
/// Smallest δ of a step with a force, and largest δ of a resolved step, in units of its velocity.
const FELT: f64 = 1e-12;
const RESOLVED: f64 = 0.1;
/// The least target, in units of the terms of the velocity. δ contains their roundings: up to 64 ulps of the stage
/// velocities, of which slopes are a hundred times as large. The error at the end of such a step is a rounding.
const ROUNDED: f64 = 1e-10;
/// The largest δ of an accepted step, in units of the largest δ of the first steps.
const LARGEST: f64 = 2.0;
/// The length of the next step, in units of the length with the δ of the first steps.
const AIM: f64 = 0.9;
/// Exponents of the last δ and of the one before, in units of 1/(S + 1).
const OF_LAST: f64 = 0.7;
const OF_BEFORE: f64 = 0.4;
/// The largest δ, in units of the target of roundings, that may be nothing but roundings.
const LOW: f64 = 1e-2;
/// The range of the ratio of two lengths, and the range in which the length does not change.
const RATIOS: [f64; 2] = [0.2, 2.0];
const KEPT: [f64; 2] = [0.99, 1.2];

/// The data of the law between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[doc(hidden)]
pub struct Decaying {
    /// The largest δ of the first steps: the target of all later steps.
    wanted: f64,
    /// Whether δ has fallen since.
    is_set: bool,
    /// δ of the last step, in units of the target.
    off: f64,
    /// The next length, divided by the last one.
    ahead: f64,
    /// The longest length.
    longest: f64,
}

/// A measured step: δ, its velocity, and the size of the terms of which its velocity is the sum.
#[derive(Clone, Copy)]
struct Defect {
    size: f64,
    velocity: f64,
    terms: f64,
}

/// δ of the step of the length h that led to a node.
///
/// # Errors
/// The errors of [`State::velocity`](crate::State::velocity) and of the acceleration.
fn defect<S: Convertible<N>, const N: usize, const STAGES: usize>(
    system: &S,
    (end, steps): (&Node<N>, &Steps<S, N, STAGES>),
    h: f64,
) -> Result<Defect, StepError> {
    let state = end.state();
    let v = state.velocity(system)?;
    let acceleration = system.acceleration(state.t, &state.q, &v)?;
    let mass = system.point(state.t, &state.q, &v).mass;
    let size = |x: &SVector<f64, N>| {
        let mut sum = 0.0;
        mass.each_entry(|i, j, value| sum += x[i] * value * x[j]);
        sum.abs().sqrt()
    };
    let velocity = size(&v).max(size(&(acceleration * h)));
    // A singular mass matrix, which constraints make up for, has no inverse.
    let terms = size(&(mass.inverse_unchecked().abs() * state.p.abs()));
    let terms = if terms.is_finite() { velocity.max(terms) } else { velocity };
    // P_k' at the end is k (k + 1)/2 for x, twice that for θ.
    let mut slope = SVector::<f64, N>::zeros();
    for (entry, row) in slope.iter_mut().zip(coefficients(&Solver::<S, N, STAGES>::velocities(system, steps))) {
        let mut factor = 0.0;
        for (k, coefficient) in (0_u32..).zip(row) {
            factor += f64::from(2 * k);
            *entry += factor * coefficient;
        }
    }
    Ok(Defect { size: size(&(slope - acceleration * h)), velocity, terms })
}

/// The exponent 1/(S + 1): lengths grow by this power of δ.
#[allow(clippy::cast_precision_loss)] // 16 stages at most
const fn power<const STAGES: usize>() -> f64 {
    1.0 / (STAGES + 1) as f64
}

impl Decaying {
    /// The law of the first step, of the length h.
    ///
    /// # Errors
    /// As [`defect`].
    pub(super) fn of_first<S: Convertible<N>, const N: usize, const STAGES: usize>(
        system: &S,
        step: (&Node<N>, &Steps<S, N, STAGES>),
        h: f64,
    ) -> Result<Self, StepError> {
        let Defect { size: wanted, .. } = defect::<S, N, STAGES>(system, step, h)?;
        Ok(Self { wanted, is_set: false, off: 1.0, ahead: 1.0, longest: LONGEST * h.abs() })
    }

    /// The law after a measured step.
    ///
    /// # Errors
    /// δ in units of the target, if it is too large.
    fn after<const STAGES: usize>(self, Defect { size, velocity, terms }: Defect) -> Result<Self, f64> {
        if !self.is_set && (size >= self.wanted || self.wanted < FELT * velocity) {
            return Ok(Self { wanted: self.wanted.max(size), ..self });
        }
        // After fast modes have died out, the steps of slow ones have to be resolved.
        let most = self.wanted.min(RESOLVED * velocity);
        let rounded = ROUNDED * terms;
        let off = if size == 0.0 { 0.0 } else { size / most.max(rounded) };
        let ahead = self.ahead::<STAGES>(off, most < rounded);
        let law = Self { is_set: true, off, ahead, ..self };
        // False for NaN.
        if off <= LARGEST { Ok(law) } else { Err(off) }
    }

    /// The law after a change of the system or of the state, which may make δ larger by any factor: the target is that of
    /// the steps before, if anything moved.
    pub(super) fn resumed(self) -> Self {
        Self { is_set: self.is_set || self.wanted > 0.0, off: 1.0, ahead: 1.0, ..self }
    }

    /// Whether the numbers of a checkpoint are those of a law.
    pub(super) fn is_valid(&self) -> bool {
        let Self { wanted, is_set: _, off, ahead, longest } = *self;
        let are_positive = [ahead, longest].iter().all(|number| *number > 0.0 && number.is_normal());
        are_positive && [wanted, off].iter().all(|number| *number >= 0.0 && number.is_finite())
    }

    /// The next length by δ of the last step and of the one before, divided by the last one. If the target is that of
    /// roundings, a δ far below it may be nothing else: it changes by any factor, and no length follows from its change.
    fn ahead<const STAGES: usize>(&self, off: f64, is_rounded: bool) -> f64 {
        let power = power::<STAGES>();
        let ratio = if is_rounded && off < LOW {
            (AIM * off.powf(-power)).max(1.0)
        } else {
            AIM * off.powf(-OF_LAST * power) * self.off.powf(OF_BEFORE * power)
        };
        // Infinite, or NaN, for a step without a defect.
        let ratio = if off > 0.0 && self.off > 0.0 { ratio } else { f64::INFINITY };
        let [short, long] = KEPT;
        if ratio > short && ratio < long { 1.0 } else { ratio.clamp(RATIOS[0], RATIOS[1]) }
    }

    /// The next step.
    ///
    /// # Errors
    /// The errors of the solver for the shortest length tried; [`StepError::LengthsLost`] if all are too long.
    pub(super) fn next<S: Convertible<N>, const N: usize, const STAGES: usize>(
        &self,
        at: Of<'_, S, N, STAGES>,
        memory: &Following<Steps<S, N, STAGES>>,
        cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
    ) -> Result<End<S, N, STAGES>, StepError> {
        let Problem { system, node, .. } = at;
        let Following { steps, h: last, .. } = memory;
        let solver = &memory.solver::<S, N, STAGES>();
        let mut h = (last.abs() * self.ahead).min(self.longest).copysign(*last);
        let mut guess = None;
        let mut failure = StepError::LengthsLost { t: node.t, h: *last };
        for _ in 0..TRIALS {
            if !moves_time(h, node.t)? {
                break;
            }
            #[allow(clippy::float_cmp)] // the same length
            let from = match &guess {
                Some(guess) => guess,
                None if h == *last => steps,
                None => guess.insert(Solver::<S, N, STAGES>::resized(system, steps, node, h)?),
            };
            let tried = solved(solver, Problem { h, ..at }, from, cache)
                .and_then(|(end, steps)| Ok((defect::<S, N, STAGES>(system, (&end, &steps), h)?, end, steps)));
            match tried {
                Ok((found, end, steps)) => match self.after::<STAGES>(found) {
                    Ok(law) => return Ok((end, Following { steps, h, law: Some(Law::Decaying(law)), ..*memory })),
                    Err(off) => {
                        h *= (AIM * off.powf(-power::<STAGES>())).max(RATIOS[0]);
                        guess = Some(Solver::<S, N, STAGES>::again(system, &steps, node, h)?);
                    }
                },
                Err(error) => {
                    failure = error;
                    h *= 0.5;
                    guess = Some(Solver::<S, N, STAGES>::resized(system, steps, node, h)?);
                }
            }
        }
        Err(failure)
    }
}
