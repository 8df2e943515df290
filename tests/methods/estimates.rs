//! Error of a step, monitor.

use super::spoiled::Fault;
use super::{Case, Node, advance, ensure, fails, holds, largest};
use vi_erased::Simulation;

/// Smaller errors are rounding.
const ROUNDING: f64 = 1e-12;

/// The larger error of q and h·v of each coordinate of the next step: as estimated, and the true one.
fn errors(case: &Case, run: &mut dyn Simulation) -> Result<[Vec<f64>; 2], String> {
    let [q, hv] = run.local_error().map_err(|error| error.to_string())?;
    let estimate = q.iter().zip(&hv).map(|(q, hv)| q.max(*hv)).collect();
    let mut exact = case.motion(&Node::of(run))?;
    let t = run.t();
    advance(run, 1)?;
    let node = Node::of(run);
    let truth = exact.to(node.t)?;
    let velocity = run.velocity().map_err(|error| error.to_string())?;
    let places = truth.q.iter().zip(&node.q).map(|(one, other)| (one - other).abs());
    let speeds = exact.v().iter().zip(&velocity).map(|(one, other)| ((one - other) * (node.t - t)).abs());
    Ok([estimate, places.zip(speeds).map(|(q, hv)| q.max(hv)).collect()])
}

/// The estimated error of a step is the true one within a factor of ten, also of steps that are far too long: of these
/// the half steps may be no approximation.
fn local_error(case: &Case) -> Result<(), String> {
    let (mut near, mut steps, mut ratios) = (0, 0, [f64::INFINITY, 0.0_f64]);
    for factor in [0.5, 2.0, 8.0, 32.0] {
        let Ok(mut run) = case.with(factor * case.scene.h) else { continue };
        for _ in 0..6 {
            if run.copy().advance().is_err() {
                ensure!(run.local_error().is_err(), "a step that does not exist has an error");
                break;
            }
            let [estimate, truth] = errors(case, &mut *run)?.map(largest);
            let is_near =
                if truth < ROUNDING { estimate < 10.0 * ROUNDING } else { (0.1..10.0).contains(&(estimate / truth)) };
            (near, steps) = (near + u32::from(is_near), steps + 1);
            ensure!(is_near || factor > 4.0, "a step of {factor}: {estimate:e} for {truth:e}");
            if truth > ROUNDING {
                ratios = [ratios[0].min(estimate / truth), ratios[1].max(estimate / truth)];
            }
        }
    }
    println!("{}: {near} of {steps} estimates are near, {ratios:.2?} of the errors", case.name());
    ensure!(steps > 8 && f64::from(near) >= 0.7 * f64::from(steps), "{near} of {steps} estimates are near: {ratios:?}");
    Ok(())
}

/// A monitor finds the largest error, relative to the excursion of its coordinate, and changes no bit.
fn monitor(case: &Case) -> Result<(), String> {
    let (mut run, mut watched) = (case.run()?, case.run()?);
    watched.monitor();
    let start = Node::of(&*run);
    let [mut worst, mut excursion] = [0, 1].map(|_| vec![0.0_f64; start.q.len()]);
    for _ in 0..30 {
        let t = run.t();
        let [_, truth] = errors(case, &mut *run)?;
        advance(&mut *watched, 1)?;
        ensure!(run.row() == watched.row(), "a monitor changes the run");
        let velocity = run.velocity().map_err(|error| error.to_string())?;
        for (index, truth) in truth.iter().enumerate() {
            let moved = (run.q()[index] - start.q[index]).abs().max((velocity[index] * (run.t() - t)).abs());
            excursion[index] = excursion[index].max(moved);
            worst[index] = worst[index].max(*truth);
        }
    }
    let truth = largest(worst.iter().zip(&excursion).map(|(worst, excursion)| worst / excursion));
    let found = watched.largest_error().ok_or("nothing measured")?.estimate;
    println!("{}: the monitor finds {:.2} of the largest error {truth:.1e}", case.name(), found / truth);
    ensure!(truth < ROUNDING || (0.1..100.0).contains(&(found / truth)), "{found:e} for {truth:e}");
    Ok(())
}

#[test]
fn estimates_are_near_the_errors() {
    holds(local_error);
    // Errors of Gauss steps of order 16 are rounding.
    fails(local_error, "forced", Fault::Estimate, |method| method.order < 16);
    fails(local_error, "rod", Fault::Estimate, |_| true);
}

#[test]
fn monitors_find_the_largest_error() {
    holds(monitor);
    fails(monitor, "forced", Fault::Monitor, |_| true);
}
