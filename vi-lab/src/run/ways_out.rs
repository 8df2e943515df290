//! What can be done where an energy-preserving step does not exist.
//!
//! In: the run that ended, and its error. Out: one line that names, with their numbers, the shift with which steps exist along this motion,
//! the step densities of other numbers of stages, and fixed steps; or, where steps are too short for their length to be told, a longer one.
//! Nothing for an error of another kind.

use super::request::Request;
use core::cell::Cell;
use vi_core::StepError;
use vi_report::numbers::about;
use vi_runs::plan::{ENERGY_STAGES, Method, Plan, Shift};
use vi_runs::simulation::Row;

/// Steps are tried up to 2^DOUBLINGS times as long.
const DOUBLINGS: u32 = 10;
/// So many have to exist.
const TRIED: u64 = 20;

/// The ways out of an error at a node.
pub(super) fn of(request: &Request, error: &StepError, node: &Row) -> Option<String> {
    let is_missing = matches!(
        error,
        StepError::NoForwardStep { .. }
            | StepError::NoForwardGaussStep { .. }
            | StepError::DegenerateStep { .. }
            | StepError::StepRatio { .. }
    );
    if !is_missing || request.plan.method != Method::Energy {
        return None;
    }
    let stages = request.plan.energy_stages().unwrap_or(1);
    let mut ways = Vec::new();
    if let Some(h) = longer(request, error) {
        ways.push(format!("--h {}: of steps as short as these rounding leaves no length", about(h)));
    }
    if let Some(shift) = shift(request, error, node) {
        let stages = request.plan.stages.map_or_else(String::new, |stages| format!("--stages {stages} "));
        ways.push(format!("{stages}--shift {} makes steps that exist along this motion", about(shift)));
    }
    let densities = request.system.step_densities(node.t, &node.q, &node.p);
    let others: Vec<String> = ENERGY_STAGES
        .into_iter()
        .zip(densities)
        .filter(|(other, _)| *other != stages)
        .filter_map(|(other, density)| density.map(|density| (other, density)))
        // At rest all of them vanish.
        .filter(|(_, density)| *density != 0.0)
        .map(|(other, density)| format!("--stages {other}, D = {}", about(density)))
        .collect();
    if !others.is_empty() {
        ways.push(format!("other orders have other step densities, here {}", others.join("; ")));
    }
    ways.push(format!("--fallback goes on with fixed steps of h = {}", about(node.h)));
    ways.push("--method fixed and --method gauss take no others".to_owned());
    Some(ways.join("; "))
}

/// A first step that is long enough, where the energy of shorter ones tells no length.
fn longer(Request { system, plan, .. }: &Request, error: &StepError) -> Option<f64> {
    let is_degenerate = matches!(error, StepError::DegenerateStep { .. });
    let lengths = (1..=DOUBLINGS).map(|k| plan.h * f64::from(1_u32 << k));
    lengths.filter(|_| is_degenerate).find(|h| {
        let evaluations = Cell::new(0);
        let begun = system.begin(&Plan { h: *h, ..plan.clone() }, &evaluations);
        begun.is_ok_and(|mut run| run.advance_by(TRIED).is_ok())
    })
}

/// The shift that fits the motion: as `--shift auto` measures it, up to the end of the run at least, and larger than the one that failed.
fn shift(Request { system, plan, length, .. }: &Request, error: &StepError, node: &Row) -> Option<f64> {
    let time = length.measured(plan).max(node.t - plan.t);
    let stages = Some(plan.energy_stages().unwrap_or(1));
    let evaluations = Cell::new(0);
    let begun = system.begin(&Plan { stages, shift: Some(Shift::Over(time)), ..plan.clone() }, &evaluations).ok()?;
    let met = match error {
        StepError::NoForwardGaussStep { largest, .. } => 2.0 * largest,
        _ => 0.0,
    };
    let failed = match plan.shift {
        Some(Shift::Of(shift)) => 2.0 * shift,
        _ => 0.0,
    };
    let shift = begun.shifted_energy()?.shift.max(met).max(failed);
    (shift > 0.0).then_some(shift)
}
