//! Beyond the paper: energy-preserving steps of order 2s, where they exist, the shift, and what they cost.
//!
//! In: nothing. Out: the sections on the step density, the domains, the shift and the error at equal work. Statements and derivations:
//! `docs/theory.md`; here each is drawn beside runs.

mod density;
mod domain;
mod shift;
mod work;

use super::book::Book;
use vi_core::gauss::step_density;
use vi_core::{Called, EnergyPreservingGauss, Gauss, Run, Starts as _, State, StepError};
use vi_erased::plan::ENERGY_STAGES;
use vi_report::chart::Look;
use vi_report::failure::Failure;
use vi_report::progress::Progress;
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

/// A pendulum, its functions not inlined.
fn pendulum() -> Called<Pendulum> {
    Called(Pendulum::default())
}

/// A run of energy-preserving steps from rest at an angle; the first step has the length h.
fn released<const STAGES: usize>(
    angle: f64,
    h: f64,
) -> Result<Run<EnergyPreservingGauss<STAGES>, Called<Pendulum>, 1>, StepError> {
    pendulum().at(0.0, [angle], [0.0]).integrate(EnergyPreservingGauss::<STAGES>, h)
}

/// The time at which such a run ends, if it ends before a given time.
fn end(stages: usize, angle: f64, h: f64, until: f64) -> Result<Option<f64>, StepError> {
    fn of<const STAGES: usize>(angle: f64, h: f64, until: f64) -> Result<Option<f64>, StepError> {
        let mut run = released::<STAGES>(angle, h)?;
        while run.t() < until {
            if run.step().is_err() {
                return Ok(Some(run.t()));
            }
        }
        Ok(None)
    }
    [of::<1>, of::<2>, of::<3>][stages - 1](angle, h, until)
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
    let mut run = pendulum().0.at(0.0, [angle], [0.0]).integrate(Gauss::<8>, 0.05)?;
    let mut points = Vec::new();
    loop {
        let state = run.state();
        points.push(Point { t: state.t, densities: densities(&state)? });
        if state.t >= until {
            return Ok(points);
        }
        run.step()?;
    }
}

/// The step densities of 1, 2 and 3 stages of the pendulum at a state.
fn densities(state: &State<1>) -> Result<[f64; ENERGY_STAGES.len()], StepError> {
    let system = pendulum();
    Ok([
        step_density::<_, 1, 1>(&system, state)?,
        step_density::<_, 1, 2>(&system, state)?,
        step_density::<_, 1, 3>(&system, state)?,
    ])
}
