//! Beyond the paper: energy-preserving steps of order 2s, where they exist, the shift, and what they cost.
//!
//! In: nothing. Out: the sections on the step density, the domains, the shift and the error at equal work. Statements and derivations:
//! `docs/theory.md`; here each is drawn beside runs.

mod density;
mod domain;
mod shift;
mod work;

use super::book::Book;
use vi_core::{Called, EnergyPreservingGauss, Gauss, State, StepError};
use vi_report::chart::Look;
use vi_report::failure::Failure;
use vi_report::progress::Progress;
use vi_systems::Pendulum;

/// How energy-preserving steps of 1, 2 and 3 stages are drawn.
const LOOKS: [Look; 3] = [Look::ENERGY.dotted(), Look::ENERGY.dashed(), Look::ENERGY.line()];

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

/// A pendulum at rest at an angle.
fn released(angle: f64) -> (Called<Pendulum>, State<1>) {
    let system = Pendulum::default();
    (Called(system), State::at(&system, 0.0, [angle], [0.0]))
}

/// When a run of energy-preserving steps from rest at an angle ends, if it does before a time.
fn end<const S: usize>(angle: f64, h: f64, until: f64) -> Result<Option<f64>, StepError> {
    let (system, start) = released(angle);
    let mut run = EnergyPreservingGauss::<_, 1, S>::new(system, start, h)?;
    while run.state().t < until {
        if run.step().is_err() {
            return Ok(Some(run.state().t));
        }
    }
    Ok(None)
}

/// States along the accurate motion of a pendulum from rest, until a time.
fn swing(angle: f64, until: f64) -> Result<Vec<State<1>>, StepError> {
    let (Called(system), start) = released(angle);
    let mut run = Gauss::<_, 1, 8>::new(system, start, 0.05)?;
    let mut states = vec![start];
    while run.state().t < until {
        states.push(run.step()?);
    }
    Ok(states)
}
