//! A system of a text, which is not compiled.
//!
//! In: the text of a file. Out: an [`Entry`] whose system runs by every method. What the command asks beside runs and is
//! compiled for each type, exponents, the rival and step densities, it does not have.

use core::cell::Cell;
use vi_core::StepError;
use vi_erased::plan::{ENERGY_STAGES, PhasePoint, Plan};
use vi_runs::entry::Entry;
use vi_runs::exponents::Exponents;
use vi_runs::rival::Ended;
use vi_runs::system::System;

/// The system of a text, which starts at the state of its clause `check`, with the parameters of that clause. Without the
/// clause it starts at zero, with a step of 0.01.
///
/// # Errors
/// The mistakes of the text, at their places in the file of this name.
pub fn entry(file: &str, text: &str) -> Result<Entry, String> {
    let mut system = vi_tape::System::of_file(file, text, &[]).map_err(|mistakes| mistakes.to_string())?;
    let zeros = vec![0.0; system.coordinates().len()];
    let start = system.start().cloned();
    for (name, value) in start.iter().flat_map(|start| &start.parameters) {
        system.set(name, *value);
    }
    let (q, v, h) = start.map_or_else(|| (zeros.clone(), zeros, 0.01), |start| (start.q, start.v, start.h));
    Ok(Entry { about: system.about(), system: Box::new(Text(system.into_inner())), q, v, h })
}

/// Such a system.
struct Text(Box<dyn vi_erased::System>);

impl System for Text {
    fn erased(&self) -> &(dyn vi_erased::System + 'static) {
        &*self.0
    }

    fn erased_mut(&mut self) -> &mut (dyn vi_erased::System + 'static) {
        &mut *self.0
    }

    fn is_compiled(&self) -> bool {
        false
    }

    fn copy(&self) -> Box<dyn System> {
        Box::new(Self(self.0.copy()))
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
