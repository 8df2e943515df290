//! A system of a text, which is not compiled.
//!
//! In: the text of a file. Out: a [`System`] that runs by every method. What the command asks beside runs and is compiled
//! for each type, exponents, the rival and step densities, it does not have.

use crate::exponents::Exponents;
use crate::rival::Ended;
use crate::system::System;
use core::cell::Cell;
use vi_core::StepError;
use vi_erased::plan::{ENERGY_STAGES, PhasePoint, Plan};

impl System for vi_tape::System {
    fn erased(&self) -> &(dyn vi_erased::System + 'static) {
        &**self
    }

    fn erased_mut(&mut self) -> &mut (dyn vi_erased::System + 'static) {
        &mut **self
    }

    fn is_compiled(&self) -> bool {
        false
    }

    fn copy(&self) -> Box<dyn System> {
        Box::new(self.clone())
    }

    fn start(&self) -> Option<[Vec<f64>; 2]> {
        None
    }

    fn step_density(&self, _q: &[f64], _v: &[f64]) -> Option<f64> {
        None
    }

    fn step_densities(&self, _t: f64, _q: &[f64], _p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        [None; ENERGY_STAGES.len()]
    }

    fn time_scale(&self, at: &PhasePoint) -> Option<f64> {
        vi_tape::System::time_scale(self, at.t, &at.q, &at.v)
    }

    fn follow(&self, from: &PhasePoint, _end: f64) -> Result<PhasePoint, StepError> {
        Err(compiled(from.t))
    }

    fn lyapunov(&self, plan: &Plan, _count: usize) -> Result<Box<dyn Exponents>, StepError> {
        Err(compiled(plan.t))
    }

    fn rival(
        &self,
        from: &PhasePoint,
        _end: f64,
        _tolerance: f64,
        _evaluations: &Cell<u64>,
        _watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended> {
        Err(compiled(from.t).into())
    }
}

/// The error of what only a compiled system has.
fn compiled(t: f64) -> StepError {
    StepError::NoDerivative { t, because: "a system of a text has runs alone; make a project of it by `vi-lab new`" }
}
