//! A run that a program controls: the functions of a [`Session`].

#[cfg(feature = "derivatives")]
use crate::control::Linear;
#[cfg(feature = "derivatives")]
use crate::derivatives;
use crate::erasable::Runnable;
#[cfg(feature = "checkpoints")]
use crate::method::AnyMemory;
use crate::method::{AnyMethod, AnyOutput, AnyRun, Progress};
use crate::run::{Simulated, met};
use crate::section::Section;
use crate::simulation::{Met, Rows, Session, StepOutput, vector};
#[cfg(feature = "derivatives")]
use crate::simulation::{Wanted, wrong_size};
#[cfg(feature = "checkpoints")]
use serde_json::value::RawValue;
#[cfg(feature = "checkpoints")]
use vi_core::run::Checkpoint;
use vi_core::run::DenseOutput as _;
use vi_core::{State, StepError};

impl<const N: usize> StepOutput for AnyOutput<N> {
    fn at(&self, t: f64) -> [Vec<f64>; 3] {
        let State { q, p, .. } = self.state(t);
        [q, p, self.velocity(t)].map(|of| of.as_slice().to_vec())
    }
}

/// Sets parameters by their indices.
fn assign<S: Runnable<N>, const N: usize>(system: &mut S, change: &[(usize, f64)]) {
    for (index, value) in change {
        if let Some(place) = system.parameters().get(*index).and_then(|name| system.parameter_mut(name)) {
            *place = *value;
        }
    }
}

/// A state from slices.
///
/// # Errors
/// As [`vector`].
fn state<const N: usize>(t: f64, q: &[f64], p: &[f64]) -> Result<State<N>, StepError> {
    Ok(State { t, q: vector(q, "number of coordinates")?, p: vector(p, "number of momenta")? })
}

impl<S: Runnable<N>, const N: usize> Simulated<S, N> {
    /// Takes one step toward the time `end`; returns whether the run is there.
    #[inline(never)]
    fn approach(&mut self, end: f64) -> Result<bool, StepError> {
        let is_there = self.run.approach_once(end)?;
        self.shortened = None;
        self.count();
        Ok(is_there)
    }

    /// Continues as a run with other parameters or at another state.
    fn continue_as(&mut self, run: AnyRun<S, N>) {
        // An unfinished window of measurement belongs to the system and the steps of before.
        self.resume();
        self.run = run;
        // The next window begins here.
        self.resume();
        #[cfg(feature = "derivatives")]
        {
            self.start = None;
        }
    }
}

impl<S: Runnable<N>, const N: usize> Session for Simulated<S, N> {
    fn velocity(&self) -> Result<Vec<f64>, StepError> {
        Ok(self.run.velocity()?.as_slice().to_vec())
    }

    fn parameters(&self) -> Vec<f64> {
        let system = self.run.system();
        (0..system.parameters().len()).map(|index| system.parameter(index)).collect()
    }

    fn set_parameters(&mut self, change: &[(usize, f64)]) -> Result<(), StepError> {
        let mut run = self.run.clone();
        run.set_parameters(|system| assign(system, change))?;
        self.continue_as(run);
        Ok(())
    }

    fn set_state(&mut self, change: &[(usize, f64)], (t, q, p): (f64, &[f64], &[f64])) -> Result<(), StepError> {
        let mut run = self.run.clone();
        run.set_parameters_and_state(|system| assign(system, change), state(t, q, p)?)?;
        self.continue_as(run);
        Ok(())
    }

    fn advance_of(&mut self, h: f64) -> Result<(), StepError> {
        self.run.step_of(h)?;
        self.shortened = Some(h);
        self.count();
        Ok(())
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
        let until = taken.saturating_add(most);
        let is_far = |run: &dyn Progress<N>| {
            end.is_none_or(|end| (run.time_to(end) - 2.0 * run.longest()) * run.h().signum() > 0.0)
        };
        let mut is_first = true;
        let mut goes_on = |run: &dyn Progress<N>| {
            if !is_first {
                *taken += 1;
                if taken.is_multiple_of(every) {
                    rows.push_state(&run.state());
                }
            }
            is_first = false;
            *taken < until && is_far(run)
        };
        let mut outcome = self.advance_while(&mut goes_on).map(|()| false);
        // The last steps are shortened, or lengthened by a rounding, to end there.
        while outcome == Ok(false)
            && *taken < until
            && let Some(end) = end
        {
            outcome = self.approach(end);
            *taken += u64::from(outcome.is_ok());
            if outcome == Ok(false) && taken.is_multiple_of(every) {
                rows.push_state(&self.run.state());
            }
        }
        outcome
    }

    fn record_at(&mut self, times: &[f64], rows: &mut Rows) -> Result<(), StepError> {
        let outcome = AnyMethod::states_at(&mut self.run, times, &mut |state| rows.push_state(&state));
        self.resume();
        outcome
    }

    fn next_crossing(&mut self, sections: &[Section], end: f64) -> Result<Option<Met>, StepError> {
        let events: Vec<_> = sections.iter().map(Section::event).collect();
        let crossing = AnyMethod::next_event(&mut self.run, &events, end);
        self.resume();
        Ok(crossing?.map(|crossing| met(self.run.system(), &crossing)))
    }

    fn step_output(&self, t: f64, q: &[f64], p: &[f64]) -> Result<Box<dyn StepOutput>, StepError> {
        Ok(Box::new(self.run.dense_output(&state(t, q, p)?)?))
    }

    fn local_error(&self) -> Result<[Vec<f64>; 2], StepError> {
        let error = self.run.local_error()?;
        Ok([error.q, error.hv].map(|of| of.as_slice().to_vec()))
    }

    #[cfg(feature = "checkpoints")]
    fn checkpoint(&self) -> Result<String, String> {
        let lost = || format!("a number of the run is not finite at t = {}: it cannot be stored", self.run.t());
        let raw = |memory: AnyMemory<S, N>| {
            memory.text().and_then(|text| RawValue::from_string(text).map_err(|error| error.to_string()))
        };
        let checkpoint = self.run.checkpoint().try_map(raw).map_err(|_| lost())?;
        let text = serde_json::to_string(&checkpoint).map_err(|error| error.to_string())?;
        // JSON has no infinite number: it writes null.
        serde_json::from_str::<Checkpoint<Box<RawValue>, N>>(&text).map_err(|_| lost())?;
        Ok(text)
    }

    #[cfg(feature = "derivatives")]
    fn linearization(&self) -> Result<Linear, StepError> {
        self.run.linearization().map(Linear::from)
    }

    #[cfg(feature = "derivatives")]
    fn tangent(
        &mut self,
        wanted: Wanted<'_>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<f64>>>, StepError> {
        let found = derivatives::tangent(&self.run, self.begins(), wanted, goes_on)?;
        Ok(self.at_end(found))
    }

    #[cfg(feature = "derivatives")]
    fn curvature(&self, wanted: Wanted<'_>, weights: &[f64]) -> Result<Option<Vec<f64>>, StepError> {
        if !weights.len().is_multiple_of(2) || weights.len() > 2 * N {
            return Err(wrong_size(weights, "number of coordinates and momenta"));
        }
        // The matrix is symmetric, so its columns are its rows.
        Ok(derivatives::curvature(&self.run, wanted, weights)?.map(|matrix| matrix.as_slice().to_vec()))
    }

    #[cfg(feature = "derivatives")]
    fn tangents_at(
        &mut self,
        times_and_parameters: (&[f64], &[usize]),
        has_velocities: [bool; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<Vec<f64>>>>, StepError> {
        let found = derivatives::tangents_at(&self.run, self.begins(), times_and_parameters, has_velocities, goes_on)?;
        Ok(self.at_end(found))
    }

    #[cfg(feature = "derivatives")]
    fn lyapunov(
        &mut self,
        steps: u64,
        count_and_coordinates: [usize; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError> {
        let found = derivatives::lyapunov(&self.run, steps, count_and_coordinates, goes_on)?;
        Ok(self.at_end(found))
    }

    #[cfg(feature = "derivatives")]
    fn gradient(
        &mut self,
        wanted: Wanted<'_>,
        slope: &[f64],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError> {
        if slope.len() != 2 * N + 1 {
            return Err(wrong_size(slope, "number of coordinates, momenta and the time"));
        }
        let found = derivatives::gradient(&self.run, self.begins(), wanted, slope, goes_on)?;
        Ok(self.at_end(found))
    }
}

#[cfg(feature = "derivatives")]
impl<S: Runnable<N>, const N: usize> Simulated<S, N> {
    /// Whether the run is where it began.
    fn begins(&self) -> bool {
        self.start.as_ref() == Some(self.run.node())
    }

    /// Continues at the end of differentiated steps, unless they were interrupted, and returns their derivatives.
    fn at_end<Y>(&mut self, found: Option<(AnyRun<S, N>, Y)>) -> Option<Y> {
        found.map(|(run, of)| {
            self.run = run;
            self.resume();
            of
        })
    }
}
