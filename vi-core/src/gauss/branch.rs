//! Continuation of the steps from a node in their length, from h → 0.
//!
//! A long step has further solutions, which satisfy its equations to rounding but lie on no branch from h → 0: steps
//! through a pole, or past a fold. [`follow`] solves steps of growing lengths,
//!
//! ```text
//! h θ0 … h θ … h        each guess is extrapolated from shorter steps, and close to its solution
//! ```
//!
//! and returns the step of the whole length. If the branch ends before, the step is too long.

use super::stages::{Stages, coefficients, maximum, scaled, sum};
use super::tableau::{Tableau, real};

/// Contraction of Newton iteration up to which its solution counts as connected. It finds solutions farther away than
/// fixed-point iteration: with a bound of 0.25 ten of 517 plunging orbits took another branch.
pub(crate) const FAST: f64 = 0.05;
/// Largest last coefficients of resolved stages, relative to the largest one. Measured on Kepler's problem: up to 0.09
/// for e = 0.6, 1.0 in a step that loses a plunging orbit.
const RESOLVED: f64 = 0.1;
/// Smallest number of stages whose coefficients show whether they are resolved.
const FEWEST: usize = 3;
/// Most solved steps of a continuation.
const SOLVES: u32 = 192;
/// Halvings of h until a step needs no continuation.
const HALVINGS: u32 = 12;
/// The largest and the least relative increase of the length. A branch that does not continue by the least one ends.
const INCREASES: [f64; 2] = [0.5, 1e-4];
/// Margin of the length to try: close to the end of a branch a step is hardly determined.
const MARGIN: f64 = 0.8;
/// The largest distance from a guess to its solution, relative to the range of the stages.
pub(crate) const NEAR: f64 = 0.25;
/// Largest error of a row, in roundings of the largest row of stages.
const NOISE: f64 = 4096.0;
/// The largest distance between two results for one solution, relative to the range of the stages.
pub(crate) const EQUAL: f64 = 1e-6;

/// Steps of all lengths from a node.
pub(crate) trait StepsFromNode {
    /// A solved step.
    type Solution;
    /// The step of a part of the length, from stages equal to the node. `None` if there is none, or if it may be on
    /// another branch.
    fn short(&mut self, part: f64) -> Option<Self::Solution>;
    /// The step of a longer part, with a guess from the last two shorter ones. `None` if there is none close to the
    /// guess. The solver may fail from this guess although it has solved the step of the whole length, which is then
    /// compared with the guess.
    fn longer(&mut self, part: f64, last: [&Shorter<Self::Solution>; 2]) -> Option<Self::Solution>;
}

/// A step of a part of the length.
#[derive(Debug)]
pub(crate) struct Shorter<S> {
    pub(crate) part: f64,
    pub(crate) step: S,
}

/// The factor of an extrapolation by a line to a part: `last + factor (last − before)`. Zero if both are the same step.
pub(crate) fn ahead<S>(part: f64, [before, last]: [&Shorter<S>; 2]) -> f64 {
    let between = last.part - before.part;
    if between > 0.0 { (part - last.part) / between } else { 0.0 }
}

/// The step of the whole length on the branch from h → 0.
///
/// # Errors
/// A part of the length to try, if the branch ends before the whole, or has not been followed so far.
pub(crate) fn follow<B: StepsFromNode>(steps: &mut B) -> Result<B::Solution, f64> {
    let mut part = 1.0;
    let mut solves = 0;
    let step = loop {
        part *= 0.5;
        solves += 1;
        if solves > HALVINGS {
            return Err(part);
        }
        if let Some(step) = steps.short(part) {
            break step;
        }
    };
    let [largest, least] = INCREASES;
    let mut increase = largest;
    let mut last = Shorter { part, step };
    let mut before: Option<Shorter<B::Solution>> = None;
    while last.part < 1.0 {
        solves += 1;
        if increase < least || solves > SOLVES {
            return Err(MARGIN * last.part);
        }
        let part = 1.0_f64.min(last.part * (1.0 + increase));
        match steps.longer(part, [before.as_ref().unwrap_or(&last), &last]) {
            Some(step) => {
                before = Some(core::mem::replace(&mut last, Shorter { part, step }));
                increase = largest.min(1.5 * increase);
            }
            None => increase *= 0.5,
        }
    }
    Ok(last.step)
}

/// Whether a step is resolved: the last two Legendre coefficients of each row of stages are small. False for few
/// stages. `weights` make rows comparable: a row that is rounding of the others counts as zero.
pub(crate) fn is_resolved<const N: usize, const S: usize>(stages: &Stages<N, S>, weights: &[f64; N]) -> bool {
    let noise = noise([stages], weights);
    let is_smooth = |(row, weight): ([f64; S], &f64)| {
        let sizes = row.map(f64::abs);
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let last = sizes[S - 1].max(sizes[S.saturating_sub(2)]);
        last <= largest * RESOLVED || last * weight <= noise
    };
    S >= FEWEST && coefficients(stages).into_iter().zip(weights).all(is_smooth)
}

/// A cheap test that only resolved stages pass, for the loop over steps: their last two coefficients are small against the
/// largest entry of their row over S, which is at most the largest coefficient.
#[inline(always)]
pub(crate) fn are_smooth<const N: usize, const S: usize>(stages: &Stages<N, S>) -> bool {
    let Tableau { to_legendre, .. } = const { &Tableau::<S>::VALUES };
    let [last, before] = [&to_legendre[S - 1], &to_legendre[S.saturating_sub(2)]];
    let mut are_smooth = S >= FEWEST;
    for row in stages {
        let mut sizes = [0.0; S];
        for i in 0..S {
            sizes[i] = row[i].abs();
        }
        let most = const { RESOLVED / real(S) } * maximum(&sizes);
        // False for NaN.
        are_smooth &= sum(&scaled(last, row)).abs() <= most && sum(&scaled(before, row)).abs() <= most;
    }
    are_smooth
}

/// The largest distance of stages, relative to the range of their row and of its value at the node, `from`. `weights`
/// make rows comparable: a distance that is rounding of the largest row counts as zero.
pub(crate) fn distance<const N: usize, const S: usize>(
    [a, b]: [&Stages<N, S>; 2],
    from: &Stages<N, S>,
    weights: &[f64; N],
) -> f64 {
    let noise = noise([a, b], weights);
    let of_row = |k: usize| {
        let values = || a[k].iter().chain(&b[k]).chain(&from[k][..1]).copied();
        let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
        let distance = a[k].iter().zip(&b[k]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if distance * weights[k] > noise { distance / range } else { 0.0 }
    };
    (0..N).map(of_row).fold(0.0, f64::max)
}

/// Rounding of the largest row, weighted.
pub(crate) fn noise<const N: usize, const S: usize, const K: usize>(
    stages: [&Stages<N, S>; K],
    weights: &[f64; N],
) -> f64 {
    let rows = stages.into_iter().flat_map(|stages| stages.iter().zip(weights));
    let sizes = rows.flat_map(|(row, weight)| row.iter().map(move |entry| (entry * weight).abs()));
    NOISE * f64::EPSILON * sizes.fold(0.0, f64::max)
}
