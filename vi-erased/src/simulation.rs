//! One type-erased run of any system.
//!
//! In: a run of known types. Out: a [`Simulation`], whose rows are the nodes of the integrator, starting with its first
//! node. The numbers are those of the generic integrators, to the last bit, and loops over steps are inside, without
//! virtual calls.

use crate::section::Section;
use vi_core::collocation::Collocation;
use vi_core::lagrangian::Parameters;
use vi_core::run::{Crossing, DenseOutput, ErrorEstimate, ErrorMonitor};
use vi_core::stepping::Convertible;
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

/// Nodes of a run, in flat columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Times.
    pub t: Vec<f64>,
    /// Coordinates, node after node.
    pub q: Vec<f64>,
    /// Momenta, node after node.
    pub p: Vec<f64>,
}

impl Rows {
    /// Adds a node.
    pub fn push<const N: usize>(&mut self, state: &State<N>) {
        self.t.push(state.t);
        self.q.extend_from_slice(state.q.as_slice());
        self.p.extend_from_slice(state.p.as_slice());
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

/// The motion within one step.
pub trait StepOutput: Send + Sync {
    /// Coordinates, momenta and velocities at the time `t`, one after the other.
    fn at(&self, t: f64) -> [Vec<f64>; 3];
}

/// Dense output, type-erased.
struct Output<D, const N: usize>(D);

impl<D: DenseOutput<N> + Send + Sync, const N: usize> StepOutput for Output<D, N> {
    fn at(&self, t: f64) -> [Vec<f64>; 3] {
        let State { q, p, .. } = self.0.state(t);
        [q, p, self.0.velocity(t)].map(|of| of.as_slice().to_vec())
    }
}

/// The nodes of a run, one after the other.
pub trait Steps {
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
    /// Measures errors of the steps from here on. It costs a few per cent of their time and changes no bit of them.
    fn monitor(&mut self) {}
    /// The largest error of a step since [`Steps::monitor`], relative to the excursion of its coordinate.
    fn largest_error(&self) -> Option<ErrorEstimate> {
        None
    }

    /// The last node with its energies.
    fn row(&self) -> Row {
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

/// A started run.
pub trait Simulation: Steps + Send + Sync {
    /// Velocities of the last node.
    ///
    /// # Errors
    /// The momenta have no velocity.
    fn velocity(&self) -> Result<Vec<f64>, StepError>;
    /// Evaluations of the equations by the steps so far, from their iterations.
    fn evaluations(&self) -> u64;
    /// Values of the parameters, in the order of their declaration.
    fn parameters(&self) -> Vec<f64>;
    /// The same run, once more.
    fn copy(&self) -> Box<dyn Simulation>;
    /// Sets parameters by their indices.
    ///
    /// # Errors
    /// As [`Run::set_parameters`].
    fn set_parameters(&mut self, change: &[(usize, f64)]) -> Result<(), StepError>;
    /// Continues from another state, of coordinates and momenta.
    ///
    /// # Errors
    /// As [`Run::set_state`]; [`StepError::InvalidInput`] for another number of coordinates or momenta.
    fn set_state(&mut self, t: f64, q: &[f64], p: &[f64]) -> Result<(), StepError>;
    /// Takes one step of the length h in time.
    ///
    /// # Errors
    /// As [`Run::step_of`].
    fn advance_of(&mut self, h: f64) -> Result<(), StepError>;
    /// Takes steps until a node at `end` or later, at most `most`; returns their number.
    ///
    /// # Errors
    /// The error of the failed step.
    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError>;
    /// Takes steps toward the time `end`, where the last of them ends, if one is given; at most `most`. Adds each
    /// `every`th node to `rows`, as `taken` counts, and the last one. Returns whether it was the last.
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
    /// Adds states at the given times to `rows`, as [`Run::states_at`].
    ///
    /// # Errors
    /// As [`Run::states_at`].
    fn record_at(&mut self, times: &[f64], rows: &mut Rows) -> Result<(), StepError>;
    /// Advances to the time `end`, and passes each crossing of a section to `take`, in order. A crossing is located by
    /// a step of the exact length h, and has no discrete energy. It ends early where `take` returns false.
    ///
    /// # Errors
    /// The error of the failed step.
    fn cross(&mut self, sections: &[Section], end: f64, take: &mut dyn FnMut(Met) -> bool) -> Result<(), StepError>;
    /// Advances to the first crossing of a section, or to the time `end`.
    ///
    /// # Errors
    /// As [`Run::next_event`].
    fn next_crossing(&mut self, sections: &[Section], end: f64) -> Result<Option<Met>, StepError>;
    /// Dense output of the last step, which began at this time with these coordinates and momenta.
    ///
    /// # Errors
    /// As [`Run::dense_output`].
    fn step_output(&self, t: f64, q: &[f64], p: &[f64]) -> Result<Box<dyn StepOutput>, StepError>;
    /// The error of the next step: of q and of h·v, one after the other.
    ///
    /// # Errors
    /// As [`Run::local_error`].
    fn local_error(&self) -> Result<[Vec<f64>; 2], StepError>;
    /// Time and H at which H is most accurate: at the node; for energy-preserving steps at the midpoint of the last
    /// one, since H deviates by h²D/8 at their nodes.
    ///
    /// # Errors
    /// As [`Simulation::energy`].
    fn sampled_energy(&self) -> Result<(f64, f64), StepError>;
    /// Everything that the run carries, as text for [`System::restart`](crate::System::restart).
    ///
    /// # Errors
    /// What cannot be written.
    #[cfg(feature = "checkpoints")]
    fn checkpoint(&self) -> Result<String, String>;
    /// Takes steps, and returns the derivatives of the node at their end by each coordinate, each momentum, and the
    /// parameters of these indices at the start: one vector of (q, p) for each.
    ///
    /// # Errors
    /// As [`Tangent::step`](vi_core::derivatives::Tangent::step).
    #[cfg(feature = "derivatives")]
    fn tangent(&mut self, steps: u64, parameters: &[usize]) -> Result<Vec<Vec<f64>>, StepError>;
    /// Takes steps, and returns the gradient of `slope·(q, p)` at their end by q, p, and the parameters of these
    /// indices, by one backward pass.
    ///
    /// # Errors
    /// As [`gradient`](vi_core::derivatives::gradient).
    #[cfg(feature = "derivatives")]
    fn gradient(&mut self, steps: u64, slope: &[f64], parameters: &[usize]) -> Result<Vec<f64>, StepError>;
}

impl dyn Simulation + '_ {
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
    if values.len() == N {
        Ok(SVector::from_column_slice(values))
    } else {
        #[allow(clippy::cast_precision_loss)] // a count that a command line can hold
        let value = values.len() as f64;
        Err(StepError::InvalidInput { input, allowed: "that of the system", value })
    }
}

/// A state from slices.
///
/// # Errors
/// As [`vector`].
fn state<const N: usize>(t: f64, q: &[f64], p: &[f64]) -> Result<State<N>, StepError> {
    Ok(State { t, q: vector(q, "number of coordinates")?, p: vector(p, "number of momenta")? })
}

/// A method whose runs are erased: what its rows and its evaluations are.
pub trait Erasable<S: Runnable<N>, const N: usize>: Supported<S, N> {
    /// Evaluations of the equations in the last step of a run.
    fn evaluations(run: &Run<Self, S, N>) -> u64;

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

/// A system whose runs are erased.
pub trait Runnable<const N: usize>: Collocation<N> + Convertible<N> + Parameters + Send + Sync + 'static {}
impl<S: Collocation<N> + Convertible<N> + Parameters + Send + Sync + 'static, const N: usize> Runnable<N> for S {}

#[cfg(not(feature = "derivatives"))]
use Method as Derived;
#[cfg(feature = "derivatives")]
use vi_core::derivatives::Differentiable as Derived;

/// A method with all that the features ask of it.
#[cfg(not(feature = "checkpoints"))]
pub trait Supported<S: Runnable<N>, const N: usize>: Derived<S, N> + 'static {}
#[cfg(not(feature = "checkpoints"))]
impl<M: Derived<S, N> + 'static, S: Runnable<N>, const N: usize> Supported<S, N> for M {}

/// A method with all that the features ask of it.
#[cfg(feature = "checkpoints")]
pub trait Supported<S: Runnable<N>, const N: usize>: Derived<S, N, Memory: Storable> + 'static {}
#[cfg(feature = "checkpoints")]
impl<M: Derived<S, N, Memory: Storable> + 'static, S: Runnable<N>, const N: usize> Supported<S, N> for M {}

/// A memory that serde writes and reads.
#[cfg(feature = "checkpoints")]
pub trait Storable: serde::Serialize + serde::de::DeserializeOwned {}
#[cfg(feature = "checkpoints")]
impl<Y: serde::Serialize + serde::de::DeserializeOwned> Storable for Y {}

/// A run with a method, and the data for its rows.
#[derive(Clone)]
pub(crate) struct Simulated<M: Method<S, N>, S, const N: usize> {
    run: Run<M, S, N>,
    evaluations: u64,
    /// Whether rows have E', even for a shift of zero.
    is_shifted: bool,
    /// Length of the last step, if it was shortened.
    shortened: Option<f64>,
    monitor: Option<Box<ErrorMonitor<M, S, N>>>,
}

/// Relative deviation below which a length counts as the step of the run.
const ROUNDED: f64 = 1e-9;

/// The same run, type-erased.
pub fn erased<M: Erasable<S, N>, S: Runnable<N>, const N: usize>(run: Run<M, S, N>) -> Box<dyn Simulation> {
    erased_with(run, false)
}

/// The same, with E' in its rows if `is_shifted`.
pub(crate) fn erased_with<M: Erasable<S, N>, S: Runnable<N>, const N: usize>(
    run: Run<M, S, N>,
    is_shifted: bool,
) -> Box<dyn Simulation> {
    Box::new(Simulated { run, evaluations: 0, is_shifted, shortened: None, monitor: None })
}

impl<M: Erasable<S, N>, S: Runnable<N>, const N: usize> Simulated<M, S, N> {
    /// Takes notice of the last step.
    fn count(&mut self) {
        self.evaluations += M::evaluations(&self.run);
        if let Some(monitor) = &mut self.monitor {
            monitor.watch(&self.run);
        }
    }

    /// Takes steps by `step` until it returns true or `most` are taken; `see` gets the run after each. Returns whether
    /// `step` did.
    #[inline]
    fn advance_while(
        &mut self,
        most: u64,
        mut step: impl FnMut(&mut Run<M, S, N>) -> Result<bool, StepError>,
        mut see: impl FnMut(&Run<M, S, N>),
    ) -> Result<bool, StepError> {
        // A local copy of the run: behind a pointer its numbers would go through memory in every step.
        let mut run = self.run.clone();
        let mut outcome = Ok(false);
        let mut taken = 0;
        while let Ok(false) = outcome
            && taken < most
        {
            outcome = step(&mut run);
            if outcome.is_ok() {
                taken += 1;
                self.evaluations += M::evaluations(&run);
                see(&run);
                if let Some(monitor) = &mut self.monitor {
                    monitor.watch(&run);
                }
            }
        }
        self.run = run;
        self.shortened = None;
        outcome
    }

    fn met(&self, crossing: &Crossing<N>) -> Met {
        let Crossing { events, state, length, .. } = crossing;
        let row = Row {
            t: state.t,
            q: state.q.as_slice().to_vec(),
            p: state.p.as_slice().to_vec(),
            energy: state.energy(self.run.system()).ok(),
            discrete_energy: None,
            shifted_energy: None,
            h: *length,
        };
        Met { row, events: events.iter().map(|met| (met.event, met.is_rising)).collect() }
    }

    /// Forgets a jump of the run.
    fn resume(&mut self) {
        self.shortened = None;
        if let Some(monitor) = &mut self.monitor {
            monitor.resume(&self.run);
        }
    }
}

impl<M: Erasable<S, N>, S: Runnable<N>, const N: usize> Steps for Simulated<M, S, N> {
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
        M::shifted_energy(&self.run).filter(|of| self.is_shifted || of.shift != 0.0)
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
            let ahead = if M::FINDS_LENGTH { Some(self.run.after_a_step()?) } else { None };
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
        self.monitor.as_ref().map(|monitor| monitor.largest(&self.run))
    }
}

impl<M: Erasable<S, N>, S: Runnable<N>, const N: usize> Simulation for Simulated<M, S, N> {
    fn velocity(&self) -> Result<Vec<f64>, StepError> {
        Ok(self.run.velocity()?.as_slice().to_vec())
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn parameters(&self) -> Vec<f64> {
        (0..S::PARAMETERS.len()).map(|index| self.run.system().parameter(index)).collect()
    }

    fn copy(&self) -> Box<dyn Simulation> {
        Box::new(self.clone())
    }

    fn set_parameters(&mut self, change: &[(usize, f64)]) -> Result<(), StepError> {
        self.run.set_parameters(|system| {
            for (index, value) in change {
                if let Some(place) = S::PARAMETERS.get(*index).and_then(|name| system.parameter_mut(name)) {
                    *place = *value;
                }
            }
        })
    }

    fn set_state(&mut self, t: f64, q: &[f64], p: &[f64]) -> Result<(), StepError> {
        self.run.set_state(state(t, q, p)?)?;
        self.resume();
        Ok(())
    }

    fn advance_of(&mut self, h: f64) -> Result<(), StepError> {
        self.run.step_of(h)?;
        self.shortened = Some(h);
        self.count();
        Ok(())
    }

    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        let mut taken = 0;
        let is_there = |run: &Run<M, S, N>| run.t() >= end;
        if !is_there(&self.run) {
            self.advance_while(most, |run| run.step().map(|_| is_there(run)), |_| taken += 1)?;
        }
        Ok(taken)
    }

    fn record(
        &mut self,
        end: Option<f64>,
        most: u64,
        every: u64,
        taken: &mut u64,
        rows: &mut Rows,
    ) -> Result<bool, StepError> {
        if let Some(end) = end {
            self.run.check_ahead(end)?;
        }
        let before = *taken;
        let see = |run: &Run<M, S, N>| {
            *taken += 1;
            if taken.is_multiple_of(every) {
                rows.push(&run.state());
            }
        };
        let outcome = match end {
            Some(end) => self.advance_while(most, |run| run.approach(end), see),
            None => self.advance_while(most, |run| run.step().map(|_| false), see),
        };
        let is_over = outcome != Ok(false);
        if is_over && *taken > before && !taken.is_multiple_of(every) {
            rows.push(&self.run.state());
        }
        outcome
    }

    fn record_at(&mut self, times: &[f64], rows: &mut Rows) -> Result<(), StepError> {
        for state in self.run.states_at(times.iter().copied()) {
            rows.push(&state?);
        }
        Ok(())
    }

    fn cross(&mut self, sections: &[Section], end: f64, take: &mut dyn FnMut(Met) -> bool) -> Result<(), StepError> {
        let mut run = self.run.clone();
        let events: Vec<_> = sections.iter().map(Section::event).collect();
        let mut outcome = Ok(());
        for crossing in run.events(events, end) {
            match crossing {
                Ok(crossing) if take(self.met(&crossing)) => {}
                Ok(_) => break,
                Err(error) => outcome = Err(error),
            }
        }
        self.run = run;
        self.resume();
        outcome
    }

    fn next_crossing(&mut self, sections: &[Section], end: f64) -> Result<Option<Met>, StepError> {
        let events: Vec<_> = sections.iter().map(Section::event).collect();
        let crossing = self.run.next_event(events, end);
        self.resume();
        Ok(crossing?.map(|crossing| self.met(&crossing)))
    }

    fn step_output(&self, t: f64, q: &[f64], p: &[f64]) -> Result<Box<dyn StepOutput>, StepError> {
        Ok(Box::new(Output(self.run.dense_output(&state(t, q, p)?)?)))
    }

    fn local_error(&self) -> Result<[Vec<f64>; 2], StepError> {
        let error = self.run.local_error()?;
        Ok([error.q, error.hv].map(|of| of.as_slice().to_vec()))
    }

    fn sampled_energy(&self) -> Result<(f64, f64), StepError> {
        M::sampled_energy(&self.run)
    }

    #[cfg(feature = "checkpoints")]
    fn checkpoint(&self) -> Result<String, String> {
        serde_json::to_string(&self.run.checkpoint()).map_err(|error| error.to_string())
    }

    #[cfg(feature = "derivatives")]
    fn tangent(&mut self, steps: u64, parameters: &[usize]) -> Result<Vec<Vec<f64>>, StepError> {
        let mut variations = vi_core::derivatives::Variation::of_state();
        variations.extend(parameters.iter().map(|index| of_parameter(*index)));
        let mut tangent = vi_core::derivatives::Tangent::from_start(self.run.clone(), variations)?;
        for _ in 0..steps {
            tangent.step()?;
        }
        self.run = tangent.run().clone();
        self.resume();
        let of_node = |of: &vi_core::derivatives::Variation<N>| of.q.iter().chain(&of.p).copied().collect();
        Ok(tangent.variations().iter().map(of_node).collect())
    }

    #[cfg(feature = "derivatives")]
    fn gradient(&mut self, steps: u64, slope: &[f64], parameters: &[usize]) -> Result<Vec<f64>, StepError> {
        use vi_core::derivatives::{Covector, Objective};

        struct AtTheEnd<const N: usize> {
            steps: u64,
            slope: Covector<N>,
            parameters: Vec<&'static str>,
        }

        impl<M: Method<S, N>, S, const N: usize> Objective<M, S, N> for AtTheEnd<N> {
            fn parameters(&self) -> &[&str] {
                &self.parameters
            }

            fn slope(&self, step: u64, _state: &State<N>) -> Covector<N> {
                if step == self.steps { self.slope } else { Covector::zero() }
            }
        }

        let State { q, p, .. } = match slope.split_at_checked(N) {
            Some((q, p)) => state::<N>(0.0, q, p)?,
            None => state::<N>(0.0, slope, &[])?,
        };
        let parameters = parameters.iter().filter_map(|index| S::PARAMETERS.get(*index).copied()).collect();
        let objective = AtTheEnd { steps, slope: Covector { q, p, ..Covector::zero() }, parameters };
        let found = vi_core::derivatives::gradient(&self.run, steps, 1024, &objective)?;
        (0..steps).try_for_each(|_| self.run.single_step().map(drop))?;
        self.resume();
        let count = objective.parameters.len();
        let sums = (0..count).map(|index| found.parameters.iter().map(|of_a_step| of_a_step[index]).sum::<f64>());
        Ok(found.start.q.iter().chain(&found.start.p).copied().chain(sums).collect())
    }
}

/// The direction of a parameter, by its index.
#[cfg(feature = "derivatives")]
fn of_parameter<const N: usize>(index: usize) -> vi_core::derivatives::Variation<N> {
    let mut parameters = vec![0.0; index + 1];
    parameters[index] = 1.0;
    vi_core::derivatives::Variation { parameters, ..vi_core::derivatives::Variation::zero() }
}
