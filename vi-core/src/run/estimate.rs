//! Measurement errors of steps.
//!
//! For each coordinate this module measures the error of q and of h·v in one step. An [`ErrorMonitor`] reports the
//! largest relative error along the run and its time. A step is a pure function, so comparison with two steps of half
//! the length from the same node measures its error. With p the order of the method,
//!
//! ```text
//! error = |one step − two half steps| · 2^p/(2^p − 1)
//! ```
//!
//! The error of a coordinate is relative to its own excursion: the largest `|q_i − q_i(start)|` and `|h v_i|` so far.
//! It has no unit, and neither a large coordinate nor the choice of an origin hides the error of a small one. A
//! coordinate counts if it moves by more than [`VISIBLE`] ulps of its own value, and if its `|p_i v_i|` exceeds `(4096
//! ε)²` of the largest one. Smaller excursions are rounding errors that the other coordinates cause.
//!
//! The first stretch ends when every counted coordinate with a turning point has covered four times its excursion, or
//! after [`STRETCH`] steps. Until then excursions grow, so the largest error is relative to the excursions at the time
//! of the query. Later measurements are final.
//!
//! A monitor first measures every step. Then it divides the run into windows of an eighth of the steps so far, at most
//! [`WINDOW`] steps. In each window it measures the step with the largest indicator `h |Δ(Δp_i/h)|/|p_i − p_i(start)|`,
//! the change of the mean force. This finds peaks that are shorter than a window. One measurement costs about two
//! steps (eight in transformed time). A run of 5000 steps measures 3 % of them, a long run 1.1 %. The indicator costs
//! about 60 instructions a step for one coordinate, 90 for two. A run without a monitor has no extra cost.

use super::Run;
#[cfg(feature = "alloc")]
use super::events::{Crossing, Crossings, Events};
use crate::angles::{self, Turns};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::State;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// A coordinate counts if it moves by more ulps than this.
const VISIBLE: f64 = 64.0;
/// A coordinate counts if the root of its `|p_i v_i|`, relative to the others, exceeds this many `ε`.
const FAINT: f64 = 4096.0;
/// The longest window between two measurements, in steps: about 1 % of their time.
const WINDOW: u64 = 200;
/// Most steps of the first stretch.
const STRETCH: u64 = 4096;
/// Steps after which errors are judged by the excursions so far, even if no coordinate has turned back.
const JUDGED: u64 = 64;
/// A coordinate that covers more than this part of its excursion has turned back.
const TURNED: f64 = 1.001;
/// Excursions per coordinate in the first stretch: two full oscillations from a turning point.
const COVERED: f64 = 4.0;

/// The error of one step, for each coordinate. Infinite if its half steps have no solution, because the step is too
/// long to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalError<const N: usize> {
    /// Error of the coordinates.
    pub q: SVector<f64, N>,
    /// Error of the velocities times the length of the step.
    pub hv: SVector<f64, N>,
}

/// Result of a measurement.
struct Measurement<const N: usize> {
    /// The larger error of q and h·v.
    error: SVector<f64, N>,
    of: LocalError<N>,
    /// `|h v|` and `|p v|` at the end of the step.
    displacement: SVector<f64, N>,
    action: SVector<f64, N>,
}

impl<const N: usize> Measurement<N> {
    fn unknown() -> Self {
        let infinite = SVector::repeat(f64::INFINITY);
        let of = LocalError { q: infinite, hv: infinite };
        Self { error: infinite, of, displacement: SVector::zeros(), action: SVector::zeros() }
    }
}

/// Measures the step between two nodes. The half steps start from guesses by `memory`.
#[inline(never)]
fn measured<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    run: &Run<M, S, N, T>,
    memory: &M::Memory,
    [before, after]: [&Node<N, T>; 2],
) -> Measurement<N> {
    let fresh = || {
        // Stages of a long step can give a guess from which the iteration of a half step diverges.
        let mut node = *before;
        let memory = run.method.begin(&run.system, &mut node, run.h)?;
        compared(run, &memory, [before, after])
    };
    compared(run, memory, [before, after]).or_else(|_| fresh()).unwrap_or_else(|_| Measurement::unknown())
}

/// Compares the step with two half steps.
///
/// # Errors
/// The reason why a half step or a velocity has no solution.
fn compared<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    run: &Run<M, S, N, T>,
    memory: &M::Memory,
    [before, after]: [&Node<N, T>; 2],
) -> Result<Measurement<N>, StepError> {
    let Run { method, system, h: of_run, .. } = run;
    let h = duration(before, after);
    let half = h * T::real(0.5);
    let (middle, memory) = method.step_of(system, (before, memory), [half, *of_run])?;
    let (end, _) = method.step_of(system, (&middle, &memory), [duration(&middle, after), *of_run])?;
    let v = after.state().velocity(system)?;
    let better = end.state().velocity(system)?;
    let halved = 2.0_f64.powi(i32::try_from(method.order()).unwrap_or(i32::MAX));
    let factor = halved / (halved - 1.0);
    let length = h.to_f64();
    // The low parts carry the digits beyond the precision of a number.
    let q = (after.q - end.q) + (after.q_low - end.q_low);
    let q = q.map(|entry| known(factor * entry.to_f64()));
    let hv = (v - better).map(|entry| known(factor * length * entry.to_f64()));
    let displacement = v.map(|entry| (length * entry.to_f64()).abs());
    let action = v.zip_map(&after.p, |v, p| (v.to_f64() * p.to_f64()).abs());
    let error = q.zip_map(&hv, f64::max);
    Ok(Measurement { error, of: LocalError { q, hv }, displacement, action })
}

/// The size of an error; infinite for NaN.
fn known(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error.abs() }
}

/// Time from one node to another.
fn duration<const N: usize, T: Scalar>(before: &Node<N, T>, after: &Node<N, T>) -> T {
    (after.t - before.t) + (after.t_low - before.t_low)
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Run<M, S, N, T> {
    /// The error of the next step, for each coordinate in its own unit. The run does not change.
    ///
    /// # Errors
    /// That of the next step. If only its half steps fail, its error is infinite.
    pub fn local_error(&self) -> Result<LocalError<N>, StepError> {
        let mut ahead = self.clone();
        ahead.single_step()?;
        let before = angles::reduced_node::<S, N, T>(&self.node);
        Ok(measured(self, &self.memory, [&before, &ahead.node]).of)
    }

    /// Adds an error monitor, which changes no bit of the steps. See the [module](crate::run::ErrorMonitor).
    pub fn monitored(self) -> Monitored<M, S, N, T> {
        Monitored { monitor: ErrorMonitor::new(&self), run: self, limit: f64::INFINITY }
    }
}

/// A candidate for a measurement.
#[derive(Clone, Debug)]
struct Candidate<M, const N: usize, T> {
    before: Node<N, T>,
    after: Node<N, T>,
    memory: M,
    indicator: T,
}

/// The largest relative error of a step, and the time at which that step began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Error of q and h·v in one step, relative to the excursion of the coordinate: the largest entry. Infinite if the
    /// half steps of a step have no solution.
    pub estimate: f64,
    /// Time at which the step began.
    pub t: f64,
    /// Index of the coordinate.
    pub coordinate: usize,
}

impl ErrorEstimate {
    fn or_larger(self, other: Self) -> Self {
        if other.estimate > self.estimate { other } else { self }
    }
}

/// Monitors the steps of a run, and keeps the largest relative error. See [`Run::monitored`] and `docs/choosing.md`.
///
/// Errors are relative to the largest `|q_i − q_i(start)|` and `|h v_i|` of the coordinate so far. The monitor
/// measures, by half steps, those steps in which the momentum increments change most: the first sixteen, then ever
/// fewer, down to one of 200.
#[derive(Clone, Debug)]
pub struct ErrorMonitor<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    start: State<N, T>,
    last: Node<N, T>,
    /// The turns that the angles of `start` and `last` are without.
    turns: Turns<N>,
    /// Increment of the momenta in the last step, divided by its length.
    force: SVector<T, N>,
    /// Inverse of the largest `|p_i − p_i(start)|`, of counted coordinates.
    weights: SVector<T, N>,
    excursion: SVector<T, N>,
    /// Largest `|p_i − p_i(start)|`.
    momentum: SVector<T, N>,
    candidate: Option<Candidate<M::Memory, N, T>>,
    pub(super) steps: u64,
    /// Step number at which the window ends.
    due: u64,
    stretch: Option<Stretch<N, T>>,
    /// Largest `|p_i v_i|` and `|h v_i|` of the measured steps.
    action: SVector<f64, N>,
    displacement: SVector<f64, N>,
    largest: ErrorEstimate,
    measurements: u64,
}

/// The first stretch of a run.
#[derive(Clone, Debug)]
struct Stretch<const N: usize, T> {
    /// Path length of each coordinate.
    way: SVector<T, N>,
    /// The largest error of each coordinate, in its unit, and the time of that step.
    errors: SVector<f64, N>,
    times: SVector<f64, N>,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> ErrorMonitor<M, S, N, T> {
    /// A monitor that starts at the current node of a run.
    pub fn new(run: &Run<M, S, N, T>) -> Self {
        let (node, zeros, none) = (run.node, SVector::zeros(), SVector::zeros());
        Self {
            start: node.state(),
            last: node,
            turns: run.turns,
            force: zeros,
            weights: zeros,
            excursion: zeros,
            momentum: zeros,
            candidate: None,
            steps: 0,
            due: 1,
            stretch: Some(Stretch { way: zeros, errors: none, times: none }),
            action: none,
            displacement: none,
            largest: ErrorEstimate { estimate: 0.0, t: node.t.to_f64(), coordinate: 0 },
            measurements: 0,
        }
    }

    /// Records the step that the run has just taken.
    #[inline]
    pub fn watch(&mut self, run: &Run<M, S, N, T>) {
        let node = &run.node;
        let h = duration(&self.last, node);
        if h == T::zero() {
            return;
        }
        let rate = T::one() / h;
        let mut indicator = T::zero();
        self.turn(run);
        for i in 0..N {
            let excursion = (node.q[i] - self.start.q[i]).abs();
            self.excursion[i] = larger(self.excursion[i], excursion);
            self.momentum[i] = larger(self.momentum[i], (node.p[i] - self.start.p[i]).abs());
            let force = (node.p[i] - self.last.p[i]) * rate;
            let change = (force - self.force[i]) * self.weights[i];
            let size = force * self.weights[i];
            self.force[i] = force;
            // An impulse changes the force in its own step and in the next one equally: a quarter more decides for its
            // own step.
            let (change, size) = (change * change, size * size);
            indicator += change + T::real(0.25) * if size < change { size } else { change };
        }
        // A shortened step has small increments. The steps of a damped motion grow: their errors increase while its momenta
        // decay.
        indicator *= if M::FINDS_LENGTH { h * h * h * h * h * h } else { h * h };
        if let Some(stretch) = &mut self.stretch {
            stretch.way += (node.q - self.last.q).map(T::abs);
        }
        self.steps += 1;
        if self.candidate.as_ref().is_none_or(|candidate| indicator >= candidate.indicator) {
            self.nominate(run, indicator);
        }
        self.last = *node;
        if self.steps >= self.due {
            self.close(run);
        }
    }

    /// Takes the turns of a run for the start of its step, and for the start of the run.
    #[inline]
    fn turn(&mut self, run: &Run<M, S, N, T>) {
        if const { angles::has_angles::<S, N, T>() } && self.turns != run.turns {
            self.last = angles::reduced_node::<S, N, T>(&self.last);
            self.start = angles::without_turns(&self.start, &(run.turns - self.turns));
            self.turns = run.turns;
        }
    }

    /// Skips a jump of the state: the next step begins at the current node of the run.
    pub fn resume(&mut self, run: &Run<M, S, N, T>) {
        self.close(run);
        // A jump is no excursion.
        self.start.q += run.node.q - self.last.q;
        self.start.p += run.node.p - self.last.p;
        (self.last, self.turns) = (run.node, run.turns);
        self.force = SVector::zeros();
    }

    /// The largest relative error of a step so far, and its time. Also measures the candidate of the open window, so
    /// that short runs have a result.
    pub fn largest(&self, run: &Run<M, S, N, T>) -> ErrorEstimate {
        if self.candidate.is_none() {
            return self.found();
        }
        let mut closed = self.clone();
        closed.close(run);
        closed.found()
    }

    /// Number of measured steps.
    pub fn measurements(&self) -> u64 {
        self.measurements
    }

    /// The error of the next step of the run, relative to the excursions so far.
    ///
    /// # Errors
    /// Those of the step.
    pub fn error_estimate(&self, run: &Run<M, S, N, T>) -> Result<f64, StepError> {
        let mut ahead = run.clone();
        ahead.single_step()?;
        let mut monitor = self.clone();
        // The excursions include this step.
        monitor.watch(&ahead);
        let before = angles::reduced_node::<S, N, T>(&run.node);
        let found = measured(run, &run.memory, [&before, &ahead.node]);
        monitor.add(&found);
        Ok(monitor.relative(&found.error, &SVector::zeros()).estimate)
    }

    /// Whether the first stretch is over.
    pub(super) fn is_over(&self) -> bool {
        self.stretch.is_none()
    }

    /// Whether excursions are large enough to judge errors: a coordinate has turned back, or the run has taken [`JUDGED`] steps.
    fn judges(&self) -> bool {
        let Some(stretch) = &self.stretch else { return true };
        let has_turned = |i: usize| stretch.way[i].to_f64() > TURNED * self.excursion[i].to_f64();
        self.steps >= JUDGED || (0..N).any(|i| self.counts(i) && has_turned(i))
    }

    /// # Errors
    /// [`StepError::Tolerance`] if the largest error exceeds the limit.
    #[inline]
    fn check(&self, limit: f64) -> Result<(), StepError> {
        // Errors of the first steps are relative to excursions that still grow.
        if self.largest.estimate <= limit || !self.judges() {
            return Ok(());
        }
        let ErrorEstimate { estimate, t, .. } = self.largest;
        Err(StepError::Tolerance { t, estimate, tolerance: limit })
    }

    #[inline(never)]
    fn nominate(&mut self, run: &Run<M, S, N, T>, indicator: T) {
        let (before, after, memory) = (self.last, run.node, run.memory.clone());
        self.candidate = Some(Candidate { before, after, memory, indicator });
    }

    /// Measures the step with the largest indicator, and begins the next window.
    #[cold]
    #[inline(never)]
    fn close(&mut self, run: &Run<M, S, N, T>) {
        self.due = self.steps + (self.steps / 8).clamp(1, WINDOW);
        let Some(Candidate { before, after, memory, .. }) = self.candidate.take() else { return };
        if !duration(&before, &after).to_f64().is_normal() {
            return;
        }
        let found = measured(run, &memory, [&before, &after]);
        self.measurements += 1;
        self.add(&found);
        let t = before.t.to_f64();
        if let Some(stretch) = &mut self.stretch {
            for i in 0..N {
                if found.error[i] > stretch.errors[i] {
                    (stretch.errors[i], stretch.times[i]) = (found.error[i], t);
                }
            }
            self.largest = self.found();
            if self.steps >= STRETCH || self.has_turned() {
                self.stretch = None;
            }
        } else {
            self.largest = self.largest.or_larger(self.relative(&found.error, &SVector::repeat(t)));
        }
        for i in 0..N {
            let size = self.momentum[i];
            let weight = T::one() / size;
            self.weights[i] = if self.counts(i) && weight.is_finite() { weight } else { T::zero() };
        }
    }

    fn add(&mut self, found: &Measurement<N>) {
        self.action = self.action.zip_map(&found.action, f64::max);
        self.displacement = self.displacement.zip_map(&found.displacement, f64::max);
    }

    /// Whether every counted coordinate has turned back and covered its excursion several times, or has never turned.
    fn has_turned(&self) -> bool {
        let Some(stretch) = &self.stretch else { return true };
        let mut has_turned = false;
        for i in (0..N).filter(|i| self.counts(*i)) {
            let covered = stretch.way[i].to_f64() / self.excursion[i].to_f64();
            if covered >= COVERED {
                has_turned = true;
            } else if covered > TURNED {
                return false;
            }
        }
        has_turned
    }

    /// Whether a coordinate moves visibly.
    fn counts(&self, i: usize) -> bool {
        let size = larger(self.start.q[i].abs(), self.last.q[i].abs()).to_f64();
        let faint = FAINT * T::EPSILON;
        self.excursion(i) > VISIBLE * T::EPSILON * size && self.action[i] >= faint * faint * self.action.max()
    }

    fn excursion(&self, i: usize) -> f64 {
        self.excursion[i].to_f64().max(self.displacement[i])
    }

    /// The largest relative error so far.
    fn found(&self) -> ErrorEstimate {
        match &self.stretch {
            Some(stretch) => self.relative(&stretch.errors, &stretch.times),
            None => self.largest,
        }
    }

    /// The largest error over all coordinates, relative to their excursions.
    fn relative(&self, errors: &SVector<f64, N>, times: &SVector<f64, N>) -> ErrorEstimate {
        let mut largest = ErrorEstimate { estimate: 0.0, t: self.last.t.to_f64(), coordinate: 0 };
        for i in 0..N {
            let error = errors[i];
            let estimate = match error {
                0.0 => 0.0,
                _ if error.is_infinite() => f64::INFINITY,
                _ if self.counts(i) => error / self.excursion(i),
                _ => 0.0,
            };
            largest = largest.or_larger(ErrorEstimate { estimate, t: times[i], coordinate: i });
        }
        largest
    }
}

/// The larger number, by one comparison.
#[inline(always)]
fn larger<T: Scalar>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// A run with an error monitor: [`Run::monitored`].
#[derive(Clone, Debug)]
pub struct Monitored<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    run: Run<M, S, N, T>,
    monitor: ErrorMonitor<M, S, N, T>,
    limit: f64,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Monitored<M, S, N, T> {
    /// Ends the run with [`StepError::Tolerance`] if a measured error exceeds `limit`, for example ten times the
    /// tolerance. The first steps are not judged, because excursions are still small: until a coordinate has turned
    /// back, or for 64 steps.
    #[must_use]
    pub fn with_limit(self, limit: f64) -> Self {
        Self { limit, ..self }
    }

    /// Takes one step and returns its end state.
    ///
    /// # Errors
    /// As [`Run::step`]. [`StepError::Tolerance`] if a measured error exceeds the limit: the last state stays, and a
    /// further call returns the same error.
    #[inline]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        self.check()?;
        self.run.step()?;
        self.monitor.watch(&self.run);
        self.check()?;
        Ok(self.run.state())
    }

    /// Checks the limit.
    ///
    /// # Errors
    /// [`StepError::Tolerance`] beyond the limit.
    #[inline]
    fn check(&self) -> Result<(), StepError> {
        self.monitor.check(self.limit)
    }

    /// The largest relative error of a step so far, and its time.
    pub fn largest(&self) -> ErrorEstimate {
        self.monitor.largest(&self.run)
    }

    /// The error of the next step, relative to the excursions so far.
    ///
    /// # Errors
    /// Those of the step.
    pub fn error_estimate(&self) -> Result<f64, StepError> {
        self.monitor.error_estimate(&self.run)
    }

    /// Number of measured steps.
    pub fn measurements(&self) -> u64 {
        self.monitor.measurements()
    }

    /// The run. A monitored run has its functions that change nothing, too: `state`, `energy`, `t`, `system`, `checkpoint`.
    pub fn run(&self) -> &Run<M, S, N, T> {
        &self.run
    }

    /// Changes the run: `monitored.change(|run| run.set_state(state))`. A jump of its state is no excursion, and steps
    /// that it takes meanwhile are not measured.
    pub fn change<R>(&mut self, change: impl FnOnce(&mut Run<M, S, N, T>) -> R) -> R {
        // Open measurements belong to the system before the change.
        self.monitor.close(&self.run);
        let outcome = change(&mut self.run);
        self.monitor.resume(&self.run);
        outcome
    }

    /// The run without its monitor.
    pub fn into_run(self) -> Run<M, S, N, T> {
        self.run
    }
}

impl<M: Method<S, N, T>, S, const N: usize, T: Scalar> core::ops::Deref for Monitored<M, S, N, T> {
    type Target = Run<M, S, N, T>;

    fn deref(&self) -> &Run<M, S, N, T> {
        &self.run
    }
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Monitored<M, S, N> {
    /// Takes steps up to the time t, as [`Run::until`] does.
    ///
    /// # Errors
    /// As [`Run::until`] and [`Monitored::step`].
    pub fn until(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.run.check_ahead(t)?;
        loop {
            self.check()?;
            let is_there = self.run.approach(t)?;
            self.monitor.watch(&self.run);
            if is_there {
                if self.limit.is_finite() {
                    // Else a peak shortly before the end would stay in its window.
                    self.monitor.close(&self.run);
                }
                self.check()?;
                return Ok(self.run.state());
            }
        }
    }

    /// Takes steps to the first event, or to the time `until` if there is none before, as [`Run::next_event`] does.
    ///
    /// # Errors
    /// As [`Run::next_event`] and [`Monitored::step`].
    #[cfg(feature = "alloc")]
    pub fn next_event(&mut self, events: impl Events<N>, until: f64) -> Result<Option<Crossing<N>>, StepError> {
        self.check()?;
        let Self { run, monitor, limit } = self;
        let watch = |run: &Run<M, S, N>| {
            monitor.watch(run);
            monitor.check(*limit)
        };
        Crossings::new(run, events, until, watch).stop()
    }
}
