//! The search of one step for events.
//!
//! In: a node, the step after it, functions and the sign that each had last. Out: the crossings of that step, in order.
//!
//! ```text
//! samples    each function at both nodes, at SAMPLES − 1 points of the dense output between them, and at extrema that are nearer to zero
//! bracket    the dense output between two samples of different sign, then steps of exact length, to neighbouring lengths (`solve::bracket`)
//! instant    at the first such length: the side of every function
//! ```

use super::events::{Crossing, Event, Met, Moment};
use super::side::{Node, Side, resolution};
use super::{DenseOutput, Run};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::solve::bracket::{Point, narrowed};
use crate::state::State;
use core::convert::Infallible;
use nalgebra::SVector;

/// Parts into which a step is divided.
const SAMPLES: u32 = 8;
/// Iterations that find an extremum of the dense output.
const ITERATIONS: u32 = 60;

/// A run from one node on, type-erased: the search is compiled once, and not for each method of each system.
pub(super) trait Motion<const N: usize> {
    /// Length of a step.
    fn step_length(&self) -> f64;
    /// The end of a step of this length.
    fn reached(&self, length: f64) -> Result<Reached<N>, StepError>;
    /// The run from there on.
    fn apart(&self, length: f64) -> Result<Box<dyn Motion<N> + '_>, StepError>;
}

/// The end of a step.
pub(super) struct Reached<const N: usize> {
    pub(super) state: State<N>,
    pub(super) v: SVector<f64, N>,
}

/// The run after a step of a length; a length below the smallest of a step is none.
fn moved<M, S, const N: usize>(run: &Run<M, S, N>, length: f64) -> Result<Run<M, S, N>, StepError>
where
    M: Method<S, N>,
    S: Lagrangian<N> + Copy,
{
    let mut aside = run.clone();
    if length.is_normal() {
        aside.step_of(length)?;
    }
    Ok(aside)
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Motion<N> for Run<M, S, N> {
    fn step_length(&self) -> f64 {
        self.h()
    }

    fn reached(&self, length: f64) -> Result<Reached<N>, StepError> {
        let end = moved(self, length)?;
        Ok(Reached { state: end.state(), v: end.velocity()? })
    }

    fn apart(&self, length: f64) -> Result<Box<dyn Motion<N> + '_>, StepError> {
        Ok(Box::new(moved(self, length)?))
    }
}

/// A run that is searched, type-erased.
pub(super) trait Searched<const N: usize> {
    /// Takes the step that was looked at. Returns whether the run is at `until`.
    fn take(&mut self, until: f64) -> Result<bool, StepError>;
    /// Looks at the step after the node of the run, or at the part of it up to `until`.
    fn look_ahead(&mut self, until: f64) -> Result<Step<N>, StepError>;
    /// Goes to a length in the step that was looked at.
    fn stop(&mut self, length: f64) -> Result<(), StepError>;
    /// The run at its node.
    fn node(&self) -> &dyn Motion<N>;
    /// The run at the end of the step that was looked at.
    fn end(&self) -> &dyn Motion<N>;
}

/// A run, and the run at the end of the step that is searched, with its length.
pub(super) struct Ahead<'a, M: Method<S, N>, S, const N: usize> {
    run: &'a mut Run<M, S, N>,
    end: Option<(Run<M, S, N>, f64)>,
}

impl<'a, M: Method<S, N>, S, const N: usize> Ahead<'a, M, S, N> {
    pub(super) fn new(run: &'a mut Run<M, S, N>) -> Self {
        Self { run, end: None }
    }
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Searched<N> for Ahead<'_, M, S, N> {
    fn take(&mut self, until: f64) -> Result<bool, StepError> {
        self.run.check_ahead(until)?;
        if let Some((end, _)) = self.end.take() {
            *self.run = end;
        }
        let is_at_end = self.run.time_to(until) == 0.0;
        if is_at_end {
            self.run.set_time(until);
        }
        Ok(is_at_end)
    }

    fn look_ahead(&mut self, until: f64) -> Result<Step<N>, StepError> {
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
        Ok(Step { t: start.t, length, is_last, path })
    }

    fn stop(&mut self, length: f64) -> Result<(), StepError> {
        *self.run = match self.end.take() {
            Some((end, step)) if length.to_bits() == step.to_bits() => end,
            _ => moved(self.run, length)?,
        };
        Ok(())
    }

    fn node(&self) -> &dyn Motion<N> {
        &*self.run
    }

    fn end(&self) -> &dyn Motion<N> {
        self.end.as_ref().map_or(&*self.run, |(end, _)| end)
    }
}

/// What is known of a function in a search.
pub(super) struct Watched {
    /// Whether it was positive last.
    is_positive: bool,
    /// A length after the node at which it had that sign by steps.
    sure: f64,
    /// The function over the step, by lengths.
    samples: Vec<Point>,
    /// The samples before this one have been looked at.
    next: usize,
    /// Where it is not finite.
    lost: Option<f64>,
}

impl Watched {
    /// A function of which its side is known.
    pub(super) fn new(side: &Side) -> Self {
        Self { is_positive: side.is_positive, sure: side.after, samples: Vec::new(), next: 0, lost: None }
    }
}

/// A step that is searched.
pub(super) struct Step<const N: usize> {
    /// Time of the node before it.
    t: f64,
    /// Length up to which it is searched.
    pub(super) length: f64,
    is_last: bool,
    /// The motion over it, by the time since its start.
    path: Box<dyn DenseOutput<N>>,
}

/// A step that is searched, and the run that takes it. Lengths are positive in both directions of time.
struct Search<'a, const N: usize> {
    step: &'a Step<N>,
    run: &'a dyn Searched<N>,
    /// Length up to which the step is searched.
    length: f64,
    /// Where the motion is at both ends.
    ends: [Moment<N>; 2],
}

impl<const N: usize> Step<N> {
    /// The crossings of the step, and the error that ends them; if `is_first`, no crossing after the first.
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

    /// Hands over the crossings of the step, until `take` says that this was the last one wanted.
    fn search(
        &self,
        run: &dyn Searched<N>,
        wanted: &[Event<N>],
        watched: &mut [Watched],
        take: &mut dyn FnMut(Crossing<N>) -> bool,
    ) -> Result<(), StepError> {
        let ends = [run.node().reached(0.0)?.moment(), run.end().reached(0.0)?.moment()];
        let search = Search { step: self, run, length: self.length.abs(), ends };
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
            let sides =
                search.at(length, |node| wanted.iter().map(|event| node.side(event)).collect::<Result<Vec<_>, _>>())?;
            // A function that changed its sign before, unseen by its samples, comes first.
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
                let Reached { state, v } = search.reached(length)?;
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

impl<const N: usize> Search<'_, N> {
    /// The motion after a length, by the dense output.
    fn along(&self, length: f64) -> Moment<N> {
        let passed = length.copysign(self.step.length);
        Moment { t: self.step.t + passed, q: self.step.path.state(passed).q, v: self.step.path.velocity(passed) }
    }

    /// The motion after a length, by a step.
    fn reached(&self, length: f64) -> Result<Reached<N>, StepError> {
        if length.to_bits() == self.length.to_bits() {
            self.run.end().reached(0.0)
        } else {
            self.run.node().reached(length.copysign(self.step.length))
        }
    }

    /// Where the motion is after a length, by a step.
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

    /// What is asked of the node after a length.
    fn at<R>(&self, length: f64, ask: impl FnOnce(&mut Node<N>) -> Result<R, StepError>) -> Result<R, StepError> {
        if length.to_bits() == self.length.to_bits() {
            return ask(&mut Node::of(self.run.end())?);
        }
        let apart = self.run.node().apart(length.copysign(self.step.length))?;
        ask(&mut Node::of(&*apart)?)
    }

    /// Samples a function over the step, up to where it is not finite.
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

    /// The length at which a function changes its sign next; it may be a change that is taken back within the rounding of the function.
    fn change(&self, event: &Event<N>, watched: &mut Watched) -> Result<Option<f64>, StepError> {
        while let Some(&sample) = watched.samples.get(watched.next) {
            watched.next += 1;
            if sample.x <= watched.sure || sample.is_positive() == watched.is_positive {
                continue;
            }
            let moment = self.moment(sample.x)?;
            let to = Point { x: sample.x, y: event.value(&moment)? };
            if to.is_positive() == watched.is_positive {
                watched.sure = sample.x;
                continue;
            }
            // Within its rounding the sign of a function says nothing.
            if to.y.abs() <= event.rounding(&moment, to.y)
                && self.at(to.x, |node| node.side(event))?.is_positive == watched.is_positive
            {
                continue;
            }
            return self.located(event, watched, to).map(Some);
        }
        // What is not finite is met like a change.
        Ok(watched.lost)
    }

    /// The length at which a function changes its sign before `to`.
    fn located(&self, event: &Event<N>, watched: &Watched, to: Point) -> Result<f64, StepError> {
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
        let along = |x: f64| Ok::<_, Infallible>(event.at(&self.along(x)));
        let guess = if is_before(before) {
            let Ok([guess, _]) = narrowed(along, [before, after], None, 0.0);
            Some(guess.x)
        } else {
            None
        };
        let resolution = resolution(self.step.t, self.run.node().step_length());
        let [from, to] = narrowed(|x| self.point(event, x).map(|point| point.y), [from, to], guess, resolution)?;
        if to.y == 0.0 {
            return Ok(to.x);
        }
        let side = self.at(from.x, |node| node.side(event))?;
        Ok(if side.is_positive == watched.is_positive { to.x } else { from.x })
    }
}

/// Whether the parabola through three neighbours of one sign has an extremum between them that is half as near to zero as they are.
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

/// The extremum between three neighbours, or a point of the other sign: by golden sections.
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
