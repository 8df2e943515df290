//! Energy-preserving steps of order 2s among the steps of any length from a node.
//!
//! A method solves steps of a given length, with their discrete energies ([`StepsOfAnyLength`]). This module finds the
//! length whose step has the energy of the node, or takes fixed steps if the user allows them.

use super::bounds::{Alternating, Control, FirstStep, RATIO, too_long};
use super::length::{Search, Trial};
use super::{Method, Problem};
use crate::dense_output::{DenseOutput as _, Hermite};
use crate::error::StepError;
use crate::gauss::density::power;
use crate::gauss::history::StepHistory;
use crate::lagrangian::Lagrangian;
use crate::newton::{FLOOR, roundings};
use crate::node::Node;
use crate::state::State;
use core::cell::Cell;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Steps of any length from a node, of order 2K, with their discrete energies.
pub(crate) trait StepsOfAnyLength<const N: usize, const K: usize> {
    /// A solved step. Its residual is `E0(h) − C_s h^2s D_*` less the energy of the node.
    type Trial: Trial;
    /// The data of a step that its run keeps.
    type Taken;

    /// Solves the step of length h with the shift D_*, guessed from another step from the same node if there is one,
    /// otherwise from the last step.
    ///
    /// # Errors
    /// The errors of a step; [`StepError::NonFinite`] if its energy is not finite.
    fn tried(&self, node: &Node<N>, h: f64, shift: f64, near: Option<&Self::Trial>) -> Result<Self::Trial, StepError>;
    /// Rounding-error bound of the energy of a trial by running error analysis, in units of `ε`.
    fn rounding_of(&self, node: &Node<N>, trial: &Self::Trial) -> f64;
    /// Iterations of a trial.
    fn iterations(trial: &Self::Trial) -> u32;
    /// The step density D_s at a state.
    ///
    /// # Errors
    /// The reason why it has no value.
    fn density(&self, state: &State<N>) -> Result<f64, StepError>;
    /// `H − E'` at a node, and the size of the terms of H.
    ///
    /// # Errors
    /// As [`measured`].
    fn measured(&self, node: &Node<N>) -> Result<[f64; 2], StepError>;
    /// The end of a trial.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] and the reason why H has no value there.
    fn ended(&self, node: &Node<N>, trial: &Self::Trial) -> Result<Ended<Self::Taken, N>, StepError>;
    /// Dense output between two states.
    ///
    /// # Errors
    /// As [`Hermite::between`].
    fn between(&self, before: &State<N>, after: &State<N>, h: f64) -> Result<Hermite<N>, StepError>;
}

/// The end of a step.
pub(crate) struct Ended<T, const N: usize> {
    pub(crate) taken: T,
    pub(crate) state: State<N>,
    /// `E1 − E0`.
    pub(crate) gain: f64,
    /// `H − E'` at the end, and the size of the terms of H.
    pub(crate) measured: [f64; 2],
}

/// A solved step, with its energies and density.
#[derive(Clone, Copy, Debug)]
pub struct PreservingStep<T> {
    pub(crate) taken: T,
    /// Increment of the energy of the node.
    pub(crate) gain: f64,
    pub(crate) history: StepHistory,
}

/// Change of `h^(2s+1) |D|` from step to step from which a step may have passed a sign change of D: the step law says that
/// it is constant up to O(h²).
const IRREGULAR: f64 = 1.3;
/// Parts of such a step at which D is evaluated.
const PARTS: u32 = 16;

/// Largest accepted rounding error of an energy, relative to its terms. With fewer digits the energy is not preserved.
const KNOWN: f64 = 1e-10;

/// The order 2K: to leading order the slope of `ln (H − E0)` over ln h.
#[allow(clippy::cast_precision_loss)] // at most three stages
pub(crate) const fn order<const K: usize>() -> f64 {
    2.0 * K as f64
}

/// The smallest `|H − E|` that determines a length, for energies with this rounding error.
fn least_excess<const K: usize>(rounding: f64) -> f64 {
    // Relative accuracy of the length that the numbers of its step need.
    const PARTS: f64 = 1000.0;
    PARTS * rounding / order::<K>()
}

/// A run at a node: the inputs of the search for a step.
pub(crate) struct Preserving<'a, P, const N: usize, const K: usize> {
    pub(crate) steps: &'a P,
    pub(crate) node: &'a Node<N>,
    pub(crate) history: &'a StepHistory,
}

impl<P: StepsOfAnyLength<N, K>, const N: usize, const K: usize> Preserving<'_, P, N, K> {
    fn tried(&self, h: f64, near: Option<&P::Trial>) -> Result<P::Trial, StepError> {
        self.steps.tried(self.node, h, self.history.shift, near)
    }

    /// Whether the energy of a trial equals the preserved one within its rounding error.
    ///
    /// # Errors
    /// [`StepError::DegenerateStep`] if it does, but `H − E` is too small to determine the length.
    #[cold]
    fn is_kept(&self, trial: &P::Trial) -> Result<bool, StepError> {
        let rounding = f64::EPSILON * self.steps.rounding_of(self.node, trial);
        // At a turning point H may be zero although the energies of the trajectory are not.
        let size = trial.size().max(self.history.largest_size);
        if !(trial.residual().abs() <= FLOOR * rounding && rounding <= KNOWN * size) {
            return Ok(false);
        }
        if self.history.excess.abs() < least_excess::<K>(rounding) { Err(self.degenerate()) } else { Ok(true) }
    }

    /// The error if `H − E` does not determine a length.
    fn degenerate(&self) -> StepError {
        let h = self.history.h();
        StepError::DegenerateStep { t: self.node.t, h, density: self.history.excess / power::<K>(h) }
    }

    /// The error if no forward step exists.
    #[cold]
    fn no_step(&self) -> StepError {
        let last = || self.history.initial_density::<K>() - self.history.shift;
        self.no_step_at(self.steps.density(&self.node.state()).unwrap_or_else(|_| last()))
    }

    /// The error if no forward step exists because of this density D_s.
    fn no_step_at(&self, density: f64) -> StepError {
        let Self { node, history, .. } = *self;
        let StepHistory { excess, shift, largest, .. } = *history;
        let largest = largest.max(density.abs());
        StepError::NoForwardGaussStep { t: node.t, h: history.h(), stages: K, excess, density, shift, largest }
    }

    /// The energy-preserving step within the bounds, the slope of its energy over its length, and the iterations of all
    /// trials.
    fn found(&self) -> Result<(P::Trial, f64, u32), StepError> {
        let Self { node, history, .. } = *self;
        let (t, last) = (node.t, history.h());
        let StepHistory { excess, size, largest_size, shift, .. } = *history;
        if excess.abs() < least_excess::<K>(f64::EPSILON * size) {
            return Err(self.degenerate());
        }
        // A trajectory that has only become faster so far does not show the size of its energies.
        if size < largest_size {
            check_shift(t, [last, power::<K>(last)], shift, largest_size, order::<K>())?;
        }
        // The root has passed a sign change of D: it is another one.
        if history.density().is_some_and(|density| excess * density < 0.0) {
            return Err(self.no_step());
        }
        let iterations = Cell::new(0);
        let search = Search {
            solve: &|h, near| {
                let tried = self.tried(h, near)?;
                iterations.set(iterations.get() + P::iterations(&tried));
                Ok(tried)
            },
            is_rounding: &|trial| self.is_kept(trial),
            t,
            predicted: history.predicted_length(),
            last,
            ratio: RATIO,
            excess,
            noise: 0.0,
            slope: history.slope,
            order: order::<K>(),
        };
        let (step, slope) = match search.root() {
            Some(found) => found,
            None => match search.smallest() {
                Ok(found) => (found.ok_or_else(|| self.no_step())?, history.slope),
                // With constraints longer steps do not exist: a constraint turns too far.
                Err(StepError::NotConverged { h, turn, .. }) if turn > 0.0 && h > last => return Err(self.no_step()),
                Err(failure) => return Err(failure),
            },
        };
        let h = step.h();
        if h > last * RATIO || last > h * RATIO {
            return Err(StepError::StepRatio { t, previous: last, found: h });
        }
        history.control.check_bounds(t, h)?;
        Ok((step, slope, iterations.get()))
    }

    /// Whether `h^(2s+1) |D|` has changed by more since the last step than steps that resolve D allow.
    fn is_irregular(&self, after: &StepHistory) -> bool {
        let (Some([density, last]), false) = (after.densities, self.history.is_first()) else { return false };
        let ratio = after.h() / self.history.h();
        let change = (power::<K>(ratio) / power::<K>(1.0) * ratio * (density / last)).abs();
        !(IRREGULAR.recip()..=IRREGULAR).contains(&change)
    }

    /// Checks that D keeps its sign from the start of a step to its end, if it has that sign at its end: the step law does
    /// not hold across a short time with the other sign. A step to a place with the other sign is the last one.
    ///
    /// # Errors
    /// [`StepError::NoForwardGaussStep`].
    #[cold]
    fn check_sign(&self, end: &State<N>, h: f64) -> Result<(), StepError> {
        let Self { steps, node, history } = *self;
        let before = node.state();
        let is_other = |density: f64| (density + history.shift) * history.excess < 0.0;
        // Without a density there is no sign.
        let (Ok(path), Ok(last)) = (steps.between(&before, end, h), steps.density(end)) else { return Ok(()) };
        let at = |part: u32| path.state(before.t + h * (f64::from(part) / f64::from(PARTS)));
        let mut other = (0..PARTS).filter_map(|part| steps.density(&at(part)).ok());
        match other.find(|density| is_other(*density)) {
            Some(density) if !is_other(last) => Err(self.no_step_at(density)),
            _ => Ok(()),
        }
    }

    /// Computes the energies at the end of a step.
    fn after(&self, trial: &P::Trial) -> Result<(PreservingStep<P::Taken>, State<N>), StepError> {
        let Self { steps, node, history } = *self;
        let Ended { taken, state, gain, measured } = steps.ended(node, trial)?;
        let mut history = *history;
        // The mean of `H − E0` at the start and of `H − E1` at the end.
        let mean = 0.5 * (history.excess + measured[0]) - trial.residual();
        history.push(trial.h(), mean / power::<K>(trial.h()));
        history.set_excess(measured);
        Ok((PreservingStep { taken, gain, history }, state))
    }
}

impl<P: StepsOfAnyLength<N, K>, const N: usize, const K: usize> Alternating<f64> for Preserving<'_, P, N, K> {
    const POWER: f64 = order::<K>() + 1.0;
    type StepSolution = PreservingStep<P::Taken>;

    fn control(&self) -> &Control {
        &self.history.control
    }

    fn t(&self) -> f64 {
        self.node.t
    }

    fn last(&self) -> [f64; 2] {
        [self.history.h(), self.history.initial_density::<K>()]
    }

    fn preserving(&self, gap: f64) -> Result<(PreservingStep<P::Taken>, f64), StepError> {
        let (mut node, mut history) = (*self.node, *self.history);
        if gap != 0.0 {
            node.add_energy(gap);
            history.set_excess(self.steps.measured(&node)?);
        }
        let here = Preserving { steps: self.steps, node: &node, history: &history };
        let (trial, slope, iterations) = here.found()?;
        let (mut found, end) = here.after(&trial)?;
        if here.is_irregular(&found.history) {
            here.check_sign(&end, trial.h())?;
        }
        found.gain += gap;
        found.history.residual = match trial.roundings() {
            few if few <= FLOOR => few,
            _ => roundings(trial.residual(), self.steps.rounding_of(&node, &trial)),
        };
        (found.history.slope, found.history.iterations) = (slope, iterations);
        Ok((found, trial.h()))
    }

    fn fixed(&self, h: f64) -> Result<(PreservingStep<P::Taken>, [f64; 2]), StepError> {
        let trial = self.tried(h, None)?;
        let last = self.history.initial_density::<K>();
        let (mut found, _) = self.after(&trial)?;
        found.history.residual = 0.0;
        found.history.forget_lengths();
        found.history.iterations = P::iterations(&trial);
        let density = found.history.initial_density::<K>();
        // The next interval has the same length.
        Ok((found, [trial.residual(), density + (density - last)]))
    }

    fn control_of(found: &mut PreservingStep<P::Taken>) -> &mut Control {
        &mut found.history.control
    }
}

/// The error of a failed attempt. That of a first step names a shorter length, if one leads to a step.
#[cold]
pub(super) fn failed<M: Method<S, N>, S, const N: usize>(
    method: &M,
    at: Problem<'_, S, M::Prepared, N>,
    history: &StepHistory,
    cache: &mut M::Cache,
    failure: StepError,
) -> StepError {
    // A start of another length has no shift.
    if !history.is_first() || history.shift != 0.0 {
        return failure;
    }
    let Problem { system, prepared, node, .. } = at;
    too_long(failure, ([node.t, history.h()], [node.energy, history.excess]), |h| {
        let mut node = Node::new(node.state(), 0.0);
        let memory = method.begin(system, &mut node, h).ok()?;
        let at = Problem { system, prepared, node: &node, h };
        Some(FirstStep { energy: node.energy, exists: method.attempt(at, &memory, cache).is_ok() })
    })
}

/// `H − E'` at a node, and the size of the terms of H.
///
/// # Errors
/// As [`State::velocity`]; [`StepError::NonFinite`] if H is not finite.
pub(crate) fn measured<S: Lagrangian<N>, const N: usize>(system: &S, node: &Node<N>) -> Result<[f64; 2], StepError> {
    excess_of(energy_at(system, &node.state())?, node)
}

/// `H − E'` at a node with this energy, and the size of the terms of H.
///
/// # Errors
/// [`StepError::NonFinite`].
pub(crate) fn excess_of<const N: usize>(
    NodeEnergy { total, size }: NodeEnergy,
    node: &Node<N>,
) -> Result<[f64; 2], StepError> {
    let excess = (total - node.energy) - node.energy_low;
    if excess.is_finite() && size.is_finite() {
        Ok([excess, size])
    } else {
        Err(StepError::NonFinite { t: node.t, quantity: "energy", expression: None })
    }
}

/// The energy at a state.
pub(crate) struct NodeEnergy {
    /// H.
    pub(crate) total: f64,
    /// The size of its terms, `|v·p| + |H|`.
    pub(crate) size: f64,
}

/// The energy at a state.
///
/// # Errors
/// As [`State::velocity`].
pub(crate) fn energy_at<S: Lagrangian<N>, const N: usize>(
    system: &S,
    State { t, q, p }: &State<N>,
) -> Result<NodeEnergy, StepError> {
    let v = system.flow(*t, q, p)?.v;
    let total = system.energy(*t, q, &v);
    Ok(NodeEnergy { total, size: v.dot(p).abs() + total.abs() })
}

/// Rejects a shift that adds more to the energy of a step of the length h with this `C_s h^2s` than `size`, the size of
/// the energy terms along the trajectory.
///
/// # Errors
/// [`StepError::ShiftTooLarge`].
pub(crate) fn check_shift(t: f64, [h, power]: [f64; 2], shift: f64, size: f64, order: f64) -> Result<(), StepError> {
    let part = power * shift.abs();
    if part <= size {
        return Ok(());
    }
    let shorter = h * (0.1 * size / part).powf(order.recip());
    Err(StepError::ShiftTooLarge { t, h, shift, part, size, shorter })
}

/// Checks that a first step is so long that `C_s h^2s` is a number.
///
/// # Errors
/// [`StepError::InvalidInput`].
pub(crate) fn check_power<const K: usize>(h: f64) -> Result<(), StepError> {
    if power::<K>(h).is_normal() {
        return Ok(());
    }
    let (input, allowed) = ("the step h", "so long that C h^2s is a number");
    Err(StepError::InvalidInput { input, allowed, value: h })
}
