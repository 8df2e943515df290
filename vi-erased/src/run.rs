//! A run of any method behind a [`Simulation`].
//!
//! The numbers are those of the generic integrators, to the last bit, and loops over steps are inside, without virtual
//! calls.

use crate::erasable::Runnable;
use crate::method::{AnyMethod, AnyRun, GoesOn, Progress};
use crate::section::Section;
use crate::simulation::{AtConstraints, Met, Row, ShiftedEnergy, Simulation, Steps};
use std::borrow::Cow;
use vi_core::kind::Kind;
use vi_core::linear::Rectangular as _;
#[cfg(feature = "derivatives")]
use vi_core::node::Node;
use vi_core::run::{Crossing, ErrorEstimate, ErrorMonitor};
use vi_core::support::has_angles;
use vi_core::{Method as _, SVector, State, StepError};

/// A run with a method, and the data for its rows.
#[derive(Clone)]
pub(crate) struct Simulated<S: Runnable<N>, const N: usize> {
    pub(crate) run: AnyRun<S, N>,
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
pub(crate) fn erased<S: Runnable<N>, const N: usize>(run: AnyRun<S, N>, is_shifted: bool) -> Box<dyn Simulation> {
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

/// The constraints at a state; `None` for systems without.
fn at_constraints<S: Runnable<N>, const N: usize>(system: &S, state: &State<N>) -> Option<AtConstraints> {
    if const { S::Kind::COUNT == 0 } {
        return None;
    }
    let reactions = match state.reaction(system) {
        Ok(reactions) => reactions.as_ref().iter().copied().map(Some).collect(),
        Err(_) => vec![None; system.constraint_names().len()],
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
            let ahead = if self.run.method().facts().finds_length { Some(self.run.after_a_step()?) } else { None };
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
    fn copy(&self) -> Box<dyn Simulation> {
        Box::new(self.clone())
    }

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
