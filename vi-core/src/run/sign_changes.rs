//! Where a function of the part of a step changes its sign.
//!
//! In: the function along the path over a step, and by steps of the exact length. Out: its changes of sign, in order, and the part at which each is:
//!
//! ```text
//! search     signs at SAMPLES + 1 parts of the path; where there is an extremum between samples that is nearer to zero, there too
//! bracket    the root along the path, between two samples of different sign
//! polish     the root by steps, by Newton's iteration with the slope along the path
//! enclose    parts a rounding apart between which the function by steps changes its sign, by wider and wider brackets about that one, and bisection
//! ```
//!
//! Zero counts as positive.

use crate::error::StepError;

/// Parts into which a step is divided.
const SAMPLES: u32 = 8;
/// Iterations that locate a root, along the path or by steps.
const ITERATIONS: u32 = 60;
/// Part of the interval around a root over which the slope is measured.
const SLOPE: f64 = 1e-3;
/// Part of a step after its start in which an event is the one that the search began at; as much after its end is searched too.
pub(super) const START: f64 = 1e-9;

/// Parts of a step between which a function changes its sign, and the values there.
#[derive(Clone, Copy)]
pub(super) struct Change {
    pub(super) is_rising: bool,
    from: Sample,
    to: Sample,
}

/// A function at a part of a step.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) part: f64,
    pub(super) value: f64,
}

impl Sample {
    fn of(along: &dyn Fn(f64) -> Result<f64, StepError>, part: f64) -> Result<Self, StepError> {
        along(part).map(|value| Self { part, value })
    }

    pub(super) fn is_positive(&self) -> bool {
        self.value >= 0.0
    }
}

/// Where a function changes its sign along a step, in order. `sign` is that before the step, where it is known, and after it.
/// `last` is the function where the search ends, by a step.
pub(super) fn changes(
    along: &dyn Fn(f64) -> Result<f64, StepError>,
    last: Option<Sample>,
    sign: &mut Option<bool>,
) -> Result<Vec<Change>, StepError> {
    let mut samples = samples(along)?;
    samples.retain(|sample| last.is_none_or(|last| sample.part < last.part));
    samples.extend(last);
    let first = samples.iter().find(|sample| sample.value != 0.0).is_none_or(Sample::is_positive);
    let mut is_positive = sign.unwrap_or(first);
    let mut changes = Vec::new();
    let mut from = samples[0];
    for to in samples {
        // At the start the sign is the one that was found there: that of the path may differ by rounding.
        if to.part > START && to.is_positive() != is_positive {
            is_positive = !is_positive;
            changes.push(Change { is_rising: is_positive, from, to });
        }
        from = to;
    }
    *sign = Some(is_positive);
    Ok(changes)
}

/// The function at the parts of a step, and at its extrema that are nearer to zero.
fn samples(along: &dyn Fn(f64) -> Result<f64, StepError>) -> Result<Vec<Sample>, StepError> {
    let part = |index: u32| START + f64::from(index) / f64::from(SAMPLES);
    let even: Vec<Sample> = (0..=SAMPLES).map(|index| Sample::of(along, part(index))).collect::<Result<_, _>>()?;
    let mut samples = even.clone();
    for near in even.windows(3) {
        if has_near_extremum(near) {
            samples.push(extremum(along, near)?);
        }
    }
    samples.sort_by(|a, b| a.part.total_cmp(&b.part));
    Ok(samples)
}

/// Whether the parabola through three neighbours of one sign has an extremum between them that is half as near to zero as they are.
fn has_near_extremum(near: &[Sample]) -> bool {
    let &[a, b, c] = near else { return false };
    let is_one_sign = a.is_positive() == b.is_positive() && b.is_positive() == c.is_positive();
    // g = b + slope x + bend x²/2, x in widths of a part.
    let slope = 0.5 * (c.value - a.value);
    let bend = a.value - 2.0 * b.value + c.value;
    let x = -slope / bend;
    let value = b.value + 0.5 * slope * x;
    let nearest = a.value.abs().min(b.value.abs()).min(c.value.abs());
    let sign = if b.is_positive() { 1.0 } else { -1.0 };
    is_one_sign && x.abs() <= 1.0 && bend * sign > 0.0 && value * sign <= 0.5 * nearest
}

/// The extremum between three neighbours, or a point of the other sign: by golden sections.
fn extremum(along: &dyn Fn(f64) -> Result<f64, StepError>, near: &[Sample]) -> Result<Sample, StepError> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let sign = if near[0].is_positive() { 1.0 } else { -1.0 };
    let mut from = near[0].part;
    let mut to = near[near.len() - 1].part;
    let mut low = Sample::of(along, to - GOLDEN * (to - from))?;
    let mut high = Sample::of(along, from + GOLDEN * (to - from))?;
    for _ in 0..ITERATIONS {
        if low.value * sign <= high.value * sign {
            (to, high) = (high.part, low);
            low = Sample::of(along, to - GOLDEN * (to - from))?;
        } else {
            (from, low) = (low.part, high);
            high = Sample::of(along, from + GOLDEN * (to - from))?;
        }
        if low.value * sign < 0.0 {
            return Ok(low);
        }
    }
    Ok(low)
}

/// The part of the step at which the function vanishes along the path: by false position, each second one of which halves the value at the end that stays (Illinois).
fn root(along: &dyn Fn(f64) -> Result<f64, StepError>, change: &Change) -> Result<f64, StepError> {
    let Change { mut from, mut to, .. } = *change;
    if from.is_positive() == to.is_positive() {
        // It changed its sign between the path of the step before and this one.
        return Ok(from.part);
    }
    for _ in 0..ITERATIONS {
        let middle = from.part + (to.part - from.part) * (from.value / (from.value - to.value));
        // Where values underflow there is no quotient.
        let middle = if middle.is_finite() { middle } else { 0.5 * (from.part + to.part) };
        let new = Sample::of(along, middle)?;
        let is_between = (new.part - from.part) * (new.part - to.part) < 0.0;
        if new.value == 0.0 || !is_between {
            return Ok(new.part);
        }
        if new.is_positive() == to.is_positive() {
            from.value *= 0.5;
            to = new;
        } else {
            to.value *= 0.5;
            from = new;
        }
    }
    Ok(0.5 * (from.part + to.part))
}

/// The part of a step that the step from the node before to the event of a change of sign is: by Newton's iteration with the slope along the path, and then
/// enclosed. None where steps have no such change.
pub(super) fn located(
    by_steps: &dyn Fn(f64) -> Result<Sample, StepError>,
    along: &dyn Fn(f64) -> Result<f64, StepError>,
    change: &Change,
) -> Result<Option<f64>, StepError> {
    let width = SLOPE * (change.to.part - change.from.part);
    let mut best = by_steps(root(along, change)?)?;
    let slope = (along(best.part + width)? - along(best.part - width)?) / (2.0 * width);
    for _ in 0..ITERATIONS {
        let part = best.part - best.value / slope;
        let moves = (part - best.part).abs() > 0.0;
        if !moves || !(0.0..=1.0 + START).contains(&part) {
            break;
        }
        let next = by_steps(part)?;
        if next.value.abs() >= best.value.abs() {
            break;
        }
        best = next;
    }
    if best.value == 0.0 {
        return Ok(Some(best.part));
    }
    // What changed between two paths is at the node where neither is right about it.
    let is_at_node = change.from.is_positive() == change.to.is_positive();
    let enclosed = enclosed(by_steps, best, change.is_rising)?;
    Ok(enclosed.map(|sample| sample.part).or(is_at_node.then_some(0.0)))
}

/// The sample nearest to zero of two that are a rounding apart and between which g changes its sign, by brackets about `near` that grow to the side where
/// the event is, and then by bisection; none where g does not change its sign by steps up to the end of this step on that side.
fn enclosed(
    by_steps: &dyn Fn(f64) -> Result<Sample, StepError>,
    near: Sample,
    is_rising: bool,
) -> Result<Option<Sample>, StepError> {
    let is_before = |sample: &Sample| sample.is_positive() != is_rising;
    let side = if is_before(&near) { 1.0 } else { -1.0 };
    let mut from = near;
    let mut width = 2.0 * f64::EPSILON;
    let mut to = loop {
        let part = (from.part + side * width).clamp(0.0, 1.0 + START);
        let next = by_steps(part)?;
        if is_before(&next) != is_before(&near) {
            break next;
        }
        if !(part > 0.0 && part < 1.0 + START) {
            return Ok(None);
        }
        from = next;
        width *= 2.0;
    };
    while (to.part - from.part).abs() > 2.0 * f64::EPSILON {
        let middle = by_steps(0.5 * (from.part + to.part))?;
        if is_before(&middle) == is_before(&near) {
            from = middle;
        } else {
            to = middle;
        }
    }
    let nearest = |one: Sample, other: Sample| if other.value.abs() < one.value.abs() { other } else { one };
    Ok(Some(nearest(nearest(to, from), near)))
}
