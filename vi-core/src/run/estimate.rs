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
//! The error of a coordinate is relative to a scale of its motion, the shorter one of
//!
//! ```text
//! excursion = largest |q_i − q_i(start)| and |h v_i| so far
//! reach     = range of the force F_i / largest |∂F_i/∂q_i|, at least a quarter of the largest change of h v_i
//! ```
//!
//! An error as large as the reach changes the force by as much as it changes along the run. The reach does not depend
//! on origin and frame, and that of a rotor is one turn. A step cannot resolve less than the change of h v. The
//! relative error has no unit, so a large coordinate does not hide the error of a small one. A coordinate counts if it
//! moves by more than [`VISIBLE`] ulps of its own value, and if its `|p_i v_i|` exceeds `(4096 ε)²` of the largest one.
//! Smaller excursions are rounding errors that the other coordinates cause.
//!
//! Three further measurements only add to this. A step that changes a conserved H by more than [`GROSS`] of the energy has
//! at least that error. A half step whose dense output does not begin with the velocity of its node misses the motion.
//! At the end of each window a conserved H is compared with H at the start, relative to the energies between
//! ([`EnergyPath`]): in a near collision or an escape, a small part of the large energies may be all the energy of the
//! orbit.
//!
//! The first stretch ends when every counted coordinate with a turning point has covered four times its excursion, or,
//! if none turns back, its force four times its range, or after [`STRETCH`] steps. Until then the scales grow, so the
//! largest error is relative to the scales at the time of the query. Later measurements are final.
//!
//! A monitor measures the first step, and those after a jump. Then it divides the run into windows of an eighth of the
//! steps so far, at most [`WINDOW`] steps. The indicator of a step is the change of the mean force of a coordinate,
//! relative to the largest change before the window: `h² |Δ(Δp_i/h)|`. A step whose indicator exceeds [`SUSPICIOUS`] is
//! measured at once, and of each window the step with the largest one. So no peak of a force passes unmeasured, and
//! the number of measurements grows by the logarithm of the largest change. On plunging Kepler orbits, walls and rotors
//! this indicator alone found every step that loses the motion, so there is none for the stages of a method. One
//! measurement costs about two steps (eight in transformed time). A run of 5000 steps measures 3 % of them, a long run
//! 1.1 %. The indicator costs about 60 instructions a step for one coordinate, 90 for two. A run without a monitor has
//! no extra cost.

#[cfg(feature = "alloc")]
use super::event::{Crossing, Events};
#[cfg(feature = "alloc")]
use super::events::Crossings;
use super::{DenseOutput as _, Run};
use crate::angles::{self, Turns};
use crate::error::StepError;
use crate::lagrangian::{Flow, Lagrangian};
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
/// A motion counts as rest if not even relative errors of this size would be visible.
const COARSEST: f64 = 1e-6;
/// The longest window between two measurements, in steps: about 1 % of their time.
const WINDOW: u64 = 200;
/// Relative energy error from which on it counts as an error of the step. Smaller ones may be rounding of a large
/// constant in H.
const GROSS: f64 = 1e-3;
/// Relative change of H since the start from which on the motion counts as lost. The energy errors of steps that resolve a
/// motion oscillate below it.
const DRIFTED: f64 = 0.01;
/// Change of H in an escape from which on the motion counts as lost, relative to H and to the geometric mean of `Σ |p
/// v|`.
const BROKEN: f64 = 0.03;
/// Ratio of `Σ |p v|` to its mean above which the motion has only become faster so far.
const RISEN: f64 = 2.0;
/// Ratio of `Σ |p v|` to its largest value before its present rise above which the motion is an escape.
const ESCAPED: f64 = 100.0;
/// A step is measured at once if its indicator exceeds the largest one before its window by this factor.
const SUSPICIOUS: f64 = 1.25;
/// Lower bound of the scale of an error, in units of the largest change of `h v`.
const DEFLECTION: f64 = 0.25;
/// Part of the displacement of a step by which the force is probed.
const PROBE: f64 = 1e-4;
/// Most steps of the first stretch.
const STRETCH: u64 = 4096;
/// Steps after which errors are judged by the excursions so far, even if no coordinate has turned back.
const JUDGED: u64 = 64;
/// A coordinate that covers more than this part of its excursion has turned back.
const TURNED: f64 = 1.001;
/// Path length of a coordinate in the first stretch, in excursions: two full oscillations from a turning point.
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
    /// `h v` and `|p v|` at the end of the step.
    hv: SVector<f64, N>,
    action: SVector<f64, N>,
    /// `|∂(L_q + f)_i/∂q_i|` at the end of the step.
    stiffness: SVector<f64, N>,
    /// `|H1 − H0|` of a system that conserves H, relative to the energy, if it exceeds [`GROSS`]; else zero.
    energy: f64,
}

impl<const N: usize> Measurement<N> {
    fn unknown() -> Self {
        let infinite = SVector::repeat(f64::INFINITY);
        let of = LocalError { q: infinite, hv: infinite };
        let zeros = SVector::zeros();
        Self { error: infinite, of, hv: zeros, action: zeros, stiffness: zeros, energy: 0.0 }
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
    let start = (before.state(), before.state().velocity(system)?);
    let unresolved = unresolved(run, &start, (&middle, &memory, half))?;
    let (end, _) = method.step_of(system, (&middle, &memory), [duration(&middle, after), *of_run])?;
    let v = after.state().velocity(system)?;
    let better = end.state().velocity(system)?;
    let halved = 2.0_f64.powi(i32::try_from(method.facts().order).unwrap_or(i32::MAX));
    let factor = halved / (halved - 1.0);
    let length = h.to_f64();
    // The low parts carry the digits beyond the precision of a number.
    let q = (after.q - end.q) + (after.q_low - end.q_low);
    let q = q.map(|entry| known(factor * entry.to_f64()));
    let error_of_hv = (v - better).map(|entry| known(factor * length * entry.to_f64()));
    let hv = v.map(|entry| length * entry.to_f64());
    let action = v.zip_map(&after.p, |v, p| (v.to_f64() * p.to_f64()).abs());
    let stiffness = stiffness(system, after, &hv);
    let energy = energy_error(method, system, [start, (after.state(), v)], action.sum());
    let error = q.zip_map(&error_of_hv, f64::max).zip_map(&unresolved, f64::max);
    Ok(Measurement { error, of: LocalError { q, hv: error_of_hv }, hv, action, stiffness, energy })
}

/// For each coordinate, `h |u'(t0) − v0|` of the half step with the dense output u, if that exceeds half of the
/// displacement; zero otherwise.
///
/// If a step is too stiff by orders of magnitude, its stages and those of its halves miss the motion. With an even
/// number of stages both then return the state from which they started, so that their difference hides the error.
fn unresolved<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    run: &Run<M, S, N, T>,
    (before, v): &(State<N, T>, SVector<T, N>),
    (middle, memory, half): (&Node<N, T>, &M::Memory, T),
) -> Result<SVector<f64, N>, StepError> {
    let Run { method, system, .. } = run;
    let output = method.dense_output(system, before, middle, half, memory)?;
    let after = middle.state().velocity(system)?;
    let missed = output.velocity(before.t) - v;
    Ok(SVector::from_fn(|i, _| {
        let [missed, before, after] = [missed[i], v[i], after[i]].map(|speed| (half * speed).to_f64().abs());
        if missed > 0.5 * before.max(after) { 2.0 * missed } else { 0.0 }
    }))
}

/// `|H1 − H0|` of a step, relative to the larger of |H| and `Σ |p v|`, if that exceeds [`GROSS`]. Zero if H changes along
/// the motion.
///
/// A step and its halves that do not evaluate the force inside a wall end at the place of the motion without the wall:
/// only the energy shows the error.
fn energy_error<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    method: &M,
    system: &S,
    ends: [(State<N, T>, SVector<T, N>); 2],
    action: f64,
) -> f64 {
    if !system.conserves_energy() || method.facts().has_reactions {
        return 0.0;
    }
    let [before, after] = ends.map(|(State { t, q, .. }, v)| system.energy(t, &q, &v).to_f64());
    // An energy may be infinite although the forces are not.
    if !(before.is_finite() && after.is_finite()) {
        return 0.0;
    }
    let error = known(after - before) / before.abs().max(after.abs()).max(action);
    if error > GROSS { error } else { 0.0 }
}

/// A conserved H along a run, and the energies that it is compared with.
#[derive(Clone, Copy, Debug)]
struct EnergyPath {
    /// H at the start.
    start: f64,
    /// Start, and end of the last window.
    from: f64,
    until: f64,
    /// `Σ |p v|` there.
    action: f64,
    /// The time integral of `Σ |p v|`, by the smaller value of each window: a near collision counts for its own time only.
    integral: f64,
    /// The time integral of the logarithm of `Σ |p v|`, and the time without rest, in which the logarithm exists.
    logarithms: f64,
    moving: f64,
    /// The largest `Σ |p v|` so far, and the largest one before its present rise.
    largest: f64,
    before: f64,
    /// Whether `Σ |p v|` has a mean: it does not only rise.
    has_mean: bool,
}

impl EnergyPath {
    /// The path from the current node of a run. `None` if H changes along the motion, or has no value.
    fn from<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
        run: &Run<M, S, N, T>,
    ) -> Option<Self> {
        let Energies { energy, action, .. } = Energies::at(run)?;
        let t = run.node.t.to_f64();
        Some(Self {
            start: energy,
            from: t,
            until: t,
            action,
            integral: 0.0,
            logarithms: 0.0,
            moving: 0.0,
            largest: action,
            before: action,
            has_mean: false,
        })
    }

    /// `|H − H(start)|` at the current node of a run, in two units:
    ///
    /// * relative to `Σ |p v|`: its mean so far, or its present value if that is larger; zero up to [`DRIFTED`];
    /// * in an escape, in which `Σ |p v|` is [`ESCAPED`] times its largest value before the present rise: relative to
    ///   the geometric mean of `Σ |p v|`, or to `|H(start)|` if that is larger; zero up to [`BROKEN`]. It holds for the
    ///   present state only: after a near collision the energy returns.
    ///
    /// Both are zero for rounding, and in the first rise of `Σ |p v|`, as in a fall from rest: it has no mean yet.
    fn drift<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
        &mut self,
        run: &Run<M, S, N, T>,
    ) -> [f64; 2] {
        let Some(Energies { energy, action, terms }) = Energies::at(run) else { return [0.0; 2] };
        let t = run.node.t.to_f64();
        let (least, duration) = (self.action.min(action), (t - self.until).abs());
        self.integral += least * duration;
        if least > 0.0 {
            self.logarithms += least.ln() * duration;
            self.moving += duration;
        }
        if action < self.action {
            self.before = self.largest;
        }
        self.largest = self.largest.max(action);
        (self.until, self.action) = (t, action);
        let mean = self.integral / (t - self.from).abs();
        self.has_mean |= action <= RISEN * mean;
        let size = if mean < action { action } else { mean };
        let change = (energy - self.start).abs();
        let is_visible = change > FAINT * T::EPSILON * (self.start.abs() + terms);
        if !(self.has_mean && is_visible) {
            return [0.0; 2];
        }
        let usual = (self.logarithms / self.moving).exp().max(self.start.abs());
        let part = |size: f64, from: f64| if change > from * size { change / size } else { 0.0 };
        let escapes = action > ESCAPED * self.before;
        [part(size, DRIFTED), if escapes { part(usual, BROKEN) } else { 0.0 }]
    }
}

/// Energies at a node: H, `Σ |p v|`, and the size of the terms whose rounding errors H has.
struct Energies {
    energy: f64,
    action: f64,
    terms: f64,
}

impl Energies {
    fn at<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
        Run { method, system, node, .. }: &Run<M, S, N, T>,
    ) -> Option<Self> {
        if !system.conserves_energy() || method.facts().has_reactions {
            return None;
        }
        let Flow { v, force, .. } = system.flow(node.t, &node.q, &node.p).ok()?;
        let energy = system.energy(node.t, &node.q, &v).to_f64();
        let sum = |a: &SVector<T, N>, b: &SVector<T, N>| (0..N).map(|i| (a[i] * b[i]).to_f64().abs()).sum::<f64>();
        let action = sum(&node.p, &v);
        let terms = energy.abs() + action + sum(&force, &node.q);
        terms.is_finite().then_some(Self { energy, action, terms })
    }
}

/// `|∂(L_q + f)_i/∂q_i|` of each coordinate at a node, by central differences over small parts of a displacement.
fn stiffness<S: Lagrangian<N, T>, const N: usize, T: Scalar>(
    system: &S,
    node: &Node<N, T>,
    displacement: &SVector<f64, N>,
) -> SVector<f64, N> {
    SVector::from_fn(|i, _| {
        let length = (PROBE * displacement[i].abs()).max(T::EPSILON.powf(2.0 / 3.0) * node.q[i].to_f64().abs());
        let force = |length: f64| {
            let mut q = node.q;
            q[i] += T::real(length);
            Some((system.flow(node.t, &q, &node.p).ok()?.force[i].to_f64(), q[i].to_f64()))
        };
        let (Some((above, right)), Some((below, left))) = (force(length), force(-length)) else { return 0.0 };
        let stiffness = ((above - below) / (right - left)).abs();
        if stiffness.is_finite() { stiffness } else { 0.0 }
    })
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
    /// The error of the next step. If only its half steps fail, its error is infinite.
    pub fn local_error(&self) -> Result<LocalError<N>, StepError> {
        let mut ahead = self.clone();
        ahead.single_step()?;
        let before = angles::reduced_node(&self.system, &self.node);
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
    /// Error of q and h·v in one step, relative to the scale of the motion of the coordinate: the largest entry. Infinite
    /// if the half steps of a step have no solution. If H has changed by more than a hundredth since the start although it
    /// is conserved, at least that part.
    pub estimate: f64,
    /// Time at which the step began.
    pub t: f64,
    /// Index of the coordinate.
    pub coordinate: usize,
    /// The errors of all steps so far, added up, in the same unit: the largest entry. Each step counts with the error
    /// of the measured one of its window, so that it is a bound rather than a mean. It is too large if errors cancel,
    /// as those of the energy of a symplectic method, and too small if neighbouring motions diverge.
    pub sum: f64,
}

impl ErrorEstimate {
    /// The estimate before the first measurement: zero, at t.
    fn none(t: f64) -> Self {
        Self { estimate: 0.0, t, coordinate: 0, sum: 0.0 }
    }

    fn or_larger(self, other: Self) -> Self {
        let larger = if other.estimate > self.estimate { other } else { self };
        Self { sum: self.sum.max(other.sum), ..larger }
    }
}

/// Monitors the steps of a run, and keeps the largest relative error. See [`Run::monitored`] and `docs/choosing.md`.
///
/// Errors are relative to the scale of the motion of a coordinate: the distance over which its force changes by its
/// range, or the largest `|q_i − q_i(start)|` and `|h v_i|` so far, if that is shorter. The monitor measures, by half
/// steps, every step whose momentum increments change more than before, and of the others the first sixteen, then ever
/// fewer, down to one of 200.
#[derive(Clone, Debug)]
pub struct ErrorMonitor<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    start: State<N, T>,
    last: Node<N, T>,
    /// The turns that are subtracted from the angles of `start` and `last`.
    turns: Turns<N>,
    /// Mean force of the last step: the increment of the momenta, divided by its length.
    force: SVector<T, N>,
    /// Mean force of the first step, and the largest difference to it.
    first_force: SVector<T, N>,
    range: SVector<T, N>,
    /// Whether the next step has no predecessor: the first one, and one after a jump.
    is_first: bool,
    excursion: SVector<T, N>,
    /// The largest indicator of each coordinate, and its inverse when the window began.
    peak: SVector<T, N>,
    weights: SVector<T, N>,
    /// The largest `|∂F_i/∂q_i|` of the measured steps.
    stiffness: SVector<f64, N>,
    candidate: Option<Candidate<M::Memory, N, T>>,
    pub(super) steps: u64,
    /// Step number at which the window ends.
    due: u64,
    stretch: Option<Stretch<N, T>>,
    /// Largest `|p_i v_i|` and `|h v_i|` of the measured steps.
    action: SVector<f64, N>,
    displacement: SVector<f64, N>,
    /// `h v` of the first measured step, and the largest difference to it.
    first_hv: Option<SVector<f64, N>>,
    deflection: SVector<f64, N>,
    largest: ErrorEstimate,
    /// The errors of all steps of closed windows, added up, and the number of those steps.
    sums: SVector<f64, N>,
    counted: u64,
    /// H along the run, and its largest error.
    energy: Option<EnergyPath>,
    of_energy: ErrorEstimate,
    /// The error of H at the end of the last window. It may pass.
    passing: ErrorEstimate,
    measurements: u64,
}

/// The first stretch of a run.
#[derive(Clone, Debug)]
struct Stretch<const N: usize, T> {
    /// Path lengths of each coordinate and of its mean force.
    way: SVector<T, N>,
    force_way: SVector<T, N>,
    /// The largest error of each coordinate, in its unit, and the time of that step.
    errors: SVector<f64, N>,
    times: SVector<f64, N>,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> ErrorMonitor<M, S, N, T> {
    /// A monitor that starts at the current node of a run.
    pub fn new(run: &Run<M, S, N, T>) -> Self {
        Self { energy: EnergyPath::from(run), ..Self::of_steps(run) }
    }

    /// A monitor of the errors of single steps only, which starts at the current node of a run.
    pub(super) fn of_steps(run: &Run<M, S, N, T>) -> Self {
        let nothing = ErrorEstimate::none(run.node.t.to_f64());
        let (node, zeros, none) = (run.node, SVector::zeros(), SVector::zeros());
        Self {
            start: node.state(),
            last: node,
            turns: run.turns,
            force: zeros,
            first_force: zeros,
            range: zeros,
            is_first: true,
            excursion: zeros,
            peak: zeros,
            weights: zeros,
            stiffness: none,
            candidate: None,
            steps: 0,
            due: 1,
            stretch: Some(Stretch { way: zeros, force_way: zeros, errors: none, times: none }),
            action: none,
            displacement: none,
            first_hv: None,
            deflection: none,
            largest: nothing,
            sums: none,
            counted: 0,
            energy: None,
            of_energy: nothing,
            passing: nothing,
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
        self.turn(run);
        if self.is_first {
            self.take_first((node.p - self.last.p) * rate);
        }
        // The change of the mean force, as a displacement. The steps of a damped motion grow: their errors increase
        // while its momenta decay.
        let unit = if run.method.facts().finds_length { h * h * h * h } else { h * h };
        let mut indicator = T::zero();
        for i in 0..N {
            let excursion = (node.q[i] - self.start.q[i]).abs();
            self.excursion[i] = larger(self.excursion[i], excursion);
            let force = (node.p[i] - self.last.p[i]) * rate;
            self.range[i] = larger(self.range[i], (force - self.first_force[i]).abs());
            let change = (force - self.force[i]).abs();
            let size = force.abs();
            self.force[i] = force;
            // An impulse changes the force in its own step and in the next one equally: a quarter more decides for its
            // own step.
            let peak = (change + T::real(0.25) * if size < change { size } else { change }) * unit;
            self.peak[i] = larger(self.peak[i], peak);
            indicator = larger(indicator, peak * self.weights[i]);
            // In free flight, sums of roundings would look like the path of a force.
            if let Some(stretch) = &mut self.stretch
                && change > T::real(4.0 * T::EPSILON) * (node.p[i] * rate).abs()
            {
                stretch.force_way[i] += change;
            }
        }
        if let Some(stretch) = &mut self.stretch {
            stretch.way += (node.q - self.last.q).map(T::abs);
        }
        self.steps += 1;
        if self.candidate.as_ref().is_none_or(|candidate| indicator >= candidate.indicator) {
            self.nominate(run, indicator);
        }
        self.last = *node;
        if self.steps >= self.due || indicator > T::real(SUSPICIOUS) {
            self.close(run);
        }
    }

    /// Takes the mean force of a step without a predecessor, and measures that step.
    #[cold]
    #[inline(never)]
    fn take_first(&mut self, force: SVector<T, N>) {
        if self.steps == 0 {
            self.first_force = force;
        }
        (self.force, self.is_first, self.due) = (force, false, self.steps);
    }

    /// Takes the turns of a run for the start of its step, and for the start of the run.
    #[inline]
    fn turn(&mut self, run: &Run<M, S, N, T>) {
        if const { angles::has_angles::<S, N, T>() } && self.turns != run.turns {
            self.last = angles::reduced_node(&run.system, &self.last);
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
        self.is_first = true;
        self.energy = EnergyPath::from(run);
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

    /// The error of the next step of the run, relative to the scales so far.
    ///
    /// # Errors
    /// The errors of the step.
    pub fn error_estimate(&self, run: &Run<M, S, N, T>) -> Result<f64, StepError> {
        let mut ahead = run.clone();
        ahead.single_step()?;
        let mut monitor = self.clone();
        // The excursions include this step.
        monitor.watch(&ahead);
        let before = angles::reduced_node(&run.system, &run.node);
        let found = measured(run, &run.memory, [&before, &ahead.node]);
        monitor.add(&found);
        Ok(monitor.relative(&found.error, &SVector::zeros()).estimate.max(found.energy))
    }

    /// Whether some coordinate moves so far that errors of the size of a tolerance exceed rounding.
    pub(super) fn has_motion(&self, tolerance: f64) -> bool {
        (0..N).any(|i| {
            let size = larger(self.start.q[i].abs(), self.last.q[i].abs()).to_f64();
            self.counts(i) && self.excursion(i) * tolerance.max(COARSEST) > VISIBLE * T::EPSILON * size
        })
    }

    /// Whether the first stretch is over.
    pub(super) fn is_over(&self) -> bool {
        self.stretch.is_none()
    }

    /// Whether excursions are large enough to judge errors: a coordinate or its force has turned back, or the run has taken [`JUDGED`] steps.
    fn judges(&self) -> bool {
        let Some(stretch) = &self.stretch else { return true };
        let has_turned = |way: T, largest: T| way.to_f64() > TURNED * largest.to_f64();
        self.steps >= JUDGED
            || (0..N).filter(|i| self.counts(*i)).any(|i| {
                has_turned(stretch.way[i], self.excursion[i])
                    || self.has_force(i) && has_turned(stretch.force_way[i], self.range[i])
            })
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
        // Without a step the product of an infinite error has no value.
        if self.steps > self.counted {
            #[allow(clippy::cast_precision_loss)] // an estimate
            let steps = (self.steps - self.counted) as f64;
            self.sums += found.error * steps;
            self.counted = self.steps;
        }
        let t = before.t.to_f64();
        let coordinate = found.action.imax();
        let [lasting, passing] = self.energy.as_mut().map_or([0.0; 2], |energy| energy.drift(run));
        let of_energy = |estimate: f64| ErrorEstimate { estimate, t, coordinate, sum: 0.0 };
        self.of_energy = self.of_energy.or_larger(of_energy(found.energy.max(lasting)));
        self.passing = of_energy(passing);
        if let Some(stretch) = &mut self.stretch {
            for i in 0..N {
                if found.error[i] > stretch.errors[i] {
                    (stretch.errors[i], stretch.times[i]) = (found.error[i], t);
                }
            }
            self.largest = self.lasting();
            if self.steps >= STRETCH || self.has_turned() {
                self.stretch = None;
            }
        } else {
            let of_step = self.relative(&found.error, &SVector::repeat(t));
            self.largest = self.largest.or_larger(of_step).or_larger(self.of_energy);
        }
        self.weights = self.peak.map(|peak| T::one() / peak);
    }

    fn add(&mut self, found: &Measurement<N>) {
        self.action = self.action.zip_map(&found.action, f64::max);
        self.displacement = self.displacement.zip_map(&found.hv, |largest, hv| largest.max(hv.abs()));
        let first = *self.first_hv.get_or_insert(found.hv);
        self.deflection = self.deflection.zip_map(&(found.hv - first), |largest, hv| largest.max(hv.abs()));
        self.stiffness = self.stiffness.zip_map(&found.stiffness, f64::max);
    }

    /// Whether every counted coordinate has turned back and covered its excursion several times, or has never turned. If
    /// none has turned, the same of the mean forces: a rotor never turns back, but its force does.
    fn has_turned(&self) -> bool {
        let Some(stretch) = &self.stretch else { return true };
        let path = |i: usize| stretch.way[i].to_f64() / self.excursion[i].to_f64();
        let of_force = |i: usize| stretch.force_way[i].to_f64() / self.range[i].to_f64();
        let counted = || (0..N).filter(|i| self.counts(*i));
        if counted().any(|i| path(i) > TURNED) {
            counted().any(|i| path(i) >= COVERED) && counted().all(|i| path(i) >= COVERED || path(i) <= TURNED)
        } else {
            let forced = || counted().filter(|i| self.has_force(*i));
            forced().any(|i| of_force(i) >= COVERED)
                && forced().all(|i| of_force(i) >= COVERED || of_force(i) <= TURNED)
        }
    }

    /// Whether a coordinate moves visibly.
    fn counts(&self, i: usize) -> bool {
        let size = larger(self.start.q[i].abs(), self.last.q[i].abs()).to_f64();
        let faint = FAINT * T::EPSILON;
        self.excursion(i) > VISIBLE * T::EPSILON * size && self.action[i] >= faint * faint * self.action.max()
    }

    /// The scale of the errors of a coordinate: its excursion, or the distance over which its force changes by the
    /// range of the force, if that is shorter.
    fn scale(&self, i: usize) -> f64 {
        let excursion = self.excursion(i);
        let reach = (self.range[i].to_f64() / self.stiffness[i]).max(DEFLECTION * self.deflection[i]);
        if self.has_force(i) && reach < excursion { reach } else { excursion }
    }

    /// Whether the mean force of a coordinate changes visibly.
    fn has_force(&self, i: usize) -> bool {
        let change = self.range[i].to_f64() * self.displacement[i];
        change > VISIBLE * T::EPSILON * self.action[i]
    }

    fn excursion(&self, i: usize) -> f64 {
        self.excursion[i].to_f64().max(self.displacement[i])
    }

    /// The largest relative error so far.
    fn found(&self) -> ErrorEstimate {
        self.lasting().or_larger(self.passing)
    }

    /// The largest relative error so far, without an error of H that may pass.
    fn lasting(&self) -> ErrorEstimate {
        let found = match &self.stretch {
            Some(stretch) => self.relative(&stretch.errors, &stretch.times),
            None => self.largest,
        };
        let sum = self.relative(&self.sums, &SVector::zeros()).estimate;
        ErrorEstimate { sum, ..found.or_larger(self.of_energy) }
    }

    /// The largest error over all coordinates, relative to their excursions.
    fn relative(&self, errors: &SVector<f64, N>, times: &SVector<f64, N>) -> ErrorEstimate {
        let mut largest = ErrorEstimate::none(self.last.t.to_f64());
        for i in 0..N {
            let error = errors[i];
            let estimate = match error {
                0.0 => 0.0,
                _ if error.is_infinite() => f64::INFINITY,
                _ if self.counts(i) => error / self.scale(i),
                _ => 0.0,
            };
            largest = largest.or_larger(ErrorEstimate { estimate, t: times[i], coordinate: i, sum: 0.0 });
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

    /// The error of the next step, relative to the scales so far.
    ///
    /// # Errors
    /// The errors of the step.
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
        // Pending measurements need the system before the change.
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
                    // Otherwise a peak shortly before the end would stay unmeasured in its window.
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
