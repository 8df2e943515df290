//! Beyond the paper: energy-preserving steps of order 2s, where they exist, the shift, and what they cost.
//!
//! In: nothing. Out: the sections on the step density, the domains, the shift and the error at equal work. Statements and derivations:
//! `docs/theory.md`; here each is drawn beside runs.

mod density;
mod domain;
mod shift;
mod work;

use super::book::Book;
use core::cell::Cell;
use vi_core::StepError;
use vi_report::chart::Look;
use vi_report::failure::Failure;
use vi_report::progress::Progress;
use vi_runs::plan::{ENERGY_STAGES, Method, PhasePoint, Plan};
use vi_runs::system::{System, erased};
use vi_systems::Pendulum;

/// How energy-preserving steps of 1, 2 and 3 stages are drawn.
const LOOKS: [Look; ENERGY_STAGES.len()] = [Look::ENERGY.dotted(), Look::ENERGY.dashed(), Look::ENERGY.line()];

/// The sections beyond the paper.
pub(super) fn chapter(book: &mut Book, progress: &mut Progress) -> Result<(), Failure> {
    progress.message("step densities");
    density::section(book)?;
    progress.message("domains");
    domain::section(book)?;
    progress.message("shift");
    shift::section(book)?;
    progress.message("equal work");
    work::section(book)
}

/// A pendulum, its type erased.
fn pendulum() -> Box<dyn System> {
    erased::<Pendulum, 1>()
}

/// A run from rest at an angle by steps of the length h.
fn released(method: Method, angle: f64, h: f64) -> Plan {
    Plan::new(method, h, PhasePoint { t: 0.0, q: vec![angle], v: vec![0.0] })
}

/// When a run of energy-preserving steps of so many stages from rest at an angle ends, if it does before a time.
fn end(stages: usize, angle: f64, h: f64, until: f64) -> Result<Option<f64>, StepError> {
    let plan = Plan { stages: Some(stages), ..released(Method::Energy, angle, h) };
    let sweeps = Cell::new(0);
    let mut run = pendulum().begin(&plan, &sweeps)?;
    while run.t() < until {
        if run.advance().is_err() {
            return Ok(Some(run.t()));
        }
    }
    Ok(None)
}

/// A state on a motion, and the step densities of 1, 2 and 3 stages there.
struct Point {
    t: f64,
    densities: [f64; ENERGY_STAGES.len()],
}

/// The largest `|D_s|` of some points, of the number of stages with this index.
fn largest(points: &[Point], index: usize) -> f64 {
    points.iter().fold(0.0_f64, |largest, point| largest.max(point.densities[index].abs()))
}

/// Points along the accurate motion of a pendulum from rest, until a time.
fn swing(angle: f64, until: f64) -> Result<Vec<Point>, StepError> {
    let system = pendulum();
    let sweeps = Cell::new(0);
    let mut run = system.begin(&released(Method::Gauss, angle, 0.05), &sweeps)?;
    let mut points = Vec::new();
    loop {
        let densities = densities(system.as_ref(), run.t(), run.q(), run.p())?;
        points.push(Point { t: run.t(), densities });
        if run.t() >= until {
            return Ok(points);
        }
        run.advance()?;
    }
}

/// The step densities of 1, 2 and 3 stages at a node.
fn densities(system: &dyn System, t: f64, q: &[f64], p: &[f64]) -> Result<[f64; ENERGY_STAGES.len()], StepError> {
    match system.step_densities(t, q, p) {
        [Some(one), Some(two), Some(three)] => Ok([one, two, three]),
        _ => Err(StepError::NonFinite { t, quantity: "step density", expression: None }),
    }
}
