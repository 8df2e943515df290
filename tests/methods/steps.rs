//! Latched errors, single steps of any length, refused lengths.

use super::spoiled::Fault;
use super::{Case, Node, advance, ensure, fails, holds};
use crate::support::slope;
use vi_core::StepError;
use vi_erased::plan::Start;
use vi_erased::{PhasePoint, Simulation};

/// A run whose next step fails: far too long, or far too fast for its length.
fn failing(case: &Case) -> Result<Box<dyn Simulation>, String> {
    let factors = [1e2, 1e3, 1e4, 1e100, 1e150, 1e200, 1e300];
    let is_equal = case.method.has_equal_steps() || case.method.follows_motion();
    let long = factors.iter().filter(|_| is_equal).filter_map(|factor| case.with(factor * case.h()).ok());
    let fast = factors.iter().filter_map(|factor| {
        let mut run = case.run().ok()?;
        let v = run.velocity().ok()?.iter().map(|v| v * factor).collect();
        let at = PhasePoint { t: run.t(), q: run.q().to_vec(), v };
        let at = case.system.project(&at).ok()?.point;
        run.set_state(&[], (at.t, &at.q, &case.system.momentum(&at).ok()?)).ok()?;
        Some(run)
    });
    let mut found = long.chain(fast).filter(|run| run.copy().advance().is_err());
    found.next().ok_or_else(|| "every step has a solution".into())
}

/// After a failed step the node is the one before it, and the error repeats until a single step or another
/// state ends it.
fn latched_error(case: &Case) -> Result<(), String> {
    let mut run = failing(case)?;
    let before = Node::of(&*run);
    let error = run.advance().expect_err("a step that has failed");
    for _ in 0..2 {
        ensure!(run.advance() == Err(error), "the error does not repeat: {error}");
        ensure!(Node::of(&*run) == before, "a failed step moves the run");
    }
    ensure!(run.advance_by(3) == Err(error), "the loop does not repeat the error {error}");
    let shorter = [1e-3, 1e-6, 1e-100].iter().any(|h| run.advance_of(*h).is_ok());
    ensure!(shorter && Node::of(&*run).off(&before) > 0.0, "a shorter step does not lead on");
    Ok(())
}

/// Lengths without a step are refused, by a start and by a single step, which changes nothing.
fn refused_lengths(case: &Case) -> Result<(), String> {
    for h in [0.0, f64::NAN, f64::INFINITY, 1e-320] {
        let begun = case.with(h).map(|run| run.h());
        let is_refused = match begun {
            Err(StepError::InvalidInput { .. }) => true,
            // The accurate motion to the second point has this length.
            Err(StepError::NonFinite { .. }) => case.method.start == Start::Points,
            _ => false,
        };
        ensure!(is_refused, "a start with h = {h}: {begun:?}");
        let mut run = case.run()?;
        advance(&mut *run, 1)?;
        let before = run.row();
        let taken = run.advance_of(h);
        ensure!(matches!(taken, Err(StepError::InvalidInput { .. })), "a step of {h}: {taken:?}");
        ensure!(run.row() == before, "a refused step of {h} changes the run");
        advance(&mut *run, 1)?;
    }
    Ok(())
}

/// A single step has exactly its length, and the order of the method; the one back returns, and the run goes on with its
/// own steps.
fn single_step(case: &Case) -> Result<(), String> {
    let mut start = case.run()?;
    advance(&mut *start, 2)?;
    let node = Node::of(&*start);
    let h = case.h();
    let mut points = Vec::new();
    for part in [1.0, 0.8, 0.6] {
        let mut run = start.copy();
        run.advance_of(part * h).map_err(|error| error.to_string())?;
        let end = Node::of(&*run);
        ensure!(
            (end.t - node.t - part * h).abs() <= 4.0 * f64::EPSILON,
            "a step of {} for {}",
            end.t - node.t,
            part * h
        );
        points.push((part * h, case.motion(&node)?.to(end.t)?.off(&end)));
        // From the same node another run takes the same step.
        if case.method.has_equal_steps() {
            let mut other = case.from(part * h, &node).map_err(|error| error.to_string())?;
            advance(&mut *other, 1)?;
            let off = Node::of(&*other).off(&end);
            // Measured: 1e-15, by the low parts of the node.
            ensure!(off < 1e-14, "a run with these steps is off by {off:e}");
        }
        let back = run.advance_of(-part * h);
        if case.method.keeps_energy {
            ensure!(matches!(back, Err(StepError::InvalidInput { .. })), "a step backward: {back:?}");
        } else {
            let off = Node::of(&*run).off(&node);
            ensure!(back.is_ok() && off < 1e-13, "there and back again, off by {off:e}");
        }
        advance(&mut *run, 1)?;
        let left = run.h() / start.h();
        ensure!((0.5..2.0).contains(&left), "the next step has {left} of the length of those before");
        ensure!(!case.method.has_equal_steps() || run.h().to_bits() == h.to_bits(), "the next step has {}", run.h());
    }
    let (order, found) = (f64::from(case.method.order) + 1.0, slope(&case.name(), &points, 0.0));
    // Errors of the length in transformed time are the difference of H and the energy of the run.
    ensure!(found > order - 0.75 || points[2].1 < 1e-11, "order {found}, not {order}: {points:?}");
    Ok(())
}

#[test]
fn errors_are_latched() {
    holds(latched_error);
    fails(latched_error, "coupled", Fault::Latch, |_| true);
    fails(latched_error, "rod", Fault::Latch, |_| true);
}

#[test]
fn lengths_without_a_step_are_refused() {
    holds(refused_lengths);
    fails(refused_lengths, "coupled", Fault::Length, |_| true);
}

#[test]
fn single_steps_have_their_length_and_order() {
    holds(single_step);
    fails(single_step, "coupled", Fault::Length, |_| true);
    fails(single_step, "rod", Fault::Length, |_| true);
}
