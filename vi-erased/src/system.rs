//! A type-erased system with any number of coordinates.
//!
//! In: the type of a system, and its integrators. Out: a [`System`], whose functions and runs take slices.

#[cfg(feature = "derivatives")]
use crate::control::{Control, Linear, Rest};
use crate::erasable::Runnable;
use crate::integrator::Integrator;
#[cfg(feature = "studies")]
use crate::plan::ENERGY_STAGES;
use crate::plan::{Built, Method, PhasePoint, Plan};
use crate::run::constraint_residuals;
use crate::simulation::{Simulation, vector, wrong_size};
#[cfg(feature = "studies")]
use crate::studies::Studies;
#[cfg(feature = "studies")]
use crate::studies::exponents::{self, Exponents};
#[cfg(feature = "studies")]
use crate::studies::rival::{self, Ended};
#[cfg(feature = "studies")]
use core::cell::Cell;
use std::sync::Arc;
#[cfg(feature = "studies")]
use vi_core::Called;
#[cfg(feature = "studies")]
use vi_core::check::Trajectory;
#[cfg(feature = "derivatives")]
use vi_core::constrained::Independent;
use vi_core::constrained::{Extended, Projected};
#[cfg(feature = "derivatives")]
use vi_core::control::Dynamics as _;
#[cfg(feature = "studies")]
use vi_core::gauss::step_density;
#[cfg(feature = "studies")]
use vi_core::kind::Kind;
use vi_core::lagrangian::{Described, Space};
use vi_core::{Lagrangian as _, SVector, State, StepError};

/// A function of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// L(t, q, v).
    Lagrangian,
    /// `v·∂L/∂v − L` at (t, q, v).
    Energy,
    /// `v·∂L/∂v − L` at (t, q, p).
    Hamiltonian,
    /// g of the time scale at (t, q, v); no number without the clause `time_scale`.
    TimeScale,
    /// `∂L/∂v` at (t, q, v).
    Momentum,
    /// The generalized force at (t, q, v).
    Force,
    /// The acceleration at (t, q, v), which has to satisfy the constraints.
    Acceleration,
    /// The acceleration at any (t, q, v), for solvers whose stages leave the constraints.
    ExtendedAcceleration,
    /// The velocity at (t, q, p).
    Velocity,
    /// The multiplier Λ of each constraint at (t, q, p).
    Reaction,
    /// The generalized force `AᵀΛ` of all constraints at (t, q, p).
    ReactionForce,
    /// g of each constraint at (t, q, v), zero for nonholonomic ones, then `A v + a` of each.
    Residuals,
}

impl Quantity {
    /// Whether it has one number for each coordinate.
    pub(crate) fn has_coordinates(self) -> bool {
        use Quantity::{Acceleration, ExtendedAcceleration, Force, Momentum, ReactionForce, Velocity};
        matches!(self, Momentum | Force | Acceleration | ExtendedAcceleration | Velocity | ReactionForce)
    }
}

/// A point on the constraints, and how far it is from the given one.
#[derive(Clone, Debug, PartialEq)]
pub struct OnConstraints {
    /// The point.
    pub point: PhasePoint,
    /// Changes of the coordinates.
    pub moved_q: Vec<f64>,
    /// Changes of the velocities.
    pub moved_v: Vec<f64>,
}

/// A system with its parameters.
pub trait System: Send + Sync {
    /// Name of the type.
    fn name(&self) -> &'static str;
    /// Documentation of the declaration.
    fn about(&self) -> &'static str;
    /// The text of the declaration, as tokens.
    fn definition(&self) -> &'static str;
    /// Names of the coordinates.
    fn coordinates(&self) -> Vec<&'static str>;
    /// What each coordinate is.
    fn spaces(&self) -> Vec<Space>;
    /// Names of the constraints, holonomic ones first; none for a system without.
    fn constraints(&self) -> &'static [&'static str];
    /// Names and values of the parameters.
    fn parameters(&self) -> Vec<(&'static str, f64)>;
    /// Documentation of each parameter.
    fn parameters_about(&self) -> &'static [&'static str];
    /// Sets a parameter; false if there is none with this name.
    fn set(&mut self, name: &str, value: f64) -> bool;
    /// A system of the same type with the same parameters.
    fn copy(&self) -> Box<dyn System>;
    /// The integrators that are built for it.
    fn integrators(&self) -> Vec<Built>;
    /// Whether it has an integrator.
    ///
    /// # Errors
    /// Why it does not: [`StepError::HasConstraints`] for one that does not keep its constraints,
    /// [`StepError::NoTimeScale`], [`StepError::NotSeparable`], [`StepError::NoRule`], and [`StepError::InvalidInput`] for
    /// stages that are not built, [`StepError::FirstOrder`] for one that needs a mass matrix.
    fn offers(&self, wanted: Built) -> Result<(), StepError>;
    /// Whether L is linear in the velocities: coordinates alone are a state, and momenta follow from them.
    fn is_first_order(&self) -> bool {
        matches!(self.offers((Method::Energy, None, false)), Err(StepError::FirstOrder { .. }))
    }
    /// Whether the energy of a motion is constant: L and f are autonomous, and there is no force.
    fn conserves_energy(&self) -> bool;
    /// A function at as many points as there are times; `q` and `v`, or momenta, have N numbers for each. Appends to
    /// `out`, N numbers for each point if the function is a vector; for constraints see [`Quantity`].
    ///
    /// # Errors
    /// [`StepError::Singular`], [`StepError::NotConverged`] or [`StepError::NonFinite`] of the first point without a
    /// value; [`StepError::InconsistentStart`] of the first point off the constraints without an acceleration.
    fn evaluate(&self, of: Quantity, points: [&[f64]; 3], out: &mut Vec<f64>) -> Result<(), StepError>;
    /// The point on the constraints that is nearest to a point, as [`State::projected`]. Without constraints it is the
    /// same point.
    ///
    /// # Errors
    /// As [`State::projected`]; [`StepError::InvalidInput`] for a point with another number of coordinates.
    fn project(&self, at: &PhasePoint) -> Result<OnConstraints, StepError>;
    /// A point on the constraints from one that may be far from them, as [`State::assembled`]. Without constraints it is
    /// the same point.
    ///
    /// # Errors
    /// As [`State::assembled`]; [`StepError::InvalidInput`] for a point with another number of coordinates.
    #[cfg(feature = "derivatives")]
    fn assemble(&self, at: &PhasePoint) -> Result<OnConstraints, StepError>;
    /// Names of the constraints that follow from the others at coordinates which satisfy all, as [`Independent::at`] drops
    /// them.
    ///
    /// # Errors
    /// As [`Independent::at`]; [`StepError::InvalidInput`] for another number of coordinates.
    #[cfg(feature = "derivatives")]
    fn redundant(&self, t: f64, q: &[f64]) -> Result<Vec<&'static str>, StepError>;
    /// The same system without constraints of these names, which follow from the others: they have no reaction, and every
    /// step checks them. `None` for a name of no constraint, and for a compiled system, whose type keeps all.
    fn without(&self, constraints: &[&str]) -> Option<Box<dyn System>>;
    /// The quantities that a controller needs.
    #[cfg(feature = "derivatives")]
    fn control(&self) -> &dyn Control;
    /// The quantities with which studies compare runs.
    #[cfg(feature = "studies")]
    fn studies(&self) -> &dyn Studies;
    /// Starts a run.
    ///
    /// # Errors
    /// The error of the integrators for the initial state, and those of [`System::offers`]. [`StepError::InvalidInput`]
    /// for wrong numbers of coordinates or velocities, [`StepError::RuleTooLarge`] for the rule of a text.
    fn begin(&self, plan: &Plan) -> Result<Box<dyn Simulation>, StepError> {
        self.begin_while(plan, &mut || true)
    }
    /// As [`System::begin`], but a measurement of a shift asks `goes_on` before each step. Once it is false, the
    /// measurement ends with [`StepError::InvalidInput`].
    ///
    /// # Errors
    /// As [`System::begin`].
    fn begin_while(&self, plan: &Plan, goes_on: &mut dyn FnMut() -> bool) -> Result<Box<dyn Simulation>, StepError>;
    /// The run of an integrator as [`Session::checkpoint`](crate::Session::checkpoint) stored it.
    ///
    /// # Errors
    /// Why it cannot be read.
    #[cfg(feature = "checkpoints")]
    fn restart(&self, built: Built, stored: &str) -> Result<Box<dyn Simulation>, String>;
}

impl dyn System + '_ {
    /// Whether an integrator of this method is built.
    #[must_use]
    pub fn has(&self, method: Method) -> bool {
        self.integrators().iter().any(|(built, ..)| *built == method)
    }

    /// Whether the system has constraints.
    #[must_use]
    pub fn has_constraints(&self) -> bool {
        !self.constraints().is_empty()
    }

    /// Whether the system has a rule, and with it fixed and energy-preserving steps of order 2.
    #[must_use]
    pub fn has_rule(&self) -> bool {
        self.has(Method::Fixed)
    }

    /// A system of the same type with these values of its parameters, in their order.
    #[must_use]
    pub fn with_parameters(&self, values: &[f64]) -> Box<dyn System> {
        let mut system = self.copy();
        for ((name, _), value) in self.parameters().into_iter().zip(values) {
            system.set(name, *value);
        }
        system
    }

    /// The default method of the system.
    #[must_use]
    pub fn usual_method(&self) -> Method {
        if self.has_rule() { Method::Fixed } else { Method::Gauss }
    }

    /// H at a point.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a point with another number of coordinates, here and below.
    pub fn energy(&self, at: &PhasePoint) -> Result<f64, StepError> {
        Ok(self.values(Quantity::Energy, at)?[0])
    }

    /// g of the time scale at a point; `None` without a time scale, or for another number of coordinates.
    #[must_use]
    pub fn time_scale(&self, at: &PhasePoint) -> Option<f64> {
        self.values(Quantity::TimeScale, at).ok()?.first().copied()
    }

    /// Momenta ∂L/∂v at a point.
    ///
    /// # Errors
    /// As `energy`.
    pub fn momentum(&self, at: &PhasePoint) -> Result<Vec<f64>, StepError> {
        self.values(Quantity::Momentum, at)
    }

    fn values(&self, of: Quantity, at: &PhasePoint) -> Result<Vec<f64>, StepError> {
        let PhasePoint { t, q, v } = at;
        let n = self.coordinates().len();
        for (values, input) in [(q, "number of coordinates"), (v, "number of velocities")] {
            if values.len() != n {
                return Err(wrong_size(values, input));
            }
        }
        let mut out = Vec::new();
        self.evaluate(of, [core::slice::from_ref(t), q, v], &mut out)?;
        Ok(out)
    }
}

/// A system of a known type.
#[derive(Clone)]
pub struct Typed<S, const N: usize> {
    /// The system.
    pub system: S,
    pub(crate) integrators: Arc<[Integrator<S, N>]>,
}

impl<S: Runnable<N> + Described + Default, const N: usize> Typed<S, N> {
    /// The system with its default parameters.
    #[must_use]
    pub fn new(integrators: Vec<Integrator<S, N>>) -> Self {
        Self::of(S::default(), integrators)
    }
}

impl<S: Runnable<N>, const N: usize> Typed<S, N> {
    /// A system with its parameters.
    #[must_use]
    pub fn of(system: S, integrators: Vec<Integrator<S, N>>) -> Self {
        Self { system, integrators: integrators.into() }
    }
}

/// The system with its default parameters, type-erased.
#[must_use]
pub fn erased<S, const N: usize>(integrators: Vec<Integrator<S, N>>) -> Box<dyn System>
where
    S: Runnable<N> + Described + Default,
{
    Box::new(Typed::new(integrators))
}

impl<S: Runnable<N> + Described, const N: usize> Typed<S, N> {
    /// An integrator.
    ///
    /// # Errors
    /// As [`System::offers`].
    fn integrator(&self, wanted: Built) -> Result<&Integrator<S, N>, StepError> {
        let found = self.integrators.iter().find(|integrator| integrator.built == wanted);
        let has_method = self.integrators.iter().any(|integrator| integrator.built.0 == wanted.0);
        let unbuilt = |input, value| StepError::InvalidInput { input, allowed: "one that is built", value };
        found.ok_or(match (wanted, wanted.0.splitting()) {
            (_, Some(splitting)) if self.system.splits() => unbuilt("order of a splitting", f64::from(splitting.order)),
            ((method, ..), _) if self.system.is_first_order() && (method != Method::Gauss || !has_method) => {
                StepError::FirstOrder { system: self.system.name() }
            }
            // Methods that keep constraints have stages.
            ((_, stages, _), _) if !self.system.constraint_names().is_empty() && (!has_method || stages.is_none()) => {
                StepError::HasConstraints { system: self.system.name() }
            }
            ((.., true), _) if !self.system.scales_time() => StepError::NoTimeScale { system: self.system.name() },
            (_, Some(_)) => StepError::NotSeparable { system: self.system.name() },
            #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
            ((_, Some(stages), _), None) => unbuilt("number of stages", stages as f64),
            // Every system has Gauss steps of some stages; methods without stages need a rule.
            ((_, None, _), None) => StepError::NoRule { system: self.system.name() },
        })
    }
}

/// A function that moves a point of a system onto its constraints.
type Mover<S, const N: usize> = fn(&S, f64, SVector<f64, N>, SVector<f64, N>) -> Result<Projected<N>, StepError>;

impl<S: Runnable<N>, const N: usize> Typed<S, N> {
    /// A point that `mover` has moved onto the constraints.
    fn moved(&self, at: &PhasePoint, mover: Mover<S, N>) -> Result<OnConstraints, StepError> {
        let PhasePoint { t, q, v } = at;
        let (q, v) = (vector(q, "number of coordinates")?, vector(v, "number of velocities")?);
        let Projected { state, moved_q, moved_v, .. } = mover(&self.system, *t, q, v)?;
        // The velocity itself: that of the momenta has a further rounding.
        let [q, v, moved_q, moved_v] = [state.q, v + moved_v, moved_q, moved_v].map(|of| of.as_slice().to_vec());
        Ok(OnConstraints { point: PhasePoint { t: *t, q, v }, moved_q, moved_v })
    }
}

impl<S: Runnable<N> + Described, const N: usize> System for Typed<S, N> {
    fn name(&self) -> &'static str {
        self.system.name()
    }

    fn about(&self) -> &'static str {
        self.system.about()
    }

    fn definition(&self) -> &'static str {
        self.system.definition()
    }

    fn coordinates(&self) -> Vec<&'static str> {
        self.system.coordinates().to_vec()
    }

    fn spaces(&self) -> Vec<Space> {
        self.system.spaces().to_vec()
    }

    fn constraints(&self) -> &'static [&'static str] {
        self.system.constraint_names()
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        let system = &self.system;
        system.parameters().iter().enumerate().map(|(index, name)| (*name, system.parameter(index))).collect()
    }

    fn parameters_about(&self) -> &'static [&'static str] {
        self.system.parameters_about()
    }

    fn set(&mut self, name: &str, value: f64) -> bool {
        self.system.parameter_mut(name).map(|parameter| *parameter = value).is_some()
    }

    fn copy(&self) -> Box<dyn System> {
        Box::new(self.clone())
    }

    fn integrators(&self) -> Vec<Built> {
        self.integrators.iter().map(|of| of.built).collect()
    }

    fn offers(&self, wanted: Built) -> Result<(), StepError> {
        self.integrator(wanted).map(drop)
    }

    fn conserves_energy(&self) -> bool {
        self.system.conserves_energy()
    }

    fn evaluate(&self, of: Quantity, [t, q, v]: [&[f64]; 3], out: &mut Vec<f64>) -> Result<(), StepError> {
        let system = &self.system;
        for ((&t, q), v) in t.iter().zip(q.chunks_exact(N)).zip(v.chunks_exact(N)) {
            let (q, v) = (SVector::<f64, N>::from_column_slice(q), SVector::<f64, N>::from_column_slice(v));
            let number = match of {
                Quantity::Lagrangian => system.lagrangian(t, &q, &v),
                Quantity::Energy => system.energy(t, &q, &v),
                Quantity::Hamiltonian => State { t, q, p: v }.energy(system)?,
                Quantity::TimeScale if system.scales_time() => system.scaled_point(t, &q, &v).g,
                Quantity::TimeScale => continue,
                Quantity::Reaction => {
                    out.extend_from_slice(State { t, q, p: v }.reaction(system)?.as_ref());
                    continue;
                }
                Quantity::Residuals => {
                    constraint_residuals(system, (t, &q, &v), out);
                    continue;
                }
                _ => {
                    let vector = match of {
                        Quantity::ReactionForce => State { t, q, p: v }.reaction_force(system)?,
                        Quantity::Momentum => system.momentum(t, &q, &v),
                        Quantity::Force => system.force(t, &q, &v),
                        Quantity::Acceleration => system.acceleration(t, &q, &v)?,
                        Quantity::ExtendedAcceleration => Extended(*system).acceleration(t, &q, &v)?,
                        _ => system.flow(t, &q, &v)?.v,
                    };
                    out.extend_from_slice(vector.as_slice());
                    continue;
                }
            };
            out.push(number);
        }
        Ok(())
    }

    fn project(&self, at: &PhasePoint) -> Result<OnConstraints, StepError> {
        self.moved(at, State::projected)
    }

    #[cfg(feature = "derivatives")]
    fn assemble(&self, at: &PhasePoint) -> Result<OnConstraints, StepError> {
        self.moved(at, State::assembled)
    }

    #[cfg(feature = "derivatives")]
    fn redundant(&self, t: f64, q: &[f64]) -> Result<Vec<&'static str>, StepError> {
        let q = vector::<N>(q, "number of coordinates")?;
        if self.system.constraint_names().is_empty() {
            return Ok(Vec::new());
        }
        Ok(Independent::at(self.system, t, q)?.dropped_names().collect())
    }

    fn without(&self, constraints: &[&str]) -> Option<Box<dyn System>> {
        let names = self.system.constraint_names();
        let index = |name: &&str| names.iter().position(|known| known == name);
        let dropped = constraints.iter().map(index).collect::<Option<Vec<_>>>()?;
        Some(Box::new(Self { system: self.system.without(&dropped)?, ..self.clone() }))
    }

    #[cfg(feature = "derivatives")]
    fn control(&self) -> &dyn Control {
        self
    }

    #[cfg(feature = "studies")]
    fn studies(&self) -> &dyn Studies {
        self
    }

    fn begin_while(&self, plan: &Plan, goes_on: &mut dyn FnMut() -> bool) -> Result<Box<dyn Simulation>, StepError> {
        let q = vector(&plan.q, "number of coordinates")?;
        let state = match &plan.p {
            Some(p) => State { t: plan.t, q, p: vector(p, "number of momenta")? },
            None => State::at(&self.system, plan.t, q, vector::<N>(&plan.v, "number of velocities")?),
        };
        let wanted = plan.wanted(!self.system.constraint_names().is_empty());
        let integrator = self.integrator(wanted)?;
        // A text derives its rule when a run needs it.
        let is_by_rule = wanted.1.is_none() && wanted.0.splitting().is_none();
        if is_by_rule && self.system.has_too_large_rule() {
            return Err(StepError::RuleTooLarge { system: self.system.name() });
        }
        (integrator.begin)(self.system, plan, state, goes_on)
    }

    #[cfg(feature = "checkpoints")]
    fn restart(&self, built: Built, stored: &str) -> Result<Box<dyn Simulation>, String> {
        let integrator = self.integrator(built).map_err(|error| error.to_string())?;
        (integrator.restart)(self.system, stored)
    }
}

#[cfg(feature = "derivatives")]
impl<S: Runnable<N> + Described, const N: usize> Control for Typed<S, N> {
    fn inputs(&self) -> &'static [usize] {
        self.system.inputs()
    }

    fn mass_matrix(&self, points: [&[f64]; 3], out: &mut Vec<f64>) {
        for (t, q, v) in each::<N>(points) {
            out.extend_from_slice(self.system.mass_matrix(t, q, v).transpose().as_slice());
        }
    }

    fn bias(&self, points: [&[f64]; 3], out: &mut Vec<f64>) {
        for (t, q, v) in each::<N>(points) {
            out.extend_from_slice(self.system.bias(t, q, v).as_slice());
        }
    }

    fn linearization(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Linear, StepError> {
        let (q, v) = (vector::<N>(q, "number of coordinates")?, vector::<N>(v, "number of velocities")?);
        self.system.linearization(t, q, v).map(Linear::from)
    }

    fn equilibrium(&self, t: f64, guess: &[f64]) -> Result<Rest, StepError> {
        Rest::of(&self.system.equilibrium(t, vector::<N>(guess, "number of coordinates")?)?)
    }
}

/// The points (t, q, v) of flat columns.
#[cfg(feature = "derivatives")]
fn each<const N: usize>([t, q, v]: [&[f64]; 3]) -> impl Iterator<Item = (f64, SVector<f64, N>, SVector<f64, N>)> {
    let of = SVector::<f64, N>::from_column_slice;
    t.iter().zip(q.chunks_exact(N)).zip(v.chunks_exact(N)).map(move |((t, q), v)| (*t, of(q), of(v)))
}

#[cfg(feature = "studies")]
impl<S: Runnable<N>, const N: usize> Typed<S, N> {
    /// The start of a motion. If L is linear in the velocities, they are those of the coordinates.
    fn started(&self, from: &PhasePoint) -> Result<Trajectory<N>, StepError> {
        let Trajectory { t, q, v } = sized(from)?;
        let v = if self.system.is_first_order() { self.system.flow(t, &q, &SVector::zeros())?.v } else { v };
        Ok(Trajectory { t, q, v })
    }
}

#[cfg(feature = "studies")]
impl<S: Runnable<N> + Described, const N: usize> Studies for Typed<S, N> {
    fn step_density(&self, at: &PhasePoint) -> Option<f64> {
        let Trajectory { t, q, v } = sized(at).ok()?;
        let energy = self.integrators.iter().find(|of| of.built == (Method::Energy, None, false))?;
        energy.density.and_then(|density| density(&self.system, t, &q, &v)).filter(|density| density.is_finite())
    }

    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        let none = [None; ENERGY_STAGES.len()];
        if const { S::Kind::COUNT > 0 } {
            return none;
        }
        let state =
            vector(q, "number of coordinates").and_then(|q| Ok(State { t, q, p: vector(p, "number of momenta")? }));
        let Ok(state) = state else { return none };
        let system = Called(self.system);
        [
            step_density::<_, N, { ENERGY_STAGES[0] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[1] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[2] }>(&system, &state).ok(),
        ]
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        self.started(from)?.at(&Extended(self.system), end).map(erased_point)
    }

    fn lyapunov(&self, plan: &Plan, count: usize, coordinates: usize) -> Result<Box<dyn Exponents>, StepError> {
        exponents::begin(self.system, plan, (count, coordinates))
    }

    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        mut watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended> {
        let system = Extended(self.system);
        let mut show = |motion: &Trajectory<N>| {
            if let Some(watch) = &mut watch {
                watch(motion.t, system.energy(motion.t, &motion.q, &motion.v));
            }
        };
        rival::motion(system, &self.started(from)?, end, tolerance, evaluations, &mut show).map(erased_point)
    }
}

/// A point with the system's number of coordinates.
#[cfg(feature = "studies")]
fn sized<const N: usize>(point: &PhasePoint) -> Result<Trajectory<N>, StepError> {
    let q: SVector<f64, N> = vector(&point.q, "number of coordinates")?;
    let v = vector(&point.v, "number of velocities")?;
    Ok(Trajectory { t: point.t, q, v })
}

/// A type-erased point.
#[cfg(feature = "studies")]
fn erased_point<const N: usize>(motion: Trajectory<N>) -> PhasePoint {
    PhasePoint { t: motion.t, q: motion.q.as_slice().to_vec(), v: motion.v.as_slice().to_vec() }
}
