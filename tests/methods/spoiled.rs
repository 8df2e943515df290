//! Systems whose runs have a fault, to prove that each claim can fail.

use super::Node;
use std::borrow::Cow;
use vi_core::StepError;
use vi_core::lagrangian::Space;
use vi_core::run::ErrorEstimate;
use vi_erased::control::{Control, Linear};
use vi_erased::plan::Built;
use vi_erased::section::Section;
use vi_erased::simulation::{Met, Rows, Session, StepOutput, Steps, Wanted};
use vi_erased::studies::Studies;
use vi_erased::system::{OnConstraints, Quantity};
use vi_erased::{PhasePoint, Plan, Row, Simulation, System, forward};

/// The fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// Every step multiplies all momenta by 1 + h²/10, in either direction of time.
    Kick,
    /// Every step multiplies all momenta by 1 + 1e-13.
    Momenta,
    /// A step after a failed one does nothing.
    Latch,
    /// A single step is 1e-7 too long, and a length without a step is taken as 1e-3.
    Length,
    /// States at times are those of a later time, 1e-8 of a step.
    Times,
    /// Dense output is that of a later time, 1e-8 of a step.
    Dense,
    /// An event is 1e-8 of its length late.
    Event,
    /// Every second event is lost.
    LostEvent,
    /// A stored run forgets the low parts of its node, and its steps before.
    Checkpoint,
    /// Parameters do not change.
    Parameters,
    /// Another state has momenta that are 1e-12 too large.
    State,
    /// Tangent vectors are 1e-3 too large, gradients and linearizations as much too small.
    Tangent,
    /// Second derivatives are 1e-6 too large.
    Curvature,
    /// Estimates of an error are 30 times as large.
    Estimate,
    /// A monitor finds a hundredth.
    Monitor,
}

/// A system or a run with a fault.
struct Spoiled<Y: ?Sized> {
    of: Box<Y>,
    fault: Fault,
    /// Whether a step has failed.
    has_failed: bool,
}

/// A system whose runs have a fault.
pub(super) fn system(of: Box<dyn System>, fault: Fault) -> Box<dyn System> {
    Box::new(Spoiled { of, fault, has_failed: false })
}

impl<Y: ?Sized> Spoiled<Y> {
    /// A run with the same fault.
    fn run(&self, of: Box<dyn Simulation>) -> Box<dyn Simulation> {
        Box::new(Spoiled { of, fault: self.fault, has_failed: false })
    }

    /// A factor that is 1 without the fault.
    fn factor(&self, fault: Fault, wrong: f64) -> f64 {
        if self.fault == fault { wrong } else { 1.0 }
    }
}

impl System for Spoiled<dyn System> {
    forward!(System);
    forward! {
        fn coordinates(&self) -> Vec<&'static str>;
        fn spaces(&self) -> Vec<Space>;
        fn evaluate(&self, of: Quantity, points: [&[f64]; 3], out: &mut Vec<f64>) -> Result<(), StepError>;
        fn project(&self, at: &PhasePoint) -> Result<OnConstraints, StepError>;
        fn assemble(&self, at: &PhasePoint) -> Result<OnConstraints, StepError>;
        fn redundant(&self, t: f64, q: &[f64]) -> Result<Vec<&'static str>, StepError>;
        fn studies(&self) -> &dyn Studies;
        fn control(&self) -> &dyn Control;
    }

    fn without(&self, constraints: &[&str]) -> Option<Box<dyn System>> {
        Some(system(self.of.without(constraints)?, self.fault))
    }

    fn copy(&self) -> Box<dyn System> {
        system(self.of.copy(), self.fault)
    }

    fn begin_while(&self, plan: &Plan, goes_on: &mut dyn FnMut() -> bool) -> Result<Box<dyn Simulation>, StepError> {
        let mut plan = plan.clone();
        if self.fault == Fault::Length && !(plan.h.is_normal() && plan.dtau.is_none_or(f64::is_normal)) {
            (plan.h, plan.dtau) = (1e-3, plan.dtau.map(|_| 1e-3));
        }
        Ok(self.run(self.of.begin_while(&plan, goes_on)?))
    }

    fn restart(&self, built: Built, stored: &str) -> Result<Box<dyn Simulation>, String> {
        let mut run = self.of.restart(built, stored)?;
        if self.fault == Fault::Checkpoint {
            let Node { t, q, p } = Node::of(&*run);
            run.set_state(&[], (t, &q, &p)).map_err(|error| error.to_string())?;
        }
        Ok(self.run(run))
    }
}

impl Spoiled<dyn Simulation> {
    /// Changes the momenta of the run.
    fn push(&mut self, change: impl Fn(&mut [f64])) -> Result<(), StepError> {
        let Node { t, q, mut p } = Node::of(&*self.of);
        change(&mut p);
        self.of.set_state(&[], (t, &q, &p))
    }
}

impl Steps for Spoiled<dyn Simulation> {
    forward!(Steps);
    forward! {
        fn q(&self) -> Cow<'_, [f64]>;
        fn p(&self) -> &[f64];
    }

    fn advance(&mut self) -> Result<(), StepError> {
        if self.fault == Fault::Latch && self.has_failed {
            return Ok(());
        }
        let outcome = self.of.advance();
        self.has_failed |= outcome.is_err();
        outcome?;
        let h = self.of.h();
        match self.fault {
            Fault::Kick => self.push(|p| p.iter_mut().for_each(|p| *p *= 1.0 + 0.1 * h * h)),
            Fault::Momenta => self.push(|p| p.iter_mut().for_each(|p| *p *= 1.0 + 1e-13)),
            _ => Ok(()),
        }
    }

    fn largest_error(&self) -> Option<ErrorEstimate> {
        let found = self.of.largest_error()?;
        Some(ErrorEstimate { estimate: found.estimate * self.factor(Fault::Monitor, 0.01), ..found })
    }
}

impl Simulation for Spoiled<dyn Simulation> {
    forward!(Simulation);

    fn copy(&self) -> Box<dyn Simulation> {
        self.run(self.of.copy())
    }

    fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError> {
        let mut taken = 0;
        while taken < most && self.t() < end {
            self.advance()?;
            taken += 1;
        }
        Ok(taken)
    }

    fn cross(&mut self, sections: &[Section], end: f64, take: &mut dyn FnMut(Met) -> bool) -> Result<(), StepError> {
        let mut index = 0;
        let is_lossy = self.fault == Fault::LostEvent;
        self.of.cross(sections, end, &mut |met| {
            index += 1;
            (is_lossy && index % 2 == 0) || take(met)
        })
    }
}

/// Dense output that is late.
struct Late {
    of: Box<dyn StepOutput>,
    by: f64,
}

impl StepOutput for Late {
    fn at(&self, t: f64) -> [Vec<f64>; 3] {
        self.of.at(t + self.by)
    }
}

impl Session for Spoiled<dyn Simulation> {
    forward! {
        fn velocity(&self) -> Result<Vec<f64>, StepError>;
        fn parameters(&self) -> Vec<f64>;
        fn checkpoint(&self) -> Result<String, String>;
    }

    fn set_parameters(&mut self, change: &[(usize, f64)]) -> Result<(), StepError> {
        if self.fault == Fault::Parameters { Ok(()) } else { self.of.set_parameters(change) }
    }

    fn set_state(&mut self, change: &[(usize, f64)], (t, q, p): (f64, &[f64], &[f64])) -> Result<(), StepError> {
        let factor = self.factor(Fault::State, 1.0 + 1e-12);
        let p: Vec<f64> = p.iter().map(|p| p * factor).collect();
        self.of.set_state(change, (t, q, &p))
    }

    fn advance_of(&mut self, h: f64) -> Result<(), StepError> {
        let h = h * self.factor(Fault::Length, 1.0 + 1e-7);
        self.of.advance_of(if self.fault == Fault::Length && !h.is_normal() { 1e-3 } else { h })
    }

    fn record(
        &mut self,
        end: Option<f64>,
        most: u64,
        every: u64,
        taken: &mut u64,
        rows: &mut Rows,
    ) -> Result<bool, StepError> {
        self.of.record(end, most, every, taken, rows)
    }

    fn record_at(&mut self, times: &[f64], rows: &mut Rows) -> Result<(), StepError> {
        if self.fault != Fault::Times {
            return self.of.record_at(times, rows);
        }
        let late: Vec<f64> = times.iter().map(|t| t + 1e-8 * self.of.h()).collect();
        self.of.record_at(&late, rows)?;
        rows.t = times.to_vec();
        Ok(())
    }

    fn next_crossing(&mut self, sections: &[Section], end: f64) -> Result<Option<Met>, StepError> {
        let mut met = self.of.next_crossing(sections, end)?;
        if self.fault == Fault::Event
            && let Some(met) = &mut met
        {
            let late = 1e-8 * met.row.h;
            self.of.advance_of(late)?;
            met.row = Row { h: met.row.h + late, ..self.of.row() };
        }
        Ok(met)
    }

    fn step_output(&self, t: f64, q: &[f64], p: &[f64]) -> Result<Box<dyn StepOutput>, StepError> {
        let by = if self.fault == Fault::Dense { 1e-8 * self.of.h() } else { 0.0 };
        Ok(Box::new(Late { of: self.of.step_output(t, q, p)?, by }))
    }

    fn local_error(&self) -> Result<[Vec<f64>; 2], StepError> {
        let factor = self.factor(Fault::Estimate, 30.0);
        Ok(self.of.local_error()?.map(|of| of.iter().map(|error| error * factor).collect()))
    }

    fn linearization(&self) -> Result<Linear, StepError> {
        let factor = 1.0 / self.factor(Fault::Tangent, 1.001);
        let mut found = self.of.linearization()?;
        found.a.iter_mut().for_each(|entry| *entry *= factor);
        Ok(found)
    }

    fn tangent(
        &mut self,
        wanted: Wanted<'_>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<f64>>>, StepError> {
        let factor = self.factor(Fault::Tangent, 1.001);
        let found = self.of.tangent(wanted, goes_on)?;
        Ok(found.map(|of| of.iter().map(|of| of.iter().map(|entry| entry * factor).collect()).collect()))
    }

    fn curvature(&self, wanted: Wanted<'_>, weights: &[f64]) -> Result<Option<Vec<f64>>, StepError> {
        let factor = self.factor(Fault::Curvature, 1.0 + 1e-6);
        let found = self.of.curvature(wanted, weights)?;
        Ok(found.map(|of| of.iter().map(|entry| entry * factor).collect()))
    }

    fn tangents_at(
        &mut self,
        times_and_parameters: (&[f64], &[usize]),
        has_velocities: [bool; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<Vec<f64>>>>, StepError> {
        self.of.tangents_at(times_and_parameters, has_velocities, goes_on)
    }

    fn lyapunov(
        &mut self,
        steps: u64,
        count_and_coordinates: [usize; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError> {
        self.of.lyapunov(steps, count_and_coordinates, goes_on)
    }

    fn gradient(
        &mut self,
        wanted: Wanted<'_>,
        slope: &[f64],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError> {
        // Not the fault of the tangent vectors with which it is compared.
        let factor = 1.0 / self.factor(Fault::Tangent, 1.001);
        let found = self.of.gradient(wanted, slope, goes_on)?;
        Ok(found.map(|of| of.iter().map(|entry| entry * factor).collect()))
    }
}
