//! A plan from Python's arguments.

use crate::failure::wrong;
use pyo3::prelude::*;
use vi_erased::System;
use vi_erased::plan::{Built, DEFAULT_BOUND_ENERGY_STAGES, Method, Named as _, PhasePoint, Plan, Shift, Start};

/// Method and options of a run. Python has checked their names.
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
    /// `ValueError` for a method or stages that are not built, with those that are.
    pub(crate) fn plan(&self, system: &dyn System, t: f64, q: Vec<f64>, v: Vec<f64>) -> PyResult<Plan> {
        let method =
            Method::named(&self.method).ok_or_else(|| wrong(format!("there is no method {:?}", self.method)))?;
        let h = self.h.or(self.dtau).unwrap_or(f64::NAN);
        let plan = Plan {
            start: Start::default(),
            stages: self.stages,
            shift: self.shift_from.map(Shift::Over).or(self.shift.map(Shift::Of)),
            fallback: self.fallback,
            dtau: self.dtau,
            tolerance: self.tolerance,
            ..Plan::new(method, h, PhasePoint { t, q, v })
        };
        let plan = Plan { stages: stages(&plan, system), ..plan };
        let wanted = plan.wanted(!system.constraints().is_empty());
        let built = system.integrators();
        if built.contains(&wanted) {
            return Ok(plan);
        }
        let names: Vec<_> = built.into_iter().filter(|of| of.0 == method).map(name).collect();
        let lacks = |clause: &str| !system.definition().contains(clause);
        let hint = if wanted.2 && lacks("time_scale") {
            "Write the clause `time_scale = …;` for steps in transformed time"
        } else if wanted == (Method::Energy, None, false) && system.constraints().is_empty() && lacks("discretize") {
            "Write the clause `discretize midpoint;`, or give stages=1"
        } else {
            "The argument methods of compile and of native builds others, of 1 to 16 stages"
        };
        Err(wrong(format!("{} has no integrator {}; it has {}. {hint}", system.name(), name(wanted), names.join(", "))))
    }
}

/// The stages of a plan: if none are given, the default if it is built, else the most that are built.
fn stages(plan: &Plan, system: &dyn System) -> Option<usize> {
    let has_constraints = !system.constraints().is_empty();
    let of_energy = (plan.method == Method::Energy && has_constraints).then_some(DEFAULT_BOUND_ENERGY_STAGES);
    let usual = plan.gauss_stages(has_constraints).or(of_energy).filter(|_| plan.stages.is_none());
    let Some(usual) = usual else { return plan.stages };
    let built = system.integrators().into_iter().filter(|of| of.0 == plan.method && of.2 == plan.dtau.is_some());
    let built: Vec<usize> = built.filter_map(|of| of.1).collect();
    if built.contains(&usual) { Some(usual) } else { built.into_iter().max() }
}

/// An integrator in the words of Python.
pub(crate) fn name((method, stages, is_transformed): Built) -> String {
    let stages = stages.map_or(String::new(), |stages| format!(", stages={stages}"));
    format!("method=\"{}\"{stages}{}", method.name(), if is_transformed { ", dtau=…" } else { "" })
}
