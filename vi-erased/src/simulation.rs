//! One type-erased run of any system.
//!
//! In: a run of known types. Out: a [`Simulation`], whose rows are the nodes of the integrator, starting with its first
//! node. The numbers are those of the generic integrators, to the last bit, and loops over steps are inside, without
//! virtual calls.

use crate::method::{AnyMethod, GoesOn, Progress};
use crate::section::Section;
#[cfg(feature = "sessions")]
use crate::session::Session;
use std::borrow::Cow;
#[cfg(feature = "derivatives")]
/// A method, with derivatives if the feature asks for them.
pub use vi_core::derivatives::Differentiable as Derived;
use vi_core::kind::Kind;
use vi_core::lagrangian::Parameters;
use vi_core::linear::Rectangular as _;
use vi_core::method::Storable;
#[cfg(feature = "derivatives")]
use vi_core::node::Node;
use vi_core::run::{Crossing, ErrorEstimate, ErrorMonitor};
use vi_core::stepping::Convertible;
use vi_core::support::has_angles;
use vi_core::{Method, Run, SVector, State, StepError};

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
    /// E', the energy that steps with a shift keep; `None` for other methods, whose rows have no such column.
    pub shifted_energy: Option<f64>,
    /// The constraints at the node; `None` for systems without, whose rows have no such columns.
    pub constraints: Option<AtConstraints>,
    /// Length of the step; in the first row the requested length.
    pub h: f64,
}

/// The constraints of a system at a node.
#[derive(Clone, Debug, PartialEq)]
pub struct AtConstraints {
    /// The multiplier Λ of each; `None` if the state has none.
    pub reactions: Vec<Option<f64>>,
    /// The largest of `|g|` and `|A v + a|`; `None` if the momenta have no velocity.
    pub residual: Option<f64>,
}

impl Row {
    /// The names of the columns for these coordinates and constraints, with or without a shift.
    #[must_use]
    pub fn columns(coordinates: &[&str], constraints: &[&str], is_shifted: bool) -> Vec<String> {
        let q = coordinates.iter().map(|&name| name.to_owned());
        let p = coordinates.iter().map(|name| format!("p_{name}"));
        let reactions = constraints.iter().map(|name| format!("Λ_{name}"));
        let residual = (!constraints.is_empty()).then(|| "residual".to_owned());
        let last: &[&str] = if is_shifted { &["H", "E", "E'", "h"] } else { &["H", "E", "h"] };
        let last = last.iter().map(|&name| name.to_owned());
        ["t".to_owned()].into_iter().chain(q).chain(p).chain(reactions).chain(residual).chain(last).collect()
    }

    /// The entries in the order of the columns.
    pub fn entries(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        let numbers = core::iter::once(&self.t).chain(&self.q).chain(&self.p).copied().map(Some);
        let constraints = self.constraints.iter().flat_map(|of| of.reactions.iter().copied().chain([of.residual]));
        let energies = [self.energy, self.discrete_energy];
        numbers.chain(constraints).chain(energies).chain(self.shifted_energy.map(Some)).chain([Some(self.h)])
    }
}

/// Events of one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Met {
    /// The state there, with the length of the step to it.
    pub row: Row,
    /// Index of each section, and whether its function rises.
    pub events: Vec<(usize, bool)>,
}

/// The nodes of a run, one after the other.
pub trait Steps {
    /// Time of the last node.
    fn t(&self) -> f64;
    /// Coordinates of the last node.
    fn q(&self) -> Cow<'_, [f64]>;
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
    /// E', which steps with a shift keep, and that shift; `None` for other methods.
    fn shifted_energy(&self) -> Option<ShiftedEnergy> {
        None
    }
    /// The constraints at the last node; `None` for systems without.
    fn constraints(&self) -> Option<AtConstraints> {
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
    /// Measures errors of the steps from here on. It costs a few per cent of their time and changes no bit of them.
    fn monitor(&mut self) {}
    /// The largest error of a step since [`Steps::monitor`], relative to the scale of its motion; `None` if no step
    /// was measured.
    fn largest_error(&self) -> Option<ErrorEstimate> {
        None
    }
}

/// A run is nothing more without the feature.
#[cfg(not(feature = "sessions"))]
pub trait Session {}
#[cfg(not(feature = "sessions"))]
impl<T> Session for T {}

/// A started run.
pub trait Simulation: Steps + Session + Send + Sync {
    /// Evaluations of the equations by the steps so far, from their iterations.
    fn evaluations(&self) -> u64;
    /// Takes steps until a node at `end` or later, at most `most`; returns their number.
    ///
    /// # Errors
    /// The error of the failed step.
    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError>;
    /// Advances to the time `end`, and passes each crossing of a section to `take`, in order. A crossing is located by
    /// a step of the exact length h, and has no discrete energy. It ends early where `take` returns false.
    ///
    /// # Errors
    /// The error of the failed step.
    fn cross(&mut self, sections: &[Section], end: f64, take: &mut dyn FnMut(Met) -> bool) -> Result<(), StepError>;
    /// Time and H at which H is most accurate: at the node; for energy-preserving steps at the midpoint of the last
    /// one, since H deviates by h²D/8 at their nodes.
    ///
    /// # Errors
    /// As [`Steps::energy`].
    fn sampled_energy(&self) -> Result<(f64, f64), StepError>;
}

impl dyn Steps + '_ {
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
            constraints: self.constraints(),
            h: self.h(),
        }
    }
}

impl dyn Simulation + '_ {
    /// The last node with its energies.
    #[must_use]
    pub fn row(&self) -> Row {
        let steps: &dyn Steps = self;
        steps.row()
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// The error of the failed step.
    pub fn advance_by(&mut self, steps: u64) -> Result<(), StepError> {
        self.advance_until(f64::INFINITY, steps).map(drop)
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

/// A vector of the system's size.
///
/// # Errors
/// [`StepError::InvalidInput`] for another number of values.
pub fn vector<const N: usize>(values: &[f64], input: &'static str) -> Result<SVector<f64, N>, StepError> {
    if values.len() == N { Ok(SVector::from_column_slice(values)) } else { Err(wrong_size(values, input)) }
}

/// The error for another number of values than that of the system.
pub(crate) fn wrong_size(values: &[f64], input: &'static str) -> StepError {
    #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
    let value = values.len() as f64;
    StepError::InvalidInput { input, allowed: "that of the system", value }
}

/// A method whose runs are erased: what its rows and its evaluations are.
pub trait Erasable<S: Runnable<N>, const N: usize>: Derived<S, N, Memory: Storable> + 'static {
    /// Evaluations of the equations in a step with these iterations.
    fn evaluations(&self, iterations: u32) -> u64;

    /// Time and H at which H is most accurate.
    ///
    /// # Errors
    /// The momenta have no velocity.
    fn sampled_energy(run: &Run<Self, S, N>) -> Result<(f64, f64), StepError> {
        Ok((run.t(), run.energy()?))
    }

    /// The conserved quantity of steps with a shift.
    fn shifted_energy(_run: &Run<Self, S, N>) -> Option<ShiftedEnergy> {
        None
    }
}

/// A method, with derivatives if the feature asks for them.
#[cfg(not(feature = "derivatives"))]
pub use vi_core::Method as Derived;

/// The constraints at a state; `None` for systems without.
fn at_constraints<S: Runnable<N>, const N: usize>(system: &S, state: &State<N>) -> Option<AtConstraints> {
    if const { S::Kind::COUNT == 0 } {
        return None;
    }
    let reactions = match state.reaction(system) {
        Ok(reactions) => reactions.as_ref().iter().copied().map(Some).collect(),
        Err(_) => vec![None; S::CONSTRAINTS.len()],
    };
    let residual = state.velocity(system).ok().map(|v| {
        let mut residuals = Vec::new();
        constraint_residuals(system, (state.t, &state.q, &v), &mut residuals);
        largest(&residuals)
    });
    Some(AtConstraints { reactions, residual })
}

/// Appends g of each constraint at a point, zero for nonholonomic ones; then `A v + a` of each.
pub(crate) fn constraint_residuals<S: Runnable<N>, const N: usize>(
    system: &S,
    (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>),
    out: &mut Vec<f64>,
) {
    out.extend_from_slice(system.constraints(t, q).as_ref());
    let (gradients, offsets) = system.constraint_gradients(t, q);
    out.extend(gradients.rows().zip(offsets.as_ref()).map(|(gradient, offset)| gradient.dot(v) + offset));
}

/// The largest of the absolute values; NaN if one is NaN.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| if value.is_nan() || value.abs() > most { value.abs() } else { most })
}

/// A system whose runs are erased: every generated one.
pub trait Runnable<const N: usize>: Convertible<N> + Parameters + Send + Sync + 'static {}
impl<S: Convertible<N> + Parameters + Send + Sync + 'static, const N: usize> Runnable<N> for S {}

/// A run with a method, and the data for its rows.
#[derive(Clone)]
pub(crate) struct Simulated<S: Runnable<N>, const N: usize> {
    pub(crate) run: Run<AnyMethod<S, N>, S, N>,
    evaluations: u64,
    /// The node where the run began, until its state or its parameters change: the energy that it keeps follows from it.
    #[cfg(feature = "derivatives")]
    pub(crate) start: Option<Node<N>>,
    /// Whether rows have E', even for a shift of zero.
    is_shifted: bool,
    /// Length of the last step, if it was shortened.
    pub(crate) shortened: Option<f64>,
    pub(crate) monitor: Option<Box<ErrorMonitor<AnyMethod<S, N>, S, N>>>,
}

/// Relative deviation below which a length counts as the step of the run.
const ROUNDED: f64 = 1e-9;

/// The same run, type-erased, with E' in its rows if `is_shifted`.
pub(crate) fn erased<S: Runnable<N>, const N: usize>(
    run: Run<AnyMethod<S, N>, S, N>,
    is_shifted: bool,
) -> Box<dyn Simulation> {
    Box::new(Simulated {
        #[cfg(feature = "derivatives")]
        start: (run.iterations() == 0).then(|| *run.node()),
        run,
        evaluations: 0,
        is_shifted,
        shortened: None,
        monitor: None,
    })
}

impl<S: Runnable<N>, const N: usize> Simulated<S, N> {
    /// Takes notice of the last step.
    pub(crate) fn count(&mut self) {
        self.evaluations += self.run.method().evaluations(self.run.iterations());
        if let Some(monitor) = &mut self.monitor {
            monitor.watch(&self.run);
        }
    }

    /// Takes steps while `goes_on`, which gets the run before each step. The loop is compiled for each method.
    pub(crate) fn advance_while(&mut self, goes_on: GoesOn<'_, N>) -> Result<(), StepError> {
        self.shortened = None;
        if self.monitor.is_some() {
            while goes_on(&self.run) {
                self.run.single_step()?;
                self.count();
            }
            return Ok(());
        }
        AnyMethod::advance_while(&mut self.run, &mut self.evaluations, goes_on)
    }

    /// Forgets a jump of the run.
    pub(crate) fn resume(&mut self) {
        self.shortened = None;
        if let Some(monitor) = &mut self.monitor {
            monitor.resume(&self.run);
        }
    }
}

/// A crossing of a run of the system, type-erased.
pub(crate) fn met<S: Runnable<N>, const N: usize>(system: &S, crossing: &Crossing<N>) -> Met {
    let Crossing { events, state, length, .. } = crossing;
    let row = Row {
        t: state.t,
        q: state.q.as_slice().to_vec(),
        p: state.p.as_slice().to_vec(),
        energy: state.energy(system).ok(),
        discrete_energy: None,
        shifted_energy: None,
        constraints: at_constraints(system, state),
        h: *length,
    };
    Met { row, events: events.iter().map(|met| (met.event, met.is_rising)).collect() }
}

impl<S: Runnable<N>, const N: usize> Steps for Simulated<S, N> {
    fn t(&self) -> f64 {
        self.run.t()
    }

    fn q(&self) -> Cow<'_, [f64]> {
        // Only angles differ from their node.
        if const { has_angles::<S, N, f64>() } {
            self.run.state().q.as_slice().to_vec().into()
        } else {
            self.run.node().q.as_slice().into()
        }
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
        AnyMethod::shifted_energy(&self.run).filter(|of| self.is_shifted || of.shift != 0.0)
    }

    fn constraints(&self) -> Option<AtConstraints> {
        at_constraints(self.run.system(), &self.run.node().state())
    }

    fn advance(&mut self) -> Result<(), StepError> {
        self.run.single_step()?;
        self.shortened = None;
        self.count();
        Ok(())
    }

    fn advance_to(&mut self, end: f64) -> Result<(), StepError> {
        let (left, h) = (self.run.time_to(end), self.run.h());
        let rounding = (f64::EPSILON * end.abs()).min(ROUNDED * h.abs());
        let is_beyond = |left: f64| left * h.signum() < -rounding;
        if is_beyond(left - self.run.longest()) {
            // Steps that solve for their length must be taken to know it.
            let ahead = if self.run.method().finds_length() { Some(self.run.after_a_step()?) } else { None };
            let Some(ahead) = ahead.filter(|ahead| !is_beyond(ahead.time_to(end))) else {
                self.run.end_at(end)?;
                self.shortened = Some(left);
                self.count();
                return Ok(());
            };
            self.run = ahead;
            self.count();
        } else {
            self.advance()?;
        }
        if self.run.time_to(end).abs() <= rounding {
            self.run.set_time(end);
        }
        Ok(())
    }

    fn monitor(&mut self) {
        self.monitor = Some(Box::new(ErrorMonitor::new(&self.run)));
    }

    fn largest_error(&self) -> Option<ErrorEstimate> {
        let monitor = self.monitor.as_ref()?;
        let found = monitor.largest(&self.run);
        (found.estimate > 0.0 || monitor.measurements() > 0).then_some(found)
    }
}

impl<S: Runnable<N>, const N: usize> Simulation for Simulated<S, N> {
    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        let mut taken = 0;
        let mut goes_on = |run: &dyn Progress<N>| {
            let goes_on = taken < most && run.t() < end;
            taken += u64::from(goes_on);
            goes_on
        };
        self.advance_while(&mut goes_on)?;
        Ok(taken)
    }

    fn cross(&mut self, sections: &[Section], end: f64, take: &mut dyn FnMut(Met) -> bool) -> Result<(), StepError> {
        let system = *self.run.system();
        let events: Vec<_> = sections.iter().map(Section::event).collect();
        let mut outcome = Ok(());
        AnyMethod::events(&mut self.run, &events, end, &mut |crossings| {
            for crossing in crossings {
                match crossing {
                    Ok(crossing) if take(met(&system, &crossing)) => {}
                    Ok(_) => break,
                    Err(error) => outcome = Err(error),
                }
            }
        });
        self.resume();
        outcome
    }

    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        AnyMethod::sampled_energy(&self.run)
    }
}
