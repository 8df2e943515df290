//! Angles as a reduced angle and a count of whole turns.
//!
//! A run keeps an angle near zero, as the unevaluated sum of a number and its low part, and counts the turns k:
//!
//! ```text
//! θ = θ_r + 2π k        k = round(θ/2π) whenever |θ_r| > 4
//! ```
//!
//! 2π is the sum of three numbers, and products with k are exact, so that a reduction changes θ by less than `1e-31`:
//! ten million of them lose nothing. Between π and 4 an ulp is that below π, and an angle that oscillates about π is
//! not reduced in every step.
//!
//! A run reduces its node at the start of a step. So the node and the step that led to it have the same turns.

use crate::compensated::two_sum;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::State;
use core::f64::consts::{PI, TAU};
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// 2π is `TAU + TAU_LOW + TAU_LOWEST`, to 2^-160.
const TAU_LOW: f64 = 2.449_293_598_294_706_4e-16;
const TAU_LOWEST: f64 = -5.989_539_619_436_679e-33;
/// The largest reduced angle at the start of a step.
const FAR: f64 = 4.0;
/// The largest count of turns, 2^53: every smaller one is a number.
const LARGEST: i64 = 1 << 53;

/// The turns of each coordinate; zero for one that is no angle.
pub type Turns<const N: usize> = SVector<i64, N>;

/// Whether a system has angles.
#[must_use]
pub const fn has_angles<S: Lagrangian<N, T>, const N: usize, T: Scalar>() -> bool {
    let mut index = 0;
    while index < N {
        if S::SPACES[index].is_angle() {
            return true;
        }
        index += 1;
    }
    false
}

/// Whether an angle has to be reduced before the next step.
#[inline(always)]
pub fn are_far<S: Lagrangian<N, T>, const N: usize, T: Scalar>(system: &S, q: &SVector<T, N>) -> bool {
    let (mut are_far, spaces) = (false, system.spaces());
    for i in 0..N {
        are_far |= spaces[i].is_angle() && q[i].abs() > T::real(FAR);
    }
    are_far
}

/// Coordinates and their low parts with reduced angles, and the turns of the angles.
pub type Reduced<const N: usize, T> = (SVector<T, N>, SVector<T, N>, Turns<N>);

/// Reduces the angles that are far from zero, and adds to their turns.
///
/// # Errors
/// [`StepError::InvalidInput`] for an angle of more than 2^53 turns.
#[cold]
#[inline(never)]
pub fn reduced<S: Lagrangian<N, T>, const N: usize, T: Scalar>(
    system: &S,
    (mut q, mut q_low, mut turns): Reduced<N, T>,
) -> Result<Reduced<N, T>, StepError> {
    for i in (0..N).filter(|i| system.spaces()[*i].is_angle()) {
        if q[i].abs() <= T::real(FAR) {
            continue;
        }
        let [high, low] = [q[i].to_f64(), q_low[i].to_f64()];
        let (k, [high, low]) = nearest(high, low).ok_or_else(|| too_far(high))?;
        let sum = turns[i].checked_add(k).filter(|sum| sum.abs() <= LARGEST);
        turns[i] = sum.ok_or_else(|| too_far(high))?;
        q[i] = T::real(high);
        // A shorter number leaves a part of the first to the second.
        q_low[i] = T::real((high - q[i].to_f64()) + low);
    }
    Ok((q, q_low, turns))
}

/// The node with reduced angles, as a step from it begins. It is unchanged if an angle has more than 2^53 turns.
#[inline]
pub(crate) fn reduced_node<S: Lagrangian<N, T>, const N: usize, T: Scalar>(
    system: &S,
    node: &Node<N, T>,
) -> Node<N, T> {
    if !are_far(system, &node.q) {
        return *node;
    }
    let reduced = reduced(system, (node.q, node.q_low, Turns::zeros()));
    reduced.map_or(*node, |(q, q_low, _)| Node { q, q_low, ..*node })
}

/// The state of a node: its angles with their turns.
#[inline(always)]
pub fn state<S: Lagrangian<N, T>, const N: usize, T: Scalar>(node: &Node<N, T>, turns: &Turns<N>) -> State<N, T> {
    let mut state = node.state();
    if const { has_angles::<S, N, T>() } {
        state.q = with_turns(&node.q, &node.q_low, turns);
    }
    state
}

/// Coordinates plus 2π times their turns, rounded once.
#[inline]
pub(crate) fn with_turns<const N: usize, T: Scalar>(
    q: &SVector<T, N>,
    q_low: &SVector<T, N>,
    turns: &Turns<N>,
) -> SVector<T, N> {
    SVector::from_fn(|i, _| {
        if turns[i] == 0 {
            return q[i];
        }
        let [high, low] = turned(turns[i]);
        let (sum, lost) = two_sum(high, q[i].to_f64());
        T::real(sum + (lost + (low + q_low[i].to_f64())))
    })
}

/// A state with its angles less these turns.
pub(crate) fn without_turns<const N: usize, T: Scalar>(state: &State<N, T>, turns: &Turns<N>) -> State<N, T> {
    State { q: with_turns(&state.q, &SVector::zeros(), &-turns), ..*state }
}

/// Adds the turns nearest to a reduced angle and its low part to the others. The rest is in `[-π, π]`.
pub(crate) fn normalized<S: Lagrangian<N, T>, const N: usize, T: Scalar>(
    system: &S,
    node: &Node<N, T>,
    turns: &Turns<N>,
) -> (SVector<T, N>, Turns<N>) {
    let (mut q, mut turns) = (node.q, *turns);
    for i in (0..N).filter(|i| system.spaces()[*i].is_angle()) {
        if let Some((k, [high, _])) = nearest(q[i].to_f64(), node.q_low[i].to_f64()) {
            (q[i], turns[i]) = (T::real(high), turns[i] + k);
        }
    }
    (q, turns)
}

/// Checks the angles of a state from which a run begins, and given turns.
///
/// # Errors
/// [`StepError::InvalidInput`] for an angle of more than 2^53 turns, and for turns of a coordinate that is no angle.
pub(crate) fn check<S: Lagrangian<N, T>, const N: usize, T: Scalar>(
    system: &S,
    q: &SVector<T, N>,
    turns: &Turns<N>,
) -> Result<(), StepError> {
    for i in 0..N {
        if !system.spaces()[i].is_angle() && turns[i] != 0 {
            return Err(StepError::InvalidInput {
                input: "the turns of a coordinate that is no angle",
                allowed: "zero",
                value: number(turns[i]),
            });
        }
        if turns[i].unsigned_abs() > LARGEST.unsigned_abs() {
            return Err(too_far(number(turns[i]) * TAU));
        }
        let angle = q[i].to_f64();
        // The method reports an angle that is not finite.
        if system.spaces()[i].is_angle() && angle.is_finite() && nearest(angle, 0.0).is_none() {
            return Err(too_far(angle));
        }
    }
    Ok(())
}

#[cold]
fn too_far(angle: f64) -> StepError {
    StepError::InvalidInput { input: "an angle", allowed: "at most 2^53 turns of 2π", value: angle }
}

/// The count of turns nearest to `high + low`, and the rest, in [-π, π] to a rounding. `None` for more than 2^53 turns.
fn nearest(high: f64, low: f64) -> Option<(i64, [f64; 2])> {
    let k = (high / TAU).round();
    if high.abs() <= PI {
        return Some((0, [high, low]));
    }
    #[allow(clippy::cast_precision_loss)] // 2^53
    if k.is_nan() || k.abs() > LARGEST as f64 {
        return None;
    }
    // The difference is exact, since both numbers are within a factor of two.
    let (product, of_product) = two_product(k, TAU);
    let (of_low, of_lowest) = two_product(k, TAU_LOW);
    let (lower, lost) = two_sum(low, -of_product);
    let (lower, lost_again) = two_sum(lower, -of_low);
    let (rest, rounding) = two_sum(high - product, lower);
    let rest_low = rounding + (lost + lost_again - of_lowest - k * TAU_LOWEST);
    let (rest, rest_low) = two_sum(rest, rest_low);
    #[allow(clippy::cast_possible_truncation)] // an integer of at most 2^53
    let k = k as i64;
    if rest.abs() <= PI {
        return Some((k, [rest, rest_low]));
    }
    // A quotient of sixteen digits may be one turn off.
    nearest(rest, rest_low).map(|(more, rest)| (k + more, rest))
}

/// 2π times the turns, as a number and its low part.
fn turned(turns: i64) -> [f64; 2] {
    let k = number(turns);
    let (product, lost) = two_product(k, TAU);
    [product, lost + k * TAU_LOW]
}

#[allow(clippy::cast_precision_loss)] // at most 2^53
fn number(turns: i64) -> f64 {
    turns as f64
}

/// `a b` as (rounded product, rounding error), by Dekker's algorithm: the fused operation is slow if no instruction
/// exists.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let scaled = 134_217_729.0 * x;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let product = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    (product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low)
}

#[cfg(test)]
mod tests {
    use super::{Turns, nearest, with_turns};
    use nalgebra::SVector;

    #[test]
    fn angles_are_reduced_to_thirty_digits() {
        // The exact remainders, from 120 digits of 2π.
        for (angle, k, high, low) in [
            (1e9, 159_154_943, 0.577_395_423_501_385_2, -4.937_786_218_090_278_4e-18),
            (4.5, 1, -1.783_185_307_179_586_5, -2.288_475_490_443_932_7e-17),
            (-1e9, -159_154_943, -0.577_395_423_501_385_2, 4.937_786_218_090_278_4e-18),
            (core::f64::consts::TAU, 1, -2.449_293_598_294_706_4e-16, 5.989_539_619_436_679e-33),
            (62_831_853.071_795_86, 10_000_000, -6.326_469_511_952_699e-9, -1.537_344_478_267_249_8e-25),
            (1e15, 159_154_943_091_895, 2.109_698_117_070_112_6, 3.160_753_408_753_027_7e-17),
            (-3.7e16, -5_888_732_894_400_127, -2.660_606_645_439_128_4, -6.683_282_685_223_188e-18),
            (5e16, 7_957_747_154_594_767, -1.329_244_368_547_340_3, 8.111_284_637_588_888e-17),
            (22.0, 4, -3.132_741_228_718_346, -9.153_901_961_775_731e-17),
            (710.0, 113, 6.028_870_672_810_744e-5, 7.312_385_788_746_351e-22),
        ] {
            let found = nearest(angle, 0.0);
            let (turns, [rest, rest_low]) = found.expect("less than 2^53 turns");
            assert_eq!((turns, rest.to_bits()), (k, f64::to_bits(high)), "{angle}");
            // Measured: 0 for all but 1e15, 4e-33.
            assert!((rest_low - low).abs() < 1e-31, "{angle}: {rest_low:e}, not {low:e}");
            // Back to the number itself.
            let back = with_turns(&SVector::from([rest]), &SVector::from([rest_low]), &Turns::from([turns]))[0];
            assert_eq!(back.to_bits(), f64::to_bits(angle), "{angle}");
        }
        assert_eq!([1e18, f64::INFINITY, f64::NAN].map(|angle| nearest(angle, 0.0)), [None; 3]);
    }

    #[test]
    fn ten_million_reductions_lose_nothing() {
        // A turn at a time: 2π rounded to a number and its low part differs from 2π by 6e-33 each time.
        let (mut angle, mut low, mut turns) = (1.0, 0.0, 0);
        for _ in 0..10_000_000 {
            (angle, low) = crate::compensated::two_sum(angle, low);
            let (sum, lost) = crate::compensated::two_sum(angle, super::TAU);
            let (k, rest) = nearest(sum, lost + (low + super::TAU_LOW)).expect("one turn");
            [angle, low] = rest;
            turns += k;
        }
        assert_eq!(turns, 10_000_000);
        // Measured: 6e-33, a rounding of the low part.
        assert!(((angle - 1.0) + low).abs() < 1e-31, "{angle} {low:e}");
    }
}
