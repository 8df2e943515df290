//! One instance of a unit.
//!
//! The number of a variable is its place in this list, which the description in XML has, too: the time; the parameters
//! and inputs; the initial coordinates and velocities; the outputs, which are coordinates, velocities, momenta,
//! reactions of the constraints, and the energy H.

use crate::Unit;
use vi_core::StepError;
use vi_erased::{Plan, Rows, Simulation, System};

/// An instance: its unit, and everything that changes.
pub(crate) struct Instance {
    unit: Unit,
    state: State,
}

/// The state of an instance. A copy continues bit for bit.
pub struct State {
    /// The values of the variables that can be set, as they were set last.
    values: Vec<f64>,
    /// The time of the start.
    start: f64,
    /// Whether the initialization has ended.
    is_initialized: bool,
    /// The run, after the first request for an output or a step. Its parameters are those of the last step.
    run: Option<Box<dyn Simulation>>,
    /// The outputs at the last node; empty before the first request.
    outputs: Vec<f64>,
}

/// A state as it is stored: values, start, whether the initialization has ended, and parameters and checkpoint of the run.
type Stored = (Vec<f64>, f64, bool, Option<(Vec<f64>, String)>);

/// A variable by its number.
enum Variable {
    Time,
    /// A parameter or an input, by its place among the values.
    Parameter(usize),
    /// An initial coordinate or velocity, by its place among the values.
    Initial(usize),
    Output(usize),
}

/// A result whose error is a text for the log.
type Outcome<T = ()> = Result<T, String>;

fn words(error: StepError) -> String {
    error.to_string()
}

impl Instance {
    pub(crate) fn new(unit: Unit) -> Self {
        let state = State::of(&unit);
        Self { unit, state }
    }

    /// Starts again, with the start values of the unit.
    pub(crate) fn reset(&mut self) {
        self.state = State::of(&self.unit);
    }

    /// Begins the initialization at this time.
    pub(crate) fn initialize(&mut self, start: f64) -> Outcome {
        self.check_initializes()?;
        self.state.start = start;
        self.state.forget_run();
        Ok(())
    }

    /// Ends the initialization.
    ///
    /// # Errors
    /// No run begins at the start values.
    pub(crate) fn end_initialization(&mut self) -> Outcome {
        self.check_initializes()?;
        self.run()?;
        self.state.is_initialized = true;
        Ok(())
    }

    fn check_initializes(&self) -> Outcome {
        if self.state.is_initialized {
            Err("the unit is initialized already: reset it first".to_owned())
        } else {
            Ok(())
        }
    }

    /// The values of variables.
    pub(crate) fn get(&mut self, numbers: &[u32]) -> Outcome<Vec<f64>> {
        numbers.iter().map(|number| self.value(*number)).collect()
    }

    fn value(&mut self, number: u32) -> Outcome<f64> {
        Ok(match self.variable(number)? {
            Variable::Time => self.time(),
            Variable::Parameter(index) | Variable::Initial(index) => self.state.values[index],
            Variable::Output(index) => self.outputs()?[index],
        })
    }

    /// Sets variables. Parameters and inputs act from the next step on.
    pub(crate) fn set(&mut self, numbers: &[u32], values: &[f64]) -> Outcome {
        if numbers.len() != values.len() {
            return Err(format!(
                "{} variables and {} values: each variable is one number",
                numbers.len(),
                values.len()
            ));
        }
        for (number, value) in numbers.iter().zip(values) {
            if !value.is_finite() {
                return Err(format!("the variable with the reference {number} must be finite, not {value}"));
            }
            let index = match self.variable(*number)? {
                Variable::Initial(_) if self.state.is_initialized => {
                    return Err(
                        "initial coordinates and velocities can be set until the initialization ends".to_owned()
                    );
                }
                Variable::Parameter(index) | Variable::Initial(index) => index,
                Variable::Time | Variable::Output(_) => {
                    return Err(format!("the variable with the reference {number} cannot be set"));
                }
            };
            self.state.values[index] = *value;
        }
        if !self.state.is_initialized {
            self.state.forget_run();
        }
        Ok(())
    }

    fn variable(&self, number: u32) -> Outcome<Variable> {
        let Unit { system, parameters, plan, .. } = &self.unit;
        let (parameters, n, constraints) = (parameters.len(), plan.q.len(), system.constraints().len());
        let of = |number: u32| {
            let Some(index) = usize::try_from(number).ok()?.checked_sub(1) else { return Some(Variable::Time) };
            if index < parameters {
                return Some(Variable::Parameter(index));
            }
            let Some(index) = index.checked_sub(parameters + 2 * n) else { return Some(Variable::Initial(index)) };
            (index <= 3 * n + constraints).then_some(Variable::Output(index))
        };
        of(number).ok_or_else(|| format!("there is no variable with the reference {number}"))
    }

    pub(crate) fn time(&self) -> f64 {
        self.state.run.as_ref().map_or(self.state.start, |run| run.t())
    }

    /// Takes steps of the run, the last of which ends after this length of time. Inputs and parameters stay meanwhile.
    pub(crate) fn step(&mut self, from: f64, length: f64) -> Outcome {
        if !self.state.is_initialized {
            return Err("the first step follows the initialization".to_owned());
        }
        let (now, end) = (self.time(), from + length);
        // The caller may sum its steps up with another rounding.
        if (from - now).abs() > 4.0 * f64::EPSILON * from.abs() + 1e-9 * length.abs() {
            return Err(format!("the step begins at {from}, but the unit is at {now}"));
        }
        self.state.outputs.clear();
        let wanted = self.state.values[..self.unit.parameters.len()].to_vec();
        let run = self.run()?;
        let pairs = wanted.into_iter().zip(run.parameters()).enumerate();
        let differs = |(_, (wanted, present)): &(usize, (f64, f64))| wanted.to_bits() != present.to_bits();
        let changes: Vec<_> = pairs.filter(differs).map(|(index, (wanted, _))| (index, wanted)).collect();
        // A call discards what the solver knows from the steps before.
        if !changes.is_empty() {
            run.set_parameters(&changes).map_err(words)?;
        }
        if end.to_bits() != run.t().to_bits() {
            run.record(Some(end), u64::MAX, u64::MAX, &mut 0, &mut Rows::default()).map_err(words)?;
        }
        Ok(())
    }

    /// The run, which begins at the start values.
    fn run(&mut self) -> Outcome<&mut Box<dyn Simulation>> {
        let run = match self.state.run.take() {
            Some(run) => run,
            None => self.begin()?,
        };
        Ok(self.state.run.insert(run))
    }

    fn begin(&self) -> Outcome<Box<dyn Simulation>> {
        let (parameters, initial) = self.state.values.split_at(self.unit.parameters.len());
        let (q, v) = initial.split_at(initial.len() / 2);
        let plan = Plan { t: self.state.start, q: q.to_vec(), v: v.to_vec(), ..self.unit.plan.clone() };
        self.system(parameters).begin(&plan).map_err(words)
    }

    /// The system with these parameters.
    fn system(&self, parameters: &[f64]) -> Box<dyn System> {
        self.unit.system.with_parameters(parameters)
    }

    fn outputs(&mut self) -> Outcome<&[f64]> {
        if self.state.outputs.is_empty() {
            let run = self.run()?;
            let mut outputs = run.q().into_owned();
            outputs.extend(run.velocity().map_err(words)?);
            outputs.extend_from_slice(run.p());
            let reactions = run.constraints().map(|of| of.reactions).unwrap_or_default();
            outputs.extend(reactions.into_iter().map(|reaction| reaction.unwrap_or(f64::NAN)));
            outputs.push(run.energy().map_err(words)?);
            self.state.outputs = outputs;
        }
        Ok(&self.state.outputs)
    }

    pub(crate) fn save(&self) -> State {
        self.state.copy()
    }

    pub(crate) fn restore(&mut self, state: &State) {
        self.state = state.copy();
    }

    /// A state as text.
    pub(crate) fn stored(state: &State) -> Outcome<Vec<u8>> {
        let stored_run = |run: &dyn Simulation| run.checkpoint().map(|checkpoint| (run.parameters(), checkpoint));
        let run = state.run.as_deref().map(stored_run).transpose()?;
        let stored: Stored = (state.values.clone(), state.start, state.is_initialized, run);
        serde_json::to_vec(&stored).map_err(|error| error.to_string())
    }

    /// The state of such a text.
    pub(crate) fn loaded(&self, text: &[u8]) -> Outcome<State> {
        let foreign = |error: &dyn core::fmt::Display| format!("the stored state is not of this unit: {error}");
        let (values, start, is_initialized, run): Stored =
            serde_json::from_slice(text).map_err(|error| foreign(&error))?;
        if values.len() != State::of(&self.unit).values.len() {
            return Err(foreign(&"it has other variables"));
        }
        let restarted = |(parameters, checkpoint): (Vec<f64>, String)| {
            let system = self.system(&parameters);
            system.restart(self.unit.plan.wanted(!system.constraints().is_empty()), &checkpoint)
        };
        let run = run.map(restarted).transpose().map_err(|error| foreign(&error))?;
        Ok(State { values, start, is_initialized, run, outputs: Vec::new() })
    }
}

impl State {
    /// The state of a new instance.
    fn of(unit: &Unit) -> Self {
        let values = [unit.parameters, &unit.plan.q, &unit.plan.v].concat();
        Self { values, start: unit.plan.t, is_initialized: false, run: None, outputs: Vec::new() }
    }

    fn copy(&self) -> Self {
        Self {
            values: self.values.clone(),
            run: self.run.as_ref().map(|run| run.copy()),
            outputs: self.outputs.clone(),
            ..*self
        }
    }

    fn forget_run(&mut self) {
        self.run = None;
        self.outputs.clear();
    }
}
