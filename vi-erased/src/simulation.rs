//! A started run, type-erased.
//!
//! Its rows are the nodes of the integrator, starting with its first node: [`Steps`]. With the feature `sessions` a
//! program changes its parameters and its state, records its nodes and computes its derivatives: [`Session`]. The
//! command does not need this trait, which is a fifth of the machine code of a run.

#[cfg(feature = "derivatives")]
use crate::control::Linear;
use crate::section::Section;
use std::borrow::Cow;
#[cfg(feature = "sessions")]
use vi_core::State;
use vi_core::run::ErrorEstimate;
use vi_core::{SVector, StepError};

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

/// Nodes of a run, in flat columns.
#[cfg(feature = "sessions")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Times.
    pub t: Vec<f64>,
    /// Coordinates, node after node.
    pub q: Vec<f64>,
    /// Momenta, node after node.
    pub p: Vec<f64>,
}

#[cfg(feature = "sessions")]
impl Rows {
    /// Adds a node: its time, coordinates and momenta.
    pub fn push(&mut self, t: f64, q: &[f64], p: &[f64]) {
        self.t.push(t);
        self.q.extend_from_slice(q);
        self.p.extend_from_slice(p);
    }

    pub(crate) fn push_state<const N: usize>(&mut self, state: &State<N>) {
        self.push(state.t, state.q.as_slice(), state.p.as_slice());
    }
}

/// The motion within one step.
#[cfg(feature = "sessions")]
pub trait StepOutput: Send + Sync {
    /// Coordinates, momenta and velocities at the time `t`, one after the other.
    fn at(&self, t: f64) -> [Vec<f64>; 3];
}

/// The end of the steps that are differentiated.
#[cfg(feature = "derivatives")]
#[derive(Clone, Copy, Debug)]
pub enum End<'a> {
    /// After this number of steps.
    Steps(u64),
    /// At this time, which does not vary.
    Time(f64),
    /// At the first crossing of a section, which is at this time.
    Crossing(&'a Section, f64),
}

/// The derivatives that are wanted of a run.
#[cfg(feature = "derivatives")]
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The end of the steps.
    pub end: End<'a>,
    /// Indices of parameters that vary. The number of parameters is the index of the step length, the next number that of
    /// the time at the start.
    pub parameters: &'a [usize],
    /// Whether velocities vary at the start, and are differentiated at the end, in place of momenta.
    pub has_velocities: [bool; 2],
}

#[cfg(feature = "derivatives")]
impl Wanted<'_> {
    /// The derivatives with respect to (q, p) after this number of steps.
    #[must_use]
    pub fn after(steps: u64) -> Self {
        Self { end: End::Steps(steps), parameters: &[], has_velocities: [false; 2] }
    }
}

/// A run that a program controls.
#[cfg(feature = "sessions")]
pub trait Session {
    /// Velocities of the last node.
    ///
    /// # Errors
    /// The momenta have no velocity.
    fn velocity(&self) -> Result<Vec<f64>, StepError>;
    /// Values of the parameters, in the order of their declaration.
    fn parameters(&self) -> Vec<f64>;
    /// Sets parameters by their indices.
    ///
    /// # Errors
    /// As [`Run::set_parameters`](vi_core::Run::set_parameters).
    fn set_parameters(&mut self, change: &[(usize, f64)]) -> Result<(), StepError>;
    /// Continues from another state, of time, coordinates and momenta, with changed parameters.
    ///
    /// # Errors
    /// As [`Run::set_parameters_and_state`](vi_core::Run::set_parameters_and_state); [`StepError::InvalidInput`] for
    /// another number of coordinates or momenta.
    fn set_state(&mut self, change: &[(usize, f64)], at: (f64, &[f64], &[f64])) -> Result<(), StepError>;
    /// Takes one step of the length h in time.
    ///
    /// # Errors
    /// As [`Run::step_of`](vi_core::Run::step_of).
    fn advance_of(&mut self, h: f64) -> Result<(), StepError>;
    /// Takes steps toward the time `end`, where the last of them ends, if one is given; at most `most`. Adds each
    /// `every`th node before `end` to `rows`, as `taken` counts. Returns whether the run is at `end`.
    ///
    /// # Errors
    /// The error of the failed step; [`StepError::InvalidInput`] for an end that is not ahead.
    fn record(
        &mut self,
        end: Option<f64>,
        most: u64,
        every: u64,
        taken: &mut u64,
        rows: &mut Rows,
    ) -> Result<bool, StepError>;
    /// Adds states at the given times to `rows`, as [`Run::states_at`](vi_core::Run::states_at).
    ///
    /// # Errors
    /// As [`Run::states_at`](vi_core::Run::states_at).
    fn record_at(&mut self, times: &[f64], rows: &mut Rows) -> Result<(), StepError>;
    /// Advances to the first crossing of a section, or to the time `end`.
    ///
    /// # Errors
    /// As [`Run::next_event`](vi_core::Run::next_event).
    fn next_crossing(&mut self, sections: &[Section], end: f64) -> Result<Option<Met>, StepError>;
    /// Dense output of the last step, which began at this time with these coordinates and momenta.
    ///
    /// # Errors
    /// As [`Run::dense_output`](vi_core::Run::dense_output).
    fn step_output(&self, t: f64, q: &[f64], p: &[f64]) -> Result<Box<dyn StepOutput>, StepError>;
    /// The error of the next step: of q and of h·v, one after the other.
    ///
    /// # Errors
    /// As [`Run::local_error`](vi_core::Run::local_error).
    fn local_error(&self) -> Result<[Vec<f64>; 2], StepError>;
    /// The complete state of the run as text for [`System::restart`](crate::System::restart).
    ///
    /// # Errors
    /// A part of the state that cannot be written.
    #[cfg(feature = "checkpoints")]
    fn checkpoint(&self) -> Result<String, String>;
    /// The linearization of the next step. The run does not change.
    ///
    /// # Errors
    /// As [`Run::linearization`](vi_core::Run::linearization).
    #[cfg(feature = "derivatives")]
    fn linearization(&self) -> Result<Linear, StepError>;
    /// Takes steps, and returns the derivatives of (q, p, t) at their end with respect to each coordinate, each momentum
    /// and the parameters at the start: one vector for each. With constraints they are those of a run that starts from the
    /// nearest state on the constraints. The energy that a run keeps follows from
    /// the start where the run began; later it changes as by [`Session::set_state`] and [`Session::set_parameters`].
    /// `goes_on` is called for each step; if it is false the result is `None`, and the run stays where it was.
    ///
    /// # Errors
    /// As [`Tangent::step`](vi_core::derivatives::Tangent::step), `until` and `until_event` there.
    #[cfg(feature = "derivatives")]
    fn tangent(
        &mut self,
        wanted: Wanted<'_>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<f64>>>, StepError>;
    /// The second derivatives of `weights·(q, p)`, or of `weights·(q, v)`, at the end that is wanted, with respect to
    /// each coordinate, each momentum and the parameters at the start: a symmetric matrix, row by row. `weights` has two
    /// numbers for each coordinate that varies; further ones are at rest. `None` for methods and ends without them. The
    /// run does not change.
    ///
    /// # Errors
    /// As [`Run::curvature`](vi_core::Run::curvature); the error of a failed step.
    #[cfg(feature = "derivatives")]
    fn curvature(&self, wanted: Wanted<'_>, weights: &[f64]) -> Result<Option<Vec<f64>>, StepError>;
    /// As [`Session::tangent`] at each of these times, in the order of the run, which keeps its own steps and is near the
    /// last one after.
    ///
    /// # Errors
    /// As [`Session::tangent`].
    #[cfg(feature = "derivatives")]
    fn tangents_at(
        &mut self,
        times_and_parameters: (&[f64], &[usize]),
        has_velocities: [bool; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<Vec<f64>>>>, StepError>;
    /// Takes steps, and returns the largest Lyapunov exponents of them, of the first `coordinates`. Otherwise as
    /// [`Session::tangent`].
    ///
    /// # Errors
    /// As [`Lyapunov`](vi_core::derivatives::Lyapunov).
    #[cfg(feature = "derivatives")]
    fn lyapunov(
        &mut self,
        steps: u64,
        count_and_coordinates: [usize; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError>;
    /// Takes steps, and returns the gradient of `slope·(q, p, t)` at their end with respect to q, p, and the parameters
    /// of these indices, not the step length, by one backward pass. Otherwise as [`Session::tangent`].
    ///
    /// # Errors
    /// As [`Session::tangent`] and [`gradient`](vi_core::derivatives::gradient).
    #[cfg(feature = "derivatives")]
    fn gradient(
        &mut self,
        wanted: Wanted<'_>,
        slope: &[f64],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError>;
}

/// Without the feature `sessions` a run has no further functions.
#[cfg(not(feature = "sessions"))]
pub trait Session {}
#[cfg(not(feature = "sessions"))]
impl<T> Session for T {}

/// A started run.
pub trait Simulation: Steps + Session + Send + Sync {
    /// The same run, once more.
    fn copy(&self) -> Box<dyn Simulation>;
    /// Evaluations of the equations by the steps so far, from their iterations.
    fn evaluations(&self) -> u64;
    /// Takes steps until a node at `end` or later, at most `most`; returns their number.
    ///
    /// # Errors
    /// The error of the failed step.
    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError>;
    /// Advances to the time `end`, and passes each crossing of a section to `take`, in order. A crossing is located by
    /// a step of the exact length h, and has no discrete energy. It ends early if `take` returns false.
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
