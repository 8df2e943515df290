//! Alternatives if an energy-preserving step does not exist.
//!
//! In: the run that ended, and its error. Out: one line with a shift for which steps exist along this motion, the step
//! densities of other numbers of stages, and fixed steps; if rounding hides the length of short steps, a longer step;
//! for other errors nothing.

use super::request::Request;
use vi_core::StepError;
use vi_erased::plan::{ENERGY_STAGES, Method, Plan, Shift};
use vi_erased::simulation::Row;
use vi_report::numbers::about;

/// Maximum ratio of a tried step, as a power of 2.
const DOUBLINGS: u32 = 10;
/// Number of steps that must exist.
const TRIED: u64 = 20;

/// The alternatives after an error at a node.
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
        ways.push(format!("--h {}: for steps as short as these, rounding hides the length", about(h)));
    }
    if let Some(shift) = shift(request, error, node) {
        let stages = request.plan.stages.map_or_else(String::new, |stages| format!("--stages {stages} "));
        ways.push(format!("{stages}--shift {} gives steps along this motion", about(shift)));
    }
    let densities = request.system.studies().step_densities(node.t, &node.q, &node.p);
    let others: Vec<String> = ENERGY_STAGES
        .into_iter()
        .zip(densities)
        .filter(|(other, _)| *other != stages)
        .filter_map(|(other, density)| density.map(|density| (other, density)))
        // At rest all densities vanish.
        .filter(|(_, density)| *density != 0.0)
        .map(|(other, density)| format!("--stages {other}, D = {}", about(density)))
        .collect();
    if !others.is_empty() {
        ways.push(format!("other orders have other step densities: {}", others.join("; ")));
    }
    ways.push("--fallback continues with fixed steps".to_owned());
    ways.push(if request.system.has_constraints() {
        "--method gauss needs no step density".to_owned()
    } else {
        "--method fixed and --method gauss need no step density".to_owned()
    });
    Some(ways.join("; "))
}

/// A first step whose length exceeds the rounding of the energy.
fn longer(Request { system, plan, .. }: &Request, error: &StepError) -> Option<f64> {
    let is_degenerate = matches!(error, StepError::DegenerateStep { .. });
    let lengths = (1..=DOUBLINGS).map(|k| plan.h * f64::from(1_u32 << k));
    lengths.filter(|_| is_degenerate).find(|h| {
        let begun = system.begin(&Plan { h: *h, ..plan.clone() });
        begun.is_ok_and(|mut run| run.advance_by(TRIED).is_ok())
    })
}

/// A shift for the motion: measured as for `--shift auto`, up to the end of the run at least, and larger than the
/// failed one.
fn shift(Request { system, plan, length, .. }: &Request, error: &StepError, node: &Row) -> Option<f64> {
    let time = length.measured(plan).max(node.t - plan.t);
    let stages = Some(plan.energy_stages().unwrap_or(1));
    let begun = system.begin(&Plan { stages, shift: Some(Shift::Over(time)), ..plan.clone() }).ok()?;
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
