//! States at which functions of the motion vanish.
//!
//! In: a run, functions g(t, q, v), a time to end at. Out: the states where a function changes its sign, in their order, by steps of the exact length:
//!
//! ```text
//! search     signs of g at SAMPLES + 1 times of the path over a step; where g has an extremum between samples that is nearer to zero, there too
//! bracket    the root of g along the path, between two samples of different sign
//! polish     the step from the node before whose end has g = 0, by Newton's iteration with the slope along the path
//! enclose    lengths a rounding apart between which g changes its sign, by wider and wider brackets about that one, and bisection
//! ```
//!
//! Zero counts as positive: g is RISING where it comes from below zero, FALLING where it goes there. What only touches zero is no event; nor is a zero at
//! the very start, so that a run that was stopped at an event goes on from it: there g has the sign that it takes next. So a search looks from a billionth of a
//! step after its start to as much after its end, where what it finds is an event at the end: of two searches that follow each other one finds it. Two events of one step are found where a sample
//! or an extremum lies between them; of faster ones, less than an eighth of a step apart, a pair may be missed.
//! AFTER AN EVENT |g| is not larger than at neighbouring lengths of the step, to rounding.

use super::{Integrator, Path};
use crate::error::StepError;
use crate::state::State;
use core::fmt;
use nalgebra::SVector;

/// Parts into which a step is divided.
const SAMPLES: u32 = 8;
/// Iterations that locate a root, along the path or by steps.
const ITERATIONS: u32 = 60;
/// Part of the interval around a root over which the slope is measured.
const SLOPE: f64 = 1e-3;
/// Part of a step after its start in which an event is the one that the search began at; as much after its end is searched too.
const START: f64 = 1e-9;

/// In which direction a function passes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Either.
    Both,
}

/// A function g(t, q, v) of time, coordinates and velocities.
pub type Function<'a, const N: usize> = dyn Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> f64 + 'a;

/// A function of the motion, and the direction in which it passes zero.
#[derive(Clone, Copy)]
pub struct Event<'a, const N: usize> {
    g: &'a Function<'a, N>,
    direction: Direction,
}

impl<'a, const N: usize> Event<'a, N> {
    /// An event where `g(t, q, v)` passes zero in a direction. It has to be continuous, and the same for the same arguments.
    pub fn new(g: &'a Function<'a, N>, direction: Direction) -> Self {
        Self { g, direction }
    }
}

impl<const N: usize> fmt::Debug for Event<'_, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Event").field("direction", &self.direction).finish_non_exhaustive()
    }
}

/// An event that was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<const N: usize> {
    /// The index of the event among those that were asked for.
    pub event: usize,
    /// Whether g was below zero before.
    pub is_rising: bool,
    /// The state there.
    pub state: State<N>,
    /// The velocity there.
    pub v: SVector<f64, N>,
    /// Length of the step that leads there from the node before it.
    pub length: f64,
}

/// The events of a run; see [`Integrator::events`].
///
/// An item is a [`Crossing`], or the error of the step that fails: then the run is at its last good node, and the iterator ends.
#[derive(Debug)]
pub struct Events<'a, I, const N: usize> {
    run: &'a mut I,
    wanted: &'a [Event<'a, N>],
    until: f64,
    /// Whether each function was positive, where that is known.
    signs: Vec<Option<bool>>,
    /// The run after the step that is searched, and what was found in it: the last first.
    ahead: Option<I>,
    found: Vec<Crossing<N>>,
    is_over: bool,
}

impl<'a, I: Integrator<N>, const N: usize> Events<'a, I, N> {
    pub(super) fn new(run: &'a mut I, wanted: &'a [Event<'a, N>], until: f64) -> Self {
        let signs = vec![None; wanted.len()];
        Self { run, wanted, until, signs, ahead: None, found: Vec::new(), is_over: false }
    }

    /// The next event, or none before the end.
    fn advance(&mut self) -> Result<Option<Crossing<N>>, StepError> {
        self.run.check_ahead(self.until)?;
        let direction = self.run.h().signum();
        while self.found.is_empty() {
            if let Some(ahead) = self.ahead.take() {
                if ahead.time_to(self.until) * direction < 0.0 {
                    self.run.end_at(self.until)?;
                } else {
                    *self.run = ahead;
                }
            }
            if self.run.time_to(self.until) == 0.0 {
                self.run.set_time(self.until);
                return Ok(None);
            }
            let ahead = self.run.after_a_step()?;
            self.search(&ahead)?;
            self.ahead = Some(ahead);
        }
        Ok(self.found.pop())
    }
}

impl<I: Integrator<N>, const N: usize> Iterator for Events<'_, I, N> {
    type Item = Result<Crossing<N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let next = self.advance().transpose();
        self.is_over = !matches!(next, Some(Ok(_)));
        next
    }
}

impl<I: Integrator<N>, const N: usize> Events<'_, I, N> {
    /// Finds the events of the step that leads from the run to `ahead`.
    fn search(&mut self, ahead: &I) -> Result<(), StepError> {
        let run = &*self.run;
        let start = run.state();
        let path = ahead.path(&start)?.since_start();
        let h = run.time_to(ahead.t()) + ahead.node().t_low;
        let left = run.time_to(self.until);
        let is_last = ahead.time_to(self.until) * h.signum() <= 0.0;
        for (index, event) in self.wanted.iter().enumerate() {
            let along = |part: f64| {
                let passed = part * h;
                let state = path.state(passed);
                event.value(&State { t: start.t + passed, ..state }, &path.velocity(passed))
            };
            let by_steps = |part: f64| -> Result<Sample, StepError> {
                let value = reached(run, event, part * h, f64::INFINITY.copysign(h))?.value;
                Ok(Sample { part, value })
            };
            let sign = &mut self.signs[index];
            // Where a search begins and ends, signs are those of steps: velocities of a path are off there, and the search before or after has another path.
            if sign.is_none() {
                let first = by_steps(START)?;
                *sign = (first.value != 0.0).then_some(first.is_positive());
            }
            let last = if is_last { Some(by_steps(left / h + START)?) } else { None };
            for change in changes(&along, last, sign)? {
                let Some(part) = located(&by_steps, &along, &change)? else {
                    // It is in the next step.
                    *sign = Some(!change.is_rising);
                    continue;
                };
                *sign = Some(change.is_rising);
                let length = part * h;
                if event.admits(change.is_rising) && (length - left) * h.signum() <= START * h.abs() {
                    let reached = reached(run, event, length, self.until)?;
                    let (state, v, length) = (reached.state, reached.v, reached.length);
                    self.found.push(Crossing { event: index, is_rising: change.is_rising, state, v, length });
                }
            }
        }
        self.found.sort_by(|a, b| b.length.abs().total_cmp(&a.length.abs()));
        Ok(())
    }
}

impl<const N: usize> Event<'_, N> {
    /// g at a state.
    fn value(&self, state: &State<N>, v: &SVector<f64, N>) -> Result<f64, StepError> {
        let value = (self.g)(state.t, &state.q, v);
        let lost = StepError::NonFinite { t: state.t, quantity: "function of an event", expression: None };
        if value.is_finite() { Ok(value) } else { Err(lost) }
    }

    /// Whether it is one in this direction.
    fn admits(&self, is_rising: bool) -> bool {
        match self.direction {
            Direction::Rising => is_rising,
            Direction::Falling => !is_rising,
            Direction::Both => true,
        }
    }
}

/// Parts of a step between which a function changes its sign, and the values there.
#[derive(Clone, Copy)]
struct Change {
    is_rising: bool,
    from: Sample,
    to: Sample,
}

/// A function at a part of a step.
#[derive(Clone, Copy)]
struct Sample {
    part: f64,
    value: f64,
}

impl Sample {
    fn of(along: &impl Fn(f64) -> Result<f64, StepError>, part: f64) -> Result<Self, StepError> {
        along(part).map(|value| Self { part, value })
    }

    fn is_positive(&self) -> bool {
        self.value >= 0.0
    }
}

/// Where a function changes its sign along a step, in order. `sign` is that before the step, where it is known, and after it.
/// `last` is the function where the search ends, by a step.
fn changes(
    along: &impl Fn(f64) -> Result<f64, StepError>,
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
fn samples(along: &impl Fn(f64) -> Result<f64, StepError>) -> Result<Vec<Sample>, StepError> {
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
fn extremum(along: &impl Fn(f64) -> Result<f64, StepError>, near: &[Sample]) -> Result<Sample, StepError> {
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
fn root(along: &impl Fn(f64) -> Result<f64, StepError>, change: &Change) -> Result<f64, StepError> {
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

/// The end of a step from the node before an event.
struct Reached<const N: usize> {
    length: f64,
    state: State<N>,
    v: SVector<f64, N>,
    value: f64,
}

/// The end of the step of a length, or of the one that ends at `until` if that is shorter.
fn reached<I: Integrator<N>, const N: usize>(
    run: &I,
    event: &Event<'_, N>,
    length: f64,
    until: f64,
) -> Result<Reached<N>, StepError> {
    let mut aside = run.clone();
    let left = run.time_to(until);
    let length = if length.abs() < left.abs() { length } else { left };
    if length.to_bits() == left.to_bits() {
        aside.end_at(until)?;
    } else if length.is_normal() {
        // A length below the smallest of a step is none.
        aside.step_of(length)?;
    }
    let state = aside.state();
    let v = aside.velocity()?;
    let value = event.value(&state, &v)?;
    Ok(Reached { length, state, v, value })
}

/// The part of a step that the step from the node before to the event of a change of sign is: by Newton's iteration with the slope along the path, and then
/// enclosed. None where steps have no such change.
fn located(
    by_steps: &impl Fn(f64) -> Result<Sample, StepError>,
    along: &impl Fn(f64) -> Result<f64, StepError>,
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
    by_steps: &impl Fn(f64) -> Result<Sample, StepError>,
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
