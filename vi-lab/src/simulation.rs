//! One run of any system, its number of degrees of freedom erased.
//!
//! In: a system with its parameters, a [`Plan`]. Out: a [`Simulation`], whose rows are the nodes that the integrator
//! reaches, the first one the node it starts from. Erased, so that a name on the command line can choose the system;
//! the numbers are those of the generic integrators, to the last bit.

use crate::start;
use clap::ValueEnum;
use serde::Deserialize;
use vi_core::{EnergyPreserving, FixedStep, SVector, State, StepError, Stepping};

/// Which integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Method {
    /// The variational integrator with a given step
    Fixed,
    /// The integrator that solves for its own step and preserves the discrete energy
    Energy,
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
    /// The start of the energy-preserving integrator; the fixed-step integrator needs none.
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
    pub(crate) fn method_name(&self) -> &'static str {
        match (self.method, self.start) {
            (Method::Fixed, _) => "fixed",
            (Method::Energy, Start::Midpoint) => "energy, start midpoint",
            (Method::Energy, Start::Points) => "energy, start points",
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
    /// E, the discrete energy of the interval that ends at the node; none before the first fixed step.
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
    /// Length of the last step; before the first one the length asked for.
    fn h(&self) -> f64;
    /// The node reached last, with its energies.
    fn row(&self) -> Row;
    /// Takes one step.
    fn advance(&mut self) -> Result<(), StepError>;
}

/// Starts a run of `system`.
///
/// # Errors
/// What the integrators say of the initial state; [`StepError::InvalidInput`] where the numbers of coordinates or
/// velocities are not those of the system.
pub(crate) fn begin<S, const N: usize>(system: S, plan: &Plan) -> Result<Box<dyn Simulation>, StepError>
where
    S: Stepping<N> + 'static,
{
    let initial = (plan.t, vector(&plan.q, "number of coordinates")?, vector(&plan.v, "number of velocities")?);
    let (t, q, v) = initial;
    Ok(match plan.method {
        Method::Fixed => {
            let state = State::at(&system, t, q, v);
            Box::new(Fixed { integrator: FixedStep::new(system, state, plan.h)? })
        }
        Method::Energy => {
            let integrator = match plan.start {
                Start::Midpoint => EnergyPreserving::from_midpoint(system, t, q, v, plan.h)?,
                Start::Points => {
                    let second = start::second_point(&system, initial, plan.h)?;
                    EnergyPreserving::from_points(system, (t, q), second)?
                }
            };
            Box::new(Energy { integrator })
        }
    })
}

/// A vector of the system's size.
fn vector<const N: usize>(values: &[f64], input: &'static str) -> Result<SVector<f64, N>, StepError> {
    if values.len() == N {
        Ok(SVector::from_column_slice(values))
    } else {
        #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
        let value = values.len() as f64;
        Err(StepError::InvalidInput { input, allowed: "that of the system", value })
    }
}

struct Fixed<S: Stepping<N>, const N: usize> {
    integrator: FixedStep<S, N>,
}

struct Energy<S, const N: usize> {
    integrator: EnergyPreserving<S, N>,
}

impl<S: Stepping<N>, const N: usize> Simulation for Fixed<S, N> {
    fn t(&self) -> f64 {
        self.integrator.state().t
    }

    fn q(&self) -> Vec<f64> {
        self.integrator.state().q.as_slice().to_vec()
    }

    fn h(&self) -> f64 {
        self.integrator.h()
    }

    fn row(&self) -> Row {
        let Self { integrator } = self;
        row(integrator.system(), &integrator.state(), integrator.discrete_energy(), integrator.h())
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.integrator.step().map(drop)
    }
}

impl<S: Stepping<N>, const N: usize> Simulation for Energy<S, N> {
    fn t(&self) -> f64 {
        self.integrator.state().t
    }

    fn q(&self) -> Vec<f64> {
        self.integrator.state().q.as_slice().to_vec()
    }

    fn h(&self) -> f64 {
        self.integrator.h()
    }

    fn row(&self) -> Row {
        let Self { integrator } = self;
        row(integrator.system(), &integrator.state(), Some(integrator.energy()), integrator.h())
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.integrator.step().map(drop)
    }
}

fn row<S: Stepping<N>, const N: usize>(system: &S, state: &State<N>, discrete_energy: Option<f64>, h: f64) -> Row {
    let (q, p) = (state.q.as_slice().to_vec(), state.p.as_slice().to_vec());
    Row { t: state.t, q, p, energy: state.energy(system).ok(), discrete_energy, h }
}
