//! Checkpoints, changes of parameters and states.

use super::derivatives::nearest;
use super::spoiled::Fault;
use super::structure::kept_energy;
use super::{Case, Node, advance, ensure, fails, holds};
use vi_core::StepError;
use vi_erased::Simulation;

/// A stored run goes on bit for bit, and only with its own system.
fn checkpoint(case: &Case) -> Result<(), String> {
    let mut run = case.run()?;
    for steps in [0, 1, 7] {
        advance(&mut *run, steps)?;
        let mut resumed = case.system.restart(case.method.built, &run.checkpoint()?)?;
        let mut whole = run.copy();
        for step in 0..10 {
            advance(&mut *whole, 1)?;
            advance(&mut *resumed, 1)?;
            ensure!(whole.row() == resumed.row(), "step {step}: {:?} and {:?}", whole.row(), resumed.row());
        }
        ensure!(whole.checkpoint() == resumed.checkpoint(), "other checkpoints after {steps} steps");
    }
    let stored = run.checkpoint()?;
    for other in case.system.integrators().into_iter().filter(|built| *built != case.method.built) {
        ensure!(case.system.restart(other, &stored).is_err(), "{other:?} takes the run of another method");
    }
    let mut other = case.system.copy();
    let (name, value) = case.scene.parameters[0];
    other.set(name, 1.1 * value);
    let refused = other.restart(case.method.built, &stored).err().unwrap_or_default();
    ensure!(refused.contains(&format!("`{name}`")), "a checkpoint of another {name}: {refused}");
    Ok(())
}

/// The energy that a run preserves, and H: what a change brings is added to both.
fn energies(run: &dyn Simulation) -> Result<[f64; 2], String> {
    Ok([kept_energy(run)?, run.energy().map_err(|error| error.to_string())?])
}

/// The preserved energy changes as H does.
fn is_added([e, h]: [f64; 2], [e_after, h_after]: [f64; 2]) -> Result<(), String> {
    let (of_e, of_h) = (e_after - e, h_after - h);
    ensure!((of_e - of_h).abs() < 1e-14 * (1.0 + h.abs()), "E changes by {of_e}, H by {of_h}");
    ensure!(of_h.abs() > 1e-6, "H does not change");
    Ok(())
}

/// A run with changed parameters, or from another state, takes the steps of a new one; preserved energies change as H.
fn changes(case: &Case) -> Result<(), String> {
    let mut run = case.run()?;
    advance(&mut *run, 3)?;
    let index = case.system.parameters().iter().position(|(name, _)| *name == case.scene.parameters[0].0);
    let (index, value) = (index.ok_or("no parameter")?, case.scene.parameters[0].1);
    let before = Node::of(&*run);
    let energies_before = case.method.keeps_energy.then(|| energies(&*run)).transpose()?;
    run.set_parameters(&[(index, 1.05 * value)]).map_err(|error| error.to_string())?;
    ensure!(Node::of(&*run) == before, "a parameter moves the run");
    ensure!(run.parameters()[index].to_bits() == (1.05 * value).to_bits(), "the parameter is {:?}", run.parameters());
    if let Some(before) = energies_before {
        is_added(before, energies(&*run)?)?;
    }
    let mut changed = case.system.copy();
    changed.set(case.scene.parameters[0].0, 1.05 * value);
    is_new(&case.of_system(changed), &mut *run, &before)?;
    // Another state, with the first parameters again.
    let p: Vec<f64> = before.p.iter().map(|p| 1.1 * p).collect();
    let mut at = Node { t: before.t + 0.3, p, ..before };
    if case.system.is_first_order() {
        at.q.iter_mut().for_each(|q| *q *= 1.02);
        nearest(case, &mut at).map_err(|error| error.to_string())?;
    }
    if case.is_free() {
        let before = case.method.keeps_energy.then(|| energies(&*run)).transpose()?;
        run.set_state(&[(index, value)], (at.t, &at.q, &at.p)).map_err(|error| error.to_string())?;
        if let Some(before) = before {
            is_added(before, energies(&*run)?)?;
        }
        ensure!(Node::of(&*run) == at, "the state is {:?}", Node::of(&*run));
        is_new(case, &mut *run, &at)?;
    }
    let kept = run.row();
    let refused = run.set_parameters(&[(index, f64::NAN)]);
    ensure!(matches!(refused, Err(StepError::InvalidInput { .. })), "a parameter that is no number: {refused:?}");
    let lost = vec![f64::NAN; at.q.len()];
    let refused = run.set_state(&[], (at.t, &lost, &at.p));
    ensure!(matches!(refused, Err(StepError::NonFinite { .. })), "a state that is no number: {refused:?}");
    ensure!(run.row() == kept, "a refused change changes the run");
    advance(&mut *run, 1)
}

/// The next step is the first one of a new run from there.
fn is_new(case: &Case, run: &mut dyn Simulation, at: &Node) -> Result<(), String> {
    advance(run, 1)?;
    if case.method.has_equal_steps() {
        let mut new = case.from(case.h(), at).map_err(|error| error.to_string())?;
        advance(&mut *new, 1)?;
        let off = Node::of(&*new).off(&Node::of(run));
        // Measured: 1e-15, by the low parts of the node.
        ensure!(off < 1e-14, "a new run is off by {off:e}");
    }
    // Steps of unknown length, and in transformed time, may have another one.
    let off = case.motion(at)?.to(run.t())?.off(&Node::of(run));
    ensure!(off < 1e-3, "off by {off:e}");
    Ok(())
}

#[test]
fn stored_runs_go_on_bit_for_bit() {
    holds(checkpoint);
    fails(checkpoint, "everything", Fault::Checkpoint, |_| true);
    fails(checkpoint, "rod", Fault::Checkpoint, |_| true);
}

#[test]
fn changed_runs_are_new_ones() {
    holds(changes);
    fails(changes, "coupled", Fault::Parameters, |_| true);
    fails(changes, "coupled", Fault::State, |_| true);
    fails(changes, "rod", Fault::Parameters, |_| true);
}
