//! One run of any system, its number of degrees of freedom erased.
//!
//! In: a system with its parameters, a [`Plan`]. Out: a [`Simulation`], whose rows are the nodes that the integrator
//! reaches, the first one the node it starts from. Erased, so that a name on the command line can choose the system;
//! the numbers are those of the generic integrators, to the last bit, and [`Simulation::advance_by`] is their loop, in
//! which no call is virtual.

use crate::start;
use clap::ValueEnum;
use serde::Deserialize;
use vi_core::stepping::EnergyStepping;
use vi_core::{Composition, EnergyPreserving, FixedStep, SVector, Scheme, State, StepError};

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
    /// The integrator that solves for its own step and preserves the discrete energy
    Energy,
}

impl Method {
    /// The scheme of a composition.
    pub(crate) fn scheme(self) -> Option<Scheme> {
        match self {
            Self::Suzuki4 => Some(Scheme::SUZUKI_4),
            Self::KahanLi6 => Some(Scheme::KAHAN_LI_6),
            Self::KahanLi8 => Some(Scheme::KAHAN_LI_8),
            Self::Fixed | Self::Energy => None,
        }
    }

    /// Its name on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Suzuki4 => "suzuki-4",
            Self::KahanLi6 => "kahan-li-6",
            Self::KahanLi8 => "kahan-li-8",
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

/// A run that has been started.
pub(crate) trait Simulation {
    /// Time of the node reached last.
    fn t(&self) -> f64;
    /// Coordinates of the node reached last.
    fn q(&self) -> Vec<f64>;
    /// Momenta of the node reached last.
    fn p(&self) -> Vec<f64>;
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
        (0..steps).try_for_each(|_| self.advance())
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
            q: self.q(),
            p: self.p(),
            energy: self.energy().ok(),
            discrete_energy: self.discrete_energy(),
            h: self.h(),
        }
    }
}

/// Starts a run of `system`.
///
/// # Errors
/// What the integrators say of the initial state; [`StepError::InvalidInput`] where the numbers of coordinates or
/// velocities are not those of the system.
pub(crate) fn begin<'a, S, const N: usize>(system: S, plan: &Plan) -> Result<Box<dyn Simulation + 'a>, StepError>
where
    S: EnergyStepping<N> + 'a,
{
    let t = plan.t;
    let q = vector(&plan.q, "number of coordinates")?;
    let v = vector(&plan.v, "number of velocities")?;
    Ok(match (plan.method, plan.method.scheme()) {
        (Method::Energy, _) => {
            let integrator = match plan.start {
                Start::Midpoint => EnergyPreserving::from_midpoint(system, t, q, v, plan.h)?,
                Start::Points => {
                    let second = start::second_point(&system, t, q, v, plan.h)?;
                    EnergyPreserving::from_points(system, (t, q), second)?
                }
            };
            Box::new(Energy { integrator })
        }
        (_, Some(scheme)) => {
            let integrator = Composition::new(system, scheme, State::at(&system, t, q, v), plan.h)?;
            Box::new(Composed { system, integrator, h: plan.h })
        }
        (_, None) => {
            let state = State::at(&system, t, q, v);
            Box::new(Fixed { integrator: FixedStep::new(system, state, plan.h)? })
        }
    })
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

struct Fixed<S: EnergyStepping<N>, const N: usize> {
    integrator: FixedStep<S, N>,
}

impl<S: EnergyStepping<N>, const N: usize> Simulation for Fixed<S, N> {
    fn t(&self) -> f64 {
        self.integrator.state().t
    }

    fn q(&self) -> Vec<f64> {
        self.integrator.state().q.as_slice().to_vec()
    }

    fn p(&self) -> Vec<f64> {
        self.integrator.state().p.as_slice().to_vec()
    }

    fn h(&self) -> f64 {
        self.integrator.h()
    }

    fn energy(&self) -> Result<f64, StepError> {
        self.integrator.state().energy(self.integrator.system())
    }

    fn discrete_energy(&self) -> Option<f64> {
        self.integrator.discrete_energy()
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.integrator.step().map(drop)
    }

    fn advance_by(&mut self, steps: u64) -> Result<(), StepError> {
        // The loop has an integrator of its own: behind a pointer its numbers would go through memory in every step.
        let mut integrator = self.integrator.clone();
        let outcome = (0..steps).try_for_each(|_| integrator.step().map(drop));
        self.integrator = integrator;
        outcome
    }
}

struct Composed<S: EnergyStepping<N>, const N: usize> {
    system: S,
    integrator: Composition<S, N>,
    h: f64,
}

impl<S: EnergyStepping<N>, const N: usize> Simulation for Composed<S, N> {
    fn t(&self) -> f64 {
        self.integrator.state().t
    }

    fn q(&self) -> Vec<f64> {
        self.integrator.state().q.as_slice().to_vec()
    }

    fn p(&self) -> Vec<f64> {
        self.integrator.state().p.as_slice().to_vec()
    }

    fn h(&self) -> f64 {
        self.h
    }

    fn energy(&self) -> Result<f64, StepError> {
        self.integrator.state().energy(&self.system)
    }

    fn discrete_energy(&self) -> Option<f64> {
        None
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.integrator.step().map(drop)
    }
}

struct Energy<S, const N: usize> {
    integrator: EnergyPreserving<S, N>,
}

impl<S: EnergyStepping<N>, const N: usize> Simulation for Energy<S, N> {
    fn t(&self) -> f64 {
        self.integrator.state().t
    }

    fn q(&self) -> Vec<f64> {
        self.integrator.state().q.as_slice().to_vec()
    }

    fn p(&self) -> Vec<f64> {
        self.integrator.state().p.as_slice().to_vec()
    }

    fn h(&self) -> f64 {
        self.integrator.h()
    }

    fn energy(&self) -> Result<f64, StepError> {
        self.integrator.state().energy(self.integrator.system())
    }

    fn discrete_energy(&self) -> Option<f64> {
        Some(self.integrator.discrete_energy())
    }

    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        let Self { integrator } = self;
        let v = integrator.v();
        let (t, q) = integrator.node().midpoint(-integrator.h(), &v);
        Ok((t, integrator.system().energy(t, &q, &v)))
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.integrator.step().map(drop)
    }

    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        // As in fixed steps, the loop has an integrator of its own.
        let mut integrator = self.integrator.clone();
        let mut taken = 0;
        let mut outcome = Ok(());
        while outcome.is_ok() && taken < most && integrator.node().t < end {
            outcome = integrator.step().map(drop);
            taken += 1;
        }
        self.integrator = integrator;
        outcome.map(|()| taken)
    }
}
