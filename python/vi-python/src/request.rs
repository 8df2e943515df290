//! A plan from Python's arguments.

use crate::failure::{exception, wrong};
use pyo3::prelude::*;
use vi_core::StepError;
use vi_erased::System;
use vi_erased::check::{self, Face, Refusal};
use vi_erased::plan::{Method, Named as _, PhasePoint, Plan, Shift};

/// Method and options of a run.
#[derive(Clone, Debug, FromPyObject)]
pub(crate) struct Request {
    method: String,
    stages: Option<usize>,
    h: Option<f64>,
    tolerance: Option<f64>,
    dtau: Option<f64>,
    shift: Option<f64>,
    shift_from: Option<f64>,
    fallback: bool,
}

impl Request {
    /// The plan of a run of this system from a state with velocities.
    ///
    /// # Errors
    /// `ValueError` for options that do not go together, and for a method or stages that are not built, with those that
    /// are.
    pub(crate) fn plan(&self, system: &dyn System, t: f64, q: Vec<f64>, v: Vec<f64>) -> PyResult<Plan> {
        let method =
            Method::named(&self.method).ok_or_else(|| wrong(format!("there is no method {:?}", self.method)))?;
        let h = self.h.or(self.dtau).unwrap_or(f64::NAN);
        let plan = Plan {
            stages: self.stages,
            shift: self.shift_from.map(Shift::Over).or(self.shift.map(Shift::Of)),
            fallback: self.fallback,
            dtau: self.dtau,
            tolerance: self.tolerance,
            ..Plan::new(method, h, PhasePoint { t, q, v })
        };
        check::integrator(system, plan).map_err(|refusal| wrong(refusal.message(Face::Python)))
    }
}

/// A plan whose numbers a run can have.
///
/// # Errors
/// `InvalidInput`.
pub(crate) fn checked(py: Python<'_>, system: &dyn System, plan: Plan) -> PyResult<Plan> {
    match check::numbers(system, &plan) {
        Ok(()) => Ok(plan),
        Err(Refusal::Number { option, allowed, value, .. }) => {
            Err(exception(py, &StepError::InvalidInput { input: option, allowed, value }))
        }
        Err(refusal) => Err(wrong(refusal.message(Face::Python))),
    }
}
