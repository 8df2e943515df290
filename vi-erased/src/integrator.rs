//! Integrators that are built for a system.
//!
//! In: the type of a system. Out: for each method an [`Integrator`], which starts its runs. Fixed and Gauss steps, kicks
//! and drifts are optimised for the system; the others take [`Called`] systems, which build
//! in a third of the time and differ by rounding.

use crate::erasable::{Derived, Erasable, Runnable};
use crate::method::AnyMethod;
use crate::plan::{Built, Method, Plan, Shift, Start};
use crate::run::erased;
use crate::simulation::{ShiftedEnergy, Simulation};
use crate::start;
use core::convert::identity;
#[cfg(feature = "checkpoints")]
use serde_json::value::RawValue;
#[cfg(feature = "studies")]
use vi_core::SVector;
use vi_core::kind::{Free, Kind};
use vi_core::method::{Controlled, Shiftable, Storable};
use vi_core::motion::Motion;
#[cfg(feature = "checkpoints")]
use vi_core::run::Checkpoint;
use vi_core::stepping::EnergyStepping;
use vi_core::{
    Adaptive, Called, Composition, EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss,
    InTransformedTime, Presumed, Run, Splitting, Starts, State, StepError,
};

/// Starts a run of a plan from a state, as [`System::begin_while`](crate::System::begin_while).
type Begin<S, const N: usize> =
    fn(S, &Plan, State<N>, &mut dyn FnMut() -> bool) -> Result<Box<dyn Simulation>, StepError>;
/// Restarts a stored run.
#[cfg(feature = "checkpoints")]
type Restart<S> = fn(S, &str) -> Result<Box<dyn Simulation>, String>;

/// An integrator that is built for a system.
#[derive(Clone, Copy)]
pub struct Integrator<S, const N: usize> {
    /// Its method, number of stages and time.
    pub built: Built,
    pub(crate) begin: Begin<S, N>,
    #[cfg(feature = "checkpoints")]
    pub(crate) restart: Restart<S>,
    /// The step density of energy-preserving steps of order 2.
    #[cfg(feature = "studies")]
    pub(crate) density: Option<Density<S, N>>,
}

/// The step density of a rule at (t, q, v); `None` without a value.
#[cfg(feature = "studies")]
type Density<S, const N: usize> = fn(&S, f64, &SVector<f64, N>, &SVector<f64, N>) -> Option<f64>;

/// Integrators of several words of [`kind!`](crate::kind).
#[must_use]
pub fn all<S, const N: usize, const K: usize>(of: [Vec<Integrator<S, N>>; K]) -> Vec<Integrator<S, N>> {
    of.into_iter().flatten().collect()
}

/// Reads a stored run of a method.
#[cfg(feature = "checkpoints")]
fn restarted<S: Runnable<N>, const N: usize>(
    system: S,
    method: AnyMethod<S, N>,
    stored: &str,
) -> Result<Box<dyn Simulation>, String> {
    let stored: Checkpoint<Box<RawValue>, N> = serde_json::from_str(stored).map_err(|error| error.to_string())?;
    let stored = stored.try_map(|memory| method.memory(memory.get()))?;
    let run = Run::restart(system, method, stored).map_err(|error| match error {
        StepError::OtherSystem { .. } => error.to_string(),
        // Other advice is for programmers.
        _ => error.reason().to_string(),
    })?;
    Ok(erased(run, false))
}

/// An integrator: which one, the system that it takes, its method of a system for a restart, and how a run begins.
macro_rules! integrator {
    ($built:expr, $wrapped:expr, $system:ident => $method:expr, $begin:expr) => {
        Integrator {
            built: $built,
            begin: $begin,
            #[cfg(feature = "checkpoints")]
            restart: |$system: S, stored| restarted($system, AnyMethod::of($method, $wrapped), stored),
            #[cfg(feature = "studies")]
            density: None,
        }
    };
}

/// An integrator whose runs begin with a plan's step length.
macro_rules! by_length {
    ($kind:expr, $stages:expr, $wrapped:expr, $system:ident => $method:expr) => {
        integrator!(
            ($kind, $stages, false),
            $wrapped,
            $system => $method,
            |$system: S, plan: &Plan, state: State<N>, _| {
                let method = AnyMethod::of($method, $wrapped);
                Ok(erased($system.at_state(state).integrate(method, plan.length())?, false))
            }
        )
    };
    ($kind:expr, $stages:expr, $wrapped:expr, $method:expr) => {
        by_length!($kind, $stages, $wrapped, system => $method)
    };
}

/// Fixed steps of order 2.
#[must_use]
pub fn fixed<S: Runnable<N>, const N: usize>() -> Integrator<S, N>
where
    FixedStep: Erasable<S, N>,
{
    by_length!(Method::Fixed, None, identity, FixedStep)
}

/// Fixed steps of order 2, and their compositions of order 4, 6, 8.
#[must_use]
pub fn by_rule<S: Runnable<N>, const N: usize>() -> Vec<Integrator<S, N>>
where
    FixedStep: Erasable<S, N>,
    Composition: Erasable<S, N>,
{
    vec![
        fixed(),
        by_length!(Method::Suzuki4, None, identity, Composition::SUZUKI_4),
        by_length!(Method::KahanLi6, None, identity, Composition::KAHAN_LI_6),
        by_length!(Method::KahanLi8, None, identity, Composition::KAHAN_LI_8),
    ]
}

/// Kicks and drifts of order 4 and 6; none for a system whose motion does not split.
#[must_use]
pub fn splitting<S: Runnable<N, Kind = Free>, const N: usize>() -> Vec<Integrator<S, N>>
where
    Presumed<S>: Runnable<N>,
    Splitting: Erasable<Presumed<S>, N>,
{
    if const { !S::SPLITS && !S::INTERPRETED } {
        return Vec::new();
    }
    vec![
        by_length!(Method::Splitting4, None, Presumed, system => weights(
            &system,
            Splitting::BLANES_MOAN_4,
            Splitting::BLANES_MOAN_S4
        )),
        by_length!(Method::Splitting6, None, Presumed, system => weights(
            &system,
            Splitting::BLANES_MOAN_6,
            Splitting::BLANES_MOAN_S6
        )),
    ]
}

/// The weights for a kinetic energy with a mass matrix, or for any.
fn weights<const N: usize>(system: &impl Motion<N>, with_mass: Splitting, any: Splitting) -> Splitting {
    if system.is_first_order() { any } else { with_mass }
}

/// Gauss steps of the given number of stages.
#[must_use]
pub fn gauss<S: Runnable<N>, const N: usize, const STAGES: usize>() -> Integrator<S, N>
where
    Gauss<STAGES>: Erasable<S, N>,
{
    by_length!(Method::Gauss, Some(STAGES), identity, Gauss::<STAGES>)
}

/// Gauss steps of the given number of stages whose length follows the motion.
#[must_use]
pub fn adaptive<S: Runnable<N>, const N: usize, const STAGES: usize>() -> Integrator<S, N>
where
    Called<S>: Runnable<N>,
    Adaptive<Gauss<STAGES>>: Erasable<S, N>,
    Adaptive<Gauss<STAGES>>: Erasable<Called<S>, N>,
{
    if const { is_called::<S, N>() } {
        by_length!(Method::Adaptive, Some(STAGES), Called, Gauss::<STAGES>.adaptive())
    } else {
        by_length!(Method::Adaptive, Some(STAGES), identity, Gauss::<STAGES>.adaptive())
    }
}

/// Whether steps that are not optimised for the system take it as [`Called`]. With constraints most of a step is
/// elimination, which calls no function of the system, and calls of an interpreter are calls already.
const fn is_called<S: Runnable<N>, const N: usize>() -> bool {
    S::Kind::COUNT == 0 && !S::INTERPRETED
}

/// Gauss steps in transformed time.
#[must_use]
pub fn transformed<S: Runnable<N, Kind = Free>, const N: usize, const STAGES: usize>() -> Integrator<S, N>
where
    Called<S>: Runnable<N>,
    InTransformedTime<Gauss<STAGES>>: Erasable<Called<S>, N>,
{
    integrator!(
        (Method::Gauss, Some(STAGES), true),
        Called,
        system => Gauss::<STAGES>.in_transformed_time(),
        |system: S, plan: &Plan, state: State<N>, _| {
            // Otherwise they would be built for every system.
            if !system.scales_time() {
                return Err(StepError::NoTimeScale { system: system.name() });
            }
            let method = AnyMethod::of(Gauss::<STAGES>.in_transformed_time(), Called);
            Ok(erased(system.at_state(state).integrate(method, plan.dtau.unwrap_or(plan.h))?, false))
        }
    )
}

/// Energy-preserving steps of order 2.
#[must_use]
pub fn energy<S: EnergyStepping<N> + Runnable<N>, const N: usize>() -> Integrator<S, N>
where
    EnergyPreserving: Erasable<S, N, Memory: Controlled<f64>>,
{
    let integrator = integrator!(
        (Method::Energy, None, false),
        identity,
        system => EnergyPreserving,
        |system: S, plan: &Plan, state: State<N>, _| {
            let method = AnyMethod::of(EnergyPreserving, identity);
            let h = system.at_state(state).length(&method, plan.length())?;
            let State { t, q, .. } = state;
            let v = || state.velocity(&system);
            let run = match plan.start {
                Start::State => system.at_state(state).integrate(EnergyPreserving, h)?,
                Start::Midpoint => EnergyPreserving::from_midpoint(system, t, q, v()?, h)?,
                Start::Points => {
                    EnergyPreserving::from_points(system, (t, q), start::second_point(&system, t, q, v()?, h)?)?
                }
            };
            Ok(erased(AnyMethod::erased(system, run.with_fallback(fallback(plan))), false))
        }
    );
    #[cfg(feature = "studies")]
    let integrator =
        Integrator { density: Some(|system: &S, t, q, v| system.step_density(t, q, v).ok()), ..integrator };
    integrator
}

/// An integrator of energy-preserving Gauss steps.
macro_rules! energy_gauss {
    ($wrapped:expr) => {
        integrator!(
            (Method::Energy, Some(STAGES), false),
            $wrapped,
            system => EnergyPreservingGauss::<STAGES>,
            |system: S, plan: &Plan, state: State<N>, goes_on| {
                let method = AnyMethod::of(EnergyPreservingGauss::<STAGES>, $wrapped);
                let h = system.at_state(state).length(&method, plan.length())?;
                let run = $wrapped(system).at_state(state).integrate(EnergyPreservingGauss::<STAGES>, h)?;
                let run = AnyMethod::erased(system, shifted(run, plan, goes_on)?);
                Ok(erased(run, plan.shift.is_some()))
            }
        )
    };
}

/// Energy-preserving Gauss steps of the given number of stages.
#[must_use]
pub fn energy_gauss<S: Runnable<N>, const N: usize, const STAGES: usize>() -> Integrator<S, N>
where
    Called<S>: Runnable<N>,
    EnergyPreservingGauss<STAGES>: Erasable<S, N, Memory: Controlled<f64>>,
    EnergyPreservingGauss<STAGES>: Erasable<Called<S>, N, Memory: Controlled<f64>>,
{
    if const { is_called::<S, N>() } { energy_gauss!(Called) } else { energy_gauss!(identity) }
}

/// A run of energy-preserving steps with the shift and the fallback of a plan.
///
/// # Errors
/// The errors of the shift.
fn shifted<M, S, const N: usize>(
    run: Run<M, S, N>,
    plan: &Plan,
    goes_on: &mut dyn FnMut() -> bool,
) -> Result<Run<M, S, N>, StepError>
where
    M: Shiftable<S, N, Memory: Controlled<f64>>,
    S: Runnable<N>,
{
    let run = match plan.shift {
        None => run,
        Some(Shift::Of(shift)) => run.with_shift(shift)?,
        Some(Shift::Over(time)) => run.with_shift_from_while(time, goes_on)?,
    };
    Ok(run.with_fallback(fallback(plan)))
}

/// The action if there is no energy-preserving step.
fn fallback(plan: &Plan) -> Fallback {
    if plan.fallback { Fallback::FixedSteps } else { Fallback::Stop }
}

/// Evaluations of an iteration by a rule: the equation with its Jacobian, then the residual.
pub const OF_A_CORRECTION: u64 = 2;

/// Evaluations of `steps` steps by a rule. A linear system has a closed form, whose residual is evaluated once.
fn by_corrections(iterations: u32, steps: usize) -> u64 {
    (OF_A_CORRECTION * u64::from(iterations)).max(steps as u64)
}

impl<S: Runnable<N>, const N: usize> Erasable<S, N> for FixedStep
where
    FixedStep: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        by_corrections(iterations, 1)
    }
}

impl<S: Runnable<N>, const N: usize> Erasable<S, N> for Composition
where
    Composition: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        by_corrections(iterations, self.weights.len())
    }
}

impl<S: Runnable<N>, const N: usize> Erasable<S, N> for Splitting
where
    Splitting: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, _iterations: u32) -> u64 {
        self.forces() as u64
    }
}

impl<S: EnergyStepping<N> + Runnable<N>, const N: usize> Erasable<S, N> for EnergyPreserving
where
    EnergyPreserving: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        by_corrections(iterations, 1)
    }

    fn sampled_energy(run: &Run<Self, S, N>) -> Result<(f64, f64), StepError> {
        let v = run.v();
        let (t, q) = run.node().midpoint(-run.h(), &v);
        Ok((t, run.system().energy(t, &q, &v)))
    }
}

impl<S: Runnable<N>, const N: usize, const STAGES: usize> Erasable<S, N> for Gauss<STAGES>
where
    Gauss<STAGES>: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        u64::from(iterations) * STAGES as u64
    }
}

impl<S: Runnable<N>, const N: usize, const STAGES: usize> Erasable<S, N> for Adaptive<Gauss<STAGES>>
where
    Adaptive<Gauss<STAGES>>: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        u64::from(iterations) * STAGES as u64
    }
}

impl<S: Runnable<N>, const N: usize, const STAGES: usize> Erasable<S, N> for InTransformedTime<Gauss<STAGES>>
where
    InTransformedTime<Gauss<STAGES>>: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        u64::from(iterations) * STAGES as u64
    }
}

impl<S: Runnable<N>, const N: usize, const STAGES: usize> Erasable<S, N> for EnergyPreservingGauss<STAGES>
where
    EnergyPreservingGauss<STAGES>: Derived<S, N, Memory: Storable>,
{
    fn evaluations(&self, iterations: u32) -> u64 {
        u64::from(iterations) * STAGES as u64
    }

    fn shifted_energy(run: &Run<Self, S, N>) -> Option<ShiftedEnergy> {
        Some(ShiftedEnergy { energy: run.shifted_energy(), shift: run.shift() })
    }
}
