//! Event search within one step.
//!
//! For a node, its step, and the last sign of each function, the search returns the crossings of that step in order.
//!
//! ```text
//! samples    each function at both nodes, at SAMPLES − 1 points of the dense output between them, and at extrema nearer to zero
//! bracket    between two samples of different sign: the dense output, then steps of exact length, to neighbouring lengths (`solve::bracket`)
//! instant    the side of every function at the first such length
//! singular   a step may pass a dead point of a mechanism, but none ends there: the dense output has the crossing
//! ```

use super::event::{Crossing, Event, Met, Moment};
use super::reached::{ErasedRun, StepEnd, moved};
use super::side::{NodeAndAfter, Side, resolution};
use super::{DenseOutput, Run};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::solve::bracket::{Point, narrowed};
use crate::state::State;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::convert::Infallible;

/// Parts into which a step is divided.
const SAMPLES: u32 = 8;
/// Iterations of the search for an extremum of the dense output.
const ITERATIONS: u32 = 60;

/// A run that is searched, type-erased.
pub(super) trait Searched<const N: usize> {
    /// Takes the previewed step. Returns whether the run is at `until`.
    fn take(&mut self, until: f64) -> Result<bool, StepError>;
    /// Previews the next step, or the part of it up to `until`.
    fn look_ahead(&mut self, until: f64) -> Result<SearchedStep<N>, StepError>;
    /// Moves to a length within the previewed step.
    fn stop(&mut self, length: f64) -> Result<(), StepError>;
    /// The run at its node.
    fn node(&self) -> &dyn ErasedRun<N>;
    /// The run at the end of the previewed step.
    fn end(&self) -> &dyn ErasedRun<N>;
}

/// A run, and the run at the end of the searched step, with its length. `watch` is called after each step.
pub(super) struct Ahead<'a, W, M: Method<S, N>, S, const N: usize> {
    run: &'a mut Run<M, S, N>,
    end: Option<(Run<M, S, N>, f64)>,
    watch: W,
}

impl<'a, W, M: Method<S, N>, S, const N: usize> Ahead<'a, W, M, S, N> {
    pub(super) fn new(run: &'a mut Run<M, S, N>, watch: W) -> Self {
        Self { run, end: None, watch }
    }
}

impl<W, M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Searched<N> for Ahead<'_, W, M, S, N>
where
    W: FnMut(&Run<M, S, N>) -> Result<(), StepError>,
{
    fn take(&mut self, until: f64) -> Result<bool, StepError> {
        self.run.check_ahead(until)?;
        if let Some((end, _)) = self.end.take() {
            *self.run = end;
            (self.watch)(self.run)?;
        }
        let is_at_end = self.run.time_to(until) == 0.0;
        if is_at_end {
            self.run.set_time(until);
        }
        Ok(is_at_end)
    }

    fn look_ahead(&mut self, until: f64) -> Result<SearchedStep<N>, StepError> {
        let start = self.run.state();
        let mut end = self.run.after_a_step()?;
        let path = Box::new(end.dense_output(&start)?.since_start());
        let h = self.run.time_to(end.t()) + end.node().t_low;
        let beyond = end.time_to(until) * h.signum();
        let is_last = beyond <= 0.0;
        if beyond < 0.0 {
            end.clone_from(self.run);
            end.end_at(until)?;
        } else if is_last {
            end.set_time(until);
        }
        let length = if is_last { self.run.time_to(until) } else { h };
        self.end = Some((end, length));
        Ok(SearchedStep { t: start.t, length, is_last, path })
    }

    fn stop(&mut self, length: f64) -> Result<(), StepError> {
        *self.run = match self.end.take() {
            Some((end, step)) if length.to_bits() == step.to_bits() => end,
            _ => moved(self.run, length)?,
        };
        (self.watch)(self.run)
    }

    fn node(&self) -> &dyn ErasedRun<N> {
        &*self.run
    }

    fn end(&self) -> &dyn ErasedRun<N> {
        self.end.as_ref().map_or(&*self.run, |(end, _)| end)
    }
}

/// State of one function during a search.
pub(super) struct Watched {
    /// Whether it was positive last.
    is_positive: bool,
    /// Length after the node at which exact steps confirm that sign.
    sure: f64,
    /// Samples of the function over the step, by length.
    samples: Vec<Point>,
    /// Index of the next sample to search.
    next: usize,
    /// Length at which it is not finite.
    lost: Option<f64>,
    /// If no step ends at its sign change: length of the next step past it.
    beyond: Option<f64>,
}

impl Watched {
    /// A function with a known side.
    pub(super) fn new(side: &Side) -> Self {
        let (is_positive, sure) = (side.is_positive, side.after);
        Self { is_positive, sure, samples: Vec::new(), next: 0, lost: None, beyond: None }
    }
}

/// A searched step.
pub(super) struct SearchedStep<const N: usize> {
    /// Start time of the step.
    t: f64,
    /// Length of the searched part.
    pub(super) length: f64,
    is_last: bool,
    /// Dense output as a function of the time since the start.
    path: Box<dyn DenseOutput<N>>,
}

/// A searched step and its run. Lengths are positive in both directions of time.
struct EventSearch<'a, const N: usize> {
    step: &'a SearchedStep<N>,
    run: &'a dyn Searched<N>,
    /// Length of the searched part.
    length: f64,
    /// Moments at both ends.
    ends: [Moment<N>; 2],
}

impl<const N: usize> SearchedStep<N> {
    /// The crossings of the step, and the error that ends them. With `is_first`, only the first crossing.
    pub(super) fn crossings(
        &self,
        run: &dyn Searched<N>,
        wanted: &[Event<N>],
        watched: &mut [Watched],
        is_first: bool,
    ) -> Vec<Result<Crossing<N>, StepError>> {
        let mut found = Vec::new();
        let mut take = |crossing| {
            found.push(Ok(crossing));
            is_first
        };
        if let Err(error) = self.search(run, wanted, watched, &mut take) {
            found.push(Err(error));
        }
        found
    }

    /// Passes the crossings of the step to `take`, until it returns that no more are wanted.
    fn search(
        &self,
        run: &dyn Searched<N>,
        wanted: &[Event<N>],
        watched: &mut [Watched],
        take: &mut dyn FnMut(Crossing<N>) -> bool,
    ) -> Result<(), StepError> {
        let ends = [run.node().reached(0.0)?.moment(), run.end().reached(0.0)?.moment()];
        let search = EventSearch { step: self, run, length: self.length.abs(), ends };
        let mut changes = Vec::new();
        for (event, watched) in wanted.iter().zip(&mut *watched) {
            search.sample(event, watched)?;
            changes.push(search.change(event, watched)?);
        }
        let mut is_over = false;
        while !is_over {
            let first = (0..changes.len()).filter(|&i| changes[i].is_some());
            let first = first.min_by(|&a, &b| changes[a].unwrap_or(0.0).total_cmp(&changes[b].unwrap_or(0.0)));
            let length = match first.and_then(|first| changes[first]) {
                Some(length) => length,
                None if self.is_last => search.length,
                None => break,
            };
            let lost = wanted.iter().zip(&*watched).filter_map(|(event, watched)| Some((event, watched.lost?)));
            for (event, _) in lost.filter(|(_, lost)| *lost <= length) {
                search.point(event, length)?;
            }
            is_over = first.is_none();
            let beyond = first.and_then(|first| watched[first].beyond.take());
            let sides = match beyond {
                Some(beyond) => search.sides_along(wanted, watched, (first, length, beyond))?,
                None => search
                    .at(length, |node| wanted.iter().map(|event| node.side(event)).collect::<Result<Vec<_>, _>>())?,
            };
            // An earlier sign change that the samples missed comes first.
            let mut is_unseen = false;
            for (index, side) in sides.iter().enumerate() {
                let watched = &mut watched[index];
                let is_other = side.is_positive != watched.is_positive && !side.is_zero && first != Some(index);
                let place = watched.samples.partition_point(|sample| sample.x < length);
                if is_other && watched.samples.get(place).is_some_and(|sample| sample.x > length) {
                    watched.samples.insert(place, Point { x: length, y: side.value });
                    watched.next = place;
                    changes[index] = search.change(&wanted[index], watched)?;
                    is_unseen = true;
                }
            }
            if is_unseen {
                continue;
            }
            let mut events = Vec::new();
            for (event, side) in sides.iter().enumerate() {
                let watched = &mut watched[event];
                let is_met =
                    side.is_positive != watched.is_positive && (side.is_zero || first == Some(event) || is_over);
                if is_met || first == Some(event) {
                    (watched.is_positive, watched.sure) = (side.is_positive, length + side.after);
                    changes[event] = search.change(&wanted[event], watched)?;
                }
                if is_met && wanted[event].admits(side.is_positive) {
                    events.push(Met { event, is_rising: side.is_positive });
                }
            }
            if !events.is_empty() {
                let StepEnd { state, v } =
                    if beyond.is_some() { search.end_along(length) } else { search.reached(length)? };
                if take(Crossing { events, state, v, length: length.copysign(self.length) }) {
                    return Ok(());
                }
            }
        }
        for watched in watched {
            watched.sure = (watched.sure - search.length).max(0.0);
        }
        Ok(())
    }
}

impl<const N: usize> EventSearch<'_, N> {
    /// The moment after a length, by dense output.
    fn along(&self, length: f64) -> Moment<N> {
        let passed = length.copysign(self.step.length);
        Moment { t: self.step.t + passed, q: self.step.path.state(passed).q, v: self.step.path.velocity(passed) }
    }

    /// The state after a length, by dense output.
    fn end_along(&self, length: f64) -> StepEnd<N> {
        let passed = length.copysign(self.step.length);
        let state = State { t: self.step.t + passed, ..self.step.path.state(passed) };
        StepEnd { state, v: self.step.path.velocity(passed) }
    }

    /// The sign change of a function between two samples, by dense output.
    fn crossing_along(&self, event: &Event<N>, between: [Point; 2]) -> f64 {
        let value = |x: f64| Ok::<_, Infallible>(event.at(&self.along(x)));
        let Ok([before, _]) = narrowed(value, between, None, 0.0);
        before.x
    }

    /// The sides of all functions after a length at which no step ends: `first` changes its sign, the others keep
    /// theirs until the next length at which a step ends.
    fn sides_along(
        &self,
        wanted: &[Event<N>],
        watched: &[Watched],
        (first, length, beyond): (Option<usize>, f64, f64),
    ) -> Result<Vec<Side>, StepError> {
        let moment = self.along(length);
        let side = |(index, event): (usize, &Event<N>)| {
            let (is_first, value) = (first == Some(index), event.value(&moment)?);
            let is_positive = watched[index].is_positive != is_first;
            Ok(Side { is_positive, after: beyond - length, is_zero: is_first, is_turned: false, value })
        };
        wanted.iter().enumerate().map(side).collect()
    }

    /// The end of a step of this length.
    fn reached(&self, length: f64) -> Result<StepEnd<N>, StepError> {
        if length.to_bits() == self.length.to_bits() {
            self.run.end().reached(0.0)
        } else {
            self.run.node().reached(length.copysign(self.step.length))
        }
    }

    /// The moment after a length, by a step.
    fn moment(&self, length: f64) -> Result<Moment<N>, StepError> {
        if length.to_bits() == self.length.to_bits() {
            Ok(self.ends[1])
        } else if length == 0.0 {
            Ok(self.ends[0])
        } else {
            self.reached(length).map(|reached| reached.moment())
        }
    }

    /// A function after a length, by a step.
    fn point(&self, event: &Event<N>, x: f64) -> Result<Point, StepError> {
        Ok(Point { x, y: event.value(&self.moment(x)?)? })
    }

    /// Evaluates `ask` at the node after a length.
    fn at<R>(
        &self,
        length: f64,
        ask: impl FnOnce(&mut NodeAndAfter<N>) -> Result<R, StepError>,
    ) -> Result<R, StepError> {
        if length.to_bits() == self.length.to_bits() {
            return ask(&mut NodeAndAfter::of(self.run.end())?);
        }
        let run_after = self.run.node().run_after(length.copysign(self.step.length))?;
        ask(&mut NodeAndAfter::of(&*run_after)?)
    }

    /// Samples a function over the step, up to the first value that is not finite.
    fn sample(&self, event: &Event<N>, watched: &mut Watched) -> Result<(), StepError> {
        let samples = &mut watched.samples;
        samples.clear();
        watched.lost = None;
        samples.push(self.point(event, 0.0)?);
        watched.next = 1;
        for index in 1..=SAMPLES {
            let x = self.length * (f64::from(index) / f64::from(SAMPLES));
            let y = event.at(&self.along(x));
            let by_path = (y.is_finite() && index < SAMPLES).then_some(Point { x, y });
            let Some(sample) = by_path.or_else(|| self.point(event, x).ok()) else {
                watched.lost = Some(x);
                break;
            };
            samples.push(sample);
        }
        let near = samples.windows(3).filter(|near| has_near_extremum(near));
        let extrema: Vec<Point> = near.map(|near| extremum(|x| event.at(&self.along(x)), near)).collect();
        samples.extend(extrema.into_iter().filter(|sample| sample.y.is_finite()));
        samples.sort_by(|a, b| a.x.total_cmp(&b.x));
        Ok(())
    }

    /// The length of the next sign change of a function. It may revert within the rounding error of the function.
    fn change(&self, event: &Event<N>, watched: &mut Watched) -> Result<Option<f64>, StepError> {
        watched.beyond = None;
        while let Some(&sample) = watched.samples.get(watched.next) {
            watched.next += 1;
            if sample.x <= watched.sure || sample.is_positive() == watched.is_positive {
                continue;
            }
            let moment = match self.moment(sample.x) {
                // No step ends at this place: continue past it.
                Err(StepError::Singular { .. }) => continue,
                moment => moment?,
            };
            let to = Point { x: sample.x, y: event.value(&moment)? };
            if to.is_positive() == watched.is_positive {
                watched.sure = sample.x;
                continue;
            }
            // Within its rounding error a function has no reliable sign.
            if to.y.abs() <= event.rounding(&moment, to.y)
                && self.at(to.x, |node| node.side(event))?.is_positive == watched.is_positive
            {
                continue;
            }
            return self.located(event, watched, to).map(Some);
        }
        // A value that is not finite counts as a change.
        Ok(watched.lost)
    }

    /// The length of the sign change of a function before `to`.
    fn located(&self, event: &Event<N>, watched: &mut Watched, to: Point) -> Result<f64, StepError> {
        let is_before = |point: Point| point.is_positive() == watched.is_positive;
        let mut from = self.point(event, watched.sure)?;
        if !is_before(from) {
            let side = self.at(from.x, |node| node.side(event))?;
            if side.is_positive != watched.is_positive {
                return Ok(from.x);
            }
            from = self.point(event, from.x + side.after)?;
            if !is_before(from) || from.x >= to.x {
                return Ok(to.x);
            }
        }
        let [before, after] = [watched.samples[watched.next - 2], watched.samples[watched.next - 1]];
        let guess = is_before(before).then(|| self.crossing_along(event, [before, after]));
        let resolution = resolution(self.step.t, self.run.node().step_length());
        let by_steps = narrowed(|x| self.point(event, x).map(|point| point.y), [from, to], guess, resolution);
        // A step may pass a singular place, such as a dead point, but none ends at it.
        if let Err(StepError::Singular { .. }) = by_steps
            && let Some(pair) = watched.samples[..watched.next].windows(2).rfind(|pair| is_before(pair[0]))
        {
            watched.beyond = Some(to.x);
            return Ok(self.crossing_along(event, [pair[0], pair[1]]));
        }
        let [from, to] = by_steps?;
        if to.y == 0.0 {
            return Ok(to.x);
        }
        let side = self.at(from.x, |node| node.side(event))?;
        Ok(if side.is_positive == watched.is_positive { to.x } else { from.x })
    }
}

/// Whether the parabola through three neighbours of one sign has an extremum between them that is less than half as far
/// from zero.
fn has_near_extremum(near: &[Point]) -> bool {
    let &[a, b, c] = near else { return false };
    let is_one_sign = a.is_positive() == b.is_positive() && b.is_positive() == c.is_positive();
    // g = b + slope x + bend x²/2, x in widths of a part.
    let slope = 0.5 * (c.y - a.y);
    let bend = a.y - 2.0 * b.y + c.y;
    let x = -slope / bend;
    let value = b.y + 0.5 * slope * x;
    let nearest = a.y.abs().min(b.y.abs()).min(c.y.abs());
    let sign = if b.is_positive() { 1.0 } else { -1.0 };
    is_one_sign && x.abs() <= 1.0 && bend * sign > 0.0 && value * sign <= 0.5 * nearest
}

/// The extremum between three neighbours, or a point of the other sign, by golden-section search.
fn extremum(y: impl Fn(f64) -> f64, near: &[Point]) -> Point {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let at = |x: f64| Point { x, y: y(x) };
    let sign = if near[0].is_positive() { 1.0 } else { -1.0 };
    let mut from = near[0].x;
    let mut to = near[near.len() - 1].x;
    let mut low = at(to - GOLDEN * (to - from));
    let mut high = at(from + GOLDEN * (to - from));
    for _ in 0..ITERATIONS {
        if low.y * sign <= high.y * sign {
            (to, high) = (high.x, low);
            low = at(to - GOLDEN * (to - from));
        } else {
            (from, low) = (low.x, high);
            high = at(from + GOLDEN * (to - from));
        }
        if low.y * sign < 0.0 {
            break;
        }
    }
    low
}
