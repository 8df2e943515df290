//! One type-erased run of any system.
//!
//! In: a system with its parameters, a [`Plan`]. Out: a [`Simulation`], whose rows are the nodes of the integrator,
//! starting with its first node. Type erasure lets a name on the command line choose the system. The numbers are those
//! of the generic integrators, to the last bit, and [`Simulation::advance_until`] contains their loop without virtual
//! calls. Integrators that only user runs need take [`Called`] systems, which build in a third of the time and differ
//! by rounding.

use crate::counting::Counting;
use crate::kind::SystemKind;
use crate::plan::{DEFAULT_STAGES, Method, Plan, Shift, Start, StepLength};
use crate::start;
use core::cell::Cell;
use vi_core::collocation::Collocation;
use vi_core::run::{Crossing, ErrorEstimate, ErrorMonitor, Event, Length as _, Moment};
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_core::{
    Called, EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, InTransformedTime, Lagrangian, Run,
    SVector, Starts, State, StepError,
};

/// A node, its energies, and the length of the step that led to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Momenta.
    pub p: Vec<f64>,
    /// H, the energy at the node; `None` if the momenta have no velocity.
    pub energy: Option<f64>,
    /// E, the discrete energy of the interval that ends at the node; `None` before the first fixed step and for
    /// compositions, whose step is not an interval of one discrete Lagrangian.
    pub discrete_energy: Option<f64>,
    /// E', the energy conserved by steps with a shift; `None` for other methods, whose rows have no such column.
    pub shifted_energy: Option<f64>,
    /// Length of the step; in the first row the requested length.
    pub h: f64,
}

impl Row {
    /// The names of the columns for these coordinates, with or without a shift.
    #[must_use]
    pub fn columns(coordinates: &[&str], is_shifted: bool) -> Vec<String> {
        let q = coordinates.iter().map(|&name| name.to_owned());
        let p = coordinates.iter().map(|name| format!("p_{name}"));
        let last: &[&str] = if is_shifted { &["H", "E", "E'", "h"] } else { &["H", "E", "h"] };
        let last = last.iter().map(|&name| name.to_owned());
        ["t".to_owned()].into_iter().chain(q).chain(p).chain(last).collect()
    }

    /// The entries in the order of the columns.
    pub fn entries(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        let numbers = core::iter::once(&self.t).chain(&self.q).chain(&self.p).copied().map(Some);
        let energies = [self.energy, self.discrete_energy];
        numbers.chain(energies).chain(self.shifted_energy.map(Some)).chain([Some(self.h)])
    }
}

/// The direction in which a coordinate crosses a value, along the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Either.
    Both,
}

/// A surface that a motion crosses repeatedly: a Poincaré section.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// A coordinate crosses this value in this direction.
    Coordinate {
        /// Which coordinate.
        index: usize,
        /// Its value.
        at: f64,
        /// Rising, falling, or both.
        direction: Direction,
    },
    /// The time is `start` plus a whole number of periods.
    Period {
        /// Time of the first one.
        start: f64,
        /// From one to the next.
        period: f64,
    },
}

impl Section {
    /// A function of time and coordinates that changes sign at the section.
    fn value(&self, t: f64, q: &[f64]) -> f64 {
        match self {
            Self::Coordinate { index, at, .. } => q[*index] - at,
            Self::Period { start, period } => {
                let passed = (t - start) / period;
                // Within half a period of zero, so that late crossings are as accurate as early ones.
                let is_odd = if passed.round() % 2.0 == 0.0 { 1.0 } else { -1.0 };
                is_odd * (core::f64::consts::PI * (passed - passed.round())).sin()
            }
        }
    }

    /// The event that the function crosses zero in the direction of the section.
    fn event<const N: usize>(&self) -> Event<N> {
        let section = self.clone();
        let g = move |moment: &Moment<N>| section.value(moment.t, moment.q.as_slice());
        match self {
            Self::Coordinate { direction: Direction::Rising, .. } => Event::rising(g),
            Self::Coordinate { direction: Direction::Falling, .. } => Event::falling(g),
            Self::Coordinate { direction: Direction::Both, .. } | Self::Period { .. } => Event::crossing(g),
        }
    }
}

/// A started run.
pub trait Simulation {
    /// Time of the last node.
    fn t(&self) -> f64;
    /// Coordinates of the last node.
    fn q(&self) -> &[f64];
    /// Momenta of the last node.
    fn p(&self) -> &[f64];
    /// Length of the last step; before the first one the requested length.
    fn h(&self) -> f64;
    /// H, the energy at the last node, from its coordinates and momenta.
    ///
    /// # Errors
    /// The momenta have no velocity.
    fn energy(&self) -> Result<f64, StepError>;
    /// E, the discrete energy of the interval that ends at the last node; `None` without such an interval.
    fn discrete_energy(&self) -> Option<f64>;
    /// E', conserved by steps with a shift, and that shift; `None` for other methods.
    fn shifted_energy(&self) -> Option<ShiftedEnergy> {
        None
    }
    /// Takes one step.
    ///
    /// # Errors
    /// The error of the integrator.
    fn advance(&mut self) -> Result<(), StepError>;
    /// Takes one step toward the time `end`, which lies ahead. A step beyond it is shortened to end at `end` exactly,
    /// and has no discrete energy.
    ///
    /// # Errors
    /// The error of the integrator.
    fn advance_to(&mut self, end: f64) -> Result<(), StepError>;

    /// Advances to the time `end`, and passes each crossing of a section to `take`, in order. A crossing is located by
    /// a step of the exact length h, and has no discrete energy.
    ///
    /// # Errors
    /// The error of the failed step.
    fn cross(&mut self, section: &Section, end: f64, take: &mut dyn FnMut(Row)) -> Result<(), StepError>;

    /// Measures errors of the steps from here on. It costs a few per cent of their time and changes no bit of them.
    fn monitor(&mut self) {}
    /// The largest error of a step since [`Simulation::monitor`], relative to the excursion of its coordinate.
    fn largest_error(&self) -> Option<ErrorEstimate> {
        None
    }

    /// Time and H at which H is most accurate: at the node; for energy-preserving steps at the midpoint of the last
    /// one, since H deviates by h²D/8 at their nodes.
    ///
    /// # Errors
    /// As [`Simulation::energy`].
    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        Ok((self.t(), self.energy()?))
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// The error of the failed step.
    fn advance_by(&mut self, steps: u64) -> Result<(), StepError> {
        self.advance_until(f64::INFINITY, steps).map(drop)
    }

    /// Takes steps until a node at `end` or later, at most `most`; returns their number.
    ///
    /// # Errors
    /// The error of the failed step.
    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        let mut taken = 0;
        while taken < most && self.t() < end {
            self.advance()?;
            taken += 1;
        }
        Ok(taken)
    }
}

impl dyn Simulation + '_ {
    /// The last node with its energies.
    #[must_use]
    pub fn row(&self) -> Row {
        Row {
            t: self.t(),
            q: self.q().to_vec(),
            p: self.p().to_vec(),
            energy: self.energy().ok(),
            discrete_energy: self.discrete_energy(),
            shifted_energy: self.shifted_energy().map(|of| of.energy),
            h: self.h(),
        }
    }
}

/// The conserved quantity of steps with a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftedEnergy {
    /// `E' = E − C_s h^2s D_*`.
    pub energy: f64,
    /// D_*.
    pub shift: f64,
}

/// Starts a run of `system`. `evaluations` grows by the evaluations of its equations, which [`Counting`] counts. For
/// Gauss steps it grows by the iterations of each step times its stages, so that these steps need no second
/// instantiation.
///
/// # Errors
/// The error of the integrators for the initial state. [`StepError::InvalidInput`] for wrong numbers of coordinates or
/// velocities, and for stages that are not built in: 4 and 8 for Gauss steps, 1 to 3 for energy-preserving ones.
pub fn begin<'a, S, K: SystemKind<S, N>, const N: usize>(
    system: S,
    plan: &Plan,
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: Collocation<N> + Convertible<N> + 'a,
{
    let t = plan.t;
    let q = vector(&plan.q, "number of coordinates")?;
    let v = vector(&plan.v, "number of velocities")?;
    let state = State::at(&system, t, q, v);
    match plan.method {
        Method::Fixed | Method::Suzuki4 | Method::KahanLi6 | Method::KahanLi8 => {
            K::begin(system, plan, (q, v), evaluations)
        }
        Method::Gauss => match (plan.stages.unwrap_or(DEFAULT_STAGES), plan.dtau) {
            (4, None) => gauss::<S, N, 4>(system, state, plan.length(), evaluations),
            (8, None) => gauss::<S, N, 8>(system, state, plan.length(), evaluations),
            (4, Some(dtau)) => scaled::<S, N, 4>(system, state, dtau, evaluations),
            (8, Some(dtau)) => scaled::<S, N, 8>(system, state, dtau, evaluations),
            (other, _) => Err(wrong_stages("4 or 8", other)),
        },
        Method::Energy => match plan.energy_stages() {
            None => K::begin(system, plan, (q, v), evaluations),
            Some(1) => energy::<S, N, 1>(system, state, plan, evaluations),
            Some(2) => energy::<S, N, 2>(system, state, plan, evaluations),
            Some(3) => energy::<S, N, 3>(system, state, plan, evaluations),
            Some(other) => Err(wrong_stages("1, 2 or 3", other)),
        },
    }
}

/// Starts a run with the rule of a system.
///
/// # Errors
/// The error of the integrators for the initial state.
pub(crate) fn by_rule<'a, S, const N: usize>(
    system: S,
    plan: &Plan,
    (q, v): (SVector<f64, N>, SVector<f64, N>),
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: EnergyStepping<N> + 'a,
{
    let state = State::at(&system, plan.t, q, v);
    let counting = Counting::new(system, evaluations);
    match plan.method.scheme() {
        Some(scheme) => Ok(Simulated::boxed(counting.at_state(state).integrate(scheme, plan.length())?, evaluations)),
        None if plan.method == Method::Fixed => {
            Ok(Simulated::boxed(counting.at_state(state).integrate(FixedStep, plan.length())?, evaluations))
        }
        None => one_stage(system, plan, (q, v), evaluations),
    }
}

/// Starts a run of energy-preserving steps of one stage without a shift.
fn one_stage<'a, S, const N: usize>(
    system: S,
    plan: &Plan,
    (q, v): (SVector<f64, N>, SVector<f64, N>),
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: EnergyStepping<N> + 'a,
{
    let Plan { t, .. } = *plan;
    let counting = Counting::new(system, evaluations);
    let h = plan.length().length(&counting.at_state(State::at(&system, t, q, v)), &EnergyPreserving)?;
    let integrator = match plan.start {
        Start::Midpoint => EnergyPreserving::from_midpoint(counting, t, q, v, h)?,
        Start::Points => {
            let second = start::second_point(&system, t, q, v, h)?;
            EnergyPreserving::from_points(counting, (t, q), second)?
        }
    };
    let in_the_middle = |run: &Run<EnergyPreserving, Counting<'a, S>, N>| {
        let v = run.v();
        let (t, q) = run.node().midpoint(-run.h(), &v);
        Ok((t, run.system().energy(t, &q, &v)))
    };
    let run = Simulated::new(integrator.with_fallback(fallback(plan)), evaluations);
    Ok(Box::new(Simulated { sampled_energy: in_the_middle, ..run }))
}

/// The action if there is no energy-preserving step.
fn fallback(plan: &Plan) -> Fallback {
    if plan.fallback { Fallback::FixedSteps } else { Fallback::Stop }
}

/// The error for a number of stages that is not built in.
#[allow(clippy::cast_precision_loss)] // a count that a command line can hold
fn wrong_stages(allowed: &'static str, stages: usize) -> StepError {
    StepError::InvalidInput { input: "number of stages", allowed, value: stages as f64 }
}

/// Starts a run of energy-preserving Gauss steps.
fn energy<'a, S, const N: usize, const STAGES: usize>(
    system: S,
    state: State<N>,
    plan: &Plan,
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: Collocation<N> + Convertible<N> + 'a,
{
    let integrator = Called(system).at_state(state).integrate(EnergyPreservingGauss::<STAGES>, plan.length())?;
    let integrator = match plan.shift {
        None => integrator,
        Some(Shift::Of(shift)) => integrator.with_shift(shift)?,
        Some(Shift::Over(time)) => integrator.with_shift_from(time)?,
    };
    let run = Simulated::new(integrator.with_fallback(fallback(plan)), evaluations);
    let count = |run: &Run<EnergyPreservingGauss<STAGES>, Called<S>, N>| u64::from(run.iterations()) * STAGES as u64;
    let shifted = |run: &Run<EnergyPreservingGauss<STAGES>, Called<S>, N>| ShiftedEnergy {
        energy: run.shifted_energy(),
        shift: run.shift(),
    };
    let shifted = plan.shift.map(|_| shifted as fn(&_) -> _);
    Ok(Box::new(Simulated { uncounted: Some(count), shifted, ..run }))
}

/// Starts a run of Gauss steps in transformed time.
fn scaled<'a, S, const N: usize, const STAGES: usize>(
    system: S,
    state: State<N>,
    dtau: f64,
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: Collocation<N> + Convertible<N> + 'a,
{
    // Otherwise they would be built for every system.
    if !S::SCALES_TIME {
        return Err(StepError::NoTimeScale { system: S::NAME });
    }
    let run = Simulated::new(
        Called(system).at_state(state).integrate(Gauss::<STAGES>.in_transformed_time(), dtau)?,
        evaluations,
    );
    let count = |run: &Run<InTransformedTime<Gauss<STAGES>>, Called<S>, N>| u64::from(run.iterations()) * STAGES as u64;
    Ok(Box::new(Simulated { uncounted: Some(count), ..run }))
}

/// Starts a run of Gauss steps.
fn gauss<'a, S, const N: usize, const STAGES: usize>(
    system: S,
    state: State<N>,
    h: StepLength,
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: Collocation<N> + Convertible<N> + 'a,
{
    let run = Simulated::new(system.at_state(state).integrate(Gauss::<STAGES>, h)?, evaluations);
    let count = |run: &Run<Gauss<STAGES>, S, N>| u64::from(run.iterations()) * STAGES as u64;
    Ok(Box::new(Simulated { uncounted: Some(count), ..run }))
}

/// A vector of the system's size.
///
/// # Errors
/// [`StepError::InvalidInput`] for another number of values.
pub fn vector<const N: usize>(values: &[f64], input: &'static str) -> Result<SVector<f64, N>, StepError> {
    if values.len() == N {
        Ok(SVector::from_column_slice(values))
    } else {
        #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
        let value = values.len() as f64;
        Err(StepError::InvalidInput { input, allowed: "that of the system", value })
    }
}

/// A number read from a run.
type Reading<M, S, const N: usize, R> = fn(&Run<M, S, N>) -> R;

/// A run with a method, and the data for its rows.
struct Simulated<'a, M: vi_core::Method<S, N>, S, const N: usize> {
    run: Run<M, S, N>,
    /// Time and H at which H is most accurate.
    sampled_energy: Reading<M, S, N, Result<(f64, f64), StepError>>,
    evaluations: &'a Cell<u64>,
    /// The evaluations of the last step, if its system does not count them.
    uncounted: Option<Reading<M, S, N, u64>>,
    /// The conserved quantity of steps with a shift.
    shifted: Option<Reading<M, S, N, ShiftedEnergy>>,
    /// Length of the last step, if it was shortened.
    shortened: Option<f64>,
    monitor: Option<Box<ErrorMonitor<M, S, N>>>,
}

/// Relative deviation below which a length counts as the step of the run.
const ROUNDED: f64 = 1e-9;

impl<'a, M: vi_core::Method<S, N> + 'a, S: Lagrangian<N> + Copy + 'a, const N: usize> Simulated<'a, M, S, N> {
    /// A run whose system counts its evaluations, and whose H is most accurate at the nodes.
    fn new(run: Run<M, S, N>, evaluations: &'a Cell<u64>) -> Self {
        let at_the_node = |run: &Run<M, S, N>| Ok((run.t(), run.energy()?));
        let sampled_energy = at_the_node;
        Self { run, sampled_energy, evaluations, uncounted: None, shifted: None, shortened: None, monitor: None }
    }

    /// The same, type-erased.
    fn boxed(run: Run<M, S, N>, evaluations: &'a Cell<u64>) -> Box<dyn Simulation + 'a> {
        Box::new(Self::new(run, evaluations))
    }

    /// Shows the last step to the monitor, whose evaluations are not those of the run.
    fn watch(&mut self) {
        if let Some(monitor) = &mut self.monitor {
            let before = self.evaluations.get();
            monitor.watch(&self.run);
            self.evaluations.set(before);
        }
    }

    /// Adds the evaluations of the last step of a run.
    fn count(&self, run: &Run<M, S, N>) {
        if let Some(of_a_step) = self.uncounted {
            self.evaluations.update(|count| count + of_a_step(run));
        }
    }
}

impl<'a, M: vi_core::Method<S, N> + 'a, S: Lagrangian<N> + Copy + 'a, const N: usize> Simulation
    for Simulated<'a, M, S, N>
{
    fn t(&self) -> f64 {
        self.run.t()
    }

    fn q(&self) -> &[f64] {
        self.run.node().q.as_slice()
    }

    fn p(&self) -> &[f64] {
        self.run.node().p.as_slice()
    }

    fn h(&self) -> f64 {
        self.shortened.unwrap_or_else(|| self.run.h())
    }

    fn energy(&self) -> Result<f64, StepError> {
        self.run.energy()
    }

    fn discrete_energy(&self) -> Option<f64> {
        // A step of another length does not conserve the energy.
        if self.shortened.is_some() { None } else { self.run.discrete_energy() }
    }

    fn shifted_energy(&self) -> Option<ShiftedEnergy> {
        self.shifted.map(|of| of(&self.run))
    }

    fn monitor(&mut self) {
        self.monitor = Some(Box::new(ErrorMonitor::new(&self.run)));
    }

    fn largest_error(&self) -> Option<ErrorEstimate> {
        let before = self.evaluations.get();
        let found = self.monitor.as_ref().map(|monitor| monitor.largest(&self.run));
        self.evaluations.set(before);
        found
    }

    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        (self.sampled_energy)(&self.run)
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.run.single_step()?;
        self.count(&self.run);
        self.shortened = None;
        self.watch();
        Ok(())
    }

    fn advance_to(&mut self, end: f64) -> Result<(), StepError> {
        let (left, h) = (self.run.time_to(end), self.run.h());
        let rounding = (f64::EPSILON * end.abs()).min(ROUNDED * h.abs());
        let is_beyond = |left: f64| left * h.signum() < -rounding;
        if is_beyond(left - self.run.longest()) {
            // Steps that solve for their length must be taken to know it.
            let ahead = if M::FINDS_LENGTH { Some(self.run.after_a_step()?) } else { None };
            let Some(ahead) = ahead.filter(|ahead| !is_beyond(ahead.time_to(end))) else {
                self.run.end_at(end)?;
                self.shortened = Some(left);
                self.watch();
                return Ok(());
            };
            self.run = ahead;
            self.count(&self.run);
            self.watch();
        } else {
            self.advance()?;
        }
        if self.run.time_to(end).abs() <= rounding {
            self.run.set_time(end);
        }
        Ok(())
    }

    fn cross(&mut self, section: &Section, end: f64, take: &mut dyn FnMut(Row)) -> Result<(), StepError> {
        let system = *self.run.system();
        for crossing in self.run.events(section.event(), end) {
            let Crossing { state, length, .. } = crossing?;
            take(Row {
                t: state.t,
                q: state.q.as_slice().to_vec(),
                p: state.p.as_slice().to_vec(),
                energy: state.energy(&system).ok(),
                discrete_energy: None,
                shifted_energy: None,
                h: length,
            });
        }
        Ok(())
    }

    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        // A local copy of the run: behind a pointer its numbers would go through memory in every step.
        let mut run = self.run.clone();
        let mut taken = 0;
        let mut outcome = Ok(());
        while outcome.is_ok() && taken < most && run.t() < end {
            outcome = run.step().map(drop);
            self.count(&run);
            taken += 1;
        }
        self.run = run;
        outcome.map(|()| taken)
    }
}
