//! One run of any system, its number of degrees of freedom erased.
//!
//! In: a system with its parameters, a [`Plan`]. Out: a [`Simulation`], whose rows are the nodes that the integrator
//! reaches, the first one the node it starts from. Erased, so that a name on the command line can choose the system;
//! the numbers are those of the generic integrators, to the last bit, and [`Simulation::advance_until`] is their loop, in
//! which no call is virtual.

use crate::counting::Counting;
use crate::start;
use clap::ValueEnum;
use core::cell::Cell;
use serde::Deserialize;
use vi_core::collocation::Collocation;
use vi_core::integrator::{Crossing, Direction, Event};
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_core::{
    Composition, EnergyPreserving, FixedStep, Gauss, Integrator, Lagrangian, SVector, Scheme, State, StepError,
};

/// Which integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Method {
    /// The variational integrator with a given step
    Fixed,
    /// Five fixed steps composed to order 4, by Suzuki
    #[value(name = "suzuki-4")]
    #[serde(rename = "suzuki-4")]
    Suzuki4,
    /// Nine fixed steps composed to order 6, by Kahan and Li
    #[value(name = "kahan-li-6")]
    #[serde(rename = "kahan-li-6")]
    KahanLi6,
    /// Seventeen fixed steps composed to order 8, by Kahan and Li
    #[value(name = "kahan-li-8")]
    #[serde(rename = "kahan-li-8")]
    KahanLi8,
    /// Collocation at Gauss points, of twice the order of its --stages
    Gauss,
    /// The integrator that solves for its own step and preserves the discrete energy
    Energy,
}

/// Numbers of stages of the Gauss steps that are built into the command, for each system: each costs a second or two of the compiler.
pub(crate) const STAGES: [usize; 2] = [4, 8];
/// The number of stages that nobody asked for: the most accurate steps for their time, from errors of 1e-6 on.
pub(crate) const USUAL_STAGES: usize = 8;

impl Method {
    /// The scheme of a composition.
    pub(crate) fn scheme(self) -> Option<Scheme> {
        match self {
            Self::Suzuki4 => Some(Scheme::SUZUKI_4),
            Self::KahanLi6 => Some(Scheme::KAHAN_LI_6),
            Self::KahanLi8 => Some(Scheme::KAHAN_LI_8),
            Self::Fixed | Self::Gauss | Self::Energy => None,
        }
    }

    /// Its name on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Suzuki4 => "suzuki-4",
            Self::KahanLi6 => "kahan-li-6",
            Self::KahanLi8 => "kahan-li-8",
            Self::Gauss => "gauss",
            Self::Energy => "energy",
        }
    }
}

/// How the energy-preserving integrator gets its first interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Start {
    /// The initial state is the middle of the first interval
    Midpoint,
    /// The first interval ends in the exact solution at t0 + h: the paper's start
    Points,
}

/// What is to be run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plan {
    /// The integrator.
    pub(crate) method: Method,
    /// The start of the energy-preserving integrator; the others need none.
    pub(crate) start: Start,
    /// The stages of Gauss steps, one of [`STAGES`]; the others need none.
    pub(crate) stages: usize,
    /// The step, or the first one.
    pub(crate) h: f64,
    /// Initial time.
    pub(crate) t: f64,
    /// Initial coordinates.
    pub(crate) q: Vec<f64>,
    /// Initial velocities.
    pub(crate) v: Vec<f64>,
}

impl Plan {
    /// The integrator and its start, as they are asked for on the command line.
    pub(crate) fn method_name(&self) -> String {
        let name = self.method.name();
        match (self.method, self.start) {
            (Method::Energy, Start::Midpoint) => format!("{name}, start midpoint"),
            (Method::Energy, Start::Points) => format!("{name}, start points"),
            (Method::Gauss, _) => format!("{name}, {} stages", self.stages),
            _ => name.to_owned(),
        }
    }
}

/// A node, its energies, and the length of the step that led to it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// Time.
    pub(crate) t: f64,
    /// Coordinates.
    pub(crate) q: Vec<f64>,
    /// Momenta.
    pub(crate) p: Vec<f64>,
    /// H, the energy at the node; none where no velocity belongs to the momenta.
    pub(crate) energy: Option<f64>,
    /// E, the discrete energy of the interval that ends at the node; none before the first fixed step, and none of a
    /// composition, whose whole step is no interval of one discrete Lagrangian.
    pub(crate) discrete_energy: Option<f64>,
    /// Length of the step; in the first row the length asked for.
    pub(crate) h: f64,
}

impl Row {
    /// The names of the columns, for these coordinates.
    pub(crate) fn columns(coordinates: &[&str]) -> Vec<String> {
        let q = coordinates.iter().map(|&name| name.to_owned());
        let p = coordinates.iter().map(|name| format!("p_{name}"));
        let last = ["H", "E", "h"].map(str::to_owned);
        ["t".to_owned()].into_iter().chain(q).chain(p).chain(last).collect()
    }

    /// The entries in the order of the columns.
    pub(crate) fn entries(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        let numbers = core::iter::once(&self.t).chain(&self.q).chain(&self.p).copied().map(Some);
        numbers.chain([self.energy, self.discrete_energy, Some(self.h)])
    }
}

/// A surface that a motion crosses again and again: a Poincaré section.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Section {
    /// A coordinate has this value, and passes it in this direction.
    Coordinate {
        /// Which coordinate.
        index: usize,
        /// Its value.
        at: f64,
        /// Rising, falling, or both.
        direction: Direction,
    },
    /// The time is `start` and a whole number of periods.
    Period {
        /// Time of the first one.
        start: f64,
        /// From one to the next.
        period: f64,
    },
}

impl Section {
    /// A function of time and coordinates that changes its sign at the section.
    fn value(&self, t: f64, q: &[f64]) -> f64 {
        match self {
            Self::Coordinate { index, at, .. } => q[*index] - at,
            Self::Period { start, period } => {
                let passed = (t - start) / period;
                // Within half a period of zero, so that late crossings are as sharp as early ones.
                let is_odd = if passed.round() % 2.0 == 0.0 { 1.0 } else { -1.0 };
                is_odd * (core::f64::consts::PI * (passed - passed.round())).sin()
            }
        }
    }

    /// In which direction the function passes zero.
    fn direction(&self) -> Direction {
        match self {
            Self::Coordinate { direction, .. } => *direction,
            Self::Period { .. } => Direction::Both,
        }
    }
}

/// A run that has been started.
pub(crate) trait Simulation {
    /// Time of the node reached last.
    fn t(&self) -> f64;
    /// Coordinates of the node reached last.
    fn q(&self) -> &[f64];
    /// Momenta of the node reached last.
    fn p(&self) -> &[f64];
    /// Length of the last step; before the first one the length asked for.
    fn h(&self) -> f64;
    /// H, the energy at the node reached last, of its coordinates and momenta.
    ///
    /// # Errors
    /// Where no velocity belongs to the momenta.
    fn energy(&self) -> Result<f64, StepError>;
    /// E, the discrete energy of the interval that ends at the node reached last; none where there is no such interval.
    fn discrete_energy(&self) -> Option<f64>;
    /// Takes one step.
    ///
    /// # Errors
    /// That of the integrator.
    fn advance(&mut self) -> Result<(), StepError>;

    /// Goes on to the time `end`, and gives `take` the point of each crossing of a section on the way, in their order: located by
    /// steps of the exact length, which h tells. Their discrete energy is none.
    ///
    /// # Errors
    /// That of the step that fails.
    fn cross(&mut self, section: &Section, end: f64, take: &mut dyn FnMut(Row)) -> Result<(), StepError>;

    /// Time and H where the method keeps H best: at the node; with energy-preserving steps in the middle of the last one,
    /// since H swings by h²D/8 at their nodes.
    ///
    /// # Errors
    /// As [`Simulation::energy`].
    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        Ok((self.t(), self.energy()?))
    }

    /// Takes so many steps.
    ///
    /// # Errors
    /// That of the step that fails.
    fn advance_by(&mut self, steps: u64) -> Result<(), StepError> {
        self.advance_until(f64::INFINITY, steps).map(drop)
    }

    /// Takes steps until a node at `end` or later is reached, so many at most; returns how many.
    ///
    /// # Errors
    /// That of the step that fails.
    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        let mut taken = 0;
        while taken < most && self.t() < end {
            self.advance()?;
            taken += 1;
        }
        Ok(taken)
    }

    /// The node reached last, with its energies.
    fn row(&self) -> Row {
        Row {
            t: self.t(),
            q: self.q().to_vec(),
            p: self.p().to_vec(),
            energy: self.energy().ok(),
            discrete_energy: self.discrete_energy(),
            h: self.h(),
        }
    }
}

/// Starts a run of `system`. `evaluations` grows by those of its equations, which [`Counting`] counts; by Gauss steps it grows by the
/// sweeps of each step times its stages, so that no copy of these steps is built for a system that counts.
///
/// # Errors
/// What the integrators say of the initial state; [`StepError::InvalidInput`] where the numbers of coordinates or
/// velocities are not those of the system, and for stages that are not among [`STAGES`].
pub(crate) fn begin<'a, S, const N: usize>(
    system: S,
    plan: &Plan,
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: EnergyStepping<N> + Collocation<N> + Convertible<N> + 'a,
{
    let t = plan.t;
    let q = vector(&plan.q, "number of coordinates")?;
    let v = vector(&plan.v, "number of velocities")?;
    let state = State::at(&system, t, q, v);
    let counting = Counting::new(system, evaluations);
    match plan.method {
        Method::Fixed => Ok(Run::boxed(FixedStep::new(counting, state, plan.h)?, evaluations)),
        Method::Suzuki4 => Ok(Run::boxed(Composition::new(counting, Scheme::SUZUKI_4, state, plan.h)?, evaluations)),
        Method::KahanLi6 => Ok(Run::boxed(Composition::new(counting, Scheme::KAHAN_LI_6, state, plan.h)?, evaluations)),
        Method::KahanLi8 => Ok(Run::boxed(Composition::new(counting, Scheme::KAHAN_LI_8, state, plan.h)?, evaluations)),
        Method::Gauss => match plan.stages {
            4 => gauss::<S, N, 4>(system, state, plan.h, evaluations),
            8 => gauss::<S, N, 8>(system, state, plan.h, evaluations),
            #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
            other => Err(StepError::InvalidInput { input: "number of stages", allowed: "4 or 8", value: other as f64 }),
        },
        Method::Energy => {
            let integrator = match plan.start {
                Start::Midpoint => EnergyPreserving::from_midpoint(counting, t, q, v, plan.h)?,
                Start::Points => {
                    let second = start::second_point(&system, t, q, v, plan.h)?;
                    EnergyPreserving::from_points(counting, (t, q), second)?
                }
            };
            let in_the_middle = |run: &EnergyPreserving<Counting<'a, S>, N>| {
                let v = run.v();
                let (t, q) = run.node().midpoint(-run.h(), &v);
                Ok((t, run.system().energy(t, &q, &v)))
            };
            Ok(Box::new(Run { sampled_energy: in_the_middle, ..Run::new(integrator, evaluations) }))
        }
    }
}

/// Starts a run by Gauss steps of so many stages.
fn gauss<'a, S, const N: usize, const STAGES: usize>(
    system: S,
    state: State<N>,
    h: f64,
    evaluations: &'a Cell<u64>,
) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: EnergyStepping<N> + Collocation<N> + Convertible<N> + 'a,
{
    let run = Run::new(Gauss::<S, N, STAGES>::new(system, state, h)?, evaluations);
    let count = |run: &Gauss<S, N, STAGES>| u64::from(run.iterations()) * STAGES as u64;
    Ok(Box::new(Run { uncounted: Some(count), ..run }))
}

/// A vector of the system's size.
///
/// # Errors
/// [`StepError::InvalidInput`] where there are more or fewer values.
pub(crate) fn vector<const N: usize>(values: &[f64], input: &'static str) -> Result<SVector<f64, N>, StepError> {
    if values.len() == N {
        Ok(SVector::from_column_slice(values))
    } else {
        #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
        let value = values.len() as f64;
        Err(StepError::InvalidInput { input, allowed: "that of the system", value })
    }
}

/// A run by an integrator.
struct Run<'a, I, const N: usize> {
    integrator: I,
    /// Time and H where the method keeps H best.
    sampled_energy: fn(&I) -> Result<(f64, f64), StepError>,
    evaluations: &'a Cell<u64>,
    /// The evaluations of the last step, where its system does not count them.
    uncounted: Option<fn(&I) -> u64>,
}

impl<'a, I: Integrator<N> + 'a, const N: usize> Run<'a, I, N> {
    /// A run whose system counts its evaluations, and which keeps H best at the nodes.
    fn new(integrator: I, evaluations: &'a Cell<u64>) -> Self {
        Self { integrator, sampled_energy: |run| Ok((run.t(), run.energy()?)), evaluations, uncounted: None }
    }

    /// The same, its type erased.
    fn boxed(integrator: I, evaluations: &'a Cell<u64>) -> Box<dyn Simulation + 'a> {
        Box::new(Self::new(integrator, evaluations))
    }

    /// Adds the evaluations of the step that `integrator` took last.
    fn count(&self, integrator: &I) {
        if let Some(of_a_step) = self.uncounted {
            self.evaluations.update(|count| count + of_a_step(integrator));
        }
    }
}

impl<'a, I: Integrator<N> + 'a, const N: usize> Simulation for Run<'a, I, N> {
    fn t(&self) -> f64 {
        self.integrator.t()
    }

    fn q(&self) -> &[f64] {
        self.integrator.node().q.as_slice()
    }

    fn p(&self) -> &[f64] {
        self.integrator.node().p.as_slice()
    }

    fn h(&self) -> f64 {
        self.integrator.h()
    }

    fn energy(&self) -> Result<f64, StepError> {
        self.integrator.energy()
    }

    fn discrete_energy(&self) -> Option<f64> {
        self.integrator.discrete_energy()
    }

    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        (self.sampled_energy)(&self.integrator)
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.integrator.step()?;
        self.count(&self.integrator);
        Ok(())
    }

    fn cross(&mut self, section: &Section, end: f64, take: &mut dyn FnMut(Row)) -> Result<(), StepError> {
        let system = *self.integrator.system();
        let value = |t: f64, q: &SVector<f64, N>, _: &SVector<f64, N>| section.value(t, q.as_slice());
        let wanted = [Event::new(&value, section.direction())];
        for crossing in self.integrator.events(&wanted, end) {
            let Crossing { state, length, .. } = crossing?;
            take(Row {
                t: state.t,
                q: state.q.as_slice().to_vec(),
                p: state.p.as_slice().to_vec(),
                energy: state.energy(&system).ok(),
                discrete_energy: None,
                h: length,
            });
        }
        Ok(())
    }

    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        // The loop has an integrator of its own: behind a pointer its numbers would go through memory in every step.
        let mut integrator = self.integrator.clone();
        let mut taken = 0;
        let mut outcome = Ok(());
        while outcome.is_ok() && taken < most && integrator.t() < end {
            outcome = integrator.step().map(drop);
            self.count(&integrator);
            taken += 1;
        }
        self.integrator = integrator;
        outcome.map(|()| taken)
    }
}
